"""A display on the SPI of a chip on Unicorn, and a host on its USART.

`Display` sees what a real one would: words as they leave the SPI, and the levels of the pins at that time. It writes
them down as a wire trace, which the simulator's `look` reads, and refuses what no display could make sense of.
`Host` is the Python package's own session, on the emulated clock.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from edgeline.events import Event, Frame, SetRate
from edgeline.protocol import Control
from edgeline.session import Session
from unicorn_core import TargetError
from unicorn_stm32 import Chip

COMMAND, DATA, RESET, TIME = range(4)
"""Kinds of the trace's records."""

MAGIC = b"HOT1"


@dataclass(frozen=True)
class Wiring:
    """Pins of port A."""

    sck: int = 5
    mosi: int = 7
    cs: int = 4
    dc: int = 3
    reset: int = 2


class Display:
    """Judges the wire and writes it down. `frames` counts the memory writes (2Ch) that had data."""

    def __init__(self, chip: Chip, wiring: Wiring) -> None:
        self._chip = chip
        self._wiring = wiring
        self._records = bytearray(MAGIC)
        self._told_ns = 0
        self._command = 0
        self.data_bytes = 0
        self.frames = 0
        self.sck_hz = 0
        chip.spi.sent = self._sent
        chip.port_a.changed = self._pin_changed

    def _pin_changed(self, pin: int, level: int) -> None:
        wiring = self._wiring
        if self._chip.spi.busy and pin in (wiring.dc, wiring.cs, wiring.reset):
            name = {wiring.dc: "D/C", wiring.cs: "chip select", wiring.reset: "reset"}[pin]
            raise TargetError(f"{name} changes to {level} while SPI1 is busy")
        if pin == wiring.reset:
            self._let_time_pass()
            self._records += bytes((RESET, level))

    def _let_time_pass(self) -> None:
        ns = self._chip.machine.ns
        while self._told_ns < ns:
            step = min(ns - self._told_ns, 0xFFFFFFFF)
            self._records += struct.pack("<BBI", TIME, 0, step)
            self._told_ns += step

    def _check_pins(self) -> None:
        port, wiring = self._chip.port_a, self._wiring
        for pin in (wiring.sck, wiring.mosi):
            if not port.has_function(pin, self._chip.spi_function):
                raise TargetError(f"SPI1 sends, but pin {pin} is not its own")
        for pin in (wiring.cs, wiring.dc, wiring.reset):
            if not port.is_output(pin):
                raise TargetError(f"SPI1 sends, but pin {pin} of the display is no output")
        if port.level(wiring.cs):
            raise TargetError("SPI1 sends, but the display is not selected (chip select is high)")

    def _sent(self, words: list[int], bits: int) -> None:
        self._check_pins()
        self.sck_hz = self._chip.spi.sck_hz
        data = self._chip.port_a.level(self._wiring.dc)
        if bits == 16 and not data:
            raise TargetError("a word of 16 bits is sent as a command (D/C is low)")
        sent = b"".join(word.to_bytes(bits // 8, "big") for word in words)
        if data:
            if self._command == 0x2C:
                self.frames += 1
                self._command = 0
            self.data_bytes += len(sent)
        else:
            self._command = sent[-1]
            self._let_time_pass()
        records = bytearray(2 * len(sent))
        records[0::2] = bytes([DATA if data else COMMAND]) * len(sent)
        records[1::2] = sent
        self._records += records

    def write_trace(self, path: Path) -> Path:
        """All that was on the wire since the start."""
        self._let_time_pass()
        path.write_bytes(self._records)
        return path


@dataclass
class Host:
    """The host's end of the USART. `hears`: whether it takes what comes and answers."""

    chip: Chip
    session: Session = field(default_factory=Session)
    hears: bool = True
    frames: list[Frame] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    _taken: int = 0

    def exchange(self) -> None:
        """Takes what the board has sent, and sends what is due."""
        output = self.chip.usart.output
        data = bytes(output[self._taken :])
        self._taken = len(output)
        if not self.hears:
            return
        now = self.chip.machine.ns / 1e9
        events = self.session.tick(now)
        if data:
            events += self.session.receive(data, now)
        self.chip.usart.feed(self.session.bytes_to_send())
        for event in events:
            if isinstance(event, SetRate):
                self.chip.usart.baud = event.rate
        self.events += events
        self.frames += [event for event in events if isinstance(event, Frame)]

    def begin(self, scene: int, frame: int) -> None:
        """A new session, as a new start of the host's program: it asks for that frame of that scene, for no other."""
        self.session.stop()
        self.chip.usart.feed(self.session.bytes_to_send())
        self.session = Session()
        for control, value in ((Control.PAUSE, 1), (Control.SCENE, scene), (Control.FRAME, frame)):
            self.session.input(control, value)
        self.frames.clear()
        self._taken = len(self.chip.usart.output)

    def run(self, until: Callable[[], bool], limit_ms: int) -> None:
        """Runs the board with this host until `until()` holds."""

        def done() -> bool:
            self.exchange()
            return until()

        self.chip.machine.run(done, limit_ms)
