"""A recording that plays the device: what `edgeline replay` puts behind a pty or a TCP port.

No I/O and no clock, as the host's session has none: bytes and a time in, bytes out. It keeps the device's side of
WIRE.md (HELLO, START, credits, KEY, STOP, silence), sends the recorded packets at their times, numbered anew, and
offers no INPUT, ROLL or SET_BAUD, for what was recorded cannot be changed. STOP, and a host that has gone, rewind it. A
START or KEY in its middle is answered as a cut begins: by the next verified frame, told anew (`snapshot`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import chain

from edgeline import framing, protocol
from edgeline.errors import EdgelineError, StreamError
from edgeline.follow import Step
from edgeline.framing import Packet, Text
from edgeline.protocol import Capability, Hello, PacketType
from edgeline.recording import DamagedRecordingError, Direction
from edgeline.snapshot import packets, snapshot

HELLO_INTERVAL_S = 1.0
LONGEST_WAIT_S = 0.05
ABSENT_S = 1.0
"""A host that lets the credits run out and says nothing for so long has gone."""

_PLAYED = Capability.RAW | Capability.RUNS | Capability.SPLIT | Capability.SKIPS_LINES
_MOST_CREDITS = 255


class Player:
    """Plays the steps that `begin` gives anew at each rewinding, `speed` times as fast as recorded, None: as fast as
    the host takes them; `loop` for ever, and `most` frames at most.

    Raises StreamError if the recording has no HELLO, and what `begin` raises.
    """

    def __init__(
        self,
        begin: Callable[[], Iterator[Step]],
        speed: float | None = 1.0,
        *,
        loop: bool = False,
        most: int | None = None,
    ) -> None:
        self.frames = 0
        """sent since it was rewound"""
        self.wait_s = 0.0
        """when `run` should be called again at the latest, if nothing is heard before"""
        self.ended = False
        """The recording is at its end; the host may still be reading."""
        self.damage: DamagedRecordingError | None = None
        """the end is where the recording is damaged"""
        self._begin = begin
        self._speed = speed
        self._loop = loop
        self._most = most
        self._splitter = framing.Splitter()
        self._outgoing = bytearray()
        self._seq = 0
        self._starts = 0
        self._refused = False
        self._streaming = False
        self._last_heard = 0.0
        self._next_hello = 0.0
        self.rewind()

    def rewind(self) -> None:
        """Back to the beginning, and to waiting for START."""
        self.frames = 0
        self.ended = False
        self._frames_before = 0
        self._credits = 0
        self._unconfirmed = 0
        self._begin_anew()
        self._open()

    def _open(self) -> None:
        self._steps = (step for step in self._begin() if step.piece.direction is Direction.FROM_DEVICE)
        self._next: Step | None = None
        self._due_from: float | None = None
        self._join_from_here = False
        self._hello = self._first_hello()

    def leave(self) -> None:
        """The host has gone, or has had enough. Rewinds, unless it has had every frame: then this is the end."""
        self._unconfirmed = 0
        if self.frames and not self.ended and not self._loop:
            self.ended = not self._has_more_frames()
        if not self.ended:
            self.rewind()

    @property
    def streaming(self) -> bool:
        """A host has asked for the frames."""
        return self._streaming

    @property
    def confirmed(self) -> bool:
        """The host has read every frame that was sent."""
        return self._unconfirmed == 0 and not self._outgoing

    def receive(self, data: bytes, now: float) -> None:
        """Takes what the host says; what is no packet of this wire is passed over."""
        for chunk in self._splitter.feed(data):
            if not isinstance(chunk, Packet):
                continue
            self._last_heard = now
            try:
                body = protocol.unpack(chunk)
            except EdgelineError:
                continue
            if isinstance(body, protocol.Ping):
                self._greet(body)
            elif self._refused:
                continue
            elif isinstance(body, protocol.Start):
                self._start(body)
            elif isinstance(body, protocol.Ack):
                self._credits = min(_MOST_CREDITS, self._credits + body.credits)
                self._unconfirmed = max(0, self._unconfirmed - body.credits)
            elif isinstance(body, protocol.Key):
                self._join_late = self._streaming
            elif isinstance(body, protocol.Stop):
                self.leave()

    def run(self, now: float) -> bytes:
        """What goes to the host now: answers, and at most one packet of the recording. To be called again at once while
        it gives bytes."""
        self.wait_s = LONGEST_WAIT_S
        if not self._streaming:
            if now >= self._next_hello:
                self._next_hello = now + HELLO_INTERVAL_S
                self._send(self._offer())
        elif self._credits == 0 and not self.ended:
            self._due_from = None  # the time stands still while the host is not ready
            if now - self._last_heard > ABSENT_S:
                self.leave()
        elif not self.ended:
            self._play(now)
        data = bytes(self._outgoing)
        self._outgoing.clear()
        return data

    def _greet(self, ping: protocol.Ping) -> None:
        self._send(self._offer())
        self._refused = ping.major not in (0, protocol.MAJOR)  # 0: it does not say, which is 1
        if self._refused:
            own = f"this device has version {protocol.MAJOR} of the wire"
            self._send(protocol.Log(f"{own} and takes nothing from a host of version {ping.major}"))
            self.leave()

    def _start(self, start: protocol.Start) -> None:
        missing = self._hello.capabilities & protocol.DECODABLE & ~start.codecs
        if start.mode != protocol.Mode.BLOCK or missing:
            what = "mode ROLL" if start.mode != protocol.Mode.BLOCK else "a host that lacks one of its codecs"
            self._send(protocol.Log(f"START refused: a recording cannot be played in {what}"))
            return
        self._join_late = self._streaming or self._join_from_here
        self._streaming = True
        self._credits = start.credits
        self._unconfirmed = 0

    def _play(self, now: float) -> None:
        try:
            self._next = self._next or next(self._steps, None)
        except DamagedRecordingError as error:
            self.damage = error
            self._next = None
        if self._next is None:
            self._end()
        elif self._is_due(self._next.piece.time_us / 1e6, now):
            step, self._next = self._next, None
            self._pass_on(step)

    def _is_due(self, time_s: float, now: float) -> bool:
        if self._speed is None:
            return True
        if self._due_from is None:
            self._due_from = now - time_s / self._speed
        self.wait_s = min(LONGEST_WAIT_S, max(0.0, self._due_from + time_s / self._speed - now))
        return self.wait_s == 0.0

    def _end(self) -> None:
        """At the recording's end: over, or from the beginning, as a device that has been started anew."""
        if self._loop and self.frames > self._frames_before and self.damage is None:
            self._frames_before = self.frames
            self._starts += 1
            self._begin_anew()
            self._open()
        else:
            self.ended = True

    def _begin_anew(self) -> None:
        self._streaming = False
        self._join_late = False
        self._next_hello = 0.0

    def _pass_on(self, step: Step) -> None:
        if step.hello is not None and step.hello.boot_id != self._hello.boot_id:
            self._hello = step.hello
            self._join_from_here = True
            self._begin_anew()
        elif self._join_late:
            if step.frame is not None:
                self._join_late = False
                self._tell_anew(step)
        elif isinstance(step.chunk, Text):
            self._outgoing += step.chunk.text.encode() + b"\0"
        elif isinstance(step.chunk, Packet) and step.chunk.type not in (PacketType.HELLO, PacketType.BAUD):
            self._outgoing += framing.encode(replace(step.chunk, seq=self._number()))
            if step.chunk.type == PacketType.FRAME_END:
                self._count_frame()

    def _tell_anew(self, step: Step) -> None:
        assert step.frame is not None
        opening = snapshot(self._offer(), step.frame.picture, step.frame.end, 0)
        for packet in packets(opening)[1:]:  # the HELLO would ask for another START
            (chunk,) = framing.Splitter().feed(packet)
            assert isinstance(chunk, Packet)
            self._outgoing += framing.encode(replace(chunk, seq=self._number()))
        self._count_frame()

    def _count_frame(self) -> None:
        self.frames += 1
        self._credits -= 1
        self._unconfirmed += 1
        self.ended = self.frames == self._most

    def _has_more_frames(self) -> bool:
        try:
            return any(step.frame is not None for step in chain([self._next] if self._next else [], self._steps))
        except DamagedRecordingError as error:
            self.damage = error
            return False

    def _first_hello(self) -> Hello:
        for step in self._steps:
            if step.hello is not None:
                return step.hello
        raise StreamError("the recording holds no HELLO, so there is nothing to play")

    def _offer(self) -> Hello:
        """The recorded HELLO, without what a recording cannot do."""
        return replace(
            self._hello,
            boot_id=self._hello.boot_id + self._starts & 0xFFFFFFFF,
            capabilities=self._hello.capabilities & _PLAYED,
            highest_baud=0,
            baud=0,
            input=0,
            controls=0,
            scenes=0,
            views=0,
        )

    def _number(self) -> int:
        number, self._seq = self._seq, self._seq + 1 & 0xFF
        return number

    def _send(self, body: protocol.Body) -> None:
        self._outgoing += framing.encode(protocol.pack(body, self._number()))
