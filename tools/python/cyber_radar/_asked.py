"""What was asked, of casts and of moves of chains."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _engine

MOST_REMEMBERED = 100_000  # casts, whose inputs are kept whole, so that parts of them can be shown, too


def first(array: npt.NDArray[Any], shape: tuple[int, ...], count: int) -> npt.NDArray[Any]:
    """A copy of what the first casts of this leading shape have, one after the other."""
    return _of(array, np.arange(count), shape)


def _of(array: npt.NDArray[Any], numbers: npt.NDArray[np.int64], shape: tuple[int, ...]) -> npt.NDArray[Any]:
    return np.array(array[np.unravel_index(numbers, shape)] if shape else array[None], order="C")


@dataclasses.dataclass(frozen=True)
class Asked:
    """What some casts, or moves, of a batch were asked, for a page. Of a large batch, what the page can show, one after
    the other."""

    make_page: Callable[..., str]  #: of a title, the number of answers, names, arrays, records and more
    object_names: dict[int, str]  #: the scene's own
    arrays: dict[str, npt.NDArray[Any]]  #: of the whole batch
    number: npt.NDArray[np.int64]  #: in the batch, in C order
    shape: tuple[int, ...]  #: of the batch
    is_cut: bool = False

    @classmethod
    def of(
        cls,
        make_page: Callable[..., str],
        object_names: dict[int, str],
        arguments: dict[str, Any],
        shape: tuple[int, ...],
    ) -> Asked:
        count = int(np.prod(shape, dtype=np.int64))
        if count <= MOST_REMEMBERED:
            return cls(make_page, object_names, arguments, np.arange(count).reshape(shape), shape)
        kept = _engine.MOST_SHOWN
        arrays = {name: first(array, shape, kept) for name, array in arguments.items()}
        return cls(make_page, object_names, arrays, np.arange(kept), shape, True)

    def __getitem__(self, index: Any) -> Asked | None:
        """None: of a large batch."""
        return None if self.is_cut else dataclasses.replace(self, number=np.asarray(self.number[index]))

    def page(self, title: str, count: int, records: npt.NDArray[Any], *listed: Any) -> str:
        """Of `count` casts, whose first ones have these records."""
        numbers = self.number.reshape(-1)[: records.size]
        shape = (self.number.size,) if self.is_cut else self.shape
        arrays = {name: _of(array, numbers, shape) for name, array in self.arrays.items()}
        places = np.stack(np.unravel_index(numbers, self.shape), axis=-1) if self.shape else np.empty((1, 0))
        names = [", ".join(map(str, place)) or "one" for place in places.tolist()]
        return self.make_page(title, count, names, arrays, records, *listed)
