"""Pictures of triangles: an orthographic view with a depth buffer, in numpy."""

from __future__ import annotations

import numpy as np

BACKGROUND = np.array([255, 255, 255], np.uint8)


def view_from(direction: tuple[float, float, float]) -> np.ndarray:
    """Rows right, up and towards the viewer, (3, 3), of someone who looks from `direction`; z is up."""
    towards = np.array(direction) / np.linalg.norm(direction)
    right = np.cross([0, 0, 1], towards)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(towards, right), towards])


class Camera:
    """Fits points (n, 3) into a picture of this size, (width, height)."""

    def __init__(self, view: np.ndarray, points: np.ndarray, size: tuple[int, int], margin: float = 0.04) -> None:
        self.view, self.size = view, size
        flat = points @ view[:2].T
        low, high = flat.min(axis=0), flat.max(axis=0)
        self.scale = (1 - 2 * margin) * np.min(np.array(size) / np.maximum(high - low, 1e-300))
        self.middle = (low + high) / 2

    def pixels(self, points: np.ndarray) -> np.ndarray:
        """(..., 3) pixel coordinates, and closeness to the viewer."""
        seen = points @ self.view.T
        seen[..., :2] = (seen[..., :2] - self.middle) * self.scale
        seen[..., 0] += self.size[0] / 2
        seen[..., 1] = self.size[1] / 2 - seen[..., 1]
        return seen


def draw(camera: Camera, triangles: np.ndarray, colours: np.ndarray) -> np.ndarray:
    """(height, width, 3) bytes. triangles: (n, 3, 3) corners; colours: (n, 3), 0 to 1."""
    width, height = camera.size
    pixels, closeness, numbers = _fragments(camera.pixels(triangles), width, height)
    nearest = np.full(width * height, -1)
    order = np.argsort(closeness, kind="stable")
    nearest[pixels[order]] = numbers[order]  # of several, the last is kept: the closest
    shaded = (255 * _shaded(camera.view, triangles, colours)).astype(np.uint8)
    return np.where((nearest >= 0)[:, None], shaded[nearest], BACKGROUND).reshape(height, width, 3)


def _shaded(view: np.ndarray, triangles: np.ndarray, colours: np.ndarray) -> np.ndarray:
    """Lit from above the viewer's right shoulder, on both sides."""
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    light = np.array([0.35, 0.5, 0.79]) @ view
    return colours * (0.3 + 0.7 * np.abs(normals @ light))[:, None].clip(0, 1)


def _fragments(corners: np.ndarray, width: int, height: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Pixels whose centres the triangles cover, how close they are there, and which triangle it is."""
    flat = corners[..., :2]
    low = np.clip(np.ceil(flat.min(axis=1) - 0.5), 0, [width, height]).astype(int)
    high = np.clip(np.floor(flat.max(axis=1) - 0.5) + 1, 0, [width, height]).astype(int)
    extent = (high - low).max(axis=1)
    ab, ac = flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]
    area = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0]
    seen = ((high - low).min(axis=1) > 0) & (area != 0)
    found: list[tuple[np.ndarray, ...]] = [(np.zeros(0, int), np.zeros(0), np.zeros(0, int))]
    # Triangles of about one size at a time, so that one grid of pixels does for all of them.
    side = 1
    while side < 2 * max(width, height):
        which = np.flatnonzero(seen & (extent <= side) & (extent > side // 2))
        x, y = np.meshgrid(np.arange(side), np.arange(side))
        for some in np.array_split(which, max(1, len(which) * side * side >> 20)):
            px, py = low[some, 0, None, None] + x, low[some, 1, None, None] + y
            to = np.stack([px + 0.5, py + 0.5], axis=-1) - flat[some, 0, None, None]
            along, across = ab[some, None, None], ac[some, None, None]
            v = (to[..., 0] * across[..., 1] - to[..., 1] * across[..., 0]) / area[some, None, None]
            w = (along[..., 0] * to[..., 1] - along[..., 1] * to[..., 0]) / area[some, None, None]
            inside = (v >= 0) & (w >= 0) & (v + w <= 1) & (px < width) & (py < height)
            z = corners[some, :, 2][:, None, None]
            closeness = z[..., 0] + v * (z[..., 1] - z[..., 0]) + w * (z[..., 2] - z[..., 0])
            numbers = np.broadcast_to(some[:, None, None], inside.shape)
            found.append(((py * width + px)[inside], closeness[inside], numbers[inside]))
        side *= 2
    return tuple(np.concatenate(column) for column in zip(*found))  # type: ignore[return-value]


def colours_of(count: int) -> np.ndarray:
    """Colours that differ, (count, 3)."""
    hue = (np.arange(count) * 0.618034)[:, None] * 6 + np.array([0, 4, 2])
    full = np.abs(hue % 6 - 3).clip(1, 2) - 1
    return 0.35 + 0.6 * full
