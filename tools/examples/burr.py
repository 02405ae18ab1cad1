"""A burr puzzle: six sticks of unit cubes, two along each axis, cut so that they fill their common middle exactly."""

from __future__ import annotations

import numpy as np

LENGTH = 6  # of a stick; it is 2 thick
AXES = np.concatenate([np.eye(3, dtype=int), -np.eye(3, dtype=int)])


# Which stick has each cube, in the order of coordinates. Found by chance: every stick is in one piece, they come apart
# one by one, and only stick 0, which has no notch, is free at the start.
_OWNERS = "00110011222200210021222222444444400414500115555555223344334440011450015555555533333300310031333300110011"


def pieces() -> list[np.ndarray]:
    """The cubes of each stick, (n, 3) whole coordinates."""
    cubes = np.unique(np.concatenate([_stick(axis, side) for axis in range(3) for side in (-2, 0)]), axis=0)
    owners = np.array(list(_OWNERS), int)
    return [cubes[owners == i] for i in range(6)]


def blocking(parts: list[np.ndarray]) -> np.ndarray:
    """By counting cubes: (directions of AXES, part, other part), whether the other is in the part's way."""
    result = np.zeros((len(AXES), len(parts), len(parts)), bool)
    for d, axis in enumerate(AXES):
        k = int(np.flatnonzero(axis)[0])
        beside = [i for i in range(3) if i != k]
        for i, part in enumerate(parts):
            for j, other in enumerate(parts):
                gap = other[None] - part[:, None]
                result[d, i, j] = i != j and ((gap[..., beside] == 0).all(axis=-1) & (gap[..., k] * axis[k] > 0)).any()
    return result


def surface(part: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The mesh of cubes: vertices (n, 3) float32 and faces (m, 3), closed and wound outwards."""
    taken = {tuple(cube) for cube in part.tolist()}
    corners, faces = [], []
    for cube in part:
        for axis in AXES:
            if tuple((cube + axis).tolist()) in taken:
                continue
            k, sign = int(np.flatnonzero(axis)[0]), int(axis.sum())
            u, v = np.eye(3, dtype=int)[[(k + 1) % 3, (k + 2) % 3]]
            origin = cube + (axis if sign > 0 else 0)
            square = [origin, origin + u, origin + u + v, origin + v]
            first = len(corners)
            corners += square if sign > 0 else square[::-1]
            faces += [[first, first + 1, first + 2], [first, first + 2, first + 3]]
    vertices, index = np.unique(np.array(corners, np.float32), axis=0, return_inverse=True)
    return vertices, index[np.array(faces)]


def _stick(axis: int, side: int) -> np.ndarray:
    """Two by two by LENGTH cubes around the middle; `side` puts it beside its twin."""
    across, pairwise = (axis + 1) % 3, (axis + 2) % 3
    grid = np.stack(
        np.meshgrid(np.arange(-LENGTH // 2, LENGTH // 2), (-1, 0), (side, side + 1), indexing="ij"), axis=-1
    )
    cubes = np.empty_like(grid.reshape(-1, 3))
    cubes[:, [axis, across, pairwise]] = grid.reshape(-1, 3)
    return cubes
