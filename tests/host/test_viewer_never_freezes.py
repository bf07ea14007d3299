"""The window answers whatever comes: a flood of frames, garbage, a link that loses half of it, a device that dies.

How quick it is is told per second of processor time that the process got, so that a busy machine does not fail it.
"""

from __future__ import annotations

import re
import socket
import subprocess
import time
import tracemalloc
from collections.abc import Callable, Iterator
from itertools import cycle

import numpy as np
import pytest

from edgeline import framing, protocol
from edgeline.events import Damage, Event, Log
from edgeline.viewer.log import LINES
from edgeline.viewer.model import ViewModel
from fake_device import FakeDevice, Faults, PtyDevice
from talk import Talk
from viewer_at_work import AtWork, at_work

LEAST_RATE = 20


class Torrent:
    """A device whose bytes come as quickly as they are read, each read one of `pieces`, over and over."""

    name, one_way, baud = "torrent", True, 0

    def __init__(self, pieces: list[bytes], per_second: float = 1e9) -> None:
        self._pieces = cycle(pieces)
        self._gap = 1 / per_second
        self._next = time.monotonic()

    def read(self) -> bytes:
        self._next += self._gap
        time.sleep(max(0.0, self._next - time.monotonic()))
        return next(self._pieces)

    def write(self, data: bytes) -> None:
        """Nobody listens."""

    def set_baud(self, rate: int) -> int:
        return 0

    def close(self) -> None:
        """There is nothing to close."""


def frames() -> list[bytes]:
    """What a device sends that leaves nothing out, frame by frame; twice, so that it may be repeated: each time it has
    just been started."""
    pieces = []
    for boot_id in (1, 2):
        device = FakeDevice(64, 48, skips=False, band_lines=48, boot_id=boot_id)
        device.receive(framing.encode(protocol.pack(protocol.Ping(), 0)), 0.0)
        device.receive(framing.encode(protocol.pack(protocol.Start(255), 1)), 0.0)
        for _ in range(512):
            device.credits = 255
            pieces.append(device.run(0.0))
    return pieces


@pytest.fixture
def torrent(monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[list[bytes], float], None]]:
    def opens(pieces: list[bytes], per_second: float = 1e9) -> None:
        monkeypatch.setattr("viewer_at_work.connect", lambda *_: Torrent(pieces, per_second))

    yield opens


def rates_of(viewer: AtWork, seconds: float, *counts: Callable[[], int]) -> list[float]:
    """How much each count grows per second of processor time, while the window lives for `seconds` of it."""
    before, begun = [count() for count in counts], time.process_time()
    viewer.until(lambda: time.process_time() >= begun + seconds)
    spent = time.process_time() - begun
    return [(count() - then) / spent for count, then in zip(counts, before, strict=True)]


def ticks_of(viewer: AtWork) -> Callable[[], int]:
    """Counts how often the window's thread gets to something that is due a hundred times a second."""
    counted = [0]

    def tick() -> None:
        counted[0] += 1
        viewer.root.after(10, tick)

    tick()
    return lambda: counted[0]


def test_a_thousand_frames_a_second_leave_the_window_quick(
    display: str, torrent: Callable[[list[bytes], float], None]
) -> None:
    torrent(frames(), 1000)
    with at_work(display, "torrent") as viewer:
        viewer.until(lambda: viewer.model.frames > 100)
        drawn, taken = rates_of(viewer, 1.0, lambda: viewer.window.drawn, lambda: viewer.model.frames)
        assert drawn >= LEAST_RATE
        assert taken > 100
        viewer.press("<space>")
        assert viewer.model.paused


@pytest.mark.parametrize("kind", ["noise", "zeros", "text", "log"])
def test_garbage_leaves_the_window_quick_and_the_log_bounded(
    display: str, torrent: Callable[[list[bytes], float], None], kind: str
) -> None:
    log = framing.encode(protocol.pack(protocol.Log("x\ny" * 500), 7))
    pieces = {
        "noise": [np.random.default_rng(seed).bytes(65536) for seed in range(8)],
        "zeros": [bytes(65536)],
        "text": [b"boot message\n\0" * 4000],
        "log": [log * 20],
    }
    torrent([frames()[0], *pieces[kind]])
    with at_work(display, "torrent") as viewer:
        viewer.until(lambda: viewer.view.measures and viewer.view.measures.counts.bytes_received > 300_000)
        assert rates_of(viewer, 0.7, ticks_of(viewer))[0] >= LEAST_RATE
        assert int(viewer.window.log.text.index("end-1c").split(".")[0]) <= LINES + 1
        assert len(viewer.model.log_since(0)[0]) <= LINES


def test_memory_stays_the_same_under_a_flood_of_events() -> None:
    talk, model = Talk(), ViewModel("x")
    talk.run(20)
    some = talk.frames[-1]
    events: list[Event] = [some, Damage("a packet with a wrong CRC"), Log("device text, and more of it"), some]

    def flood(rounds: int, now: float) -> None:
        for i in range(rounds):
            model.take(events, now + i / 1000)

    tracemalloc.start()
    flood(LINES, 100.0)  # the log is full, every bucket has been used
    before = tracemalloc.get_traced_memory()[0]
    flood(LINES, 200.0)
    grown = tracemalloc.get_traced_memory()[0] - before
    tracemalloc.stop()
    assert grown < 50_000


def test_a_bad_link_is_called_so_and_shows_nothing_that_is_not_proven(display: str) -> None:
    device = FakeDevice(faults=Faults(11, flip=0.10, drop=0.02, noise=0.02, first=40))
    with PtyDevice(device) as served, at_work(display, served.port) as viewer:
        viewer.until(lambda: re.match(r"bad link: \d+ % of the frames fail", viewer.line))
        checked = set()

        def look() -> bool:
            view = viewer.view
            if view.proven is None:
                assert view.frame is not None
                assert view.picture is view.frame.picture
                assert np.array_equal(view.picture, device.sent[view.frame.number])
                checked.add(view.frame.number)
            return len(checked) > 60

        viewer.until(look)


def test_of_a_link_that_brings_no_whole_frame_the_certain_lines_are_shown(display: str) -> None:
    device = FakeDevice(faults=Faults(5, flip=0.5, first=100))
    with PtyDevice(device) as served, at_work(display, served.port) as viewer:
        seen, certain = set(), set()

        def look() -> bool:
            view = viewer.view
            if view.picture is None or view.frame is None or view.serial in seen:
                return False
            if view.proven is None:
                assert view.picture is view.frame.picture
                return False
            seen.add(view.serial)
            for y in np.flatnonzero(view.proven):
                assert any(np.array_equal(view.picture[y], sent[y]) for sent in list(device.sent.values()))
                certain.add(y)
            shown = viewer.model.shown
            assert shown is not None
            assert np.array_equal(shown.picture, device.sent[shown.number])
            return len(seen) >= 2 and len(certain) > 0

        viewer.until(look)


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        return int(listener.getsockname()[1])


def start(simulator: str, port: int) -> subprocess.Popen[bytes]:
    command = [simulator, "stream", "--scene", "solid", "--tcp", str(port)]
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def test_a_simulator_that_is_killed_and_started_again_is_shown_again(display: str, simulator: str) -> None:
    port = free_port()
    name = f"socket://127.0.0.1:{port}"
    running = start(simulator, port)
    try:
        with at_work(display, name) as viewer:
            viewer.until(lambda: viewer.model.frames > 10)
            running.kill()
            running.wait()
            viewer.until(lambda: viewer.line.startswith(f"lost {name}: reconnecting"))
            seen, last = viewer.model.frames, viewer.view.picture
            viewer.settle()
            assert viewer.view.picture is last
            running = start(simulator, port)
            viewer.until(lambda: viewer.model.frames > seen + 10 and viewer.line == "streaming")
            viewer.press("<space>")
            viewer.settle()
            shown, viewport = viewer.model.shown, viewer.window.picture.viewport
            assert shown is not None
            assert viewport is not None
            patch = viewport.patch()
            block = viewer.screen()[patch.top :, patch.left :][: patch.height, : patch.width]
            expected = shown.rgb888.repeat(patch.scale, axis=0).repeat(patch.scale, axis=1)
            assert np.array_equal(block, expected)
    finally:
        running.kill()
        running.wait()
