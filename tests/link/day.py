"""24 hours' worth of frames in accelerated time: the real device and the real session, on a picture so small that only
what is kept per frame can grow, begun just before every counter's wrap."""

from __future__ import annotations

import gc
import sys
from collections import deque
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from device import Boot, Device, Truth
from edgeline.events import Damage, Frame
from edgeline.session import Session

FRAME_US = 33_333
DAY_FRAMES = 24 * 3600 * 30

NEAR_WRAPS = Boot(
    scene="solid",
    width=16,
    height=8,
    rate=0,
    render_us=FRAME_US - 1,
    clock_us=2**32 - 10_000_000,
    frame=65_500,
    seq=250,
)
WARM_UP = 2000
"""Frames after which everything that is kept has been filled."""

SAMPLES = 20


@dataclass
class Day:
    """What is looked at. Memory is what the processes hold in pages, in KiB, at the beginning (WARM_UP) and at most."""

    frames: int = 0
    wrong: int = 0
    damaged: int = 0
    frame_wraps: int = 0
    clock_wraps: int = 0
    seconds: float = 0.0
    """that the frames' time stamps cover, by the session"""
    host_kib: tuple[int, int] = (0, 0)
    device_kib: tuple[int, int] = (0, 0)
    blocks: tuple[int, int] = (0, 0)
    """of memory that Python has given out on the host's side"""


def resident_kib(pid: int | str) -> int:
    """Of a process; 0 where the system does not tell."""
    try:
        status = Path(f"/proc/{pid}/status").read_text(encoding="ascii")
    except OSError:
        return 0
    return next((int(line.split()[1]) for line in status.splitlines() if line.startswith("VmRSS")), 0)


class Watch:
    """The memory of both sides, first and most."""

    def __init__(self, pid: int) -> None:
        self._pid = pid
        self.first: tuple[int, int, int] | None = None
        self.most = (0, 0, 0)

    def look(self) -> None:
        gc.collect()
        now = (resident_kib("self"), resident_kib(self._pid), sys.getallocatedblocks())
        self.first = self.first or now
        self.most = (max(self.most[0], now[0]), max(self.most[1], now[1]), max(self.most[2], now[2]))


def live_through(program: Path, frames: int, session: Session | None = None) -> Day:
    """Until `frames` frames have come, or a tenth more time than they need has passed."""
    session, day = session or Session(), Day()
    stretch = max(1, (frames - WARM_UP) // SAMPLES)
    with Device(program) as device:
        watch = Watch(device.pid)
        truths: deque[Truth] = deque(device.boot(NEAR_WRAPS).truths, maxlen=4)
        now, last, first_s, last_us = 0.0, -1, None, 0
        while day.frames < frames and now < 1.1 * frames * FRAME_US / 1e6 + 10:
            session.tick(now)
            said = session.bytes_to_send()
            now += FRAME_US / 1e6
            answer = device.advance(FRAME_US, said)
            truths += answer.truths
            for event in session.receive(answer.bytes, now):
                if isinstance(event, Damage):
                    day.damaged += 1
                elif isinstance(event, Frame):
                    day.frames += 1
                    day.wrong += not _is_right(event, truths, last)
                    day.frame_wraps += event.number < last
                    day.clock_wraps += event.end.time_us < last_us
                    last, last_us = event.number, event.end.time_us
                    first_s = event.time_s if first_s is None else first_s
                    day.seconds = event.time_s - first_s
                    if day.frames >= WARM_UP and (day.frames - WARM_UP) % stretch == 0:
                        watch.look()
    if watch.first is not None:
        day.host_kib, day.device_kib, day.blocks = zip(watch.first, watch.most, strict=True)
    return day


def _is_right(frame: Frame, truths: deque[Truth], last: int) -> bool:
    """It is what was drawn, and the one after the last."""
    follows = last < 0 or frame.number == last + 1 & 0xFFFF
    truth = next((t for t in truths if t.number == frame.number), None)
    if truth is None or not follows:
        return False
    assert truth.picture is not None
    return np.array_equal(truth.picture, frame.picture)
