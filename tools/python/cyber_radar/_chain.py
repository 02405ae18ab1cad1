"""Chains of joints, such as robot arms."""

from __future__ import annotations

import dataclasses
import functools
import re
from collections.abc import Iterable, Sequence
from typing import Any, Literal, Union

import numpy as np
import numpy.typing as npt

from . import _engine
from ._arguments import one_flag, one_number, one_whole_number
from ._arrays import LEAST_MASK, MOST_MASK, common_shape, poses as _poses, reals
from ._asked import Asked
from ._casts import Answers
from ._scene import Scene

JOINTS = ("fixed", "revolute", "prismatic")
Pairs = Iterable[Sequence[str]]


@dataclasses.dataclass(frozen=True, eq=False)
class Link:
    """A link of a chain, and the joint that carries it, as in URDF."""

    name: str
    parent: str | None = None
    """The name of a link before it; None: the base."""
    joint: Literal["fixed", "revolute", "prismatic"] = "fixed"
    """Turns the link by the joint's number, radians, about the axis, by the right-hand rule; moves it so far along the
    axis; or does nothing."""
    origin: npt.ArrayLike | None = None
    """(4, 4) or (3, 4) parent from joint, rigid to 1e-6; None: the identity."""
    axis: npt.ArrayLike = (1.0, 0.0, 0.0)
    """(3,) through the joint's origin, in its frame; of any length but 0."""
    meshes: Sequence[Union[int, tuple[int, npt.ArrayLike]]] = ()
    """Ids of meshes of the scene, each alone, or with (4, 4) or (3, 4) link from mesh: any invertible affine matrix."""
    variable: str | None = None
    """What the joint's number is called; joints with the same name share one. None: as the link."""
    limits: tuple[float, float] = (-np.inf, np.inf)
    """Of that number. A chain keeps them for its user; motions beyond them are answered, too."""


class Chain:
    """Links on joints, which move among the objects of a scene.

    scene: has the links' meshes, which must stay there, and the objects that they may touch.
    links: each behind its parent. Their names differ.
    pairs: (k, 2) names of links that are tested with each other, too. None: all that have meshes, but for those that a
        joint joins, also through links that are fixed to each other.
    ignored: (k, 2) names of links that are not.
    variables: names of the joints' numbers, in the order that configurations have; None: in that of the links.

    A chain pickles with its scene.

    >>> scene = Scene()
    >>> rod = scene.add_mesh([[0, 0, 0], [2, 0, 0], [2, 0.1, 0]], [[0, 1, 2]])
    >>> wall = scene.add_mesh([[-9, 0, -9], [9, 0, -9], [0, 0, 9]], [[0, 1, 2]])
    >>> scene.add(wall, [[1, 0, 0, 0], [0, 1, 0, 1], [0, 0, 1, 0]])
    0
    >>> chain = Chain(scene, [Link("rod", joint="revolute", axis=[0, 0, 1], meshes=[rod])])
    >>> moves = chain.move([0], [[0.4], [1.0]])  # from 0 to angles at which its end is below the wall, and beyond
    >>> moves
    <Moves of shape (2,): 1 hit, 1 clear>
    >>> moves.object, moves.link_names
    (array([-1,  0]), array(['', 'rod'], dtype='<U3'))
    """

    links: tuple[Link, ...]
    variables: tuple[str, ...]
    """Names of the numbers in a configuration."""
    lower: npt.NDArray[np.float64]
    """(variables,) the limits of those numbers; -inf where there is none."""
    upper: npt.NDArray[np.float64]
    """(variables,) likewise; inf where there is none."""
    pairs: tuple[tuple[str, str], ...]
    """Links that are tested with each other."""

    def __init__(
        self,
        scene: Scene,
        links: Iterable[Link],
        *,
        pairs: Pairs | None = None,
        ignored: Pairs = (),
        variables: Sequence[str] | None = None,
    ) -> None:
        self.scene = scene
        self.links = tuple(links)
        self._number = {link.name: i for i, link in enumerate(self.links)}
        if len(self._number) < len(self.links):
            twice = next(link.name for i, link in enumerate(self.links) if self._number[link.name] != i)
            raise ValueError(f"links: expected names that differ, got {twice!r} twice")
        moving = [link for link in self.links if link.joint != "fixed"]
        names = tuple(dict.fromkeys(_variable(link) for link in moving))
        self.variables = names if variables is None else tuple(variables)
        if sorted(self.variables) != sorted(names):
            raise ValueError(f"variables: expected {names} in any order, got {self.variables}")
        self._parts = [self._part(i) for i in range(len(self.links))]
        limits = [[link.limits for link in moving if _variable(link) == name] for name in self.variables]
        self.lower = np.array([max(low for low, _ in of_joints) for of_joints in limits], float)
        self.upper = np.array([min(high for _, high in of_joints) for of_joints in limits], float)
        left_out = {frozenset(pair) for pair in self._known_pairs(ignored, "ignored")}
        chosen = self._apart() if pairs is None else self._known_pairs(pairs, "pairs")
        self.pairs = tuple(pair for pair in chosen if frozenset(pair) not in left_out)
        with scene._reading() as engine:
            wrong = engine.wrong_with_chain(self._given())
        if wrong:
            named = re.sub(r"^link (\d+): ", lambda found: f"{self._called(int(found[1]))}: ", wrong)
            raise ValueError(named.replace("parentFromJoint", "origin"))

    @property
    def names(self) -> tuple[str, ...]:
        """Of the links."""
        return tuple(self._number)

    def __repr__(self) -> str:
        return f"<Chain of {len(self.links)} links, {len(self.variables)} variables, {len(self.pairs)} pairs>"

    def move(
        self,
        start: npt.ArrayLike,
        end: npt.ArrayLike,
        base: npt.ArrayLike | None = None,
        *,
        any_hit: bool = False,
        exclude_from_all: npt.ArrayLike = (),
        mask: int = MOST_MASK,
        clearance: float = 0.0,
        tolerance: float | None = None,
    ) -> Moves:
        """What does the chain first touch on its way from one configuration to another? Any number of motions at once,
        on the CPU.

        start, end: (..., variables) angles, radians, up to 2^16, and lengths. Each number goes from one to the other
            linearly, and objects move (Scene.set_motions) meanwhile.
        base: (..., 4, 4) or (..., 3, 4) world from base, rigid to 1e-6; None: the identity.
        Leading shapes broadcast together; the result has the common shape.

        any_hit: ask only whether there is a conflict; cheaper if there is one.
        exclude_from_all: (K,) ids of objects to ignore, or one id.
        mask: 32 bits; an object takes part if its mask shares one.
        clearance: surfaces are in contact where their distance is at most this, world units.
        tolerance: how far a point of the link may move between fraction_lo and fraction_hi, world units. None, or more:
            1e-6 of the longest side of its mesh's box, or of the clearance if that is longer.

        A motion whose own numbers are wrong, such as a NaN, has status INVALID and a reason, and the others are
        answered. Raises ValueError for arguments of a wrong type or shape.
        """
        width = len(self.variables)
        arrays = {
            "start": (reals(start, "start", (width,)), 1),
            "end": (reals(end, "end", (width,)), 1),
            "base": (np.eye(4) if base is None else _poses(base, "base"), 2),
        }
        shape = common_shape(arrays)
        count = int(np.prod(shape, dtype=np.int64))
        starts, ends = (
            np.broadcast_to(arrays[name][0], (*shape, width)).reshape(count, width) for name in ("start", "end")
        )
        bases = arrays["base"][0]
        if bases.ndim > 2:
            bases = np.broadcast_to(bases, (*shape, 4, 4)).reshape(count, 4, 4)
        options = {
            "any_hit": one_flag(any_hit, "any_hit"),
            "mask": one_whole_number(mask, "mask", LEAST_MASK, MOST_MASK),
            "clearance": _length(clearance, "clearance"),
            "tolerance": None if tolerance is None else _length(tolerance, "tolerance"),
        }
        excluded = self.scene._excluded(exclude_from_all, None).tolist()
        with self.scene._exclusive() as engine:
            records, reasons = engine.move_chain(self._given(), starts, ends, bases, excluded, options)
        moves = Moves(records.reshape(shape), reasons, self.names)
        asked = {"start": starts, "end": ends, "base": np.broadcast_to(bases, (count, 4, 4))}
        arrays = {name: array.reshape(*shape, *array.shape[1:]) for name, array in asked.items()}
        make_page = functools.partial(self._page, excluded, options)
        moves._asked = Asked.of(make_page, self.scene._names, arrays, shape)
        return moves

    def poses(self, configurations: npt.ArrayLike, base: npt.ArrayLike | None = None) -> npt.NDArray[np.float64]:
        """World from link, (..., links, 4, 4), in configurations (..., variables). base: as of move()."""
        numbers = reals(configurations, "configurations", (len(self.variables),))
        root = np.eye(4) if base is None else _poses(base, "base")
        shape = common_shape({"configurations": (numbers, 1), "base": (root, 2)})
        placed = np.empty((*shape, len(self.links), 4, 4))
        for i, (parent, origin, joint, axis, variable, _) in enumerate(self._parts):
            placed[..., i, :, :] = (root if parent is None else placed[..., parent, :, :]) @ origin
            if variable is not None:
                moved = _moved(JOINTS[joint], np.array(axis), numbers[..., variable])
                placed[..., i, :, :] = placed[..., i, :, :] @ moved
        return placed

    # ---------------------------------------------------------------------------------------------------------- inner

    def _page(self, excluded: list[int], options: dict[str, Any], *shown: Any) -> str:
        with self.scene._reading() as engine:
            return engine.moves_page(self.scene._names, self._given(), list(self.names), excluded, options, *shown)

    def _called(self, i: int) -> str:
        return f"links[{i}] ({self.links[i].name!r})"

    def _given(self) -> _engine.Chain:
        pairs = [(self._number[a], self._number[b]) for a, b in self.pairs]
        return self._parts, len(self.variables), pairs

    def _part(self, i: int) -> _engine.Link:
        """A link as the compiled half takes it."""
        link = self.links[i]
        try:
            if link.joint not in JOINTS:
                raise ValueError(f'joint: expected "fixed", "revolute" or "prismatic", got {link.joint!r}')
            parent = None if link.parent is None else self._number.get(link.parent, i)
            if parent is not None and parent >= i:
                raise ValueError(f"parent: expected the name of a link before it, got {link.parent!r}")
            axis, limits = reals(link.axis, "axis", (3,)), reals(link.limits, "limits", (2,))
            for name, numbers in (("axis", axis), ("limits", limits)):
                if numbers.ndim != 1:
                    raise ValueError(f"{name}: expected shape ({numbers.shape[-1]},), got shape {numbers.shape}")
            if not limits[0] <= limits[1]:
                raise ValueError(f"limits: expected a least and a greatest number, got {link.limits}")
            meshes = []
            for entry in link.meshes:
                mesh, pose = entry if isinstance(entry, (tuple, list)) else (entry, None)
                self.scene._unrounded(self.scene._known_meshes(mesh), "meshes")
                meshes.append((self.scene._known_mesh(mesh), _one_pose(pose, "meshes")))
            variable = None if link.joint == "fixed" else self.variables.index(_variable(link))
            origin, (x, y, z) = _one_pose(link.origin, "origin"), axis.tolist()
            return parent, origin, JOINTS.index(link.joint), (x, y, z), variable, meshes
        except ValueError as error:
            raise ValueError(f"{self._called(i)}: {error}") from None

    def _known_pairs(self, pairs: Pairs, name: str) -> list[tuple[str, str]]:
        known = []
        for i, pair in enumerate(pairs):
            if isinstance(pair, str) or len(pair) != 2 or pair[0] == pair[1] or not set(pair) <= set(self._number):
                raise ValueError(f"{name}[{i}]: expected the names of two links, got {pair!r}")
            known.append((pair[0], pair[1]))
        return known

    def _apart(self) -> list[tuple[str, str]]:
        """All that have meshes, but for those that do not move past each other, or do at one joint."""
        groups: list[int] = []  # of links that are fixed to each other: the first of them; -1: to the base
        joined = set()  # groups, also to themselves
        for i, (parent, _, joint, _, _, _) in enumerate(self._parts):
            before = -1 if parent is None else groups[parent]
            groups.append(before if JOINTS[joint] == "fixed" else i)
            joined.add(frozenset((before, groups[i])))
        solid = [i for i, link in enumerate(self.links) if link.meshes]
        return [
            (self.links[a].name, self.links[b].name)
            for k, a in enumerate(solid)
            for b in solid[k + 1 :]
            if frozenset((groups[a], groups[b])) not in joined
        ]


@dataclasses.dataclass(eq=False, repr=False)
class Moves(Answers):
    """Answers of Chain.move(), as views into `records`, an array of numpy's of the motions' leading shape (...). Ids are
    -1 and other numbers NaN where there are none. An index gives the motions there, as numpy's would.

    status: a Status. HIT: certainly a conflict; OVERLAP: at the start; CLEAR: certainly none; UNDECIDED: none gets
        certainly deeper than the tolerance, or it comes at the very start or end; INVALID: `reasons` says why.
    fraction_lo: of the motion, 0 to 1: certainly no conflict before; inf if there is none.
    fraction_hi: certainly a conflict by then; inf where none is certain.
    fraction: how far the chain can go: fraction_lo of a hit (with any_hit: 1); inf if it is clear, NaN if undecided.
    link: the number of the link that touches something; link_names has its name.
    mesh: which of that link's meshes.
    object: the object touched; -1 if it is another link.
    other_link, other_mesh: that link, and which of its meshes; -1 if it is an object.
    tri_a, tri_b: the triangles of the link's mesh, and of what it touches.
    feature_a, feature_b: a Feature: which parts of these triangles touch.
    point: (..., 3) where, in the world, at that moment.
    normal: (..., 3) unit, from what is touched towards the link.
    gap: with a clearance: how far apart the triangles are at that moment.
    """

    records: npt.NDArray[Any]
    """(...) a structured array, whose fields are the members above: numpy.save(file, moves.records)."""
    reasons: dict[str, npt.NDArray[np.int64]] = dataclasses.field(default_factory=dict)
    """Why motions are invalid: reason -> their positions, counted in C order."""
    names: tuple[str, ...] = ()
    """Of the chain's links."""
    _asked: Asked | None = None
    _called = "moves"
    _answered_by = "Chain.move()"

    @property
    def link_names(self) -> npt.NDArray[np.str_]:
        """(...) the names of `link`; empty where it is -1."""
        return self._named(self.link)

    @property
    def other_link_names(self) -> npt.NDArray[np.str_]:
        """(...) the names of `other_link`; empty where it is -1."""
        return self._named(self.other_link)

    def _named(self, links: npt.NDArray[np.int64]) -> npt.NDArray[np.str_]:
        return np.asarray(np.array([*self.names, ""])[links])

    def __getitem__(self, index: Any) -> Moves:
        records, _, reasons = self._chosen(index)
        part = Moves(records, reasons, self.names)
        part._asked = self._asked[index] if self._asked else None
        return part


def _variable(link: Link) -> str:
    return link.name if link.variable is None else link.variable


def _length(value: Any, name: str) -> float:
    number = one_number(value, name)
    if not 0 <= number < np.inf:
        raise ValueError(f"{name}: expected a finite number of 0 or more, got {number}")
    return number


def _one_pose(value: npt.ArrayLike | None, name: str) -> npt.NDArray[np.float64]:
    pose = np.eye(4) if value is None else _poses(value, name)
    if pose.ndim != 2:
        raise ValueError(f"{name}: expected one pose, got shape {pose.shape}")
    return pose


def _moved(joint: str, axis: npt.NDArray[np.float64], numbers: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """What a joint does: (..., 4, 4)."""
    unit = axis / np.abs(axis).max()
    unit /= np.linalg.norm(unit)
    moved = np.broadcast_to(np.eye(4), (*numbers.shape, 4, 4)).copy()
    if joint == "prismatic":
        moved[..., :3, 3] = numbers[..., None] * unit
        return moved
    across = np.cross(np.eye(3), unit)
    side, back = np.sin(numbers), 2 * np.sin(numbers / 2) ** 2
    moved[..., :3, :3] += side[..., None, None] * across + back[..., None, None] * (across @ across)
    return moved
