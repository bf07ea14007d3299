"""The Pico's display never depends on the host: nobody there, a line that takes nothing, a host that vanishes in the
middle of a frame, noise on the line. Its pictures go on, and a host that comes later is served.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from edgeline.protocol import Control
from edgeline.session import Frame
from pico import MS, Host, Pico
from target_tools import Image, Simulator, build_faulty

BOOT_MS = 600
"""Clocks, the display's own start, and the first picture."""

PATIENCE_MS = 1200
"""The stream gives a host that takes nothing one second (EL_STREAM_PATIENCE_US); the rest is the frame under way."""

BYTES_PER_MS = 11
"""Of 115200 baud."""


@pytest.fixture
def pico(board_image: Callable[..., Image], tmp_path: Path) -> Iterator[Pico]:
    with Pico(board_image("rp2040"), tmp_path) as running:
        yield running
        running.report().assert_clean()


def pictures_in(pico: Pico, ms: int, rx: bytes = b"", *, hold_tx: bool = False) -> int:
    """How many pictures the display completes in the next milliseconds."""
    before = pico.frame_ends
    pico.step(ms * MS, rx, hold_tx=hold_tx)
    return pico.frame_ends - before


def test_nobody_is_there(pico: Pico) -> None:
    pictures_in(pico, BOOT_MS)
    assert pictures_in(pico, 300) >= 2


def test_the_line_never_takes_a_byte(pico: Pico) -> None:
    pictures_in(pico, BOOT_MS, hold_tx=True)
    assert pictures_in(pico, 300, hold_tx=True) >= 2


def in_the_middle_of_a_frame(pico: Pico, simulator: Simulator) -> Host:
    """A host that has had one frame, and the beginning of the next."""
    host = Host(pico)
    host.session.input(Control.SCENE, simulator.scenes().index("solid"))
    first = host.next_frame()
    for _ in range(100):
        received = host.session.counts.bytes_received
        if any(isinstance(event, Frame) for event in host.step()):
            continue
        if host.session.counts.bytes_received > received:
            return host
    raise AssertionError(f"nothing follows frame {first.number}")


@pytest.mark.parametrize("hold_tx", [True, False], ids=["line stands still", "nobody listens"])
def test_the_host_vanishes_in_mid_frame(hold_tx: bool, pico: Pico, simulator: Simulator) -> None:
    in_the_middle_of_a_frame(pico, simulator)
    pictures_in(pico, PATIENCE_MS, hold_tx=hold_tx)
    assert pictures_in(pico, 300, hold_tx=hold_tx) >= 3
    # Another host finds it as if nothing had happened.
    assert Host(pico).next_frame().picture.any()


def test_a_stream_that_waits_for_ever_is_seen(simulator: Simulator, tmp_path: Path) -> None:
    """The tests above can fail: with patience without end the display stands still."""
    endless = [("EL_STREAM_PATIENCE_US = 1000000,", "EL_STREAM_PATIENCE_US = 2000000000,")]
    image = build_faulty("rp2040", {"firmware/src/stream/session.h": endless}, tmp_path)
    with Pico(image, tmp_path) as running:
        in_the_middle_of_a_frame(running, simulator)
        pictures_in(running, 100, hold_tx=True)
        assert pictures_in(running, PATIENCE_MS, hold_tx=True) == 0


def test_noise_on_the_line(pico: Pico) -> None:
    pictures_in(pico, BOOT_MS)
    noise = random.Random(4).randbytes(300 * BYTES_PER_MS)
    assert pictures_in(pico, 300, noise) >= 2
    host = Host(pico)
    assert host.next_frame().picture.any()
    assert host.session.counts.damaged == 0
