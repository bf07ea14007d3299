"""What is counted modulo something, packets, frames, microseconds, INPUTs, goes on across every wrap."""

from __future__ import annotations

import tracemalloc
from itertools import pairwise

import pytest

from edgeline import protocol
from edgeline.session import Session
from edgeline.stream import Clock
from fake_device import FakeDevice, bars
from talk import Talk

TINY = bars(16, 8)


def test_a_stream_crosses_every_wrap_without_a_word() -> None:
    device = FakeDevice(16, 8, TINY, frame=65_500, seq=250, time_us=2**32 - 10**6)
    talk = Talk(device)
    for step in range(100):
        if step % 2:
            talk.session.input(200, step)
        talk.step()
    numbers = [frame.number for frame in talk.frames]
    assert numbers == [(65_500 + i) % 65_536 for i in range(len(numbers))]
    assert len(numbers) > 95
    times = [frame.time_s for frame in talk.frames]
    assert [round(later - earlier, 6) for earlier, later in pairwise(times)] == [0.04] * (len(times) - 1)
    assert talk.session.counts.damaged == 0
    assert device.taken == [(200, step) for step in range(100) if step % 2]


def test_lost_frames_are_counted_right_across_the_wrap() -> None:
    talk = Talk(FakeDevice(16, 8, TINY, frame=65_533))
    talk.run(3)
    talk.device._frame += 5
    talk.device._dropped = 5
    talk.run(3)
    assert [frame.number for frame in talk.frames] == [65_533, 65_534, 4, 5, 6]
    assert talk.session.counts.failed == 0


@pytest.mark.parametrize(
    ("stamps", "expected"),
    [
        ([(0, 0.0), (40_000, 0.04)], 0.04),
        ([(2**32 - 1, 0.0), (39_999, 9.9)], 0.04),
        ([(100, 0.0), (100, 4294.967296)], 4294.967296),
        ([(100, 0.0), (2_000_100, 3 * 4294.967296 + 2.5)], 3 * 4294.967296 + 2.0),
    ],
)
def test_the_device_s_clock_never_goes_back(stamps: list[tuple[int, float]], expected: float) -> None:
    clock = Clock()
    times = [clock.at(time_us, now) for time_us, now in stamps]
    assert times[0] == 0.0
    assert times[-1] == pytest.approx(expected, abs=1e-6)


def test_after_a_restart_the_host_s_clock_bridges_the_gap() -> None:
    clock = Clock()
    assert clock.at(5_000_000, 100.0) == 0.0
    clock.restarted()
    assert clock.at(1_000, 103.0) == 3.0
    assert clock.at(41_000, 103.9) == pytest.approx(3.04)


def test_a_session_s_time_goes_on_over_a_restart() -> None:
    talk = Talk(FakeDevice(16, 8, TINY, time_us=4_000_000_000))
    talk.run(10)
    last = len(talk.frames) - 1
    talk.device.time_us = 0
    talk.device.reboot(9, talk.now)
    talk.run(10)
    before, after = talk.frames[last], talk.frames[last + 1]
    assert before.time_s == pytest.approx(before.number * 0.04)
    assert after.number == 0
    assert after.time_s - before.time_s == pytest.approx(after.received_s - before.received_s)


def test_frames_leave_no_memory_behind() -> None:
    """Of a minute; a whole day's are in tests/link."""
    talk = Talk(FakeDevice(16, 8, TINY), Session())
    sizes = []
    for _ in range(3):
        for _ in range(200):
            talk.step()
            talk.events.clear()
            talk.device.sent.clear()
            talk.device.commands.clear()
        if not tracemalloc.is_tracing():
            tracemalloc.start()
        # What the device packs passes through Python's store of used tuples, which is counted as if it were held.
        kept = tracemalloc.take_snapshot().filter_traces([tracemalloc.Filter(False, protocol.__file__)])
        sizes.append(sum(trace.size for trace in kept.traces))
    tracemalloc.stop()
    assert talk.session.counts.frames > 590
    assert sizes[2] - sizes[1] < 20_000, sizes
