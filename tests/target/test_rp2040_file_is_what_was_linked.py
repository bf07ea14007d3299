"""The file that goes onto a Pico: its blocks hold the program and nothing else, the boot stage's CRC is the one that
the boot ROM wants, the vectors lead where they should, and the memory is used as promised."""

from __future__ import annotations

import struct
import subprocess
import sys
import zlib
from pathlib import Path

import pytest

from needs import need_tool
from target_tools import REPOSITORY, Image, build_board

MAKE_UF2 = REPOSITORY / "firmware/boards/rp2040/make_uf2.py"
FLASH, RAM = 0x1000_0000, 0x2000_0000
VECTORS = 0x100
IRQ_TIMER_0, IRQ_DMA_0, IRQ_UART0, IRQ_COUNT = 0, 11, 20, 26
BLOCK = struct.Struct("<8I476sI")


@pytest.fixture(scope="module")
def image() -> Image:
    """The Pico's demo as it is flashed."""
    return build_board("rp2040")


@pytest.fixture(scope="module")
def symbols(image: Image) -> dict[str, int]:
    """Address of each symbol."""
    nm = need_tool("arm-none-eabi-nm", "binutils-arm-none-eabi")
    lines = subprocess.run([nm, str(image.elf)], capture_output=True, text=True, check=True).stdout.splitlines()
    return {words[2]: int(words[0], 16) for words in map(str.split, lines) if len(words) == 3}


def linked(image: Image) -> bytes:
    """What the linker put into flash, by a tool that is not ours: objcopy."""
    return image.elf.with_suffix(".bin").read_bytes()


def decode_uf2(file: bytes) -> bytes:
    """Contents of the flash from its beginning; fails where a boot ROM would ignore or misplace a block."""
    assert len(file) % BLOCK.size == 0
    count = len(file) // BLOCK.size
    contents = bytearray()
    for number, block in enumerate(BLOCK.iter_unpack(file)):
        *header, payload, end = block
        assert header == [
            0x0A324655,
            0x9E5D5157,
            0x2000,
            FLASH + 256 * number,
            256,
            number,
            count,
            0xE48BFF56,
        ]
        assert end == 0x0AB16F30
        assert payload[256:] == bytes(220)
        contents += payload[:256]
    return bytes(contents)


def boot_crc(code: bytes) -> int:
    """CRC-32 from the most significant bit on, by zlib, which begins with the least significant one: mirrored bytes in,
    a mirrored CRC out, and zlib's final inversion taken back."""
    mirrored = bytes(int(f"{byte:08b}"[::-1], 2) for byte in code)
    return int(f"{zlib.crc32(mirrored) ^ 0xFFFF_FFFF:032b}"[::-1], 2)


def make_uf2(*arguments: Path) -> subprocess.CompletedProcess[str]:
    """Runs the script that writes the file."""
    command = [sys.executable, str(MAKE_UF2), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)


def test_the_file_holds_the_program_and_zeros(image: Image) -> None:
    flash = decode_uf2(image.uf2.read_bytes())
    program = linked(image)
    assert flash[: len(program)] == program
    assert flash[len(program) :] == bytes(len(flash) - len(program))
    assert len(flash) - len(program) < 256


@pytest.mark.parametrize("at", [0, 8, 12, 20, 24, 28, 32 + 255, 32 + 300, 508])
def test_a_changed_byte_is_noticed(image: Image, at: int) -> None:
    """The test above can fail: one bit of each part of the second block."""
    file = bytearray(image.uf2.read_bytes())
    file[BLOCK.size + at] ^= 1
    program = linked(image)
    with pytest.raises(AssertionError):
        assert decode_uf2(bytes(file))[: len(program)] == program


def test_the_boot_rom_accepts_the_boot_stage(image: Image) -> None:
    stage = linked(image)[:256]
    assert int.from_bytes(stage[252:], "little") == boot_crc(stage[:252])


def test_a_boot_stage_with_a_wrong_crc_is_refused(image: Image, tmp_path: Path) -> None:
    elf = bytearray(image.elf.read_bytes())
    at = elf.index(linked(image)[:256])
    right = boot_crc(bytes(elf[at : at + 252]))
    elf[at + 252] ^= 1
    broken = tmp_path / "broken.elf"
    broken.write_bytes(elf)
    done = make_uf2(broken, tmp_path / "broken.uf2")
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert f"write {right:#010x}" in done.stderr
    assert not (tmp_path / "broken.uf2").exists()


@pytest.mark.parametrize(
    ("contents", "says"), [(b"no ELF at all", "no 32-bit little-endian ELF"), (None, "No such file")]
)
def test_what_is_no_program_is_refused(contents: bytes | None, says: str, tmp_path: Path) -> None:
    source = tmp_path / "program.elf"
    if contents is not None:
        source.write_bytes(contents)
    done = make_uf2(source, tmp_path / "program.uf2")
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert str(source) in done.stderr and says in done.stderr


def test_the_vectors_lead_to_the_handlers(image: Image, symbols: dict[str, int]) -> None:
    stack, reset, *handlers = struct.unpack_from(f"<{16 + IRQ_COUNT}I", linked(image), VECTORS)
    assert stack == symbols["el_stack_end"]
    assert reset & 1 and FLASH <= reset < RAM
    expected = dict.fromkeys(range(2, 16 + IRQ_COUNT), symbols["el_fault_entry"])
    expected[15] = symbols["el_systick_entry"]
    expected[16 + IRQ_TIMER_0] = symbols["el_pico_timer_interrupt"]
    expected[16 + IRQ_DMA_0] = symbols["el_pico_display_interrupt"]
    expected[16 + IRQ_UART0] = symbols["el_pico_link_interrupt"]
    assert dict(enumerate(handlers, 2)) == {number: address | 1 for number, address in expected.items()}


def test_a_quarter_of_the_ram_is_used_at_most(symbols: dict[str, int]) -> None:
    assert RAM < symbols["el_stack_begin"] < symbols["el_stack_end"] <= RAM + 64 * 1024


def test_what_runs_per_pixel_is_in_ram_and_what_starts_it_is_not(symbols: dict[str, int]) -> None:
    hot = "draw_pass el_triangle_setup el_triangle_draw el_spans_next el_divide_q32 el_texture_walk_piece el_crc32"
    for name in hot.split():
        assert symbols["el_data_begin"] <= symbols[name] < symbols["el_data_end"], name
    for name in ("memcpy", "main"):
        assert FLASH <= symbols[name] < RAM, name


@pytest.mark.parametrize(
    ("variable", "value", "says"),
    [
        ("EDGELINE_PANEL", "st7799", "one of ili9341, st7789, st7789-240x240, st7735, ssd1306, ssd0323"),
        ("EDGELINE_ROTATION", "45", "one of 0, 90, 180, 270"),
    ],
)
def test_a_display_that_is_not_there_is_refused(variable: str, value: str, says: str, tmp_path: Path) -> None:
    need_tool("arm-none-eabi-gcc", "gcc-arm-none-eabi")
    command = ["cmake", "--preset", "rp2040", "-B", str(tmp_path), f"-D{variable}={value}"]
    done = subprocess.run(command, cwd=REPOSITORY, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode != 0
    assert says in " ".join(done.stderr.split()) and variable in done.stderr
