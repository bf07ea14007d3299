/* From a record of the display list back to what its triangle is set up from. Private to the renderer. */
#ifndef EL_RASTER_GATHER_H
#define EL_RASTER_GATHER_H

#include "raster/list.h"
#include "raster/plain.h"
#include "raster/triangle.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The colour of a mesh's vertex under the draw's light, 0..255 in 8.8. `turned`: seen from its back. */
void el_shade_vertex(const el_draw_state *draw, uint16_t vertex, bool turned, uint16_t rgb_q8[3]);

/* The colour of a flat triangle whose corners are in its record. */
uint16_t el_list_flat_colour(const el_draw_state *draw, const el_record *record);

/* The same, as they are looked at. */
static inline uint16_t el_flat_colour(const el_run_look *look, const el_record *record)
{
    if (look->colours == NULL) {
        return el_list_flat_colour(look->flat, record);
    }
    const uint8_t *const rgb = look->colours[record->index];
    return el_rgb565(rgb[0], rgb[1], rgb[2]);
}

#if EL_WITH_THIN
/* What a thin record would be if it were plain: with its corners, whose vertices are transformed anew. Of a draw without
 * textures. */
void el_list_make_whole(el_record *whole, const el_draw_state *draw, const el_record *thin);
#endif

/* What is needed to set up a record's triangle: its corners with all attributes, and its surface. Returns how many
 * vertices it transformed for that. */
unsigned el_list_gather(const el_list *list, const el_record *record, el_corner corners[3], el_surface *surface);

/* The same for its depth alone: corners without attributes, a flat surface in no colour. */
unsigned el_list_gather_depth(const el_list *list, const el_record *record, el_corner corners[3], el_surface *surface);

#ifdef __cplusplus
}
#endif

#endif
