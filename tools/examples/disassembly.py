#!/usr/bin/env python3
"""Takes an assembly apart: which parts block which, in what order they come out, and a page that plays it.

    PYTHONPATH=build/release/python python3 tools/examples/disassembly.py --out burr
    ... disassembly.py engine.glb --out engine --directions 26

Without a file, the assembly is a burr puzzle, whose pieces touch exactly. Writes graph.json, and steps.html, a page for any
browser.

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
    points = corners(scene)
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
    return Graph(directions, blocked, casts.t, crossing | crossing.T)


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


def check(scene: cyber_radar.Scene, graph: Graph, steps: list[Step], mode: str) -> cyber_radar.Casts:
    """Casts every step again, with what is left then: nothing may be in the way. What leaves first goes farthest."""
    held = scene.objects()
    parts = np.array([part for step in steps for part in step.parts], int)
    of_step = np.repeat(np.arange(len(steps)), [len(step.parts) for step in steps])
    left = np.array([np.isin(held.ids, step.taken_from) for step in steps]).reshape(len(steps), len(held.ids))
    ways = graph.directions[[step.direction for step in steps]].reshape(-1, 3)
    far = np.ptp(corners(scene), axis=0).max() * (2 - np.arange(len(steps)) / max(len(steps), 1))
    casts = scene.cast(
        held.meshes[parts],
        held.transforms[parts],
        (ways * far[:, None])[of_step],
        exclude_from_each=np.where(left, -1, held.ids)[of_step],
        ignore_leaving=True,
        skip_overlapping=True,
        mode=mode,
    )
    if casts.touches.any():
        part = int(parts[casts.touches][0])
        raise RuntimeError(f"part {part} is not free when its turn comes")
    return casts


def corners(scene: cyber_radar.Scene) -> np.ndarray:
    """The vertices of all objects in the world, (n, 3)."""
    held = scene.objects()
    placed = [scene.mesh(int(mesh))[0] @ t[:3, :3].T + t[:3, 3] for mesh, t in zip(held.meshes, held.transforms)]
    return np.concatenate(placed)


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
    parser.add_argument("file", nargs="?", help="a mesh file, such as glTF; each node with triangles is a part")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder to write to")
    parser.add_argument("--directions", type=int, choices=(6, 26), default=6, help="along the axes, or diagonals, too")
    parser.add_argument("--mode", choices=("contact", "reference"), default="contact")
    options = parser.parse_args()
    scene = load(options.file)
    graph = blocking_graph(scene, all_directions(options.directions), options.mode)
    steps, locked = removal_order(graph)
    casts = check(scene, graph, steps, options.mode)

    options.out.mkdir(parents=True, exist_ok=True)
    told = described(scene, graph, steps, locked)
    (options.out / "graph.json").write_text(json.dumps(told, indent=1) + "\n")
    casts.show(options.out / "steps.html", title=f"{len(steps)} steps")
    print(f"{len(told['parts'])} parts, {len(told['interpenetrating'])} pairs interpenetrate, {len(steps)} steps")
    for step in told["steps"]:
        names = ", ".join(told["parts"][part] for part in step["parts"])
        way = " ".join(f"{x:+.2f}" for x in told["directions"][step["direction"]])
        crossing = f"; interpenetrates {len(step['interpenetrates'])} of the rest" if step["interpenetrates"] else ""
        print(f"  {names}: along {way}{crossing}")
    for group in locked:
        print(f"  locked in these directions: {', '.join(told['parts'][part] for part in group)}")
    print(f"written: {options.out}/graph.json, steps.html")


if __name__ == "__main__":
    sys.exit(main())
