"""Robots as URDF files describe them."""

import numpy as np
import pytest

import cyber_radar
from conftest import FACES, at, box, write_obj
from cyber_radar import Status, load_urdf
from test_arguments import refusal

ROBOT = """<?xml version="1.0"?>
<robot name="arm">
  <material name="grey"><color rgba="0.5 0.5 0.5 1"/></material>
  <link name="rail"><collision><geometry><mesh filename="part.obj"/></geometry></collision></link>
  <link name="base">
    <inertial><mass value="1"/></inertial>
    <visual><geometry><sphere radius="0.5"/></geometry><material name="grey"/></visual>
    <collision><geometry><mesh filename="package://parts/part.obj"/></geometry></collision>
  </link>
  <link name="arm">
    <collision name="rod"><origin xyz="0 0 2"/><geometry><mesh filename="part.obj" scale="1 1 2"/></geometry></collision>
    <collision><origin xyz="0 0.1 0" rpy="0 0 1.5707963267948966"/><geometry><box size="0.3 0.1 0.7"/></geometry></collision>
  </link>
  <joint name="slide" type="prismatic">
    <parent link="arm"/><child link="rail"/><origin rpy="0 0 1.5707963267948966"/><axis xyz="2 0 0"/>
    <limit lower="-0.5" upper="2" effort="1" velocity="1"/>
  </joint>
  <joint name="elbow" type="revolute">
    <parent link="base"/><child link="arm"/><origin xyz="3 0 0"/><axis xyz="0 1 0"/>
    <limit upper="1.5" effort="1" velocity="1"/><dynamics damping="1"/>
  </joint>
  <link name="tool"/>
  <joint name="screw" type="continuous"><parent link="rail"/><child link="tool"/></joint>
  <link name="tip"/>
  <joint name="glue" type="fixed"><parent link="tool"/><child link="tip"/><origin rpy="0.3 -0.4 2"/></joint>
  <transmission name="t"><joint name="elbow"/></transmission>
</robot>"""


@pytest.fixture
def robot(tmp_path):
    write_obj(tmp_path / "part.obj")
    (tmp_path / "robot.urdf").write_text(ROBOT)
    return tmp_path / "robot.urdf"


def load(robot, scene=None, **options):
    return load_urdf(
        cyber_radar.Scene() if scene is None else scene, robot, **{"packages": {"parts": robot.parent}} | options
    )


def turn(x=0.0, y=0.0, z=0.0):
    """About fixed axes, x first."""
    out = np.eye(3)
    for angle, (i, j) in ((x, (1, 2)), (y, (2, 0)), (z, (0, 1))):
        step = np.eye(3)
        step[[i, i, j, j], [i, j, i, j]] = np.cos(angle), -np.sin(angle), np.sin(angle), np.cos(angle)
        out = step @ out
    return out


def test_links_joints_and_limits_are_those_of_the_file(robot):
    chain = load(robot)
    assert chain.variables == ("slide", "elbow", "screw")
    assert chain.lower.tolist() == [-0.5, 0, -np.inf] and chain.upper.tolist() == [2, 1.5, np.inf]
    assert [(link.name, link.parent, link.joint) for link in chain.links] == [
        ("base", None, "fixed"), ("arm", "base", "revolute"), ("rail", "arm", "prismatic"),
        ("tool", "rail", "revolute"), ("tip", "tool", "fixed"),
    ]  # fmt: skip
    base, arm, rail, tool, tip = chain.poses([5, np.pi / 2, 0.7])
    assert (base == np.eye(4)).all()
    # A quarter about y takes z to x: the arm points along x from (3, 0, 0).
    np.testing.assert_allclose(arm[:3], [[0, 0, 1, 3], [0, 1, 0, 0], [-1, 0, 0, 0]], atol=1e-15)
    # Its slide is along the y axis, since its frame is turned about z.
    np.testing.assert_allclose(rail[:3, 3], [3, 5, 0], atol=1e-15)
    np.testing.assert_allclose(tool[:3, :3], arm[:3, :3] @ turn(z=np.pi / 2) @ turn(x=0.7), atol=1e-15)
    np.testing.assert_allclose(tip[:3, :3], tool[:3, :3] @ turn(0.3, -0.4, 2), atol=1e-15)


def corners(chain, link, number):
    """Of a mesh of a link, in its frame."""
    (mesh, pose), scene = chain.links[chain.names.index(link)].meshes[number], chain.scene
    return scene.mesh(mesh)[0] @ pose[:3, :3].T + pose[:3, 3], scene.mesh(mesh)[1]


def test_shapes_stand_where_the_file_has_them_and_share_meshes(robot):
    scene = cyber_radar.Scene()
    chain = load(robot, scene)
    assert [len(link.meshes) for link in chain.links] == [1, 2, 1, 0, 0]
    assert len(scene.meshes) == 2 and len(scene) == 0  # the file's and a box
    np.testing.assert_array_equal(np.unique(corners(chain, "arm", 0)[0], axis=0), box(1, 1, 2) + [0, 0, 2])
    of_box = corners(chain, "arm", 1)[0]
    np.testing.assert_allclose([of_box.min(0), of_box.max(0)], [[-0.05, -0.05, -0.35], [0.05, 0.25, 0.35]], atol=1e-15)
    assert chain.pairs == (("base", "rail"),)
    # A box is exact: no float can hold these sizes.
    (mesh, pose), at_middle = chain.links[1].meshes[1], np.array([0, 0.1, 0])
    assert (scene.mesh(mesh)[0] == box(1, 1, 1)).all() and (pose[:3, 3] == at_middle).all()
    np.testing.assert_array_equal(np.abs(pose[:3, :3]).max(axis=0), [0.3, 0.1, 0.7])


def test_visual_shapes_are_taken_on_request(robot):
    chain = load(robot, geometry="visual", segments=12)
    assert [len(link.meshes) for link in chain.links] == [1, 0, 0, 0, 0]
    np.testing.assert_allclose(np.linalg.norm(corners(chain, "base", 0)[0], axis=1), 0.5, rtol=1e-6)


@pytest.mark.parametrize("segments", [3, 4, 7, 32])
@pytest.mark.parametrize("shape", ['cylinder radius="0.5" length="3"', 'sphere radius="0.5"'])
def test_round_shapes_are_closed_meshes_inside_them_by_no_more_than_is_said(tmp_path, shape, segments):
    (tmp_path / "a.urdf").write_text(
        f'<robot><link name="a"><collision><geometry><{shape}/></geometry></collision></link></robot>'
    )
    chain = load_urdf(cyber_radar.Scene(), tmp_path / "a.urdf", segments=segments)
    vertices, faces = corners(chain, "a", 0)
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]).tolist()
    assert len({tuple(edge) for edge in edges}) == len(edges)
    assert {tuple(edge) for edge in edges} == {tuple(edge[::-1]) for edge in edges}
    a, b, c = vertices[faces].transpose(1, 0, 2)
    assert np.einsum("ij,ij->", a, np.cross(b, c)) > 0  # wound outwards
    normals = np.cross(b - a, c - a)
    depth = np.einsum("ij,ij->i", a, normals) / np.linalg.norm(normals, axis=1)  # of planes, from the middle
    lost = 0.5 * (1 - np.cos(np.pi / segments))
    if shape.startswith("cylinder"):
        assert (np.abs(vertices[:, 2]) == 1.5).all()
        sides = np.abs(normals[:, 2]) < 1e-9
        assert depth[sides] == pytest.approx(0.5 - lost) and depth[~sides] == pytest.approx(1.5)
        assert (np.hypot(*vertices.T[:2]) < 0.5 + 1e-7).all() and len(faces) == 4 * segments
    else:
        assert np.linalg.norm(vertices, axis=1) == pytest.approx(0.5)
        assert (0.5 - depth < 2 * lost).all() and (0.5 - depth).max() > lost


def test_an_arm_from_a_file_touches_what_stands_in_its_way(robot):
    scene = cyber_radar.Scene()
    chain = load(robot, scene)
    wall = scene.add(scene.add_mesh(box(0.2, 20, 20), FACES), at([6, 0, 0]))
    # The rod's end, 3 from the elbow and 0.5 to its side, comes to x = 5.9 in a turn about y.
    expected = np.arcsin(2.9 / np.hypot(3, 0.5)) - np.arctan2(0.5, 3)
    move = chain.move([0, 0, 0], [0, 1.5, 0])
    assert (move.status, move.object, move.link_names, move.mesh) == (Status.HIT, wall, "arm", 0)
    assert 1.5 * move.fraction_lo == pytest.approx(expected, abs=1e-5)


def test_links_are_ignored_by_names_and_by_an_srdf_file(robot, tmp_path):
    assert load(robot, ignored=[("rail", "base")]).pairs == ()
    srdf = tmp_path / "robot.srdf"
    srdf.write_text(
        '<robot name="arm"><group name="g"><joint name="elbow"/></group>\n'
        '<disable_collisions link1="base" link2="rail" reason="Never"/></robot>'
    )
    assert load(robot, srdf=srdf).pairs == ()
    for wrong, words in (
        ('<disable_collisions link1="base" link2="cup"/>', "expected two links of the robot, got 'base' and 'cup'"),
        ('<disable_collisions link1="base"/>', "<disable_collisions>: expected an attribute link2"),
        ('<disable_default_collisions link="base"/>', "<disable_default_collisions>: expected in <robot>: "),
    ):
        srdf.write_text(f"<robot>\n{wrong}</robot>")
        assert refusal(lambda: load(robot, srdf=srdf)).startswith(f"{srdf}:2: ")
        assert words in refusal(lambda: load(robot, srdf=srdf))


LINE = "\n"
PLACES = {
    "joint 'elbow'": '<joint name="elbow" type',
    "robot 'arm'": "<robot",
    "expected one link": "<robot",
    "expected XML": "</robot>",
}


def test_what_is_wrong_or_unknown_is_refused_with_its_line(robot):
    for old, new, words in (
        ('type="continuous"', 'type="planar"', "joint 'screw': type: expected revolute, continuous, prismatic, fixed, got 'pla"),
        ('type="continuous"', 'type="floating"', "got 'floating'"),
        ('<dynamics damping="1"/>', '<mimic joint="slide"/>', "<mimic>: expected in joint 'elbow': "),
        ('<material name="grey"><color', '<xacro:macro xmlns:xacro="x"/><material name="grey"><color', "<xacro:macro>: expec"),
        ('<box size="0.3 0.1 0.7"/>', '<capsule radius="1" length="2"/>', "<capsule>: expected a box, cylinder, sphere or"),
        ('<box size="0.3 0.1 0.7"/>', '<cylinder radius="1" length="2"/>', "<cylinder>: expected boxes and meshes, or segm"),
        ('<box size="0.3 0.1 0.7"/>', '<box size="0.3 0.1"/>', "<box>: size: expected 3 finite numbers, got '0.3 0.1'"),
        ('<box size="0.3 0.1 0.7"/>', '<box size="0.3 0.1 nan"/>', "<box>: size: expected 3 finite numbers, got '0.3 0.1 nan'"),
        ('<box size="0.3 0.1 0.7"/>', "<box/>", "<box>: size: expected 3 finite numbers, got ''"),
        ('<box size="0.3 0.1 0.7"/>', '<box size="0.3 0 1"/>', "<box>: expected sizes that are above 0"),
        ('<box size="0.3 0.1 0.7"/>', "", "<collision>: expected a <geometry> with one shape"),
        ('scale="1 1 2"', 'scale="1 0 2"', "<mesh>: expected sizes that are not 0"),
        ("package://parts/", "package://cups/", "<mesh>: filename: expected a file, or one in a package of ['parts'], got"),
        ('"package://parts/part.obj"', '"cup.obj"', "cup.obj"),
        ('filename="package://parts/part.obj"', "", "<mesh>: expected an attribute filename"),
        ('<axis xyz="0 1 0"/>', '<axis xyz="0 0 0"/>', "joint 'elbow': axis: expected a vector that is not zero"),
        ('<axis xyz="0 1 0"/>', '<axis xyz="0 one 0"/>', "<axis>: xyz: expected 3 finite numbers, got '0 one 0'"),
        ('upper="1.5"', 'upper="-1"', "joint 'elbow': limit: expected lower up to upper, got 0.0 and -1.0"),
        ('<child link="arm"/>', '<child link="cup"/>', "joint 'elbow': expected links of the file, got 'cup'"),
        ('<child link="arm"/>', '<child link="rail"/>', "joint 'elbow': expected one joint for each child, got another for 'r"),
        ('<child link="arm"/>', "", "joint 'elbow': expected a <child>"),
        ('<parent link="base"/>', '<parent link="tip"/>', "robot 'arm': expected joints that lead from 'base' to all links"),
        ('<link name="tip"/>', '<link name="tool"/>', "link 'tool': expected another name than before"),
        ('<link name="tip"/>', '<link name="tip"/><link name="cup"/>', "expected one link that is no joint's child, got ['ba"),
        ('<link name="tip"/>', "<link/>", "<link>: expected an attribute name"),
        ('<link name="tip"/>', '<link name="tip">', "expected XML: mismatched tag"),
    ):  # fmt: skip
        assert ROBOT.count(old) == 1
        robot.write_text(ROBOT.replace(old, new))
        scene = cyber_radar.Scene()
        said = refusal(lambda: load(robot, scene))
        assert words in said
        # The line is that of the element that is wrong.
        place = next((place for begin, place in PLACES.items() if words.startswith(begin)), old)
        assert said.startswith(f"{robot}:{1 + ROBOT[: ROBOT.index(place)].count(LINE)}: "), said
        assert scene.meshes == []
    robot.write_text(ROBOT)
    assert "nowhere.urdf: cannot be read: No such file" in refusal(lambda: load(robot.parent / "nowhere.urdf"))
    assert "segments: expected whole numbers from 3" in refusal(lambda: load(robot, segments=2))
    assert 'geometry: expected "collision" or "visual"' in refusal(lambda: load(robot, geometry="all"))
    robot.write_text(ROBOT.replace("visual>", "collision>"))
    assert "robot 'arm': expected a link with a <visual>, without" in refusal(lambda: load(robot, geometry="visual"))
    robot.write_text("<model/>")
    assert refusal(lambda: load(robot)) == f"{robot}:1: <model>: expected <robot>, got <model>"
