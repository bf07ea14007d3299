/* The first design of codec 2, which the present one is measured against: one pixel per delta token, green by -6..6; literals
 * 16 to a token, none named again; runs and copies of 24 lengths each, up to the line's width; skips of the same lengths. It
 * was measured by itself before the project began; here it takes the very frames that the present one gets. */
#ifndef EL_BENCH_CODEC_FIRST_H
#define EL_BENCH_CODEC_FIRST_H

#include <stdint.h>

/* Bytes of a frame's BAND packets before COBS. `known` is the frame that the host has, or NULL: all is sent; `unit` is what
 * is left out at least, in pixels, 64 or CODEC_WIDTH; lines refresh and refresh + 1 are sent whatever they are. */
uint32_t codec_first_bytes(const uint16_t *frame, const uint16_t *known, uint32_t unit, uint32_t refresh);

#endif
