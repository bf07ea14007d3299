"""A stream that begins in the middle: HELLO and one whole raw frame stand for all that came before.

Frames depend on earlier ones, so a recording that begins later than its device, and a replay that is joined late, open
with a verified frame told anew: the same picture, number, times, counters and digest, in bands that need nothing else.
"""

from __future__ import annotations

from dataclasses import replace

from edgeline import codec, framing, protocol
from edgeline.codec import Pixels
from edgeline.protocol import Band, FrameEnd, Hello

_MOST_LINES = 255
_AROUND_PIXELS = 14
"""Bytes of a raw BAND's packet besides its pixels: type, seq, the body's eight, CRC."""


def snapshot(hello: Hello, picture: Pixels, end: FrameEnd, next_seq: int) -> bytes:
    """The wire's bytes of `hello` and the frame that `picture`, (h, w) RGB565, and `end` are, numbered so that the
    packet `next_seq`, 0..255, follows."""
    height, width = picture.shape
    room = max(hello.largest_packet, _AROUND_PIXELS + 2 * width)
    lines = min(_MOST_LINES, (room - _AROUND_PIXELS) // (2 * width))
    bands: list[Band] = [codec.encode_raw(end.frame, y0, picture[y0 : y0 + lines]) for y0 in range(0, height, lines)]
    seq = next_seq - len(bands) - 2
    sent = [framing.encode(protocol.pack(band, seq + 1 + i & 0xFF)) for i, band in enumerate(bands)]
    first = framing.encode(protocol.pack(replace(hello, largest_packet=room), seq & 0xFF))
    told_anew = replace(end, bands=len(bands), wire_bytes=sum(map(len, sent)))
    return first + b"".join(sent) + framing.encode(protocol.pack(told_anew, next_seq - 1 & 0xFF))


def packets(data: bytes) -> list[bytes]:
    """`data` cut after each 00, the end of a packet; the last one may lack it."""
    cut = [packet + b"\0" for packet in data.split(b"\0")]
    return [*cut[:-1], cut[-1][:-1]] if cut[-1] != b"\0" else cut[:-1]
