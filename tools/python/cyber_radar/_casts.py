"""The answers to casts."""

from __future__ import annotations

import dataclasses
import enum
import operator
import os
import pathlib
from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from ._show import Asked, in_notebook, open_in_browser, page_of, write


class Status(enum.IntEnum):
    """What an answer says: the values of Casts.status."""

    HIT = 0  #: certainly a contact; with any_hit, overlaps at the start, too
    CLEAR = 1  #: certainly none
    OVERLAP = 2  #: the surfaces meet at the start
    UNDECIDED = 3  #: no contact before `lo`; only in mode "sampled" and with a clearance
    INVALID = 4  #: not answered; Casts.reasons says why


class Tier(enum.IntEnum):
    """The stage that produced an answer: the values of Casts.tier."""

    SELECT = 0
    SAMPLED = 1
    CONTACT = 2
    REFERENCE = 3


class Feature(enum.IntEnum):
    """A part of a triangle: the values of Casts.features. Each is the number of its corners."""

    NONE = 0
    VERTEX = 1
    EDGE = 2
    FACE = 3


# Of each array: dtype, and the length of its last dimension if it has one beside the leading shape.
_FIELDS: dict[str, tuple[Any, tuple[int, ...]]] = {
    "distance": (np.float64, ()),
    "lo": (np.float64, ()),
    "hi": (np.float64, ()),
    "fraction": (np.float64, ()),
    "status": (np.uint8, ()),
    "tier": (np.uint8, ()),
    "detected": (np.int8, ()),
    "object": (np.int64, ()),
    "triangles": (np.int64, (2,)),
    "features": (np.uint8, (2,)),
    "point": (np.float64, (3,)),
    "normal": (np.float64, (3,)),
    "gap": (np.float64, ()),
}
_SAMPLED_FIELDS: dict[str, tuple[Any, tuple[int, ...]]] = {
    "paper_min_l": (np.float64, ()),
    "resolution": (np.uint32, ()),
}


_MOST_NAMED = 5  # objects in a line


@dataclasses.dataclass(eq=False, repr=False)
class Casts:
    """Answers as arrays, each of the casts' leading shape (...).

    Distances are in world units along the displacement. A number that an answer does not have is NaN, an id -1; a
    distance is infinite if there is no contact. 117 bytes a cast, and 12 more in mode "sampled".

    An index into the leading shape gives the casts there, with all that they list, as numpy's index would: casts[3],
    casts[:, 0], casts[casts.touches]. len() and iteration go through the first dimension.
    """

    distance: npt.NDArray[np.float64]
    """(...) to first contact: exact to rounding, but `hi` in mode "sampled" and with any_hit, which does not ask for it.
    inf: free. NaN: undecided or invalid."""
    lo: npt.NDArray[np.float64]
    """(...) no contact before this."""
    hi: npt.NDArray[np.float64]
    """(...) a contact by then; inf: none is certain."""
    fraction: npt.NDArray[np.float64]
    """(...) distance / the whole way, 0 to 1."""
    status: npt.NDArray[np.uint8]
    """(...) values of Status."""
    tier: npt.NDArray[np.uint8]
    """(...) values of Tier."""
    detected: npt.NDArray[np.int8]
    """(...) whether any surface lies in the swept volume: 1, 0, or -1 if nobody looked."""
    object: npt.NDArray[np.int64]
    """(...) the object touched; among equal distances the least."""
    triangles: npt.NDArray[np.int64]
    """(..., 2) the triangles that touch: the moving mesh's, the object's."""
    features: npt.NDArray[np.uint8]
    """(..., 2) values of Feature: which parts of the two triangles touch, the smallest that contain every point."""
    point: npt.NDArray[np.float64]
    """(..., 3) where they touch, in world units, at the moment of contact."""
    normal: npt.NDArray[np.float64]
    """(..., 3) of length 1, from the touched surface towards the moving one."""
    gap: npt.NDArray[np.float64]
    """(...) how far apart the surfaces are at `distance`: 0, or with a clearance up to that; at the start the least."""
    paper_min_l: npt.NDArray[np.float64] | None = None
    """(...) mode "sampled": the paper's literal min(L), for comparison; may be negative, too early or too late."""
    resolution: npt.NDArray[np.uint32] | None = None
    """(...) mode "sampled": pixels along the picture's longer side; 0 if none was drawn."""
    hits: Hits | None = None
    """With hits above 1: the first contact with each of the nearest objects; no rows of casts that ask for 1."""
    overlapping: Overlapping | None = None
    """With skip_overlapping: the objects left out."""
    reasons: dict[str, npt.NDArray[np.int64]] = dataclasses.field(default_factory=dict)
    """Why casts are invalid: reason -> their positions, counted in C order."""
    _asked: Asked | None = None

    @classmethod
    def empty(cls, shape: tuple[int, ...], mode: str = "contact") -> Casts:
        """Arrays for answers of this shape, to be filled by Scene.cast(out=...)."""
        return cls(**_new_arrays(shape, mode == "sampled"))

    @property
    def shape(self) -> tuple[int, ...]:
        """The leading shape of all arrays."""
        return self.distance.shape

    @property
    def sensor_point(self) -> npt.NDArray[np.float64]:
        """(..., 3) the moving mesh's point that is nearest to `point`, `gap` away, in world units, at that moment."""
        return self.point + np.where(self.gap > 0, self.gap, 0)[..., None] * np.nan_to_num(self.normal)

    @property
    def touches(self) -> npt.NDArray[np.bool_]:
        """(...) whether there certainly is a contact: status HIT or OVERLAP."""
        return np.isin(self.status, (Status.HIT, Status.OVERLAP))

    def to_dict(self) -> dict[str, npt.NDArray[Any]]:
        """The arrays by name, without what is listed: numpy.savez(file, **casts.to_dict())."""
        arrays = {name: getattr(self, name) for name in _FIELDS | _SAMPLED_FIELDS}
        return {name: array for name, array in arrays.items() if array is not None}

    def show(self, file: str | os.PathLike[str] | None = None, *, title: str = "Casts") -> pathlib.Path:
        """A page for a browser, which shows the casts and their scene as it is now: one file that needs no network. Up
        to 10,000 casts and 100,000 objects; the page says if it leaves some out.

        file: where it goes; None: to a temporary file, which is opened in a browser. Returns where it is.
        """
        page = page_of(self, self._asked, title)
        return open_in_browser(page) if file is None else write(page, file)

    def _repr_html_(self) -> str | None:
        """The page in a cell of a notebook."""
        return in_notebook(page_of(self, self._asked, "Casts"), repr(self)) if self._asked else None

    def __getstate__(self) -> dict[str, Any]:
        """Without the scene, of which show() knows."""
        return {name: value for name, value in self.__dict__.items() if name != "_asked"}

    def __len__(self) -> int:
        if not self.shape:
            raise TypeError("casts of shape () are one cast, without a length")
        return self.shape[0]

    def __iter__(self) -> Iterator[Casts]:
        return (self[i] for i in range(len(self)))

    def __getitem__(self, index: Any) -> Casts:
        places = _leading(index, self.shape)
        part = Casts(**{name: array[places] for name, array in self.to_dict().items()})
        part._asked = self._asked[places] if self._asked else None
        if self.hits is None and self.overlapping is None and not self.reasons:
            return part
        chosen = np.arange(self.distance.size).reshape(self.shape)[places].ravel()
        if self.hits is not None:
            rows, offsets = self.hits._rows_of(chosen)
            arrays: dict[str, Any] = self.hits[rows].to_dict()
            part.hits = Hits(**arrays, offsets=offsets, of_shape=part.shape)
        if self.overlapping is not None:
            rows, offsets = self.overlapping._rows_of(chosen)
            part.overlapping = Overlapping(self.overlapping.object[rows], offsets, part.shape)
        for reason, casts in self.reasons.items():
            if (isin := np.isin(chosen, casts)).any():
                part.reasons[reason] = np.flatnonzero(isin)
        return part

    def __repr__(self) -> str:
        counts = np.bincount(self.status.ravel(), minlength=len(Status))
        words = ", ".join(f"{counts[status]} {status.name.lower()}" for status in Status if counts[status])
        return f"<{type(self).__name__} of shape {self.shape}: {words or 'none'}{self._left_out()}>"

    def _left_out(self) -> str:
        """What skip_overlapping left out: of all but these the answers speak."""
        ids = [] if self.overlapping is None else np.unique(self.overlapping.object).tolist()
        if not ids:
            return ""
        names = self._asked.scene.names if self._asked else {}
        words = [f"{number} ({names[number]})" if number in names else str(number) for number in ids[:_MOST_NAMED]]
        more = f" and {len(ids) - _MOST_NAMED} more" if len(ids) > _MOST_NAMED else ""
        return f" of all but {len(ids)} object{'s' if len(ids) > 1 else ''} left out: {', '.join(words)}{more}"


class _Ragged:
    """Rows of all casts, one after the other: those of cast i, counted in C order, begin at offsets[i] and end before
    offsets[i + 1]."""

    offsets: npt.NDArray[np.int64]
    of_shape: tuple[int, ...]

    def of(self, *index: int) -> slice:
        """The rows of one cast: hits.object[hits.of(3, 1)]. As many whole numbers as the casts have dimensions."""
        shape, called = self.of_shape, f"of({', '.join(map(str, index))})"
        if len(index) != len(shape):
            raise IndexError(f"{called}: expected {len(shape)} whole numbers, as the casts have shape {shape}")
        i = 0
        for k, length in zip(map(operator.index, index), shape):
            if not -length <= k < length:
                raise IndexError(f"{called}: expected a place in the casts' shape {shape}")
            i = i * length + k % length
        return slice(int(self.offsets[i]), int(self.offsets[i + 1]))

    def _rows_of(self, casts: npt.NDArray[np.int64]) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
        """The rows of these casts, one cast after the other, and their offsets."""
        counts = np.diff(self.offsets)[casts]
        offsets = np.concatenate([np.zeros(1, np.int64), np.cumsum(counts)])
        rows = np.arange(offsets[-1]) + np.repeat(self.offsets[casts] - offsets[:-1], counts)
        return rows.astype(np.int64), offsets

    @property
    def cast(self) -> npt.NDArray[np.int64]:
        """(rows,) the cast of each row, counted in C order."""
        return np.repeat(np.arange(len(self.offsets) - 1), np.diff(self.offsets))


@dataclasses.dataclass(eq=False, repr=False)
class Hits(Casts, _Ragged):
    """First contacts with several objects, one row each, for each cast in the order of (distance, object). An index
    gives rows."""

    offsets: npt.NDArray[np.int64] = dataclasses.field(default_factory=lambda: np.zeros(1, np.int64))
    of_shape: tuple[int, ...] = ()


@dataclasses.dataclass(eq=False)
class Overlapping(_Ragged):
    """The objects whose surfaces cross the moving one's at the start, one row each, for each cast ascending."""

    object: npt.NDArray[np.int64]
    offsets: npt.NDArray[np.int64]
    of_shape: tuple[int, ...]


def _leading(index: Any, shape: tuple[int, ...]) -> tuple[Any, ...]:
    """An index into the leading shape as one into arrays that have more dimensions behind it."""
    try:
        np.broadcast_to(False, shape)[index]
    except IndexError as error:
        raise IndexError(f"casts of shape {shape}: {error}") from None
    items = list(index) if isinstance(index, tuple) else [index]
    where = [i for i, item in enumerate(items) if item is Ellipsis]
    if where:
        others = items[: where[0]] + items[where[0] + 1 :]
        items[where[0] : where[0] + 1] = [slice(None)] * (len(shape) - sum(map(_dimensions, others)))
    return (*items, Ellipsis)


def _dimensions(item: Any) -> int:
    """How many dimensions an item of an index takes."""
    if item is None:
        return 0
    array = None if isinstance(item, slice) else np.asarray(item)
    return 1 if array is None or array.dtype != bool else array.ndim


def _new_arrays(shape: tuple[int, ...], sampled: bool) -> dict[str, Any]:
    fields = _FIELDS | _SAMPLED_FIELDS if sampled else _FIELDS
    return {name: np.empty(shape + inner, dtype) for name, (dtype, inner) in fields.items()}


def _arrays_of(casts: Casts, shape: tuple[int, ...], sampled: bool) -> dict[str, Any]:
    """The arrays of `out`, or a ValueError that names the one that cannot take answers of this shape."""
    if not isinstance(casts, Casts):
        raise ValueError(f"out: expected Casts, got {type(casts).__name__}")
    arrays = {}
    for name, (dtype, inner) in (_FIELDS | _SAMPLED_FIELDS if sampled else _FIELDS).items():
        array = getattr(casts, name)
        fits = isinstance(array, np.ndarray) and array.dtype == dtype and array.shape == shape + inner
        if not (fits and array.flags.c_contiguous and array.flags.writeable):
            got = f"{array.dtype} of shape {array.shape}" if isinstance(array, np.ndarray) else type(array).__name__
            raise ValueError(
                f"out.{name}: expected a writeable C-contiguous array of {np.dtype(dtype)} of shape {shape + inner}, "
                f"got {got}" + ("" if not fits else ", not writeable or not C-contiguous")
            )
        arrays[name] = array
    return arrays
