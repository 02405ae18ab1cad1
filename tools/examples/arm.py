#!/usr/bin/env python3
"""Moves a robot's arm among shelves, between random configurations in which it touches nothing: which motions are free?

    PYTHONPATH=build/release/python python3 tools/examples/arm.py --out arm
    ... arm.py robot.urdf --segments 32 --motions 1000 --out robot

The arm has six axes and is made of boxes, unless a URDF file is given. Writes arm.urdf, and contact.html, a page for
any browser: the motion that gets farthest before it touches a shelf, played up to then.
"""

from __future__ import annotations

import argparse
import pathlib
import sys
import time

import numpy as np

import cyber_radar
from boxes import add_boxes
from cyber_radar import Status

# Links from the base up: name, the box's sides, and of the joint to the next one the axis and greatest angle. Each box
# stands on its joint.
_LINKS = [
    ("base", (0.3, 0.3, 0.2), "0 0 1", 3.0),
    ("shoulder", (0.2, 0.2, 0.2), "0 1 0", 1.9),
    ("upper arm", (0.12, 0.12, 0.6), "0 1 0", 2.6),
    ("forearm", (0.1, 0.1, 0.5), "0 0 1", 3.0),
    ("wrist", (0.08, 0.08, 0.1), "0 1 0", 2.1),
    ("flange", (0.08, 0.1, 0.1), "0 0 1", 3.1),
    ("hand", (0.06, 0.2, 0.12), "", 0),
]


def urdf() -> str:
    lines = ['<robot name="arm">']
    for (name, (x, y, z), axis, most), (child, *_) in zip(_LINKS, [*_LINKS[1:], ("",)]):
        lines.append(f'  <link name="{name}"><collision><origin xyz="0 0 {z / 2}"/>')
        lines.append(f'    <geometry><box size="{x} {y} {z}"/></geometry></collision></link>')
        if child:
            lines.append(f'  <joint name="{child}" type="revolute"><parent link="{name}"/><child link="{child}"/>')
            lines.append(f'    <origin xyz="0 0 {z}"/><axis xyz="{axis}"/>')
            lines.append(f'    <limit lower="{-most}" upper="{most}"/></joint>')
    return "\n".join([*lines, "</robot>\n"])


def add_shelves(scene: cyber_radar.Scene, rng: np.random.Generator) -> None:
    """A floor, and shelves with goods on both sides of the arm."""
    boxes = [((0, 0, -0.1), (2.4, 2.4, 0.1))]  # middles and sides
    for side in (-0.8, 0.8):
        boxes += [((x, side, 0.7), (0.02, 0.4, 1.5)) for x in (-0.8, 0, 0.8)]
        for height in (0.2, 0.6, 1.0, 1.4):
            boxes.append(((0, side, height), (1.6, 0.4, 0.02)))
            for x in np.arange(-0.7, 0.71, 0.2):
                sides = rng.uniform(0.06, 0.17, 3)
                boxes.append(((x, side + rng.uniform(-0.1, 0.1), height + 0.01 + sides[2] / 2), sides))
    add_boxes(scene, boxes)


def free_configurations(arm: cyber_radar.Chain, count: int, rng: np.random.Generator) -> np.ndarray:
    """Random ones within the limits, or a turn, in which the arm touches nothing: (count, variables)."""
    lower, upper = (np.clip(limits, -np.pi, np.pi) for limits in (arm.lower, arm.upper))
    found = np.empty((0, len(arm.variables)))
    while len(found) < count:
        drawn = rng.uniform(lower, upper, (count, len(lower)))
        found = np.concatenate([found, drawn[arm.move(drawn, drawn).status == Status.CLEAR]])
        if len(found) == 0:
            raise SystemExit(f"arm.py: the arm touches something in all of {count} configurations")
    return found[:count]


def described(moves: cyber_radar.Moves) -> str:
    """How the motions end, and which link stops most of them."""
    free, stopped = (moves.status == Status.CLEAR).sum(), moves[moves.touches]
    text = f"{len(moves)} motions: {free} are free, {len(stopped)} are not, "
    text += f"{len(moves) - free - len(stopped)} undecided"
    if len(stopped):
        names, counts = np.unique(stopped.link_names, return_counts=True)
        text += f"\nhit most: the {names[counts.argmax()]}, in {counts.max()}"
        text += f"; the arm hits itself in {(stopped.other_link >= 0).sum()}"
    return text


def farthest(moves: cyber_radar.Moves) -> cyber_radar.Moves:
    """The motion that gets farthest before it touches a shelf."""
    candidates = np.where(moves.touches & (moves.object >= 0), moves.fraction_lo, -1)
    if candidates.max() < 0:
        raise SystemExit("arm.py: no motion touches a shelf: try more --motions")
    return moves[candidates.argmax()]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", nargs="?", help="a URDF file")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder to write to")
    parser.add_argument("--motions", type=int, default=10_000)
    parser.add_argument("--segments", type=int, help="of meshes for cylinders and spheres")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    if options.file is None:
        (options.out / "arm.urdf").write_text(urdf())

    scene, rng = cyber_radar.Scene(), np.random.default_rng(options.seed)
    add_shelves(scene, rng)
    arm = cyber_radar.load_urdf(scene, options.file or options.out / "arm.urdf", segments=options.segments)
    through = free_configurations(arm, options.motions + 1, rng)
    begin = time.perf_counter()
    moves = arm.move(through[:-1], through[1:])
    seconds = time.perf_counter() - begin
    print(described(moves))
    print(f"{seconds:.2f} s, {1e6 * seconds / len(moves):.0f} us a motion")
    best = farthest(moves)
    best.show(options.out / "contact.html", title=f"The {best.link_names} touches object {best.object}")


if __name__ == "__main__":
    sys.exit(main())
