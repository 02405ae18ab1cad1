"""The margins of the CPU's tests, read from their C++.

The CPU rounds to nearest, in the order that is written, and keeps subnormal numbers.
"""

from dataclasses import replace
from fractions import Fraction

from claims import Claim, Constant, Inequality, Rule
from evaluator import UNKNOWN, Evaluator, Vector
from node_claims import merged
from polynomial import Polynomial
from reader import SourceError, Sources
from rounding import CPU_DOUBLES, CPU_FLOATS, ZERO, Number, Rounding, exactly
from sizes import Kept, plain, symbol, times, total, without_flushing

UNIT = CPU_DOUBLES.unit
# A difference of exact numbers, relative to itself.
DIFFERENCE = UNIT / (1 - UNIT)


def vector(name, error=0, **more):
    return Vector(plain(f"{name}{k}", symbol(f"{name}{k}") * error, **more) for k in range(3))


def ordered(arithmetic):
    """The arithmetic with sums in the order that is written."""
    return replace(arithmetic, ordered=True)


def without_underflow(arithmetic):
    """The arithmetic in the order that is written, for numbers that are 0 or far from underflow."""
    return replace(arithmetic, ordered=True, flushed=Fraction(0))


def underflow(arithmetic):
    """A step: what underflow takes is a number."""
    return [Rule(("flushed",), Polynomial.constant(arithmetic.flushed))]


# ---- determinants ----------------------------------------------------------------------------------------------------


def estimate(sources, replaced):
    """A determinant of rounded differences. Underflow takes something from products, which are multiplied by w."""
    evaluator = Evaluator(sources, ordered(CPU_DOUBLES), replaced=replaced)
    w = vector("w", DIFFERENCE)
    floor = evaluator.call("underflowOf", w)
    value, error = evaluator.call("estimate", w, vector("x", DIFFERENCE), vector("y", DIFFERENCE), floor)
    return [Inequality("error of a determinant", error.least, value.error, [underflow(CPU_DOUBLES)])]


CROSS = "kRelative * (std::abs(p) + std::abs(q)) + kUnderflow"


def cross_sign(sources, replaced):
    evaluator = Evaluator(sources, ordered(CPU_DOUBLES), replaced=replaced)
    p, q = (
        evaluator.rounding.multiply(x, y)
        for x, y in (
            (plain("v1", symbol("v1") * DIFFERENCE), plain("w2", symbol("w2") * DIFFERENCE)),
            (plain("v2", symbol("v2") * DIFFERENCE), plain("w1", symbol("w1") * DIFFERENCE)),
        )
    )
    scope = {"function": "crossSign", "p": p, "q": q}
    value = evaluator.evaluate(sources.expression("crossSign", "std::abs(p - q)"), scope)
    margin = evaluator.settled(evaluator.evaluate(sources.expression("crossSign", CROSS), scope))
    return [Inequality("error of a component", margin.least, evaluator.settled(value).error, [underflow(CPU_DOUBLES)])]


BEYOND = "2.125 * slack * (largest(x) * largest(y))"


def side_beyond(sources, replaced):
    """No component of x cross y exceeds twice the product of their largest; x and y are rounded differences."""
    largest = {"x": plain("x", nonnegative=True), "y": plain("y", nonnegative=True)}
    evaluator = Evaluator(
        sources, ordered(CPU_DOUBLES), replaced=replaced, contracts={"largest": lambda e, v: largest[v]}
    )
    scope = {"function": "sideBeyond", "slack": plain("slack", nonnegative=True), "x": "x", "y": "y"}
    margin = evaluator.evaluate(sources.expression("sideBeyond", BEYOND), scope)
    need = 2 * (1 + DIFFERENCE) ** 2 * (1 + 2 * UNIT) * symbol("x") * symbol("y") * symbol("slack")
    return [Inequality("side beyond a slack", margin.least, need, [without_flushing])]


def bounded(name):
    return {"value_": plain(name, symbol(f"{name} error")), "error_": plain(f"{name} error", nonnegative=True)}


def bounded_operations(sources, replaced):
    """Sums, products, differences of products and inner products of numbers with bounds; nothing underflows."""
    evaluator = Evaluator(sources, ordered(CPU_DOUBLES), replaced=replaced)
    numbers = {name: bounded(name) for name in "pqrs"}
    vectors = {name: [bounded(f"{name}{k}") for k in range(3)] for name in "pq"}
    value = {name: n["value_"] for name, n in numbers.items()}
    error = {name: n["error_"] for name, n in numbers.items()}
    rounding = evaluator.rounding
    product, other = rounding.multiply(value["p"], value["q"]), rounding.multiply(value["r"], value["s"])
    parts = {
        axis: rounding.multiply(vectors["p"][k]["value_"], vectors["q"][k]["value_"]) for k, axis in enumerate("xyz")
    }
    inner = rounding.add(rounding.add(parts["x"], parts["y"]), parts["z"])
    # What a sum or a product loses last is relative to the result.
    total_of_two = rounding.named(rounding.add(value["p"], value["q"]), "value")
    operations = [
        (
            "sum",
            "sum",
            "(error + kUnit * std::abs(value)) * kMore",
            total_of_two,
            {"error": rounding.add(error["p"], error["q"]), "value": total_of_two},
        ),
        (
            "product",
            "operator*",
            "(spread(p, q) + kUnit * std::abs(value)) * kMore",
            product,
            numbers | {"value": product},
        ),
        (
            "minor",
            "minor",
            """(spread(p, q) + spread(r, s) +
            2 * kUnit * (std::abs(first) + std::abs(second))) * kMore""",
            rounding.add(product, rounding.negated(other)),
            numbers | {"first": product, "second": other},
        ),
        (
            "inner",
            "inner",
            """(spread(p[0], q[0]) + spread(p[1], q[1]) + spread(p[2], q[2]) +
            3 * kUnit * (std::abs(x) + std::abs(y) + std::abs(z))) * kMore""",
            inner,
            vectors | parts,
        ),
    ]
    inequalities = []
    for what, owner, text, computed, scope in operations:
        bound = evaluator.evaluate(sources.expression(owner, text), {"function": owner} | scope)
        inequalities.append(Inequality(what, bound.least, evaluator.settled(computed).error, [without_flushing]))
    return inequalities


def outlines(sources, replaced):
    """Orientations of an edge and a vertex, seen along the motion. W bounds differences of corners, which are off by E.

    A corner's error is 24 u of its size (measured), so E is at least 24 u W; that covers what the bound's own rounding
    takes.
    """
    corner = Vector([UNKNOWN] * 2)
    triangle = {"corners": [corner] * 3, "error": plain("e", nonnegative=True), "area": UNKNOWN, "areaError": UNKNOWN}
    difference = Number(symbol("W"), symbol("E") * (1 + 4 * UNIT))
    kept, out = [], {"overA": [Vector([None] * 3) for _ in range(3)], "overB": [Vector([None] * 3) for _ in range(3)]}

    def keep(value):
        kept.append(value)
        return value

    evaluator = Evaluator(
        sources,
        ordered(CPU_DOUBLES),
        replaced=replaced,
        contracts={"separates": lambda *_: False},
        globals={"kNext": [1, 2, 0]},
        names={
            "outline.error": lambda _: plain("E", nonnegative=True),
            "outline.x[i][k]": lambda _: difference,
            "outline.y[i][k]": lambda _: difference,
            "outline.out.overA[i][k]": keep,
            "outline.out.overB[k][i]": keep,
        },
    )
    evaluator.call("outline", triangle, triangle, plain("W", nonnegative=True), out)
    evaluator.check_used()
    rules = [Rule(("W",), symbol("E") * (1 / (24 * UNIT)))]
    return [
        Inequality(f"orientation {i}", out["bound"].least, value.error, [without_flushing, rules])
        for i, value in enumerate(kept)
    ]


# ---- placements ------------------------------------------------------------------------------------------------------


def placement(sources, replaced):
    """Placing by the formula of radar::Transform, and the origin of the faster one, each against exact placing."""
    evaluator = Evaluator(sources, ordered(CPU_DOUBLES), replaced=replaced)
    rows = [plain(f"r{i}{k}") for i in range(3) for k in range(4)]
    mesh = {
        "unit": plain("unit", nonnegative=True, scales=True),
        "origin": vector("o"),
        "reach": vector("h", nonnegative=True),
    }
    members = {name: Vector([None] * 3) for name in ("origin", "error", "extent")} | {
        "linear": [Vector([None] * 3) for _ in "xyz"]
    }
    pose = {"m": rows}
    _, placed = evaluator.run(sources.function("MeshPlacement::MeshPlacement"), [mesh, pose], members)
    vertex = Vector(Number(symbol(f"o{k}") + symbol(f"h{k}")) for k in range(3))
    by_formula = evaluator.call("transform", pose, vertex)
    return [
        Inequality(
            f"axis {i}",
            placed["error"][i].least,
            placed["origin"][i].error + by_formula[i].error,
            [underflow(CPU_DOUBLES)],
        )
        for i in range(3)
    ]


ROUNDING = """a.error[k] + b.error[k] + 0x1p-1000 * (1 + span) +
    32 * kUnit * (a.extent[k] + b.extent[k] + std::abs(gap[k]) + std::abs(travel[k]))"""


def relative_placement(sources, replaced):
    """A RelativePlacement's rounding, against what its numbers are off by, for normalised vertices, which are below 2.

    n are the rows of the approximate inverse and A and B the linear parts, all exact; g is the distance of the origins,
    a rounded difference; t the travel, a product with a component of the unit direction, which is off by 8 roundings
    (by hand).
    """

    def run(function, arguments, members, **more):
        evaluator = Evaluator(sources, ordered(CPU_DOUBLES), replaced=replaced, globals={"side": 1}, **more)
        _, scope = evaluator.run(sources.function(function), arguments, members)
        evaluator.check_used()
        return scope

    def linear(name):
        return [vector(f"{name}{i}") for i in range(3)]

    def extents(name):
        sums = [2 * total(symbol(f"{name}{i}{j}") for j in range(3)) for i in range(3)]
        return Vector(Number(s * (1 + 4 * UNIT), ZERO, s * (1 - 4 * UNIT), nonnegative=True) for s in sums)

    rows = linear("n")
    own = run("MeshAxes::MeshAxes", [linear("B")], {"rows": rows, "residual": Vector([None] * 3)})
    gap, travel = vector("g", DIFFERENCE), vector("t", 10 * UNIT)
    scope = {
        "function": "PairMotion::PairMotion",
        "span": plain("span", nonnegative=True),
        "gap": gap,
        "travel": travel,
    }
    scope |= {"a": {"error": vector("eA", nonnegative=True), "extent": extents("A")}}
    scope |= {"b": {"error": vector("eB", nonnegative=True), "extent": extents("B")}}
    evaluator = Evaluator(sources, ordered(CPU_DOUBLES), replaced=replaced)
    expression = sources.expression("PairMotion::PairMotion", ROUNDING)
    rounding = Vector(evaluator.settled(evaluator.evaluate(expression, scope | {"k": k})) for k in range(3))
    motion = {"gap": gap, "travel": travel, "rounding": rounding, "clearance": UNKNOWN}
    members = {name: Vector([None] * 3) for name in ("offset", "travel", "rounding", "slack", "magnitude")}
    members |= {"matrix": [Vector([None] * 3) for _ in range(3)]}
    axes = {"rows": rows, "residual": vector("residual", nonnegative=True)}
    placed = run(
        "RelativePlacement::RelativePlacement",
        [axes, {"linear": linear("A")}, motion, 1],
        members,
        assumptions={"motion.clearance > 0": False},
        contracts={"radar::dot": lambda e, p, q: e.settled(e._call_dot(p, q))},
    )
    inequalities = []
    for k in range(3):
        need = placed["offset"][k].error + placed["travel"][k].error
        need += total(placed["matrix"][k][j].error for j in range(3)) * 2
        # Of a placement's error, half is needed, as `placement` proves.
        need += total(symbol(f"n{k}{i}") * (symbol(f"eA{i}") + symbol(f"eB{i}")) for i in range(3)) * Fraction(51, 100)
        need += (symbol(f"residual{k}") + own["residual"][k].error) * 2
        rules = [Rule((f"residual{k}",), own["residual"][k].size.without("flushed"))]
        inequalities.append(Inequality(f"axis {k}", placed["rounding"][k].least, need, [without_flushing, rules]))
    return inequalities


# ---- nodes -----------------------------------------------------------------------------------------------------------

# Operations of lanes (math/lanes.h) are those of their numbers.
NODE_FILES = ["engine/math/rounding.h", "engine/cpu/node_test.h", "engine/cpu/node_test.cpp"]
# A node's centre and half extent, together, of normalised vertices, which are below 2.
REACH = Polynomial.constant(2)


# What a slack must hold is at most this share of it: see relative_placement, and the 1.01 of clearances.
SLACK = Fraction(100, 101)


class NodeAxes:
    """Evaluates NodeTest::Axes for one number type: its values per axis, and what bounds its symbols.

    Inputs, exact: P, the matrix of a RelativePlacement; offset, travel, slack. Its magnitude is a rounded sum of 2 + 2
    sum |P| + |offset| + |travel|. `used`, the speed, is named u. All that is divided by it has the symbol 1/u.
    """

    def __init__(self, sources, real, replaced):
        self.real = real
        size = 4 if real is CPU_FLOATS else 8
        conversions = {"Real": self._convert, "static_cast": self._convert, "sizeof": lambda e, x: x}
        self.globals = {"Real": size, "float": 4}
        self.least = Fraction(1, 1 << (20 if real is CPU_FLOATS else 40))
        # No axis is used whose numbers may exceed this.
        self.most = 1 << (30 if real is CPU_FLOATS else 200)
        self.conversions = conversions
        magnitudes = Vector(self._magnitude(k) for k in range(3))
        relative = {
            "matrix": [vector(f"P{k}") for k in range(3)],
            "offset": vector("offset"),
            "travel": vector("travel"),
            "slack": vector("slack", nonnegative=True),
            "magnitude": magnitudes,
        }
        self.evaluator = Evaluator(
            sources,
            ordered(CPU_DOUBLES),
            replaced=replaced,
            contracts={"std::copysign": lambda e, x, y: x},
            conversions=conversions,
            globals=self.globals,
            assumptions={"usable": True},
            names={
                "Axes::Axes.used": self._speed,
                "Axes::Axes.std::abs(used - relative.travel[k])": lambda x: plain("raised", nonnegative=True),
            },
        )
        members = {name: Vector([None] * 3) for name in ("speed", "rate", "rateSize", "offset", "slack", "normalSlack")}
        members |= {name: [Vector([None] * 3) for _ in range(3)] for name in ("matrix", "matrixSize")}
        members |= {"complete": UNKNOWN, "k": 0}
        function = sources.function("Axes::Axes")
        _, self.values = self.evaluator.run(function, [relative], members)
        self.evaluator.check_used()

    def underflow(self, balance):
        """A step: what underflow takes, as a number. It is multiplied by numbers of an axis that is used, and by
        inverse speeds, all at most `most`, and by normals and coordinates of nodes, at most 4.
        """
        terms = {}
        for monomial, c in balance.terms.items():
            powers = monomial.count("flushed")
            if powers:
                small = sum((len(s) == 2 and s[0] in "nor") or s.startswith(("centre", "half")) for s in monomial)
                large = len(monomial) - powers - small
                c *= self.real.flushed**powers * self.most**large * 4**small
                monomial = ()
            terms[monomial] = terms.get(monomial, 0) + c
        return Polynomial(terms)

    def _speed(self, _):
        self.axis = getattr(self, "axis", -1) + 1
        return plain(f"u{self.axis}", reciprocal=f"1/u{self.axis}")

    def _convert(self, evaluator, number):
        if isinstance(number, int):
            return exactly(number)
        if number.constant is not None:  # a power of two
            return number
        return evaluator.rounding.converted(number, self.real) if self.real is CPU_FLOATS else number

    def _magnitude(self, k):
        terms = 2 + 2 * total(symbol(f"P{k}{j}") for j in range(3)) + symbol(f"offset{k}") + symbol(f"travel{k}")
        return Number(terms * (1 + 8 * UNIT), ZERO, terms * (1 - 8 * UNIT), nonnegative=True)


def node(letter):
    half = vector(f"half{letter}", nonnegative=True)
    return {"type": "Nodes", "centre": vector(f"centre{letter}"), "half": half}


def within_reach(letter):
    return {f"{part}{letter}{k}": "reach" for part in ("centre", "half") for k in range(3)}


def ends_of_cut(sources, real, replaced):
    """What an interval's ends are off by where its middle is m and its half width h."""
    evaluator = Evaluator(sources, ordered(real), replaced=replaced)
    interval = {"from": exactly(0), "to": exactly(0)}
    evaluator.call("cut", interval, plain("m"), plain("h"))
    return (interval["from"].error + interval["to"].error) * Fraction(1, 2)


def by_boxes(real):
    """Contact at t, from 0 to 1, is within the interval that cutByBox computes, along each of own's axes.

    |own centre - P centre - offset - travel t| <= own half + |P| half + slack. All is multiplied by the speed, u.
    """

    def statement(sources, replaced):
        axes, cuts = NodeAxes(sources, real, replaced), []
        evaluator = Evaluator(
            sources,
            ordered(real),
            replaced=replaced,
            contracts={"cut": lambda e, all, middle, half: cuts.append((e.settled(middle), e.settled(half)))},
            conversions=axes.conversions,
        )
        evaluator.call("cutByBox", UNKNOWN, node("O"), node("X"), axes.values)
        evaluator.check_used()
        inequalities, ends = [], ends_of_cut(sources, real, replaced)
        for k, (middle, half) in enumerate(cuts):
            middle, half = times(middle, f"u{k}"), times(half, f"u{k}")
            need = symbol(f"halfO{k}") + total(symbol(f"P{k}{j}") * symbol(f"halfX{j}") for j in range(3))
            need += symbol(f"slack{k}") * SLACK + symbol("raised") + middle.error + ends
            rules = [
                Rule(("m",), middle.size),
                Rule(("h",), half.size),
                Rule((f"u{k}",), symbol(f"travel{k}") + symbol("raised")),
                Rule(("raised",), Polynomial.constant(axes.least)),
            ]
            steps = [
                axes.underflow,
                rules,
                axes.underflow,
                merged(within_reach("O") | within_reach("X")),
                [Rule(("reach",), REACH)],
            ]
            inequalities.append(Inequality(f"axis {k}", half.least, need, steps))
        return inequalities

    return statement


def by_roots(sources, replaced):
    """Contact at t, from 0 to 1, is within the interval of two roots' boxes: as in by_boxes, in doubles and without
    inverses.

    Ends are compared with products of the speed, or are quotients by it, which are at most 1.
    """
    intervals, halves = [], []

    def half(value):
        halves.append(value)
        return value

    def way(value):
        intervals.append((value, halves[-1]))
        return value

    terms = [
        total(symbol(f"P{k}{j}") for j in range(3)) * 2 + 2 + symbol(f"offset{k}") + symbol(f"travel{k}")
        for k in range(3)
    ]
    relative = {
        "matrix": [vector(f"P{k}") for k in range(3)],
        "offset": vector("offset"),
        "travel": vector("travel"),
        "slack": vector("slack", nonnegative=True),
        "magnitude": Vector(Number(t * (1 + 8 * UNIT), ZERO, t * (1 - 8 * UNIT), nonnegative=True) for t in terms),
    }
    evaluator = Evaluator(
        sources,
        ordered(CPU_DOUBLES),
        replaced=replaced,
        names={"narrow.half": half, "narrow.way": way},
        assumptions={
            "!relative.magnitude[k] < 0x1p900": False,
            "relative.travel[k] < 0": False,
            "way - half > speed * times.to || way + half < speed * times.from": False,
            "way - half > speed * times.from": False,
            "way + half < speed * times.to": False,
        },
    )
    own, other = ({"centre": n["centre"], "halfExtent": n["half"]} for n in (node("O"), node("X")))
    times_ = {"from": plain("from"), "to": plain("to")}
    evaluator.call("narrow", times_, relative, own, other)
    evaluator.check_used()
    inequalities = []
    for k, (middle, half_) in enumerate(intervals):
        need = symbol(f"halfO{k}") + total(symbol(f"P{k}{j}") * symbol(f"halfX{j}") for j in range(3))
        need += symbol(f"slack{k}") * SLACK + middle.error
        need += (middle.size + half_.size + symbol(f"travel{k}") * 2) * UNIT
        steps = [without_flushing, merged(within_reach("O") | within_reach("X")), [Rule(("reach",), REACH)]]
        inequalities.append(Inequality(f"axis {k}", half_.least, need, steps))
    return inequalities


ROOT_OF_3 = Fraction(17321, 10000)


def cancelled(bound):
    """The bound with speeds and their inverses cancelled."""
    terms = {}
    for monomial, c in bound.terms.items():
        rest = list(monomial)
        for k in range(3):
            while f"u{k}" in rest and f"1/u{k}" in rest:
                rest.remove(f"u{k}")
                rest.remove(f"1/u{k}")
        rest = tuple(rest)
        terms[rest] = terms.get(rest, 0) + c
    return Polynomial(terms)


def across(bound):
    """A step for what a balance lacks in a |o_j|, times 1 or other symbols: a = g.o with a unit vector o, so the sum
    over j of |a o_j| is at most the root of 3 times the norm of g, of which `bound` is one.
    """

    def pay(balance):
        terms, lacks = {}, {}
        for monomial, c in balance.terms.items():
            part = next((s for s in monomial if s in ("o0", "o1", "o2")), None)
            if part is None or "a" not in monomial:
                terms[monomial] = terms.get(monomial, 0) + c
            elif c < 0:
                rest = list(monomial)
                rest.remove(part)
                rest.remove("a")
                lacks.setdefault(tuple(rest), []).append(c)
        rest = Polynomial(terms)
        for monomial, lacking in lacks.items():
            rest = rest + bound * ROOT_OF_3 * Polynomial({monomial: min(lacking)})
        return rest

    return pay


def by_normals(real):
    """Contact at t, from 0 to 1, is within the interval that cutByNormal computes.

    Along own's normal n, with g = n P, any a = `along` and r = g - a o, for the other's unit normal o: |own middle -
    n.offset - a mu - r.centre - t n.travel| <= own slab + sum |n_k| slack_k + |a| h + |r| halves, mu and h being the
    other's slab. A slab's middle and half width are at most 2 |n| together. All is multiplied by v, the speed, which is
    at least `least`; so the sum n.u, u being the speeds that have been raised, is off by at most that.
    """

    def statement(sources, replaced):
        axes, kept, cuts = NodeAxes(sources, real, replaced), Kept(), []

        def named_rest(value):
            # Products with `along` are bounded by a step; what the difference loses is relative to the rest.
            kept["rest"] = kept.get("rest", []) + [value]
            j = len(kept["rest"]) - 1
            return evaluator.rounding.named(value, f"r{j}")

        evaluator = Evaluator(
            sources,
            ordered(real),
            replaced=replaced,
            contracts={
                "cut": lambda e, all, middle, half: cuts.append((e.settled(middle), e.settled(half))),
                "withSignOf": lambda e, x, y: x,
            },
            conversions=axes.conversions | {"Lanes": axes.conversions["Real"]},
            globals=axes.globals,
            names={
                "cutByNormal.rest[j]": named_rest,
                "cutByNormal.along": lambda _: plain("a"),
                "cutByNormal.middle": kept.keep("middle", lambda _: plain("m")),
                "cutByNormal.half": kept.keep("half", lambda _: plain("h", nonnegative=True)),
                "cutByNormal.speed": kept.keep("speed", lambda _: plain("s")),
                "cutByNormal.max(abs(speed), least)": lambda _: plain("v", nonnegative=True, reciprocal="1/v"),
                "cutByNormal.inverse": lambda _: Number(symbol("1/v"), ZERO, symbol("1/v"), nonnegative=True),
            },
        )
        own = node("O") | {"normal": vector("n"), "slabMiddle": plain("own middle")}
        other = node("X") | {
            "normal": vector("o"),
            "slabMiddle": plain("mu"),
            "slabHalf": plain("other slab", nonnegative=True),
        }
        own["slabHalf"] = plain("own slab", nonnegative=True)
        _, scope = evaluator.run(sources.function("cutByNormal"), [UNKNOWN, own, other, axes.values])
        evaluator.check_used()
        ((middle, half),) = cuts
        middle, half = times(middle, "v"), times(half, "v")
        n = [symbol(f"n{k}") for k in range(3)]
        r = scope["rest"]
        need = symbol("own slab") + symbol("a") * symbol("other slab")
        need += total((symbol(f"r{j}") + r[j].error) * symbol(f"halfX{j}") for j in range(3))
        need += total(n[k] * (symbol(f"slack{k}") * SLACK + symbol("raised")) for k in range(3))
        need += kept["middle"].error + kept["speed"].error + axes.least
        # The inverse is off by a rounding, relative to the ends; that of half is left out.
        need += middle.error + (middle.size + kept["half"].size) * (real.division + real.unit) * (1 + 4 * real.unit)
        need += ends_of_cut(sources, real, replaced)
        g = total(n[k] * symbol(f"P{k}{j}") for k in range(3) for j in range(3))
        sizes = [Rule(("m",), kept["middle"].size), Rule(("h",), kept["half"].size)]
        rests = [Rule((f"r{j}",), kept["rest"][j].size) for j in range(3)]
        slabs = {"own middle": "own reach", "own slab": "own reach", "mu": "other reach", "other slab": "other reach"}
        reaches = [Rule((f"u{k}",), symbol(f"travel{k}") + symbol("raised")) for k in range(3)]
        reaches += [
            Rule(("reach",), REACH),
            Rule(("own reach",), total(n) * REACH),
            Rule(("other reach",), total(symbol(f"o{j}") for j in range(3)) * REACH),
            Rule(("raised",), Polynomial.constant(axes.least)),
        ]
        margin = kept["half"].least
        steps = [
            cancelled,
            sizes,
            rests,
            cancelled,
            axes.underflow,
            merged(slabs),
            merged(within_reach("X")),
            reaches,
            across(g),
        ]
        return [Inequality("normal", margin, need, steps)]

    return statement


# ---- triangles of two leaves -----------------------------------------------------------------------------------------

LEAF_FILES = NODE_FILES + ["engine/cpu/leaf_test.h", "engine/cpu/leaf_test.cpp"]
# Of positionError_, edgeError_ and clearance_, what they must hold: they have been raised by a hundredth.
HELD = Fraction(100, 101)


class LeafAxes:
    """Evaluates LeafTest's test of two leaves for one number type.

    Inputs: x and y bound the edges' components, whichever the edge; d is the gap, w the travel, e and p are the errors
    of an edge and of a position, c the clearance; tau is the duration. An edge's components have been rounded 5 times
    (A) or once (B, by hand), a gap's and a travel's once. A size is the sum of an edge's components, and 4 e.
    """

    def __init__(self, sources, real, replaced):
        self.sources, self.real, self.replaced = sources, real, replaced
        unit = real.unit
        self.added = []
        constants = {"Real": 4 if real is CPU_FLOATS else 8, "float": 4, "INFINITY": UNKNOWN}
        self.conversions = {
            name: lambda e, x: exactly(x) if isinstance(x, int) else x
            for name in ("Real", "L", "Lanes", "static_cast", "rounded")
        } | {"sizeof": lambda e, x: x, "double": lambda e, x: x}

        def edges(name, roundings):
            error = symbol("e") * HELD
            return [
                Vector(plain(f"{name}{k}", error + symbol(f"{name}{k}") * unit * roundings) for k in range(3))
                for _ in range(3)
            ]

        def size(name):
            value = total(symbol(f"{name}{k}") for k in range(3)) + 4 * symbol("e")
            return Number(value * (1 + 8 * unit), ZERO, value * (1 - 8 * unit), nonnegative=True)

        sides = {}
        for side, name, roundings in (("a_", "x", 5), ("b_", "y", 1)):
            sides[side] = {"edge": edges(name, roundings), "corner": vector("corner"), "size": size(name)}
            cross = Evaluator(sources, without_underflow(real), replaced=replaced)._call_cross
            sides[side]["normal"] = Vector(
                map(Rounding(without_underflow(real)).settled, cross(*sides[side]["edge"][:2]))
            )
        travel = total(symbol(f"w{k}") for k in range(3))
        members = sides | {
            "offset_": vector("offset"),
            "travel_": vector("w", unit),
            "travelSize_": Number(travel * (1 + 4 * unit), ZERO, travel * (1 - 4 * unit), nonnegative=True),
            "positionError_": plain("p", nonnegative=True),
            "edgeError_": plain("e", nonnegative=True),
            "clearance_": plain("c", nonnegative=True),
            "usable_": True,
        }
        gaps = iter(range(3))

        def gap(_):
            k = next(gaps)
            return plain(f"d{k}", symbol("p") * HELD + symbol(f"d{k}") * unit)

        evaluator = Evaluator(
            sources,
            without_underflow(real),
            replaced=replaced,
            contracts={
                "showA": lambda *_: None,
                "showB": lambda *_: None,
                "lanesOf": lambda *_: UNKNOWN,
                "Margin": self._margin,
                "cross": lambda e, p, q, out: out.__setitem__(slice(None), e.settled(e._call_cross(p, q))),
                "add": lambda e, *arguments: self.added.append(arguments),
                "possible": lambda *_: UNKNOWN,
            },
            conversions=self.conversions,
            globals=constants,
            assumptions={"out.possible == 0": False},
            names={
                "operator().gap[k]": gap,
                "operator().collected": lambda _: {"from": UNKNOWN, "to": UNKNOWN, "axis": UNKNOWN},
                "operator().duration": lambda _: plain("tau", nonnegative=True, reciprocal="1/tau"),
            },
        )
        function = sources.function("operator()", lambda f: len(f.parameters) == 4)
        evaluator.run(function, [UNKNOWN, UNKNOWN, plain("begin"), plain("end")], members)
        evaluator.check_used()

    def _margin(self, evaluator, error, clearance, duration):
        constructor = self.sources.function("Margin")
        scope = {"function": "Margin", "error": error, "clearance": clearance, "duration": duration}
        return {
            member: evaluator.settled(evaluator.evaluate(value.parts[0], scope))
            for member, value in self.sources.initialisers(constructor)
        }

    def ends(self):
        """What an interval's ends are off by, times v: for a middle m, a half width h and a margin's width, q."""
        evaluator = Evaluator(
            self.sources,
            without_underflow(self.real),
            replaced=self.replaced,
            contracts={"withSignOf": lambda e, x, y: x, "select": lambda *_: UNKNOWN},
            conversions=self.conversions,
            names={"add.max(abs(speed), margin.speed)": lambda _: plain("v", nonnegative=True, reciprocal="1/v")},
        )
        margin = {"width": plain("q", nonnegative=True), "speed": plain("least", nonnegative=True)}
        _, scope = evaluator.run(
            self.sources.function("add"),
            [plain("m"), plain("h", nonnegative=True), plain("s"), margin, 0],
            {"from": exactly(0), "to": exactly(0), "axis": UNKNOWN},
        )
        evaluator.check_used()
        return (times(scope["from"], "v").error + times(scope["to"], "v").error) * Fraction(1, 2)


def by_triangles(real):
    """Contact at t, from 0 to tau, is within the interval of each separating axis.

    |middle - t speed| <= half, of exact numbers. A speed below that of the margin is raised to it.
    """

    def statement(sources, replaced):
        axes = LeafAxes(sources, real, replaced)
        ends, inequalities = axes.ends(), []
        tau, c = symbol("tau"), symbol("c")
        sizes = {name: total(symbol(f"{name}{k}") for k in range(3)) for name in "xy"}
        areas = [sizes["x"] * sizes["x"], sizes["y"] * sizes["y"]] + [sizes["x"] * sizes["y"]] * 9
        if len(axes.added) != len(areas):
            place = sources.literal("Margin", "3) * error").place
            raise SourceError(f"{place}: LeafTest adds another number of axes than the claim knows")
        for (middle, half, speed, margin, number), area in zip(axes.added, areas):
            middle, half, speed = map(Rounding(without_underflow(real)).settled, (middle, half, speed))
            need = middle.error + half.error + tau * (speed.error + margin["speed"].size) + ends + c * area * HELD
            rules = [
                Rule(("1/tau", "tau"), Polynomial.constant(1)),
                Rule(("m",), middle.size),
                Rule(("h",), half.size),
                Rule(("q",), margin["width"].size),
            ]
            inequalities.append(Inequality(f"axis {number}", margin["width"].least, need, [rules]))
        return inequalities

    return statement


def claims(root):
    determinants = Sources(root, ["engine/math/vector.h", "engine/exact/determinant.h"])
    crosses = Sources(root, ["engine/exact/determinant.h", "engine/exact/determinant.cpp"])

    def claim(name, function, constants, sources, statement):
        owned = [Constant(*c) if isinstance(c, tuple) else Constant(function, c) for c in constants]
        return Claim(name, function, owned, sources, lambda replaced: statement(sources, replaced))

    nodes = Sources(root, NODE_FILES)
    leaves = Sources(root, LEAF_FILES)
    certificate = Sources(root, ["engine/cpu/certificate.cpp"])
    numbers = Sources(root, ["engine/math/rounding.h", "engine/exact/bounded.h"])
    overlap = Sources(root, ["engine/math/rounding.h", "engine/cpu/swept_overlap.cpp"])
    motions = Sources(
        root,
        ["engine/math/rounding.h", "engine/math/vector.h", "engine/cpu/pair_motion.cpp"],
    )
    placements = Sources(root, ["engine/math/rounding.h", "engine/cpu/pair_motion.cpp", "engine/math/frame.cpp"])
    return [
        claim("determinant", "estimate", [("kRelative", "16 * 0x1p-53")], determinants, estimate),
        claim("component of a cross product", "crossSign", [("kRelative", "16 * 0x1p-53")], crosses, cross_sign),
        claim("side beyond a slack", "sideBeyond", ["2.125 * slack"], certificate, side_beyond),
        claim("numbers with bounds", "Bounded", [("kMore", "0x1p-49")], numbers, bounded_operations),
        claim(
            "outlines", "outline", ["4 * width * error", "4 * error * error", "4 * kUnit * width"], overlap, outlines
        ),
        claim("placement of a mesh", "MeshPlacement::MeshPlacement", ["16 * kUnit"], placements, placement),
        claim("relative placement", "PairMotion::PairMotion", ["32 * kUnit"], motions, relative_placement),
        claim(
            "relative placement", "RelativePlacement::RelativePlacement", ["32 * kUnit"], motions, relative_placement
        ),
        claim("boxes of roots", "narrow", ["32 * kUnit"], motions, by_roots),
        claim("boxes of nodes, floats", "Axes::Axes", ["16 * kRounding"], nodes, by_boxes(CPU_FLOATS)),
        claim("boxes of nodes, doubles", "Axes::Axes", ["16 * kRounding"], nodes, by_boxes(CPU_DOUBLES)),
        claim("normals of nodes, floats", "Axes::Axes", ["128 * kRounding"], nodes, by_normals(CPU_FLOATS)),
        claim("normals of nodes, doubles", "Axes::Axes", ["128 * kRounding"], nodes, by_normals(CPU_DOUBLES)),
        claim(
            "triangles of leaves, floats",
            "operator()",
            ["32 * kRounding", ("Margin", "3) * error")],
            leaves,
            by_triangles(CPU_FLOATS),
        ),
        claim(
            "triangles of leaves, doubles",
            "operator()",
            ["32 * kRounding", ("Margin", "3) * error")],
            leaves,
            by_triangles(CPU_DOUBLES),
        ),
    ]
