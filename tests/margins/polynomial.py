"""Polynomials in symbols for sizes, which are not negative, with exact coefficients."""
import itertools
import re
from fractions import Fraction
from functools import lru_cache


@lru_cache(maxsize=None)
def product(p, q):
    """The product of two monomials. The symbol 1/x stands for the inverse of x."""
    symbols = sorted(p + q)
    for symbol in q:
        inverse = symbol.removeprefix("1/") if symbol.startswith("1/") else f"1/{symbol}"
        if symbol in symbols and inverse in symbols:
            symbols.remove(symbol)
            symbols.remove(inverse)
    return tuple(symbols)


def divided(monomial, factor):
    """The monomial without a factor, a tuple of symbols; None if it lacks one of these."""
    left = list(monomial)
    for symbol in factor:
        if symbol not in left:
            return None
        left.remove(symbol)
    return tuple(left)


class Polynomial:
    """A sum of coefficients times monomials. A monomial is the sorted tuple of its symbols' names."""

    __slots__ = ("terms",)

    def __init__(self, terms=()):
        """terms: pairs of a monomial and a coefficient; those of the same monomial are added up."""
        sums = {}
        for monomial, c in terms:
            sums[monomial] = sums[monomial] + c if monomial in sums else c
        self.terms = {m: c for m, c in sums.items() if c}

    @staticmethod
    def constant(value):
        return Polynomial([((), Fraction(value))])

    @staticmethod
    def symbol(name):
        return Polynomial([((name,), Fraction(1))])

    def __add__(self, other):
        return Polynomial([*self.terms.items(), *polynomial(other).terms.items()])

    __radd__ = __add__

    def __neg__(self):
        return self * -1

    def __sub__(self, other):
        return self + -polynomial(other)

    def __rsub__(self, other):
        return polynomial(other) - self

    def __mul__(self, other):
        factors = polynomial(other).terms.items()
        return Polynomial((product(p, q), c * d) for q, d in factors for p, c in self.terms.items())

    __rmul__ = __mul__

    def coefficient(self, monomial):
        return self.terms.get(monomial, Fraction(0))

    def without(self, symbol):
        """The part whose monomials lack the symbol: its value where the symbol is 0."""
        return Polynomial((m, c) for m, c in self.terms.items() if symbol not in m)

    def positive(self):
        return Polynomial((m, c) for m, c in self.terms.items() if c > 0)

    def negative(self):
        """The monomials with negative coefficients, as a polynomial of positive ones."""
        return (-self).positive()

    def __repr__(self):
        ordered = sorted(self.terms.items(), key=lambda term: (len(term[0]), term[0]))
        return " + ".join(f"{float(c):.6g} {' '.join(m)}".strip() for m, c in ordered) or "0"


def polynomial(value):
    return value if isinstance(value, Polynomial) else Polynomial.constant(value)


def total(polynomials):
    return Polynomial(term for p in polynomials for term in polynomial(p).terms.items())


def summed(text, **fixed):
    """A product of symbols, added up over the indices that braces in its text leave free, each from 0 to 2."""
    free = sorted(set(re.findall(r"{(\w+)}", text)) - fixed.keys())
    products = (
        text.format(**fixed, **dict(zip(free, indices))) for indices in itertools.product(range(3), repeat=len(free))
    )
    return Polynomial((tuple(sorted(product.split())), Fraction(1)) for product in products)


def merged(choose, p, q):
    """The polynomial whose coefficients are the greater of p's and q's, which is a bound on both if none is negative,
    or the lesser: neither is below that."""
    return Polynomial((m, choose(p.coefficient(m), q.coefficient(m))) for m in p.terms.keys() | q.terms.keys())


def product_of_lower_bounds(p, q):
    """A lower bound of x y, for x >= max(p, 0) and y >= max(q, 0).

    With p = p+ - p- and q = q+ - q-, x y >= p+ q+ - p+ q- - p- q+ whichever of p and q are negative.
    """
    return p.positive() * q.positive() - p.positive() * q.negative() - p.negative() * q.positive()
