"""The heights of the drop cutter, against the closed forms of round cutters on vertices, edges and facets."""

import argparse
import json
import subprocess
import sys

import numpy as np
import pytest

from conftest import page_data, write_obj
from test_examples import EXAMPLES, run

import drop_cutter  # noqa: E402  (test_examples makes the examples importable)
from closed_forms import Profile, exact_heights  # noqa: E402

OPTIONS = argparse.Namespace(diameter=6, corner=1, angle=60, length=50)
TOOLS = {name: drop_cutter.cutter_of(name, OPTIONS) for name in drop_cutter.CUTTERS}
each_tool = pytest.mark.parametrize("tool, profile", TOOLS.values(), ids=TOOLS)


def test_a_cutter_pushed_from_any_side_stops_where_it_falls_to_that_height():
    vertices, faces = drop_cutter.relief(cells=8, side=30.0)
    machine, corners = drop_cutter.Machine((vertices, faces), 1.0), vertices.astype(float)[faces]
    for degrees in (0, 90, 217):
        for name in ("ball", "taper"):
            tool, profile = TOOLS[name]
            stops = machine.push(tool, 3.0, degrees)
            assert len(stops) > 10 and (stops[:, 2] == 3).all()
            way = np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])
            assert (exact_heights(profile, corners, stops[:, :2] + 1e-7 * way) > 3).all()
            for back in (1e-7, 0.01, 1, 9):
                assert (exact_heights(profile, corners, stops[:, :2] - back * way) < 3).all()


def test_a_relief_is_machined(tmp_path):
    write_obj(tmp_path / "part.obj", *drop_cutter.relief(cells=10, side=20.0))
    text = run(
        "drop_cutter.py", tmp_path / "part.obj", "--out", tmp_path, "--step", 1, "--diameter", 4,
        "--cutter", "bull", "--corner", 0.5, "--holder", 8, 6, "--waterline", 3, 30, 120,
    )  # fmt: skip
    heights = np.load(tmp_path / "heights.npy")
    assert heights.shape == (21, 21)
    report = json.loads((tmp_path / "report.json").read_text())
    assert report["points"] == 441 and report["triangles"] == 200 and "points: 441" in text
    assert report["undecided"] == 0

    touched = np.load(tmp_path / "touched.npy")
    kinds = [(touched[..., 3] == kind).sum() for kind in (1, 2, 3)]
    assert kinds == [report[f"{name}_touched"] for name in ("vertices", "edges", "facets")] and sum(kinds) == 441
    stops = np.loadtxt(tmp_path / "waterline.csv", delimiter=",", skiprows=1, ndmin=2)
    assert len(stops) == report["waterline_stops"] > 20 and (stops[:, 2] == 3).all()

    table = np.loadtxt(tmp_path / "holder.csv", delimiter=",", skiprows=1, ndmin=2)
    assert len(table) == report["holder_touches_first"] > 0
    assert (table[:, 3] > table[:, 2]).all()

    driven = path_in(tmp_path)
    on_raster = (driven[:, :2] == np.round(driven[:, :2])).all(axis=1)
    of_raster = driven[on_raster]
    over = of_raster[np.lexsort((of_raster[:, 0], of_raster[:, 1])), 2] - heights.ravel()
    assert (over >= 0.01).all() and np.median(over) <= 0.0101 and over.max() < 0.1
    steps = np.abs(np.diff(of_raster[:, :2], axis=0)).sum(axis=1)
    assert (steps == 1).all()  # to and fro, never across the part
    assert report["moves"] == 440 > report["moves_too_deep"] > 0
    assert report["points_inserted"] == len(driven) - 441 > 0 and 0 < report["path_longer_percent"] < 5

    surface = page_data(tmp_path / "surface.html")
    assert surface["meshes"][0]["triangles"] == 800 and surface["queries"]["count"] == 1


def path_in(folder) -> np.ndarray:
    moves = [line for line in (folder / "path.ngc").read_text().splitlines() if line.startswith("G1 ")]
    return np.array([[float(word[1:]) for word in line.split()[1:4]] for line in moves])


@each_tool
def test_a_cutter_cuts_too_deep_at_no_point_of_its_path_and_neither_does_its_holder(tool, profile):
    vertices, faces = drop_cutter.relief(cells=7, side=12.0)
    machine, corners = drop_cutter.Machine((vertices, faces), 1.0), vertices.astype(float)[faces]
    _, heights, _ = machine.drop(tool)
    path, work = machine.path(tool, heights, 0.01)
    assert work["moves_too_deep"] > 50 and work["points_inserted"] == len(path) - heights.size > 50
    rng = np.random.default_rng(8)
    move, share = rng.integers(0, len(path) - 1, 200), rng.uniform(0, 1, (200, 1))
    between = (1 - share) * path[move] + share * path[move + 1]
    above = between[:, 2] - exact_heights(profile, corners, between[:, :2])
    assert (above >= 0).all() and np.median(above) < 0.1

    def with_holder(above: float):
        options = argparse.Namespace(holder=[8, above], length=20)
        return lambda longer: tool.with_holder(drop_cutter.holder_of(options, longer))

    first, held, longer = machine.hold(with_holder(5), path, 0.01)
    lowest = exact_heights(Profile(8, 8), corners, path[:, :2]) - 5
    assert (first == (lowest > path[:, 2])).all() and first.any()
    np.testing.assert_allclose(held[first], lowest[first], atol=1e-9)
    assert 0 <= longer - (lowest - path[:, 2]).max() < 0.1
    between = between[:60]
    assert (between[:, 2] + longer + 5 >= exact_heights(Profile(8, 8), corners, between[:, :2])).all()
    assert machine.hold(with_holder(40), path, 0.01)[2] == 0


def test_the_surface_left_is_the_lowest_envelope_and_never_below_the_part():
    part = drop_cutter.relief(cells=10, side=20.0)
    machine = drop_cutter.Machine(part, 1.0)
    ball, profile = TOOLS["ball"]
    _, heights, _ = machine.drop(ball)
    left = drop_cutter.surface_left(heights, 1.0, profile, 99.0)
    x, y = np.meshgrid(machine.raster.x, machine.raster.y)
    points = np.stack([x, y], axis=-1).reshape(-1, 2)
    direct = (heights.ravel() + profile.height(np.linalg.norm(points[:, None] - points, axis=-1))).min(axis=1)
    np.testing.assert_allclose(left.ravel(), np.minimum(direct, 99), atol=1e-12)
    needle = Profile(1e-9, 1e-9)
    assert (left.ravel() >= exact_heights(needle, part[0].astype(float)[part[1]], points) - 1e-6).all()


def test_any_mesh_may_be_the_cutter(tmp_path):
    corners = np.float32([[0, 0, 0], [2, 0, 3], [-1, 2, 3], [-1, -2, 3]])
    write_obj(tmp_path / "mill.obj", corners, np.array([[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]]))
    run("drop_cutter.py", "cube", "--cutter", tmp_path / "mill.obj", "--step", 50, "--out", tmp_path)
    heights = np.load(tmp_path / "heights.npy")
    assert heights.shape == (5, 6)
    # Its sides are steeper than the cube's: the tip touches wherever the cube is below it.
    vertices, faces = drop_cutter.cube()
    machine = drop_cutter.Machine((vertices, faces), 50.0)
    expected = exact_heights(Profile(1e-9, 1e-9), vertices.astype(float)[faces], machine.raster.points().reshape(-1, 2))
    inside = np.isfinite(expected)
    assert inside.sum() > 15
    np.testing.assert_allclose(heights.ravel()[inside], expected[inside], atol=1e-6)


def test_bad_tools_are_refused(tmp_path):
    for arguments, problem in (
        (["--diameter", "-1"], "radius: expected a number above 0"),
        (["--holder", "20"], "--holder: expected RADIUS ABOVE"),
        (["--cutter", tmp_path / "mill.stl"], "mill.stl"),
    ):
        command = [sys.executable, EXAMPLES / "drop_cutter.py", "cube", "--out", tmp_path, *map(str, arguments)]
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode == 2 and problem in done.stderr


def test_the_table_has_all_cutters_next_to_their_closed_forms(tmp_path):
    text = run("drop_cutter.py", "cube", "--table", "--step", 60, "--out", tmp_path)
    rows = [row.strip("| ").split(" | ") for row in text.splitlines()[2:]]
    assert [row[0] for row in rows] == list(drop_cutter.CUTTERS)
    assert all(0 < float(row[1]) and float(row[2]) < 1000 for row in rows)


def test_the_turned_cube_has_no_holes():
    vertices, faces = drop_cutter.cube()
    machine, (ball, profile) = drop_cutter.Machine((vertices, faces), 6.9), TOOLS["ball"]  # some places beside the rim
    _, heights, _ = machine.drop(ball)
    expected = exact_heights(profile, vertices.astype(float)[faces], machine.raster.points().reshape(-1, 2))
    over = expected > machine.raster.floor
    assert over.mean() > 0.8
    np.testing.assert_allclose(heights.ravel()[over], expected[over], atol=1e-9)
