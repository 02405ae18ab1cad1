"""Numbers that carry bounds of their sizes and errors, and the rules of rounded arithmetic for them.

A Number stands for what a machine computes where the formula, evaluated exactly on exact inputs, has another value. Its
bounds are polynomials:

    size    |computed| is at most this
    ideal   |exact| is at most this
    error   |computed - exact| is at most this
    least   |computed| is at least this, or 0 if this is negative

An operation gives the exact result on its computed operands within `unit` of it, relative, in any direction, a division
within `division`. Besides, it loses at most FLUSHED: the result may be flushed to 0, and so may it be in one of its
uses but not in another, if it is below the normal range. That is charged once, where a number is made; a sum of numbers
that are not negative loses only terms that have been charged, because a sum below the normal range has no other terms.
A sum is rounded only where it is used for something else than a sum, or has a name, in the least favourable order: each
of n terms passes n - 1 additions. Only what is `precise` has the order that is written, and what the CPU computes. A
contraction to a fused multiply-add omits roundings, so it has these bounds, too.
"""
from dataclasses import dataclass
from fractions import Fraction

from polynomial import Polynomial, greatest, least, polynomial, product_of_lower_bounds

FLUSHED = Polynomial.symbol("flushed")
ZERO = Polynomial()


@dataclass(frozen=True)
class Arithmetic:
    unit: Fraction  # of a sum or product
    division: Fraction  # of a division
    flushed: Fraction  # the value of FLUSHED; 0: nothing is lost
    sums_lose: bool  # whether sums lose FLUSHED, too; they are exact where numbers below the normal range are kept
    ordered: bool = False  # sums have the order that is written


_ANY_DIRECTION = Fraction(2) ** -23
# Floats on a device. Vulkan fixes neither the rounding direction nor whether subnormal numbers are flushed.
DEVICE_FLOATS = Arithmetic(
    _ANY_DIRECTION, Fraction(5, 2) * _ANY_DIRECTION, Fraction(2) ** -126 * (1 + _ANY_DIRECTION), True
)
# Doubles on a device. One that does not round sums and products to nearest is not used for them (gpu/arithmetic.cpp).
_NEAREST = Fraction(2) ** -53
DEVICE_DOUBLES = Arithmetic(_NEAREST, _NEAREST, Fraction(2) ** -1022, True)
# The CPU: to nearest, with subnormal numbers.
CPU_DOUBLES = Arithmetic(_NEAREST, _NEAREST, Fraction(2) ** -1074, False)
CPU_FLOATS = Arithmetic(Fraction(2) ** -24, Fraction(2) ** -24, Fraction(2) ** -149, False)


def is_power_of_two(value):
    value = abs(Fraction(value))
    return (
        value != 0 and value.numerator & (value.numerator - 1) == 0 and value.denominator & (value.denominator - 1) == 0
    )


class Number:
    def __init__(
        self,
        size,
        error=ZERO,
        least=ZERO,
        *,
        ideal=None,
        nonnegative=False,
        normal=False,
        scales=False,
        reciprocal=None,
        constant=None,
    ):
        self.size, self.error, self.least = polynomial(size), polynomial(error), polynomial(least)
        self.ideal = self.size + self.error if ideal is None else ideal
        self.nonnegative = nonnegative
        self.normal = normal or (
            constant is not None and abs(constant) > Fraction(1, 1 << 126)
        )  # not below the normal range
        self.scales = scales  # a power of two, so that products with it are exact
        self.reciprocal = reciprocal  # a symbol that stands for 1 / |computed|
        self.constant = constant  # its value, if it is known
        self.terms = None  # of a sum that is not rounded yet
        self.arithmetic = None  # of a number that is of another type than the evaluation's
        self.before = None  # for a name: the error before the last rounding, and that rounding's unit

    def __repr__(self):
        return f"Number(size {self.size}; error {self.error}; least {self.least})"


def exactly(value):
    size = Polynomial.constant(abs(Fraction(value)))
    return Number(size, least=size, nonnegative=value >= 0, scales=is_power_of_two(value), constant=Fraction(value))


def given(name, error=ZERO, *, nonnegative=False, normal=False, known=True, scales=False, reciprocal=None):
    """An input, of which `name` stands for the absolute value.

    `normal`: never below the normal range. `known`: margins that grow with it may be counted on.
    """
    size, lost = Polynomial.symbol(name), ZERO if normal else FLUSHED
    return Number(
        size,
        polynomial(error) + lost,
        size - lost if known else ZERO,
        ideal=size + error,
        nonnegative=nonnegative,
        normal=normal,
        scales=scales,
        reciprocal=reciprocal,
    )


class Rounding:
    """The operations of an arithmetic."""

    def __init__(self, arithmetic):
        self.arithmetic = arithmetic
        self.any_order = not arithmetic.ordered
        self.lost = FLUSHED if arithmetic.flushed else ZERO

    def add(self, p, q, precise=False):
        if p.constant == 0:
            return q
        if q.constant == 0:
            return p
        if p.constant is not None and q.constant is not None:
            value, unit = p.constant + q.constant, self.arithmetic.unit
            return Number(
                abs(value) * (1 + unit),
                abs(value) * unit,
                abs(value) * (1 - unit),
                nonnegative=value >= 0,
                normal=abs(value) > Fraction(1, 1 << 126),
            )
        if precise or not self.any_order:
            return self._rounded_sum([self.settled(p), self.settled(q)])
        result = Number(ZERO)
        result.terms = (p.terms or [p]) + (q.terms or [q])
        return result

    def settled(self, number):
        return number if number.terms is None else self._rounded_sum(number.terms)

    def _arithmetic_of(self, numbers):
        return next((n.arithmetic for n in numbers if n.arithmetic is not None), self.arithmetic)

    def converted(self, number, arithmetic):
        """The number, converted to another type."""
        number = self.settled(number)
        size, unit = number.size, arithmetic.unit
        result = Number(
            size * (1 + unit),
            number.error + size * unit,
            number.least * (1 - unit),
            ideal=number.ideal,
            nonnegative=number.nonnegative,
        )
        result.arithmetic = arithmetic
        return result

    def _rounded_sum(self, terms):
        a, n = self._arithmetic_of(terms), len(terms) - 1
        lost = self.lost * n if a.sums_lose else ZERO
        grows, shrinks = (1 + a.unit) ** n, (1 - a.unit) ** n
        size = sum((t.size for t in terms), ZERO)
        inner = sum((t.error for t in terms), ZERO)
        nonnegative = all(t.nonnegative for t in terms)
        lower = sum((t.least for t in terms), ZERO) * shrinks if nonnegative else ZERO
        result = Number(
            (size + lost) * grows,
            inner + size * (grows - 1) + lost * grows,
            lower,
            ideal=sum((t.ideal for t in terms), ZERO),
            nonnegative=nonnegative,
            normal=nonnegative and any(t.normal for t in terms),
        )
        if n == 1:
            result.before = inner + lost, a.unit
        result.arithmetic = a if a is not self.arithmetic else None
        return result

    def negated(self, p):
        if p.terms is not None:
            result = Number(ZERO)
            result.terms = [self.negated(t) for t in p.terms]
            return result
        return Number(
            p.size,
            p.error,
            p.least,
            ideal=p.ideal,
            normal=p.normal,
            scales=p.scales,
            reciprocal=p.reciprocal,
            constant=None if p.constant is None else -p.constant,
        )

    def absolute(self, p):
        p = self.settled(p)
        result = Number(
            p.size,
            p.error,
            p.least,
            ideal=p.ideal,
            nonnegative=True,
            normal=p.normal,
            scales=p.scales,
            reciprocal=p.reciprocal,
            constant=None if p.constant is None else abs(p.constant),
        )
        result.before = p.before
        return result

    def multiply(self, p, q):
        p, q = self.settled(p), self.settled(q)
        if 0 in (p.constant, q.constant):
            return exactly(0)
        for one, other in ((p, q), (q, p)):
            if one.constant is not None and abs(one.constant) == 1:
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
            normal=not lost.terms and p.normal and q.normal,
            scales=p.scales and q.scales,
        )

    @staticmethod
    def _stays_normal(p, q):
        """Whether a factor p is at least 1, so that the product is normal or, if p is a power of two, no further off
        than q; or whether both are constants."""
        both = not (p.size.terms.keys() | q.size.terms.keys()) - {()}
        return (both and p.normal and q.normal) or (
            p.constant is not None and abs(p.constant) >= 1 and (q.normal or p.scales)
        )

    def divide(self, p, q):
        """p / q, for a constant q or one that is exact, and named so that its reciprocal has a symbol."""
        p, q = self.settled(p), self.settled(q)
        if q.constant is not None:
            inverse = Polynomial.constant(1 / abs(q.constant))
        elif q.reciprocal is not None:
            inverse = Polynomial.symbol(q.reciprocal)
        else:
            raise ValueError("a divisor must be a constant or named with a reciprocal")
        unit = 0 if q.scales else self.arithmetic.division
        size = p.size * inverse
        return Number(
            size * (1 + unit) + self.lost,
            p.error * inverse + size * unit + self.lost,
            p.least * inverse * (1 - unit) - self.lost,
            ideal=p.ideal * inverse,
            nonnegative=p.nonnegative and q.nonnegative,
            scales=p.scales and q.scales,
        )

    def maximum(self, p, q):
        p, q = self.settled(p), self.settled(q)
        nonnegative = p.nonnegative or q.nonnegative
        lower = ZERO
        if p.nonnegative and q.nonnegative:
            # It is no less than either; one is taken if the other has nothing to add.
            lower = (
                p.least
                if not q.least.positive().terms or p.least.is_no_less_than(q.least)
                else q.least
                if not p.least.positive().terms or q.least.is_no_less_than(p.least)
                else least(p.least, q.least)
            )
        elif nonnegative:
            lower = p.least if p.nonnegative else q.least
        return Number(
            greatest(p.size, q.size),
            greatest(p.error, q.error),
            lower,
            ideal=greatest(p.ideal, q.ideal),
            nonnegative=nonnegative,
        )

    def minimum(self, p, q):
        p, q = self.settled(p), self.settled(q)
        nonnegative = p.nonnegative and q.nonnegative
        if nonnegative and q.constant is not None:  # it is at most either
            return Number(p.size, p.error, least(p.least, q.least), ideal=p.ideal, nonnegative=True)
        return Number(
            greatest(p.size, q.size),
            greatest(p.error, q.error),
            least(p.least, q.least) if nonnegative else ZERO,
            ideal=greatest(p.ideal, q.ideal),
            nonnegative=nonnegative,
        )

    def named(self, number, name, *, reciprocal=None, exact=False, nonnegative=False):
        """The same number, with a symbol for its absolute value as computed.

        Its last rounding is at most the unit times that, if that is all that the last operation loses. `exact`: from
        here on, what is computed is what counts.
        """
        number = self.settled(number)
        symbol, error = Polynomial.symbol(name), number.error
        if number.before is not None:
            inner, unit = number.before
            error = inner + symbol * (unit / (1 - unit))
        return Number(
            symbol,
            ZERO if exact else error,
            symbol - (ZERO if exact else self.lost),
            nonnegative=nonnegative or number.nonnegative,
            reciprocal=reciprocal,
        )
