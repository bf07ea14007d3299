#include "raster/field.h"

#include "base/fixed.h"

#if EL_WITH_INTERLACED

static void double_plane(el_plane *plane)
{
    plane->dy *= 2U; /* modulo 2^64, as its steps are */
}

static void double_edge(el_edge *edge)
{
    edge->step_q32 *= 2; /* below 2^45 */
}

/* From rows of the screen to lines of the field, in one of which its next row is. */
static void take_every_other_row(el_triangle *triangle, unsigned field)
{
    triangle->y = (int16_t)el_field_row(field, triangle->y);
    triangle->y_end = (int16_t)el_field_row(field, triangle->y_end);
    if (triangle->y_middle != INT16_MAX) {
        const int32_t middle = el_field_row(field, triangle->y_middle);
        if (el_screen_row(field, middle) != triangle->y_middle) {
            el_edge_next_row(&triangle->lower);
        }
        triangle->y_middle = (int16_t)(middle < triangle->y_end ? middle : INT16_MAX);
        double_edge(&triangle->lower);
    }
    double_edge(&triangle->left);
    double_edge(&triangle->right);
    triangle->edges_are_short = false; /* a doubled step needs more bits than those have */
    if (triangle->surface.depth) {
        double_plane(&triangle->z);
    }
    if (el_has_colours(triangle->surface.shading)) {
        for (unsigned i = 0; i < 3; i++) {
            triangle->rgb[i].dy *= 2U;
        }
    }
    if (el_has_texture(triangle->surface.shading)) {
        double_plane(&triangle->perspective.w);
        double_plane(&triangle->perspective.u);
        double_plane(&triangle->perspective.v);
    }
}

bool el_field_setup(el_triangle *triangle, const el_corner corners[3], const el_surface *surface, int32_t first_line,
                    unsigned field)
{
    const int32_t top = el_first_centre(el_min3_i32(corners[0].y, corners[1].y, corners[2].y));
    const int32_t line = el_max_i32(first_line, el_field_row(field, top));
    if (!el_triangle_setup(triangle, corners, surface, el_screen_row(field, line))) {
        return false;
    }
    take_every_other_row(triangle, field);
    return true;
}

#endif
