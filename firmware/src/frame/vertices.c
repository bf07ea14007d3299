/* Where a mesh's vertices are while it is drawn, and how they get there. */
#include <string.h>

#include "base/fixed.h"
#include "frame/drawing.h"

enum {
    NO_VERTEX = 0xFFFF, /* meshes have at most 65535 vertices */
    VERTICES_AHEAD = 16,
    VERTICES_SHARED = 64 /* from so many on, the workers' start is worth it */
};

#if EL_SMALL_CODE
/* Transforms a vertex to its slot. */
static void transform_one(el_drawing *d, uint32_t index)
{
    d->transformed++;
    el_transform_vertex(&d->state->transform, d->mesh->positions[index], &d->vertices[index & d->slot_mask]);
}
#endif

static void transform_run(const el_drawing *d, uint32_t first, uint32_t count, el_screen_vertex *screen)
{
#if EL_SMALL_CODE
    for (uint32_t i = 0; i < count; i++) {
        el_transform_vertex(&d->state->transform, d->mesh->positions[first + i], &screen[i]);
    }
#else
    el_transform_vertices(&d->state->transform, d->mesh->positions + first, count, screen,
                          d->kind == EL_RECORD_PERSPECTIVE);
#endif
}

#if EL_WITH_WORKERS
typedef struct vertex_job {
    const el_drawing *drawing;
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

void el_vertices_transform(el_drawing *d, uint32_t first, uint32_t count, el_screen_vertex *screen)
{
    d->transformed += count;
#if EL_WITH_WORKERS
    if (d->renderer->workers > 1 && !d->in_parts && count >= VERTICES_SHARED) {
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

void el_vertices_begin_cache(el_drawing *d)
{
    const uint32_t most = d->vertex_bytes / (uint32_t)(sizeof(el_screen_vertex) + sizeof(uint16_t));
    /* NOLINTNEXTLINE(clang-analyzer-core.*): there is room for a vertex at least. */
    d->slot_mask = (1U << (el_bit_length_u32(most) - 1)) - 1U;
    d->cached = (uint16_t *)(void *)(d->vertices + d->slot_mask + 1U);
    d->next_vertex = NO_VERTEX;
    memset(d->cached, 0xFF, (d->slot_mask + 1U) * sizeof d->cached[0]);
}

/* None of them is there until it is asked for. */
static void leave_vertices(const el_drawing *d)
{
    for (uint32_t i = 0; i < d->mesh->vertex_count; i++) {
        d->vertices[i].code = EL_CODE_LATER;
    }
}

/* A vertex that one triangle alone asks for is better made when that is looked at. */
static bool shares_nothing(const el_drawing *d)
{
    enum { LEAST = 16 }; /* triangles for which emptying a cache is worth it */
#if EL_CULLS_IN_VIEW
    return d->mesh->triangle_count >= LEAST && d->mesh->vertex_count >= 3U * d->mesh->triangle_count &&
           !d->list->is_shared;
#else
    (void)d;
    return false;
#endif
}

void el_vertices_place(el_drawing *d)
{
    el_renderer *const renderer = d->renderer;
    el_list *const list = d->list;
    uint8_t *const list_end = list->base + renderer->list_bytes;
    const uint32_t depth_bytes = renderer->painter.band_is_open ? 0U : renderer->depth_bytes;
    const uint32_t free_bytes = renderer->list_bytes - list->used;
    const uint32_t direct_bytes = d->mesh->vertex_count * (uint32_t)sizeof(el_screen_vertex);
    d->direct = direct_bytes <= depth_bytes + free_bytes / 4 && !shares_nothing(d);
    const uint32_t bytes = d->direct ? EL_ROUND_UP_8(direct_bytes)
                                     : (uint32_t)el_max_i32((int32_t)depth_bytes, (int32_t)(free_bytes / 8)) / 8 * 8;
    const uint32_t beside = bytes > depth_bytes ? bytes - depth_bytes : 0U;
    list->end = renderer->list_bytes - beside;
    d->vertices = (el_screen_vertex *)(void *)(list_end + depth_bytes - bytes);
    d->vertex_bytes = bytes;
#if EL_CULLS_IN_VIEW
    d->unshared_begin = 0;
    d->unshared_end = 0;
    d->stretch_end = 0;
    d->overlaid = 0;
#endif
    if (d->direct) {
        d->slot_mask = UINT16_MAX;
        if (d->by_clusters) {
            leave_vertices(d);
        } else {
#if EL_SMALL_CODE
            for (uint32_t i = 0; i < d->mesh->vertex_count; i++) {
                transform_one(d, i);
            }
#else
            el_vertices_transform(d, 0, d->mesh->vertex_count, d->vertices);
#endif
        }
    } else {
        el_vertices_begin_cache(d); /* el_draw saw to it that there is room for a vertex at least */
    }
}

#if EL_SMALL_CODE
void el_vertices_find(el_drawing *d, const uint16_t indices[3], el_screen_vertex *v[3], el_screen_vertex copies[3])
{
    for (unsigned i = 0; i < 3; i++) {
        const uint16_t index = indices[i];
        const uint32_t slot = index & d->slot_mask;
        if (!d->direct && d->cached[slot] != index) {
            d->cached[slot] = index;
            transform_one(d, index);
        }
        copies[i] = d->vertices[slot];
        v[i] = &copies[i];
    }
}
#else
void el_vertices_cache(el_drawing *d, uint32_t index)
{
    const uint32_t slot = index & d->slot_mask;
    uint32_t count = 1;
    if (index == d->next_vertex) {
        const uint32_t left = d->mesh->vertex_count - index;
        const uint32_t slots_left = d->slot_mask + 1U - slot;
        count = left < slots_left ? left : slots_left;
        count = count < VERTICES_AHEAD ? count : VERTICES_AHEAD;
    }
    d->next_vertex = index + count;
    el_vertices_transform(d, index, count, d->vertices + slot);
    for (uint32_t i = 0; i < count; i++) {
        d->cached[slot + i] = (uint16_t)(index + i);
    }
}

void el_vertices_find(el_drawing *d, const uint16_t indices[3], el_screen_vertex *v[3], el_screen_vertex copies[3])
{
    const bool in_place = d->direct ? !d->in_parts : el_vertices_are_cached(d, indices);
    for (unsigned i = 0; i < 3; i++) {
        const uint32_t slot = indices[i] & d->slot_mask;
        if (!d->direct && d->cached[slot] != indices[i]) {
            el_vertices_cache(d, indices[i]);
        }
        v[i] = &d->vertices[slot];
        if (!in_place) {
            copies[i] = *v[i];
            v[i] = &copies[i];
        }
    }
}
#endif
