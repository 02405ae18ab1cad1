"""What casts and scenes are given, checked: a ValueError names the argument."""

from __future__ import annotations

import os
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from . import _engine
from ._arrays import reals, whole_numbers
from ._warnings import RoundingWarning, warn

Mode = Literal["contact", "sampled", "reference"]
MOST_ID = 2**32 - 2
_FLAGS = ("any_hit", "ignore_leaving", "skip_overlapping", "closest", "exit")
_OF_EACH = ("ignore_leaving", "slack", "clearance", "tolerance", "hits")  # options that may differ from cast to cast


def cast_option(value: Any, name: str) -> bool | float | str | None:
    """One value for all casts, whose range the compiled half checks."""
    if name in _FLAGS:
        return one_flag(value, name)
    return value if value is None or isinstance(value, (bool, str)) else one_number(value, name)


def one_flag(value: Any, name: str) -> bool:
    if isinstance(value, bool) or (getattr(value, "dtype", None) == np.bool_ and np.ndim(value) == 0):
        return bool(value)
    raise ValueError(f"{name}: expected True or False, got {value!r}")


def one_number(value: Any, name: str) -> float:
    number = reals(value, name)
    if number.ndim:
        raise ValueError(f"{name}: expected one number, got shape {number.shape}")
    return float(number)


def option_of_each(value: Any, name: str) -> tuple[npt.NDArray[Any], Any] | None:
    """An option with a value for each cast: the values, whose range is checked cast by cast, and one for all casts that
    asks for what any of them asks. None: one value for all casts."""
    if name not in _OF_EACH or np.ndim(value) == 0:
        return None
    if name == "ignore_leaving":
        flags = np.asarray(value)
        if flags.dtype != bool:
            raise ValueError(f"{name}: expected True or False for each cast, got dtype {flags.dtype}")
        return flags, bool(flags.any())
    if name == "hits":
        counts = whole_numbers(value, name, np.uint32, 0, MOST_ID)
        return counts, "all" if (counts == 0).any() else float(counts.max(initial=1))
    numbers = reals(value, name)
    wanted = numbers[np.isfinite(numbers) & (numbers > 0)]
    return numbers, float(wanted.max(initial=0.0)) if name == "clearance" else None


def one_whole_number(value: Any, name: str, least: int, most: int) -> int:
    number = whole_numbers(value, name, np.int64, least, most)
    if number.ndim:
        raise ValueError(f"{name}: expected one whole number, got shape {number.shape}")
    return int(number)


def device_choice(device: Any) -> tuple[int | None, list[int] | None]:
    if device is None:
        return None, None
    if isinstance(device, str):
        if device != "all":
            raise ValueError(f'device: expected a number of devices(), a list of them, or "all", got {device!r}')
        return None, []
    numbers = whole_numbers(device, "device", np.int64, 0, MOST_ID)
    if numbers.ndim > 1 or numbers.size == 0:
        raise ValueError(f'device: expected a number of devices(), a list of them, or "all", got {device!r}')
    return (int(numbers), None) if numbers.ndim == 0 else (None, numbers.tolist())


def mesh_arrays(vertices: Any, faces: npt.ArrayLike | None) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.uint32]]:
    """`faces` may be missing if `vertices` is a mesh of another package."""
    if isinstance(vertices, (str, bytes, os.PathLike)):
        raise ValueError(f"vertices: expected numbers of shape (N, 3), got {vertices!r}; load_mesh() reads a file")
    if faces is None:
        name = "faces" if hasattr(vertices, "faces") else "triangles"
        if not (hasattr(vertices, "vertices") and hasattr(vertices, name)):
            raise ValueError(
                "faces: expected them beside the vertices, or a mesh that has .vertices and .faces or .triangles, "
                f"got {type(vertices).__name__}"
            )
        vertices, faces = vertices.vertices, getattr(vertices, name)
    placed = mesh_vertices(vertices)
    corners = whole_numbers(faces, "faces", np.uint32, 0, MOST_ID + 1, (3,))
    if corners.ndim != 2 or len(corners) == 0 or len(placed) == 0:
        raise ValueError(f"faces: expected shape (M, 3) with a triangle at least, got shape {corners.shape}")
    if (wrong := corners >= len(placed)).any():
        row, got = int(np.argwhere(wrong)[0][0]), int(corners[wrong][0])
        hint = "; are they strips? Each row is a triangle of its own" if got in (2**16 - 1, 2**32 - 1) else ""
        raise ValueError(f"faces[{row}]: expected vertices from 0 to {len(placed) - 1}, got {got}{hint}")
    return placed, corners


def mesh_vertices(value: npt.ArrayLike) -> npt.NDArray[np.float64]:
    given = reals(value, "vertices", (3,))
    if given.ndim != 2:
        raise ValueError(f"vertices: expected shape (N, 3), got shape {given.shape}")
    with np.errstate(over="ignore"):
        fits = np.isfinite(given.astype(np.float32))
    if not fits.all():
        row = int(np.argwhere(~fits)[0][0])
        raise ValueError(f"vertices[{row}]: expected 3 finite numbers that float32 can hold, got {given[row]}")
    return given


def about_base(
    vertices: npt.NDArray[np.float64], faces: npt.NDArray[np.uint32]
) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float64]]:
    """Vertices as floats about a base, and the base."""
    floats, base, change = _engine.float_vertices(vertices, faces)
    if change:
        warn(f"floats, which vertices become, change the mesh's numbers by up to {change:.2g}", RoundingWarning)
    return floats, base


def refuse_one_each(ids: tuple[int, ...], casts: tuple[int, ...]) -> None:
    """Refuses rows of ids if their shape is also that of one id for each cast."""
    fits = len(ids) <= len(casts) and all(n in (1, length) for n, length in zip(ids[::-1], casts[::-1]))
    if fits and ids[-1] > 1:
        raise ValueError(
            f"exclude_from_each: shape {ids} may mean rows of {ids[-1]} ids, or one id for each cast of shape {casts}; "
            "for one each, pass ids[..., None]; for rows, ids[None]"
        )


def regular(matrices: npt.NDArray[np.float64], name: str) -> npt.NDArray[np.float64]:
    """Refuses a matrix that is singular or not finite."""
    wrong = _engine.first_singular(matrices)
    if wrong is not None:
        at, why = wrong
        index = tuple(int(k) for k in np.unravel_index(at, matrices.shape[:-2])) if matrices.ndim > 2 else ()
        raise ValueError(f"{name}{list(index) or ''}: {why}")
    return matrices
