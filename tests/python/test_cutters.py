"""Cutters in Python: where they stop, and what they are refused for."""

import copy
import pickle

import numpy as np
import pytest

import cyber_radar
from conftest import at, numbers, page_data, same_answers
from cyber_radar import Feature, Status, ball_cutter, bull_nose, cone, flat, taper


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


def test_a_page_draws_a_cutter_of_parts(scene, tmp_path):
    tool = flat(1, 5).with_holder([(5, 3), (9, 3, 0.5)])
    shown = page_data(fall(scene, tool, [-2.5, 1, 0]).show(tmp_path / "page.html"))
    assert [mesh["parts"] for mesh in shown["meshes"]] == [0, 2] and numbers(shown["answers"]["tri_a"]).tolist() == [1]


def test_equal_cutters_share_a_mesh(scene):
    fall(scene, flat(1, 5), [1, 1, 5])
    meshes = len(scene.meshes)
    fall(scene, flat(1, 5), [2, 1, 5])
    assert len(scene.meshes) == meshes


def test_a_pickled_scene_keeps_cutters_and_their_ids(scene):
    gone, tool = scene.add_mesh(ball_cutter(2, 9)), scene.add_mesh(bull_nose(1, 0.5, 5).with_holder([(5, 3), (9, 3)]))
    scene.remove_mesh(gone)
    again = pickle.loads(pickle.dumps(copy.deepcopy(scene)))
    assert again.meshes == scene.meshes == [0, tool]
    places = [[-0.8, 1, 5], [-2.5, 1, 3], [1, 1, -1]]  # the rim, the holder, a plate that the solid encloses
    for casts in (fall(scene, tool, places), fall(again, tool, places)):
        assert casts.tri_a.tolist() == [0, 1, 0] and casts.status.tolist() == [Status.HIT, Status.HIT, Status.OVERLAP]
        assert same_answers(casts, fall(scene, tool, places))


def test_what_cutters_cannot_do_is_refused_by_name(scene):
    tool = flat(1, 5)
    mesh = scene.add_mesh(tool)
    for casts, problem in (
        (fall(scene, tool, [1, 1, 5], ignore_leaving=True), "ignore_leaving: expected none with a cutter"),
        (fall(scene, tool, [1, 1, 5], skip_overlapping=True), "skip_overlapping: expected none with a cutter"),
        (fall(scene, tool, [1, 1, 5], closest=True), "closest: expected none with a cutter"),
        (fall(scene, tool, [1, 1, 5], slack=9), "slack: expected at most a tenth of the sensor's size"),
        (scene.cast(tool, np.diag([2.0, 2.0, 2.0, 1.0]), [0, 0, 1]), "poses: a cutter: expected a rigid pose"),
    ):
        assert casts.status == Status.INVALID
        assert next(iter(casts.reasons)).startswith(problem)
    for call, problem in (
        (
            lambda: fall(scene, mesh, [1, 1, 5], mode="sampled"),
            'mesh, in mode "sampled": expected meshes, got 1, a cutter',
        ),
        (lambda: scene.add(mesh), "mesh: expected meshes, got 1, a cutter"),
        (lambda: scene.set_vertices(mesh, [[0, 0, 0]]), "mesh: expected one with vertices of its own, got 1, a cutter"),
        (
            lambda: cyber_radar.Chain(scene, [cyber_radar.Link("arm", meshes=[mesh])]),
            r"links\[0\] \('arm'\): meshes: expected meshes, got 1, a cutter",
        ),
        (lambda: flat(0, 5), "^radius: expected a number above 0"),
        (lambda: ball_cutter(1, 1.5), "^length: expected at least twice the radius"),
        (lambda: cone(1, 0.1, 30, tip_radius=1), "^tip_radius: expected 0 or more, less than the radius, got 1"),
        (lambda: taper(1, 0.5, 0.95, 9), "^tip_radius: expected less than"),
        (lambda: scene.add_mesh(cyber_radar.Cutter(())), "^parts: expected one or more"),
        (
            lambda: fall(scene, tool.with_holder([(5, -1)]), [1, 1, 5]),
            r"^parts\[1\]\[0\]: radius: expected 0 to 2\^100",
        ),
        (lambda: scene.add_mesh(tool.with_holder([(5, 0)])), r"^parts\[1\]: expected rings that span a solid"),
        (lambda: tool.with_holder([(1, 2), (1,)]), r"parts\[1\]\[1\]: expected \(height, radius\) or"),
        (lambda: tool.with_holder([(1, "2")]), r"parts\[1\]\[0\]: expected numbers"),
        (lambda: tool.with_holder(5), "parts: expected sequences of rings"),
        (lambda: cyber_radar.Cutter("flat"), r"parts\[0\]\[0\]: expected"),
        (lambda: scene.add_mesh(tool, [[0, 1, 2]]), "faces: expected none with a Cutter"),
    ):
        with pytest.raises((ValueError, cyber_radar.Error), match=problem):
            call()
