"""Frames to files: PNG, a sequence of PNGs, animated PNG, GIF.

Every file is written beside its name and renamed when it is complete, so that a failure leaves what was there before.
The animations are written frame by frame: memory holds one frame of a recording of any length. (Pillow's own animation
writers keep all frames until the end, so Pillow compresses the frames here and the containers, a few fixed records, are
written by hand.) A frame lasts until the device's time stamp of the next one.
"""

from __future__ import annotations

import contextlib
import io
import os
import re
import struct
import tempfile
import zlib
from abc import ABC, abstractmethod
from pathlib import Path
from typing import IO, Protocol

import numpy as np
from PIL import GifImagePlugin, Image

from edgeline.codec import Pixels
from edgeline.colour import to_image, to_rgb
from edgeline.errors import OutputError

LAST_FRAME_US = 100_000
"""How long the only frame of a recording is shown."""

LONGEST_FRAME_US = 60_000_000
"""A pause longer than this is a restarted clock, not a picture to look at."""

_GIF_SHORTEST_CS = 2
"""Viewers take a delay of less than 2/100 s for a mistake and show the frame for 10/100 s."""

_SEQUENCE = re.compile(r"%(0[1-9])?d")


class Recorder(Protocol):
    """Takes frames one by one. Every method may raise OutputError."""

    def add(self, picture: Pixels, time_us: int) -> None:
        """The next frame, (h, w) RGB565 of one size throughout, begun at `time_us` of the device's clock (mod 2^32)."""

    def finish(self) -> None:
        """Makes the files complete. Without a frame there will be no file."""

    def discard(self) -> None:
        """Leaves everything as if this recorder had not been, except the finished files of a sequence."""


def recorder(path: str) -> Recorder:
    """The recorder for a file name: `*.gif`, `*.png` or `*.apng`, or a pattern such as `frames/%04d.png`."""
    if "%" in Path(path).name:
        return PngSequence(path)
    suffix = Path(path).suffix.lower()
    if suffix == ".gif":
        return GifRecorder(path)
    if suffix in (".png", ".apng"):
        return ApngRecorder(path)
    raise OutputError(f"{path}: record writes *.gif, *.png (animated), or a sequence such as frames/%04d.png")


def save_png(path: str, picture: Pixels) -> None:
    """Writes one picture, (h, w) RGB565. Raises OutputError."""
    file = AtomicFile(path)
    try:
        to_image(picture).save(file.stream, "PNG")
        file.commit()
    except OSError as error:
        raise _failed(path, error) from None
    finally:
        file.discard()


def check_writable(path: str) -> None:
    """Raises OutputError if a file of this name could not be written, before anyone waits for its content."""
    AtomicFile(path).discard()


class AtomicFile:
    """A file that appears under its name when it is complete, or not at all."""

    def __init__(self, path: str) -> None:
        self.path = Path(path)
        if self.path.is_dir():
            raise OutputError(f"{path}: is a folder: name a file in it")
        try:
            descriptor, name = tempfile.mkstemp(".part", f".{self.path.name}.", self.path.parent)
        except OSError as error:
            raise _failed(path, error) from None
        self._temporary = Path(name)
        self.stream: IO[bytes] = os.fdopen(descriptor, "w+b")

    def commit(self) -> None:
        """Gives the file its name. Raises OSError."""
        self.stream.flush()
        os.fsync(self.stream.fileno())
        self.stream.close()
        umask = os.umask(0)
        os.umask(umask)
        self._temporary.chmod(0o666 & ~umask)  # mkstemp makes files for the user alone
        self._temporary.replace(self.path)

    def discard(self) -> None:
        """Removes what was not committed. Never raises."""
        with contextlib.suppress(OSError):
            self.stream.close()
        with contextlib.suppress(OSError):
            self._temporary.unlink()


class PngSequence:
    """One PNG per frame, numbered from 0; each is complete as soon as it is there."""

    def __init__(self, pattern: str) -> None:
        path = Path(pattern)
        if path.suffix.lower() != ".png" or not _SEQUENCE.search(path.name) or path.name.count("%") != 1:
            raise OutputError(f"{pattern}: a sequence is named with one number and .png, as in frames/%04d.png")
        self._pattern = path
        self._count = 0
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise _failed(str(path.parent), error) from None
        check_writable(pattern)

    def add(self, picture: Pixels, time_us: int) -> None:
        save_png(str(self._pattern.with_name(self._pattern.name % self._count)), picture)
        self._count += 1

    def finish(self) -> None:
        """Every file is complete already."""

    def discard(self) -> None:
        """What is there is good."""


class _Animation(ABC):
    """What GIF and APNG share: a frame is written when the next one tells how long it lasts, and only the rectangle
    that changed is written."""

    def __init__(self, path: str) -> None:
        self._file = AtomicFile(path)
        self._path = path
        self._waiting: tuple[Pixels, int] | None = None
        self._shown: Pixels | None = None
        self._duration_us = LAST_FRAME_US
        self._count = 0

    def add(self, picture: Pixels, time_us: int) -> None:
        if self._waiting is not None:
            elapsed_us = time_us - self._waiting[1] & 0xFFFFFFFF
            if elapsed_us <= LONGEST_FRAME_US:
                self._duration_us = elapsed_us
            self._put(self._waiting[0])
        self._waiting = picture, time_us

    def finish(self) -> None:
        if self._waiting is None:
            self.discard()
            return
        self._put(self._waiting[0])
        self._waiting = None
        try:
            self._end(self._file.stream)
            self._file.commit()
        except OSError as error:
            raise _failed(self._path, error) from None
        finally:
            self.discard()

    def discard(self) -> None:
        self._file.discard()

    def _put(self, picture: Pixels) -> None:
        stream = self._file.stream
        try:
            if self._shown is None:
                self._begin(stream, picture.shape[1], picture.shape[0])
                x0, y0, x1, y1 = 0, 0, picture.shape[1], picture.shape[0]
            else:
                x0, y0, x1, y1 = _changed(self._shown, picture)
            self._frame(stream, picture[y0:y1, x0:x1], x0, y0, self._duration_us)
        except OSError as error:
            self.discard()
            raise _failed(self._path, error) from None
        self._shown = picture
        self._count += 1

    @abstractmethod
    def _begin(self, stream: IO[bytes], width: int, height: int) -> None: ...

    @abstractmethod
    def _frame(self, stream: IO[bytes], part: Pixels, x0: int, y0: int, duration_us: int) -> None: ...

    @abstractmethod
    def _end(self, stream: IO[bytes]) -> None: ...


class GifRecorder(_Animation):
    """A GIF that repeats, each frame with a palette of its own (GIF89a specification, sections 18 to 23).

    Exact where the rectangle that changed has at most 256 colours; otherwise the colours are quantised: record an
    animated PNG if every pixel counts. Delays are whole 1/100 s, 2 at least; their rounding does not add up.
    """

    def __init__(self, path: str) -> None:
        super().__init__(path)
        self._clock_us = 0
        self._clock_cs = 0

    def _begin(self, stream: IO[bytes], width: int, height: int) -> None:
        stream.write(b"GIF89a" + struct.pack("<HHBBB", width, height, 0x70, 0, 0))
        stream.write(b"\x21\xff\x0bNETSCAPE2.0\x03\x01\x00\x00\x00")

    def _frame(self, stream: IO[bytes], part: Pixels, x0: int, y0: int, duration_us: int) -> None:
        self._clock_us += duration_us
        delay_cs = max(_GIF_SHORTEST_CS, min(65535, round(self._clock_us / 10_000) - self._clock_cs))
        self._clock_cs += delay_cs
        # A frame that had to be lengthened is not made up for by later ones: that would make the speed uneven.
        self._clock_us = max(self._clock_us, (self._clock_cs - 1) * 10_000)
        image = _with_palette(part)
        blocks = GifImagePlugin.getdata(image, (x0, y0), duration=delay_cs * 10, disposal=1, include_color_table=True)
        stream.write(b"".join(blocks))

    def _end(self, stream: IO[bytes]) -> None:
        stream.write(b"\x3b")


class ApngRecorder(_Animation):
    """An animated PNG that repeats: lossless (PNG specification, third edition, sections 11.3.7 and 4.9).

    `acTL` holds the number of frames, which is known at the end, and is written over then.
    """

    def __init__(self, path: str) -> None:
        super().__init__(path)
        self._sequence = 0
        self._control_at = 0

    def _begin(self, stream: IO[bytes], width: int, height: int) -> None:
        stream.write(b"\x89PNG\r\n\x1a\n")
        stream.write(_chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)))
        self._control_at = stream.tell()
        stream.write(_chunk(b"acTL", struct.pack(">II", 1, 0)))

    def _frame(self, stream: IO[bytes], part: Pixels, x0: int, y0: int, duration_us: int) -> None:
        height, width = part.shape
        duration_ms = min(65535, round(duration_us / 1000))
        control = (self._next(), width, height, x0, y0, duration_ms, 1000, 0, 0)
        stream.write(_chunk(b"fcTL", struct.pack(">IIIIIHHBB", *control)))
        for data in _compressed(part):
            if self._count == 0:
                stream.write(_chunk(b"IDAT", data))
            else:
                stream.write(_chunk(b"fdAT", struct.pack(">I", self._next()) + data))

    def _end(self, stream: IO[bytes]) -> None:
        stream.write(_chunk(b"IEND", b""))
        stream.seek(self._control_at)
        stream.write(_chunk(b"acTL", struct.pack(">II", self._count, 0)))

    def _next(self) -> int:
        self._sequence += 1
        return self._sequence - 1


def _changed(before: Pixels, after: Pixels) -> tuple[int, int, int, int]:
    """The rectangle (x0, y0, x1, y1), half-open, outside of which both are equal; one pixel if they are equal."""
    different = before != after
    rows, columns = np.flatnonzero(different.any(axis=1)), np.flatnonzero(different.any(axis=0))
    if rows.size == 0:
        return 0, 0, 1, 1
    return int(columns[0]), int(rows[0]), int(columns[-1]) + 1, int(rows[-1]) + 1


def _with_palette(part: Pixels) -> Image.Image:
    colours, indices = np.unique(part, return_inverse=True)
    if colours.size > 256:
        return to_image(part).quantize(256, Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    image = Image.frombytes("P", (part.shape[1], part.shape[0]), indices.astype(np.uint8).tobytes())
    image.putpalette(to_rgb(colours.reshape(1, -1)).tobytes())
    return image


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


def _failed(path: str, error: OSError) -> OutputError:
    return OutputError(f"{path}: cannot be written: {error.strerror or error}")
