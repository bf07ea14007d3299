"""A Cortex-M microcontroller on Unicorn: the processor is Unicorn's, everything around it is judged strictly here.

Unicorn executes instructions and knows no time, no interrupts and no devices. Here

* time is the number of executed instructions, one clock each, in slices of at most SLICE; in sleep (WFI) it jumps to
  the next event. Unicorn does not tell how much of a slice ran that ended early: one that ends with sleep or a
  handler's return counts as SHORT_CLOCKS, one that is cut because something begins that has an end of its own as one
  clock, so that all of that is still to come;
* devices (`Device`) answer to addresses, say when something happens next, and hold interrupt lines;
* interrupts have one priority: none interrupts another;
* whatever the chip would not do, or would do and no program should ask for, raises TargetError with the program's
  counter: accesses to nothing, to a device without a clock, of a wrong size or alignment; writes to the program;
  undefined instructions; a stack that overflows.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from elftools.elf.elffile import ELFFile
from unicorn import (  # type: ignore[attr-defined]
    UC_ARCH_ARM,
    UC_HOOK_CODE,
    UC_HOOK_INTR,
    UC_HOOK_MEM_INVALID,
    UC_HOOK_MEM_WRITE,
    UC_MODE_MCLASS,
    UC_MODE_THUMB,
    UC_PROT_EXEC,
    UC_PROT_READ,
    UC_PROT_WRITE,
    Uc,
    UcError,
)
from unicorn import arm_const as arm

SLICE = 1024
"""The most instructions that run before the devices are looked at."""

SHORT_CLOCKS = 50
"""About what an interrupt's handler takes, or a turn of a loop that waits."""

SYSTICK_EXCEPTION = 15
FIRST_IRQ = 16
_EXCEPTION_EXIT = 8
"""What Unicorn calls a branch to an EXC_RETURN value in handler mode."""

_PAINT = 0xA5
_WFI = b"\x30\xbf"
_CORE_REGISTERS = 0xE000E000
_CYCLE_COUNTER = 0xE0001000
_DEVICE_SPACES = ((0x40000000, 0x20000000), (_CYCLE_COUNTER, 0x1000), (_CORE_REGISTERS, 0x1000))
_FRAME = struct.Struct("<8I")
_FLOAT_FRAME = struct.Struct("<8Q2I")
_FLOAT_REGISTERS = (*range(arm.UC_ARM_REG_D0, arm.UC_ARM_REG_D7 + 1), arm.UC_ARM_REG_FPSCR)
_FLOATS_IN_USE = 4
"""CONTROL.FPCA: the frame holds the floating-point registers as well."""

_FRAME_REGISTERS = (
    arm.UC_ARM_REG_R0,
    arm.UC_ARM_REG_R1,
    arm.UC_ARM_REG_R2,
    arm.UC_ARM_REG_R3,
    arm.UC_ARM_REG_R12,
    arm.UC_ARM_REG_LR,
    arm.UC_ARM_REG_PC,
    arm.UC_ARM_REG_XPSR,
)


class TargetError(AssertionError):
    """The program did what it must not do; says what and where."""


class Restarted(Exception):
    """The program asked for a reset."""


class Device:
    """Registers at `base` .. `base` + `size`, 32-bit accesses alone unless `sizes` says otherwise."""

    name = "device"
    base = 0
    size = 0x400
    sizes: tuple[int, ...] = (4,)
    clock: tuple[str, int] | None = None
    """The register and the bit of the clock controller that enable it; None: it always has a clock."""

    machine: Machine

    def read(self, offset: int) -> int:
        """The register's value; KeyError where there is none."""
        raise KeyError(offset)

    def write(self, offset: int, value: int) -> None:
        """Sets a register; KeyError where there is none."""
        raise KeyError(offset)

    def next_event(self) -> int | None:
        """The clock at which `advance` should be called at the latest; None: nothing is under way."""
        return None

    def advance(self, now: int) -> None:
        """Lets happen what is due at clock `now` or earlier."""


class CoreRegisters(Device):
    """SysTick, NVIC and the system control block (Armv7-M Architecture Reference Manual, B3.2 to B3.4)."""

    name = "system control space"
    base = _CORE_REGISTERS
    size = 0x1000

    def __init__(self) -> None:
        self.enabled: set[int] = set()
        self.pending: set[int] = set()
        """Exceptions that wait for their turn."""
        self._lines: set[int] = set()
        self._systick_control = 0
        self._systick_reload = 0
        self._systick_begin = 0
        self._scratch = {0xD08: 0, 0xD14: 0x200, 0xD24: 0, 0xD28: 0, 0xD2C: 0, 0xD34: 0, 0xD38: 0, 0xD88: 0, 0xDFC: 0}

    def set_line(self, irq: int, level: bool) -> None:
        """A device's interrupt line: pending from when it rises, and again after its handler if it is still high."""
        number = FIRST_IRQ + irq
        if level and number not in self._lines:
            self._lines.add(number)
            self.pending.add(number)
        elif not level:
            self._lines.discard(number)

    def ready(self) -> list[int]:
        """Pending exceptions that may be taken, the first one first."""
        return sorted(n for n in self.pending if n < FIRST_IRQ or n - FIRST_IRQ in self.enabled)

    def ended(self, number: int) -> None:
        if number in self._lines:
            self.pending.add(number)

    def read(self, offset: int) -> int:
        if offset == 0x10:
            return self._systick_control
        if offset == 0x14:
            return self._systick_reload
        if offset == 0x18:
            gone = (self.machine.now - self._systick_begin) % (self._systick_reload + 1)
            return self._systick_reload - gone
        if 0x100 <= offset < 0x120 or 0x180 <= offset < 0x1A0:
            first = (offset & 0x1F) * 8
            return sum(1 << (irq - first) for irq in self.enabled if first <= irq < first + 32)
        return self._scratch[offset]

    def write(self, offset: int, value: int) -> None:
        bits = [(offset & 0x1F) * 8 + bit for bit in range(32) if value >> bit & 1]
        if offset == 0x10:
            if value & 3 and not value & 4:
                raise TargetError("SysTick from the external clock, which this model does not have")
            self._systick_control = value & 7
        elif offset == 0x14:
            self._systick_reload = value & 0xFFFFFF
        elif offset == 0x18:
            self._systick_begin = self.machine.now
        elif 0x100 <= offset < 0x120:
            self.enabled.update(bits)
        elif 0x180 <= offset < 0x1A0:
            self.enabled.difference_update(bits)
        elif 0x200 <= offset < 0x220:
            self.pending.update(FIRST_IRQ + bit for bit in bits)
        elif 0x280 <= offset < 0x2A0:
            self.pending.difference_update(FIRST_IRQ + bit for bit in bits)
        elif offset == 0xD0C:
            if value >> 16 != 0x05FA:
                raise TargetError(f"AIRCR written without its key: {value:08x}")
            raise Restarted
        elif offset in self._scratch:
            self._scratch[offset] = value
        else:
            raise KeyError(offset)

    def next_event(self) -> int | None:
        if self._systick_control & 3 != 3:
            return None
        period = self._systick_reload + 1
        return self._systick_begin + ((self.machine.accounted - self._systick_begin) // period + 1) * period

    def advance(self, now: int) -> None:
        due = self.next_event()
        if due is not None and due <= now:
            self.pending.add(SYSTICK_EXCEPTION)


class CycleCounter(Device):
    """CYCCNT of the data watchpoint and trace unit (C1.8), which counts once TRCENA of DEMCR and CYCCNTENA are set.
    Here it counts asleep, too."""

    name = "data watchpoint and trace unit"
    base = _CYCLE_COUNTER
    size = 0x1000

    def __init__(self, core: CoreRegisters) -> None:
        self._core = core
        self._control = 0

    def read(self, offset: int) -> int:
        if offset == 0x00:
            return self._control
        if offset == 0x04:
            return self.machine.now & 0xFFFFFFFF if self._control & 1 else 0
        raise KeyError(offset)

    def write(self, offset: int, value: int) -> None:
        if offset != 0x00:
            raise KeyError(offset)
        if not self._core.read(0xDFC) >> 24 & 1:
            raise TargetError("the DWT is set up before DEMCR.TRCENA has started it")
        self._control = value


@dataclass
class Memory:
    """A region of the chip; `dma`: its DMA controllers reach it."""

    begin: int
    size: int
    writable: bool
    dma: bool = True


@dataclass
class Watch:
    """What `Machine.watch` gives, for `Machine.unwatch`."""

    hook: int


class Machine:
    """One microcontroller with a program. `now` is in clocks of the core since reset, `ns` in nanoseconds."""

    def __init__(self, elf: Path, memories: list[Memory], devices: list[Device], core_hz: int) -> None:
        self.now = 0
        self.accounted = 0
        """The clock up to which the devices have been advanced."""
        self.core_hz = core_hz
        self.core = CoreRegisters()
        self.memories = memories
        self.devices: list[Device] = [self.core, CycleCounter(self.core), *devices]
        self.clock_enabled: Callable[[str, int], bool] = lambda register, bit: True
        self._ps = 0
        self._asleep = False
        self._cut_hook = 0
        self._exception = 0
        self._returning = False
        self._error: BaseException | None = None
        self._blocks = {
            block: device
            for device in self.devices
            for block in range(device.base >> 10, (device.base + device.size + 0x3FF) >> 10)
        }
        for device in self.devices:
            device.machine = self

        emulator: Any = Uc  # its stubs are not those of the version that runs
        self._uc = emulator(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS)
        self._uc.ctl_set_cpu_model(arm.UC_CPU_ARM_CORTEX_M4)
        for memory in memories:
            access = UC_PROT_READ | (UC_PROT_WRITE if memory.writable else UC_PROT_EXEC)
            self._uc.mem_map(memory.begin, memory.size, access)
        for begin, size in _DEVICE_SPACES:
            self._uc.mmio_map(begin, size, self._mmio_read, begin, self._mmio_write, begin)
        self._uc.hook_add(UC_HOOK_INTR, self._on_exception)
        self._uc.hook_add(UC_HOOK_MEM_INVALID, self._on_invalid)
        # Unicorn compiles stores with a look at the hooks only if there is one when it does; this one is never called.
        self._uc.hook_add(UC_HOOK_MEM_WRITE, lambda *_: None, begin=1, end=2)
        self._load(elf)

    # --- the program ---------------------------------------------------------------------------------------------

    def _load(self, elf: Path) -> None:
        with elf.open("rb") as file:
            parsed = ELFFile(file)
            table: Any = parsed.get_section_by_name(".symtab")
            self.symbols = {symbol.name: symbol["st_value"] for symbol in table.iter_symbols()}
            for segment in parsed.iter_segments("PT_LOAD"):
                if segment["p_filesz"] == 0:
                    continue
                self._uc.mem_write(segment["p_paddr"], segment.data())
                if segment["p_flags"] & 1:
                    self._mark_sleep(segment["p_paddr"], segment.data())
        stack, reset = struct.unpack("<2I", self.memory(self.symbols["core_vectors"], 8))
        self._vectors = self.symbols["core_vectors"]
        self._uc.reg_write(arm.UC_ARM_REG_SP, stack)
        self._pc = reset & ~1

    def _mark_sleep(self, address: int, code: bytes) -> None:
        at = code.find(_WFI)
        while at >= 0:
            if at % 2 == 0:
                self._uc.hook_add(UC_HOOK_CODE, self._on_wfi, begin=address + at, end=address + at)
            at = code.find(_WFI, at + 1)

    def memory(self, address: int, size: int) -> bytes:
        return bytes(self._uc.mem_read(address, size))

    def paint_stack(self) -> None:
        """Before the start; for `stack_left`."""
        begin, end = self.symbols["el_stack_begin"], self.symbols["el_stack_end"]
        self._uc.mem_write(begin, bytes([_PAINT]) * (end - begin))

    def stack_left(self) -> int:
        """Bytes of the stack that the program has never written."""
        begin, end = self.symbols["el_stack_begin"], self.symbols["el_stack_end"]
        kept = self.memory(begin, end - begin)
        return len(kept) - len(kept.lstrip(bytes([_PAINT])))

    @property
    def ns(self) -> int:
        return self._ps // 1000

    def set_core_hz(self, hz: int) -> None:
        self.core_hz = hz

    def cycles(self, ns: int) -> int:
        """Nanoseconds in clocks of the core as it runs now."""
        return ns * self.core_hz // 1_000_000_000

    # --- running -------------------------------------------------------------------------------------------------

    def run(self, until: Callable[[], bool], limit_ms: int) -> None:
        """Runs until `until()` holds, asked after each slice. Raises TargetError when it does not within `limit_ms`."""
        limit = self._ps + limit_ms * 1_000_000_000
        while not until():
            if self._ps >= limit:
                raise self.error(f"what was waited for did not come within {limit_ms} ms")
            self.step()

    def step(self) -> None:
        """One slice, or a sleep until the next event."""
        if self._asleep:
            if not self.core.ready():
                self._pass_time(self._until_event(1 << 30))
                return
            self._asleep = False
        masked = self._exception != 0 or self._uc.reg_read(arm.UC_ARM_REG_PRIMASK) & 1
        ready = self.core.ready()
        if ready and not masked:
            self._enter(ready[0])
        # One instruction at a time while one is kept waiting: the gap between cpsie and cpsid may be that short.
        count = 1 if ready and masked and self._exception == 0 else self._until_event(SLICE)
        try:
            self._uc.emu_start(self._pc | 1, 0, count=count)
        except UcError as error:
            if self._error is None:
                self._pc = self._uc.reg_read(arm.UC_ARM_REG_PC)
                raise self.error(str(error)) from None
        self._pc = self._uc.reg_read(arm.UC_ARM_REG_PC)
        if self._error is not None:
            raised, self._error = self._error, None
            raise raised
        if self._asleep or self._returning:
            count = min(count, SHORT_CLOCKS)
        if self._cut_hook:
            count = 1
            self._uc.hook_del(self._cut_hook)
            self._cut_hook = 0
        if self._returning:
            self._leave()
        self._pass_time(count)

    def _until_event(self, most: int) -> int:
        events = [event for device in self.devices if (event := device.next_event()) is not None]
        if not events and most > SLICE:
            raise self.error("the program sleeps, and nothing will wake it")
        return max(1, min([most, *(event - self.now for event in events)]))

    def _pass_time(self, clocks: int) -> None:
        self.now += clocks
        self._ps += clocks * (1_000_000_000_000 // self.core_hz)
        try:
            for device in self.devices:
                device.advance(self.now)
        except TargetError as error:
            raise self._with_place(error) from None
        self.accounted = self.now

    def cut(self) -> None:
        """Ends the slice after this instruction: something begins whose end the processor may wait for.

        Stopping at once would leave the instruction half done, so a hook stops before the next one."""
        if not self._cut_hook:
            self._cut_hook = self._uc.hook_add(UC_HOOK_CODE, lambda uc, *_: uc.emu_stop())

    def error(self, what: str) -> TargetError:
        return TargetError(f"{what}; {self.where()}")

    def _with_place(self, error: TargetError) -> TargetError:
        return error if "; at " in str(error) else self.error(str(error))

    def where(self) -> str:
        """The function and address of the instruction under way."""
        pc = self._uc.reg_read(arm.UC_ARM_REG_PC)
        below = [(value, name) for name, value in self.symbols.items() if value <= pc and name and name[0] not in "$."]
        name = max(below)[1] if below else "?"
        return f"at {pc:08x} in {name}"

    # --- exceptions ----------------------------------------------------------------------------------------------

    def _enter(self, number: int) -> None:
        """Pushes the frame and jumps to the handler (Armv7-M Architecture Reference Manual, B1.5.6)."""
        control = self._uc.reg_read(arm.UC_ARM_REG_CONTROL)
        floats = control & _FLOATS_IN_USE
        values = list(self._uc.reg_read_batch(_FRAME_REGISTERS))
        values[6] = self._pc
        frame = b""
        if floats:
            frame = _FLOAT_FRAME.pack(*self._uc.reg_read_batch(_FLOAT_REGISTERS), 0)
            self._uc.reg_write(arm.UC_ARM_REG_CONTROL, control & ~_FLOATS_IN_USE)
        stack = self._uc.reg_read(arm.UC_ARM_REG_SP)
        if stack & 4:
            values[7] |= 1 << 9
        frame = _FRAME.pack(*values) + frame
        stack = (stack & ~7) - len(frame)
        if stack < self.symbols["el_stack_begin"]:
            raise self.error(f"the stack overflows: {stack:08x}")
        self._uc.mem_write(stack, frame)
        self._uc.reg_write(arm.UC_ARM_REG_SP, stack)
        self._uc.reg_write(arm.UC_ARM_REG_LR, 0xFFFFFFE9 if floats else 0xFFFFFFF9)
        self._uc.reg_write(arm.UC_ARM_REG_XPSR, 0x01000000 | number)
        self._pc = struct.unpack("<I", self.memory(self._vectors + 4 * number, 4))[0] & ~1
        self._exception = number
        self.core.pending.discard(number)

    def _leave(self) -> None:
        self._returning = False
        stack = self._uc.reg_read(arm.UC_ARM_REG_SP)
        values = _FRAME.unpack(self.memory(stack, _FRAME.size))
        stack += _FRAME.size
        control = self._uc.reg_read(arm.UC_ARM_REG_CONTROL) & ~_FLOATS_IN_USE
        if not self._pc & 0x10:
            *floats, _ = _FLOAT_FRAME.unpack(self.memory(stack, _FLOAT_FRAME.size))
            stack += _FLOAT_FRAME.size
            self._uc.reg_write_batch(list(zip(_FLOAT_REGISTERS, floats, strict=True)))
            control |= _FLOATS_IN_USE
        self._uc.reg_write_batch(list(zip(_FRAME_REGISTERS[:6], values[:6], strict=True)))
        self._uc.reg_write(arm.UC_ARM_REG_XPSR, values[7] & ~(1 << 9))
        self._uc.reg_write(arm.UC_ARM_REG_CONTROL, control)
        self._uc.reg_write(arm.UC_ARM_REG_SP, stack + (4 if values[7] & 1 << 9 else 0))
        self._pc = values[6]
        self.core.ended(self._exception)
        self._exception = 0

    def _on_exception(self, uc: Any, number: int, _: Any) -> None:
        if number == _EXCEPTION_EXIT and self._exception:
            self._returning = True
        else:
            self._error = self.error(f"exception {number} (svc, bkpt, or a return from nothing)")
        uc.emu_stop()

    def _on_wfi(self, *_: Any) -> None:
        self._asleep = True

    # --- memory --------------------------------------------------------------------------------------------------

    def watch(self, begin: int, end: int, told: Callable[[int, int], None]) -> Watch:
        """Tells `told(address, size)` each write of the processor that touches `begin` .. `end`, `end` excluded.

        Not to be called by a device's `read` or `write`."""

        def hooked(uc: Any, access: int, address: int, size: int, value: int, _: Any) -> None:
            self._guarded(lambda: told(address, size))

        return Watch(self._uc.hook_add(UC_HOOK_MEM_WRITE, hooked, begin=begin, end=end - 1))

    def unwatch(self, watch: Watch) -> None:
        self._uc.hook_del(watch.hook)

    def dma_reaches(self, begin: int, size: int) -> bool:
        return any(m.dma and m.begin <= begin and begin + size <= m.begin + m.size for m in self.memories)

    def _guarded(self, action: Callable[[], int | None]) -> int:
        """Keeps what `action` raises for after the slice, with the program's counter."""
        try:
            return action() or 0
        except TargetError as error:
            self._error = self._error or self._with_place(error)
        except Restarted as restart:
            self._error = self._error or restart
        self._uc.emu_stop()
        return 0

    def _device_at(self, address: int, size: int) -> Device:
        device = self._blocks.get(address >> 10)
        if device is None or not device.base <= address < device.base + device.size:
            raise TargetError(f"access to {address:08x}, where nothing is that this board uses")
        if size not in device.sizes or address % size:
            raise TargetError(f"{device.name}: {size} bytes at {address:08x}, which its registers do not take")
        if device.clock is not None and not self.clock_enabled(*device.clock):
            raise TargetError(f"{device.name} is used, but its clock is off ({device.clock[0]} bit {device.clock[1]})")
        return device

    def _mmio_read(self, uc: Any, offset: int, size: int, begin: int) -> int:
        def access() -> int:
            device = self._device_at(begin + offset, size)
            try:
                return device.read(begin + offset - device.base)
            except KeyError:
                raise TargetError(f"{device.name} has no register at {begin + offset:08x} to be read") from None

        return self._guarded(access)

    def _mmio_write(self, uc: Any, offset: int, size: int, value: int, begin: int) -> None:
        def access() -> None:
            device = self._device_at(begin + offset, size)
            try:
                device.write(begin + offset - device.base, value)
            except KeyError:
                raise TargetError(f"{device.name} has no register at {begin + offset:08x} to be written") from None

        self._guarded(access)

    def _on_invalid(self, uc: Any, access: int, address: int, size: int, value: int, _: Any) -> bool:
        self._error = self._error or self.error(f"access of {size} bytes to {address:08x}, which the chip refuses")
        return False
