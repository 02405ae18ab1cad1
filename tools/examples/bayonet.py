#!/usr/bin/env python3
"""Unlocks a bayonet: a plug whose lugs sit under a socket's rim is turned back until they stand in its slots, and pulled.

    PYTHONPATH=build/release/python python3 tools/examples/bayonet.py --out bayonet

Tells how far the plug can be pulled, how far it turns, and at which angles it comes out. Writes bayonet.html, a page for
any browser: the pull that fails, the turn, and the pull after it.
"""

from __future__ import annotations

import argparse
import pathlib
import sys

import numpy as np

import cyber_radar
from cyber_radar import Status

SECTORS = 72  # of 5 degrees, in which cells are counted around the axis
LUGS = 3
LOCKED = 45  # degrees from where the lugs stand in the slots
REACH = 90  # as far as it is asked to turn
PULL = 24.0  # mm; out of the socket


def around(first: int, last: int) -> list[int]:
    """The sectors from an angle to another, degrees, at each lug."""
    step = 360 // SECTORS
    return [(k * SECTORS // LUGS + i) % SECTORS for k in range(LUGS) for i in range(first // step, last // step)]


def plug() -> tuple[np.ndarray, np.ndarray]:
    """A tube with lugs at its lower end, and a grip at its upper one. Millimetres."""
    cells = np.zeros((3, SECTORS, 3), bool)
    cells[0] = cells[:, :, 2] = True
    cells[1, around(-10, 10), 0] = True
    return surface(cells, [5, 8, 10, 13], [0, 2, 11, 14])


def socket() -> tuple[np.ndarray, np.ndarray]:
    """A ring around it, whose slots go down from the rim and then to the side."""
    cells = np.ones((2, SECTORS, 3), bool)
    cells[0, around(-15, 15), 1:] = False
    cells[0, around(-15, 60), 1] = False
    return surface(cells, [8.4, 10.4, 13], [-3, -0.4, 2.4, 10])


def surface(cells: np.ndarray, radii: list[float], heights: list[float]) -> tuple[np.ndarray, np.ndarray]:
    """The mesh of cells between cylinders, planes through the axis and planes across it: vertices and faces, closed and
    wound outwards."""
    solid = np.pad(cells, [(1, 1), (0, 0), (1, 1)])
    squares = []
    for cell in np.argwhere(solid):
        for axis in range(3):
            for side in (0, 1):
                beside = cell + (2 * side - 1) * np.eye(3, dtype=int)[axis]
                if solid[tuple(beside % solid.shape)]:
                    continue
                corners = np.repeat(cell[None], 4, axis=0)
                corners[:, axis] += side
                u, v = (axis + 1) % 3, (axis + 2) % 3
                corners[[1, 2], u] += 1
                corners[[2, 3], v] += 1
                squares.append(corners if side else corners[::-1])
    places = np.concatenate(squares) - [1, 0, 1]
    radius, angle = np.array(radii)[places[:, 0]], 2 * np.pi * (places[:, 1] % SECTORS) / SECTORS
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.array(heights)[places[:, 2]]], axis=1)
    vertices, index = np.unique(points.astype(np.float32), axis=0, return_inverse=True)
    first, second, third, fourth = index.reshape(-1, 4).T
    return vertices, np.concatenate([np.stack([first, second, third], 1), np.stack([first, third, fourth], 1)])


def turned(degrees: float) -> np.ndarray:
    c, s = np.cos(np.deg2rad(degrees)), np.sin(np.deg2rad(degrees))
    return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder to write to")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    scene = cyber_radar.Scene()
    scene.add(scene.add_mesh(*socket()), np.eye(4))
    mesh = scene.add_mesh(*plug())

    up, about = [0, 0, PULL], ([0, 0, 1], -np.deg2rad(REACH), [0, 0, 0])
    pulled = scene.cast(mesh, turned(LOCKED), up, mode="reference")
    turn = scene.cast(mesh, turned(LOCKED), turns=about, mode="reference")
    free = REACH * float(turn.fraction)
    print(f"locked: pulled, it is free for {float(pulled.t):.4g} mm; turned back, for {free:.6g} degrees")
    # At every half degree on the way; where it just touches, it would not come out.
    angles = np.arange(0, free, 0.5)
    out = scene.cast(mesh, np.stack([turned(LOCKED - angle) for angle in angles]), up, mode="reference")
    loose = angles[out.status == Status.CLEAR]
    if len(loose) == 0:
        raise SystemExit("bayonet.py: the plug comes out at no angle")
    print(f"turned back by {loose.min():g} to {loose.max():g} degrees, it comes out")

    best = float(np.median(loose))
    poses = np.stack([turned(LOCKED), turned(LOCKED), turned(LOCKED - best)])
    steps = scene.cast(
        mesh, poses, [up, [0, 0, 0], up], turns=([0, 0, 1], -np.deg2rad([0, best, 0]), [0, 0, 0]), mode="reference"
    )
    steps.show(options.out / "bayonet.html", title="A bayonet: pulled, turned back, and pulled")


if __name__ == "__main__":
    sys.exit(main())
