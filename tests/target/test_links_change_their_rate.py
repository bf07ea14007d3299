"""Each board's UART at other rates than its first: on the host's request, when the last bit of the answer is out and
not before, with the divider that the rate needs; and back at the first when nobody is heard.

Where the emulator has a wire with a rate (the Pico's and the STM32's), bytes at another rate than the host's are an
error; QEMU's UARTs send at any rate, so there the registers are read back.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from edgeline.events import RateChanged
from edgeline.framing import encode
from edgeline.protocol import SetBaud, pack
from edgeline.session import Session
from pico import MS, Host, Pico
from qemu_demo import streaming
from target_tools import Image, build_faulty
from unicorn_display import Host as UsartHost
from unicorn_stm32 import f100

FIRST_BAUD = 115200
LIMIT_MS = 3000
BACK_MS = 1200
"""1 s without a packet at the new rate, and a frame in which nobody looks."""


# --- The Pico: a PL011 ------------------------------------------------------------------------------------------------


def change(pico: Pico, rate: int) -> RateChanged:
    """What comes of a host's wish for another rate; it streams nothing."""
    host = Host(pico, Session(autostart=False))
    while host.session.hello is None:
        assert pico.now_ns < LIMIT_MS * MS, "no HELLO"
        host.step()
    assert host.session.hello.highest_baud == 3_000_000
    host.session.request_baud(rate)
    while pico.now_ns < 2 * LIMIT_MS * MS:
        for event in host.step():
            if isinstance(event, RateChanged):
                assert host.session.counts.damaged == 0
                return event
    raise AssertionError("the rate does not change")


def test_the_pico(board_image: Callable[..., Image], tmp_path: Path) -> None:
    rate = 3_000_000
    with Pico(board_image("rp2040"), tmp_path, uart_speed=1) as pico:
        changed = change(pico, rate)
        assert changed.rate == rate, changed.why
        divider_q6 = round(64 * 125_000_000 / (16 * rate))
        assert pico.report().uart_baud == pytest.approx(4 * 125_000_000 / divider_q6)
        pico.report().assert_clean()


def test_a_pico_that_does_not_wait_for_the_last_bit_is_seen(tmp_path: Path) -> None:
    hasty = [("|| (uart->registers->fr & FR_BUSY) != 0) {", ") {")]
    image = build_faulty("rp2040", {"firmware/boards/arm/pl011.c": hasty}, tmp_path)
    with Pico(image, tmp_path, uart_speed=1) as pico:
        change(pico, 921_600)
        assert "uart-set-up" in pico.report().problems


# --- The STM32s: a USART, the same in both ----------------------------------------------------------------------------


def test_an_stm32(board_image: Callable[..., Image]) -> None:
    rate = 460_800
    chip = f100(board_image("stm32vldiscovery").elf)
    host = UsartHost(chip, Session(autostart=False))
    host.run(lambda: host.session.hello is not None, LIMIT_MS)
    assert host.session.hello is not None and host.session.hello.highest_baud == rate
    host.session.request_baud(rate)
    host.run(lambda: any(isinstance(event, RateChanged) for event in host.events), LIMIT_MS)
    assert host.session.rate == chip.usart.baud == rate
    assert chip.usart.read(0x08) == round(chip.rcc.apb2_hz / rate)


def test_an_stm32_comes_back_when_nobody_is_heard(board_image: Callable[..., Image]) -> None:
    chip = f100(board_image("stm32vldiscovery").elf)
    chip.machine.run(lambda: b"EDGL" in bytes(chip.usart.output), LIMIT_MS)
    first = chip.usart.read(0x08)
    assert first == round(chip.rcc.apb2_hz / FIRST_BAUD)
    chip.usart.feed(encode(pack(SetBaud(460_800), 0)))
    chip.machine.run(lambda: chip.usart.read(0x08) != first, LIMIT_MS)
    chip.usart.baud = 460_800
    chip.machine.run(lambda: chip.usart.read(0x08) == first, BACK_MS)
    chip.usart.baud = FIRST_BAUD
    host = UsartHost(chip, Session(autostart=False))
    host.run(lambda: host.session.hello is not None, LIMIT_MS)


# --- QEMU's machines: a PL011 and a 16550 -----------------------------------------------------------------------------


def test_the_lm3s6965(board_image: Callable[..., Image]) -> None:
    with streaming("lm3s6965evb", board_image("lm3s6965").elf) as demo:
        assert demo.link.wait_hello(30).highest_baud == 921_600
        assert demo.link.request_baud(921_600) == 921_600
        demo.link.next_frame(10)
        integer, fraction = (int.from_bytes(demo.board.memory(0x4000C000 + at, 4), "little") for at in (0x24, 0x28))
        assert 64 * integer + fraction == round(64 * 50_000_000 / (16 * 921_600))


def test_riscv_virt(board_image: Callable[..., Image]) -> None:
    """Its divider is where its data is, and a look would take a byte: what can be seen is that the data is back."""
    with streaming("virt", board_image("riscv_virt").elf, "-bios", "none") as demo:
        assert demo.link.wait_hello(30).highest_baud == 230_400
        assert demo.link.request_baud(230_400) == 230_400
        assert demo.link.next_frame(10).stats.cycles is not None, "mcycle does not count"
        assert demo.board.memory(0x10000003, 1) == b"\x03", "the line register's DLAB"
        assert demo.link.request_baud(921_600) == 230_400, "more than its clock has"
