"""What casts answer."""

import numpy as np
import pytest

import cyber_radar
from conftest import DOWN, FACES, at, box, fill, random_poses, same_answers
from cyber_radar import Status, Tier


def test_device_and_processor_give_the_same_bits():
    on_device = cyber_radar.Scene(cpu_batch=0)
    mesh = fill(on_device)
    rng = np.random.default_rng(3)
    poses, displacements = random_poses(rng, 700, 20), rng.normal(size=(700, 3)) * 5
    contact = on_device.cast(mesh, poses, displacements)
    reference = on_device.cast(mesh, poses, displacements, mode="reference")
    assert len(on_device.device_names) == 1
    assert (contact.tier == Tier.CONTACT).all() and (reference.tier == Tier.REFERENCE).all()
    assert same_answers(contact, reference, but=("tier",))
    assert set(np.unique(contact.status)) == {Status.HIT, Status.CLEAR, Status.OVERLAP}


def test_mode_sampled_bounds_the_distance_from_above():
    scene = cyber_radar.Scene()
    mesh = scene.add_mesh(box(1, 1, 1), FACES)
    scene.add(mesh, at([[0, 0, 0], [5, 0, -0.25]]))
    poses = at([[0.1, 0.2, 3], [5.1, 0.2, 3], [20, 0, 0]])
    casts = scene.cast(mesh, poses, DOWN, mode="sampled", resolution=32)
    np.testing.assert_allclose(casts.t, [2, 2.25, np.inf], atol=1e-6)
    assert (casts.hi >= scene.cast(mesh, poses, DOWN, mode="reference").t).all()
    np.testing.assert_allclose(casts.paper_min_l[:2], [2, 2.25], atol=1e-4)
    assert casts.resolution.tolist() == [32, 32, 0]
    assert casts.detected.tolist() == [1, 1, 0]


def test_leading_shapes_broadcast_and_are_those_of_the_arrays(boxes):
    scene, mesh = boxes
    rng = np.random.default_rng(4)
    poses, displacements = random_poses(rng, 15, 20).reshape(5, 1, 3, 4, 4), rng.normal(size=(2, 1, 3)) * 5
    exclude, distances = rng.integers(-1, 200, (3, 4)), np.array([[[6.0]], [[7.0]]] * 5).reshape(5, 2, 1)
    casts = scene.cast(mesh, poses, displacements, exclude_from_each=exclude, distances=distances, mode="reference")
    assert casts.shape == casts.object.shape == (5, 2, 3)
    assert casts.tri_a.shape == (5, 2, 3) and casts.point.shape == casts.normal.shape == (5, 2, 3, 3)
    assert casts.touches.any()
    for i in np.ndindex(5, 2, 3):
        one = scene.cast(
            mesh, poses[i[0], 0, i[2]], displacements[i[1], 0], mode="reference",
            exclude_from_all=exclude[i[2]][exclude[i[2]] >= 0], distances=distances[i[0], i[1], 0],
        )  # fmt: skip
        assert one.shape == ()
        assert one.t == casts.t[i] and one.object == casts.object[i]
        assert (one.point == casts.point[i]).all() or one.status == Status.CLEAR


def test_numbers_of_any_type_and_layout_mean_the_same(boxes):
    scene, mesh = boxes
    rng = np.random.default_rng(5)
    poses = at(rng.integers(-9, 9, (40, 3)))
    expected = scene.cast(mesh, poses, DOWN, mode="reference")
    wide = np.zeros((40, 8, 8))
    wide[:, ::2, ::-2] = poses
    fortran = np.asfortranarray(poses)
    for given in (poses.astype(np.float32), poses.astype(np.int64), wide[:, ::2, ::-2], fortran, poses.tolist(),
                  poses.astype(">f8")):  # fmt: skip
        assert same_answers(scene.cast(np.uint8(mesh), given, [0, 0, -10], mode="reference"), expected)
    backwards = scene.cast(mesh, poses[::-1], DOWN, mode="reference")
    assert (backwards.t[::-1] == expected.t).all()


SMALL = np.array([way for way in np.ndindex(11, 6, 6) if way != (5, 0, 0)], float) * [1, 1, -1] - [5, 0, 0]


def starts_that_end_in_touch(displacements: np.ndarray) -> np.ndarray:
    """Where a box of side 2 begins that first meets another one, around the origin, at the end of the displacement."""
    axis, rows = np.abs(displacements).argmax(axis=1), np.arange(len(displacements))
    ends = np.zeros(displacements.shape)
    ends[rows, axis] = -2 * np.sign(displacements[rows, axis])
    return ends - displacements


@pytest.mark.parametrize("mode", ["reference", "contact"])
@pytest.mark.parametrize(
    "options",
    [{}, {"hits": "all"}, {"hits": 2, "skip_overlapping": True}, {"ignore_leaving": True}, {"any_hit": True}],
    ids=lambda options: " ".join(options),
)
def test_contact_at_the_end_of_a_displacement_is_found_and_none_beyond(mode, options):
    scene = cyber_radar.Scene(cpu_batch=0)
    mesh = scene.add_mesh(box(2, 2, 2), FACES)
    scene.add(mesh)
    starts = starts_that_end_in_touch(SMALL)
    casts = scene.cast(mesh, at(starts), SMALL, mode=mode, **options)
    assert (casts.status == Status.HIT).all()
    if "any_hit" not in options:
        length = np.linalg.norm(SMALL, axis=1)
        np.testing.assert_allclose(casts.t, length, rtol=4e-16)
        assert (casts.fraction == 1).all() and (casts.lo <= length).all() and (length <= casts.hi).all()
    if "hits" in options:
        assert casts.hits.cast.tolist() == list(range(len(SMALL)))
        assert (casts.hits.t == casts.t).all() and (casts.hits.hi == casts.hi).all()
    beyond = scene.cast(mesh, at(starts - SMALL * 2.0**-45), SMALL, mode=mode, **options)
    assert (beyond.status == Status.CLEAR).all()


def test_mode_sampled_finds_contact_at_the_end_of_a_displacement():
    scene = cyber_radar.Scene()
    mesh = scene.add_mesh(box(2, 2, 2), FACES)
    scene.add(mesh)
    ways = SMALL[::7]
    casts = scene.cast(mesh, at(starts_that_end_in_touch(ways)), ways, mode="sampled", resolution=64)
    assert (casts.status == Status.HIT).all()
    np.testing.assert_allclose(casts.t, np.linalg.norm(ways, axis=1), rtol=1e-15)


def test_displacements_of_any_size_are_taken_as_they_are():
    scene = cyber_radar.Scene()
    mesh = scene.add_mesh(box(2, 2, 2), FACES)
    scene.add(mesh)
    way = np.array([0.0, 3.0, -5.0])
    for size in (2.0**-1070, 2.0**-600, 2.0**600, 2.0**996):
        touching = scene.cast(mesh, at([0, 0, 2]), way * size, mode="reference", ignore_leaving=True)
        assert touching.t == 0 and touching.lo == touching.hi == touching.fraction == 0
        beside = scene.cast(mesh, at([0, 0, 3]), way * size, mode="reference")
        assert beside.t == (np.inf if size < 1 else pytest.approx(np.sqrt(34) / 5))
    long = scene.cast(mesh, None, way * 2.0**1000, mode="reference")
    assert long.status == Status.INVALID
    assert list(long.reasons)[0].startswith("displacements: expected 3 finite numbers of at most 2^1000, got")


def test_no_displacement_asks_whether_the_surfaces_meet():
    scene = cyber_radar.Scene()
    mesh = scene.add_mesh(box(1, 1, 1), FACES)
    scene.add(mesh)
    casts = scene.cast(mesh, at([[0.5, 0.5, 0.5], [3, 0, 0]]), [0, 0, 0], mode="reference")
    assert casts.status.tolist() == [Status.OVERLAP, Status.CLEAR]
    leaving = scene.cast(mesh, at([[0.5, 0.5, 0.5], [1, 0, 0]]), [0, 0, 0], ignore_leaving=True, mode="reference")
    assert leaving.status.tolist() == [Status.OVERLAP, Status.CLEAR]
    assert scene.cast(mesh, None, [0, 0, 0], distances=1.0, mode="reference").status == Status.INVALID


def test_a_crate_leaves_the_floor_it_rests_on():
    scene = cyber_radar.Scene()
    floor, crate = scene.add_mesh(box(20, 20, 1), FACES), scene.add_mesh(box(1, 1, 1), FACES)
    scene.add(floor)
    ways = [[0, 0, 3], [3, 0, 0], [0, 0, -3]]
    assert scene.cast(crate, at([0, 0, 1]), ways, mode="reference").status.tolist() == [Status.OVERLAP] * 3
    casts = scene.cast(crate, at([0, 0, 1]), ways, ignore_leaving=True, mode="reference")
    assert casts.t.tolist() == [np.inf, np.inf, 0]
    sunk = scene.cast(crate, at([0, 0, 1 - 1e-9]), ways, ignore_leaving=True, slack=1e-8, mode="reference")
    assert sunk.t.tolist() == [np.inf, np.inf, 0]


def test_hits_and_what_overlaps_are_listed():
    scene = cyber_radar.Scene()
    mesh = scene.add_mesh(box(1, 1, 1), FACES)
    scene.add(mesh, at([[0, 0, -3], [0, 0, -6], [0, 0, -9], [0.5, 0, 0.25], [9, 9, -2]]))
    poses = at([[0.25, 0, 0], [9, 9, 0], [30, 0, 0]])
    casts = scene.cast(mesh, poses, DOWN, hits="all", skip_overlapping=True, mode="reference")
    assert casts.hits.offsets.tolist() == [0, 3, 4, 4]
    assert casts.hits.object.tolist() == [0, 1, 2, 4]
    assert casts.hits.t.tolist() == [2, 5, 8, 1]
    assert casts.hits.cast.tolist() == [0, 0, 0, 1]
    assert casts.hits.object[casts.hits.of(0)].tolist() == [0, 1, 2]
    assert casts.hits.of(2) == slice(4, 4)
    assert casts.overlapping.object[casts.overlapping.of(0)].tolist() == [3]
    assert casts.overlapping.offsets.tolist() == [0, 1, 1, 1]
    two = scene.cast(mesh, poses[:, None], DOWN, hits=2, skip_overlapping=True, mode="reference")
    assert two.hits.object[two.hits.of(0, 0)].tolist() == [0, 1]
    plain = scene.cast(mesh, poses, DOWN, mode="reference")
    assert plain.hits is None and plain.overlapping is None


def test_the_closest_approach_and_the_last_contact():
    scene = cyber_radar.Scene()
    mesh = scene.add_mesh(box(1, 1, 1), FACES)
    scene.add(mesh, at([[0, 0, -3], [20, 0, 0]]))
    poses = at([[0, 0, 0], [2, 0, -9], [50, 0, 0]])
    poses[2, 0, 0] = np.nan
    for mode in ("contact", "reference"):
        casts = scene.cast(mesh, poses, [0, 0, -12], closest=True, exit=True, mode=mode)
        assert casts.status.tolist() == [Status.HIT, Status.CLEAR, Status.INVALID]
        closest = casts.closest
        assert closest.distance_lo[0] == closest.distance_hi[0] == 0
        assert closest.t[0] == casts.t[0] == 2
        assert closest.distance_lo[1] <= np.sqrt(26) <= closest.distance_hi[1] < np.sqrt(26) + 1e-12
        assert (closest.t[1], closest.object[1]) == (0, 0)
        assert closest.gap[1] == pytest.approx(np.sqrt(26))
        assert np.isnan(closest.distance_lo[2]) and closest.status[2] == Status.INVALID
        assert casts.exit.lo[0] <= 4 <= casts.exit.hi[0] == casts.exit.t[0] < 4 + 1e-14
        assert casts.exit.status.tolist() == [Status.HIT, Status.CLEAR, Status.INVALID]
        assert casts[1].closest.distance_lo == closest.distance_lo[1] and casts[:2].exit.shape == (2,)
    # A ball is out of the radius, and its distance is its centre's.
    casts = scene.cast(cyber_radar.ball(1), at([0, 0, -3]), [0, 0, 9], closest=True, exit=True)
    assert casts.exit.t == pytest.approx(1.5, abs=1e-11)
    assert scene.cast(mesh, None, [0, 0, 1]).closest is None
    with pytest.raises(ValueError, match="closest"):
        scene.cast(mesh, None, [0, 0, 1], closest=True, mode="sampled")
    turned = scene.cast(mesh, None, None, turns=([0, 0, 1], 1, [0, 0, 0]), exit=True)
    assert list(turned.reasons) == ["exit: expected neither a turn nor ignore_leaving beside it"]


def test_an_index_gives_the_casts_there_with_all_that_they_list(boxes):
    scene, mesh = boxes
    rng = np.random.default_rng(15)
    poses, displacements = random_poses(rng, 24, 20), rng.normal(size=(24, 3)) * 5
    poses[[6, 23]] = np.nan
    options = {"hits": 3, "skip_overlapping": True, "mode": "reference"}
    places = np.arange(24).reshape(2, 3, 4)
    casts = scene.cast(mesh, poses[places], displacements[places], **options)
    even = places % 2 == 0
    for index in (
        *(1, -1, (0, 2), (1, 2, 3), np.int8(1), slice(1), (0, slice(1, 3)), (slice(None), [2, 0]), [], None, (1, None)),
        *(..., (..., 1), (0, ..., slice(1, 3)), (..., [[0], [1]], [2, 3]), (None, ..., even[1])),
        *(even, even[0, :, 0][:2], (even[..., 0], 2), (0, even[0]), casts.touches, ~casts.touches, [True, False]),
    ):
        part, chosen = casts[index], places[index]
        again = scene.cast(mesh, poses[chosen], displacements[chosen], **options)
        assert part.shape == again.shape == chosen.shape
        assert same_answers(part, again) and same_answers(part.hits, again.hits)
        for ragged in ("hits", "overlapping"):
            a, b = getattr(part, ragged), getattr(again, ragged)
            assert a.of_shape == b.of_shape and (a.offsets == b.offsets).all() and (a.object == b.object).all()
        assert {reason: which.tolist() for reason, which in part.reasons.items()} == {
            reason: which.tolist() for reason, which in again.reasons.items()
        }
    plain = scene.cast(mesh, poses, displacements, mode="sampled", resolution=16)
    assert plain[3:5].resolution.shape == (2,) and plain[3:5].hits is None


def test_casts_have_a_length_and_are_gone_through():
    casts = cyber_radar.Casts.empty((3, 2))
    casts.t[:] = np.arange(6).reshape(3, 2)
    assert len(casts) == 3
    assert [[float(one.t) for one in row] for row in casts] == [[0, 1], [2, 3], [4, 5]]
    assert casts[0, 0].shape == () and casts[0, 0].point.shape == (3,)
    for ask in (lambda: len(casts[0, 0]), lambda: list(casts[0, 0])):
        with pytest.raises(TypeError, match=r"casts of shape \(\) are one cast, without a length"):
            ask()
    for index in (3, (0, 2), (0, 0, 0), [True, False], "a"):
        with pytest.raises(IndexError, match=r"casts of shape \(3, 2\): "):
            casts[index]


def test_casts_are_records_and_become_a_dict_of_arrays(tmp_path):
    for mode, count in (("contact", 15), ("sampled", 17)):
        casts = cyber_radar.Casts.empty((5, 2), mode)
        casts.records[:] = np.zeros((), casts.records.dtype)
        arrays = casts.to_dict()
        assert len(arrays) == count and np.shares_memory(arrays["t"], casts.t)
        assert all(name in dir(casts) and f"\n    {name}: " in cyber_radar.Casts.__doc__ for name in arrays)
        assert all(array.shape[:2] == (5, 2) and array.flags.aligned for array in arrays.values())
        np.save(tmp_path / "casts.npy", casts.records)
        assert same_answers(cyber_radar.Casts(np.load(tmp_path / "casts.npy")), casts)
    with pytest.raises(AttributeError, match="Casts have no 'distance'"):
        casts.distance


def test_an_index_of_lists_has_errors_of_its_own():
    scene = cyber_radar.Scene()
    mesh = scene.add_mesh(box(1, 1, 1), FACES)
    scene.add(mesh)
    casts = scene.cast(mesh, np.zeros((3, 2, 1, 1)) + np.eye(4), DOWN, hits="all", mode="reference")
    assert casts.hits.of(-1, -2) == casts.hits.of(2, 0) == slice(4, 5)
    for index, words in (
        ((3,), r"of\(3\): expected 2 whole numbers, as the casts have shape \(3, 2\)"),
        ((), r"of\(\): expected 2 whole numbers, as the casts have shape \(3, 2\)"),
        ((0, 2), r"of\(0, 2\): expected a place in the casts' shape \(3, 2\)"),
        ((-4, 0), r"of\(-4, 0\): expected a place in the casts' shape \(3, 2\)"),
    ):
        with pytest.raises(IndexError, match=words):
            casts.hits.of(*index)
    with pytest.raises(IndexError, match=r"of\(3\): expected 0 whole numbers, as the casts have shape \(\)"):
        casts[0, 0].hits.of(3)


@pytest.mark.parametrize("mode", ["reference", "contact"])
def test_options_given_for_each_cast_answer_as_those_given_for_one(mode):
    scene = cyber_radar.Scene(cpu_batch=0)
    mesh = scene.add_mesh(box(1, 1, 1), FACES)
    scene.add(mesh, at([[0, 0, -3], [0.5, 0, -6], [1.25, 0, 0]]))
    ways = np.array([DOWN, [0, 3, -9], [-2, 0, 0]])
    for name, values in {
        "ignore_leaving": [True, False, True],
        "slack": [0.0, np.nan, 1e-3],
        "clearance": [0.0, 0.5, 0.25],
        "tolerance": [1e-2, np.nan, 1e-9],
        "hits": [1, 3, 0],
    }.items():
        others = {"clearance": 0.3} if name == "tolerance" else {"ignore_leaving": True} if name == "slack" else {}
        column = np.array(values)[:, None]
        casts = scene.cast(mesh, None, ways, mode=mode, **{name: column}, **others)
        assert casts.shape == (3, 3)
        for row, value in enumerate(values):
            one = "all" if name == "hits" and value == 0 else None if np.isnan(value) else value
            single = scene.cast(mesh, None, ways, mode=mode, **{name: one}, **others)
            for key, array in single.to_dict().items():
                np.testing.assert_array_equal(casts[row].to_dict()[key], array, err_msg=f"{name} {value} {key}")
            for way in range(3) if name == "hits" and value != 1 else ():
                rows = casts.hits.of(row, way)
                np.testing.assert_array_equal(casts.hits.object[rows], single.hits.object[single.hits.of(way)])
            assert name != "hits" or value != 1 or casts[row].hits.object.size == 0


def test_a_wrong_option_of_one_cast_makes_that_cast_invalid():
    scene = cyber_radar.Scene()
    mesh = scene.add_mesh(box(1, 1, 1), FACES)
    scene.add(mesh, at([0, 0, -3]))
    casts = scene.cast(mesh, None, DOWN, clearance=[0, -1, np.nan], mode="reference")
    assert casts.status.tolist() == [Status.HIT, Status.INVALID, Status.INVALID]
    assert {reason: found.tolist() for reason, found in casts.reasons.items()} == {
        "clearance: expected a finite number of 0 or more, got -1": [1],
        "clearance: expected a finite number of 0 or more, got nan": [2],
    }


def test_casts_name_the_objects_that_they_leave_out():
    scene = cyber_radar.Scene()
    mesh = scene.add_mesh(box(1, 1, 1), FACES)
    scene.add(mesh, at([[0.5, 0, 0.5], [0, 0, -3], [0, 5, 0]]))
    scene._names = {0: "bin"}  # as load_assembly() gives them
    options = {"mode": "reference", "skip_overlapping": True}
    assert repr(scene.cast(mesh, None, [0, 0, 9], **options)) == (
        "<Casts of shape (): 1 clear of all but 1 object left out: 0 (bin)>"
    )
    casts = scene.cast(mesh, at([[0.25, 0.25, 0], [0.5, 5, 0.5], [9, 9, 9]]), [0, 0, 9], **options)
    assert repr(casts) == "<Casts of shape (3,): 3 clear of all but 2 objects left out: 0 (bin), 2>"
    assert repr(casts[2]) == "<Casts of shape (): 1 clear>"


def test_masks_exclusions_clearance_and_any_hit():
    scene = cyber_radar.Scene()
    mesh = scene.add_mesh(box(1, 1, 1), FACES)
    scene.add(mesh, at([[0, 0, -3], [0, 0, -6]]), mask=[1, 2])
    cast = lambda **options: scene.cast(mesh, None, DOWN, mode="reference", **options)  # noqa: E731
    assert cast(mask=[1, 2, 3, 4]).t.tolist() == [2, 5, 2, np.inf]
    assert cast(exclude_from_each=[[-1, -1], [0, -1], [1, 0]]).t.tolist() == [2, 5, np.inf]
    assert [cast(exclude_from_all=ids).t for ids in ([], 0, [0], [0, 1])] == [2, 5, 5, np.inf]
    assert cast(exclude_from_all=[0], exclude_from_each=[[-1], [1]]).t.tolist() == [5, np.inf]
    near = cast(clearance=0.5, tolerance=1e-3)
    assert 1.5 - 1e-3 <= near.lo <= 1.5 <= near.hi <= near.lo + 1e-3
    any_hit = cast(any_hit=True)
    assert any_hit.status == Status.HIT and any_hit.object == -1
    assert any_hit.t == any_hit.hi == 10 and any_hit.lo == 0 and any_hit.fraction == 1  # it comes by then
    there = scene.cast(mesh, at([0, 0, -3.5]), DOWN, mode="reference", any_hit=True)
    assert there.status == Status.HIT and there.t == 10
    assert cast(any_hit=True, mask=4).status == Status.CLEAR
    assert cast(distances=[1.5, 2.5]).t.tolist() == [np.inf, 2]


def test_out_is_filled_and_returned(boxes):
    scene, mesh = boxes
    rng = np.random.default_rng(6)
    poses, displacements = random_poses(rng, 50, 20), rng.normal(size=(50, 3)) * 5
    expected = scene.cast(mesh, poses, displacements, mode="reference")
    out = cyber_radar.Casts.empty((50,))
    t = out.t
    assert scene.cast(mesh, poses, displacements, mode="reference", out=out) is out
    assert np.shares_memory(out.t, t)
    assert same_answers(out, expected)
    scene.cast(mesh, poses[::-1], displacements[::-1], mode="reference", out=out)
    assert (t[::-1] == expected.t).all()


def test_one_bad_cast_is_invalid_and_leaves_the_others_alone(boxes):
    scene, mesh = boxes
    rng = np.random.default_rng(8)
    poses, displacements = random_poses(rng, 900, 20), rng.normal(size=(900, 3)) * 5
    for mode in ("reference", "contact"):
        expected = scene.cast(mesh, poses, displacements, mode=mode, hits=2, skip_overlapping=True)
        bad_poses, bad_displacements = poses.copy(), displacements.copy()
        bad_poses[3] = np.nan
        bad_poses[500, 1, 2] = -np.inf
        bad_poses[600, :3, :3] = 0
        bad_displacements[[4, 899], 1] = np.nan
        casts = scene.cast(mesh, bad_poses, bad_displacements, mode=mode, hits=2, skip_overlapping=True)
        bad = [3, 4, 500, 600, 899]
        assert np.flatnonzero(casts.status == Status.INVALID).tolist() == bad
        assert sorted(np.concatenate(list(casts.reasons.values())).tolist()) == bad
        assert casts.reasons["displacements: expected 3 finite numbers of at most 2^1000, got nan"].tolist() == [4, 899]
        assert np.isnan(casts.t[bad]).all() and (casts.object[bad] == -1).all()
        good = np.setdiff1d(np.arange(900), bad)
        assert (casts.t[good] == expected.t[good]).all()
        for i in good:
            assert (casts.hits.object[casts.hits.of(i)] == expected.hits.object[expected.hits.of(i)]).all()
            rows = casts.overlapping.of(i), expected.overlapping.of(i)
            assert (casts.overlapping.object[rows[0]] == expected.overlapping.object[rows[1]]).all()


def test_there_may_be_no_cast_at_all(boxes):
    scene, mesh = boxes
    casts = scene.cast(mesh, np.zeros((0, 4, 4)), DOWN, hits="all")
    assert casts.shape == (0,) and casts.hits.offsets.tolist() == [0] and casts.reasons == {}
    assert scene.cast(mesh, np.zeros((3, 0, 1, 4, 4)), np.zeros((5, 3))).shape == (3, 0, 5)
    assert repr(casts) == "<Casts of shape (0,): none>"


def test_a_scene_without_objects_is_free():
    scene = cyber_radar.Scene()
    mesh = scene.add_mesh(box(1, 1, 1), FACES)
    for mode in ("reference", "contact", "sampled"):
        assert scene.cast(mesh, None, DOWN, mode=mode).t == np.inf
