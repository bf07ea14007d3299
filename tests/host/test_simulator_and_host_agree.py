"""The real simulator over its real links: every frame of the stream is, pixel for pixel, what `render` draws.

Needs the environment variable EDGELINE_SIM, the path of edgeline-sim. Skipped without it, a failure in CI.
"""

from __future__ import annotations

import json
import re
import socket
import subprocess
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
