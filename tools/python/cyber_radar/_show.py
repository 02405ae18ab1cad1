"""Casts as a page for a browser."""

from __future__ import annotations

import dataclasses
import html
import os
import pathlib
import tempfile
import webbrowser
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _engine

if TYPE_CHECKING:
    from ._casts import Casts
    from ._scene import Scene

_LARGEST_IN_NOTEBOOKS = 4_000_000


_MOST_REMEMBERED = 100_000  # casts, whose inputs are kept whole, so that parts of them can be shown, too


def _first(array: npt.NDArray[Any], shape: tuple[int, ...], count: int) -> npt.NDArray[Any]:
    """A copy of what the first casts of this leading shape have, one after the other."""
    return np.array(array[np.unravel_index(np.arange(count), shape)] if shape else array[None], order="C")


@dataclasses.dataclass(frozen=True)
class Asked:
    """What casts were asked, for a page: arrays of their leading shape, and their places in the whole batch. Of a large
    batch, what the page can show, one after the other."""

    scene: Scene
    arrays: dict[str, npt.NDArray[Any]]
    number: npt.NDArray[np.int64]  #: in C order, of `shape`
    shape: tuple[int, ...]
    is_cut: bool = False

    @classmethod
    def of(cls, scene: Scene, arguments: dict[str, Any], shape: tuple[int, ...]) -> Asked:
        count = int(np.prod(shape, dtype=np.int64))
        arrays = {name: array for name, array in arguments.items() if array is not None}
        if count <= _MOST_REMEMBERED:
            return cls(scene, arrays, np.arange(count).reshape(shape), shape)
        kept = _engine.MOST_SHOWN
        arrays = {name: _first(array, shape, kept) for name, array in arrays.items()}
        return cls(scene, arrays, np.arange(kept), shape, True)

    def __getitem__(self, places: Any) -> Asked | None:
        """None: of a large batch."""
        if self.is_cut:
            return None
        arrays = {name: array[places] for name, array in self.arrays.items()}
        return Asked(self.scene, arrays, self.number[places], self.shape)


def page_of(casts: Casts, asked: Asked | None, title: str) -> str:
    """The page, HTML; ValueError if it is not known what was asked."""
    if asked is None:
        raise ValueError(
            "show: expected casts that Scene.cast() has answered, got some that were unpickled or made, or a part of "
            f"more than {_MOST_REMEMBERED:,}"
        )
    shown = min(asked.number.size, _engine.MOST_SHOWN)
    arrays = {name: _first(array, asked.number.shape, shown) for name, array in asked.arrays.items()}
    arrays |= {name: _first(array, casts.shape, shown) for name, array in casts.to_dict().items()}
    ways = arrays["displacements"]
    lengths = np.linalg.norm(ways, axis=-1)
    arrays.setdefault("distances", lengths)
    ways[~(lengths > 0)] = (0, 0, 1)
    numbers = asked.number.reshape(-1)[:shown]
    places = np.stack(np.unravel_index(numbers, asked.shape), axis=-1) if asked.shape else np.empty((1, 0))
    names = [", ".join(map(str, place)) or "cast" for place in places.tolist()]
    left_out: dict[int, list[int]] = {}
    if casts.overlapping is not None:
        rows, offsets = casts.overlapping.object.tolist(), casts.overlapping.offsets.tolist()
        left_out = {i: rows[offsets[i] : offsets[i + 1]] for i in range(shown) if offsets[i] < offsets[i + 1]}
    reasons = {int(i): reason for reason, found in casts.reasons.items() for i in found if i < shown}
    arrays |= {name: np.array(arrays[name], np.float64) for name in _engine.OPTIONS}
    hits = None
    if casts.hits is not None:
        offsets = casts.hits.offsets[: shown + 1]
        hits = ({name: array[: offsets[-1]] for name, array in casts.hits.to_dict().items()}, offsets)
    scene = asked.scene
    with scene._reading() as engine:
        return engine.page(scene.names, title, casts.status.size, names, arrays, reasons, left_out, hits)


def write(page: str, file: str | os.PathLike[str]) -> pathlib.Path:
    """Leaves what was there if the page cannot be written."""
    path = pathlib.Path(file)
    beside = tempfile.NamedTemporaryFile("w", encoding="utf-8", dir=path.parent, suffix=".html", delete=False)
    try:
        with beside:
            beside.write(page)
        os.chmod(beside.name, 0o644)
        os.replace(beside.name, path)
    except BaseException:
        os.unlink(beside.name)
        raise
    return path


def open_in_browser(page: str) -> pathlib.Path:
    number, name = tempfile.mkstemp(prefix="cyber-radar-", suffix=".html")
    os.close(number)
    path = write(page, name)
    webbrowser.open(path.as_uri())
    return path


def in_notebook(page: str, words: str) -> str:
    """HTML for a cell of a notebook; in words if the page would make the notebook large."""
    if len(page) > _LARGEST_IN_NOTEBOOKS:
        return f"<p>{html.escape(words)} show() opens the page ({1e-6 * len(page):.0f} MB).</p>"
    return f'<iframe srcdoc="{html.escape(page)}" style="width: 100%; height: 600px; border: 0"></iframe>'
