/* What of a line is not as it was: a CRC-32 per segment, kept from one frame to the next.
 *
 * 32 bits, because hashes of 16 go wrong several times a minute; and a CRC, because the line's own CRC, which the digest
 * needs, follows from those of its segments: no pixel is looked at twice, and what was sent of a line that is no longer
 * there still has its CRC. */
#ifndef EL_STREAM_CHANGES_H
#define EL_STREAM_CHANGES_H

#include <stdint.h>

#include "stream/split.h"

#ifdef __cplusplus
extern "C" {
#endif

/* `segment`, in both, is EL_SPLIT_SEGMENT_PIXELS, or `width` for a whole line; the arrays have a CRC for each of a line's
 * segments, the last of which may be shorter. */

/* Computes a line's CRCs, `fresh`, and returns a bit for each that is not the one in `crcs`. */
uint32_t el_changes_find(const uint16_t *pixels, uint32_t width, uint32_t segment, const uint32_t *crcs,
                         uint32_t *fresh);

/* The CRC-32 of the line's little-endian pixels, of which this needs none. */
uint32_t el_changes_line_crc(const uint32_t *crcs, uint32_t width, uint32_t segment);

/* The digest of one line more. The product is what makes it one: CRCs of CRCs are linear, so two neighbouring lines that
 * are wrong alike, the lower one two pixels further to the left, would cancel out, and stale slanted edges are like that. */
uint32_t el_changes_digest(uint32_t digest, uint32_t line_crc);

#ifdef __cplusplus
}
#endif

#endif
