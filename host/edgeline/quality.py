"""How good the link is and what it carries: since the session began, and over the last WINDOW_S seconds.

The latter's sums are kept in slots of SLOT_S, so that a day of frames takes no more memory than five seconds of them.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass, fields

from edgeline.protocol import FrameEnd

WINDOW_S = 5.0
SLOT_S = 0.25


@dataclass(frozen=True)
class LinkQuality:
    """What the link did to the last `window_s` seconds' frames and packets."""

    window_s: float
    frames: int
    """verified"""
    failed: int
    """that lacked something, or whose digest was wrong"""
    damaged_per_s: float
    """pieces that were no packets, and gaps between packets"""
    lost_packets: int
    bit_error_rate: float | None
    """the share of wrong bits that would lose as many packets; None: nothing arrived"""

    @property
    def failed_share(self) -> float:
        """Of all frames, 0..1."""
        return self.failed / (self.frames + self.failed) if self.failed else 0.0

    @property
    def words(self) -> str:
        """One line for people."""
        if not self.failed and not self.damaged_per_s:
            return "good" if self.bit_error_rate is not None else "silent"
        ended = self.frames + self.failed
        said = [f"{self.failed} of {ended} frames failed"] if ended else []
        said.append(f"{self.damaged_per_s:.1f} damaged pieces/s")
        if self.bit_error_rate:
            said.append(f"bit errors about {self.bit_error_rate:.1e}")
        return ", ".join(said)


@dataclass(frozen=True)
class Statistics:
    """What the link carried, and what the frames cost: means of the last `window_s` seconds, None without frames."""

    window_s: float
    frames_per_s: float
    """verified ones"""
    bytes_per_s: float
    compression: float | None
    """raw bytes of the frames for each byte on the wire"""
    render_us: float | None
    encode_us: float | None
    """encoding and writing, waiting for the link included"""
    wire_bytes: float | None
    """for each frame"""


@dataclass
class Amounts:
    """What is summed up."""

    bytes_received: int = 0
    packets: int = 0
    lost: int = 0
    damaged: int = 0
    frames: int = 0
    failed: int = 0
    render_us: int = 0
    encode_us: int = 0
    wire_bytes: int = 0
    raw_bytes: int = 0


class Meter:
    """Takes amounts as they come. `now` is in seconds of any steady clock and never goes back."""

    def __init__(self) -> None:
        self._slots: deque[tuple[int, Amounts]] = deque()
        self._began: float | None = None

    def at(self, now: float) -> Amounts:
        """The sums that what happens at `now` is to be added to."""
        if self._began is None:
            self._began = now
        slot = int(now / SLOT_S)
        if not self._slots or self._slots[-1][0] != slot:
            self._slots.append((slot, Amounts()))
            self._forget(now)
        return self._slots[-1][1]

    def clear(self) -> None:
        """Begins anew, as after a change of the link's rate."""
        self._slots.clear()
        self._began = None

    def covers(self, now: float) -> bool:
        """Whether it has been taking amounts for a whole window."""
        return self._began is not None and now - self._began >= WINDOW_S

    def quality(self, now: float) -> LinkQuality:
        total, seconds = self._total(now)
        return LinkQuality(
            seconds, total.frames, total.failed, total.damaged / seconds, total.lost, _bit_error_rate(total)
        )

    def statistics(self, now: float) -> Statistics:
        total, seconds = self._total(now)
        frames = total.frames
        return Statistics(
            seconds,
            frames / seconds,
            total.bytes_received / seconds,
            total.raw_bytes / total.wire_bytes if total.wire_bytes else None,
            total.render_us / frames if frames else None,
            total.encode_us / frames if frames else None,
            total.wire_bytes / frames if frames else None,
        )

    def _forget(self, now: float) -> None:
        while self._slots and self._slots[0][0] < _first_slot(now):
            self._slots.popleft()

    def _total(self, now: float) -> tuple[Amounts, float]:
        """Sums, and the seconds that they are of: whole slots and the one that has begun, and no less than one slot,
        lest the first frame make a thousand a second."""
        self._forget(now)
        total = Amounts()
        for _, amounts in self._slots:
            for field in fields(Amounts):
                setattr(total, field.name, getattr(total, field.name) + getattr(amounts, field.name))
        began = now if self._began is None else self._began
        return total, max(SLOT_S, now - max(began, _first_slot(now) * SLOT_S))


@dataclass
class Counts:
    """What has passed since the session began. `damaged` counts from the first HELLO on: what comes before may be the
    tail of a packet that was under way when the port was opened."""

    bytes_received: int = 0
    bytes_sent: int = 0
    packets: int = 0
    frames: int = 0
    failed: int = 0
    damaged: int = 0
    lost_packets: int = 0
    keys_sent: int = 0
    key_lines: int = 0
    inputs_resent: int = 0


class Tally:
    """What happened, counted for both."""

    def __init__(self, counts: Counts) -> None:
        self.counts = counts
        self.meter = Meter()

    def received(self, size: int, now: float) -> None:
        self.counts.bytes_received += size
        self.meter.at(now).bytes_received += size

    def packet(self, now: float) -> None:
        self.counts.packets += 1
        self.meter.at(now).packets += 1

    def lost(self, packets: int, now: float) -> None:
        self.counts.lost_packets += packets
        self.meter.at(now).lost += packets

    def damaged(self, now: float) -> None:
        self.counts.damaged += 1
        self.meter.at(now).damaged += 1

    def failed(self, now: float) -> None:
        self.counts.failed += 1
        self.meter.at(now).failed += 1

    def verified(self, end: FrameEnd, raw_bytes: int, now: float) -> None:
        self.counts.frames += 1
        amounts = self.meter.at(now)
        amounts.frames += 1
        amounts.render_us += end.render_us
        amounts.encode_us += end.encode_us
        amounts.wire_bytes += end.wire_bytes
        amounts.raw_bytes += raw_bytes


def _first_slot(now: float) -> int:
    """Of the window that ends at `now`."""
    return int((now - WINDOW_S) / SLOT_S)


def _bit_error_rate(total: Amounts) -> float | None:
    """b, where a packet of n bits survives with (1 - b)^n, n being the mean."""
    if not total.bytes_received:
        return None
    if not total.lost:
        return 0.0
    packets = total.packets + total.lost
    surviving = max(total.packets, 0.5) / packets
    return -math.log(surviving) * packets / (8 * total.bytes_received)
