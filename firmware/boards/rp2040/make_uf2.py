#!/usr/bin/env python3
"""Write the UF2 file of an RP2040 program: `make_uf2.py PROGRAM.elf PROGRAM.uf2`.

The boot ROM's drive takes files of 512-byte blocks, each of which says where its 256 bytes of flash go (RP2040 data
sheet, 2.8.4.2, and Microsoft's UF2 specification):

    offset size
         0    4  magic 0A324655h
         4    4  magic 9E5D5157h
         8    4  flags: 2000h, a family follows at 28
        12    4  address, a multiple of 256
        16    4  bytes of payload: 256
        20    4  number of this block
        24    4  number of blocks
        28    4  family: E48BFF56h, RP2040
        32  476  payload, padded with zeros
       508    4  magic 0AB16F30h

The program's first 256 bytes are the boot stage. The ROM does not start it when its CRC is wrong, so such a program is
refused here. Status 2 and one line on stderr when the program cannot be written.
"""

import struct
import sys
from pathlib import Path

FLASH_BEGIN, FLASH_END = 0x1000_0000, 0x1020_0000
PAYLOAD = 256
MAGICS = 0x0A32_4655, 0x9E5D_5157, 0x0AB1_6F30
FLAG_FAMILY = 0x2000
FAMILY_RP2040 = 0xE48B_FF56
ELF_LOAD = 1


class ProgramError(Exception):
    """The program cannot be put onto a board; the text says why."""


def boot_crc(code: bytes | bytearray) -> int:
    """The CRC that the boot ROM compares: polynomial 04C11DB7h, most significant bit first, no final inversion."""
    crc = 0xFFFF_FFFF
    for byte in code:
        crc ^= byte << 24
        for _ in range(8):
            crc = (crc << 1 ^ (0x04C1_1DB7 if crc & 0x8000_0000 else 0)) & 0xFFFF_FFFF
    return crc


def flash_contents(elf: bytes) -> bytes:
    """What the flash holds from its beginning on: all that the program headers load, at the addresses of the file."""
    if elf[:6] != b"\x7fELF\x01\x01":
        raise ProgramError("it is no 32-bit little-endian ELF file")
    (table,) = struct.unpack_from("<I", elf, 28)
    entry_bytes, entries = struct.unpack_from("<HH", elf, 42)
    flash = bytearray()
    for i in range(entries):
        kind, offset, _, address, count = struct.unpack_from("<5I", elf, table + i * entry_bytes)
        if kind != ELF_LOAD or count == 0:
            continue
        if not FLASH_BEGIN <= address <= address + count <= FLASH_END:
            raise ProgramError(f"{count} bytes at {address:#010x} are not in the flash: check the linker script")
        begin = address - FLASH_BEGIN
        flash.extend(bytes(max(0, begin + count - len(flash))))
        flash[begin : begin + count] = elf[offset : offset + count]
    if len(flash) < PAYLOAD:
        raise ProgramError("there is no boot stage at the beginning of the flash")
    wanted, found = boot_crc(flash[:252]), int.from_bytes(flash[252:256], "little")
    if wanted != found:
        raise ProgramError(f"the boot stage ends in {found:#010x} and must end in its CRC: write {wanted:#010x} there")
    return bytes(flash)


def uf2_blocks(flash: bytes) -> bytes:
    """The file that puts `flash` at the beginning of the flash."""
    pages = [flash[at : at + PAYLOAD].ljust(PAYLOAD, b"\0") for at in range(0, len(flash), PAYLOAD)]
    return b"".join(
        struct.pack(
            "<8I476sI",
            *(MAGICS[0], MAGICS[1], FLAG_FAMILY, FLASH_BEGIN + number * PAYLOAD, PAYLOAD, number, len(pages)),
            *(FAMILY_RP2040, page, MAGICS[2]),
        )
        for number, page in enumerate(pages)
    )


def main(arguments: list[str]) -> int:
    """The command line; returns the exit status."""
    if len(arguments) != 2:
        print("usage: make_uf2.py PROGRAM.elf PROGRAM.uf2", file=sys.stderr)
        return 2
    source, target = map(Path, arguments)
    try:
        target.write_bytes(uf2_blocks(flash_contents(source.read_bytes())))
    except (ProgramError, OSError, struct.error) as error:
        print(f"make_uf2.py: {source}: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
