"""Numbers that carry bounds of their sizes and errors, and the rules of rounded arithmetic for them.

A Number stands for what a machine computes where the formula, evaluated exactly on exact inputs, has another value. Its
bounds are polynomials:

    size    |computed| is at most this
    ideal   |exact| is at most this
    error   |computed - exact| is at most this
    least   |computed| is at least this, or 0 if this is negative

An operation gives the exact result on its computed operands within `unit` of it, relative, in any direction, a division
within `division`: for floats on a device an ulp of 1 and 2.5 of them, else half an ulp. Besides, it loses at most
FLUSHED: the result may be flushed to 0, and so may it be in one of its uses but not in another, if it is below the
normal range. That is charged once, where a number is made; a sum of numbers that are not negative loses only terms that
have been charged, because a sum below the normal range has no other terms. A sum is rounded only where it is used for
something else than a sum, or has a name, in the least favourable order: each of n terms passes n - 1 additions. Only
what is `precise` has the order that is written, and doubles (shaders/uncontracted.cmake), and what the CPU computes. A contraction to a fused multiply-add omits
roundings, so it has these bounds, too.
"""
from dataclasses import dataclass, replace
from fractions import Fraction

from polynomial import Polynomial, merged, product_of_lower_bounds, total

symbol = Polynomial.symbol
FLUSHED = symbol("flushed")
ZERO = Polynomial()


@dataclass(frozen=True)
class Arithmetic:
    unit: Fraction  # of a sum or product
    division: Fraction  # of a division
    flushed: Fraction  # the value of FLUSHED; 0: nothing is lost
    sums_lose: bool  # whether sums lose FLUSHED, too; they are exact where numbers below the normal range are kept
    ordered: bool = False  # sums have the order that is written

    @property
    def of_result(self):
        """A rounding of a sum or product, relative to the result."""
        return self.unit / (1 - self.unit)


_ANY_DIRECTION = Fraction(2) ** -23
# Floats on a device. Vulkan fixes neither the rounding direction nor whether subnormal numbers are flushed.
DEVICE_FLOATS = Arithmetic(
    _ANY_DIRECTION, Fraction(5, 2) * _ANY_DIRECTION, Fraction(2) ** -126 * (1 + _ANY_DIRECTION), True
)
# Doubles on a device. One that does not round sums and products to nearest is not used for them (gpu/arithmetic.cpp).
_NEAREST = Fraction(2) ** -53
DEVICE_DOUBLES = Arithmetic(_NEAREST, _NEAREST, Fraction(2) ** -1022, True, True)
# The CPU: to nearest, with subnormal numbers.
CPU_DOUBLES = Arithmetic(_NEAREST, _NEAREST, Fraction(2) ** -1074, False, True)
CPU_FLOATS = Arithmetic(Fraction(2) ** -24, Fraction(2) ** -24, Fraction(2) ** -149, False, True)


@dataclass
class Number:
    size: Polynomial
    error: Polynomial = ZERO
    least: Polynomial = ZERO
    ideal: Polynomial = None
    nonnegative: bool = False
    normal: bool = False  # not below the normal range
    scales: bool = False  # a power of two, so that products with it are exact
    divides: bool = False  # the inverse of its size is a symbol, or a number
    constant: Fraction = None  # its value, if it is known
    terms: list = None  # of a sum that is not rounded yet
    arithmetic: Arithmetic = None  # of a number that is of another type than the evaluation's
    before: tuple = None  # the error before the last rounding, and that rounding's unit

    def __post_init__(self):
        if self.ideal is None:
            self.ideal = self.size + self.error

    def times(self, factor):
        return Number(self.size * factor, self.error * factor, self.least * factor)


def known(size, error=ZERO, **more):
    """A number of which `size` is the absolute value, and which is 0 or in the normal range."""
    return Number(size, error, size, **more)


def exactly(value):
    value = Fraction(value)
    parts = abs(value.numerator), value.denominator
    scales = value != 0 and all(part & (part - 1) == 0 for part in parts)
    normal = abs(value) > Fraction(1, 1 << 126)
    conditions = {"nonnegative": value >= 0, "normal": normal, "scales": scales, "divides": value != 0}
    return known(Polynomial.constant(abs(value)), constant=value, **conditions)


def roughly(size, share):
    """A sum of exact numbers that are not negative, off by a share of `size` at most; what is computed counts."""
    return Number(size * (1 + share), ZERO, size * (1 - share), nonnegative=True)


def plain(name, error=ZERO, **more):
    """An input that is 0 or in the normal range; `name` stands for its absolute value."""
    return known(symbol(name), error, **more)


def given(name, error=ZERO, *, normal=False, counts=True, **more):
    """An input that may be flushed to 0 unless it is `normal`; `name` stands for its absolute value.

    `counts`: margins that grow with it may be counted on.
    """
    size, lost = symbol(name), ZERO if normal else FLUSHED
    lower = size - lost if counts else ZERO
    return Number(size, error + lost, lower, normal=normal, **more)


def converted(number, arithmetic):
    """The number, converted to another type."""
    size, unit = number.size, arithmetic.unit
    return Number(
        size * (1 + unit),
        number.error + size * unit,
        number.least * (1 - unit),
        ideal=number.ideal,
        nonnegative=number.nonnegative,
        arithmetic=arithmetic,
    )


class Rounding:
    """The operations of an arithmetic."""

    def __init__(self, arithmetic):
        self.arithmetic = arithmetic
        self.lost = FLUSHED if arithmetic.flushed else ZERO

    def add(self, p, q, precise=False):
        if p.constant == 0:
            return q
        if q.constant == 0:
            return p
        if p.constant is not None and q.constant is not None:
            value = exactly(p.constant + q.constant)
            size, lost = value.size, value.size * self.arithmetic.unit
            return Number(size + lost, lost, size - lost, nonnegative=value.nonnegative)
        if precise or self.arithmetic.ordered:
            return self._rounded_sum([self.settled(p), self.settled(q)])
        return Number(ZERO, terms=(p.terms or [p]) + (q.terms or [q]))

    def settled(self, number):
        return number if number.terms is None else self._rounded_sum(number.terms)

    def _rounded_sum(self, terms):
        a = next((t.arithmetic for t in terms if t.arithmetic is not None), self.arithmetic)
        n = len(terms) - 1
        lost = self.lost * n if a.sums_lose else ZERO
        grows, shrinks = (1 + a.unit) ** n, (1 - a.unit) ** n
        size, inner = total(t.size for t in terms), total(t.error for t in terms)
        nonnegative = all(t.nonnegative for t in terms)
        return Number(
            (size + lost) * grows,
            inner + size * (grows - 1) + lost * grows,
            total(t.least for t in terms) * shrinks if nonnegative else ZERO,
            ideal=total(t.ideal for t in terms),
            nonnegative=nonnegative,
            arithmetic=a if a is not self.arithmetic else None,
            before=(inner + lost, a.unit) if n == 1 else None,
        )

    def negated(self, p):
        terms = p.terms and [self.negated(t) for t in p.terms]
        constant = None if p.constant is None else -p.constant
        return replace(p, nonnegative=False, terms=terms, constant=constant)

    def absolute(self, p):
        p = self.settled(p)
        return replace(p, nonnegative=True, constant=None if p.constant is None else abs(p.constant))

    def multiply(self, p, q):
        p, q = self.settled(p), self.settled(q)
        if 0 in (p.constant, q.constant):
            return exactly(0)
        for one, other in ((p, q), (q, p)):
            if one.constant in (1, -1):
                return other if one.constant == 1 else self.negated(other)
        unit = 0 if p.scales or q.scales else self.arithmetic.unit
        if p.constant is not None and q.constant is not None and unit == 0:
            return exactly(p.constant * q.constant)
        lost = ZERO if self._stays_normal(p, q) or self._stays_normal(q, p) else self.lost
        size = p.size * q.size
        return Number(
            size * (1 + unit) + lost,
            size * unit + lost + p.size * q.error + p.error * q.ideal,
            product_of_lower_bounds(p.least, q.least) * (1 - unit) - lost,
            ideal=p.ideal * q.ideal,
            nonnegative=p.nonnegative and q.nonnegative,
        )

    @staticmethod
    def _stays_normal(p, q):
        """Whether a factor p is at least 1, so that the product is normal or, if p is a power of two, no further off
        than q."""
        return p.constant is not None and abs(p.constant) >= 1 and (q.normal or p.scales)

    def divide(self, p, q):
        """p / q, for an exact q."""
        p, q = self.settled(p), self.settled(q)
        if not q.divides:
            raise ValueError("a divisor must be a constant or a symbol")
        ((monomial, c),) = q.size.terms.items()
        inverse = Polynomial([(tuple(f"1/{symbol}" for symbol in monomial), 1 / c)])
        size, unit = p.size * inverse, self.arithmetic.division
        return Number(
            size * (1 + unit) + self.lost,
            p.error * inverse + size * unit + self.lost,
            p.least * inverse * (1 - unit) - self.lost,
            nonnegative=p.nonnegative and q.nonnegative,
        )

    def maximum(self, p, q):
        p, q = self.settled(p), self.settled(q)
        lower = ZERO
        if p.nonnegative and q.nonnegative:
            # It is no less than either; the second is taken if the first is not known to be above 0.
            lower = p.least if p.least.positive().terms else q.least
        elif p.nonnegative or q.nonnegative:
            lower = p.least if p.nonnegative else q.least
        return self._one_of(p, q, lower, p.nonnegative or q.nonnegative)

    def minimum(self, p, q):
        p, q = self.settled(p), self.settled(q)
        nonnegative = p.nonnegative and q.nonnegative
        lower = merged(min, p.least, q.least) if nonnegative else ZERO
        if nonnegative and q.constant is not None:  # it is at most either
            return Number(p.size, p.error, lower, nonnegative=True)
        return self._one_of(p, q, lower, nonnegative)

    @staticmethod
    def _one_of(p, q, lower, nonnegative):
        return Number(merged(max, p.size, q.size), merged(max, p.error, q.error), lower, nonnegative=nonnegative)

    def named(self, number, name):
        """The same number, with a symbol for its absolute value as computed.

        Its last rounding is at most the unit times that, if that is all that the last operation loses.
        """
        number = self.settled(number)
        size, error = symbol(name), number.error
        if number.before is not None:
            inner, unit = number.before
            error = inner + size * (unit / (1 - unit))
        return Number(size, error, size - self.lost, nonnegative=number.nonnegative)
