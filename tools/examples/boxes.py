"""Boxes, as meshes and as objects of a scene."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

import cyber_radar

CORNERS = np.stack(np.meshgrid(*[(-0.5, 0.5)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)  #: of a box of side 1
_SQUARES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
FACES = np.array([triangle for a, b, c, d in _SQUARES for triangle in ((a, b, c), (a, c, d))])  #: wound outwards


def add_boxes(scene: cyber_radar.Scene, boxes: Iterable[tuple], mask: int = 2**32 - 1) -> list[int]:
    """Adds boxes, given by their middles (3,) and sides (3,), and returns their ids."""
    poses = [np.vstack([np.column_stack([np.diag(sides), middle]), [0, 0, 0, 1]]) for middle, sides in boxes]
    return scene.add(scene.add_mesh(CORNERS, FACES), np.array(poses), mask=mask).tolist()
