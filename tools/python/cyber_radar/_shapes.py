"""Round shapes, exact and without tessellation."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import numpy.typing as npt

from ._arguments import mesh_arrays, one_number
from ._arrays import reals


@dataclasses.dataclass(frozen=True, eq=False)
class Shape:
    """All points that are no farther than the radius from a mesh: what ball(), capsule() and rounded() make. Casts move
    it (Scene.cast, Scene.add_mesh); objects and links of chains cannot be round.

    A cast's clearance keeps that much more distance. The cast's `gap` and `sensor_point` are those of the mesh, so that
    at first contact the gap is the radius; `point` is where the object is touched.
    """

    vertices: npt.NDArray[np.float64]
    """(N, 3)"""
    faces: npt.NDArray[np.uint32]
    """(M, 3); of a ball or capsule one triangle of no area."""
    radius: float
    """World units, whatever the pose: one that scales the mesh does not scale it."""

    def __repr__(self) -> str:
        return f"<Shape of {len(self.faces)} triangles, radius {self.radius:g}>"


def ball(radius: float) -> Shape:
    """A ball around the origin of its pose. Raises ValueError unless the radius is from 0 to 2^1000.

    >>> from cyber_radar import Scene
    >>> scene = Scene()
    >>> scene.add(scene.add_mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]]))
    0
    >>> casts = scene.cast(ball(1.5), [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 4]], [0, 0, -4], mode="reference")
    >>> casts.t.round(5), casts.point
    (2.5, array([0., 0., 0.]))
    """
    return Shape(np.zeros((1, 3)), np.zeros((1, 3), np.uint32), _radius(radius))


def capsule(start: npt.ArrayLike, end: npt.ArrayLike, radius: float) -> Shape:
    """A ball around every point of the segment between two points, (3,), which may be the same. Raises ValueError as
    ball() does, or unless the points are of finite numbers that float32 can hold."""
    ends = [reals(point, name, (3,)) for point, name in ((start, "start"), (end, "end"))]
    if any(point.ndim != 1 for point in ends):
        raise ValueError("start, end: expected two points of shape (3,)")
    return Shape(*mesh_arrays(np.stack(ends), [[0, 1, 1]]), _radius(radius))


def rounded(mesh: Any, radius: float) -> Shape:
    """A mesh rounded by a ball, as a bull-nosed cutter is a disc. What its surface encloses, farther than the radius from
    it, is not a part of the shape.

    mesh: (vertices, faces), as read_mesh() returns them; a mesh of another package, as in Scene.add_mesh(); or a Shape,
        whose radius then grows. Raises ValueError as add_mesh() and ball() do.
    """
    before = mesh.radius if isinstance(mesh, Shape) else 0.0
    arrays = mesh if isinstance(mesh, tuple) and len(mesh) == 2 else (mesh, None)
    return Shape(*mesh_arrays(*arrays), before + _radius(radius))


def _radius(value: float) -> float:
    number = one_number(value, "radius")
    if not 0 <= number <= 2.0**1000:
        raise ValueError(f"radius: expected a number from 0 to 2^1000, got {number:g}")
    return number
