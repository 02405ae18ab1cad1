"""Estimates how many queries a second GPUs allow, from what lanes do and from Mesa's compiler for AMD GPUs: a table.

Usage: estimate.py WORK PROGRAM, with WORK radar_kernel_work, PROGRAM cyber-radar. docs/performance.md states the model.
"""

import os
import pathlib
import re
import subprocess
import sys

# Lanes that issue an instruction in a second, the share of doubles in that, bytes that memory gives in a second.
GPUS = {"NAVI21": (80 * 64 * 2.25e9, 1 / 16, 512e9), "H200": (132 * 128 * 1.98e9, 1 / 2, 4.8e12)}
# How often loops run that depend on numbers: of the features of a pair that may be first, some lane's.
FEATURES = 4
TEXEL = 16
PLACEMENTS = (12 + 19) * TEXEL  # of object and sensor


class Loop:
    """Instructions and instructions on doubles of a loop's body, without the loops inside."""

    def __init__(self, instructions: int, doubles: int, inside: list["Loop"]):
        self.inside = inside
        self.own = (instructions - sum(i.all[0] for i in inside), doubles - sum(i.all[1] for i in inside))
        self.all = (instructions, doubles)


def loops_of(listing: str) -> Loop:
    """A kernel's loops, from the driver's listing of basic blocks."""
    blocks = [part.split("\n") for part in re.split(r"^BB", listing, flags=re.M)[1:]]
    place = {int(lines[0].split(":")[0]): i for i, lines in enumerate(blocks)}
    code = [[line.strip() for line in lines[1:] if re.match(r"\s+[a-z]+_", line)] for lines in blocks]
    spans = {(0, len(code) - 1)}
    for i, lines in enumerate(code):
        for line in lines:
            jump = re.match(r"s_c?branch\w*\s+BB(\d+)", line)
            if jump and place.get(int(jump[1]), i + 1) <= i:
                spans.add((place[int(jump[1])], i))

    def loop(span: tuple[int, int]) -> Loop:
        within = [s for s in spans if s != span and span[0] <= s[0] and s[1] <= span[1]]
        direct = [s for s in within if not any(t != s and t[0] <= s[0] and s[1] <= t[1] for t in within)]
        lines = [line for block in code[span[0] : span[1] + 1] for line in block]
        return Loop(len(lines), sum("_f64" in line for line in lines), [loop(s) for s in sorted(direct)])

    return loop((0, len(code) - 1))


def kernels(program: str) -> dict[str, Loop]:
    (driver,) = sorted(pathlib.Path("/usr/share/vulkan/icd.d").glob("radeon_icd*.json"))
    environment = os.environ | {"VK_DRIVER_FILES": str(driver), "RADV_FORCE_FAMILY": "NAVI21", "RADV_DEBUG": "shaders,nocache"}
    run = subprocess.run([program, "devices", "--kernels"], env=environment, capture_output=True, text=True, check=True)
    names = re.findall(r"^ +(\w+/\w+) ", run.stdout, flags=re.M)
    listings = [part.split("disasm:")[1] for part in run.stderr.split("\nshader: ") if "disasm:" in part]
    return {name: loops_of(listing) for name, listing in zip(names, listings, strict=True)}


def instructions(program: str) -> tuple[list[int], dict[str, tuple[int, int]]]:
    """Of each thing that the search does once, as radar_kernel_work lists them; and of the kernels after it."""
    found = kernels(program)
    walk, work = found["contact/search"].inside[0].inside
    over_objects, _, step = walk.inside
    (child,) = step.inside
    leaves, solve = work.inside
    test, *_ = leaves.inside
    edges, features, *_ = solve.inside
    search = [
        over_objects.all[0],
        walk.own[0],
        child.all[0] + step.own[0] // 2,
        leaves.own[0] + 4 * test.all[0],
        solve.own[0] + 9 * edges.all[0] + FEATURES * features.all[0],
    ]
    return search, {name: found[f"contact/{name}"].all for name in ("encode", "certify", "resolve", "describe")}


def main() -> None:
    work, program = sys.argv[1:]
    search, after = instructions(program)
    run = subprocess.run([work], capture_output=True, text=True, check=True)
    print(run.stdout)
    print(f"instructions, each time: {search}; of kernels, those on doubles second: {after}\n")
    titles = "".join(f" {gpu}: issue | memory |" for gpu in GPUS)
    print(f"| million queries a second | search, instructions |{titles}\n|---|--:|" + "--:|--:|" * len(GPUS))
    for row in re.findall(r"^\| (.*) \|$", run.stdout, flags=re.M)[1:]:
        name, _, *cells, refined = row.split(" | ")
        done = [float(cell.split()[0]) for cell in cells]
        steps = [times / float(cell.split("(")[1].rstrip("%)")) * 100 for times, cell in zip(done, cells, strict=True)]
        searched = sum(times * each for times, each in zip(steps, search, strict=True))
        nodes, objects, pairs, leaves, solved = done
        moved = nodes * 64 + pairs * 96 + (objects + leaves + solved) * PLACEMENTS + leaves * 208 + solved * 104
        cells = [f"{searched:.0f}"]
        for lanes, doubles, memory in GPUS.values():
            issued = searched
            for kernel, (all_of, precise) in after.items():
                times = float(refined) if kernel == "certify" else 1
                issued += times * (all_of - precise + precise / doubles)
            cells += [f"{lanes / issued / 1e6:.3g}", f"{memory / moved / 1e6:.3g}"]
        print(f"| {name} | " + " | ".join(cells) + " |")


main()
