"""Inputs that claims of several files have."""
from fractions import Fraction

from claims import Inequality, Shared
from evaluator import Evaluator, Matrix, Vector
from rounding import plain, symbol

# A node's centre and half extent are at most this times the mesh's reach, together.
WITHIN = 1 + Fraction(1, 1 << 22)
# No unit vector's components add up to more.
ROOT_OF_3 = Fraction(17321, 10000)


def positive(name, **more):
    return plain(name, nonnegative=True, **more)


def vector(name, relative=0, make=plain, **more):
    """Numbers with symbols `name` and 0 to 2, whose errors are relative to themselves."""
    return Vector(make(f"{name}{k}", symbol(f"{name}{k}") * relative, **more) for k in range(3))


def matrix(name, relative, make=plain):
    """A matrix of such numbers, with symbols `name` and their row and column."""
    return Matrix(map(Vector, zip(*(vector(f"{name}{i}", relative, make) for i in range(3)))))


def mean_error(one, other):
    """What both ends of an interval are off by on average."""
    return (one.error + other.error) * Fraction(1, 2)


def symbols(name):
    return [symbol(f"{name}{k}") for k in range(3)]


def holds(arithmetic, function, *arguments, steps, spare=0, **conditions):
    """A statement: the error of what a function returns, a value or a vector, is at most its bound less `spare`."""

    def statement(sources):
        result = Evaluator(sources, arithmetic, **conditions).call(function, *arguments)
        values, errors = (x if isinstance(x, Vector) else [x] for x in (result["value"], result["error"]))
        for k, (value, error) in enumerate(zip(values, errors, strict=True)):
            yield Inequality(f"error of component {k} of {function}", error.least, value.error + spare, steps)

    return statement


def together(one, other, bound):
    """A step: two sizes within a reach, of which `bound` is one."""
    return Shared([(one,), (other,)], bound * WITHIN)


def within(letter, reach):
    """Steps: a node's box, of vectors named centre and half and the letter, is within its mesh's reach."""
    return [together(f"centre{letter}{k}", f"half{letter}{k}", reach[k]) for k in range(3)]


