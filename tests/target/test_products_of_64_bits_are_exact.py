"""The 64-bit product of boards whose processor has none (firmware/boards/cortex_m/multiply64.S), run on an emulated
Cortex-M0 and compared with Python's integers: values around every bit and seeded random ones."""

from __future__ import annotations

import random
import struct
import subprocess
from pathlib import Path
from typing import Any

import pytest
import unicorn
from unicorn import arm_const

from needs import need_tool
from target_tools import REPOSITORY

SOURCE = REPOSITORY / "firmware/boards/cortex_m/multiply64.S"
CODE, RETURN, STACK = 0x1000, 0x2000, 0x4000
ALL = 2**64 - 1
KEPT = (0x4444_4444, 0x5555_5555)


def assemble(text: str, folder: Path) -> bytes:
    """The function's code."""
    gcc = need_tool("arm-none-eabi-gcc", "gcc-arm-none-eabi")
    objcopy = need_tool("arm-none-eabi-objcopy", "binutils-arm-none-eabi")
    source, program, code = (folder / f"multiply64.{kind}" for kind in ("S", "o", "bin"))
    source.write_text(text, encoding="utf-8")
    subprocess.run([gcc, "-mcpu=cortex-m0plus", "-mthumb", "-c", source, "-o", program], check=True)
    subprocess.run([objcopy, "-O", "binary", "-j", ".text.__aeabi_lmul", program, code], check=True)
    return code.read_bytes()


def first_wrong(code: bytes) -> str:
    """The first pair whose product is wrong, or that changes what belongs to the caller; empty when all are right."""
    mode = unicorn.UC_MODE_THUMB | unicorn.UC_MODE_MCLASS
    cpu: Any = unicorn.Uc(unicorn.UC_ARCH_ARM, mode)  # type: ignore[attr-defined,no-untyped-call]
    cpu.ctl_set_cpu_model(arm_const.UC_CPU_ARM_CORTEX_M0)
    cpu.mem_map(0, 0x8000)
    cpu.mem_write(CODE, code)
    names = [getattr(arm_const, f"UC_ARM_REG_{name}") for name in ("R0", "R1", "R2", "R3", "R4", "R5", "SP", "LR")]
    chosen = random.Random(64)
    edges = [0, *(2**bit + by & ALL for bit in range(65) for by in (-1, 0, 1))]
    pairs = [(a, b) for a in edges[::3] for b in edges[1::5]]
    pairs += [(chosen.getrandbits(64), chosen.getrandbits(64) >> chosen.randrange(64)) for _ in range(2000)]
    for a, b in pairs:
        words = struct.unpack("<4I", struct.pack("<2Q", a, b))
        for name, value in zip(names, (*words, *KEPT, STACK, RETURN | 1), strict=True):
            cpu.reg_write(name, value)
        cpu.emu_start(CODE | 1, RETURN)
        low, high, _, _, *kept, stack, _ = (cpu.reg_read(name) for name in names)
        if (high << 32 | low, tuple(kept), stack) != (a * b & ALL, KEPT, STACK):
            return f"{a:#x} * {b:#x} = {high << 32 | low:#x}"
    return ""


def test_products_are_exact(tmp_path: Path) -> None:
    assert first_wrong(assemble(SOURCE.read_text(encoding="utf-8"), tmp_path)) == ""


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("adcs r1, r4", "adds r1, r1, r4"),
        ("lsrs r4, r2, #16", "asrs r4, r2, #16"),
        ("muls r3, r0, r3", "movs r3, #0"),
        ("pop  {r4, r5}", "add  sp, #8"),
    ],
)
def test_a_wrong_instruction_is_noticed(right: str, wrong: str, tmp_path: Path) -> None:
    text = SOURCE.read_text(encoding="utf-8")
    assert text.count(right) == 1, f"{SOURCE.name} has no longer one {right!r}"
    assert first_wrong(assemble(text.replace(right, wrong), tmp_path)) != ""
