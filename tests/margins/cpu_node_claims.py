"""The margins of the CPU's tests of nodes and leaves, read from their C++, for both number types."""
import re
from dataclasses import replace
from fractions import Fraction
from functools import partial

from claims import Claim, Inequality, Shared, at_most, underflow, without_flushing
from cpu_claims import HELD, MOTION_FILES, ROUNDING_FILE, UNIT
from evaluator import UNKNOWN, Evaluator, Vector
from polynomial import Polynomial, summed, total
from rounding import CPU_DOUBLES, CPU_FLOATS, converted, exactly, plain, roughly, symbol
from sizes import ROOT_OF_3, mean_error, positive, together, vector, within

# A node's centre and half extent, together, of normalised vertices, which are below 2.
REACH = [Polynomial.constant(2)] * 3
# The condition on which numbers of a template are those of floats.
IS_FLOAT = "sizeof(Real) == sizeof(float)"


def relative_placement():
    """A RelativePlacement. Inputs, exact: P, its matrix; offset, travel, slack; its magnitude is a rounded sum."""

    def magnitude(k):
        terms = 2 * summed("P{k}{j}", k=k) + symbol(f"offset{k}") + symbol(f"travel{k}")
        return roughly(2 + terms, 8 * UNIT)

    return {
        "matrix": [vector(f"P{k}") for k in range(3)],
        "offset": vector("offset"),
        "travel": vector("travel"),
        "slack": vector("slack", nonnegative=True),
        "magnitude": Vector(map(magnitude, range(3))),
    }


def node(letter):
    half = vector(f"half{letter}", nonnegative=True)
    return {"type": "Nodes", "centre": vector(f"centre{letter}"), "half": half}


def widths(k):
    """What half of an interval along axis k must hold: both boxes, and what the slack is for."""
    return symbol(f"halfO{k}") + summed("P{k}{j} halfX{j}", k=k) + symbol(f"slack{k}") * HELD


def by_roots(sources):
    """Contact at t, from 0 to 1, is within the interval of two roots' boxes: as in by_boxes, in doubles and without
    inverses.

    Ends are compared with products of the speed, or are quotients by it, which are at most 1.
    """
    before, after = "way - half > speed * times.", "way + half < speed * times."
    cases = ["!(relative.magnitude[k] < 0x1p900)", "relative.travel[k] < 0", f"{before}to || {after}from"]
    assumptions = dict.fromkeys([*cases, f"{before}from", f"{after}to"], False)
    evaluator = Evaluator(sources, CPU_DOUBLES, assumptions=assumptions)
    times = {"from": plain("from"), "to": plain("to")}
    own, other = ({"centre": n["centre"], "halfExtent": n["half"]} for n in (node("O"), node("X")))
    evaluator.call("narrow", times, relative_placement(), own, other)
    # Of an axis, the last of the values that half has: there are four.
    halves = evaluator.values["half"][3::4]
    for k, (middle, half) in enumerate(zip(evaluator.values["way"], halves, strict=True)):
        need = widths(k) + middle.error + (middle.size + half.size + symbol(f"travel{k}") * 2) * UNIT
        steps = [without_flushing, *within("O", REACH), *within("X", REACH)]
        yield Inequality(f"axis {k}", half.least, need, steps)


class NodeAxes:
    """Evaluates NodeTest::Axes for one number type: its values per axis, and what bounds its symbols.

    `used`, the speed, is named u.
    """

    def __init__(self, sources, real):
        self.sources, self.real = sources, real
        self.least = Fraction(1, 1 << (20 if real is CPU_FLOATS else 40))
        # No axis is used whose numbers, or inverse speeds, may exceed this.
        most = 1 << (30 if real is CPU_FLOATS else 200)
        # Normals and coordinates of nodes are at most 4.
        small = re.compile("[nor].|centre.*|half.*")
        self.underflow = underflow(real, lambda symbol: 4 if small.fullmatch(symbol) else most)
        self.assumptions = {IS_FLOAT: real is CPU_FLOATS}
        self.globals = dict.fromkeys(("Real", "Lanes", "static_cast"), self.convert)
        names = {"used": iter(vector("u", divides=True)), "std::abs(used - relative.travel[k])": positive("raised")}
        contracts, assumptions = {"std::copysign": lambda x, y: x}, self.assumptions | {"usable": True}
        conditions = {"contracts": contracts, "assumptions": assumptions, "globals": self.globals}
        evaluator = Evaluator(sources, CPU_DOUBLES, names=names, **conditions)
        evaluator.call("Axes::Axes", relative_placement(), members={"complete": UNKNOWN})
        self.values = evaluator.variables

    def convert(self, number):
        if isinstance(number, int):
            return exactly(number)
        if number.constant is not None:  # a power of two
            return number
        return converted(number, self.real) if self.real is CPU_FLOATS else number

    def cut(self, function, arguments, **conditions):
        """Middle and half width of the intervals that a function hands to `cut`; its evaluator."""
        cuts = []
        contracts = {"cut": lambda times, middle, half: cuts.append((middle, half))} | conditions.pop("contracts", {})
        evaluator = Evaluator(self.sources, self.real, contracts=contracts, globals=self.globals, **conditions)
        evaluator.call(function, UNKNOWN, *arguments, self.values)
        return cuts, evaluator

    def ends(self):
        """What an interval's ends are off by where its middle is m and its half width h."""
        interval = {"from": exactly(0), "to": exactly(0)}
        Evaluator(self.sources, self.real).call("cut", interval, plain("m"), plain("h"))
        return mean_error(interval["from"], interval["to"])


def by_boxes(real, sources):
    """Contact at t, from 0 to 1, is within the interval that cutByBox computes, along each of own's axes.

    |own centre - P centre - offset - travel t| <= own half + |P| half + slack. All is multiplied by the speed, u.
    """
    axes = NodeAxes(sources, real)
    cuts, _ = axes.cut("cutByBox", [node("O"), node("X")])
    for k, (middle, half) in enumerate(cuts):
        middle, half = (number.times(symbol(f"u{k}")) for number in (middle, half))
        need = widths(k) + symbol("raised") + middle.error + axes.ends()
        rules = {"m": middle.size, "h": half.size}
        rules |= {f"u{k}": symbol(f"travel{k}") + symbol("raised"), "raised": axes.least}
        steps = [axes.underflow, at_most(rules), axes.underflow, *within("O", REACH), *within("X", REACH)]
        yield Inequality(f"axis {k}", half.least, need, steps)


def by_normals(real, sources):
    """Contact at t, from 0 to 1, is within the interval that cutByNormal computes.

    Along own's normal n, with g = n P, any a = `along` and r = g - a o, for the other's unit normal o: |own middle -
    n.offset - a mu - r.centre - t n.travel| <= own slab + sum |n_k| slack_k + |a| h + |r| halves, mu and h being the
    other's slab. A slab's middle and half width are at most 2 |n| together. All is multiplied by v, the speed, which is
    at least `least`; so the sum n.u, u being the speeds that have been raised, is off by at most that.
    """
    axes = NodeAxes(sources, real)
    names = {
        # Products with `along` are bounded by a step; what the difference loses is relative to the rest.
        "rest[j]": iter(["r0", "r1", "r2"]),
        "along": plain("a"),
        "middle": plain("m"),
        "half": positive("h"),
        "speed": plain("s"),
        "max(abs(speed), least)": positive("v", divides=True),
        "inverse": positive("1/v"),
    }
    own = node("O") | {"normal": vector("n"), "slabMiddle": plain("own_middle"), "slabHalf": positive("own_slab")}
    other = node("X") | {"normal": vector("o"), "slabMiddle": plain("mu"), "slabHalf": positive("other_slab")}
    conditions = {"assumptions": axes.assumptions, "contracts": {"withSignOf": lambda x, y: x}}
    ((middle, _),), evaluator = axes.cut("cutByNormal", [own, other], names=names, **conditions)
    middle = middle.times(symbol("v"))
    m, h, s = (evaluator.values[name][0] for name in ("middle", "half", "speed"))
    rest = evaluator.variables["rest"]
    need = symbol("own_slab") + summed("a other_slab") + summed("n{k} slack{k}") * HELD + summed("n{k} raised")
    need += total((symbol(f"r{j}") + rest[j].error) * symbol(f"halfX{j}") for j in range(3))
    # The inverse is off by a rounding, relative to the ends; that of half is left out.
    need += middle.error + (middle.size + h.size) * (real.division + real.unit) * (1 + 4 * real.unit)
    need += m.error + s.error + axes.least + axes.ends()
    rests = {f"r{j}": value.size for j, value in enumerate(evaluator.values["rest[j]"])}
    speeds = {f"u{k}": symbol(f"travel{k}") + symbol("raised") for k in range(3)}
    steps = [
        at_most({"m": m.size, "h": h.size}),
        at_most(rests),
        axes.underflow,
        together("own_middle", "own_slab", summed("n{k}") * REACH[0]),
        together("mu", "other_slab", summed("o{j}") * REACH[0]),
        *within("X", REACH),
        at_most(speeds | {"raised": axes.least}),
        # a = g.o, so the sum over j of |a o_j| is at most the root of 3 times the norm of g.
        Shared([("a", f"o{j}") for j in range(3)], summed("n{k} P{k}{j}") * ROOT_OF_3),
    ]
    yield Inequality("normal", h.least, need, steps)


class LeafAxes:
    """Evaluates LeafTest's test of two leaves for one number type. Underflow is left out.

    Inputs: x and y bound the edges' components, whichever the edge; d is the gap, w the travel, e and p are the errors
    of an edge and of a position, c the clearance; tau is the duration. An edge's components have been rounded 5 times
    (A) or once (B, by hand), a gap's and a travel's once. A size is the sum of an edge's components, and 4 e.
    """

    def __init__(self, sources, real):
        self.sources, self.real, self.added = sources, replace(real, flushed=Fraction(0)), []
        evaluator = self._evaluator(
            contracts={
                "showA": UNKNOWN,
                "showB": UNKNOWN,
                "lanesOf": UNKNOWN,
                "beginningOf": lambda pairs: plain("begin"),
                "add": lambda *arguments: self.added.append(arguments),
                "possible": UNKNOWN,
            },
            assumptions={"out.possible == 0": False, IS_FLOAT: real is CPU_FLOATS},
            names={
                "gap[k]": iter(self._off("d", symbol("p") * HELD, 1)),
                "collected": {"from": UNKNOWN, "to": UNKNOWN, "axis": UNKNOWN},
                "duration": positive("tau", divides=True),
            },
        )
        members = {
            "a_": self._side("x", 5),
            "b_": self._side("y", 1),
            "offset_": vector("offset"),
            "travel_": vector("w", real.unit),
            "travelSize_": roughly(summed("w{k}"), 4 * real.unit),
            "positionError_": positive("p"),
            "edgeError_": positive("e"),
            "clearance_": positive("c"),
            "usable_": True,
        }
        evaluator.call("timesOf", UNKNOWN, plain("end"), members=members)

    def _evaluator(self, **conditions):
        def convert(number):
            return exactly(number) if isinstance(number, int) else number

        def cross(p, q, out):
            out.extend(evaluator.settled(evaluator.cross(p, q)))

        names = dict.fromkeys(("Real", "L", "Lanes", "static_cast", "rounded"), convert)
        globals_ = names | {"cross": cross, "INFINITY": UNKNOWN}
        evaluator = Evaluator(self.sources, self.real, globals=globals_, **conditions)
        return evaluator

    def _off(self, name, error, roundings):
        """A vector that is off by an error, and rounded so many times."""
        unit = self.real.unit * roundings
        return Vector(plain(f"{name}{k}", error + symbol(f"{name}{k}") * unit) for k in range(3))

    def _side(self, name, roundings):
        edges = [self._off(name, symbol("e") * HELD, roundings) for _ in range(3)]
        size = roughly(summed(name + "{k}") + 4 * symbol("e"), 8 * self.real.unit)
        evaluator = self._evaluator()
        normal = evaluator.settled(evaluator.cross(*edges[:2]))
        return {"edge": edges, "corner": vector("corner"), "size": size, "normal": normal}

    def ends(self):
        """What an interval's ends are off by, times v: for a middle m, a half width h and a margin's width, q."""
        evaluator = self._evaluator(
            contracts={"withSignOf": lambda x, y: x, "select": UNKNOWN},
            names={"max(abs(speed), margin.speed)": positive("v", divides=True)},
        )
        margin = {"width": positive("q"), "speed": positive("least")}
        members = {"from": exactly(0), "to": exactly(0), "axis": UNKNOWN}
        evaluator.call("add", plain("m"), positive("h"), plain("s"), margin, 0, members=members)
        return mean_error(evaluator.variables["from"], evaluator.variables["to"]) * symbol("v")


def by_triangles(real, sources):
    """Contact at t, from 0 to tau, is within the interval of each separating axis.

    |middle - t speed| <= half, of exact numbers. A speed below that of the margin is raised to it.
    """
    axes = LeafAxes(sources, real)
    x, y = summed("x{k}"), summed("y{k}")
    areas, ends = [x * x, y * y] + [x * y] * 9, axes.ends()
    for (middle, half, speed, margin, number), area in zip(axes.added, areas, strict=True):
        need = middle.error + half.error + symbol("tau") * (speed.error + margin["speed"].size)
        need += ends + symbol("c") * area * HELD
        rules = at_most({"m": middle.size, "h": half.size, "q": margin["width"].size})
        yield Inequality(f"axis {number}", margin["width"].least, need, [rules])


def of_leaves(real, sources):
    """edgeError_ holds the errors of two placed vertices; positionError_ that of one, and what a gap loses in doubles.

    The largest of the axes counts: it is no less if the numbers of the others are left out.
    """
    convert = {"Real": None, "static_cast": lambda x: converted(x, real) if real is CPU_FLOATS else x}
    for k in range(3):
        relative = relative_placement() | {"rounding": vector("rounding", nonnegative=True)}
        matrix, offset, travel = (relative[name] for name in ("matrix", "offset", "travel"))
        for name in ("magnitude", "rounding"):
            relative[name] = Vector(x if j == k else exactly(0) for j, x in enumerate(relative[name]))
        assumptions = {"!usable_": False, IS_FLOAT: real is CPU_FLOATS}
        evaluator = Evaluator(sources, CPU_DOUBLES, assumptions=assumptions, globals=convert)
        evaluator.call("LeafTest", UNKNOWN, UNKNOWN, relative, members={"usable_": UNKNOWN})
        edge, position = (evaluator.variables[name].least * HELD for name in ("edgeError_", "positionError_"))
        rounding = symbol(f"rounding{k}")
        yield Inequality(f"edge, axis {k}", edge, rounding * 2, [without_flushing])

        evaluator = Evaluator(sources, CPU_DOUBLES, globals={"D": lambda x: x})
        placing = "D(row[0]) * own.first[0] + D(row[1]) * own.first[1] + D(row[2]) * own.first[2]"
        corner = evaluator.expression("showA", placing, row=matrix[k], own={"first": vector("p")})
        moving = {"offset_": offset, "travel_": travel, "start": plain("begin"), "k": k}
        moved = evaluator.expression("timesOf", "offset_[k] + start * travel_[k]", **moving)
        corners = {"a_": {"corner": {k: corner}}, "b_": {"corner": vector("q")}, "moved": moved, "k": k}
        gap = evaluator.expression("timesOf", "b_.corner[k] - (a_.corner[k] + moved)", **corners)
        rules = at_most({f"{name}{j}": REACH[j] for name in "pq" for j in range(3)} | {"begin": Polynomial.constant(1)})
        yield Inequality(f"position, axis {k}", position, rounding + gap.error, [without_flushing, rules])


NODE_FILES = [ROUNDING_FILE, "engine/cpu/node_test.h", "engine/cpu/node_test.cpp"]
LEAF_FILES = NODE_FILES + ["engine/cpu/leaf_test.h", "engine/cpu/leaf_test.cpp"]


def claims():
    found = [Claim("boxes of roots", "narrow", ["32 * kUnit"], MOTION_FILES, by_roots)]
    triangles = ["32 * kRounding", ("Margin", "3) * error")]
    errors = ["2 * relative.rounding[k])", "2 * relative.rounding[k] + 16", "16 * kUnit"]
    for title, owner, constants, files, statement in (
        ("boxes of nodes", "Axes::Axes", ["16 * kRounding"], NODE_FILES, by_boxes),
        ("normals of nodes", "Axes::Axes", ["128 * kRounding"], NODE_FILES, by_normals),
        ("triangles of leaves", "timesOf", triangles, LEAF_FILES, by_triangles),
        ("errors of leaves", "LeafTest", errors, LEAF_FILES, of_leaves),
    ):
        for numbers, real in (("floats", CPU_FLOATS), ("doubles", CPU_DOUBLES)):
            found.append(Claim(f"{title}, {numbers}", owner, constants, files, partial(statement, real)))
    return found
