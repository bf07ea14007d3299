"""One conversation with one device: bytes in, typed events out, bytes to send out (WIRE.md, "Session").

No I/O, and the time is an argument, so that tests drive it to the microsecond. What it sees to:

* PING until there is a HELLO, then START. A HELLO with another boot id, or one where frames should come, begins anew;
  so does silence, because then the credits may be lost with a FRAME_END that never arrived.
* A frame leaves as an event only if all of its bands arrived and its digest is that of the session's own picture; what
  is missing is asked for again (stream.py, picture.py).
* INPUT that arrives once each and in order (inputs.py), the link's rate (rate.py), how good the link is (quality.py).
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from enum import Enum, auto

from edgeline import framing, protocol
from edgeline.errors import DeviceError, EdgelineError, WireError
from edgeline.events import (
    Connected,
    Damage,
    Event,
    Frame,
    Log,
    Partial,
    RateChanged,
    Refused,
    SetRate,
    Stalled,
)
from edgeline.inputs import Inputs
from edgeline.protocol import Capability, Hello, Mode
from edgeline.quality import Counts, LinkQuality, Statistics, Tally
from edgeline.rate import SILENCE_S, Rate, can_change
from edgeline.stream import CREDITS, Clock, Stream

__all__ = [
    "CREDITS",
    "Connected",
    "Counts",
    "Damage",
    "Event",
    "Frame",
    "Log",
    "Partial",
    "RateChanged",
    "Refused",
    "Session",
    "SetRate",
    "Stalled",
    "State",
]

PING_INTERVAL_S = 0.5
USUAL_PAUSES = 10
SHORTEST_STALL_S = 0.5
STALL_S = 2.0
"""Silence after which the session begins anew: so many usual pauses between packets, from the shortest to this. With
both credits lost, which takes two lost ACKs since START, a device says nothing for a second. Doubled each time in vain,
up to the longest, lest a slow renderer be restarted forever."""

LONGEST_STALL_S = 16.0
MOST_DOUBLINGS = 5
PAUSE_DECAY = 0.95
"""What is left of a long pause with each packet that follows."""

HELLO_ECHO_S = 0.5
"""For this long after START a HELLO is the answer to an earlier PING, not a call for another START."""

AWAY_S = 1.0
"""Who is not called for longer than this has not been listening, and cannot call it silence."""


MOST_TEXT = 4096
"""Characters of a Log; a packet could hold sixteen times as many."""


class State(Enum):
    WAITING = auto()
    """for a HELLO"""
    READY = auto()
    """it is there, and START has not been asked for, or STOP has"""
    RETUNING = auto()
    """the link's rate is being changed"""
    STREAMING = auto()
    REFUSED = auto()
    """the device cannot be served"""


@dataclass
class Session:
    """`autostart` False stops at the HELLO. `fps` 0: as fast as the device goes.

    `one_way`: nobody hears what is said (a recording, a pipe), so nothing is, and silence means nothing. `baud` is the
    rate that the port was opened at, 0 if it has none; `fast` the one to go on with, 0 for the device's highest, None
    to stay.
    """

    autostart: bool = True
    fps: int = 0
    mode: Mode = Mode.BLOCK
    one_way: bool = False
    baud: int = 0
    fast: int | None = None
    codecs: Capability = protocol.DECODABLE
    counts: Counts = field(default_factory=Counts)
    hello: Hello | None = None
    state: State = State.WAITING

    def __post_init__(self) -> None:
        if not 0 <= self.fps <= 0xFFFF:
            raise EdgelineError(f"{self.fps} frames per second: 0..65535, 0 for all that the device can")
        _check_rate(self.fast or 0)
        self._splitter = framing.Splitter()
        self._outgoing = bytearray()
        self._inputs = Inputs()
        self._tally = Tally(self.counts)
        self._clock = Clock()
        self._rate: Rate | None = None
        self._stream: Stream | None = None
        self._now: float | None = None
        self._seq_out = 0
        self._seq_in: int | None = None
        self._last_packet: framing.Packet | None = None
        self._heard = 0.0
        self._pinged: float | None = None
        self._started = 0.0
        self._restarts_in_vain = 0
        self._usual_pause_s = STALL_S

    # --- what the owner calls ----------------------------------------------------------------------------------------

    def receive(self, data: bytes, now: float) -> list[Event]:
        """Takes the next bytes from the device; `now` in seconds of any steady clock."""
        self._now = now
        self._tally.received(len(data), now)
        events: list[Event] = []
        for chunk in self._splitter.feed(data):
            if self.state is State.REFUSED:
                break
            if isinstance(chunk, framing.Packet):
                events += self._packet(chunk, now)
            elif isinstance(chunk, framing.Damaged):
                # If this was a packet, a gap in seq follows; if it came between two, nothing is lost.
                events += self._damage(f"{chunk.reason} ({chunk.size} bytes)", now)
            elif chunk.text:
                events.append(Log(chunk.text[:MOST_TEXT]))
        self._send_inputs(now)
        return events

    def tick(self, now: float) -> list[Event]:
        """Lets time pass. To be called often, a few times per PING_INTERVAL_S at least."""
        if self._now is not None and now - self._now > AWAY_S:
            self._heard = now
        self._now = now
        if self.one_way or self.state is State.REFUSED:
            return []
        events: list[Event] = []
        silence = now - self._heard
        if self.state is State.STREAMING and silence > self._longest_pause_s():
            self._restarts_in_vain = min(self._restarts_in_vain + 1, MOST_DOUBLINGS)
            self.state = State.WAITING
            events.append(Stalled(silence))
        if self._rate is not None:
            events += self._tune(self._rate, silence, now)
        if self.state is State.WAITING and (self._pinged is None or now - self._pinged >= PING_INTERVAL_S):
            self._ping(now)
        self._send_inputs(now)
        return events

    def _longest_pause_s(self) -> float:
        pause = min(STALL_S, max(SHORTEST_STALL_S, USUAL_PAUSES * self._usual_pause_s))
        return min(LONGEST_STALL_S, pause * 2.0**self._restarts_in_vain)

    def stop(self) -> None:
        """Ends the stream politely: a device that is told does not wait for credits."""
        if self.state is State.STREAMING:
            self._send(protocol.Stop())
            self.state = State.READY

    def close(self) -> None:
        """As `stop`, and leaves the device at the link's first rate, where the next host will look for it."""
        self.stop()
        if self._rate is not None and self._rate.raised and self.state is not State.REFUSED:
            self._send(protocol.SetBaud(self._rate.first))

    def input(self, control: int, value: int) -> None:
        """Sets one of the device's controls (protocol.Control, or 128..255: the program's own) to `value`, -2^31 ..
        2^31 - 1; before the HELLO, as soon as it is there. Each arrives once and in order (from wire 1.2 on); of those
        that wait, the newest YAW .. VIEW replaces the one before.

        Raises EdgelineError on numbers that do not fit or when more than a thousand wait, DeviceError if the device
        does not take it or cannot be told. If that is found out later, it is Refused.
        """
        if not (_is_whole(control, 0, 255) and _is_whole(value, -(2**31), 2**31 - 1)):
            raise EdgelineError(f"control {control} = {value}: a control is 0..255, its value a signed 32-bit number")
        if self.one_way:
            raise DeviceError("this stream is one-way (a recording, a pipe): there is nobody to take INPUT")
        if self.hello is not None:
            _need_values(self.hello, ((control, value),))
        self._inputs.ask(control, value)
        if self._now is not None:
            self._send_inputs(self._now)

    @property
    def inputs_waiting(self) -> int:
        """How many INPUTs the device is not known to have taken."""
        return self._inputs.waiting

    def request_baud(self, rate: int = 0) -> None:
        """Changes the link's rate to `rate`, 0 for the device's highest; RateChanged tells what came of it.

        Raises EdgelineError if that is no rate, DeviceError if the device's link has none to change.
        """
        _check_rate(rate)
        self.fast = rate
        if self.hello is None or self._rate is None:
            return
        if self.one_way or not can_change(self.hello):
            raise DeviceError(_fixed_rate(self.hello))
        self._rate.wish(rate)
        if self.state in (State.READY, State.STREAMING) and self._now is not None:
            self._retune(self._rate, self.hello, self._now)

    def refuse_rate(self, now: float) -> list[Event]:
        """The port cannot do what SetRate asked for. The device comes back to its first rate by itself; then a more
        common one is tried."""
        if self._rate is None:
            return []
        events = self._rate.refuse()
        self._go_on(self._rate, now)
        return events

    @property
    def retuning(self) -> bool:
        """The link's rate is being changed, or will be."""
        pending = self._rate is not None and self.hello is not None and self._rate.goal(self.hello) is not None
        return self.state is State.RETUNING or pending

    @property
    def rate(self) -> int:
        """The link's rate in bits per second, 0 if it has none."""
        return self._rate.now if self._rate is not None else self.baud

    def quality(self, now: float | None = None) -> LinkQuality:
        """How good the link was in the last seconds before `now`, which is by default the latest that is known."""
        return self._tally.meter.quality(self._now or 0.0 if now is None else now)

    def statistics(self, now: float | None = None) -> Statistics:
        """What it carried in the last seconds, likewise."""
        return self._tally.meter.statistics(self._now or 0.0 if now is None else now)

    def bytes_to_send(self) -> bytes:
        """What has to go to the device now; each byte is given once."""
        data = bytes(self._outgoing)
        self._outgoing.clear()
        self.counts.bytes_sent += len(data)
        return data

    # --- packets -----------------------------------------------------------------------------------------------------

    def _send(self, body: protocol.Body) -> None:
        if not self.one_way:
            self._outgoing += framing.encode(protocol.pack(body, self._seq_out))
            self._seq_out = self._seq_out + 1 & 0xFF

    def _ping(self, now: float) -> None:
        self._pinged = now
        self._send(protocol.Ping())

    def _send_inputs(self, now: float) -> None:
        if self.hello is not None and self.state in (State.READY, State.STREAMING):
            for body in self._inputs.due(now, self._stream.credits if self._stream is not None else 0):
                self._send(body)
            self.counts.inputs_resent = self._inputs.resent

    def _packet(self, packet: framing.Packet, now: float) -> list[Event]:
        self._tally.packet(now)
        pause_s, self._heard = now - self._heard, now
        if packet == self._last_packet and self._seq_in == packet.seq + 1 & 0xFF:
            return self._damage(f"packet {packet.seq} came twice", now)
        self._last_packet = packet
        try:
            body = protocol.unpack(packet)
        except DeviceError as error:
            return self._refuse(error)
        except WireError as error:
            events = self._sequence(packet.seq, now)
            self._lost_packets()
            return events + self._damage(str(error), now)
        if isinstance(body, Hello) and self.hello is not None and body.boot_id != self.hello.boot_id:
            self._seq_in = None
        events = self._sequence(packet.seq, now)
        stream = self._stream if self.state is State.STREAMING else None
        if isinstance(body, Hello):
            events += self._greet(body, now)
        elif isinstance(body, protocol.Log):
            events.append(Log(body.text[:MOST_TEXT]))
        elif isinstance(body, protocol.Band | protocol.FrameEnd) and stream is not None:
            self._usual_pause_s = max(pause_s, PAUSE_DECAY * self._usual_pause_s)
            if isinstance(body, protocol.Band):
                events += stream.band(body, now)
            else:
                self._restarts_in_vain = 0
                events += stream.end(body, now)
        elif isinstance(body, protocol.Baud) and self._rate is not None:
            events += self._rate.answer(body.rate, now)
            self._go_on(self._rate, now)
        return events

    def _sequence(self, seq: int, now: float) -> list[Event]:
        expected, self._seq_in = self._seq_in, seq + 1 & 0xFF
        if expected is None or seq == expected:
            return []
        lost = seq - expected & 0xFF
        if lost < 128:  # else it is one that comes late, and nothing new is lost
            self._tally.lost(lost, now)
        self._lost_packets()
        return self._damage(f"packet {seq} arrived where {expected} was due", now)

    def _lost_packets(self) -> None:
        if self._stream is not None:
            self._stream.lost_packets()

    def _damage(self, reason: str, now: float) -> list[Event]:
        if self.state is State.RETUNING:
            return []  # bytes at one rate, read at another
        if self.hello is not None:
            self._tally.damaged(now)
        return [Damage(reason)]

    def _refuse(self, error: DeviceError) -> list[Event]:
        self.state = State.REFUSED
        return [Refused(error)]

    # --- the device is there -----------------------------------------------------------------------------------------

    def _greet(self, hello: Hello, now: float) -> list[Event]:
        known, self.hello = self.hello, hello
        restarted = known is not None and known.boot_id != hello.boot_id
        events: list[Event] = []
        if known is None or _identity(known) != _identity(hello):
            events.append(Connected(hello, restarted))
        if known is None:
            try:
                _need_values(hello, self._inputs.values)
                _need_mode(hello, self.mode)
            except DeviceError as error:
                return self._refuse(error)
            if self.fast is not None and not self.one_way and not can_change(hello):
                events.append(RateChanged(self.baud, _fixed_rate(hello)))
        if self._rate is None:
            self._rate = Rate(self.baud, self.fast)
        self._rate.met(hello, restarted)
        if restarted:
            self._clock.restarted()
        self._inputs.greet(hello, restarted, self._pinged)
        if self.state is State.RETUNING:
            events += self._rate.hello()
            self._go_on(self._rate, now)
            return events
        resized = known is not None and (known.width, known.height) != (hello.width, hello.height)
        if known is not None and not restarted and not resized:
            echo = self.one_way or now - self._started < HELLO_ECHO_S
            if self.state is State.READY or (self.state is State.STREAMING and echo):
                return events
        self.state = State.READY
        if self.autostart:
            self._start(self._rate, hello, now)
        return events

    def _start(self, rate: Rate, hello: Hello, now: float) -> None:
        if self._retune(rate, hello, now):
            return
        self._send_inputs(now)
        self._inputs.restart()
        size = hello.width, hello.height
        self._stream = Stream(
            size, self.mode, say=self._send, inputs=self._inputs, tally=self._tally, clock=self._clock
        )
        self._send(protocol.Start(CREDITS, self.fps, hello.capabilities & self.codecs, self.mode))
        self.state = State.STREAMING
        self._started = now

    # --- the link's rate ---------------------------------------------------------------------------------------------

    def _retune(self, rate: Rate, hello: Hello, now: float) -> bool:
        """Begins to change the link's rate if another one is wished for."""
        goal = None if self.one_way else rate.goal(hello)
        if goal is not None:
            self._stop_for(rate.begin(goal, now))
        return goal is not None

    def _stop_for(self, bodies: list[protocol.Body]) -> None:
        self.stop()
        self.state = State.RETUNING
        for body in bodies:
            self._send(body)

    def _tune(self, rate: Rate, silence: float, now: float) -> list[Event]:
        """What the rate's clock has to say."""
        if rate.busy:
            bodies, events = rate.tick(now)
            for body in bodies:
                self._send(body)
            self._go_on(rate, now)
            return events
        if rate.raised and silence > SILENCE_S:
            self.state = State.WAITING
            return rate.fall_back(f"nothing for {SILENCE_S:g} s at {rate.now} baud")
        if rate.raised and self.state is State.STREAMING and self._tally.meter.covers(now):
            quality = self._tally.meter.quality(now)
            if rate.is_bad(quality):
                self._stop_for(rate.bring_back(f"{100 * quality.failed_share:.0f} % of the frames failed", now))
        return []

    def _go_on(self, rate: Rate, now: float) -> None:
        """Where a change of the rate has come to an end: asks who is there, since nothing else is certain."""
        if self.state is State.RETUNING and not rate.busy:
            self.state = State.WAITING
            self._heard = now
            self._seq_in = None
            self._tally.meter.clear()
            self._ping(now)


def _identity(hello: Hello) -> Hello:
    """Without what changes from one HELLO of a device to the next."""
    return replace(hello, input=0, baud=0)


_RANGES: dict[int, tuple[int, int]] = {
    protocol.Control.FRAME: (0, 2**31 - 1),
    protocol.Control.PAUSE: (0, 1),
    protocol.Control.STEP: (1, 2**31 - 1),
    protocol.Control.PITCH: (-16384, 16384),
    protocol.Control.ZOOM: (-1024, 1024),
    protocol.Control.PAN_X: (-4096, 4096),
    protocol.Control.PAN_Y: (-4096, 4096),
    protocol.Control.SHADING: (0, 3),
    protocol.Control.TEXTURE_ERROR: (0, 5),
}
"""WIRE.md, "INPUT". A device ignores what lies outside."""


def _need_values(hello: Hello, values: tuple[tuple[int, int], ...]) -> None:
    """Raises DeviceError where the device is known to ignore one of the (control, value)."""
    device = f"{hello.target}, {hello.firmware}"
    if values and Capability.INPUT not in hello.capabilities:
        raise DeviceError(f"{device}: takes no INPUT, so its scene cannot be chosen")
    names = {member.value: member.name for member in protocol.Control}
    for control, value in values:
        name = names.get(control, str(control))
        if not hello.knows(control):
            raise DeviceError(f"{device}: has no control {name}")
        if control == protocol.Control.SCENE and hello.scenes and not 0 <= value < hello.scenes:
            raise DeviceError(f"{device}: has no scene {value}: they are 0..{hello.scenes - 1}")
        if control == protocol.Control.VIEW and not hello.has_view(value):
            raise DeviceError(f"{device}: has no debug view {value}")
        low, high = _RANGES.get(control, (-(2**31), 2**31 - 1))
        if not low <= value <= high:
            raise DeviceError(f"{name} {value}: it takes {low}..{high}")


def _is_whole(value: object, low: int, high: int) -> bool:
    return isinstance(value, int) and low <= value <= high


def _need_mode(hello: Hello, mode: Mode) -> None:
    if mode is Mode.ROLL and Capability.ROLL not in hello.capabilities:
        raise DeviceError(f"{hello.target}, {hello.firmware}: does not know the mode roll: use block")


def _check_rate(rate: int) -> None:
    if not 0 <= rate < 2**32:
        raise EdgelineError(f"{rate} is no rate of a link")


def _fixed_rate(hello: Hello) -> str:
    return f"{hello.target}, {hello.firmware}: its link's rate cannot be changed"
