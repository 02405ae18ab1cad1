"""Scenes and casts."""

from __future__ import annotations

import contextlib
import os
import threading
import weakref
from collections.abc import Callable, Iterator, Sequence
from typing import Any, Literal, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _engine
from ._arguments import (
    MOST_ID,
    Mode,
    about_base,
    cast_option,
    device_choice,
    mesh_arrays,
    mesh_vertices,
    one_number,
    one_whole_number,
    option_of_each,
    refuse_one_each,
    regular,
)
from ._arrays import LEAST_MASK, MOST_MASK, common_shape, poses as _poses, reals, whole_numbers
from ._asked import Asked
from ._casts import Casts, Closest, Hits, Overlapping, record_type, records_of
from ._files import Path, file_mesh, vertices_at
from ._cutters import Cutter
from ._shapes import Shape
from ._turns import turn_arrays
from ._warnings import DeviceLostWarning, MeshFileWarning, ValidationWarning, warn_of

_ALL_BITS = MOST_MASK


class Objects(NamedTuple):
    """All objects of a scene, in the order of their ids."""

    ids: npt.NDArray[np.int64]  #: (n,)
    meshes: npt.NDArray[np.int64]  #: (n,)
    transforms: npt.NDArray[np.float64]  #: (n, 4, 4) world from mesh
    masks: npt.NDArray[np.uint32]  #: (n,)
    motions: npt.NDArray[np.float64]  #: (n, 3)


class Scene:
    """Meshes, and objects that place them: what casts may touch.

    device: what answers casts in the modes "contact" and "sampled". None: the best Vulkan device; a number: that device
        of devices(); a list of numbers, or "all": these devices share the work. It is opened by the first cast that
        needs it. Mode "reference" needs none.
    threads: of the exact search on the CPU; 0: one for each core.
    cpu_batch: in mode "contact", fewer casts than this at once are answered on the CPU, with the same answers. 0: none.
        None: those with which it was faster lately; all, if the device is a CPU.

    Lengths are in any one unit. Meshes are triangle soups seen from both sides: they need not be closed or convex. A
    scene pickles as its recipe: meshes, objects, names and these settings. Any thread may use a scene; calls wait for
    each other. A forked process may use it, unless another thread was using it at that moment: then calls raise
    RuntimeError.

    >>> scene = Scene()
    >>> plate = scene.add_mesh([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], [[0, 1, 2]])
    >>> scene.add(plate)
    0
    >>> above = np.eye(4)
    >>> above[2, 3] = 2
    >>> scene.cast(plate, above, [[0, 0, -5], [0, 0, -1]], mode="reference").t
    array([ 2., inf])
    """

    def __init__(
        self,
        *,
        device: int | Literal["all"] | Sequence[int] | None = None,
        threads: int = 0,
        cpu_batch: int | None = None,
    ) -> None:
        self._settings = {"device": device, "threads": threads, "cpu_batch": cpu_batch}
        single, pool = device_choice(device)
        self._engine = _engine.Scene(
            device=single,
            pool=pool,
            cpu_batch=None if cpu_batch is None else one_whole_number(cpu_batch, "cpu_batch", 0, 2**31),
            threads=one_whole_number(threads, "threads", 0, 4096),
        )
        self._names: dict[int, str] = {}
        self._shapes: dict[tuple[Any, ...], int] = {}  # meshes of those that casts were given
        self._lock = threading.Lock()
        self._user: int | None = None  # the thread that holds the lock
        self._is_lost = False  # to a thread of the process that forked this one
        _scenes.add(self)

    # ------------------------------------------------------------------------------------------------------ contents

    def add_mesh(self, vertices: Any, faces: npt.ArrayLike | None = None) -> int:
        """Adds a mesh and returns its id.

        vertices: (N, 3). They become float32. Where that would move one by more than a millionth of the mesh's size, a
            base is subtracted first, which poses of the mesh give back; a RoundingWarning if that does not suffice.
        faces: (M, 3), whole numbers: the vertices of each triangle.

        Or only one argument, a mesh of another package: anything with `vertices` and `faces`, as in trimesh, or
        `triangles`, as in Open3D. Or a Shape, such as ball(2): casts of the mesh then have the radius. Or a Cutter, such as
        flat(3, 50), which only casts move.
        """
        if isinstance(vertices, Cutter):
            if faces is not None:
                raise ValueError("faces: expected none with a Cutter")
            with self._exclusive() as engine:
                return engine.add_cutter(vertices.parts)
        numbers, corners = mesh_arrays(vertices, faces)
        floats, base = about_base(numbers, corners)
        radius = vertices.radius if isinstance(vertices, Shape) else 0.0
        with self._exclusive() as engine:
            return engine.add_mesh(floats, corners, base, radius)

    def load_mesh(self, file: Path, *, scale: float = 1) -> int:
        """Adds the mesh that read_mesh(file, scale=scale) reads and returns its id."""
        mesh = file_mesh(file, scale)
        with self._exclusive() as engine:
            return engine.add_mesh(*mesh)

    def load_assembly(
        self, file: Path, transform: npt.ArrayLike | None = None, *, scale: float = 1, mask: int = _ALL_BITS
    ) -> npt.NDArray[np.int64]:
        """Adds one object for each node of a mesh file that has triangles, placed by the nodes' transforms.

        transform: (4, 4) or (3, 4) world from file, whose numbers are multiplied by `scale` before. Returns the objects' ids, (n,), in the file's depth-first order. `names` has
        the nodes' names; nodes that place the same triangles share a mesh.
        """
        meshes, names, placed, transforms, notes = _engine.read_assembly(os.fspath(file), one_number(scale, "scale"))
        warn_of(notes, MeshFileWarning)
        if transform is not None:
            transforms = regular(_poses(transform, "transform"), "transform") @ transforms
        bits = np.full(len(placed), one_whole_number(mask, "mask", LEAST_MASK, MOST_MASK), np.uint32)
        with self._exclusive() as engine:
            ids = [engine.add_mesh(*mesh) for mesh in meshes]
            objects = engine.add(np.array(ids, np.uint32)[placed], transforms, bits)
            self._names.update(zip(objects.tolist(), names))
            return objects

    def remove_mesh(self, mesh: int) -> None:
        """Removes a mesh that no object uses."""
        with self._exclusive() as engine:
            number = self._known_mesh(mesh)
            if (engine.objects()[1] == number).any():
                raise ValueError(f"mesh: expected a mesh that no object uses, got {number}")
            engine.remove_mesh(number)
            self._shapes = {key: mesh for key, mesh in self._shapes.items() if mesh != number}

    def mesh(self, mesh: int) -> tuple[npt.NDArray[np.float32] | npt.NDArray[np.float64], npt.NDArray[np.uint32]]:
        """A copy of a mesh: vertices (N, 3), float64 if float32 cannot hold them, and faces (M, 3). Of a Cutter, what pages
        draw of it."""
        with self._reading() as engine:
            vertices, faces, base = engine.mesh(self._known_mesh(mesh))
        return vertices_at(base, vertices), faces

    @property
    def meshes(self) -> list[int]:
        """The ids of all meshes."""
        with self._reading() as engine:
            return engine.mesh_ids()

    def add(
        self, mesh: npt.ArrayLike, transforms: npt.ArrayLike | None = None, *, mask: npt.ArrayLike = _ALL_BITS
    ) -> Any:
        """Adds objects, which place meshes, and returns their ids: (...), or a number for a single one.

        mesh: (...) ids. transforms: (..., 4, 4) or (..., 3, 4) world from mesh, any invertible affine matrices; None: the
        identity.
        mask: (...) 32 bits; an object takes part in a cast whose mask shares one. All leading shapes broadcast.
        """
        matrices = np.eye(4) if transforms is None else regular(_poses(transforms, "transforms"), "transforms")
        masks = whole_numbers(mask, "mask", np.uint32, LEAST_MASK, MOST_MASK)
        with self._exclusive() as engine:
            meshes = self._unrounded(self._known_meshes(mesh), "mesh")
            shape = common_shape({"mesh": (meshes, 0), "transforms": (matrices, 2), "mask": (masks, 0)})
            ids = engine.add(
                np.broadcast_to(meshes, shape).ravel(),
                np.broadcast_to(matrices, (*shape, 4, 4)).reshape(-1, 4, 4),
                np.broadcast_to(masks, shape).ravel(),
            ).reshape(shape)
        return ids if shape else int(ids)

    def set_transforms(self, objects: npt.ArrayLike, transforms: npt.ArrayLike) -> None:
        """Moves objects: ids (...), transforms (..., 4, 4) or (..., 3, 4) world from mesh; leading shapes broadcast."""
        matrices = regular(_poses(transforms, "transforms"), "transforms")
        with self._exclusive() as engine:
            ids = self._known_objects(objects, "objects")
            shape = common_shape({"objects": (ids, 0), "transforms": (matrices, 2)})
            engine.set_transforms(
                np.broadcast_to(ids, shape).astype(np.uint32).ravel(),
                np.broadcast_to(matrices, (*shape, 4, 4)).reshape(-1, 4, 4),
            )

    def set_motions(self, objects: npt.ArrayLike, motions: npt.ArrayLike) -> None:
        """Says how far objects move during a cast, at constant velocity: ids (...), motions (..., 3), world units;
        leading shapes broadcast. Displacements of casts are then those of the same time: `fraction` says when they meet,
        and `t` how far the cast mesh got. Where an object starts does not change."""
        ways = reals(motions, "motions", (3,))
        if not (np.abs(ways) <= 2.0**1000).all():
            raise ValueError("motions: expected finite numbers up to 2^1000")
        with self._exclusive() as engine:
            ids = self._known_objects(objects, "objects")
            shape = common_shape({"objects": (ids, 0), "motions": (ways, 1)})
            engine.set_motions(
                np.broadcast_to(ids, shape).astype(np.uint32).ravel(), np.broadcast_to(ways, (*shape, 3)).reshape(-1, 3)
            )

    def set_vertices(self, mesh: int, vertices: npt.ArrayLike) -> None:
        """Moves the vertices of a mesh: (N, 3), as many as it has, as in add_mesh()."""
        numbers = mesh_vertices(vertices)
        with self._exclusive() as engine:
            number = self._known_mesh(mesh)
            if engine.parts(number):
                raise ValueError(f"mesh: expected one with vertices of its own, got {number}, a cutter")
            old, faces, _ = engine.mesh(number)
            if len(numbers) != len(old):
                raise ValueError(f"vertices: expected shape ({len(old)}, 3), got shape {numbers.shape}")
            engine.set_vertices(number, *about_base(numbers, faces))

    def remove(self, objects: npt.ArrayLike) -> None:
        """Removes objects: ids (...). New objects get the least free ids."""
        with self._exclusive() as engine:
            ids = np.unique(self._known_objects(objects, "objects"))
            engine.remove(ids.astype(np.uint32))
            for number in ids.tolist():
                self._names.pop(number, None)

    def objects(self) -> Objects:
        """Ids, meshes, transforms, masks and motions of all objects: copies."""
        with self._reading() as engine:
            return Objects(*engine.objects())

    @property
    def names(self) -> dict[int, str]:
        """Names of the objects that have one: a copy."""
        return dict(self._names)

    def __len__(self) -> int:
        with self._reading() as engine:
            return len(engine.object_ids())

    def __repr__(self) -> str:
        return f"<Scene of {len(self)} objects, {len(self.meshes)} meshes>"

    # --------------------------------------------------------------------------------------------------------- casts

    def cast(
        self,
        mesh: npt.ArrayLike | Shape | Cutter,
        poses: npt.ArrayLike | None,
        displacements: npt.ArrayLike | None = None,
        *,
        mode: Mode = "contact",
        distances: npt.ArrayLike | None = None,
        turns: tuple[npt.ArrayLike, npt.ArrayLike, npt.ArrayLike] | None = None,
        exclude_from_all: npt.ArrayLike = (),
        exclude_from_each: npt.ArrayLike | None = None,
        mask: npt.ArrayLike = _ALL_BITS,
        any_hit: bool = False,
        ignore_leaving: npt.ArrayLike = False,
        skip_overlapping: bool = False,
        slack: npt.ArrayLike | None = None,
        clearance: npt.ArrayLike = 0.0,
        tolerance: npt.ArrayLike | None = None,
        hits: npt.ArrayLike | Literal["all"] = 1,
        closest: bool = False,
        exit: bool = False,
        resolution: int = 0,
        out: Casts | None = None,
        progress: Callable[[int, int], object] | None = None,
    ) -> Casts:
        """How far can a mesh move before its surface first touches an object? Any number of casts at once.

        mesh: (...) ids of the moving meshes. They need not be objects of the scene; if they are, exclude these. Or a Shape
            or Cutter, such as ball(2), which becomes a mesh of the scene, one for all that are equal.
        poses: (..., 4, 4) or (..., 3, 4) world from mesh at the start, affine; None: the identity.
        displacements: (..., 3) the way to go, its end included; world units, at most 2^1000. With a zero the mesh
            rests: only what is there at the start, or moves (set_motions), meets it.
            None, with turns: the mesh turns on the spot.
        Leading shapes broadcast together, also those of the next four; the result has the common shape.

        distances: (...) how far to go; displacements then give the direction alone.
        turns: axes (..., 3), angles (...), radians, and centres (..., 3), or Turns: meanwhile the mesh turns, by the
            right-hand rule, about an axis through the centre, which goes by the displacement. t, lo and hi are then
            fractions of the step. turn_between() makes them of poses. Not with distances or mode
            "sampled".
        exclude_from_each: (..., K) ids of objects to ignore, a row for each cast; -1 is none. ids[:, None] is one each.
        mask: (...) 32 bits; an object takes part if its mask shares one.

        exclude_from_all: (K,) ids of objects that every cast ignores, or one id.
        mode: "contact", exact, on device or CPU; "sampled", the paper's depth pictures, an upper bound; "reference",
            exact, on the CPU alone. "contact" and "reference" give the same numbers.
        any_hit: ask only whether there is a contact; cheaper if there is one. A start that overlaps is a HIT, too, and t
            of a hit is the whole way: contact comes by then.
        skip_overlapping: leave out objects whose surfaces cross the mesh's at the start; the answer lists them.
        closest: find how near the mesh comes to objects on the whole of its way, too (Casts.closest), and
        exit: when its last contact ends, the way out of what it overlaps (Casts.exit). Neither with turns,
            nor with ignore_leaving, nor of a Cutter.

        The next five are one value for all casts, or (...) one for each:

        ignore_leaving: count only what blocks: the mesh may leave what it rests on, or slide along it.
        slack: with ignore_leaving and skip_overlapping: how far rounding may have let surfaces sink into each other,
            world units; NaN in an array: derived from the coordinates.
        clearance: surfaces are in contact where their distance is at most this, world units; that of a Shape begins at its
            radius.
        tolerance: with a clearance or turns: how narrow hi - lo is to be, world units; NaN in an array: chosen.
        hits: list the first contacts with this many nearest objects, one each; "all", 0 in an array: all in reach.

        resolution: mode "sampled": pixels along the picture's longer side, up to 2048; 0: chosen.

        out: Casts of this shape and mode, whose records are used again.
        progress: is called with the numbers of casts done and asked for, a few times a second. What it raises ends the
            cast, as Ctrl-C does; `out` then has some of the answers.

        A cast whose own numbers are wrong, such as a NaN in its pose, has status INVALID and a reason, and the others
        are answered. Raises ValueError for arguments of a wrong type or shape, and Error if no device is usable.
        """
        given = {name: value for name, value in locals().items() if name in _engine.OPTIONS}
        each = {name: found for name, value in given.items() if (found := option_of_each(value, name)) is not None}
        options = {name: each[name][1] if name in each else cast_option(value, name) for name, value in given.items()}
        if mode not in ("contact", "sampled", "reference"):
            raise ValueError(f'mode: expected "contact", "sampled" or "reference", got {mode!r}')
        options["mode"] = mode
        options["resolution"] = one_whole_number(resolution, "resolution", 0, _engine.MAX_RESOLUTION)
        if isinstance(mesh, (Shape, Cutter)):
            mesh = self._mesh_of(mesh)
        excluded = self._excluded(exclude_from_all, exclude_from_each)
        arrays: dict[str, tuple[npt.NDArray[Any], int]] = {
            "mesh": (self._known_meshes(mesh), 0),
            "poses": (np.eye(4) if poses is None else _poses(poses, "poses"), 2),
            "displacements": (_ways(displacements, turns), 1),
            "mask": (whole_numbers(mask, "mask", np.uint32, LEAST_MASK, MOST_MASK), 0),
            "exclude_from_each": (excluded, 1),
        }
        if distances is not None:
            arrays["distances"] = (reals(distances, "distances"), 0)
        if turns is not None:
            arrays |= turn_arrays(turns)
            if distances is not None:
                raise ValueError("distances: expected none with turns")
            if mode == "sampled":
                raise ValueError('mode: expected "contact" or "reference" with turns, got "sampled"')
        if mode == "sampled":
            self._unrounded(arrays["mesh"][0], 'mesh, in mode "sampled"')
        arrays |= {name: (array, 0) for name, (array, _) in each.items()}
        shape = common_shape(arrays)
        if exclude_from_each is not None:
            refuse_one_each(np.shape(exclude_from_each), shape)
        arguments: dict[str, Any] = {}
        for name, (array, inner) in arrays.items():
            arguments[name] = np.broadcast_to(array, shape + array.shape[array.ndim - inner :])
        records = np.empty(shape, record_type(mode)) if out is None else records_of(out, shape, mode)
        total = int(np.prod(shape, dtype=np.int64))
        after_chunk = None if progress is None else lambda done: progress(done, total)
        with self._exclusive() as engine:
            try:
                listed, overlapping, closest, exits, reasons = engine.cast(shape, arguments, options, records, after_chunk)
            finally:
                warn_of(_engine.take_validation_messages(), ValidationWarning)
                warn_of(engine.take_losses(), DeviceLostWarning)
        casts = Casts(records) if out is None else out
        casts.hits = None if listed is None else Hits(listed[0], offsets=listed[1], of_shape=shape)
        casts.overlapping = None if overlapping is None else Overlapping(*overlapping, shape)
        casts.closest = None if closest is None else Closest(closest[0], distance_lo=closest[1], distance_hi=closest[2])
        casts.exit = None if exits is None else Casts(exits)
        casts.reasons = reasons
        for name in _engine.OPTIONS:
            value = {None: np.nan, "all": 0}.get(options[name], options[name])
            arguments.setdefault(name, np.broadcast_to(np.asarray(value, np.float64), shape))
        casts._asked = Asked.of(self._page, self._names, arguments, shape)
        return casts

    def _page(self, title: str, count: int, names: list[str], arrays: dict[str, npt.NDArray[Any]], *shown: Any) -> str:
        ways = arrays["displacements"]
        lengths = np.linalg.norm(ways, axis=-1)
        arrays.setdefault("distances", lengths)
        if "turns: axes" not in arrays:
            ways[~(lengths > 0)] = (0, 0, 1)
        arrays |= {name: np.array(arrays[name], np.float64) for name in _engine.OPTIONS}
        with self._reading() as engine:
            return engine.page(self._names, title, count, names, arrays, *shown)

    @property
    def device_names(self) -> list[str]:
        """The devices that have been opened for this scene."""
        with self._reading() as engine:
            return engine.device_names()

    # ------------------------------------------------------------------------------------------------------- pickling

    def __getstate__(self) -> dict[str, Any]:
        with self._reading() as engine:
            return {
                "settings": self._settings,
                "meshes": {mesh: (*engine.mesh(mesh), float(engine.radii()[mesh])) for mesh in engine.mesh_ids()},
                "cutters": {mesh: parts for mesh in engine.mesh_ids() if (parts := engine.parts(mesh))},
                "objects": engine.objects(),
                "names": self._names,
            }

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__init__(**state["settings"])  # type: ignore[misc]
        ids, meshes, transforms, masks, motions = state["objects"]
        triangle = np.eye(3, dtype=np.float32), np.array([[0, 1, 2]], np.uint32), np.zeros(3)
        # A new item gets the least free id: what is missing is added, too, and removed again.
        last_mesh = max(state["meshes"], default=-1)
        for mesh in range(last_mesh + 1):
            if mesh in state["cutters"]:
                self._engine.add_cutter(state["cutters"][mesh])
            else:
                self._engine.add_mesh(*state["meshes"].get(mesh, triangle))
        if len(ids):
            count = int(ids[-1]) + 1
            rows = np.zeros(count, np.intp)
            rows[ids] = np.arange(len(ids))
            self._engine.add(meshes[rows].astype(np.uint32), transforms[rows], masks[rows])
            self._engine.set_motions(ids.astype(np.uint32), motions)
            self._engine.remove(np.setdiff1d(np.arange(count), ids).astype(np.uint32))
        for mesh in set(range(last_mesh + 1)) - set(state["meshes"]):
            self._engine.remove_mesh(mesh)
        self._names = dict(state["names"])

    # ---------------------------------------------------------------------------------------------------------- inner

    @contextlib.contextmanager
    def _exclusive(self) -> Iterator[_engine.Scene]:
        """The engine's scene, for this thread alone."""
        if self._user == threading.get_ident():
            raise RuntimeError("a progress callback cannot change the scene that is being cast, or cast in it")
        if self._is_lost:
            raise RuntimeError("another thread was using this scene when the process forked: send it pickled instead")
        with self._lock:
            try:
                self._user = threading.get_ident()
                yield self._engine
            finally:
                self._user = None

    @contextlib.contextmanager
    def _reading(self) -> Iterator[_engine.Scene]:
        """The same; a thread that has the scene already, such as in a progress callback, may look at it."""
        if self._user == threading.get_ident():
            yield self._engine
        else:
            with self._exclusive() as engine:
                yield engine

    def _excluded(self, from_all: npt.ArrayLike, from_each: npt.ArrayLike | None) -> npt.NDArray[np.int64]:
        """Rows of objects to ignore: (..., K)."""
        all_ids = self._known_objects(from_all, "exclude_from_all")
        if all_ids.ndim > 1:
            raise ValueError(
                f"exclude_from_all: expected shape (K,), ids that every cast ignores, got shape {all_ids.shape}; "
                "exclude_from_each has a row for each cast"
            )
        all_ids = all_ids.reshape(-1)
        if from_each is None:
            return all_ids
        rows = self._known_objects(from_each, "exclude_from_each", least=-1)
        if rows.ndim < 2:
            raise ValueError(
                f"exclude_from_each: expected shape (..., K), a row of ids for each cast, got shape {rows.shape}; for "
                "one id each, pass ids[:, None]; for the same ids in every cast, exclude_from_all"
            )
        return np.concatenate([rows, np.broadcast_to(all_ids, (*rows.shape[:-1], all_ids.size))], axis=-1)

    def _mesh_of(self, shape: Shape | Cutter) -> int:
        key: tuple[Any, ...]
        if isinstance(shape, Cutter):
            key = (shape.parts,)
        else:
            key = shape.vertices.tobytes(), shape.faces.tobytes(), shape.radius
        if key not in self._shapes:
            self._shapes[key] = self.add_mesh(shape)
        return self._shapes[key]

    def _unrounded(self, meshes: npt.NDArray[np.uint32], name: str) -> npt.NDArray[np.uint32]:
        """Refuses meshes of Shapes and Cutters."""
        with self._reading() as engine:
            radii = engine.radii()[meshes]
            for mesh in np.unique(meshes).tolist():
                if engine.parts(mesh):
                    raise ValueError(f"{name}: expected meshes, got {mesh}, a cutter")
        if (radii > 0).any():
            raise ValueError(
                f"{name}: expected meshes without a radius, got {meshes[radii > 0].flat[0]}, of radius {radii.max():g}"
            )
        return meshes

    def _known_meshes(self, mesh: npt.ArrayLike) -> npt.NDArray[np.uint32]:
        ids = whole_numbers(mesh, "mesh", np.uint32, 0, MOST_ID)
        known = np.isin(ids, self.meshes)
        if not known.all():
            raise ValueError(f"mesh: expected ids of meshes of the scene, got {ids[~known].flat[0]}")
        return ids

    def _known_mesh(self, mesh: int) -> int:
        return int(self._known_meshes(one_whole_number(mesh, "mesh", 0, MOST_ID)))

    def _known_objects(self, objects: npt.ArrayLike, name: str, least: int = 0) -> npt.NDArray[np.int64]:
        """`least`: -1 if that is none."""
        ids = whole_numbers(objects, name, np.int64, least, MOST_ID)
        if ids.size:
            with self._reading() as engine:
                unknown = np.setdiff1d(ids, engine.object_ids())
            unknown = unknown[unknown >= 0]
            if unknown.size:
                raise ValueError(f"{name}: expected ids of objects of the scene, got {unknown[0]}")
        return ids


def _ways(displacements: npt.ArrayLike | None, turns: Any) -> npt.NDArray[np.float64]:
    if displacements is not None:
        return reals(displacements, "displacements", (3,))
    if turns is None:
        raise ValueError("displacements: expected numbers of shape (..., 3), or turns, got neither")
    return np.zeros(3)


_scenes: weakref.WeakSet[Scene] = weakref.WeakSet()


def _after_fork() -> None:
    """Other threads do not follow a fork: what they began with a scene is never finished."""
    for scene in _scenes:
        scene._is_lost = scene._lock.locked() and scene._user != threading.get_ident()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_after_fork)
