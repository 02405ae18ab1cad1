#!/usr/bin/env python3
"""Takes an assembly apart: which parts block which, in what order they come out, and a film of it.

    PYTHONPATH=build/release/python python3 tools/examples/disassembly.py --out burr
    ... disassembly.py engine.glb --out engine --directions 26

Without a file, the assembly is a burr puzzle, whose pieces touch exactly. Writes graph.json, film.png, which a browser
plays, and its frames.

A part is blocked in a direction by the parts that its surface would run into, were it moved out straight: what it
leaves or slides along does not block. Parts whose surfaces cross at the start interpenetrate; what a motion does to
that cannot be told from surfaces, so they do not block each other and are listed.
"""

from __future__ import annotations

import argparse
import dataclasses
import itertools
import json
import pathlib
import sys

import numpy as np

import burr
import cyber_radar
import picture
import png


@dataclasses.dataclass
class Graph:
    """Who is in whose way."""

    directions: np.ndarray  #: (d, 3)
    blocked: np.ndarray  #: (d, parts, parts) whether the second part blocks the first
    free_for: np.ndarray  #: (d, parts) how far each part gets, inf: out
    interpenetrating: np.ndarray  #: (parts, parts), symmetric


@dataclasses.dataclass
class Step:
    """Parts that leave together."""

    parts: list[int]
    direction: int
    taken_from: list[int]  #: the parts that they leave


def all_directions(count: int) -> np.ndarray:
    """Along the axes (6), also their diagonals (26)."""
    ways = np.array([way for way in itertools.product((-1, 0, 1), repeat=3) if any(way)], float)
    ways = ways[np.argsort(np.abs(ways).sum(axis=1), kind="stable")][:count]
    return ways / np.linalg.norm(ways, axis=1, keepdims=True)


def blocking_graph(scene: cyber_radar.Scene, directions: np.ndarray, mode: str) -> Graph:
    """One cast for each part and direction, out of the assembly."""
    held = scene.objects()
    points = np.concatenate(corners(scene)).reshape(-1, 3)
    casts = scene.cast(
        held.meshes,
        held.transforms,
        directions[:, None],
        distances=np.linalg.norm(np.ptp(points, axis=0)),
        exclude_from_each=held.ids[:, None],
        ignore_leaving=True,
        skip_overlapping=True,
        hits="all",
        mode=mode,
    )
    count = len(held.ids)
    blocked = np.zeros((len(directions), count, count), bool)
    blocked.reshape(-1, count)[casts.hits.cast, casts.hits.object] = True
    crossing = np.zeros((len(directions) * count, count), bool)
    crossing[casts.overlapping.cast, casts.overlapping.object] = True
    crossing = crossing.reshape(blocked.shape).any(axis=0)
    return Graph(directions, blocked, casts.distance, crossing | crossing.T)


def removal_order(graph: Graph) -> tuple[list[Step], list[list[int]]]:
    """Peels parts off that nothing blocks; where every part is blocked, the smallest group that moves as one, which is
    then taken apart by itself. Returns the steps, and the groups that do not come apart in these directions."""
    steps, locked = [], []
    waiting = [list(range(graph.blocked.shape[1]))]
    while waiting:
        parts = waiting.pop()
        while len(parts) > 1:
            found = _smallest_free(graph, parts)
            if found is None:
                locked.append(parts)
                break
            group, direction = found
            steps.append(Step(group, direction, [part for part in parts if part not in group]))
            parts = steps[-1].taken_from
            if len(group) > 1:
                waiting.append(group)
    return steps, locked


def _smallest_free(graph: Graph, parts: list[int]) -> tuple[list[int], int] | None:
    """The fewest parts that nothing else blocks in some direction; of equals, those that cross the fewest others,
    then those that leave where most can."""
    best = None
    crowded = graph.blocked.sum(axis=(1, 2))
    for direction, blocked in enumerate(graph.blocked[:, parts][:, :, parts]):
        needed = blocked | np.eye(len(parts), dtype=bool)
        while ((more := needed @ needed) != needed).any():
            needed = more
        for row in needed:
            crossings = int(graph.interpenetrating[np.ix_(np.array(parts)[row], np.array(parts)[~row])].sum())
            rank = (int(row.sum()), crossings, int(crowded[direction]))
            if row.sum() < len(parts) and (best is None or rank < best[0]):
                best = rank, [part for part, inside in zip(parts, row) if inside], direction
    return None if best is None else best[1:]


def check(scene: cyber_radar.Scene, graph: Graph, steps: list[Step], mode: str) -> None:
    """Casts every step again, with what is left then, and nothing may be in the way."""
    held = scene.objects()
    for step in steps:
        alone = np.setdiff1d(held.ids, step.taken_from)
        casts = scene.cast(
            held.meshes[step.parts],
            held.transforms[step.parts],
            graph.directions[step.direction] * 1e3 * np.ptp(np.concatenate(corners(scene)).reshape(-1, 3)),
            exclude_from_all=alone,
            ignore_leaving=True,
            skip_overlapping=True,
            mode=mode,
        )
        if casts.touches.any():
            raise RuntimeError(f"parts {step.parts} are not free along {graph.directions[step.direction]}")


def corners(scene: cyber_radar.Scene) -> list[np.ndarray]:
    """The placed triangles of each object, (n, 3, 3)."""
    placed = []
    for mesh, transform in zip(scene.objects().meshes, scene.objects().transforms):
        vertices, faces = scene.mesh(int(mesh))
        placed.append((vertices @ transform[:3, :3].T + transform[:3, 3])[faces])
    return placed


def film(triangles: list[np.ndarray], graph: Graph, steps: list[Step], size: tuple[int, int], count: int):
    """The steps one after the other, in this many pictures."""
    side = np.ptp(np.concatenate(triangles).reshape(-1, 3), axis=0).max()
    ends = np.zeros((len(steps), len(triangles), 3))
    for number, step in enumerate(steps):
        # What leaves first goes farthest, so that parts that leave in one direction come to rest in a row.
        way = graph.directions[step.direction] * side * (0.4 + 0.6 * (1 - number / len(steps)))
        ends[number:, step.parts] += way
    colours = np.repeat(picture.colours_of(len(triangles)), [len(part) for part in triangles], axis=0)
    spread = [part + end for part, end in zip(triangles, ends[-1])] if len(steps) else []
    points = np.concatenate([*triangles, *spread]).reshape(-1, 3)
    camera = picture.Camera(picture.view_from((2.0, -3.0, 1.6)), points, size)
    for moment in np.linspace(0, len(steps), count):
        done = min(int(moment), len(steps) - 1)
        before = ends[done - 1] if done > 0 else np.zeros_like(ends[0])
        part_way = moment - done
        now = before + (ends[done] - before) * part_way**2 * (3 - 2 * part_way)
        yield picture.draw(camera, np.concatenate([part + at for part, at in zip(triangles, now)]), colours)


def described(scene: cyber_radar.Scene, graph: Graph, steps: list[Step], locked: list[list[int]]) -> dict:
    """What graph.json holds."""
    crossing = np.argwhere(np.triu(graph.interpenetrating))
    return {
        "parts": [scene.names.get(int(i), f"part {i}") for i in scene.objects().ids],
        "directions": graph.directions.tolist(),
        "blocked_by": [[np.flatnonzero(row).tolist() for row in blocked] for blocked in graph.blocked],
        "free_for": [[None if np.isinf(d) else d for d in row] for row in graph.free_for.tolist()],
        "interpenetrating": crossing.tolist(),
        "steps": [
            {
                "parts": step.parts,
                "direction": step.direction,
                "interpenetrates": sorted(
                    {int(k) for i in step.parts for k in np.flatnonzero(graph.interpenetrating[i])}
                    & set(step.taken_from)
                ),
            }
            for step in steps
        ],
        "locked": locked,
    }


def load(file: str | None) -> cyber_radar.Scene:
    scene = cyber_radar.Scene()
    if file is not None:
        scene.load_assembly(file)
    else:
        for piece in burr.pieces():
            scene.add(scene.add_mesh(*burr.surface(piece)))
    return scene


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", nargs="?", help="any file assimp reads; each node with triangles is a part")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder to write to")
    parser.add_argument("--directions", type=int, choices=(6, 26), default=6, help="along the axes, or diagonals, too")
    parser.add_argument("--mode", choices=("contact", "reference"), default="contact")
    parser.add_argument("--frames", type=int, default=60, help="pictures of the film")
    parser.add_argument("--size", type=int, nargs=2, default=(480, 400), metavar=("WIDTH", "HEIGHT"))
    options = parser.parse_args()
    scene = load(options.file)
    graph = blocking_graph(scene, all_directions(options.directions), options.mode)
    steps, locked = removal_order(graph)
    check(scene, graph, steps, options.mode)

    (options.out / "frames").mkdir(parents=True, exist_ok=True)
    told = described(scene, graph, steps, locked)
    (options.out / "graph.json").write_text(json.dumps(told, indent=1) + "\n")
    pictures = []
    for frame in film(corners(scene), graph, steps, tuple(options.size), options.frames):
        png.write(options.out / "frames" / f"{len(pictures):03}.png", frame)
        pictures.append(frame)
    png.write_animation(options.out / "film.png", pictures, 70, 2000)
    print(f"{len(told['parts'])} parts, {len(told['interpenetrating'])} pairs interpenetrate, {len(steps)} steps")
    for step in told["steps"]:
        names = ", ".join(told["parts"][part] for part in step["parts"])
        way = " ".join(f"{x:+.2f}" for x in told["directions"][step["direction"]])
        crossing = f"; interpenetrates {len(step['interpenetrates'])} of the rest" if step["interpenetrates"] else ""
        print(f"  {names}: along {way}{crossing}")
    for group in locked:
        print(f"  locked in these directions: {', '.join(told['parts'][part] for part in group)}")
    print(f"written: {options.out}/graph.json, film.png, frames/")


if __name__ == "__main__":
    sys.exit(main())
