/* A display's stripes as pixels.
 *
 * A pixel of an LCD is three stripes side by side, red, green and blue: light in thirds of a pixel. A frame for it is drawn as
 * one of three times the width, and each channel of a pixel is taken from where its stripe is. Edges then lie three times as
 * finely from left to right as without, by the same rule.
 *
 * Taken alone, a stripe beside an edge would colour it. So a channel is the mean of five stripes, its own in the middle, with
 * the weights 1, 2, 3, 2, 1: each stripe of the frame gives a third of its light to each of the three colours of the display,
 * so that a line of any width has no colour of its own, and what an edge has left is spread over a pixel and a half. Beyond the
 * screen's sides the last stripe goes on. */
#ifndef EL_RASTER_STRIPES_H
#define EL_RASTER_STRIPES_H

#include <stdbool.h>
#include <stdint.h>

#include "base/options.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { EL_STRIPES_PER_PIXEL = 3 };

#if EL_WITH_STRIPES

/* Makes three pixels of each, in place: `pixels` has room for three times as many. */
void el_stripes_cut(uint16_t *pixels, uint32_t count);

/* Makes one pixel of three in `lines` lines, in place, which then have `width` pixels each, one behind the other: the
 * means, each rounded to nearest, and the depths at their centres, which are those of the middle stripes. `blue_first`:
 * the stripes are blue, green, red. */
void el_stripes_filter(uint16_t *pixels, uint16_t *depth, uint32_t width, uint32_t lines, bool blue_first);

#endif

#ifdef __cplusplus
}
#endif

#endif
