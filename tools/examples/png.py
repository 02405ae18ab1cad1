"""PNG files from arrays (height, width, 3) of bytes."""

from __future__ import annotations

import pathlib
import struct
import zlib

import numpy as np


def write(file: pathlib.Path, picture: np.ndarray) -> None:
    """Writes one picture."""
    file.write_bytes(_SIGNATURE + _header(picture) + _chunk(b"IDAT", _packed(picture)) + _chunk(b"IEND", b""))


_SIGNATURE = b"\x89PNG\r\n\x1a\n"


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def _header(picture: np.ndarray) -> bytes:
    height, width, _ = picture.shape
    return _chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))


def _packed(picture: np.ndarray) -> bytes:
    """Rows as differences from the row above, which compress well."""
    picture = np.ascontiguousarray(picture, np.uint8)
    height, width, _ = picture.shape
    rows = picture.reshape(height, 3 * width)
    above = np.vstack([np.zeros((1, 3 * width), np.uint8), rows[:-1]])
    filtered = np.hstack([np.full((height, 1), 2, np.uint8), rows - above])
    return zlib.compress(filtered.tobytes(), 6)
