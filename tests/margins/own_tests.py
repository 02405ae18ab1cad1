"""What the reader, the evaluator and the polynomials must do: return complaints, none if all is well."""
import random
from fractions import Fraction

from claims import Inequality, Rule
from evaluator import Evaluator, Vector
from polynomial import Polynomial, product_of_lower_bounds
from reader import Parser, SourceError, Sources, tokens_of
from rounding import DEVICE_FLOATS, given


class _Text(Sources):
    """Sources of one text."""

    def __init__(self, text):
        super().__init__(None, [])
        self._scan(tokens_of(text, "text.glsl"))


def _stops(text, call):
    sources = _Text(text)
    try:
        call(sources)
    except SourceError as error:
        return (
            "text.glsl:" in str(error)
            or "needed once" in str(error)
            or "claim's" in str(error)
            or "expected once" in str(error)
        )
    return False


def _evaluate(sources, **conditions):
    evaluator = Evaluator(sources, DEVICE_FLOATS, **conditions)
    value = evaluator.call("f", given("x"))
    evaluator.check_used()
    return value


def _stopping():
    """The reader and the evaluator stop at what they do not understand, or what a claim no longer finds."""
    texts = {
        "another statement": "float f(float x) { while (x > 1.0) x = x * 0.5; return x; }",
        "another operator": "float f(float x) { return x @ x; }",
        "a condition that is not known": "float f(float x) { return x > 1.0 ? x : 1.0; }",
        "an unknown function": "float f(float x) { return g(x); }",
        "an unknown variable": "float f(float x) { return x + y; }",
        "a divisor without a name": "float f(float x) { return 1.0 / x; }",
        "a renamed function": "float h(float x) { return x; }",
        "a function twice": "float f(float x) { return x; } float f(float x) { return x * x; }",
    }
    for what, text in texts.items():
        try:
            stopped = _stops(text, _evaluate)
        except SourceError:  # the tokens
            stopped = True
        if not stopped:
            yield f"own test: the evaluation does not stop at {what}"
    if not _stops("float f(float x) { float z = x; return z; }", lambda s: _evaluate(s, names={"f.y": lambda v: v})):
        yield "own test: a name that the source lacks is not noticed"
    if not _stops("float f(float x) { return 2.0 * x; }", lambda s: s.literal("f", "3.0 * x")):
        yield "own test: a constant that the source lacks is not noticed"


def _rounded(value, direction):
    """A float next to an exact value."""
    if value == 0:
        return Fraction(0)
    exponent = 0
    while abs(value) / Fraction(2) ** exponent >= 2:
        exponent += 1
    while abs(value) / Fraction(2) ** exponent < 1:
        exponent -= 1
    unit = Fraction(2) ** (exponent - 23)
    return (value // unit + (direction if value % unit else 0)) * unit


def _errors():
    """Bounds hold for products and sums that are rounded in random directions, in random orders."""
    sources = _Text("float f(vec3 p, vec3 q) { return dot(p, q) * (p.x - q.y); }")
    numbers = Evaluator(sources, DEVICE_FLOATS)
    result = numbers.call("f", Vector(given(f"p{k}") for k in range(3)), Vector(given(f"q{k}") for k in range(3)))
    choose, worst = random.Random(1), 0.0
    for _ in range(2000):
        p = [_rounded(Fraction(choose.uniform(-1, 1)) ** choose.choice((1, 5)), 0) for _ in range(3)]
        q = [_rounded(Fraction(choose.uniform(-1, 1)) ** choose.choice((1, 5)), 0) for _ in range(3)]
        step = lambda value: _rounded(value, choose.randrange(2))  # noqa: E731
        terms = [step(a * b) for a, b in zip(p, q)]
        choose.shuffle(terms)
        computed = step(step(step(terms[0] + terms[1]) + terms[2]) * step(p[0] - q[1]))
        exact = sum(a * b for a, b in zip(p, q)) * (p[0] - q[1])
        sizes = (
            {f"p{k}": abs(p[k]) for k in range(3)}
            | {f"q{k}": abs(q[k]) for k in range(3)}
            | {"flushed": DEVICE_FLOATS.flushed}
        )
        bound = Fraction(0)
        for monomial, c in result.error.terms.items():
            for symbol in monomial:
                c *= sizes[symbol]
            bound += c
        worst = max(worst, float(abs(computed - exact) / bound))
    if not 0.05 < worst <= 1:
        yield f"own test: an error is {worst} of its bound"


def _comparing():
    x, y = Polynomial.symbol("x"), Polynomial.symbol("y")
    if not Inequality("", x + y, x).lacking().terms == {} or not Inequality("", x, x + y).lacking().terms:
        yield "own test: a comparison is wrong"
    if Inequality("", 2 * x, x + y, [[Rule(("y",), x)]]).lacking().terms:
        yield "own test: a rule is not applied"
    if not Inequality("", 2 * x, x + 2 * y, [[Rule(("y",), x)]]).lacking().terms:
        yield "own test: a rule is applied too often"
    # (1 - x) (1 - y) at x = y = 2 would be 1, but both factors may be 0.
    if product_of_lower_bounds(1 - x, 1 - y).coefficient(("x", "y")) > 0:
        yield "own test: a product of lower bounds is wrong"


def complaints():
    return [*_stopping(), *_errors(), *_comparing()]
