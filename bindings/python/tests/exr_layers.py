"""Reads the layers that ``tem00 render`` writes: OpenEXR files of several parts.

Mitsuba's own reader takes the first part of a file only. Understood are scan lines of 32-bit
floats, compressed by ZIP in blocks of 16 lines; see "OpenEXR File Layout" of the Academy Software
Foundation.
"""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

_MAGIC, _VERSION, _SEVERAL_PARTS = 20000630, 2, 0x1000
_ZIP, _LINES_PER_BLOCK = 3, 16
_FLOAT32 = 2


@dataclass
class _Part:
    """A layer: its name and channels, and the images as far as they have been read."""

    name: str
    channels: list[str]
    first_row: int
    images: NDArray[np.float32]

    def put(self, row: int, block: bytes) -> None:
        """Store a block of lines, which holds one channel after the other for each line."""
        width = self.images.shape[-1]
        lines = min(_LINES_PER_BLOCK, self.images.shape[1] - (row - self.first_row))
        size = lines * len(self.channels) * width * 4
        raw = block if len(block) == size else _unpacked(zlib.decompress(block))
        values = np.frombuffer(raw, dtype="<f4").reshape(lines, len(self.channels), width)
        start = row - self.first_row
        self.images[:, start : start + lines] = values.transpose(1, 0, 2)


def read_layers(path: Path) -> dict[str, NDArray[np.float32]]:
    """Return the channels of all parts by the name ``part.channel``, of shape (rows, columns)."""
    data = path.read_bytes()
    magic, version = struct.unpack_from("<ii", data)
    assert (magic, version & 0xFF) == (_MAGIC, _VERSION), f"{path} is no OpenEXR file"
    assert version & _SEVERAL_PARTS, f"{path} has one part only"
    parts, offset = _parts(data, 8)
    blocks = [-(-part.images.shape[1] // _LINES_PER_BLOCK) for part in parts]
    offset += 8 * sum(blocks)
    for _ in range(sum(blocks)):
        number, row, size = struct.unpack_from("<iii", data, offset)
        parts[number].put(row, data[offset + 12 : offset + 12 + size])
        offset += 12 + size
    return {
        f"{part.name}.{channel}": image
        for part in parts
        for channel, image in zip(part.channels, part.images, strict=True)
    }


def _parts(data: bytes, offset: int) -> tuple[list[_Part], int]:
    """Return the empty parts that the headers describe, and where the headers end."""
    parts = []
    while data[offset]:
        attributes = {}
        while data[offset]:
            name, offset = _text(data, offset)
            _, offset = _text(data, offset)
            (size,) = struct.unpack_from("<i", data, offset)
            attributes[name] = data[offset + 4 : offset + 4 + size]
            offset += 4 + size
        parts.append(_part(attributes))
        offset += 1
    return parts, offset + 1


def _part(attributes: dict[str, bytes]) -> _Part:
    assert attributes["compression"][0] == _ZIP, "another compression than ZIP"
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    channels = _channels(attributes["channels"])
    images = np.empty((len(channels), bottom - top + 1, right - left + 1), dtype=np.float32)
    return _Part(attributes["name"].decode(), channels, top, images)


def _channels(data: bytes) -> list[str]:
    names, offset = [], 0
    while data[offset]:
        name, offset = _text(data, offset)
        (kind,) = struct.unpack_from("<i", data, offset)
        assert kind == _FLOAT32, f"{name} has no 32-bit floats"
        names.append(name)
        offset += 16
    return names


def _text(data: bytes, offset: int) -> tuple[str, int]:
    end = data.index(0, offset)
    return data[offset:end].decode(), end + 1


def _unpacked(packed: bytes) -> bytes:
    """Undo what ZIP compression does before: differences, of the even bytes and then the odd."""
    differences = np.frombuffer(packed, dtype=np.uint8).astype(np.int64)
    differences[1:] -= 128
    sums = (np.cumsum(differences) & 0xFF).astype(np.uint8)
    half = -(-len(sums) // 2)
    together = np.empty_like(sums)
    together[0::2], together[1::2] = sums[:half], sums[half:]
    return together.tobytes()
