"""Compiles every kernel with Mesa's compiler for AMD GPUs, which needs none: the result must keep to budgets.txt, and have no fused
operation on doubles.

Usage: kernels.py PROGRAM FAMILY..., with PROGRAM cyber-radar and FAMILY the names that releases of Mesa have for one family.
"""

import json
import os
import pathlib
import re
import subprocess
import sys

COLUMNS = {"registers": "VGPRs", "spilled": "Spilled VGPRs", "code": "Code size", "shared": "LDS size", "scratch": "Scratch size"}
# Kernels that may have fused operations on doubles, and why.
FUSED = {"arithmetic/doubles": "the driver's own division, whose bits are compared with the CPU's; where they differ, it is not used"}


def budgets() -> dict[str, dict[str, int]]:
    lines = (pathlib.Path(__file__).parent / "budgets.txt").read_text().splitlines()
    rows = [line.split() for line in lines if line and not line.startswith("#")]
    return {row[0]: dict(zip(COLUMNS, map(int, row[1:]), strict=True)) for row in rows}


def kernels(program: str, families: list[str]) -> tuple[list[dict[str, object]], list[str]]:
    """What the driver tells of each kernel, and its listing of each."""
    drivers = sorted(pathlib.Path("/usr/share/vulkan/icd.d").glob("radeon_icd*.json"))
    if not drivers:
        sys.exit("expected Mesa's driver for AMD GPUs in /usr/share/vulkan/icd.d (Debian: mesa-vulkan-drivers), found none")
    command = [program, "devices", "--kernels", "--json"]
    for family in families:
        environment = os.environ | {"VK_DRIVER_FILES": str(drivers[0]), "RADV_FORCE_FAMILY": family, "RADV_DEBUG": "shaders,nocache"}
        run = subprocess.run(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        if run.returncode == 0:
            (device,) = json.loads(run.stdout)
            _, *listings = re.split("^shader: MESA_SHADER_", run.stderr, flags=re.MULTILINE)
            return device["kernels"], listings
    sys.exit(f"expected the kernels as compiled for {' or '.join(families)}, got none")


def main() -> None:
    program, *families = sys.argv[1:]
    limits, used, wrong = budgets(), set(), []
    compiled, listings = kernels(program, families)
    if len(listings) != len(compiled):
        sys.exit(f"expected a listing of each of {len(compiled)} kernels, got {len(listings)}")
    for kernel, listing in zip(compiled, listings, strict=True):
        name = kernel["kernel"].split()[0]
        used.add(name)
        fused = re.findall(r"\bv_(?:fma|fmac|mad|mac)_f64\b.*", listing)
        if fused and name not in FUSED:
            wrong.append(f"{kernel['kernel']}: expected no fused operation on doubles, got {len(fused)}, the first: {fused[0]}")
        if name not in limits:
            wrong.append(f"{name} has no row")
            continue
        for column, limit in limits[name].items():
            value = kernel[COLUMNS[column]]
            if value > limit:
                wrong.append(f"{kernel['kernel']}: {column}: expected at most {limit}, got {value:.0f}")
    wrong += [f"{name} is no kernel" for name in limits.keys() - used]
    if wrong:
        sys.exit(f"{families[0]}: expected kernels within budgets.txt (who needs more says why in the commit), got\n  " + "\n  ".join(wrong))


main()
