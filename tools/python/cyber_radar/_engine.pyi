"""The compiled half. Private: it trusts its caller to pass arrays of the dtypes and shapes given here."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

_Doubles = npt.NDArray[np.float64]
_Ids = npt.NDArray[np.int64]
_U32 = npt.NDArray[np.uint32]
_Floats = npt.NDArray[np.float32]
# Parent, origin (4, 4), joint: fixed, revolute or prismatic, axis, variable; meshes and their poses (4, 4).
Link = tuple[int | None, _Doubles, int, tuple[float, float, float], int | None, list[tuple[int, _Doubles]]]
Chain = tuple[list[Link], int, list[tuple[int, int]]]  # links, the number of variables, pairs of links
_Mesh = tuple[_Floats, _U32, _Doubles]  # vertices about a base, faces, the base: (3,)

version: str
commit: str
OPTIONS: list[str]
ANSWERS: dict[str, str]  # what the members of an answer mean
CASTS: np.dtype[Any]  # of records
SAMPLED_CASTS: np.dtype[Any]
MOVES: np.dtype[Any]
MAX_RESOLUTION: int
MOST_SHOWN: int

class Error(RuntimeError):
    reasons: list[str]

class Scene:
    def __init__(self, device: int | None, pool: list[int] | None, cpu_batch: int | None, threads: int) -> None: ...
    def add_mesh(self, vertices: _Floats, faces: _U32, base: _Doubles, radius: float = 0) -> int: ...
    def add_cutter(self, parts: Sequence[Sequence[tuple[float, float, float]]]) -> int: ...
    @staticmethod
    def cutter_rings(kind: str, numbers: list[float]) -> list[list[tuple[float, float, float]]]: ...
    def parts(self, mesh: int) -> list[list[tuple[float, float, float]]]: ...  # of a cutter, else none
    def radii(self) -> _Doubles: ...  # by mesh
    def remove_mesh(self, mesh: int) -> None: ...
    def mesh(self, mesh: int) -> _Mesh: ...
    def mesh_ids(self) -> list[int]: ...
    def add(self, meshes: _U32, transforms: _Doubles, masks: _U32) -> _Ids: ...
    def set_transforms(self, objects: _U32, transforms: _Doubles) -> None: ...
    def set_motions(self, objects: _U32, motions: _Doubles) -> None: ...
    def set_vertices(self, mesh: int, vertices: _Floats, base: _Doubles) -> None: ...
    def remove(self, objects: _U32) -> None: ...
    def objects(self) -> tuple[_Ids, _Ids, _Doubles, _U32, _Doubles]: ...
    def object_ids(self) -> _Ids: ...
    def device_names(self) -> list[str]: ...
    def take_losses(self) -> list[str]: ...
    def cast(
        self,
        shape: tuple[int, ...],
        arguments: dict[str, Any],
        options: dict[str, Any],
        records: npt.NDArray[Any],
        after_chunk: Callable[[int], object] | None,
    ) -> tuple[
        tuple[npt.NDArray[Any], _Ids] | None,
        tuple[_Ids, _Ids] | None,
        tuple[npt.NDArray[Any], _Doubles, _Doubles] | None,
        npt.NDArray[Any] | None,
        dict[str, _Ids],
    ]:
        """Writes `records`. The hits' records and offsets, if any are asked for; what overlaps, likewise; records of the
        closest approaches, and their distances' brackets; records of the last contacts; positions by reason."""
    def wrong_with_chain(self, chain: Chain) -> str: ...
    def move_chain(
        self,
        chain: Chain,
        starts: _Doubles,
        ends: _Doubles,
        bases: _Doubles,
        excluded: list[int],
        options: dict[str, Any],
    ) -> tuple[npt.NDArray[Any], dict[str, _Ids]]:
        """Records (n,), and positions by reason. `bases`: (4, 4), or (n, 4, 4)."""
    def moves_page(
        self,
        object_names: dict[int, str],
        chain: Chain,
        link_names: list[str],
        excluded: list[int],
        options: dict[str, Any],
        title: str,
        count: int,
        names: list[str],
        arrays: dict[str, npt.NDArray[Any]],
        records: npt.NDArray[Any],
        reasons: dict[int, str],
    ) -> str:
        """As page(), of moves."""
    def page(
        self,
        object_names: dict[int, str],
        title: str,
        count: int,
        names: list[str],
        arrays: dict[str, npt.NDArray[Any]],
        records: npt.NDArray[Any],
        reasons: dict[int, str],
        left_out: dict[int, list[int]],
        hits: tuple[npt.NDArray[Any], _Ids] | None,
        closest: npt.NDArray[Any] | None,
        exits: npt.NDArray[Any] | None,
    ) -> str:
        """`count` casts, of which `names`, `arrays`, `records` and the rest, C-contiguous, are the first: what was asked,
        the answers, the hits' records and offsets, records of closest approaches and of last contacts."""

def first_singular(matrices: _Doubles) -> tuple[int, str] | None: ...
def float_vertices(vertices: _Doubles, faces: _U32) -> tuple[_Floats, _Doubles, float]:
    """The vertices about a base, the base, and by up to how much floats change them, if that spoils the mesh, else 0."""

def devices() -> list[dict[str, Any]]: ...
def read_mesh(file: str, scale: float) -> tuple[_Mesh, list[str]]: ...
def read_assembly(file: str, scale: float) -> tuple[list[_Mesh], list[str], _U32, _Doubles, list[str]]: ...
def turn_between(
    start: _Doubles, end: _Doubles, about: _Doubles
) -> tuple[_Doubles, _Doubles, _Doubles, _Doubles, tuple[int, str] | None]:
    """Axes, angles, centres and displacements of n pairs of poses; the first that have none, and why."""

def take_validation_messages() -> list[str]: ...
