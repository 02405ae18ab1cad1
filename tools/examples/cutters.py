"""Milling cutters: surfaces of revolution around the z axis with the tip at z = 0, and meshes that bracket them."""

from __future__ import annotations

import dataclasses

import numpy as np

Mesh = tuple[np.ndarray, np.ndarray]  # vertices (n, 3) float32, faces (m, 3)

_ROUNDING = 2.0**-22  # moves vertices inwards or outwards by more than rounding them to float32 may


@dataclasses.dataclass(frozen=True)
class Cutter:
    """A convex cutter: a flat tip, a corner that is an arc or a cone, and a shaft.

    radius: of the shaft. corner: radius of the arc between tip and shaft; as large as `radius` for a ball, 0 for a flat
    end mill. slope: instead of an arc, how much a cone rises per unit of radius.
    """

    radius: float
    length: float
    corner: float = 0.0
    slope: float = 0.0

    def height(self, distance: np.ndarray) -> np.ndarray:
        """How high the surface is above the tip at this distance from the axis; infinite beyond the shaft."""
        in_corner = np.clip(distance - (self.radius - self.corner), 0, self.corner)
        arc = self.corner - np.sqrt(np.maximum(self.corner**2 - in_corner**2, 0))
        return np.where(distance <= self.radius, arc + self.slope * distance, np.inf)

    def steepest(self, slope: np.ndarray) -> np.ndarray:
        """The distance from the axis at which the surface is as steep as a plane of this slope touches it."""
        if self.slope > 0:
            return np.where(slope > self.slope, self.radius, 0.0)
        touched = self.radius - self.corner + self.corner * slope / np.sqrt(1 + slope**2)
        return np.where(slope > 0, touched, 0.0)

    def inscribed(self, segments: int, steps: int) -> Mesh:
        """A mesh inside the cutter: it touches no earlier, so it falls no less deep."""
        turn = np.linspace(0, np.pi / 2, steps + 1) if self.corner > 0 else np.zeros(1)
        profile = self._profile(turn, np.ones_like(turn))
        return _revolved(profile, segments, 1 - _ROUNDING)

    def circumscribed(self, segments: int, steps: int) -> Mesh:
        """A mesh around the cutter."""
        step = np.pi / 2 / steps
        if self.corner > 0:
            turn = np.concatenate([[0], (np.arange(steps) + 0.5) * step, [np.pi / 2]])
            away = np.concatenate([[1], np.full(steps, 1 / np.cos(step / 2)), [1]])
        else:
            turn, away = np.zeros(1), np.ones(1)
        return _revolved(self._profile(turn, away), segments, (1 + _ROUNDING) / np.cos(np.pi / segments))

    def tessellation_error(self, segments: int, steps: int) -> float:
        """No point of the cutter is farther than this from either mesh, and no point of theirs from it."""
        around, along = 1 / np.cos(np.pi / segments) - 1, 1 / np.cos(np.pi / 4 / steps) - 1
        return self.radius * around + self.corner * along

    def _profile(self, turn: np.ndarray, away: np.ndarray) -> np.ndarray:
        """Distances from the axis and heights, from the tip to the end of the shaft."""
        if self.slope > 0:
            points = [[self.radius, self.slope * self.radius]]
        else:
            across = self.radius - self.corner + self.corner * away * np.sin(turn)
            points = np.stack([across, self.corner * (1 - away * np.cos(turn))], axis=1).tolist()
        points = [point for point in points if point[0] > 0]
        return np.array([*points, [self.radius, self.length]])


def cylinder(radius: float, low: float, high: float, segments: int) -> Mesh:
    """A holder: a cylinder around the z axis."""
    vertices, faces = _revolved(np.array([[radius, 0], [radius, high - low]]), segments, 1 / np.cos(np.pi / segments))
    return vertices + np.float32([0, 0, low]), faces


def _revolved(profile: np.ndarray, segments: int, widened: float) -> Mesh:
    """Closed, wound outwards: rings of `segments` corners, the tip in the middle of the first."""
    angles = np.arange(segments) * (2 * np.pi / segments)
    circle = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    rings = [np.column_stack([circle * (r * widened), np.full(segments, z)]) for r, z in profile]
    vertices = np.concatenate([*rings, [[0, 0, 0], [0, 0, profile[-1, 1]]]])
    tip, top = len(vertices) - 2, len(vertices) - 1
    here, after = np.arange(segments), np.roll(np.arange(segments), -1)
    faces = [np.column_stack([np.full(segments, tip), after, here])]
    for ring in range(len(rings) - 1):
        low, up = ring * segments, (ring + 1) * segments
        faces.append(np.column_stack([low + here, low + after, up + after]))
        faces.append(np.column_stack([low + here, up + after, up + here]))
    last = (len(rings) - 1) * segments
    faces.append(np.column_stack([np.full(segments, top), last + here, last + after]))
    return vertices.astype(np.float32), np.concatenate(faces)
