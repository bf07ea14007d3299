"""Framing against bytes made by hand from WIRE.md, by a COBS of its own: whole, byte by byte, bytes around them."""

from __future__ import annotations

import struct
import zlib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from edgeline.framing import MAX_CHUNK, Chunk, Damaged, Packet, Splitter, Text, encode


def plain_cobs(data: bytes) -> bytes:
    """Cheshire and Baker's algorithm as their paper has it: split at the zeros, at most 254 bytes to a block."""
    out = bytearray()
    pieces = data.split(b"\0")
    for i, piece in enumerate(pieces):
        rest = piece
        while len(rest) > 254 or (len(rest) == 254 and i + 1 < len(pieces)):
            out += b"\xff" + rest[:254]
            rest = rest[254:]
        if len(rest) == 254:
            out += b"\xff" + rest
        else:
            out += bytes((len(rest) + 1,)) + rest
    return bytes(out)


def on_the_wire(packet: Packet) -> bytes:
    content = bytes((packet.type, packet.seq)) + packet.body
    return plain_cobs(content + struct.pack("<I", zlib.crc32(content))) + b"\0"


PING = Packet(7, 0, b"")
PING_BYTES = bytes.fromhex("0207053884980e00")

VECTORS = [
    PING,
    Packet(7, 255, b""),
    Packet(6, 1, struct.pack("<HH", 0, 240)),
    Packet(9, 2, "Grüße".encode()),
    Packet(3, 3, bytes(1000)),
    Packet(3, 4, bytes(range(1, 255)) * 3),
    Packet(3, 5, b"\xff" * 65529),
    Packet(200, 6, b"of a later version"),
]


def feed(data: bytes, size: int) -> list[Chunk]:
    splitter = Splitter()
    return [chunk for i in range(0, len(data), size) for chunk in splitter.feed(data[i : i + size])]


def test_ping_is_these_bytes() -> None:
    assert encode(PING) == PING_BYTES == on_the_wire(PING)


@pytest.mark.parametrize("packet", VECTORS, ids=lambda packet: f"type{packet.type}-{len(packet.body)}")
def test_vectors(packet: Packet) -> None:
    data = on_the_wire(packet)
    assert encode(packet) == data
    assert feed(data, len(data)) == [packet]
    assert feed(data, 1) == [packet]
    assert feed(data + b"tail", 7) == [packet]
    assert feed(b"\0\0" + data + b"\0" + data, 5) == [packet, packet]


@given(st.lists(st.tuples(st.integers(0, 255), st.integers(0, 255), st.binary(max_size=600))), st.integers(1, 700))
def test_any_packets_in_any_pieces(contents: list[tuple[int, int, bytes]], size: int) -> None:
    packets = [Packet(*content) for content in contents]
    data = b"".join(map(on_the_wire, packets))
    assert b"".join(map(encode, packets)) == data
    assert feed(data, size) == packets


@pytest.mark.parametrize("bit", range(8 * (len(PING_BYTES) - 1)))
def test_no_single_flipped_bit_gives_a_packet(bit: int) -> None:
    broken = bytearray(PING_BYTES)
    broken[bit // 8] ^= 1 << bit % 8
    assert not [chunk for chunk in feed(bytes(broken), 100) if isinstance(chunk, Packet)]


@given(st.binary(max_size=2000), st.integers(1, 100))
def test_noise_is_survived_and_the_next_packet_found(noise: bytes, size: int) -> None:
    assert feed(noise + b"\0" + PING_BYTES, size)[-1] == PING


def test_text_before_the_first_packet_goes_to_the_log() -> None:
    boot = "ROM v1.2\r\nbooting … ok\r\n".encode()
    assert feed(boot + b"\0" + PING_BYTES, 3) == [Text("ROM v1.2\r\nbooting … ok"), PING]


def test_short_and_wrong_chunks_are_damage_with_their_size() -> None:
    assert feed(plain_cobs(b"\x07\x00\x01\x02\x03") + b"\0", 9) == [Damaged("a packet cut short", 6)]
    assert feed(b"\xff\x01\x02\0", 9) == [Damaged("bytes that are no COBS", 3)]


def test_endless_garbage_takes_no_memory() -> None:
    splitter = Splitter()
    for _ in range(100):
        assert splitter.feed(b"\xaa" * 10_000) == []
        assert len(splitter._partial) <= MAX_CHUNK
    assert splitter.feed(b"\0" + PING_BYTES) == [Damaged("a packet without an end", 1_000_000), PING]
