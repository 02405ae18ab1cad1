"""Compiles every kernel with Mesa's compiler for AMD GPUs, which needs none, and holds the result to budgets.txt.

Usage: kernels.py PROGRAM FAMILY..., with PROGRAM cyber-radar and FAMILY the names that releases of Mesa have for one family.
"""

import json
import os
import pathlib
import subprocess
import sys

COLUMNS = {"registers": "VGPRs", "spilled": "Spilled VGPRs", "code": "Code size", "shared": "LDS size", "scratch": "Scratch size"}


def budgets() -> dict[str, dict[str, int]]:
    lines = (pathlib.Path(__file__).parent / "budgets.txt").read_text().splitlines()
    rows = [line.split() for line in lines if line and not line.startswith("#")]
    return {row[0]: dict(zip(COLUMNS, map(int, row[1:]), strict=True)) for row in rows}


def kernels(program: str, families: list[str]) -> list[dict[str, object]]:
    drivers = sorted(pathlib.Path("/usr/share/vulkan/icd.d").glob("radeon_icd*.json"))
    if not drivers:
        sys.exit("expected Mesa's driver for AMD GPUs in /usr/share/vulkan/icd.d (Debian: mesa-vulkan-drivers), found none")
    command = [program, "devices", "--kernels", "--json"]
    for family in families:
        environment = os.environ | {"VK_DRIVER_FILES": str(drivers[0]), "RADV_FORCE_FAMILY": family}
        run = subprocess.run(command, env=environment, stdout=subprocess.PIPE)
        if run.returncode == 0:
            (device,) = json.loads(run.stdout)
            return device["kernels"]
    sys.exit(f"expected the kernels as compiled for {' or '.join(families)}, got none")


def main() -> None:
    program, *families = sys.argv[1:]
    limits, used, wrong = budgets(), set(), []
    for kernel in kernels(program, families):
        name = kernel["kernel"].split()[0]
        used.add(name)
        if name not in limits:
            wrong.append(f"{name} has no row")
            continue
        for column, limit in limits[name].items():
            value = kernel[COLUMNS[column]]
            if value > limit:
                wrong.append(f"{kernel['kernel']}: {column}: expected at most {limit}, got {value:.0f}")
    wrong += [f"{name} is no kernel" for name in limits.keys() - used]
    if wrong:
        sys.exit(f"{families[0]}: budgets.txt does not hold; who needs more says why in the commit:\n  " + "\n  ".join(wrong))


main()
