"""Batches as arrays: numpy writes the queries and reads the answers, without this project's code."""

import csv
import json
import os
import subprocess

import numpy as np
import pytest

from conftest import random_poses, write_obj

STATUS = ["hit", "clear", "overlap", "undecided", "invalid"]
TIER = ["select", "sampled", "contact", "reference"]
FEATURE = [None, "vertex", "edge", "face"]


def run(folder, *arguments) -> subprocess.CompletedProcess:
    return subprocess.run([os.environ["RADAR_PROGRAM"], *arguments], capture_output=True, text=True, cwd=folder)


def answer(folder, *arguments) -> bytes:
    done = run(folder, "query", "q.json", "--out", "out", *arguments)
    assert done.returncode == 0, done.stderr
    return (folder / "out").read_bytes()


def refusal(folder, *arguments) -> str:
    before = sorted(folder.iterdir())
    done = run(folder, "query", "q.json", "--out", "out.npy", *arguments)
    assert done.returncode == 2
    assert sorted(folder.iterdir()) == before
    return done.stderr


def write_world(folder, **queries):
    """Two scenes of boxes, of which the second has one more."""
    write_obj(folder / "box.obj")
    poses = random_poses(np.random.default_rng(3), 30, 10)
    instances = [[0, *pose[:3].ravel().tolist()] for pose in poses]
    scenes = [{"id": "a", "instances": instances[1:]}, {"id": "b", "base": 0, "instances": instances[:1]}]
    file = {"format": "cyber-radar-queries-1", "meshes": ["box.obj", "box.obj"], "scenes": scenes, **queries}
    (folder / "q.json").write_text(json.dumps(file))


def some_arrays(count: int) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(count)
    return {
        "mesh": rng.integers(0, 2, count),
        "pose": random_poses(rng, count, 10)[:, :3, :].copy(),
        "dir": rng.normal(size=(count, 3)),
        "D": rng.uniform(0, 6, count),
        "scene": rng.integers(0, 2, count, dtype=np.uint8),
        "batch": rng.integers(0, 3, count, dtype=np.int16),
        "mask": rng.integers(1, 2**32, count, dtype=np.uint32),
        "any_hit": rng.integers(0, 4, count) == 0,
        "speed": np.where(rng.integers(0, 2, count) == 0, np.nan, 2.5),
        "ignore_leaving": rng.integers(0, 2, count) == 0,
        "slack": np.where(rng.integers(0, 2, count) == 0, np.nan, 1e-12),
        "tolerance": np.where(rng.integers(0, 2, count) == 0, np.nan, 1e-3),
        "clearance": np.where(rng.integers(0, 3, count) == 0, 0.125, 0).astype(np.float32),
        "exclude": rng.integers(-1, 29, (count, 2)),
        "mode": rng.integers(1, 3, count, dtype=np.int8),
    }


def chosen(count: int, *names: str) -> dict[str, np.ndarray]:
    arrays = some_arrays(count)
    return {name: arrays[name] for name in names}


def change(name: str, value, arrays=None):
    """Arrays with one of them replaced, or left out."""
    arrays = arrays or chosen(20, "mesh", "pose", "dir", "D")
    return {key: array for key, array in (arrays | {name: value}).items() if array is not None}


def save(file, arrays: dict[str, np.ndarray]) -> None:
    """As one array, with a column for each."""
    rows = np.zeros(len(next(iter(arrays.values()))), [(name, a.dtype, a.shape[1:]) for name, a in arrays.items()])
    for name, array in arrays.items():
        rows[name] = array
    np.save(file, rows)


def as_queries(arrays: dict[str, np.ndarray]) -> list[dict]:
    """The same queries in JSON."""
    queries = []
    for i in range(len(arrays["mesh"])):
        query = {"id": str(i), "scene": 0, "sensor": [int(arrays["mesh"][i]), *arrays["pose"][i].ravel().tolist()]}
        for name, array in arrays.items():
            value = array[i].tolist()
            if name in ("mesh", "pose") or value != value:
                continue
            if name == "exclude":
                value = [one for one in value if one >= 0]
            if name == "mode":
                value = ["sampled", "contact", "reference"][value]
            if name == "hits" and value == 0:
                value = "all"
            if name.startswith("turn_"):
                query.setdefault("turn", {})[name[5:]] = value
            else:
                query[name] = value
        if "angle" not in query.get("turn", {"angle": 0}):
            del query["turn"]
        queries.append(query)
    return queries


def test_arrays_are_answered_as_the_same_queries_in_json(tmp_path):
    arrays = some_arrays(500)
    write_world(tmp_path, queries=as_queries(arrays))
    expected = answer(tmp_path)
    save(tmp_path / "q.npy", arrays)
    write_world(tmp_path, queries_file="q.npy")
    assert answer(tmp_path) == expected
    arrays = chosen(500, "mesh", "pose", "dir", "D") | {"hits": np.arange(500) % 3}
    save(tmp_path / "q.npy", arrays)
    listed = answer(tmp_path)
    write_world(tmp_path, queries=as_queries(arrays))
    assert answer(tmp_path) == listed


def test_steps_are_arrays_of_motions(tmp_path):
    arrays = some_arrays(100)
    motions = arrays["dir"].astype(np.float32)
    steps = {"mesh": arrays["mesh"], "pose": arrays["pose"], "motion": motions, "speed": arrays["speed"]}
    save(tmp_path / "q.npy", steps)
    write_world(tmp_path, queries_file="q.npy")
    found = answer(tmp_path)
    write_world(tmp_path, queries=as_queries(steps))
    assert answer(tmp_path) == found


def turn_arrays(count: int) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(67)
    return {
        "turn_axis": rng.normal(size=(count, 3)).astype(np.float32),
        "turn_angle": rng.uniform(-3, 3, count),
        "turn_centre": rng.uniform(-5, 5, (count, 3)),
    }


def test_turns_are_arrays_beside_motions_or_alone(tmp_path):
    places = chosen(100, "mesh", "pose", "tolerance")
    turns = turn_arrays(100)
    some_turns = {**turns, "turn_angle": np.where(np.arange(100) % 3 == 0, np.nan, turns["turn_angle"])}
    for queries in (places | turns, places | some_turns | {"motion": some_arrays(100)["dir"]}):
        save(tmp_path / "q.npy", queries)
        write_world(tmp_path, queries_file="q.npy")
        found = answer(tmp_path)
        write_world(tmp_path, queries=as_queries(queries))
        assert answer(tmp_path) == found
        assert {json.loads(line)["status"] for line in found.splitlines()} >= {"hit", "clear"}


@pytest.mark.parametrize(
    "name, value, words",
    [
        ("turn_axis", None, "q.npy: turn_axis: expected this column, which is missing"),
        ("turn_angle", None, "q.npy: turn_angle: expected this column, which is missing"),
        ("turn_centre", None, "q.npy: turn_centre: expected this column, which is missing"),
        ("turn", np.zeros(9), "q.npy: turn: expected one of the columns mesh, pose, motion, turn_axis, turn_angle, turn_c"),
        ("turn_axis", np.zeros((9, 4)), "q.npy: turn_axis: expected float32 or float64 of shape (3,), got float64 of"),
        ("turn_axis", np.zeros((9, 3)), "q.npy: turn_axis[0]: expected a vector that is not zero"),
        ("turn_axis", np.full((9, 3), np.inf), "q.npy: turn_axis[0]: expected finite numbers, got inf"),
        ("turn_angle", np.full(9, np.nan), 'q.npy: turn_angle[0]: expected a finite number, or nan beside "motion"'),
        ("turn_angle", np.full(9, -1e5), "q.npy: turn_angle[0]: expected a number of at most 2^16"),
        ("turn_angle", np.full(9, -np.inf), "q.npy: turn_angle[0]: expected finite numbers, got -inf"),
        ("turn_centre", np.full((9, 3), 1e300), "q.npy: turn_centre[0]: expected numbers of at most 2^800"),
        ("motion", np.full((9, 3), 1e250), "q.npy: motion[0]: expected numbers of at most 2^800 beside a turn"),
        ("D", np.zeros(9), 'q.npy: turn_angle: expected either "dir" and "D" or "turn_angle", got both'),
        ("speed", np.ones(9), "q.npy: speed[0]: expected none beside a turn"),
        ("mode", np.zeros(9, np.uint8), 'q.npy: mode[0]: expected contact or reference, as "turn" needs'),
    ],
)  # fmt: skip
def test_bad_columns_of_turns_are_refused_by_name_and_index(tmp_path, name, value, words):
    save(tmp_path / "q.npy", change(name, value, chosen(9, "mesh", "pose") | turn_arrays(9)))
    write_world(tmp_path, queries_file="q.npy")
    assert words in refusal(tmp_path)


@pytest.mark.parametrize("mode", ["contact", "sampled"])
def test_records_and_tables_say_what_lines_say(tmp_path, mode):
    arrays = some_arrays(300)
    if mode == "sampled":
        arrays = {name: arrays[name] for name in ("mesh", "pose", "dir", "D", "speed", "any_hit")}
    queries = as_queries(arrays)
    queries[0]["id"], queries[1]["id"], queries[2]["id"] = 'a "b", c\nd', "\r", ","
    write_world(tmp_path, queries=queries)
    lines = [json.loads(line) for line in answer(tmp_path, "--mode", mode).splitlines()]
    for file in ("a.npy", "a.csv"):
        assert run(tmp_path, "query", "q.json", "--mode", mode, "--out", file).returncode == 0
    records = np.load(tmp_path / "a.npy")
    with open(tmp_path / "a.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file, strict=True))
    assert len(rows) == len(records) == 300 and np.array_equal(records["query"], np.arange(300))
    assert len(set(records["status"])) > 1
    codes = {"status": STATUS, "tier": TIER, "feature_a": FEATURE, "feature_b": FEATURE, "detected": [False, True, None]}
    words = {"None": "", "True": "true", "False": "false"}
    for record, row, line in zip(records, rows, lines):
        for name in set(records.dtype.names) - {"query"}:
            value, expected = record[name], line.get(name)
            if name in codes:
                assert codes[name][value] == expected, name
            elif expected is None and name in {*line, "time", "paper_min_l"}:
                assert np.all((value == -1) | np.isnan(value)), name
            elif expected is not None:
                assert np.array_equal(value, expected), name
        cells = {"id": line["id"]}
        for name, value in line.items():
            vector = name in ("point", "normal", "sensor_point")
            values = {f"{name}_{axis}": value and value["xyz".index(axis)] for axis in "xyz"} if vector else {name: value}
            cells |= {key: words.get(repr(one), one) for key, one in values.items()}
        for name, text in row.items():
            expected = cells.get(name, "")
            assert text == expected if isinstance(expected, str) else float(text) == expected, name
        assert set(cells) <= set(row)
    for command in (("compare", "a.csv", "out"), ("view", "q.json", "a.csv", "--out", "a.html")):
        assert "a.csv: expected lines of JSON, or records in a file .npy, got a table" in run(tmp_path, *command).stderr


@pytest.mark.parametrize("ending", ["npy", "csv"])
def test_shards_and_resumed_runs_give_the_same_records(tmp_path, ending):
    if ending == "npy":
        save(tmp_path / "q.npy", some_arrays(1000))
        write_world(tmp_path, queries_file="q.npy")
    else:
        queries = as_queries(some_arrays(1000))
        write_world(tmp_path, queries=[{**query, "id": f'"{i}"\n,'} for i, query in enumerate(queries)])
    assert run(tmp_path, "query", "q.json", "--out", f"whole.{ending}").returncode == 0
    whole = (tmp_path / f"whole.{ending}").read_bytes()
    for i in range(3):
        assert run(tmp_path, "query", "q.json", "--out", f"part-{i}.{ending}", "--shard", f"{i}/3").returncode == 0
    part = (tmp_path / f"part-1.{ending}").read_bytes()
    parts = [f"part-{i}.{ending}" for i in (2, 0, 1)]
    assert run(tmp_path, "merge", *parts, "--out", f"merged.{ending}").returncode == 0
    assert (tmp_path / f"merged.{ending}").read_bytes() == whole
    # An interrupted shard: within a record.
    (tmp_path / f"part-1.{ending}.partial").write_bytes(part[: len(part) // 2 + 5])
    assert run(tmp_path, "query", "q.json", "--out", f"part-1.{ending}", "--shard", "1/3", "--resume").returncode == 0
    assert (tmp_path / f"part-1.{ending}").read_bytes() == part


def test_numpy_reads_what_workload_writes(tmp_path):
    for folder, binary in (("lines", []), ("arrays", ["--binary"])):
        made = run(
            tmp_path, "workload", "figure7", "--teapots", "3", "--boxes", "20", "--steps", "4", "--out", folder, *binary
        )
        assert made.returncode == 0, made.stderr
    arrays = np.load(tmp_path / "arrays/queries.npy")
    queries = json.loads((tmp_path / "lines/queries.json").read_text())["queries"]
    assert arrays["dir"].tolist() == [query["dir"] for query in queries]
    assert arrays["scene"].tolist() == [query["scene"] for query in queries]
    found = []
    for folder in ("lines", "arrays"):
        done = run(tmp_path, "query", f"{folder}/queries.json")
        assert done.returncode == 0, done.stderr
        found.append([json.loads(line) for line in done.stdout.splitlines()])
    assert [{**line, "id": ""} for line in found[0]] == [{**line, "id": ""} for line in found[1]]


def with_value(name: str, index, value) -> np.ndarray:
    array = some_arrays(20)[name].copy()
    array[index] = value
    return array


@pytest.mark.parametrize(
    "name, value, words",
    [
        ("mesh", None, "q.npy: mesh: expected this column, which is missing"),
        ("D", None, "q.npy: D: expected this column, which is missing"),
        ("d", np.zeros(20), "q.npy: d: expected one of the columns mesh, pose, motion, turn_axis, turn_a"),
        ("mesh", np.zeros(20), "q.npy: mesh: expected integers, got float64"),
        ("pose", np.zeros((20, 4, 4)), "q.npy: pose: expected float32 or float64 of shape (3, 4), got float64 of shape (4, 4)"),
        ("D", np.zeros((20, 1)), "q.npy: D: expected float32 or float64, got float64 of shape (1,)"),
        ("any_hit", np.zeros(20, np.uint8), "q.npy: any_hit: expected booleans, got uint8"),
        ("D", np.zeros(20, ">f8"), "q.npy: D: expected little-endian numbers"),
        ("D", np.zeros(20, np.float16), "q.npy: D: expected float32, float64, integers or booleans, got the type f2"),
        ("D", np.zeros(20, "U3"), "q.npy: D: expected float32, float64, integers or booleans, got the type U3"),
        ("D", np.zeros(20, [("a", "f8")]), "q.npy: expected columns of plain numbers, got ('D', [('a'"),
        ("D", with_value("D", 7, np.nan), "q.npy: D[7]: expected finite numbers, got nan"),
        ("D", with_value("D", 7, -1), "q.npy: D[7]: expected a number of 0 or more, got -1"),
        ("dir", with_value("dir", 3, 0), "q.npy: dir[3]: expected a vector that is not zero"),
        ("dir", with_value("dir", (3, 1), np.inf), "q.npy: dir[3]: expected finite numbers, got inf"),
        ("mesh", with_value("mesh", 5, 2), "q.npy: mesh[5]: expected a whole number that names one of the 2 meshes"),
        ("mesh", with_value("mesh", 5, -1), "q.npy: mesh[5]: expected a whole number that names one of the 2 meshes"),
        ("pose", with_value("pose", 9, 1), "q.npy: pose[9]: expected"),
        ("scene", np.arange(20), "q.npy: scene[2]: expected a whole number that names one of the 2 scenes"),
        ("exclude", np.full((20, 1), 29), "q.npy: exclude[0]: expected -1 or a whole number"),
        ("mode", np.full(20, 3), "q.npy: mode[0]: expected 0 for sampled"),
        ("mask", np.full(20, 2**32), "q.npy: mask[0]: expected a whole number from 0 to 4294967295"),
        ("speed", np.zeros(20), "q.npy: speed[0]: expected a finite number above 0, or nan for none, got 0"),
        ("slack", np.full(20, -1.0), "q.npy: slack[0]: expected a finite number of 0 or more, or nan"),
        ("motion", np.zeros((20, 3)), "q.npy: motion: expected either"),
        ("hits", np.full(20, -1), "q.npy: hits[0]: expected a whole number from 1 to 4294967294, or \"all\", which is 0"),
        ("hits", np.full(20, 2), "out.npy: expected another file than .npy"),
    ],
)  # fmt: skip
def test_bad_columns_are_refused_by_name_and_index(tmp_path, name, value, words):
    save(tmp_path / "q.npy", change(name, value))
    write_world(tmp_path, queries_file="q.npy")
    assert words in refusal(tmp_path)


@pytest.mark.parametrize("size", [0, 3, 5, 6, 7])
def test_numbers_of_odd_sizes_are_refused(tmp_path, size):
    """They were read as numbers of eight bytes, beyond the array."""
    write_world(tmp_path, queries_file="q.npy")
    save(tmp_path / "q.npy", some_arrays(20))
    whole = (tmp_path / "q.npy").read_bytes()
    (tmp_path / "q.npy").write_bytes(whole.replace(b"('mesh', '<i8')", b"('mesh', '<u%d')" % size))
    assert f"q.npy: mesh: expected float32, float64, integers or booleans, got the type u{size}" in refusal(tmp_path)


def test_columns_may_have_gaps_between_them(tmp_path):
    arrays = some_arrays(50)
    save(tmp_path / "q.npy", arrays)
    write_world(tmp_path, queries_file="q.npy")
    expected = answer(tmp_path)
    rows = np.load(tmp_path / "q.npy")
    aligned = np.zeros(50, np.dtype([(name, rows.dtype[name]) for name in reversed(rows.dtype.names)], align=True))
    for name in rows.dtype.names:
        aligned[name] = rows[name]
    assert aligned.dtype.itemsize > rows.dtype.itemsize
    np.save(tmp_path / "q.npy", aligned)
    assert answer(tmp_path) == expected


def test_damaged_files_are_refused(tmp_path):
    write_world(tmp_path, queries_file="q.npy")
    assert "q.npy: expected an .npy file, got no such file" in refusal(tmp_path)
    save(tmp_path / "q.npy", change("D", np.arange(20.0)))
    whole = (tmp_path / "q.npy").read_bytes()
    for length in (0, 10, len(whole) // 2, len(whole) - 1):
        (tmp_path / "q.npy").write_bytes(whole[:length])
        assert "q.npy: expected" in refusal(tmp_path)
    for place in np.random.default_rng(1).integers(0, 300, 60).tolist():
        (tmp_path / "q.npy").write_bytes(whole[:place] + bytes([whole[place] ^ 4]) + whole[place + 1 :])
        done = run(tmp_path, "query", "q.json")
        assert done.returncode == 0 or (done.returncode == 2 and "q.npy: " in done.stderr), (place, done.stderr)
    for wrong in (b"no array", b"\x93NUMPY\x01\x00\xff\xff{}"):
        (tmp_path / "q.npy").write_bytes(wrong)
        assert "q.npy: expected an array in numpy's format .npy" in refusal(tmp_path)
    np.save(tmp_path / "q.npy", np.zeros((20, 3)))
    assert "q.npy: expected a structured array of one dimension, got {'descr': '<f8'" in refusal(tmp_path)
    write_world(tmp_path, queries_file="q.npy", queries=[])
    assert "queries_file: expected either" in refusal(tmp_path)
