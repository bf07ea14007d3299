"""Whatever happens at the other end of the UART, the RISC-V board goes on: nobody there, a host that goes away in the
middle of a frame, one that talks nonsense, one that takes nothing. And a program that fails or hangs says where, in a
line of the host's log, and is started anew."""

from __future__ import annotations

import random
import re
import socket
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

import pytest

import qemu
import qemu_virt
from edgeline.link import Link
from edgeline.session import Connected, Event, Log, Session
from needs import need_tool
from qemu_demo import SCENES, START, Progress, becomes_true, leave_in_mid_frame, streaming
from qemu_virt import MACHINE, OPTIONS
from target_tools import Image

PATIENCE_S = 20.0
"""For what takes the board well under a second, or 4 s where its watchdog has to bite; a build server may be slow."""

HEX = "([0-9a-f]{8})"

Seen = TypeVar("Seen", Connected, Log)

FAULTS = {
    # name: (instructions at the beginning of el_player_play, the report's beginning, where within it, mcause, mtval)
    "illegal instruction": ("0000", "illegal instruction", 0, 2, 0),
    "bad address": ("03250000", "load access fault", 0, 5, 0),  # lw a0, 0(zero)
    "bad jump": ("67000000", "instruction access fault", None, 1, 0),  # jr zero
    "system call": ("73000000", "unexpected trap", 0, 11, 0),  # ecall
    "breakpoint": ("0290", "breakpoint", 0, 3, None),  # ebreak, but not that of semihosting
    "lost stack": ("014106c0", "stack overflow", 2, 7, 0),  # li sp, 0; sw ra, 0(sp)
    "endless loop": ("73005010f5bf", "the program hangs", 4, 1 << 31 | 7, 0),  # wfi; j to the wfi
}


@pytest.fixture(scope="module")
def image(board_image: Callable[..., Image]) -> Image:
    need_tool("riscv64-unknown-elf-gcc", "gcc-riscv64-unknown-elf and picolibc-riscv64-unknown-elf")
    return board_image("riscv_virt")


def test_nobody_is_there(image: Image) -> None:
    """Nor is the file for the wire: QEMU runs without semihosting."""
    with qemu.machine(MACHINE, image.elf, *OPTIONS) as board:
        board.run()
        assert Progress.of(board, image.elf).goes_on(20, PATIENCE_S)


def test_a_host_goes_away_in_the_middle_of_a_frame_and_comes_back(image: Image) -> None:
    with qemu.machine(MACHINE, image.elf, *OPTIONS) as board:
        board.run()
        for _ in range(3):
            leave_in_mid_frame(board.uart())
            assert Progress.of(board, image.elf).goes_on(5, PATIENCE_S)


def test_a_host_talks_nonsense(image: Image) -> None:
    noise = random.Random(0x815C)
    with streaming(MACHINE, image.elf, *OPTIONS) as demo:
        demo.link.next_frame(PATIENCE_S)
        for _ in range(40):
            demo.link.transport.write(noise.randbytes(500))
        assert Progress.of(demo.board, image.elf).goes_on(5, PATIENCE_S)
        demo.link.transport.write(b"\0")
        assert demo.show(SCENES.index("solid"), 0).any(), "and afterwards it listens again"


def test_a_host_takes_nothing(image: Image) -> None:
    """It asks for frames and reads none, so the UART's FIFO stays full: frames wait a little, and go on."""
    with qemu.machine(MACHINE, image.elf, *OPTIONS) as board, socket.socket(socket.AF_UNIX) as link:
        link.connect(str(board.folder / "s.sock"))
        board.run()
        link.sendall(START)
        assert Progress.of(board, image.elf).goes_on(20, PATIENCE_S)


def function_at(image: Image, address: int) -> str:
    """The function by the command that the report's header names."""
    tool = need_tool("riscv64-unknown-elf-addr2line", "binutils-riscv64-unknown-elf")
    done = subprocess.run([tool, "-fipe", image.elf, hex(address)], capture_output=True, text=True, check=True)
    return done.stdout.split(" ")[0]


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_says_what_failed_and_where_and_the_board_starts_anew(name: str, image: Image, tmp_path: Path) -> None:
    code, what, offset, mcause, mtval = FAULTS[name]
    entry = qemu.symbols(image.elf)["el_player_play"]
    program = qemu_virt.patched(image, "el_player_play", bytes.fromhex(code), tmp_path)
    events: list[Event] = []

    def of(kind: type[Seen]) -> list[Seen]:
        return [event for event in events if isinstance(event, kind)]

    with qemu.machine(MACHINE, program, *OPTIONS) as board, Link(board.uart(), Session(autostart=False)) as link:
        board.run()

        def started_anew() -> bool:
            events.extend(link.step())
            return len(of(Connected)) == 2

        assert becomes_true(started_anew, PATIENCE_S), events
    first, second = of(Connected)
    assert first.hello.boot_id != second.hello.boot_id
    events = events[: events.index(second)]
    reports = [log.text for log in of(Log) if log.text.startswith(what)]
    assert len(reports) == 1, events
    found = re.fullmatch(
        rf"{what}, at {HEX}, called from {HEX}, mcause {HEX}, mtval {HEX}, stack {HEX}; .+", reports[0]
    )
    assert found is not None, reports[0]
    at, by, cause, value, stack = (int(word, 16) for word in found.groups())
    assert at == (0 if offset is None else entry + offset)
    assert function_at(image, by) == "main"
    assert cause == mcause
    assert mtval is None or value == mtval
    marks = qemu.Stack.of(image.elf)
    assert stack == 0 if name == "lost stack" else marks.begin <= stack <= marks.end
