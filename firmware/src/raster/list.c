#include "raster/list.h"

#include <string.h>

#include "base/fixed.h"

#define ROUND_UP(bytes) ((uint32_t)((bytes) + EL_LIST_UNIT - 1) / EL_LIST_UNIT * EL_LIST_UNIT)

static uint32_t record_bytes(el_record_kind kind)
{
    static const uint8_t bytes[EL_RECORD_KINDS] = {
        [EL_RECORD_THIN] = ROUND_UP(EL_THIN_BYTES),
        [EL_RECORD_PLAIN] = ROUND_UP(sizeof(el_record)),
        [EL_RECORD_CUT] = ROUND_UP(sizeof(el_record)),
        [EL_RECORD_PERSPECTIVE] = ROUND_UP(sizeof(el_record_perspective)),
        [EL_RECORD_CLIPPED] = ROUND_UP(sizeof(el_record_clipped)),
    };
    return bytes[kind];
}

void el_list_init(el_list *list, void *memory, uint32_t bytes, uint16_t *bins, uint16_t bin_count, uint16_t band_lines)
{
    list->base = memory;
    list->end = bytes;
    list->bins = bins;
    list->bin_count = bin_count;
    list->band_lines = band_lines;
#if !EL_SMALL_CODE
    list->rows_to_bands = 0xFFFFFFFFU / band_lines + 1ULL;
#endif
    el_list_clear(list);
}

void el_list_clear(el_list *list)
{
    list->used = EL_LIST_UNIT; /* the name 0 means none */
    list->run = 0;
    list->is_thin = false;
    memset(list->bins, 0, list->bin_count * sizeof list->bins[0]);
}

static uint16_t name_of(const el_list *list, const void *at)
{
    return (uint16_t)((uint32_t)((const uint8_t *)at - list->base) / EL_LIST_UNIT);
}

static void put_into_bin(el_list *list, el_record *record, int32_t row)
{
#if EL_SMALL_CODE
    uint16_t *const bin = &list->bins[(uint32_t)row / list->band_lines];
#else
    uint16_t *const bin = &list->bins[el_multiply_u16(list->rows_to_bands, (uint32_t)row) >> 32];
#endif
    const uint16_t name = name_of(list, record);
    if (*bin == 0) {
        record->next = name;
    } else {
        el_record *const last = el_list_at(list, *bin);
        record->next = last->next;
        last->next = name;
    }
    *bin = name;
}

/* Opens a run at the end of the list. `state`: the draw call's, which it is the first run of; else NULL, and `draw` is the
 * state's name. */
static el_run *open_run(el_list *list, el_record_kind kind, const el_draw_state *state, uint16_t draw)
{
    el_run *const run = (el_run *)(void *)(list->base + list->used);
    list->run = name_of(list, run);
    list->used += ROUND_UP(sizeof *run);
    if (state != NULL) {
        draw = (uint16_t)(list->used / EL_LIST_UNIT);
        memmove(list->base + list->used, state, EL_DRAW_STATE_BYTES);
        list->used += ROUND_UP(EL_DRAW_STATE_BYTES);
    }
    *run = (el_run){.draw = draw, .count = 0, .kind = (uint8_t)kind};
    return run;
}

el_record *el_list_append(el_list *list, const el_draw_state *draw, el_record_kind kind, int32_t row)
{
    el_run *run = el_list_at(list, list->run);
    const bool opens_draw = list->run == 0;
    const bool opens_run = opens_draw || run->kind != (uint8_t)kind || run->count == UINT16_MAX;
    const uint32_t needed = record_bytes(kind) + (opens_run ? ROUND_UP(sizeof(el_run)) : 0U) +
                            (opens_draw ? ROUND_UP(EL_DRAW_STATE_BYTES) : 0U);
    if (needed > list->end || list->used > list->end - needed) {
        return NULL;
    }
    if (opens_run) {
        run = open_run(list, kind, opens_draw ? draw : NULL, run->draw);
    }
    el_record *const record = (el_record *)(void *)(list->base + list->used);
    list->used += record_bytes(kind);
    run->count++;
    record->run = list->run;
    put_into_bin(list, record, row);
    return record;
}

static int32_t first_row(const el_record *record, el_record_kind kind)
{
    if (EL_WITH_THIN && kind == EL_RECORD_THIN) {
        return record->at.row;
    }
    const el_point *const points = record->at.points;
    return el_first_centre(el_min_i32(points[0].y, el_min_i32(points[1].y, points[2].y)));
}

/* Moves the records of one run that begin above row_end to the end of the list's new part, `wanted` being their kind
 * there. */
static void move_records(el_list *list, const el_run *from, const uint8_t *old, el_record_kind wanted,
                         int32_t row_begin, int32_t row_end)
{
    el_run *const run = el_list_at(list, list->run);
    const el_record_kind kind = (el_record_kind)from->kind;
    for (uint16_t i = 0; i < from->count; i++, old += record_bytes(kind)) {
        const int32_t row = first_row((const el_record *)(const void *)old, kind);
        if (row >= row_end) {
            continue;
        }
        el_record *const record = (el_record *)(void *)(list->base + list->used);
        memmove(record, old, record_bytes(wanted));
        if (EL_WITH_THIN && wanted == EL_RECORD_THIN) {
            record->at.row = (int16_t)row;
        }
        record->run = list->run;
        put_into_bin(list, record, el_max_i32(row, row_begin));
        list->used += record_bytes(wanted);
        run->count++;
    }
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
        const bool is_open = at / EL_LIST_UNIT == open;
        const el_record_kind kind = (el_record_kind)old.kind;
        const el_record_kind wanted =
            make_thin && (kind == EL_RECORD_PLAIN || kind == EL_RECORD_PERSPECTIVE) ? EL_RECORD_THIN : kind;
        at += ROUND_UP(sizeof(el_run));
        const bool opens_draw = at / EL_LIST_UNIT == old.draw;
        if (opens_draw && list->used == draw_end) {
            list->used = draw_at; /* nothing was left of the draw before */
        }
        const uint32_t run_at = list->used;
        const uint16_t draw = (uint16_t)(draw_at / EL_LIST_UNIT + 1U);
        el_run *const run = open_run(list, wanted, opens_draw ? el_list_at(list, old.draw) : NULL, draw);
        at += opens_draw ? ROUND_UP(EL_DRAW_STATE_BYTES) : 0U;
        if (opens_draw) {
            draw_at = run_at;
            draw_end = list->used;
        }
        move_records(list, &old, list->base + at, wanted, row_begin, row_end);
        at += old.count * record_bytes(kind);
        if (is_open) {
            open_now = list->run;
        } else if (run->count == 0 && !opens_draw) {
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

uint16_t el_list_take_bin(el_list *list, uint16_t band)
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
