"""The bodies of the packets, both ways: one dataclass per packet of WIRE.md, version 1.2.

`decode` checks every rule that a body can break by itself and raises WireError; what depends on the session (the order
of bands, digests, credits) is checked in `session`. All numbers are little-endian.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from enum import IntEnum, IntFlag
from typing import ClassVar

from edgeline.errors import DeviceError, WireError
from edgeline.framing import Packet

MAJOR = 1
MINOR = 2
MAGIC = b"EDGL"
RGB565 = 1
MAX_SIDE = 2040

COUNTERS = (
    "passes",
    "draws",
    "draws_culled",
    "vertices",
    "triangles",
    "triangles_outside",
    "triangles_clipped",
    "triangles_backface",
    "triangles_empty",
    "triangles_other",
    "triangles_listed",
    "setups",
    "rows",
    "spans",
    "pixels",
    "bands",
    "flushes",
    "memory_peak",
    "clusters_outside",
    "clusters_turned",
    "triangles_skipped",
    "triangles_hidden",
    "pixels_prepass",
    "lines_background",
    "frames_unchanged",
)
"""The names of FRAME_END's work counters, in the order of firmware/src/base/stats.h."""


class PacketType(IntEnum):
    HELLO = 0x01
    START = 0x02
    BAND = 0x03
    FRAME_END = 0x04
    ACK = 0x05
    KEY = 0x06
    PING = 0x07
    STOP = 0x08
    LOG = 0x09
    INPUT = 0x0A
    SET_BAUD = 0x0B
    BAUD = 0x0C


class Capability(IntFlag):
    """Bits 0..2 of HELLO's capabilities and of START's codecs; those from bit 8 on are HELLO's alone."""

    RAW = 1
    RUNS = 2
    SPLIT = 4
    SKIPS_LINES = 256
    INPUT = 512
    ROLL = 1024
    SET_BAUD = 2048


class Mode(IntEnum):
    """How START wants the frames paced."""

    BLOCK = 0
    """every frame that is sent is whole, and rendering waits for the wire"""
    ROLL = 1
    """rendering never waits, and a frame carries the changed lines that the link takes at once"""


class Codec(IntEnum):
    RAW = 0
    RUNS = 1
    SPLIT = 2


class Control(IntEnum):
    """What INPUT sets (WIRE.md, "INPUT", has each one's values); 128..255 are a program's own."""

    SCENE = 1
    """index into the device's scenes; the scene begins at its frame 0"""
    FRAME = 2
    """number of the scene's next frame"""
    PAUSE = 3
    """1: the scene stays at its frame; 0: it goes on"""
    STEP = 4
    """a scene that stands still goes on by so many frames, 1 .. 2^31 - 1"""
    YAW = 5
    """the camera's way around what it looks at, to the right; 65536 is a whole turn"""
    PITCH = 6
    """likewise upwards, -16384 .. 16384"""
    ZOOM = 7
    """the camera's distance is divided by 2^(value / 256), -1024 .. 1024"""
    PAN_X = 8
    """the camera and what it looks at move to the right, in 1/256 of their distance, -4096 .. 4096"""
    PAN_Y = 9
    """likewise upwards"""
    SHADING = 10
    """one of Shading"""
    TEXTURE_ERROR = 11
    """texture coordinates are within 2^-value texel, 1..5; 0: what the program chose"""
    ANTIALIASING = 12
    """samples per pixel, 1, 4 or 8"""
    VIEW = 13
    """one of DebugView"""


class Shading(IntEnum):
    """Values of Control.SHADING."""

    AS_MADE = 0
    FLAT = 1
    COLOURS = 2
    """vertex colours, no textures"""
    TEXTURES = 3
    """textures, no vertex colours"""


class DebugView(IntEnum):
    """Values of Control.VIEW: what the renderer did, drawn instead of the picture."""

    PICTURE = 0
    OVERDRAW = 1
    """how often a pixel was drawn, depth not asked"""
    DEPTH = 2
    """near light, far dark"""
    TRIANGLES = 3
    """each in a colour of its own"""
    BANDS = 4
    """the picture, and how much work each band was"""
    REJECTED = 5
    """how often a pixel was tested and found hidden"""


DECODABLE = Capability.RAW | Capability.RUNS | Capability.SPLIT
_ALL_CAPABILITIES = DECODABLE | Capability.SKIPS_LINES | Capability.INPUT | Capability.ROLL | Capability.SET_BAUD
_CONTROLS_OF_1_1 = 1 << Control.SCENE | 1 << Control.FRAME | 1 << Control.PAUSE


@dataclass(frozen=True)
class Hello:
    """What a device is. `width` in pixels and `height` in lines, 1..2040; `boot_id` differs after each start.

    The members from `input` on are told since version 1.2; before it they have the values given here.
    """

    TYPE: ClassVar = PacketType.HELLO
    _LAYOUT: ClassVar = struct.Struct("<4sBBHHBBHHIII")
    _SINCE_1_2: ClassVar = struct.Struct("<BBIHI")

    width: int
    height: int
    capabilities: Capability
    boot_id: int
    target: str
    firmware: str
    minor: int = 0
    skip_segment: int = 0
    largest_packet: int = 1024
    highest_baud: int = 0
    """0: the link has no rate"""
    input: int = 0
    """number of the INPUT that the device took last"""
    scenes: int = 0
    """how many there are for Control.SCENE; 0: the device does not say"""
    controls: int = 0
    """bit c: it knows control c, 0..31; ask `knows`"""
    views: int = 0
    """bit v: it has the DebugView v; ask `has_view`"""
    baud: int = 0
    """the rate that the link has now, 0: none"""

    def encode(self) -> bytes:
        fixed = self._LAYOUT.pack(
            MAGIC,
            MAJOR,
            self.minor,
            self.width,
            self.height,
            RGB565,
            0,
            self.skip_segment,
            self.largest_packet,
            self.capabilities,
            self.highest_baud,
            self.boot_id,
        )
        body = fixed + _pack_string(self.target) + _pack_string(self.firmware)
        if self.minor < 2:
            return body
        return body + self._SINCE_1_2.pack(self.input, self.scenes, self.controls, self.views, self.baud)

    @classmethod
    def decode(cls, body: bytes) -> Hello:
        """Raises WireError on a broken body, DeviceError on a sound one that this version of the host cannot serve."""
        if len(body) < 6 or body[:4] != MAGIC:
            raise WireError("a HELLO without the magic EDGL")
        if body[4] != MAJOR:
            raise DeviceError(
                f"the device speaks version {body[4]}.{body[5]} of the wire, this host {MAJOR}.{MINOR}: "
                f"update the {'host' if body[4] > MAJOR else 'firmware'}"
            )
        _need(body, cls._LAYOUT.size, "HELLO")
        (_, _, minor, width, height, pixels, _, segment, largest, capabilities, baud, boot_id) = (
            cls._LAYOUT.unpack_from(body)
        )
        if not (1 <= width <= MAX_SIDE and 1 <= height <= MAX_SIDE):
            raise WireError(f"a HELLO with a picture of {width}x{height}")
        target, offset = _unpack_string(body, cls._LAYOUT.size)
        firmware, offset = _unpack_string(body, offset)
        if pixels != RGB565:
            raise DeviceError(f"{target} sends pixel format {pixels}, this host knows RGB565 alone: update the host")
        if not capabilities & DECODABLE:
            raise DeviceError(f"{target} offers no codec that this host knows: update the host")
        known = Capability(capabilities & _ALL_CAPABILITIES)
        since_1_2 = (0, 0, _CONTROLS_OF_1_1 if Capability.INPUT in known else 0, 0, 0)
        if minor >= 2:
            _need(body, offset + cls._SINCE_1_2.size, "HELLO")
            since_1_2 = cls._SINCE_1_2.unpack_from(body, offset)
        return cls(width, height, known, boot_id, target, firmware, minor, segment, largest, baud, *since_1_2)

    @property
    def numbers_inputs(self) -> bool:
        """Whether FRAME_END tells which INPUT it shows."""
        return self.minor >= 2

    def knows(self, control: int) -> bool:
        """Whether INPUT of this control has an effect; what a program does with its own, 128..255, it does not say."""
        if Capability.INPUT not in self.capabilities:
            return False
        return control >= 128 or bool(control < 32 and self.controls >> control & 1)

    def has_view(self, view: int) -> bool:
        """Whether Control.VIEW can be set to `view`."""
        return self.knows(Control.VIEW) and bool(0 <= view < 16 and self.views >> view & 1)


@dataclass(frozen=True)
class Start:
    """Begin, with `credits` frames at once and then one for each credit that an ACK brings; `fps` 0: no limit."""

    TYPE: ClassVar = PacketType.START
    _LAYOUT: ClassVar = struct.Struct("<BBHH")

    credits: int
    fps: int = 0
    codecs: Capability = Capability.RAW | Capability.RUNS
    mode: int = Mode.BLOCK

    def encode(self) -> bytes:
        return self._LAYOUT.pack(self.mode, self.credits, self.fps, self.codecs)

    @classmethod
    def decode(cls, body: bytes) -> Start:
        _need(body, cls._LAYOUT.size, "START")
        mode, count, fps, codecs = cls._LAYOUT.unpack_from(body)
        return cls(count, fps, Capability(codecs & DECODABLE), mode)


@dataclass(frozen=True)
class Band:
    """Lines y0 .. y0 + lines - 1 of `frame`, still encoded: `tokens` u8, then `literals`, RGB565 u16.

    Codec.SPLIT only: `lags` is empty, or has a bit per line; `joined`: the first line depends on the one above.
    """

    TYPE: ClassVar = PacketType.BAND
    _LAYOUT: ClassVar = struct.Struct("<HHBBH")
    _CODEC: ClassVar = 7
    _LAGS: ClassVar = 8
    _JOINED: ClassVar = 16

    frame: int
    y0: int
    lines: int
    codec: Codec
    tokens: bytes
    literals: bytes
    lags: bytes = b""
    joined: bool = False

    def encode(self) -> bytes:
        flags = self.codec | (self._LAGS if self.lags else 0) | (self._JOINED if self.joined else 0)
        fixed = self._LAYOUT.pack(self.frame, self.y0, self.lines, flags, len(self.tokens))
        return fixed + self.lags + self.tokens + self.literals

    @classmethod
    def decode(cls, body: bytes) -> Band:
        _need(body, cls._LAYOUT.size, "BAND")
        frame, y0, lines, flags, tokens = cls._LAYOUT.unpack_from(body)
        if lines == 0:
            raise WireError("a BAND without lines")
        codec = flags & cls._CODEC
        allowed = cls._LAGS | cls._JOINED if codec == Codec.SPLIT else 0
        if codec > max(Codec) or flags & ~(cls._CODEC | allowed):
            raise WireError(f"a BAND with the unknown codec byte 0x{flags:02x}")
        first_token = cls._LAYOUT.size + (-(-lines // 8) if flags & cls._LAGS else 0)
        first_literal = first_token + tokens
        _need(body, first_literal, "BAND")
        return cls(
            frame,
            y0,
            lines,
            Codec(codec),
            body[first_token:first_literal],
            body[first_literal:],
            body[cls._LAYOUT.size : first_token],
            bool(flags & cls._JOINED),
        )


@dataclass(frozen=True)
class FrameEnd:
    """A frame's proof and its cost. Times in microseconds, `time_us` modulo 2^32; `counters` in COUNTERS' order.

    The members from `input` on are told since version 1.2 and are 0 or False before it.
    """

    TYPE: ClassVar = PacketType.FRAME_END
    _LAYOUT: ClassVar = struct.Struct("<HHIIIIHBBIB")
    _MIXED: ClassVar = 1
    _OWING: ClassVar = 2

    frame: int
    bands: int
    time_us: int
    render_us: int
    encode_us: int
    wire_bytes: int
    dropped: int
    digest: int
    counters: tuple[int, ...] = ()
    input: int = 0
    """number of the INPUT that was taken last before the frame began"""
    mixed: bool = False
    """some lines are of earlier frames (ROLL)"""
    cycles: int = 0
    """of the processor while it rendered, modulo 2^32; 0: the board does not count them"""
    owing: bool = False
    """lines that START or KEY asked for are still to come, so a wrong digest is no new damage"""

    def encode(self) -> bytes:
        fixed = self._LAYOUT.pack(
            self.frame,
            self.bands,
            self.time_us,
            self.render_us,
            self.encode_us,
            self.wire_bytes,
            self.dropped,
            self.input,
            (self._MIXED if self.mixed else 0) | (self._OWING if self.owing else 0),
            self.digest,
            len(self.counters),
        )
        return fixed + struct.pack(f"<{len(self.counters) + 1}I", *self.counters, self.cycles)

    @classmethod
    def decode(cls, body: bytes) -> FrameEnd:
        _need(body, cls._LAYOUT.size, "FRAME_END")
        (frame, bands, time_us, render, encode, wire, dropped, number, flags, digest, count) = cls._LAYOUT.unpack_from(
            body
        )
        end = cls._LAYOUT.size + 4 * count
        _need(body, end, "FRAME_END")
        counters = struct.unpack_from(f"<{count}I", body, cls._LAYOUT.size)
        # Before 1.2 the body ends here. Part of a number is no number: a longer body is one of a later minor version.
        (cycles,) = struct.unpack_from("<I", body, end) if len(body) >= end + 4 else (0,)
        return cls(
            frame=frame,
            bands=bands,
            time_us=time_us,
            render_us=render,
            encode_us=encode,
            wire_bytes=wire,
            dropped=dropped,
            digest=digest,
            counters=counters,
            input=number,
            mixed=bool(flags & cls._MIXED),
            cycles=cycles,
            owing=bool(flags & cls._OWING),
        )

    def named_counters(self) -> dict[str, int]:
        """The work counters by name; those of a newer firmware, which this host has no name for, as `counter_N`."""
        names = [*COUNTERS, *(f"counter_{i}" for i in range(len(COUNTERS), len(self.counters)))]
        return dict(zip(names, self.counters, strict=False))


@dataclass(frozen=True)
class Ack:
    """Frame `frame` has been dealt with: `credits` more may come."""

    TYPE: ClassVar = PacketType.ACK
    _LAYOUT: ClassVar = struct.Struct("<HB")

    frame: int
    credits: int

    def encode(self) -> bytes:
        return self._LAYOUT.pack(self.frame, self.credits)

    @classmethod
    def decode(cls, body: bytes) -> Ack:
        _need(body, cls._LAYOUT.size, "ACK")
        return cls(*cls._LAYOUT.unpack_from(body))


@dataclass(frozen=True)
class Key:
    """Send lines y0 .. y0 + lines - 1 afresh with the next frame."""

    TYPE: ClassVar = PacketType.KEY
    _LAYOUT: ClassVar = struct.Struct("<HH")

    y0: int
    lines: int

    def encode(self) -> bytes:
        return self._LAYOUT.pack(self.y0, self.lines)

    @classmethod
    def decode(cls, body: bytes) -> Key:
        _need(body, cls._LAYOUT.size, "KEY")
        return cls(*cls._LAYOUT.unpack_from(body))


@dataclass(frozen=True)
class Ping:
    """Asks for a HELLO and tells the version of the host's wire; before 1.2 it told nothing, which is (0, 0) here."""

    TYPE: ClassVar = PacketType.PING
    _LAYOUT: ClassVar = struct.Struct("<BB")

    major: int = MAJOR
    minor: int = MINOR

    def encode(self) -> bytes:
        return self._LAYOUT.pack(self.major, self.minor)

    @classmethod
    def decode(cls, body: bytes) -> Ping:
        return cls(*cls._LAYOUT.unpack_from(body)) if len(body) >= cls._LAYOUT.size else cls(0, 0)


@dataclass(frozen=True)
class Stop:
    TYPE: ClassVar = PacketType.STOP

    def encode(self) -> bytes:
        return b""

    @classmethod
    def decode(cls, _body: bytes) -> Stop:
        return cls()


@dataclass(frozen=True)
class Input:
    """Sets `control`, 0..255, to `value`, -2^31 .. 2^31 - 1. Only for a device with Capability.INPUT.

    `number` 0..255 is one more than that of the INPUT before; None, as before 1.2: without one.
    """

    TYPE: ClassVar = PacketType.INPUT
    _LAYOUT: ClassVar = struct.Struct("<Bi")

    control: int
    value: int
    number: int | None = None

    def encode(self) -> bytes:
        number = b"" if self.number is None else bytes((self.number,))
        return self._LAYOUT.pack(self.control, self.value) + number

    @classmethod
    def decode(cls, body: bytes) -> Input:
        _need(body, cls._LAYOUT.size, "INPUT")
        control, value = cls._LAYOUT.unpack_from(body)
        return cls(control, value, body[cls._LAYOUT.size] if len(body) > cls._LAYOUT.size else None)


@dataclass(frozen=True)
class SetBaud:
    """Asks for another rate of the link, in bits per second. Only for a device with Capability.SET_BAUD."""

    TYPE: ClassVar = PacketType.SET_BAUD
    _LAYOUT: ClassVar = struct.Struct("<I")

    rate: int

    def encode(self) -> bytes:
        return self._LAYOUT.pack(self.rate)

    @classmethod
    def decode(cls, body: bytes) -> SetBaud:
        _need(body, cls._LAYOUT.size, "SET_BAUD")
        return cls(*cls._LAYOUT.unpack_from(body))


@dataclass(frozen=True)
class Baud:
    """The answer: the rate that the link will have when this packet's last bit is out; the present one is a no."""

    TYPE: ClassVar = PacketType.BAUD
    _LAYOUT: ClassVar = struct.Struct("<I")

    rate: int

    def encode(self) -> bytes:
        return self._LAYOUT.pack(self.rate)

    @classmethod
    def decode(cls, body: bytes) -> Baud:
        _need(body, cls._LAYOUT.size, "BAUD")
        return cls(*cls._LAYOUT.unpack_from(body))


@dataclass(frozen=True)
class Log:
    """A line for the user's log."""

    TYPE: ClassVar = PacketType.LOG

    text: str

    def encode(self) -> bytes:
        return self.text.encode()

    @classmethod
    def decode(cls, body: bytes) -> Log:
        return cls(_utf8(body, "LOG"))


Body = Hello | Start | Band | FrameEnd | Ack | Key | Ping | Stop | Input | Log | SetBaud | Baud

_BODIES: dict[int, type[Body]] = {
    body.TYPE: body for body in (Hello, Start, Band, FrameEnd, Ack, Key, Ping, Stop, Input, Log, SetBaud, Baud)
}


def pack(body: Body, seq: int) -> Packet:
    """`body` as the packet with the number `seq`, 0..255."""
    return Packet(body.TYPE, seq, body.encode())


def unpack(packet: Packet) -> Body | None:
    """The packet's body, or None if its type is unknown here (a newer minor version's). Raises as `decode` does."""
    body = _BODIES.get(packet.type)
    return None if body is None else body.decode(packet.body)


def _need(body: bytes, size: int, name: str) -> None:
    if len(body) < size:
        raise WireError(f"a {name} of {len(body)} bytes where it needs {size}")


def _utf8(raw: bytes, name: str) -> str:
    try:
        return raw.decode()
    except UnicodeDecodeError:
        raise WireError(f"a {name} whose text is not UTF-8") from None


def _pack_string(text: str) -> bytes:
    raw = text.encode()
    return bytes((len(raw),)) + raw


def _unpack_string(body: bytes, offset: int) -> tuple[str, int]:
    _need(body, offset + 1, "HELLO")
    end = offset + 1 + body[offset]
    _need(body, end, "HELLO")
    return _utf8(body[offset + 1 : end], "HELLO"), end
