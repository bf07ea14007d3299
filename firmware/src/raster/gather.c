/* From a record of the display list back to its mesh: colours, light and texture coordinates of the corners. Light is
 * computed here, for triangles that are drawn, not for every vertex of the mesh. */
#include "raster/gather.h"

#include <stddef.h>
#include <string.h>

#include "base/fixed.h"
#include "base/rgb565.h"
#include "raster/plain.h"
#include "raster/texture.h"

/* n / 127, n < 2^25. */
static inline uint32_t by_127(uint32_t n)
{
#if defined(EL_PRODUCTS_IN_HALVES)
    /* Without a division: with n = 128 q + r = 127 q + (q + r), n / 127 is q + (q + r) / 127; and (q + r) is below 2^19, then
     * below 2^13, then 192. */
    uint32_t quotient = n >> 7;
    uint32_t rest = quotient + (n & 127U);
    quotient += rest >> 7;
    rest = (rest >> 7) + (rest & 127U);
    quotient += rest >> 7;
    rest = (rest >> 7) + (rest & 127U);
    return quotient + (rest + 1U >= 128U);
#else
    return n / 127U;
#endif
}

/* ambient + diffuse * max(0, normal . light), 0..255 in 8.8, of that scalar product: 127 * 2^14 for a unit normal along the
 * light; at most 3 * 2^7 * 2^14. */
static inline uint32_t light_of_dot_q8(int32_t dot, uint32_t ambient, uint32_t diffuse)
{
    uint32_t value = ambient << 8;
    if (dot > 0) {
        /* diffuse * 256 * dot / (127 * 2^14), in two steps that stay below 2^31: 255 * 98304 at most */
        value += by_127(diffuse * ((uint32_t)dot >> 6));
    }
    return value > 0xFF00U ? 0xFF00U : value;
}

/* colour * light / 255, 8.8. Thumb-2 divides by a long product. Others without: with n = 256 q + r = 255 q + (q + r), n / 255
 * is q + (q + r) / 255, and (q + r) <= 65280. */
static uint16_t lit_q8(uint32_t colour, uint32_t light)
{
    const uint32_t n = colour * light + 127U;
#if EL_SMALL_CODE || defined(__thumb2__)
    return (uint16_t)(n / 255U);
#else
    const uint32_t rest = (n >> 8) + (n & 255U);
    return (uint16_t)((n >> 8) + ((rest + 1U + (rest >> 8)) >> 8));
#endif
}

/* What lit_q8 makes of a light of 255: n / 255 = 256 colour for n = 255 * 256 colour + 127. */
static inline void take_colour(const uint8_t colour[3], uint16_t rgb_q8[3])
{
    rgb_q8[0] = (uint16_t)(colour[0] << 8);
    rgb_q8[1] = (uint16_t)(colour[1] << 8);
    rgb_q8[2] = (uint16_t)(colour[2] << 8);
}

static uint32_t light_q8(const el_draw_state *draw, const int8_t normal[3], bool turned)
{
    const el_light *const light = draw->material->light;
    int32_t dot = 0;
    for (unsigned i = 0; i < 3; i++) {
        dot += normal[i] * draw->light_q14[i];
    }
    return light_of_dot_q8(turned ? -dot : dot, light->ambient, light->diffuse);
}

/* Three channels of 8.8 for one of the mesh's vertices. */
static void shade(const el_draw_state *draw, const uint8_t colour[3], uint16_t vertex, bool turned, uint16_t rgb_q8[3])
{
    if (!EL_SMALL_CODE && !el_is_lit(draw->material)) {
        take_colour(colour, rgb_q8);
        return;
    }
    const uint32_t light = el_is_lit(draw->material) ? light_q8(draw, draw->mesh->normals[vertex], turned) : 0xFF00U;
    for (unsigned i = 0; i < 3; i++) {
        rgb_q8[i] = lit_q8(colour[i], light);
    }
}

void el_shade_vertex(const el_draw_state *draw, uint16_t vertex, bool turned, uint16_t rgb_q8[3])
{
    shade(draw, el_base_colour(draw, vertex), vertex, turned, rgb_q8);
}

/* Whether a two-sided triangle shows its back to the light. */
static bool is_turned(const el_draw_state *draw, const el_corner corners[3])
{
    if (!el_is_lit(draw->material) || (draw->material->flags & EL_MATERIAL_TWO_SIDED) == 0) {
        return false;
    }
    const int32_t x[3] = {corners[0].x, corners[1].x, corners[2].x};
    const int32_t y[3] = {corners[0].y, corners[1].y, corners[2].y};
    return el_shows_back(draw, el_doubled_area(x, y));
}

/* One colour for the triangle: its own, or that of its first vertex, or its vertices' mean; lit alike. */
static EL_APART uint16_t flat_colour(const el_draw_state *draw, uint16_t index, const el_corner corners[3])
{
    const unsigned count = (draw->material->flags & EL_MATERIAL_FLAT_MEAN) != 0 ? 3 : 1;
    const bool turned = is_turned(draw, corners);
    const uint16_t *const vertices = draw->mesh->triangles[index];
    uint32_t sums[3] = {0, 0, 0};
    for (unsigned i = 0; i < count; i++) {
        uint16_t rgb_q8[3];
        shade(draw,
              draw->mesh->triangle_colours != NULL ? draw->mesh->triangle_colours[index]
                                                   : el_base_colour(draw, vertices[i]),
              vertices[i], turned, rgb_q8);
        for (unsigned channel = 0; channel < 3; channel++) {
            sums[channel] += rgb_q8[channel];
        }
    }
    uint8_t rgb[3];
    for (unsigned channel = 0; channel < 3; channel++) {
        rgb[channel] = (uint8_t)((sums[channel] / count + 128U) >> 8);
    }
    return el_rgb565(rgb[0], rgb[1], rgb[2]);
}

/* 1/w of the corners in one unit, the largest in [2^30, 2^31), from w * 2^-shift of each. */
static void scale_reciprocals(el_corner corners[3], const uint16_t w[3], const uint8_t shifts[3])
{
    const int32_t least = el_min3_i32(shifts[0], shifts[1], shifts[2]);
    for (unsigned i = 0; i < 3; i++) {
        const uint32_t scaled = ((uint32_t)w[i] << 15) >> (shifts[i] - least);
        corners[i].w = scaled == 0 ? 1U : scaled;
    }
}

/* Where the corners of a thin record are, as its vertices would have been listed. */
static EL_APART void find_points(const el_draw_state *draw, const el_record *record, el_corner corners[3])
{
    uint16_t w[3];
    uint8_t shifts[3];
    for (unsigned i = 0; i < 3; i++) {
        el_screen_vertex v;
        el_transform_vertex(&draw->transform, draw->mesh->positions[draw->mesh->triangles[record->index][i]], &v);
        corners[i].x = v.x;
        corners[i].y = v.y;
        corners[i].z = v.z;
        w[i] = v.w;
        shifts[i] = v.w_shift;
    }
    if (el_has_texture(el_shading_of(draw))) {
        scale_reciprocals(corners, w, shifts);
    }
}

#if EL_WITH_THIN
void el_list_make_whole(el_record *whole, const el_draw_state *draw, const el_record *thin)
{
    const uint16_t *const vertices = draw->mesh->triangles[thin->index];
    *whole = (el_record){.run = thin->run, .index = thin->index};
    for (unsigned i = 0; i < 3; i++) {
        el_screen_vertex v;
        el_transform_vertex(&draw->transform, draw->mesh->positions[vertices[i]], &v);
        whole->at.points[i] = (el_point){.x = v.x, .y = v.y, .z = v.z};
    }
}
#endif

static inline void take_point(el_corner *corner, const el_point *point)
{
    corner->x = point->x;
    corner->y = point->y;
    corner->z = point->z;
}

/* 1/w of the corners of a textured record. */
static EL_APART void gather_reciprocals(const el_record *record, el_corner corners[3])
{
    const el_record_perspective *const perspective = (const el_record_perspective *)(const void *)record;
    uint8_t shifts[3];
    for (unsigned i = 0; i < 3; i++) {
        shifts[i] = (perspective->w_shifts >> (5 * i)) & 31U;
    }
    scale_reciprocals(corners, perspective->w, shifts);
}

/* Where the corners are; of textured ones 1/w. */
static inline void gather_points(const el_record *record, el_record_kind kind, el_corner corners[3])
{
    if (EL_SMALL_CODE) {
        for (unsigned i = 0; i < 3; i++) {
            take_point(&corners[i], &record->at.points[i]);
        }
    } else {
        take_point(&corners[0], &record->at.points[0]);
        take_point(&corners[1], &record->at.points[1]);
        take_point(&corners[2], &record->at.points[2]);
    }
    if (EL_WITH_TEXTURE && kind >= EL_RECORD_PERSPECTIVE) {
        gather_reciprocals(record, corners);
    }
}

#if !EL_SMALL_CODE
uint16_t el_list_flat_colour(const el_draw_state *draw, const el_record *record)
{
    const uint8_t *const plain = el_plain_colour(draw, record->index);
    if (plain != NULL) {
        return el_rgb565(plain[0], plain[1], plain[2]);
    }
    el_corner corners[3];
    gather_points(record, EL_RECORD_PLAIN, corners);
    return flat_colour(draw, record->index, corners);
}
#endif

/* Texture coordinates and colours of the corners: a cut triangle's own, or its vertices'. */
static EL_APART void gather_attributes(const el_draw_state *draw, const el_record *record, el_record_kind kind,
                                       el_corner corners[3])
{
    const el_shading shading = el_shading_of(draw);
    const bool turned = is_turned(draw, corners);
    for (unsigned i = 0; i < 3; i++) {
        el_corner *const corner = &corners[i];
        if (kind == EL_RECORD_CLIPPED) {
            const el_attributes *const own = &((const el_record_clipped *)(const void *)record)->attributes[i];
            corner->u_q16 = own->u_q16;
            corner->v_q16 = own->v_q16;
            memcpy(corner->rgb_q8, own->rgb_q8, sizeof corner->rgb_q8);
            continue;
        }
        const uint16_t vertex = draw->mesh->triangles[record->index][i];
        if (el_has_texture(shading)) {
            corner->u_q16 = draw->mesh->uvs[vertex][0] * (1 << 12);
            corner->v_q16 = draw->mesh->uvs[vertex][1] * (1 << 12);
        }
        if (el_has_colours(shading)) {
            el_shade_vertex(draw, vertex, turned, corner->rgb_q8);
        }
    }
}

#if !EL_SMALL_CODE
/* Colours alone, of the mesh's vertices: with the light at hand for all three. */
static EL_APART void gather_colours(const el_draw_state *draw, uint16_t index, el_corner corners[3])
{
    const el_mesh *const mesh = draw->mesh;
    const uint16_t *const vertices = mesh->triangles[index];
    if (!el_is_lit(draw->material)) {
        for (unsigned i = 0; i < 3; i++) {
            take_colour(el_base_colour(draw, vertices[i]), corners[i].rgb_q8);
        }
        return;
    }
    const el_light *const light = draw->material->light;
    const uint32_t ambient = light->ambient;
    const uint32_t diffuse = light->diffuse;
    const int32_t side = is_turned(draw, corners) ? -1 : 1;
    const int32_t x_q14 = draw->light_q14[0] * side;
    const int32_t y_q14 = draw->light_q14[1] * side;
    const int32_t z_q14 = draw->light_q14[2] * side;
    for (unsigned i = 0; i < 3; i++) {
        const uint8_t *const colour = el_base_colour(draw, vertices[i]);
        const int8_t *const normal = mesh->normals[vertices[i]];
        const uint32_t value =
            light_of_dot_q8(normal[0] * x_q14 + normal[1] * y_q14 + normal[2] * z_q14, ambient, diffuse);
        uint16_t *const rgb_q8 = corners[i].rgb_q8;
        rgb_q8[0] = lit_q8(colour[0], value);
        rgb_q8[1] = lit_q8(colour[1], value);
        rgb_q8[2] = lit_q8(colour[2], value);
    }
}
#endif

#if EL_WITH_MIPMAPS
/* With the texture of which the triangle has less than two texels per pixel, in whose texels its coordinates are then. */
static EL_APART void choose_level(const el_texture *texture, el_corner corners[3], el_surface *surface)
{
    const int level = (int)el_mip_level(texture, corners);
    for (unsigned i = 0; i < 3; i++) {
        corners[i].u_q16 >>= level;
        corners[i].v_q16 >>= level;
    }
    if (el_is_mixed(surface)) {
        surface->level = (uint8_t)level;
    } else {
        surface->texture = el_texture_at_level(texture, (unsigned)level);
    }
}
#endif

unsigned el_list_gather(const el_list *list, const el_record *record, el_corner corners[3], el_surface *surface)
{
    const el_run *const run = el_list_run(list, record);
    const el_record_kind kind = (el_record_kind)run->kind;
    const el_draw_state *const draw = (const el_draw_state *)el_list_at(list, run->draw);
    const el_material *const material = draw->material;
    const el_shading shading = el_shading_of(draw);
    surface->shading = shading;
    surface->depth = (material->flags & EL_MATERIAL_NO_DEPTH) == 0 && shading != EL_SHADE_OVERDRAW;
    surface->finish = (uint8_t)el_finish_of(draw, shading);
    surface->texture = material->texture;
    if (el_is_mixed(surface)) {
        surface->material = material;
        surface->level = 0;
    }

    const uint8_t *const plain = shading == EL_SHADE_FLAT ? el_plain_colour(draw, record->index) : NULL;
    if (plain != NULL) {
        surface->colour = el_rgb565(plain[0], plain[1], plain[2]);
    }
    if (EL_WITH_THIN && kind == EL_RECORD_THIN) {
        find_points(draw, record, corners);
    } else {
        gather_points(record, kind, corners);
    }
    if (plain == NULL) {
        if (shading == EL_SHADE_FLAT) {
            surface->colour = flat_colour(draw, record->index, corners);
#if !EL_SMALL_CODE
        } else if (shading == EL_SHADE_GOURAUD && kind != EL_RECORD_CLIPPED) {
            gather_colours(draw, record->index, corners);
#endif
        } else if (el_has_texture(shading) || el_has_colours(shading)) {
            gather_attributes(draw, record, kind, corners);
#if EL_WITH_MIPMAPS
            if (el_has_texture(shading) && material->texture->smaller != NULL) {
                choose_level(material->texture, corners, surface);
            }
#endif
        }
    }
    return EL_WITH_THIN && kind == EL_RECORD_THIN ? 3U : 0U;
}

unsigned el_list_gather_depth(const el_list *list, const el_record *record, el_corner corners[3], el_surface *surface)
{
    const el_record_kind kind = (el_record_kind)el_list_run(list, record)->kind;
    const el_draw_state *const draw = el_list_draw(list, record);
    *surface = (el_surface){
        .shading = EL_SHADE_FLAT,
        .depth = (draw->material->flags & EL_MATERIAL_NO_DEPTH) == 0 && el_shading_of(draw) != EL_SHADE_OVERDRAW &&
                 !el_is_drawn_apart(draw),
    };
    if (!surface->depth) {
        return 0U;
    }
    if (EL_WITH_THIN && kind == EL_RECORD_THIN) {
        find_points(draw, record, corners);
        return 3U;
    }
    gather_points(record, EL_RECORD_PLAIN, corners);
    return 0U;
}
