"""Standard headers: what uses a name includes its header, itself or through the project's own headers.

Other headers of one standard library often bring the name along, and those of its next release do not.
"""

import functools
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).parents[2]
FOLDERS = [ROOT / folder for folder in ("engine/include", "engine", "tools", "tests", "shaders", ".")]
SKIPPED = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|R"\((?:.|\n)*?\)"', re.S)
INCLUDE = re.compile(r'^#include [<"]([^>"]+)[>"]', re.M)
NAMES = {
    "algorithm": "all_of any_of clamp copy copy_n count count_if equal fill find find_if is_sorted lower_bound max "
    "max_element min min_element minmax minmax_element none_of nth_element partition remove_if reverse rotate sort "
    "stable_sort transform unique upper_bound",
    "array": "array",
    "atomic": "atomic",
    "bit": "bit_cast bit_ceil bit_width countl_zero countr_zero endian has_single_bit popcount",
    "chrono": "chrono",
    "cmath": "ceil cos exp2 fabs floor fma frexp hypot isfinite isinf isnan ldexp log2 nextafter pow sin sqrt trunc",
    "condition_variable": "condition_variable",
    "cstdint": "u?int(?:8|16|32|64)_t UINT(?:8|16|32|64)_MAX",
    "cstdio": "FILE fflush fopen fprintf fputs printf puts snprintf",
    "cstdlib": "abort exit getenv strtod",
    "cstring": "memcmp memcpy memset strcmp strerror strlen",
    "deque": "deque",
    "filesystem": "filesystem",
    "fstream": "fstream ifstream ofstream",
    "functional": "function",
    "limits": "numeric_limits",
    "map": "map multimap",
    "memory": "make_shared make_unique shared_ptr unique_ptr weak_ptr",
    "mutex": "call_once lock_guard mutex once_flag scoped_lock unique_lock",
    "numeric": "accumulate iota",
    "optional": "optional",
    "random": "mt19937 mt19937_64",
    "set": "set",
    "span": "span",
    "sstream": "istringstream ostringstream stringstream",
    "stdexcept": "invalid_argument logic_error out_of_range runtime_error",
    "string": "string to_string",
    "thread": "this_thread thread",
    "unordered_map": "unordered_map",
    "variant": "variant",
    "vector": "vector",
}


def used(names):
    free = "(?:std::)?" if "u?int" in names else "std::(?:ranges::)?"
    return re.compile(rf"(?<![\w:.>]){free}(?:{'|'.join(names.split())})\b")


USES = {header: used(names) for header, names in NAMES.items()}


@functools.cache
def included(path):
    headers = set()
    for name in INCLUDE.findall(path.read_text()):
        own = next((file for folder in (path.parent, *FOLDERS) if (file := folder / name).is_file()), None)
        headers |= included(own) if own else {name}
    return headers


def main():
    missing, files = [], 0
    for folder in ("engine", "shaders", "tools", "tests"):
        for path in sorted(file for file in (ROOT / folder).rglob("*") if file.suffix in (".cpp", ".h")):
            files += 1
            text = SKIPPED.sub("", path.read_text())
            for header, uses in USES.items():
                if header not in included(path) and (found := uses.search(text)):
                    missing.append(f"{path.relative_to(ROOT)}: {found[0]} without <{header}>")
    print("\n".join(missing) or f"{files} files include what they use of {len(NAMES)} standard headers")
    return 1 if missing or files < 500 else 0


sys.exit(main())
