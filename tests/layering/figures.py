"""Holds the pages to docs/figures.json, which has what was measured: under "PAGE#SECTION", runs with their command, commit,
date, device and figures. Each number of a measured table is a figure of its section, and each figure occurs there.

    figures.py                        checks that, and says which runs are old
    figures.py take SECTION FOLDER    takes the figures of the section's first run anew, from FOLDER/report.json

What a run with "from" takes: of the report's part of that name, for each row, under what its columns `label` hold, the
`columns`. The page is then edited by hand.
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).parents[2]
FIGURES = ROOT / "docs/figures.json"
MEASURED = ("accuracy", "ci", "gallery", "performance", "python", "reliability", "scaling", "stability")
NUMBER = re.compile(r"(?<![\w.^-])(?:\d{1,3}(?:,\d{3})+|\d+)(?:\.\d+)?(?![\w^])")
OLD = 100  # commits


def numbers(text):
    return {float(found.replace(",", "")) for found in NUMBER.findall(re.sub(r"`[^`]*`", "", text))}


def sections(page):
    """Their texts, by anchor."""
    found, anchor = {}, ""
    for line in page.read_text().splitlines():
        if line.startswith("#"):
            anchor = re.sub(r"[^\w -]", "", line.lstrip("# ").lower()).replace(" ", "-")
        found[anchor] = found.get(anchor, "") + line + "\n"
    return found


def cells(text):
    """Those of tables, without the heads and the first column."""
    rows = [line for line in text.splitlines() if line.startswith("|")]
    bodies = [row for row, below in zip(rows, rows[1:] + [""]) if "|--" not in (row[:3], below[:3])]
    return [re.sub(r"\(.*?\)", "", cell).strip() for row in bodies for cell in row.split("|")[2:-1]]


def wrong_tables(figures):
    measured = 0
    for name in MEASURED:
        for anchor, text in sections(ROOT / f"docs/{name}.md").items():
            found = cells(text)
            if not any(NUMBER.fullmatch(cell.rstrip("%")) for cell in found):
                continue
            measured += 1
            section = f"{name}.md#{anchor}"
            if section not in figures:
                yield f"docs/{section} has measured numbers, but figures.json has no such section"
                continue
            known = {number for run in figures[section] for row in run["figures"].values() for number in row}
            for number in sorted(set().union(*map(numbers, found)) - known):
                yield f"docs/{section}: {number:g} is in a table, but not in figures.json"
    if measured < 5:
        yield f"only {measured} measured tables were found"


def wrong_runs(figures):
    for section, runs in figures.items():
        name, _, anchor = section.partition("#")
        page = ROOT / "docs" / name
        text = sections(page).get(anchor) if page.exists() else None
        if text is None:
            yield f"figures.json: {section} is no section of a page"
            continue
        shown = numbers(text)
        for run in runs:
            if not all(run.get(key) for key in ("command", "commit", "date", "device", "figures")):
                yield f"figures.json: {section}: expected a command, a commit, a date, a device and figures"
            elif run["command"] not in page.read_text():
                yield f"docs/{name} does not name the command {run['command']}"
            for label, row in run["figures"].items():
                for number in row:
                    if number not in shown:
                        yield f"docs/{section} lacks {number:g}, which figures.json has as {label}"


def tell_the_old(figures):
    for commit in sorted({run["commit"] for runs in figures.values() for run in runs}):
        git = ["git", "-C", str(ROOT), "rev-list", "--count", f"{commit}..HEAD"]
        count = subprocess.run(git, capture_output=True, text=True, check=False).stdout.strip()
        if count and int(count) > OLD:
            old = ", ".join(section for section, runs in figures.items() if any(run["commit"] == commit for run in runs))
            print(f"warning: {count} commits old ({commit}): {old}")


def rounded(value):
    return float(f"{value:.3g}") if isinstance(value, float) and value < 1000 else round(value)


def take(figures, section, folder):
    report = json.loads((pathlib.Path(folder) / "report.json").read_text())
    run = figures[section][0]
    run |= {key: report[key] for key in ("commit", "date", "device", "processor")}
    wanted = run["from"]
    (part,) = (part for part in report["parts"] if part["name"] == wanted["part"])
    run["figures"] = {
        " ".join(str(row[column]) for column in wanted["label"]): [
            rounded(row[column]) for column in wanted["columns"] if isinstance(row[column], (int, float))
        ]
        for row in part["rows"]
    }


def wrong_taking():
    """Whether take() takes what a run asks for, from a report that has more."""
    run = {"from": {"part": "methods", "label": ["method", "size"], "columns": ["us", "note", "queries"]}, "figures": {"old": [1]}}
    made = {"commit": "c", "date": "d", "device": "e", "processor": "p"}
    rows = [{"method": "fast", "size": 8, "us": 1.2345, "note": "no number", "queries": 12345, "other": 3}]
    parts = [{"name": "other", "rows": []}, {"name": "methods", "rows": rows}]
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "report.json").write_text(json.dumps(made | {"parts": parts}))
        figures = {"page.md#section": [dict(run), "a second run"]}
        take(figures, "page.md#section", folder)
    if figures != {"page.md#section": [run | made | {"figures": {"fast 8": [1.23, 12345]}}, "a second run"]}:
        yield f"take() made of a report {figures}"


def write(figures):
    """A line for each row of figures."""
    text = json.dumps(figures, indent=1, ensure_ascii=False)
    text = re.sub(r"\[\s*((?:[^\[\]{}]|\"[^\"]*\")*?)\s*\]", lambda row: "[" + re.sub(r",\n\s*", ", ", row[1]) + "]", text)
    FIGURES.write_text(text + "\n")


def main():
    figures = json.loads(FIGURES.read_text())
    if sys.argv[1:2] == ["take"]:
        take(figures, *sys.argv[2:])
        write(figures)
        return 0
    wrong = [*wrong_tables(figures), *wrong_runs(figures), *wrong_taking()]
    tell_the_old(figures)
    print("\n".join(wrong) or f"the pages have the figures of {len(figures)} sections of figures.json")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
