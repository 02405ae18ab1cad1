"""Reads compiled shaders: no operation whose result must be rounded by itself may be fused with another (docs/method.md, section 6).

Usage: modules.py FOLDER, of SPIR-V modules. Prints of each module with doubles how many operations on them are NoContraction and how many
are not.
"""

import pathlib
import struct
import sys
from collections import Counter
from collections.abc import Iterator

NAME, EXT_INST, FUNCTION, DECORATE = 5, 12, 54, 71
TYPE_FLOAT, TYPES_OF = 22, (23, 24)  # vectors and matrices
NO_CONTRACTION = 42
SIMPLE = {127: "FNegate", 129: "FAdd", 131: "FSub", 133: "FMul", 136: "FDiv", 140: "FRem", 141: "FMod", 142: "VectorTimesScalar"}
# Drivers may fuse what these are made of, whatever the decoration; so may they that of extended instructions, but for some.
COMPOSED = {143: "MatrixTimesScalar", 144: "VectorTimesMatrix", 145: "MatrixTimesVector", 146: "MatrixTimesMatrix", 147: "OuterProduct", 148: "Dot"}
ONE_OPERATION = {1, 2, 3, 4, 6, 8, 9, 10, 37, 38, 39, 40, 41, 42, 43, 44, 45, 59, 64, 65, 79, 80, 81}  # rounding, signs, least and greatest, bits

# Functions of floats of which some operations are claimed to be exact, or to have the order that is written. (Within a dot product of
# theirs nothing is.)
EXACT_FLOATS = {"addExactly", "addProduct", "boxAround", "coordinatesOf", "differenceInParts", "partsOf", "rowApart"}


def instructions(module: bytes) -> Iterator[tuple[int, list[int]]]:
    words = struct.unpack(f"<{len(module) // 4}I", module)
    at = 5
    while at < len(words):
        yield words[at] & 0xFFFF, list(words[at + 1 : at + (words[at] >> 16)])
        at += words[at] >> 16


def text(words: list[int]) -> str:
    return struct.pack(f"<{len(words)}I", *words).split(b"\0")[0].decode()


class Module:
    def __init__(self, path: pathlib.Path) -> None:
        self.decorated: Counter[int] = Counter()  # operations by the width of their results
        self.undecorated: Counter[int] = Counter()
        self.exact: set[str] = set()  # functions of EXACT_FLOATS
        self.wrong: list[str] = []
        names: dict[int, str] = {}
        width: dict[int, int] = {}  # of a type's components
        fixed: set[int] = set()
        function = ""
        for code, words in instructions(path.read_bytes()):
            if code == NAME:
                names[words[0]] = text(words[1:]).split("(")[0]
            elif code == DECORATE and words[1] == NO_CONTRACTION:
                fixed.add(words[0])
            elif code == TYPE_FLOAT:
                width[words[0]] = words[1]
            elif code in TYPES_OF and words[1] in width:
                width[words[0]] = width[words[1]]
            elif code == FUNCTION:
                function = names.get(words[1], "")
                self.exact |= {function} & EXACT_FLOATS
            elif words and words[0] in width:
                self.check(code, words, width[words[0]], words[1] in fixed, function)

    def check(self, code: int, words: list[int], width: int, is_fixed: bool, function: str) -> None:
        must = width == 64 or function in EXACT_FLOATS
        if code in SIMPLE:
            (self.decorated if is_fixed else self.undecorated)[width] += 1
            if must and not is_fixed:
                self.wrong.append(f"{function}: {SIMPLE[code]} may be fused")
        elif width == 64 and (code in COMPOSED or (code == EXT_INST and words[3] not in ONE_OPERATION)):
            self.undecorated[width] += 1
            self.wrong.append(f"{function}: {COMPOSED.get(code, 'an extended instruction')} consists of operations that may be fused")


def main() -> None:
    (folder,) = sys.argv[1:]
    modules = {path.stem: Module(path) for path in sorted(pathlib.Path(folder).glob("*.spv"))}
    wrong = [f"{name}: {what}" for name, module in modules.items() for what in module.wrong]
    for name, module in modules.items():
        if module.decorated[64] + module.undecorated[64] > 0:
            print(f"{name}: {module.decorated[64]} operations on doubles are NoContraction, {module.undecorated[64]} are not")
    found = set().union(*(module.exact for module in modules.values()))
    wrong += [f"no module has the function {name}" for name in sorted(EXACT_FLOATS - found)]
    if wrong:
        sys.exit(f"{len(wrong)} operations may be fused:\n  " + "\n  ".join(wrong))


main()
