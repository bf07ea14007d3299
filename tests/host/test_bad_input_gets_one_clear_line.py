"""Every failure of the command line: its status, one line on standard error, and nothing lost."""

from __future__ import annotations

import re
import socket
import subprocess
import sys
import threading
import time
from dataclasses import replace
from pathlib import Path

import pytest
from PIL import Image

from conftest import Edgeline, environment
from edgeline.protocol import Body, Hello
from edgeline.transport import connect
from fake_device import FakeDevice, PtyDevice, TcpDevice, _Served
from faults import Faults
from recorded import (
    called,
    capture,
    edgeline_here,  # noqa: F401 (a fixture)
    write_recording,
)


def complains(result: subprocess.CompletedProcess[str], status: int, *words: str) -> None:
    assert result.returncode == status, result.stderr
    assert result.stdout == ""
    assert result.stderr.count("\n") == 1, result.stderr
    for word in words:
        assert word in result.stderr


BAD_COMMAND_LINES: list[tuple[list[str], list[str]]] = [
    ([], ["COMMAND"]),
    (["dance"], ["dance"]),
    (["record"], ["-o"]),
    (["record", "-o", "a.gif", "--frames", "0"], ["--frames", "'0'"]),
    (["record", "-o", "a.gif", "--frames", "many"], ["'many'"]),
    (["record", "-o", "a.gif", "--fps", "65536"], ["65536"]),
    (["shot", "--timeout", "-1"], ["--timeout", "'-1'"]),
    (["shot", "--timeout", "nan"], ["--timeout", "'nan'"]),
    (["info", "-b", "fast"], ["'fast'"]),
    (["info", "a.elrec"], ["edgeline info: ", "a.elrec", "-p names a port or a recording", "edgeline info --help"]),
    (["info", "--loud", "a.elrec"], ["edgeline info: unrecognized arguments: --loud a.elrec (see"]),
    (["convert", "a.obj", "b.obj", "-o", "c.h"], ["edgeline convert: unrecognized arguments: b.obj (see"]),
    (["shot", "--fast", "0"], ["'0'"]),
    (["shot", "--mode", "jump"], ["'jump'", "block"]),
    (["record", "-o", "a.bmp", "-p", "x"], ["a.bmp", "*.gif"]),
    (["record", "-o", "no/folder/a.gif", "-p", "x"], ["no/folder/a.gif", "No such file"]),
    (["record", "-o", "no/folder/a.elrec", "-p", "x"], ["no/folder/a.elrec", "No such file"]),
    (["record", "-o", "b.elrec", "-p", "a.elrec"], ["a.elrec: is a recording already", "edgeline cut"]),
    (["shot", "-o", ".", "-p", "x"], ["folder"]),
    (["shot", "-o", "a.jpg", "-p", "x"], ["a.jpg", "PNG"]),
    (["shot", "-p", "no.elrec"], ["no.elrec: cannot be read: No such file"]),
    (["shot", "-p", "none.elrec"], ["none.elrec: is no recording", "edgeline record"]),
    (["info", "-p", "none.elrec"], ["none.elrec: is no recording"]),
    (["view", "--json"], ["--json goes with --headless"]),
    (["view", "--scale", "17"], ["'17'", "from 1 to 16"]),
    (["view", "--speed", "0"], ["'0'", "factor above 0"]),
    (["export", "a.elrec"], ["-o"]),
    (["export", "a.elrec", "-o", "b.elrec"], ["b.elrec", "edgeline cut"]),
    (["export", "none.elrec", "-o", "b.gif"], ["none.elrec: is no recording"]),
    (["cut", "a.elrec", "-o", "b.gif"], ["b.gif", "*.elrec"]),
    (["cut", "a.elrec", "--from", "-1", "-o", "b.elrec"], ["'-1'"]),
    (["cut", "a.elrec", "--from", "2", "--to", "2", "-o", "b.elrec"], ["--to 2 is not after --from 2"]),
    (["cut", "none.elrec", "-o", "b.elrec"], ["none.elrec: is no recording"]),
    (["replay", "none.elrec"], ["none.elrec: is no recording"]),
    (["replay", "no.elrec", "--tcp", "0"], ["no.elrec: cannot be read"]),
    (["replay", "a.elrec", "--tcp", "65536"], ["'65536'", "TCP port"]),
    (["replay", "a.elrec", "--tcp", "0", "--pty"], ["--pty", "--tcp"]),
    (["replay", "a.elrec", "--speed", "2", "--as-fast"], ["--as-fast", "--speed"]),
    (["replay", "a.elrec", "--stdout", "--loop"], ["--stdout takes neither"]),
    (["verify"], ["GOLDEN.crc"]),
    (["verify", "no.crc", "-p", "a.elrec"], ["no.crc: cannot be read", "--update makes it"]),
    (["verify", "none.elrec", "-p", "a.elrec"], ["none.elrec, line 1"]),
    (["verify", "no.crc", "-p", "a.elrec", "-r", "x"], ["--reference goes with --diff"]),
    (["verify", "no.crc", "-p", "a.elrec", "--record", "b.elrec"], ["--record is for a device"]),
    (["verify", "no.crc", "-p", "x", "--record", "b.gif"], ["b.gif", "*.elrec"]),
    (["bench", "-o", "b.png"], ["--output goes with --plot"]),
    (["bench", "--plot", "no.json"], ["no.json"]),
]


@pytest.mark.parametrize(
    ("arguments", "words"), BAD_COMMAND_LINES, ids=[" ".join(line) for line, _ in BAD_COMMAND_LINES]
)
def test_bad_command_lines(
    arguments: list[str],
    words: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    write_recording(tmp_path / "a.elrec", 2)
    (tmp_path / "none.elrec").write_bytes(b"not at all")
    status = called(*arguments)
    said = capsys.readouterr()
    complains(subprocess.CompletedProcess(arguments, status, said.out, said.err), 2, *words)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.elrec", "none.elrec"]


def test_the_program_says_it_as_well() -> None:
    program = [sys.executable, "-m", "edgeline", "shot", "-o", "a.jpg", "-p", "x"]
    said = subprocess.run(program, env=environment(), capture_output=True, text=True, check=False, timeout=60)
    complains(said, 2, "a.jpg", "PNG")


def test_a_port_that_is_taken(edgeline: Edgeline, tmp_path: Path) -> None:
    write_recording(tmp_path / "a.elrec", 2)
    with socket.create_server(("127.0.0.1", 0)) as server:
        number = str(server.getsockname()[1])
        complains(edgeline("replay", "a.elrec", "--tcp", number), 3, f"TCP port {number}", "in use")


def test_an_absent_port(edgeline: Edgeline, tmp_path: Path) -> None:
    complains(edgeline("shot", "-p", "/dev/ttyABSENT"), 3, "/dev/ttyABSENT", "no such port")
    assert list(tmp_path.iterdir()) == []


def test_a_device_that_is_no_port(edgeline: Edgeline) -> None:
    complains(edgeline("shot", "-p", "/dev/null", "-o", "a.png"), 3, "/dev/null: is no serial port")


def test_a_busy_port(edgeline: Edgeline) -> None:
    with PtyDevice(FakeDevice()) as served:
        holder = connect(served.port, 115200)
        complains(edgeline("shot", "-p", served.port), 3, served.port, "in use")
        holder.close()


def test_nothing_listens(edgeline: Edgeline) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
    complains(edgeline("info", "-p", f"socket://127.0.0.1:{port}"), 3, "nothing listens")
    complains(edgeline("info", "-p", "socket://nowhere"), 3, "socket://HOST:PORT")
    complains(edgeline("info", "-p", "weird://x"), 3, "weird")


def test_nothing_answers(edgeline: Edgeline) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        url = f"socket://127.0.0.1:{server.getsockname()[1]}"
        complains(edgeline("info", "-p", url, "--timeout", "0.3"), 3, "nothing answers within 0.3 s")


def test_noise_instead_of_an_edgeline(edgeline: Edgeline, tmp_path: Path) -> None:
    (tmp_path / "noise").write_bytes(bytes(range(1, 256)) * 40)
    complains(edgeline("shot", "-p", "noise"), 3, "10200 bytes", "no HELLO")
    (tmp_path / "empty").write_bytes(b"")
    complains(edgeline("shot", "-p", "empty"), 3, "nothing answers")


def test_another_version(edgeline: Edgeline) -> None:
    with TcpDevice(FakeDevice(major=2)) as served:
        complains(edgeline("shot", "-p", served.port), 3, "version 2.3", "update the host")


def test_an_unwritable_output_stops_before_the_device_is_asked(edgeline: Edgeline) -> None:
    with PtyDevice(FakeDevice()) as served:
        complains(edgeline("shot", "-p", served.port, "-o", "/proc/a.png"), 2, "/proc/a.png")
        complains(edgeline("record", "-p", served.port, "-o", "/proc/a.gif"), 2, "/proc/a.gif")
        complains(edgeline("record", "-p", served.port, "-o", "/proc/x/%d.png"), 2, "/proc/x")
        assert served.device.commands == []


def test_a_line_that_damages_everything(edgeline: Edgeline, tmp_path: Path) -> None:
    (tmp_path / "a.png").write_bytes(b"precious")
    with PtyDevice(FakeDevice(faults=Faults(flip=1.0, first=3))) as served:
        complains(edgeline("shot", "-p", served.port, "--timeout", "1.5", "-o", "a.png"), 4, "no verified frame")
    assert (tmp_path / "a.png").read_bytes() == b"precious"


@pytest.mark.parametrize("cut", [1, 100, 700])
def test_a_stream_that_is_cut_keeps_what_was_good(edgeline: Edgeline, tmp_path: Path, cut: int) -> None:
    (tmp_path / "stream.bin").write_bytes(capture(10)[:-cut])
    result = edgeline("record", "-p", "stream.bin", "--frames", "10", "-o", "a.png")
    assert result.returncode == 4
    assert result.stderr.count("\n") == 1
    assert "the 9 frames until then are in a.png" in result.stderr or "the 8 frames" in result.stderr
    with Image.open(tmp_path / "a.png") as image:
        assert getattr(image, "n_frames", 1) in (8, 9)


def unplugged_after(served: _Served, frames: int) -> None:
    while len(served.device.sent) < frames:
        time.sleep(0.01)
    served.stop()


@pytest.mark.parametrize("link", [PtyDevice, TcpDevice])
def test_a_device_that_is_unplugged_keeps_what_was_good(
    edgeline: Edgeline, tmp_path: Path, link: type[PtyDevice | TcpDevice]
) -> None:
    with link(FakeDevice(), frame_s=0.05) as served:
        unplug = threading.Thread(target=lambda: unplugged_after(served, 10))
        unplug.start()
        result = edgeline("record", "-p", served.port, "-o", "a.png")
        unplug.join()
    assert result.returncode == 4
    assert "gone" in result.stderr or "closed" in result.stderr
    kept = re.search(r"the (\d+) frames until then are in a.png", result.stderr)
    assert kept is not None
    with Image.open(tmp_path / "a.png") as image:
        assert getattr(image, "n_frames", 1) == int(kept[1])


def test_a_device_that_falls_silent_keeps_what_was_good(edgeline: Edgeline, tmp_path: Path) -> None:
    with TcpDevice(FakeDevice(limit=5)) as served:
        result = edgeline("record", "-p", served.port, "--frames", "10", "--timeout", "1", "-o", "a.png")
    assert result.returncode == 4
    assert "no verified frame within 1 s" in result.stderr
    assert "the 5 frames until then are in a.png" in result.stderr
    with Image.open(tmp_path / "a.png") as image:
        assert getattr(image, "n_frames", 1) == 5


def test_a_window_without_a_display(edgeline: Edgeline) -> None:
    with PtyDevice(FakeDevice()) as served:
        complains(edgeline("view", "-p", served.port, env={"DISPLAY": ""}), 2, "no display", "edgeline shot")


def test_a_recording_that_is_cut_off_keeps_what_was_good(edgeline: Edgeline, tmp_path: Path) -> None:
    frames = write_recording(tmp_path / "a.elrec", 40)
    whole = (tmp_path / "a.elrec").read_bytes()
    (tmp_path / "a.elrec").write_bytes(whole[:-30])
    result = edgeline("export", "a.elrec", "-o", "a.png")
    assert result.returncode == 4
    assert result.stderr.startswith("edgeline: a.elrec: the recording is cut off near byte ")
    kept = re.search(r"the (\d+) frames until then are in a.png\n$", result.stderr)
    assert kept is not None
    with Image.open(tmp_path / "a.png") as image:
        assert getattr(image, "n_frames", 1) == int(kept[1]) > len(frames) / 2
    info = edgeline("info", "-p", "a.elrec")
    assert info.returncode == 4
    assert f"{kept[1]} verified frames" in info.stdout
    assert "is cut off" in info.stderr


def test_a_link_without_frames_leaves_no_recording_behind(edgeline: Edgeline, tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        url = f"socket://127.0.0.1:{server.getsockname()[1]}"
        complains(edgeline("record", "-p", url, "--timeout", "0.3", "-o", "a.elrec"), 3, "nothing answers")
    assert list(tmp_path.iterdir()) == []


def test_a_device_that_writes_what_steers_a_terminal(edgeline: Edgeline) -> None:
    """Its name and its words are shown without what is no letter."""

    class Steering(FakeDevice):
        def send(self, body: Body) -> None:
            super().send(replace(body, target="\x1b[2Jboard\x07") if isinstance(body, Hello) else body)

    with PtyDevice(Steering(takes_input=False)) as served:
        info = edgeline("info", "-p", served.port)
        bench = edgeline("bench", "-p", served.port, "--frames", "2")
        refused = edgeline("shot", "-p", served.port, "--scene", "1")
    assert (info.returncode, bench.returncode, refused.returncode) == (0, 0, 3)
    for said in (info.stdout, bench.stdout, refused.stderr):
        assert "[2Jboard" in said
        assert "\x1b" not in said
