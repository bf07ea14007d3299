#include "raster/list.h"

#include <string.h>

#include "base/fixed.h"

#define ROUND_UP(bytes) ((uint32_t)((bytes) + EL_LIST_UNIT - 1) / EL_LIST_UNIT * EL_LIST_UNIT)

static uint32_t record_bytes(el_record_kind kind)
{
    static const uint8_t bytes[EL_RECORD_KINDS] = {
        [EL_RECORD_PLAIN] = ROUND_UP(sizeof(el_record)),
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
    el_list_clear(list);
}

void el_list_clear(el_list *list)
{
    list->used = EL_LIST_UNIT; /* the name 0 means none */
    list->run = 0;
    memset(list->bins, 0, list->bin_count * sizeof list->bins[0]);
}

static uint16_t name_of(const el_list *list, const void *at)
{
    return (uint16_t)((uint32_t)((const uint8_t *)at - list->base) / EL_LIST_UNIT);
}

static void put_into_bin(el_list *list, el_record *record, int32_t row)
{
    uint16_t *const bin = &list->bins[(uint32_t)row / list->band_lines];
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

el_record *el_list_append(el_list *list, const el_draw_state *draw, el_record_kind kind, int32_t row)
{
    el_run *run = el_list_at(list, list->run);
    const bool opens = list->run == 0 || run->kind != (uint8_t)kind || run->count == UINT16_MAX;
    const uint32_t needed = record_bytes(kind) + (opens ? ROUND_UP(sizeof(el_run)) : 0U);
    if (needed > list->end || list->used > list->end - needed) {
        return NULL;
    }
    if (opens) {
        list->run = (uint16_t)(list->used / EL_LIST_UNIT);
        run = el_list_at(list, list->run);
        *run = (el_run){.draw = *draw, .count = 0, .kind = (uint8_t)kind};
        list->used += ROUND_UP(sizeof(el_run));
    }
    el_record *const record = (el_record *)(void *)(list->base + list->used);
    list->used += record_bytes(kind);
    run->count++;
    record->run = list->run;
    put_into_bin(list, record, row);
    return record;
}

static int32_t first_row(const el_record *record)
{
    const el_point *const points = record->at.points;
    return el_first_centre(el_min_i32(points[0].y, el_min_i32(points[1].y, points[2].y)));
}

void el_list_keep_rows(el_list *list, int32_t row_begin, int32_t row_end)
{
    const uint32_t used = list->used;
    const uint16_t open_run = list->run;
    el_list_clear(list);
    uint32_t from = EL_LIST_UNIT;
    while (from < used) {
        const bool is_open = from / EL_LIST_UNIT == open_run;
        el_run *const old_run = (el_run *)(void *)(list->base + from);
        const el_record_kind kind = (el_record_kind)old_run->kind;
        const uint32_t stride = record_bytes(kind);
        const uint16_t count = old_run->count;
        const uint32_t run_at = list->used;
        el_run *const run = (el_run *)(void *)(list->base + run_at);
        memmove(run, old_run, sizeof *run);
        run->count = 0;
        list->used += ROUND_UP(sizeof *run);
        from += ROUND_UP(sizeof *run);
        for (uint16_t i = 0; i < count; i++, from += stride) {
            const el_record *const old = (const el_record *)(const void *)(list->base + from);
            const int32_t row = el_max_i32(first_row(old), row_begin);
            if (row < row_end) {
                el_record *const record = (el_record *)(void *)(list->base + list->used);
                memmove(record, old, stride);
                record->run = (uint16_t)(run_at / EL_LIST_UNIT);
                put_into_bin(list, record, row);
                list->used += stride;
                run->count++;
            }
        }
        if (is_open) {
            list->run = (uint16_t)(run_at / EL_LIST_UNIT);
        } else if (run->count == 0) {
            list->used = run_at;
        }
    }
}

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
