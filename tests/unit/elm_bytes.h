/* Bytes of an ELM file that a test makes by hand. */
#ifndef EL_TEST_ELM_BYTES_H
#define EL_TEST_ELM_BYTES_H

#include <stddef.h>
#include <stdint.h>

#include "base/crc32.h"

/* The `bytes` lowest bytes of `value`, the lowest first. */
static inline void elm_put(uint8_t *file, size_t at, uint32_t value, size_t bytes)
{
    for (size_t i = 0; i < bytes; i++) {
        file[at + i] = (uint8_t)(value >> (8 * i));
    }
}

/* Makes the header's CRC right for a file of `size` bytes. */
static inline void elm_seal(uint8_t *file, size_t size)
{
    elm_put(file, 12, el_crc32(0, file + 16, size - 16), 4);
}

#endif
