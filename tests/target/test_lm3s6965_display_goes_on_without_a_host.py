"""Whatever happens at the other end of the UART, the display goes on: nobody there, a host that goes away in the middle
of a frame, one that talks nonsense, a UART that takes nothing. And a program that hangs is started anew."""

from __future__ import annotations

import random
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

import qemu
from oled_screen import levels
from qemu_demo import SCENES, START, Progress, becomes_true, leave_in_mid_frame, streaming
from target_tools import Image, build_faulty

MACHINE = "lm3s6965evb"
UART = "firmware/boards/arm/pl011.c"

PATIENCE_S = 15.0
"""For what takes the board well under a second; a loaded build server may be slow."""


@pytest.fixture(scope="module")
def image(board_image: Callable[..., Image]) -> Image:
    return board_image("lm3s6965")


def display_changes(board: qemu.Machine, times: int = 3) -> bool:
    """Whether the OLED's picture becomes another one, several times."""
    for _ in range(times):
        before = levels(board)
        if not becomes_true(partial(differs, board, before), PATIENCE_S):
            return False
    return True


def differs(board: qemu.Machine, before: npt.NDArray[np.uint16]) -> bool:
    return not np.array_equal(levels(board), before)


def test_nobody_is_there(image: Image) -> None:
    with qemu.machine(MACHINE, image.elf) as board:
        board.run()
        assert display_changes(board)
        assert Progress.of(board, image.elf).goes_on(20, PATIENCE_S)


def test_a_host_goes_away_in_the_middle_of_a_frame_and_comes_back(image: Image) -> None:
    with qemu.machine(MACHINE, image.elf) as board:
        board.run()
        for _ in range(3):
            leave_in_mid_frame(board.uart())
            assert display_changes(board)


def test_a_host_talks_nonsense(image: Image) -> None:
    noise = random.Random(6965)
    with streaming(MACHINE, image.elf) as demo:
        demo.link.next_frame(PATIENCE_S)
        for _ in range(40):
            demo.link.transport.write(noise.randbytes(500))
        assert display_changes(demo.board)
        demo.link.transport.write(b"\0")
        assert demo.show(SCENES.index("solid"), 0).any(), "and afterwards it listens again"


def test_the_uart_takes_nothing(tmp_path: Path) -> None:
    """Its FIFO is full for ever. A START arrives, so the board tries to send: frames wait a little, and go on."""
    full = ("(uart->registers->fr & FR_TXFF) == 0 &&", "(uart->registers->fr & 0U) != 0 &&")
    image = build_faulty("lm3s6965", {UART: [full]}, tmp_path)
    with streaming(MACHINE, image.elf) as demo:
        progress = Progress.of(demo.board, image.elf)
        demo.link.transport.write(START)
        assert display_changes(demo.board)
        assert progress.goes_on(20, PATIENCE_S)


def test_a_program_that_hangs_is_started_anew(tmp_path: Path) -> None:
    """The watchdog, of whose time the test does not wait for all; the boot id tells a start from the one before."""
    faults = {
        "firmware/boards/lm3s6965/board.c": [("WATCHDOG_S = 4", "WATCHDOG_S = 1")],
        "firmware/apps/demo/main.c": [
            ("        el_board_feed();\n", "        while (player.frame > 4) {\n        }\n")
        ],
    }
    image = build_faulty("lm3s6965", faults, tmp_path)
    with streaming(MACHINE, image.elf) as demo:
        first = demo.link.hello.boot_id

        def started_anew() -> bool:
            demo.link.step()
            return demo.link.hello.boot_id != first

        assert becomes_true(started_anew, PATIENCE_S)
