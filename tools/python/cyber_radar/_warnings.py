"""The package's warnings."""

from __future__ import annotations

import inspect
import warnings


class RoundingWarning(UserWarning):
    """Floats, the engine's precision for meshes, cannot hold a mesh's numbers."""


class MeshFileWarning(UserWarning):
    """Something in a mesh file was left out."""


class DeviceLostWarning(UserWarning):
    """The device was lost: the CPU alone answers mode "contact" now, with the same answers."""


class ValidationWarning(UserWarning):
    """A message of a Vulkan validation layer."""


def warn(note: str, category: type[Warning]) -> None:
    """Warns at the line that called the package."""
    level, frame = 1, inspect.currentframe()
    while frame is not None and frame.f_globals.get("__package__") == __package__:
        level, frame = level + 1, frame.f_back
    warnings.warn(note, category, stacklevel=level)


def warn_of(notes: list[str], category: type[Warning]) -> None:
    for note in notes:
        warn(note, category)
