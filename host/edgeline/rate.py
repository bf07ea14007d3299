"""The link's rate: how it is raised, proven, and brought back (WIRE.md, "The link's rate").

No I/O: bodies to send and events come out. Whatever goes wrong, both ends come back to the rate that they began with,
each by its own clock, so there is no state in which they do not find each other again.
"""

from __future__ import annotations

from enum import Enum, auto

from edgeline.events import Event, RateChanged, SetRate
from edgeline.protocol import Body, Capability, Hello, Ping, SetBaud
from edgeline.quality import LinkQuality

ANSWER_S = 0.5
ASK_TRIES = 5
"""Of which the last ones reach a device that has changed its rate, was not heard, and has gone back after 1 s."""

SETTLE_S = 0.010
PROOF_PING_S = 0.25
PROOF_S = 1.5
SILENCE_S = 4.0
"""At a rate other than the first, with a stream running."""

TOLERANCE = 0.025
"""By which the rate that the device's divider gives may differ from the one that it was asked for."""

COMMON_RATES = (921_600, 115_200)
"""Which drivers take that refuse odd ones."""

BAD_SHARE = 0.25
FEWEST_FRAMES = 4
"""A share of fewer frames than this says nothing."""

ATTEMPTS = 2
"""To raise the rate of a device, before the link is believed not to take it."""


class _Phase(Enum):
    STEADY = auto()
    ASKED = auto()
    PROVING = auto()


class Rate:
    """`first` is the rate that the port was opened at, 0 if it has none; `wish` the one to go on with, 0 for the
    device's highest, None to stay."""

    def __init__(self, first: int, wish: int | None) -> None:
        self.now = first
        self.first = first
        self._wish = wish
        self._goal = first
        self._why = ""
        self._attempts = 0
        self._phase = _Phase.STEADY
        self._tries = 0
        self._due = 0.0
        self._deadline = 0.0

    @property
    def busy(self) -> bool:
        """A change is under way; nothing but what `tick` gives may be sent."""
        return self._phase is not _Phase.STEADY

    @property
    def raised(self) -> bool:
        return self.now != self.first

    def wish(self, rate: int) -> None:
        """Asks for `rate`, 0 for the device's highest; carried out as soon as `begin` is called."""
        self._wish = rate
        self._attempts = 0

    def met(self, hello: Hello, anew: bool) -> None:
        """A HELLO has come. `anew`: of a device that has been started since the last one."""
        if self.now == 0:
            self.now = self.first = hello.baud
        if anew:
            self._attempts = 0

    def goal(self, hello: Hello) -> int | None:
        """The rate to change to now, None: none."""
        if self._wish is None:
            return None
        if not can_change(hello):
            return None
        rate = self._wish or hello.highest_baud
        return None if _near(self.now, rate) or self._attempts == ATTEMPTS else rate

    def begin(self, rate: int, now: float) -> list[Body]:
        """Asks for `rate`, the stream having been stopped."""
        self._goal = rate
        self._attempts += 1
        self._phase = _Phase.ASKED
        self._tries = 1
        self._due = now + ANSWER_S
        return [SetBaud(rate)]

    def bring_back(self, why: str, now: float) -> list[Body]:
        """Asks for the first rate, and for no other one again."""
        self._wish = None
        self._why = f"back at {self.first} baud: {why}"
        return self.begin(self.first, now)

    def is_bad(self, quality: LinkQuality) -> bool:
        """Whether a raised rate loses too much to be kept; `quality` is of a whole window at this rate."""
        enough = quality.frames + quality.failed >= FEWEST_FRAMES
        return self.raised and enough and quality.failed_share > BAD_SHARE

    def answer(self, rate: int, now: float) -> list[Event]:
        """BAUD has come."""
        if self._phase is not _Phase.ASKED:
            return []
        if _near(rate, self._goal):
            return self._switch(rate, now)
        self._wish = None
        return self._settle(f"{self.now} baud: the device cannot do {self._goal}")

    def hello(self) -> list[Event]:
        """A HELLO has come while `busy`: the new rate works. Before BAUD it says nothing."""
        if self._phase is not _Phase.PROVING:
            return []
        return self._settle(f"{self.now} baud")

    def tick(self, now: float) -> tuple[list[Body], list[Event]]:
        """Lets time pass; to be called while `busy`."""
        if self._phase is _Phase.PROVING and now >= self._deadline:
            return [], self.fall_back(f"no HELLO at {self.now} baud")
        if now < self._due:
            return [], []
        if self._phase is _Phase.ASKED:
            return self._ask_again(now)
        self._due = now + PROOF_PING_S
        return [Ping()], []

    def _ask_again(self, now: float) -> tuple[list[Body], list[Event]]:
        if self._tries < ASK_TRIES:
            self._tries += 1
            self._due = now + ANSWER_S
            return [SetBaud(self._goal)], []
        if self._goal == self.first:
            # It may be there already, and its answer lost.
            return [], self._switch(self.first, now)
        self._wish = None
        return [], self._settle(f"{self.now} baud: the device does not answer SET_BAUD")

    def fall_back(self, why: str) -> list[Event]:
        """The device is not to be heard at this rate: to the first one, where it is or will be."""
        self.now = self.first
        return [SetRate(self.first, self.first), *self._settle(f"back at {self.first} baud: {why}")]

    def refuse(self) -> list[Event]:
        """The host's port cannot do what it was told."""
        refused = self._goal
        self._wish = next((rate for rate in COMMON_RATES if self.first < rate < refused), None)
        self._attempts = 0
        return self.fall_back(f"this computer's port cannot do {refused}")

    def _switch(self, rate: int, now: float) -> list[Event]:
        self.now = rate
        self._phase = _Phase.PROVING
        self._due = now + SETTLE_S
        self._deadline = now + PROOF_S
        return [SetRate(rate, self._goal)]

    def _settle(self, why: str) -> list[Event]:
        why, self._why = self._why or why, ""
        self._phase = _Phase.STEADY
        return [RateChanged(self.now, why)]


def _near(rate: int, asked: int) -> bool:
    return abs(rate - asked) <= TOLERANCE * asked


def can_change(hello: Hello) -> bool:
    """Whether the device takes SET_BAUD and has a link with a rate."""
    return Capability.SET_BAUD in hello.capabilities and hello.highest_baud > 0
