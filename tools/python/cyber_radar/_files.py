"""Mesh files."""

from __future__ import annotations

import os
from typing import Union

import numpy as np
import numpy.typing as npt

from . import _engine
from ._arguments import one_number
from ._warnings import MeshFileWarning, warn_of

Path = Union[str, "os.PathLike[str]"]


def read_mesh(
    file: Path, *, scale: float = 1
) -> tuple[npt.NDArray[np.float32] | npt.NDArray[np.float64], npt.NDArray[np.uint32]]:
    """Reads a mesh file of any format that the program cyber-radar reads.

    "engine.glb" is the whole file as one mesh; "engine.glb#3" is node 3 of those that have triangles, in its own frame;
    "engine.glb#name" is the only node of that name. The file's numbers are multiplied by `scale`: 0.001 makes metres of
    millimetres.

    Returns vertices (N, 3), float64 where float32 cannot hold the file's numbers, and faces (M, 3). Raises ValueError if
    the scale is not finite and above 0, or the file is missing, broken, or has no triangle.
    """
    vertices, faces, base = file_mesh(file, scale)
    return vertices_at(base, vertices), faces


def file_mesh(
    file: Path, scale: float
) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.uint32], npt.NDArray[np.float64]]:
    """The same as vertices about a base, faces, and the base."""
    mesh, notes = _engine.read_mesh(os.fspath(file), one_number(scale, "scale"))
    warn_of(notes, MeshFileWarning)
    return mesh


def vertices_at(
    base: npt.NDArray[np.float64], vertices: npt.NDArray[np.float32]
) -> npt.NDArray[np.float32] | npt.NDArray[np.float64]:
    return base + vertices if base.any() else vertices
