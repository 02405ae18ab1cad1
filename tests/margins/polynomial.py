"""Polynomials in symbols for sizes, which are not negative, with exact coefficients."""
from fractions import Fraction
from functools import lru_cache


@lru_cache(maxsize=None)
def _joined(p, q):
    return tuple(sorted(p + q))


class Polynomial:
    """A sum of coefficients times monomials. A monomial is the sorted tuple of its symbols' names."""

    __slots__ = ("terms",)

    def __init__(self, terms=None):
        self.terms = terms or {}

    @staticmethod
    def constant(value):
        return Polynomial({(): Fraction(value)} if value else {})

    @staticmethod
    def symbol(name):
        return Polynomial({(name,): Fraction(1)})

    def __add__(self, other):
        terms = dict(self.terms)
        for monomial, c in polynomial(other).terms.items():
            terms[monomial] = terms.get(monomial, 0) + c
        return Polynomial({m: c for m, c in terms.items() if c})

    __radd__ = __add__

    def __neg__(self):
        return Polynomial({m: -c for m, c in self.terms.items()})

    def __sub__(self, other):
        return self + -polynomial(other)

    def __rsub__(self, other):
        return polynomial(other) - self

    def __mul__(self, other):
        terms = {}
        for q, d in polynomial(other).terms.items():
            for p, c in self.terms.items():
                monomial = _joined(p, q)
                terms[monomial] = terms.get(monomial, 0) + c * d
        return Polynomial({m: c for m, c in terms.items() if c})

    __rmul__ = __mul__

    def coefficient(self, monomial):
        return self.terms.get(monomial, Fraction(0))

    def without(self, symbol):
        """The part whose monomials lack the symbol: its value where the symbol is 0."""
        return Polynomial({m: c for m, c in self.terms.items() if symbol not in m})

    def positive(self):
        return Polynomial({m: c for m, c in self.terms.items() if c > 0})

    def negative(self):
        """The monomials with negative coefficients, as a polynomial of positive ones."""
        return Polynomial({m: -c for m, c in self.terms.items() if c < 0})

    def is_no_less_than(self, other):
        """Whether every coefficient is at least the other's. Then so is the value, whatever the sizes."""
        return all(c >= 0 for c in (self - other).terms.values())

    def __repr__(self):
        ordered = sorted(self.terms.items(), key=lambda term: (len(term[0]), term[0]))
        return " + ".join(f"{float(c):.6g} {' '.join(m)}".strip() for m, c in ordered) or "0"


def polynomial(value):
    return value if isinstance(value, Polynomial) else Polynomial.constant(value)


def greatest(p, q):
    """A bound on both: the greater coefficients. For polynomials without negative ones."""
    monomials = p.terms.keys() | q.terms.keys()
    return Polynomial({m: max(p.coefficient(m), q.coefficient(m)) for m in monomials})


def least(p, q):
    """A polynomial that neither is below: the lesser coefficients."""
    monomials = p.terms.keys() | q.terms.keys()
    lesser = {m: min(p.coefficient(m), q.coefficient(m)) for m in monomials}
    return Polynomial({m: c for m, c in lesser.items() if c})


def product_of_lower_bounds(p, q):
    """A lower bound of x y, for x >= max(p, 0) and y >= max(q, 0).

    With p = p+ - p- and q = q+ - q-, x y >= p+ q+ - p+ q- - p- q+ whichever of p and q are negative.
    """
    return p.positive() * q.positive() - p.positive() * q.negative() - p.negative() * q.positive()
