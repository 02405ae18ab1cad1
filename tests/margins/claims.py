"""What is to be proved, and how: a claim is one or more inequalities between polynomials."""
from dataclasses import dataclass, field
from fractions import Fraction

from polynomial import Polynomial, polynomial
from reader import SourceError, number_of


@dataclass
class Rule:
    """A fact: the product of the symbols `factor` is at most `bound`. Pays for what a margin lacks in monomials with
    that factor, unless they contain one of `unless`."""

    factor: tuple
    bound: Polynomial
    unless: tuple = ()

    def applies(self, monomial):
        left = list(monomial)
        for symbol in self.factor:
            if symbol not in left:
                return None
            left.remove(symbol)
        if any(symbol in monomial for symbol in self.unless):
            return None
        return tuple(left)


def paid(balance, rules):
    """What is left of a margin that lacks something in some monomials, after the rules' bounds have taken their places.

    Rules are tried in order; one for whose monomials the margin has something is preferred.
    """
    terms = dict(balance.terms)

    def bound_of(monomial):
        bounds = [
            rule.bound * Polynomial({left: Fraction(1)})
            for rule in rules
            if (left := rule.applies(monomial)) is not None
        ]
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
    return Polynomial(terms)


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


@dataclass
class Constant:
    """A constant of a margin: the first number in `text`, in a function or constant of the sources."""

    owner: str
    text: str


@dataclass
class Claim:
    """Bounds the error of what a function computes by its margin.

    statement: from a dict of replaced literals to a list of inequalities. It raises SourceError where the sources have
    changed their shape.
    """

    name: str
    function: str
    constants: list
    sources: object
    statement: object

    def lacking(self, replaced=None):
        """The inequalities that do not hold, with what they lack."""
        try:
            inequalities = self.statement(replaced or {})
        except (AttributeError, IndexError, KeyError, StopIteration, TypeError) as error:
            raise SourceError(
                f"{self.token(self.constants[0]).place}: the claim '{self.name}' does not understand {self.function}: "
                f"{type(error).__name__}: {error}"
            ) from error
        balances = [(inequality.what, inequality.lacking()) for inequality in inequalities]
        return [(what, lacks) for what, lacks in balances if lacks.terms]

    def token(self, constant):
        return self.sources.literal(constant.owner, constant.text)

    def least_that_proves(self, constant):
        """The least value of the constant with which the claim holds, 0 if it is not needed: from above, up to a 256th
        of the room, or a part in 2^20.

        Margins are affine in each constant, so two values give those for all others.
        """
        token = self.token(constant)
        value = Fraction(number_of(token))
        samples = [value * Fraction(1025, 1024), value * Fraction(1281, 1024)]
        at = [self.statement({token: sample}) for sample in samples]
        depending = [(p, q) for p, q in zip(*at, strict=True) if (p.margin - q.margin).terms or (p.need - q.need).terms]

        def holds(c):
            share = (c - samples[1]) / (samples[0] - samples[1])
            return not any(
                Inequality(
                    p.what, p.margin * share + q.margin * (1 - share), p.need * share + q.need * (1 - share), p.steps
                )
                .lacking()
                .terms
                for p, q in depending
            )

        if holds(Fraction(0)):
            return Fraction(0)
        below, above = Fraction(0), value
        while above - below > max(above / (1 << 20), min(above, value - above) / 256):
            middle = (below + above) / 2
            below, above = (below, middle) if holds(middle) else (middle, above)
        return above
