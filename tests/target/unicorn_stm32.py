"""The STM32's devices for `unicorn_core`: what Edgeline's boards use of them, judged strictly.

SPI and USART are the same in the STM32F405 and the STM32F100; clocks and pins are not. `f405` and `f100` give a machine
with its devices by name. Sections are of the reference manuals RM0090 (F405) and RM0041 (F100).
"""

from __future__ import annotations

import random
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from unicorn_core import Device, Machine, Memory, TargetError, Watch

MHZ = 1_000_000


class Plain(Device):
    """Registers that hold what is written to them, and whose values the model looks at elsewhere or not at all."""

    def __init__(self, name: str, base: int, registers: dict[int, int], clock: tuple[str, int] | None = None) -> None:
        self.name = name
        self.base = base
        self.clock = clock
        self.registers = registers

    def read(self, offset: int) -> int:
        return self.registers[offset]

    def write(self, offset: int, value: int) -> None:
        if offset not in self.registers:
            raise KeyError(offset)
        self.registers[offset] = value


class Rcc(Plain):
    """The clock controller. `apb1_hz` and `apb2_hz` follow from what the program has set."""

    enables: dict[str, int]
    has_crystal = True
    locks = True

    def __init__(self, registers: dict[int, int]) -> None:
        super().__init__("RCC", self.base, registers)
        self.core_hz = self.apb1_hz = self.apb2_hz = self.internal_hz

    internal_hz = 0
    crystal_hz = 8 * MHZ
    most_hz = 0
    most_apb1_hz = 0

    def enabled(self, register: str, bit: int) -> bool:
        return bool(self.registers[self.enables[register]] >> bit & 1)

    def read(self, offset: int) -> int:
        value = super().read(offset)
        if offset == 0x00:  # what is on is ready
            value |= 2 | (value & 1 << 16 and self.has_crystal) << 17 | (value & 1 << 24 and self.locks) << 25
        return value

    def _ready(self, bit: int) -> bool:
        return bool(self.read(0x00) >> bit & 1)

    def _prescaled(self, hz: int, code: int) -> int:
        return hz if code < 4 else hz >> (code - 3)

    def _set_clocks(self, core_hz: int, apb1_code: int, apb2_code: int) -> None:
        self.core_hz = core_hz
        self.apb1_hz = self._prescaled(core_hz, apb1_code)
        self.apb2_hz = self._prescaled(core_hz, apb2_code)
        if core_hz > self.most_hz or self.apb1_hz > self.most_apb1_hz or self.apb2_hz > 2 * self.most_apb1_hz:
            raise TargetError(f"clocks too fast: {core_hz}, APB1 {self.apb1_hz}, APB2 {self.apb2_hz} Hz")
        self.machine.set_core_hz(core_hz)
        self.machine.cut()


class RccF4(Rcc):
    """7.3."""

    base = 0x40023800
    enables = {"AHB1ENR": 0x30, "AHB2ENR": 0x34, "APB1ENR": 0x40, "APB2ENR": 0x44}  # noqa: RUF012
    internal_hz = 16 * MHZ
    most_hz = 168 * MHZ
    most_apb1_hz = 42 * MHZ

    def __init__(self, flash: Plain, power: Plain) -> None:
        super().__init__(dict.fromkeys((0x00, 0x08, 0x30, 0x34, 0x38, 0x40, 0x44, 0x74), 0) | {0x04: 0x24003010})
        self._flash = flash
        self._power = power
        self.usb_hz = 0

    def write(self, offset: int, value: int) -> None:
        if offset == 0x04 and self.registers[0x00] >> 24 & 1:
            raise TargetError("the PLL is changed while it runs")
        super().write(offset, value)
        if offset == 0x08:
            if value & 3 == 1:
                raise TargetError("the crystal without the PLL, which this model does not have")
            core_hz = self._pll_hz() if value & 3 == 2 else self.internal_hz
            wait_states = self._flash.registers[0] & 7
            if core_hz > (wait_states + 1) * 30 * MHZ:
                raise TargetError(f"{core_hz} Hz with {wait_states} wait states of the flash")
            self._set_clocks(core_hz, value >> 10 & 7, value >> 13 & 7)

    def read(self, offset: int) -> int:
        value = super().read(offset)
        return value & ~0xC | (value & 3) << 2 if offset == 0x08 else value

    def _pll_hz(self) -> int:
        if not self._ready(25):
            raise TargetError("the core is given the PLL, which is not ready")
        value = self.registers[0x04]
        if value >> 22 & 1 and not self._ready(17):
            raise TargetError("the PLL is given the crystal, which is not ready")
        source = self.crystal_hz if value >> 22 & 1 else self.internal_hz
        step = source // (value & 0x3F)
        swing = step * (value >> 6 & 0x1FF)
        self.usb_hz = swing // (value >> 24 & 15)
        if not (MHZ <= step <= 2 * MHZ and 100 * MHZ <= swing <= 432 * MHZ and self.usb_hz <= 48 * MHZ):
            raise TargetError(f"the PLL gets {step} Hz, swings at {swing}, and gives {self.usb_hz} for USB")
        if not (self.enabled("APB1ENR", 28) and self._power.registers[0] >> 14 & 1):
            raise TargetError("more than 144 MHz without voltage scale 1")
        return swing // (2 * (value >> 16 & 3) + 2)


class RccF1(Rcc):
    """RM0041, 6.3: the internal 8 MHz or the crystal's, times the PLL."""

    base = 0x40021000
    enables = {"AHBENR": 0x14, "APB2ENR": 0x18, "APB1ENR": 0x1C}  # noqa: RUF012
    internal_hz = 8 * MHZ
    most_hz = 24 * MHZ
    most_apb1_hz = 24 * MHZ

    def __init__(self) -> None:
        super().__init__(dict.fromkeys((0x00, 0x04, 0x08, 0x18, 0x1C, 0x24, 0x2C), 0) | {0x14: 0x14})

    def write(self, offset: int, value: int) -> None:
        if offset == 0x04 and self.registers[0x00] >> 24 & 1 and (value ^ self.registers[0x04]) & 0x3F0000:
            raise TargetError("the PLL is changed while it runs")
        super().write(offset, value)
        if offset == 0x04:
            self._set_clocks(self._source_hz(value), value >> 8 & 7, value >> 11 & 7)

    def read(self, offset: int) -> int:
        value = super().read(offset)
        return value & ~0xC | (value & 3) << 2 if offset == 0x04 else value

    def _source_hz(self, value: int) -> int:
        if value & 3 == 0:
            return self.internal_hz
        needed = 17 if value & 3 == 1 or value >> 16 & 1 else 25
        if not self._ready(needed) or (value & 3 == 2 and not self._ready(25)):
            raise TargetError("the core is given a clock that is not ready")
        if value & 3 == 1:
            return self.crystal_hz
        divider = (self.registers[0x2C] & 15) + 1
        source = self.crystal_hz // divider if value >> 16 & 1 else self.internal_hz // 2
        return source * ((value >> 18 & 15) + 2)


class Gpio(Device):
    """One port. `changed(pin, level)` is told each change of an output."""

    registers: dict[int, int]
    set_register = 0
    output_register = 0

    def __init__(self, port: str, base: int, clock: tuple[str, int]) -> None:
        self.name = f"GPIO{port}"
        self.base = base
        self.clock = clock
        self.changed: Callable[[int, int], None] = lambda pin, level: None

    def level(self, pin: int) -> int:
        return self.registers[self.output_register] >> pin & 1

    def is_output(self, pin: int) -> bool:
        raise NotImplementedError

    def has_function(self, pin: int, function: int) -> bool:
        """Whether the pin is the device's: push-pull, and the alternate function where the chip numbers them."""
        raise NotImplementedError

    def read(self, offset: int) -> int:
        if offset == self.set_register:
            raise KeyError(offset)
        return self.registers[offset]

    def write(self, offset: int, value: int) -> None:
        if offset == self.set_register:
            self._set_outputs((self.registers[self.output_register] & ~(value >> 16)) | value & 0xFFFF)
        elif offset == self.output_register:
            self._set_outputs(value)
        elif offset in self.registers:
            self.registers[offset] = value
        else:
            raise KeyError(offset)

    def _set_outputs(self, value: int) -> None:
        before = self.registers[self.output_register]
        self.registers[self.output_register] = value & 0xFFFF
        for pin in range(16):
            if (before ^ value) >> pin & 1:
                self.changed(pin, value >> pin & 1)


class GpioF4(Gpio):
    """8.4."""

    set_register = 0x18
    output_register = 0x14

    def __init__(self, port: str, base: int, clock: tuple[str, int]) -> None:
        super().__init__(port, base, clock)
        self.registers = dict.fromkeys((0x00, 0x04, 0x08, 0x0C, 0x10, 0x14, 0x20, 0x24), 0)
        if port == "A":
            self.registers |= {0x00: 0xA8000000, 0x08: 0x0C000000, 0x0C: 0x64000000}

    def is_output(self, pin: int) -> bool:
        return self.registers[0x00] >> 2 * pin & 3 == 1

    def has_function(self, pin: int, function: int) -> bool:
        alternate = self.registers[0x20 + 4 * (pin // 8)] >> 4 * (pin % 8) & 15
        return self.registers[0x00] >> 2 * pin & 3 == 2 and alternate == function


class GpioF1(Gpio):
    """RM0041, 7.2."""

    set_register = 0x10
    output_register = 0x0C

    def __init__(self, port: str, base: int, clock: tuple[str, int]) -> None:
        super().__init__(port, base, clock)
        self.registers = {0x00: 0x44444444, 0x04: 0x44444444, 0x08: 0, 0x0C: 0}

    def write(self, offset: int, value: int) -> None:
        if offset == 0x14:
            offset, value = 0x10, value << 16
        super().write(offset, value)

    def _mode(self, pin: int) -> int:
        return self.registers[4 * (pin // 8)] >> 4 * (pin % 8) & 15

    def is_output(self, pin: int) -> bool:
        return self._mode(pin) & 12 == 0 and self._mode(pin) & 3 != 0

    def has_function(self, pin: int, function: int) -> bool:
        return self._mode(pin) & 12 == 8 and self._mode(pin) & 3 != 0


class Spi(Device):
    """A master that sends; 28.5, RM0041 23.5. `sent(words, bits)` is told what has left it, `fetch(n)` asks the DMA for
    up to n words."""

    name = "SPI1"
    base = 0x40013000
    sizes = (2, 4)
    clock = ("APB2ENR", 12)
    _ENABLE = 1 << 6
    _SHAPE = 0x888F | 7 << 3 | 3 << 8
    """The bits of CR1 that are not changed on the way: word size, order of bits, mode, rate, master, select."""

    PIECE = 16
    """Words that the DMA sends before the model looks again; the last ones of a transfer it looks at one by one."""

    def __init__(self, rcc: Rcc) -> None:
        self._rcc = rcc
        self._control = [0, 0]
        self._waiting: int | None = None
        self._shifting: int | None = None
        self._end = 0
        self.sent: Callable[[list[int], int], None] = lambda words, bits: None
        self.fetch: Callable[[int], list[int]] = lambda most: []
        self.left: Callable[[], int] = lambda: 0

    @property
    def busy(self) -> bool:
        return self._shifting is not None

    @property
    def bits(self) -> int:
        return 16 if self._control[0] >> 11 & 1 else 8

    @property
    def sck_hz(self) -> int:
        return self._rcc.apb2_hz >> (self._control[0] >> 3 & 7) + 1

    def _word_cycles(self) -> int:
        return self.bits * self._rcc.core_hz // self.sck_hz

    def read(self, offset: int) -> int:
        if offset in (0x00, 0x04):
            return self._control[offset // 4]
        if offset == 0x08:
            return (self._waiting is None) << 1 | self.busy << 7
        if offset == 0x0C:
            return 0
        raise KeyError(offset)

    def write(self, offset: int, value: int) -> None:
        if offset == 0x00:
            changed = value ^ self._control[0]
            if self.busy and changed & (self._SHAPE | self._ENABLE):
                raise TargetError(f"SPI1's control changes from {self._control[0]:04x} to {value:04x} while it is busy")
            if self._control[0] & self._ENABLE and changed & self._SHAPE:
                raise TargetError("SPI1's word size, mode or rate changes while it is on")
            self._control[0] = value
        elif offset == 0x04:
            self._control[1] = value
            self.machine.cut()
        elif offset == 0x0C:
            self._put(value)
            self.machine.cut()
        else:
            raise KeyError(offset)

    def _put(self, value: int) -> None:
        control = self._control[0]
        if control & self._ENABLE == 0:
            raise TargetError("SPI1 is given a word, but is not enabled")
        if control & 4 == 0 or control & 0x300 != 0x300:
            raise TargetError("SPI1 is no master that selects itself (MSTR, SSM, SSI)")
        if control & 0x80 or control & 3 not in (0, 3):
            raise TargetError("SPI1 sends the wrong bit first, or in a mode that displays do not have")
        if self._waiting is not None:
            raise TargetError("SPI1 is given a word while one waits (TXE is 0)")
        if value >> self.bits:
            raise TargetError(f"SPI1 is given {value:#x} as a word of {self.bits} bits")
        if self._shifting is None:
            self._shifting = value
            self._end = self.machine.now + self._word_cycles()
        else:
            self._waiting = value

    def next_event(self) -> int | None:
        if self._shifting is None:
            return None
        more = self.left() if self._control[1] & 2 else 0
        return self._end + (self.PIECE * self._word_cycles() if more > self.PIECE else 0)

    def advance(self, now: int) -> None:
        fed = self._control[1] & 2 and self._control[0] & self._ENABLE
        if fed and self._shifting is None and (words := self.fetch(1)):
            self._put(words[0])
        if self._shifting is None:
            return
        if fed and self._waiting is None and (words := self.fetch(1)):
            self._waiting = words[0]
        while self._shifting is not None and self._end <= now:
            done = [self._shifting]
            cycles = self._word_cycles()
            ahead = self.fetch((now - self._end) // cycles + 1) if fed else []
            if self._waiting is not None:
                ahead.insert(0, self._waiting)
            # Of n words at hand the first leave, one is on its way, one may wait.
            leave = min(len(ahead), (now - self._end) // cycles)
            done += ahead[:leave]
            self._end += leave * cycles
            rest = ahead[leave:]
            self._shifting = rest[0] if rest else None
            self._waiting = rest[1] if len(rest) > 1 else None
            self._end += cycles if rest else 0
            self.sent(done, self.bits)


class DmaF4(Device):
    """DMA2's streams towards a device, in direct mode; 10.5. `wiring` is which channel of which stream serves whom: by
    the device's data register."""

    name = "DMA2"
    base = 0x40026400
    clock = ("AHB1ENR", 22)
    _IRQS = (56, 57, 58, 59, 60, 68, 69, 70)
    _FLAG_SHIFTS = (0, 6, 16, 22)

    def __init__(self, wiring: dict[tuple[int, int], int]) -> None:
        self._wiring = wiring
        self._streams = [dict.fromkeys((0x00, 0x04, 0x08, 0x0C, 0x10), 0) | {0x14: 0x21} for _ in self._IRQS]
        self._flags = [0] * len(self._IRQS)
        self._at = [0] * len(self._IRQS)
        self._watches: list[Watch | None] = [None] * len(self._IRQS)
        self.dead = False
        """Whether it moves nothing, as in an emulator without it."""

    def _status(self, first: int) -> int:
        return sum(self._flags[first + i] << shift for i, shift in enumerate(self._FLAG_SHIFTS))

    def read(self, offset: int) -> int:
        if offset in (0x00, 0x04):
            return self._status(offset)
        return self._streams[(offset - 0x10) // 0x18][(offset - 0x10) % 0x18]

    def write(self, offset: int, value: int) -> None:
        if offset in (0x08, 0x0C):
            for i, shift in enumerate(self._FLAG_SHIFTS):
                self._flags[offset - 0x08 + i] &= ~(value >> shift & 0x3D)
                self._update_line(offset - 0x08 + i)
            return
        number, register = divmod(offset - 0x10, 0x18)
        stream = self._streams[number]
        if register not in stream:
            raise KeyError(offset)
        if stream[0x00] & 1 and (register or value & 1):
            raise TargetError(f"DMA2 stream {number} is changed while it is on")
        stream[register] = value
        if register == 0x00 and value & 1:
            self._start(number)
            self.machine.cut()

    def _start(self, number: int) -> None:
        stream = self._streams[number]
        control, count, memory = stream[0x00], stream[0x04], stream[0x0C]
        size = 1 << (control >> 11 & 3)
        served = self._wiring.get((number, control >> 25 & 7))
        if served is None or served != stream[0x08]:
            raise TargetError(f"DMA2 stream {number}: channel {control >> 25 & 7} does not serve {stream[0x08]:08x}")
        if control >> 6 & 3 != 1 or control >> 10 & 1 == 0 or control >> 8 & 3 or stream[0x14] & 4:
            raise TargetError(f"DMA2 stream {number}: {control:08x} is no plain transfer from memory to a device")
        if self._flags[number]:
            raise TargetError(f"DMA2 stream {number} is started with flags of the last transfer set")
        if not 0 < count < 65536 or memory % size or not self.machine.dma_reaches(memory, count * size):
            raise TargetError(f"DMA2 stream {number}: {count} words at {memory:08x}, where it cannot read them")
        self._at[number] = memory

    def serving(self, register: int) -> int | None:
        """The stream that is on and serves that data register."""
        for number, stream in enumerate(self._streams):
            if stream[0x00] & 1 and stream[0x08] == register:
                return number
        return None

    def left(self, register: int) -> int:
        number = self.serving(register)
        return 0 if number is None or self.dead else self._streams[number][0x04]

    def fetch(self, register: int, most: int) -> list[int]:
        """Up to `most` words for that data register, as they are in memory now."""
        number = self.serving(register)
        if number is None or self.dead:
            return []
        stream = self._streams[number]
        size = 1 << (stream[0x00] >> 11 & 3)
        count = min(most, stream[0x04])
        data = self.machine.memory(self._at[number], count * size)
        self._at[number] += count * size
        stream[0x04] -= count
        if stream[0x04] == 0:
            stream[0x00] &= ~1
            self._flags[number] |= 0x20
            self._update_line(number)
            self._end_watch(number)
        return [int.from_bytes(data[i : i + size], "little") for i in range(0, len(data), size)]

    def _told(self, number: int, address: int, size: int) -> None:
        if address + size > self._at[number]:
            raise TargetError(f"{address:08x} is written, which DMA2 stream {number} has yet to read")

    def _end_watch(self, number: int) -> None:
        watch = self._watches[number]
        if watch is not None:
            self.machine.unwatch(watch)
            self._watches[number] = None

    def advance(self, now: int) -> None:
        for number, stream in enumerate(self._streams):
            if not stream[0x00] & 1:
                self._end_watch(number)
            elif self._watches[number] is None:
                end = self._at[number] + (stream[0x04] << (stream[0x00] >> 11 & 3))
                self._watches[number] = self.machine.watch(self._at[number], end, partial(self._told, number))

    def _update_line(self, number: int) -> None:
        enabled = self._streams[number][0x00] >> 4 & 1
        self.machine.core.set_line(self._IRQS[number], bool(enabled and self._flags[number] & 0x20))


class Usart(Device):
    """30.6, RM0041 24.6: 8 data bits, no parity, one stop bit. What it sends gathers in `output`; `feed` gives it input
    at the line's rate. `stuck`: the transmitter takes nothing more. `hasty`: it sends a byte in no time, for tests that
    are about what is sent; one interrupt for each byte makes most of the work otherwise."""

    name = "USART1"
    base = 0x40011000
    clock = ("APB2ENR", 4)
    irq = 37

    def __init__(self, rcc: Rcc, baud: int, has_pins: Callable[[], bool]) -> None:
        self._rcc = rcc
        self.baud = baud
        """The rate at the other end; another one is garbage, and an error here."""
        self._has_pins = has_pins
        self._registers = dict.fromkeys((0x08, 0x0C, 0x10, 0x14, 0x18), 0)
        self._shifting: int | None = None
        self._waiting: int | None = None
        self._end = 0
        self._received: int | None = None
        self._overrun = False
        self._input: deque[int] = deque()
        self._input_due = 0
        self.output = bytearray()
        self.stuck = False
        self.hasty = False
        self.lost = 0
        """Bytes that came while the last one had not been read."""

    def feed(self, data: bytes) -> None:
        if data and not self._input:
            self._input_due = max(self._input_due, self.machine.now + self._byte_cycles())
        self._input.extend(data)

    @property
    def fed(self) -> bool:
        """Whether all that `feed` was given has arrived."""
        return not self._input

    def _byte_cycles(self) -> int:
        return 10 * self._rcc.core_hz // self.baud

    def _check(self, direction: int) -> None:
        control = self._registers[0x0C]
        if not (control >> 13 & 1 and control >> direction & 1):
            raise TargetError("USART1 is used, but it or that direction of it is not enabled (UE, TE, RE)")
        if control & 0x9600 or self._registers[0x10] or self._registers[0x14]:
            raise TargetError("USART1 is not set up for 8 data bits, no parity, one stop bit")
        divider = self._registers[0x08]
        if divider < 16 or abs(self._rcc.apb2_hz / divider / self.baud - 1) > 0.015:
            raise TargetError(f"USART1 with divider {divider} of {self._rcc.apb2_hz} Hz is not at {self.baud} bit/s")
        if not self._has_pins():
            raise TargetError("USART1 is used, but its pins are not its own")

    def read(self, offset: int) -> int:
        if offset == 0x00:
            empty = self._waiting is None and not self.stuck
            complete = empty and self._shifting is None
            return self._overrun << 3 | (self._received is not None) << 5 | complete << 6 | empty << 7
        if offset == 0x04:
            value, self._received, self._overrun = self._received or 0, None, False
            self._update_line()
            return value
        return self._registers[offset]

    def write(self, offset: int, value: int) -> None:
        if offset == 0x04:
            self._check(3)
            if self._waiting is not None or self.stuck:
                raise TargetError("USART1 is given a byte while one waits (TXE is 0)")
            if self.hasty:
                self.output.append(value & 0xFF)
            elif self._shifting is None:
                self._shifting = value & 0xFF
                self._end = self.machine.now + self._byte_cycles()
            else:
                self._waiting = value & 0xFF
        elif offset in self._registers:
            if offset == 0x08 and (self._shifting is not None or self._waiting is not None):
                raise TargetError("USART1 gets another divider while a byte is on its way")
            self._registers[offset] = value
        elif offset != 0x00:
            raise KeyError(offset)
        self._update_line()

    def next_event(self) -> int | None:
        events = [self._end] if self._shifting is not None and not self.stuck else []
        if self._input:
            events.append(self._input_due)
        return min(events, default=None)

    def advance(self, now: int) -> None:
        while self._shifting is not None and self._end <= now and not self.stuck:
            self.output.append(self._shifting)
            self._shifting, self._waiting = self._waiting, None
            self._end += self._byte_cycles()
        while self._input and self._input_due <= now:
            byte = self._input.popleft()
            self._input_due += self._byte_cycles()
            if self._registers[0x0C] & 0x2004 == 0x2004:
                self._check(2)
                if self._received is None:
                    self._received = byte
                else:
                    self._overrun = True
                    self.lost += 1
        self._update_line()

    def _update_line(self) -> None:
        status, control = self.read(0x00), self._registers[0x0C]
        level = control >> 13 & 1 and (
            (control >> 5 & 1 and status & 0x28)
            or (control >> 7 & 1 and status & 0x80)
            or (control >> 6 & status >> 6 & 1)
        )
        self.machine.core.set_line(self.irq, bool(level))


class Iwdg(Device):
    """The watchdog (21.4, RM0041 21.4), at the fastest that its oscillator may have: 47 kHz."""

    name = "IWDG"
    base = 0x40003000

    def __init__(self) -> None:
        self._prescaler = 0
        self._reload = 0xFFF
        self._unlocked = False
        self._bites_ns: int | None = None

    def read(self, offset: int) -> int:
        return {0x04: self._prescaler, 0x08: self._reload, 0x0C: 0}[offset]

    def write(self, offset: int, value: int) -> None:
        if offset == 0x00:
            if value not in (0x5555, 0xAAAA, 0xCCCC):
                raise TargetError(f"IWDG has no key {value:04x}")
            self._unlocked = value == 0x5555
            if value == 0xCCCC or (value == 0xAAAA and self._bites_ns is not None):
                self._bites_ns = self.machine.ns + (self._reload + 1) * (4 << self._prescaler) * 1_000_000 // 47
        elif offset in (0x04, 0x08):
            if not self._unlocked:
                raise TargetError("IWDG is set up without its key 5555")
            if offset == 0x04:
                self._prescaler = value & 7
            else:
                self._reload = value & 0xFFF
        else:
            raise KeyError(offset)

    @property
    def is_on(self) -> bool:
        return self._bites_ns is not None

    def next_event(self) -> int | None:
        if self._bites_ns is None:
            return None
        return self.machine.now + self.machine.cycles(max(0, self._bites_ns - self.machine.ns)) + 1

    def advance(self, now: int) -> None:
        if self._bites_ns is not None and self.machine.ns > self._bites_ns:
            raise self.machine.error("the watchdog bites: the program has not fed it in time")


class Rng(Device):
    """Random numbers (24.4), the same ones for the same seed."""

    name = "RNG"
    base = 0x50060800
    clock = ("AHB2ENR", 6)

    def __init__(self, rcc: RccF4, seed: int) -> None:
        self._rcc = rcc
        self._random = random.Random(seed)
        self._control = 0

    def read(self, offset: int) -> int:
        ready = self._control >> 2 & 1 and self._rcc.usb_hz > 0
        if offset == 0x08:
            if not ready:
                raise TargetError("RNG is read, but it is not ready")
            return self._random.getrandbits(32)
        return {0x00: self._control, 0x04: int(ready)}[offset]

    def write(self, offset: int, value: int) -> None:
        if offset:
            raise KeyError(offset)
        self._control = value


@dataclass
class Chip:
    """A machine and those of its devices that tests look at."""

    machine: Machine
    rcc: Rcc
    port_a: Gpio
    spi: Spi
    usart: Usart
    iwdg: Iwdg
    spi_function: int
    dma: DmaF4 | None = None


def f405(elf: Path, *, baud: int = 115200, crystal: bool = True, seed: int = 1) -> Chip:
    """An STM32F405 with the program `elf`; `crystal`: whether 8 MHz are soldered in."""
    flash = Plain("flash interface", 0x40023C00, {0x00: 0})
    power = Plain("PWR", 0x40007000, {0x00: 0x4000, 0x04: 0}, ("APB1ENR", 28))
    rcc = RccF4(flash, power)
    rcc.has_crystal = crystal
    port = GpioF4("A", 0x40020000, ("AHB1ENR", 0))
    spi = Spi(rcc)
    data_register = spi.base + 0x0C
    dma = DmaF4({(3, 3): data_register, (5, 3): data_register})
    spi.fetch = lambda most: dma.fetch(data_register, most)
    spi.left = lambda: dma.left(data_register)
    usart = Usart(rcc, baud, lambda: all(port.has_function(pin, 7) for pin in (9, 10)))
    iwdg = Iwdg()
    memories = [
        Memory(0x08000000, 1 << 20, writable=False),
        Memory(0x20000000, 128 << 10, writable=True),
        Memory(0x10000000, 64 << 10, writable=True, dma=False),
    ]
    devices = [rcc, flash, power, port, spi, dma, usart, iwdg, Rng(rcc, seed)]
    machine = Machine(elf, memories, devices, rcc.internal_hz)
    machine.clock_enabled = rcc.enabled
    return Chip(machine, rcc, port, spi, usart, iwdg, spi_function=5, dma=dma)


def f100(elf: Path, *, baud: int = 115200, crystal: bool = True) -> Chip:
    """An STM32F100RB with the program `elf`, without its DMA; `crystal`: whether 8 MHz are soldered in."""
    flash = Plain("flash interface", 0x40022000, {0x00: 0x30})
    rcc = RccF1()
    rcc.has_crystal = crystal
    ports = [GpioF1("ABCD"[i], 0x40010800 + 0x400 * i, ("APB2ENR", 2 + i)) for i in range(4)]
    spi = Spi(rcc)
    usart = Usart(rcc, baud, lambda: ports[0].has_function(9, 0))
    usart.base = 0x40013800
    usart.clock = ("APB2ENR", 14)
    iwdg = Iwdg()
    memories = [Memory(0x08000000, 128 << 10, writable=False), Memory(0x20000000, 8 << 10, writable=True)]
    machine = Machine(elf, memories, [rcc, flash, *ports, spi, usart, iwdg], rcc.internal_hz)
    machine.clock_enabled = rcc.enabled
    return Chip(machine, rcc, ports[0], spi, usart, iwdg, spi_function=0)
