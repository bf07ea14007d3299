"""Bytes to packets and back: COBS between zeros, a CRC-32 at the end of each packet (WIRE.md, "Packets").

No I/O and no clock: `Splitter.feed` takes whatever bytes arrived, in whatever pieces, and gives what is complete.
"""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass

from cobs import cobs

MAX_PACKET = 65535
"""Bytes of a packet before COBS: HELLO states a device's own limit in 16 bits."""

MAX_CHUNK = MAX_PACKET + MAX_PACKET // 254 + 1
"""Bytes between two zeros: COBS adds one byte, and one more for each 254."""

_OVERHEAD = 6
"""Type, seq and CRC."""


@dataclass(frozen=True)
class Packet:
    """A packet whose CRC is right. `seq` is 0..255; `body` may still break the rules of its type."""

    type: int
    seq: int
    body: bytes


@dataclass(frozen=True)
class Text:
    """A chunk that is no packet but printable: what a boot loader or a stray printf wrote."""

    text: str


@dataclass(frozen=True)
class Damaged:
    """A chunk that is neither packet nor text; `size` is its length on the wire, the closing zero left out."""

    reason: str
    size: int


Chunk = Packet | Text | Damaged


def encode(packet: Packet) -> bytes:
    """The packet on the wire, closing zero included."""
    content = bytes((packet.type, packet.seq)) + packet.body
    encoded: bytes = cobs.encode(content + struct.pack("<I", zlib.crc32(content)))
    return encoded + b"\0"


class Splitter:
    """Cuts a byte stream at its zeros. Holds at most MAX_CHUNK bytes, whatever arrives."""

    def __init__(self) -> None:
        self._partial = bytearray()
        self._overrun = 0

    def feed(self, data: bytes) -> list[Chunk]:
        """Takes the next bytes of the stream and returns the chunks that they complete, in order."""
        *complete, rest = data.split(b"\0")
        chunks: list[Chunk] = []
        for piece in complete:
            self._append(piece)
            chunk = self._finish()
            if chunk is not None:
                chunks.append(chunk)
        self._append(rest)
        return chunks

    def _append(self, piece: bytes) -> None:
        if self._overrun or len(self._partial) + len(piece) > MAX_CHUNK:
            self._overrun += len(self._partial) + len(piece)
            self._partial.clear()
        else:
            self._partial += piece

    def _finish(self) -> Chunk | None:
        if self._overrun:
            chunk = Damaged("a packet without an end", self._overrun)
            self._overrun = 0
            return chunk
        encoded = bytes(self._partial)
        self._partial.clear()
        return _read(encoded) if encoded else None


def _read(encoded: bytes) -> Chunk:
    try:
        content: bytes = cobs.decode(encoded)
    except cobs.DecodeError:
        return _text_or_damage(encoded, "bytes that are no COBS")
    if len(content) < _OVERHEAD:
        return _text_or_damage(encoded, "a packet cut short")
    (crc,) = struct.unpack_from("<I", content, len(content) - 4)
    if crc != zlib.crc32(content[:-4]):
        return _text_or_damage(encoded, "a packet with a wrong CRC")
    return Packet(content[0], content[1], content[2:-4])


def _text_or_damage(encoded: bytes, reason: str) -> Text | Damaged:
    try:
        text = encoded.decode()
    except UnicodeDecodeError:
        return Damaged(reason, len(encoded))
    if all(character.isprintable() or character in "\r\n\t" for character in text):
        return Text(text.strip())
    return Damaged(reason, len(encoded))
