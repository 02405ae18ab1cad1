"""Casts that turn: answers are the program's and geometry's, and two poses make a turn."""

import re

import numpy as np
import pytest

import cyber_radar
from conftest import FACES, at, box, random_poses, write_obj
from test_arguments import refusal
from test_program import ask_program, column, instance

COUNT = 2000


def rotation(axis, angle) -> np.ndarray:
    """(..., 3, 3) by O. Rodrigues."""
    x, y, z = np.moveaxis(np.asarray(axis) / np.linalg.norm(axis, axis=-1, keepdims=True), -1, 0)
    zero = np.zeros_like(x)
    k = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=-1).reshape(*x.shape, 3, 3)
    angle = np.asarray(angle)[..., None, None]
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * (k @ k)


@pytest.fixture
def gate() -> tuple[cyber_radar.Scene, int]:
    """A rod of length 10 along x, and a post of side 1 whose nearest edge is at (-0.5, 6.5)."""
    scene = cyber_radar.Scene(threads=2)
    rod = scene.add_mesh(box(10, 1, 1), FACES)
    scene.add(scene.add_mesh(box(1, 1, 3), FACES), at([-1, 6, 0]))
    return scene, rod


def test_random_turns_have_the_answers_of_the_program(tmp_path):
    rng = np.random.default_rng(67)
    objects, poses = random_poses(rng, 60, 16), random_poses(rng, COUNT, 16)
    ways = rng.normal(size=(COUNT, 3)) * (np.arange(COUNT) % 2)[:, None]
    turns = cyber_radar.Turns(rng.normal(size=(COUNT, 3)), rng.uniform(-3, 3, COUNT), rng.uniform(-9, 9, (COUNT, 3)))
    write_obj(tmp_path / "box.obj")
    queries = {
        "format": "cyber-radar-queries-1",
        "meshes": ["box.obj"],
        "scenes": [{"id": "s", "instances": [instance(0, pose) for pose in objects]}],
        "queries": [
            {"id": str(i), "scene": 0, "sensor": instance(0, poses[i]), "motion": way.tolist(),
             "turn": {"axis": axis.tolist(), "angle": angle, "centre": centre.tolist()}}
            for i, (way, axis, angle, centre) in enumerate(zip(ways, *turns))
        ],
    }  # fmt: skip
    answers = ask_program(tmp_path, queries)
    scene = cyber_radar.Scene(threads=2)
    mesh = scene.load_mesh(tmp_path / "box.obj")
    scene.add(mesh, objects)
    casts = scene.cast(mesh, poses, ways, turns=turns)
    for name, member in (("t", "fraction"), ("fraction", "fraction"), ("lo", "fraction_lo"), ("hi", "fraction_hi")):
        assert (casts.records[name] == column(answers, member, np.inf)).all(), name
    assert (casts.object == column(answers, "object", -1)).all()
    hits = casts[casts.status == cyber_radar.Status.HIT]
    assert 0.2 < len(hits) / COUNT < 0.8 and (hits.hi - hits.lo).max() < 1e-5


def test_what_no_turn_can_be_makes_that_cast_invalid_and_says_why(gate):
    scene, rod = gate
    axes = [[0, 0, 1], [0, 0, 0], [0, np.nan, 1], [0, 0, 1], [0, 0, 1]]
    casts = scene.cast(rod, at([5, 0, 0]), turns=(axes, [1, 1, 1, 1e6, 1], [*[[0, 0, 0]] * 4, [np.inf, 0, 0]]))
    assert casts.status.tolist() == [1, 4, 4, 4, 4]
    assert {int(i): reason[:30] for reason, found in casts.reasons.items() for i in found} == {
        1: "turns: expected an axis that i",
        2: "turns: expected an axis of 3 f",
        3: "turns: expected a finite angle",
        4: "turns: expected a centre up to",
    }


def test_messages_name_turns_and_what_does_not_go_with_them(gate):
    scene, rod = gate
    turns = ([0, 0, 1], 1.0, [0, 0, 0])

    def cast(*arguments, **options):
        return lambda: scene.cast(rod, None, *arguments, **options)

    for call, words in (
        (cast(), "displacements: expected numbers of shape (..., 3), or turns, got neither"),
        (cast(turns=5.0), "turns: expected three arrays, axes, angles and centres, got 5.0"),
        (cast(turns=turns[:2]), "turns: expected three arrays, axes, angles and centres, got ([0, 0, 1], 1.0)"),
        (cast(turns=([0, 0], 1.0, [0, 0, 0])), "turns: axes: expected numbers of shape (..., 3), got shape (2,)"),
        (cast(turns=([0, 0, 1], "x", [0, 0, 0])), "turns: angles: expected numbers of at most double precision"),
        (cast(turns=([0, 0, 1], [1, 2], np.zeros((3, 3)))), "got turns: angles (2,), turns: centres (3, 3)"),
        (cast([0, 0, 1], turns=turns, distances=1), "distances: expected none with turns"),
        (cast(turns=turns, mode="sampled"), 'mode: expected "contact" or "reference" with turns, got "sampled"'),
    ):
        assert words in refusal(call)
    both = scene.cast(rod, None, turns=turns, ignore_leaving=[False, True], clearance=0.1)
    assert [[*found] for found in both.reasons.values()] == [[1]]
    assert list(both.reasons)[0] == "turns: expected no ignore_leaving beside it and a clearance"


def test_two_poses_make_the_turn_that_leads_from_one_to_the_other(gate):
    rng = np.random.default_rng(7)
    start = random_poses(rng, 500, 9) @ np.diag([2, -1, 3, 1.0])
    axis, angle = rng.normal(size=(500, 3)), rng.uniform(0.1, 3, 500)
    about, ways = rng.normal(size=(500, 3)), rng.normal(size=(500, 3))
    centre = (start[:, :3, :3] @ about[..., None])[..., 0] + start[:, :3, 3]
    turned = rotation(axis, angle)
    end = start.copy()
    end[:, :3, :3] = turned @ start[:, :3, :3]
    end[:, :3, 3] = centre + ways - (end[:, :3, :3] @ about[..., None])[..., 0]
    turns, displacements = cyber_radar.turn_between(start[:, :3], end, about)
    np.testing.assert_allclose(rotation(turns.axes, turns.angles), turned, atol=1e-13)
    for found, expected in ((turns.angles, angle), (turns.centres, centre), (displacements, ways)):
        np.testing.assert_allclose(found, expected, atol=1e-13)
    assert all(array.shape[:2] == (2, 500) for array in cyber_radar.turn_between(start, np.stack([end, end]))[0])
    # In a cast: from clear of the post to well into it.
    scene, rod = gate
    start, end = at([5, 0, 0]), at([-1, 3, 0])
    end[:3, :3] = rotation([0, 0, 1.0], 1.5)
    turns, displacements = cyber_radar.turn_between(start, end, about=[-5, 0, 0])
    touches = [scene.cast(rod, pose, [0, 0, 0]).touches for pose in (start, end)]
    assert touches == [False, True] and 0 < scene.cast(rod, start, displacements, turns=turns).t < 1


def test_poses_that_no_turn_leads_between_are_refused_by_place(gate):
    start = at(np.zeros((2, 2, 3)))
    half = start.copy()
    half[1, 0, :3, :3] = rotation(np.array([1.0, 2, 3]), np.pi)
    for end, words in (
        (half, r"turn_between\[1, 0\]: expected less than half a turn"),
        (start @ np.diag([1, 1, -1.0, 1]), r"turn_between\[0, 0\]: expected an end .* mirror image"),
        (start[0, 0] @ np.diag([2, 2, 2.0, 1]), r"turn_between\[0, 0\]: expected an end .* scaled or sheared, by 3"),
        (start * np.nan, r"end\[0, 0\]: "),
        (np.eye(3), r"end: expected numbers of shape"),
    ):
        assert re.search(words, refusal(lambda end=end: cyber_radar.turn_between(start, end)))
    assert "turn_between: expected" in refusal(lambda: cyber_radar.turn_between(np.eye(4), half[1, 0]))
    assert "about: expected" in refusal(lambda: cyber_radar.turn_between(start, start, [np.nan, 0, 0]))
    shapes = refusal(lambda: cyber_radar.turn_between(start, np.eye(4), np.eye(3)))
    assert "got start (2, 2, 4, 4), about (3, 3)" in shapes
    assert cyber_radar.turn_between(start[:0], start[:0])[0].angles.shape == (0, 2)
