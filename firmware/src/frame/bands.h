/* Drawing the collected triangles into bands, and handing bands to the sinks. Internal to the frame layer. */
#ifndef EL_FRAME_BANDS_H
#define EL_FRAME_BANDS_H

#include "frame/renderer.h"

/* Counts a use of `bytes` of the list's memory in the peak. */
void el_bands_note_use(el_renderer *renderer, uint32_t bytes);

/* Draws every listed triangle into the pass' only band, which stays open, and empties the list. */
void el_bands_flush(el_renderer *renderer);

/* Draws the pass' bands and hands them over. */
void el_bands_finish(el_renderer *renderer);

#endif
