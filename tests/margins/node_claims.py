"""The margins of the tests of pairs of nodes, and of boxes of objects, in floats."""
import math
import re
from dataclasses import replace
from fractions import Fraction

from claims import Claim, Inequality, Shared, at_most
from evaluator import UNKNOWN, Evaluator, Matrix, Vector
from polynomial import Polynomial, divided, summed, total
from rounding import DEVICE_FLOATS, FLUSHED, ZERO, Number, Rounding, exactly, given, plain, symbol
from sizes import WITHIN, matrix, mean_error, positive, symbols, together, vector, within
from triangle_claims import DIRECTION, HOST, IN_PARTS, OF_VERTICES, PLACED, UNIT

FILES = ["shaders/shared/two_floats.glsl", "shaders/contact/nodes.glsl", "shaders/contact/node_pair.glsl"]
DIVISION = DEVICE_FLOATS.division
# The sum of |n_j| is rounded twice, but to no less than the greatest |n_j|. If the others are less than 2^-12 of that,
# |n| is within a quarter of an ulp of it; else the sum is above |n| by more. So this times the sum is no less than |n|,
# as computed.
NORM = (1 - UNIT) ** 2 * (1 + UNIT / 4)
# Where a clearance's part |n| c decides, it is at most the gap at the start and this share of the motion: see
# along_axes.
OF_MOTION = Fraction(1, 400)
ABOUT = 1 + Fraction(1, 1 << 18)
ONES = Vector([exactly(1)] * 3)
# In the sensor's unit of length, symbols that begin with these letters are at most this (docs/method.md, section 6).
# 1/f is at most 2^20, since `farthest` is raised to 2^-20.
_MOST = {
    **dict.fromkeys(("n", "m", "apart", "high", "low", "size", "f"), 1001 * 10**9),
    **dict.fromkeys(("e", "c"), 10**9),
    **dict.fromkeys(("w", "r", "a"), 10**25),
    **dict.fromkeys(("reach", "centre", "half", "g", "o", "d"), 2),
    **dict.fromkeys(("own_middle", "own_slab", "mu", "h"), 8),
    "D": 1 << 42,
    "1/f": 1 << 20,
    "flushed": DEVICE_FLOATS.flushed,
}
# Of a row of an inverse, what flushes to 0 when it is scaled: below 2^-126 in the world, where matrices are at most
# 2^80, times a reach of 2, for three columns.
_OF_ROW = Polynomial.constant(DEVICE_FLOATS.flushed * (1 << 80) * 6)


def flushing(balance):
    """A step: what flushing takes, as numbers; the residual pays for its own share."""

    def as_number(monomial, c):
        left = divided(monomial, ("flushed",))
        if left is None:
            return monomial, c
        kept = [s for s in left if s.startswith("residual")]
        kept += [s for s in left if kept and re.match("g[012]", s)]
        most = math.prod(_MOST[re.match("1/f$|[a-z_]+", s)[0]] for s in divided(left, kept))
        return tuple(sorted(kept)), min(c, 0) * DEVICE_FLOATS.flushed * most

    return Polynomial(as_number(m, c) for m, c in balance.terms.items())


def inverse_of_about_1(x):
    """A bound on 1 / x for x from 1 to 1.00003, and affine."""
    return 2 - x + Fraction(1, 10**9)


def of_raised(name):
    """What flushing takes, times what a velocity is raised by: a share of f times that, since f is at least 2^-20."""
    return symbol(name) * symbol("f") * (DEVICE_FLOATS.flushed * (1 << 20))


class Pair:
    """Evaluates meshPairOf, in the sensor's unit of length: scale is 1, since scaling by a power of two is exact.

    `own` is the mesh along whose axes nodes are compared, `other` the other one; meshPairOf names by the latter.
    Inputs:
    - nA and nB, the inverse matrices: exact, since any rows will do;
    - mA and mB, the matrices, in two parts;
    - h and l, the differences of the positions' high and low parts: the sensor's are set to 0;
    - reach, residual, e (the placements' errors), size, D (the distance), c (the clearance);
    - the direction.
    """

    def __init__(self, sources, own):
        host, self.sources = sources.elsewhere(*HOST), sources.elsewhere(*FILES)
        self.own, self.other = own, "B" if own == "A" else "A"
        contracts = {
            "sensorTexel": self._texels("A", lambda name: Number(ZERO)),
            "objectTexel": self._texels("B", plain),
            "clearanceOf": positive("c"),
            "awayFromZero": lambda v, least: Vector(Number(x.size + y.size) for x, y in zip(v, least)),
        }
        conditions = {"contracts": contracts, "assumptions": {"p.inRange": True}}
        evaluator = Evaluator(self.sources, DEVICE_FLOATS, names=self._names(), **conditions)
        self.values = evaluator.call("meshPairOf", UNKNOWN, UNKNOWN)
        self.matrix, self.least = self.values[f"from{self.other}"], evaluator.variables[f"least{self.other}"]
        (self.velocity,) = evaluator.values[f"p.velocity{self.other}"]
        (most,) = evaluator.values["most"]
        # Contact that counts is no later than this; `farthest` has been raised.
        terms = ("apart0", "apart1", "apart2", "sizeA", "sizeB", "c")
        rounding = (1 - UNIT) * min(most.least.coefficient((term,)) for term in terms)
        raised = self.sources.number("meshPairOf", "1.00001 * min")
        self.latest = symbol("f") * inverse_of_about_1(raised) * (1 / rounding)
        # A placement's residual, as it is; its float has been raised for the sums here.
        self.residual = inverse_of_about_1(host.number("setInverse", "1.00001 * (off"))

    def _texels(self, letter, position):
        """Takes the place of sensorTexel or objectTexel."""

        def texel(name, offset=0):
            return self.sources.value(name) + offset

        def row(last):
            return Vector(ONES + [last])

        errors = positive(f"e{letter}"), positive(f"size{letter}")
        table = {
            texel("kTexelReach"): Vector(vector(f"reach{letter}", make=given, nonnegative=True) + [UNKNOWN]),
            texel("kTexelOrigin"): row(exactly(1)),
            texel("kTexelError"): Vector([*errors, UNKNOWN, UNKNOWN]),
            texel("kTexelDirection"): Vector([DIRECTION] * 3 + [exactly(1)]),
            texel("kTexelCentre"): row(positive("D")),
            texel("kTexelMask"): row(exactly(1)),
        }
        for k in range(3):
            table[k] = row(position(f"h{k}"))
            table[texel("kTexelFine", k)] = row(position(f"l{k}"))
            table[texel("kTexelInverse", k)] = row(given(f"residual{letter}{k}", nonnegative=True))
        return lambda index, number: table[number]

    def _names(self):
        own, other = self.own, self.other
        names = {
            "apart": self._apart,
            "high": vector("high"),
            "low": vector("low"),
            "p.farthest": positive("f", divides=True),
            "most": positive("most"),
            f"p.velocity{other}": vector("v"),
            f"way{other}": vector("way", divides=True),
            f"way{own}": vector("x", divides=True),
            f"abs(way{other} - p.velocity{other})": "raised",
        }
        for letter in "AB":
            names[f"matrix{letter}"] = matrix(f"m{letter}", IN_PARTS, given)
            names[f"inverse{letter}"] = matrix(f"n{letter}", 0, given)
        return names

    @staticmethod
    def _apart(value):
        """The difference of the positions, named. What flushes before it is scaled is in the placements' errors."""
        named = (Rounding(DEVICE_FLOATS).named(x, f"apart{k}") for k, x in enumerate(value))
        return Vector(replace(x, error=x.error.without("flushed") + FLUSHED) for x in named)

    def row(self, k):
        return summed("n{own}{k}{j}", own=self.own, k=k)

    def needs(self, k):
        """What a slack along axis k must hold: the residual, half of the placements' errors and what flushing takes
        from vertices, the clearance."""
        errors = (symbol("eA") + symbol("eB")) * (Fraction(1, 2) + 2 / OF_VERTICES)
        rows = self.row(k) * (errors + symbol("c") * NORM)
        return symbol(f"residual{self.own}{k}") * self.residual + rows + _OF_ROW

    def rules(self, k):
        """What bounds the names of intermediate results, along axis k."""
        bounds = {f"h{j}": symbol(f"high{j}") * (1 + 2 * UNIT) for j in range(3)}
        bounds |= {f"l{j}": symbol(f"low{j}") * (1 + 2 * UNIT) for j in range(3)}
        bounds |= {f"w{k}{j}": self.matrix[j][k].size for j in range(3)}
        bounds |= {f"v{k}": self.velocity[k].size, f"raised{k}": self.least[k].size * (1 + UNIT)}
        bounds |= {("flushed", f"way{k}"): FLUSHED * self.velocity[k].size + of_raised(f"raised{k}")}
        return at_most(bounds)

    def named_matrix(self):
        """The relative matrix, with w for its entries as computed."""
        return Matrix(Vector(plain(f"w{i}{j}", self.matrix[j][i].error) for i in range(3)) for j in range(3))

    def clearance_paid(self, start, normal):
        """A step: the clearance's part |n| c, with n the sum of the rows times `normal`, is at most `start`, the gap at
        the start, and a share of the motion."""
        parts = [("c", *normal[k], f"n{self.own}{k}{j}") for k in normal for j in range(3)]
        across = total(Polynomial([(normal[k], 1)]) * self.row(k) for k in normal)
        return Shared(parts, (start + across * symbol("f") * OF_MOTION) * ABOUT)


def node(letter, **more):
    half = vector(f"half{letter}", make=given, nonnegative=True)
    box = {"centre": vector(f"centre{letter}", make=given), "halfExtent": half, "link": UNKNOWN}
    return {"type": "Node", "normal": UNKNOWN, "middle": UNKNOWN, "slab": UNKNOWN} | box | more


def of_ends(one, other, *symbols):
    """What both ends of an interval are off by on average, in terms with one of the symbols."""
    terms = mean_error(one, other).terms
    return Polynomial((m, c) for m, c in terms.items() if any(s in symbols for s in m))


def along_axes(sources):
    """Contact at s, within the farthest distance, is within the interval that approachOf computes along each box axis.

    For own's axis k, with n its row: |gap - s n.v| <= halves + residual + |n| (half of the placements' errors +
    clearance). All is multiplied by the speed `way` that the ends of the interval have been divided by. The inverse's
    error is relative to an end.

    With a clearance c, roundings of up to 2.4e-6 |n| c matter only if the gap at s is within that of |n| c. Then all of
    the distance but a share of 2.2e-3 is along n. If the motion leads towards each other along n, |n| c is at most the
    gap at the start. If it leads apart, it must approach across n, so n.v is at most 2.2e-3 |n|: then |n| c is at most
    the gap at the start and 2.2e-3 |n| s.
    """
    for pair in (Pair(sources, own) for own in "AB"):
        own, other = pair.own, pair.other
        # The inverse's error is charged below. Along the axes that are not looked at, anything.
        values = pair.values | {
            f"from{other}": pair.named_matrix(),
            f"inverse{other}": vector("1/way"),
            f"from{own}": Matrix([ONES] * 3),
            f"offset{own}": ONES,
            f"inverse{own}": ONES,
            f"slack{own}": ONES,
        }
        # Middle and reach are products with the speed.
        names = {f"gap{other}": vector("gap"), f"middle{other}": vector("middle"), f"reach{other}": vector("extent")}
        conditions = {"contracts": {"addNormalSlab": UNKNOWN}, "assumptions": {"meets": True}}
        evaluator = Evaluator(pair.sources, DEVICE_FLOATS, names=names, **conditions)
        evaluator.call("approachOf", values, node("A"), node("B"), UNKNOWN)
        kept = [evaluator.values[name][0] for name in names]
        ends = evaluator.variables["enter"], evaluator.variables["leave"]
        yield from (along_axis(pair, k, *(vectors[k] for vectors in kept), ends) for k in range(3))


def along_axis(pair, k, gap, middle, reach, ends):
    own, other = pair.own, pair.other
    middle, reach = (number.times(symbol(f"way{k}")) for number in (middle, reach))
    halves = symbol(f"half{own}{k}") + total(
        (symbol(f"w{k}{j}") + pair.matrix[j][k].error) * symbol(f"half{other}{j}") for j in range(3)
    )
    division = (symbol(f"v{k}") + symbol(f"raised{k}")) * DIVISION
    need = halves + pair.needs(k) + gap.error + middle.error + of_ends(*ends, f"middle{k}", f"extent{k}")
    need += pair.latest * (pair.velocity[k].error + symbol(f"raised{k}") + division)
    start = symbol(f"reach{own}{k}") + summed("n{own}{k}{i} apart{i}", own=own, k=k)
    start += summed("n{own}{k}{i} m{other}{i}{j} reach{other}{j}", own=own, other=other, k=k)
    steps = [
        at_most({f"middle{k}": middle.size, f"extent{k}": reach.size, f"gap{k}": gap.size}),
        pair.rules(k),
        pair.clearance_paid(start, {k: ()}),
        *within("A", symbols("reachA")),
        *within("B", symbols("reachB")),
        flushing,
    ]
    return Inequality(f"axis {k} of {own}", reach.least, need, steps)


def along_normals(sources):
    """Contact at s, within the farthest distance, is within the interval that addNormalSlab computes.

    Along own's normal g, with n = g fromOther, any a = `along` and r = n - a o, for the other's normal o: |between + a
    mu + r.centre - s g.v| <= own's slab + |a| h + |r| halves + sum |g_k| (what along_axes has for axis k), mu and h
    being the other's slab. The middle and half width of own's slab are at most |g| reach together. Clearances are as
    along axes.
    """
    return [along_normal(Pair(sources, own), negative) for own in "AB" for negative in (False, True)]


def along_unit(balance, normal):
    """What a balance lacks as a number, times a unit vector's components, which are 1 or more together."""
    number = balance.coefficient(())
    return balance - number + total(normal) * min(number, 0) * Fraction(101, 100)


def along_normal(pair, negative):
    own, other = pair.own, pair.other
    names = {
        "along": plain("a"),
        # Products with `along` are bounded by a rule; what the difference loses is relative to the rest.
        "rest": "r",
        "way": plain("way"),
        "held": plain("held", divides=True),
        "abs(held - way)": "raised",
        "gap": plain("gap"),
        "reach": positive("extent"),
        # Its error is charged below.
        "inverse": plain("1/held"),
    }
    evaluator = Evaluator(pair.sources, DEVICE_FLOATS, names=names, assumptions={"way < 0.0": negative})
    own_node = node(own, normal=vector("g"), middle=given("own_middle"), slab=given("own_slab", nonnegative=True))
    other_node = node(other, normal=vector("o"), middle=given("mu"), slab=given("h", nonnegative=True))
    velocity = Vector(plain(f"v{k}", v.error) for k, v in enumerate(pair.velocity))
    offset, slack = pair.values[f"offset{other}"], pair.values[f"slack{other}"]
    side = {"type": "Side", "node": own_node, "fromOther": pair.named_matrix(), "least": positive("least")}
    side |= {"offset": offset, "velocity": velocity, "slack": slack}
    evaluator.call("addNormalSlab", exactly(0), exactly(0), side, other_node, positive("f"))
    kept = {name: evaluator.values[name][0] for name in ("way", "gap", "reach")}
    rest, *ends = (evaluator.variables[name] for name in ("rest", "enter", "leave"))

    gap, way, raised = map(symbol, ("gap", "way", "raised"))
    g, r, halves = map(symbols, ("g", "r", f"half{other}"))
    slabs = symbol("own_slab") + summed("a h")
    # What the inverse and the last sum are off by is relative to an end of the interval, s |way|: at most f |way|, and
    # at most gap + extent. The last sum's is in the ends' errors; two fifths of both are charged to the motion instead.
    motion = Fraction(2, 5)
    by_motion, by_gap = (DIVISION + UNIT) * motion, DIVISION * (1 - motion) - UNIT * motion
    need = slabs + total((r[j] + rest[j].error) * halves[j] for j in range(3))
    need += total(g[k] * pair.needs(k) for k in range(3)) + kept["gap"].error
    need += pair.latest * (kept["way"].error + raised + (way + raised) * by_motion) + (gap + symbol("extent")) * by_gap
    need += mean_error(*ends) * symbol("held")

    reaches = summed("g{k} reach{own}{k}", own=own) * WITHIN
    n = [summed("g{k} w{k}{j}", j=j) * (1 + 4 * UNIT) for j in range(3)]
    velocities = at_most({("flushed", "held"): FLUSHED * way + of_raised("raised")})
    along = {("a", f"o{j}"): n[j] + r[j] * (1 + 2 * UNIT) for j in range(3)}
    start = symbol("own_middle") + slabs + summed("a mu") + summed("g{k} n{own}{k}{i} apart{i}", own=own)
    start += summed("r{j} centre{other}{j}", other=other) + summed("r{j} half{other}{j}", other=other)
    steps = [
        velocities + at_most({"extent": kept["reach"].size, "gap": kept["gap"].size, "way": kept["way"].size}),
        pair.clearance_paid(start, {k: (f"g{k}",) for k in range(3)}),
        together("own_middle", "own_slab", reaches),
        [rule for k in range(3) for rule in pair.rules(k)] + at_most(along),
        *within(other, symbols(f"reach{other}")),
        flushing,
        lambda balance: along_unit(balance, g),
    ]
    return Inequality(f"normal of {own}" + (", away" if negative else ""), kept["reach"].least, need, steps)


def boxes_of_objects(sources):
    """The sensor's box at s meets an object's only within the interval that meetsBox computes, along each axis of the
    world.

    |gap - s d| <= halves. The direction d is rounded to nearest; its inverse is off by a division's rounding. Both are
    relative to s d, which is at most gap + reach. The boxes hold what rounding them, and raising d, takes
    (contact/encode.comp.glsl; by hand), and have `flushed` to spare (boxOf), of which this may take half.
    """
    half, inverse = vector("half", nonnegative=True), vector("1/d")
    centre, room = vector("centre", make=given), sources.elsewhere(*PLACED).number("boxOf", "1e-36")
    sources = sources.elsewhere(*FILES)
    box = {"type": "SensorBox", "centre": centre, "halfExtent": half, "inverseDirection": inverse}
    names = {"gap": "gap", "at": vector("at"), "reach": vector("extent")}
    evaluator = Evaluator(sources, DEVICE_FLOATS, names=names)
    middle = Vector(vector("middle", make=given) + [UNKNOWN])
    size = Vector(vector("size", make=given, nonnegative=True) + [UNKNOWN])
    ends = evaluator.call("meetsBox", box, middle, size)
    for k in range(3):
        at, reach = (evaluator.values[name][0][k].times(symbol(f"d{k}")) for name in ("at", "reach"))
        relative = (DIRECTION.error.without("flushed") + DIVISION) * (1 + 4 * UNIT)
        need = symbol(f"size{k}") + symbol(f"half{k}") - room * Fraction(1, 2) + at.error
        need += (symbol(f"gap{k}") + reach.size) * relative
        need += of_ends(*ends, f"at{k}", f"extent{k}")
        rules = at_most({f"at{k}": at.size, f"extent{k}": reach.size})
        yield Inequality(f"axis {k} of the world", reach.least, need, [rules, flushing])


def claims():
    spans = ["64.0 * kUnit * spanB", "64.0 * kUnit * spanA"]
    motion = ["16.0 * kUnit * p.farthest * sumB", "16.0 * kUnit * p.farthest * sumA"]
    rest = ["4.0 * kUnit * by", "1.00001 * min"]
    flushed = ["sumB + 1e-11", "sumA + 1e-11"]
    return [
        Claim("axes of boxes", "meshPairOf", spans + motion + rest, FILES, along_axes),
        Claim("axes of boxes", "setInverse", ["1.00001 * (off"], HOST, along_axes),
        Claim("axes of normals", "meshPairOf", spans + motion + flushed, FILES, along_normals),
        Claim("axes of normals", "addNormalSlab", ["64.0 * kUnit * added"], FILES, along_normals),
        Claim("boxes of objects", "meetsBox", ["1.00001 + 1e-6", "1e-6 * abs"], FILES, boxes_of_objects),
        Claim("boxes of objects", "boxOf", ["1e-36"], PLACED, boxes_of_objects),
    ]
