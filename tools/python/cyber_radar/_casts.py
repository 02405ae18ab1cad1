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

from . import _engine
from ._asked import MOST_REMEMBERED, Asked, first
from ._show import in_notebook, open_in_browser, write


class Status(enum.IntEnum):
    """What an answer says: the values of Casts.status."""

    HIT = 0  #: certainly a contact; with any_hit, overlaps at the start, too
    CLEAR = 1  #: certainly none
    OVERLAP = 2  #: the surfaces meet at the start
    UNDECIDED = 3  #: no contact before `lo`; only in mode "sampled", and with a clearance or turns
    INVALID = 4  #: not answered; Casts.reasons says why


class Tier(enum.IntEnum):
    """The stage that produced an answer: the values of Casts.tier."""

    SELECT = 0
    SAMPLED = 1
    CONTACT = 2
    REFERENCE = 3


class Feature(enum.IntEnum):
    """A part of a triangle: the values of Casts.feature_a and feature_b. Each is the number of its corners."""

    NONE = 0
    VERTEX = 1
    EDGE = 2
    FACE = 3


_MOST_NAMED = 5  # objects in a line


class Answers:
    """Members of `records`, a structured array of a leading shape (...), as attributes."""

    _called = "answers"  #: in messages
    _answered_by = "a scene"
    records: npt.NDArray[Any]
    reasons: dict[str, npt.NDArray[np.int64]]
    _asked: Asked | None

    def __getattr__(self, name: str) -> npt.NDArray[Any]:
        records = self.__dict__.get("records")
        if records is None or name not in records.dtype.names:
            raise AttributeError(f"{type(self).__name__} have no {name!r}")
        return records[name]  # type: ignore[no-any-return]

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.records.dtype.names]

    @property
    def shape(self) -> tuple[int, ...]:
        """The leading shape of all arrays."""
        return self.records.shape

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
        return {name: self.records[name] for name in self.records.dtype.names}

    def show(self, file: str | os.PathLike[str] | None = None, *, title: str = "") -> pathlib.Path:
        """A page for a browser, which shows the answers and their scene as it is now: one file that needs no network. Up
        to 10,000 answers and 100,000 objects; the page says if it leaves some out.

        file: where it goes; None: to a temporary file, which is opened in a browser. Returns where it is.
        """
        page = self._page(title)
        return open_in_browser(page) if file is None else write(page, file)

    def _repr_html_(self) -> str | None:
        """The page in a cell of a notebook."""
        return in_notebook(self._page(""), repr(self)) if self._asked else None

    def _page(self, title: str) -> str:
        """`title`: if empty, what the answers are."""
        if self._asked is None:
            raise ValueError(
                f"show: expected {self._called} that {self._answered_by} has answered, got some that were unpickled or "
                f"made, or a part of more than {MOST_REMEMBERED:,}"
            )
        shown = min(self.records.size, _engine.MOST_SHOWN)
        reasons = {int(i): reason for reason, found in self.reasons.items() for i in found if i < shown}
        records = first(self.records, self.shape, shown)
        listed = self._listed(shown)
        return self._asked.page(title or type(self).__name__, self.records.size, records, reasons, *listed)

    def _listed(self, shown: int) -> tuple[Any, ...]:
        """What the first answers list."""
        return ()

    def __getstate__(self) -> dict[str, Any]:
        """Without the scene, of which show() knows."""
        return {name: value for name, value in self.__dict__.items() if name != "_asked"}

    def __len__(self) -> int:
        if not self.shape:
            raise TypeError(f"{self._called} of shape () are one {self._called[:-1]}, without a length")
        return self.shape[0]

    def __iter__(self) -> Iterator[Any]:
        return (self[i] for i in range(len(self)))

    def __getitem__(self, index: Any) -> Any:
        raise NotImplementedError

    def _chosen(self, index: Any) -> tuple[npt.NDArray[Any], npt.NDArray[np.int64], dict[str, npt.NDArray[np.int64]]]:
        """Records at an index, as numpy's index would give them, a view if it can; where they are, counted in C order,
        and the reasons for those that are invalid."""
        try:
            chosen = np.arange(self.records.size).reshape(self.shape)[index]
        except IndexError as error:
            raise IndexError(f"{self._called} of shape {self.shape}: {error}") from None
        # A single one is an array, too.
        records = self.records[index if np.ndim(chosen) else np.unravel_index(chosen, self.shape) + (...,)]
        chosen = np.ravel(chosen)
        reasons = {}
        for reason, found in self.reasons.items():
            if (isin := np.isin(chosen, found)).any():
                reasons[reason] = np.flatnonzero(isin)
        return records, chosen, reasons

    def __repr__(self) -> str:
        counts = np.bincount(self.status.ravel(), minlength=len(Status))
        words = ", ".join(f"{counts[status]} {status.name.lower()}" for status in Status if counts[status])
        return f"<{type(self).__name__} of shape {self.shape}: {words or 'none'}{self._left_out()}>"

    def _left_out(self) -> str:
        return ""


@dataclasses.dataclass(eq=False, repr=False)
class Casts(Answers):
    """Answers, as views into `records`, an array of numpy's of the casts' leading shape (...). What is null in the words
    below is NaN, and -1 of ids; but t, lo, hi and fraction are inf where there certainly is no contact, and hi where
    none is certain. Lengths are along the displacement (D), in world units; with turns, t, lo and hi are fractions. 120
    bytes a cast, 136 in mode "sampled".

    An index into the leading shape gives the casts there, with all that they list, as numpy's index would: casts[3],
    casts[:, 0], casts[casts.touches]. len() and iteration go through the first dimension.

    """

    records: npt.NDArray[Any]
    """(...) a structured array, whose fields are the members above: numpy.save(file, casts.records)."""
    hits: Hits | None = None
    """With hits above 1: the first contact with each of the nearest objects; no rows of casts that ask for 1."""
    overlapping: Overlapping | None = None
    """With skip_overlapping: the objects left out."""
    closest: Closest | None = None
    """With closest: how near the meshes come to objects on the whole of their ways."""
    exit: Casts | None = None
    """With exit: the last contact on each way, t being hi, after which nothing is touched: the way out of what overlaps.
    CLEAR: nothing is ever touched; t = lo = hi = D: something still is at the end; UNDECIDED, with a clearance: perhaps
    nothing is ever that near, and certainly nothing after hi."""
    reasons: dict[str, npt.NDArray[np.int64]] = dataclasses.field(default_factory=dict)
    """Why casts are invalid: reason -> their positions, counted in C order."""
    _asked: Asked | None = None
    _called = "casts"
    _answered_by = "Scene.cast()"

    @classmethod
    def empty(cls, shape: tuple[int, ...], mode: str = "contact") -> Casts:
        """Arrays for answers of this shape, to be filled by Scene.cast(out=...)."""
        return cls(np.empty(shape, record_type(mode)))

    def _listed(self, shown: int) -> tuple[Any, ...]:
        left_out: dict[int, list[int]] = {}
        if self.overlapping is not None:
            rows, offsets = self.overlapping.object.tolist(), self.overlapping.offsets.tolist()
            left_out = {i: rows[offsets[i] : offsets[i + 1]] for i in range(shown) if offsets[i] < offsets[i + 1]}
        hits = None
        if self.hits is not None:
            offsets = self.hits.offsets[: shown + 1]
            hits = (self.hits.records[: offsets[-1]], offsets)
        moments = (None if casts is None else first(casts.records, self.shape, shown) for casts in (self.closest, self.exit))
        return left_out, hits, *moments

    def __getitem__(self, index: Any) -> Casts:
        records, chosen, reasons = self._chosen(index)
        part = Casts(records, reasons=reasons)
        part._asked = self._asked[index] if self._asked else None
        if self.hits is not None:
            rows, offsets = self.hits._rows_of(chosen)
            part.hits = Hits(self.hits.records[rows], offsets=offsets, of_shape=part.shape)
        if self.overlapping is not None:
            rows, offsets = self.overlapping._rows_of(chosen)
            part.overlapping = Overlapping(self.overlapping.object[rows], offsets, part.shape)
        part.closest = None if self.closest is None else self.closest[index]
        part.exit = None if self.exit is None else self.exit[index]
        return part

    def _left_out(self) -> str:
        """What skip_overlapping left out: of all but these the answers speak."""
        ids = [] if self.overlapping is None else np.unique(self.overlapping.object).tolist()
        if not ids:
            return ""
        names = self._asked.object_names if self._asked else {}
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
    """First contacts with several objects, one row each, for each cast in the order of (t, object). An index
    gives rows."""

    offsets: npt.NDArray[np.int64] = dataclasses.field(default_factory=lambda: np.zeros(1, np.int64))
    of_shape: tuple[int, ...] = ()


@dataclasses.dataclass(eq=False, repr=False)
class Closest(Casts):
    """Where each mesh comes nearest to an object, on the whole of its way, whatever it touches there: t, fraction, object,
    tri_a, tri_b, feature_a, feature_b, point, normal, gap. Where surfaces meet, that is the first contact; where no object
    takes part, there is none. Distances are between surfaces, without a clearance: of a Shape, from its core."""

    distance_lo: npt.NDArray[np.float64] = dataclasses.field(default_factory=lambda: np.empty(0))
    """(...) the least distance is at least this, certainly; 0 where surfaces meet, inf where no object takes part."""
    distance_hi: npt.NDArray[np.float64] = dataclasses.field(default_factory=lambda: np.empty(0))
    """(...) and at most this."""

    def __getitem__(self, index: Any) -> Closest:
        records, _, reasons = self._chosen(index)
        lo, hi = (np.asarray(ends[index]) for ends in (self.distance_lo, self.distance_hi))
        return Closest(records, reasons=reasons, distance_lo=lo, distance_hi=hi)


@dataclasses.dataclass(eq=False)
class Overlapping(_Ragged):
    """The objects whose surfaces cross the moving one's at the start, one row each, for each cast ascending."""

    object: npt.NDArray[np.int64]
    offsets: npt.NDArray[np.int64]
    of_shape: tuple[int, ...]


def record_type(mode: str) -> np.dtype[Any]:
    return _engine.SAMPLED_CASTS if mode == "sampled" else _engine.CASTS


def records_of(out: Casts, shape: tuple[int, ...], mode: str) -> npt.NDArray[Any]:
    """Those of `out`, or a ValueError if they cannot take answers of this shape."""
    if not isinstance(out, Casts):
        raise ValueError(f"out: expected Casts, got {type(out).__name__}")
    records, flags = out.records, out.records.flags
    if records.dtype != record_type(mode) or records.shape != shape:
        got = f'of shape {records.shape}{" for mode sampled" if "resolution" in records.dtype.names else ""}'
        raise ValueError(f'out: expected Casts.empty({shape}, "{mode}"), got Casts {got}')
    if not (flags.c_contiguous and flags.writeable):
        raise ValueError("out: expected Casts whose records are writeable and C-contiguous")
    return records


_names = dict.fromkeys((*_engine.CASTS.names, *_engine.SAMPLED_CASTS.names))
Casts.__doc__ = f"{Casts.__doc__}" + "".join(f"{name}: {_engine.ANSWERS[name]}\n    " for name in _names)
