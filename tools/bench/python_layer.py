#!/usr/bin/env python3
"""What the Python layer costs: the same casts of a box among 30,000 boxes by the package and by the program.

    PYTHONPATH=build/release/python python3 tools/bench/python_layer.py build/release/bin/cyber-radar

The program's time is that of its C++ call, without reading or writing files. Both answer alternately, on all cores.
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np

import cyber_radar


def resident() -> int:
    """Bytes of this process."""
    return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * 4096


def load(file: pathlib.Path) -> tuple[cyber_radar.Scene, dict[str, np.ndarray]]:
    """The query file's only scene, and its queries as the arguments of cast."""
    content = json.loads(file.read_text())
    scene = cyber_radar.Scene()
    meshes = np.array([scene.load_mesh(file.parent / name) for name in content["meshes"]])
    rows = np.loadtxt(file.parent / content["scenes"][0]["instances_file"])
    scene.add(meshes[rows[:, 0].astype(int)], matrices(rows[:, 1:]))
    sensors = np.array([query["sensor"] for query in content["queries"]])
    return scene, {
        "mesh": meshes[sensors[:, 0].astype(int)],
        "poses": matrices(sensors[:, 1:]),
        "displacements": np.array([query["dir"] for query in content["queries"]], float),
        "distances": np.array([query["D"] for query in content["queries"]], float),
    }


def matrices(rows: np.ndarray) -> np.ndarray:
    full = np.zeros((len(rows), 4, 4)) + np.eye(4)
    full[:, :3] = rows.reshape(-1, 3, 4)
    return full


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="cyber-radar")
    parser.add_argument("--boxes", type=int, default=30_000)
    parser.add_argument("--casts", type=int, default=100_000)
    parser.add_argument("--many", type=int, default=1_000_000, help="casts of one large call")
    parser.add_argument("--repeat", type=int, default=5)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        written = ["workload", "table1", "--boxes", options.boxes, "--sensors", options.casts, "--shape", "box"]
        subprocess.run([options.program, *map(str, written), "--out", folder], check=True, capture_output=True)
        file, stats = pathlib.Path(folder) / "queries.json", pathlib.Path(folder) / "stats.json"
        scene, arguments = load(file)
        out = scene.cast(**arguments, mode="reference")
        of_package, of_program = [], []
        for _ in range(options.repeat):
            start = time.perf_counter()
            scene.cast(**arguments, mode="reference", out=out)
            of_package.append(time.perf_counter() - start)
            command = ["query", file, "--mode", "reference", "--repeat", "1", "--stats", stats]
            command += ["--out", stats.with_suffix(".jsonl")]
            subprocess.run([options.program, *map(str, command)], check=True, capture_output=True)
            of_program.append(json.loads(stats.read_text())["sweep_ms"] / 1e3)
        package, program = statistics.median(of_package), statistics.median(of_program)
        ratio = statistics.median(a / b for a, b in zip(of_package, of_program))
        print(f"{len(out.distance)} casts: package {package:.3f} s, C++ {program:.3f} s, of pairs {ratio:.3f}")

        tiles = -(-options.many // len(out.distance))
        many = {name: np.concatenate([array] * tiles)[: options.many] for name, array in arguments.items()}
        before, start = resident(), time.perf_counter()
        casts = scene.cast(**many, mode="reference")
        seconds, grown = time.perf_counter() - start, resident() - before
        print(f"{len(casts.distance)} casts in one call: {seconds:.2f} s, memory grows by {grown / 1e6:.0f} MB")


if __name__ == "__main__":
    sys.exit(main())
