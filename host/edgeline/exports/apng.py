"""Animated PNG, frame by frame: Pillow compresses the pixels, the chunks around them are written by hand."""

from __future__ import annotations

import io
import struct
import zlib

from edgeline.codec import Pixels
from edgeline.colour import to_image
from edgeline.exports.animation import Animation, Ticks, changed

_TICK_US = 1000


class ApngRecorder(Animation):
    """An animated PNG that repeats: lossless (PNG specification, third edition, sections 11.3.7 and 4.9).

    Times are whole milliseconds whose rounding does not add up. `acTL` holds the number of frames, which is known at
    the end, and is written over then.
    """

    def __init__(self, path: str) -> None:
        super().__init__(path)
        self._shown: Pixels | None = None
        self._ticks = Ticks(_TICK_US)
        self._count = 0
        self._sequence = 0
        self._control_at = 0

    def _frame(self, picture: Pixels, duration_us: int) -> None:
        stream = self._file.stream
        if self._shown is None:
            height, width = picture.shape
            stream.write(b"\x89PNG\r\n\x1a\n")
            stream.write(_chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)))
            self._control_at = stream.tell()
            stream.write(_chunk(b"acTL", struct.pack(">II", 1, 0)))
        x0, y0, x1, y1 = changed(self._shown, picture)
        control = (self._next(), x1 - x0, y1 - y0, x0, y0, self._ticks.of(duration_us), 1000, 0, 0)
        stream.write(_chunk(b"fcTL", struct.pack(">IIIIIHHBB", *control)))
        for data in _compressed(picture[y0:y1, x0:x1]):
            if self._shown is None:
                stream.write(_chunk(b"IDAT", data))
            else:
                stream.write(_chunk(b"fdAT", struct.pack(">I", self._next()) + data))
        self._shown = picture
        self._count += 1

    def _end(self) -> None:
        stream = self._file.stream
        stream.write(_chunk(b"IEND", b""))
        stream.seek(self._control_at)
        stream.write(_chunk(b"acTL", struct.pack(">II", self._count, 0)))

    def _next(self) -> int:
        self._sequence += 1
        return self._sequence - 1


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def _compressed(part: Pixels) -> list[bytes]:
    """The IDAT contents of `part` as Pillow compresses it."""
    buffer = io.BytesIO()
    to_image(part).save(buffer, "PNG")
    png = buffer.getvalue()
    contents: list[bytes] = []
    offset = 8
    while offset < len(png):
        (length,) = struct.unpack_from(">I", png, offset)
        if png[offset + 4 : offset + 8] == b"IDAT":
            contents.append(png[offset + 8 : offset + 8 + length])
        offset += 12 + length
    return contents
