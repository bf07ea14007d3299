"""Every failure of the command line: its status, one line on standard error, and nothing lost."""

from __future__ import annotations

import re
import socket
import subprocess
import threading
from pathlib import Path

import pytest
from PIL import Image

from conftest import Edgeline
from edgeline.transport import connect
from fake_device import FakeDevice, Faults, PtyDevice, TcpDevice
from test_commands_work_over_pty_and_tcp import capture


def complains(result: subprocess.CompletedProcess[str], status: int, *words: str) -> None:
    assert result.returncode == status, result.stderr
    assert result.stdout == ""
    assert result.stderr.count("\n") == 1, result.stderr
    for word in words:
        assert word in result.stderr


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ([], ["COMMAND"]),
        (["dance"], ["dance"]),
        (["record"], ["-o"]),
        (["record", "-o", "a.gif", "--frames", "0"], ["--frames", "'0'"]),
        (["record", "-o", "a.gif", "--frames", "many"], ["'many'"]),
        (["record", "-o", "a.gif", "--fps", "65536"], ["65536"]),
        (["shot", "--timeout", "-1"], ["--timeout", "'-1'"]),
        (["info", "-b", "fast"], ["'fast'"]),
        (["record", "-o", "a.bmp", "-p", "x"], ["a.bmp", "*.gif"]),
        (["record", "-o", "no/folder/a.gif", "-p", "x"], ["no/folder/a.gif", "No such file"]),
        (["shot", "-o", ".", "-p", "x"], ["folder"]),
        (["shot", "-o", "a.jpg", "-p", "x"], ["a.jpg", "PNG"]),
    ],
)
def test_bad_command_lines(edgeline: Edgeline, arguments: list[str], words: list[str]) -> None:
    complains(edgeline(*arguments), 2, *words)


def test_an_absent_port(edgeline: Edgeline, tmp_path: Path) -> None:
    complains(edgeline("shot", "-p", "/dev/ttyABSENT"), 3, "/dev/ttyABSENT", "no such port")
    assert list(tmp_path.iterdir()) == []


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


@pytest.mark.parametrize("link", [PtyDevice, TcpDevice])
def test_a_device_that_is_unplugged_keeps_what_was_good(
    edgeline: Edgeline, tmp_path: Path, link: type[PtyDevice | TcpDevice]
) -> None:
    with link(FakeDevice(), frame_s=0.05) as served:
        timer = threading.Timer(2.0, served.stop)
        timer.start()
        result = edgeline("record", "-p", served.port, "-o", "a.png")
        timer.join()
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
