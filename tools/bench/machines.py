#!/usr/bin/env python3
"""What ranks gain, and what reading and writing cost: ratios within one run.

    /usr/bin/python3 tools/bench/machines.py [--programs build/release/bin] [--queries 100000] [--large 1000000]

Ranks have one thread each, so two need two free cores. Needs numpy, and mpirun in PATH.
"""

import argparse
import json
import os
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

RANKS = [1, 2]
MPIRUN = {
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "OMPI_MCA_hwloc_base_binding_policy": "none",
}


def run(*command) -> float:
    start = time.perf_counter()
    subprocess.run([str(word) for word in command], check=True, env=os.environ | MPIRUN, stdout=subprocess.DEVNULL)
    return time.perf_counter() - start


def make(programs: Path, folder: Path, *workload) -> Path:
    run(programs / "cyber-radar", "workload", *workload, "--binary", "--out", folder)
    return folder / "queries.json"


def mix(folder: Path, parts: list[Path]) -> Path:
    """One file of several, each its own scene, whose queries stand together."""
    folder.mkdir()
    file = {"format": "cyber-radar-queries-1", "meshes": [], "scenes": [], "queries_file": "queries.npz"}
    arrays: dict[str, list[np.ndarray]] = {name: [] for name in ("mesh", "pose", "dir", "D", "scene")}
    for part in parts:
        one = json.loads(part.read_text())
        scene = one["scenes"][0]
        first = len(file["meshes"])
        lines = (part.parent / scene["instances_file"]).read_text().splitlines()
        instances = [line.split(" ", 1) for line in lines]
        moved = "\n".join(" ".join([str(int(mesh) + first), *rest]) for mesh, *rest in instances)
        (folder / f"{len(file['scenes'])}.inst").write_text(moved)
        queries = np.load(part.parent / "queries.npz")
        arrays["mesh"].append(queries["mesh"] + first)
        arrays["scene"].append(np.full(len(queries["mesh"]), len(file["scenes"])))
        for name in ("pose", "dir", "D"):
            arrays[name].append(queries[name])
        file["meshes"] += [os.path.relpath(part.parent / mesh, folder) for mesh in one["meshes"]]
        file["scenes"].append({"id": part.parent.name, "instances_file": f"{len(file['scenes'])}.inst"})
    np.savez(folder / "queries.npz", **{name: np.concatenate(lists) for name, lists in arrays.items()})
    (folder / "queries.json").write_text(json.dumps(file))
    return folder / "queries.json"


def measure_ranks(programs: Path, name: str, queries: Path, repeats: int):
    folder = queries.parent
    answers = folder / "answers.npy"
    query = (queries, "--mode", "reference", "--out", answers, "--threads", 1, "--stats", folder / "stats.json")
    run(programs / "cyber-radar", "query", *query)
    expected = answers.read_bytes()
    seconds: dict[int, list[float]] = {ranks: [] for ranks in RANKS}
    sweeps: dict[int, list[float]] = {ranks: [] for ranks in RANKS}
    for _ in range(repeats):
        for ranks in RANKS:
            seconds[ranks].append(run("mpirun", "-n", ranks, programs / "cyber-radar-mpi", "query", *query))
            sweeps[ranks].append(json.loads((folder / "stats.json").read_text())["sweep_ms"] / 1e3)
            assert answers.read_bytes() == expected, f"{ranks} ranks gave other answers"
    base, base_sweep = statistics.median(seconds[1]), statistics.median(sweeps[1])
    for ranks in RANKS:
        whole, sweep = statistics.median(seconds[ranks]), statistics.median(sweeps[ranks])
        print(f"{name},{ranks},{whole:.2f},{base / whole:.2f},{sweep:.2f},{base_sweep / sweep:.2f}", flush=True)


def measure_files(programs: Path, folder: Path, queries: int):
    file = make(programs, folder, "table1", "--boxes", 30_000, "--sensors", queries)
    for name in ("answers.npy", "answers.jsonl"):
        stats = folder / "stats.json"
        whole = run(programs / "cyber-radar", "query", file, "--out", folder / name, "--stats", stats)
        took = json.loads(stats.read_text())
        share = (took["load_ms"] + took["write_ms"]) / 10 / whole
        print(
            f"{name},{queries},{whole:.2f},{took['load_ms'] / 1e3:.2f},{took['write_ms'] / 1e3:.2f},{share:.1f}%",
            flush=True,
        )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--programs", type=Path, default=Path("build/release/bin"))
    parser.add_argument("--queries", type=int, default=100_000, help="of the runs with ranks")
    parser.add_argument("--large", type=int, default=1_000_000, help="queries to read and write; 0: none")
    parser.add_argument("--repeats", type=int, default=3, help="the median counts")
    options = parser.parse_args()
    programs = options.programs.resolve()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        costly = options.queries // 2
        equal = make(programs, folder / "equal", "interlocking", "--sensors", options.queries)
        easy = make(programs, folder / "easy", "table1", "--sensors", options.queries - costly)
        hard = make(programs, folder / "hard", "interlocking", "--sensors", costly)
        print("workload,ranks,seconds,times one rank,answering seconds,times one rank")
        measure_ranks(programs, "rings on pegs", equal, options.repeats)
        measure_ranks(programs, "half teapots; then rings", mix(folder / "last", [easy, hard]), options.repeats)
        measure_ranks(programs, "half rings; then teapots", mix(folder / "first", [hard, easy]), options.repeats)
        if options.large > 0:
            print("answers,queries,seconds,waiting for the reader,for the writer,share of both")
            measure_files(programs, folder / "large", options.large)


if __name__ == "__main__":
    main()
