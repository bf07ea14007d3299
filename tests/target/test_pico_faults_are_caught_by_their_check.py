"""The checks of the Pico's tests can fail: each fault that firmware for this chip and this wire is likely to have is
put into a copy of the sources, built, run, and found by the check that is meant for it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from pico import MS, BoardStopped, Pico
from target_tools import Image, LookError, Replacements, Simulator, build_faulty

DISPLAY = "firmware/boards/rp2040/display.c"
BOARD = "firmware/boards/rp2040/board.c"
CLOCKS = "firmware/boards/rp2040/clocks.c"
UART = "firmware/boards/arm/pl011.c"
BANDS = "firmware/src/frame/bands.c"
TFT = "firmware/src/panel/tft.c"
BUS_WAIT = "    while ((EL_SPI0->sr & EL_SPI_SR_BSY) != 0) {\n    }\n"
STEP_NS = 20 * MS
WITHIN_MS = 2000


@dataclass(frozen=True)
class Fault:
    """In each file `replacements` are made; the harness reports `problem`."""

    name: str
    replacements: Replacements
    problem: str


def slow_wire(divisor: int) -> tuple[str, str]:
    """At 62.5 MHz a byte takes 16 cycles, and the processor seldom overtakes it: a missing wait shows by luck alone. So
    these faults are sought on a slower wire, as a slower display or a longer cable needs it."""
    return "CPSDVSR = 2 }", f"CPSDVSR = {divisor} }}"


def in_display(old: str, new: str, *others: tuple[str, str]) -> Replacements:
    return {DISPLAY: [(old, new), *others]}


def in_board(old: str, new: str) -> Replacements:
    return {BOARD: [(old, new)]}


START = "    start_watchdog();\n"
TRIGGER = "    EL_DMA_0->ctrl_trig = DMA_CONTROL | dma_size;\n"
FAULTS = [
    Fault(
        "no wait for the bus before D or C",
        in_display(
            "    wait_until_idle();\n    if (word_size != wire.word_size) {",
            "    if (word_size != wire.word_size) {",
            slow_wire(254),
        ),
        "dc-while-busy",
    ),
    Fault(
        "D or C too early",
        in_display(
            "    if (count > 0) {\n        set_wire",
            "    set_pin(EL_PIN_DC, 1);\n    if (count > 0) {\n        set_wire",
        ),
        "dc-while-busy",
    ),
    Fault("word size changed while busy", in_display(BUS_WAIT, "", slow_wire(254)), "word-size-while-busy"),
    Fault("chip select changed while busy", in_display(BUS_WAIT, "", slow_wire(254)), "cs-while-busy"),
    Fault(
        "DMA over a buffer still being drawn",
        {
            BANDS: [("            painter->current ^= 1U;\n", "")],
            DISPLAY: [(TRIGGER, TRIGGER + "    done(argument);\n"), slow_wire(16)],
        },
        "dma-overwrite",
    ),
    Fault(
        "no wait for the DMA before the next",
        in_display(
            "    while (transfer.busy) {\n        wait(context);\n    }\n    set_wire(EL_SPI_CR0_16_BITS, 1);",
            "    (void)context;\n    set_wire(EL_SPI_CR0_16_BITS, 1);",
            slow_wire(64),
        ),
        "dma-set-up",
    ),
    Fault(
        "SPI disabled under a selected display",
        in_display("        set_pin(EL_PIN_CS, 1);\n        set_word_size", "        set_word_size"),
        "disabled-while-selected",
    ),
    Fault("no chip select", in_display("    set_pin(EL_PIN_CS, 0);\n", ""), "cs-high"),
    Fault(
        "pixels as bytes",
        in_display(
            "start(words, count, EL_DMA_HALFWORDS, done, argument)", "start(words, count, EL_DMA_BYTES, done, argument)"
        ),
        "word-width",
    ),
    Fault(
        "DMA not paced by the SPI",
        in_display("EL_DMA_DREQ_SPI0_TX | EL_DMA_CHAIN_TO_ITSELF", "0x3F << 15 | EL_DMA_CHAIN_TO_ITSELF"),
        "fifo-overflow",
    ),
    Fault("SPI not enabled", in_display("    EL_SPI0->cr1 = EL_SPI_CR1_SSE;\n", ""), "spi-disabled"),
    Fault("SPI left in reset", in_board(" | EL_RESET_SPI0 |", " |"), "in-reset"),
    Fault(
        "pin without its function", in_display("    *EL_GPIO_CTRL(EL_PIN_TX) = EL_FUNCTION_SPI;\n", ""), "pin-function"
    ),
    Fault("clk_peri not started", {CLOCKS: [("    EL_CLK_PERI->ctrl = EL_CLK_PERI_ENABLE;", "   ")]}, "clock"),
    Fault(
        "no tick for the timer",
        {CLOCKS: [("    EL_WATCHDOG->tick = EL_WATCHDOG_TICK_ENABLE | TICK;\n", "")]},
        "clock",
    ),
    Fault(
        "bytes into the full UART",
        {UART: [("(uart->registers->fr & FR_TXFF) == 0 && el_ring_take", "el_ring_take")]},
        "uart-overflow",
    ),
    Fault(
        "store not aligned",
        in_board(START, START + '    __asm__ volatile("str %0, [%0]" : : "l"(0x2000FF01U));\n'),
        "unaligned",
    ),
    Fault("store to flash", in_board(START, START + "    *(el_register *)0x10000200U = 0;\n"), "flash-write"),
    Fault(
        "no such instruction",
        in_board(START, START + '    __asm__ volatile(".hword 0xb100");\n'),
        "undefined-instruction",
    ),
    Fault(
        "watchdog not fed",
        in_board("    EL_WATCHDOG->load = WATCHDOG_HALF_US;\n", "    EL_WATCHDOG->load = WATCHDOG_HALF_US / 40;\n"),
        "restart",
    ),
]


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name)
def test_fault_is_caught(fault: Fault, tmp_path: Path) -> None:
    image = build_faulty("rp2040", fault.replacements, tmp_path)
    problems: dict[str, int] = {}
    with Pico(image, tmp_path) as pico:
        while fault.problem not in problems and pico.now_ns < WITHIN_MS * MS:
            problems = pico.step_and_report(STEP_NS).problems
    assert fault.problem in problems, f"not caught; what was seen: {problems}"


def test_a_slower_wire_is_no_fault(tmp_path: Path) -> None:
    image = build_faulty("rp2040", {DISPLAY: [slow_wire(254)]}, tmp_path)
    with Pico(image, tmp_path) as pico:
        pico.step(WITHIN_MS // 2 * MS)
        pico.report().assert_clean()


@pytest.mark.parametrize(
    "replacements",
    [
        pytest.param(
            {TFT: [("const unsigned last = end - 1U;", "const unsigned last = end - 2U;")]}, id="wrong window"
        ),
        pytest.param(in_display(BUS_WAIT, "", slow_wire(254)), id="no wait for the bus"),
    ],
)
def test_the_picture_tells(replacements: Replacements, simulator: Simulator, tmp_path: Path) -> None:
    """Whatever the wire showed: the display refuses what it got, or shows something else."""
    image = build_faulty("rp2040", replacements, tmp_path)
    expected = simulator.render("demo", (320, 240), tmp_path, "ili9341", rotation=90)[0]
    with Pico(image, tmp_path) as pico:
        while pico.frame_ends == 0 and pico.now_ns < WITHIN_MS // 2 * MS:
            pico.step(STEP_NS, until_frame=True)
        trace = pico.wire_until_picture(0) if pico.frame_ends > 0 else pico.trace
        try:
            wrong = bool((simulator.look(trace, "ili9341", (320, 240), 90) != expected).any())
        except LookError as error:
            print(error)
            wrong = True
    assert wrong, "the picture is right in spite of the fault"


def test_a_damaged_boot_stage_does_not_boot(board_image: Callable[..., Image], tmp_path: Path) -> None:
    image = board_image("rp2040")
    damaged = Image(tmp_path)
    data = bytearray(image.uf2.read_bytes())
    data[32 + 100] ^= 1  # in the payload of the first block, which is the boot stage
    damaged.uf2.write_bytes(data)
    damaged.elf.write_bytes(image.elf.read_bytes())
    with Pico(damaged, tmp_path) as pico, pytest.raises(BoardStopped, match="boot2: the CRC"):
        pico.step(MS)
