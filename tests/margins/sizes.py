"""Inputs of the claims: numbers with symbols for their sizes."""
from polynomial import Polynomial
from rounding import ZERO, Number

symbol = Polynomial.symbol


def plain(name, error=ZERO, **more):
    """An input that is 0 or in the normal range; `name` stands for its absolute value."""
    size = symbol(name)
    return Number(size, error, size, **more)


def total(polynomials):
    return sum(polynomials, Polynomial())


def without_flushing(balance):
    return balance.without("flushed")


class Kept(dict):
    """Values of variables, as a claim's evaluation comes across them."""

    def keep(self, name, then=lambda value: value):
        """A function for Evaluator.names, which keeps the value under `name` and goes on with then(value)."""

        def keeping(value):
            self.setdefault(name, value)
            return then(value)

        return keeping


def times(number, name):
    """The number, most of which is divided by `name`, multiplied by it."""

    def multiplied(bound):
        terms = {}
        for monomial, c in bound.terms.items():
            rest = list(monomial)
            if f"1/{name}" in rest:
                rest.remove(f"1/{name}")
            else:
                rest.append(name)
            rest = tuple(sorted(rest))
            terms[rest] = terms.get(rest, 0) + c
        return Polynomial(terms)

    return Number(multiplied(number.size), multiplied(number.error), multiplied(number.least))
