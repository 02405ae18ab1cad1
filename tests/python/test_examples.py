"""The examples do what they say, on small inputs."""

import json
import pathlib
import subprocess
import sys

import numpy as np

EXAMPLES = pathlib.Path(__file__).parents[2] / "tools/examples"
sys.path.insert(0, str(EXAMPLES))

import arm  # noqa: E402
import bayonet  # noqa: E402
import burr  # noqa: E402
import cyber_radar  # noqa: E402
import disassembly  # noqa: E402
from conftest import numbers, page_data  # noqa: E402
from test_scene import ENGINE  # noqa: E402


def run(example: str, *arguments) -> str:
    strict = ["-W", "error", "-W", "ignore:Undefined-Value-Layer-Written"]  # as in pytest.ini
    done = subprocess.run(
        [sys.executable, *strict, EXAMPLES / example, *map(str, arguments)], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_blocking_graph_of_a_burr_is_that_of_its_cubes(tmp_path):
    text = run("disassembly.py", "--out", tmp_path, "--mode", "reference")
    told = json.loads((tmp_path / "graph.json").read_text())
    expected = burr.blocking(burr.pieces())
    for direction, blocked_by in zip(told["directions"], told["blocked_by"]):
        d = (burr.AXES == direction).all(axis=1).argmax()
        assert blocked_by == [np.flatnonzero(row).tolist() for row in expected[d]]
    assert told["interpenetrating"] == [] and told["locked"] == []
    assert [step["parts"] for step in told["steps"]][0] == [0]
    free = [i for i in range(6) if any(not blocked_by[i] for blocked_by in told["blocked_by"])]
    assert free == [0] and len(told["steps"]) == 5
    assert text.startswith("6 parts, 0 pairs interpenetrate, 5 steps\n  part 0: along")

    shown = page_data(tmp_path / "steps.html")
    assert shown["title"] == "5 steps" and shown["queries"]["count"] == 5
    assert shown["queries"]["ignored"]["0"] == [0]  # the first moves alone; then it is gone
    assert all(0 in ignored for ignored in shown["queries"]["ignored"].values())


def test_pieces_of_the_burr_are_closed_and_fill_the_middle():
    parts = burr.pieces()
    cubes = np.concatenate(parts)
    assert len(np.unique(cubes, axis=0)) == len(cubes) == 104
    for part in parts:
        vertices, faces = burr.surface(part)
        a, b, c = vertices[faces].transpose(1, 0, 2)
        assert np.einsum("ij,ij->", a, np.cross(b, c)) / 6 == len(part)  # the volume, so it is wound outwards
        edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
        there, count = np.unique(edges, axis=0, return_counts=True)
        back = {tuple(edge): n for edge, n in zip(there[:, ::-1].tolist(), count.tolist())}
        assert all(back[tuple(edge)] == n for edge, n in zip(there.tolist(), count.tolist()))


def test_groups_that_only_move_together_are_found_and_what_is_locked_is_listed():
    # 0 and 1 block each other everywhere; 2 blocks both in all directions but the first; 2 itself is blocked by 0.
    blocked = np.ones((2, 3, 3), bool)
    blocked[:, range(3), range(3)] = False
    blocked[0, :2, 2] = False
    graph = disassembly.Graph(np.eye(3)[:2], blocked, np.zeros((2, 3)), np.zeros((3, 3), bool))
    steps, locked = disassembly.removal_order(graph)
    assert [(step.parts, step.direction, step.taken_from) for step in steps] == [([0, 1], 0, [2])]
    assert locked == [[0, 1]]


def test_an_engine_comes_apart_and_what_interpenetrates_is_listed(tmp_path):
    run("disassembly.py", ENGINE, "--out", tmp_path)
    told = json.loads((tmp_path / "graph.json").read_text())
    assert len(told["parts"]) == 67 and len(told["interpenetrating"]) == 80
    moved = [part for step in told["steps"] for part in step["parts"]]
    assert len(told["steps"]) > 50 and len(set(moved)) > 50
    crossing = {tuple(pair) for pair in told["interpenetrating"]}
    for direction in told["blocked_by"]:
        for part, others in enumerate(direction):
            assert part not in others
            assert not any((min(part, k), max(part, k)) in crossing for k in others)
    assert all(len(group) > 1 for group in told["locked"])


def test_a_bayonet_comes_out_where_its_lugs_stand_in_the_slots(tmp_path):
    text = run("bayonet.py", "--out", tmp_path)
    # Lugs of 20 degrees in slots of 30, from whose middle they are locked 45 away; the rim is 0.4 above them.
    assert "pulled, it is free for 0.4 mm; turned back, for 50 degrees\n" in text
    assert "turned back by 40.5 to 49.5 degrees, it comes out\n" in text
    for mesh in (bayonet.plug(), bayonet.socket()):
        a, b, c = mesh[0].astype(float)[mesh[1]].transpose(1, 0, 2)
        edges = np.concatenate([mesh[1][:, [i, (i + 1) % 3]] for i in range(3)])
        assert len(np.unique(edges, axis=0)) == len(edges)  # each once, and
        assert {(i, k) for i, k in edges.tolist()} == {(k, i) for i, k in edges.tolist()}  # once the other way round
        assert np.einsum("ij,ij->i", a, np.cross(b, c)).sum() > 0  # wound outwards
    shown = page_data(tmp_path / "bayonet.html")
    assert numbers(shown["answers"]["status"]).tolist() == [0, 1, 1]
    assert [round(np.rad2deg(turn["angle"])) for turn in shown["queries"]["turns"].values()] == [0, -45, 0]


def test_motions_of_an_arm_among_shelves_are_free_where_samples_are(tmp_path):
    text = run("arm.py", "--motions", 300, "--out", tmp_path)
    scene, rng = cyber_radar.Scene(), np.random.default_rng(1)
    arm.add_shelves(scene, rng)
    robot = cyber_radar.load_urdf(scene, tmp_path / "arm.urdf")
    assert len(robot.variables) == 6 and len(robot.links) == 7
    through = arm.free_configurations(robot, 301, rng)
    assert (np.abs(through) <= robot.upper).all()
    start, end = through[:-1], through[1:]
    samples = start + np.linspace(0, 1, 60)[:, None, None] * (end - start)
    sampled = robot.move(samples, samples).touches.any(axis=0)
    moves = robot.move(start, end)
    assert moves.touches[sampled].all() and (sampled[moves.touches]).mean() > 0.9
    stopped = moves.touches.sum()
    assert 50 < stopped < 250
    assert text.startswith(f"300 motions: {300 - stopped} are free, {stopped} are not, 0 undecided\nhit most: the ")
    link = text.split("hit most: the ")[1].split(",")[0]
    hits = (moves.link_names == link).sum()
    assert f"{link}, in {hits}; the arm hits itself in {(moves.other_link >= 0).sum()}\n" in text
    assert hits == max((moves.link_names == name).sum() for name in robot.names)

    shown = page_data(tmp_path / "contact.html")
    best = arm.farthest(moves)
    assert shown["title"] == f"The {best.link_names} touches object {best.object}"
    assert len(shown["chains"][0]["links"]) == 7 and shown["queries"]["count"] == 1
    assert best.fraction_lo == max(moves.fraction_lo[moves.object >= 0])


def test_a_robot_of_a_file_may_move_among_the_shelves(tmp_path):
    text = arm.urdf().replace('box size="0.1 0.1 0.5"', 'cylinder radius="0.05" length="0.5"')
    assert "cylinder" in text
    (tmp_path / "robot.urdf").write_text(text)
    text = run("arm.py", tmp_path / "robot.urdf", "--motions", 50, "--segments", 8, "--out", tmp_path / "out")
    assert text.startswith("50 motions: ")
    assert [file.name for file in (tmp_path / "out").iterdir()] == ["contact.html"]
