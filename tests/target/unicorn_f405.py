"""The STM32F405 board with its demo, a display and a host, as the tests of this board start it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from target_tools import Image, Picture, Simulator
from unicorn_display import Display, Host, Wiring
from unicorn_stm32 import Chip, f405

SIZE = (320, 240)
PANEL = "st7789"
ROTATION = 90

START_MS = 1000
"""Reset, the panel's start-up with its waiting times, and a frame take less."""


@dataclass
class Board:
    """A board that runs from reset."""

    chip: Chip
    display: Display
    host: Host

    @classmethod
    def start(cls, image: Image, *, crystal: bool = True, hasty_link: bool = True) -> Board:
        chip = f405(image.elf, crystal=crystal)
        chip.usart.hasty = hasty_link
        chip.machine.paint_stack()
        return cls(chip, Display(chip, Wiring()), Host(chip))

    def run_to_frame(self, count: int, limit_ms: int = START_MS) -> None:
        """Runs until the display is given its frame number `count`, without a host."""
        self.chip.machine.run(lambda: self.display.frames >= count, limit_ms)

    def stream(self, scene: int, frame: int, limit_ms: int = 3 * START_MS) -> Picture:
        """Asks for that frame of that scene; gives what comes on the stream. The display is given the same."""
        self.host.begin(scene, frame)
        self.host.run(lambda: bool(self.host.frames), limit_ms)
        return self.host.frames[0].picture

    def is_wire_idle(self) -> bool:
        dma = self.chip.dma
        return not self.chip.spi.busy and dma is not None and dma.left(self.chip.spi.base + 0x0C) == 0

    def shown(self, simulator: Simulator, folder: Path) -> Picture:
        """What the display shows when all that is on its way has arrived."""
        self.chip.machine.run(self.is_wire_idle, START_MS)
        trace = self.display.write_trace(folder / "wire.hot")
        picture = simulator.look(trace, PANEL, SIZE, ROTATION)
        trace.unlink()
        return picture


def expected(simulator: Simulator, scene: str, frame: int, folder: Path) -> Picture:
    """What the simulator's display shows at that frame."""
    picture: Picture = simulator.render(scene, SIZE, folder, PANEL, rotation=ROTATION, frames=frame + 1)[frame]
    return picture
