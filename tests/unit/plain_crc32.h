/* CRC-32 by its definition, bit by bit: what tests hold against base/crc32, and what their hosts count with. */
#ifndef EL_TEST_PLAIN_CRC32_H
#define EL_TEST_PLAIN_CRC32_H

#include <stddef.h>
#include <stdint.h>

static inline uint32_t plain_crc32(const uint8_t *bytes, size_t count)
{
    uint32_t crc = 0xFFFFFFFF;
    for (size_t i = 0; i < count; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++) {
            crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xEDB88320 : 0);
        }
    }
    return ~crc;
}

#endif
