"""The margins of the tests of pairs of nodes, and of boxes of objects, in floats.

Flushing is left out here: 1e-18 is for that, and what is too large or too small is refused (by hand).
"""

from dataclasses import replace
from fractions import Fraction

from claims import Claim, Constant, Inequality, Rule
from evaluator import UNKNOWN, Evaluator, Matrix, Vector
from polynomial import Polynomial
from reader import Sources, number_of
from rounding import DEVICE_FLOATS, ZERO, Number, exactly
from sizes import Kept, plain, symbol, times, total

FILES = ["shaders/shared/two_floats.glsl", "shaders/contact/nodes.glsl", "shaders/contact/node_pair.glsl"]
FLOATS = replace(DEVICE_FLOATS, flushed=Fraction(0))
UNIT, DIVISION, NEAREST = FLOATS.unit, FLOATS.division, Fraction(1, 1 << 24)
# A rounding, relative to its result.
ROUNDED = UNIT / (1 - UNIT)
# The sum of |n_j| is rounded twice, but to no less than the greatest |n_j|. If the others are less than 2^-12 of that,
# |n| is within a quarter of an ulp of it; else the sum is above |n| by more. So this times the sum is no less than |n|,
# as computed.
NORM = (1 - UNIT) ** 2 * (1 + UNIT / 4)
# Where a clearance's part |n| c decides, it is at most the gap at the start and this share of the motion: see
# along_axes.
OF_MOTION = Fraction(1, 400)
# A node's centre and half extent are at most this times the mesh's reach, together.
WITHIN = 1 + Fraction(1, 1 << 22)
ABOUT = 1 + Fraction(1, 1 << 18)


def vector(name, **more):
    return Vector(plain(f"{name}{k}", **more) for k in range(3))


def ones():
    return Vector(exactly(1) for _ in range(3))


def matrix_of(entry):
    return Matrix(Vector(entry(i, j) for i in range(3)) for j in range(3))


def inverse_of_about_1(x):
    """A bound on 1 / x for x from 1 to 1.00003, and affine."""
    return 2 - Fraction(x) + Fraction(1, 10**9)


def exact(name):
    """Takes the place of a vector: what is computed counts from here on."""
    return lambda _: vector(name)


class Pair:
    """Evaluates meshPairOf, in the sensor's unit of length: scale is 1, since scaling by a power of two is exact.

    `own` is the mesh along whose axes nodes are compared, `other` the other one; meshPairOf names by the latter.
    Inputs:
    - nA and nB, the inverse matrices: exact, since any rows will do;
    - mA and mB, the matrices: their two parts are added with one rounding, and hold them to 2^-39;
    - h and l, the differences of the positions' high and low parts: the sensor's are set to 0;
    - reach, residual, e (the placements' errors), size, D (the distance), c (the clearance);
    - the direction, a unit vector of rounded components: 1 stands for their sizes.
    """

    def __init__(self, sources, host, replaced, own):
        self.own, self.other = own, "B" if own == "A" else "A"
        self.sources, self.replaced = sources, replaced
        self.kept = Kept()
        self.evaluator = Evaluator(
            sources,
            FLOATS,
            replaced=replaced,
            assumptions={"p.inRange": True},
            names=self._names(),
            contracts={
                "sensorTexel": self._texels("A", lambda name: Number(ZERO)),
                "objectTexel": self._texels("B", plain),
                "clearanceOf": lambda *_: plain("c", nonnegative=True),
                "awayFromZero": lambda _, v, least: Vector(Number(x.size + y.size) for x, y in zip(v, least)),
            },
        )
        self.values = self.evaluator.call("meshPairOf", UNKNOWN, UNKNOWN)
        self.evaluator.check_used()
        self.matrix = self.values[f"from{self.other}"]
        self.velocity = self.kept["velocity"]
        # Contact that counts is no later than this; `farthest` has been raised.
        raised = sources.literal("meshPairOf", "1.00001 * min")
        most = self.kept["most"].least
        terms = ("apart0", "apart1", "apart2", "sizeA", "sizeB", "c")
        rounding = (1 - UNIT) * min(most.coefficient((term,)) for term in terms)
        self.latest = symbol("f") * inverse_of_about_1(replaced.get(raised, number_of(raised))) * (1 / rounding)
        # A placement's residual, as it is; its float has been raised for the sums here.
        raised = host.literal("setInverse", "1.00001 * (off")
        self.residual = inverse_of_about_1(replaced.get(raised, number_of(raised)))

    def _texels(self, letter, position):
        """Takes the place of sensorTexel or objectTexel."""

        def texel(name, offset=0):
            return self.sources.value(name) + offset

        def row(last):
            return Vector(ones() + [last])

        direction = Number(Polynomial.constant(1), NEAREST + Fraction(1, 1 << 50))
        table = {
            texel("kTexelReach"): Vector(vector(f"reach{letter}", nonnegative=True) + [UNKNOWN]),
            texel("kTexelOrigin"): row(exactly(1)),
            texel("kTexelError"): Vector(
                [plain(f"e{letter}", nonnegative=True), plain(f"size{letter}", nonnegative=True), UNKNOWN, UNKNOWN]
            ),
            texel("kTexelDirection"): Vector([direction] * 3 + [exactly(1)]),
            texel("kTexelCentre"): row(plain("D", nonnegative=True)),
            texel("kTexelMask"): row(exactly(1)),
        }
        for k in range(3):
            table[k] = row(position(f"h{k}"))
            table[texel("kTexelFine", k)] = row(position(f"l{k}"))
            table[texel("kTexelInverse", k)] = row(plain(f"residual{letter}{k}", nonnegative=True))
        return lambda evaluator, index, number: table[number]

    def _names(self):
        own, other, keep = self.own, self.other, self.kept.keep

        def rounded(name):
            return lambda v: Vector(self.evaluator.rounding.named(x, f"{name}{k}") for k, x in enumerate(v))

        def divisor(name):
            return lambda _: Vector(plain(f"{name}{k}", reciprocal=f"1/{name}{k}") for k in range(3))

        def entries(name, error):
            return lambda _: matrix_of(lambda i, j: plain(f"{name}{i}{j}", symbol(f"{name}{i}{j}") * error))

        names = {
            "apart": rounded("apart"),
            "high": exact("high"),
            "low": exact("low"),
            "p.farthest": lambda _: plain("f", nonnegative=True, reciprocal="1/f"),
            "most": keep("most", lambda _: plain("most", nonnegative=True)),
            f"p.velocity{other}": keep("velocity", exact("v")),
            f"least{other}": keep("least"),
            f"way{other}": divisor("way"),
            f"way{own}": divisor("x"),
            f"abs(way{other} - p.velocity{other})": rounded("raised"),
            f"p.inverse{other}": keep("inverse"),
        }
        for letter in "AB":
            names[f"matrix{letter}"] = entries(f"m{letter}", ROUNDED + Fraction(1, 1 << 39))
            names[f"inverse{letter}"] = entries(f"n{letter}", 0)
        return {f"meshPairOf.{name}": then for name, then in names.items()}

    def n(self, k, j):
        return symbol(f"n{self.own}{k}{j}")

    def row(self, k):
        return total(self.n(k, j) for j in range(3))

    def needs(self, k):
        """What a slack along axis k must hold: the residual, half of the placements' errors, the clearance."""
        errors = (symbol("eA") + symbol("eB")) * Fraction(1, 2)
        return symbol(f"residual{self.own}{k}") * self.residual + self.row(k) * (errors + symbol("c") * NORM)

    def rules(self, k):
        """What bounds the names of intermediate results, along axis k."""
        rules = [Rule((f"h{j}",), symbol(f"high{j}") * (1 + 2 * UNIT)) for j in range(3)]
        rules += [Rule((f"l{j}",), symbol(f"low{j}") * (1 + 2 * UNIT)) for j in range(3)]
        rules += [Rule((f"w{k}{j}",), self.matrix[j][k].size) for j in range(3)]
        rules.append(Rule((f"v{k}",), self.velocity[k].size))
        rules.append(Rule((f"raised{k}",), self.kept["least"][k].size * (1 + UNIT)))
        return rules + [Rule(("1/f", "f"), Polynomial.constant(1))]

    def named_matrix(self):
        """The relative matrix, with w for its entries as computed."""
        return matrix_of(lambda i, j: plain(f"w{i}{j}", self.matrix[j][i].error))


def node(letter, **more):
    half = vector(f"half{letter}", nonnegative=True)
    box = {"centre": vector(f"centre{letter}"), "halfExtent": half, "link": UNKNOWN}
    return {"type": "Node", "normal": UNKNOWN, "middle": UNKNOWN, "slab": UNKNOWN} | box | more


def within_reach(letter):
    """For `merged`: a node's box is within the mesh's reach."""
    return {f"{part}{letter}{k}": f"reach{letter}{k}" for part in ("centre", "half") for k in range(3)}


def merged(parts):
    """A step that replaces what a balance lacks in a centre and in a half extent by what the reach must pay for both,
    as their sum is at most the reach. What it has to spare in them is left out. `parts`: the reach for each symbol.
    """

    def merge(balance):
        terms, lacks = {}, {}
        for monomial, c in balance.terms.items():
            part = next((s for s in monomial if s in parts), None)
            if part is None:
                terms[monomial] = terms.get(monomial, 0) + c
            elif c < 0:
                rest = list(monomial)
                rest.remove(part)
                own = lacks.setdefault(tuple(sorted(rest + [parts[part]])), {})
                own[part] = own.get(part, 0) + c
        for monomial, lacking in lacks.items():
            terms[monomial] = terms.get(monomial, 0) + min(lacking.values()) * WITHIN
        return Polynomial(terms)

    return merge


def clearance_paid_by(bound, *factors):
    """A step that replaces what a balance lacks in c |n|, for one n or several with factors, by as much of `bound`.

    factors: the monomials that are added up in |n|.
    """
    monomials = [tuple(sorted(("c",) + factor)) for factor in factors]

    def pay(balance):
        lacks = max(max(-balance.coefficient(m) for m in monomials), Fraction(0))
        return Polynomial({m: x for m, x in balance.terms.items() if m not in monomials}) - bound * lacks

    return pay


def only(polynomial, *symbols):
    return Polynomial({m: c for m, c in polynomial.terms.items() if any(s in symbols for s in m)})


def along_axes(sources, host, replaced):
    """Contact at s, within the farthest distance, is within the interval that approachOf computes along each box axis.

    For own's axis k, with n its row: |gap - s n.v| <= halves + residual + |n| (half of the placements' errors +
    clearance). All is multiplied by the speed `way` that the ends of the interval have been divided by. The inverse's
    error is relative to an end.

    With a clearance c, roundings of up to 2.4e-6 |n| c matter only if the gap at s is within that of |n| c. Then all of
    the distance but a share of 2.2e-3 is along n. If the motion leads towards each other along n, |n| c is at most the
    gap at the start. If it leads apart, it must approach across n, so n.v is at most 2.2e-3 |n|: then |n| c is at most
    the gap at the start and 2.2e-3 |n| s.
    """
    inequalities = []
    for own in "AB":
        pair = Pair(sources, host, replaced, own)
        other, kept = pair.other, Kept()
        # The inverse's error is charged below. Along the axes that are not looked at, anything.
        values = pair.values | {
            f"from{other}": pair.named_matrix(),
            f"inverse{other}": Vector(Number(symbol(f"1/way{k}"), ZERO, symbol(f"1/way{k}")) for k in range(3)),
            f"from{own}": Matrix([ones()] * 3),
            f"offset{own}": ones(),
            f"inverse{own}": ones(),
            f"slack{own}": ones(),
        }
        evaluator = Evaluator(
            sources,
            FLOATS,
            replaced=replaced,
            contracts={"addNormalSlab": lambda *_: None},
            assumptions={"meets": True},
            names={
                f"approachOf.gap{other}": kept.keep("gap", exact("gap")),
                # As products with the speed.
                f"approachOf.middle{other}": kept.keep("middle", exact("middle")),
                f"approachOf.reach{other}": kept.keep("reach", exact("extent")),
                "approachOf.enter": kept.keep("enter"),
                "approachOf.leave": kept.keep("leave"),
            },
        )
        evaluator.call("approachOf", values, node("A"), node("B"), UNKNOWN)
        evaluator.check_used()
        inequalities += [along_axis(pair, kept, k) for k in range(3)]
    return inequalities


def along_axis(pair, kept, k):
    own, other, f = pair.own, pair.other, symbol("f")
    middle, reach = (times(kept[name][k], f"way{k}") for name in ("middle", "reach"))
    halves = symbol(f"half{own}{k}") + total(
        (symbol(f"w{k}{j}") + pair.matrix[j][k].error) * symbol(f"half{other}{j}") for j in range(3)
    )
    division = (symbol(f"v{k}") + symbol(f"raised{k}")) * DIVISION
    ends = only(kept["enter"].error + kept["leave"].error, f"middle{k}", f"extent{k}") * Fraction(1, 2)
    need = halves + pair.needs(k) + kept["gap"][k].error + middle.error + ends
    need += pair.latest * (pair.velocity[k].error + symbol(f"raised{k}") + division)
    terms = total(
        pair.n(k, i)
        * (total(symbol(f"m{other}{i}{j}") * symbol(f"reach{other}{j}") for j in range(3)) + symbol(f"apart{i}"))
        for i in range(3)
    )
    start = symbol(f"reach{own}{k}") + terms
    clearance = (start + pair.row(k) * f * OF_MOTION) * ABOUT
    ends = [
        Rule((f"middle{k}",), middle.size),
        Rule((f"extent{k}",), reach.size),
        Rule((f"gap{k}",), kept["gap"][k].size),
    ]
    return Inequality(
        f"axis {k} of {own}",
        reach.least,
        need,
        [
            ends,
            pair.rules(k),
            clearance_paid_by(clearance, *((f"n{own}{k}{j}",) for j in range(3))),
            merged(within_reach("A") | within_reach("B")),
        ],
    )


def along_normals(sources, host, replaced):
    """Contact at s, within the farthest distance, is within the interval that addNormalSlab computes.

    Along own's normal g, with n = g fromOther, any a = `along` and r = n - a o, for the other's normal o: |between + a
    mu + r.centre - s g.v| <= own's slab + |a| h + |r| halves + sum |g_k| (what along_axes has for axis k), mu and h
    being the other's slab. The middle and half width of own's slab are at most |g| reach together. Clearances are as
    along axes.
    """
    return [along_normal(Pair(sources, host, replaced, own), negative) for own in "AB" for negative in (False, True)]


def along_normal(pair, negative):
    own, other, kept = pair.own, pair.other, Kept()

    def named_rest(values):
        # Products with `along` are bounded by a rule; what the difference loses is relative to the rest.
        return Vector(evaluator.rounding.named(x, f"r{j}") for j, x in enumerate(values))

    evaluator = Evaluator(
        pair.sources,
        FLOATS,
        replaced=pair.replaced,
        assumptions={"way < 0.0": negative},
        names={
            "addNormalSlab.along": lambda _: plain("a"),
            "addNormalSlab.rest": lambda values: kept.setdefault("rest", named_rest(values)),
            "addNormalSlab.way": kept.keep("way", lambda _: plain("way")),
            "addNormalSlab.held": lambda _: plain("held", reciprocal="1/held"),
            "addNormalSlab.abs(held - way)": lambda value: evaluator.rounding.named(value, "raised"),
            "addNormalSlab.gap": kept.keep("gap", lambda _: plain("gap")),
            "addNormalSlab.reach": kept.keep("reach", lambda _: plain("extent", nonnegative=True)),
            # Its error is charged below.
            "addNormalSlab.inverse": lambda _: Number(symbol("1/held"), ZERO, symbol("1/held")),
        },
    )
    own_node = node(own, normal=vector("g"), middle=plain("own middle"), slab=plain("own slab", nonnegative=True))
    other_node = node(other, normal=vector("o"), middle=plain("mu"), slab=plain("h", nonnegative=True))
    velocity = Vector(plain(f"v{k}", v.error) for k, v in enumerate(pair.velocity))
    _, scope = evaluator.run(
        pair.sources.function("addNormalSlab"),
        [
            exactly(0),
            exactly(0),
            own_node,
            other_node,
            pair.named_matrix(),
            pair.values[f"offset{other}"],
            velocity,
            pair.values[f"slack{other}"],
            plain("least", nonnegative=True),
            plain("f", nonnegative=True),
        ],
    )
    evaluator.check_used()

    f, gap, way, raised = map(symbol, ("f", "gap", "way", "raised"))
    g = [symbol(f"g{k}") for k in range(3)]
    r = [symbol(f"r{j}") for j in range(3)]
    halves, centres = ([symbol(f"{part}{other}{j}") for j in range(3)] for part in ("half", "centre"))
    slabs = symbol("own slab") + symbol("a") * symbol("h")
    # What the inverse and the last sum are off by is relative to an end of the interval, s |way|: at most f |way|, and
    # at most gap + extent. The last sum's is in the ends' errors; two fifths of both are charged to the motion instead.
    motion = Fraction(2, 5)
    by_motion, by_gap = (DIVISION + UNIT) * motion, DIVISION * (1 - motion) - UNIT * motion
    need = slabs + total((r[j] + kept["rest"][j].error) * halves[j] for j in range(3))
    need += total(g[k] * pair.needs(k) for k in range(3)) + kept["gap"].error
    need += pair.latest * (kept["way"].error + raised + (way + raised) * by_motion) + (gap + symbol("extent")) * by_gap
    need += (times(scope["enter"], "held").error + times(scope["leave"], "held").error) * Fraction(1, 2)

    reaches = total(g[k] * symbol(f"reach{own}{k}") for k in range(3)) * WITHIN
    bounds = [Rule(("own reach",), reaches)] + [rule for k in range(3) for rule in pair.rules(k)]
    for j in range(3):
        n = total(g[k] * symbol(f"w{k}{j}") for k in range(3)) * (1 + 4 * UNIT)
        bounds.append(Rule(("a", f"o{j}"), n + r[j] * (1 + 2 * UNIT)))
    start = symbol("own middle") + slabs + symbol("a") * symbol("mu")
    start += total(r[j] * (centres[j] + halves[j]) for j in range(3))
    start += total(g[k] * pair.n(k, i) * symbol(f"apart{i}") for k in range(3) for i in range(3))
    clearance = (start + total(g[k] * pair.row(k) for k in range(3)) * f * OF_MOTION) * ABOUT
    factors = [(f"g{k}", f"n{own}{k}{j}") for k in range(3) for j in range(3)]
    ends = [Rule(("extent",), kept["reach"].size), Rule(("gap",), kept["gap"].size), Rule(("way",), kept["way"].size)]
    return Inequality(
        f"normal of {own}" + (", away" if negative else ""),
        kept["reach"].least,
        need,
        [
            ends,
            clearance_paid_by(clearance, *factors),
            merged({"own middle": "own reach", "own slab": "own reach"}),
            bounds,
            merged(within_reach(other)),
        ],
    )


def boxes_of_objects(sources, host, replaced):
    """The sensor's box at s meets an object's only within the interval that meetsBox computes, along each axis of the
    world.

    |gap - s d| <= halves. The direction d is rounded to nearest; its inverse is off by a division's rounding. Both are
    relative to s d, which is at most gap + reach. The boxes hold what rounding them, and raising d, takes
    (contact/sensors.cpp; by hand).
    """
    kept = Kept()
    box = {
        "type": "SensorBox",
        "centre": vector("centre"),
        "halfExtent": vector("half", nonnegative=True),
        "inverseDirection": Vector(Number(symbol(f"1/d{k}"), ZERO, symbol(f"1/d{k}")) for k in range(3)),
    }
    evaluator = Evaluator(
        sources,
        FLOATS,
        replaced=replaced,
        names={
            "meetsBox.gap": kept.keep(
                "gap", lambda v: Vector(evaluator.rounding.named(x, f"gap{k}") for k, x in enumerate(v))
            ),
            "meetsBox.at": kept.keep("at", exact("at")),
            "meetsBox.reach": kept.keep("reach", exact("extent")),
        },
    )
    middle = Vector(vector("middle") + [UNKNOWN])
    ends = evaluator.call("meetsBox", box, middle, Vector(vector("size", nonnegative=True) + [UNKNOWN]))
    evaluator.check_used()
    inequalities = []
    for k in range(3):
        at, reach = (times(kept[name][k], f"d{k}") for name in ("at", "reach"))
        relative = (NEAREST + Fraction(1, 1 << 50) + DIVISION) * (1 + 4 * UNIT)
        need = symbol(f"size{k}") + symbol(f"half{k}") + at.error + (symbol(f"gap{k}") + reach.size) * relative
        need += only((ends[0].error + ends[1].error) * Fraction(1, 2), f"at{k}", f"extent{k}")
        rules = [Rule((f"at{k}",), at.size), Rule((f"extent{k}",), reach.size)]
        inequalities.append(Inequality(f"axis {k} of the world", reach.least, need, [rules]))
    return inequalities


def claims(root):
    sources, host = Sources(root, FILES), Sources(root, ["engine/scene/placement.cpp"])

    def claim(name, function, constants, statement, where=sources):
        owned = [Constant(function, text) for text in constants]
        return Claim(name, function, owned, where, lambda replaced: statement(sources, host, replaced))

    spans = ["64.0 * kUnit * spanB", "64.0 * kUnit * spanA"]
    motion = ["16.0 * kUnit * p.farthest * sumB", "16.0 * kUnit * p.farthest * sumA"]
    return [
        claim("axes of boxes", "meshPairOf", spans + motion + ["4.0 * kUnit * by", "1.00001 * min"], along_axes),
        claim("axes of boxes", "setInverse", ["1.00001 * (off"], along_axes, host),
        claim("axes of normals", "meshPairOf", spans + motion, along_normals),
        claim("axes of normals", "addNormalSlab", ["64.0 * kUnit * added"], along_normals),
        claim("boxes of objects", "meetsBox", ["1.00001 + 1e-6", "1e-6 * abs"], boxes_of_objects),
    ]
