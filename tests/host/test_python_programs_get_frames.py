"""`edgeline.open`, as a program uses it: the example of its docstring, arrays, time stamps, statistics, errors."""

from __future__ import annotations

import doctest
import inspect
import itertools
import time
from pathlib import Path

import numpy as np
import pytest

import edgeline
from edgeline import Control, DeviceError, EdgelineError, StreamError
from edgeline.errors import StreamEndError
from edgeline.link import Link
from edgeline.protocol import Log
from edgeline.session import Session
from fake_device import FakeDevice, Faults, PtyDevice, TcpDevice, bars


def test_the_example_of_the_docstring_does_what_it_shows() -> None:
    with PtyDevice(FakeDevice(320, 240)) as served:
        text = (edgeline.open.__doc__ or "").replace("/dev/ttyACM0", served.port)
        names = {"edgeline": edgeline, "itertools": itertools}
        example = doctest.DocTestParser().get_doctest(text, names, "open", None, 0)
        assert example.examples
        runner = doctest.DocTestRunner(verbose=False)
        assert runner.run(example).failed == 0


def test_arrays_have_the_shapes_and_types_that_are_promised() -> None:
    with TcpDevice(FakeDevice()) as served, edgeline.open(served.port) as link:
        frame = link.next_frame()
        assert (frame.rgb565.shape, frame.rgb565.dtype) == ((32, 48), np.uint16)
        assert (frame.rgb888.shape, frame.rgb888.dtype) == ((32, 48, 3), np.uint8)
        assert np.array_equal(frame.rgb565, bars()(frame.number))
        assert np.array_equal(frame.rgb888, edgeline.to_rgb(frame.rgb565))
        assert frame.rgb888 is frame.rgb888, "computed once"
        with pytest.raises(ValueError, match="read-only"):
            frame.rgb565[0, 0] = 1
        assert not frame.mixed
        assert frame.lines_sent.tolist() == [True] * 32
        later = list(itertools.islice(link, 3))[-1]
        assert 0 < later.lines_sent.sum() < 32


def test_time_stamps_and_statistics() -> None:
    device = FakeDevice(80, 32, split=True, frame_us=50_000)
    began = time.monotonic()
    with PtyDevice(device) as served, edgeline.open(served.port) as link:
        frames = list(itertools.islice(link, 30))
        statistics, quality = link.statistics, link.quality
    assert [round(frame.time_s * 1000) for frame in frames] == [50 * i for i in range(30)]
    assert began < frames[0].received_s <= frames[-1].received_s <= time.monotonic()
    stats = frames[-1].stats
    assert (stats.render_us, stats.encode_us, stats.wire_bytes, stats.raw_bytes) == (4321, 1234, 5678, 5120)
    assert (stats.not_sent, stats.cycles, stats.bands) == (0, 654321, frames[-1].end.bands)
    assert stats.compression == 5120 / 5678
    assert stats.counters == frames[-1].counters
    assert stats.counters["passes"] == 100
    assert statistics.frames_per_s > 1
    assert statistics.compression == pytest.approx(5120 / 5678)
    assert (statistics.render_us, statistics.encode_us, statistics.wire_bytes) == (4321, 1234, 5678)
    assert statistics.bytes_per_s > 0
    assert quality.failed == 0
    assert quality.words == "good"


def test_without_a_port_the_environment_s_is_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    with PtyDevice(FakeDevice()) as served:
        monkeypatch.setenv("EDGELINE_PORT", served.port)
        with edgeline.open() as link:
            assert link.transport.name == served.port
            link.next_frame()
        monkeypatch.setenv("EDGELINE_PORT", "")
        monkeypatch.setattr(edgeline, "find", lambda baud: served.port if baud == 9600 else "")
        with edgeline.open(baud=9600) as link:
            assert link.transport.baud == 9600
            link.next_frame()


def test_the_device_is_asked_for_what_the_program_wants() -> None:
    device = FakeDevice(rolls=True)
    with PtyDevice(device) as served, edgeline.open(served.port, mode="roll", fps=7) as link:
        link.control(Control.VIEW, edgeline.DebugView.DEPTH)
        link.next_frame()
    start = next(body for body in device.commands if body.TYPE.name == "START")
    assert (start.mode, start.fps) == (1, 7)  # type: ignore[union-attr]
    assert device.taken == [(13, 2)]


def test_errors_are_of_the_types_that_are_promised() -> None:
    with pytest.raises(EdgelineError, match="no mode 'fast'"):
        edgeline.open("x", mode="fast")
    with pytest.raises(EdgelineError, match="70000 frames per second"):
        edgeline.open("x", fps=70000)
    with pytest.raises(DeviceError, match="there is no such port"):
        edgeline.open("/dev/ttyABSENT")
    with (
        TcpDevice(FakeDevice(major=2)) as served,
        edgeline.open(served.port) as link,
        pytest.raises(DeviceError, match=r"version 2\.3 of the wire, this host 1\.2"),
    ):
        link.next_frame(5)
    with (
        PtyDevice(FakeDevice(limit=3)) as served,
        edgeline.open(served.port, timeout=0.3) as link,
        pytest.raises(StreamError, match=r"no verified frame within 0\.3 s"),
    ):
        list(link)
    with TcpDevice(FakeDevice()) as served, edgeline.open(served.port) as link:
        link.next_frame()
        served.stop()
        with pytest.raises(StreamError, match="closed the connection"):
            list(link)


def test_a_frame_that_was_waiting_does_not_show_what_is_asked_for_now() -> None:
    with PtyDevice(FakeDevice()) as served, edgeline.open(served.port) as link:
        frame = link.next_frame()
        assert frame.shows_inputs
        while not link._frames:
            link._collect()
        link.control("scene", 2)
        assert not link.next_frame().shows_inputs
        assert link.next_frame(settled=True).shows_inputs


def test_frames_come_through_a_bad_link_and_the_link_says_how_bad() -> None:
    device = FakeDevice(faults=Faults(5, flip=0.03))
    with PtyDevice(device) as served, edgeline.open(served.port) as link:
        for frame in itertools.islice(link, 60):
            assert np.array_equal(frame.rgb565, device.sent[frame.number])
        assert link.quality.damaged_per_s > 0
        assert "damaged pieces/s" in link.quality.words


def test_closing_twice_and_closing_a_lost_link_are_no_errors() -> None:
    with PtyDevice(FakeDevice()) as served:
        link = edgeline.open(served.port)
        link.next_frame()
        served.stop()
        link.close()
        link.close()


def test_a_captured_stream_is_iterated_to_its_end(tmp_path: Path) -> None:
    device = FakeDevice(limit=5)
    device.streaming, device.credits = True, 200
    device.send(Log("captured"))
    device._hello()
    capture = tmp_path / "capture.bin"
    capture.write_bytes(b"".join(device.run(i / 10) for i in range(10)))
    said: list[str] = []
    with edgeline.open(str(capture), on_log=said.append) as link:
        assert [frame.number for frame in link] == [0, 1, 2, 3, 4]
        with pytest.raises(DeviceError, match="one-way"):
            link.control("scene", 1)
    assert said == ["captured"]
    (tmp_path / "empty.bin").write_bytes(b"")
    with edgeline.open(str(tmp_path / "empty.bin")) as link, pytest.raises(DeviceError, match="nothing answers before"):
        next(iter(link))


def test_a_stream_that_ends_before_a_frame_is_an_error(tmp_path: Path) -> None:
    device = FakeDevice()
    device._hello()
    (tmp_path / "hello.bin").write_bytes(device.run(0.0))
    with edgeline.open(str(tmp_path / "hello.bin")) as link, pytest.raises(StreamEndError, match="has ended"):
        next(iter(link))


def test_everything_that_programs_use_is_documented_and_typed() -> None:
    assert (Path(inspect.getfile(edgeline)).parent / "py.typed").is_file()
    for name in edgeline.__all__:
        thing = getattr(edgeline, name)
        assert inspect.getdoc(thing), name
    for thing in (Link, Session, edgeline.Frame):
        for name, member in vars(thing).items():
            if not name.startswith("_") and (callable(member) or isinstance(member, property)):
                assert inspect.getdoc(member), f"{thing.__name__}.{name}"
