"""What a link carries and what it costs: the figures of `edgeline bench`."""

from __future__ import annotations

import statistics
import time
from dataclasses import dataclass, field

from edgeline.errors import StreamEndError
from edgeline.events import Event
from edgeline.link import Link
from edgeline.protocol import Capability, Control
from edgeline.session import Session

BITS_PER_BYTE = 10
"""on a UART: start bit, eight bits, stop bit"""


class TimedSession(Session):
    """A session that knows how long it thinks about what it receives: unpacking, decoding, proving."""

    def __post_init__(self) -> None:
        super().__post_init__()
        self.thinking_s = 0.0

    def receive(self, data: bytes, now: float) -> list[Event]:
        begin = time.perf_counter()
        events = super().receive(data, now)
        self.thinking_s += time.perf_counter() - begin
        return events


@dataclass
class Measured:
    """Sums over `frames` frames in `seconds` of the host's clock. A first frame begins the time and is not counted."""

    frames: int = 0
    seconds: float = 0.0
    link_bytes: int = 0
    """that arrived, everything included"""
    band_bytes: int = 0
    raw_bytes: int = 0
    """of the frames' pixels"""
    host_s: float = 0.0
    render_us: int = 0
    encode_us: int = 0
    intervals_s: list[float] = field(default_factory=list)
    latencies_s: list[float] = field(default_factory=list)

    def to_json(self, rate: int) -> dict[str, object]:
        """`rate`: the link's, 0 if it has none. Times in milliseconds, None where there is no figure.

        `compression` is raw bytes for each byte that arrived, `wire_efficiency` the pictures' share of these,
        `link_use` their share of what the rate allows.
        """
        frames, seconds = max(1, self.frames), max(1e-9, self.seconds)
        intervals = sorted(self.intervals_s)
        latencies = sorted(self.latencies_s)
        return {
            "frames": self.frames,
            "seconds": round(self.seconds, 6),
            "frames_per_second": round(self.frames / seconds, 3),
            "interval_ms": _spread(intervals),
            "bytes_per_second": round(self.link_bytes / seconds, 1),
            "bytes_per_frame": round(self.link_bytes / frames, 1),
            "raw_bytes_per_frame": round(self.raw_bytes / frames, 1),
            "compression": round(self.raw_bytes / max(1, self.link_bytes), 4),
            "wire_efficiency": round(self.band_bytes / max(1, self.link_bytes), 4),
            "baud": rate or None,
            "link_use": round(self.link_bytes * BITS_PER_BYTE / rate / seconds, 4) if rate else None,
            "render_ms": round(self.render_us / frames / 1000, 3),
            "encode_and_send_ms": round(self.encode_us / frames / 1000, 3),
            "host_decode_ms": round(self.host_s / frames * 1000, 4),
            "host_decode_frames_per_second": round(frames / self.host_s, 1) if self.host_s else None,
            "input_latency_ms": _spread(latencies) if latencies else None,
        }


def measure(link: Link, session: TimedSession, frames: int, timeout_s: float) -> Measured:
    """Takes `frames` frames, fewer if the stream ends before. Raises StreamError if one does not come in time."""
    link.next_frame(timeout_s)
    result = Measured()
    begin = last = time.monotonic()
    bytes_before, host_before = session.counts.bytes_received, session.thinking_s
    while result.frames < frames:
        try:
            frame = link.next_frame(timeout_s)
        except StreamEndError:
            break
        now = time.monotonic()
        result.intervals_s.append(now - last)
        last = now
        result.frames += 1
        result.band_bytes += frame.stats.wire_bytes
        result.raw_bytes += frame.stats.raw_bytes
        result.render_us += frame.stats.render_us
        result.encode_us += frame.stats.encode_us
    result.seconds = last - begin
    result.link_bytes = session.counts.bytes_received - bytes_before
    result.host_s = session.thinking_s - host_before
    return result


def can_measure_latency(link: Link) -> bool:
    """Whether the device says which frame is the first to show an INPUT."""
    hello = link.hello
    asked = Capability.INPUT in hello.capabilities and hello.knows(Control.PAUSE)
    return not link.transport.one_way and hello.numbers_inputs and asked


def latencies(link: Link, trials: int, paused: bool, timeout_s: float) -> list[float]:
    """Seconds from an INPUT to the first frame, read whole and proven, that shows it. PAUSE is told what it is already,
    so nothing changes on the display."""
    taken = []
    for _ in range(trials):
        link.next_frame(timeout_s)
        begin = time.monotonic()
        link.control(Control.PAUSE, int(paused))
        while not link.next_frame(timeout_s).shows_inputs:
            pass
        taken.append(time.monotonic() - begin)
    return taken


def _spread(seconds: list[float]) -> dict[str, float] | None:
    """Least, median, mean and most of sorted times, in milliseconds."""
    if not seconds:
        return None
    return {
        "min": round(seconds[0] * 1000, 3),
        "median": round(statistics.median(seconds) * 1000, 3),
        "mean": round(statistics.fmean(seconds) * 1000, 3),
        "max": round(seconds[-1] * 1000, 3),
    }
