"""How far can a shape move before it first touches anything? Any triangle meshes, any number of casts at once.

    import cyber_radar

    scene = cyber_radar.Scene()
    mesh = scene.add_mesh(vertices, faces)             # (N, 3), (M, 3); or scene.load_mesh("part.stl")
    scene.add(mesh, transforms)                        # (..., 4, 4) or (..., 3, 4): what stands still
    casts = scene.cast(mesh, poses, displacements)     # (..., 4, 4), (..., 3): what moves, from where, how far
    casts.t, casts.object, casts.point                 # (...), (...), (..., 3)

`t` is how far it can go: exact to rounding, and inf if the way is free. Shapes broadcast: poses of shape (100, 1, 4, 4) and displacements
of shape (6, 3) make 600 casts, and arrays of shape (100, 6).

help(cyber_radar.Scene) says what a scene holds, help(cyber_radar.Scene.cast) what may be asked, help(cyber_radar.Casts)
what the answers are. help(cyber_radar.Chain) is about robot arms. devices() lists the Vulkan devices; mode="reference" needs none.
"""

from __future__ import annotations

import dataclasses
import platform

import numpy as _np

from . import _engine
from ._casts import Casts, Closest, Feature, Hits, Overlapping, Status, Tier
from ._chain import Chain, Link, Moves
from ._cutters import Cutter, ball_cutter, bull_nose, cone, flat, taper
from ._engine import Error
from ._files import read_mesh
from ._scene import Objects, Scene
from ._shapes import Shape, ball, capsule, rounded
from ._turns import Turns, turn_between
from ._urdf import load_urdf
from ._warnings import DeviceLostWarning, MeshFileWarning, RoundingWarning, ValidationWarning

__version__: str = _engine.version
__all__ = [
    "Casts",
    "Chain",
    "Closest",
    "Cutter",
    "DeviceInfo",
    "DeviceLostWarning",
    "Error",
    "Feature",
    "Hits",
    "Link",
    "MeshFileWarning",
    "Moves",
    "Objects",
    "Overlapping",
    "RoundingWarning",
    "Scene",
    "Shape",
    "Status",
    "Tier",
    "Turns",
    "ValidationWarning",
    "ball",
    "ball_cutter",
    "bull_nose",
    "capsule",
    "cone",
    "devices",
    "flat",
    "load_urdf",
    "read_mesh",
    "rounded",
    "taper",
    "turn_between",
    "versions",
]


@dataclasses.dataclass(frozen=True)
class DeviceInfo:
    """A Vulkan device."""

    index: int
    """What Scene(device=...) takes."""
    name: str
    driver: str
    type: str
    """discrete, integrated, virtual, CPU or other."""
    version: str
    """Of Vulkan."""
    memory: int
    """The largest heap on the device, bytes."""
    doubles: bool
    """Whether its shaders have double precision; the answers do not depend on it."""
    reasons: tuple[str, ...]
    """Why it cannot be used; empty if it can."""
    sampled_reasons: tuple[str, ...]
    """Why it cannot answer in mode "sampled"; empty if it can."""

    @property
    def usable(self) -> bool:
        """Whether it answers in mode "contact"."""
        return not self.reasons


def devices() -> list[DeviceInfo]:
    """All Vulkan devices, as `cyber-radar devices` lists them. Raises Error if there is no Vulkan loader or driver."""
    reports = _engine.devices()
    for report in reports:
        report.update(reasons=tuple(report["reasons"]), sampled_reasons=tuple(report["sampled_reasons"]))
    return [DeviceInfo(index=index, **report) for index, report in enumerate(reports)]


def versions() -> dict[str, str]:
    """What a report of a problem should name."""
    return {
        "cyber_radar": __version__,
        "commit": _engine.commit,
        "python": platform.python_version(),
        "numpy": _np.__version__,
        "platform": platform.platform(),
    }
