"""The check of a tool's path."""

import argparse
import subprocess
import sys

import numpy as np
import pytest

from conftest import box, page_data, write_obj
from cyber_radar import Cutter
from test_examples import EXAMPLES

import boxes  # noqa: E402  (test_examples makes the examples importable)
import check_path  # noqa: E402
import drop_cutter  # noqa: E402

OPTIONS = argparse.Namespace(diameter=6, corner=1, angle=60, length=25, holder=[10, 25])


def tool(name: str) -> Cutter:
    return drop_cutter.cutter_of(name, OPTIONS)[0].with_holder(drop_cutter.holder_of(OPTIONS))


def run(*arguments) -> subprocess.CompletedProcess:
    command = [sys.executable, "-W", "error", EXAMPLES / "check_path.py", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True)


def path_of(points, cuts) -> check_path.Path:
    return check_path.Path(np.array(points, float), np.array(cuts), np.arange(1, len(points)))


def conflicts(machine, path) -> list[tuple]:
    found = machine.conflicts(path, machine.cast(path))
    return [(conflict.line, conflict.what, conflict.object, round(conflict.after, 9)) for conflict in found]


def test_moves_are_stopped_by_what_they_must_not_touch_and_by_nothing_else():
    head = boxes.CORNERS * (60, 60, 20) + (0, 0, 70), boxes.FACES  # from 60 above the tip
    machine = check_path.Machine(tool("flat"), head)
    machine.add_boxes("stock", [((0, 0, -10), (100, 100, 20))], check_path.STOCK)
    machine.add_boxes("part", [((0, 0, -15), (100, 100, 10)), ((40, 0, -5), (20, 100, 10))], check_path.PART)
    machine.add_boxes("post", [((0, 45, 20), (10, 10, 120))], check_path.FIXTURE)
    for points, cuts, expected in (
        ([[0, 0, 5], [0, 0, -8], [0, -9, -8], [0, -9, 5]], [True, True, False], []),  # cuts, and leaves straight up
        ([[0, 0, 5], [0, 0, -8]], [False], [(1, "cutter", "stock", 5)]),
        ([[0, 0, 5], [0, 0, -8], [9, 0, -8]], [True, False], [(2, "cutter", "stock", 0)]),
        ([[0, 0, 5], [0, 0, -8], [9, 0, 5]], [True, False], [(2, "cutter", "stock", 0)]),  # leaves, but not straight
        ([[0, 0, 5], [0, 0, -41]], [True], [(1, "holder", "part", 40)]),  # from 25 above the tip to the floor
        ([[27, 0, 5], [27, 0, -31]], [True], [(1, "holder", "part", 30)]),  # to the wall from x 30 on
        ([[0, 0, 5], [0, 20, 5]], [True], [(1, "head", "post", 10)]),
        ([[0, 0, 50], [0, 20, 50]], [False], []),
        ([[40, 32, 5], [-40, 32, 5]], [True], [(1, "head", "post", 5), (1, "holder", "post", 29)]),
    ):
        found = conflicts(machine, path_of(points, cuts))
        assert found == expected, points


def test_the_pocket_has_one_conflict_at_its_distance(tmp_path):
    done = run("pocket", "--cutter", "bull", "--length", 25, "--holder", 8, 25, "--out", tmp_path)
    assert (done.returncode, done.stderr) == (1, "")
    code = (tmp_path / "pocket.ngc").read_text().splitlines()
    line = code.index("Z5 (too low for the next move)") + 2
    told = f"{tmp_path / 'pocket.ngc'}:{line}: rapid move: the cutter touches the right clamp after 10.1 mm, at (70, "
    assert done.stdout.startswith(told)
    rows = [row.split(",") for row in (tmp_path / "conflicts.csv").read_text().splitlines()]
    assert rows[0] == "line,move,what,object,status,after,x,y,z".split(",") and len(rows) == 2
    assert float(rows[1][5]) == pytest.approx(10.1, abs=1e-12)
    path = check_path.read_gcode(tmp_path / "pocket.ngc")
    shown = page_data(tmp_path / "path.html")
    assert shown["title"] == f"{len(path.cuts)} moves, 1 with conflicts"
    assert shown["queries"]["count"] == len(path.cuts)
    assert path.lines[0] == 6 and path.points[0].tolist() == [23.1, 18.1, 30] and 40 < path.cuts.sum() < len(path.cuts)


def test_points_of_a_file_are_moves_that_cut_or_do_not(tmp_path):
    rows = [[0, 0, 9, 0], [0, 0, 2, 0], [30, 0, 2, 1], [30, 0, 9, 0]]
    wall = tmp_path / "wall.obj"
    write_obj(wall, box(10, 40, 4) + (20, 0, 2))
    (tmp_path / "path.csv").write_text("".join(",".join(map(str, row)) + "\n" for row in rows))
    np.save(tmp_path / "path.npy", np.array(rows))
    for name, line in (("path.csv", 3), ("path.npy", 2)):
        for given, move in (("--fixture", "cutting"), ("--stock", None)):
            done = run(tmp_path / name, given, wall, "--out", tmp_path / "out")
            if move:
                told = f"{tmp_path / name}:{line}: {move} move: the cutter touches {wall} after {15 - 8**0.5:.6g} mm"
            else:
                told = "3 moves, 0 with conflicts"
            assert done.returncode == (1 if move else 0) and done.stdout.startswith(told), done
    np.save(tmp_path / "path.npy", np.array(rows)[:, :3])
    assert check_path.read_points(tmp_path / "path.npy").cuts.all()


def test_bad_paths_are_refused_with_file_and_line(tmp_path):
    mesh = tmp_path / "missing.stl"
    for code, problem in (
        ("G0 X0 Y0 Z0\nG2 X1 Y1 I1", "path.ngc:2: expected G0, G1, one X, Y and Z, F, H, "),
        ("T1 M6\nG0 X0 Y0 Z0\nT2", "path.ngc:3: expected G0, G1, one X, Y and Z, "),
        ("T1 M6\nG0 X0 Y0 Z0\nM6", "before the first move, got M6"),
        ("G20\nG0 X0 Y0 Z0", "path.ngc:1: expected G0, G1, one X"),
        ("G91 G0 X0", "got G91"),
        ("G0 X0 Y0 Z0\nX1 X2", "path.ngc:2: expected G0, G1, one X, Y and Z"),
        ("G0 X0 Y0 Z0\nX1 G0 G1", "path.ngc:2: expected one of G0 and G1, got 'X1 G0 G1'"),
        ("X0 Y0 Z0", "path.ngc:1: expected one of G0 and G1"),
        ("G0 X0 Y0\nG1 Z0", "path.ngc:2: expected G0 with X, Y and Z before the first G1"),
        ("G0 X0 Y0 Z0\nG0 X#5", "path.ngc:2: expected words such as G1 or X2.5, got 'X#5'"),
        ("G0 X0 Y0 Z0\nG0 X1 (open", "path.ngc:2: expected words such as G1 or X2.5, got '(open'"),
        ("G0 X0 Y0 Z0\nG0 X" + "9" * 400, "path.ngc:2: expected G0, G1, one X"),
        ("G0 X0 Y0 Z0\nM30\nX1", "path.ngc: expected a move from a point whose X, Y and Z are given, got none"),
        ("\x00\xff", "path.ngc:1: expected words"),
        ("", "path.ngc: expected a move from"),
    ):
        check_refusal(tmp_path, "path.ngc", code, problem)
    for text, problem in (
        ("0,0,0\n0,0,a\n", "path.csv:2: expected numbers with commas between them, got '0,0,a'"),
        ("0,0,0\n0,0,0,1\n", "path.csv:2: expected 3 numbers, as in line 1"),
        ("0,0,0\n0,0,inf\n", "path.csv:2: expected finite numbers"),
        ("0,0,0,1\n0,0,1,2\n", "expected finite numbers, and 0 or 1 as the fourth, got [0.0, 0.0, 1.0, 2.0]"),
        ("0,0\n0,1\n", "path.csv: expected two rows or more of 3 or 4 numbers, got float64 of shape (2, 2)"),
        ("", "path.csv: expected two rows or more"),
        ("0,0,0\n", "path.csv: expected two rows or more"),
    ):
        check_refusal(tmp_path, "path.csv", text, problem)
    check_refusal(tmp_path, "path.npy", "no array", "path.npy: expected an array of numbers")
    for array in (np.array("abc"), np.zeros((3, 2)), np.array([[{}] * 3] * 2, object)):
        np.save(tmp_path / "path.npy", array, allow_pickle=True)
        assert_refused(tmp_path / "path.npy", tmp_path, "path.npy: expected")
    (tmp_path / "path.ngc").write_text("G0 X0 Y0 Z0\nX1")
    for arguments, problem in (
        ([tmp_path / "none.ngc", "--fixture", mesh], "none.ngc"),
        ([tmp_path / "path.ngc", "--fixture", mesh], "missing.stl"),
        ([tmp_path / "path.ngc"], "--stock, --part, --fixture: expected a mesh at least"),
        (["pocket", "--cutter", "mill.stl"], "--cutter: expected one of ball, flat, bull, cone, taper, got mill.stl"),
        (["pocket", "--holder", "5"], "--holder: expected RADIUS ABOVE [CORNER]"),
        (["pocket", "--diameter", "29.9"], "--diameter: expected less than 29.8 for the pocket, got 29.9"),
        (["pocket", "--diameter", "-1"], "radius: expected a number above 0"),
    ):
        done = run(*arguments, "--out", tmp_path)
        assert done.returncode == 2 and problem in done.stderr, done.stderr


def check_refusal(folder, name: str, text: str, problem: str) -> None:
    (folder / name).write_text(text)
    assert_refused(folder / name, folder, problem)


def assert_refused(file, folder, problem: str) -> None:
    with pytest.raises(ValueError) as caught:
        (check_path.read_gcode if file.suffix == ".ngc" else check_path.read_points)(file)
    assert problem in str(caught.value)
