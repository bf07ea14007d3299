"""The plots and the numbers beside the picture: ten seconds of each, in bounded memory, drawn where they belong."""

from __future__ import annotations

import tkinter as tk
import tracemalloc

import numpy as np

from edgeline.codec import PIXEL
from edgeline.events import Frame
from edgeline.protocol import COUNTERS, FrameEnd
from edgeline.viewer import history
from edgeline.viewer.history import BUCKETS, History, Track, count_in_words, in_words, label, nice_ceiling
from edgeline.viewer.log import LINES, LONGEST_LINE, Log, Source
from edgeline.viewer.paint import chart
from fake_device import FakeDevice, PtyDevice
from viewer_at_work import at_work

PICTURE = np.zeros((4, 8), PIXEL)
GROUND, LINE, FAILED = (10, 20, 30), (200, 100, 50), (255, 0, 0)


def frame(number: int, *, time_us: int = 0, render_us: int = 1000, wire_bytes: int = 10, cycles: int = 0) -> Frame:
    counters = tuple(range(number, number + len(COUNTERS)))
    time_us &= 0xFFFFFFFF
    return Frame(
        number, PICTURE, FrameEnd(number, 1, time_us, render_us, 2500, wire_bytes, 2, 0, counters, cycles=cycles)
    )


def test_every_number_of_a_frame_is_a_series() -> None:
    taken = History()
    taken.add(frame(7, cycles=123), 100.0)
    latest = taken.latest()
    assert latest[history.RENDER_MS] == 1.0
    assert latest[history.WIRE_MS] == 2.5
    assert latest[history.CYCLES] == 123
    assert latest[history.BYTES_SENT] == 10
    assert latest[history.BYTES_SAVED] == 2 * 8 * 4 - 10
    assert latest[history.NOT_SENT] == 2
    assert [latest[name] for name in COUNTERS] == list(range(7, 7 + len(COUNTERS)))
    assert np.isnan(latest[history.FRAME_MS])  # it takes two frames


def test_frame_time_is_the_device_s_and_survives_its_clock_s_wrap_and_restart() -> None:
    taken = History()
    for number, time_us in enumerate((0xFFFFFFFF - 9_999, 0xFFFFFFFF + 10_001)):
        taken.add(frame(number, time_us=time_us), number * 0.5)
    assert taken.latest()[history.FRAME_MS] == 20.0
    taken.restart()
    taken.add(frame(2, time_us=100_000), 2.0)
    assert np.isnan(taken.latest()[history.FRAME_MS])
    assert taken.track(history.FRAME_MS, 2.0).summary == (20.0, 20.0, 20.0)


def test_a_track_is_what_fell_into_each_bucket_of_ten_seconds() -> None:
    """Against the plain way: all samples kept, sorted into buckets afterwards."""
    random = np.random.default_rng(5)
    taken, samples, now = History(), [], 50.0
    for number in range(3000):
        # Bursts, single frames and gaps, one of them longer than the whole window.
        now += float(random.choice((0.0, 0.001, 0.03, 0.2, 0.5), p=(0.3, 0.5, 0.15, 0.04, 0.01)))
        now += 13.0 if number == 1500 else 0.0
        value = int(random.integers(0, 5000))
        samples.append((int(now / history.BUCKET_S), value / 1000))
        taken.add(frame(number & 0xFFFF, render_us=value), now)
        if number % 250 == 17:
            at = now + float(random.choice((0.0, 1.0, 9.0, 20.0)))
            track = taken.track(history.RENDER_MS, at)
            for column, bucket in enumerate(
                range(int(at / history.BUCKET_S) - BUCKETS + 1, int(at / history.BUCKET_S) + 1)
            ):
                inside = [v for b, v in samples if b == bucket]
                if inside:
                    assert (track.low[column], track.high[column]) == (min(inside), max(inside))
                    assert track.mean[column] == sum(inside) / len(inside)
                else:
                    assert np.isnan(track.mean[column])


def test_memory_is_the_same_for_ten_frames_and_for_eight_thousand() -> None:
    taken = History()
    for number in range(10):
        taken.add(frame(number), number * 0.001)
    tracemalloc.start()
    before = tracemalloc.get_traced_memory()[0]
    for number in range(8_000):
        taken.add(frame(number & 0xFFFF), 1 + number * 0.001)
        if number % 5 == 0:
            taken.fail(1, 1 + number * 0.001)
    grown = tracemalloc.get_traced_memory()[0] - before
    tracemalloc.stop()
    assert grown < 20_000


def test_a_newer_firmware_s_counters_are_shown_too() -> None:
    taken = History()
    taken.add(frame(1), 1.0)
    counters = tuple(range(len(COUNTERS) + 2))
    taken.add(Frame(2, PICTURE, FrameEnd(2, 1, 0, 0, 0, 0, 0, 0, counters)), 1.1)
    assert taken.latest()[f"counter_{len(COUNTERS) + 1}"] == len(COUNTERS) + 1


def track_of(values: list[float]) -> Track:
    mean = np.full(BUCKETS, np.nan)
    mean[-len(values) :] = values
    return Track(mean - 1, mean, mean + 1, values[-1])


def test_a_chart_s_line_is_at_its_values() -> None:
    nothing = np.zeros(BUCKETS, np.int64)
    image = chart(track_of([5.0] * BUCKETS), nothing, (BUCKETS, 11), 10.0, (GROUND, LINE, FAILED))
    assert image.shape == (11, BUCKETS, 3)
    line = (image == LINE).all(axis=-1)
    assert line[5].all()
    assert line.sum() == BUCKETS
    assert not (image[4] == image[3]).all()  # the range from the least to the greatest is marked, beyond it nothing is
    assert (image[3] == GROUND).all()
    step = chart(track_of([0.0] * 10 + [10.0] * 10), nothing, (BUCKETS, 11), 10.0, (GROUND, LINE, FAILED))
    line = (step == LINE).all(axis=-1)
    assert not line[:, :-20].any()
    assert line[10, -20:-10].all()
    assert line[0, -10:].all()
    assert line[:, -10].all()  # where it rises, a column joins both


def test_a_chart_repeats_the_last_value_until_the_next_frame_and_ends_with_the_last_one() -> None:
    values = [np.nan] * 40
    values[0], values[20] = 10.0, 0.0
    image = chart(track_of(values), np.zeros(BUCKETS, np.int64), (BUCKETS, 11), 10.0, (GROUND, LINE, FAILED))
    line = (image == LINE).all(axis=-1)
    assert line[0, -40:-20].all()
    assert line[10, -20]
    assert not line[:, -19:].any()


def test_a_failed_frame_is_marked_at_the_foot() -> None:
    failures = np.zeros(BUCKETS, np.int64)
    failures[17] = 3
    image = chart(track_of([5.0]), failures, (BUCKETS, 40), 10.0, (GROUND, LINE, FAILED))
    red = (image == FAILED).all(axis=-1)
    assert red[-3:, 17].all()
    assert red.sum() == 3


def test_axes_end_at_round_numbers() -> None:
    assert [nice_ceiling(v) for v in (0, 0.7, 1, 1.01, 2, 4.9, 5, 5.1, 99, 100, 12345)] == [
        *(1, 1, 1, 2, 2, 5, 5, 10, 100, 100, 20000)
    ]


def test_numbers_are_short_enough_to_be_read() -> None:
    assert [count_in_words(v) for v in (0, 117, 12345, 1234567, 2.5, 4294967295)] == [
        *("0", "117", "12,345", "1.23 M", "2.5", "4.29 G")
    ]
    assert in_words(history.RENDER_MS, 4.321) == "4.3 ms"
    assert in_words(history.RENDER_MS, 1234.5) == "1,234 ms"
    assert in_words("pixels", float("nan")) == "-"
    assert [label(name) for name in ("triangles", "memory_peak", "counter_99")] == [
        *("triangles in", "memory peak, bytes", "counter 99")
    ]


def test_the_log_is_bounded_and_tells_of_damage_once_a_second() -> None:
    log = Log()
    log.damage("a packet with a wrong CRC", 10.0)
    for i in range(5000):
        log.damage(f"piece {i}", 10.0 + i / 10_000)
    log.settle(10.9)
    log.settle(11.0)
    lines, number = log.since(0)
    assert [line.text for line in lines] == ["a packet with a wrong CRC", "piece 4999 (and 4,999 more)"]
    for i in range(3 * LINES):
        log.add(Source.DEVICE, f"{i}\x1b\x07" + "x" * 2 * LONGEST_LINE)
    lines, number = log.since(number)
    assert (len(lines), number) == (LINES, 2 + 3 * LINES)
    assert max(len(line.text) for line in lines) == LONGEST_LINE + 1
    assert all(line.text.isprintable() for line in lines)
    assert log.since(number) == ([], number)


def texts_of(canvas: tk.Canvas) -> set[str]:
    """What can be read on it."""
    items = [item for item in canvas.find_all() if canvas.type(item) == "text"]
    return {canvas.itemcget(item, "text") for item in items if canvas.itemcget(item, "state") != "hidden"}


def test_a_click_on_a_number_plots_it_and_another_one_ends_that(display: str) -> None:
    with PtyDevice(FakeDevice()) as served, at_work(display, served.port) as viewer:
        viewer.until(lambda: viewer.model.frames > 5)
        viewer.settle()
        plotted = [*history.TIMES, history.CYCLES, history.BYTES_SENT]
        assert viewer.window.charts.chosen == plotted
        row = list(viewer.model.series()).index("triangles")
        for expected in ([*plotted, "triangles"], plotted):
            viewer.window.numbers.canvas.event_generate("<Button-1>", x=40, y=row * 16 + 8)
            viewer.settle()
            assert viewer.window.charts.chosen == expected
            assert ("Triangles in" in texts_of(viewer.window.charts.canvas)) == ("triangles" in expected)
