"""Names in comments of the engine and the shaders: each type, function or member must exist in the code."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).parents[2]
COMMENT = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.S)
# Words of prose have no second hump.
NAME = re.compile(r"\b(?:[A-Z][a-z0-9]+(?:[A-Z][A-Za-z0-9]*)+|[a-z]+[A-Z][A-Za-z0-9]*)\b")
# Of other people, and words.
FOREIGN = re.compile(r"Vk|Vma|vma|pEnabledFeatures|AccurateDWPlusDW|SplitMix64|MoltenVK|KiB|NaNs|worldFromWindow$")


def sources(*folders):
    for folder in folders:
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix in (".cpp", ".h", ".glsl", ".txt", ".cmake", ".in", ".py", ".js"):
                yield path, path.read_text()


def main():
    code = set()
    for path, text in sources("engine", "shaders", "tools", "tests"):
        kept = COMMENT.sub(lambda found: " " if found[0].startswith("/") else found[0], text)
        code.update(re.findall(r"\w+", kept))
    gone = []
    for path, text in sources("engine", "shaders"):
        for comment in COMMENT.finditer(text):
            if not comment[0].startswith("/"):
                continue
            line = text.count("\n", 0, comment.start()) + 1
            for found in NAME.finditer(comment[0]):
                name, is_family = found[0], comment[0][found.end() :].startswith("*")
                known = name in code or (is_family and any(other.startswith(name) for other in code))
                if not known and not FOREIGN.match(name):
                    gone.append(f"{path.relative_to(ROOT)}:{line}: {name}")
    print("\n".join(gone) or f"all names of comments are among {len(code)} names of the code")
    return 1 if gone or len(code) < 5000 else 0


sys.exit(main())
