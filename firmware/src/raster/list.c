#include "raster/list.h"

#include <string.h>

#include "base/fixed.h"
#include "raster/edge.h"
#include "raster/field.h"
#include "raster/triangle.h"
#include "raster/wires.h"

void el_list_init(el_list *list, void *memory, uint32_t bytes, uint16_t *bins, uint16_t bin_count, uint16_t band_lines)
{
    list->base = memory;
    list->end = bytes;
    list->bins = bins;
    list->band_lines = band_lines;
    list->bin_count = bin_count;
    list->is_shared = false;
    list->has_gaps = false;
#if EL_WITH_SAMPLES
    list->reach = 0;
#endif
#if EL_WITH_INTERLACED
    list->field = EL_FIELD_NONE;
#endif
    /* 2^s / lines rounded up is too much by less than lines / 2^s of 1 / lines, which rows below 2^11 take to less than
     * 1 / lines when 2^s >= 2^11 lines; so the whole part of their product is exact. The product is at most
     * 2^11 * (2^16 + 1). */
    const uint32_t lines_log2 = (uint32_t)el_bit_length_u32(band_lines - 1U);
    list->band_shift = (uint8_t)(16U + lines_log2);
    list->bands_per_row = ((1U << list->band_shift) + band_lines - 1U) / band_lines;
    el_list_clear(list);
}

void el_list_clear(el_list *list)
{
    list->used = EL_LIST_UNIT; /* the name 0 means none */
    list->run = 0;
    list->is_thin = false;
    list->has_gaps = false;
    memset(list->bins, 0, list->bin_count * sizeof list->bins[0]);
}

/* Opens a run at the end of the list. `state`: the draw call's, which it is the first run of; else NULL, and `draw` is the
 * state's name. */
static el_run *open_run(el_list *list, el_record_kind kind, const el_draw_state *state, uint16_t draw)
{
    el_run *const run = (el_run *)(void *)(list->base + list->used);
    list->run = (uint16_t)(list->used / EL_LIST_UNIT);
    list->used += EL_LIST_BYTES(sizeof *run);
    if (state != NULL) {
        draw = (uint16_t)(list->used / EL_LIST_UNIT);
        memmove(list->base + list->used, state, EL_DRAW_STATE_BYTES);
        list->used += EL_LIST_BYTES(EL_DRAW_STATE_BYTES);
    }
    *run = (el_run){.draw = draw, .kind = (uint8_t)kind};
    return run;
}

/* Puts a share of record `name` into the list's memory at byte `at`. Returns where it ends. */
static uint32_t put_share(const el_list *list, uint16_t name, uint32_t at, int32_t row)
{
    el_record *const share = (el_record *)(void *)(list->base + at);
    share->run = 0;
    share->index = name;
    share->at.row = (int16_t)row;
    el_list_put(list, share, row);
    return at + el_list_record_bytes(EL_RECORD_THIN);
}

#if EL_WITH_WORKERS
uint32_t el_list_share(const el_list *list, const el_record *record, uint32_t at, int32_t row, int32_t row_end)
{
    const uint32_t end = el_list_band_of(list, row_end - 1) + 1U;
    uint32_t band = el_list_band_of(list, row);
    for (band += EL_GROUP_BANDS - band % EL_GROUP_BANDS; band < end; band += EL_GROUP_BANDS) {
        at = put_share(list, el_list_name(list, record), at, (int32_t)(band * list->band_lines));
    }
    return at;
}
#endif

el_record *el_list_append(el_list *list, const el_draw_state *draw, el_record_kind kind, int32_t row, int32_t row_end)
{
    el_run *run = el_list_at(list, list->run);
    const bool opens_draw = list->run == 0;
    const bool opens_run = opens_draw || run->kind != (uint8_t)kind;
    const uint32_t bytes = el_list_record_bytes(kind);
    const uint32_t share_bytes = el_list_share_bytes(list, row, row_end);
    const uint32_t needed = bytes + share_bytes + (opens_run ? EL_LIST_BYTES(sizeof(el_run)) : 0U) +
                            (opens_draw ? EL_LIST_BYTES(EL_DRAW_STATE_BYTES) : 0U);
    if (needed > list->end - list->used) {
        return NULL;
    }
    if (opens_run) {
        const uint16_t draw_name = run->draw;
        el_list_end_draw(list);
        open_run(list, kind, opens_draw ? draw : NULL, draw_name);
    }
    el_record *const record = el_list_append_same(list, bytes, share_bytes, row);
#if EL_WITH_WORKERS
    if (share_bytes != 0) {
        list->used = el_list_share(list, record, list->used, row, row_end);
    }
#endif
    return record;
}

#if EL_WITH_WORKERS
/* Appends a bin to another one: both are rings, each named by its last record. */
static void join_bin(const el_list *list, uint16_t *bin, uint16_t more)
{
    if (*bin != 0 && more != 0) {
        el_record *const last = el_list_at(list, *bin);
        el_record *const more_last = el_list_at(list, more);
        const uint16_t first = last->next;
        last->next = more_last->next;
        more_last->next = first;
    }
    *bin = more != 0 ? more : *bin;
}

void el_list_join(el_list *list, const el_list *more, uint32_t begin)
{
    if (more->used == begin) {
        return;
    }
    el_list_end_draw(list);
    el_run *const gap = (el_run *)(void *)(list->base + list->used);
    *gap = (el_run){.end = (uint16_t)(begin / EL_LIST_UNIT), .kind = EL_RUN_IS_GAP};
    for (uint16_t band = 0; band < list->bin_count; band++) {
        join_bin(list, &list->bins[band], more->bins[band]);
    }
    list->used = more->used;
    list->run = more->run;
    list->has_gaps = true;
}
#endif

static int32_t first_row(const el_list *list, const el_record *record, el_record_kind kind, int32_t reach)
{
    if (EL_WITH_THIN && kind == EL_RECORD_THIN) {
        return record->at.row;
    }
    const el_point *const points = record->at.points;
    const int32_t top = el_min3_i32(points[0].y, points[1].y, points[2].y);
    return el_field_row(el_list_field(list), el_first_centre(top - reach));
}

typedef struct run_records {
    uint32_t begin, end; /* bytes from the list's base */
    el_record_kind kind;
    int32_t reach; /* as in a culling (frame/cull.h) */
} run_records;

/* Moves the records of one run that begin above row_end to the end of the list's new part, `wanted` being their kind
 * there. */
static void move_records(el_list *list, const run_records *from, el_record_kind wanted, int32_t row_begin,
                         int32_t row_end)
{
    uint16_t kept = 0; /* name of the record whose shares come next, in the new part; 0: it is not there */
    for (uint32_t at = from->begin; at < from->end;) {
        const uint8_t *const old = list->base + at;
        if (EL_WITH_WORKERS && ((const el_record *)(const void *)old)->run == 0) {
            at += el_list_record_bytes(EL_RECORD_THIN);
            const int32_t group_row = ((const el_record *)(const void *)old)->at.row;
            if (kept != 0 && group_row < row_end) {
                list->used = put_share(list, kept, list->used, group_row);
            }
            continue;
        }
        at += el_list_record_bytes(from->kind);
        kept = 0;
        const int32_t row = first_row(list, (const el_record *)(const void *)old, from->kind, from->reach);
        if (row >= row_end) {
            continue;
        }
        el_record *const record = (el_record *)(void *)(list->base + list->used);
        memmove(record, old, el_list_record_bytes(wanted));
        if (EL_WITH_THIN && wanted == EL_RECORD_THIN) {
            record->at.row = (int16_t)row;
        }
        record->run = list->run;
        el_list_put(list, record, el_max_i32(row, row_begin));
        list->used += el_list_record_bytes(wanted);
        kept = el_list_name(list, record);
    }
}

/* How far beyond its corners a draw's triangles have pixels. */
static int32_t reach_of(const el_list *list, const el_draw_state *draw)
{
#if EL_WITH_WIRES
    if (el_draws_wires(draw)) {
        return EL_WIRE_REACH;
    }
#endif
    (void)draw;
    return EL_WITH_SAMPLES ? list->reach : 0;
}

/* Walks the list and writes what is kept over it: what is written never reaches what is still to be read. */
static void compact(el_list *list, int32_t row_begin, int32_t row_end, bool make_thin)
{
    const uint32_t used = list->used;
    const uint16_t open = list->run;
    uint16_t open_now = 0;
    uint32_t draw_at = 0; /* the kept draw's first run, and the end of its state */
    uint32_t draw_end = 0;
    el_list_clear(list);
    list->is_thin = make_thin;
    for (uint32_t at = EL_LIST_UNIT; at < used;) {
        const el_run old = *(const el_run *)(const void *)(list->base + at);
        if (EL_WITH_WORKERS && old.kind == EL_RUN_IS_GAP) {
            at = old.end * (uint32_t)EL_LIST_UNIT;
            continue;
        }
        const bool is_open = at / EL_LIST_UNIT == open;
        const el_record_kind kind = (el_record_kind)old.kind;
        const uint32_t old_end = is_open ? used : old.end * (uint32_t)EL_LIST_UNIT;
        const el_record_kind wanted =
            make_thin && (kind == EL_RECORD_PLAIN || kind == EL_RECORD_PERSPECTIVE) ? EL_RECORD_THIN : kind;
        at += EL_LIST_BYTES(sizeof(el_run));
        const bool opens_draw = at / EL_LIST_UNIT == old.draw;
        if (opens_draw && list->used == draw_end) {
            list->used = draw_at; /* nothing was left of the draw before */
        }
        const uint32_t run_at = list->used;
        const uint16_t draw = (uint16_t)(draw_at / EL_LIST_UNIT + 1U);
        el_run *const run = open_run(list, wanted, opens_draw ? el_list_at(list, old.draw) : NULL, draw);
        at += opens_draw ? EL_LIST_BYTES(EL_DRAW_STATE_BYTES) : 0U;
        if (opens_draw) {
            draw_at = run_at;
            draw_end = list->used;
        }
        const uint32_t records_at = list->used;
        const el_draw_state *const state = (const el_draw_state *)el_list_at(list, run->draw);
        const run_records from = {.begin = at, .end = old_end, .kind = kind, .reach = reach_of(list, state)};
        move_records(list, &from, wanted, row_begin, row_end);
        at = old_end;
        run->end = (uint16_t)(list->used / EL_LIST_UNIT);
        if (is_open) {
            open_now = list->run;
        } else if (list->used == records_at && !opens_draw) {
            list->used = run_at;
        }
    }
    if (open == 0 && list->used == draw_end) {
        list->used = draw_at;
    }
    list->run = open_now;
}

void el_list_keep_rows(el_list *list, int32_t row_begin, int32_t row_end)
{
    compact(list, row_begin, row_end, el_list_is_thin(list));
}

#if EL_WITH_THIN
void el_list_make_thin(el_list *list, int32_t row_begin)
{
    compact(list, row_begin, INT32_MAX, true);
}
#endif

uint16_t el_list_take_bin(const el_list *list, uint16_t band)
{
    const uint16_t last_name = list->bins[band];
    if (last_name == 0) {
        return 0;
    }
    el_record *const last = el_list_at(list, last_name);
    const uint16_t first = last->next;
    last->next = 0;
    list->bins[band] = 0;
    return first;
}
