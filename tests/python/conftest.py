"""Shapes and scenes of the tests. A message of the validation layers is a warning, and every warning fails a test."""

import base64
import json
import pathlib
import re

import numpy as np
import pytest

import cyber_radar

FACES = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1]]
    + [[2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
)
DOWN = np.array([0.0, 0.0, -10.0])


def box(*sides: float) -> np.ndarray:
    """Vertices of a box around the origin."""
    signs = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    return (signs * np.array(sides) / 2).astype(np.float32)


def write_obj(file: pathlib.Path, vertices=box(1, 1, 1), faces: np.ndarray = FACES) -> None:
    lines = ["v {} {} {}".format(*vertex) for vertex in np.asarray(vertices).tolist()]
    file.write_text("\n".join(lines + ["f {} {} {}".format(*face) for face in faces + 1]))


def at(positions) -> np.ndarray:
    """Poses that only move: (..., 3) to (..., 4, 4)."""
    positions = np.asarray(positions, dtype=np.float64)
    poses = np.broadcast_to(np.eye(4), (*positions.shape[:-1], 4, 4)).copy()
    poses[..., :3, 3] = positions
    return poses


def random_poses(rng: np.random.Generator, count: int, side: float) -> np.ndarray:
    """Turned, and moved into a cube of this side."""
    rotations, _ = np.linalg.qr(rng.normal(size=(count, 3, 3)))
    poses = at(rng.uniform(-side / 2, side / 2, (count, 3)))
    poses[:, :3, :3] = rotations
    return poses


def same_bits(a: np.ndarray, b: np.ndarray) -> bool:
    return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()


def same_answers(a: cyber_radar.Casts, b: cyber_radar.Casts, but: tuple[str, ...] = ()) -> bool:
    names = a.records.dtype.names
    assert names == b.records.dtype.names
    return all(same_bits(a.records[name], b.records[name]) for name in names if name not in but)


def numbers(array: dict) -> np.ndarray:
    """An array in the data of a page."""
    ((kind, text),) = array.items()
    return np.frombuffer(base64.b64decode(text), kind)


def page_data(file: pathlib.Path) -> dict:
    """What a page shows: the JSON in it."""
    found = re.search(r'<script type="application/json" id="data">(.*?)</script>', file.read_text(encoding="utf-8"))
    return json.loads(found[1])


def fill(scene: cyber_radar.Scene) -> int:
    """200 boxes of side 1 in a cube of side 20; returns their mesh."""
    mesh = scene.add_mesh(box(1, 1, 1), FACES)
    scene.add(mesh, random_poses(np.random.default_rng(1), 200, 20))
    return mesh


@pytest.fixture
def boxes() -> tuple[cyber_radar.Scene, int]:
    scene = cyber_radar.Scene(threads=2)
    return scene, fill(scene)


@pytest.fixture
def scene() -> cyber_radar.Scene:
    """A plate at z = 0."""
    made = cyber_radar.Scene()
    made.add(made.add_mesh([[0, 0, 0], [4, 0, 0], [0, 4, 0]], [[0, 1, 2]]))
    return made
