"""LinkQuality and Statistics: exact sums over a window of five seconds, and words for people."""

from __future__ import annotations

import math

import pytest

from edgeline.protocol import FrameEnd
from edgeline.quality import Counts, LinkQuality, Meter, Tally
from fake_device import FakeDevice, Faults, bars
from talk import Talk

END = FrameEnd(0, 1, 0, 4000, 6000, 500, 0, 0)


def test_the_window_is_five_seconds() -> None:
    tally = Tally(Counts())
    for frame in range(1000):
        now = 10 + frame / 50
        tally.received(600, now)
        tally.verified(END, 2000, now)
    statistics = tally.meter.statistics(30.125)
    assert statistics.window_s == 5.125
    assert statistics.frames_per_s == 250 / 5.125
    assert statistics.bytes_per_s == 250 * 600 / 5.125
    assert statistics.compression == 4.0
    assert (statistics.render_us, statistics.encode_us, statistics.wire_bytes) == (4000, 6000, 500)
    assert tally.counts.frames == 1000
    later = tally.meter.statistics(100)
    assert (later.frames_per_s, later.bytes_per_s, later.compression, later.render_us) == (0, 0, None, None)


def test_a_beginning_is_not_divided_by_next_to_nothing() -> None:
    tally = Tally(Counts())
    tally.verified(END, 2000, 1.0)
    assert tally.meter.statistics(1.0).frames_per_s == 4.0
    assert tally.meter.quality(2.0).window_s == 1.0


def test_words() -> None:
    assert LinkQuality(5, 0, 0, 0, 0, None).words == "silent"
    assert LinkQuality(5, 60, 0, 0, 0, 0.0).words == "good"
    bad = LinkQuality(5, 56, 5, 3.2, 9, 1.234e-5)
    assert bad.words == "5 of 61 frames failed, 3.2 damaged pieces/s, bit errors about 1.2e-05"
    assert bad.failed_share == 5 / 61
    assert LinkQuality(5, 0, 0, 2.0, 0, 0.0).words == "2.0 damaged pieces/s"


@pytest.mark.parametrize("rate", [1e-6, 1e-5, 1e-4])
def test_the_bit_error_rate_is_the_link_s(rate: float) -> None:
    """Packets of 1000 bytes, of which as many are lost as that rate loses."""
    survives = (1 - rate) ** 8000
    tally = Tally(Counts())
    lost = 0.0
    for _ in range(200):
        tally.received(1000, 1.0)
        lost += 1 - survives
        if lost >= 1:
            tally.lost(1, 1.0)
            lost -= 1
        else:
            tally.packet(1.0)
    told = tally.meter.quality(1.0).bit_error_rate
    assert told is not None
    assert math.isclose(told, rate, rel_tol=0.3 if rate > 1e-6 else 2)


@pytest.mark.parametrize("bits", [3e-6, 1e-5, 1e-4])
def test_a_session_tells_how_bad_its_link_is(bits: float) -> None:
    talk = Talk(FakeDevice(96, 32, bars(96, 32), faults=Faults(5, bits=bits)))
    told = []
    for _ in range(3):
        talk.run(270)  # more than a window, so that the windows share nothing
        told.append(talk.session.quality(talk.now))
    estimates = [quality.bit_error_rate or 0.0 for quality in told]
    assert 0.3 * bits < sum(estimates) / len(estimates) < 3 * bits
    assert sum(quality.failed for quality in told) <= talk.session.counts.failed
    assert told[-1].words != "good"
    quality = Talk().session.quality()
    assert (quality.frames, quality.bit_error_rate, quality.words) == (0, None, "silent")


def test_up_to_1e_5_the_picture_is_whole_again_within_five_frames() -> None:
    for bits in (1e-6, 1e-5):
        talk = Talk(FakeDevice(120, 64, bars(120, 64), faults=Faults(7, bits=bits)))
        talk.run(400)
        numbers = {frame.number for frame in talk.frames}
        gaps = []
        gap = 0
        for number in range(talk.device._frame):
            gap = 0 if number in numbers else gap + 1
            gaps += [gap] if gap and number + 1 in numbers else []
        assert gaps, "no fault came"
        assert sum(gaps) / len(gaps) <= 5


def test_a_slot_is_as_long_as_it_says_and_memory_is_bounded() -> None:
    meter = Meter()
    for step in range(100_000):
        meter.at(step / 100).packets += 1
    assert len(meter._slots) <= 22
    assert meter.quality(999.99).window_s == pytest.approx(5.24)
