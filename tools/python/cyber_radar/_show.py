"""Pages for a browser: files, and cells of notebooks."""

from __future__ import annotations

import html
import os
import pathlib
import tempfile
import webbrowser

_LARGEST_IN_NOTEBOOKS = 4_000_000


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
