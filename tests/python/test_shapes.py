"""Round shapes in Python: where they stop, and what they are refused for."""

import pickle

import numpy as np

import cyber_radar
from conftest import FACES, at, box, page_data, random_poses, same_answers
from cyber_radar import Feature, Status, ball, capsule, rounded
from test_arguments import refusal


def fall(scene, shape, place, **options):
    return scene.cast(shape, at(place), [0, 0, -9], **{"mode": "reference", "tolerance": 1e-12, **options})


def test_shapes_fall_onto_a_face_an_edge_and_a_corner(scene):
    for mode in ("contact", "reference"):
        casts = fall(scene, ball(2), [[1, 1, 5], [1, -1, 5], [-1, -1, 5], [1, -2.1, 5], [1, 1, 1.9]], mode=mode)
        np.testing.assert_allclose(casts.t[:3], [3, 5 - np.sqrt(3), 5 - np.sqrt(2)], atol=1e-11)
        assert casts.status[3:].tolist() == [Status.CLEAR, Status.OVERLAP]
        assert casts.feature_b[:3].tolist() == [Feature.FACE, Feature.EDGE, Feature.VERTEX]
        assert (casts.feature_a[:3] == Feature.VERTEX).all()
        np.testing.assert_allclose(casts.point[:3], [[1, 1, 0], [1, 0, 0], [0, 0, 0]], atol=1e-11)
        np.testing.assert_allclose(casts.gap[:3], 2, atol=1e-11)
    across = fall(scene, capsule([0, -2, 0], [0, 2, 0], 1), [[-0.5, 0, 5], [1, 1, 5]])
    np.testing.assert_allclose(across.t, [5 - np.sqrt(0.75), 4], atol=1e-11)
    disc = rounded(([[-1, -1, 0], [1, -1, 0], [0, 1, 0]], [[0, 1, 2]]), 0.5)
    np.testing.assert_allclose(fall(scene, disc, [[1, 2, 5], [1, -1.3, 5]]).t, [4.5, 5 - 0.4], atol=1e-11)
    assert rounded(disc, 0.25).radius == 0.75


def test_a_clearance_comes_on_top_of_the_radius_in_every_cast_of_a_large_batch(scene):
    mesh, plain = scene.add_mesh(ball(2)), scene.add_mesh([[0, 0, 0]], [[0, 0, 0]])
    many = 30_000  # several chunks
    casts = scene.cast([[mesh], [plain]], at([1, 1, 7]), np.zeros((many, 3)) + [0, 0, -9], tolerance=1e-9, clearance=0.5,
                       mode="reference")  # fmt: skip
    np.testing.assert_allclose(casts.t, np.broadcast_to([[4.5], [6.5]], (2, many)), atol=1e-8)
    each = fall(scene, mesh, [1, 1, 7], clearance=[0, 1, -1, np.nan])
    np.testing.assert_allclose(each.t[:2], [5, 4], atol=1e-11)
    assert each.status[2:].tolist() == [Status.INVALID] * 2


def test_equal_shapes_are_one_mesh_until_it_is_removed(scene):
    fall(scene, ball(1), [1, 1, 5])
    known = scene.meshes
    fall(scene, ball(1.0), [1, 1, 5])
    assert scene.meshes == known == [0, 1]
    fall(scene, ball(2), [1, 1, 5])
    assert scene.meshes == [0, 1, 2]
    scene.remove_mesh(1)
    assert scene.add_mesh(box(1, 1, 1), FACES) == 1
    np.testing.assert_allclose(fall(scene, ball(1), [1, 1, 5]).t, 4, atol=1e-11)
    np.testing.assert_allclose(fall(scene, 1, [1, 1, 5]).t, 4.5, atol=1e-11)


def test_a_pickled_scene_keeps_radii(scene):
    mesh = scene.add_mesh(capsule([0, 0, 0], [0, 0, 3], 1))
    again = pickle.loads(pickle.dumps(scene))
    assert same_answers(fall(scene, mesh, [[1, 1, 5], [0, -0.5, 5]]), fall(again, mesh, [[1, 1, 5], [0, -0.5, 5]]))


def test_what_cannot_be_round_is_refused_by_name(scene):
    mesh = scene.add_mesh(ball(2))
    for call, words in (
        (lambda: ball(-1), "radius: expected a number from 0 to 2^1000, got -1"),
        (lambda: ball(np.nan), "radius: expected a number from 0 to 2^1000, got nan"),
        (lambda: ball([1, 2]), "radius: expected one number"),
        (lambda: capsule([0, 0], [0, 0, 1], 1), "start: expected numbers of shape"),
        (lambda: capsule([[0, 0, 0]], [0, 0, 1], 1), "start, end: expected two points"),
        (lambda: capsule([0, 0, 0], [0, 0, np.inf], 1), "vertices[1]: expected 3 finite numbers"),
        (lambda: rounded("part.stl", 1), "load_mesh() reads a file"),
        (lambda: rounded(([[0, 0, 0]], [[0, 0, 0]]), np.inf), "radius: expected a number from 0"),
        (lambda: scene.add(mesh), "mesh: expected meshes without a radius, got 1, of radius 2"),
        (lambda: fall(scene, mesh, [0, 0, 5], mode="sampled", tolerance=None), 'mesh, in mode "sampled": expected'),
        (
            lambda: cyber_radar.Chain(scene, [cyber_radar.Link("arm", meshes=[mesh])]),
            "links[0] ('arm'): meshes: expected meshes without a radius",
        ),
    ):
        assert words in refusal(call)


def test_a_page_draws_balls_and_capsules_and_names_the_clearance_beside_the_radius(scene, tmp_path):
    fall(scene, ball(2), [[1, 1, 5]]).show(tmp_path / "ball.html")
    shown = page_data(tmp_path / "ball.html")
    drawn = [mesh for mesh in shown["meshes"] if mesh["isRound"]]
    assert len(shown["meshes"]) == 3 and len(drawn) == 1 and drawn[0]["radius"] == 2
    assert "clearance" not in shown["queries"]["asked"].get("0", {})
    stretched = np.diag([1, 1, 2, 1]) + [[0, 0, 0, 1], [0, 0, 0, 1], [0, 0, 0, 5], [0, 0, 0, 0]]
    rod = capsule([0, 0, 0], [0, 0, 3], 1)
    casts = scene.cast(rod, [np.eye(4), stretched, at([1, 1, 5])], [0, 0, -9], clearance=0.5, mode="reference")
    shown = page_data(casts.show(tmp_path / "rod.html"))
    assert [mesh["radius"] for mesh in shown["meshes"] if mesh["isRound"]] == [1, 1]  # of two lengths
    assert shown["queries"]["asked"]["0"]["clearance"] == 0.5


def test_a_device_gives_the_answers_of_the_cpu():
    rng = np.random.default_rng(5)
    device = cyber_radar.Scene(cpu_batch=0)
    cube = device.add_mesh(box(1, 1, 1), FACES)
    device.add(cube, random_poses(rng, 60, 8))
    shapes = [ball(0.3), capsule([0, 0, -1], [0, 0.5, 1], 0.2), rounded(device.mesh(cube), 0.25)]
    meshes = np.array([device.add_mesh(shape) for shape in shapes])
    poses, ways = random_poses(rng, 300, 12), rng.normal(size=(300, 3)) * 6
    options = {"clearance": rng.choice([0, 0.1], 300), "hits": "all"}
    casts = [device.cast(meshes[:, None], poses, ways, mode=mode, **options) for mode in ("contact", "reference")]
    assert same_answers(*casts, but=("tier",)) and same_answers(casts[0].hits, casts[1].hits, but=("tier",))
    assert 100 < casts[0].touches.sum() < 800
