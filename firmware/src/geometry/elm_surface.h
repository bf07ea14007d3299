/* The last section of an .elm of version 2 (elm.h): material and picture. Private to the reader. */
#ifndef EL_GEOMETRY_ELM_SURFACE_H
#define EL_GEOMETRY_ELM_SURFACE_H

#include "geometry/elm.h"

#if EL_WITH_MIXED

enum { EL_ELM_SURFACE_HEAD = 12 };

/* The size of the section without its padding, by its first EL_ELM_SURFACE_HEAD bytes and the logarithms of the picture's
 * sides, each 0..10. 0 when they contradict each other. */
uint32_t el_elm_surface_bytes(const uint8_t *section, unsigned width_log2, unsigned height_log2);

/* Makes `surface` views of a section of that size; false, and nothing is written, when a byte of its padding is not 0. */
bool el_elm_surface_open(const uint8_t *section, unsigned width_log2, unsigned height_log2, el_elm_surface *surface);

#endif
#endif
