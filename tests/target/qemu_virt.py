"""The demo on QEMU's RISC-V machine `virt`: its options, its display's wire, programs with a seeded fault."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import qemu
from qemu_demo import Demo, streaming
from target_tools import Image, Picture, Simulator

MACHINE = "virt"
OPTIONS = ("-bios", "none")
PANEL, ROTATION, SIZE = "ili9341", 90, (320, 240)
FLASH_BEGIN = 0x80000000


@dataclass
class Recorded:
    """The demo and the recording of its display's wire. The machine runs only while it has to, because each frame makes
    the recording 300 KB longer; it stands still between two records."""

    demo: Demo
    trace: Path

    def show(self, scene: int, frame: int) -> Picture:
        """Has the board show a frame; gives the picture that it streams. Afterwards the wire has carried it, too."""
        self.demo.board.command("cont")
        picture = self.demo.show(scene, frame)
        self.demo.board.command("stop")
        return picture

    def glass(self, simulator: Simulator) -> Picture:
        """What the display shows."""
        return simulator.look(self.trace, PANEL, SIZE, ROTATION)


@contextmanager
def recorded(image: Image, folder: Path, *options: str) -> Iterator[Recorded]:
    """The demo from reset on, its wire recorded by semihosting, and a host at its UART."""
    trace = folder / "wire.hot1"
    recording = ("-semihosting-config", "enable=on,target=native", "-append", f"trace={trace}")
    with streaming(MACHINE, image.elf, *OPTIONS, *recording, *options) as demo:
        demo.link.wait_hello()
        demo.board.command("stop")
        yield Recorded(demo, trace)


def patched(image: Image, symbol: str, code: bytes, folder: Path) -> Path:
    """The image with other instructions at the beginning of a function: a fault that needs no compiler."""
    program = bytearray((image.folder / f"{image.name}.bin").read_bytes())
    at = qemu.symbols(image.elf)[symbol] - FLASH_BEGIN
    program[at : at + len(code)] = code
    path = folder / f"{symbol}.bin"
    path.write_bytes(program)
    return path
