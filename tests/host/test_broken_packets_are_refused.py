"""The packets' bodies: bytes laid out by hand from WIRE.md's tables, and every rule broken once."""

from __future__ import annotations

import re
import struct
from pathlib import Path

import pytest

from edgeline import protocol
from edgeline.errors import DeviceError, WireError
from edgeline.framing import Packet
from edgeline.protocol import (
    Ack,
    Band,
    Baud,
    Body,
    Capability,
    Codec,
    Control,
    DebugView,
    FrameEnd,
    Hello,
    Input,
    Key,
    Log,
    Mode,
    Ping,
    SetBaud,
    Start,
    Stop,
)

HELLO_1_1_BYTES = (
    bytes.fromhex("4544474c 01 01 4001 f000 01 00 0000 e803 03030000 00c20100 cdab3412".replace(" ", ""))
    + b"\x04Pico\x09edge 0.1b"
)
HELLO_1_1 = Hello(
    width=320,
    height=240,
    capabilities=Capability.RAW | Capability.RUNS | Capability.SKIPS_LINES | Capability.INPUT,
    boot_id=0x1234ABCD,
    target="Pico",
    firmware="edge 0.1b",
    minor=1,
    largest_packet=1000,
    highest_baud=115200,
    controls=0b1110,
)
HELLO_BYTES = (
    bytes.fromhex("4544474c 01 02 4001 f000 01 00 4000 e803 070f0000 00100e00 cdab3412".replace(" ", ""))
    + b"\x04Pico\x09edge 0.1b"
    + bytes.fromhex("07 05 fe3f0000 3f00 00c20100".replace(" ", ""))
)
HELLO = Hello(
    width=320,
    height=240,
    capabilities=Capability.RAW
    | Capability.RUNS
    | Capability.SPLIT
    | Capability.SKIPS_LINES
    | Capability.INPUT
    | Capability.ROLL
    | Capability.SET_BAUD,
    boot_id=0x1234ABCD,
    target="Pico",
    firmware="edge 0.1b",
    minor=2,
    skip_segment=64,
    largest_packet=1000,
    highest_baud=921600,
    input=7,
    scenes=5,
    controls=0x3FFE,
    views=0x3F,
    baud=115200,
)
FRAME_END_1_1_BYTES = struct.pack("<HHIIIIHHIB2I", 65535, 30, 1, 2, 3, 4, 5, 0, 0xDEADBEEF, 2, 7, 8)
FRAME_END_BYTES = struct.pack("<HHIIIIHBBIB2II", 65535, 30, 1, 2, 3, 4, 5, 255, 3, 0xDEADBEEF, 2, 7, 8, 99)
FRAME_END = FrameEnd(65535, 30, 1, 2, 3, 4, 5, 0xDEADBEEF, (7, 8), input=255, mixed=True, owing=True, cycles=99)

BODIES: list[tuple[Body, bytes]] = [
    (HELLO, HELLO_BYTES),
    (Start(2, 25), bytes.fromhex("000219000300")),
    (Start(255, 65535, Capability.SPLIT, Mode.ROLL), bytes.fromhex("01ffffff0400")),
    (
        Band(1, 8, 2, Codec.RUNS, b"\x82\x82", b"\x34\x12\x00\xf8"),
        bytes.fromhex("0100080002010200") + b"\x82\x824\x12\x00\xf8",
    ),
    (FRAME_END, FRAME_END_BYTES),
    (Ack(513, 1), bytes.fromhex("010201")),
    (Key(0, 240), bytes.fromhex("0000f000")),
    (Ping(), bytes.fromhex("0102")),
    (Stop(), b""),
    (Input(1, 3, 0), bytes.fromhex("010300000000")),
    (Input(200, -2, 255), bytes.fromhex("c8feffffffff")),
    (SetBaud(921600), bytes.fromhex("00100e00")),
    (Baud(923076), bytes.fromhex("c4150e00")),
    (Log("größer"), "größer".encode()),
]
NAMES = [type(body).__name__ for body, _ in BODIES]


@pytest.mark.parametrize(("body", "data"), BODIES, ids=NAMES)
def test_bodies_are_these_bytes(body: Body, data: bytes) -> None:
    assert body.encode() == data
    assert protocol.unpack(protocol.pack(body, 9)) == body


def test_what_before_1_2_was_shorter_is_still_read() -> None:
    assert Hello.decode(HELLO_1_1_BYTES) == HELLO_1_1
    assert HELLO_1_1.encode() == HELLO_1_1_BYTES
    assert Hello.decode(HELLO_1_1_BYTES + b"later members") == HELLO_1_1
    assert FrameEnd.decode(FRAME_END_1_1_BYTES) == FrameEnd(65535, 30, 1, 2, 3, 4, 5, 0xDEADBEEF, (7, 8))
    assert FrameEnd.decode(FRAME_END_1_1_BYTES + b"abc") == FrameEnd.decode(FRAME_END_1_1_BYTES)
    assert Input.decode(bytes.fromhex("0103000000")) == Input(1, 3)
    assert Input(1, 3).encode() == bytes.fromhex("0103000000")
    assert Ping.decode(b"") == Ping(0, 0)


def test_a_device_says_which_controls_and_views_it_has() -> None:
    assert [control for control in range(300) if HELLO.knows(control)] == [*range(1, 14), *range(128, 300)]
    assert [control for control in Control if HELLO_1_1.knows(control)] == [1, 2, 3]
    assert [view for view in range(-1, 20) if HELLO.has_view(view)] == list(DebugView)
    assert not any(HELLO_1_1.has_view(view) for view in DebugView)
    silent = Hello(8, 8, Capability.RAW, 1, "", "", minor=2, controls=0xFFFFFFFF)
    assert not any(silent.knows(control) for control in range(256))


@pytest.mark.parametrize(("body", "data"), [pair for pair in BODIES if not isinstance(pair[0], Log | Band)])
def test_longer_bodies_of_a_later_version_are_read(body: Body, data: bytes) -> None:
    assert type(body).decode(data + b"later members") == body


@pytest.mark.parametrize(
    ("body", "data"), [pair for pair in BODIES if not isinstance(pair[0], Log | Band | Ping | Stop)]
)
def test_shorter_bodies_are_damage(body: Body, data: bytes) -> None:
    # Members that were appended may be missing: an older device has none.
    appended = {FrameEnd: 4, Input: 1}.get(type(body), 0)
    for size in range(len(data) - appended):
        with pytest.raises(WireError):
            type(body).decode(data[:size])


def test_a_band_needs_its_head_and_its_tokens() -> None:
    (data,) = (data for body, data in BODIES if isinstance(body, Band))
    for size in range(10):
        with pytest.raises(WireError):
            Band.decode(data[:size])


def patched(at: int, value: bytes) -> bytes:
    return HELLO_BYTES[:at] + value + HELLO_BYTES[at + len(value) :]


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (patched(0, b"edgl"), "magic"),
        (patched(6, b"\0\0"), "0x240"),
        (patched(6, struct.pack("<H", 2041)), "2041x240"),
        (patched(8, struct.pack("<H", 0)), "320x0"),
        (patched(8, struct.pack("<H", 2041)), "320x2041"),
        (patched(5, b"\x02")[:-1], "needs"),
        (patched(29, b"\xff"), "UTF-8"),
        (patched(28, b"\xff"), "needs"),
    ],
)
def test_hellos_that_break_a_rule_are_damage(data: bytes, message: str) -> None:
    with pytest.raises(WireError, match=message):
        Hello.decode(data)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (patched(4, b"\x02"), r"version 2\.2 of the wire, this host 1\.2: update the host"),
        (b"EDGL\x00\x09", r"version 0\.9 .* update the firmware"),
        (patched(10, b"\x02"), "pixel format 2"),
        (patched(16, struct.pack("<I", 8 | 256)), "offers no codec"),
    ],
)
def test_devices_that_cannot_be_served_are_named(data: bytes, message: str) -> None:
    with pytest.raises(DeviceError, match=message):
        Hello.decode(data)


@pytest.mark.parametrize("flags", [3, 7, 8, 9, 0x11, 0x22, 0x42, 0x80, 0x81, 0x82])
def test_unknown_codec_bytes_are_damage(flags: int) -> None:
    with pytest.raises(WireError, match="codec"):
        Band.decode(struct.pack("<HHBBH", 0, 0, 1, flags, 0))


def test_a_band_without_lines_is_damage() -> None:
    with pytest.raises(WireError, match="without lines"):
        Band.decode(struct.pack("<HHBBH", 0, 0, 0, 0, 0))


def test_unknown_types_are_ignored() -> None:
    assert protocol.unpack(Packet(0x0D, 0, b"reserved")) is None


def test_counters_have_the_names_and_the_order_of_stats_h() -> None:
    header = Path(__file__).parents[2] / "firmware/src/base/stats.h"
    names = re.findall(r"^\s+uint32_t (\w+);", header.read_text(encoding="utf-8"), re.MULTILINE)
    assert tuple(names) == protocol.COUNTERS


def test_counters_of_a_later_firmware_are_kept() -> None:
    end = FrameEnd(0, 0, 0, 0, 0, 0, 0, 0, tuple(range(len(protocol.COUNTERS) + 1)))
    assert end.named_counters()[f"counter_{len(protocol.COUNTERS)}"] == len(protocol.COUNTERS)
    assert FRAME_END.named_counters() == {"passes": 7, "draws": 8}
