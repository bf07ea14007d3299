"""One conversation with one device: bytes in, typed events out, bytes to send out (WIRE.md, "Session").

No I/O, and the time is an argument, so that tests drive it to the microsecond. What it sees to:

* PING until there is a HELLO, then START. A HELLO with another boot id, or one where frames should come, begins anew;
  so does silence, because then the credits may be lost with a FRAME_END that never arrived.
* A frame leaves as an event only if all of its bands arrived and its digest is that of the session's own picture.
* After damage, a gap in seq or a wrong digest: KEY for all lines, once for as many frames as may be on their way.
* INPUT that was given before the HELLO goes out ahead of START, so that the first frame shows it; to a device that has
  been started anew all controls are told again, and after silence to one that is to stand still.
* ACK for every FRAME_END, good or not. The credit has to go back either way, or two damaged frames would end it all.
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass, field
from enum import Enum, auto

import numpy as np

from edgeline import codec, framing, protocol
from edgeline.codec import PIXEL, Pixels
from edgeline.errors import DeviceError, EdgelineError, WireError
from edgeline.protocol import Hello

CREDITS = 2
"""One frame on its way, one being drawn."""

PING_INTERVAL_S = 0.5
STALL_S = 2.0
"""Silence after which the session begins anew. Doubled each time in vain, lest a slow renderer be restarted forever."""

LONGEST_STALL_S = 16.0
HELLO_ECHO_S = 0.5
"""For this long after START a HELLO is the answer to an earlier PING, not a call for another START."""


class State(Enum):
    WAITING = auto()
    """for a HELLO"""
    READY = auto()
    """it is there, and START has not been asked for, or STOP has"""
    STREAMING = auto()
    REFUSED = auto()
    """the device speaks another version"""


@dataclass(frozen=True)
class Connected:
    """A device is there. `restarted`: it has been started anew since the last time."""

    hello: Hello
    restarted: bool


@dataclass(frozen=True)
class Frame:
    """A verified frame. `picture` is RGB565, uint16 of shape (height, width), read-only and not touched again."""

    number: int
    picture: Pixels
    end: protocol.FrameEnd

    @property
    def counters(self) -> dict[str, int]:
        """The renderer's work counters by name (firmware/src/base/stats.h)."""
        return self.end.named_counters()


@dataclass(frozen=True)
class Damage:
    """Something arrived that was not what the device sent, or did not arrive. It has been asked for again."""

    reason: str


@dataclass(frozen=True)
class Log:
    """Text from the device: a LOG packet, or printable bytes between packets."""

    text: str


@dataclass(frozen=True)
class Stalled:
    """Nothing arrived for `seconds`; the session asks for a HELLO again."""

    seconds: float


@dataclass(frozen=True)
class Refused:
    """The device cannot be served; nothing more will be sent or said."""

    error: DeviceError


Event = Connected | Frame | Damage | Log | Stalled | Refused


@dataclass
class Counts:
    """What has passed since the session began. `damaged` counts from the first HELLO on: what comes before may be the
    tail of a packet that was under way when the port was opened."""

    bytes_received: int = 0
    packets: int = 0
    frames: int = 0
    damaged: int = 0
    keys_sent: int = 0


@dataclass
class _Assembly:
    """The frame that is arriving."""

    frame: int
    bands: int = 0
    next_y: int = 0
    gap: bool = False


@dataclass
class Session:
    """`autostart` False stops at the HELLO. `fps` 0: as fast as the device goes."""

    autostart: bool = True
    fps: int = 0
    counts: Counts = field(default_factory=Counts)
    hello: Hello | None = None
    state: State = State.WAITING

    def __post_init__(self) -> None:
        self._splitter = framing.Splitter()
        self._outgoing = bytearray()
        self._inputs: dict[int, int] = {}
        self._seq_out = 0
        self._seq_in: int | None = None
        self._last_ping: float | None = None
        self._last_packet = 0.0
        self._started = 0.0
        self._stall_s = STALL_S
        self._key_covers = 0
        self._assembly: _Assembly | None = None
        self._finished: int | None = None
        self._picture: Pixels = np.zeros((0, 0), PIXEL)
        self._line_crcs = np.zeros(0, "<u4")

    def receive(self, data: bytes, now: float) -> list[Event]:
        """Takes the next bytes from the device; `now` in seconds of any steady clock."""
        self.counts.bytes_received += len(data)
        events: list[Event] = []
        for chunk in self._splitter.feed(data):
            if self.state is State.REFUSED:
                break
            if isinstance(chunk, framing.Packet):
                events += self._packet(chunk, now)
            elif isinstance(chunk, framing.Damaged):
                events += self._damage(f"{chunk.reason} ({chunk.size} bytes)")
            elif chunk.text:
                events.append(Log(chunk.text))
        return events

    def tick(self, now: float) -> list[Event]:
        """Lets time pass. To be called often, a few times per PING_INTERVAL_S at least."""
        events: list[Event] = []
        silence = now - self._last_packet
        if self.state is State.STREAMING and silence > self._stall_s:
            self._stall_s = min(2 * self._stall_s, LONGEST_STALL_S)
            self.state = State.WAITING
            events.append(Stalled(silence))
        due = self._last_ping is None or now - self._last_ping >= PING_INTERVAL_S
        if self.state is State.WAITING and due:
            self._last_ping = now
            self._send(protocol.Ping())
        return events

    def stop(self) -> None:
        """Ends the stream politely: a device that is told does not wait for credits."""
        if self.state is State.STREAMING:
            self._send(protocol.Stop())
            self.state = State.READY

    def input(self, control: int, value: int) -> None:
        """Sets one of the device's controls (protocol.Control, or 128..255: the program's own) to `value`, -2^31 ..
        2^31 - 1; before the HELLO, as soon as it is there.

        Raises EdgelineError on numbers that do not fit, DeviceError if the device takes no INPUT. If that is found out
        later, it is Refused.
        """
        if not (0 <= control <= 255 and -(2**31) <= value < 2**31):
            raise EdgelineError(f"control {control} = {value}: a control is 0..255, its value a signed 32-bit number")
        if self.hello is not None:
            _need_input(self.hello)
            self._send(protocol.Input(control, value))
        self._inputs.pop(control, None)  # the order counts: SCENE sets the frame, too
        self._inputs[control] = value

    def bytes_to_send(self) -> bytes:
        """What has to go to the device now; each byte is given once."""
        data = bytes(self._outgoing)
        self._outgoing.clear()
        return data

    def _send(self, body: protocol.Body) -> None:
        self._outgoing += framing.encode(protocol.pack(body, self._seq_out))
        self._seq_out = self._seq_out + 1 & 0xFF

    def _packet(self, packet: framing.Packet, now: float) -> list[Event]:
        self.counts.packets += 1
        self._last_packet = now
        try:
            body = protocol.unpack(packet)
        except DeviceError as error:
            self.state = State.REFUSED
            return [Refused(error)]
        except WireError as error:
            return self._sequence(packet.seq) + self._damage(str(error))
        if isinstance(body, Hello):
            if self.hello is not None and body.boot_id != self.hello.boot_id:
                self._seq_in = None
            return self._sequence(packet.seq) + self._greet(body, now)
        events = self._sequence(packet.seq)
        if isinstance(body, protocol.Log):
            events.append(Log(body.text))
        elif isinstance(body, protocol.Band) and self.state is State.STREAMING:
            events += self._band(body)
        elif isinstance(body, protocol.FrameEnd) and self.state is State.STREAMING:
            events += self._frame_end(body)
        return events

    def _sequence(self, seq: int) -> list[Event]:
        expected, self._seq_in = self._seq_in, seq + 1 & 0xFF
        if expected is None or seq == expected:
            return []
        if self._assembly is not None:
            self._assembly.gap = True
        return self._damage(f"packet {seq} arrived where {expected} was due")

    def _greet(self, hello: Hello, now: float) -> list[Event]:
        known, self.hello = self.hello, hello
        restarted = known is not None and known.boot_id != hello.boot_id
        if self.state is State.STREAMING and not restarted and now - self._started < HELLO_ECHO_S:
            return []
        if self.state is State.READY and not restarted:
            return []
        # Where the scene stands still, telling again changes nothing if they had arrived; in silence they may not have.
        stands_still = self._inputs.get(protocol.Control.PAUSE) == 1
        if self._inputs and (known is None or restarted or stands_still):
            try:
                _need_input(hello)
            except DeviceError as error:
                self.state = State.REFUSED
                return [Refused(error)]
            for control, value in self._inputs.items():
                self._send(protocol.Input(control, value))
        self.state = State.READY
        if self.autostart:
            self._start(hello, now)
        return [] if known == hello else [Connected(hello, restarted)]

    def _start(self, hello: Hello, now: float) -> None:
        self.state = State.STREAMING
        self._started = now
        self._assembly = None
        self._finished = None
        self._key_covers = 0
        self._picture = np.zeros((hello.height, hello.width), PIXEL)
        blank = zlib.crc32(bytes(2 * hello.width))
        self._line_crcs = np.full(hello.height, blank, "<u4")
        codecs = hello.capabilities & protocol.DECODABLE
        self._send(protocol.Start(CREDITS, self.fps, codecs))

    def _band(self, band: protocol.Band) -> list[Event]:
        height, width = self._picture.shape
        if self._assembly is None or self._assembly.frame != band.frame:
            self._abandon()
            self._assembly = _Assembly(band.frame)
        assembly = self._assembly
        if band.y0 < assembly.next_y or band.y0 + band.lines > height:
            return self._damage(f"frame {band.frame}: a band of {band.lines} lines at line {band.y0} is out of place")
        try:
            pixels = codec.decode(band, width)
        except WireError as error:
            return self._damage(f"frame {band.frame}: {error}")
        self._picture[band.y0 : band.y0 + band.lines] = pixels
        for y, line in enumerate(pixels, band.y0):
            self._line_crcs[y] = zlib.crc32(line)
        assembly.bands += 1
        assembly.next_y = band.y0 + band.lines
        return []

    def _abandon(self) -> None:
        """The next frame begins, and this one's FRAME_END was lost: its credit would be lost with it."""
        if self._assembly is not None and self._assembly.gap:
            self._send(protocol.Ack(self._assembly.frame, 1))
        self._assembly = None

    def _frame_end(self, end: protocol.FrameEnd) -> list[Event]:
        if end.frame == self._finished:
            return []
        if self._assembly is not None and self._assembly.frame != end.frame:
            self._abandon()
        bands = self._assembly.bands if self._assembly is not None else 0
        self._assembly = None
        self._finished = end.frame
        events: list[Event] = []
        if bands != end.bands:
            events += self._damage(f"frame {end.frame}: {bands} of {end.bands} bands arrived")
        elif zlib.crc32(self._line_crcs.tobytes()) != end.digest:
            events += self._damage(f"frame {end.frame}: the picture's digest is wrong")
        else:
            self.counts.frames += 1
            self._key_covers = 0
            self._stall_s = STALL_S
            picture = self._picture.copy()
            picture.flags.writeable = False
            events.append(Frame(end.frame, picture, end))
        self._key_covers = max(0, self._key_covers - 1)
        self._send(protocol.Ack(end.frame, 1))
        return events

    def _damage(self, reason: str) -> list[Event]:
        self.counts.damaged += self.hello is not None
        if self.state is State.STREAMING and self.hello is not None and self._key_covers == 0:
            # The device reads KEY before it has the credit for frame k + CREDITS, so that frame is whole at the latest;
            # the ones until then may fail without another KEY.
            self._key_covers = CREDITS
            self.counts.keys_sent += 1
            self._send(protocol.Key(0, self.hello.height))
        return [Damage(reason)]


def _need_input(hello: Hello) -> None:
    if not hello.capabilities & protocol.Capability.INPUT:
        raise DeviceError(f"{hello.target}, {hello.firmware}: takes no INPUT, so its scene cannot be chosen")
