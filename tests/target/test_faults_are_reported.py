"""A program that fails says over its UART what failed and where and starts anew; for the host it is a line of its log.

firmware/boards/cortex_m/fault.c on emulated cores, with real faults, read by the host's own session.
"""

from __future__ import annotations

import os
import re
import select
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

import pytest

from edgeline.session import Damage, Event, Log, Session
from needs import need_tool
from target_tools import BUILD, REPOSITORY, only_one

SOURCE = Path(__file__).parent / "faults"
TOOLCHAIN = REPOSITORY / "firmware" / "boards" / "cortex_m" / "arm-none-eabi.cmake"
MACHINES = {"cortex-m0plus": "mps2-an385", "cortex-m3": "mps2-an385", "cortex-m4f": "mps2-an386"}
PATIENCE_S = 20.0

READY = Log("ready")
"""What the program says when it starts: text, not a packet."""

LETTER = 0x20000000
"""Where the program looks for what it has to do."""

PLACE = r", at (?P<at>[0-9a-f]{8}), called from (?P<by>[0-9a-f]{8}), xPSR [0-9a-f]{8}, stack [0-9a-f]{8}"

FAULTS = {
    # letter: (what Armv6-M says, what Armv7-M says beside it, the status registers, the function that failed)
    "u": ("HardFault", ": undefined instruction", "00010000, HFSR 40000000", "undefined_instruction"),
    "a": (
        "HardFault",
        ": access to an address without memory, address f0000000",
        "00008200, HFSR 40000000",
        "bad_address",
    ),
    "l": ("HardFault", ": unaligned access", "01000000, HFSR 40000000", "unaligned_access"),
    "e": ("HardFault", ": jump to an even address, which is no Thumb code", "00020000, HFSR 40000000", "bad_address"),
    # Armv6-M has no division.
    "d": ("HardFault", ": divide by zero", "02000000, HFSR 40000000", "divide_by_zero"),
    "v": (
        "HardFault",
        ": undefined instruction, stack overflow into the variables",
        "00010000, HFSR 40000000",
        "stack_in_the_variables",
    ),
    "c": ("SVCall", "", "00000000, HFSR 00000000", "system_call"),
    "n": ("NMI", "", "00000000, HFSR 00000000", "main"),
}


@dataclass(frozen=True)
class Board:
    """The program for one core."""

    core: str
    elf: Path

    def fail(self, letter: str) -> list[Event]:
        """What the host makes of all that comes between a start and the next one."""
        qemu = need_tool("qemu-system-arm", "qemu-system-arm")
        command = [qemu, "-M", MACHINES[self.core], "-kernel", str(self.elf), "-display", "none", "-monitor", "none"]
        command += ["-serial", "stdio", "-device", f"loader,addr={LETTER:#x},data={ord(letter)},data-len=4"]
        session = Session(autostart=False)
        events: list[Event] = []
        deadline = time.monotonic() + PATIENCE_S
        with subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE) as process:
            assert process.stdout is not None
            try:
                while events.count(READY) < 2:
                    assert time.monotonic() < deadline, f"{self.core}: no restart within {PATIENCE_S:g} s: {events}"
                    if select.select([process.stdout], [], [], 0.1)[0]:
                        events += session.receive(os.read(process.stdout.fileno(), 4096), time.monotonic())
            finally:
                process.kill()
        assert events[0] == READY
        return events[1 : events.index(READY, 1)]

    def report(self, letter: str) -> str:
        events = self.fail(letter)
        assert [type(event) for event in events] == [Log], events
        assert isinstance(events[0], Log)
        return events[0].text

    def function_at(self, address: str) -> str:
        """By the command that fault.c names."""
        tool = need_tool("arm-none-eabi-addr2line", "binutils-arm-none-eabi")
        done = subprocess.run([tool, "-fipe", self.elf, address], capture_output=True, text=True, check=True)
        return done.stdout.split(" ")[0]


@pytest.fixture(scope="module", params=MACHINES)
def board(request: pytest.FixtureRequest) -> Board:
    need_tool("arm-none-eabi-gcc", "gcc-arm-none-eabi")
    folder = BUILD / f"faults-{request.param}"
    with only_one(folder.name):
        choices = [f"-DCMAKE_TOOLCHAIN_FILE={TOOLCHAIN}", f"-DEDGELINE_CPU={request.param}"]
        for command in (["cmake", "-S", str(SOURCE), "-B", str(folder), *choices], ["cmake", "--build", str(folder)]):
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            assert done.returncode == 0, done.stdout + done.stderr
    return Board(request.param, folder / "faults.elf")


@pytest.mark.parametrize(
    ("board", "letter"),
    [(core, letter) for core in MACHINES for letter in FAULTS if (core, letter) != ("cortex-m0plus", "d")],
    indirect=["board"],
)
def test_a_fault_says_what_failed_and_where(board: Board, letter: str) -> None:
    name, cause, status, function = FAULTS[letter]
    if board.core == "cortex-m0plus":
        cause = ", stack overflow into the variables" if letter == "v" else ""
        registers = ""
    else:
        registers = f", CFSR {status}"
    text = board.report(letter)
    found = re.fullmatch(re.escape(f"{name}{cause}") + PLACE + re.escape(f"{registers}; faults 1.0"), text)
    assert found is not None, text
    assert board.function_at(found["at"]) == function
    if letter != "n":
        assert board.function_at(found["by"]) == "main"


def test_a_lost_stack_is_reported_from_a_new_one(board: Board) -> None:
    text = board.report("o")
    if board.core == "cortex-m0plus":
        assert text == "HardFault, the stack is lost; faults 1.0"
    else:
        assert text.startswith("HardFault: "), text
        assert "stack overflow: no memory while entering an exception" in text
        assert ", the stack is lost, CFSR " in text


def test_a_main_that_returns_is_reported(board: Board) -> None:
    assert board.report("x") == "main returned; faults 1.0"


def test_the_report_is_whole_after_half_a_packet(board: Board) -> None:
    events = board.fail("p")
    assert isinstance(events[-1], Log), events
    assert events[-1].text.startswith("HardFault")
    assert [event for event in events[:-1] if not isinstance(event, Damage)] == []
