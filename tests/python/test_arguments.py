"""Wrong arguments end with an exception that says what was expected, never otherwise."""


import numpy as np
import pytest

import cyber_radar
from conftest import DOWN, FACES, at, box, same_answers


def refusal(call) -> str:
    with pytest.raises(ValueError) as caught:
        call()
    return str(caught.value)


def test_messages_name_the_argument_and_the_shape(boxes):
    scene, mesh = boxes
    cast = scene.cast
    six = np.zeros((6, 3))
    for call, words in (
        (lambda: cast(mesh, np.eye(3), DOWN), "poses: expected numbers of shape (..., 4, 4) or (..., 3, 4), got shape (3, 3)"),
        (lambda: cast(mesh, None, 5.0), "displacements: expected numbers of shape (..., 3), got shape ()"),
        (lambda: cast(mesh, None, [[0, 0], [1]]), "displacements: expected numbers of shape (..., 3), got"),
        (lambda: cast(mesh, None, ["a", "b", "c"]), "displacements: expected numbers of at most double precision"),
        (lambda: cast(mesh, None, DOWN * 1j), "displacements: expected numbers of at most double precision"),
        (lambda: cast(mesh, None, np.float128(DOWN)), "displacements: expected numbers of at most double precision"),
        (lambda: cast(mesh, None, np.array([0, 0, 2**53 + 1])), "displacements: expected whole numbers up to 2^53"),
        (lambda: cast(mesh, None, np.ma.masked_less(DOWN, 0)), "got a masked array"),
        (lambda: cast(mesh, at(six).swapaxes(1, 2) + np.eye(4)[3], DOWN), "poses[0]: expected the last row 0 0 0 1"),
        (lambda: cast(mesh, at(six), np.ones((5, 3))), "got poses (6, 4, 4), displacements (5, 3)"),
        (lambda: cast(mesh + 1, None, DOWN), "mesh: expected ids of meshes of the scene, got 1"),
        (lambda: cast(0.5, None, DOWN), "mesh: expected whole numbers, got dtype float64"),
        (lambda: cast(-1, None, DOWN), "mesh: expected whole numbers from 0 to 4294967294, got -1"),
        (lambda: cast(mesh, None, DOWN, exclude_from_all=[200]), "exclude_from_all: expected ids of objects of the"),
        (lambda: cast(mesh, None, DOWN, exclude_from_all=-1), "exclude_from_all: expected whole numbers from 0"),
        (lambda: cast(mesh, None, DOWN, exclude_from_each=[[200]]), "exclude_from_each: expected ids of objects"),
        (lambda: cast(mesh, None, DOWN, mask=2**32), "mask: expected whole numbers from 0 to 4294967295"),
        (lambda: cast(mesh, None, DOWN, mode="fast"), 'mode: expected "contact", "sampled" or "reference"'),
        (lambda: cast(mesh, None, DOWN, slack=-1), "slack: expected a finite number of 0 or more, got -1"),
        (lambda: cast(mesh, None, DOWN, clearance=np.inf), "clearance: expected a finite number of 0 or more"),
        (lambda: cast(mesh, None, [DOWN] * 3, tolerance=[1, 2]), "got displacements (3, 3), tolerance (2,)"),
        (lambda: cast(mesh, None, DOWN, skip_overlapping=[True]), "skip_overlapping: expected True or False, got [True]"),
        (lambda: cast(mesh, None, DOWN, closest="yes"), "closest: expected True or False, got 'yes'"),
        (lambda: cast(mesh, None, DOWN, exit=np.nan), "exit: expected True or False, got nan"),
        (lambda: cast(mesh, None, DOWN, exit=True, mode="sampled"), 'mode: expected "contact" or "reference" with exit'),
        (lambda: cast(mesh, None, DOWN, ignore_leaving=[0, 1]), "ignore_leaving: expected True or False for each cast"),
        (lambda: cast(mesh, None, DOWN, hits=[1, -1]), "hits: expected whole numbers from 0 to"),
        (lambda: cast(mesh, None, DOWN, hits=[1, 2], mode="sampled"), 'mode: expected "contact" or "reference" with'),
        (lambda: scene.add_mesh("part.stl"), "got 'part.stl'; load_mesh() reads a file"),
        (lambda: cast(mesh, None, DOWN, hits=0), "hits: expected a whole number from 1 to"),
        (lambda: cast(mesh, None, DOWN, hits="al"), "hits: expected a whole number from 1 to 4294967294, or \"all\", got 'al'"),
        (lambda: cast(mesh, None, DOWN, hits=2, any_hit=True), "hits: expected 1 with any_hit"),
        (lambda: cast(mesh, None, DOWN, hits=2, mode="sampled"), 'mode: expected "contact" or "reference" with'),
        (lambda: cast(mesh, None, DOWN, resolution=2049), "resolution: expected whole numbers from 0 to 2048"),
        (lambda: cast(mesh, None, DOWN, distances=[[1, 2], [3]]), "distances: expected numbers of shape (...)"),
        (lambda: scene.add(mesh, np.zeros((2, 4, 4)) + np.diag([0, 1, 1, 1])), "transforms[0]: expected an invertible"),
        (
            lambda: scene.add(mesh, np.full((4, 4), np.nan)),
            "transforms: expected 12 finite numbers of at most 2^800, got nan",
        ),
        (lambda: scene.set_transforms([0, 200], np.eye(4)), "objects: expected ids of objects of the scene, got 200"),
        (lambda: scene.remove([-1]), "objects: expected whole numbers from 0"),
        (lambda: scene.add_mesh(box(1, 1, 1)[:, :2], FACES), "vertices: expected numbers of shape (..., 3)"),
        (lambda: scene.add_mesh(box(1, 1, 1)[None], FACES), "vertices: expected shape (N, 3), got shape (1, 8, 3)"),
        (lambda: scene.add_mesh([[0, 0, 1e39]], FACES), "vertices[0]: expected 3 finite numbers that float32 can hold"),
        (lambda: scene.add_mesh(box(1, 1, 1), FACES + 1), "faces[2]: expected vertices from 0 to 7, got 8"),
        (lambda: scene.add_mesh(box(1, 1, 1)), "faces: expected them beside the vertices, or a mesh that has"),
        (lambda: scene.add_mesh(box(1, 1, 1), FACES[:0]), "faces: expected shape (M, 3) with a triangle at least"),
        (lambda: scene.add_mesh(box(1, 1, 1), FACES * 1.0), "faces: expected whole numbers, got dtype float64"),
        (lambda: cyber_radar.Scene(device="gpu"), "device: expected a number of devices()"),
        (lambda: cyber_radar.Scene(device=[]), "device: expected a number of devices()"),
        (lambda: cyber_radar.Scene(threads=-1), "threads: expected whole numbers from 0 to 4096"),
    ):
        assert words in refusal(call)
    assert len(scene) == 200 and scene.meshes == [0]
    with pytest.raises(TypeError, match="speed"):
        cast(mesh, None, DOWN, speed=2)


def test_what_each_cast_excludes_is_never_taken_for_what_all_exclude(boxes):
    scene, mesh = boxes
    poses = at(np.arange(18).reshape(6, 3))
    cast = lambda poses, **excluded: scene.cast(mesh, poses, DOWN, mode="reference", **excluded)  # noqa: E731
    ids = np.arange(6)
    own = [cast(pose, exclude_from_all=i).object.tolist() for i, pose in enumerate(poses)]
    assert cast(poses, exclude_from_each=ids[:, None]).object.tolist() == own
    for shape in ((), (1,), (6,)):
        words = f"expected shape (..., K), a row of ids for each cast, got shape {shape}; for one id each, pass"
        assert words in refusal(lambda: cast(poses, exclude_from_each=np.zeros(shape, int)))
    assert "got shape (6, 1); exclude_from_each has a row for each" in refusal(
        lambda: cast(poses, exclude_from_all=ids[:, None])
    )
    square = np.broadcast_to(ids, (6, 6))
    words = "shape (6, 6) may mean rows of 6 ids, or one id for each cast of shape (6, 6); for one each, pass ids[..., "
    assert words in refusal(lambda: cast(poses[:, None], mask=np.ones(6, int), exclude_from_each=square))
    all_pairs = cast(poses[:, None], mask=np.ones(6, int), exclude_from_each=square[..., None])
    assert (all_pairs.object[range(6), range(6)] == own).all()
    with pytest.raises(TypeError, match="exclude"):
        cast(poses, exclude=ids)


def test_triangle_strips_are_refused_with_the_triangle_that_betrays_them(boxes):
    scene, _ = boxes
    for restart in (2**16 - 1, 2**32 - 1):
        faces = np.append(FACES, [[0, 1, restart]], axis=0)
        words = f"faces[12]: expected vertices from 0 to 7, got {restart}; are they strips? Each row is a triangle"
        assert words in refusal(lambda: scene.add_mesh(box(1, 1, 1), faces))


def test_out_must_be_able_to_take_the_answers(boxes):
    scene, mesh = boxes
    out = cyber_radar.Casts.empty((4,))
    cast = lambda: scene.cast(mesh, at(np.zeros((4, 3))), DOWN, mode="reference", out=out)  # noqa: E731
    assert "out: expected Casts, got dict" in refusal(lambda: scene.cast(mesh, None, DOWN, out={}))
    assert 'Casts.empty((), "contact"), got Casts of shape (4,)' in refusal(lambda: scene.cast(mesh, None, DOWN, out=out))
    assert '"sampled"), got' in refusal(lambda: scene.cast(mesh, at(np.zeros((4, 3))), DOWN, mode="sampled", out=out))
    sampled = cyber_radar.Casts.empty((4,), "sampled")
    assert "for mode sampled" in refusal(lambda: scene.cast(mesh, at(np.zeros((4, 3))), DOWN, out=sampled))
    assert "C-contiguous" in refusal(
        lambda: scene.cast(mesh, at(np.zeros((4, 3))), DOWN, out=cyber_radar.Casts.empty((8,))[::2])
    )
    out.records.flags.writeable = False
    assert "out: expected Casts whose records are writeable" in refusal(cast)
    out.records.flags.writeable = True
    assert same_answers(cast(), scene.cast(mesh, at(np.zeros((4, 3))), DOWN, mode="reference"))


def odd_arrays(rng: np.random.Generator, shape: tuple[int, ...]):
    """Arrays of all sorts, some of a shape near the one wanted."""
    shapes = [shape, (2, *shape), (0, *shape), shape[1:], (*shape, 1), (3,), (), (1, 2, *shape)]
    numbers = [0, 1, -1, 0.5, np.nan, np.inf, -np.inf, 1e308, 5e-324, 2.0**63, -0.0]
    types = [float, np.float32, np.float16, np.longdouble, int, np.uint64, np.int8, bool, complex, object, "U3", ">f8"]
    chosen = rng.choice(np.array(numbers), shapes[rng.integers(len(shapes))])
    with np.errstate(all="ignore"):
        array = chosen.astype(types[rng.integers(len(types))])
    if len(shape) == 2 and array.shape[-2:] == (4, 4) and rng.random() < 0.8 and array.dtype.kind in "fiu":
        array[..., :, :] = rng.permutation(np.eye(4)) if rng.random() < 0.2 else np.eye(4)
        array[..., 0, 3] = chosen[..., 0, 3].astype(array.dtype) if array.dtype.kind == "f" else 0
    change = rng.integers(5)
    if change == 0 and array.ndim:
        return array[..., ::-1]
    if change == 1 and array.ndim:
        return np.broadcast_to(array, (3, *array.shape))
    return array.tolist() if change == 2 else array


@pytest.mark.filterwarnings("ignore")
def test_odd_arguments_never_crash(boxes):
    scene, mesh = boxes
    rng = np.random.default_rng(9)
    out = cyber_radar.Casts.empty((2,))
    answered = refused = 0
    for round_ in range(3000):
        odd = lambda *shape, plain: odd_arrays(rng, shape) if rng.random() < 0.12 else plain  # noqa: E731
        try:
            what = round_ % 6
            if what == 0:
                scene.add_mesh(odd(8, 3, plain=box(1, 1, 1)), odd(12, 3, plain=FACES))
            elif what == 1:
                scene.remove(scene.add(odd(plain=mesh), odd(4, 4, plain=np.eye(4)), mask=odd(plain=1)))
            elif what == 2:
                scene.set_transforms(odd(plain=[3, 4]), odd(4, 4, plain=at([9, 9, 9])))
            else:
                casts = scene.cast(
                    odd(plain=mesh), odd(4, 4, plain=at([[0, 0, 0], [1, 2, 3]])), odd(3, plain=DOWN),
                    mode=("reference", "contact")[round_ % 2], exclude_from_all=odd(3, plain=[]), mask=odd(plain=7),
                    exclude_from_each=odd(2, 3, plain=None), distances=odd(plain=None), clearance=odd(plain=0.0),
                    slack=odd(plain=None), hits=odd(plain=2), skip_overlapping=rng.random() < 0.5,
                    ignore_leaving=rng.random() < 0.5, out=out if rng.random() < 0.1 else None,
                )  # fmt: skip
                answered += casts.t.size
        except (ValueError, TypeError) as error:
            assert str(error)
            refused += 1
    assert answered > 500 and refused > 500
    assert len(scene) == 200


def test_the_compiled_half_refuses_arrays_that_do_not_fit(boxes):
    scene, mesh = boxes
    engine = scene._engine
    with pytest.raises((TypeError, ValueError)):
        engine.add(np.zeros(2, np.uint32), np.zeros((1, 4, 4)), np.zeros(2, np.uint32))
    with pytest.raises((TypeError, ValueError)):
        engine.set_transforms(np.zeros(2, np.uint32), np.zeros((1, 4, 4)))
    of_casts = {
        "mesh": np.full(4, mesh, np.uint32),
        "poses": at(np.zeros((4, 3))),
        "displacements": np.full((4, 3), DOWN, float),
        "mask": np.ones(4, np.uint32),
        "exclude_from_each": np.zeros((4, 1), np.int64),
    }
    records = cyber_radar.Casts.empty((4,)).records
    options = dict.fromkeys(cyber_radar._engine.OPTIONS, 1.0) | {"any_hit": False, "mode": "contact", "resolution": 0}
    engine.cast((4,), of_casts, options, records, None)
    of_casts |= {"turns: axes": np.ones((4, 3)), "turns: angles": np.ones(4), "turns: centres": np.ones((4, 3))}
    for wrong in of_casts:
        arguments = of_casts | {wrong: of_casts[wrong][:2]}
        with pytest.raises(ValueError):
            engine.cast((4,), arguments, options, records, None)
    for wrong in (records[:2], np.zeros(4, records.dtype.str), cyber_radar.Casts.empty((8,)).records[::2]):
        with pytest.raises(ValueError, match="records: expected"):
            engine.cast((4,), of_casts, options, wrong, None)


def test_poses_may_lack_their_last_row(boxes):
    scene, mesh = boxes
    poses = at(np.linspace((-9, -9, 9), (9, 9, 20), 12).reshape(3, 4, 3))
    whole = scene.cast(mesh, poses, DOWN, mode="reference")
    assert same_answers(scene.cast(mesh, poses[..., :3, :], DOWN, mode="reference"), whole)
    one = cyber_radar.Scene()
    one.add(one.add_mesh(box(1, 1, 1), FACES), poses[:, :, :3])
    assert (one.objects().transforms == poses.reshape(-1, 4, 4)).all()
