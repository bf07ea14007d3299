/* el_draw: from a mesh to records on the display list. */
#include <string.h>

#include "base/fixed.h"
#include "frame/bands.h"
#include "frame/debug_hooks.h"
#include "geometry/clip.h"

/* The mesh's vertices on the screen, at the end of the list's memory. `direct`: all of them, each transformed once
 * before the triangles are looked at. Otherwise a direct-mapped cache, for meshes that do not fit: a vertex is
 * transformed when a triangle asks for it and may be asked for again after another took its place. */
typedef struct cached_vertex {
    uint16_t index; /* 0xFFFF: none; meshes have at most 65535 vertices */
    el_screen_vertex vertex;
} cached_vertex;

/* Attributes of corners that are cut. */
enum { U, V, RGB };

typedef struct drawing {
    el_renderer *renderer;
    const el_mesh *mesh;
    bool direct;
    el_record_kind kind;     /* of its triangles */
    el_record_kind cut_kind; /* of those that are cut */
    uint32_t slots;          /* of the cache, a power of two */
    void *vertices;          /* el_screen_vertex[] or cached_vertex[] */
    el_draw_state state;
} drawing;

static void transform_one(const drawing *d, uint16_t index, el_screen_vertex *screen)
{
#if EL_SMALL_CODE
    el_transform_vertex(&d->state.transform, d->mesh->positions[index], screen);
#else
    el_transform_vertex_in_view(&d->state.transform, d->mesh->positions[index], screen);
#endif
    el_count(&d->renderer->stats.vertices, 1);
}

static void transform_all(const drawing *d)
{
#if EL_SMALL_CODE
    for (uint16_t i = 0; i < d->mesh->vertex_count; i++) {
        transform_one(d, i, (el_screen_vertex *)d->vertices + i);
    }
#else
    el_transform_vertices(&d->state.transform, d->mesh->positions, d->mesh->vertex_count, d->vertices);
    el_count(&d->renderer->stats.vertices, d->mesh->vertex_count);
#endif
}

/* Places the vertices: over the depth band if no band is open, and over at most a quarter of the list's free memory. */
static void place_vertices(drawing *d)
{
    el_renderer *const renderer = d->renderer;
    el_list *const list = &renderer->list;
    uint8_t *const list_end = list->base + renderer->list_bytes;
    const uint32_t depth_bytes = renderer->band_is_open ? 0U
                                                        : EL_DEPTH_BAND_BYTES((uint32_t)renderer->config.width,
                                                                              (uint32_t)renderer->config.band_lines);
    const uint32_t free_bytes = renderer->list_bytes - list->used;
    const uint32_t direct_bytes = d->mesh->vertex_count * (uint32_t)sizeof(el_screen_vertex);
    uint32_t bytes;
    if (direct_bytes <= depth_bytes + free_bytes / 4) {
        d->direct = true;
        bytes = EL_ROUND_UP_8(direct_bytes);
    } else {
        d->direct = false;
        bytes = (uint32_t)el_max_i32((int32_t)depth_bytes, (int32_t)(free_bytes / 8)) / 8 * 8;
        /* NOLINTNEXTLINE(clang-analyzer-core.*): el_draw saw to it that there is room for a vertex at least. */
        d->slots = 1U << (el_bit_length_u32(bytes / (uint32_t)sizeof(cached_vertex)) - 1);
    }
    const uint32_t beside = bytes > depth_bytes ? bytes - depth_bytes : 0U;
    list->end = renderer->list_bytes - beside;
    d->vertices = list_end + depth_bytes - bytes;

    if (d->direct) {
        transform_all(d);
        return;
    }
    cached_vertex *const cache = d->vertices;
    for (uint32_t i = 0; i < d->slots; i++) {
        cache[i].index = 0xFFFF;
    }
}

static cached_vertex *slot_of(const drawing *d, uint16_t index)
{
    return (cached_vertex *)d->vertices + (index & (d->slots - 1U));
}

static inline el_screen_vertex *find_vertex(const drawing *d, cached_vertex *slot, uint16_t index)
{
    if (slot->index != index) {
        slot->index = index;
        transform_one(d, index, &slot->vertex);
    }
    return &slot->vertex;
}

/* A triangle's vertices at their places; false where two of them share a slot of the cache. */
static inline bool find_in_place(const drawing *d, const uint16_t indices[3], el_screen_vertex *v[3])
{
    if (d->direct) {
        el_screen_vertex *const all = d->vertices;
        v[0] = all + indices[0];
        v[1] = all + indices[1];
        v[2] = all + indices[2];
        return true;
    }
    cached_vertex *const a = slot_of(d, indices[0]);
    cached_vertex *const b = slot_of(d, indices[1]);
    cached_vertex *const c = slot_of(d, indices[2]);
    if (a == b || b == c || c == a) {
        return false;
    }
    v[0] = find_vertex(d, a, indices[0]);
    v[1] = find_vertex(d, b, indices[1]);
    v[2] = find_vertex(d, c, indices[2]);
    return true;
}

/* The same, or where that does not do and in small code, copies. */
static void find_vertices(const drawing *d, const uint16_t indices[3], el_screen_vertex *v[3],
                          el_screen_vertex copies[3])
{
    if (!EL_SMALL_CODE && find_in_place(d, indices, v)) {
        return;
    }
    for (unsigned i = 0; i < 3; i++) {
        copies[i] = d->direct ? ((const el_screen_vertex *)d->vertices)[indices[i]]
                              : *find_vertex(d, slot_of(d, indices[i]), indices[i]);
        v[i] = &copies[i];
    }
}

/* The list is full. Makes it thin; where it is that already, gives up the last sixteenth of the pass' bands; where there
 * is one band only, draws the list. Returns true when vertices that lay over the depth band are lost, because the band's
 * depth is there now. */
static bool make_room(el_renderer *renderer)
{
    const int32_t bands = renderer->pass_end - renderer->pass_begin;
    el_bands_note_use(renderer, renderer->list.used + renderer->list_bytes - renderer->list.end);
    const int32_t lines = renderer->config.band_lines;
#if EL_WITH_THIN
    if (bands > 1 && !renderer->list.is_thin) {
        el_list_make_thin(&renderer->list, renderer->pass_begin * lines);
        return false;
    }
#endif
    if (bands > 1) {
        renderer->pass_end = (uint16_t)(renderer->pass_begin + bands * 15 / 16);
        el_list_keep_rows(&renderer->list, renderer->pass_begin * lines, renderer->pass_end * lines);
        return false;
    }
    const bool was_open = renderer->band_is_open;
    el_bands_flush(renderer);
    return !was_open;
}

static void fill_plain(el_record *record, uint16_t index, const el_screen_vertex *const v[3])
{
    record->index = index;
    for (unsigned i = 0; i < 3; i++) {
        record->at.points[i] = (el_point){.x = v[i]->x, .y = v[i]->y, .z = v[i]->z};
    }
}

static void fill_perspective(el_record *record, const el_screen_vertex *const v[3])
{
    el_record_perspective *const perspective = (el_record_perspective *)(void *)record;
    unsigned shifts = 0;
    for (unsigned i = 0; i < 3; i++) {
        perspective->w[i] = v[i]->w;
        shifts |= (unsigned)v[i]->w_shift << (5 * i);
    }
    perspective->w_shifts = (uint16_t)shifts;
}

static void fill_clipped(el_record *record, const el_clip_corner *const corners[3])
{
    el_record_clipped *const clipped = (el_record_clipped *)(void *)record;
    for (unsigned i = 0; i < 3; i++) {
        /* NOLINTNEXTLINE(clang-analyzer-core.NullDereference): a clipped record is made of a triangle that was cut. */
        const int32_t *const a = corners[i]->attributes;
        el_attributes *const attributes = &clipped->attributes[i];
        *attributes = (el_attributes){.u_q16 = a[U], .v_q16 = a[V]};
        for (unsigned channel = 0; channel < 3 && EL_WITH_GOURAUD; channel++) {
            attributes->rgb_q8[channel] = (uint16_t)a[RGB + channel];
        }
    }
}

/* A triangle on the screen: culls it, or puts it on the list. `cut` has the corners of a clipped one, else NULL. Returns
 * false when the list is full. */
static bool try_triangle(drawing *d, uint16_t index, const el_screen_vertex *const v[3],
                         const el_clip_corner *const cut[3])
{
    el_renderer *const renderer = d->renderer;
    el_stats *const stats = &renderer->stats;
    const int32_t x[3] = {v[0]->x, v[1]->x, v[2]->x};
    const int32_t y[3] = {v[0]->y, v[1]->y, v[2]->y};

    const int64_t area = el_doubled_area(x, y);
    if (area == 0) {
        el_count(&stats->triangles_empty, 1);
        return true;
    }
    if (el_shows_back(&d->state, area) && (d->state.material->flags & EL_MATERIAL_TWO_SIDED) == 0) {
        el_count(&stats->triangles_backface, 1);
        return true;
    }
    const int32_t x_begin = el_first_centre(el_min_i32(x[0], el_min_i32(x[1], x[2])));
    const int32_t x_end = el_first_centre(el_max_i32(x[0], el_max_i32(x[1], x[2])));
    const int32_t y_begin = el_first_centre(el_min_i32(y[0], el_min_i32(y[1], y[2])));
    const int32_t y_end = el_first_centre(el_max_i32(y[0], el_max_i32(y[1], y[2])));
    if (x_begin >= x_end || y_begin >= y_end) {
        el_count(&stats->triangles_empty, 1);
        return true;
    }
    if (x_end <= 0 || x_begin >= renderer->config.width || y_end <= 0 || y_begin >= renderer->config.height) {
        el_count(&stats->triangles_outside, 1);
        return true;
    }

    const int32_t lines = renderer->config.band_lines;
    const int32_t pass_row = renderer->pass_begin * lines;
    const int32_t row = el_max_i32(y_begin, pass_row);
    if (y_end <= pass_row || row >= renderer->pass_end * lines) {
        el_count(&stats->triangles_other, 1);
        return true;
    }
    const el_record_kind whole = el_list_is_thin(&renderer->list) ? EL_RECORD_THIN : d->kind;
    const el_record_kind kind = cut != NULL ? d->cut_kind : whole;
    el_record *const record = el_list_append(&renderer->list, &d->state, kind, row);
    if (record == NULL) {
        return false;
    }
    el_count(&stats->triangles_listed, 1);
    if (EL_WITH_THIN && kind == EL_RECORD_THIN) {
        record->index = index;
        record->at.row = (int16_t)y_begin;
        return true;
    }
    fill_plain(record, index, v);
    if (EL_WITH_TEXTURE && kind >= EL_RECORD_PERSPECTIVE) {
        fill_perspective(record, v);
    }
    if (EL_CLIP_ATTRIBUTES > 0 && kind == EL_RECORD_CLIPPED) {
        fill_clipped(record, cut);
    }
    return true;
}

static void add_triangle(drawing *d, uint16_t index, const el_screen_vertex *const v[3],
                         const el_clip_corner *const cut[3])
{
#if EL_SMALL_CODE
    const el_screen_vertex *const *const kept = v;
#else
    if (try_triangle(d, index, v, cut)) {
        return;
    }
    /* The vertices' place may be needed. */
    const el_screen_vertex copies[3] = {*v[0], *v[1], *v[2]};
    const el_screen_vertex *const kept[3] = {&copies[0], &copies[1], &copies[2]};
#endif
    while (!try_triangle(d, index, kept, cut)) {
        if (make_room(d->renderer)) {
            place_vertices(d);
        }
    }
}

/* Which side of the triangle the camera sees, before it is cut: the light needs it. */
static bool seen_from_back(const el_draw_state *draw, const el_clip_vertex v[3])
{
    /* Sign of the determinant of the (x, y, w) rows, with 19 bits of each, so that it stays below 2^60 whatever they
     * hold. What is turned by less looks alike lit from either side. */
    const int32_t rows[3][3] = {{v[0].x, v[0].y, v[0].w}, {v[1].x, v[1].y, v[1].w}, {v[2].x, v[2].y, v[2].w}};
    return el_determinant_is_negative(rows, 12) != (draw->mirrored != 0);
}

/* A corner from which a fan has triangles of one winding. Snapping can dent a cut polygon by a sub-pixel; from the wrong
 * corner a fan folds over there, and its part that faces away would be culled while its neighbour covers too much. */
static unsigned fan_root(const el_screen_vertex screen[], unsigned count)
{
    for (unsigned root = 0; root < count; root++) {
        bool clockwise = false;
        bool counter_clockwise = false;
        for (unsigned i = 2; i < count; i++) {
            const el_screen_vertex *const b = &screen[(root + i - 1) % count];
            const el_screen_vertex *const c = &screen[(root + i) % count];
            const int32_t x[3] = {screen[root].x, b->x, c->x};
            const int32_t y[3] = {screen[root].y, b->y, c->y};
            const int64_t area = el_doubled_area(x, y);
            clockwise = clockwise || area > 0;
            counter_clockwise = counter_clockwise || area < 0;
        }
        if (!(clockwise && counter_clockwise)) {
            return root;
        }
    }
    return 0;
}

static void clip_triangle(drawing *d, uint16_t index, uint8_t codes)
{
    const uint16_t *const vertices = d->mesh->triangles[index];
    const el_material *const material = d->state.material;
    const bool coloured = el_has_colours((el_shading)material->shading);
    el_clip_corner corners[EL_CLIP_MAX_VERTICES];
    el_clip_vertex clip[3];
    for (unsigned i = 0; i < 3; i++) {
        clip[i] = el_transform_position(&d->state.transform, d->mesh->positions[vertices[i]]);
    }
    const bool turned = coloured && el_is_lit(material) && (material->flags & EL_MATERIAL_TWO_SIDED) != 0 &&
                        seen_from_back(&d->state, clip);
    for (unsigned i = 0; i < 3; i++) {
        corners[i] = (el_clip_corner){.position = clip[i]};
        if (el_has_texture((el_shading)material->shading)) {
            corners[i].attributes[U] = d->mesh->uvs[vertices[i]][0] * (1 << 12);
            corners[i].attributes[V] = d->mesh->uvs[vertices[i]][1] * (1 << 12);
        }
        if (coloured) {
            uint16_t rgb_q8[3];
            el_shade_vertex(&d->state, vertices[i], turned, rgb_q8);
            for (unsigned channel = 0; channel < 3; channel++) {
                corners[i].attributes[RGB + channel] = rgb_q8[channel];
            }
        }
    }
    const unsigned count = el_clip_polygon(&d->state.transform, corners, 3, codes);
    el_count(&d->renderer->stats.triangles_clipped, 1);
    if (count == 0) {
        el_count(&d->renderer->stats.triangles_outside, 1);
        return;
    }
    el_screen_vertex screen[EL_CLIP_MAX_VERTICES];
    for (unsigned i = 0; i < count; i++) {
        el_project(&d->state.transform, &corners[i].position, &screen[i]);
    }
    const unsigned a = fan_root(screen, count);
    for (unsigned i = 2; i < count; i++) {
        const unsigned b = (a + i - 1) % count;
        const unsigned c = (a + i) % count;
        const el_screen_vertex *const fan[3] = {&screen[a], &screen[b], &screen[c]};
        const el_clip_corner *const cut[3] = {&corners[a], &corners[b], &corners[c]};
        add_triangle(d, index, fan, cut);
    }
}

/* Now a triangle needs them. Returns the bits of all three codes. */
static unsigned transform_later(const drawing *d, const uint16_t indices[3], el_screen_vertex *const v[3])
{
    unsigned codes = 0;
    for (unsigned i = 0; i < 3; i++) {
        if ((v[i]->code & EL_CODE_LATER) != 0) {
            el_transform_vertex(&d->state.transform, d->mesh->positions[indices[i]], v[i]);
        }
        codes |= v[i]->code;
    }
    return codes;
}

static void draw_triangles(drawing *d)
{
    el_stats *const stats = &d->renderer->stats;
    const uint32_t count = d->mesh->triangle_count;
    for (uint32_t i = 0; i < count; i++) {
        const uint16_t *const vertices = d->mesh->triangles[i];
        el_screen_vertex copies[3];
        el_screen_vertex *v[3];
        find_vertices(d, vertices, v, copies);
        if ((v[0]->code & v[1]->code & v[2]->code & EL_CODE_OUTSIDE) != 0) {
            el_count(&stats->triangles_outside, 1);
            continue;
        }
        unsigned codes = v[0]->code | v[1]->code | v[2]->code;
        if (!EL_SMALL_CODE && (codes & EL_CODE_LATER) != 0) {
            codes = transform_later(d, vertices, v);
            if ((v[0]->code & v[1]->code & v[2]->code & EL_CODE_OUTSIDE) != 0) {
                el_count(&stats->triangles_outside, 1);
                continue;
            }
        }
        if ((codes & EL_CODE_CLIP) != 0) {
            clip_triangle(d, (uint16_t)i, (uint8_t)codes);
            continue;
        }
        add_triangle(d, (uint16_t)i, (const el_screen_vertex *const *)v, NULL);
    }
    el_count(&stats->triangles, count);
}

/* The bits of el_shading that options.h leaves out. */
enum {
    LEFT_OUT = (EL_WITH_GOURAUD ? 0 : EL_SHADE_GOURAUD) | (EL_WITH_TEXTURE ? 0 : EL_SHADE_TEXTURED) |
               (EL_WITH_OVERDRAW ? 0 : EL_SHADE_OVERDRAW)
};

static el_status check(const el_mesh *mesh, const el_material *material)
{
    if (mesh->triangle_count > EL_MESH_MAX_TRIANGLES) {
        return EL_ERROR_SIZE;
    }
    if (mesh->triangle_count > 0 && (mesh->positions == NULL || mesh->triangles == NULL)) {
        return EL_ERROR_ARGUMENT;
    }
    const unsigned shading = material->shading;
    if (shading > EL_SHADE_OVERDRAW || (shading & LEFT_OUT) != 0 ||
        (!EL_WITH_DITHER && (material->flags & EL_MATERIAL_DITHER) != 0) ||
        (!EL_WITH_LIGHT && material->light != NULL) ||
        (el_has_texture((el_shading)shading) &&
         (material->texture == NULL || material->texture->texels == NULL || mesh->uvs == NULL ||
          material->texture->width_log2 > 10 || material->texture->height_log2 > 10)) ||
        (el_is_lit(material) && mesh->normals == NULL)) {
        return EL_ERROR_MATERIAL;
    }
    return EL_OK;
}

el_status el_draw(el_renderer *renderer, const el_mesh *mesh, const el_pose *pose, const el_material *material)
{
    if (renderer == NULL || mesh == NULL || pose == NULL || material == NULL || !renderer->in_frame) {
        return EL_ERROR_ARGUMENT;
    }
    const el_status status = check(mesh, material);
    if (status != EL_OK) {
        return status;
    }
    el_count(&renderer->stats.draws, 1);
    drawing d = {.renderer = renderer, .mesh = mesh};
    const int visibility = el_transform_make(&d.state.transform, &renderer->view, mesh, pose);
    if (visibility < 0) {
        return (el_status)visibility;
    }
    if (visibility == EL_CULLED) {
        el_count(&renderer->stats.draws_culled, 1);
        return EL_OK;
    }
    d.state.mesh = mesh;
    d.state.material = material;
    d.state.mirrored = d.state.transform.mirrored;
    if (el_is_lit(material)) {
        /* Into model space, by the transposed rotation. */
        for (unsigned i = 0; i < 3; i++) {
            const int64_t component =
                el_shift_i64(el_dot_column(material->light->direction_q30, pose->rotation_q30, i), 46);
            d.state.light_q14[i] = (int16_t)(component > 16384 ? 16384 : (component < -16384 ? -16384 : component));
        }
    }
    el_shading shading = (el_shading)material->shading;
    if (!el_debug_begin_draw(renderer, &d.state, &shading)) {
        return EL_OK;
    }
    d.kind = el_has_texture(shading) ? EL_RECORD_PERSPECTIVE : EL_RECORD_PLAIN;
    d.cut_kind = el_has_texture(shading) || el_has_colours(shading) ? EL_RECORD_CLIPPED : EL_RECORD_CUT;
    el_list_end_draw(&renderer->list);
    /* Enough for a few vertices in the cache and for the largest record and its run beside them; an empty list has it. */
    while (renderer->list_bytes - renderer->list.used < EL_MIN_LIST_BYTES / 2) {
        (void)make_room(renderer);
    }
    place_vertices(&d);
    draw_triangles(&d);
    el_bands_note_use(renderer, renderer->list.used + renderer->list_bytes - renderer->list.end);
    renderer->list.end = renderer->list_bytes;
    return EL_OK;
}
