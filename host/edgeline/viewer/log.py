"""The log: what the device says and what happens to the link, a line each, bounded however fast they come."""

from __future__ import annotations

import time
from collections import deque
from dataclasses import dataclass
from enum import Enum
from itertools import islice

LINES = 1000
LONGEST_LINE = 300
DAMAGE_INTERVAL_S = 1.0
"""Damage is told once in so long, with a count: a bad link has thousands of it."""


class Source(Enum):
    DEVICE = "device"
    LINK = "link"
    VIEWER = "viewer"
    DAMAGE = "damage"


@dataclass(frozen=True)
class Line:
    """`stamp`: the time of day."""

    stamp: str
    source: Source
    text: str


class Log:
    """The last LINES lines. Not for several threads by itself."""

    def __init__(self) -> None:
        self._lines: deque[Line] = deque(maxlen=LINES)
        self._total = 0
        self._damage_told = float("-inf")
        self._damage_held = 0
        self._reason = ""

    def add(self, source: Source, text: str) -> None:
        """`text` may have several lines; what cannot be printed becomes a space, too long lines are cut."""
        stamp = time.strftime("%H:%M:%S")
        for line in text.splitlines():
            printable = "".join(c if c.isprintable() else " " for c in line[:LONGEST_LINE])
            self._lines.append(Line(stamp, source, printable + ("\u2026" if len(line) > LONGEST_LINE else "")))
            self._total += 1

    def damage(self, reason: str, now: float) -> None:
        """Something did not arrive whole; `now` in seconds of a steady clock."""
        self._damage_held += 1
        self._reason = reason
        self.settle(now)

    def settle(self, now: float) -> None:
        """Tells of damage that has been held back."""
        if self._damage_held and now - self._damage_told >= DAMAGE_INTERVAL_S:
            more = f" (and {self._damage_held - 1:,} more)" if self._damage_held > 1 else ""
            self.add(Source.DAMAGE, self._reason + more)
            self._damage_told = now
            self._damage_held = 0

    def since(self, number: int, most: int = LINES) -> tuple[list[Line], int]:
        """The lines from `number` on, as far as they are still there, `most` at most; the number to go on with."""
        first = max(number, self._total - len(self._lines))
        at = first - (self._total - len(self._lines))
        lines = list(islice(self._lines, at, at + most))
        return lines, first + len(lines)
