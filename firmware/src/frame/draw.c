/* el_draw: from a mesh to records on the display list. */
#include <string.h>

#include "base/fixed.h"
#include "frame/bands.h"
#include "frame/cull.h"
#include "frame/debug_hooks.h"
#include "frame/quiet.h"
#include "geometry/clip.h"
#include "geometry/cluster.h"

/* The mesh's vertices on the screen, at the end of the list's memory. `direct`: all of them, each transformed once
 * before the triangles are looked at. Otherwise a direct-mapped cache, for meshes that do not fit: a vertex is
 * transformed when a triangle asks for it and may be asked for again after another took its place. Where triangles ask
 * for one vertex after the other, as they do in most meshes, several are transformed at a time. */
enum { NO_VERTEX = 0xFFFF /* meshes have at most 65535 vertices */, VERTICES_AHEAD = 16 };
enum { VERTICES_SHARED = 64 /* from so many on, the workers' start is worth it */ };

/* Attributes of corners that are cut. */
enum { U, V, RGB };

typedef struct drawing {
    el_renderer *renderer;
    const el_mesh *mesh;
    bool direct;
    bool by_clusters;        /* the mesh has some: vertices of those that are skipped wait */
    el_record_kind kind;     /* of its triangles */
    el_record_kind cut_kind; /* of those that are cut */
    uint32_t slot_mask;      /* a vertex' slot is its index & slot_mask */
    uint32_t ahead;          /* so many are transformed at a time, one after the other */
    uint32_t next_vertex;    /* the one behind those that were put into the cache last */
    el_screen_vertex *vertices;
    uint16_t *cached; /* indices of the vertices in the cache's slots */
    el_culling culling;
    uint32_t verdicts[EL_VERDICTS]; /* how many triangles had each */
    el_draw_state state;
} drawing;

/* The rows of the pass, which make_room may have made fewer. */
static void find_rows(drawing *d)
{
    const el_renderer *const renderer = d->renderer;
    d->culling.row_begin = renderer->pass_begin * renderer->config.band_lines;
    d->culling.row_end = el_min_i32(renderer->pass_end * renderer->config.band_lines, renderer->config.height);
}

static void transform_run(const drawing *d, uint32_t first, uint32_t count, el_screen_vertex *screen)
{
#if EL_SMALL_CODE
    for (uint32_t i = 0; i < count; i++) {
        el_transform_vertex(&d->state.transform, d->mesh->positions[first + i], &screen[i]);
    }
#else
    el_transform_vertices(&d->state.transform, d->mesh->positions + first, count, screen);
#endif
}

#if EL_WITH_WORKERS
typedef struct vertex_job {
    const drawing *drawing;
    uint32_t first, count;
    el_screen_vertex *screen;
} vertex_job;

/* The worker's part of the vertices: as many as each other's, one more or less. */
static void transform_part(void *argument, unsigned worker)
{
    const vertex_job *const job = argument;
    const uint32_t workers = job->drawing->renderer->workers;
    const uint32_t begin = job->count * worker / workers; /* count < 2^16 */
    const uint32_t end = job->count * (worker + 1U) / workers;
    transform_run(job->drawing, job->first + begin, end - begin, job->screen + begin);
}
#endif

static void transform_vertices(const drawing *d, uint32_t first, uint32_t count, el_screen_vertex *screen)
{
    el_count(&d->renderer->stats.vertices, count);
#if EL_WITH_WORKERS
    if (d->renderer->workers > 1 && count >= VERTICES_SHARED) {
        const el_workers *const workers = d->renderer->config.workers;
        vertex_job job = {.drawing = d, .first = first, .count = count, .screen = screen};
        workers->start(workers->context, transform_part, &job);
        transform_part(&job, 0);
        workers->wait(workers->context);
        return;
    }
#endif
    transform_run(d, first, count, screen);
}

/* None of them is there, until a triangle asks for it. */
static void leave_vertices(const drawing *d)
{
    for (uint32_t i = 0; i < d->mesh->vertex_count; i++) {
        d->vertices[i].code = EL_CODE_LATER;
    }
}

/* Places the vertices: over the depth bands if no band is open, and over at most a quarter of the list's free memory. */
static void place_vertices(drawing *d)
{
    el_renderer *const renderer = d->renderer;
    el_list *const list = &renderer->list;
    uint8_t *const list_end = list->base + renderer->list_bytes;
    const uint32_t depth_bytes = renderer->painter.band_is_open ? 0U : renderer->depth_bytes;
    const uint32_t free_bytes = renderer->list_bytes - list->used;
    const uint32_t direct_bytes = d->mesh->vertex_count * (uint32_t)sizeof(el_screen_vertex);
    uint32_t bytes;
    if (direct_bytes <= depth_bytes + free_bytes / 4) {
        d->direct = true;
        d->slot_mask = UINT16_MAX;
        bytes = EL_ROUND_UP_8(direct_bytes);
    } else {
        d->direct = false;
        bytes = (uint32_t)el_max_i32((int32_t)depth_bytes, (int32_t)(free_bytes / 8)) / 8 * 8;
        const uint32_t most = bytes / (uint32_t)(sizeof(el_screen_vertex) + sizeof(uint16_t));
        /* NOLINTNEXTLINE(clang-analyzer-core.*): el_draw saw to it that there is room for a vertex at least. */
        d->slot_mask = (1U << (el_bit_length_u32(most) - 1)) - 1U;
    }
    const uint32_t beside = bytes > depth_bytes ? bytes - depth_bytes : 0U;
    list->end = renderer->list_bytes - beside;
    d->vertices = (el_screen_vertex *)(void *)(list_end + depth_bytes - bytes);

    if (d->direct) {
        if (d->by_clusters) {
            leave_vertices(d);
        } else {
            transform_vertices(d, 0, d->mesh->vertex_count, d->vertices);
        }
        return;
    }
    d->cached = (uint16_t *)(void *)(d->vertices + d->slot_mask + 1U);
    d->next_vertex = NO_VERTEX;
    const uint32_t shared = (d->slot_mask + 1U) / 4;
    d->ahead = EL_WITH_WORKERS && renderer->workers > 1 && shared > VERTICES_AHEAD ? shared : VERTICES_AHEAD;
    memset(d->cached, 0xFF, (d->slot_mask + 1U) * sizeof d->cached[0]);
}

/* Puts a vertex into the cache, and those that follow it when it follows the one before. */
static void cache_vertex(drawing *d, uint32_t index)
{
    const uint32_t slot = index & d->slot_mask;
    uint32_t count = 1;
    if (!EL_SMALL_CODE && index == d->next_vertex) {
        const uint32_t left = d->mesh->vertex_count - index;
        const uint32_t slots_left = d->slot_mask + 1U - slot;
        count = left < slots_left ? left : slots_left;
        count = count < d->ahead ? count : d->ahead;
    }
    d->next_vertex = index + count;
    transform_vertices(d, index, count, d->vertices + slot);
    for (uint32_t i = 0; i < count; i++) {
        d->cached[slot + i] = (uint16_t)(index + i);
    }
}

#if !EL_SMALL_CODE
/* Puts a triangle's vertices into the cache. False where they do not go there together. */
static inline bool cache_vertices(drawing *d, const uint16_t indices[3])
{
    const uint16_t *const a = &d->cached[indices[0] & d->slot_mask];
    const uint16_t *const b = &d->cached[indices[1] & d->slot_mask];
    const uint16_t *const c = &d->cached[indices[2] & d->slot_mask];
    if (*a == indices[0] && *b == indices[1] && *c == indices[2]) {
        return true;
    }
    for (unsigned i = 0; i < 3; i++) {
        if (d->cached[indices[i] & d->slot_mask] != indices[i]) {
            cache_vertex(d, indices[i]);
        }
    }
    return *a == indices[0] && *b == indices[1] && *c == indices[2];
}
#endif

/* A triangle's vertices: at their places, or where two of them share one in the cache, and in small code, copies. */
static void find_vertices(drawing *d, const uint16_t indices[3], el_screen_vertex *v[3], el_screen_vertex copies[3])
{
#if EL_SMALL_CODE
    const bool in_place = false;
#else
    const bool in_place = d->direct || cache_vertices(d, indices);
#endif
    for (unsigned i = 0; i < 3; i++) {
        const uint32_t slot = indices[i] & d->slot_mask;
        if (!d->direct && d->cached[slot] != indices[i]) {
            cache_vertex(d, indices[i]);
        }
        v[i] = &d->vertices[slot];
        if (!in_place) {
            copies[i] = *v[i];
            v[i] = &copies[i];
        }
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
    const bool was_open = renderer->painter.band_is_open;
    el_bands_flush(renderer);
    return !was_open;
}

static EL_SPECIALISED el_point point_of(const el_screen_vertex *v)
{
    return (el_point){.x = v->x, .y = v->y, .z = v->z};
}

/* What a whole triangle's record of that kind holds beside its run. */
static EL_SPECIALISED void fill_record(el_record *record, uint16_t index, const el_screen_vertex *const v[3],
                                       el_record_kind kind, int32_t first_row)
{
    record->index = index;
    if (EL_WITH_THIN && kind == EL_RECORD_THIN) {
        record->at.row = (int16_t)first_row;
        return;
    }
    record->at.points[0] = point_of(v[0]);
    record->at.points[1] = point_of(v[1]);
    record->at.points[2] = point_of(v[2]);
    if (EL_WITH_TEXTURE && kind >= EL_RECORD_PERSPECTIVE) {
        el_record_perspective *const perspective = (el_record_perspective *)(void *)record;
        perspective->w[0] = v[0]->w;
        perspective->w[1] = v[1]->w;
        perspective->w[2] = v[2]->w;
        perspective->w_shifts = (uint16_t)(v[0]->w_shift | v[1]->w_shift << 5 | v[2]->w_shift << 10);
    }
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

static el_record_kind whole_kind(const drawing *d)
{
    return el_list_is_thin(&d->renderer->list) ? EL_RECORD_THIN : d->kind;
}

/* A triangle on the screen: culls it, or puts it on the list. `cut` has the corners of a clipped one, else NULL. */
static void add_triangle(drawing *d, uint16_t index, const el_screen_vertex *const v[3],
                         const el_clip_corner *const cut[3])
{
#if !EL_SMALL_CODE
    el_screen_vertex copies[3];
    const el_screen_vertex *const kept[3] = {&copies[0], &copies[1], &copies[2]};
#endif
    for (;;) {
        el_cull_rows rows;
        const el_verdict verdict = el_cull(&d->culling, v, &rows);
        if (verdict == EL_VERDICT_SEEN) {
            const el_record_kind kind = cut != NULL ? d->cut_kind : whole_kind(d);
            const int32_t row_end = el_min_i32(rows.end, d->culling.row_end);
            el_record *const record = el_list_append(&d->renderer->list, &d->state, kind, rows.begin, row_end);
            if (record == NULL) {
#if !EL_SMALL_CODE
                /* Their place may be needed. */
                for (unsigned i = 0; i < 3; i++) {
                    copies[i] = *v[i];
                }
                v = kept;
#endif
                if (make_room(d->renderer)) {
                    place_vertices(d);
                }
                find_rows(d);
                continue;
            }
            fill_record(record, index, v, kind, rows.first);
            if (EL_CLIP_ATTRIBUTES > 0 && kind == EL_RECORD_CLIPPED) {
                fill_clipped(record, cut);
            }
        }
        d->verdicts[verdict]++;
        return;
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

/* Any triangle. */
static void draw_triangle(drawing *d, uint32_t index)
{
    const uint16_t *const vertices = d->mesh->triangles[index];
    el_screen_vertex copies[3];
    el_screen_vertex *v[3];
    find_vertices(d, vertices, v, copies);
    if ((v[0]->code & v[1]->code & v[2]->code & EL_CODE_OUTSIDE) != 0) {
        d->verdicts[EL_VERDICT_OUTSIDE]++;
        return;
    }
    unsigned codes = v[0]->code | v[1]->code | v[2]->code;
    if (!EL_SMALL_CODE && (codes & EL_CODE_LATER) != 0) {
        codes = transform_later(d, vertices, v);
    }
    if ((codes & EL_CODE_CLIP) != 0) {
        clip_triangle(d, (uint16_t)index, (uint8_t)codes);
    } else {
        add_triangle(d, (uint16_t)index, (const el_screen_vertex *const *)v, NULL);
    }
}

#if EL_CULLS_IN_VIEW
/* Draws the triangles [index, end) while they are simple: within the view or all beside it, their vertices in
 * their places, and room for the record in the open run. Returns the number of the first that is not. All that changes
 * stays in registers. `direct` as in `drawing`; `shared` as in its list. */
static EL_SPECIALISED uint32_t draw_in_view(drawing *d, uint32_t index, uint32_t end, bool direct, bool shared)
{
    const el_record_kind kind = whole_kind(d);
    el_list list = d->renderer->list;
    if (list.run == 0 || ((const el_run *)el_list_at(&list, list.run))->kind != (uint8_t)kind) {
        return index;
    }
    const uint32_t record_bytes = el_list_record_bytes(kind);
    const el_culling culling = d->culling;
    const el_screen_vertex *const vertices = d->vertices;
    const uint32_t slot_mask = direct ? UINT16_MAX : d->slot_mask;
    const uint16_t(*triangle)[3] = &d->mesh->triangles[index];
    const uint32_t first = index;
    uint32_t verdicts[EL_VERDICT_SEEN] = {0};
    for (; index < end; index++, triangle++) {
        if (!direct && !cache_vertices(d, *triangle)) {
            break;
        }
        const el_screen_vertex *const v[3] = {vertices + ((*triangle)[0] & slot_mask),
                                              vertices + ((*triangle)[1] & slot_mask),
                                              vertices + ((*triangle)[2] & slot_mask)};
        if ((v[0]->code | v[1]->code | v[2]->code) != 0) {
            if ((v[0]->code & v[1]->code & v[2]->code & EL_CODE_OUTSIDE) == 0) {
                break;
            }
            verdicts[EL_VERDICT_OUTSIDE]++;
            continue;
        }
        el_cull_rows rows;
        const el_verdict verdict = el_cull_in_view(&culling, v[0], v[1], v[2], &rows);
        if (verdict != EL_VERDICT_SEEN) {
            verdicts[verdict]++;
            continue;
        }
        const int32_t row_end = el_min_i32(rows.end, culling.row_end);
        const uint32_t share_bytes = shared ? el_list_share_bytes(&list, rows.begin, row_end) : 0U;
        el_record *const record = el_list_append_same(&list, record_bytes, share_bytes, rows.begin);
        if (record == NULL) {
            break;
        }
#if EL_WITH_WORKERS
        if (share_bytes != 0) {
            list.used = el_list_share(&d->renderer->list, record, list.used, rows.begin, row_end);
        }
#endif
        fill_record(record, (uint16_t)index, v, kind, rows.first);
    }
    d->renderer->list = list;
    d->verdicts[EL_VERDICT_SEEN] += index - first;
    for (unsigned i = 0; i < EL_VERDICT_SEEN; i++) {
        d->verdicts[i] += verdicts[i];
        d->verdicts[EL_VERDICT_SEEN] -= verdicts[i];
    }
    return index;
}
#endif

static void draw_triangles(drawing *d, uint32_t begin, uint32_t end)
{
    el_count(&d->renderer->stats.triangles, end - begin);
    for (uint32_t i = begin; i < end; i++) {
#if EL_CULLS_IN_VIEW
        if (EL_WITH_WORKERS && d->renderer->list.is_shared) {
            i = draw_in_view(d, i, end, d->direct, true);
        } else {
            i = d->direct ? draw_in_view(d, i, end, true, false) : draw_in_view(d, i, end, false, false);
        }
        if (i == end) {
            break;
        }
#endif
        draw_triangle(d, i);
    }
}

#if EL_WITH_CLUSTERS
/* Those parts of the mesh that may be seen: clusters that follow each other are one. */
static void draw_clusters(drawing *d)
{
    el_stats *const stats = &d->renderer->stats;
    el_cluster_view view;
    el_cluster_view_make(&view, &d->state.transform, d->culling.two_sided);
    uint32_t vertex = 0; /* of the part */
    uint32_t triangle = 0;
    uint32_t vertex_end = 0; /* and of the clusters so far */
    uint32_t triangle_end = 0;
    for (uint32_t i = 0; i <= d->mesh->cluster_count; i++) {
        const el_cluster *const cluster = &d->mesh->clusters[i];
        const bool at_end = i == d->mesh->cluster_count;
        const el_cluster_verdict verdict =
            at_end ? EL_CLUSTER_OUTSIDE : el_cluster_look(&view, &d->state.transform, cluster);
        if (verdict != EL_CLUSTER_SEEN && triangle < triangle_end) {
            if (d->direct) {
                transform_vertices(d, vertex, vertex_end - vertex, d->vertices + vertex);
            }
            draw_triangles(d, triangle, triangle_end);
        }
        if (at_end) {
            break;
        }
        vertex_end += cluster->vertex_count;
        triangle_end += cluster->triangle_count;
        if (verdict != EL_CLUSTER_SEEN) {
            el_count(verdict == EL_CLUSTER_OUTSIDE ? &stats->clusters_outside : &stats->clusters_turned, 1);
            el_count(&stats->triangles_skipped, cluster->triangle_count);
            vertex = vertex_end;
            triangle = triangle_end;
        }
    }
}
#endif

/* All of the mesh, or of its clusters what may be seen. */
static void draw_mesh(drawing *d)
{
#if EL_WITH_CLUSTERS
    if (d->by_clusters) {
        draw_clusters(d);
    } else {
        draw_triangles(d, 0, d->mesh->triangle_count);
    }
#else
    draw_triangles(d, 0, d->mesh->triangle_count);
#endif
    el_stats *const stats = &d->renderer->stats;
    el_count(&stats->triangles_outside, d->verdicts[EL_VERDICT_OUTSIDE]);
    el_count(&stats->triangles_backface, d->verdicts[EL_VERDICT_BACK]);
    el_count(&stats->triangles_empty, d->verdicts[EL_VERDICT_EMPTY]);
    el_count(&stats->triangles_other, d->verdicts[EL_VERDICT_OTHER]);
    el_count(&stats->triangles_listed, d->verdicts[EL_VERDICT_SEEN]);
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
    if (el_quiet_looks(renderer)) {
        el_quiet_look_at(renderer, mesh, pose, material);
        return EL_OK;
    }
    drawing d = {.renderer = renderer, .mesh = mesh};
    const int visibility = el_transform_make(&d.state.transform, &renderer->view, mesh, pose);
    if (visibility < 0) {
        el_quiet_refuse(renderer);
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
    d.culling = (el_culling){.facing = d.state.mirrored != 0 ? -1 : 1,
                             .two_sided = (material->flags & EL_MATERIAL_TWO_SIDED) != 0,
                             .width = renderer->config.width,
                             .height = renderer->config.height};
    el_list_end_draw(&renderer->list);
    /* Enough for a few vertices in the cache and for the largest record and its run beside them; an empty list has it. */
    while (renderer->list_bytes - renderer->list.used < EL_MIN_LIST_BYTES / 2) {
        (void)make_room(renderer);
    }
    find_rows(&d);
    d.by_clusters = EL_WITH_CLUSTERS && mesh->cluster_count > 1;
    place_vertices(&d);
    draw_mesh(&d);
    el_bands_note_use(renderer, renderer->list.used + renderer->list_bytes - renderer->list.end);
    renderer->list.end = renderer->list_bytes;
    return EL_OK;
}
