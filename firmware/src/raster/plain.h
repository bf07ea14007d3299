/* Colours that need no light: of vertices, and of triangles in one colour, most of which have it in their mesh. */
#ifndef EL_RASTER_PLAIN_H
#define EL_RASTER_PLAIN_H

#include <stddef.h>

#include "base/rgb565.h"
#include "raster/list.h"
#include "raster/triangle.h"

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

/* What the records of a run have in common on a screen of some width, looked up where another run begins. */
typedef struct el_run_look {
    const el_draw_state *flat;   /* whose triangles are flat, with depth, their corners in their records; else NULL */
    const el_draw_state *thin;   /* the same, but for the corners: only their vertices have them; else NULL */
    const uint8_t (*colours)[3]; /* of its triangles, as they are drawn; NULL: see el_list_flat_colour */
    uint32_t last_corner;        /* of tiny triangles: y * 2^16 + x; 0 where the screen is too wide for them */
    uint16_t run;
} el_run_look;

/* Tiny triangles number the pixels of 17 rows with 14 bits (tiny_triangle.h). */
enum { EL_TINY_SCREEN = (1 << 14) / 17 };

static inline el_run_look el_look_at_run(const el_list *list, uint16_t name, int32_t width)
{
    el_run_look look = {.run = name};
    const el_run *const run = (const el_run *)el_list_at(list, name);
    const el_draw_state *const draw = (const el_draw_state *)el_list_at(list, run->draw);
    /* By its material and as it is shaded: a texture that is left out has a colour of its own. */
    if (draw->material->shading == EL_SHADE_FLAT && el_shading_of(draw) == EL_SHADE_FLAT &&
        (draw->material->flags & EL_MATERIAL_NO_DEPTH) == 0 && !el_is_drawn_apart(draw)) {
        if (EL_WITH_THIN && run->kind == EL_RECORD_THIN) {
            look.thin = draw;
        } else {
            look.flat = draw;
        }
        look.colours = el_is_lit(draw->material) ? NULL : draw->mesh->triangle_colours;
        look.last_corner = width <= EL_TINY_SCREEN ? (INT16_MAX << 16) + (uint32_t)(width * EL_SUBPIXELS) : 0U;
    }
    return look;
}

#ifdef __cplusplus
}
#endif

#endif
