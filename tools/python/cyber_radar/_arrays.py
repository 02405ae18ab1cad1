"""Arguments as the arrays that the engine takes, or a ValueError that names the argument."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

MOST_EXACT = 2**53  # whole numbers up to this are doubles
LEAST_MASK, MOST_MASK = 0, 2**32 - 1


def reals(value: npt.ArrayLike, name: str, inner: tuple[int, ...] = (), also: str = "") -> npt.NDArray[np.float64]:
    """Doubles of shape (..., *inner), adjacent in memory. Numbers that doubles cannot hold are refused. `also`: another
    shape that would do, for messages."""
    array = _array(value, name, inner, "numbers", also)
    if array.dtype.kind not in "fiu" or array.dtype.itemsize > 8:
        raise ValueError(f"{name}: expected numbers of at most double precision, got dtype {array.dtype}")
    if array.dtype.kind in "iu" and array.dtype.itemsize == 8 and ((array > MOST_EXACT) | (array < -MOST_EXACT)).any():
        raise ValueError(f"{name}: expected whole numbers up to 2^53, which doubles can hold, got larger ones")
    return np.asarray(array, dtype=np.float64, order="C")


def whole_numbers(
    value: npt.ArrayLike, name: str, dtype: Any, least: int, most: int, inner: tuple[int, ...] = ()
) -> npt.NDArray[Any]:
    """Whole numbers from `least` to `most`, as `dtype`, of shape (..., *inner). A length of -1 in `inner` is any."""
    array = _array(value, name, inner, "whole numbers")
    if array.size == 0 and not isinstance(value, np.ndarray):
        array = array.astype(dtype)  # an empty list has no type of its own
    if array.dtype.kind not in "iu":
        raise ValueError(f"{name}: expected whole numbers, got dtype {array.dtype}")
    if array.size and (int(array.min()) < least or int(array.max()) > most):
        wrong = array[(array < least) | (array > most)].flat[0]
        raise ValueError(f"{name}: expected whole numbers from {least} to {most}, got {wrong}")
    return np.asarray(array, dtype=dtype, order="C")


def poses(value: npt.ArrayLike, name: str) -> npt.NDArray[np.float64]:
    """Matrices of shape (..., 4, 4), from those or their first three rows. Those with a number that is not finite may
    have any last row."""
    if np.shape(value)[-2:] == (3, 4):
        rows = reals(value, name, (3, 4))
        last = np.broadcast_to(np.array([0.0, 0.0, 0.0, 1.0]), (*rows.shape[:-2], 1, 4))
        return np.concatenate([rows, last], axis=-2)
    matrices = reals(value, name, (4, 4), " or (..., 3, 4)")
    wrong = (matrices[..., 3, :] != (0.0, 0.0, 0.0, 1.0)).any(axis=-1)
    if wrong.any():
        wrong &= np.isfinite(matrices).all(axis=(-2, -1))
    if wrong.any():
        index = tuple(int(i) for i in np.argwhere(wrong)[0])
        row = matrices[index][3]
        raise ValueError(f"{name}{list(index) or ''}: expected the last row 0 0 0 1, got {row}; is it transposed?")
    return matrices


def common_shape(arrays: dict[str, tuple[npt.NDArray[Any], int]]) -> tuple[int, ...]:
    """The leading shape to which all arrays broadcast; each comes with the number of its last dimensions that do not."""
    leading = {name: array.shape[: array.ndim - inner] for name, (array, inner) in arrays.items()}
    try:
        return np.broadcast_shapes(*leading.values())
    except ValueError:
        got = ", ".join(f"{name} {arrays[name][0].shape}" for name, shape in leading.items() if shape)
        raise ValueError(f"expected arguments whose leading shapes broadcast together, got {got}") from None


def _array(value: npt.ArrayLike, name: str, inner: tuple[int, ...], what: str, also: str = "") -> npt.NDArray[Any]:
    lengths = ", ".join(["...", *("K" if length < 0 else str(length) for length in inner)])
    expected = f"{name}: expected {what} of shape ({lengths}){also}"
    if isinstance(value, np.ma.MaskedArray):
        raise ValueError(f"{expected}, got a masked array, whose mask would be lost")
    try:
        array = np.asarray(value)
    except ValueError as error:
        raise ValueError(f"{expected}, got {error}") from None
    fits = array.ndim >= len(inner) and all(
        length in (-1, got) for length, got in zip(inner, array.shape[array.ndim - len(inner) :])
    )
    if not fits:
        raise ValueError(f"{expected}, got shape {array.shape}")
    return array
