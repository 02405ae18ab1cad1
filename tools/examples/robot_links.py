#!/usr/bin/env python3
"""A robot's arm of six capsules among shelves: which turns of one joint are free, and what do the others touch first?

    PYTHONPATH=build/release/python python3 tools/examples/robot_links.py --out links

From random configurations in which the arm touches nothing, each motion turns one joint: the links that it carries turn
about its axis, and the others rest. All links of all motions are cast in one call, once to ask whether, once to ask when
and where. Writes contacts.html, a page for any browser: some of the motions up to their first contacts.
"""

from __future__ import annotations

import argparse
import pathlib
import sys
import time
from typing import Any

import numpy as np

import cyber_radar
from arm import add_shelves
from cyber_radar import Status

# From the base up: name, length and radius of the capsule, which stands on its joint, and the joint's axis.
_LINKS = [
    ("turntable", 0.40, 0.12, (0, 0, 1)),
    ("upper arm", 0.60, 0.08, (0, 1, 0)),
    ("forearm", 0.50, 0.06, (0, 1, 0)),
    ("wrist", 0.12, 0.05, (0, 0, 1)),
    ("flange", 0.10, 0.05, (0, 1, 0)),
    ("hand", 0.18, 0.04, (0, 0, 1)),
]
_AXES = np.array([axis for *_, axis in _LINKS], float)
_SHOWN = 40  # motions of a page


class Arm:
    """Capsules in a scene, and where they are in configurations (..., 6): angles."""

    def __init__(self, scene: cyber_radar.Scene) -> None:
        self.scene = scene
        links, height = [], 0.1
        for (name, length, _, axis), parent in zip(_LINKS, [None, *(name for name, *_ in _LINKS)]):
            origin = np.eye(4)
            origin[2, 3] = height
            links.append(cyber_radar.Link(name, parent, "revolute", origin, axis))
            height = length
        self.chain = cyber_radar.Chain(scene, links)
        rods = [cyber_radar.capsule([0, 0, 0], [0, 0, length], radius) for _, length, radius, _ in _LINKS]
        self.meshes = np.array([scene.add_mesh(rod) for rod in rods])

    def cast(self, starts: np.ndarray, joints: np.ndarray, angles: np.ndarray, **options: Any) -> cyber_radar.Casts:
        """Of motions (n,) that turn a joint by an angle: casts (n, 6) of the links."""
        poses = self.chain.poses(starts)
        carrying = poses[np.arange(len(starts)), joints]
        axes = np.einsum("nij,nj->ni", carrying[:, :3, :3], _AXES[joints])
        of_links = np.where(np.arange(len(_LINKS)) >= joints[:, None], angles[:, None], 0)
        turns = axes[:, None], of_links, carrying[:, None, :3, 3]
        return self.scene.cast(self.meshes, poses, None, turns=turns, mode="reference", **options)

    def free_configurations(self, count: int, rng: np.random.Generator) -> np.ndarray:
        """Random ones in which the arm touches nothing: (count, 6)."""
        found = np.empty((0, len(_LINKS)))
        while len(found) < count:
            drawn = rng.uniform(-2.5, 2.5, (count, len(_LINKS)))
            at_rest = self.scene.cast(self.meshes, self.chain.poses(drawn), [0, 0, 0], any_hit=True, mode="reference")
            found = np.concatenate([found, drawn[(at_rest.status == Status.CLEAR).all(axis=1)]])
        return found[:count]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder to write to")
    parser.add_argument("--motions", type=int, default=100_000)
    parser.add_argument("--most", type=float, default=0.5, help="the greatest angle, radians")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)

    scene, rng, count = cyber_radar.Scene(), np.random.default_rng(options.seed), options.motions
    add_shelves(scene, rng)
    arm = Arm(scene)
    starts = arm.free_configurations(count, rng)
    joints, angles = rng.integers(0, len(_LINKS), count), rng.uniform(-options.most, options.most, count)

    begin = time.perf_counter()
    whether = arm.cast(starts, joints, angles, any_hit=True)
    between = time.perf_counter()
    casts = arm.cast(starts, joints, angles)
    end = time.perf_counter()

    is_free = (whether.status == Status.CLEAR).all(axis=1)
    first = np.where(casts.touches, casts.t, np.inf).argmin(axis=1)  # the link that touches something first
    hits = np.flatnonzero(casts.touches.any(axis=1))
    undecided = count - is_free.sum() - len(hits)
    print(f"{count} motions: {is_free.sum()} are free, {len(hits)} are not, {undecided} undecided")
    names, counts = np.unique([_LINKS[link][0] for link in first[hits]], return_counts=True)
    print("first to touch: " + ", ".join(f"the {name}, in {n}" for name, n in zip(names, counts)))
    for question, seconds in (("any hit", between - begin), ("first hit", end - between)):
        print(f"{question}: {seconds:.2f} s, {1e6 * seconds / count:.0f} us a motion of {len(_LINKS)} links")
    if len(hits) == 0:
        raise SystemExit("robot_links.py: no motion touches a shelf: try more --motions")
    chosen = hits[:_SHOWN]
    shown = arm.cast(starts[chosen], joints[chosen], angles[chosen])
    shown[np.arange(len(chosen)), first[chosen]].show(options.out / "contacts.html", title="First contacts of an arm")


if __name__ == "__main__":
    sys.exit(main())
