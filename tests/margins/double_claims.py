"""The margins of tests in doubles on a device, and of bounds that become floats."""
from claims import Claim, Inequality, underflow, without_flushing
from evaluator import UNKNOWN, Evaluator, Vector
from rounding import DEVICE_DOUBLES, DEVICE_FLOATS, Rounding, converted, plain, symbol
from sizes import holds, positive, vector
from triangle_claims import quotient

UNIT = DEVICE_DOUBLES.unit
DIFFERENCE = DEVICE_DOUBLES.of_result
# Coordinates in doubles are at most 10^25 (docs/method.md, "Ranges").
UNDERFLOW = underflow(DEVICE_DOUBLES, lambda symbol: 10**25)


def bounded(name, **more):
    error = positive(f"{name}_error")
    return {"type": "Bounded", "value": plain(name, error.size, **more), "error": error}


def bounded_vector(name):
    numbers = [bounded(f"{name}{k}") for k in range(3)]
    return {"type": "BoundedVector"} | {part: Vector(n[part] for n in numbers) for part in ("value", "error")}


def quotient_of(sources):
    """The division is rounded to nearest, and divides() excludes underflow.

    That quotient() is, where a device's division is not, is by hand.
    """
    contracts = {"divides": UNKNOWN, "quotient": Rounding(DEVICE_DOUBLES).divide}
    return quotient(sources, DEVICE_DOUBLES, "Bounded", assumptions={"known": True}, contracts=contracts)


def side_beyond(sources):
    """|w . (x cross y)| > margin implies that it is above slack times the greatest component of x cross y."""
    plane = {"type": "Bounded", "value": UNKNOWN, "error": positive("e")}
    contracts = {"planeOf": plane, "largest": iter((positive("x"), positive("y")))}
    evaluator = Evaluator(sources, DEVICE_DOUBLES, contracts=contracts, assumptions={"at.value > margin": True})
    evaluator.call("sideBeyond", UNKNOWN, UNKNOWN, UNKNOWN, positive("slack"))
    # x and y are rounded differences. The sum's rounding takes a share of e, of which planeOf has a fifth to spare.
    need = 2 * (1 + DIFFERENCE) ** 2 * symbol("x") * symbol("y") * symbol("slack") + symbol("e") * (1 - 2 * UNIT)
    margin = evaluator.variables["margin"].least
    yield Inequality("side beyond the slack", margin, need, [without_flushing])


def as_float(number):
    return converted(number, DEVICE_FLOATS)


SWEEP = {"type": "Sweep", "scale": positive("scale", scales=True), "directionLength": positive("length")}


def scaled_down(sources):
    evaluator = Evaluator(sources, DEVICE_DOUBLES, contracts={"float": as_float})
    low = evaluator.call("scaledDown", positive("low"), SWEEP)
    yield Inequality("lower bound as a float", symbol("low") * symbol("scale"), low.size, [without_flushing])


def lower_hi(sources):
    floats = []
    contracts = {"float": as_float, "floatBitsToUint": floats.append, "atomicMin": UNKNOWN}
    conditions = {"assumptions": {"!wouldLowerHi(search, sweep, by)": False}, "globals": {"states": UNKNOWN}}
    evaluator = Evaluator(sources, DEVICE_DOUBLES, contracts=contracts, **conditions)
    evaluator.call("lowerHi", UNKNOWN, SWEEP, positive("by"))
    # `by` is a rounded sum, and so is the length rounded.
    exact = symbol("by") * symbol("length") * symbol("scale") * (1 + DIFFERENCE) ** 2
    yield Inequality("upper bound as a float", floats[0].least, exact, [without_flushing])


REFINED = "max(min(earliest, m.unknown), 0.0LF) * sweep.directionLength * (1.0LF - kRounded)"
LIMIT = "max(c.at + c.error, 0.0LF) * length * (1.0LF + kRounded)"


def rounded_down(sources):
    """A lower bound in multiples of the direction, times its length, which is rounded to nearest."""
    parts = {"earliest": positive("s"), "m": {"unknown": positive("s")}}
    low = Evaluator(sources, DEVICE_DOUBLES).expression("main", REFINED, **parts, sweep=SWEEP)
    exact = symbol("s") * symbol("length") * (1 - DIFFERENCE)
    yield Inequality("lower bound of a pair", exact, low.size, [without_flushing])


def rounded_up(sources):
    c = {"at": positive("at"), "error": positive("error")}
    limit = Evaluator(sources, DEVICE_DOUBLES).expression("summarise", LIMIT, c=c, length=positive("length"))
    exact = (symbol("at") + symbol("error")) * symbol("length") * (1 + DIFFERENCE)
    yield Inequality("upper bound of a pair", limit.least, exact, [without_flushing])


ALLOWED = """Bounded(slack.value * largest, (slack.error * (largest + error) + slack.value * error +
    kHalfUlp * slack.value * largest) * kMore + kTiny)"""


def allowed(sources):
    """The slack times the greatest component of a normal."""
    largest, slack = bounded("n", nonnegative=True), bounded("slack", nonnegative=True)
    variables = {"slack": slack, "largest": largest["value"], "error": largest["error"]}
    result = Evaluator(sources, DEVICE_DOUBLES).expression("allowedAlong", ALLOWED, **variables)
    yield Inequality("slack along a normal", result["error"].least, result["value"].error, [UNDERFLOW])


BOUNDED = "shaders/shared/bounded.glsl"
BOUNDS = "shaders/shared/triangle_pair_bounds.glsl"
LOWER_HI = "shaders/contact/refined_pair.glsl"
ANSWERS = ["shaders/contact/interop.h", BOUNDED, "shaders/contact/answers.glsl"]
BLOCK = ["shaders/contact/interop.h", BOUNDED, "shaders/contact/block.comp.glsl"]
TRIPLE = [("kTripleError", "10.0LF"), ("kTiny", "1.0e-280LF")]
QUOTIENT = ["9.094947017729282e-13LF", "8.881784197001252e-16LF * abs"]
AS_FLOAT = [("kRoundedFloat", "2.4e-7LF")]
HALF_ULP, MORE = ("kHalfUlp", "1.1102230246251565e-16LF"), ("kMore", "1.0001LF")
PRODUCT = [("productError", "3.0LF * kHalfUlp"), MORE]


def claims():
    bounds = [BOUNDED, BOUNDS, "shaders/shared/divide.glsl"]
    refine = [BOUNDED, LOWER_HI, "shaders/contact/refine.comp.glsl"]
    prove = [BOUNDED, BOUNDS, "shaders/contact/prove.comp.glsl"]
    vectors = bounded_vector("p"), bounded_vector("q")
    directions = *(vector(name, DIFFERENCE) for name in "xyz"), vector("d")
    # What a difference loses is relative to the result; and it loses nothing to underflow, since numbers are 0 or far
    # from it.
    relative = {"steps": [without_flushing], "names": {"value": "value"}}
    minus = holds(DEVICE_DOUBLES, "minus", bounded("p"), bounded("q"), **relative)
    exact = holds(DEVICE_DOUBLES, "difference", vector("p"), vector("q"), **relative)
    operations = ("planeOf", directions), ("inner", vectors), ("crossProduct", vectors)
    plane_of, inner, cross = (holds(DEVICE_DOUBLES, f, *arguments, steps=[UNDERFLOW]) for f, arguments in operations)
    return [
        Claim("x . (y cross z)", "planeOf (doubles)", TRIPLE, bounds, plane_of),
        Claim("quotient of bounded numbers", "quotientOf", QUOTIENT, bounds, quotient_of),
        Claim("side beyond a slack", "sideBeyond", ["2.125LF * slack"], prove, side_beyond),
        Claim("lower bound as a float", "scaledDown", AS_FLOAT, [LOWER_HI], scaled_down),
        Claim("upper bound as a float", "lowerHi", AS_FLOAT, [LOWER_HI], lower_hi),
        Claim("lower bound of a pair", "main", [("kRounded", "8.0LF")], refine, rounded_down),
        Claim("upper bound of a pair", "summarise", [("kRounded", "8.0LF")], ANSWERS, rounded_up),
        Claim("difference", "minus", [HALF_ULP, MORE], BLOCK, minus),
        Claim("difference of exact vectors", "difference", [HALF_ULP], BLOCK, exact),
        Claim("inner product", "inner", PRODUCT, BLOCK, inner),
        Claim("cross product", "crossProduct", PRODUCT, BLOCK, cross),
        Claim("slack along a normal", "allowedAlong", [HALF_ULP, MORE], BLOCK, allowed),
    ]
