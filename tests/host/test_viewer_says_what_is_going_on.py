"""The viewer's model without a window, and the window on a real display: states, keys, a device that comes back."""

from __future__ import annotations

import contextlib
import signal
import subprocess
import sys
import time
import tkinter as tk
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageGrab

from conftest import Edgeline, environment
from edgeline.colour import to_rgb
from edgeline.protocol import PacketType
from edgeline.session import Counts, Damage, Log, Stalled
from edgeline.transport import TcpTransport, Transport, connect
from edgeline.viewer import Reader, Window
from edgeline.viewmodel import Mood, ViewModel, largest_scale
from fake_device import FakeDevice, Faults, PtyDevice, TcpDevice, bars
from talk import Talk

Watch = Callable[[ViewModel, Transport], Reader]


def after(steps: int) -> tuple[ViewModel, Talk]:
    talk, model = Talk(), ViewModel("/dev/ttyX")
    for _ in range(steps):
        events = talk.step()
        model.take(events, talk.session.counts, talk.now)
    return model, talk


def test_before_the_device_answers() -> None:
    view = ViewModel("/dev/ttyX").view(1.0)
    assert (view.picture, view.mood, view.title) == (None, Mood.BUSY, "/dev/ttyX")
    assert view.state == "waiting for the device's HELLO"


def test_while_frames_arrive() -> None:
    model, talk = after(60)
    view = model.view(talk.now)
    assert (view.mood, view.state, view.title) == (Mood.GOOD, "streaming", "fake board")
    assert view.picture is not None
    assert np.array_equal(view.picture, talk.frames[-1].picture)
    assert dict(view.sections["Link"])["frames/s"] == "50.0"
    assert dict(view.sections["Frame"])["render"] == "4.3 ms"
    assert dict(view.sections["Work"])["memory peak"] == "117"
    assert view.status.startswith("streaming   50.0 frames/s   ")
    assert view.status.endswith("render 4.3 ms")


def test_rates_fall_to_nothing_when_frames_stop() -> None:
    model, talk = after(60)
    model.take([Stalled(2.2)], talk.session.counts, talk.now + 5)
    view = model.view(talk.now + 5)
    assert view.state == "silent for 2 s: asking again"
    assert "   0.0 frames/s" in view.status


def test_damage_is_said_and_then_over() -> None:
    model, talk = after(10)
    model.take([Damage("a packet with a wrong CRC (9 bytes)"), Log("hot\nvery hot")], Counts(), talk.now)
    view = model.view(talk.now)
    assert (view.mood, view.state) == (Mood.BUSY, "damaged: lines asked for anew")
    assert view.log[-3:] == ("a packet with a wrong CRC (9 bytes)", "hot", "very hot")
    model.take(talk.run(3), talk.session.counts, talk.now)
    assert model.view(talk.now).state == "streaming"


def test_pause_holds_the_picture_and_not_the_link() -> None:
    model, talk = after(10)
    model.toggle_pause()
    held = model.view(talk.now)
    model.take(talk.run(10), talk.session.counts, talk.now)
    still = model.view(talk.now)
    assert held.picture is still.picture
    assert held.serial == still.serial
    assert still.state == "paused"
    assert model.frames == len(talk.frames)
    model.toggle_pause()
    assert model.view(talk.now).picture is talk.frames[-1].picture


def test_another_version_stays_on_the_screen() -> None:
    talk, model = Talk(FakeDevice(major=2)), ViewModel("x")
    model.take(talk.run(3), talk.session.counts, talk.now)
    view = model.view(talk.now)
    assert view.mood is Mood.BAD
    assert "update the host" in view.state


def test_scales_are_whole_numbers() -> None:
    assert [largest_scale(320, 240, *room) for room in ((1, 1), (639, 999), (640, 480), (2000, 719))] == [1, 1, 2, 2]


@pytest.fixture
def root(display: str) -> Iterator[tk.Tk]:
    window = tk.Tk()
    yield window
    with contextlib.suppress(tk.TclError):
        window.destroy()


@pytest.fixture
def watch() -> Iterator[Watch]:
    """Starts readers, and stops them however the test ends."""
    readers = []

    def start(model: ViewModel, transport: Transport) -> Reader:
        readers.append(Reader(model, transport, 115200))
        readers[-1].start()
        return readers[-1]

    yield start
    for reader in readers:
        reader.stop()


def run_until(root: tk.Tk, true: Callable[[], bool], seconds: float = 60) -> None:
    deadline = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < deadline, "this did not happen in time"
        root.update()
        time.sleep(0.005)


def test_the_window_shows_the_picture_and_obeys_keys(
    root: tk.Tk, display: str, watch: Watch, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    device = FakeDevice(160, 120, limit=30)
    with PtyDevice(device) as served:
        model = ViewModel(served.port)
        Window(root, model)
        reader = watch(model, connect(served.port, 115200))
        run_until(root, lambda: model.frames == 30)
        for _ in range(60):
            root.update()
            time.sleep(0.01)
        scene = to_rgb(bars(160, 120)(29))
        grabbed = np.asarray(ImageGrab.grab(xdisplay=display).convert("RGB"))
        assert contains_scaled(grabbed, scene), "the last frame is not on the screen"
        root.focus_force()
        root.update()
        root.event_generate("s")
        root.event_generate("<space>")
        root.update()
        assert model.paused
        assert np.array_equal(np.asarray(Image.open(tmp_path / "edgeline-0001.png")), scene)
        width = root.winfo_width()
        root.event_generate("<minus>")
        run_until(root, lambda: root.winfo_width() == width - 160)
        root.event_generate("<plus>")
        run_until(root, lambda: root.winfo_width() == width)
        reader.stop()
        root.event_generate("q")
        with pytest.raises(tk.TclError):
            root.winfo_width()


def contains_scaled(screen: np.ndarray, picture: np.ndarray) -> bool:
    """Whether `picture` stands somewhere on the screen, each pixel a square of the same size."""
    height, width, _ = picture.shape
    for scale in range(1, screen.shape[0] // height + 1):
        large = picture.repeat(scale, 0).repeat(scale, 1)
        rows, columns = screen.shape[0] - large.shape[0] + 1, screen.shape[1] - large.shape[1] + 1
        # The noise in the scene is a needle that stands nowhere else.
        line = large[large.shape[0] // 2 + scale]
        for y in range(rows):
            row = screen[y + large.shape[0] // 2 + scale]
            starts = np.flatnonzero(
                (row[:columns] == line[0]).all(axis=1) & (row[width * scale - 1 :] == line[-1]).all(axis=1)
            )
            for x in starts:
                if np.array_equal(screen[y : y + large.shape[0], x : x + large.shape[1]], large):
                    return True
    return False


def test_a_device_that_goes_and_comes_back(root: tk.Tk, watch: Watch) -> None:
    first = TcpDevice(FakeDevice())
    port = int(first.port.rsplit(":", 1)[1])
    with first:
        model = ViewModel(first.port)
        Window(root, model)
        watch(model, TcpTransport(first.port))
        run_until(root, lambda: model.frames > 3)
    run_until(root, lambda: "gone" in model.view(time.monotonic()).state)
    assert model.view(time.monotonic()).picture is not None
    seen = model.frames
    with TcpDevice(FakeDevice(boot_id=7), listen=port):
        run_until(root, lambda: model.frames > seen + 3)
        assert model.view(time.monotonic()).state == "streaming"


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_view_ends_cleanly_on_a_signal(display: str, number: signal.Signals) -> None:
    with PtyDevice(FakeDevice()) as served:
        viewer = subprocess.Popen(
            [sys.executable, "-m", "edgeline", "view", "-p", served.port],
            env={**environment(), "DISPLAY": display},
            stderr=subprocess.PIPE,
        )
        while len(served.device.sent) < 5:
            time.sleep(0.01)
        viewer.send_signal(number)
        _, errors = viewer.communicate(timeout=20)
    assert (viewer.returncode, errors) == (0, b"")
    assert served.device.commands[-1].TYPE == PacketType.STOP


def test_view_ends_after_its_frames(display: str, edgeline: Edgeline) -> None:
    with PtyDevice(FakeDevice(faults=Faults(3, flip=0.02))) as served:
        result = edgeline("view", "-p", served.port, "--frames", "20", env={"DISPLAY": display})
    assert (result.returncode, result.stderr) == (0, "")
    assert any(body.TYPE == PacketType.STOP for body in served.device.commands)
