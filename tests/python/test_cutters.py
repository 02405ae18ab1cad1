"""Cutters in Python: where they stop, and what they are refused for."""

import numpy as np
import pytest

import cyber_radar
from conftest import at
from cyber_radar import Feature, Status, ball_cutter, bull_nose, cone, flat, taper


@pytest.fixture
def scene() -> cyber_radar.Scene:
    """A plate at z = 0."""
    made = cyber_radar.Scene()
    made.add(made.add_mesh([[0, 0, 0], [4, 0, 0], [0, 4, 0]], [[0, 1, 2]]))
    return made


def fall(scene, tool, place, **options):
    return scene.cast(tool, at(place), [0, 0, -9], **options)


def test_cutters_fall_onto_a_face_and_an_edge(scene):
    edge = np.array([1, -0.6, 5])
    for tool, drop in (
        (flat(1, 20), 5),
        (ball_cutter(1, 20), 5 + 1 - 0.8),
        (bull_nose(1, 0.5, 20), 5 + 0.5 - np.sqrt(0.25 - 0.01)),
        (cone(1, np.pi / 4, 20), 5 + 0.6),
        (taper(1, np.pi / 4, 0.5, 20), 5 + 0.5 - np.sqrt(0.5) + 0.6),
    ):
        for mode in ("contact", "reference"):
            casts = fall(scene, tool, [[1.5, 1, 5], edge, [1, -1.1, 5]], mode=mode)
            np.testing.assert_allclose(casts.t[:2], [5, drop], atol=1e-12)
            assert casts.status.tolist() == [Status.HIT, Status.HIT, Status.CLEAR]
            assert casts.feature_b[:2].tolist() == [Feature.FACE, Feature.EDGE]
            np.testing.assert_allclose(casts.normal[0], [0, 0, 1], atol=1e-15)


def test_a_holder_is_a_part_of_its_own(scene):
    tool = flat(1, 5).with_holder([(5, 3), (9, 3, 0.5)])
    casts = fall(scene, scene.add_mesh(tool), [-2.5, 1, 0])
    assert (casts.status, casts.tri_a) == (Status.HIT, 1)
    np.testing.assert_allclose(casts.t, 5, atol=1e-12)
    assert len(tool.parts) == 2 and flat(1, 5) == flat(1, 5)


def test_equal_cutters_share_a_mesh(scene):
    fall(scene, flat(1, 5), [1, 1, 5])
    meshes = len(scene.meshes)
    fall(scene, flat(1, 5), [2, 1, 5])
    assert len(scene.meshes) == meshes


def test_what_cutters_cannot_do_is_refused_by_name(scene):
    tool = flat(1, 5)
    mesh = scene.add_mesh(tool)
    for casts, problem in (
        (fall(scene, tool, [1, 1, 5], mode="sampled"), "expected contact with a cutter"),
        (fall(scene, tool, [1, 1, 5], ignore_leaving=True), "with a cutter"),
        (scene.cast(tool, np.diag([2.0, 2.0, 2.0, 1.0]), [0, 0, 1]), "expected a rigid pose"),
    ):
        assert casts.status == Status.INVALID
        assert problem in next(iter(casts.reasons))
    for call, problem in (
        (lambda: scene.add(mesh), "is a cutter"),
        (lambda: flat(0, 5), "flatCutter: radius"),
        (lambda: ball_cutter(1, 1.5), "at least twice the radius"),
        (lambda: tool.with_holder([(1,)]), "ring: expected"),
    ):
        with pytest.raises((ValueError, cyber_radar.Error), match=problem):
            call()
