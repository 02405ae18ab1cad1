"""The heights of the drop cutter, against the exact ones of round cutters on vertices, edges and facets."""

import json

import numpy as np
import pytest

import cyber_radar
from conftest import page_data
from test_examples import run

import drop_cutter  # noqa: E402  (test_examples makes the examples importable)
from cutters import Cutter, Tool, exact_heights  # noqa: E402

BALL, FLAT = Cutter(3, 50, corner=3), Cutter(3, 50)
BULL, CONE = Cutter(3, 50, corner=1), Cutter(3, 50, slope=1.5)


@pytest.mark.parametrize("cutter", [BALL, FLAT, BULL, CONE])
def test_the_exact_height_lies_between_those_of_the_two_polygons(cutter):
    rng = np.random.default_rng(14)
    turned = drop_cutter.cube(side=9.0)
    peak = np.float32([[20, 0, 0], [24, 0, 0], [20, 4, 0], [21, 1, 6]]), np.array(
        [[0, 1, 3], [1, 2, 3], [2, 0, 3], [0, 2, 1]]
    )
    kinds: set[int] = set()
    for vertices, faces in (turned, peak, drop_cutter.relief(cells=8, side=30.0)):
        machine, corners = drop_cutter.Machine((vertices, faces), 1.0, "reference"), vertices.astype(float)[faces]
        low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
        points = rng.uniform(low[:2] - 2, high[:2] + 2, (300, 2))
        expected = np.maximum(exact_heights(cutter, corners, points), low[2])
        bracket = []
        for tool in (cutter.tool(48, outside=False), cutter.tool(48)):
            casts, heights = machine.falls(tool, points, "reference")
            bracket.append(heights)
        assert (bracket[0] <= expected + 1e-9).all() and (expected <= bracket[1] + 1e-9).all()
        touched = casts.touches & (expected > low[2])
        assert 100 < touched.sum()
        # Between vertical walls a small error of the shape may be a large one of the height, but seldom is.
        width = (bracket[1] - bracket[0])[touched]
        assert np.median(width) <= 8 * cutter.polygon_error(48)
        if cutter is BALL:
            assert np.quantile(np.abs(bracket[1] - expected)[touched], 0.95) < 1e-9
        # What is touched lies on the cutter, in the part's triangles of that many corners.
        up = (casts.point[..., 2] - heights)[touched]
        away = np.linalg.norm(casts.point[..., :2] - points, axis=-1)[touched]
        if cutter is BALL:
            np.testing.assert_allclose(np.hypot(away, up - 3), 3, atol=1e-6)
        is_vertex = touched & (casts.feature_b == cyber_radar.Feature.VERTEX)
        assert (np.abs(casts.point[is_vertex][:, None] - vertices).max(axis=-1).min(axis=-1) == 0).all()
        kinds |= set(casts.feature_b[touched].tolist())
    assert len(kinds) > 1


@pytest.mark.parametrize("cutter", [FLAT, BULL, CONE])
def test_the_polygons_of_a_cutter_are_closed_and_inside_and_around_it(cutter):
    core = Cutter(cutter.radius - cutter.corner, cutter.length - 2 * cutter.corner, slope=cutter.slope)
    for outside, sign in ((False, 1), (True, -1)):
        tool = cutter.tool(20, outside)
        assert tool.above == tool.shape.radius == cutter.corner
        check_surface(tool, core, sign)


def test_the_facets_of_a_ball_are_closed_and_around_it():
    check_surface(BALL.facets(20, 6), BALL, -1)


def check_surface(tool: Tool, cutter: Cutter, sign: int) -> None:
    """Closed, wound outwards, and inside the cutter (sign 1) or around it."""
    vertices, faces = tool.shape.vertices, tool.shape.faces
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    assert {tuple(edge) for edge in edges.tolist()} == {tuple(edge) for edge in edges[:, ::-1].tolist()}
    a, b, c = vertices[faces].transpose(1, 0, 2)
    assert np.einsum("ij,ij->", a, np.cross(b, c)) > 0
    # Points of the lower faces: above the cutter's surface if the mesh is inside.
    middle = np.concatenate([vertices[faces].mean(axis=1), vertices, (a + b) / 2])
    middle = middle[middle[:, 2] < cutter.length * 0.9]
    distance = np.linalg.norm(middle[:, :2], axis=1)
    with np.errstate(invalid="ignore"):
        depth = sign * (middle[:, 2] - cutter.height(distance))
    inside = distance <= cutter.radius if sign > 0 else distance < cutter.radius
    assert (depth[inside] >= -1e-12).all()
    assert sign < 0 or inside.all()


def test_a_relief_is_machined(tmp_path):
    (tmp_path / "part.obj").write_text(_obj(*drop_cutter.relief(cells=10, side=20.0)))
    text = run(
        "drop_cutter.py", tmp_path / "part.obj", "--out", tmp_path, "--step", 1, "--diameter", 4, "--segments", 24,
        "--cutter", "bull", "--corner", 0.5, "--holder", 8, 6, "--waterline", 3, "--mode", "reference",
    )  # fmt: skip
    heights, lowest = np.load(tmp_path / "heights.npy"), np.load(tmp_path / "lowest.npy")
    assert heights.shape == (21, 21) and (lowest <= heights).all()
    report = json.loads((tmp_path / "report.json").read_text())
    assert report["points"] == 441 and report["triangles"] == 200 and "points: 441" in text
    assert report["widest_bracket_um"] == pytest.approx(1e3 * (heights - lowest).max())

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


@pytest.mark.parametrize("cutter", [BALL, FLAT, BULL, CONE])
def test_a_round_cutter_cuts_too_deep_at_no_point_of_its_path_and_neither_does_its_holder(cutter):
    vertices, faces = drop_cutter.relief(cells=7, side=12.0)
    machine, tool = drop_cutter.Machine((vertices, faces), 1.0, "reference"), cutter.tool(48)
    heights, _, _ = machine.drop(tool)
    path, work = machine.path(tool, heights, 0.01)
    assert work["moves_too_deep"] > 50 and work["points_inserted"] == len(path) - heights.size > 50
    rng = np.random.default_rng(8)
    move, share = rng.integers(0, len(path) - 1, 200), rng.uniform(0, 1, (200, 1))
    between = (1 - share) * path[move] + share * path[move + 1]
    corners = vertices.astype(float)[faces]
    above = between[:, 2] - exact_heights(cutter, corners, between[:, :2])
    assert (above >= 0).all() and np.median(above) < 0.1

    held, longer = machine.hold(Tool(Cutter(8, 25).tool(24).shape, 5), path, 0.01)
    assert (held > path[:, 2]).any() and 0 <= longer - (held - path[:, 2]).max() < 0.1
    between = between[:60]
    assert (between[:, 2] + longer + 5 >= exact_heights(Cutter(8, 50), corners, between[:, :2])).all()
    assert machine.hold(Tool(Cutter(8, 20).tool(24).shape, 40), path, 0.01)[1] == 0


def test_the_surface_left_is_the_lowest_envelope_and_never_below_the_part():
    part = drop_cutter.relief(cells=10, side=20.0)
    machine = drop_cutter.Machine(part, 1.0, "reference")
    heights, _, _ = machine.drop(BALL.tool(48))
    left = drop_cutter.surface_left(heights, 1.0, BALL, 99.0)
    x, y = np.meshgrid(machine.raster.x, machine.raster.y)
    points = np.stack([x, y], axis=-1).reshape(-1, 2)
    direct = (heights.ravel() + BALL.height(np.linalg.norm(points[:, None] - points, axis=-1))).min(axis=1)
    np.testing.assert_allclose(left.ravel(), np.minimum(direct, 99), atol=1e-12)
    needle = Cutter(1e-9, 50)
    assert (left.ravel() >= exact_heights(needle, part[0].astype(float)[part[1]], points) - 1e-6).all()


def test_any_mesh_may_be_the_cutter_and_depth_pictures_are_compared(tmp_path):
    for name, cutter, segments, above in (("mill", Cutter(2, 9), 4, 0), ("holder", Cutter(20, 21), 8, 9)):
        shape = cutter.tool(segments).shape
        (tmp_path / f"{name}.obj").write_text(_obj(shape.vertices + [0, 0, above], shape.faces))
    text = run(
        "drop_cutter.py", "cube", "--cutter", tmp_path / "mill.obj", "--step", 50, "--compare", "--out", tmp_path,
        "--holder", tmp_path / "holder.obj",
    )  # fmt: skip
    heights = np.load(tmp_path / "heights.npy")
    assert heights.shape == (5, 6)
    held = np.loadtxt(tmp_path / "holder.csv", delimiter=",", skiprows=1, ndmin=2)
    assert len(held) > 0 and (held[:, 3] > held[:, 2]).all()
    modes = json.loads((tmp_path / "report.json").read_text())["modes"]
    assert [row["mode"] for row in modes] == ["reference", "contact", "sampled 32", "sampled 128"]
    assert modes[1]["deepest_error_um"] == 0 and all(row["deepest_error_um"] >= 0 for row in modes)
    assert "um too deep" in text


def test_the_turned_cube_has_no_holes():
    vertices, faces = drop_cutter.cube()
    machine = drop_cutter.Machine((vertices, faces), 6.9, "reference")  # no place a radius beyond the rim
    heights, _, _ = machine.drop(BALL.tool(64))
    points = np.stack(np.meshgrid(machine.raster.x, machine.raster.y), axis=-1).reshape(-1, 2)
    expected = exact_heights(BALL, vertices.astype(float)[faces], points)
    over = np.isfinite(expected)
    assert over.mean() > 0.8
    error = 1e3 * (heights.ravel()[over] - expected[over])
    # Micrometres; more at the rim, where the ball is vertical. A hole would be a hundred times as deep.
    assert (error >= -1e-6).all() and np.quantile(error, 0.9) < 40 and (error < 1000).all()


def _obj(vertices: np.ndarray, faces: np.ndarray) -> str:
    return "".join(
        [f"v {x} {y} {z}\n" for x, y, z in vertices.tolist()] + [f"f {a} {b} {c}\n" for a, b, c in faces + 1]
    )
