"""A demo that cannot start says over the host's link which call failed, and starts anew; a Pico whose clocks do not
come up shows its pictures all the same, only slower, and says that it is slow.
"""

from __future__ import annotations

import time
from pathlib import Path

import pytest

import qemu
from edgeline.session import Event, Log, Session
from pico import MS, Pico
from target_tools import Replacements, Simulator, assert_same_picture, build_faulty

MAIN = "firmware/apps/demo/main.c"
CLOCKS = "firmware/boards/rp2040/clocks.c"

NO_MEMORY: Replacements = {MAIN: [(".memory_bytes = sizeof memory - stream_bytes,", ".memory_bytes = 16,")]}
"""EL_ERROR_MEMORY of el_init, the commonest mistake of a program with another panel."""

REPORT = Log("el_init failed with status -3; edgeline-demo 0.1.0")
PATIENCE_S = 20.0

FAILING = {"lm3s6965": "lm3s6965evb", "stm32vldiscovery": "stm32vldiscovery"}
"""Board -> QEMU's machine."""


@pytest.mark.parametrize("board", FAILING)
def test_the_failed_call_is_told_at_each_start(board: str, tmp_path: Path) -> None:
    image = build_faulty(board, NO_MEMORY, tmp_path)
    session = Session(autostart=False)
    events: list[Event] = []
    deadline = time.monotonic() + PATIENCE_S
    with qemu.machine(FAILING[board], image.elf) as running:
        uart = running.uart()
        running.run()
        while events.count(REPORT) < 2:
            assert time.monotonic() < deadline, f"{board}: {events}"
            events += session.receive(uart.read(), time.monotonic())


def pico_report(tmp_path: Path, *more: tuple[str, str]) -> list[str]:
    """The log lines of a Pico whose demo fails, up to its restart, with `more` replaced in its UART's driver."""
    faults = dict(NO_MEMORY)
    if more:
        faults["firmware/boards/arm/pl011.c"] = more
    session = Session(autostart=False)
    with Pico(build_faulty("rp2040", faults, tmp_path), tmp_path, uart_speed=1) as pico:
        words = pico.last_words(3000 * MS)
    return [event.text for event in session.receive(words, 0.0) if isinstance(event, Log)]


def test_a_pico_sends_its_last_byte_before_it_starts_anew(tmp_path: Path) -> None:
    assert pico_report(tmp_path)[-1:] == [REPORT.text]


def test_a_report_that_the_restart_cuts_off_is_seen(tmp_path: Path) -> None:
    assert REPORT.text not in pico_report(tmp_path, ("&& (uart->registers->fr & FR_BUSY) != 0", "&& 0"))


SLOW = {
    "crystal": ("comes_up(&EL_XOSC->status, EL_XOSC_STABLE)", 6.5e6, "its crystal does not swing"),
    "PLL": ("comes_up(&EL_PLL_SYS->cs, EL_PLL_LOCK)", 12e6, "its PLL does not lock"),
}
"""What is dead -> the wait that then ends without it, the clock that is left, and what the board says."""

EXPECTED_PROBLEMS = {"clock"}
"""The harness knows one right rate of each clock, and says so of every other."""


@pytest.mark.parametrize("dead", SLOW)
def test_a_pico_shows_its_pictures_without(dead: str, simulator: Simulator, tmp_path: Path) -> None:
    wait, clock_hz, said = SLOW[dead]
    image = build_faulty("rp2040", {CLOCKS: [(wait, f"({wait} && false)")]}, tmp_path)
    size, rotation = (320, 240), 90
    expected = simulator.render("demo", size, tmp_path, "ili9341", rotation=rotation)[0]
    received = b""
    with Pico(image, tmp_path) as pico:
        while pico.frame_ends == 0 and pico.now_ns < 10_000 * MS:
            received += pico.step(20 * MS, until_frame=True)
        report = pico.report()
        shown = simulator.look(pico.wire_until_picture(0), "ili9341", size, rotation)
    assert_same_picture(shown, expected, f"without its {dead}")
    assert report.clk_sys_hz == clock_hz
    assert set(report.problems) <= EXPECTED_PROBLEMS, report.texts
    assert said.encode() in received
