"""The last ten seconds of every number that comes with a frame, in a memory of fixed size.

Time is cut into buckets, each with the least, the greatest, the sum and the count of what fell into it. So a device
that sends a thousand frames a second takes no more room, and is drawn as quickly, as one that sends two.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from edgeline.events import Frame

SECONDS = 10.0
BUCKETS = 250
BUCKET_S = SECONDS / BUCKETS

LONGEST_INTERVAL_US = 60_000_000
"""Two frames that are further apart were drawn by a clock that began anew."""

Floats = npt.NDArray[np.float64]

FRAME_MS, RENDER_MS, WIRE_MS, CYCLES = "frame time", "render", "wire", "cycles"
BYTES_SENT, BYTES_SAVED, NOT_SENT = "bytes sent", "bytes saved", "frames not sent"

TIMES = (FRAME_MS, RENDER_MS, WIRE_MS)
"""In milliseconds: from one frame's beginning to the next one's, by the device's clock; rendering; encoding and
sending, waiting for the link included."""

_LABELS = {
    "triangles": "triangles in",
    "triangles_outside": "  culled: outside the view",
    "triangles_backface": "  culled: facing away",
    "triangles_empty": "  culled: without a sample",
    "triangles_other": "  of another pass",
    "triangles_clipped": "  clipped",
    "triangles_listed": "  listed",
    "pixels": "pixels tested",
    "pixels_shaded": "  shaded",
    "pixels_rejected": "  rejected by depth",
    "draws_culled": "  culled by their sphere",
    "setups": "triangle set-ups",
    "rows": "rows walked",
    "flushes": "early flushes",
    "memory_peak": "memory peak, bytes",
    "clusters_outside": "clusters outside the view",
    "clusters_turned": "clusters facing away",
    "triangles_skipped": "triangles of both",
    "triangles_hidden": "triangles hidden, by band",
    "pixels_prepass": "pixels drawn for depth alone",
    "lines_background": "lines of background left out",
    "frames_unchanged": "unchanged, not drawn",
}
"""What the panel calls a counter of firmware/src/base/stats.h, where its own name does not say it."""


def label(name: str) -> str:
    """A series' name for people. Two spaces in front: a part of the one above."""
    return _LABELS.get(name, name.replace("_", " "))


@dataclass(frozen=True)
class Track:
    """One series over the window, oldest bucket first; NaN where nothing fell into a bucket."""

    low: Floats
    mean: Floats
    high: Floats
    latest: float
    """of the last frame, NaN if there was none"""

    @property
    def summary(self) -> tuple[float, float, float] | None:
        """Least, mean and greatest of the window; each bucket counts once in the mean. None if there was nothing."""
        filled = ~np.isnan(self.mean)
        if not filled.any():
            return None
        return float(self.low[filled].min()), float(self.mean[filled].mean()), float(self.high[filled].max())


class History:
    """A ring of buckets for all series at once: one row per bucket, one column per series."""

    def __init__(self) -> None:
        self.names: tuple[str, ...] = ()
        self._last_time_us: int | None = None
        self._forget_all()

    def add(self, frame: Frame, now: float) -> None:
        """A verified frame's numbers; `now` in seconds of a steady clock."""
        names, values = self._numbers(frame)
        if names != self.names:
            self.names = names
            self._forget_all()
        row = self._row(now)
        np.fmin(self._low[row], values, out=self._low[row])
        np.fmax(self._high[row], values, out=self._high[row])
        known = ~np.isnan(values)
        self._sum[row][known] += values[known]
        self._count[row] += known
        self._latest = values

    def restart(self) -> None:
        """The device's clock begins anew: the next frame has no interval to the one before."""
        self._last_time_us = None

    def fail(self, frames: int, now: float) -> None:
        """So many frames could not be proven."""
        self._failed[self._row(now)] += frames

    def track(self, name: str, now: float) -> Track:
        """The series `name`, one of `names`, as it is at `now`."""
        column = self.names.index(name)
        order = self._order(now)
        count = np.where(order < 0, 0, self._count[order, column])
        with np.errstate(invalid="ignore", divide="ignore"):
            mean = np.where(count > 0, self._sum[order, column] / count, np.nan)
        low = np.where(count > 0, self._low[order, column], np.nan)
        high = np.where(count > 0, self._high[order, column], np.nan)
        return Track(low, mean, high, float(self._latest[column]))

    def failures(self, now: float) -> npt.NDArray[np.int64]:
        """How many frames failed, per bucket, oldest first."""
        order = self._order(now)
        return np.where(order < 0, 0, self._failed[order])

    def latest(self) -> dict[str, float]:
        """The last frame's numbers by name."""
        return dict(zip(self.names, self._latest.tolist(), strict=True))

    def _forget_all(self) -> None:
        shape = BUCKETS, len(self.names)
        self._low, self._high = np.full(shape, np.nan), np.full(shape, np.nan)
        self._sum, self._count = np.zeros(shape), np.zeros(shape, np.int64)
        self._failed = np.zeros(BUCKETS, np.int64)
        self._latest = np.full(len(self.names), np.nan)
        self._newest: int | None = None

    def _numbers(self, frame: Frame) -> tuple[tuple[str, ...], Floats]:
        end = frame.end
        interval = np.nan
        if self._last_time_us is not None:
            elapsed_us = end.time_us - self._last_time_us & 0xFFFFFFFF
            interval = elapsed_us / 1000 if elapsed_us <= LONGEST_INTERVAL_US else np.nan
        self._last_time_us = end.time_us
        height, width = frame.picture.shape
        numbers = {FRAME_MS: interval, RENDER_MS: end.render_us / 1000, WIRE_MS: end.encode_us / 1000}
        if end.cycles or CYCLES in self.names:
            numbers[CYCLES] = end.cycles
        numbers |= frame.counters
        numbers[BYTES_SENT] = end.wire_bytes
        numbers[BYTES_SAVED] = max(0, 2 * width * height - end.wire_bytes)
        numbers[NOT_SENT] = end.dropped
        return tuple(numbers), np.array(list(numbers.values()), np.float64)

    def _row(self, now: float) -> int:
        """The row of the bucket of `now`; those that lie between it and the newest one are emptied."""
        bucket = int(now / BUCKET_S)
        if self._newest is None:
            self._newest = bucket
        elif bucket > self._newest:
            stale = np.arange(max(self._newest + 1, bucket - BUCKETS + 1), bucket + 1) % BUCKETS
            self._low[stale] = self._high[stale] = np.nan
            self._sum[stale] = 0
            self._count[stale] = 0
            self._failed[stale] = 0
            self._newest = bucket
        return self._newest % BUCKETS

    def _order(self, now: float) -> npt.NDArray[np.int64]:
        """The rows from the oldest bucket of the window to that of `now`; -1 where the ring holds none yet."""
        buckets = int(now / BUCKET_S) + np.arange(1 - BUCKETS, 1)
        newest = self._newest if self._newest is not None else -1
        there = (buckets <= newest) & (buckets > newest - BUCKETS)
        return np.where(there, buckets % BUCKETS, -1)


def nice_ceiling(value: float) -> float:
    """The least of 1, 2, 5 times a power of ten that is not below `value`: the top of an axis."""
    if not value > 0:
        return 1.0
    power = 10.0 ** np.floor(np.log10(value))
    return float(next(power * step for step in (1, 2, 5, 10) if power * step >= value * (1 - 1e-9)))


def in_words(name: str, value: float) -> str:
    """A number of the series `name`, as short as it can be read."""
    if np.isnan(value):
        return "-"
    if name in TIMES:
        return f"{value:.1f} ms" if value < 100 else f"{value:,.0f} ms"
    return count_in_words(value)


def count_in_words(value: float) -> str:
    """A count in at most six characters or so: 117, 12,345, 1.23 M."""
    for limit, unit in ((1e9, "G"), (1e6, "M")):
        if value >= limit:
            return f"{value / limit:.2f} {unit}"
    return f"{value:,.0f}" if value == int(value) or value >= 100 else f"{value:.1f}"


def default_charts(names: Sequence[str]) -> tuple[str, ...]:
    """What is drawn until the user chooses: the times, cycles where the board counts them, and the bytes."""
    return tuple(name for name in (*TIMES, CYCLES, BYTES_SENT) if name in names)
