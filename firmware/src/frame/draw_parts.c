/* A draw call's triangles, culled and listed by several cores.
 *
 * Each core takes a part of the triangles in a row, and a part of the list's free memory, with bins of its own. Names grow
 * with the memory, so joining the parts' bins one after the other keeps the order of submission; what a part leaves of its
 * memory is a gap, until the list needs it. A core whose part is full stops; what comes after that in the order of
 * submission is thrown away, and the caller's core goes on from there alone. */
#include <string.h>

#include "base/fixed.h"
#include "frame/drawing.h"

#if EL_WITH_WORKERS

enum {
    LEAST_TRIANGLES = 64, /* from so many on, the workers' start is worth it */
    LEAST_BYTES = 4096,   /* of a part: full ones cost what was drawn in vain */
    LEAST_CACHE_BYTES = 1024
};

/* What a core has made of its part. */
typedef struct part {
    el_list list;
    uint32_t stopped; /* the first triangle that it has not drawn */
    uint32_t transformed;
    uint32_t clipped;
    uint32_t verdicts[EL_VERDICTS];
} part;

typedef struct parts_job {
    const el_drawing *drawing;
    uint32_t begin; /* of the memory, and the bytes of each part of it */
    uint32_t bytes;
    part parts[EL_MAX_WORKERS];
} parts_job;

static uint32_t first_triangle(const el_drawing *d, uint32_t worker)
{
    return d->mesh->triangle_count * worker / d->renderer->workers; /* at most 2^16 * 8 */
}

static void draw_part(void *argument, unsigned worker)
{
    parts_job *const job = argument;
    const el_renderer *const renderer = job->drawing->renderer;
    part *const own = &job->parts[worker];
    el_drawing d = *job->drawing;
    el_list list = renderer->list;
    list.used = job->begin + worker * job->bytes;
    list.end = list.used + job->bytes - EL_LIST_BYTES(sizeof(el_run)); /* room for a gap's header */
    if (worker > 0) {
        list.bins = renderer->part_bins + (worker - 1U) * renderer->bin_stride;
        memset(list.bins, 0, list.bin_count * sizeof list.bins[0]);
    }
    d.list = &list;
    d.in_parts = true;
    if (!d.direct) {
        d.vertex_bytes = d.vertex_bytes / renderer->workers / 8 * 8;
        d.vertices = (el_screen_vertex *)(void *)((uint8_t *)d.vertices + worker * d.vertex_bytes);
        el_vertices_begin_cache(&d);
    }
    own->stopped = el_drawing_run(&d, first_triangle(&d, worker), first_triangle(&d, worker + 1U));
    own->list = list;
    own->transformed = d.transformed;
    own->clipped = d.clipped;
    memcpy(own->verdicts, d.verdicts, sizeof own->verdicts);
}

/* Counts what a part has done, which began with nothing. */
static void add_counts(el_drawing *d, const part *own)
{
    d->transformed += own->transformed;
    d->clipped += own->clipped;
    for (unsigned i = 0; i < EL_VERDICTS; i++) {
        d->verdicts[i] += own->verdicts[i];
    }
}

uint32_t el_drawing_run_in_parts(el_drawing *d)
{
    const el_renderer *const renderer = d->renderer;
    const uint32_t count = renderer->workers;
    const uint32_t bytes = (d->list->end - d->list->used) / count / EL_LIST_UNIT * EL_LIST_UNIT;
    if (count < 2 || d->mesh->triangle_count < LEAST_TRIANGLES || bytes < LEAST_BYTES ||
        (!d->direct && d->vertex_bytes / count < LEAST_CACHE_BYTES)) {
        return 0;
    }
    const el_workers *const workers = renderer->config.workers;
    const uint32_t transformed = d->transformed;
    parts_job job = {.drawing = d, .begin = d->list->used, .bytes = bytes};
    d->transformed = 0;
    workers->start(workers->context, draw_part, &job);
    draw_part(&job, 0);
    workers->wait(workers->context);
    d->transformed = transformed;
    if (!d->direct) {
        el_vertices_begin_cache(d); /* the parts' lay there */
    }

    uint32_t drawn = 0;
    const uint32_t end = d->list->end;
    for (uint32_t i = 0; i < count; i++) {
        part *const own = &job.parts[i];
        if (i == 0) {
            *d->list = own->list;
        } else {
            el_list_join(d->list, &own->list, job.begin + i * bytes);
        }
        add_counts(d, own);
        drawn = own->stopped;
        if (drawn != first_triangle(d, i + 1U)) {
            break;
        }
    }
    d->list->end = end;
    return drawn;
}

#endif
