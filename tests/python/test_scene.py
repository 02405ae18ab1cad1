"""What a scene holds."""

import copy
import pickle
import types
import warnings

import numpy as np
import pytest

import cyber_radar
from conftest import DOWN, FACES, at, box, random_poses, same_answers

ENGINE = "/usr/share/assimp/models/glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb"


def test_objects_get_the_least_free_ids_and_keep_them():
    scene = cyber_radar.Scene()
    mesh = scene.add_mesh(box(1, 1, 1), FACES)
    assert scene.add(mesh) == 0
    assert scene.add(mesh, at(np.zeros((2, 3, 3)))).tolist() == [[1, 2, 3], [4, 5, 6]]
    assert scene.add([mesh, mesh]).tolist() == [7, 8]
    scene.remove([[2, 5], [2, 5]])
    assert len(scene) == 7
    assert scene.add(mesh, mask=[1, 2, 3]).tolist() == [2, 5, 9]
    assert scene.objects().ids.tolist() == list(range(10))
    assert scene.objects().masks[[0, 2, 5, 9]].tolist() == [2**32 - 1, 1, 2, 3]
    assert repr(scene) == "<Scene of 10 objects, 1 meshes>"


def test_objects_move():
    scene = cyber_radar.Scene()
    mesh = scene.add_mesh(box(1, 1, 1), FACES)
    scene.add(mesh, at([[0, 0, -3], [0, 0, -6]]))
    for mode in ("reference", "contact", "sampled"):
        scene.set_transforms([0, 1], at([[0, 0, -3], [0, 0, -6]]))
        assert scene.cast(mesh, None, DOWN, mode=mode).object == 0
        scene.set_transforms(0, at([0, 0, -7]))
        assert scene.cast(mesh, None, DOWN, mode=mode).object == 1
    assert (scene.objects().transforms == at([[0, 0, -7], [0, 0, -6]])).all()
    scene.set_transforms([[0, 1]], at([3, 0, 0]))
    assert scene.cast(mesh, None, [5, 0, 0], mode="reference").t == 2


def test_objects_move_during_a_cast():
    scene = cyber_radar.Scene()
    mesh = scene.add_mesh(box(1, 1, 1), FACES)
    scene.add(mesh, at([[0, 0, 9], [0, 0, -9]]))
    scene.set_motions(0, [0, 0, -8])
    scene.set_motions([1], [[0, 0, 0]])
    for mode in ("reference", "contact"):
        casts = scene.cast(mesh, None, [[0, 0, 8], [0, 0, 0], [0, 0, -16], [5, 0, 0]], mode=mode, hits="all")
        assert casts.fraction.tolist() == [0.5, 1.0, 0.5, np.inf]
        assert casts.t.tolist() == [4, 0, 8, np.inf]
        assert casts.object.tolist() == [0, 0, 1, -1]
        assert casts.hits.t.tolist() == [4, 0, 8] and casts.hits.fraction.tolist() == [0.5, 1, 0.5]
        assert (casts.point[1] == [0, 0, 0.5]).any()
    assert scene.objects().motions.tolist() == [[0, 0, -8], [0, 0, 0]]
    again = pickle.loads(pickle.dumps(scene))
    assert again.cast(mesh, None, [0, 0, 8], mode="reference").fraction == 0.5
    scene.set_motions([0, 1], [0, 0, 0])
    assert scene.cast(mesh, None, [0, 0, 0], mode="reference").status == cyber_radar.Status.CLEAR
    with pytest.raises(ValueError, match="motions: expected finite numbers"):
        scene.set_motions(0, [0, np.nan, 0])


def test_meshes_deform():
    scene = cyber_radar.Scene()
    mesh, still = scene.add_mesh(box(1, 1, 1), FACES), scene.add_mesh(box(1, 1, 1), FACES)
    scene.add(mesh, at([0, 0, -5]))
    for mode in ("reference", "contact", "sampled"):
        scene.set_vertices(mesh, box(1, 1, 1))
        assert scene.cast(still, None, DOWN, mode=mode, resolution=32).t == pytest.approx(4)
        scene.set_vertices(mesh, box(1, 1, 3))
        assert scene.cast(still, None, DOWN, mode=mode, resolution=32).t == pytest.approx(3)
    with pytest.raises(ValueError, match=r"vertices: expected shape \(8, 3\), got shape \(7, 3\)"):
        scene.set_vertices(mesh, box(1, 1, 1)[:7])


def test_meshes_are_kept_as_given_and_rounding_is_said():
    scene = cyber_radar.Scene()
    vertices = np.float32([[0, 0, 0], [0.1, 0, 0], [0, 1, 0]])
    mesh = scene.add_mesh(vertices, [[0, 1, 2]])
    kept, faces = scene.mesh(mesh)
    assert kept.dtype == np.float32 and (kept == vertices).all() and (faces == [[0, 1, 2]]).all()
    scene.add_mesh([[0, 0, 0], [0.5, 0, 0], [0, 1, 0]], [[0, 1, 2]])  # float32 holds these
    scene.add_mesh([[0, 0, 0], [0.1, 0, 0], [0, 1, 0]], [[0, 1, 2]])  # a billionth off, which is nothing to a mesh of 1
    scene.remove_mesh(2)
    stray = [[4512350.123, 0, 0], [4512351, 0, 0], [4512350, 1, 0], [0, 0, 0], [1, 0, 0], [0, 1, 0]]
    with pytest.warns(cyber_radar.RoundingWarning, match=r"change the mesh's numbers by up to 0\.12") as caught:
        scene.add_mesh(stray, [[0, 1, 2], [0, 2, 1], [3, 4, 5]])  # no base suits both
    assert caught[0].filename == __file__
    assert scene.meshes == [0, 1, 2]
    scene.remove_mesh(1)
    assert scene.meshes == [0, 2]
    scene.add(2)
    with pytest.raises(ValueError, match="mesh: expected a mesh that no object uses, got 2"):
        scene.remove_mesh(2)


def far_and_near(vertices: np.ndarray, offset: np.ndarray) -> tuple[cyber_radar.Scene, cyber_radar.Scene]:
    """Two objects of a mesh, the second turned and stretched, and a probe, mesh 1, in the frame of the first; in one
    scene the mesh's numbers are far from the origin, and the poses bring it back."""
    turned = np.array([[0, -2, 0, 30], [1, 0, 0, 0], [0, 0, 1, 4], [0, 0, 0, 1.0]])
    scenes = cyber_radar.Scene(), cyber_radar.Scene()
    for scene, by in zip(scenes, (offset, 0 * offset)):
        mesh = scene.add_mesh(vertices + by, FACES)
        scene.add(mesh, np.stack([at(-by), turned @ at(-by)]))
        scene.add_mesh(box(1, 1, 1), FACES)
    return scenes


def test_a_mesh_far_from_the_origin_loses_nothing():
    vertices, offset = box(8, 4, 2) + 2.0**-12, np.array([512340.0, 4512350.0, -296.0])
    rng = np.random.default_rng(5)
    poses = random_poses(rng, 300, 40)
    ways = rng.normal(size=(300, 3)) * 3 - 1.5 * poses[:, :3, 3]
    far, near = far_and_near(vertices, offset)
    assert far.mesh(0)[0].dtype == np.float64 and (far.mesh(0)[0] == vertices + offset).all()
    held = far.objects().transforms
    assert (held[0] == at(-offset)).all()

    def agree(*, up: float) -> None:
        """`up`: where the mesh is in the near scene."""
        for mode in ("reference", "contact"):
            one, other = (scene.cast(1, poses, ways, mode=mode) for scene in (far, near))
            assert same_answers(one, other) and other.touches.sum() > 100
            one = far.cast(0, poses @ at(-offset - [0, 0, up]), ways, mode=mode)
            other = near.cast(0, poses @ at([0, 0, -up]), ways, mode=mode)
            # These turned poses are themselves rounded to doubles of 4,512,350.
            np.testing.assert_allclose(one.t, other.t, rtol=0, atol=1e-7)
            assert other.touches.sum() > 100

    agree(up=0)
    for scene in (pickle.loads(pickle.dumps(far)), copy.deepcopy(far)):
        assert (scene.objects().transforms == held).all() and (scene.mesh(0)[0] == vertices + offset).all()
        assert same_answers(scene.cast(1, poses, ways, mode="reference"), far.cast(1, poses, ways, mode="reference"))
    up = np.array([0, 0, 2.0**20])
    for scene, by in ((far, offset), (near, 0 * offset)):  # about other bases
        scene.set_vertices(0, box(8, 4, 6) + 2.0**-12 + by + up)
        scene.set_transforms(0, at(-by - up))
    agree(up=2.0**20)
    far.set_vertices(0, vertices)
    assert far.mesh(0)[0].dtype == np.float32
    assert (far.objects().transforms[1] == held[1]).all()
    near.set_vertices(0, vertices)
    for scene in (far, near):
        scene.set_transforms([0, 1], poses[:2])
    assert same_answers(far.cast(1, poses, ways, mode="reference"), near.cast(1, poses, ways, mode="reference"))


def test_a_mesh_of_another_package_is_taken_as_it_is():
    scene = cyber_radar.Scene()
    vertices = box(1, 1, 1)
    like_trimesh = types.SimpleNamespace(vertices=vertices.astype(float), faces=FACES)
    like_open3d = types.SimpleNamespace(vertices=vertices.astype(float), triangles=FACES.astype(np.int32))
    for mesh in (like_trimesh, like_open3d):
        kept, faces = scene.mesh(scene.add_mesh(mesh))
        assert (kept == vertices).all() and (faces == FACES).all()
    with pytest.raises(ValueError, match="or a mesh that has .vertices and .faces or .triangles, got SimpleNamespace"):
        scene.add_mesh(types.SimpleNamespace(points=vertices, faces=FACES))


def test_a_mesh_file_is_read_as_the_program_reads_it(tmp_path):
    file = tmp_path / "a.obj"
    file.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\no lid\nf 1 2 3 4\no box\nf 4 2 1\nl 1 2\n")
    with pytest.warns(cyber_radar.MeshFileWarning, match="dropped 0 points and 1 line") as caught:
        vertices, faces = cyber_radar.read_mesh(file)
    assert caught[0].filename == __file__
    assert vertices.dtype == np.float32 and len(faces) == 3
    scene = cyber_radar.Scene()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cyber_radar.MeshFileWarning)
        mesh = scene.load_mesh(f"{file}#lid")
        assert len(scene.mesh(mesh)[1]) == 2
        assert scene.load_assembly(file).tolist() == [0, 1]
        assert (scene.mesh(scene.load_mesh(file, scale=0.001))[0] == np.float32(0.001) * vertices).all()
    assert scene.names == {0: "lid", 1: "box"}
    for wrong, message in (("b.obj", "no such file"), ("a.obj#roof", "a name that none has")):
        with pytest.raises(ValueError, match=message):
            scene.load_mesh(tmp_path / wrong)
    for wrong, message in ((0, "a finite number above 0, got 0"), ([1, 2], "scale: expected one number"), ("mm", "scale: ")):
        with pytest.raises(ValueError, match=message):
            scene.load_mesh(file, scale=wrong)


def test_an_assembly_has_an_object_for_each_node_and_keeps_the_names():
    scene = cyber_radar.Scene()
    objects = scene.load_assembly(ENGINE)
    assert objects.tolist() == list(range(67)) and len(scene.meshes) < 67
    assert sorted(scene.names) == objects.tolist() and scene.names[0] == "nodes[80]"
    moved = at([0, 0, 1000])
    again = scene.load_assembly(ENGINE, moved, mask=6)
    of_again = scene.objects().transforms[again]
    assert (of_again == moved @ scene.objects().transforms[objects]).all()
    assert (scene.objects().masks[again] == 6).all()
    small = scene.load_assembly(ENGINE, scale=0.5)
    unscaled, scaled = (scene.objects().transforms[some, :3] for some in (objects, small))
    assert (scaled[..., :3] == unscaled[..., :3]).all() and (scaled[..., 3] == unscaled[..., 3] / 2).all()
    scene.remove([*objects, *small])
    assert sorted(scene.names) == again.tolist()


def test_a_scene_pickles_as_its_recipe_with_its_ids():
    scene = cyber_radar.Scene(threads=1, cpu_batch=7)
    meshes = [scene.add_mesh(box(1, 1, side), FACES) for side in (1, 2, 3, 4)]
    rng = np.random.default_rng(2)
    scene.add(rng.choice([1, 3], 60), random_poses(rng, 60, 8), mask=rng.integers(1, 4, 60))
    scene.remove(rng.choice(60, 20, replace=False))
    scene.remove_mesh(meshes[0])
    scene.remove_mesh(meshes[2])
    scene.cast(1, None, DOWN)  # a scene with an open device, too
    poses, displacements = random_poses(rng, 80, 12), rng.normal(size=(80, 3)) * 4
    expected = scene.cast(3, poses, displacements, mask=2, mode="reference")
    assert expected.touches.any()
    for other in (pickle.loads(pickle.dumps(scene)), copy.deepcopy(scene)):
        assert other.meshes == [1, 3] and repr(other) == "<Scene of 40 objects, 2 meshes>"
        for a, b in zip(other.objects(), scene.objects()):
            assert (a == b).all()
        assert same_answers(other.cast(3, poses, displacements, mask=2, mode="reference"), expected)
    empty = pickle.loads(pickle.dumps(cyber_radar.Scene()))
    assert len(empty) == 0 and empty.meshes == []


def test_devices_are_listed_and_chosen():
    devices = cyber_radar.devices()
    assert [device.index for device in devices] == list(range(len(devices)))
    usable = [device for device in devices if device.usable]
    assert usable and usable[0].name and usable[0].version.startswith("1.")
    scene = cyber_radar.Scene(device=usable[0].index)
    mesh = scene.add_mesh(box(1, 1, 1), FACES)
    assert scene.device_names == []
    scene.cast(mesh, None, DOWN, mode="reference")
    assert scene.device_names == []
    scene.cast(mesh, None, DOWN)
    assert scene.device_names == [usable[0].name]
    absent = cyber_radar.Scene(device=len(devices))
    mesh = absent.add_mesh(box(1, 1, 1), FACES)
    with pytest.raises(cyber_radar.Error, match=f"{len(devices)}"):
        absent.cast(mesh, None, DOWN)
    assert absent.cast(mesh, None, DOWN, mode="reference").t == np.inf


def test_versions_name_what_was_built():
    versions = cyber_radar.versions()
    assert versions["cyber_radar"] == cyber_radar.__version__
    assert versions["numpy"] == np.__version__ and versions["commit"]
