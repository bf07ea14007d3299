"""Every command that reads a device, and `edgeline.open`, over ptys, TCP, pipes and recordings, faults included."""

from __future__ import annotations

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
from edgeline.cli import main
from edgeline.colour import to_rgb
from edgeline.framing import Packet, Splitter
from edgeline.playback import RecordingTransport
from edgeline.protocol import Mode, SetBaud, Start, Stop, unpack
from edgeline.recording import opened
from edgeline.session import Session
from fake_device import FakeDevice, Faults, PtyDevice, TcpDevice, _Served, bars
from recorded import (
    capture,
    edgeline_here,  # noqa: F401 (a fixture)
    frames_of,
    write_recording,
)

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


# --- headless viewing, and the port's options -----------------------------------------------------------------------


def test_view_without_a_window(link: type[_Served], edgeline: Edgeline) -> None:
    with link(FakeDevice(split=True)) as served:
        seen = edgeline("view", "-p", served.port, "--headless", "--frames", "9", "--json", "--digests")
        assert (seen.returncode, seen.stderr) == (0, "")
        told = json.loads(seen.stdout)
        lines = edgeline("view", "-p", served.port, "--headless", "--frames", "3", "--digests").stdout.splitlines()
    assert (told["frames"], told["quality"], len(told["digests"])) == (9, "good", 9)
    assert [len(line.split()) for line in lines[:3]] == [2, 2, 2]
    assert lines[3].startswith(f"{told['port']}: 3 verified frames")


def test_a_recording_is_a_port_for_all_of_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    frames = write_recording(tmp_path / "a.elrec", 14)

    def run(*arguments: str) -> dict[str, object]:
        assert main([*arguments, "-p", "a.elrec", "--json"]) == 0
        told: dict[str, object] = json.loads(capsys.readouterr().out)
        return told

    digests = [f"{frame.end.digest:08x}" for frame in frames]
    assert run("view", "--headless", "--digests")["digests"] == digests
    assert run("shot", "--frames", "6")["digest"] == digests[5]
    assert np.array_equal(np.asarray(Image.open(tmp_path / "shot.png")), to_rgb(frames[5].picture))
    assert run("record", "-o", "f/%02d.png")["frames"] == 14
    assert np.array_equal(np.asarray(Image.open(tmp_path / "f/13.png")), to_rgb(frames[13].picture))
    assert run("bench")["frames"] == 13
    info = run("info")
    assert info["target"] == "fake board"
    assert info["recording"] == {
        "recorded_from": "/dev/ttyACM0",
        "start": "2026-09-21T14:13:20.123+00:00",
        "seconds": frames_of(tmp_path / "a.elrec")[-1][0],
        "frames": 14,
        "received": sum(len(piece) for piece in _said(tmp_path / "a.elrec", 0)),
        "sent": sum(len(piece) for piece in _said(tmp_path / "a.elrec", 1)),
    }
    with package.open("a.elrec") as stream:
        assert [f"{frame.end.digest:08x}" for frame in stream] == digests


def _said(path: Path, direction: int) -> list[bytes]:
    with opened(str(path)) as reader:
        return [piece.data for piece in reader if piece.direction == direction]


def test_a_recording_has_all_that_passed(link: type[_Served], edgeline: Edgeline, tmp_path: Path) -> None:
    """The device's bytes from the first on, the host's up to STOP, and the device's frames."""
    with link(FakeDevice(split=True)) as served:
        result = edgeline("record", "-p", served.port, "--frames", "20", "-o", "a.elrec", "--json")
        sent = dict(served.device.sent)
        commands = list(served.device.commands)
    assert (result.returncode, result.stderr) == (0, "")
    told = json.loads(result.stdout)
    frames = [frame for _, frame in frames_of(tmp_path / "a.elrec")]
    assert told["frames"] == len(frames) == 20
    assert all(np.array_equal(frame.picture, sent[frame.number]) for frame in frames)
    assert told["received"] == sum(map(len, _said(tmp_path / "a.elrec", 0)))
    assert told["sent"] == sum(map(len, _said(tmp_path / "a.elrec", 1)))
    chunks = Splitter().feed(b"".join(_said(tmp_path / "a.elrec", 1)))
    bodies = [unpack(chunk) for chunk in chunks if isinstance(chunk, Packet)]
    assert bodies[: len(commands)] == commands
    assert isinstance(bodies[-1], Stop)


def test_a_recording_played_at_its_times(tmp_path: Path) -> None:
    """Half a second of it in a quarter, and nothing too early."""
    write_recording(tmp_path / "a.elrec", 25)
    due = [time_s for time_s, _ in frames_of(tmp_path / "a.elrec")]
    begin = time.monotonic()
    with package.Link(RecordingTransport(str(tmp_path / "a.elrec"), 2.0), Session(one_way=True)) as stream:
        came = [time.monotonic() - begin for _ in stream]
    assert len(came) == 25
    assert all(came_s >= due_s / 2 for came_s, due_s in zip(came, due, strict=True))


def test_the_rate_and_the_mode_are_asked_for(edgeline: Edgeline) -> None:
    with PtyDevice(FakeDevice(max_baud=460_800, rolls=True)) as served:
        assert edgeline("shot", "-p", served.port, "--fast").returncode == 0
        assert edgeline("shot", "-p", served.port, "--fast", "230400").returncode == 0
        seen = edgeline("view", "-p", served.port, "--headless", "--frames", "4", "--mode", "roll")
    assert seen.returncode == 0, seen.stderr
    rates = [body.rate for body in served.device.commands if isinstance(body, SetBaud)]
    assert rates[0] == 460_800
    assert 230_400 in rates
    starts = [body.mode for body in served.device.commands if isinstance(body, Start)]
    assert (starts[0], starts[-1]) == (Mode.BLOCK, Mode.ROLL)


def test_variables_stand_for_port_and_rate(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    opened_at: list[tuple[str, int]] = []

    def connect(port: str, baud: int) -> RecordingTransport:
        opened_at.append((port, baud))
        return RecordingTransport("a.elrec")

    write_recording(tmp_path / "a.elrec", 3)
    monkeypatch.setattr("edgeline.commands.options.connect", connect)
    monkeypatch.setenv("EDGELINE_PORT", "COM7")
    monkeypatch.setenv("EDGELINE_BAUD", "921600")
    assert main(["shot"]) == 0
    assert main(["shot", "-p", "COM3", "-b", "57600"]) == 0
    monkeypatch.delenv("EDGELINE_BAUD")
    assert main(["shot"]) == 0
    assert opened_at == [("COM7", 921600), ("COM3", 57600), ("COM7", 115200)]
    monkeypatch.setenv("EDGELINE_BAUD", "fast")
    capsys.readouterr()
    with pytest.raises(SystemExit) as stopped:
        main(["shot"])
    assert stopped.value.code == 2
    assert "'EDGELINE_BAUD=fast' is no whole number above 0" in capsys.readouterr().err


@pytest.mark.parametrize("command", ["record", "shot", "view", "info", "bench", "verify"])
def test_headless_goes_everywhere(command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A script may say --headless, --timeout and --json to whatever it calls."""
    monkeypatch.chdir(tmp_path)
    write_recording(tmp_path / "a.elrec", 5)
    more = {"record": ["-o", "a.gif"], "verify": ["a.crc", "--update"]}.get(command, [])
    assert main([command, *more, "-p", "a.elrec", "--headless", "--timeout", "5", "--json"]) == 0


def test_a_rate_that_cannot_be_had_is_told_in_one_line(edgeline: Edgeline) -> None:
    with PtyDevice(FakeDevice(max_baud=0)) as served:
        shot = edgeline("shot", "-p", served.port, "--fast", "230400")
    assert shot.returncode == 0
    assert shot.stderr.count("\n") == 1
    assert "its link's rate cannot be changed" in shot.stderr


COMMANDS = ["list", "info", "view", "record", "export", "shot", "replay", "cut", "verify", "bench", "convert", "budget"]


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_explains_itself(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stopped:
        main([command, "--help"])
    assert stopped.value.code == 0
    said = " ".join(capsys.readouterr().out.split())
    assert said.startswith(f"usage: edgeline {command}")
    if command not in ("convert", "budget"):
        assert "exit codes: 0 done; 1 verify found a difference; 2 bad command line or file; 3 no device" in said
