"""What is to be proved, and how: a claim is one or more inequalities between polynomials."""
import math
from dataclasses import dataclass, field, replace
from fractions import Fraction

from polynomial import Polynomial, divided
from reader import SourceError, Sources


@dataclass
class Rule:
    """A fact: the product of the symbols `factor` is at most `bound`. Pays for what a margin lacks in monomials with
    that factor."""

    factor: tuple
    bound: Polynomial

    def bound_of(self, monomial):
        left = divided(monomial, self.factor)
        return None if left is None else Polynomial([(left, 1)]) * self.bound


def at_most(bounds):
    """Rules from a dict, by symbols or by tuples of them."""
    return [Rule(f if isinstance(f, tuple) else (f,), bound) for f, bound in bounds.items()]


@dataclass
class Shared:
    """A step for products of symbols, `parts`, that together are at most `bound`: what a balance lacks of the part of
    which it lacks most is paid by the bound instead. What it has to spare in the parts is left out."""

    parts: list
    bound: Polynomial

    def __call__(self, balance):
        rest, lacks = [], {}
        for monomial, c in balance.terms.items():
            factor = next((left for part in self.parts if (left := divided(monomial, part)) is not None), None)
            if factor is None:
                rest.append((monomial, c))
            else:
                lacks[factor] = min(lacks.get(factor, 0), c)
        return Polynomial(rest) + Polynomial(lacks.items()) * self.bound


def without_flushing(balance):
    """A step that leaves out what underflow takes."""
    return balance.without("flushed")


def underflow(arithmetic, most):
    """A step: what underflow takes, as a number. `most`: a bound on each symbol by which it is multiplied."""

    def as_number(monomial, c):
        if "flushed" not in monomial:
            return monomial, c
        return (), c * math.prod(arithmetic.flushed if s == "flushed" else most(s) for s in monomial)

    return lambda balance: Polynomial(as_number(monomial, c) for monomial, c in balance.terms.items())


def paid(balance, rules):
    """What is left of a margin that lacks something in some monomials, after the rules' bounds have taken their places.

    Rules are tried in order; one for whose monomials the margin has something is preferred.
    """
    terms = dict(balance.terms)

    def bound_of(monomial):
        bounds = [bound for rule in rules if (bound := rule.bound_of(monomial)) is not None]
        has = [bound for bound in bounds if all(terms.get(m, 0) > 0 for m in bound.terms)]
        return (has + bounds + [None])[0]

    lacking = [m for m, c in terms.items() if c < 0]
    for _ in range(20000):
        if not lacking:
            break
        monomial = lacking.pop()
        bound = bound_of(monomial) if terms.get(monomial, 0) < 0 else None
        if bound is not None:
            short = terms.pop(monomial)
            for m, c in bound.terms.items():
                terms[m] = terms.get(m, 0) + c * short
                if terms[m] < 0:
                    lacking.append(m)
    return Polynomial(terms.items())


@dataclass
class Inequality:
    """margin >= need, for all sizes that agree with the steps: lists of rules, or functions of what is left."""

    what: str
    margin: Polynomial
    need: Polynomial
    steps: list = field(default_factory=list)

    def lacking(self):
        """What remains of need after margin, coefficient by coefficient; 0 if the inequality holds."""
        balance = self.margin - self.need
        for step in self.steps:
            balance = step(balance) if callable(step) else paid(balance, step)
        return balance.negative()

    def moved(self, other, share):
        """The inequality at `share` of the way to another, in which constants have other values."""
        margin = self.margin + (other.margin - self.margin) * share
        return replace(self, margin=margin, need=self.need + (other.need - self.need) * share)


@dataclass
class Claim:
    """Bounds the error of what a function computes by its margin.

    constants: of the margin, each the first number in a text in the function, or in another function or constant, with
    which it makes a pair. statement: from the sources of the files to inequalities.
    """

    name: str
    function: str
    constants: list
    files: list
    statement: object

    def __post_init__(self):
        self.constants = [c if isinstance(c, tuple) else (self.function, c) for c in self.constants]
        self.sources = Sources.of(*self.files)

    def inequalities(self, replaced):
        """With literals replaced, by token. Raises SourceError where the sources have changed their shape."""
        try:
            return list(self.statement(self.sources.replacing(replaced)))
        except (AttributeError, IndexError, KeyError, RuntimeError, TypeError, ValueError) as error:
            what = f"the claim '{self.name}' does not understand {self.function}: {type(error).__name__}: {error}"
            raise SourceError(f"{self.sources.literal(*self.constants[0]).place}: {what}") from error

    def lacking(self, replaced=None):
        """The inequalities that do not hold, with what they lack."""
        balances = [(inequality.what, inequality.lacking()) for inequality in self.inequalities(replaced or {})]
        return [(what, lacks) for what, lacks in balances if lacks.terms]

    def least_that_proves(self, owner, text):
        """The least value of the constant with which the claim holds, 0 if it is not needed: from above, up to a 256th
        of the room, or a part in 2^20.

        Margins are affine in each constant, so two values give those for all others.
        """
        token, value = self.sources.literal(owner, text), self.sources.number(owner, text)
        low, high = value * Fraction(1025, 1024), value * Fraction(1281, 1024)
        pairs = zip(self.inequalities({token: low}), self.inequalities({token: high}), strict=True)
        depending = [(p, q) for p, q in pairs if (p.margin - q.margin).terms or (p.need - q.need).terms]

        def holds(c):
            share = (c - low) / (high - low)
            return not any(p.moved(q, share).lacking().terms for p, q in depending)

        if holds(Fraction(0)):
            return Fraction(0)
        below, above = Fraction(0), value
        while above - below > max(above / (1 << 20), min(above, value - above) / 256):
            middle = (below + above) / 2
            below, above = (below, middle) if holds(middle) else (middle, above)
        return above
