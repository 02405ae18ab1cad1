"""Motions that turn."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _engine
from ._arguments import regular
from ._arrays import common_shape, poses, reals


class Turns(NamedTuple):
    """What Scene.cast(turns=...) takes; any three arrays in this order will do."""

    axes: npt.NDArray[np.float64]  #: (..., 3) of any length; the turn is by the right-hand rule
    angles: npt.NDArray[np.float64]  #: (...) radians
    centres: npt.NDArray[np.float64]  #: (..., 3) where the axis is at the start, world


def turn_between(
    start: npt.ArrayLike, end: npt.ArrayLike, about: npt.ArrayLike | None = None
) -> tuple[Turns, npt.NDArray[np.float64]]:
    """The turns and displacements that take bodies from poses to poses, for Scene.cast().

    start, end: (..., 4, 4) or (..., 3, 4) world from mesh.
    about: (..., 3) the point of each body, in coordinates of its mesh, that goes straight, such as the middle of its box;
        None: (0, 0, 0).
    Leading shapes broadcast.

    Each turns by less than half a turn. Raises ValueError if poses differ by half a turn, to rounding, of which nobody
    knows which way it goes (pass its axis and angle to cast() instead), or by a scale, a shear or a mirror.

    >>> start, end = np.eye(4), np.eye(4)
    >>> end[:3, :3] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    >>> turns, displacements = turn_between(start, end, about=[2, 0, 0])
    >>> turns.centres, displacements
    (array([2., 0., 0.]), array([-2.,  2.,  0.]))
    """
    bodies = {
        "start": (regular(poses(start, "start"), "start"), 2),
        "end": (regular(poses(end, "end"), "end"), 2),
        "about": (np.zeros(3) if about is None else reals(about, "about", (3,)), 1),
    }
    shape = common_shape(bodies)
    flat = []
    for array, inner in bodies.values():
        own = array.shape[array.ndim - inner :]
        flat.append(np.broadcast_to(array, shape + own).reshape(-1, *own))
    axes, angles, centres, motions, wrong = _engine.turn_between(*flat)
    if wrong is not None:
        index = list(map(int, np.unravel_index(wrong[0], shape))) if shape else ""
        raise ValueError(f"turn_between{index}: {wrong[1].split(': ', 1)[1]}")
    vectors = (*shape, 3)
    return Turns(axes.reshape(vectors), angles.reshape(shape)[()], centres.reshape(vectors)), motions.reshape(vectors)


def turn_arrays(turns: Any) -> dict[str, tuple[npt.NDArray[Any], int]]:
    """Each with the number of its last dimensions that are not those of the casts."""
    try:
        axes, angles, centres = turns
    except (TypeError, ValueError):
        raise ValueError(f"turns: expected three arrays, axes, angles and centres, got {turns!r}") from None
    return {
        "turns: axes": (reals(axes, "turns: axes", (3,)), 1),
        "turns: angles": (reals(angles, "turns: angles"), 0),
        "turns: centres": (reals(centres, "turns: centres", (3,)), 1),
    }
