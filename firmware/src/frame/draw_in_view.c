/* A draw call's triangles that are simple: within the view or all beside it. Nearly all are.
 *
 * They take two loops, because one would need more registers than there are: the first looks at triangles and writes the
 * records of those that are seen, the second puts these into their bins. */
#include "base/fixed.h"
#include "frame/drawing.h"

#if EL_CULLS_IN_VIEW

enum {
    STRETCH = 64,      /* triangles, at most */
    LEAST_STRETCH = 4, /* so many are worth what they push out of the cache */
    CHUNK = 32         /* triangles, after which another stretch is looked for */
};

/* From here on a pointer is one number. Compilers would keep what it was made of, too, for which there are no registers. */
#define EL_FORGET(pointer) __asm__("" : "+r"(pointer))

/* Where a triangle's vertices are. */
typedef enum source {
    DIRECT,   /* all are at their places */
    CACHED,   /* in the cache, once they are put there */
    STRETCHED /* behind those of the triangle before */
} source;

/* Puts the records in [record, end) of the open run into their bins; each one's `next` has its first row in the pass. */
static EL_APART void put_records(el_drawing *d, uint8_t *record, const uint8_t *end, uint32_t record_bytes)
{
    const el_list list = *d->list;
    uint32_t count = 0;
    for (; record != end; record += record_bytes) {
        el_record *const r = (el_record *)(void *)record;
        el_list_put(&list, r, r->next);
        count++;
    }
    d->verdicts[EL_VERDICT_SEEN] += count;
}

/* Not an array's address: the corners would be kept in memory for it. */
static EL_APART void fill_perspective(el_record *record, const el_screen_vertex *a, const el_screen_vertex *b,
                                      const el_screen_vertex *c)
{
    const el_screen_vertex *const v[3] = {a, b, c};
    el_fill_record(record, record->index, v, EL_RECORD_PERSPECTIVE, 0);
}

/* Triangles so far that do not face away, which are not counted one by one. */
static inline uint32_t all_but_backs(const el_drawing *d)
{
    return d->verdicts[EL_VERDICT_EMPTY] + d->verdicts[EL_VERDICT_OUTSIDE] + d->verdicts[EL_VERDICT_OTHER] +
           d->verdicts[EL_VERDICT_SEEN];
}

/* Looks at the triangles from number `index` on while they are simple, and there is room for the record in the open run.
 * Returns the number of the first that is not. `shared` as in the list; `reach` as in the culling. */
static EL_SPECIALISED uint32_t list_in_view(el_drawing *d, uint32_t index, uint32_t end, source from, bool shared,
                                            uint32_t reach)
{
    const el_list list = *d->list;
    const el_record_kind kind = el_drawing_kind(d);
    const uint32_t record_bytes = el_list_record_bytes(kind);
    const bool is_open = list.run != 0 && ((const el_run *)el_list_at(&list, list.run))->kind == (uint8_t)kind;
    uint8_t *next = list.base + list.used;
    const uint8_t *const last = list.base + (is_open ? list.end - record_bytes : 0U); /* where there is room for one */
    const el_culling culling = d->culling;
    const el_screen_vertex *const vertices = d->vertices;
    const uint32_t slot_mask = from == CACHED ? d->slot_mask : UINT16_MAX;
    const uint16_t(*triangle)[3] = &d->mesh->triangles[index];
    const uint32_t step = from == STRETCHED ? 3U : 0U;
    const el_screen_vertex *stretched = vertices + step * (index - d->stretch_begin);
    const uint32_t first = index;
    const uint32_t others = all_but_backs(d);
    for (; index < end; index++, triangle++, stretched += step) {
        if (from == CACHED && !el_vertices_are_cached(d, *triangle)) {
            break;
        }
        const el_screen_vertex *v[3] = {stretched, stretched + 1, stretched + 2};
        if (from != STRETCHED) {
            v[0] = vertices + ((*triangle)[0] & slot_mask);
            v[1] = vertices + ((*triangle)[1] & slot_mask);
            v[2] = vertices + ((*triangle)[2] & slot_mask);
            for (unsigned i = 0; i < 3; i++) {
                EL_FORGET(v[i]);
            }
        }
        if ((v[0]->code | v[1]->code | v[2]->code) != 0) {
            if ((v[0]->code & v[1]->code & v[2]->code & EL_CODE_OUTSIDE) == 0) {
                break;
            }
            d->verdicts[EL_VERDICT_OUTSIDE]++;
            continue;
        }
        el_cull_rows rows;
        const el_verdict verdict = el_cull_in_view(&culling, v[0], v[1], v[2], reach, &rows);
        if (verdict != EL_VERDICT_SEEN) {
            if (verdict != EL_VERDICT_BACK) {
                d->verdicts[verdict]++;
            }
            continue;
        }
        const int32_t row_end = el_min_i32(rows.end, culling.row_end);
        if (next > last || (shared && el_list_share_bytes(&list, rows.begin, row_end) > (uint32_t)(last - next))) {
            break;
        }
        el_record *const record = (el_record *)(void *)next;
        record->next = (uint16_t)rows.begin;
        record->run = list.run;
        record->index = (uint16_t)index;
        EL_READ_AGAIN();
        if (kind == EL_RECORD_PLAIN) {
            el_fill_points(record, v);
        } else if (kind == EL_RECORD_THIN) {
            record->at.row = (int16_t)rows.first;
        } else {
            fill_perspective(record, v[0], v[1], v[2]);
        }
        next += record_bytes;
#if EL_WITH_WORKERS
        if (shared) {
            put_records(d, (uint8_t *)record, next, record_bytes);
            next = list.base + el_list_share(&list, record, (uint32_t)(next - list.base), rows.begin, row_end);
        }
#endif
    }
    if (!shared) {
        put_records(d, list.base + list.used, next, record_bytes);
    }
    d->list->used = (uint32_t)(next - list.base);
    d->verdicts[EL_VERDICT_BACK] += index - first - (all_but_backs(d) - others);
    return index;
}

static EL_APART uint32_t list_direct(el_drawing *d, uint32_t index, uint32_t end)
{
    return list_in_view(d, index, end, DIRECT, false, 0);
}

static EL_APART uint32_t list_stretched(el_drawing *d, uint32_t index, uint32_t end)
{
    return list_in_view(d, index, end, STRETCHED, false, 0);
}

/* How many of the next triangles, a few at least, ask for one vertex after the other; 0: fewer. In pairs, which are three
 * words where they are aligned. */
static uint32_t stretch_length(const el_drawing *d, uint32_t index, uint32_t end)
{
    const uint16_t *const triangle = d->mesh->triangles[index];
    const uint32_t vertex = triangle[0];
    const uint32_t most = el_min_u32(el_min_u32(end - index, (d->slot_mask + 1U) / 3U), STRETCH);
    if (most < LEAST_STRETCH || triangle[1] != vertex + 1U || triangle[5] != vertex + 5U ||
        vertex + 3U * most > d->mesh->vertex_count || ((uintptr_t)triangle & 3U) != 0) {
        return 0;
    }
    typedef uint32_t __attribute__((may_alias)) pair_of_u16;
    const pair_of_u16 *words = (const pair_of_u16 *)(const void *)triangle;
    /* No half overflows: there are vertices of these numbers. */
    uint32_t expected = words[0];
    uint32_t length = 0;
    while (length + 2U <= most && words[0] == expected && words[1] == expected + 0x20002U &&
           words[2] == expected + 0x40004U) {
        expected += 0x60006U;
        words += 3;
        length += 2U;
    }
    return length >= LEAST_STRETCH ? length : 0U;
}

/* Looks for triangles without shared vertices from number `index` on; whether it looks at them before their vertices
 * depends on how many of the last ones were outside. */
static void begin_unshared(el_drawing *d, uint32_t index, uint32_t end)
{
    const uint32_t outside = d->verdicts[EL_VERDICT_OUTSIDE];
    const uint32_t before = d->unshared_end - d->unshared_begin;
    d->looks_beside = before != 0 && (outside - d->outside_before) * 4U >= before;
    d->outside_before = outside;
    d->unshared_begin = index;
    d->unshared_end = index + stretch_length(d, index, end);
    if (d->looks_beside && !d->has_sides) {
        el_sides_make(d->sides, &d->state->transform, d->mesh);
        d->has_sides = true;
    }
}

/* Transforms the vertices of the next triangles without shared vertices that are not found to be beside the view. Returns
 * the number of the first of them, or d->unshared_end. */
static uint32_t begin_stretch(el_drawing *d, uint32_t index)
{
    uint32_t stop = d->unshared_end;
    if (d->looks_beside) {
        const int16_t(*corners)[3] = &d->mesh->positions[d->mesh->triangles[index][0]];
        const int16_t(*const first)[3] = corners;
        while (index < stop && el_sides_are_passed(d->sides, corners)) {
            index++;
            corners += 3;
        }
        d->verdicts[EL_VERDICT_OUTSIDE] += (uint32_t)(corners - first) / 3U;
        stop = index;
        while (stop < d->unshared_end && (stop == index || !el_sides_are_passed(d->sides, corners))) {
            stop++;
            corners += 3;
        }
    }
    d->stretch_begin = index;
    d->stretch_end = stop;
    if (index < stop) {
        const uint32_t count = 3U * (stop - index);
        d->overlaid = d->overlaid > count ? d->overlaid : count;
        el_vertices_transform(d, d->mesh->triangles[index][0], count, d->vertices);
    }
    return index;
}

/* Triangles whose vertices wait in the cache or are to be put there. Meshes without shared vertices need no look at it. */
static uint32_t list_cached(el_drawing *d, uint32_t index, uint32_t end)
{
    while (index < end) {
        uint32_t stop;
        if (index >= d->stretch_end) {
            if (index >= d->unshared_end) {
                begin_unshared(d, index, end);
            }
            if (index < d->unshared_end) {
                index = begin_stretch(d, index);
                if (index == d->unshared_end) {
                    continue;
                }
            }
        }
        if (index < d->stretch_end) {
            stop = d->stretch_end;
            index = list_stretched(d, index, stop);
        } else {
            el_vertices_clear_overlaid(d);
            stop = el_min_u32(end, index + CHUNK - index % 2U);
            index = list_in_view(d, index, stop, CACHED, false, 0);
        }
        if (index != stop) {
            break;
        }
    }
    return index;
}

#if EL_WITH_SAMPLES || EL_WITH_WIRES || EL_WITH_INTERLACED
/* Where pixels have several samples: what is taken into account of a triangle is a little larger. That of wires is too large
 * for el_cull_in_view, which knows no fields, either. */
static EL_APART uint32_t list_special(el_drawing *d, uint32_t index, uint32_t end)
{
    if (el_draws_wires(d->state) || d->culling.field != EL_FIELD_NONE) {
        return index;
    }
    return list_in_view(d, index, end, d->direct ? DIRECT : CACHED, d->list->is_shared, (uint32_t)d->culling.reach);
}
#endif

uint32_t el_drawing_list_in_view(el_drawing *d, uint32_t index, uint32_t end)
{
#if EL_WITH_SAMPLES || EL_WITH_WIRES || EL_WITH_INTERLACED
    if (d->is_special) {
        return list_special(d, index, end);
    }
#endif
    if (EL_WITH_WORKERS && d->list->is_shared) {
        return list_in_view(d, index, end, d->direct ? DIRECT : CACHED, true, 0);
    }
    return d->direct ? list_direct(d, index, end) : list_cached(d, index, end);
}

#endif
