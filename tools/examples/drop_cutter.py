#!/usr/bin/env python3
"""Machines a surface: a cutter falls along -z at every point of a raster until it touches the part, and moves from point
to point without cutting too deep.

    PYTHONPATH=build/release/python python3 tools/examples/drop_cutter.py part.stl --cutter ball --diameter 6 --out part
    ... drop_cutter.py relief --cutter flat --holder 20 30 --step 0.5 --out relief
    ... drop_cutter.py cube --cutter mill.stl --out cube

The part is a mesh file, or "relief" or "cube", which are made here. The cutter is one of the exact ones, or any mesh file
with its tip at the origin. It is driven --tolerance above the heights, and cast along every straight move, too: where it
would touch the part, points are inserted. So it cuts too deep nowhere.

Writes heights.npy (the tip's height at each point of the raster, row by row), touched.npy (what it touches there: a point,
and 1 for a vertex, 2 for an edge, 3 for a facet), path.ngc (G-code, millimetres), report.json, drops.html (a page of some
of the casts), of an exact cutter also surface.html (what is left of the stock, and the cutter on it), with a holder
holder.csv (where it would touch first; the report says how much longer the tool must be), and with --waterline
waterline.csv (where the cutter stops, pushed from the sides at that height, and what it touches).
"""

from __future__ import annotations

import argparse
import dataclasses
import json
import pathlib
import sys
import time
from collections.abc import Callable
from typing import Union

import numpy as np

import boxes
import cyber_radar
import tool_path
from closed_forms import Profile, exact_heights
from cyber_radar import Cutter, Status

Mesh = tuple[np.ndarray, np.ndarray]  # vertices (n, 3) float32, faces (m, 3)
Tool = Union[Cutter, cyber_radar.Shape]


@dataclasses.dataclass
class Raster:
    """Points at the distance `step` that cover a box."""

    x: np.ndarray  #: (nx,)
    y: np.ndarray  #: (ny,)
    top: float  #: where the tip starts, above the part
    floor: float  #: where it ends, below the part, since contact at the very end may be undecided

    def points(self) -> np.ndarray:
        """(ny, nx, 2)."""
        return np.stack(np.meshgrid(self.x, self.y), axis=-1)


class Machine:
    """A part, and what falls onto it."""

    def __init__(self, part: Mesh, step: float) -> None:
        self.scene, self.step = cyber_radar.Scene(), step
        self.scene.add(self.scene.add_mesh(*part))
        self.low, self.high = part[0].min(axis=0).astype(float), part[0].max(axis=0).astype(float)
        ticks = [tool_path.written(np.arange(self.low[k], self.high[k] + 0.5 * step, step)) for k in range(2)]
        self.raster = Raster(*ticks, top=self.high[2] + 1.0, floor=self.low[2] - 1.0)

    def falls(self, tool: Tool, points: np.ndarray) -> tuple[cyber_radar.Casts, np.ndarray]:
        """Casts from the top at these points (..., 2), and the heights of the tip, (...): of an undecided fall,
        to where the way certainly is free."""
        starts = np.concatenate([points, np.full_like(points[..., :1], self.raster.top)], axis=-1)
        casts = self.scene.cast(tool, tool_path.poses_at(starts), [0, 0, self.raster.floor - self.raster.top])
        return casts, np.where(casts.status == Status.CLEAR, self.raster.floor, self.raster.top - casts.lo)

    def drop(self, tool: Tool) -> tuple[cyber_radar.Casts, np.ndarray, float]:
        """falls() at the points of the raster, (ny, nx), and the seconds that took."""
        self.falls(tool, self.raster.points()[:1, :1])  # builds the part's tree
        start = time.perf_counter()
        casts, heights = self.falls(tool, self.raster.points())
        return casts, heights, time.perf_counter() - start

    def touches(self, tool: Tool, starts: np.ndarray, ends: np.ndarray) -> np.ndarray:
        """Whether a tool meets the part anywhere on the straight ways of its tip from (n, 3) to (n, 3). What is undecided
        grazes it: the tool gets no deeper than rounding."""
        status = self.scene.cast(tool, tool_path.poses_at(starts), ends - starts, any_hit=True).status
        return (status == Status.HIT) | (status == Status.OVERLAP)

    def push(self, tool: Tool, height: float, degrees: float) -> np.ndarray:
        """Where a tool stops, its tip at this height, that is pushed in a horizontal direction along lines that are `step`
        apart: (n, 7), its tip, the point touched, and its kind: 1 a vertex, 2 an edge, 3 a facet."""
        along = np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees)), 0.0])
        across = np.array([-along[1], along[0], 0.0])
        reach = 0.5 * np.linalg.norm((self.high - self.low)[:2]) + _width(tool)
        middle = np.array([*0.5 * (self.low + self.high)[:2], height])
        starts = middle - reach * along + np.arange(-reach, reach, self.step)[:, None] * across
        casts = self.scene.cast(tool, tool_path.poses_at(starts), 2 * reach * along)
        stops = casts.status == Status.HIT
        tips = starts[stops] + casts.lo[stops, None] * along
        return np.column_stack([tips, casts.point[stops], casts.feature_b[stops]])

    def path(self, tool: Tool, heights: np.ndarray, above: float) -> tuple[np.ndarray, dict]:
        """Rows to and fro over the raster, `above` these heights, with the points that it takes for no move to touch the
        part: (n, 3). And what that took."""
        up = tool_path.written_up(heights + above)
        rows = np.concatenate([self.raster.points(), up[..., None]], axis=-1)
        rows[1::2] = rows[1::2, ::-1].copy()
        straight = rows.reshape(-1, 3)
        points, gouged = tool_path.free_path(
            straight,
            lambda places: tool_path.written_up(self.falls(tool, places)[1] + above),
            lambda starts, ends: self.touches(tool, starts, ends),
            above,
        )
        longer = 100 * (tool_path.length(points) / tool_path.length(straight) - 1)
        return points, {
            "moves": len(gouged),
            "moves_too_deep": int(gouged.sum()),
            "points_inserted": len(points) - len(straight),
            "path_longer_percent": longer,
        }

    def hold(
        self, held_at: Callable[[float], Cutter], path: np.ndarray, step: float
    ) -> tuple[np.ndarray, np.ndarray, float]:
        """At which points of a path the holder touches before the tip is there, (n,) bool, the heights of the tip at which
        something touches, (n,), and how much longer the tool must be. held_at: the tool, that much longer."""
        casts, heights = self.falls(held_at(0.0), path[:, :2])
        first = (casts.tri_a == 1) & (heights > path[:, 2])
        longer = float(tool_path.written_up((heights - path[:, 2])[first].max(initial=0.0)))
        while self.touches(held_at(longer), path[:-1], path[1:]).any():
            longer = float(tool_path.written_up(np.array(longer + step)))
            step *= 2
        return first, heights, longer


def _width(tool: Tool) -> float:
    """No point of a tool is farther from its axis."""
    if isinstance(tool, Cutter):
        return max(radius + corner for part in tool.parts for _, radius, corner in part)
    return float(np.linalg.norm(tool.vertices[:, :2], axis=1).max())


def surface_left(heights: np.ndarray, step: float, cutter: Profile, top: float) -> np.ndarray:
    """The finished surface at the points of the raster: under every place of the cutter nothing is left."""
    reach = int(cutter.radius / step)
    left = np.full_like(heights, top)
    rows, columns = heights.shape
    for dy in range(-reach, reach + 1):
        for dx in range(-reach, reach + 1):
            above = float(cutter.height(np.array(step * np.hypot(dx, dy))))
            if np.isinf(above):
                continue
            to = left[max(0, dy) : rows + min(0, dy), max(0, dx) : columns + min(0, dx)]
            by = heights[max(0, -dy) : rows + min(0, -dy), max(0, -dx) : columns + min(0, -dx)]
            np.minimum(to, by + above, out=to)
    return left


def show_surface(file: pathlib.Path, raster: Raster, left: np.ndarray, tool: Tool) -> None:
    """A page of the finished surface, with the cutter where it is lowest."""
    points = np.concatenate([raster.points(), left[..., None]], axis=-1).reshape(-1, 3)
    machine = Machine((points.astype(np.float32), _grid_faces(*left.shape)), 1.0)
    casts, _ = machine.falls(tool, points[left.argmin(), :2])
    casts.show(file, title="The finished surface")


def relief(cells: int = 88, side: float = 100.0) -> Mesh:
    """Hills on a square, 2 * cells^2 triangles."""
    u = np.linspace(0, 1, cells + 1)
    x, y = np.meshgrid(u, u)
    z = 8 * np.sin(7 * x) * np.cos(9 * y) + 3 * np.sin(23 * x + 5 * y) + 6 * (np.hypot(x - 0.5, y - 0.5) < 0.2)
    return np.stack([side * x, side * y, z], axis=-1).reshape(-1, 3).astype(np.float32), _grid_faces(
        cells + 1, cells + 1
    )


def cube(side: float = 200.0, degrees: float = 10.0) -> Mesh:
    """Turned about the y axis."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    turned = side * boxes.CORNERS @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]).T
    return turned.astype(np.float32), boxes.FACES


def _grid_faces(rows: int, columns: int) -> np.ndarray:
    number = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]
    return np.concatenate([np.stack([a, b, c], -1), np.stack([a, c, d], -1)]).reshape(-1, 3)


def write_path(file: pathlib.Path, top: float, points: np.ndarray) -> None:
    top = max(top, points[:, 2].max())
    lines = ["G21 G90", f"G0 Z{top:.4f}", "G0 X{:.4f} Y{:.4f}".format(*points[0, :2])]
    lines += ["G1 X{:.4f} Y{:.4f} Z{:.4f} F1000".format(*point) for point in points]
    file.write_text("\n".join([*lines, f"G0 Z{top:.4f}", "M2", ""]))


def table(machine: Machine, part: Mesh, options: argparse.Namespace) -> list[str]:
    """CPU time of all cutters over the raster, the least of three runs, and the greatest differences from closed forms at
    some of its places."""
    corners, places = part[0].astype(float)[part[1]], machine.raster.points().reshape(-1, 2)
    chosen = np.random.default_rng(1).choice(len(places), min(300, len(places)), replace=False)
    rows = [f"| cutter, radius {options.diameter / 2:g} | CPU us a place | greatest difference, 1e-12 mm |", "|---|---|---|"]
    for name in CUTTERS:
        cutter, profile = cutter_of(name, options)
        seconds = []
        for _ in range(3):
            begin = time.process_time()
            _, heights, _ = machine.drop(cutter)
            seconds.append(time.process_time() - begin)
        expected = np.maximum([exact_near(profile, corners, place) for place in places[chosen]], machine.raster.floor)
        worst = np.abs(heights.reshape(-1)[chosen] - expected).max()
        rows.append(f"| {name} | {1e6 * min(seconds) / heights.size:.1f} | {1e12 * worst:.1f} |")
    return rows


def exact_near(cutter: Profile, corners: np.ndarray, place: np.ndarray) -> float:
    """exact_heights() at one place, with the triangles below the cutter alone."""
    apart = np.maximum(corners.min(axis=1)[:, :2] - place, place - corners.max(axis=1)[:, :2]).max(axis=1)
    below = corners[apart <= cutter.radius]
    return float(exact_heights(cutter, below, place[None])[0]) if len(below) else -np.inf


# Of radius, corner, angle to the axis, and length.
CUTTERS = {
    "ball": lambda r, c, a, to: (cyber_radar.ball_cutter(r, to), Profile(r, 0, r)),
    "flat": lambda r, c, a, to: (cyber_radar.flat(r, to), Profile(r, r)),
    "bull": lambda r, c, a, to: (cyber_radar.bull_nose(r, c, to), Profile(r, r - c, c)),
    "cone": lambda r, c, a, to: (cyber_radar.cone(r, a, to), Profile(r, 0, 0, a)),
    "taper": lambda r, c, a, to: (cyber_radar.taper(r, a, c, to), Profile(r, 0, c, a)),
}


def cutter_of(name: str, options: argparse.Namespace) -> tuple[Cutter, Profile]:
    return CUTTERS[name](options.diameter / 2, options.corner, np.radians(options.angle / 2), options.length)


def holder_of(options: argparse.Namespace, longer: float = 0.0) -> list[tuple[float, float, float]]:
    """The rings of a holder on a tool that is so much longer."""
    radius, above, corner = [*options.holder, 0.0][:3]
    above += longer
    return [(above + corner, radius - corner, corner), (above + options.length, radius, 0.0)]


def add_tool_arguments(parser: argparse.ArgumentParser, also: str = "") -> None:
    parser.add_argument("--cutter", default="ball", help=f"{', '.join(CUTTERS)}{also}")
    parser.add_argument("--diameter", type=float, default=6.0)
    parser.add_argument("--corner", type=float, default=1.0, help="radius of a bull nose's corner, or of a taper's tip")
    parser.add_argument("--angle", type=float, default=60.0, help="of a cone or taper, from side to side, degrees")
    parser.add_argument("--length", type=float, default=50.0)
    parser.add_argument(
        "--holder",
        nargs="+",
        type=float,
        metavar="MM",
        help="RADIUS ABOVE [CORNER]: a cylinder, so far above the tip, its lower rim rounded",
    )


def parsed(parser: argparse.ArgumentParser) -> argparse.Namespace:
    """Options with those of a tool, and the folder --out."""
    options = parser.parse_args()
    if options.holder and (options.cutter not in CUTTERS or len(options.holder) not in (2, 3)):
        parser.error(f"--holder: expected RADIUS ABOVE [CORNER], and one of {', '.join(CUTTERS)} as the cutter")
    options.out.mkdir(parents=True, exist_ok=True)
    return options


def machine_part(options: argparse.Namespace) -> dict:
    made = {"relief": relief, "cube": cube}
    part = made[options.part]() if options.part in made else cyber_radar.read_mesh(options.part)
    machine = Machine(part, options.step)
    if options.table:
        return {"table": table(machine, part, options)}
    report: dict = {"part": options.part, "triangles": len(part[1]), "cutter": options.cutter}
    if options.cutter in CUTTERS:
        tool, profile = cutter_of(options.cutter, options)
    else:
        tool, profile = cyber_radar.rounded(cyber_radar.read_mesh(options.cutter), 0), None
    casts, heights, seconds = machine.drop(tool)
    every = 1 + max(casts.shape) // 7  # few, so that the part is seen between them
    casts[::every, ::every].show(options.out / "drops.html", title="A cutter falls onto a part")
    report |= {"points": heights.size, "seconds": seconds, "us_per_point": 1e6 * seconds / heights.size}
    report["undecided"] = int((casts.status == Status.UNDECIDED).sum())
    for kind, name in ((1, "vertices"), (2, "edges"), (3, "facets")):
        report[f"{name}_touched"] = int((casts.feature_b == kind).sum())

    np.save(options.out / "heights.npy", heights)
    np.save(options.out / "touched.npy", np.concatenate([casts.point, casts.feature_b[..., None]], axis=-1))
    if options.waterline:
        height, *degrees = options.waterline
        stops = np.concatenate([machine.push(tool, height, angle) for angle in degrees or (0, 90, 180, 270)])
        np.savetxt(options.out / "waterline.csv", stops, "%r", ",", header="x,y,z,px,py,pz,kind", comments="")
        report["waterline_stops"] = len(stops)
    path, work = machine.path(tool, heights, options.tolerance)
    report |= work
    write_path(options.out / "path.ngc", machine.raster.top, path)
    if profile is not None:
        left = surface_left(heights + options.tolerance, options.step, profile, machine.raster.top - 1.0)
        show_surface(options.out / "surface.html", machine.raster, left, tool)
    if options.holder:
        first, held, report["tool_longer_mm"] = machine.hold(
            lambda longer: tool.with_holder(holder_of(options, longer)), path, options.tolerance
        )
        rows = np.column_stack([path, held])[first]
        np.savetxt(options.out / "holder.csv", rows, "%r", ",", header="x,y,cutter_z,holder_z", comments="")
        report["holder_touches_first"] = len(rows)
    return report


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("part", help="a mesh file, or relief or cube")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder to write to")
    add_tool_arguments(parser, ", or a mesh file")
    parser.add_argument("--step", type=float, default=1.0, help="distance of the raster's points")
    parser.add_argument("--tolerance", type=float, default=0.01, help="how far above its heights the tip is driven")
    parser.add_argument(
        "--waterline",
        nargs="+",
        type=float,
        metavar="NUMBER",
        help="HEIGHT [DEGREES...]: also pushes the cutter from the "
        "sides, its tip at this height, in these horizontal directions, or towards +x, +y, -x and -y",
    )
    parser.add_argument(
        "--table", action="store_true", help="only times of all cutters, and differences from closed forms"
    )
    options = parsed(parser)
    try:
        report = machine_part(options)
    except (OSError, ValueError, cyber_radar.Error) as problem:
        parser.error(str(problem))
    (options.out / "report.json").write_text(json.dumps(report, indent=1) + "\n")
    for row in report.pop("table", []):
        print(row)
    for name, value in report.items():
        print(f"{name}: {value:.6g}" if isinstance(value, float) else f"{name}: {value}")


if __name__ == "__main__":
    sys.exit(main())
