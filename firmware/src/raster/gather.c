/* From a record of the display list back to its mesh: colours, light and texture coordinates of the corners. Light is
 * computed here, for triangles that are drawn, not for every vertex of the mesh. */
#include <stddef.h>

#include "base/rgb565.h"
#include "raster/list.h"

/* ambient + diffuse * max(0, normal . light), 0..255 in 8.8. */
static uint32_t light_q8(const el_draw_state *draw, const int8_t normal[3], bool turned)
{
    const el_light *const light = draw->material->light;
    int32_t dot = 0; /* 127 * 2^14 for a unit normal along the light; at most 3 * 2^7 * 2^14 */
    for (unsigned i = 0; i < 3; i++) {
        dot += normal[i] * draw->light_q14[i];
    }
    dot = turned ? -dot : dot;
    uint32_t value = (uint32_t)light->ambient << 8;
    if (dot > 0) {
        /* diffuse * 256 * dot / (127 * 2^14), in two steps that stay below 2^31 */
        value += (uint32_t)light->diffuse * ((uint32_t)dot >> 6) / 127U;
    }
    return value > 0xFF00U ? 0xFF00U : value;
}

static const uint8_t *base_colour(const el_draw_state *draw, uint16_t vertex)
{
    return draw->mesh->colours != NULL ? draw->mesh->colours[vertex] : draw->material->colour;
}

static bool is_lit(const el_draw_state *draw)
{
    return draw->material->light != NULL;
}

/* colour * light / 255, 8.8 */
static uint16_t lit_q8(uint32_t colour, uint32_t light)
{
    return (uint16_t)((colour * light + 127U) / 255U);
}

void el_shade_vertex(const el_draw_state *draw, uint16_t vertex, bool turned, uint16_t rgb_q8[3])
{
    const uint8_t *const colour = base_colour(draw, vertex);
    const uint32_t light = is_lit(draw) ? light_q8(draw, draw->mesh->normals[vertex], turned) : 0xFF00U;
    for (unsigned i = 0; i < 3; i++) {
        rgb_q8[i] = lit_q8(colour[i], light);
    }
}

/* One colour for the triangle: its own, or that of its first vertex, or its vertices' mean; lit alike. */
static uint16_t flat_colour(const el_draw_state *draw, uint16_t index, bool turned)
{
    const uint16_t *const vertices = draw->mesh->triangles[index];
    const bool mean = (draw->material->flags & EL_MATERIAL_FLAT_MEAN) != 0;
    const unsigned count = mean ? 3 : 1;
    uint32_t sums[3] = {0, 0, 0};
    for (unsigned i = 0; i < count; i++) {
        const uint8_t *const colour =
            draw->mesh->triangle_colours != NULL ? draw->mesh->triangle_colours[index] : base_colour(draw, vertices[i]);
        const uint32_t light = is_lit(draw) ? light_q8(draw, draw->mesh->normals[vertices[i]], turned) : 0xFF00U;
        for (unsigned channel = 0; channel < 3; channel++) {
            sums[channel] += lit_q8(colour[channel], light);
        }
    }
    uint8_t rgb[3];
    for (unsigned channel = 0; channel < 3; channel++) {
        rgb[channel] = (uint8_t)((sums[channel] / count + 128U) >> 8);
    }
    return el_rgb565(rgb[0], rgb[1], rgb[2]);
}

/* 1/w of the corners in one unit, the largest in [2^30, 2^31). */
static void gather_w(const el_record_perspective *record, el_corner corners[3])
{
    unsigned shifts[3];
    unsigned least = 31;
    for (unsigned i = 0; i < 3; i++) {
        shifts[i] = (record->w_shifts >> (5 * i)) & 31U;
        least = shifts[i] < least ? shifts[i] : least;
    }
    for (unsigned i = 0; i < 3; i++) {
        const uint32_t w = ((uint32_t)record->w[i] << 15) >> (shifts[i] - least);
        corners[i].w = w == 0 ? 1U : w;
    }
}

void el_list_gather(const el_list *list, const el_record *record, el_corner corners[3], el_surface *surface)
{
    const el_run *const run = el_list_at(list, record->run);
    const el_draw_state *const draw = &run->draw;
    const el_shading shading = (el_shading)draw->material->shading;
    surface->shading = shading;
    surface->depth = (draw->material->flags & EL_MATERIAL_NO_DEPTH) == 0 && shading != EL_SHADE_OVERDRAW;
    surface->dither = (draw->material->flags & EL_MATERIAL_DITHER) != 0;
    surface->texture = draw->material->texture;

    int32_t x[3];
    int32_t y[3];
    for (unsigned i = 0; i < 3; i++) {
        const el_point *const point = &record->at.points[i];
        x[i] = point->x;
        y[i] = point->y;
        corners[i].x = point->x;
        corners[i].y = point->y;
        corners[i].z = point->z;
    }
    const bool turned =
        (draw->material->flags & EL_MATERIAL_TWO_SIDED) != 0 && el_shows_back(draw, el_doubled_area(x, y));

    if (run->kind != EL_RECORD_PLAIN) {
        gather_w((const el_record_perspective *)(const void *)record, corners);
    }
    if (shading == EL_SHADE_FLAT) {
        surface->colour = flat_colour(draw, record->index, turned);
        return;
    }
    const bool textured = shading == EL_SHADE_TEXTURED || shading == EL_SHADE_TEXTURED_GOURAUD;
    const bool coloured = shading == EL_SHADE_GOURAUD || shading == EL_SHADE_TEXTURED_GOURAUD;
    for (unsigned i = 0; i < 3; i++) {
        if (run->kind == EL_RECORD_CLIPPED) {
            const el_attributes *const own = &((const el_record_clipped *)(const void *)record)->attributes[i];
            corners[i].u_q16 = own->u_q16;
            corners[i].v_q16 = own->v_q16;
            for (unsigned channel = 0; channel < 3; channel++) {
                corners[i].rgb_q8[channel] = own->rgb_q8[channel];
            }
            continue;
        }
        const uint16_t vertex = draw->mesh->triangles[record->index][i];
        if (textured) {
            corners[i].u_q16 = draw->mesh->uvs[vertex][0] * (1 << 12);
            corners[i].v_q16 = draw->mesh->uvs[vertex][1] * (1 << 12);
        }
        if (coloured) {
            el_shade_vertex(draw, vertex, turned, corners[i].rgb_q8);
        }
    }
}
