"""Pages of casts; tests/view looks at such pages in a browser."""

import pathlib
import pickle
import webbrowser

import numpy as np
import pytest

import cyber_radar
from conftest import FACES, at, box, numbers, page_data


def row() -> tuple[cyber_radar.Scene, int]:
    """Unit cubes at x = 5, 10, 15 with ids 0, 2, 3."""
    scene = cyber_radar.Scene()
    cube = scene.add_mesh(box(1, 1, 1), FACES)
    ids = scene.add(cube, at([[5, 0, 0], [0, 50, 0], [10, 0, 0], [15, 0, 0]]))
    scene.remove(ids[1])
    return scene, cube


def test_a_page_has_the_casts_and_the_scene(tmp_path):
    scene, cube = row()
    starts = at([[[0, 0, 0], [0, 3, 0]], [[8, 0, 0], [np.nan, 0, 0]]])
    casts = scene.cast(cube, starts, [20.0, 0, 0], exclude_from_each=np.array([[[2], [-1]], [[-1], [-1]]]), mask=3)
    file = casts.show(tmp_path / "page.html", title="<b> & c")
    assert file == tmp_path / "page.html" and list(tmp_path.iterdir()) == [file]
    shown = page_data(file)
    assert shown["title"] == "<b> & c" and shown["notes"] == []
    assert shown["queries"]["id"] == ["0, 0", "0, 1", "1, 0", "1, 1"]
    assert shown["queries"]["ignored"] == {"0": [2]}
    assert list(shown["reasons"]) == ["3"]
    assert numbers(shown["scenes"][0]["number"]).tolist() == [0, 2, 3]
    np.testing.assert_array_equal(numbers(shown["answers"]["t"]), casts.t.ravel())
    assert numbers(shown["answers"]["status"]).tolist() == casts.status.ravel().tolist() == [0, 1, 0, 4]
    np.testing.assert_array_equal(numbers(shown["queries"]["way"]).reshape(4, 3)[:3], [[20, 0, 0]] * 3)
    np.testing.assert_array_equal(numbers(shown["queries"]["at"]).reshape(4, 3)[2], [8, 0, 0])
    # What is chosen is shown alone, under its own place.
    part = page_data(casts[casts.touches].show(tmp_path / "part.html"))
    assert part["queries"]["id"] == ["0, 0", "1, 0"]
    assert numbers(part["answers"]["t"]).tolist() == [4.0, 1.0]


def test_a_page_shows_casts_that_turn(tmp_path):
    scene, cube = row()
    centres = np.array([[0, -5, 0], [np.nan, 0, 0], [0, 2, 0]], float)
    casts = scene.cast(cube, None, [[0, 0, 0], [0, 0, 1], [0, 0, 2]], turns=([0, 0, 1], [-1, 2, 3], centres))
    shown = page_data(casts.show(tmp_path / "page.html"))["queries"]
    assert shown["turns"]["0"] == {"axis": [0, 0, 1], "angle": -1, "centre": [0, -5, 0]}
    assert shown["turns"]["2"] == {"axis": [0, 0, 1], "angle": 3, "centre": [0, 2, 0]}
    assert numbers(shown["way"]).reshape(3, 3).tolist() == [[0, 0, 0], [0, 0, 1], [0, 0, 2]]
    assert numbers(shown["step"]).tolist() == [1, 1, 1] and numbers(shown["whole"]).tolist() == [1, 1, 1]
    part = page_data(casts[2:].show(tmp_path / "part.html"))["queries"]
    assert part["turns"] == {"0": shown["turns"]["2"]}


def test_a_page_knows_what_was_asked_and_left_out(tmp_path):
    scene, cube = row()
    starts = at([[0, 0, 0], [5.5, 0.5, 0.5]])
    casts = scene.cast(cube, starts, [20.0, 0, 0], skip_overlapping=True, clearance=0.25)
    shown = page_data(casts.show(tmp_path / "page.html"))
    assert shown["left"] == {"1": [0]}
    asked = {"clearance": 0.25, "skip_overlapping": True}
    assert shown["queries"]["asked"] == {"0": asked, "1": asked}
    assert page_data(casts[1:].show(tmp_path / "part.html"))["left"] == {"0": [0]}
    whether = page_data(scene.cast(cube, starts, [20.0, 0, 0], any_hit=True).show(tmp_path / "any.html"))
    assert whether["queries"]["asked"] == {"0": {"any_hit": True}, "1": {"any_hit": True}} and whether["left"] == {}


def test_a_page_has_every_option_and_what_is_listed(tmp_path):
    scene, cube = row()
    starts = at([[0, 0, 0], [5.5, 0.5, 0.5], [0, 9, 0]])
    leaving = np.array([False, True, False])
    casts = scene.cast(cube, starts, [20.0, 0, 0], ignore_leaving=leaving, slack=1e-9, hits=np.array([2, 0, 1]))
    shown = page_data(casts.show(tmp_path / "page.html"))
    assert shown["queries"]["asked"] == {
        "0": {"slack": 1e-9, "hits": 2},
        "1": {"ignore_leaving": True, "slack": 1e-9, "hits": "all"},
        "2": {"slack": 1e-9},
    }
    assert numbers(shown["moments"]["object"]).tolist() == casts.hits.object.tolist()
    np.testing.assert_array_equal(numbers(shown["moments"]["t"]), casts.hits.t)
    part = page_data(casts[1:].show(tmp_path / "part.html"))
    assert numbers(part["moments"]["object"]).tolist() == casts.hits.object[casts.hits.of(1)].tolist()


def test_what_is_far_from_the_origin_is_shown_where_it_is(tmp_path):
    scene, offset = cyber_radar.Scene(), np.array([512340.0, 4512350.0, 0.0])
    wall = scene.add_mesh(box(1, 1, 1) + offset + 2.0**-12, FACES)
    scene.add(wall, at([3, 0, 0] - offset))
    shown = page_data(scene.cast(wall, at(-offset), [9, 0, 0], mode="reference").show(tmp_path / "page.html"))
    between = numbers(shown["scenes"][0]["at"]) - numbers(shown["queries"]["at"])
    assert between.tolist() == [3, 0, 0]
    assert np.abs(numbers(shown["queries"]["at"])).max() < 1


def test_distances_are_ways_and_names_and_motions_are_shown(tmp_path):
    scene, cube = row()
    scene.set_motions([0], [0.0, 0, 1])
    casts = scene.cast(cube, None, [0.0, 0, 2], distances=[3.0, 0.0])
    shown = page_data(casts.show(tmp_path / "page.html"))
    np.testing.assert_allclose(numbers(shown["queries"]["way"]), [0, 0, 3, 0, 0, 0])
    assert numbers(shown["scenes"][0]["moving"]).tolist() == [0]
    one = scene.cast(cube, None, [0.0, 0, 0], mode="reference")
    assert page_data(one.show(tmp_path / "one.html"))["queries"]["id"] == ["one"]


def test_what_is_too_much_is_cut_and_the_page_says_so(tmp_path):
    scene, cube = row()
    casts = scene.cast(cube, at(np.zeros((101, 100, 3))), [20.0, 0, 0], mode="reference")
    shown = page_data(casts.show(tmp_path / "page.html"))
    assert shown["queries"]["count"] == 10_000
    assert shown["notes"] == ["The first 10000 of 10100 queries."]


def test_casts_without_their_scene_cannot_be_shown(tmp_path):
    scene, cube = row()
    casts = scene.cast(cube, None, [20.0, 0, 0])
    for other in (pickle.loads(pickle.dumps(casts)), cyber_radar.Casts.empty((3,))):
        with pytest.raises(ValueError, match="show: expected casts that Scene.cast"):
            other.show(tmp_path / "page.html")
        assert other._repr_html_() is None
    with pytest.raises(FileNotFoundError):
        casts.show(tmp_path / "nowhere" / "page.html")
    assert list(tmp_path.iterdir()) == []


def test_a_browser_is_opened_and_notebooks_show_the_page(tmp_path, monkeypatch):
    scene, cube = row()
    casts = scene.cast(cube, None, [20.0, 0, 0])
    opened: list[str] = []
    monkeypatch.setattr(webbrowser, "open", opened.append)
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr("tempfile.tempdir", None)
    file = casts.show()
    assert file.parent == tmp_path and opened == [file.as_uri()]
    assert page_data(pathlib.Path(file))["queries"]["count"] == 1
    cell = casts._repr_html_()
    assert cell.startswith("<iframe srcdoc=") and "<script" not in cell
    large = scene.add_mesh(
        np.random.default_rng(1).normal(size=(300_000, 3)).astype("f4"), np.arange(300_000).reshape(-1, 3)
    )
    scene.add(large, at([0.0, 0, 99]))
    assert "show() opens the page" in casts._repr_html_()


def test_of_a_large_batch_the_first_casts_are_remembered(tmp_path):
    scene, cube = row()
    casts = scene.cast(cube, at(np.zeros((101, 1000, 3))), [20.0, 0, 0], mode="reference")
    shown = page_data(casts.show(tmp_path / "page.html"))
    assert shown["queries"]["count"] == 10_000 and shown["queries"]["id"][-1] == "9, 999"
    assert shown["notes"] == ["The first 10000 of 101000 queries."]
    with pytest.raises(ValueError, match="a part of more than 100,000"):
        casts[0].show(tmp_path / "part.html")
