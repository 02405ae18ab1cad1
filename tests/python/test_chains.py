"""Chains of joints."""

import concurrent.futures
import multiprocessing
import pickle
import signal

import numpy as np
import pytest

import cyber_radar
from conftest import FACES, at, box, numbers, page_data, random_poses, same_answers
from cyber_radar import Chain, Link, Status
from test_arguments import refusal
from test_running import endless, many_threads, until_another_thread_runs_within


def arm(threads: int = 2) -> Chain:
    """Six axes among boxes; a wrist of two meshes, fixed to the fifth link, and a rail in front."""
    scene = cyber_radar.Scene(threads=threads)
    rod, cube = scene.add_mesh(box(0.4, 0.4, 2), FACES), scene.add_mesh(box(0.6, 0.6, 0.6), FACES)
    rng = np.random.default_rng(67)
    places = random_poses(rng, 40, 18)
    scene.add(cube, places[np.linalg.norm(places[:, :3, 3], axis=1) > 3])
    up, half = at([0, 0, 2]), at([0, 0, 1])
    links = [Link("rail", None, "prismatic", axis=[0, 2, 0], meshes=[cube])]
    for i in range(5):
        origin = at([0, 0, 0.4]) if i == 0 else up
        links.append(
            Link(f"link {i}", links[-1].name, "revolute", origin, [i % 2, 1 - i % 2, 0.2], [(rod, half)], f"q{i}")
        )
    links.append(Link("wrist", "link 4", origin=up, meshes=[cube, (cube, at([0.5, 0, 0.5]))]))
    return Chain(scene, links)


def configurations(seed: int, count: int) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-3, 3, (count, 6))


def meets(chain: Chain, configuration: np.ndarray, base: np.ndarray, clearance: float = 0) -> set[tuple]:
    """Which meshes of links meet an object or each other, by casts that rest."""
    scene, placed = chain.scene, chain.poses(configuration, base)
    found, number = set(), {name: i for i, name in enumerate(chain.names)}
    bodies = []
    for i, link in enumerate(chain.links):
        for k, entry in enumerate(link.meshes):
            mesh, pose = entry if isinstance(entry, tuple) else (entry, np.eye(4))
            bodies.append((i, k, mesh, placed[i] @ pose))
    options = {"mode": "reference", "hits": "all", "clearance": clearance}
    for i, k, mesh, pose in bodies:
        found |= {(i, k, int(object), -1, -1) for object in scene.cast(mesh, pose, [0, 0, 0], **options).hits.object}
    for a, b in chain.pairs:
        for i, k, mesh, pose in bodies:
            for j, m, other, place in bodies:
                if (i, j) != (number[a], number[b]) or np.linalg.norm(pose[:3, 3] - place[:3, 3]) > 2.5:
                    continue  # farther than any two meshes are long
                beside = cyber_radar.Scene(threads=1)
                ids = [beside.add_mesh(*scene.mesh(each)) for each in (mesh, other)]
                beside.add(ids[1], place)
                if beside.cast(ids[0], pose, [0, 0, 0], mode="reference", clearance=clearance).touches:
                    found.add((i, k, -1, j, m))
    return found


@pytest.mark.parametrize("clearance", [0, 0.05])
def test_chains_meet_nothing_before_their_brackets_and_what_is_named_after(clearance):
    chain, count = arm(), 40
    start, end = configurations(1, count), configurations(2, count)
    base = random_poses(np.random.default_rng(3), count, 1)
    moves = chain.move(start, end, base, clearance=clearance)
    seen = []
    for i in range(count):
        at_time = lambda s: start[i] + s * (end[i] - start[i])  # noqa: E731
        status, lo, hi = moves.status[i], moves.fraction_lo[i], moves.fraction_hi[i]
        seen.append((status, moves.other_link[i] >= 0))
        if status == Status.OVERLAP:
            assert lo == hi == 0
        named = tuple(int(moves.records[i][name]) for name in ("link", "mesh", "object", "other_link", "other_mesh"))
        if status in (Status.HIT, Status.OVERLAP):
            assert 0 <= lo <= hi <= lo + 1e-5 and moves.fraction[i] == lo
            assert named in meets(chain, at_time(hi), base[i], clearance)
            assert moves.link_names[i] == chain.names[moves.link[i]]
            # The point lies on the triangle of what is touched.
            pose, mesh = touched(chain, moves[i], at_time(lo), base[i])
            a, b, c = (pose[:3, :3] @ corner + pose[:3, 3] for corner in mesh[0][mesh[1][moves.tri_b[i]]])
            normal = np.cross(b - a, c - a)
            assert abs((moves.point[i] - a) @ normal) < 1e-4 * np.linalg.norm(normal)
        else:
            assert status == Status.CLEAR and lo == hi == np.inf and named == (-1,) * 5
            assert moves.link_names[i] == ""
        for s in np.arange(0, min(lo, 1) - 1e-9, 0.2):
            assert not meets(chain, at_time(s), base[i], clearance), (i, s)
    assert {(Status.HIT, False), (Status.HIT, True), (Status.CLEAR, False)} <= set(seen)


def touched(chain: Chain, move, configuration, base):
    """The pose, and the mesh, of what a motion touches."""
    if move.object >= 0:
        held = chain.scene.objects()
        at_row = held.ids.tolist().index(int(move.object))
        return held.transforms[at_row], chain.scene.mesh(int(held.meshes[at_row]))
    entry = chain.links[int(move.other_link)].meshes[int(move.other_mesh)]
    mesh, pose = entry if isinstance(entry, tuple) else (entry, np.eye(4))
    return chain.poses(configuration, base)[int(move.other_link)] @ pose, chain.scene.mesh(mesh)


def test_a_page_plays_moves(tmp_path):
    chain = arm()
    start, end = configurations(1, 8).reshape(4, 2, 6), configurations(2, 8).reshape(4, 2, 6)
    start[2, 0, 3] = np.nan
    moves = chain.move(start, end, at([1, 2, 3]), clearance=0.05, exclude_from_all=[1], tolerance=0.01)
    shown = page_data(moves.show(tmp_path / "page.html"))
    assert shown["title"] == "Moves" and shown["queries"]["id"][:3] == ["0, 0", "0, 1", "1, 0"]
    assert [link["name"] for link in shown["chains"][0]["links"]] == list(chain.names)
    assert shown["chains"][0]["links"][2]["origin"] == np.asarray(at([0, 0, 2]))[:3].ravel().tolist()
    assert shown["chains"][0]["links"][1]["joint"] == "revolute" and shown["chains"][0]["links"][0]["joint"] == "prismatic"
    assert len(shown["chains"][0]["links"][6]["meshes"]) == 2
    move = shown["queries"]["moves"]["3"]
    assert (move["from"], move["to"]) == (start[1, 1].tolist(), end[1, 1].tolist()) and move["base"][3::4] == [1, 2, 3]
    assert list(shown["reasons"]) == ["4"] and "start: " in shown["reasons"]["4"]
    assert shown["queries"]["asked"]["3"] == {"clearance": 0.05, "tolerance": 0.01} and shown["queries"]["ignored"]["3"] == [1]
    for name in ("link", "mesh", "object", "other_link", "other_mesh", "tri_a", "tri_b"):
        np.testing.assert_array_equal(numbers(shown["answers"][name]).astype(np.int32), moves.records[name].ravel(), name)
    np.testing.assert_array_equal(numbers(shown["answers"]["lo"]), moves.fraction_lo.ravel())
    part = page_data(moves[1, 1].show(tmp_path / "part.html", title="One"))
    assert part["title"] == "One" and part["queries"]["moves"] == {"0": move} and part["queries"]["id"] == ["1, 1"]
    with pytest.raises(ValueError, match=r"show: expected moves that Chain\.move\(\) has answered"):
        pickle.loads(pickle.dumps(moves)).show(tmp_path / "page.html")


def test_shapes_broadcast_and_an_index_gives_a_part():
    chain = arm()
    start, end, base = configurations(6, 5), configurations(7, 3), at([[0, 0, 0], [0.1, 0, 0]])
    moves = chain.move(start[:, None, None], end[:, None], base)
    assert moves.shape == (5, 3, 2) and len(moves) == 5
    assert repr(moves).startswith("<Moves of shape (5, 3, 2): ")
    one = chain.move(start[4], end[1], base[1])
    assert one.shape == () and same_answers(moves[4, 1, 1], one)
    assert moves[4, 1, 1].link_names == one.link_names and moves[4].shape == (3, 2)
    assert (moves[moves.touches].link == moves.link[moves.touches]).all() and moves.touches.any()
    assert [part.shape for part in moves] == [(3, 2)] * 5
    assert sorted(moves.to_dict()) == sorted(moves.records.dtype.names)
    assert (pickle.loads(pickle.dumps(moves)).link_names == moves.link_names).all()
    with pytest.raises(TypeError, match=r"moves of shape \(\) are one move, without a length"):
        len(one)
    assert chain.move(np.empty((0, 6)), end[0]).shape == (0,)


def test_options_say_what_counts():
    scene = cyber_radar.Scene()
    cube = scene.add_mesh(box(1, 1, 1), FACES)
    scene.add(cube, at([[3, 0.1, 0.2], [5, 0.2, 0.1], [7, 0.1, 0.1]]), mask=[1, 2, 4])
    chain = Chain(scene, [Link("body", joint="prismatic", meshes=[cube])])
    for options, object, t in (
        ({}, 0, 2), ({"exclude_from_all": 0}, 1, 4), ({"exclude_from_all": [0, 1]}, 2, 6), ({"mask": 6}, 1, 4),
        ({"clearance": 0.5}, 0, 1.5),
    ):  # fmt: skip
        move = chain.move([0], [10], **options)
        assert move.object == object and 10 * move.fraction_lo == pytest.approx(t, abs=1e-5)
    assert chain.move([0], [10], mask=8).status == Status.CLEAR
    asked = chain.move([0], [10], any_hit=True)
    assert (asked.status, asked.object, asked.fraction_lo, asked.fraction) == (Status.HIT, -1, 0, 1)
    hits = [chain.move([0], [10], clearance=0.5, tolerance=tolerance) for tolerance in (1e-9, None)]
    fine, coarse = (10 * (hit.fraction_hi - hit.fraction_lo) for hit in hits)
    assert fine <= 1e-9 < coarse <= 1e-6 and hits[0].gap == pytest.approx(0.5, abs=1e-8)


def test_wrong_motions_are_invalid_and_say_why_and_the_others_are_answered():
    chain, count = arm(), 16_500  # in more than one piece
    start, end = np.zeros((count, 6)), np.zeros((count, 6))
    end[:, 0] = 1e-3
    bases = np.broadcast_to(at([0, 0, 100]), (count, 4, 4)).copy()
    start[[3, 16_400], 1] = np.nan
    end[16_401, 0] = np.inf
    bases[5, 0, 0] = 2
    moves = chain.move(start, end, bases)
    wrong = {which[0]: (reason, which.tolist()) for reason, which in moves.reasons.items()}
    assert wrong[3] == ("start: variable 1: expected an angle up to 2^16, got nan", [3, 16_400])
    assert wrong[16_401] == ("end: variable 0: expected a length up to 2^300, got inf", [16_401])
    assert wrong[5][0].startswith("base: expected a rigid pose") and wrong[5][1] == [5]
    invalid = np.flatnonzero(moves.status == Status.INVALID)
    assert invalid.tolist() == [3, 5, 16_400, 16_401]
    assert np.isnan(moves.fraction_lo[invalid]).all() and (moves.object[invalid] == -1).all()
    assert (np.delete(moves.status, invalid) == Status.CLEAR).all()
    assert moves[16_400].reasons == {wrong[3][0]: [0]}


def test_answers_do_not_depend_on_the_batch():
    chain = arm()
    start, end = configurations(8, 300), configurations(9, 300)
    moves = chain.move(start, end)
    for i in range(0, 300, 37):
        assert same_answers(chain.move(start[i], end[i]), moves[i])
    assert same_answers(arm(threads=1).move(start, end), moves)
    assert len(set(moves.status)) > 1


def test_links_that_are_fixed_to_each_other_or_share_a_joint_are_no_pairs():
    scene = cyber_radar.Scene()
    cube = scene.add_mesh(box(1, 1, 1), FACES)
    solid = {"meshes": [cube]}
    links = [
        Link("stand", **solid), Link("column", **solid), Link("turret", "stand", "revolute", **solid),
        Link("plate", "turret", **solid), Link("flange", "turret"), Link("arm", "flange", "revolute", **solid),
        Link("cart", joint="prismatic", **solid), Link("tool", "arm", "revolute", **solid),
    ]  # fmt: skip
    pairs = {frozenset(pair) for pair in Chain(scene, links).pairs}
    base, head = ("stand", "column"), ("turret", "plate")
    expected = {frozenset((a, b)) for a in base for b in ("arm", "tool")} | {frozenset((a, "tool")) for a in head}
    expected |= {frozenset((a, "cart")) for a in (*head, "arm", "tool")}
    assert pairs == expected
    less = Chain(scene, links, ignored=[("tool", "stand"), ("arm", "cart")])
    ignored = {frozenset({"tool", "stand"}), frozenset({"arm", "cart"})}
    assert {frozenset(pair) for pair in less.pairs} == expected - ignored
    assert Chain(scene, links, pairs=[("arm", "turret")], ignored=[("arm", "turret")]).pairs == ()


def test_joints_may_share_a_number_and_have_limits_and_an_order():
    scene = cyber_radar.Scene()
    links = [
        Link("left", joint="prismatic", axis=[1, 0, 0], variable="grip", limits=(0, 3)),
        Link("right", joint="prismatic", axis=[-1, 0, 0], variable="grip", limits=(-1, 2)),
        Link("wrist", "left", "revolute", axis=[0, 0, 3]),
    ]
    chain = Chain(scene, links)
    assert chain.variables == ("grip", "wrist") and repr(chain) == "<Chain of 3 links, 2 variables, 0 pairs>"
    assert chain.lower.tolist() == [0, -np.inf] and chain.upper.tolist() == [2, np.inf]
    placed = chain.poses([[1, 0], [2, np.pi / 2]], at([0, 0, 5]))
    assert placed.shape == (2, 3, 4, 4) and (placed[:, 1] == at([[-1, 0, 5], [-2, 0, 5]])).all()
    np.testing.assert_allclose(placed[1, 2], [[0, -1, 0, 2], [1, 0, 0, 0], [0, 0, 1, 5], [0, 0, 0, 1]], atol=1e-15)
    turned = Chain(scene, links, variables=["wrist", "grip"])
    assert turned.lower.tolist() == [-np.inf, 0]
    assert (turned.poses([np.pi / 2, 2], at([0, 0, 5])) == placed[1]).all()


def test_meshes_far_from_their_origin_stand_where_they_do_near_it():
    scene = cyber_radar.Scene()
    far = np.array([1e6 + 1 / 3, 0, 0])
    meshes = [scene.add_mesh(box(1, 1, 1) + shift, FACES) for shift in (np.zeros(3), far)]
    scene.add(meshes[0], at([0.9, 3, 0.2]))
    near_move, far_move = (
        Chain(scene, [Link("body", joint="prismatic", axis=[0, 1, 0], meshes=[(mesh, pose)])]).move([0], [5])
        for mesh, pose in ((meshes[0], at([0.5, 0, 0])), (meshes[1], at([0.5, 0, 0] - far)))
    )
    assert near_move.object == far_move.object == 0
    assert near_move.fraction_lo == pytest.approx(0.4, abs=1e-6)
    assert far_move.fraction_lo == pytest.approx(0.4, abs=1e-6)


def test_messages_name_the_argument():
    scene = cyber_radar.Scene()
    cube = scene.add_mesh(box(1, 1, 1), FACES)
    chain = Chain(scene, [Link("a", joint="revolute", meshes=[cube]), Link("b", "a", "revolute", meshes=[cube])])
    link = lambda **changed: Chain(scene, [Link(**{"name": "a", "joint": "revolute"} | changed)])  # noqa: E731
    move = lambda *given, **options: chain.move(*given, **options)  # noqa: E731
    q = [0, 0]
    for call, words in (
        (
            lambda: link(joint="ball"),
            """links[0] ('a'): joint: expected "fixed", "revolute" or "prismatic", got 'ball'""",
        ),
        (lambda: link(parent="b"), "links[0] ('a'): parent: expected the name of a link before it, got 'b'"),
        (lambda: link(parent="a"), "links[0] ('a'): parent: expected the name of a link before it, got 'a'"),
        (lambda: link(axis=[0, 0, 0]), "links[0] ('a'): axis: expected a vector that is not zero"),
        (lambda: link(axis=np.eye(3)), "links[0] ('a'): axis: expected shape (3,), got shape (3, 3)"),
        (lambda: link(origin=np.diag([2, 1, 1, 1])), "links[0] ('a'): origin: expected a rigid pose"),
        (lambda: link(origin=at(np.zeros((2, 3)))), "links[0] ('a'): origin: expected one pose, got shape (2, 4, 4)"),
        (lambda: link(meshes=[7]), "links[0] ('a'): mesh: expected ids of meshes of the scene, got 7"),
        (lambda: link(meshes=[(cube, np.zeros((3, 4)))]), "links[0] ('a'): mesh 0: expected an invertible"),
        (lambda: link(meshes=[(cube, np.eye(3))]), "links[0] ('a'): meshes: expected numbers of shape (..., 4, 4) or"),
        (lambda: link(limits=(1, 0)), "links[0] ('a'): limits: expected a least and a greatest number, got (1, 0)"),
        (lambda: Chain(scene, [Link("a"), Link("a")]), "links: expected names that differ, got 'a' twice"),
        (lambda: Chain(scene, chain.links, pairs=["ac"]), "pairs[0]: expected the names of two links, got 'ac'"),
        (
            lambda: Chain(scene, chain.links, pairs=[("a", "c")]),
            "pairs[0]: expected the names of two links, got ('a', 'c'",
        ),
        (lambda: Chain(scene, chain.links, ignored=["ab"]), "ignored[0]: expected the names of two links, got 'ab'"),
        (lambda: Chain(scene, chain.links, variables="a"), "variables: expected ('a', 'b') in any order, got ('a',)"),
        (lambda: move([0], q), "start: expected numbers of shape (..., 2), got shape (1,)"),
        (lambda: move(q, 1), "end: expected numbers of shape (..., 2), got shape ()"),
        (lambda: move(q, q, np.eye(3)), "base: expected numbers of shape (..., 4, 4) or (..., 3, 4), got shape (3, 3)"),
        (lambda: move([q] * 3, [q] * 2), "got start (3, 2), end (2, 2)"),
        (lambda: move(q, q, any_hit=1), "any_hit: expected True or False, got 1"),
        (lambda: move(q, q, clearance=-1), "clearance: expected a finite number of 0 or more, got -1"),
        (lambda: move(q, q, tolerance=np.nan), "tolerance: expected a finite number of 0 or more, got nan"),
        (lambda: move(q, q, mask=-1), "mask: expected whole numbers from 0 to 4294967295, got -1"),
        (lambda: move(q, q, exclude_from_all=3), "exclude_from_all: expected ids of objects of the scene, got 3"),
        (lambda: chain.poses([1]), "configurations: expected numbers of shape (..., 2), got shape (1,)"),
    ):
        assert words in refusal(call)
    scene.remove_mesh(cube)
    with pytest.raises(cyber_radar.Error, match="chain: link 0: mesh 0: mesh 0 of the scene does not exist"):
        move(q, q)


def test_the_compiled_half_refuses_motions_that_do_not_fit():
    chain = arm()
    options = {"any_hit": False, "mask": 1, "clearance": 0.0, "tolerance": None}
    good = {"start": np.zeros((4, 6)), "end": np.zeros((4, 6)), "base": at(np.zeros((4, 3)))}
    call = lambda arrays: chain.scene._engine.move_chain(chain._given(), *arrays.values(), [], options)  # noqa: E731
    assert len(call(good)[0]) == 4
    for name in good:
        with pytest.raises(ValueError, match="expected"):
            call(good | {name: good[name][:2]})


def test_ctrl_c_and_other_signals_end_motions():
    scene = cyber_radar.Scene()
    chain = Chain(scene, [Link("cloud", joint="prismatic", meshes=[endless(scene)])])

    def give_up(*_):
        raise TimeoutError("enough")

    before = signal.signal(signal.SIGALRM, give_up)
    try:
        with pytest.raises(TimeoutError, match="enough"):
            signal.setitimer(signal.ITIMER_REAL, 0.1)
            chain.move([0], [1e-9])
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert chain.move([0], [1], at([0, 0, 1000])).status == Status.CLEAR


def test_other_threads_run_while_chains_move():
    chain = arm()
    given, start, end = chain._given(), configurations(10, 300), configurations(11, 300)
    options = {"any_hit": False, "mask": 1, "clearance": 0.0, "tolerance": None}
    move = chain.scene._engine.move_chain
    with concurrent.futures.ThreadPoolExecutor(1) as thread:  # in the main one signals are heeded, with the lock
        thread.submit(
            until_another_thread_runs_within, lambda: move(given, start, end, np.eye(4), [], options)
        ).result()


def _fractions(chain, start, end):
    return chain.move(start, end).fraction_lo


@many_threads
@pytest.mark.parametrize("method", ["spawn", "fork"])
def test_other_processes_answer_with_the_pickled_chain(method):
    chain = arm()
    start, end = configurations(12, 40), configurations(13, 40)
    expected = _fractions(chain, start, end)
    with concurrent.futures.ProcessPoolExecutor(2, multiprocessing.get_context(method)) as processes:
        parts = [processes.submit(_fractions, chain, start[i::2], end[i::2]) for i in range(2)]
        for i, part in enumerate(parts):
            assert (part.result() == expected[i::2]).all()
