"""Frames from START on: bands and their ends in, proven pictures out, KEY for what is missing and ACK for what ended.

What comes before START is acted on may still be on its way then: a frame of the stream before, whose lines do not make
a whole picture here. As long as nothing was lost, that is neither damage nor an answer to START.
"""

from __future__ import annotations

from collections.abc import Callable

from edgeline.errors import WireError
from edgeline.events import Damage, Event, Frame, Partial
from edgeline.inputs import Inputs
from edgeline.picture import Assembly, Picture
from edgeline.protocol import Ack, Band, Body, FrameEnd, Key, Mode
from edgeline.quality import Tally

CREDITS = 2
"""One frame on its way, one being drawn."""

ROLL_PATIENCE = 16
"""Frames in which a line that was asked for may come; BLOCK needs no more than those on their way."""

PARTIAL_S = 0.1
"""Between two Partial events, at least."""

_WRAP_S = 2**32 / 1e6


class Clock:
    """The device's clock as seconds that never go back, from frames' time stamps modulo 2^32 microseconds."""

    def __init__(self) -> None:
        self._time_s = 0.0
        self._last: tuple[int, float] | None = None
        self._restarted = False

    def restarted(self) -> None:
        """The device's clock has begun anew: until the next frame, the host's counts."""
        self._restarted = True

    def at(self, time_us: int, now: float) -> float:
        """The time of a frame with this stamp, which arrived at `now` of the host's clock."""
        if self._last is not None:
            last_us, last_now = self._last
            by_device = (time_us - last_us & 0xFFFFFFFF) / 1e6
            by_host = max(0.0, now - last_now)
            whole_turns = max(0, round((by_host - by_device) / _WRAP_S))
            self._time_s += by_host if self._restarted else by_device + whole_turns * _WRAP_S
        self._last = time_us, now
        self._restarted = False
        return self._time_s


class Stream:
    """One stream, begun by a START with CREDITS, of pictures whose `size` is (width, height).

    `say` takes the packets for the device; `tally` counts, `inputs` hears what FRAME_END tells of INPUT.
    """

    def __init__(
        self,
        size: tuple[int, int],
        mode: Mode,
        *,
        say: Callable[[Body], None],
        inputs: Inputs,
        tally: Tally,
        clock: Clock,
    ) -> None:
        self.credits = CREDITS
        """given since START"""
        self._ended = 0
        """frames since START that ended here, those included that were lost as a whole"""
        self._mode = mode
        self._say = say
        self._inputs = inputs
        self._tally = tally
        self._clock = clock
        self._picture = Picture(*size)
        self._assembly: Assembly | None = None
        self._finished: int | None = None
        """the last frame that ended here"""
        self._gap = False
        """packets were lost, and it is not known yet which lines were in them"""
        self._unbroken = True
        """nothing was lost since START, nor has a frame been verified"""
        self._last_partial_s: float | None = None
        self._patience = ROLL_PATIENCE if mode is Mode.ROLL else CREDITS
        self._picture.ask(self._patience)  # which START has done

    def lost_packets(self) -> None:
        """Some did not arrive, or broke a rule, before the one that is given next."""
        self._gap = True
        self._unbroken = False

    def band(self, band: Band, now: float) -> list[Event]:
        if self._is_late(band.frame):
            return []
        events: list[Event] = []
        if self._assembly is None or self._assembly.frame != band.frame:
            before = self._finished if self._assembly is None else self._assembly.frame
            events += self._abandon(now)
            if self._gap and before is not None and band.frame != before + 1 & 0xFFFF:
                self._picture.lose_all()  # whole frames may be among what was lost
            self._assembly = Assembly(band.frame)
        assembly = self._assembly
        if self._gap:
            # The device may not have begun the next frame yet: asked for at once, the lines come with that one.
            self._gap = False
            self._picture.lose(assembly.next_y, band.y0)
            self._ask()
        try:
            self._picture.take(band, assembly)
        except WireError as error:
            events += self._spoilt(band.frame, error, now)
        return events

    def end(self, end: FrameEnd, now: float) -> list[Event]:
        if self._is_late(end.frame):
            return []
        events: list[Event] = []
        if self._assembly is not None and self._assembly.frame != end.frame:
            events += self._abandon(now)
        assembly, self._assembly = self._assembly or Assembly(end.frame), None
        events += self._draw(assembly, now)
        gap, self._gap = self._gap, False
        complete = len(assembly.bands) == end.bands and not assembly.broken
        good = complete and self._picture.digest() == end.digest
        early = self._unbroken and complete and not good and assembly.lines < self._picture.height
        if early and self._mode is Mode.BLOCK:
            return events
        if not good:
            self._find_fault(assembly, gap, end)
            self._ask()
        self._acknowledge_missed(end, now)
        self._ended += 1
        shows = self._inputs.frame_ended(self._ended, end.input)
        if good:
            events.append(self._verified(end, assembly, shows, now))
        else:
            if not (early or end.owing):
                self._tally.failed(now)
                events.append(self._damage(_failure(end, assembly), now))
                self._picture.frame_passed()
            events += self._partial(end.frame, now)
        self._finished = end.frame
        self._acknowledge(end.frame)
        return events

    def _is_late(self, frame: int) -> bool:
        """Whether this frame has ended here: its packet was overtaken, or came twice."""
        return self._finished is not None and self._finished - frame & 0xFFFF < 0x8000

    def _abandon(self, now: float) -> list[Event]:
        """Another frame begins, and this one's FRAME_END was lost or never sent. What came of it is part of the picture
        that the next one goes on from."""
        assembly, self._assembly = self._assembly, None
        if assembly is None:
            return []
        events = self._draw(assembly, now)
        if self._gap:
            self._picture.lose(assembly.next_y, self._picture.height)
            if self._mode is Mode.BLOCK:  # in ROLL it may have ended without a FRAME_END, and took no credit then
                self._finished = assembly.frame
                self._lost(assembly.frame, now)
        return events

    def _draw(self, assembly: Assembly, now: float) -> list[Event]:
        try:
            self._picture.finish(assembly)
        except WireError as error:
            return self._spoilt(assembly.frame, error, now)
        return []

    def _spoilt(self, frame: int, error: WireError, now: float) -> list[Event]:
        self._unbroken = False
        self._ask()
        return [self._damage(f"frame {frame}: {error}", now)]

    def _find_fault(self, assembly: Assembly, gap: bool, end: FrameEnd) -> None:
        """Notes which lines may be wrong: those after the last band if packets were lost there; if nothing explains it,
        all of them."""
        if gap:
            self._picture.lose(0 if self._missed(end) else assembly.next_y, self._picture.height)
        if not (end.owing or self._picture.in_doubt.any()):
            self._picture.lose_all()

    def _missed(self, end: FrameEnd) -> bool:
        """Whether a frame that the device has sent ended unnoticed since the last one that ended here."""
        if self._finished is None:
            return False
        return (end.frame - self._finished - 1 & 0xFFFF) > end.dropped

    def _acknowledge_missed(self, end: FrameEnd, now: float) -> None:
        # No more than one can be missing: with both credits gone there would be no frame to tell it.
        if self._missed(end):
            self._lost(end.frame - 1 - end.dropped & 0xFFFF, now)

    def _lost(self, frame: int, now: float) -> None:
        self._ended += 1
        self._tally.failed(now)
        self._picture.frame_passed()
        self._acknowledge(frame)

    def _acknowledge(self, frame: int) -> None:
        self._say(Ack(frame, 1))
        self.credits += 1

    def _ask(self) -> None:
        for y0, lines in self._picture.ask(self._patience):
            self._tally.counts.keys_sent += 1
            self._tally.counts.key_lines += lines
            self._say(Key(y0, lines))

    def _damage(self, reason: str, now: float) -> Damage:
        self._tally.damaged(now)
        return Damage(reason)

    def _verified(self, end: FrameEnd, assembly: Assembly, shows: bool, now: float) -> Frame:
        self._picture.prove()
        self._unbroken = False
        picture = self._picture.copy()
        self._tally.verified(end, picture.nbytes, now)
        return Frame(end.frame, picture, end, shows, tuple(assembly.bands), self._clock.at(end.time_us, now), now)

    def _partial(self, frame: int, now: float) -> list[Event]:
        proven = ~self._picture.in_doubt
        recent = self._last_partial_s is not None and now - self._last_partial_s < PARTIAL_S
        if recent or not proven.any():
            return []
        self._last_partial_s = now
        return [Partial(frame, self._picture.copy(), proven)]


def _failure(end: FrameEnd, assembly: Assembly) -> str:
    bands = len(assembly.bands)
    if bands != end.bands:
        return f"frame {end.frame}: {bands} of {end.bands} bands arrived"
    return f"frame {end.frame}: the picture's digest is wrong"
