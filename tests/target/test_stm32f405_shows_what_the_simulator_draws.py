"""The image for the STM32F405, run on Unicorn with its SPI, DMA, USART and clocks judged strictly: display and stream
show the simulator's pictures, pixel for pixel, whatever scene the host asks for.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from target_tools import Image, Simulator, assert_same_picture, find_simulator
from unicorn_f405 import Board, expected

MHZ = 1_000_000

SCENES = ("demo", "teapot", "room", "solid", "field", "S1", "S2", "S2-no-depth", "S3", "S4")
OF_THE_SIMULATOR_ALONE = ("materials", "lamps", "wires")
FRAME = 2
MIN_STACK_LEFT = 1024


@pytest.fixture(scope="module")
def image(board_image: Callable[..., Image]) -> Image:
    return board_image("stm32f405")


@pytest.fixture(scope="module")
def board(image: Image) -> Board:
    """One board for all scenes: it is never restarted in between."""
    find_simulator()
    return Board.start(image)


def test_all_scenes_are_tested(simulator: Simulator) -> None:
    assert tuple(simulator.scenes()) == SCENES + OF_THE_SIMULATOR_ALONE


def show(board: Board, scene: str, simulator: Simulator, folder: Path, may_lose: int = 0) -> None:
    """Asks for FRAME of the scene, and compares what stream and display show with the simulator's picture. The host's
    bytes all arrive, but for `may_lose`, which it then has to send again."""
    streamed = board.stream(SCENES.index(scene), FRAME)
    wanted = expected(simulator, scene, FRAME, folder)
    assert_same_picture(streamed, wanted, f"{scene} on the stream")
    assert_same_picture(board.shown(simulator, folder), wanted, f"{scene} on the display")
    assert board.host.session.counts.damaged == 0
    assert board.chip.usart.lost <= may_lose


@pytest.mark.parametrize("scene", SCENES)
def test_display_and_stream_show_the_simulators_picture(
    scene: str, board: Board, simulator: Simulator, tmp_path: Path
) -> None:
    show(board, scene, simulator, tmp_path)


def test_clocks_are_what_the_header_says(image: Image) -> None:
    board = Board.start(image)
    board.run_to_frame(1)
    rcc = board.chip.rcc
    assert (rcc.core_hz, rcc.apb1_hz, rcc.apb2_hz) == (168 * MHZ, 42 * MHZ, 84 * MHZ)
    assert board.display.sck_hz == 42 * MHZ
    assert board.chip.iwdg.is_on


def test_stack_has_room_left(board: Board) -> None:
    assert board.chip.machine.stack_left() >= MIN_STACK_LEFT


def test_bands_are_drawn_while_the_dma_sends(image: Image) -> None:
    """A frame of 320x240 takes 29.26 ms on a wire of 42 MHz; with what the processor does meanwhile added to that, the
    solid's frame would be longer by half."""
    board = Board.start(image)
    board.stream(SCENES.index("solid"), 0)
    board.host.hears = False
    begin = board.display.frames
    board.run_to_frame(begin + 3, 2000)  # the stream has no credits by now
    first_ns = board.chip.machine.ns
    board.run_to_frame(begin + 5)
    wire_ns = 320 * 240 * 16 * 1_000_000_000 // (42 * MHZ)
    assert (board.chip.machine.ns - first_ns) / 2 < 1.25 * wire_ns


def test_without_a_crystal_the_chips_own_oscillator_does(image: Image, simulator: Simulator, tmp_path: Path) -> None:
    board = Board.start(image, crystal=False)
    show(board, "teapot", simulator, tmp_path)
    assert board.chip.rcc.core_hz == 168 * MHZ


def test_without_the_pll_everything_is_slower(image: Image, simulator: Simulator, tmp_path: Path) -> None:
    board = Board.start(image)
    board.chip.rcc.locks = False
    # At a tenth of the speed a byte's time is 1388 cycles, and one or two of the host's packets are lost on their way.
    show(board, "teapot", simulator, tmp_path, may_lose=32)
    assert board.chip.rcc.core_hz == 16 * MHZ
    assert board.display.sck_hz == 8 * MHZ


def test_when_the_dma_stops_the_processor_goes_on(image: Image, simulator: Simulator, tmp_path: Path) -> None:
    """It stops with part of a band sent; an emulator without one stops before the first."""
    board = Board.start(image)
    dma = board.chip.dma
    assert dma is not None
    board.host.begin(SCENES.index("solid"), FRAME)
    board.host.run(lambda: len(board.chip.usart.output) > 3000 and dma.left(board.chip.spi.base + 0x0C) > 100, 3000)
    dma.dead = True
    board.host.run(lambda: bool(board.host.frames), 3000)
    wanted = expected(simulator, "solid", FRAME, tmp_path)
    assert_same_picture(board.shown(simulator, tmp_path), wanted, "the display")
