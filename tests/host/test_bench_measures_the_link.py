"""`edgeline bench`: its figures are those of the bytes that passed, and the latency is a real INPUT's."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from edgeline.cli import main
from edgeline.measure import Measured
from edgeline.protocol import Control
from fake_device import FakeDevice, PtyDevice
from recorded import PlayingDevice, frames_of, write_recording


def bench(capsys: pytest.CaptureFixture[str], *arguments: str) -> dict[str, object]:
    assert main(["bench", *arguments, "--json"]) == 0
    told: dict[str, object] = json.loads(capsys.readouterr().out)
    return told


def test_the_figures_of_a_recording(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = str(tmp_path / "a.elrec")
    write_recording(Path(path), 41)
    told = bench(capsys, "-p", path, "--frames", "30")
    frames = [frame for _, frame in frames_of(Path(path))][1:31]
    assert told["frames"] == 30
    assert told["raw_bytes_per_frame"] == 2 * 48 * 32
    assert told["render_ms"] == pytest.approx(sum(frame.end.render_us for frame in frames) / 30_000, abs=0.001)
    assert told["input_latency_ms"] is None
    assert told["baud"] is None
    assert isinstance(told["host_decode_ms"], float)
    assert told["host_decode_ms"] > 0


def test_what_the_figures_mean() -> None:
    measured = Measured(
        frames=10,
        seconds=2.0,
        link_bytes=20_000,
        band_bytes=19_000,
        raw_bytes=400_000,
        host_s=0.05,
        render_us=30_000,
        encode_us=50_000,
        intervals_s=[0.3, 0.1, 0.2],
        latencies_s=[0.04],
    )
    assert measured.to_json(115_200) == {
        "frames": 10,
        "seconds": 2.0,
        "frames_per_second": 5.0,
        "interval_ms": {"min": 100.0, "median": 200.0, "mean": 200.0, "max": 300.0},
        "bytes_per_second": 10_000.0,
        "bytes_per_frame": 2_000.0,
        "raw_bytes_per_frame": 40_000.0,
        "compression": 20.0,
        "wire_efficiency": 0.95,
        "baud": 115_200,
        "link_use": 0.8681,
        "render_ms": 3.0,
        "encode_and_send_ms": 5.0,
        "host_decode_ms": 5.0,
        "host_decode_frames_per_second": 200.0,
        "input_latency_ms": {"min": 40.0, "median": 40.0, "mean": 40.0, "max": 40.0},
    }
    nothing = Measured().to_json(0)
    assert (nothing["interval_ms"], nothing["link_use"], nothing["host_decode_frames_per_second"]) == (None, None, None)


@pytest.mark.parametrize("paused", [False, True])
def test_the_latency_is_that_of_an_input(paused: bool, capsys: pytest.CaptureFixture[str]) -> None:
    """A frame is shown every 20 ms, so none is quicker than the rest of one; and the device goes on as it was."""
    device = PlayingDevice()
    with PtyDevice(device, frame_s=0.02) as served:
        told = bench(capsys, "-p", served.port, "--frames", "5", *(["--pause"] if paused else []))
    latency = told["input_latency_ms"]
    assert isinstance(latency, dict)
    assert 5 < latency["min"] <= latency["median"] <= latency["max"] < 5000
    inputs = [value for control, value in device.taken if control == Control.PAUSE]
    assert inputs == [int(paused)] * (10 + paused)
    assert [control for control, _ in device.taken if control != Control.PAUSE] == []


def test_without_input_there_is_no_latency(capsys: pytest.CaptureFixture[str]) -> None:
    for device in (FakeDevice(takes_input=False), FakeDevice(minor=1)):
        with PtyDevice(device) as served:
            assert bench(capsys, "-p", served.port, "--frames", "3")["input_latency_ms"] is None


def test_the_table_says_the_same(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_recording(tmp_path / "a.elrec", 5)
    assert main(["bench", "-p", str(tmp_path / "a.elrec")]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[1].split() == ["target", "fake", "board"]
    assert "frames                         4" in lines
    assert "input latency ms               -" in lines
