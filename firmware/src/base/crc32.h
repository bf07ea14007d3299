/* CRC-32 as zlib and PNG have it: polynomial 0x04C11DB7 reflected (0xEDB88320), initial value and final xor 0xFFFFFFFF.
 * Check value: "123456789" gives 0xCBF43926 (Williams, "A painless guide to CRC error detection algorithms"). */
#ifndef EL_BASE_CRC32_H
#define EL_BASE_CRC32_H

#include <stddef.h>
#include <stdint.h>

/* The CRC of all bytes so far, when `crc` is that of those before `bytes`; begin with 0. */
uint32_t el_crc32(uint32_t crc, const void *bytes, size_t count);

#endif
