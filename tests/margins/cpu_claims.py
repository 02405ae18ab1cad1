"""The margins of the CPU's tests of numbers and placements, read from their C++.

The CPU rounds to nearest, in the order that is written, and keeps subnormal numbers.
"""
from fractions import Fraction

from claims import Claim, Inequality, Rule, at_most, without_flushing
from evaluator import UNKNOWN, Evaluator, Vector
from polynomial import summed, total
from rounding import CPU_DOUBLES, Number, Rounding, exactly, plain, roughly, symbol
from sizes import positive, vector

UNIT = CPU_DOUBLES.unit
DIFFERENCE = CPU_DOUBLES.of_result
# What underflow takes is a number.
UNDERFLOW = [Rule(("flushed",), CPU_DOUBLES.flushed)]
# Bounds that others are made of hold errors with at most this share: so much is left for rounding what is made of them.
HELD = Fraction(991, 1000)


def evaluator_of(sources, **conditions):
    return Evaluator(sources, CPU_DOUBLES, **conditions)


def estimate(sources):
    """A determinant of rounded differences. Underflow takes something from products, which are multiplied by w."""
    evaluator = evaluator_of(sources)
    w, x, y = (vector(name, DIFFERENCE) for name in "wxy")
    value, error = evaluator.call("estimate", w, x, y, evaluator.call("underflowOf", w))
    yield Inequality("error of a determinant", error.least, value.error, [UNDERFLOW])


CROSS = "kRelative * (std::abs(p) + std::abs(q)) + kUnderflow"


def cross_sign(sources):
    conditions = {"assumptions": {f"std::abs(p - q) > {CROSS}": True}, "contracts": {"signOf": UNKNOWN}}
    evaluator = evaluator_of(sources, **conditions)
    v, w = ({"to": vector(name, DIFFERENCE), "from": [exactly(0)] * 3} for name in "vw")
    evaluator.call("crossSign", v, w, 0)
    products = {name: evaluator.variables[name] for name in "pq"}
    value, margin = (evaluator.expression("crossSign", text, **products) for text in ("std::abs(p - q)", CROSS))
    yield Inequality("error of a component", margin.least, value.error, [UNDERFLOW])


def side_beyond(sources):
    """No component of x cross y exceeds twice the product of their largest; x and y are rounded differences."""
    contracts = {"exact::estimate": UNKNOWN, "exact::underflowOf": UNKNOWN}
    contracts["largest"] = iter((positive("x"), positive("y")))
    assumptions = {"std::abs(rough.value) > rough.error + margin": False}
    evaluator = evaluator_of(sources, contracts=contracts, assumptions=assumptions)
    evaluator.call("sideBeyond", UNKNOWN, UNKNOWN, UNKNOWN, positive("slack"))
    need = 2 * (1 + DIFFERENCE) ** 2 * (1 + 2 * UNIT) * symbol("x") * symbol("y") * symbol("slack")
    yield Inequality("side beyond a slack", evaluator.variables["margin"].least, need, [without_flushing])


def bounded(name):
    error = positive(f"{name} error")
    return {"value_": plain(name, error.size), "error_": error}


def bounded_operations(sources):
    """Sums, products, differences of products and inner products of numbers with bounds; nothing underflows."""
    p, q, r, s = map(bounded, "pqrs")
    add = Rounding(CPU_DOUBLES).add
    terms = [add(p[part], q[part]) for part in ("value_", "error_")]
    # What a sum loses last is relative to the result.
    sums, others = evaluator_of(sources, names={"value": "value"}), evaluator_of(sources)
    vectors = [[bounded(f"{name}{k}") for k in range(3)] for name in "pq"]
    results = {
        "sum": sums.call("sum", *terms),
        "product": others.call("operator*", p, q),
        "minor": others.call("minor", p, q, r, s),
        "inner": others.call("inner", *vectors),
    }
    return [Inequality(what, error.least, value.error, [without_flushing]) for what, (value, error) in results.items()]


def placement(sources):
    """Placing by the formula of radar::Transform, and the origin of the faster one, each against exact placing."""
    evaluator = evaluator_of(sources)
    pose = {"m": [plain(f"r{i}{k}") for i in range(3) for k in range(4)]}
    reach = vector("h", nonnegative=True)
    mesh = {"unit": positive("unit", scales=True), "origin": vector("o"), "reach": reach}
    evaluator.call("MeshPlacement::MeshPlacement", mesh, pose)
    error, origin = evaluator.variables["error"], evaluator.variables["origin"]
    by_formula = evaluator.call("transform", pose, Vector(Number(symbol(f"o{k}") + symbol(f"h{k}")) for k in range(3)))
    needs = [one.error + other.error for one, other in zip(origin, by_formula)]
    return [Inequality(f"axis {i}", error[i].least, needs[i], [UNDERFLOW]) for i in range(3)]


ROUNDING = """a.error[k] + b.error[k] + 0x1p-1000 * (1 + span) +
    32 * kUnit * (a.extent[k] + b.extent[k] + std::abs(gap[k]) + std::abs(travel[k]))"""


def relative_placement(sources):
    """A RelativePlacement's rounding, against what its numbers are off by, for normalised vertices, which are below 2.

    n are the rows of the approximate inverse and A and B the linear parts, all exact; g is the distance of the origins,
    a rounded difference; t the travel, a product with a component of the unit direction, which is off by 8 roundings
    (by hand).
    """

    def linear(name):
        return [vector(f"{name}{i}") for i in range(3)]

    def placed(name):
        sums = (2 * summed("{name}{i}{j}", name=name, i=i) for i in range(3))
        return {"error": vector(f"e{name}", nonnegative=True), "extent": Vector(roughly(s, 4 * UNIT) for s in sums)}

    rows = linear("n")
    own = evaluator_of(sources, contracts={"roughInverse": rows})
    own.call("MeshAxes::MeshAxes", linear("B"))
    residual = own.variables["residual"]
    motion = {"gap": vector("g", DIFFERENCE), "travel": vector("t", 10 * UNIT)}
    variables = motion | {"a": placed("A"), "b": placed("B"), "span": positive("span")}
    evaluator = evaluator_of(sources)
    rounding = (evaluator.expression("PairMotion::PairMotion", ROUNDING, k=k, **variables) for k in range(3))
    motion |= {"rounding": Vector(rounding), "clearance": UNKNOWN}
    conditions = {"assumptions": {"motion.clearance > 0": False}, "contracts": {"radar::dot": evaluator.dot}}
    relative = evaluator_of(sources, globals={"side": 1}, **conditions)
    axes = {"rows": rows, "residual": vector("residual", nonnegative=True)}
    relative.call("RelativePlacement::RelativePlacement", axes, {"linear": linear("A")}, motion, 1)
    matrix, offset, travel, bound = (relative.variables[name] for name in ("matrix", "offset", "travel", "rounding"))
    for k in range(3):
        need = offset[k].error + travel[k].error + total(matrix[k][j].error for j in range(3)) * 2
        # Of a placement's error, half is needed, as `placement` proves.
        need += (summed("n{k}{i} eA{i}", k=k) + summed("n{k}{i} eB{i}", k=k)) * Fraction(51, 100)
        need += residual[k].error * 2
        # The residual itself is held to the last bit, for vertices that are below 2 by a float's unit.
        need = need * (1 / HELD) + symbol(f"residual{k}") * 2
        rules = at_most({f"residual{k}": residual[k].size.without("flushed")})
        yield Inequality(f"axis {k}", bound[k].least, need, [without_flushing, rules])


ROUNDING_FILE, VECTOR_FILE = "engine/math/rounding.h", "engine/math/vector.h"
MOTION_FILES = [ROUNDING_FILE, VECTOR_FILE, "engine/cpu/pair_motion.cpp"]


def claims():
    relative = [("kRelative", "16 * 0x1p-53")]
    determinants = [VECTOR_FILE, "engine/exact/determinant.h"]
    crosses = ["engine/exact/determinant.h", "engine/exact/determinant.cpp"]
    numbers = [ROUNDING_FILE, "engine/exact/bounded.h"]
    placements = [ROUNDING_FILE, "engine/cpu/pair_motion.cpp", "engine/math/frame.cpp"]
    mesh, pair, relation = (f"{name}::{name}" for name in ("MeshPlacement", "PairMotion", "RelativePlacement"))
    return [
        Claim("determinant", "estimate", relative, determinants, estimate),
        Claim("component of a cross product", "crossSign", relative, crosses, cross_sign),
        Claim("side beyond a slack", "sideBeyond", ["2.125 * slack"], ["engine/cpu/certificate.cpp"], side_beyond),
        Claim("numbers with bounds", "Bounded", [("kMore", "0x1p-49")], numbers, bounded_operations),
        Claim("placement of a mesh", mesh, ["16 * kUnit"], placements, placement),
        Claim("relative placement", pair, ["32 * kUnit"], MOTION_FILES, relative_placement),
        Claim("relative placement", relation, ["32 * kUnit"], MOTION_FILES, relative_placement),
    ]
