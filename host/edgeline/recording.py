"""The file of a recording: the wire's bytes in both directions with their times (RECORDING.md has every byte drawn).

A recording is a header and then chunks, each with a CRC and of a bounded size, appended as the bytes come: what a
killed program leaves is readable up to its last chunk, and so is a damaged file up to the damage. The reader holds one
chunk at a time and checks every size before it reads. Nothing in a recording names a file.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from enum import IntEnum
from pathlib import Path
from typing import IO

from edgeline.errors import EdgelineError, StreamError

SUFFIX = ".elrec"
MAGIC = b"\x89ELREC\r\n"
"""No text file begins so, and a transfer that rewrites line ends breaks it."""

MAJOR, MINOR = 1, 0
LARGEST_HEADER = 1024
LARGEST_CHUNK = 1 << 17
LARGEST_PIECE = 0xFFFF
CHUNK_BYTES = 1 << 15
"""A chunk is written when it has so many bytes ..."""

CHUNK_US = 250_000
"""... or when it is so old: this is what a kill can lose."""

LATEST_US = 1 << 53
"""No time is so late: 285 years."""

_LONGEST_PAUSE_US = 0xFFFF_FFFF
_OPENING = struct.Struct("<8sBBH")
_FACTS = struct.Struct("<QB")
_CHUNK = struct.Struct("<IQ")
_PIECE = struct.Struct("<BIH")
_CRC = struct.Struct("<I")


class Direction(IntEnum):
    FROM_DEVICE = 0
    TO_DEVICE = 1


class DamagedRecordingError(StreamError):
    """The recording is cut off or damaged; everything before that has been read."""


@dataclass(frozen=True)
class Header:
    """`start_us`: microseconds since 1970-01-01T00:00:00Z; `port`: as the user called it, for display alone."""

    start_us: int
    port: str

    def encode(self) -> bytes:
        # A name may be longer than the format allows, and need not be sound text.
        name = self.port.encode("utf-8", "replace")[:255].decode("utf-8", "ignore").encode()
        facts = _FACTS.pack(self.start_us, len(name)) + name
        return _with_crc(_OPENING.pack(MAGIC, MAJOR, MINOR, len(facts)) + facts)


@dataclass(frozen=True)
class Piece:
    """Bytes that passed together, `time_us` microseconds after the recording's start."""

    time_us: int
    direction: Direction
    data: bytes


def is_recording(path: str) -> bool:
    """Whether a port's name stands for a recording: by the file's ending, or by its beginning."""
    if path.lower().endswith(SUFFIX):
        return True
    try:
        if not Path(path).is_file():  # to read a port would take its bytes, or wait for them
            return False
        with Path(path).open("rb") as stream:
            return stream.read(len(MAGIC)) == MAGIC
    except OSError:
        return False


def cannot_read(path: str, error: OSError) -> EdgelineError:
    return EdgelineError(f"{path}: cannot be read: {error.strerror or error}")


@contextmanager
def opened(path: str) -> Iterator[RecordingReader]:
    """The recording `path`, while it is read. Raises EdgelineError if it cannot be."""
    try:
        stream = Path(path).open("rb")  # noqa: SIM115 (its errors alone are the file's)
    except OSError as error:
        raise cannot_read(path, error) from None
    with stream:
        yield RecordingReader(stream, path)


class RecordingWriter:
    """Appends to `stream`, a file opened for writing, a whole chunk at a time. Every method may raise OSError."""

    def __init__(self, stream: IO[bytes], header: Header) -> None:
        self._stream = stream
        self._pieces = bytearray()
        self._first_us = 0
        self._last_us = 0
        self._put(header.encode())

    def add(self, piece: Piece) -> None:
        """Takes the next bytes. Times never fall; one that does counts as the last one's."""
        time_us = max(piece.time_us, self._last_us)
        self.idle(time_us)
        if self._pieces and time_us - self._last_us > _LONGEST_PAUSE_US:
            self.flush()
        for start in range(0, len(piece.data), LARGEST_PIECE):
            data = piece.data[start : start + LARGEST_PIECE]
            if not self._pieces:
                self._first_us = self._last_us = time_us
            self._pieces += _PIECE.pack(piece.direction, time_us - self._last_us, len(data)) + data
            self._last_us = time_us
            if len(self._pieces) >= CHUNK_BYTES:
                self.flush()

    def idle(self, time_us: int) -> None:
        """To be called now and then while nothing passes: writes a chunk that is old enough."""
        if self._pieces and time_us - self._first_us >= CHUNK_US:
            self.flush()

    def flush(self) -> None:
        """Writes what has been taken so far."""
        if self._pieces:
            self._put(_with_crc(_CHUNK.pack(len(self._pieces), self._first_us) + self._pieces))
            self._pieces.clear()

    def _put(self, data: bytes) -> None:
        self._stream.write(data)
        self._stream.flush()


class RecordingReader:
    """Reads `stream`, a file opened for reading; `name` is what error lines call it.

    Raises EdgelineError where reading fails, and here if it is no recording that this version reads.
    """

    def __init__(self, stream: IO[bytes], name: str) -> None:
        self._stream = stream
        self.name = name
        self._offset = 0
        self._last_us = 0
        self.header = self._read_header()

    def __iter__(self) -> Iterator[Piece]:
        """The pieces from here on. Raises DamagedRecordingError where the file is cut off or damaged."""
        while True:
            opening = self._read(_CHUNK.size)
            if not opening:
                return
            if len(opening) < _CHUNK.size:
                raise self._damaged("is cut off")
            length, first_us = _CHUNK.unpack(opening)
            if not 0 < length <= LARGEST_CHUNK:
                raise self._damaged("is damaged")
            rest = self._read(length + _CRC.size)
            if len(rest) < length + _CRC.size:
                raise self._damaged("is cut off")
            if not _crc_is_right(opening + rest) or not self._last_us <= first_us < LATEST_US:
                raise self._damaged("is damaged")
            yield from self._pieces_of(rest[:length], first_us)

    def _pieces_of(self, pieces: bytes, time_us: int) -> Iterator[Piece]:
        offset = 0
        while offset < len(pieces):
            if len(pieces) - offset < _PIECE.size:
                raise self._damaged("is damaged")
            kind, pause_us, length = _PIECE.unpack_from(pieces, offset)
            offset += _PIECE.size
            if len(pieces) - offset < length:
                raise self._damaged("is damaged")
            time_us += pause_us
            self._last_us = time_us
            if kind in (Direction.FROM_DEVICE, Direction.TO_DEVICE):  # a newer minor version may have other kinds
                yield Piece(time_us, Direction(kind), pieces[offset : offset + length])
            offset += length

    def _read_header(self) -> Header:
        opening = self._read(_OPENING.size)
        if len(opening) < _OPENING.size or not opening.startswith(MAGIC):
            raise EdgelineError(f"{self.name}: is no recording: `edgeline record -o FILE{SUFFIX}` makes one")
        _, major, minor, length = _OPENING.unpack(opening)
        if major != MAJOR:
            raise EdgelineError(
                f"{self.name}: is a recording of version {major}.{minor}, this host reads {MAJOR}.x: update the host"
            )
        if not _FACTS.size <= length <= LARGEST_HEADER:
            raise EdgelineError(f"{self.name}: the recording's header is damaged")
        rest = self._read(length + _CRC.size)
        if len(rest) < length + _CRC.size or not _crc_is_right(opening + rest):
            raise EdgelineError(f"{self.name}: the recording's header is damaged")
        start_us, name_length = _FACTS.unpack_from(rest)
        if _FACTS.size + name_length > length or start_us >= LATEST_US:
            raise EdgelineError(f"{self.name}: the recording's header is damaged")
        return Header(start_us, rest[_FACTS.size : _FACTS.size + name_length].decode("utf-8", "replace"))

    def _read(self, size: int) -> bytes:
        try:
            data = self._stream.read(size)
        except OSError as error:
            raise cannot_read(self.name, error) from None
        self._offset += len(data)
        return data

    def _damaged(self, how: str) -> DamagedRecordingError:
        return DamagedRecordingError(
            f"{self.name}: the recording {how} near byte {self._offset:,}, after {self._last_us / 1e6:.3f} s"
        )


def _with_crc(data: bytes) -> bytes:
    return data + _CRC.pack(zlib.crc32(data))


def _crc_is_right(data: bytes) -> bool:
    (crc,) = _CRC.unpack_from(data, len(data) - _CRC.size)
    return bool(crc == zlib.crc32(data[: -_CRC.size]))
