"""`edgeline export`: what Pillow and ffmpeg read from the files are the recording's frames, at the device's times."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from conftest import HOST, environment
from edgeline.cli import main
from edgeline.codec import Pixels
from edgeline.colour import to_rgb
from edgeline.exports.animation import Ticks
from edgeline.exports.mp4 import arguments
from edgeline.recorder import recorder
from edgeline.recording import opened
from fake_device import FakeDevice, PtyDevice
from needs import missing
from recorded import as_file, frames_of, write_recording

FRAMES = 12


def few_colours(frame: int) -> Pixels:
    """A GIF holds them exactly. Its sides are odd."""
    picture = np.full((31, 47), 0x1082, "<u2")
    left = frame % 27
    picture[10:20, left : left + 20] = np.arange(20, dtype="<u2") * 1001
    return picture


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The test's folder, with a recording a.elrec in it."""
    monkeypatch.chdir(tmp_path)
    device = FakeDevice(47, 31, scene=few_colours, split=True, frame_us=33_333)
    write_recording(tmp_path / "a.elrec", FRAMES, device)
    return tmp_path


def pictures() -> list[np.ndarray]:
    return [to_rgb(few_colours(frame)) for frame in range(FRAMES)]


def played(path: Path) -> tuple[list[np.ndarray], list[float]]:
    """Every frame as a viewer composes it, and the durations in ms."""
    frames, durations = [], []
    with Image.open(path) as image:
        for i in range(getattr(image, "n_frames", 1)):
            image.seek(i)
            frames.append(np.asarray(image.convert("RGB")))
            durations.append(image.info.get("duration", 0.0))
    return frames, durations


@pytest.mark.parametrize("name", ["a.gif", "a.png", "a.apng", "f/%03d.png"])
def test_pillow_reads_the_very_frames(here: Path, name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", "a.elrec", "-o", name, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["frames"] == FRAMES
    if "%" in name:
        frames = [played(here / (name % i))[0][0] for i in range(FRAMES)]
    else:
        frames, durations = played(here / name)
        # 33.333 ms each, rounded so that the sum is right.
        tick = 10 if name.endswith("gif") else 1
        ends = np.cumsum(durations)
        assert np.abs(ends - 33.333 * np.arange(1, FRAMES + 1)).max() <= tick / 2 + 0.01
    assert len(frames) == FRAMES
    assert all(np.array_equal(a, b) for a, b in zip(frames, pictures(), strict=True))


def test_the_same_by_record(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["record", "-p", "a.elrec", "-o", "b.gif"]) == 0
    assert main(["export", "a.elrec", "-o", "c.gif"]) == 0
    assert (here / "b.gif").read_bytes() == (here / "c.gif").read_bytes()
    assert main(["export", "a.elrec", "--frames", "3", "-o", "c.gif"]) == 0
    assert len(played(here / "c.gif")[0]) == 3


def test_frames_of_several_moments_are_left_out(here: Path) -> None:
    device = FakeDevice(47, 31, scene=few_colours, rolls=True, room=300)
    with PtyDevice(device) as served:
        assert main(["record", "-p", served.port, "--mode", "roll", "--frames", "30", "-o", "b.elrec"]) == 0
    frames = [frame for _, frame in frames_of(here / "b.elrec")]
    whole = [frame for frame in frames if not frame.mixed]
    assert len(whole) < len(frames) == 30
    status = main(["export", "b.elrec", "-o", "f/%d.png"])
    assert status == (0 if whole else 4)
    assert len(list((here / "f").iterdir())) == len(whole)


def test_a_gif_has_256_colours_exactly(tmp_path: Path) -> None:
    picture = np.random.default_rng(3).choice(65536, 256, replace=False).astype("<u2").reshape(16, 16)
    writer = recorder(str(tmp_path / "a.gif"))
    writer.add(picture, 0)
    writer.finish()
    assert np.array_equal(played(tmp_path / "a.gif")[0][0], to_rgb(picture))


def test_ticks_never_drift() -> None:
    ticks = Ticks(1000)
    assert sum(ticks.of(33_333) for _ in range(3000)) == 99_999
    least = Ticks(10_000, 2)
    assert [least.of(2_000) for _ in range(5)] == [2] * 5
    assert least.of(50_000) == 4  # a lengthened frame is made up for by half a tick at most


# --- MP4 ------------------------------------------------------------------------------------------------------------

STAND_IN = """#!{python}
import json, sys
from pathlib import Path
Path("asked.json").write_text(json.dumps(sys.argv[1:]))
frames = sys.stdin.buffer.read({read})
Path("frames.raw").write_bytes(frames)
if {fails}:
    print("first line\\nthe reason, at last", file=sys.stderr)
    sys.exit(3)
Path(sys.argv[-1].removeprefix("file:")).write_bytes(b"an MP4")
"""


def stand_in(folder: Path, monkeypatch: pytest.MonkeyPatch, *, read: int = -1, fails: bool = False) -> None:
    """A program named ffmpeg that notes what it is given."""
    program = folder / "bin" / "ffmpeg"
    program.parent.mkdir()
    program.write_text(STAND_IN.format(python=sys.executable, read=read, fails=fails))
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(program.parent))


def test_ffmpeg_is_called_as_the_document_says(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    stand_in(here, monkeypatch)
    assert main(["export", "a.elrec", "-o", "a.mp4"]) == 0
    asked = json.loads((here / "asked.json").read_text())
    text = (HOST / "RECORDING.md").read_text(encoding="utf-8")
    documented = re.search(r"    ffmpeg (-hide_banner.*\n(?:        .*\n)+)", text)
    assert documented is not None
    words = documented[1].replace("WxH", "47x31").split()
    assert asked[:-1] == words[:-1]
    assert asked[-1].startswith(f"file:{here}/.a.mp4.") or asked[-1].startswith("file:.a.mp4.")
    assert words[-1] == "file:OUT"
    assert (here / "a.mp4").read_bytes() == b"an MP4"
    assert sorted(path.name for path in here.iterdir()) == ["a.elrec", "a.mp4", "asked.json", "bin", "frames.raw"]


def test_ffmpeg_gets_each_frame_for_its_time(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    stand_in(here, monkeypatch)
    assert main(["export", "a.elrec", "-o", "a.mp4"]) == 0
    raw = np.fromfile(here / "frames.raw", np.uint8).reshape(-1, 31, 47, 3)
    ends = [round(3.3333 * (i + 1)) for i in range(FRAMES)]
    assert len(raw) == ends[-1] == 40
    for tick, frame in enumerate(raw):
        shown = next(i for i, end in enumerate(ends) if tick < end)
        assert np.array_equal(frame, pictures()[shown])


@pytest.mark.parametrize("read", [-1, 5000])
def test_an_ffmpeg_that_fails_is_quoted(
    here: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], read: int
) -> None:
    (here / "a.mp4").write_bytes(b"precious")
    device = FakeDevice(400, 300, split=True)  # more than a pipe holds
    write_recording(here / "a.elrec", 4, device)
    stand_in(here, monkeypatch, read=read, fails=True)
    assert main(["export", "a.elrec", "-o", "a.mp4"]) == 2
    assert capsys.readouterr().err == "edgeline: a.mp4: ffmpeg ended with status 3: the reason, at last\n"
    assert (here / "a.mp4").read_bytes() == b"precious"
    assert not [path for path in here.iterdir() if path.name.endswith(".part")]


def test_without_ffmpeg_it_is_said_what_to_install(
    here: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("PATH", str(here))
    assert main(["record", "-p", "no such port", "-o", "a.mp4"]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "a.mp4: MP4 needs the program ffmpeg, which is not installed" in said


def test_ctrl_c_leaves_ffmpeg_time_to_finish(here: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    stand_in(here, monkeypatch)
    with PtyDevice(FakeDevice(), frame_s=0.02) as served:
        # What a shell starts with & ignores Ctrl+C, and so do its children, the tests among them: not this one.
        ignored = signal.signal(signal.SIGINT, signal.default_int_handler)
        recording = subprocess.Popen(
            [sys.executable, "-m", "edgeline", "record", "-p", served.port, "-o", "a.mp4"],
            env={**environment(), "PATH": str(here / "bin")},
            stdout=subprocess.PIPE,
            start_new_session=True,
        )
        signal.signal(signal.SIGINT, ignored)
        while len(served.device.sent) < 10:
            time.sleep(0.01)
        os.killpg(recording.pid, signal.SIGINT)  # as a terminal does: to the whole group
        assert recording.wait(20) == 0
        assert recording.stdout is not None
        recording.stdout.close()
    assert (here / "a.mp4").read_bytes() == b"an MP4"


@pytest.fixture
def ffmpeg(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> str:
    """The real one: the system's, or else the one that imageio-ffmpeg brings, put where commands are looked for."""
    found = shutil.which("ffmpeg")
    if found is not None:
        return found
    try:
        import imageio_ffmpeg  # noqa: PLC0415 (of use here alone)
    except ImportError:
        missing("ffmpeg")
    folder = tmp_path_factory.mktemp("bin")
    (folder / "ffmpeg").symlink_to(imageio_ffmpeg.get_ffmpeg_exe())
    monkeypatch.setenv("PATH", str(folder), prepend=os.pathsep)
    return str(folder / "ffmpeg")


def test_the_real_ffmpeg_shows_every_frame(ffmpeg: str, tmp_path: Path) -> None:
    """Played again, each frame is there for its time, each pixel four times, its colour within what H.264 loses."""
    writer = recorder(str(tmp_path / "a.mp4"))
    for frame in range(FRAMES):
        writer.add(few_colours(frame), 40_000 * frame)
    writer.finish()
    decode = [ffmpeg, "-loglevel", "error", "-i", str(tmp_path / "a.mp4"), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    raw = subprocess.run(decode, capture_output=True, check=True, timeout=60).stdout
    shown = np.frombuffer(raw, np.uint8).reshape(-1, 62, 94, 3).astype(int)
    assert len(shown) == 4 * FRAMES
    for tick, picture in enumerate(shown):
        expected = to_rgb(few_colours(tick // 4)).repeat(2, axis=0).repeat(2, axis=1).astype(int)
        assert np.abs(picture - expected).mean() < 4
        assert np.abs(picture - expected)[:18].max() < 12  # the plain background
    assert [path.name for path in tmp_path.iterdir()] == ["a.mp4"]


def test_arguments_name_no_protocol_of_ffmpeg_s() -> None:
    assert arguments(4, 2, "concat:a|b")[-1] == "file:concat:a|b"


def test_a_size_that_changes_ends_the_recording(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The board was given another firmware while it was recorded."""
    write_recording(here / "b.elrec", 3, FakeDevice(20, 10, boot_id=5, split=True))
    pieces = []
    for begin_us, name in ((0, "a.elrec"), (10_000_000, "b.elrec")):
        with opened(name) as reader:
            pieces += [replace(piece, time_us=piece.time_us + begin_us) for piece in reader]
    (here / "c.elrec").write_bytes(as_file(pieces))
    assert main(["export", "c.elrec", "-o", "c.gif"]) == 4
    assert "the picture's size has changed" in capsys.readouterr().err
    assert len(played(here / "c.gif")[0]) == FRAMES
