"""Milling cutters, exact and without tessellation."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

from . import _engine
from ._arguments import one_number
from ._arrays import reals

Ring = Sequence[float]


@dataclasses.dataclass(frozen=True)
class Cutter:
    """A solid of revolution about the z axis of its pose, its tip at the origin: what flat(), ball_cutter(), bull_nose(),
    cone() and taper() make. Casts move it (Scene.cast, Scene.add_mesh), with poses that are rigid to 1e-6; objects and
    links of chains cannot be cutters. The CPU answers, whatever the mode, which cannot be "sampled".

    A cast's `tri_a` is the number of the part that touches, 0 for the cutting end, `point` is where the object is touched, and
    `t` is as exact as rounding allows; what passes at no distance, to rounding, may be UNDECIDED. A clearance grows the solid
    by a ball. Casts with turns, ignore_leaving, skip_overlapping, closest or exit are INVALID.
    """

    parts: tuple[tuple[tuple[float, float, float], ...], ...]
    """Of each convex part its rings (height, radius) or (height, radius, corner): circles about the axis, rounded by a
    ball; part 0 cuts."""

    def __post_init__(self) -> None:
        try:
            parts = [list(part) for part in self.parts]
        except TypeError:
            raise ValueError(f"parts: expected sequences of rings, got {self.parts!r}") from None
        rings = (tuple(_ring(ring, f"parts[{p}][{r}]") for r, ring in enumerate(part)) for p, part in enumerate(parts))
        object.__setattr__(self, "parts", tuple(rings))

    def with_holder(self, *parts: Sequence[Ring]) -> Cutter:
        """The same with shanks and holders above: each the convex hull of its rings (height, radius) or (height, radius,
        corner). `flat(3, 20).with_holder([(20, 2), (50, 2)], [(50, 15), (80, 20)])`"""
        return Cutter((*self.parts, *parts))  # type: ignore[arg-type]


def _ring(ring: Ring, name: str) -> tuple[float, float, float]:
    numbers = reals(ring, name)
    if numbers.shape not in ((2,), (3,)):
        raise ValueError(f"{name}: expected (height, radius) or (height, radius, corner), got {ring!r}")
    height, radius, corner = (*numbers.tolist(), 0.0)[:3]
    return height, radius, corner


def _cutter(kind: str, **numbers: float) -> Cutter:
    values = [one_number(value, name) for name, value in numbers.items()]
    return Cutter(_engine.Scene.cutter_rings(kind, values))  # type: ignore[arg-type]


def flat(radius: float, length: float) -> Cutter:
    """A flat end mill: a cylinder. Raises Error, as the following, unless its numbers are finite and above 0.

    >>> from cyber_radar import Scene
    >>> scene = Scene()
    >>> scene.add(scene.add_mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]]))
    0
    >>> casts = scene.cast(flat(1.5, 20), [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 4]], [0, 0, -5])
    >>> casts.t.round(9)
    4.0
    """
    return _cutter("flat", radius=radius, length=length)


def ball_cutter(radius: float, length: float) -> Cutter:
    """A ball, and a cylinder up to `length`, which is at least twice the radius."""
    return _cutter("ball", radius=radius, length=length)


def bull_nose(radius: float, corner: float, length: float) -> Cutter:
    """A cylinder whose lower rim is rounded by `corner`, which is at most the radius and half the length."""
    return _cutter("bull_nose", radius=radius, corner=corner, length=length)


def cone(radius: float, angle: float, length: float, tip_radius: float = 0) -> Cutter:
    """A cone, and a cylinder up to `length`, where the cone ends at the latest. angle: radians, below pi/2, between the
    axis and the side. tip_radius: of the flat tip, less than `radius`."""
    return _cutter("cone", radius=radius, angle=angle, length=length, tip_radius=tip_radius)


def taper(radius: float, angle: float, tip_radius: float, length: float) -> Cutter:
    """A ball of `tip_radius`, above it a cone that touches it, as of cone(), and a cylinder up to `length`, where both
    have ended."""
    return _cutter("taper", radius=radius, angle=angle, tip_radius=tip_radius, length=length)
