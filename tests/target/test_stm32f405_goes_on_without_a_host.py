"""The STM32F405's display never depends on the host: nobody at the other end, a transmitter that takes nothing, a host
that vanishes in mid-frame, noise instead of packets.
"""

from __future__ import annotations

import random
from collections.abc import Callable

import pytest

from target_tools import Image
from unicorn_f405 import Board

FRAMES = 3
PATIENCE_MS = 4000
"""The stream gives a host up within this time (WIRE.md, session.h), in which the display may stand still."""


@pytest.fixture(scope="module")
def image(board_image: Callable[..., Image]) -> Image:
    return board_image("stm32f405")


def goes_on(board: Board, limit_ms: int) -> None:
    """FRAMES more frames within that time; TargetError when they do not come, or when the watchdog bites."""
    board.run_to_frame(board.display.frames + FRAMES, limit_ms)


def test_with_nobody_there(image: Image) -> None:
    board = Board.start(image, hasty_link=False)
    goes_on(board, 1000)
    assert b"EDGL" in bytes(board.chip.usart.output)


def test_with_a_transmitter_that_takes_nothing(image: Image) -> None:
    board = Board.start(image, hasty_link=False)
    board.chip.usart.stuck = True
    goes_on(board, 1000)


def test_with_a_host_that_vanishes_in_mid_frame(image: Image) -> None:
    board = Board.start(image, hasty_link=False)
    board.host.begin(0, 0)
    board.host.run(lambda: len(board.chip.usart.output) > 2000, 2000)
    board.host.hears = False
    board.chip.usart.stuck = True
    goes_on(board, PATIENCE_MS)


def test_with_noise_for_input(image: Image) -> None:
    board = Board.start(image, hasty_link=False)
    noise = random.Random(4)
    board.run_to_frame(1)
    board.chip.usart.feed(noise.randbytes(2000))
    goes_on(board, 1000)
    assert board.chip.usart.fed or board.display.frames > FRAMES
