/* A draw call under way: what its parts know of each other. Internal to the frame layer. */
#ifndef EL_FRAME_DRAWING_H
#define EL_FRAME_DRAWING_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "frame/cull.h"
#include "frame/renderer.h"
#include "geometry/sides.h"

/* The mesh's vertices on the screen, at the end of the list's memory. `direct`: all of them, each transformed once
 * before the triangles are looked at. Otherwise a direct-mapped cache, for meshes that do not fit: a vertex is
 * transformed when a triangle asks for it and may be asked for again after another took its place. Where triangles ask
 * for one vertex after the other, as they do in most meshes, several are transformed at a time. */
typedef struct el_drawing {
    el_renderer *renderer;
    const el_mesh *mesh;
    const el_draw_state *state;
    el_list *list; /* the renderer's, or a part of it */
    bool direct;
    bool by_clusters;    /* the mesh has some: vertices wait until a cluster or a triangle needs them */
    bool in_parts;       /* other cores draw too: a vertex of all is not written, and the list is not made smaller */
    el_record_kind kind; /* of its triangles */
    el_record_kind cut_kind; /* of those that are cut */
    uint32_t slot_mask;      /* a vertex' slot is its index & slot_mask */
    uint32_t next_vertex;    /* the one behind those that were put into the cache last */
    el_screen_vertex *vertices;
    uint32_t vertex_bytes; /* of memory there */
    uint16_t *cached;      /* indices of the vertices in the cache's slots */
    el_culling culling;
#if EL_CULLS_IN_VIEW
    /* Triangles [begin, end) ask for vertices that no other one asks for: those of the stretch lie at d->vertices in their
     * order, and so over some slots of the cache. */
    uint32_t unshared_begin, unshared_end;
    uint32_t stretch_begin, stretch_end;
    bool is_special;         /* not what list_direct and list_cached are for */
    uint32_t overlaid;       /* slots whose vertices are not what `cached` says */
    uint32_t outside_before; /* verdicts when unshared_begin was set */
    bool looks_beside;       /* at the sides, before vertices are transformed */
    bool has_sides;
    el_side *sides; /* EL_SIDES of them; parts, which do not look, have none */
#endif
    uint32_t transformed;           /* vertices so far */
    uint32_t verdicts[EL_VERDICTS]; /* how many triangles had each */
    uint32_t clipped;
} el_drawing;

/* The kind of the records of its whole triangles, now. */
static inline el_record_kind el_drawing_kind(const el_drawing *d)
{
    return el_list_is_thin(d->list) ? EL_RECORD_THIN : d->kind;
}

static EL_SPECIALISED void el_fill_point(el_point *point, const el_screen_vertex *v)
{
#if EL_CULLS_IN_VIEW && defined(EL_PRODUCTS_IN_HALVES)
    /* As half words without a sign, which Thumb's first set loads at once. */
    *(uint16_t *)&point->x = *(const uint16_t *)&v->x;
    *(uint16_t *)&point->y = *(const uint16_t *)&v->y;
#else
    point->x = v->x;
    point->y = v->y;
#endif
    point->z = v->z;
}

static EL_SPECIALISED void el_fill_points(el_record *record, const el_screen_vertex *const v[3])
{
    el_fill_point(&record->at.points[0], v[0]);
    el_fill_point(&record->at.points[1], v[1]);
    el_fill_point(&record->at.points[2], v[2]);
}

/* What a whole triangle's record of that kind holds beside its run. */
static EL_SPECIALISED void el_fill_record(el_record *record, uint16_t index, const el_screen_vertex *const v[3],
                                          el_record_kind kind, int32_t first_row)
{
    record->index = index;
    if (EL_WITH_THIN && kind == EL_RECORD_THIN) {
        record->at.row = (int16_t)first_row;
        return;
    }
    el_fill_points(record, v);
    if (EL_WITH_TEXTURE && kind >= EL_RECORD_PERSPECTIVE) {
        el_record_perspective *const perspective = (el_record_perspective *)(void *)record;
        perspective->w[0] = v[0]->w;
        perspective->w[1] = v[1]->w;
        perspective->w[2] = v[2]->w;
        perspective->w_shifts = (uint16_t)(v[0]->w_shift | v[1]->w_shift << 5 | v[2]->w_shift << 10);
    }
}

/* Places the vertices: over the depth bands if no band is open, and over at most a quarter of the list's free memory. */
void el_vertices_place(el_drawing *d);

/* Transforms `count` vertices from `first` on to `screen`. */
void el_vertices_transform(el_drawing *d, uint32_t first, uint32_t count, el_screen_vertex *screen);

/* Begins an empty cache in d->vertex_bytes at d->vertices; there is room for a vertex at least. */
void el_vertices_begin_cache(el_drawing *d);

/* Puts a vertex into the cache, and those that follow it when it follows the one before. */
void el_vertices_cache(el_drawing *d, uint32_t index);

/* A triangle's vertices: at their places, or where two of them share one in the cache, in small code, and in parts, copies. */
void el_vertices_find(el_drawing *d, const uint16_t indices[3], el_screen_vertex *v[3], el_screen_vertex copies[3]);

#if EL_CULLS_IN_VIEW
/* The cache is to be looked at again after a stretch. */
static inline void el_vertices_clear_overlaid(el_drawing *d)
{
    if (d->overlaid != 0) {
        memset(d->cached, 0xFF, d->overlaid * sizeof d->cached[0]);
        d->overlaid = 0;
    }
}

/* Draws the triangles from number `index` on while they are simple: within the view or all beside it, and room for the
 * record in the open run. Returns the number of the first that is not. */
uint32_t el_drawing_list_in_view(el_drawing *d, uint32_t index, uint32_t end);
#endif

#if !EL_SMALL_CODE
/* Puts a triangle's vertices into the cache. False where they do not go there together. */
static inline bool el_vertices_are_cached(el_drawing *d, const uint16_t indices[3])
{
    const uint16_t *const a = &d->cached[indices[0] & d->slot_mask];
    const uint16_t *const b = &d->cached[indices[1] & d->slot_mask];
    const uint16_t *const c = &d->cached[indices[2] & d->slot_mask];
    if (*a == indices[0] && *b == indices[1] && *c == indices[2]) {
        return true;
    }
    for (unsigned i = 0; i < 3; i++) {
        if (d->cached[indices[i] & d->slot_mask] != indices[i]) {
            el_vertices_cache(d, indices[i]);
        }
    }
    return *a == indices[0] && *b == indices[1] && *c == indices[2];
}
#endif

#if EL_WITH_WORKERS || EL_WITH_CLUSTERS
/* Draws the triangles [begin, end). Returns `end`; in parts, the first for which the list may have no room. */
uint32_t el_drawing_run(el_drawing *d, uint32_t begin, uint32_t end);
#endif

#if EL_WITH_CLUSTERS
/* Draws those clusters of the mesh that may be seen. Returns how many triangles the others have. */
uint32_t el_drawing_run_clusters(el_drawing *d);
#endif

#if EL_WITH_WORKERS
/* Draws the first triangles of the mesh by all cores, or none where that is not worth it. Returns how many. */
uint32_t el_drawing_run_in_parts(el_drawing *d);
#endif

#endif
