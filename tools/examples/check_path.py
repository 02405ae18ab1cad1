#!/usr/bin/env python3
"""Checks a tool's path: where does the tool or the machine's head touch what it must not?

    PYTHONPATH=build/release/python python3 tools/examples/check_path.py pocket --out pocket
    ... check_path.py part.ngc --stock stock.stl --part part.stl --fixture vise.stl --holder 20 30 --out part

Rapid moves must touch nothing; moves that cut no fixture, and the part with the cutter alone. The stock stays as it is
before the first move, so a rapid move straight up from where the tool has cut counts as one that cuts.

The path is G-code of straight moves (G0, G1) in absolute millimetres, checked from where X, Y and Z are known, or the
tip's points as .csv or .npy: rows of x, y, z and, if given, 0 where the move to the point is rapid, 1 where it cuts.
Meshes are in its coordinates; of the head, the tip is at the origin. "pocket" is made here: a rapid move of it hits a
clamp.

Writes conflicts.csv (each conflict's line, of an .npy its row, from 0; what touches which object after which distance,
and where) and path.html, a page of the moves, each up to its first conflict. Exit status 1: there are conflicts; 2: bad
input.
"""

from __future__ import annotations

import argparse
import csv
import dataclasses
import math
import pathlib
import re
import sys
import time

import numpy as np

import boxes
import cyber_radar
import tool_path
from cyber_radar import Cutter, Status
from drop_cutter import CUTTERS, Mesh, add_tool_arguments, cutter_of, holder_of, parsed

STOCK, PART, FIXTURE = 1, 2, 4  # bits of objects
_SHOWN = 2_000  # moves of a page
_PRINTED = 20  # conflicts; the file has all
_WORD = re.compile(r"\s*([A-Z])\s*([-+]?(?:\d+\.?\d*|\.\d+))", re.IGNORECASE)
# What changes neither the tool nor where a straight move takes its tip.
_REST = [*"FHNS", *"G17 G21 G40 G43 G49 G54 G80 G90 G94 M2 M3 M5 M8 M9 M30".split()]


@dataclasses.dataclass
class Path:
    """Moves of the tip."""

    points: np.ndarray  #: (n + 1, 3)
    cuts: np.ndarray  #: (n,) whether the tool cuts
    lines: np.ndarray  #: (n,) of the file

    @property
    def leaves(self) -> np.ndarray:
        """(n,) whether a move goes straight up from where the one before has cut."""
        ways = np.diff(self.points, axis=0)
        is_up = (ways[:, :2] == 0).all(axis=1) & (ways[:, 2] >= 0) & ~self.cuts
        return is_up & np.concatenate([[False], self.cuts[:-1]])


def read_gcode(file: pathlib.Path) -> Path:
    """Refuses what could move the tip in another way, by file and line."""
    at, cuts = dict.fromkeys("XYZ", math.nan), None
    points: list[list[float]] = []
    moves: list[tuple[bool, int]] = []
    for number, line in enumerate(file.read_text(errors="replace").splitlines(), 1):
        code, to, place = re.sub(r"\([^()]*\)|;.*", "", line).strip(" \t%"), {}, 0
        motions, is_end = set(), False
        while place < len(code):
            word = _WORD.match(code, place)
            if word is None:
                raise ValueError(f"{file}:{number}: expected words such as G1 or X2.5, got {code[place:].strip()!r}")
            letter, value, place = word[1].upper(), float(word[2]), word.end()
            name = f"{letter}{value:g}"
            if letter in at and letter not in to and math.isfinite(value):
                to[letter] = value
            elif name in ("G0", "G1"):
                motions.add(name == "G1")
            elif letter not in _REST and name not in _REST and (points or letter != "T" and name != "M6"):
                known = f"G0, G1, one X, Y and Z, {', '.join(_REST)}, or T and M6 before the first move"
                raise ValueError(f"{file}:{number}: expected {known}, got {word[0].strip()}")
            is_end |= name in ("M2", "M30")
        if len(motions) > 1 or (to and not motions and cuts is None):
            raise ValueError(f"{file}:{number}: expected one of G0 and G1, got {line.strip()!r}")
        cuts = motions.pop() if motions else cuts
        at |= to
        if to and not any(map(math.isnan, at.values())):
            moves += [(bool(cuts), number)] if points else []
            points.append(list(at.values()))
        if to and cuts and not moves:
            raise ValueError(f"{file}:{number}: expected G0 with X, Y and Z before the first G1, got {line.strip()!r}")
        if is_end:
            break
    if not moves:
        raise ValueError(f"{file}: expected a move from a point whose X, Y and Z are given, got none")
    return Path(np.array(points), *map(np.array, zip(*moves)))


def read_points(file: pathlib.Path) -> Path:
    if file.suffix == ".npy":
        try:
            rows = np.load(file, allow_pickle=False)
        except ValueError as error:
            raise ValueError(f"{file}: expected an array of numbers: {error}") from None
        lines = np.arange(rows.shape[0] if rows.ndim else 0)
    else:
        numbers = []
        for number, line in enumerate(file.read_text(errors="replace").splitlines(), 1):
            try:
                numbers.append([float(word) for word in line.split(",")])
            except ValueError:
                raise ValueError(f"{file}:{number}: expected numbers with commas between them, got {line!r}") from None
            if len(numbers[-1]) != len(numbers[0]):
                raise ValueError(f"{file}:{number}: expected {len(numbers[0])} numbers, as in line 1, got {line!r}")
        lines, rows = np.arange(1, len(numbers) + 1), np.array(numbers)
    if rows.dtype.kind not in "fiu" or rows.ndim != 2 or len(rows) < 2 or rows.shape[1] not in (3, 4):
        raise ValueError(f"{file}: expected two rows or more of 3 or 4 numbers, got {rows.dtype} of shape {rows.shape}")
    rows = rows.astype(float)
    wrong = ~np.isfinite(rows).all(axis=1) | ~np.isin(rows[:, 3:], (0, 1)).all(axis=1)
    if wrong.any():
        row = rows[wrong][0].tolist()
        raise ValueError(f"{file}:{lines[wrong][0]}: expected finite numbers, and 0 or 1 as the fourth, got {row}")
    cuts = rows[1:, 3] == 1 if rows.shape[1] == 4 else np.ones(len(rows) - 1, bool)
    return Path(rows[:, :3], cuts, lines[1:])


@dataclasses.dataclass
class Conflict:
    """A move, and an object that it meets."""

    line: int
    move: str  #: rapid or cutting
    what: str  #: cutter, holder or head
    object: str
    status: str  #: hit, overlap, or undecided: it may touch
    after: float  #: the distance that certainly is free
    x: float  #: where it touches
    y: float
    z: float

    def __str__(self) -> str:
        does = "may touch" if self.status == "undecided" else "touches"
        at = f"after {self.after:.6g} mm, at ({self.x:.6g}, {self.y:.6g}, {self.z:.6g})"
        return f"{self.line}: {self.move} move: the {self.what} {does} {self.object} {at}"


class Machine:
    """What a tool moves among, and the head that holds it, a mesh."""

    def __init__(self, tool: Cutter, head: Mesh | None = None) -> None:
        self.scene, self.names = cyber_radar.Scene(), {}
        # What moves, and the bits of objects that it must not touch in rapid moves, and while the tool cuts.
        self.movers = [("cutter", self.scene.add_mesh(tool), STOCK | PART | FIXTURE, FIXTURE)]
        if len(tool.parts) > 1:
            self.movers.append(("holder", self.scene.add_mesh(Cutter(tool.parts[1:])), 0, PART))
        if head is not None:
            self.movers.append(("head", self.scene.add_mesh(*head), STOCK | PART | FIXTURE, PART | FIXTURE))

    def add(self, name: str, mesh: Mesh, bit: int) -> None:
        self.names[self.scene.add(self.scene.add_mesh(*mesh), mask=bit)] = name

    def add_boxes(self, name: str, placed: list[tuple], bit: int) -> None:
        """Middles (3,) and sides (3,)."""
        self.names |= dict.fromkeys(boxes.add_boxes(self.scene, placed, bit), name)

    def cast(self, path: Path, moves: np.ndarray | slice = slice(None)) -> cyber_radar.Casts:
        """Of these moves: (movers, moves)."""
        _, meshes, rapid, cutting = (np.array(column)[:, None] for column in zip(*self.movers))
        masks = np.where(path.cuts | path.leaves, cutting, rapid)[:, moves]
        ways = np.diff(path.points, axis=0)[moves]
        poses = tool_path.poses_at(path.points[:-1][moves])
        return self.scene.cast(meshes, poses, ways, mask=masks, hits="all", mode="reference")

    def conflicts(self, path: Path, casts: cyber_radar.Casts) -> list[Conflict]:
        """Along the path."""
        movers, moves = np.unravel_index(casts.hits.cast, casts.shape)
        found = []
        for i in np.lexsort((casts.hits.lo, moves)):
            hit, line = casts.hits.records[i], int(path.lines[moves[i]])
            is_holder = movers[i] == 0 and hit["tri_a"] > 0  # the number of a tool's part
            what, to = "holder" if is_holder else self.movers[movers[i]][0], self.names[int(hit["object"])]
            how, after = Status(hit["status"]).name.lower(), float(hit["lo"])
            does = "cutting" if path.cuts[moves[i]] else "rapid"
            found.append(Conflict(line, does, what, to, how, after, *hit["point"].tolist()))
        return found

    def show(self, path: Path, casts: cyber_radar.Casts, file: pathlib.Path, title: str) -> None:
        """A page of the first moves with conflicts and, if there is room, of the first others: of each what stops first."""
        shown = np.sort(np.argsort((casts.status == Status.CLEAR).all(axis=0), kind="stable")[:_SHOWN])
        again = self.cast(path, shown)
        again[again.lo.argmin(axis=0), np.arange(len(shown))].show(file, title=title)


def pocket_code(radius: float) -> str:
    """Mills the pocket of add_pocket() in levels, to and fro, and hits a clamp with a rapid move."""
    low, high = np.array([20.1, 15.1]) + radius, np.array([59.9, 44.9]) - radius
    if (low >= high).any():
        raise ValueError(f"--diameter: expected less than 29.8 for the pocket, got {2 * radius:g}")
    rows = np.linspace(low[1], high[1], 1 + math.ceil((high[1] - low[1]) / radius))
    lines = ["%", "(a pocket between two clamps)", "G21 G90", "G0 Z30", f"X{low[0]:.3f} Y{low[1]:.3f}"]
    for depth in (3.9, 7.9, 11.9):
        lines += ["Z1", f"G1 Z-{depth} F300"]
        for i, y in enumerate(rows):
            ends = (low[0], high[0]) if i % 2 == 0 else (high[0], low[0])
            lines += [f"Y{y:.3f}", f"X{ends[1]:.3f} F1200"]
        lines += ["G0 Z30", f"X{low[0]:.3f} Y{low[1]:.3f}"]
    lines += [f"X{high[0]:.3f} Y30", "Z5 (too low for the next move)", "X120", "Z30", "M2", "%", ""]
    return "\n".join(lines)


def add_pocket(machine: Machine) -> None:
    """A block with a pocket from x 20 to 60 and y 15 to 45, 12 deep, its stock, and clamps on both ends."""
    walls = [((10, 30, -6), (20, 60, 12)), ((70, 30, -6), (20, 60, 12))]
    walls += [((40, 7.5, -6), (40, 15, 12)), ((40, 52.5, -6), (40, 15, 12))]
    machine.add_boxes("the part", [((40, 30, -16), (80, 60, 8)), *walls], PART)
    machine.add_boxes("the stock", [((40, 30, -10), (80, 60, 20))], STOCK)
    machine.add_boxes("the left clamp", [((0, 30, -4), (20, 20, 32))], FIXTURE)
    machine.add_boxes("the right clamp", [((80, 30, -4), (20, 20, 32))], FIXTURE)


def checked(options: argparse.Namespace) -> list[Conflict]:
    tool, _ = cutter_of(options.cutter, options)
    tool = tool.with_holder(holder_of(options)) if options.holder else tool
    head, file, is_sample = None, options.path, str(options.path) == "pocket"
    if is_sample:
        file = options.out / "pocket.ngc"
        file.write_text(pocket_code(options.diameter / 2))
        up = max(ring[0] for part in tool.parts for ring in part)
        head = (boxes.CORNERS * (60, 60, 40) + (0, 0, up + 20), boxes.FACES)
    path = (read_points if file.suffix in (".csv", ".npy") else read_gcode)(file)
    if options.head:
        head = cyber_radar.read_mesh(options.head)
    machine = Machine(tool, head)
    if is_sample:
        add_pocket(machine)
    for files, bit in ((options.stock, STOCK), (options.part, PART), (options.fixture, FIXTURE)):
        for name in files:
            machine.add(name, cyber_radar.read_mesh(name), bit)
    if not len(machine.scene):
        raise ValueError("--stock, --part, --fixture: expected a mesh at least")
    begin = time.perf_counter()
    casts = machine.cast(path)
    seconds = time.perf_counter() - begin
    for reason, found in casts.reasons.items():
        raise ValueError(f"{file}:{path.lines[found[0] % len(path.cuts)]}: {reason}")
    conflicts = machine.conflicts(path, casts)
    for conflict in conflicts[:_PRINTED]:
        print(f"{file}:{conflict}")
    said = f"{len(path.cuts)} moves, {len({conflict.line for conflict in conflicts})} with conflicts"
    print(f"{said}: {1e6 * seconds / len(path.cuts):.0f} us a move")
    with open(options.out / "conflicts.csv", "w", newline="") as to:
        names = [field.name for field in dataclasses.fields(Conflict)]
        csv.writer(to).writerows([names, *map(dataclasses.astuple, conflicts)])
    machine.show(path, casts, options.out / "path.html", said)
    return conflicts


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("path", type=pathlib.Path, help="a file of G-code, a .csv, an .npy, or pocket")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder to write to")
    for name in ("stock", "part", "fixture"):
        parser.add_argument(f"--{name}", nargs="+", default=[], metavar="FILE", help="meshes")
    parser.add_argument("--head", metavar="FILE", help="a mesh that moves with the tool")
    add_tool_arguments(parser)
    options = parsed(parser)
    if options.cutter not in CUTTERS:
        parser.error(f"--cutter: expected one of {', '.join(CUTTERS)}, got {options.cutter}")
    try:
        return 1 if checked(options) else 0
    except (OSError, ValueError, cyber_radar.Error) as problem:
        parser.error(str(problem))


if __name__ == "__main__":
    sys.exit(main())
