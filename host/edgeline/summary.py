"""What a recording amounts to: its length by the device's clock, bytes, render time and work counters in the mean."""

from __future__ import annotations

from edgeline.protocol import Hello
from edgeline.session import Counts, Frame


class Summary:
    """Sums over frames, taken one by one."""

    def __init__(self, hello: Hello) -> None:
        self._hello = hello
        self.frames = 0
        self._last_time_us: int | None = None
        self._elapsed_us = 0
        self._sums: dict[str, int] = dict.fromkeys(("wire_bytes", "render_us", "encode_us", "dropped"), 0)
        self._counters: dict[str, int] = {}

    def add(self, frame: Frame) -> None:
        end = frame.end
        if self._last_time_us is not None:
            self._elapsed_us += end.time_us - self._last_time_us & 0xFFFFFFFF
        self._last_time_us = end.time_us
        self.frames += 1
        for name in self._sums:
            self._sums[name] += getattr(end, name)
        for name, count in frame.counters.items():
            self._counters[name] = self._counters.get(name, 0) + count

    @property
    def frames_per_second(self) -> float | None:
        """By the device's clock; None before the second frame."""
        return (self.frames - 1) * 1e6 / self._elapsed_us if self._elapsed_us else None

    def to_json(self, counts: Counts) -> dict[str, object]:
        """Means per frame where the name does not say otherwise; `counts` are those of the link."""
        frames = max(self.frames, 1)
        rate = self.frames_per_second
        return {
            "target": self._hello.target,
            "firmware": self._hello.firmware,
            "width": self._hello.width,
            "height": self._hello.height,
            "frames": self.frames,
            "seconds": round(self._elapsed_us / 1e6, 6),
            "frames_per_second": None if rate is None else round(rate, 3),
            "bytes_per_frame": round(self._sums["wire_bytes"] / frames, 3),
            "render_us": round(self._sums["render_us"] / frames, 3),
            "encode_us": round(self._sums["encode_us"] / frames, 3),
            "frames_not_sent": self._sums["dropped"],
            "damaged": counts.damaged,
            "asked_anew": counts.keys_sent,
            "counters": {name: round(total / frames, 3) for name, total in self._counters.items()},
        }

    def __str__(self) -> str:
        frames = max(self.frames, 1)
        rate = self.frames_per_second
        speed = "" if rate is None else f", {rate:.1f} frames/s"
        return f"{self.frames} verified frames{speed}, {self._sums['wire_bytes'] / frames / 1000:.1f} kB each"
