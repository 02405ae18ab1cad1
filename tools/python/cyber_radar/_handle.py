"""Casts that run on another thread."""

from __future__ import annotations

import concurrent.futures
import threading
from collections.abc import Callable

from ._casts import Casts


class CastHandle:
    """A cast that runs on another thread."""

    def __init__(self, total: int, progress: Callable[[int, int], object] | None) -> None:
        self._progress = (0, total)
        self._callback = progress
        self._cancelled = threading.Event()
        self._future: concurrent.futures.Future[Casts]

    def result(self, timeout: float | None = None) -> Casts:
        """Waits, at most `timeout` seconds, and returns the answers, or raises what ended the cast:
        concurrent.futures.CancelledError after cancel(), concurrent.futures.TimeoutError if it is not done in time."""
        return self._future.result(timeout)

    def done(self) -> bool:
        """Whether result() returns at once."""
        return self._future.done()

    def cancel(self) -> None:
        """Ends the cast soon; some of `out` is then written."""
        self._cancelled.set()
        self._future.cancel()

    @property
    def progress(self) -> tuple[int, int]:
        """How many casts are done, of how many."""
        return self._progress

    def _after_chunk(self, done: int) -> None:
        self._progress = (done, self._progress[1])
        if self._callback is not None:
            self._callback(*self._progress)
        if self._cancelled.is_set():
            raise concurrent.futures.CancelledError
