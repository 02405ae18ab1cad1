"""Milling cutters around the z axis, as shapes, and their heights above a part in closed form."""

from __future__ import annotations

import dataclasses

import numpy as np

from cyber_radar import Shape, capsule, rounded

Mesh = tuple[np.ndarray, np.ndarray]  # vertices (n, 3) float32, faces (m, 3)

_ROUNDING = 2.0**-22  # moves vertices inwards or outwards by more than rounding them to float32 may


@dataclasses.dataclass(frozen=True)
class Tool:
    """A shape whose origin is so much higher than the tip: that is left to poses, since floats would round it."""

    shape: Shape
    above: float = 0.0


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

    def tool(self, segments: int, outside: bool = True) -> Tool:
        """A ball cutter, exactly: a capsule. Another: a polygon of so many corners around the axis, outside or inside the
        circle, rounded by the arc of the corner."""
        length = self.length - 2 * self.corner
        if self.corner == self.radius:
            return Tool(capsule([0, 0, 0], [0, 0, length], self.radius), self.corner)
        core, widened = self.radius - self.corner, _outside(segments) if outside else 1 - _ROUNDING
        profile = np.array([[core, self.slope * core], [core, length]])
        return Tool(rounded(_revolved(profile, segments, widened), self.corner), self.corner)

    def polygon_error(self, segments: int) -> float:
        """No point of the cutter is farther than this from either shape, and no point of theirs from it."""
        return (self.radius - self.corner) * (_outside(segments) - 1)

    def facets(self, segments: int, steps: int) -> Tool:
        """A mesh around the cutter, whose arc is made of `steps` facets, too."""
        step = np.pi / 2 / steps
        turn = np.concatenate([[0], (np.arange(steps) + 0.5) * step, [np.pi / 2]])
        away = self.corner * np.concatenate([[1], np.full(steps, 1 / np.cos(step / 2)), [1]])
        profile = np.stack([self.radius - self.corner + away * np.sin(turn), self.corner - away * np.cos(turn)], axis=1)
        profile = np.array([*profile[profile[:, 0] > 0], [self.radius, self.length]])
        return Tool(rounded(_revolved(profile, segments, _outside(segments)), 0))


def exact_heights(cutter: Cutter, corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    """The tip's height at each point (n, 2): the highest of q_z - height(|q - point|) over all points q of the
    triangles (m, 3, 3). That is at a vertex, at the steepest touch of a facet, or on an edge, where it is concave."""
    edges = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2, 3)
    highest = [_over(cutter, corners.reshape(-1, 3), points).max(axis=1)]
    highest.append(_on_facets(cutter, corners, points).max(axis=1))
    highest.append(_on_edges(cutter, edges, points).max(axis=1))
    return np.max(highest, axis=0)


def _over(cutter: Cutter, q: np.ndarray, points: np.ndarray) -> np.ndarray:
    distance = np.linalg.norm(q[..., :2] - points[:, None], axis=-1)
    return q[..., 2] - cutter.height(distance)


def _on_facets(cutter: Cutter, corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    corners, normals = corners[normals[:, 2] != 0], normals[normals[:, 2] != 0]
    gradient = -normals[:, :2] / normals[:, 2:]
    slope = np.linalg.norm(gradient, axis=1)
    uphill = gradient / np.maximum(slope, 1e-300)[:, None]
    to = points[:, None] + uphill * cutter.steepest(slope)[:, None]
    inside = np.ones(to.shape[:2], bool)
    for i in range(3):
        a, b = corners[:, i, :2], corners[:, (i + 1) % 3, :2]
        side = (b - a)[:, 0] * (to - a)[..., 1] - (b - a)[:, 1] * (to - a)[..., 0]
        inside &= side * np.sign(normals[:, 2]) >= 0
    z = corners[:, 0, 2] + ((to - corners[:, 0, :2]) * gradient).sum(axis=-1)
    return np.where(inside, z - cutter.height(cutter.steepest(slope)), -np.inf)


def _on_edges(cutter: Cutter, edges: np.ndarray, points: np.ndarray) -> np.ndarray:
    start, along = edges[:, 0], edges[:, 1] - edges[:, 0]
    # Where the edge is below the cutter: |start + s along - point| <= radius.
    away = start[:, :2] - points[:, None]
    a = (along[:, :2] ** 2).sum(axis=-1) + 1e-300
    b, c = (away * along[:, :2]).sum(axis=-1), (away**2).sum(axis=-1) - cutter.radius**2
    root = np.sqrt(np.maximum(b * b - a * c, 0))
    low, high = np.clip((-b - root) / a, 0, 1), np.clip((-b + root) / a, 0, 1)

    def value(s):
        q = start + s[..., None] * along
        distance = np.minimum(np.linalg.norm(q[..., :2] - points[:, None], axis=-1), cutter.radius)
        return q[..., 2] - cutter.height(distance)

    seen = (b * b > a * c) & (low < high)
    for _ in range(100):
        one, two = low + (high - low) / 3, high - (high - low) / 3
        rises = value(one) < value(two)
        low, high = np.where(rises, one, low), np.where(rises, high, two)
    return np.where(seen, value((low + high) / 2), -np.inf)


def _outside(segments: int) -> float:
    """By how much a polygon is larger than the circle in it."""
    return (1 + _ROUNDING) / np.cos(np.pi / segments)


def _revolved(profile: np.ndarray, segments: int, widened: float) -> Mesh:
    """Closed, wound outwards: rings of `segments` corners, the tip, at 0, in the middle of the first."""
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
