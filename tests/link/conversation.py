"""The firmware's session and the host's, with a bad line between them, on one clock; and a judge who has seen each
frame before it was sent.

The judge's rules: a frame that the session calls good is, pixel for pixel, what the renderer drew under that number; a
mixed one (ROLL) has in each line what the renderer drew there in one of the last frames, and so has each line that is
called proven of a frame that failed; the program got exactly the INPUTs that were asked for, in that order.

A frame has failed if the device sent it, its FRAME_END included, and the session did not call it good. Frames that ROLL
or a lack of credits left out were not sent, and are no failures.
"""

from __future__ import annotations

import random
from collections import deque
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import numpy.typing as npt

from channel import NO_FAULTS, Channel, Faults
from device import Answer, Boot, Device, Truth
from edgeline.codec import Pixels
from edgeline.events import Damage, Event, Frame, Partial, SetRate
from edgeline.protocol import DECODABLE, Capability, Control, Mode
from edgeline.session import Session

STEP_US = 10_000
TRUTH_BYTES = 1 << 26
"""Of pictures that the judge remembers. Many frames may pass between drawing a line and its arrival: while a host stops
reading, the device draws on for its panel."""

PROGRAMS_OWN = 200
"""A control of the program's own: its values are numbered, so that each of them is told apart."""


class WrongError(AssertionError):
    """Something was shown or done that must not be."""


@dataclass(frozen=True)
class Case:
    """One conversation."""

    name: str
    boot: Boot
    down: Faults = NO_FAULTS
    """what happens to the device's bytes"""
    up: Faults = NO_FAULTS
    """what happens to the host's"""
    mode: Mode = Mode.BLOCK
    split: bool = True
    resets: float = 0.0
    """chance per step that the device starts anew, wherever it is"""
    pauses: float = 0.0
    """chance per step that the host neither reads nor writes for up to 3 s; what comes meanwhile is lost"""
    inputs: float = 0.0
    """chance per step of an INPUT"""
    late_s: float = 0.0
    """that the host is late"""
    fast: int | None = None
    """the rate that the host asks for; None: it stays"""
    recovery: float | None = None
    """the mean of frames that may fail each time; None: it is reported and no more"""
    share: float = 1.0
    """of the frames that all cases have, by weight: large pictures take longer"""
    patience_s: float = 1.0
    """that a frame may take in the mean"""


@dataclass
class Outcome:
    """What became of it. `gaps`: for each time that frames failed, how many did until the next good one."""

    frames: int = 0
    mixed: int = 0
    partial: int = 0
    damaged: int = 0
    faults: int = 0
    inputs: int = 0
    resets: int = 0
    virtual_s: float = 0.0
    rates: set[int] = field(default_factory=set)
    gaps: list[int] = field(default_factory=list)
    quality: str = ""

    @property
    def recovery(self) -> float:
        return float(np.mean(self.gaps)) if self.gaps else 0.0


class Judge:
    """Remembers what was drawn."""

    def __init__(self, boot: Boot) -> None:
        self._truths: deque[Truth] = deque(maxlen=TRUTH_BYTES // (2 * boot.width * boot.height))

    def learn(self, truths: list[Truth]) -> None:
        self._truths.extend(truths)

    def check(self, frame: Frame) -> None:
        """Raises WrongError unless the frame is what was drawn."""
        if frame.mixed:
            self.check_lines(frame.number, frame.picture, np.ones(len(frame.picture), bool))
            return
        truth = next((t for t in reversed(self._truths) if t.number == frame.number), None)
        if truth is None:
            raise WrongError(f"frame {frame.number} was never drawn")
        assert truth.picture is not None
        if not np.array_equal(truth.picture, frame.picture):
            wrong = int((truth.picture != frame.picture).sum())
            raise WrongError(f"frame {frame.number} is called good, and {wrong} of its pixels are wrong")

    def sent_before(self, number: int) -> int:
        """How many frames the device had sent before this one, which was drawn."""
        return next(t.sent for t in reversed(self._truths) if t.number == number)

    def check_lines(self, number: int, picture: Pixels, proven: npt.NDArray[np.bool_]) -> None:
        """Raises WrongError unless each proven line is what was drawn there in one of the last frames."""
        due = proven.copy()
        for truth in reversed(self._truths):
            assert truth.picture is not None
            due[due] = (truth.picture[due] != picture[due]).any(axis=1)
            if not due.any():
                return
        # Lines that were never sent are black on both sides.
        if picture[due].any():
            raise WrongError(f"line {int(np.flatnonzero(due)[0])} of frame {number} is called good and was never drawn")


class Conversation:
    """Both ends of `case`, until `frames` frames have been judged."""

    def __init__(self, program: Path, case: Case, seed: int) -> None:
        self.case = case
        self.outcome = Outcome()
        self._random = random.Random(seed)
        self._down = Channel(case.down, seed + 1)
        self._up = Channel(case.up, seed + 2)
        self._judge = Judge(case.boot)
        self._program = program
        self._rate = case.boot.rate
        self._now_us = 0
        self._asked: list[tuple[int, int]] = []
        self._got: list[tuple[int, int]] = []
        self._sent: int | None = None
        """frames that the device had sent when the last good one had come"""
        self._boots = 1

    def run(self, frames: int, limit_s: float | None = None) -> Outcome:
        """Raises WrongError; also if there are not as many frames within `limit_s` of the clock, by default 60 s and
        what the case allows for each frame, or if they are whole again later than the case promises."""
        case, outcome = self.case, self.outcome
        limit_s = 60.0 + case.patience_s * frames if limit_s is None else limit_s
        codecs = DECODABLE if case.split else DECODABLE & ~Capability.SPLIT
        session = Session(mode=case.mode, baud=case.boot.rate, fast=case.fast, codecs=codecs)
        with Device(self._program) as device:
            self._hear(device.boot(replace(case.boot, pictures=True)), None)
            while self._now_us < 1e6 * case.late_s:
                self._step(device, None)
            while outcome.frames < frames:
                if self._now_us > 1e6 * limit_s:
                    raise WrongError(f"{outcome.frames} of {frames} frames within {limit_s:g} s; {session.counts}")
                self._chance(device, session)
                self._step(device, session)
            self._settle(device, session)
            outcome.quality = session.quality(self._now_us / 1e6).words
        outcome.virtual_s = self._now_us / 1e6
        outcome.faults = self._down.damaged + self._up.damaged
        if case.recovery is not None and outcome.recovery > case.recovery:
            mean = f"{outcome.recovery:.2f} frames failed in the mean of {len(outcome.gaps)} times"
            raise WrongError(f"{mean}, {case.recovery:g} may")
        return outcome

    def _chance(self, device: Device, session: Session) -> None:
        case = self.case
        if self._random.random() < case.resets:
            self._boots += 1
            self.outcome.resets += 1
            self._sent = None
            again = replace(case.boot, pictures=True, boot_id=self._boots, clock_us=self._random.randrange(1 << 32))
            self._hear(device.boot(again), session)
        if self._random.random() < case.pauses:
            for _ in range(self._random.randrange(1, 300)):
                self._step(device, None)
        if self._random.random() < case.inputs and session.inputs_waiting < 20:
            self._ask(session)

    def _ask(self, session: Session) -> None:
        number = len(self._asked)
        wishes = ((PROGRAMS_OWN, number), (int(Control.FRAME), number), (int(Control.PAUSE), number % 3 == 0))
        wish = wishes[self._random.randrange(len(wishes))]
        session.input(*wish)
        self._asked.append(wish)

    def _step(self, device: Device, session: Session | None) -> None:
        data = b""
        if session is not None:
            self._take(session.tick(self._now_us / 1e6))
            data = self._up.carry(session.bytes_to_send())
        self._now_us += STEP_US
        self._hear(device.advance(STEP_US, data), session)

    def _hear(self, answer: Answer, session: Session | None) -> None:
        self._judge.learn(answer.truths)
        self._got += answer.inputs
        for rate, data in answer.wire:
            self.outcome.rates.add(rate)
            arrived = self._down.carry(data)
            if session is not None:
                if rate != self._rate:
                    arrived = self._random.randbytes(len(arrived) // 2)
                self._take(session.receive(arrived, self._now_us / 1e6))

    def _take(self, events: list[Event]) -> None:
        for event in events:
            if isinstance(event, SetRate):
                self._rate = event.rate
            elif isinstance(event, Damage):
                self.outcome.damaged += 1
            elif isinstance(event, Frame):
                self._judge.check(event)
                self.outcome.frames += 1
                self.outcome.mixed += event.mixed
                sent = self._judge.sent_before(event.number)
                failed = sent - self._sent if self._sent is not None else 0
                if failed > 0:
                    self.outcome.gaps.append(failed)
                self._sent = sent + 1
            elif isinstance(event, Partial):
                self._judge.check_lines(event.number, event.picture, event.proven)
                self.outcome.partial += 1

    def _settle(self, device: Device, session: Session) -> None:
        """All INPUTs have arrived at last; without resets, which make a host tell some again, exactly once each."""
        end = self._now_us + 20_000_000
        while session.inputs_waiting and self._now_us < end:
            self._step(device, session)
        self.outcome.inputs = len(self._asked)
        if self.case.resets == 0 and self._got != self._asked:
            raise WrongError(f"asked for {self._asked[:20]}..., got {self._got[:20]}...")
