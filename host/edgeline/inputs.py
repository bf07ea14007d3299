"""INPUT that arrives: once each, in order, whatever the link loses (WIRE.md, "INPUT").

No I/O. Since wire 1.2 each INPUT has a number, and FRAME_END and HELLO tell the last one that the device took. WINDOW
of them are on their way at most; what is not confirmed is sent again from the oldest on, and the device ignores what it
has had. To a device of version 1.1, INPUT goes once and is believed to arrive.

Frames are counted from START on, the first being 1, and so are the credits that the host has given; a frame whose count
is above the credits that had been given when an INPUT was sent began after it.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, replace

from edgeline.errors import EdgelineError
from edgeline.protocol import Control, Hello, Input

WINDOW = 4
MOST_WAITING = 1000
FIRST_RETRY_S = 0.5
LAST_RETRY_S = 4.0

_ABSOLUTE = frozenset(range(Control.YAW, Control.VIEW + 1))
"""Controls of which the newest value alone counts, whatever came before and between: it replaces one that waits."""


@dataclass
class _Sent:
    input: Input
    now: float
    """when it was sent last"""
    credits: int
    """that had been given by then"""


class Inputs:
    """All that a session has been asked to set."""

    def __init__(self) -> None:
        self._told: dict[int, int] = {}
        self._waiting: deque[tuple[int, int]] = deque()
        self._sent: deque[_Sent] = deque()
        self._numbered = False
        self._last = 0
        """number of the last one that the device is known to have taken"""
        self._retry_s = FIRST_RETRY_S
        self._retry_at: float | None = None
        self._retry_now = False
        self._credits_at_last = 0
        self.resent = 0

    @property
    def waiting(self) -> int:
        """Those that the device is not known to have taken."""
        return len(self._waiting) + len(self._sent)

    @property
    def values(self) -> tuple[tuple[int, int], ...]:
        """Controls that are set, or are to be, and their values."""
        return (*self._told.items(), *self._waiting)

    def ask(self, control: int, value: int) -> None:
        """Sets `control` as soon as it may be sent. Raises EdgelineError when too many wait already."""
        if control in _ABSOLUTE:
            self._waiting = deque(item for item in self._waiting if item[0] != control)
        if len(self._waiting) >= MOST_WAITING:
            raise EdgelineError(f"{MOST_WAITING} controls wait for the device to take them: slower, please")
        self._waiting.append((control, value))
        if control != Control.STEP:
            self._told.pop(control, None)  # the order counts: SCENE sets the frame, too
            self._told[control] = value

    def greet(self, hello: Hello, anew: bool, asked: float | None = None) -> None:
        """Goes on from the number of a HELLO, which was `asked` for by a PING at that time.

        `anew`: the device has been started anew, and is told everything again that it knows, STEP excepted.
        """
        self._numbered = hello.numbers_inputs
        if anew:
            self._sent.clear()
            self._waiting = deque(item for item in self._told.items() if hello.knows(item[0]))
            self._last = hello.input
        elif self._numbered:
            self._confirm(hello.input)
            self._retry_now |= bool(self._sent) and asked is not None and asked > self._sent[0].now

    def _confirm(self, number: int) -> None:
        """The device says that `number` was the last one that it took."""
        numbers = [sent.input.number for sent in self._sent]
        if number in numbers:
            for _ in range(numbers.index(number) + 1):
                self._sent.popleft()
            self._retry_s = FIRST_RETRY_S
            self._retry_at = None
        elif number != self._last:
            # Somebody else has sent INPUT as well, so what is on its way is ignored by its number.
            for i, sent in enumerate(self._sent, 1):
                sent.input = replace(sent.input, number=number + i & 0xFF)
            self._retry_now = bool(self._sent)
        self._last = number

    def restart(self) -> None:
        """START is about to be sent: frames and credits are counted from 0 again."""
        self._credits_at_last = 0
        for sent in self._sent:
            sent.credits = 0

    def frame_ended(self, count: int, number: int) -> bool:
        """Frame `count` has ended and tells `number`: whether it shows all that was asked for."""
        # A HELLO in the frame's middle may have told a later number than the one that the frame began with.
        if self._numbered and self._last - number & 0xFF >= 128:
            self._confirm(number)
        if self._sent and count > self._sent[0].credits:
            self._retry_now = True
        return not self.waiting and (self._numbered or count > self._credits_at_last)

    def due(self, now: float, credits: int) -> list[Input]:
        """What has to be sent now, `credits` having been given."""
        return self._again(now, credits) + self._fresh(now, credits)

    def _again(self, now: float, credits: int) -> list[Input]:
        if not self._sent:
            return []
        if self._retry_at is None:
            self._retry_at = now + self._retry_s
        late = now >= self._retry_at
        if not (late or self._retry_now):
            return []
        if late:
            self._retry_s = min(2 * self._retry_s, LAST_RETRY_S)
        self._retry_at = now + self._retry_s
        self._retry_now = False
        for sent in self._sent:
            sent.now, sent.credits = now, credits
        self.resent += len(self._sent)
        return [sent.input for sent in self._sent]

    def _fresh(self, now: float, credits: int) -> list[Input]:
        fresh: list[Input] = []
        while self._waiting and len(self._sent) < WINDOW:
            control, value = self._waiting.popleft()
            self._credits_at_last = credits
            if self._numbered:
                before = self._sent[-1].input.number if self._sent else self._last
                assert before is not None
                fresh.append(Input(control, value, before + 1 & 0xFF))
                self._sent.append(_Sent(fresh[-1], now, credits))
            else:
                fresh.append(Input(control, value))
        return fresh
