"""What the reader, the evaluator and the polynomials must do: return complaints, none if all is well."""
import math
import random
from fractions import Fraction

from claims import Inequality, Rule
from evaluator import Evaluator, Vector
from polynomial import Polynomial, product_of_lower_bounds
from reader import SourceError, Sources
from rounding import DEVICE_FLOATS, given


def _sources(text):
    sources = Sources()
    sources.add(text, "text.glsl")
    return sources


def _evaluate(text, **conditions):
    return Evaluator(_sources(text), DEVICE_FLOATS, **conditions).call("f", given("x"))


def _stopping():
    """The reader and the evaluator stop at what they do not understand, or what a claim no longer finds."""
    identity = "float f(float x) { float z = x; return z; }"
    cases = {
        "another statement": lambda: _evaluate("float f(float x) { while (x > 1.0) x = x * 0.5; return x; }"),
        "another token": lambda: _evaluate("float f(float x) { return x @ x; }"),
        "a condition that is not known": lambda: _evaluate("float f(float x) { return x > 1.0 ? x : 1.0; }"),
        "an unknown function": lambda: _evaluate("float f(float x) { return g(x); }"),
        "an unknown variable": lambda: _evaluate("float f(float x) { return x + y; }"),
        "a variable without a value": lambda: _evaluate("float f(float x) { float y; return x + y; }"),
        "a divisor without a name": lambda: _evaluate("float f(float x) { return 1.0 / x; }"),
        "a renamed function": lambda: _evaluate("float h(float x) { return x; }"),
        "a function twice": lambda: _evaluate("float f(float x) { return x; } float f(float x) { return x * x; }"),
        "a name that the source lacks": lambda: _evaluate(identity, names={"y": "y"}),
        "a value that the source has no place for": lambda: _evaluate(identity, names={"z": iter("yz")}),
        "a constant that the source lacks": lambda: _sources(identity).literal("f", "3.0 * x"),
    }
    for what, case in cases.items():
        try:
            case()
        except SourceError as error:
            if not any(part in str(error) for part in ("text.glsl:", "needed once", "claim's")):
                yield f"own test: the error for {what} does not say where: {error}"
        else:
            yield f"own test: nothing stops at {what}"


def _rounded(value, direction):
    """A float next to an exact value."""
    if value == 0:
        return Fraction(0)
    exponent = math.frexp(value)[1]  # of a value that may be rounded up to a power of two
    exponent -= abs(value) < Fraction(2) ** (exponent - 1)
    unit = Fraction(2) ** (exponent - 24)
    return (value // unit + (direction if value % unit else 0)) * unit


def _errors():
    """Bounds hold for products and sums that are rounded in random directions, in random orders."""
    sources = _sources("float f(vec3 p, vec3 q) { return dot(p, q) * (p.x - q.y); }")
    vectors = (Vector(given(f"{name}{k}") for k in range(3)) for name in "pq")
    error = Evaluator(sources, DEVICE_FLOATS).call("f", *vectors).error
    choose, worst = random.Random(1), 0.0

    def step(value):
        return _rounded(value, choose.randrange(2))

    for _ in range(2000):
        p, q = ([_rounded(Fraction(choose.uniform(-1, 1)) ** choose.choice((1, 5)), 0) for _ in "xyz"] for _ in "pq")
        terms = [step(a * b) for a, b in zip(p, q)]
        choose.shuffle(terms)
        computed = step(step(step(terms[0] + terms[1]) + terms[2]) * step(p[0] - q[1]))
        exact = sum(a * b for a, b in zip(p, q)) * (p[0] - q[1])
        sizes = {f"{name}{k}": abs(v[k]) for name, v in (("p", p), ("q", q)) for k in range(3)}
        sizes["flushed"] = DEVICE_FLOATS.flushed
        bound = sum(c * math.prod(sizes[symbol] for symbol in monomial) for monomial, c in error.terms.items())
        worst = max(worst, float(abs(computed - exact) / bound))
    if not 0.05 < worst <= 1:
        yield f"own test: an error is {worst} of its bound"


def _comparing():
    x, y = Polynomial.symbol("x"), Polynomial.symbol("y")
    if Inequality("", x + y, x).lacking().terms or not Inequality("", x, x + y).lacking().terms:
        yield "own test: a comparison is wrong"
    if Inequality("", 2 * x, x + y, [[Rule(("y",), x)]]).lacking().terms:
        yield "own test: a rule is not applied"
    if not Inequality("", 2 * x, x + 2 * y, [[Rule(("y",), x)]]).lacking().terms:
        yield "own test: a rule is applied too often"
    if (x * y * Polynomial.symbol("1/x") - y).terms:
        yield "own test: a symbol and its inverse do not cancel"
    # (1 - x) (1 - y) at x = y = 2 would be 1, but both factors may be 0.
    if product_of_lower_bounds(1 - x, 1 - y).coefficient(("x", "y")) > 0:
        yield "own test: a product of lower bounds is wrong"


def complaints():
    return [*_stopping(), *_errors(), *_comparing()]
