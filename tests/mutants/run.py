#!/usr/bin/env python3
"""Makes each mutant of mutants.txt in turn, builds it and runs its tests, of which one must fail.

    tests/mutants/run.py BUILD_FOLDER [NAME_PART...]
    tests/mutants/run.py --texts

Changes the sources and restores them, also when interrupted; so they must be as committed. Prints a line per mutant, with the
tests that noticed it. Exit status 1 if a mutant survives. With --texts only looks whether each mutant's text occurs once.
"""
import pathlib
import re
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]


def read_mutants(path):
    mutants = []
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if line.startswith("#") or not line:
            continue
        key, _, value = line.partition(" ")
        if key == "mutant:":
            mutants.append({"name": value, "-": [], "+": []})
        elif key in ("-", "+"):
            mutants[-1][key].append(value)
        elif key in ("file:", "build:", "tests:"):
            mutants[-1][key[:-1]] = value
        else:
            sys.exit(f"{path}:{number}: expected mutant:, file:, -, +, build: or tests:, got {line!r}")
    return mutants


def run(*command):
    return subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def killers(mutant, build):
    """The tests that fail; "the compiler" if the mutant does not build."""
    if run("cmake", "--build", build, "--target", *mutant["build"].split()).returncode != 0:
        return ["the compiler"]
    output = run("ctest", "--test-dir", build, "-C", "GpuAssisted", "-j", "2", "--timeout", "600", "--stop-on-failure", "-R", mutant["tests"]).stdout
    if "No tests were found" in output:
        sys.exit(f'{mutant["name"]}: no test matches {mutant["tests"]!r}')
    return re.findall(r"^\s*\d+ - (.*) \((?:Failed|Timeout|SEGFAULT|Subprocess aborted|ILLEGAL|NUMERICAL)", output, re.M)


def require_texts(mutants):
    """Ends the program if sources have changed and left a mutant behind, or a field is missing."""
    stale = []
    for mutant in mutants:
        missing = [key for key in ("file", "build", "tests") if key not in mutant]
        count = 0 if missing else (ROOT / mutant["file"]).read_text().count("\n".join(mutant["-"]))
        if missing or count != 1:
            got = f"no {' and no '.join(missing)}" if missing else f"it {count} times in {mutant['file']}"
            stale.append(f"{mutant['name']}: expected its text once in its file, got {got}")
    if stale:
        sys.exit("\n".join(stale))


def main(build, *parts):
    mutants = read_mutants(pathlib.Path(__file__).with_name("mutants.txt"))
    require_texts(mutants)
    if build == "--texts":
        return 0
    dirty = run("git", "status", "--porcelain", "engine", "shaders", "tools").stdout
    if dirty:
        sys.exit(f"expected sources as committed, got\n{dirty}")
    survivors, begun = 0, time.monotonic()
    mutants = [mutant for mutant in mutants if not parts or any(part in mutant["name"] for part in parts)]
    for mutant in mutants:
        path = ROOT / mutant["file"]
        source, old, new = path.read_text(), "\n".join(mutant["-"]), "\n".join(mutant["+"])
        try:
            path.write_text(source.replace(old, new))
            found = killers(mutant, build)
        finally:
            path.write_text(source)
        survivors += not found
        print(f'{"killed  " if found else "SURVIVES"} {mutant["name"]}: {", ".join(found)}', flush=True)
    print(f"{len(mutants)} mutants in {(time.monotonic() - begun) / 60:.0f} minutes, {survivors} survive")
    return 1 if survivors else 0


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
