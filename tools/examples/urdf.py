#!/usr/bin/env python3
"""Puts a robot into a scene: the collision meshes of a URDF file, one object each, where its joints' angles place them.

    PYTHONPATH=build/release/python python3 tools/examples/urdf.py robot.urdf elbow=0.5

Other geometry than meshes is refused; paths of meshes are relative to the file, without "package://".
"""

from __future__ import annotations

import pathlib
import sys
import xml.etree.ElementTree as ElementTree

import numpy as np

import cyber_radar


def _numbers(element: ElementTree.Element | None, name: str, default: str) -> np.ndarray:
    return np.array((default if element is None else element.get(name, default)).split(), float)


def _turn(axis: np.ndarray, angle: float) -> np.ndarray:
    k = np.cross(np.eye(3), axis / np.linalg.norm(axis))
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def _pose(origin: ElementTree.Element | None) -> np.ndarray:
    roll, pitch, yaw = _numbers(origin, "rpy", "0 0 0")
    x, y, z = np.eye(3)
    pose = np.eye(4)
    pose[:3, :3] = _turn(z, yaw) @ _turn(y, pitch) @ _turn(x, roll)
    pose[:3, 3] = _numbers(origin, "xyz", "0 0 0")
    return pose


def place(robot: ElementTree.Element, link: str, values: dict[str, float]) -> np.ndarray:
    """The frame (4, 4) of a link in the robot's. values: of joints, angles or lengths; 0 of the others."""
    for joint in robot.findall("joint"):
        if joint.find("child").get("link") == link:
            axis, value = _numbers(joint.find("axis"), "xyz", "1 0 0"), values.get(joint.get("name"), 0.0)
            moved = np.eye(4)
            if joint.get("type") == "prismatic":
                moved[:3, 3] = value * axis
            else:
                moved[:3, :3] = _turn(axis, value)
            return place(robot, joint.find("parent").get("link"), values) @ _pose(joint.find("origin")) @ moved
    return np.eye(4)


def add_robot(scene: cyber_radar.Scene, file: pathlib.Path, values: dict[str, float]) -> dict[str, list[int]]:
    """The objects of each link."""
    robot, objects = ElementTree.parse(file).getroot(), {}
    for link in robot.findall("link"):
        for collision in link.findall("collision"):
            mesh = collision.find("geometry/mesh")
            if mesh is None:
                raise ValueError(f"{file}: link {link.get('name')}: expected a mesh, got another geometry")
            vertices, faces = cyber_radar.read_mesh(file.parent / mesh.get("filename").removeprefix("package://"))
            added = scene.add_mesh(vertices * _numbers(mesh, "scale", "1 1 1"), faces)
            pose = place(robot, link.get("name"), values) @ _pose(collision.find("origin"))
            objects.setdefault(link.get("name"), []).append(int(scene.add(added, pose)))
    return objects


def main() -> None:
    scene = cyber_radar.Scene()
    values = {name: float(value) for name, value in (word.split("=") for word in sys.argv[2:])}
    for link, objects in add_robot(scene, pathlib.Path(sys.argv[1]), values).items():
        print(link, *objects)


if __name__ == "__main__":
    sys.exit(main())
