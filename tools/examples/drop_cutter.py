#!/usr/bin/env python3
"""Machines a surface: a cutter falls along -z at every point of a raster until it touches the part, and moves from point
to point without cutting too deep.

    PYTHONPATH=build/release/python python3 tools/examples/drop_cutter.py part.stl --cutter ball --diameter 6 --out part
    ... drop_cutter.py relief --cutter mill.stl --holder 20 30 --step 0.5 --out relief
    ... drop_cutter.py cube --compare --out cube

The part is a mesh file, or "relief" or "cube", which are made here. The cutter is a ball, a flat or a bull-nosed end
mill, a cone, or any mesh file with its tip at the origin. A ball is exact, and so is the arc of a bull nose; the circle
around the axis of the others is a polygon: they are cast twice, inside and outside the circle, and the exact height lies
between the two. The cutter (the outer one) is driven, --tolerance higher, and cast along every straight move, too: where
it would touch the part, points are inserted. So it cuts too deep nowhere.

Writes heights.npy (the tip's height at each point of the raster, row by row), touched.npy (what it touches there: a point,
and 1 for a vertex, 2 for an edge, 3 for a facet), path.ngc (G-code, millimetres), report.json, drops.html (a page of some
of the casts), of a round cutter also surface.html (what is left of the stock, and the cutter on it), with a holder
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

import numpy as np

import cyber_radar
import tool_path
from cutters import Cutter, Mesh, Tool, exact_heights
from cyber_radar import Status

_TOLERANCE = 1e-10  # of brackets, times the radius of a round tool


@dataclasses.dataclass
class Raster:
    """Points at the distance `step` that cover a box."""

    x: np.ndarray  #: (nx,)
    y: np.ndarray  #: (ny,)
    top: float  #: where the tip starts, above the part
    floor: float  #: where it ends if nothing is below

    def points(self) -> np.ndarray:
        """(ny, nx, 2)."""
        return np.stack(np.meshgrid(self.x, self.y), axis=-1)


class Machine:
    """A part, and what falls onto it."""

    def __init__(self, part: Mesh, step: float, mode: str) -> None:
        self.scene, self.mode = cyber_radar.Scene(), mode
        self.scene.add(self.scene.add_mesh(*part))
        self.low, self.high = part[0].min(axis=0).astype(float), part[0].max(axis=0).astype(float)
        ticks = [tool_path.written(np.arange(self.low[k], self.high[k] + 0.5 * step, step)) for k in range(2)]
        self.raster = Raster(*ticks, top=self.high[2] + 1.0, floor=self.low[2])

    def drop(
        self, tool: Tool, mode: str | None = None, resolution: int = 0, page: pathlib.Path | None = None
    ) -> tuple[np.ndarray, float, cyber_radar.Casts]:
        """Heights of the tip, (ny, nx), the seconds that took, and the casts. page: shows some."""
        points, mode = self.raster.points(), mode or self.mode
        self.falls(tool, points[:1, :1], mode, resolution)  # opens the device
        start = time.perf_counter()
        casts, heights = self.falls(tool, points, mode, resolution)
        seconds = time.perf_counter() - start
        if page is not None:
            every = 1 + max(casts.shape) // 7  # few, so that the part is seen between them
            casts[::every, ::every].show(page, title="A cutter falls onto a part")
        return heights, seconds, casts

    def falls(
        self, tool: Tool, points: np.ndarray, mode: str, resolution: int = 0
    ) -> tuple[cyber_radar.Casts, np.ndarray]:
        """Casts from the top at these points (..., 2), and the heights of the tip, (...)."""
        starts = np.concatenate([points, np.full_like(points[..., :1], self.raster.top)], axis=-1)
        casts = self.goes(tool, starts, [0, 0, self.raster.floor - self.raster.top], mode, resolution)
        heights = np.where(casts.status == Status.CLEAR, self.raster.floor, self.raster.top - casts.lo)
        if mode == "sampled":
            heights = np.where(casts.touches, self.raster.top - casts.t, self.raster.floor)
        return casts, heights

    def goes(
        self, tool: Tool, starts: np.ndarray, way: np.ndarray, mode: str, resolution: int = 0
    ) -> cyber_radar.Casts:
        """Casts of a tool whose tip starts at these points (..., 3)."""
        poses = tool_path.poses_at(starts + [0, 0, tool.above])
        tolerance = _TOLERANCE * tool.shape.radius or None
        return self.scene.cast(tool.shape, poses, way, mode=mode, resolution=resolution, tolerance=tolerance)

    def waterline(self, tool: Tool, height: float) -> np.ndarray:
        """Where a tool stops that is pushed at this height of the tip from all four sides along the lines of the raster:
        (n, 7), its tip, the point touched, and its kind: 1 a vertex, 2 an edge, 3 a facet. What another part of the part
        hides from all sides is not there."""
        reach, found = self.high - self.low + 4 * (tool.shape.radius + np.abs(tool.shape.vertices).max()), []
        for along, ticks in ((0, self.raster.y), (1, self.raster.x)):
            for sign in (-1, 1):
                starts = np.full((len(ticks), 3), height)
                starts[:, 1 - along] = ticks
                starts[:, along] = 0.5 * (self.low + self.high)[along] - sign * reach[along]
                way = sign * 2 * reach[along] * np.eye(3)[along]
                casts = self.goes(tool, starts, way, self.mode)
                stops = casts.status == Status.HIT
                tips = starts[stops] + casts.lo[stops, None] * sign * np.eye(3)[along]
                found.append(np.column_stack([tips, casts.point[stops], casts.feature_b[stops]]))
        return np.concatenate(found)

    def path(self, tool: Tool, heights: np.ndarray, above: float) -> tuple[np.ndarray, dict]:
        """Rows to and fro over the raster, `above` these heights, with the points that it takes for no move to touch the
        part: (n, 3). And what that took."""
        up = tool_path.written_up(heights + above)
        rows = np.concatenate([self.raster.points(), up[..., None]], axis=-1)
        rows[1::2] = rows[1::2, ::-1].copy()
        straight = rows.reshape(-1, 3)
        points, gouged = tool_path.free_path(
            straight,
            lambda places: tool_path.written_up(self.falls(tool, places, self.mode)[1] + above),
            lambda starts, ends: tool_path.touches(self.scene, tool, starts, ends, self.mode),
            above,
        )
        longer = 100 * (tool_path.length(points) / tool_path.length(straight) - 1)
        return points, {
            "moves": len(gouged),
            "moves_too_deep": int(gouged.sum()),
            "points_inserted": len(points) - len(straight),
            "path_longer_percent": longer,
        }

    def hold(self, holder: Tool, path: np.ndarray, step: float) -> tuple[np.ndarray, float]:
        """The heights at which a holder touches the part at the points of a path, and how much longer the tool must be."""
        held = self.falls(holder, path[:, :2], self.mode)[1]
        longer = tool_path.lift_of(
            path, held, lambda starts, ends: tool_path.touches(self.scene, holder, starts, ends, self.mode), step
        )
        return held, longer


def surface_left(heights: np.ndarray, step: float, cutter: Cutter, top: float) -> np.ndarray:
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


def show_surface(file: pathlib.Path, raster: Raster, left: np.ndarray, tool: Tool, mode: str) -> None:
    """A page of the finished surface, with the cutter where it is lowest."""
    points = np.concatenate([raster.points(), left[..., None]], axis=-1).reshape(-1, 3)
    machine = Machine((points.astype(np.float32), _grid_faces(*left.shape)), 1.0, mode)
    casts, _ = machine.falls(tool, points[left.argmin(), :2], mode)
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
    signs = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * side / 2
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    turned = signs @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]).T
    squares = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    faces = [[a, b, c] for p, q, r, t in squares for a, b, c in ((p, q, r), (p, r, t))]
    return turned.astype(np.float32), np.array(faces)


def _grid_faces(rows: int, columns: int) -> np.ndarray:
    number = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]
    return np.concatenate([np.stack([a, b, c], -1), np.stack([a, c, d], -1)]).reshape(-1, 3)


def write_path(file: pathlib.Path, top: float, points: np.ndarray) -> None:
    top = max(top, points[:, 2].max())
    lines = ["G21 G90", f"G0 Z{top:.4f}", "G0 X{:.4f} Y{:.4f}".format(*points[0, :2])]
    lines += ["G1 X{:.4f} Y{:.4f} Z{:.4f} F1000".format(*point) for point in points]
    file.write_text("\n".join([*lines, f"G0 Z{top:.4f}", "M2", ""]))


def compare_modes(machine: Machine, tool: Tool) -> list[dict]:
    """What depth pictures get wrong: how much deeper than the truth they let the cutter fall."""
    exact, seconds, _ = machine.drop(tool, "reference")
    rows = [{"mode": "reference", "seconds": seconds, "deepest_error_um": 0.0, "undecided": 0}]
    for mode, resolution in (("contact", 0), ("sampled", 32), ("sampled", 128)):
        heights, seconds, casts = machine.drop(tool, mode, resolution)
        error = 1e3 * float((exact - heights).max())
        name = f"{mode} {resolution}" if resolution else mode
        undecided = int((casts.status == Status.UNDECIDED).sum())
        rows.append({"mode": name, "seconds": seconds, "deepest_error_um": error, "undecided": undecided})
    return rows


def table(machine: Machine, part: Mesh, options: argparse.Namespace) -> list[str]:
    """Times of all cutters over the raster, and the greatest differences from closed forms at some of its places."""
    radius, corners = options.diameter / 2, part[0].astype(float)[part[1]]
    ball = Cutter(radius, options.length, corner=radius)
    cutters = [("ball", ball, ball.tool(0)), ("ball, 64 x 16 facets", ball, ball.facets(64, 16))]
    for name, of_kind in (
        ("bull", Cutter(radius, options.length, corner=options.corner)),
        ("flat", Cutter(radius, options.length)),
        ("cone", Cutter(radius, options.length, slope=_slope(options))),
    ):
        cutters.append((f"{name}, {options.segments} corners", of_kind, of_kind.tool(options.segments)))
    chosen = np.random.default_rng(1).choice(machine.raster.points().reshape(-1, 2).shape[0], 200)
    rows = [f"| cutter, radius {radius:g} | us a place | greatest difference |", "|---|---|---|"]
    for name, cutter, tool in cutters:
        heights, seconds, _ = machine.drop(tool)
        places = machine.raster.points().reshape(-1, 2)[chosen]
        expected = np.maximum([exact_near(cutter, corners, place) for place in places], machine.raster.floor)
        worst = np.abs(heights.reshape(-1)[chosen] - expected).max()
        rows.append(f"| {name} | {1e6 * seconds / heights.size:.1f} | {worst:.1e} |")
    return rows


def exact_near(cutter: Cutter, corners: np.ndarray, place: np.ndarray) -> float:
    """exact_heights() at one place, with the triangles below the cutter alone."""
    apart = np.maximum(corners.min(axis=1)[:, :2] - place, place - corners.max(axis=1)[:, :2]).max(axis=1)
    below = corners[apart <= cutter.radius]
    return float(exact_heights(cutter, below, place[None])[0]) if len(below) else -np.inf


def _slope(options: argparse.Namespace) -> float:
    return 1 / np.tan(np.radians(options.angle / 2))


def cutter_from(options: argparse.Namespace) -> Cutter | None:
    radius, length = options.diameter / 2, options.length
    if options.cutter == "ball":
        return Cutter(radius, length, corner=radius)
    if options.cutter == "flat":
        return Cutter(radius, length)
    if options.cutter == "bull":
        return Cutter(radius, length, corner=options.corner)
    if options.cutter == "cone":
        return Cutter(radius, length, slope=_slope(options))
    return None


def holder_from(options: argparse.Namespace) -> Tool:
    if len(options.holder) == 1:
        return Tool(cyber_radar.rounded(cyber_radar.read_mesh(options.holder[0]), 0))
    radius, above, corner = map(float, [*options.holder, 0][:3])
    holder = Cutter(radius, options.length, corner).tool(options.segments)
    return dataclasses.replace(holder, above=holder.above + above)


def machine_part(options: argparse.Namespace) -> dict:
    made = {"relief": relief, "cube": cube}
    part = made[options.part]() if options.part in made else cyber_radar.read_mesh(options.part)
    machine, cutter = Machine(part, options.step, options.mode), cutter_from(options)
    if options.table:
        return {"table": table(machine, part, options)}
    report: dict = {"part": options.part, "triangles": len(part[1]), "cutter": options.cutter, "mode": options.mode}
    if cutter is None:
        tool = Tool(cyber_radar.rounded(cyber_radar.read_mesh(options.cutter), 0))
    else:
        tool = cutter.tool(options.segments)
    heights, seconds, casts = machine.drop(tool, page=options.out / "drops.html")
    if cutter is not None and cutter.corner < cutter.radius:
        deepest, _, _ = machine.drop(cutter.tool(options.segments, outside=False))
        report["polygon_error_um"] = 1e3 * cutter.polygon_error(options.segments)
        report["widest_bracket_um"] = 1e3 * float((heights - deepest).max())
        np.save(options.out / "lowest.npy", deepest)
    report |= {"points": heights.size, "seconds": seconds, "us_per_point": 1e6 * seconds / heights.size}
    for kind, name in ((1, "vertices"), (2, "edges"), (3, "facets")):
        report[f"{name}_touched"] = int((casts.feature_b == kind).sum())

    np.save(options.out / "heights.npy", heights)
    np.save(options.out / "touched.npy", np.concatenate([casts.point, casts.feature_b[..., None]], axis=-1))
    if options.waterline is not None:
        stops = machine.waterline(tool, options.waterline)
        np.savetxt(options.out / "waterline.csv", stops, "%r", ",", header="x,y,z,px,py,pz,kind", comments="")
        report["waterline_stops"] = len(stops)
    path, work = machine.path(tool, heights, options.tolerance)
    report |= work
    write_path(options.out / "path.ngc", machine.raster.top, path)
    if cutter is not None:
        left = surface_left(heights + options.tolerance, options.step, cutter, machine.raster.top - 1.0)
        show_surface(options.out / "surface.html", machine.raster, left, tool, options.mode)
    if options.holder:
        held, report["tool_longer_mm"] = machine.hold(holder_from(options), path, options.tolerance)
        rows = np.column_stack([path, held])[held > path[:, 2]]
        np.savetxt(options.out / "holder.csv", rows, "%r", ",", header="x,y,cutter_z,holder_z", comments="")
        report["holder_touches_first"] = len(rows)
    if options.compare:
        report["modes"] = compare_modes(machine, tool)
    return report


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("part", help="a mesh file, or relief or cube")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder to write to")
    parser.add_argument("--cutter", default="ball", help="ball, flat, bull, cone, or a mesh file")
    parser.add_argument("--diameter", type=float, default=6.0)
    parser.add_argument("--corner", type=float, default=1.0, help="radius of a bull-nosed cutter's corner")
    parser.add_argument("--angle", type=float, default=60.0, help="of a cone, degrees")
    parser.add_argument("--length", type=float, default=50.0)
    parser.add_argument(
        "--holder", nargs="+", help="a mesh file with the tip at the origin, or a cylinder: RADIUS ABOVE [CORNER]; with a "
        "corner of its radius a capsule"
    )
    parser.add_argument("--step", type=float, default=1.0, help="distance of the raster's points")
    parser.add_argument("--tolerance", type=float, default=0.01, help="how far above its heights the tip is driven")
    parser.add_argument("--segments", type=int, default=64, help="corners around a round cutter")
    parser.add_argument("--waterline", type=float, help="also pushes the cutter from the sides, its tip at this height")
    parser.add_argument("--mode", choices=("contact", "reference"), default="contact")
    parser.add_argument("--compare", action="store_true", help="also in the other modes; not of a ball or bull nose")
    parser.add_argument("--table", action="store_true", help="only times of all cutters, and differences from closed forms")
    options = parser.parse_args()
    if options.compare and options.cutter in ("ball", "bull"):
        parser.error("--compare: expected a cutter without an arc: depth pictures show meshes")
    options.out.mkdir(parents=True, exist_ok=True)
    report = machine_part(options)
    (options.out / "report.json").write_text(json.dumps(report, indent=1) + "\n")
    modes = report.pop("modes", [])
    print("\n".join(report.pop("table", [])), end="")
    for name, value in report.items():
        print(f"{name}: {value:.6g}" if isinstance(value, float) else f"{name}: {value}")
    for row in modes:
        print(
            "  {mode}: {seconds:.3f} s, up to {deepest_error_um:.3g} um too deep, {undecided} undecided".format(**row)
        )


if __name__ == "__main__":
    sys.exit(main())
