// The UF2 file as it is dropped onto the board (github.com/microsoft/uf2): 512-byte blocks, of which the boot ROM takes
// those of the RP2040's family with 256 bytes each; and the boot ROM's own first steps (RP2040 data sheet, 2.8.1).

const BLOCK = 512;
const MAGIC_START = [0x0a324655, 0x9e5d5157];
const MAGIC_END = 0x0ab16f30;
const FAMILY_PRESENT = 0x2000;
const FAMILY_RP2040 = 0xe48bff56;
const PAYLOAD = 256;
const FLASH_BEGIN = 0x10000000;
export const FLASH_BYTES = 2 << 20; // the Pico's W25Q16JV

// {bytes, end}: the flash as it is after the file was copied, erased elsewhere, and the first byte after the image.
export function loadUf2(file) {
  if (file.length === 0 || file.length % BLOCK !== 0) {
    throw new Error(`${file.length} bytes are no UF2 file: not a multiple of ${BLOCK}`);
  }
  const bytes = new Uint8Array(FLASH_BYTES).fill(0xff);
  const total = file.length / BLOCK;
  let end = 0;
  for (let number = 0; number < total; number++) {
    const view = new DataView(file.buffer, file.byteOffset + number * BLOCK, BLOCK);
    const word = (index) => view.getUint32(4 * index, true);
    const magic = word(0) === MAGIC_START[0] && word(1) === MAGIC_START[1] && word(BLOCK / 4 - 1) === MAGIC_END;
    const family = (word(2) & FAMILY_PRESENT) !== 0 && word(7) === FAMILY_RP2040;
    const inFlash = word(3) % PAYLOAD === 0 && word(3) >= FLASH_BEGIN && word(3) < FLASH_BEGIN + FLASH_BYTES;
    const wrong =
      !magic ? 'no magic number'
      : !family ? 'not of the RP2040 family'
      : word(4) !== PAYLOAD ? `${word(4)} bytes instead of ${PAYLOAD}`
      : !inFlash ? 'not a page of the flash'
      : word(5) !== number || word(6) !== total ? 'out of order'
      : '';
    if (wrong) {
      throw new Error(`block ${number} of the UF2 file: ${wrong}`);
    }
    const offset = word(3) - FLASH_BEGIN;
    bytes.set(new Uint8Array(file.buffer, file.byteOffset + number * BLOCK + 32, PAYLOAD), offset);
    end = Math.max(end, offset + PAYLOAD);
  }
  return { bytes, end };
}

// CRC-32 as the boot ROM computes it: polynomial 04C11DB7, from ffffffff, most significant bit first, no final xor.
function bootCrc(bytes) {
  let crc = 0xffffffff;
  for (const byte of bytes) {
    crc ^= byte << 24;
    for (let bit = 0; bit < 8; bit++) {
      crc = (crc << 1) ^ (crc & 0x80000000 ? 0x04c11db7 : 0);
    }
  }
  return crc >>> 0;
}

// The boot ROM copies the first 256 bytes into the end of SRAM and enters them there, but only if their CRC is right.
export const BOOT2_AT = 0x20041f00;
export function boot2Of(flash) {
  const stage = flash.subarray(0, 256);
  const stored = new DataView(stage.buffer, stage.byteOffset, 256).getUint32(252, true);
  return { stage, good: bootCrc(stage.subarray(0, 252)) === stored };
}
