"""What happens to packets on their way: seeded faults of every kind, and the garbage that a wrong rate makes."""

from __future__ import annotations

import random
from dataclasses import dataclass


@dataclass
class Faults:
    """Each with a probability per packet, from number `first` up to `last`; `bits` is per bit."""

    seed: int = 0
    flip: float = 0.0
    drop: float = 0.0
    cut: float = 0.0
    duplicate: float = 0.0
    swap: float = 0.0
    noise: float = 0.0
    bits: float = 0.0
    first: int = 0
    last: int = 1 << 30
    hits: int = 0

    def __post_init__(self) -> None:
        self._random = random.Random(self.seed)
        self._packet = 0
        self._held = b""

    def apply(self, chunk: bytes) -> bytes:
        """`chunk` is one encoded packet with its closing zero."""
        number, self._packet = self._packet, self._packet + 1
        if not self.first <= number < self.last:
            return chunk
        before = chunk
        if self._random.random() < self.flip:
            chunk = self._flipped(chunk)
        if self.bits and self._random.random() < 1 - (1 - self.bits) ** (8 * len(chunk)):
            chunk = self._flipped(chunk)
        if self._random.random() < self.cut:
            start = self._random.randrange(len(chunk))
            chunk = chunk[:start] + chunk[self._random.randrange(start, len(chunk)) + 1 :]
        if self._random.random() < self.drop:
            chunk = b""
        if self._random.random() < self.duplicate:
            chunk += chunk
        if self._random.random() < self.noise:
            chunk += self._random.randbytes(self._random.randrange(1, 40))
        if self._held:
            chunk, self._held = chunk + self._held, b""
        elif self._random.random() < self.swap:
            chunk, self._held = b"", chunk
        self.hits += chunk != before
        return chunk

    def _flipped(self, chunk: bytes) -> bytes:
        if not chunk:
            return chunk
        at = self._random.randrange(len(chunk))
        return chunk[:at] + bytes((chunk[at] ^ 1 << self._random.randrange(8),)) + chunk[at + 1 :]


def garbled(data: bytes, sent_at: int, read_at: int) -> bytes:
    """What a UART reads at another rate than that of the sender: more or fewer bytes, none of them right."""
    if sent_at == read_at:
        return data
    return random.Random(sent_at * 7919 + read_at).randbytes(min(4 * len(data), -(-len(data) * read_at // sent_at)))
