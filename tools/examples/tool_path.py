"""A tool's path over a part: straight moves, none of which cuts too deep."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

DIGITS = 4  # that are written behind the point
Touches = Callable[[np.ndarray, np.ndarray], np.ndarray]


def written(numbers: np.ndarray) -> np.ndarray:
    return np.round(numbers, DIGITS)


def written_up(numbers: np.ndarray) -> np.ndarray:
    """No number becomes less."""
    return written(np.ceil(numbers * 10**DIGITS) / 10**DIGITS)


def poses_at(points: np.ndarray) -> np.ndarray:
    """(..., 4, 4): the tip at these points (..., 3)."""
    poses = np.zeros((*points.shape[:-1], 4, 4)) + np.eye(4)
    poses[..., :3, 3] = points
    return poses


def length(points: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def free_path(points: np.ndarray, height: Callable[[np.ndarray], np.ndarray], touches: Touches, shortest: float):
    """The same path (n, 3) with more points, so that no move touches the part; and whether each move of the given one
    did.

    height: of the tip at points (n, 2). touches: of moves, given their starts and their ends (n, 3). A move that touches
    is halved by a point at its height; one that is not longer than `shortest` is raised.
    """
    points, unknown, gouged = points.copy(), np.ones(len(points) - 1, bool), None
    rise = shortest
    while unknown.any():
        moves = np.flatnonzero(unknown)
        unknown[moves] = touches(points[moves], points[moves + 1])
        gouged = unknown.copy() if gouged is None else gouged
        moves = np.flatnonzero(unknown)
        is_short = np.linalg.norm(points[moves + 1, :2] - points[moves, :2], axis=1) <= shortest
        short, long = moves[is_short], moves[~is_short]
        ends = np.concatenate([short, short + 1])
        top = np.maximum(points[short, 2], points[short + 1, 2])
        top = written_up(np.where(points[short, 2] == points[short + 1, 2], top + rise, top))
        np.maximum.at(points[:, 2], ends, np.tile(top, 2))
        rise *= 2 if len(short) else 1
        unknown[np.clip(ends, 0, len(unknown) - 1)] = unknown[np.clip(ends - 1, 0, None)] = True
        middles = written(0.5 * (points[long, :2] + points[long + 1, :2]))
        points = np.insert(points, long + 1, np.column_stack([middles, height(middles)]), axis=0)
        unknown = np.insert(unknown, long + 1, True)
    return points, gouged
