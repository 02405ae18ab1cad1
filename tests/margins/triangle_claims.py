"""The margins of the tests of pairs of triangles in floats."""
from dataclasses import replace
from fractions import Fraction

from claims import Claim, Inequality, Rule, at_most, without_flushing
from evaluator import UNKNOWN, Evaluator, Vector
from polynomial import Polynomial, divided, total
from reader import SourceError, Sources
from rounding import DEVICE_FLOATS, FLUSHED, ZERO, Number, exactly, given, known, plain, symbol
from sizes import ROOT_OF_3, holds, matrix, vector

FILES = [
    "shaders/shared/triangle_pair_bounds.glsl",
    "shaders/shared/two_floats.glsl",
    "shaders/contact/triangle_pair.glsl",
    "shaders/contact/nodes.glsl",
]
HOST, PLACED = ["engine/scene/placement.cpp"], ["shaders/shared/placement.glsl"]
UNIT, NEAREST = DEVICE_FLOATS.unit, Fraction(1, 1 << 24)
ROUNDED = DEVICE_FLOATS.of_result
# Two parts of a matrix's entry, added with one rounding, hold it to 2^-39.
IN_PARTS = ROUNDED + Fraction(1, 1 << 39)
# A component of a direction of unit length, rounded to nearest; 1 stands for its size.
DIRECTION = Number(Polynomial.constant(1), NEAREST + Fraction(1, 1 << 50) + FLUSHED)
# A placement's error has this per entry of its matrix, in FLUSHED, for vertices, which lose 1 before they are
# normalised, and 1 then. A float that is read may lose 1 more.
_VERTEX = Sources.of(*PLACED).number("placementOf", "3e-37 + 3e-37 *")
OF_VERTICES = min(_VERTEX, Sources.of(*HOST).number("kFlushedVertex", "3e-37")) / DEVICE_FLOATS.flushed
AXES = "xyz"

E = symbol("E")
# triangle_pair.glsl adds 1e-30 to each corner's error, and E is twice the sum of two.
LEAST_E = Fraction(39, 10**31)
_FLUSHED = Polynomial.constant(DEVICE_FLOATS.flushed)
# As many FLUSHED has planeOf to spare, for quotientOf.
SPARE = 3
# What flushing takes is a number, which the margins' constants pay for, or a share of E; E itself is at most 2^-40 +
# 2^80 E^3.
FLUSHING = [
    Rule(("flushed",), _FLUSHED),
    Rule(("flushed",), E * _FLUSHED * (1 / LEAST_E)),
    Rule(("flushed", "E"), _FLUSHED * (Fraction(1, 1 << 40) + E * E * E * (1 << 80))),
]
# E holds 48 kUnit times a triangle's distance from its anchor, of which edges are at most twice.
EDGES = [Rule(("flushed", f"{edge}{axis}"), FLUSHED * E * 10**6) for edge in "xy" for axis in AXES]


def difference(name, axes=AXES, counts=True):
    """A difference of coordinates, off by at most E. `counts`: margins that grow with it may be counted on."""
    return Vector(given(f"{name}{axis}", E, counts=counts) for axis in axes)


def positive(name):
    return given(name, normal=True, nonnegative=True)


# signOf is -1 or 1, as the tests fail for 0. Bounds are the same for both.
SIGN = exactly(1)


def quotient(sources, arithmetic, bounded, **conditions):
    """Of N / T, with |N - above| <= a and |T - below| <= b: it is at most (a + |above / below| b) / (|below| - b) from
    above / below.

    That is algebra (docs/exact.md); here is that the rounded margin is no less. The divisor as computed is named d.

    Where numbers flush, above and the quotient may. So value is off by a FLUSHED / |below| more, of which |below| is at
    least d, and this times b at most half a FLUSHED, since b is less than |below| / 2: planeOf has these to spare.
    """
    lost = FLUSHED if arithmetic.flushed and bounded == "BoundedFloat" else ZERO
    names = {"divisor": plain("d", nonnegative=True, divides=True), "value": plain("v")}
    above = {"type": bounded, "value": plain("n"), "error": plain("a", nonnegative=True)}
    below = {"type": bounded, "value": plain("t", divides=True), "error": plain("b", nonnegative=True)}
    quotient = Evaluator(sources, arithmetic, names=names, **conditions).call("quotientOf", above, below, UNKNOWN)
    a, b, v, inverse = map(symbol, ("a", "b", "v", "1/d"))
    # |above / below| as it is, from the value as computed; 1 / (|below| - b) from its rounded inverse.
    unit, division = arithmetic.unit, arithmetic.division
    above = a + lost * (Fraction(3, 2) - SPARE)
    need = (above + (v + lost) * b * (1 / (1 - division))) * inverse * (1 + unit)
    need += (v + lost) * (division / (1 - division)) + lost
    margin = quotient["error"].least if lost.terms else quotient["error"].least.without("flushed")
    below = Rule(("1/d", "b", "flushed"), FLUSHED)
    yield Inequality("error of the quotient", margin, need, [[below], [Rule(("flushed",), _FLUSHED)]])


def quotient_of(sources):
    return quotient(sources, DEVICE_FLOATS, "BoundedFloat", assumptions={"nonzero": True})


def edge_separates(sources):
    """s < -margin implies that the exact s is below -clearance |edge|, for each corner, whatever the others are."""
    for i in range(3):
        names = {f"d{k}": difference(f"d{k}", "xy", counts=k == i) for k in range(3)}
        evaluator = Evaluator(sources, DEVICE_FLOATS, names=names | {"e": difference("e", "xy")})
        other = {"type": "PlacedTriangle", "corners": [difference("o")] * 3}
        edge = difference("p", "xy"), difference("q", "xy")
        evaluator.call("edgeSeparates", *edge, SIGN, other, positive("E"), positive("c"))
        margin, s = (evaluator.variables[name] for name in ("margin", f"s{i}"))
        need = s.error + symbol("c") * (symbol("ex") + symbol("ey") + 2 * E)
        yield Inequality(f"corner {i} beyond the edge", margin.least, need, [FLUSHING])


def beyond_until(sources):
    """h > reached implies that the exact height is above limit |area| + clearance |n|, and h < -margin that it is below
    -clearance |n|. Else (h - margin) / perTime times |area| is at most the exact height less clearance |n|: as computed
    the quotient is at most (h - margin) (1 + unit) (1 + division) / perTime, or not positive, and perTime pays for
    both roundings. perTime is not flushed: the area exceeds its error, which holds 4 kFlushed.

    n as computed separates as well as the exact one, where flushing is concerned: what it takes from n is multiplied by
    edges only. If a test passes, g |n| > margin, which holds 6 kFlushed g and clearance (|n| - 9 flushed). So the
    clearance is less than g where it matters what flushing takes from |n|.
    """

    def name_normal(components):
        """Symbols n0 to n2 for what each component is at least."""
        return Vector(replace(n, least=symbol(f"n{k}") - FLUSHED) for k, n in enumerate(components))

    for i in range(3):
        names = {"n": name_normal}
        names["perTime"] = plain("w", divides=True)
        assumptions = {"turn == 0.0": False, "never": False}
        evaluator = Evaluator(sources, DEVICE_FLOATS, contracts={"signOf": SIGN}, names=names, assumptions=assumptions)
        area = {"type": "BoundedFloat", "value": given("t", normal=True), "error": positive("b")}
        gaps = [difference(f"g{k}", counts=k == i) for k in range(3)]
        face = {"type": "Face", "x": difference("x"), "y": difference("y"), "area": area}
        evaluator.call("beyondUntil", face, gaps, positive("E"), positive("c"), positive("l"))
        n, h, margin, reached = (evaluator.variables[name] for name in ("n", f"h{i}", "margin", "reached"))
        length = total(symbol(f"n{k}") + c.error.without("flushed") for k, c in enumerate(n))
        gap = total(symbol(f"g{i}{axis}") for axis in AXES)
        rules = [Rule(("c", "flushed"), _FLUSHED * Fraction(10001, 10000) * gap)] + EDGES + FLUSHING
        rules += at_most({f"n{k}": c.size for k, c in enumerate(n)})
        behind = h.error + symbol("c") * length
        area = symbol("t") + symbol("b")
        beyond = behind + symbol("l") * area
        yield Inequality(f"height {i} behind the plane", margin.least, behind, [rules])
        yield Inequality(f"height {i} beyond the plane", reached.least, beyond, [rules])
        (per_time,) = evaluator.values["perTime"]
        yield Inequality("area", per_time.least, area * (1 + UNIT) * (1 + DEVICE_FLOATS.division), [without_flushing])


def frame_of(sources, texel, apart, **conditions):
    """What pairFrameOf computes. texel: takes the place of sensorTexel and objectTexel."""
    contracts = {"sensorTexel": texel, "objectTexel": texel, "rowApart": apart}
    contracts |= {"normalised": UNKNOWN, "anchorOf": UNKNOWN}
    return Evaluator(sources, DEVICE_FLOATS, contracts=contracts, **conditions).call("pairFrameOf", *[UNKNOWN] * 4)


def placed_triangle(sources, side, counting):
    """Evaluates pairFrameOf and placedTriangle for a triangle of `side`, of which corner number `counting` counts.

    Inputs, in the sensor's unit of length:
    - e, a placement's error;
    - m00 to m22, the matrix, in two parts;
    - apart0 to apart2, the rows of the anchors' difference: only their last rounding is charged to the margin checked
      here;
    - the frame's axes;
    - q00 to q22, the corners less the anchor: (vertex - origin) perUnit is exact, or flushed.
    What flushing takes from a matrix, a position or a vertex before it is scaled, the placement's error pays for.
    """
    errors, one = Vector([known(symbol("e"), nonnegative=True)] * 4), exactly(1)
    error_texel = sources.value("kTexelError")

    def texel(_, number):
        return errors if number == error_texel else Vector([DIRECTION] * 3 + [one])

    def corner(i):
        numbers = vector(f"q{i}", ROUNDED, given)
        return numbers if i == counting else Vector(replace(n, least=ZERO) for n in numbers)

    names = {f"matrix{side}": matrix("m", IN_PARTS, given), "apart": vector("apart", ROUNDED, given)}
    frame = frame_of(sources, texel, SIGN, names=names)
    contracts = {"triangleAt": UNKNOWN, "vertexAt": UNKNOWN, "normalised": iter(map(corner, range(3)))}
    frame = frame[side.lower()] | {"anchor": Vector(exactly(0) for _ in AXES)}
    placing = Evaluator(sources, DEVICE_FLOATS, contracts=contracts)
    return placing.call("placedTriangle", frame, UNKNOWN)


def flushed_corner(balance):
    """A step: flushing takes a share of a product, far below its rounding; per entry of a matrix, what the placement's
    error has for vertices; or a number, times a corner's distance from the anchor, which is at most 4."""

    def taken(monomial, c):
        left = divided(monomial, ("flushed",))
        if left is None:
            return monomial, c
        kinds = "".join(sorted(s[0] for s in left if s != "flushed"))
        others = [s for s in left if s != "flushed"]
        share = min(c, 0) * DEVICE_FLOATS.flushed ** (len(left) - len(others) + 1)
        if kinds == "m":
            return ("e",), share / OF_VERTICES / DEVICE_FLOATS.flushed
        return ((), share * 4 ** len(others)) if set(kinds) <= {"q"} else (tuple(others), share)

    return Polynomial(taken(m, c) for m, c in balance.terms.items())


def corner_error(sources):
    """A corner's error and its share of a difference's rounding are at most `error`, of which E is twice the sum."""
    for side, i in ((side, i) for side in "AB" for i in range(3)):
        triangle = placed_triangle(sources, side, i)
        for k, value in enumerate(triangle["corners"][i]):
            need = (value.error + value.size * UNIT) * (1 + 3 * UNIT)
            yield Inequality(f"corner {i} of {side}, component {k}", triangle["error"].least, need, [flushed_corner])


def boxes(sources):
    """A comparison of boxes that drops a pair is right, and so is the time between them, since E is twice what the corners' errors need.

    a and b bound coordinates; the errors of corners are at least 23 kUnit of them. Where a pair is dropped, the
    clearance is at most the distance of the boxes.
    """
    for side in "AB":
        triangle = placed_triangle(sources, side, 0)
        for value in triangle["corners"][0]:
            what = f"error of a corner of {side} against a coordinate"
            yield Inequality(what, triangle["error"].least, value.size * 23 * NEAREST, [flushed_corner])

    def triangle_of(size, rest):
        error = rest + size * (23 * NEAREST)
        own = known(error, nonnegative=True, normal=True)
        return {"type": "PlacedTriangle", "error": own, "corners": [Vector([Number(size, error)] * 3)] * 3}

    contracts = {"faceOf": UNKNOWN, "signOf": SIGN, "edgeSeparates": UNKNOWN, "beyondUntil": exactly(0)}
    # As computed, E is exact.
    names = {"error": lambda e: Number(e.size, ZERO, e.least, nonnegative=True, normal=True)}
    assumptions = {"near && !apart": True}
    evaluator = Evaluator(sources, DEVICE_FLOATS, contracts=contracts, names=names, assumptions=assumptions)
    a, b = symbol("a"), symbol("b")
    triangles = triangle_of(a, symbol("A")), triangle_of(b, symbol("B"))
    evaluator.call("meetsFrom", *triangles, positive("c"), positive("l"))
    # Each error is 1e-30 at least.
    least = (symbol("A") + symbol("B")) * (DEVICE_FLOATS.flushed * 10**30)
    rules = at_most({"c": (a + b) * (1 + Fraction(1, 10**6)), "flushed": least})
    for (text, left, right), _ in zip(evaluator.compared, range(6), strict=True):
        yield Inequality(text, evaluator.variables["error"].least, left.error + right.error, [rules])


def error_of_a_row(sources):
    """The error of rowApart but for its last rounding.

    addExactly is taken at its word (by hand): high + low is the sum of what it is given, and products of leading 16
    bits and anchors of 8 bits are exact; in any rounding direction, high + low is off by at most 2^-40 of the distance
    of the anchors and both sizes, and low is at most 2^-20 of that. The distance's part is far below the rounding
    charged to `apart`.

    mA0 to mB2 are a row of the matrices, of whose parts the fine ones are at most 2^-15 and hold them to 2^-40; rA0 to
    rB2 are the greatest normalised coordinates, of which an anchor's are at most twice; PA and PB are the terms of the
    positions. Their fine parts are at most 2^-24 and hold them to 2^-49; in doubles, placing loses 6 2^-53.
    """

    def fine(size, bits, error):
        return Number(size * Fraction(1, 1 << bits), size * error)

    def fine_row(side):
        entries = [fine(symbol(f"m{side}{j}"), 15, Fraction(1, 1 << 40)) for j in range(3)]
        return Vector(entries + [fine(symbol(f"P{side}"), 24, Fraction(1, 1 << 49) + Fraction(6, 1 << 53))])

    def anchor(side):
        return Vector(Number(symbol(f"r{side}{j}") * 2 * (1 + 2 * UNIT)) for j in range(3))

    sizes = total(symbol(f"m{side}{j}") * symbol(f"r{side}{j}") * 2 for side in "AB" for j in range(3))
    names = {"high": exactly(0), "low": fine(sizes, 20, Fraction(1, 1 << 40))}
    evaluator = Evaluator(sources, DEVICE_FLOATS, contracts={"addExactly": iter([UNKNOWN] * 7)}, names=names)
    coarse = Vector([UNKNOWN] * 4)
    return evaluator.call("rowApart", coarse, fine_row("A"), anchor("A"), coarse, fine_row("B"), anchor("B")).error


def positions(sources):
    """The rest of a corner's error is in the placement's own: 2^-44 of S, the terms of a position, 2^-35 of Z, its
    size, and 4e-36 for flushing.

    Turned by a row of the frame, whose components are at most 1 and add up to at most the root of 3.
    """
    host, sources = sources.elsewhere(*HOST), sources.elsewhere(*FILES)
    error = error_of_a_row(sources)
    bound = symbol("S") * host.number("placementOf", "0x1p-44 * sum")
    bound += symbol("Z") * host.number("placementOf", "0x1p-35 * size")
    bound += symbol("flushed") * (host.number("kFlushed", "4e-36") / DEVICE_FLOATS.flushed)
    ones = Vector(map(exactly, (1, 1, 1, 1)))
    texels = {
        sources.value("kTexelError"): Vector([known(bound, nonnegative=True)] + ones[1:]),
        # The slack, which the frame's second row holds, is for something else.
        sources.value("kTexelUpwards"): Vector(map(exactly, (1, 1, 1, 0))),
    }
    frame = frame_of(sources, lambda _, number: texels.get(number, ones), exactly(0))
    for side in "AB":
        # The terms of the rows' sizes add up to Z, whatever the columns: the greatest coefficient counts.
        of_size = max(error.coefficient((f"m{side}{j}", f"r{side}{j}")) for j in range(3))
        need = symbol("Z") * of_size + symbol("S") * error.coefficient((f"P{side}",)) * ROOT_OF_3
        margin = frame[side.lower()]["error"].least
        # Each of 7 calls of addExactly flushes up to 8 numbers, and up to 160 (by hand) flush where the mesh is placed.
        need += FLUSHED * (error.coefficient(("flushed",)) + 7 * 8 + 160) * ROOT_OF_3
        yield Inequality(f"position of {side}", margin - margin.coefficient(()), need)
    expected = {(f"m{side}{j}", f"r{side}{j}") for side in "AB" for j in range(3)} | {("PA",), ("PB",), ("flushed",)}
    if error.terms.keys() - expected:
        raise SourceError(f"the error of rowApart has terms that the claim does not know: {error}")


POSITION = ["0x1p-44 * sum", "0x1p-35 * size", ("kFlushed", "4e-36")]
FLUSHED_CORNER = [("pairFrameOf", text) for text in ("1e-30 + slack", "abs(apart)) + 1e-30")]
EDGE = ["6.0 * kUlp", "1.0001 * (error", "4.0 * kFlushed"]
PLANE = ["12.0 * kUlp", "1.0001 * given", "6.0 + 6.0 * g", "6.0 * g"]
QUOTIENT = ["8.0 * kUlp", "1.0001 + 8.0", "4.0 * kFlushed"]
APART = ["12.0 * kUlp", "1.0001 * error", *PLANE[2:], "16.0 * kUlp", "2.0001 * error", "1.00001 * limit", "1.00001 * (abs"]


def claims():
    edges = difference("x"), difference("y"), positive("E")
    face_of = holds(DEVICE_FLOATS, "faceOf", *edges, steps=[FLUSHING])
    plane_of = holds(DEVICE_FLOATS, "planeOf", difference("g"), *edges, steps=[EDGES + FLUSHING], spare=FLUSHED * SPARE)
    errors = ["1.75 * scale * sensorTexel", "1.75 * scale * objectTexel"]
    return [
        Claim("position in two parts", "placementOf", POSITION, HOST, positions),
        Claim("position in two parts", "pairFrameOf", errors, FILES, positions),
        Claim("distance of the anchors", "pairFrameOf", ["24.0 * kUnit"], FILES, corner_error),
        Claim("corner about its anchor", "placedTriangle", ["24.0 * kUnit", *FLUSHED_CORNER], FILES, corner_error),
        Claim("boxes of a pair", "differenceError", ["2.0 * (a.error"], FILES, boxes),
        Claim("z of x cross y", "faceOf", ["6.0 * kUlp", "1.0001 * given", "4.0 * kFlushed"], FILES, face_of),
        Claim("gap . (x cross y)", "planeOf", PLANE, FILES, plane_of),
        Claim("quotient of bounded numbers", "quotientOf", QUOTIENT, FILES, quotient_of),
        Claim("side of an edge", "edgeSeparates", EDGE, FILES, edge_separates),
        Claim("time beyond a plane", "beyondUntil", APART, FILES, beyond_until),
    ]
