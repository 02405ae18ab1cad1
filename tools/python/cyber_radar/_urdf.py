"""Robots as URDF files describe them."""

from __future__ import annotations

import dataclasses
import math
import os
import pathlib
from collections.abc import Mapping
from typing import Literal, Union
from xml.etree import ElementTree
from xml.parsers import expat

import numpy as np
import numpy.typing as npt

from ._arguments import about_base, one_whole_number
from ._chain import Chain, Link, Pairs
from ._files import Path, file_mesh
from ._scene import Scene

Geometry = Literal["collision", "visual"]
Folders = Mapping[str, Union[str, "os.PathLike[str]"]]
_Mesh = tuple[npt.NDArray[np.float32], npt.NDArray[np.uint32], npt.NDArray[np.float64]]  # about a base; faces; the base
_Triangles = tuple[npt.NDArray[np.float64], npt.NDArray[np.uint32]]
_JOINTS: dict[str, Literal["fixed", "revolute", "prismatic"]] = {
    "revolute": "revolute",
    "continuous": "revolute",
    "prismatic": "prismatic",
    "fixed": "fixed",
}
# What may stand in an element: what is read, and what says nothing of shapes and motions.
_IN_ROBOT = {"link", "joint", "material", "transmission", "gazebo", "ros2_control", "sensor"}
_IN_LINK = {"collision", "visual", "inertial", "contact"}
_IN_SHAPE = {"origin", "geometry", "material"}
_IN_JOINT = {"parent", "child", "origin", "axis", "limit", "calibration", "dynamics", "safety_controller"}
_IN_SRDF = {"disable_collisions", "group", "group_state", "end_effector", "virtual_joint", "passive_joint"}


def load_urdf(
    scene: Scene,
    file: Path,
    *,
    geometry: Geometry = "collision",
    segments: int | None = None,
    packages: Folders | None = None,
    ignored: Pairs = (),
    srdf: Path | None = None,
) -> Chain:
    """Reads a robot's links, joints and shapes from a URDF file. Its meshes are added to the scene.

    geometry: "collision" or "visual": which shapes the links have.
    segments: cylinders and spheres become meshes of so many segments around, 3 at least, whose corners lie on the
        surface. So they are smaller: a cylinder of radius r by up to r (1 - cos(pi / segments)), a sphere by up to
        twice that; a clearance makes up for it. None: they are refused. Boxes are exact.
    packages: folders by name, for meshes at package://name/...; others are relative to the file.
    ignored: (k, 2) names of links that are not tested with each other, as of Chain.
    srdf: a file whose disable_collisions are ignored, too.

    The chain's variables are the joints that move, in the file's order; `lower` and `upper` have their limits. Raises
    ValueError, with file and line, for what is wrong and for all that it does not know, such as joints that are neither
    revolute, continuous, prismatic nor fixed, or that mimic others.
    """
    if geometry not in ("collision", "visual"):
        raise ValueError(f'geometry: expected "collision" or "visual", got {geometry!r}')
    robot = _File(file)
    around = None if segments is None else one_whole_number(segments, "segments", 3, 4096)
    shapes = _Shapes(robot, around, packages or {})
    links, variables = _tree(robot)
    of_links = {
        robot.attribute(link, "name"): [shapes.read(shape) for shape in link.findall(geometry)]
        for link in robot.root.findall("link")
    }
    if not any(of_links.values()):
        raise robot.wrong(robot.root, f"expected a link with a <{geometry}>, without which nothing touches anything")
    left_out = [*ignored, *(_disabled(_File(srdf), set(of_links)) if srdf is not None else ())]
    with scene._exclusive() as engine:
        ids = {key: engine.add_mesh(*mesh) for key, mesh in shapes.meshes.items()}
    solid = [
        dataclasses.replace(link, meshes=[(ids[key], pose) for key, pose in of_links[link.name]]) for link in links
    ]
    return Chain(scene, solid, ignored=left_out, variables=variables)


# -------------------------------------------------------------------------------------------------------------- files


class _Element(ElementTree.Element):
    line = 0


class _File:
    """An XML file of a robot, whose elements know their lines."""

    def __init__(self, file: Path) -> None:
        self.path = pathlib.Path(file)
        builder, parser = ElementTree.TreeBuilder(element_factory=_Element), expat.ParserCreate()

        def start(name: str, attributes: dict[str, str]) -> None:
            builder.start(name, attributes).line = parser.CurrentLineNumber  # type: ignore[attr-defined]

        parser.StartElementHandler, parser.EndElementHandler = start, builder.end
        try:
            parser.Parse(self.path.read_bytes(), True)
        except OSError as error:
            raise ValueError(f"{self.path}: cannot be read: {error.strerror}") from None
        except expat.ExpatError as error:
            raise ValueError(f"{self.path}:{error.lineno}: expected XML: {expat.ErrorString(error.code)}") from None
        self.root = builder.close()
        if self.root.tag != "robot":
            raise self.wrong(self.root, f"expected <robot>, got <{self.root.tag}>")

    def wrong(self, element: ElementTree.Element, text: str) -> ValueError:
        return ValueError(f"{self.path}:{getattr(element, 'line', 0)}: {_called(element)}: {text}")

    def require_known(self, element: ElementTree.Element, known: set[str]) -> None:
        for child in element:
            if child.tag not in known:
                raise self.wrong(child, f"expected in {_called(element)}: {', '.join(sorted(known))}")

    def attribute(self, element: ElementTree.Element, name: str) -> str:
        value = element.get(name)
        if not value:
            raise self.wrong(element, f"expected an attribute {name}")
        return value

    def child(self, element: ElementTree.Element, tag: str) -> ElementTree.Element | None:
        found = element.findall(tag)
        if len(found) > 1:
            raise self.wrong(element, f"expected one <{tag}>, got {len(found)}")
        return found[0] if found else None

    def attribute_of(self, element: ElementTree.Element, tag: str, name: str) -> str:
        found = self.child(element, tag)
        if found is None:
            raise self.wrong(element, f"expected a <{tag}>")
        return self.attribute(found, name)

    def numbers(
        self, element: ElementTree.Element | None, name: str, default: str, count: int = 3
    ) -> npt.NDArray[np.float64]:
        """Of an attribute. default: of an element without it, or of none; "": it must be there."""
        text = default if element is None else element.get(name, default)
        try:
            found = np.array(text.split(), float)
        except ValueError:
            found = np.empty(0)
        if element is not None and (found.shape != (count,) or not np.isfinite(found).all()):
            raise self.wrong(element, f"{name}: expected {count} finite number{'s' * (count > 1)}, got {text!r}")
        return found

    def pose(self, element: ElementTree.Element) -> npt.NDArray[np.float64]:
        """Of its origin."""
        origin, pose = self.child(element, "origin"), np.eye(4)
        pose[:3, 3] = self.numbers(origin, "xyz", "0 0 0")
        turns = self.numbers(origin, "rpy", "0 0 0")
        (sr, sp, sy), (cr, cp, cy) = np.sin(turns), np.cos(turns)
        pose[:3, :3] = [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
        return pose


def _called(element: ElementTree.Element) -> str:
    name = element.get("name")
    return f"<{element.tag}>" if name is None else f"{element.tag} {name!r}"


# -------------------------------------------------------------------------------------------------------------- joints


def _tree(robot: _File) -> tuple[list[Link], list[str]]:
    """Links behind their parents, without meshes, and the names of the joints that move, in the file's order."""
    robot.require_known(robot.root, _IN_ROBOT)
    for tag in ("link", "joint"):
        names = set()
        for element in robot.root.findall(tag):
            robot.require_known(element, _IN_LINK if tag == "link" else _IN_JOINT)
            if robot.attribute(element, "name") in names:
                raise robot.wrong(element, "expected another name than before")
            names.add(element.get("name"))
    children: dict[str | None, list[Link]] = {link.get("name"): [] for link in robot.root.findall("link")}
    carried: set[str] = set()
    variables = []
    for element in robot.root.findall("joint"):
        link = _link(robot, element)
        for end in (link.parent, link.name):
            if end not in children:
                raise robot.wrong(element, f"expected links of the file, got {end!r}")
        if link.name in carried:
            raise robot.wrong(element, f"expected one joint for each child, got another for {link.name!r}")
        carried.add(link.name)
        children[link.parent].append(link)
        if link.joint != "fixed":
            variables.append(str(link.variable))
    roots = [name for name in children if name not in carried]
    if len(roots) != 1:
        raise robot.wrong(robot.root, f"expected one link that is no joint's child, got {roots}")
    ordered = [Link(str(roots[0]))]
    for link in ordered:
        ordered += children[link.name]
    if len(ordered) < len(children):
        lost = sorted(carried - {link.name for link in ordered})
        raise robot.wrong(robot.root, f"expected joints that lead from {roots[0]!r} to all links, got none to {lost}")
    return ordered, variables


def _link(robot: _File, joint: ElementTree.Element) -> Link:
    """The link that a joint carries."""
    kind, limits = robot.attribute(joint, "type"), (-math.inf, math.inf)
    if kind not in _JOINTS:
        raise robot.wrong(joint, f"type: expected {', '.join(_JOINTS)}, got {kind!r}")
    axis = robot.numbers(robot.child(joint, "axis"), "xyz", "1 0 0")
    limit = robot.child(joint, "limit")
    if limit is not None and kind in ("revolute", "prismatic"):
        lower, upper = (robot.numbers(limit, name, "0", 1) for name in ("lower", "upper"))  # as the format has it
        limits = (float(lower[0]), float(upper[0]))
        if limits[0] > limits[1]:
            raise robot.wrong(joint, f"limit: expected lower up to upper, got {limits[0]} and {limits[1]}")
    if kind != "fixed" and not axis.any():
        raise robot.wrong(joint, "axis: expected a vector that is not zero")
    return Link(
        robot.attribute_of(joint, "child", "link"),
        robot.attribute_of(joint, "parent", "link"),
        _JOINTS[kind],
        robot.pose(joint),
        axis,
        variable=joint.get("name"),
        limits=limits,
    )


def _disabled(srdf: _File, links: set[str]) -> list[tuple[str, str]]:
    """Pairs of links."""
    srdf.require_known(srdf.root, _IN_SRDF)
    pairs = []
    for element in srdf.root.findall("disable_collisions"):
        first, second = (srdf.attribute(element, name) for name in ("link1", "link2"))
        if first == second or not {first, second} <= links:
            raise srdf.wrong(element, f"expected two links of the robot, got {first!r} and {second!r}")
        pairs.append((first, second))
    return pairs


# -------------------------------------------------------------------------------------------------------------- shapes


class _Shapes:
    """Shapes are poses, which also scale, of meshes: of those in files, or of unit ones."""

    def __init__(self, robot: _File, segments: int | None, packages: Folders) -> None:
        self.robot, self.segments, self.packages = robot, segments, packages
        self.meshes: dict[str, _Mesh] = {}

    def read(self, element: ElementTree.Element) -> tuple[str, npt.NDArray[np.float64]]:
        """The key of a mesh, and link from mesh."""
        robot = self.robot
        robot.require_known(element, _IN_SHAPE)
        geometry = robot.child(element, "geometry")
        if geometry is None or len(geometry) != 1:
            raise robot.wrong(element, "expected a <geometry> with one shape")
        shape = geometry[0]
        if shape.tag == "box":
            key, scale = "a box", robot.numbers(shape, "size", "")
        elif shape.tag == "cylinder":
            (radius,), (length,) = robot.numbers(shape, "radius", "", 1), robot.numbers(shape, "length", "", 1)
            key, scale = "a cylinder", np.array([radius, radius, length])
        elif shape.tag == "sphere":
            key, scale = "a sphere", robot.numbers(shape, "radius", "", 1).repeat(3)
        elif shape.tag == "mesh":
            key, scale = str(self._file(shape)), robot.numbers(shape, "scale", "1 1 1")
        else:
            raise robot.wrong(shape, "expected a box, cylinder, sphere or mesh")
        if not (scale.all() if shape.tag == "mesh" else (scale > 0).all()):
            raise robot.wrong(shape, f"expected sizes that are {'not 0' if shape.tag == 'mesh' else 'above 0'}")
        if key not in self.meshes:
            self.meshes[key] = self._mesh(shape, key)
        return key, robot.pose(element) @ np.diag([*scale, 1.0])

    def _file(self, shape: ElementTree.Element) -> pathlib.Path:
        name = self.robot.attribute(shape, "filename")
        scheme, separator, rest = name.partition("://")
        if not separator:
            return self.robot.path.parent / name
        if scheme == "file":
            return pathlib.Path(rest)
        package, _, path = rest.partition("/")
        if scheme != "package" or package not in self.packages:
            known = list(self.packages)
            raise self.robot.wrong(shape, f"filename: expected a file, or one in a package of {known}, got {name!r}")
        return pathlib.Path(self.packages[package]) / path

    def _mesh(self, shape: ElementTree.Element, key: str) -> _Mesh:
        if shape.tag == "mesh":
            try:
                return file_mesh(key, 1.0)
            except ValueError as error:
                raise self.robot.wrong(shape, str(error)) from None
        if shape.tag == "box":
            vertices, faces = _box()
        elif self.segments is None:
            raise self.robot.wrong(shape, "expected boxes and meshes, or segments=, of meshes that stand for it")
        elif shape.tag == "cylinder":
            vertices, faces = _turned(np.ones(2), np.array([-0.5, 0.5]), (-0.5, 0.5), self.segments)
        else:
            bands = max((self.segments + 1) // 2, 2)
            angles = (np.arange(1, bands) / bands - 0.5) * math.pi
            vertices, faces = _turned(np.cos(angles), np.sin(angles), (-1.0, 1.0), self.segments)
        floats, base = about_base(vertices, faces)
        return floats, faces, base


def _box() -> _Triangles:
    """Of side 1."""
    faces = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1)]
    faces += [(2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)]
    corners = np.stack(np.meshgrid(*[(-0.5, 0.5)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    return corners, np.array(faces, np.uint32)


def _turned(
    radii: npt.NDArray[np.float64], heights: npt.NDArray[np.float64], ends: tuple[float, float], segments: int
) -> _Triangles:
    """Rings about z, from the lowest up, closed towards points of the axis."""
    angles, i = 2 * math.pi / segments * np.arange(segments), np.arange(segments)
    ring = np.column_stack([np.cos(angles), np.sin(angles), np.ones(segments)])
    rings = [ring * (radius, radius, height) for radius, height in zip(radii, heights)]
    j, low, high = (i + 1) % segments, np.full(segments, len(rings) * segments), (len(rings) - 1) * segments
    faces = [(low, j, i), (high + i, high + j, low + 1)]
    for a in range(0, high, segments):
        faces += [(a + i, a + j, a + segments + j), (a + i, a + segments + j, a + segments + i)]
    vertices = np.concatenate([*rings, [(0.0, 0.0, end) for end in ends]])
    return vertices, np.concatenate([np.column_stack(corners) for corners in faces]).astype(np.uint32)
