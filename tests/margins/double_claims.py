"""The margins of tests in doubles on a device, and of bounds that become floats."""
from fractions import Fraction

from claims import Claim, Constant, Inequality
from evaluator import UNKNOWN, Evaluator, Vector
from polynomial import Polynomial
from reader import Sources
from rounding import DEVICE_DOUBLES, DEVICE_FLOATS, ZERO, Number
from sizes import plain, symbol, without_flushing

UNIT = DEVICE_DOUBLES.unit


def vector(name, error=ZERO):
    return Vector(plain(f"{name}{k}", symbol(f"{name}{k}") * error) for k in range(3))


# A difference of exact numbers, relative to itself.
DIFFERENCE = UNIT / (1 - UNIT)
# Bound on coordinates in doubles (docs/method.md, "Ranges"): their products, and what underflow takes, multiplied by
# them.
MOST_COORDINATE = 10**25


def underflow(balance):
    """What underflow takes, as a number: FLUSHED times coordinates."""
    terms = {}
    for monomial, c in balance.terms.items():
        if "flushed" in monomial:
            degree = len(monomial) - monomial.count("flushed")
            c, monomial = c * DEVICE_DOUBLES.flushed ** monomial.count("flushed") * MOST_COORDINATE**degree, ()
        terms[monomial] = terms.get(monomial, 0) + c
    return Polynomial(terms)


def plane_of(sources, replaced):
    evaluator = Evaluator(sources, DEVICE_DOUBLES, replaced=replaced)
    plane = evaluator.call(
        "planeOf",
        vector("x", DIFFERENCE),
        vector("y", DIFFERENCE),
        vector("z", DIFFERENCE),
        vector("d"),
        types=("dvec3",) * 4,
    )
    return [Inequality("error of x . (y cross z)", plane["error"].least, plane["value"].error, [underflow])]


def quotient_of(sources, replaced):
    """As in floats: (a + |above / below| b) / (|below| - b); the division is rounded to nearest, and divides() excludes
    underflow.

    That quotient() is, where a device's division is not, is by hand.
    """
    evaluator = Evaluator(
        sources,
        DEVICE_DOUBLES,
        replaced=replaced,
        assumptions={"known": True},
        contracts={"divides": lambda *_: UNKNOWN, "quotient": lambda e, x, y: e.rounding.divide(x, y)},
        names={
            "quotientOf.divisor": lambda number: Number(
                symbol("d"), ZERO, symbol("d"), nonnegative=True, reciprocal="I"
            ),
            "quotientOf.value": lambda number: plain("v"),
        },
    )
    above = {"type": "Bounded", "value": plain("n"), "error": plain("a", nonnegative=True)}
    below = {"type": "Bounded", "value": Number(symbol("t"), reciprocal="T"), "error": plain("b", nonnegative=True)}
    quotient = evaluator.call("quotientOf", above, below, UNKNOWN, types=("Bounded", "Bounded", "bool"))
    evaluator.check_used()
    a, b, v, inverse = (symbol(s) for s in "abvI")
    need = (a + v * b * (1 / (1 - UNIT))) * inverse * (1 + UNIT) + v * DIFFERENCE
    return [Inequality("error of the quotient", quotient["error"].least.without("flushed"), need)]


def side_beyond(sources, replaced):
    """|w . (x cross y)| > margin implies that it is above slack times the greatest component of x cross y."""
    captured = {}

    def keep(number):
        captured["margin"] = evaluator.settled(number)
        return UNKNOWN

    largest = iter((plain("x", nonnegative=True), plain("y", nonnegative=True)))
    evaluator = Evaluator(
        sources,
        DEVICE_DOUBLES,
        replaced=replaced,
        contracts={
            "planeOf": lambda *_: {"type": "Bounded", "value": UNKNOWN, "error": plain("e", nonnegative=True)},
            "largest": lambda *_: next(largest),
        },
        names={"sideBeyond.margin": keep},
        assumptions={"at.value > margin": True},
    )
    evaluator.call("sideBeyond", UNKNOWN, UNKNOWN, UNKNOWN, plain("slack", nonnegative=True))
    evaluator.check_used()
    # x and y are rounded differences. The sum's rounding takes a share of e, of which planeOf has a fifth to spare.
    need = 2 * (1 + DIFFERENCE) ** 2 * symbol("x") * symbol("y") * symbol("slack") + symbol("e") * (1 - 2 * UNIT)
    return [Inequality("side beyond the slack", captured["margin"].least.without("flushed"), need)]


def scaled_down(sources, replaced):
    evaluator = Evaluator(
        sources,
        DEVICE_DOUBLES,
        replaced=replaced,
        contracts={"float": lambda e, x: e.rounding.converted(x, DEVICE_FLOATS)},
    )
    sweep = {"type": "Sweep", "scale": plain("scale", nonnegative=True, scales=True)}
    result = evaluator.call("scaledDown", plain("low", nonnegative=True), sweep)
    return [Inequality("lower bound as a float", symbol("low") * symbol("scale"), result.size.without("flushed"))]


def lower_hi(sources, replaced):
    captured = {}

    def keep(evaluator, number):
        captured["float"] = evaluator.settled(number)
        return UNKNOWN

    evaluator = Evaluator(
        sources,
        DEVICE_DOUBLES,
        replaced=replaced,
        assumptions={"!wouldLowerHi(sensor, sweep, by)": False},
        contracts={
            "float": lambda e, x: e.rounding.converted(x, DEVICE_FLOATS),
            "floatBitsToUint": keep,
            "atomicMin": lambda *_: UNKNOWN,
        },
        globals={"states": UNKNOWN},
    )
    sweep = {
        "type": "Sweep",
        "scale": plain("scale", nonnegative=True, scales=True),
        "directionLength": plain("length", nonnegative=True),
    }
    evaluator.call("lowerHi", UNKNOWN, sweep, plain("by", nonnegative=True))
    evaluator.check_used()
    # `by` is a rounded sum, and so is the length rounded.
    exact = symbol("by") * symbol("length") * symbol("scale") * (1 + DIFFERENCE) ** 2
    return [Inequality("upper bound as a float", captured["float"].least.without("flushed"), exact)]


def rounded_down(sources, replaced):
    """A lower bound in multiples of the direction, times its length, which is rounded to nearest."""
    evaluator = Evaluator(sources, DEVICE_DOUBLES, replaced=replaced)
    expression = sources.expression("main", REFINED)
    s = plain("s", nonnegative=True)
    low = evaluator.evaluate(
        expression,
        {
            "function": "main",
            "m": {"earliest": s, "unknown": s},
            "sweep": {"directionLength": plain("length", nonnegative=True)},
        },
    )
    exact = symbol("s") * symbol("length") * (1 - DIFFERENCE)
    return [Inequality("lower bound of a pair", exact, low.size.without("flushed"))]


def rounded_up(sources, replaced):
    evaluator = Evaluator(sources, DEVICE_DOUBLES, replaced=replaced)
    expression = sources.expression("summarise", LIMIT)
    limit = evaluator.evaluate(
        expression,
        {
            "function": "summarise",
            "c": {"at": plain("at", nonnegative=True), "error": plain("error", nonnegative=True)},
            "length": plain("length", nonnegative=True),
        },
    )
    exact = (symbol("at") + symbol("error")) * symbol("length") * (1 + DIFFERENCE)
    return [Inequality("upper bound of a pair", limit.least.without("flushed"), exact)]


REFINED = "max(min(m.earliest, m.unknown), 0.0LF) * sweep.directionLength * (1.0LF - kRounded)"
LIMIT = "max(c.at + c.error, 0.0LF) * length * (1.0LF + kRounded)"


def bounded(name, **more):
    return {
        "type": "Bounded",
        "value": plain(name, symbol(f"{name}_error"), **more),
        "error": plain(f"{name}_error", nonnegative=True),
    }


def bounded_vector(name):
    numbers = [bounded(f"{name}{k}") for k in range(3)]
    return {
        "type": "BoundedVector",
        "value": Vector(n["value"] for n in numbers),
        "error": Vector(n["error"] for n in numbers),
    }


def blocking(operation, arguments):
    """An operation on numbers with bounds: those of the result hold.

    What a difference loses is relative to the result; and it loses nothing to underflow, since numbers are 0 or far
    from it.
    """
    is_difference = operation in ("minus", "difference")

    def named(value):
        return (
            Vector(evaluator.rounding.named(x, f"value{k}") for k, x in enumerate(value))
            if isinstance(value, Vector)
            else evaluator.rounding.named(value, "value")
        )

    def statement(sources, replaced):
        nonlocal evaluator
        evaluator = Evaluator(
            sources, DEVICE_DOUBLES, replaced=replaced, names={f"{operation}.value": named} if is_difference else {}
        )
        result = evaluator.call(operation, *arguments)
        if isinstance(result["value"], Number):
            result = {"value": [result["value"]], "error": [result["error"]]}
        return [
            Inequality(f"component {k}", error.least, value.error, [without_flushing] if is_difference else [underflow])
            for k, (value, error) in enumerate(zip(result["value"], result["error"], strict=True))
        ]

    evaluator = None
    return statement


def allowed(sources, replaced):
    """The slack times the greatest component of a normal."""
    evaluator = Evaluator(sources, DEVICE_DOUBLES, replaced=replaced)
    expression = sources.expression("depthsAlong", ALLOWED)
    result = evaluator.settled(
        evaluator.evaluate(
            expression,
            {
                "function": "depthsAlong",
                "slack": bounded("slack", nonnegative=True),
                "largest": plain("n", symbol("n_error"), nonnegative=True),
                "error": plain("n_error", nonnegative=True),
            },
        )
    )
    return [Inequality("slack along a normal", result["error"].least, result["value"].error, [underflow])]


ALLOWED = """Bounded(slack.value * largest, (slack.error * (largest + error) + slack.value * error +
    kHalfUlp * slack.value * largest) * kMore + kTiny)"""


def claims(root):
    bounds = Sources(root, ["shaders/shared/triangle_pair_bounds.glsl", "shaders/shared/divide.glsl"])
    certificate = Sources(root, ["shaders/shared/triangle_pair_bounds.glsl", "shaders/contact/certificate.glsl"])
    lower = Sources(root, ["shaders/contact/lower_hi.glsl"])
    refine = Sources(root, ["shaders/contact/lower_hi.glsl", "shaders/contact/refine.comp.glsl"])
    resolve = Sources(root, ["shaders/contact/interop.h", "shaders/contact/resolve.comp.glsl"])
    block = Sources(root, ["shaders/contact/interop.h", "shaders/contact/block.comp.glsl"])

    def claim(name, function, constants, sources, statement):
        return Claim(
            name,
            function,
            [Constant(*c) if isinstance(c, tuple) else Constant(function, c) for c in constants],
            sources,
            lambda replaced: statement(sources, replaced),
        )

    return [
        claim(
            "x . (y cross z)",
            "planeOf (doubles)",
            [("kTripleError", "10.0LF"), ("kTiny", "1.0e-280LF")],
            bounds,
            plane_of,
        ),
        claim(
            "quotient of bounded numbers",
            "quotientOf",
            ["9.094947017729282e-13LF", "8.881784197001252e-16LF * abs"],
            bounds,
            quotient_of,
        ),
        claim("side beyond a slack", "sideBeyond", ["2.125LF * slack"], certificate, side_beyond),
        claim("lower bound as a float", "scaledDown", [("kRoundedFloat", "2.4e-7LF")], lower, scaled_down),
        claim("upper bound as a float", "lowerHi", [("kRoundedFloat", "2.4e-7LF")], lower, lower_hi),
        claim("lower bound of a pair", "main", [("kRounded", "8.881784197001252e-16LF")], refine, rounded_down),
        claim("upper bound of a pair", "summarise", [("kRounded", "8.0LF")], resolve, rounded_up),
        claim(
            "difference",
            "minus",
            [("kHalfUlp", "1.1102230246251565e-16LF"), ("kMore", "1.0001LF")],
            block,
            blocking("minus", [bounded("p"), bounded("q")]),
        ),
        claim(
            "difference of exact vectors",
            "difference",
            [("kHalfUlp", "1.1102230246251565e-16LF")],
            block,
            blocking("difference", [vector("p"), vector("q")]),
        ),
        claim(
            "inner product",
            "inner",
            [("productError", "3.0LF * kHalfUlp"), ("kMore", "1.0001LF")],
            block,
            blocking("inner", [bounded_vector("p"), bounded_vector("q")]),
        ),
        claim(
            "cross product",
            "crossProduct",
            [("productError", "3.0LF * kHalfUlp"), ("kMore", "1.0001LF")],
            block,
            blocking("crossProduct", [bounded_vector("p"), bounded_vector("q")]),
        ),
        claim(
            "slack along a normal",
            "depthsAlong",
            [("kHalfUlp", "1.1102230246251565e-16LF"), ("kMore", "1.0001LF")],
            block,
            allowed,
        ),
    ]
