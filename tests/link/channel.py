"""A line that damages what it carries, the same way each time: bytes in, bytes out, all chance from one seed.

How often a fault comes is counted in bytes that were carried, not in pieces, so that a case means the same at every
rate and however finely the clock is moved.
"""

from __future__ import annotations

import random
from dataclasses import dataclass

MOST_GARBAGE = 600
KINDS = ("dropped", "doubled", "swapped", "inserted", "cut", "bursts", "garbage")


@dataclass(frozen=True)
class Faults:
    """What a line does to its bytes. `bit_errors` is the chance of each bit to be inverted; all the others but
    `burst_bytes` say how often it happens in 1,000 bytes."""

    bit_errors: float = 0.0
    dropped: float = 0.0
    """one byte is lost"""
    doubled: float = 0.0
    """one byte comes twice"""
    swapped: float = 0.0
    """two stretches of up to 16 bytes change places"""
    inserted: float = 0.0
    """up to 8 bytes that nobody sent"""
    cut: float = 0.0
    """the rest of the packet is lost, its end with it or not"""
    bursts: float = 0.0
    """`burst_bytes` in a row are lost"""
    burst_bytes: int = 256
    garbage: float = 0.0
    """up to MOST_GARBAGE bytes of anything come between"""


NO_FAULTS = Faults()


class Channel:
    """One direction of a line."""

    def __init__(self, faults: Faults, seed: int) -> None:
        self.faults = faults
        self.damaged = 0
        """times that something happened"""
        self._random = random.Random(seed)
        self._weights = [getattr(faults, kind) / 1000 for kind in KINDS]
        self._to_next_fault = self._distance(sum(self._weights))
        self._to_next_error = self._distance(faults.bit_errors)
        self._burst_left = 0
        self._cutting = False

    def carry(self, data: bytes) -> bytes:
        """What arrives of `data`."""
        arrived = bytearray()
        at = 0
        while self._to_next_fault is not None and self._to_next_fault < len(data) - at:
            fault_at = at + self._to_next_fault
            self._pass(data[at:fault_at], arrived)
            at = fault_at + self._fault(data[fault_at:], arrived)
            self._to_next_fault = self._distance(sum(self._weights))
        if self._to_next_fault is not None:
            self._to_next_fault -= len(data) - at
        self._pass(data[at:], arrived)
        self._invert_bits(arrived)
        return bytes(arrived)

    def _distance(self, chance: float) -> int | None:
        """To the next time that something of this chance happens; None: never."""
        return int(self._random.expovariate(chance)) if chance > 0 else None

    def _pass(self, data: bytes, arrived: bytearray) -> None:
        """Carries bytes to which nothing new happens."""
        lost = min(self._burst_left, len(data))
        self._burst_left -= lost
        data = data[lost:]
        if self._cutting:
            end = data.find(0)
            self._cutting = end < 0
            data = b"" if end < 0 else data[end + self._random.randrange(2) :]
        arrived += data

    def _fault(self, rest: bytes, arrived: bytearray) -> int:
        """One fault at the beginning of `rest`, which is not empty: how many of its bytes it has used up."""
        self.damaged += 1
        kind = self._random.choices(KINDS, self._weights)[0]
        if kind == "dropped":
            return 1
        if kind == "doubled":
            arrived += rest[:1]
        elif kind == "swapped":
            size = self._random.randint(1, 16)
            swapped = rest[size : 2 * size] + rest[:size]
            arrived += swapped
            return len(swapped)
        elif kind == "inserted":
            arrived += self._random.randbytes(self._random.randint(1, 8))
        elif kind == "cut":
            self._cutting = True
        elif kind == "bursts":
            self._burst_left = self.faults.burst_bytes
        else:
            arrived += self._random.randbytes(self._random.randint(1, MOST_GARBAGE))
        return 0

    def _invert_bits(self, piece: bytearray) -> None:
        if self._to_next_error is None:
            return
        while self._to_next_error < 8 * len(piece):
            piece[self._to_next_error // 8] ^= 1 << self._to_next_error % 8
            self.damaged += 1
            self._to_next_error += 1 + (self._distance(self.faults.bit_errors) or 0)
        self._to_next_error -= 8 * len(piece)
