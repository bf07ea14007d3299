/* Colours that need no light: of vertices, and of triangles in one colour, most of which have it in their mesh. */
#ifndef EL_RASTER_PLAIN_H
#define EL_RASTER_PLAIN_H

#include <stddef.h>

#include "base/rgb565.h"
#include "raster/list.h"

#ifdef __cplusplus
extern "C" {
#endif

static inline const uint8_t *el_base_colour(const el_draw_state *draw, uint16_t vertex)
{
    return draw->mesh->colours != NULL ? draw->mesh->colours[vertex] : draw->material->colour;
}

/* One colour for the triangle where it is not computed: its own, or that of its first vertex. NULL where it is lit, or its
 * vertices' mean. */
static inline const uint8_t *el_plain_colour(const el_draw_state *draw, uint16_t index)
{
    const el_mesh *const mesh = draw->mesh;
    if (EL_SMALL_CODE || el_is_lit(draw->material)) {
        return NULL;
    }
    if (mesh->triangle_colours != NULL) {
        return mesh->triangle_colours[index];
    }
    return (draw->material->flags & EL_MATERIAL_FLAT_MEAN) != 0 ? NULL
                                                                : el_base_colour(draw, mesh->triangles[index][0]);
}

/* The points of a record whose triangle is flat, in a colour that is not computed, with depth: they and *colour are all of
 * it. NULL for others. */
static inline const el_point *el_plain_points(const el_list *list, const el_record *record, uint16_t *colour)
{
    const el_run *const run = el_list_run(list, record);
    const el_draw_state *const draw = (const el_draw_state *)el_list_at(list, run->draw);
    /* The material's own shading: where a debug view leaves out a texture, the colour is to be found. */
    if (draw->material->shading != EL_SHADE_FLAT || el_shading_of(draw) != EL_SHADE_FLAT ||
        (draw->material->flags & EL_MATERIAL_NO_DEPTH) != 0 || (EL_WITH_THIN && run->kind == EL_RECORD_THIN)) {
        return NULL;
    }
    const uint8_t *const plain = el_plain_colour(draw, record->index);
    if (plain == NULL) {
        return NULL;
    }
    *colour = el_rgb565(plain[0], plain[1], plain[2]);
    return record->at.points;
}

#ifdef __cplusplus
}
#endif

#endif
