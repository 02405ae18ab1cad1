"""Counts what the CPU's search does for a query, one workload a row: tests, instructions, and what the processor waits for.

Usage: python3 tools/measure/count_work.py PROGRAM [--mesh FILE ...] [--out DIR]

PROGRAM is cyber-radar, built with optimisation. Counts come from valgrind's callgrind, which models a cache of 32 KiB each for
instructions and data, and a last one of 32 MiB; times from the program itself, on one thread. Needs valgrind (Debian's
package of that name). Prints a table in Markdown.
"""

import argparse
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

WORKLOADS = {
    "Table 1's boxes": "table1 --boxes 30000 --shape box --sensors 2048",
    "Table 1's teapots": "table1 --boxes 30000 --sensors 512",
    "Figure 7": "figure7 --teapots 30 --steps 4",
    "interlocking": "interlocking --sensors 64",
    "boxes among 1,000": "scale --boxes 1000 --shape box --sensors 2048",
    "boxes among 1,000,000": "scale --boxes 1000000 --shape box --sensors 2048",
}
# What is called for each test, of as many pairs of nodes, or of triangles, as there are lanes; and for each pair of triangles
# that is decided: how its name begins.
TESTS = {
    "nodes": r"radar::cpu::lanes\w+::NodeTest<\w+>::operator\(\)",
    "leaves": r"radar::cpu::lanes\w+::LeafTest<\w+>::timesOf",
    "decided": r"radar::cpu::FirstContact::consider\(",
}
COSTS = {
    "instructions": ["Ir"],
    "mispredicted": ["Bcm", "Bim"],
    "L1i misses": ["I1mr"],
    "L1d misses": ["D1mr", "D1mw"],
    "last misses": ["ILmr", "DLmr", "DLmw"],
}


def run(*command):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit status {done.returncode}\n{done.stderr[-2000:]}")


def read_profile(path):
    """Calls by function name, and the cost of everything by event."""
    names, calls, called = {}, {}, None
    events, totals = [], []
    for line in path.read_text().splitlines():
        if line.startswith("events:"):
            events = line.split()[1:]
        elif line.startswith("totals:"):
            totals = [int(number) for number in line.split()[1:]]
        elif match := re.match(r"c?fn=\((\d+)\)(?: (.*))?", line):
            if match[2]:
                names[match[1]] = match[2]
            if line.startswith("cfn"):
                called = match[1]
        elif match := re.match(r"calls=(\d+)", line):
            calls[called] = calls.get(called, 0) + int(match[1])
    return {names[key]: count for key, count in calls.items()}, dict(zip(events, totals))


def count(program, queries, profile):
    stats = profile.with_suffix(".json")
    run(
        *["valgrind", "--tool=callgrind", "--branch-sim=yes", "--cache-sim=yes", f"--callgrind-out-file={profile}"],
        *["--I1=32768,8,64", "--D1=32768,8,64", "--LL=33554432,16,64", "--toggle-collect=radar::cpu::Search::run*"],
        *[program, "query", queries, "--mode", "reference", "--threads", 1, "--stats", stats],
        *["--out", profile.with_suffix(".npy")],
    )
    calls, costs = read_profile(profile)
    if not any(name.startswith("radar::cpu::QuerySearch::") for name in calls):
        sys.exit(f"{program}: expected symbols of the engine, such as radar::cpu::QuerySearch::answer")
    answered = json.loads(stats.read_text())["queries"]
    row = {}
    for column, pattern in TESTS.items():
        row[column] = sum(number for name, number in calls.items() if re.match(pattern, name)) / answered
    for column, events in COSTS.items():
        row[column] = sum(costs[event] for event in events) / answered
    return row


def time_of(program, queries, stats):
    """Microseconds a query, the median of nine passes."""
    run(
        *[program, "query", queries, "--mode", "reference", "--threads", 1, "--repeat", 9],
        *["--stats", stats, "--out", stats.with_suffix(".npy")],
    )
    found = json.loads(stats.read_text())
    return 1000 * found["sweep_ms"] / found["queries"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", metavar="PROGRAM", type=Path)
    parser.add_argument("--mesh", nargs="+", default=[], help="one more workload, of these in random poses")
    parser.add_argument("--out", type=Path, help="keep the profiles here")
    options = parser.parse_args()
    workloads = {name: words.split() for name, words in WORKLOADS.items()}
    if options.mesh:
        workloads["meshes"] = ["meshes", "--sensors", "512", "--mesh", *options.mesh]
    columns = [*TESTS, *COSTS]
    print(f"| a query | {' | '.join(columns)} | µs | instructions a ns |")
    print("|---|" + "--:|" * (len(columns) + 2))
    with tempfile.TemporaryDirectory() as folder:
        out = options.out or Path(folder)
        for name, words in workloads.items():
            made = out / re.sub(r"\W+", "-", name)
            run(options.program.resolve(), "workload", *words, "--binary", "--out", made)
            row = count(options.program.resolve(), made / "queries.json", made / "profile")
            us = time_of(options.program.resolve(), made / "queries.json", made / "stats.json")
            numbers = [f"{row[column]:,.0f}" if row[column] >= 100 else f"{row[column]:.1f}" for column in columns]
            print(f"| {name} | {' | '.join(numbers)} | {us:.2f} | {row['instructions'] / us / 1000:.2f} |", flush=True)


if __name__ == "__main__":
    main()
