/* What of a line is not as it was: a CRC-32 per segment, kept from one frame to the next.
 *
 * 32 bits, because hashes of 16 go wrong several times a minute; and a CRC, because the line's own CRC, which the digest
 * needs, follows from those of its segments: no pixel is looked at twice. */
#ifndef EL_STREAM_CHANGES_H
#define EL_STREAM_CHANGES_H

#include <stdint.h>

#include "stream/split.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Compares a line's segments with `crcs`, one for each, and writes them there. `segment` is EL_SPLIT_SEGMENT_PIXELS, or
 * `width` for a whole line. Returns a bit for each segment that has changed; `*line_crc` is the CRC-32 of the line's
 * little-endian pixels. */
uint32_t el_changes_find(const uint16_t *pixels, uint32_t width, uint32_t segment, uint32_t *crcs, uint32_t *line_crc);

#ifdef __cplusplus
}
#endif

#endif
