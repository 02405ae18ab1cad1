"""The examples do what they say, on small inputs."""

import json
import pathlib
import subprocess
import sys

import numpy as np

EXAMPLES = pathlib.Path(__file__).parents[2] / "tools/examples"
sys.path.insert(0, str(EXAMPLES))

import burr  # noqa: E402
import cyber_radar  # noqa: E402
import disassembly  # noqa: E402
import urdf  # noqa: E402
from conftest import FACES, box, page_data  # noqa: E402
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


ROBOT = """<robot name="arm">
  <link name="base"><collision><geometry><mesh filename="package://part.obj"/></geometry></collision></link>
  <link name="arm"><collision><origin xyz="0 0 2"/><geometry><mesh filename="part.obj" scale="1 1 2"/></geometry></collision>
  </link>
  <link name="rail"><collision><geometry><mesh filename="part.obj"/></geometry></collision></link>
  <joint name="elbow" type="revolute"><parent link="base"/><child link="arm"/><origin xyz="3 0 0"/><axis xyz="0 1 0"/></joint>
  <joint name="slide" type="prismatic"><parent link="arm"/><child link="rail"/><origin rpy="0 0 1.5707963267948966"/>
    <axis xyz="1 0 0"/></joint>
</robot>"""


def test_the_links_of_a_robot_stand_where_its_joints_put_them(tmp_path):
    lines = [f"v {x} {y} {z}" for x, y, z in box(1, 1, 1).tolist()] + [f"f {a} {b} {c}" for a, b, c in FACES + 1]
    (tmp_path / "part.obj").write_text("\n".join(lines))
    (tmp_path / "robot.urdf").write_text(ROBOT)
    scene = cyber_radar.Scene()
    assert urdf.add_robot(scene, tmp_path / "robot.urdf", {"elbow": np.pi / 2, "slide": 5}) == {
        "base": [0], "arm": [1], "rail": [2]
    }  # fmt: skip
    base, arm, rail = scene.objects().transforms
    assert (base[:3] == np.eye(4)[:3]).all()
    # A quarter about y takes z to x: the arm points along x from (3, 0, 0).
    np.testing.assert_allclose(arm[:3], [[0, 0, 1, 5], [0, 1, 0, 0], [-1, 0, 0, 0]], atol=1e-15)
    # Its slide is along the y axis, since its frame is turned about z.
    np.testing.assert_allclose(rail[:3, 3], [3, 5, 0], atol=1e-15)
    assert np.ptp(scene.mesh(int(scene.objects().meshes[1]))[0], axis=0).tolist() == [1, 1, 2]
    assert run("urdf.py", tmp_path / "robot.urdf", "elbow=0.5") == "base 0\narm 1\nrail 2\n"
