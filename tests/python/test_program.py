"""The answers are the program's: 100,000 random casts, to the bit."""

import json
import os
import subprocess

import numpy as np
import pytest

import cyber_radar
from conftest import box, random_poses, write_obj
from cyber_radar import Status
from test_chains import arm, configurations

COUNT = 100_000
ENGINE = "/usr/share/assimp/models/glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb"


def ask_program(folder, queries, *arguments) -> list[dict]:
    (folder / "q.json").write_text(json.dumps(queries))
    run = subprocess.run(
        [os.environ["RADAR_PROGRAM"], "query", folder / "q.json", "--mode", "reference", *arguments],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    return [json.loads(line) for line in run.stdout.splitlines()]


def instance(mesh: int, matrix: np.ndarray) -> list:
    return [mesh, *matrix[:3].ravel().tolist()]


def column(answers: list[dict], key: str, absent: float) -> np.ndarray:
    return np.array([absent if answer[key] is None else answer[key] for answer in answers])


def test_random_casts_have_the_bits_of_the_program(tmp_path):
    rng = np.random.default_rng(12)
    objects, poses = random_poses(rng, 60, 16), random_poses(rng, COUNT, 16)
    displacements = rng.normal(size=(COUNT, 3)) * 3
    write_obj(tmp_path / "box.obj")
    lengths = np.array([np.hypot(np.hypot(*d[:2]), d[2]) for d in displacements])
    queries = {
        "format": "cyber-radar-queries-1",
        "meshes": ["box.obj"],
        "scenes": [{"id": "s", "instances": [instance(0, pose) for pose in objects]}],
        "queries": [
            {"id": str(i), "scene": 0, "sensor": instance(0, poses[i]), "dir": displacements[i].tolist(),
             "D": lengths[i]}
            for i in range(COUNT)
        ],
    }  # fmt: skip
    ask_program(tmp_path, queries, "--out", tmp_path / "answers.npy")
    records = np.load(tmp_path / "answers.npy")
    scene = cyber_radar.Scene()
    mesh = scene.load_mesh(tmp_path / "box.obj")
    scene.add(mesh, objects)
    casts = scene.cast(mesh, poses, displacements, distances=lengths, mode="reference")
    for name, array in casts.to_dict().items():
        of_file = np.where(np.isinf(array), np.nan, array) if array.dtype.kind == "f" else array
        np.testing.assert_array_equal(of_file, records[name], name)
    free = casts.t == np.inf
    assert 0.2 < free.mean() < 0.8
    own = scene.cast(mesh, poses, displacements, mode="reference")
    np.testing.assert_allclose(own.t, casts.t, rtol=1e-14)


def test_a_chain_of_a_file_has_the_bits_of_moves(tmp_path):
    """Also about which links are tested with each other."""
    chain, count = arm(), 300
    held, names = chain.scene.objects(), ["rod.obj", "cube.obj"]
    for mesh, name in enumerate(names):
        write_obj(tmp_path / name, *chain.scene.mesh(mesh))
    links = []
    for link in chain.links:
        entry = {"name": link.name, "joint": link.joint, "meshes": []}
        for mesh in link.meshes:
            entry["meshes"].append(instance(*mesh) if isinstance(mesh, tuple) else [mesh])
        if link.parent is not None:
            entry["parent"] = link.parent
        if link.origin is not None:
            entry["origin"] = np.asarray(link.origin)[:3].ravel().tolist()
        if link.joint != "fixed":
            entry["axis"] = list(link.axis)
        if link.variable is not None:
            entry["variable"] = link.variable
        links.append(entry)
    start, end = configurations(1, count), configurations(2, count)
    base = random_poses(np.random.default_rng(3), count, 1)
    asked = [
        {"id": str(i), "scene": 0, "chain": 0, "from": start[i].tolist(), "to": end[i].tolist(),
         "base": base[i, :3].ravel().tolist()}
        for i in range(count)
    ]  # fmt: skip
    queries = {
        "format": "cyber-radar-queries-1", "meshes": names, "chains": [{"links": links}],
        "scenes": [{"instances": [instance(int(mesh), pose) for mesh, pose in zip(held.meshes, held.transforms)]}],
        "queries": asked + [{**query, "id": f"near {i}", "clearance": 0.05} for i, query in enumerate(asked)],
    }  # fmt: skip
    answers = ask_program(tmp_path, queries)
    for first, clearance in ((0, 0.0), (count, 0.05)):
        moves = chain.move(start, end, base, clearance=clearance)
        part = answers[first : first + count]
        assert [answer["status"] for answer in part] == [Status(int(s)).name.lower() for s in moves.status]
        assert [answer["link_name"] or "" for answer in part] == moves.link_names.tolist()
        assert [answer["other_link_name"] or "" for answer in part] == moves.other_link_names.tolist()
        for name in ("link", "mesh", "object", "other_link", "other_mesh", "tri_a", "tri_b"):
            np.testing.assert_array_equal(column(part, name, -1), moves.records[name], name)
        for name in ("fraction", "fraction_lo", "fraction_hi"):
            np.testing.assert_array_equal(column(part, name, np.inf), moves.records[name], name)
        for name in ("point", "normal"):
            of_file = np.array([[np.nan] * 3 if answer[name] is None else answer[name] for answer in part])
            np.testing.assert_array_equal(of_file, moves.records[name], name)
        assert {0, 1} <= set(moves.status.tolist()) and (moves.other_link >= 0).any()


def test_an_assembly_has_the_answers_of_the_program(tmp_path):
    scene = cyber_radar.Scene()
    objects = scene.load_assembly(ENGINE)
    held = scene.objects()
    queries = {
        "format": "cyber-radar-queries-1",
        "meshes": [f"{ENGINE}#{i}" for i in range(67)],
        "scenes": [{"id": "engine", "assembly": ENGINE}],
        "queries": [
            {"id": str(i), "scene": 0, "sensor": instance(i, held.transforms[i]), "exclude": [i], "dir": [0, 1000, 0],
             "D": 1000, "ignore_leaving": True, "skip_overlapping": True, "hits": "all"}
            for i in range(67)
        ],
    }  # fmt: skip
    answers = ask_program(tmp_path, queries)
    casts = scene.cast(
        held.meshes, held.transforms, [0, 1000, 0], distances=1000, exclude_from_each=objects[:, None],
        mode="reference", ignore_leaving=True, skip_overlapping=True, hits="all",
    )  # fmt: skip
    assert (column(answers, "t", np.inf) == casts.t).all()
    for i, answer in enumerate(answers):
        rows = casts.hits.of(i)
        assert [hit["object"] for hit in answer["hits"]] == casts.hits.object[rows].tolist()
        assert [hit["object_name"] for hit in answer["hits"]] == [scene.names[k] for k in casts.hits.object[rows]]
        assert [hit["t"] for hit in answer["hits"]] == casts.hits.t[rows].tolist()
        assert answer["overlapping"] == casts.overlapping.object[casts.overlapping.of(i)].tolist()
    assert len(casts.hits.object) > 100 and len(casts.overlapping.object) > 100


def test_a_file_far_from_the_origin_has_the_answers_of_the_program(tmp_path):
    rng = np.random.default_rng(3)
    offset = np.array([512340.678, 4512350.123, 296.25])
    for name, by in (("far.obj", offset), ("near.obj", np.zeros(3))):
        write_obj(tmp_path / name, box(3, 4, 5) + by)
    starts = random_poses(rng, 500, 30)
    starts[:, :3, 3] += offset
    turned = random_poses(rng, 500, 9)
    turned[:, :3, 3] += offset - turned[:, :3, :3] @ offset
    sensors = np.concatenate([starts, turned])
    meshes = np.repeat([1, 0], 500)
    ways = (
        offset - sensors[:, :3, 3] - np.where(meshes[:, None] == 0, sensors[:, :3, :3] @ offset, 0) + 40 * np.eye(3)[0]
    )
    queries = {
        "format": "cyber-radar-queries-1",
        "meshes": ["far.obj", "near.obj"],
        "scenes": [{"assembly": "far.obj"}, {"instances": [[0], instance(0, turned[0])]}],
        "queries": [
            {"id": f"{scene}/{i}", "scene": scene, "sensor": instance(int(meshes[i]), sensors[i]), "dir": ways[i].tolist(),
             "D": 60}
            for scene in range(2) for i in range(1000)
        ],
    }  # fmt: skip
    answers = ask_program(tmp_path, queries)
    scenes = [cyber_radar.Scene(), cyber_radar.Scene()]
    scenes[0].load_assembly(tmp_path / "far.obj")
    for scene in scenes:
        far, near = scene.load_mesh(tmp_path / "far.obj"), scene.load_mesh(tmp_path / "near.obj")
    scenes[1].add(far, np.stack([np.eye(4), turned[0]]))
    assert scenes[1].cast(0, None, [0, 0, 1], mode="reference").t == 0
    for number, scene in enumerate(scenes):
        loaded = np.array(scene.meshes)[-2:]
        casts = scene.cast(loaded[meshes], sensors, ways, distances=60, mode="reference")
        assert (column(answers[1000 * number : 1000 * (number + 1)], "t", np.inf) == casts.t).all()
        assert 0.2 < casts.touches.mean() < 0.999


def test_a_mesh_file_that_is_broken_is_refused_with_the_programs_words(tmp_path):
    (tmp_path / "a.ply").write_text("ply\nformat ascii 1.0\n")
    with pytest.raises(ValueError, match="a.ply: .*header"):
        cyber_radar.read_mesh(tmp_path / "a.ply")
