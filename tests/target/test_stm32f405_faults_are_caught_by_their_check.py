"""The checks of the STM32F405's tests can fail: each fault that firmware for this chip and this wire is likely to have
is put into a copy of the sources, built, run, and found by the check that is meant for it.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pytest

from target_tools import LookError, Replacements, Simulator, assert_same_picture, build_faulty
from unicorn_core import TargetError
from unicorn_f405 import Board, expected

BOARD = "firmware/boards/stm32f405/board.c"
CLOCKS = "firmware/boards/stm32f405/clocks.c"
DISPLAY = "firmware/boards/stm32f405/display.c"
TFT = "firmware/src/panel/tft.c"
BANDS = "firmware/src/frame/bands.c"

BUSY_WAIT = "    wait_for(SPI_SR_BUSY, 0);\n"
COMMAND_SENT = "    put_words(&command, 1);\n    wait_idle();\n"
GIVEN = "    give_dma_a_piece();\n    SPI1_CR2"
WITHIN_MS = 10_000


@dataclass(frozen=True)
class Fault:
    """`replaced` in the sources, after which the harness says something that matches `message`."""

    name: str
    replaced: Replacements
    message: str


FAULTS = (
    Fault("no wait for the end of the last word", {DISPLAY: [(BUSY_WAIT, "")]}, "while SPI1 is busy"),
    Fault(
        "D/C too early",
        {DISPLAY: [(COMMAND_SENT, "    put_words(&command, 1);\n")]},
        "D/C changes to 1 while SPI1 is busy",
    ),
    Fault(
        "the word size while the SPI is on",
        {DISPLAY: [("    SPI1_CR1 &= ~SPI_CR1_ENABLE;", "    ")]},
        "word size, mode or rate changes while it is on",
    ),
    Fault("no chip select", {DISPLAY: [("    set_pin(PIN_CS, 0);\n", "")]}, "chip select is high"),
    Fault(
        "a pin without its function",
        {DISPLAY: [(" | GPIO_ALTERNATE << 2 * PIN_MOSI;", ";")]},
        "pin 7 is not its own",
    ),
    Fault(
        "a band is given back when its DMA begins",
        {
            DISPLAY: [(GIVEN, "    give_dma_a_piece();\n    done(argument);\n    SPI1_CR2")],
            BANDS: [("            painter->current ^= 1U;\n", "")],
        },
        "is written, which DMA2 stream 3 has yet to read",
    ),
    Fault("the wrong channel", {DISPLAY: [("DMA2_S3CR_CHANNEL(3U)", "DMA2_S3CR_CHANNEL(2U)")]}, "channel 2 does not"),
    Fault("a clock forgotten", {BOARD: [(" | RCC_AHB1ENR_DMA2", "")]}, "DMA2 is used, but its clock is off"),
    Fault(
        "too few wait states",
        {
            CLOCKS: [
                ("FLASH_ACR = FLASH_ACR_LATENCY(5U)", "FLASH_ACR = FLASH_ACR_LATENCY(4U)"),
                ("!= FLASH_ACR_LATENCY(5U)", "!= FLASH_ACR_LATENCY(4U)"),
            ]
        },
        "with 4 wait states",
    ),
    Fault(
        "a wrong rate",
        {BOARD: [("el_stm32f405_usart_start(clocks.apb2_hz)", "el_stm32f405_usart_start(clocks.core_hz)")]},
        "is not at 115200 bit/s",
    ),
    Fault(
        "a program that hangs",
        {BOARD: [("    IWDG_KR = IWDG_KR_FEED;\n", '    for (;;) {\n        __asm__ volatile("wfi");\n    }\n')]},
        "the watchdog bites",
    ),
)


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)
def test_fault_is_caught(fault: Fault, tmp_path: Path) -> None:
    board = Board.start(build_faulty("stm32f405", fault.replaced, tmp_path))
    with pytest.raises(TargetError, match=fault.message):
        board.run_to_frame(3, WITHIN_MS)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        pytest.param("const unsigned last = end - 1U;", "const unsigned last = end - 2U;", id="one column short"),
        pytest.param("panel->first_y + line, ", "panel->first_y + line + 1U, ", id="one line too low"),
    ],
)
def test_a_wrong_window_is_seen(old: str, new: str, simulator: Simulator, tmp_path: Path) -> None:
    board = Board.start(build_faulty("stm32f405", {TFT: [(old, new)]}, tmp_path))
    wanted = expected(simulator, "demo", 1, tmp_path)
    assert_same_picture(board.stream(0, 1), wanted, "the stream, which has no window")
    with pytest.raises((LookError, pytest.fail.Exception)):
        assert_same_picture(board.shown(simulator, tmp_path), wanted, "the display")
