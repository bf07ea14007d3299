"""The demo on a board that QEMU emulates, with the host's own package at its UART."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

import qemu
from edgeline import framing, protocol
from edgeline.codec import Pixels
from edgeline.link import Link
from edgeline.session import Session
from target_tools import Simulator

SIZE = (128, 64)
"""Of both boards' OLEDs, width and height."""

SCENES = ("demo", "teapot", "room", "solid", "field")
"""The demo's scenes; a scene's place is its number in INPUT."""

FRAMES = (0, 9, 45)
"""Of each scene. In the demo, frame 45 is of another part than frame 0."""

INPUT_FRAMES = 4
"""An INPUT holds from the third frame on that begins after it was sent; one more is surely whole."""


START = framing.encode(protocol.pack(protocol.Start(2), 0))
"""As a host sends it that has had a HELLO before."""


@dataclass
class Demo:
    """A running board and a host that streams from it."""

    board: qemu.Machine
    link: Link

    def show(self, scene: int, frame: int) -> Pixels:
        """Has the board stand still at a frame; gives the picture that it streams then. Its display has it too."""
        # PAUSE first: a frame that is played between the other two would move on from the one that is asked for.
        for control, value in (("pause", 1), ("scene", scene), ("frame", frame)):
            self.link.control(control, value)
        for _ in range(INPUT_FRAMES):
            picture = self.link.next_frame(10).picture
        return picture


@contextmanager
def streaming(name: str, elf: Path, *options: str) -> Iterator[Demo]:
    """QEMU's machine `name` with the demo, from reset on, and a host at its UART."""
    with qemu.machine(name, elf, *options) as board, Link(board.uart(), Session()) as link:
        board.run()
        yield Demo(board, link)


def pictures(simulator: Simulator, scene: str, folder: Path, panel: str = "") -> npt.NDArray[np.uint16]:
    """The simulator's pictures of FRAMES, (len(FRAMES), height, width); with a panel as its glass shows them."""
    return simulator.render(scene, SIZE, folder, panel, frames=FRAMES[-1] + 1)[list(FRAMES)]


def leave_in_mid_frame(uart: qemu.UartTransport) -> None:
    """A host that streams a frame, and is gone without a word when the next one has begun."""
    link = Link(uart, Session())
    link.next_frame(10)
    while not uart.read():
        pass
    uart.close()


def becomes_true(what: Callable[[], bool], patience_s: float) -> bool:
    """Whether `what` holds before the patience ends."""
    deadline = time.monotonic() + patience_s
    while time.monotonic() < deadline:
        if what():
            return True
        time.sleep(0.02)
    return what()


@dataclass
class Progress:
    """Counts frames while no host listens: the demo's own number of the next one, read in its memory."""

    board: qemu.Machine
    address: int

    @classmethod
    def of(cls, board: qemu.Machine, elf: Path) -> Progress:
        return cls(board, qemu.symbols(elf)["player"] + 4)  # el_player.frame

    def now(self) -> int:
        return int.from_bytes(self.board.memory(self.address, 4), "little")

    def goes_on(self, frames: int, patience_s: float) -> bool:
        """Whether so many more frames are drawn in time."""
        begin = self.now()
        return becomes_true(lambda: self.now() >= begin + frames, patience_s)
