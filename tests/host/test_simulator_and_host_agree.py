"""The real simulator over its real links: every frame of the stream is, pixel for pixel, what `render` draws.

Needs the environment variable EDGELINE_SIM, the path of edgeline-sim. Skipped without it, a failure in CI.

The frames per second of the flat-shaded demo over a UART at 921,600 baud, by the throttled pty:

    EDGELINE_SIM=build/sim/edgeline-sim python -m pytest tests/host/test_simulator_and_host_agree.py -k baud -s
"""

from __future__ import annotations

import json
import re
import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import edgeline as package
from conftest import Edgeline
from edgeline.codec import PIXEL, Pixels
from edgeline.colour import to_rgb
from edgeline.protocol import COUNTERS

FRAMES = 12

FLAT_SCENE = "solid"
"""One colour per face, 320x240."""

FRAMES_PER_S = 24.0
"""What a raw UART at FAST_BAUD carries of it at the least."""

FIRST_BAUD, FAST_BAUD = 115200, 921600
BITS_PER_BYTE = 10
QUEUE_BYTES = 1024
"""Of the simulator's UART: the host has them early by as much."""


@contextmanager
def streaming(simulator: str, scene: str, *link: str) -> Iterator[str]:
    """`edgeline-sim stream`, and the port that leads to it."""
    process = subprocess.Popen(
        [simulator, "stream", "--scene", scene, *link], stdout=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True
    )
    assert process.stdout is not None
    try:
        said = process.stdout.readline().strip()
        listening = re.fullmatch(r"listening on (\S+)", said)
        yield f"socket://{listening[1]}" if listening else said
    finally:
        process.terminate()
        process.wait(10)
        process.stdout.close()


def free_port() -> str:
    with socket.create_server(("127.0.0.1", 0)) as server:
        return str(server.getsockname()[1])


@pytest.fixture(scope="module")
def scenes(simulator: str) -> list[str]:
    listed = subprocess.run([simulator, "list"], capture_output=True, text=True, check=True, timeout=20).stdout
    names = [line.split()[0] for line in listed.splitlines() if line.strip()]
    assert names
    return names


def rendered(simulator: str, scene: str, size: tuple[int, int], folder: Path) -> list[Pixels]:
    raw = folder / "frames.rgb565"
    subprocess.run(
        [simulator, "render", "--scene", scene, "--frames", str(FRAMES), "--raw", str(raw)], check=True, timeout=60
    )
    width, height = size
    return list(np.fromfile(raw, PIXEL).reshape(FRAMES, height, width))


def test_every_scene_is_streamed_as_it_is_rendered(simulator: str, scenes: list[str], tmp_path: Path) -> None:
    for scene in scenes:
        with streaming(simulator, scene, "--pty") as port, package.open(port) as link:
            hello = link.hello
            truth = rendered(simulator, scene, (hello.width, hello.height), tmp_path)
            for frame in link:
                if frame.number >= FRAMES:
                    break
                assert np.array_equal(frame.picture, truth[frame.number]), f"{scene}, frame {frame.number}"
            assert frame.number == FRAMES
            assert link.session.counts.damaged == 0


def test_over_tcp_too(simulator: str, scenes: list[str], tmp_path: Path) -> None:
    with streaming(simulator, scenes[0], "--tcp", free_port()) as port, package.open(port) as link:
        truth = rendered(simulator, scenes[0], (link.hello.width, link.hello.height), tmp_path)
        for frame in link:
            assert np.array_equal(frame.picture, truth[frame.number])
            assert len(frame.counters) == len(COUNTERS)
            assert frame.counters["bands"] > 0
            if frame.number == FRAMES - 1:
                break


def test_the_host_chooses_scene_and_frame(simulator: str, scenes: list[str], tmp_path: Path) -> None:
    """One device, all scenes: the first frame after each START is the one that was asked for, and it stays."""
    with streaming(simulator, scenes[0], "--pty") as port:
        for number, scene in enumerate(scenes):
            with package.open(port) as link:
                link.control("pause", 1)
                link.control("scene", number)
                link.control("frame", FRAMES - 2)
                first, second = link.next_frame(), link.next_frame()
                truth = rendered(simulator, scene, (link.hello.width, link.hello.height), tmp_path)
                assert np.array_equal(first.picture, truth[-2]), f"{scene}, first frame"
                assert np.array_equal(second.picture, truth[-2]), f"{scene}, paused"


def test_a_paused_scene_goes_on_where_it_stood(simulator: str, scenes: list[str], tmp_path: Path) -> None:
    with streaming(simulator, scenes[0], "--pty") as port, package.open(port) as link:
        link.control("pause", 1)
        link.control("frame", FRAMES - 2)
        link.next_frame()
        truth = rendered(simulator, scenes[0], (link.hello.width, link.hello.height), tmp_path)
        link.control("pause", 0)
        shown = (frame.picture for frame in link)
        moved = next(picture for picture in shown if not np.array_equal(picture, truth[-2]))
        assert np.array_equal(moved, truth[-1])


def test_a_pipe_whose_reader_takes_its_time_has_all_frames(simulator: str, edgeline: Edgeline, tmp_path: Path) -> None:
    command = [simulator, "stream", "--scene", "room", "--stdout", "--frames", "8"]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        time.sleep(1.5)  # a session's patience is 0.5 s
        (tmp_path / "captured").write_bytes(process.stdout.read())
    told = json.loads(edgeline("view", "--headless", "--json", "-p", "captured").stdout)
    assert (told["frames"], told["damaged"]) == (8, 0)


def test_commands(simulator: str, scenes: list[str], edgeline: Edgeline, tmp_path: Path) -> None:
    with streaming(simulator, scenes[0], "--pty") as port:
        info = json.loads(edgeline("info", "-p", port, "--json").stdout)
        shot = edgeline("shot", "-p", port, "-o", "a.png", "--json")
        assert shot.returncode == 0, shot.stderr
        recorded = edgeline("record", "-p", port, "--frames", "8", "-o", "f/%d.png", "--json")
        assert recorded.returncode == 0, recorded.stderr
    assert json.loads(recorded.stdout)["damaged"] == 0
    truth = [to_rgb(picture) for picture in rendered(simulator, scenes[0], (info["width"], info["height"]), tmp_path)]
    shown = np.asarray(Image.open(tmp_path / "a.png"))
    assert any(np.array_equal(shown, picture) for picture in truth)


def test_a_second_start_begins_anew(simulator: str, scenes: list[str]) -> None:
    """Opening, leaving in the middle of a frame and opening again: the tail of the old stream harms nothing."""
    with streaming(simulator, scenes[0], "--pty") as port:
        for _ in range(5):
            with package.open(port) as link:
                assert link.next_frame(10).picture.shape == (link.hello.height, link.hello.width)


def test_at_921600_baud_the_flat_scene_goes_at_24_frames_per_second(simulator: str) -> None:
    """By the device's own clock and by its bytes. A machine that is busy holds the simulator up, which a UART's wire
    would not do, so the best second of eight counts; and what the link takes is never more than the rate allows."""
    with streaming(simulator, FLAT_SCENE, "--pty", "--baud", str(FIRST_BAUD)) as port, package.open(port) as link:
        assert (link.hello.width, link.hello.height) == (320, 240)
        assert link.hello.baud == FIRST_BAUD
        slow = [link.next_frame(10) for _ in range(4)]
        assert link.request_baud(FAST_BAUD) == FAST_BAUD
        link.next_frame(10)  # the first frame has all lines
        frames = [link.next_frame(10) for _ in range(8 * int(FRAMES_PER_S))]
        assert link.session.counts.damaged == 0
    ends = np.array([frame.end.time_us for frame in frames], np.uint32)
    seconds = np.diff(ends).astype(np.float64) / 1e6  # modulo 2^32
    sizes = np.array([frame.end.wire_bytes for frame in frames])
    window = int(FRAMES_PER_S)
    best = max(window / seconds[at : at + window].sum() for at in range(len(seconds) - window))
    computed = FAST_BAUD / BITS_PER_BYTE / sizes.mean()
    print(
        f"{sizes.mean():.0f} bytes per frame, {computed:.1f} frames/s at most by bytes; "
        f"measured {1 / seconds.mean():.1f} in the mean, {best:.1f} in the best second"
    )
    assert computed >= FRAMES_PER_S
    assert best >= FRAMES_PER_S
    most = FAST_BAUD / BITS_PER_BYTE * seconds.sum() + QUEUE_BYTES
    assert sizes[:-1].sum() <= most
    slow_s = (slow[-1].end.time_us - slow[1].end.time_us) % 2**32 / 1e6
    slow_bytes = sum(frame.end.wire_bytes for frame in slow[1:-1])
    assert slow_bytes <= FIRST_BAUD / BITS_PER_BYTE * slow_s + QUEUE_BYTES


def test_roll_never_waits_and_shows_what_was_sent(simulator: str, tmp_path: Path) -> None:
    """Over a link that is far too slow for whole frames: what is proven is made of lines of the scene's frames."""
    with (
        streaming(simulator, "room", "--pty", "--size", "96x64", "--baud", str(FIRST_BAUD)) as port,
        package.open(port, mode="roll") as link,
    ):
        frames = [link.next_frame(20) for _ in range(40)]
        assert link.session.counts.damaged == 0
    last = frames[-1].number
    raw = tmp_path / "frames.rgb565"
    command = [simulator, "render", "--scene", "room", "--size", "96x64", "--frames", str(last + 1), "--raw", str(raw)]
    subprocess.run(command, check=True, timeout=60)
    truth = np.fromfile(raw, PIXEL).reshape(last + 1, 64, 96)
    assert any(frame.mixed for frame in frames)
    for frame in frames:
        drawn = truth[: frame.number + 1]
        if not frame.mixed:
            assert np.array_equal(frame.picture, drawn[-1])
        assert (drawn == frame.picture).all(axis=2).any(axis=0).all(), "a line that was never drawn"
    # A whole frame takes this link about a second. Most frames, because a busy machine may hold up any of them.
    assert np.median([frame.end.encode_us for frame in frames]) < 50_000, "it waits for the link"
