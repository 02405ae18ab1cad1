"""The margins of the tests of pairs of triangles in floats."""

from dataclasses import replace
from fractions import Fraction

from claims import Claim, Constant, Inequality, Rule
from evaluator import UNKNOWN, Evaluator, Matrix, Vector
from polynomial import Polynomial
from reader import SourceError, Sources, number_of
from rounding import DEVICE_FLOATS, FLUSHED, ZERO, Number, exactly, given
from sizes import Kept, plain, symbol, total

FILES = [
    "shaders/shared/triangle_pair_bounds.glsl",
    "shaders/shared/two_floats.glsl",
    "shaders/contact/triangle_pair.glsl",
    "shaders/contact/nodes.glsl",
]
# Where flushing is left out.
FLOATS = replace(DEVICE_FLOATS, flushed=Fraction(0))
UNIT, NEAREST = DEVICE_FLOATS.unit, Fraction(1, 1 << 24)
# A rounding, relative to its result.
ROUNDED = UNIT / (1 - UNIT)
AXES = "xyz"

E = symbol("E")
# triangle_pair.glsl adds 1e-30 to each corner's error, and E is twice the sum of two.
LEAST_E = Fraction(39, 10**31)
_FLUSHED = Polynomial.constant(DEVICE_FLOATS.flushed)
# What flushing takes is a number, which the margins' constants pay for, or a share of E; E itself is at most 2^-40 +
# 2^80 E^3.
FLUSHING = [
    Rule(("flushed",), _FLUSHED),
    Rule(("flushed",), E * _FLUSHED * (1 / LEAST_E)),
    Rule(("flushed", "E"), _FLUSHED * (Polynomial.constant(Fraction(1, 1 << 40)) + E * E * E * (1 << 80))),
]
# E holds 48 kUnit times a triangle's distance from its anchor, of which edges are at most twice.
EDGES = [Rule(("flushed", f"{edge}{axis}"), FLUSHED * E * 10**6, unless=("E",)) for edge in "xy" for axis in AXES]


def vector(name, axes=AXES, known=True):
    """A difference of coordinates, off by at most E. `known`: margins that grow with it may be counted on."""
    return Vector(given(f"{name}{axis}", E, known=known) for axis in axes)


def error():
    return given("E", normal=True, nonnegative=True)


def sign(*_):
    """Takes the place of signOf: -1 or 1, as the tests fail for 0. Bounds are the same for both."""
    return exactly(1)


def unknown(*_):
    return UNKNOWN


# ---- expressions with bounds -----------------------------------------------------------------------------------------


def face_of(sources, replaced):
    evaluator = Evaluator(sources, DEVICE_FLOATS, replaced=replaced)
    area = evaluator.call("faceOf", vector("x"), vector("y"), error(), types=("vec3", "vec3", "float"))
    return [Inequality("error of z of x cross y", area["error"].least, area["value"].error, [FLUSHING])]


def plane_of(sources, replaced):
    """Two FLUSHED are to spare, of which quotientOf may lose one."""
    evaluator = Evaluator(sources, DEVICE_FLOATS, replaced=replaced)
    types = ("vec3", "vec3", "vec3", "float")
    plane = evaluator.call("planeOf", vector("g"), vector("x"), vector("y"), error(), types=types)
    need = plane["value"].error + FLUSHED * 2
    return [Inequality("error of gap . (x cross y)", plane["error"].least, need, [EDGES + FLUSHING])]


def quotient_of(sources, replaced):
    """Of N / T, with |N - above| <= a and |T - below| <= b: it is at most (a + |above / below| b) / (|below| - b) from
    above / below.

    That is algebra (docs/exact.md); here is that the rounded margin is no less. The divisor as computed is named, I its
    inverse. Flushing is left out. It may take one FLUSHED from a + |value| b: plane_of proves that a has it to spare.
    """
    evaluator = Evaluator(
        sources,
        DEVICE_FLOATS,
        replaced=replaced,
        assumptions={"nonzero": True},
        names={
            "quotientOf.divisor": lambda _: plain("d", nonnegative=True, reciprocal="I"),
            "quotientOf.value": lambda _: plain("v"),
        },
    )
    above = {"type": "BoundedFloat", "value": plain("n"), "error": plain("a", nonnegative=True)}
    below = {"type": "BoundedFloat", "value": plain("t", reciprocal="T"), "error": plain("b", nonnegative=True)}
    quotient = evaluator.call("quotientOf", above, below, None)
    evaluator.check_used()
    division = DEVICE_FLOATS.division
    a, b, v, inverse = map(symbol, "abvI")
    # |above / below| as it is, from the value as computed; 1 / (|below| - b) from its rounded inverse.
    exact = v * (1 / (1 - division))
    need = (a + exact * b) * inverse * (1 + UNIT) + v * (division / (1 - division))
    return [Inequality("error of the quotient", quotient["error"].least.without("flushed"), need)]


# ---- tests -----------------------------------------------------------------------------------------------------------


def edge_separates(sources, replaced):
    """s < -margin implies that the exact s is below -clearance |edge|, for each corner, whatever the others are."""
    inequalities = []
    for i in range(3):
        kept = Kept()
        names = {f"edgeSeparates.d{k}": lambda _, k=k: vector(f"d{k}", "xy", known=k == i) for k in range(3)}
        names |= {
            "edgeSeparates.e": lambda _: vector("e", "xy"),
            f"edgeSeparates.s{i}": kept.keep("s"),
            "edgeSeparates.margin": kept.keep("margin"),
        }
        evaluator = Evaluator(sources, DEVICE_FLOATS, replaced=replaced, names=names)
        other = {"type": "PlacedTriangle", "corners": [vector("o")] * 3}
        clearance = given("c", nonnegative=True, normal=True)
        evaluator.call("edgeSeparates", vector("p", "xy"), vector("q", "xy"), sign(), other, error(), clearance)
        evaluator.check_used()
        need = kept["s"].error + symbol("c") * (symbol("ex") + symbol("ey") + 2 * E)
        inequalities.append(Inequality(f"corner {i} beyond the edge", kept["margin"].least, need, [FLUSHING]))
    return inequalities


def plane_keeps_apart(sources, replaced):
    """h > reached implies that the exact height is above limit |area| + clearance |n|, and h < -margin that it is below
    -clearance |n|.

    n as computed separates as well as the exact one, where flushing is concerned: what it takes from n is multiplied by
    edges only. If a test passes, g |n| > margin, which holds 6 kFlushed g and clearance (|n| - 9 flushed). So the
    clearance is less than g where it matters what flushing takes from |n|.
    """
    inequalities = []
    for i in range(3):
        kept = Kept()

        def name_normal(components):
            """Symbols n0 to n2 for what each component is at least."""
            return Vector(
                Number(n.size, n.error, symbol(f"n{k}") - FLUSHED, ideal=n.ideal) for k, n in enumerate(components)
            )

        evaluator = Evaluator(
            sources,
            DEVICE_FLOATS,
            replaced=replaced,
            contracts={"signOf": sign},
            names={
                "planeKeepsApart.n": kept.keep("n", name_normal),
                f"planeKeepsApart.h{i}": kept.keep("h"),
                "planeKeepsApart.margin": kept.keep("margin"),
                "planeKeepsApart.reached": kept.keep("reached"),
            },
        )
        area = {"type": "BoundedFloat", "value": given("t", normal=True)}
        area["error"] = given("b", nonnegative=True, normal=True)
        gaps = [vector(f"g{k}", known=k == i) for k in range(3)]
        clearance, limit = (given(name, nonnegative=True, normal=True) for name in "cl")
        evaluator.call("planeKeepsApart", vector("x"), vector("y"), area, *gaps, error(), clearance, limit)
        evaluator.check_used()
        length = total(symbol(f"n{k}") + n.error.without("flushed") for k, n in enumerate(kept["n"]))
        gap = total(symbol(f"g{i}{axis}") for axis in AXES)
        rules = [Rule(("c", "flushed"), _FLUSHED * Fraction(10001, 10000) * gap)] + EDGES + FLUSHING
        rules += [Rule((f"n{k}",), n.size) for k, n in enumerate(kept["n"])]
        behind = kept["h"].error + symbol("c") * length
        beyond = behind + symbol("l") * (symbol("t") + symbol("b"))
        inequalities.append(Inequality(f"height {i} behind the plane", kept["margin"].least, behind, [rules]))
        inequalities.append(Inequality(f"height {i} beyond the plane", kept["reached"].least, beyond, [rules]))
    return inequalities


# ---- the corners' errors ---------------------------------------------------------------------------------------------


class Placed:
    """Evaluates pairFrameOf and placedTriangle for a triangle of `side`, of which corner number `known` counts.

    Flushing is left out: 1e-37 and 1e-30 are for that (by hand). Inputs, in the sensor's unit of length:
    - m00 to m22, the matrix: its two parts are added with one rounding, and hold it to 2^-39;
    - apart0 to apart2, the rows of the anchors' difference: only their last rounding is charged to the margin checked
      here;
    - the frame's axes: unit vectors, whose components were rounded to floats; 1 stands for their sizes;
    - q0x to q2z, the corners less the anchor: (vertex - origin) perUnit is exact.
    """

    def __init__(self, sources, replaced, side, known):
        apart = [symbol(f"apart{k}") for k in range(3)]
        axis = Number(Polynomial.constant(1), NEAREST + Fraction(1, 1 << 50))
        # Only nonnegative numbers, which do not matter here.
        other = plain("other", nonnegative=True, scales=True)
        error_texel = sources.value("kTexelError")

        def texel(evaluator, index, number):
            return Vector([other] * 4) if number == error_texel else Vector([axis] * 3 + [other])

        def entry(i, j):
            return plain(f"m{i}{j}", symbol(f"m{i}{j}") * (ROUNDED + Fraction(1, 1 << 39)))

        framing = Evaluator(
            sources,
            FLOATS,
            replaced=replaced,
            contracts={
                "sensorTexel": texel,
                "objectTexel": texel,
                "normalised": unknown,
                "anchorOf": unknown,
                "rowApart": sign,
            },
            names={
                f"pairFrameOf.matrix{side}": lambda _: Matrix(Vector(entry(i, j) for i in range(3)) for j in range(3)),
                "pairFrameOf.apart": lambda _: Vector(Number(a, a * ROUNDED, a) for a in apart),
            },
        )
        frame = framing.call("pairFrameOf", *[UNKNOWN] * 4)
        framing.check_used()

        corners = iter(range(3))

        def corner(*_):
            i = next(corners)
            q = [symbol(f"q{i}{axis}") for axis in AXES]
            return Vector(Number(x, x * ROUNDED, x if i == known else ZERO) for x in q)

        placing = Evaluator(
            sources,
            FLOATS,
            replaced=replaced,
            contracts={"triangleAt": unknown, "vertexAt": unknown, "normalised": corner},
        )
        zero = Vector(exactly(0) for _ in AXES)
        offset = frame["offset"] if side == "B" else zero
        columns, corner_error = frame[f"columns{side}"], frame[f"error{side}"]
        self.triangle = placing.call(
            "placedTriangle", UNKNOWN, frame[f"turned{side}"], UNKNOWN, UNKNOWN, zero, offset, columns, corner_error
        )
        placing.check_used()


def corner_error(sources, replaced):
    """A corner's error and its share of a difference's rounding are at most `error`, of which E is twice the sum."""
    inequalities = []
    for side in "AB":
        for i in range(3):
            triangle = Placed(sources, replaced, side, i).triangle
            for k, value in enumerate(triangle["corners"][i]):
                need = (value.error + value.size * UNIT) * (1 + 3 * UNIT)
                what = f"corner {i} of {side}, component {k}"
                inequalities.append(Inequality(what, triangle["error"].least, need))
    return inequalities


def boxes(sources, replaced):
    """A comparison of boxes that drops a pair is right, since E is twice what the corners' errors need.

    a and b bound coordinates; the errors of corners are at least 23 kUnit of them. Where a pair is dropped, the
    clearance is at most the distance of the boxes.
    """
    inequalities = []
    for side in "AB":
        triangle = Placed(sources, replaced, side, 0).triangle
        for value in triangle["corners"][0]:
            what = f"error of a corner of {side} against a coordinate"
            need = value.size * 23 * NEAREST
            inequalities.append(Inequality(what, triangle["error"].least, need))

    def triangle_of(size, rest):
        error = rest + size * (23 * NEAREST)
        corner = Vector(Number(size, error) for _ in AXES)
        own = Number(error, ZERO, error, nonnegative=True, normal=True)
        return {"type": "PlacedTriangle", "error": own, "corners": [corner] * 3}

    kept = Kept()
    evaluator = Evaluator(
        sources,
        FLOATS,
        replaced=replaced,
        contracts={"faceOf": unknown, "signOf": sign, "edgeSeparates": unknown, "planeKeepsApart": unknown},
        # As computed, E is exact.
        names={"mayMeet.error": kept.keep("E", lambda e: Number(e.size, ZERO, e.least, nonnegative=True, normal=True))},
    )
    a, b = symbol("a"), symbol("b")
    clearance, limit = (given(name, nonnegative=True, normal=True) for name in "cl")
    evaluator.call("mayMeet", triangle_of(a, symbol("A")), triangle_of(b, symbol("B")), clearance, limit)
    evaluator.check_used()
    if len(evaluator.compared) != 6:
        place = sources.function("mayMeet").place
        raise SourceError(f"{place}: mayMeet has another number of comparisons than the claim knows")
    rules = [Rule(("c",), (a + b) * (1 + Fraction(1, 10**6)))]
    for text, left, right in evaluator.compared:
        need = left.error + right.error
        inequalities.append(Inequality(text, kept["E"].least, need, [rules]))
    return inequalities


def error_of_a_row(sources, replaced):
    """The error of rowApart but for its last rounding.

    addExactly is taken at its word (by hand): high + low is the sum of what it is given, and products of leading 16
    bits and anchors of 8 bits are exact; in any rounding direction, high + low is off by at most 2^-40 of the distance
    of the anchors and both sizes, and low is at most 2^-20 of that. The distance's part is far below the rounding
    charged to `apart`.

    mA0 to mB2 are a row of the matrices, of whose parts the fine ones are at most 2^-15 and hold them to 2^-40; rA0 to
    rB2 are the greatest normalised coordinates, of which an anchor's are at most twice; PA and PB are the terms of the
    positions. Their fine parts are at most 2^-24 and hold them to 2^-49; in doubles, placing loses 6 2^-53.
    """

    def fine(side):
        entries = [symbol(f"m{side}{j}") for j in range(3)]
        position = symbol(f"P{side}")
        lost = Fraction(1, 1 << 49) + Fraction(6, 1 << 53)
        return Vector(
            [Number(m * Fraction(1, 1 << 15), m * Fraction(1, 1 << 40)) for m in entries]
            + [Number(position * Fraction(1, 1 << 24), position * lost)]
        )

    def anchor(side):
        return Vector(Number(symbol(f"r{side}{j}") * 2 * (1 + 2 * UNIT)) for j in range(3))

    added = []
    sizes = total(symbol(f"m{side}{j}") * symbol(f"r{side}{j}") * 2 for side in "AB" for j in range(3))
    low = Number(sizes * Fraction(1, 1 << 20), sizes * Fraction(1, 1 << 40))
    evaluator = Evaluator(
        sources,
        FLOATS,
        replaced=replaced,
        contracts={"addExactly": lambda *arguments: added.append(arguments)},
        names={"rowApart.high": lambda _: exactly(0), "rowApart.low": lambda _: low},
    )
    coarse = Vector([UNKNOWN] * 4)
    row = evaluator.call("rowApart", coarse, fine("A"), anchor("A"), coarse, fine("B"), anchor("B"))
    evaluator.check_used()
    if len(added) != 7:
        place = sources.function("rowApart").place
        raise SourceError(f"{place}: rowApart adds another number of exact terms than the claim knows")
    return row.error


def positions(sources, host, replaced):
    """The rest of a corner's error is in the placement's own: 2^-44 of S, the terms of a position, and 2^-35 of Z, its
    size.

    Turned by a row of the frame, whose components are at most 1 and add up to at most the root of 3.
    """
    error = error_of_a_row(sources, replaced)

    def share(text):
        token = host.literal("placementOf", text)
        return replaced.get(token, number_of(token))

    bound = symbol("S") * share("0x1p-44 * sum") + symbol("Z") * share("0x1p-35 * size")
    ones = Vector(map(exactly, (1, 1, 1, 1)))
    texels = {
        sources.value("kTexelError"): Vector([Number(bound, ZERO, bound, nonnegative=True)] + ones[1:]),
        # The slack, which the frame's second row holds, is for something else.
        sources.value("kTexelFrame") + 1: Vector(map(exactly, (1, 1, 1, 0))),
    }

    def texel(evaluator, index, number):
        return texels.get(number, ones)

    framing = Evaluator(
        sources,
        FLOATS,
        replaced=replaced,
        contracts={
            "sensorTexel": texel,
            "objectTexel": texel,
            "normalised": unknown,
            "anchorOf": unknown,
            "rowApart": lambda *_: exactly(0),
        },
    )
    frame = framing.call("pairFrameOf", *[UNKNOWN] * 4)
    inequalities = []
    for side in "AB":
        # The terms of the rows' sizes add up to Z, whatever the columns: the greatest coefficient counts.
        of_size = max(error.coefficient((f"m{side}{j}", f"r{side}{j}")) for j in range(3))
        of_position = error.coefficient((f"P{side}",)) * Fraction(17321, 10000)
        need = symbol("Z") * of_size + symbol("S") * of_position
        margin = frame[f"error{side}"].least
        inequalities.append(Inequality(f"position of {side}", margin - margin.coefficient(()), need))
    known = {(f"m{side}{j}", f"r{side}{j}") for side in "AB" for j in range(3)} | {("PA",), ("PB",)}
    if error.terms.keys() - known:
        raise SourceError(f"the error of rowApart has terms that the claim does not know: {error}")
    return inequalities


# ----------------------------------------------------------------------------------------------------------------------


def claims(root):
    sources, host = Sources(root, FILES), Sources(root, ["engine/scene/placement.cpp"])

    def claim(name, function, constants, statement, where=sources):
        return Claim(name, function, [Constant(function, text) for text in constants], where, statement)

    def on_positions(replaced):
        return positions(sources, host, replaced)

    def of(statement):
        return lambda replaced: statement(sources, replaced)

    shares = ["0x1p-44 * sum", "0x1p-35 * size"]
    errors = ["1.75 * scale * sensorTexel", "1.75 * scale * objectTexel"]
    plane = [
        "12.0 * kUlp",
        "1.0001 * error",
        "6.0 + 6.0 * g",
        "6.0 * g",
        "16.0 * kUlp",
        "2.0001 * error",
        "1.00001 * limit",
    ]
    return [
        claim("position in two parts", "placementOf", shares, on_positions, host),
        claim("position in two parts", "pairFrameOf", errors, on_positions),
        claim("distance of the anchors", "pairFrameOf", ["24.0 * kUnit"], of(corner_error)),
        claim("corner about its anchor", "placedTriangle", ["24.0 * kUnit"], of(corner_error)),
        claim("boxes of a pair", "differenceError", ["2.0 * (a.error"], of(boxes)),
        claim("z of x cross y", "faceOf", ["6.0 * kUlp", "1.0001 * given", "4.0 * kFlushed"], of(face_of)),
        claim(
            "gap . (x cross y)", "planeOf", ["12.0 * kUlp", "1.0001 * given", "6.0 + 6.0 * g", "6.0 * g"], of(plane_of)
        ),
        claim("quotient of bounded numbers", "quotientOf", ["8.0 * kUlp", "1.0001 + 8.0"], of(quotient_of)),
        claim(
            "side of an edge", "edgeSeparates", ["6.0 * kUlp", "1.0001 * (error", "4.0 * kFlushed"], of(edge_separates)
        ),
        claim("side of a plane", "planeKeepsApart", plane, of(plane_keeps_apart)),
    ]
