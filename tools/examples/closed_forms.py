"""Heights of round milling cutters above a part, in closed form, in numpy alone."""

from __future__ import annotations

import dataclasses

import numpy as np


@dataclasses.dataclass(frozen=True)
class Profile:
    """The lower surface of a convex cutter around the z axis: a flat tip, an arc, and the side of a cone up to the shaft.

    radius: of the shaft. core: of the flat tip. corner: of the arc around that. angle: radians, between the axis and the
    side, which begins where the arc is as steep; 0: there is no side.
    """

    radius: float
    core: float
    corner: float = 0.0
    angle: float = 0.0

    @property
    def side(self) -> tuple[float, float]:
        """How far from the axis the side begins, and its slope."""
        begins = self.core + self.corner * np.cos(self.angle) if self.angle else self.radius
        return begins, np.tan(np.pi / 2 - self.angle)

    def height(self, distance: np.ndarray) -> np.ndarray:
        """How high the surface is above the tip at this distance from the axis; infinite beyond the shaft."""
        begins, slope = self.side
        in_corner = np.clip(distance - self.core, 0, min(self.corner, begins - self.core))
        arc = self.corner - np.sqrt(self.corner**2 - in_corner**2)
        return np.where(distance <= self.radius, arc + slope * np.clip(distance - begins, 0, None), np.inf)

    def steepest(self, slope: np.ndarray) -> np.ndarray:
        """The distance from the axis at which the surface is as steep as a plane of this slope touches it."""
        begins, side = self.side
        on_arc = np.minimum(self.core + self.corner * slope / np.sqrt(1 + slope**2), begins)
        return np.where(slope > 0, np.where(slope > side, self.radius, on_arc), 0.0)


def exact_heights(cutter: Profile, corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    """The tip's height at each point (n, 2): the highest of q_z - height(|q - point|) over all points q of the
    triangles (m, 3, 3). That is at a vertex, at the steepest touch of a facet, or on an edge, where it is concave."""
    edges = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2, 3)
    highest = [_over(cutter, corners.reshape(-1, 3), points).max(axis=1)]
    highest.append(_on_facets(cutter, corners, points).max(axis=1))
    highest.append(_on_edges(cutter, edges, points).max(axis=1))
    return np.max(highest, axis=0)


def _over(cutter: Profile, q: np.ndarray, points: np.ndarray) -> np.ndarray:
    distance = np.linalg.norm(q[..., :2] - points[:, None], axis=-1)
    return q[..., 2] - cutter.height(distance)


def _on_facets(cutter: Profile, corners: np.ndarray, points: np.ndarray) -> np.ndarray:
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


def _on_edges(cutter: Profile, edges: np.ndarray, points: np.ndarray) -> np.ndarray:
    start, along = edges[:, 0], edges[:, 1] - edges[:, 0]
    # Where the edge is below the cutter: |start + s along - point| <= radius.
    away = start[:, :2] - points[:, None]
    a = (along[:, :2] ** 2).sum(axis=-1) + 1e-300
    b, c = (away * along[:, :2]).sum(axis=-1), (away**2).sum(axis=-1) - cutter.radius**2
    root = np.sqrt(np.maximum(b * b - a * c, 0))
    low, high = np.clip((-b - root) / a, 0, 1), np.clip((-b + root) / a, 0, 1)
    seen = (b * b > a * c) & (low < high)
    point, edge = np.nonzero(seen)
    start, along, low, high = start[edge], along[edge], low[seen], high[seen]

    def value(s):
        q = start + s[:, None] * along
        distance = np.minimum(np.linalg.norm(q[:, :2] - points[point], axis=-1), cutter.radius)
        return q[:, 2] - cutter.height(distance)

    for _ in range(80):
        one, two = low + (high - low) / 3, high - (high - low) / 3
        rises = value(one) < value(two)
        low, high = np.where(rises, one, low), np.where(rises, high, two)
    heights = np.full(seen.shape, -np.inf)
    heights[seen] = value((low + high) / 2)
    return heights
