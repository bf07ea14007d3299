"""`edgeline info`, `shot`, `record` and `edgeline.open` against the fake device on real links, faults included."""

from __future__ import annotations

import io
import json
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import edgeline as package
from conftest import Edgeline, environment
from edgeline.colour import to_rgb
from fake_device import FakeDevice, Faults, PtyDevice, TcpDevice, _Served, bars
from talk import Talk

LINKS = [PtyDevice, TcpDevice]


@pytest.fixture(params=LINKS, ids=["pty", "tcp"])
def link(request: pytest.FixtureRequest) -> type[_Served]:
    kind: type[_Served] = request.param
    return kind


def test_info(link: type[_Served], edgeline: Edgeline) -> None:
    with link(FakeDevice()) as served:
        text = edgeline("info", "-p", served.port)
        assert text.returncode == 0, text.stderr
        assert "fake board" in text.stdout
        assert "48 x 32 RGB565" in text.stdout
        parsed = json.loads(edgeline("info", "--json", env={"EDGELINE_PORT": served.port}).stdout)
    assert parsed["boot_id"] == 0x1234ABCD
    assert parsed["capabilities"] == ["raw bands", "run-length bands", "leaves out unchanged lines", "takes input"]


def test_shot_is_the_device_s_picture(link: type[_Served], edgeline: Edgeline, tmp_path: Path) -> None:
    with link(FakeDevice()) as served:
        result = edgeline("shot", "-p", served.port, "-o", "a.png", "--json")
    assert result.returncode == 0, result.stderr
    assert json.loads(result.stdout)["frames"] == 1
    assert np.array_equal(np.asarray(Image.open(tmp_path / "a.png")), to_rgb(bars()(0)))


@pytest.mark.parametrize("name", ["a.gif", "a.png", "f/%02d.png"])
def test_record(link: type[_Served], edgeline: Edgeline, tmp_path: Path, name: str) -> None:
    with link(FakeDevice()) as served:
        result = edgeline("record", "-p", served.port, "--frames", "12", "-o", name, "--json")
    assert result.returncode == 0, result.stderr
    assert result.stderr == ""
    summary = json.loads(result.stdout)
    assert (summary["frames"], summary["frames_per_second"], summary["seconds"]) == (12, 25.0, 0.44)
    assert summary["damaged"] == 0
    assert summary["counters"]["passes"] == 100
    if "%" in name:
        shown = [np.asarray(Image.open(tmp_path / (name % i))) for i in range(12)]
    else:
        with Image.open(tmp_path / name) as image:
            assert getattr(image, "n_frames", 1) == 12
            shown = [np.asarray(image.convert("RGB")) for i in range(12) if image.seek(i) is None]
    if not name.endswith(".gif"):
        for i in range(12):
            assert np.array_equal(shown[i], to_rgb(bars()(i)))


def test_frames_per_second_are_asked_for(edgeline: Edgeline) -> None:
    with PtyDevice(FakeDevice()) as served:
        assert edgeline("record", "-p", served.port, "--frames", "2", "-o", "a.gif", "--fps", "17").returncode == 0
        assert [body.fps for body in served.device.commands if hasattr(body, "fps")] == [17]


@pytest.mark.parametrize("seed", range(3))
def test_record_over_a_bad_line_is_exact(link: type[_Served], edgeline: Edgeline, tmp_path: Path, seed: int) -> None:
    faults = Faults(seed, flip=0.03, drop=0.02, cut=0.02, duplicate=0.02, noise=0.02)
    with link(FakeDevice(faults=faults)) as served:
        result = edgeline("record", "-p", served.port, "--frames", "40", "-o", "f/%02d.png", "--json")
        sent = [to_rgb(picture) for picture in served.device.sent.values()]
    assert result.returncode == 0, result.stderr
    assert json.loads(result.stdout)["damaged"] > 0
    at = 0
    for i in range(40):
        shown = np.asarray(Image.open(tmp_path / f"f/{i:02}.png"))
        while not np.array_equal(shown, sent[at]):
            at += 1
        at += 1


def test_the_python_interface(link: type[_Served]) -> None:
    with link(FakeDevice()) as served, package.open(served.port) as stream:
        assert stream.hello.target == "fake board"
        for expected, frame in enumerate(stream):
            assert frame.number == expected
            assert np.array_equal(frame.picture, bars()(expected))
            if expected == 20:
                break


def capture(frames: int) -> bytes:
    """What a device says when all its frames are asked for."""
    talk = Talk()
    data = io.BytesIO()
    run = talk.device.run

    def tee(now: float) -> bytes:
        sent = run(now)
        data.write(sent)
        return sent

    talk.device.run = tee  # type: ignore[method-assign]
    while len(talk.frames) < frames:
        talk.step()
    return data.getvalue()


def test_a_captured_stream_is_a_port(edgeline: Edgeline, tmp_path: Path) -> None:
    (tmp_path / "stream.bin").write_bytes(capture(15))
    result = edgeline("record", "-p", "stream.bin", "-o", "f/%02d.png")
    assert (result.returncode, result.stderr) == (0, "")
    assert len(list((tmp_path / "f").iterdir())) == 15


def test_a_piped_stream_is_a_port(tmp_path: Path) -> None:
    piped = subprocess.run(
        [sys.executable, "-m", "edgeline", "record", "-p", "-", "-o", "a.png"],
        cwd=tmp_path,
        env=environment(),
        input=capture(7),
        capture_output=True,
        check=False,
        timeout=60,
    )
    assert (piped.returncode, piped.stderr) == (0, b"")
    assert piped.stdout.startswith(b"a.png: 7 verified frames")


def test_ctrl_c_ends_a_recording_and_keeps_it(tmp_path: Path) -> None:
    with PtyDevice(FakeDevice(), frame_s=0.02) as served:
        # What a shell starts with & ignores Ctrl+C, and so do its children, the tests among them: not this one.
        ignored = signal.signal(signal.SIGINT, signal.default_int_handler)
        recording = subprocess.Popen(
            [sys.executable, "-m", "edgeline", "record", "-p", served.port, "-o", "a.png", "--json"],
            cwd=tmp_path,
            env=environment(),
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
        )
        signal.signal(signal.SIGINT, ignored)
        while len(served.device.sent) < 10:
            time.sleep(0.01)
        recording.send_signal(signal.SIGINT)
        out, err = recording.communicate(timeout=30)
    assert (recording.returncode, err) == (0, b"")
    with Image.open(tmp_path / "a.png") as image:
        assert getattr(image, "n_frames", 1) == json.loads(out)["frames"] >= 1


def test_a_second_device_after_the_first(edgeline: Edgeline) -> None:
    """STOP at the end: the next command does not wait for the last one's credits to run out."""
    with PtyDevice(FakeDevice()) as served:
        for _ in range(3):
            assert edgeline("shot", "-p", served.port).returncode == 0
    names = [type(body).__name__ for body in served.device.commands]
    assert names.count("Stop") == 3
