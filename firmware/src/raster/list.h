/* The display list: the triangles of a pass, binned by the band in which they begin.
 *
 * Runs follow each other in one block of memory, in the order of submission: a run is a header and its records, one per
 * triangle, all of one kind; the first run of a draw call has the call's state behind its header. A record holds the
 * snapped corners only; colours and texture coordinates stay in the mesh until the triangle is set up. That costs 24 or
 * 32 bytes (48 or 56 with more than 4 sub-pixel bits) per visible triangle and nothing for those that are not. Triangles
 * that were cut carry their own attributes.
 *
 * A list that is full can be made thin: its whole triangles keep 8 bytes each, and their vertices are transformed again
 * when they are set up, by the same function from the same numbers. Three times as many triangles fit, which saves
 * passes, and each pass looks at every vertex of the scene.
 *
 * Where several cores draw, each draws groups of neighbouring bands, and a triangle that reaches into further groups has a
 * share in each: 8 bytes behind its record, in the bin of the group's first band. So a group has all that is drawn into it
 * in its own bins, and no core writes what another one reads: records are written no more, but for the `next` of what is
 * in a bin.
 *
 * Records are named by their offset in units of 8 bytes, so a later record has a larger name: comparing names compares
 * the order of submission, which decides ties in depth. A bin is a circular list, named by its last record, so that
 * appending and taking from the front are both one step. */
#ifndef EL_RASTER_LIST_H
#define EL_RASTER_LIST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "geometry/transform.h"
#include "raster/material.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { EL_LIST_UNIT = 8, EL_LIST_MAX_BYTES = 65535 * EL_LIST_UNIT };
#define EL_LIST_BYTES(bytes) (((uint32_t)(bytes) + EL_LIST_UNIT - 1U) / EL_LIST_UNIT * EL_LIST_UNIT)

enum { EL_GROUP_BANDS = 2 }; /* as many as a core has buffers for */

typedef enum el_record_kind {
    EL_RECORD_THIN,        /* the first EL_THIN_BYTES of an el_record */
    EL_RECORD_PLAIN,       /* el_record */
    EL_RECORD_CUT,         /* el_record of a part of a triangle */
    EL_RECORD_PERSPECTIVE, /* el_record_perspective */
    EL_RECORD_CLIPPED,     /* el_record_clipped of a part of a triangle */
    EL_RECORD_KINDS,
    EL_RUN_IS_GAP = EL_RECORD_KINDS /* a run without records, from its header to its end */
} el_record_kind;

enum { EL_DRAW_MIRRORED = 1 }; /* front faces run clockwise on the screen */
#ifndef __cplusplus            /* edgeline.h leads here, and there these words are others */
_Static_assert((EL_DRAW_MIRRORED & (EL_FINISH_DITHER | EL_FINISH_MIXED | EL_FINISH_WIRES)) == 0, "they share a byte");
_Static_assert(EL_MATERIAL_DITHER << 1 == 16 && EL_SHADE_GOURAUD << 4 == 16, "dithering is for vertex colours");
#endif

/* What the triangles of a draw call have in common. */
typedef struct el_draw_state {
    const el_mesh *mesh;
    const el_material *material;
    int16_t light_q14[3]; /* direction towards the light in model space */
    uint8_t flags;        /* EL_DRAW_MIRRORED, EL_FINISH_WIRES; with EL_WITH_MIXED EL_FINISH_ of its surfaces, too */
#if EL_WITH_DEBUG_VIEWS
    uint8_t reshading : 3; /* bits of the material's el_shading that the frame's view turns around */
    uint8_t number : 5;    /* of the draw call in its pass, modulo 32 */
#endif
    el_transform transform; /* with which vertices of thin records are found again; the list keeps none without these */
} el_draw_state;

enum { EL_DRAW_STATE_BYTES = EL_WITH_THIN ? sizeof(el_draw_state) : offsetof(el_draw_state, transform) };

/* How the draw's triangles are shaded. */
static inline el_shading el_shading_of(const el_draw_state *draw)
{
#if EL_WITH_DEBUG_VIEWS
    return (el_shading)(draw->material->shading ^ draw->reshading);
#else
    return (el_shading)draw->material->shading;
#endif
}

/* EL_FINISH_DITHER, if what is shaded so is dithered. */
static inline unsigned el_dithering_of(const el_material *material, el_shading shading)
{
    return (unsigned)material->flags << 1 & (unsigned)shading << 4 & EL_FINISH_DITHER;
}

/* EL_FINISH_ of the draw's triangles, which are shaded so, among bits of no meaning. */
static inline unsigned el_finish_of(const el_draw_state *draw, el_shading shading)
{
#if EL_WITH_MIXED
    (void)shading;
    return draw->flags;
#else
    return el_dithering_of(draw->material, shading) | (draw->flags & (unsigned)EL_FINISH_WIRES);
#endif
}

static inline bool el_draws_wires(const el_draw_state *draw)
{
    return (draw->flags & EL_FINISH_WIRES) != 0;
}

/* Whether the draw's triangles are not drawn as all others are: mixed, or wires. */
static inline bool el_is_drawn_apart(const el_draw_state *draw)
{
    return (draw->flags & (EL_FINISH_MIXED | EL_FINISH_WIRES)) != 0;
}

/* Whether a triangle of that doubled area (el_doubled_area, not 0) shows its back. */
static inline bool el_shows_back(const el_draw_state *draw, int64_t doubled_area)
{
    /* Front faces run counter-clockwise, against the sense in which an area with y down is positive. */
    return (doubled_area > 0) != ((draw->flags & EL_DRAW_MIRRORED) != 0);
}

typedef struct el_run {
    uint16_t draw; /* its el_draw_state, behind this header or behind an earlier one's */
    uint16_t end;  /* name of what follows its last record; valid when it no longer takes records */
    uint8_t kind;  /* el_record_kind */
} el_run;

typedef struct el_point {
    el_coordinate x, y;
    uint16_t z;
} el_point;

typedef struct el_record {
    uint16_t next;  /* in its bin; 0: none */
    uint16_t run;   /* its el_run; 0: this is a share, of EL_RECORD_THIN's size */
    uint16_t index; /* of the mesh's triangle; of a share: the name of its record */
    union {
        el_point points[3];
        int16_t row; /* of a thin one: the first row with a pixel centre inside; of a share: its group's first row */
    } at;
} el_record;

enum { EL_THIN_BYTES = offsetof(el_record, at) + sizeof(int16_t) };

typedef struct el_record_perspective {
    el_record record;
    uint16_t w[3];     /* 1/w of each corner is w * 2^-shift, 2^15 <= w */
    uint16_t w_shifts; /* three shifts of 5 bits, the first corner's lowest */
} el_record_perspective;

typedef struct el_attributes {
    int32_t u_q16, v_q16;
    uint16_t rgb_q8[3];
} el_attributes;

typedef struct el_record_clipped {
    el_record_perspective perspective;
    union {
        el_attributes attributes[3];
        uint8_t edges; /* of wires: bit i, from corner i to the next one */
    };
} el_record_clipped;

typedef struct el_list {
    uint16_t run; /* the run that takes records; 0: none */
    uint16_t bin_count;
    uint16_t band_lines;
    bool is_thin;   /* whole triangles are EL_RECORD_THIN from now on, until the list is cleared */
    bool is_shared; /* triangles have shares */
    bool has_gaps;  /* el_list_keep_rows closes them */
    uint8_t reach;  /* of samples, as in a culling (frame/cull.h): rows begin that much earlier */
#if EL_WITH_INTERLACED
    uint8_t field; /* el_field: rows are its lines */
#endif
    uint8_t band_shift; /* see el_list_band_of: a product in place of a division */
    uint32_t bands_per_row;
    uint8_t *base;  /* 8-byte aligned */
    uint32_t end;   /* bytes that may be used now; at least `used` */
    uint32_t used;  /* bytes */
    uint16_t *bins; /* last record of each band; 0: none */
} el_list;

/* The frame's el_field. */
static inline uint8_t el_list_field(const el_list *list)
{
#if EL_WITH_INTERLACED
    return list->field;
#else
    (void)list;
    return 0; /* EL_FIELD_NONE */
#endif
}

static inline void *el_list_at(const el_list *list, uint16_t name)
{
    return list->base + (uint32_t)name * EL_LIST_UNIT;
}

static inline const el_run *el_list_run(const el_list *list, const el_record *record)
{
    return (const el_run *)el_list_at(list, record->run);
}

static inline const el_draw_state *el_list_draw(const el_list *list, const el_record *record)
{
    return (const el_draw_state *)el_list_at(list, el_list_run(list, record)->draw);
}

/* Bytes of a record of that kind, in whole units. */
static inline uint32_t el_list_record_bytes(el_record_kind kind)
{
    /* In the order of their kinds: this header is for C++ too, which cannot name them here. */
    static const uint8_t bytes[EL_RECORD_KINDS] = {
        EL_LIST_BYTES(EL_THIN_BYTES),
        EL_LIST_BYTES(sizeof(el_record)),
        EL_LIST_BYTES(sizeof(el_record)),
        EL_LIST_BYTES(sizeof(el_record_perspective)),
        EL_LIST_BYTES(sizeof(el_record_clipped)),
    };
    return bytes[kind];
}

static inline bool el_list_is_thin(const el_list *list)
{
    return EL_WITH_THIN && list->is_thin;
}

/* `memory` is 8-byte aligned; `bins` holds `bin_count` entries. */
void el_list_init(el_list *list, void *memory, uint32_t bytes, uint16_t *bins, uint16_t bin_count, uint16_t band_lines);

/* Empties the list and its bins. */
void el_list_clear(el_list *list);

/* The next record belongs to another draw call. */
static inline void el_list_end_draw(el_list *list)
{
    if (list->run != 0) {
        ((el_run *)el_list_at(list, list->run))->end = (uint16_t)(list->used / EL_LIST_UNIT);
        list->run = 0;
    }
}

/* The band that has screen row `row`, 0 <= row < EL_MAX_HEIGHT. */
static inline uint32_t el_list_band_of(const el_list *list, int32_t row)
{
    return (uint32_t)row * list->bands_per_row >> list->band_shift;
}

/* What is to be drawn under the name of a record or of a share. */
static inline const el_record *el_list_record(const el_list *list, uint16_t name)
{
    const el_record *const record = (const el_record *)el_list_at(list, name);
    return EL_WITH_WORKERS && record->run == 0 ? (const el_record *)el_list_at(list, record->index) : record;
}

static inline uint16_t el_list_name(const el_list *list, const el_record *record)
{
    return (uint16_t)((uint32_t)((const uint8_t *)record - list->base) / EL_LIST_UNIT);
}

/* Puts a record into the bin of the band that has screen row `row`, as its last. */
static inline void el_list_put(const el_list *list, el_record *record, int32_t row)
{
    uint16_t *const bin = &list->bins[el_list_band_of(list, row)];
    const uint16_t name = el_list_name(list, record);
    if (*bin == 0) {
        record->next = name;
    } else {
        el_record *const last = (el_record *)el_list_at(list, *bin);
        record->next = last->next;
        last->next = name;
    }
    *bin = name;
}

/* Bytes of the shares of a triangle with rows [row, row_end) in the pass. */
static inline uint32_t el_list_share_bytes(const el_list *list, int32_t row, int32_t row_end)
{
    if (!EL_WITH_WORKERS || !list->is_shared) {
        return 0;
    }
    const uint32_t groups =
        el_list_band_of(list, row_end - 1) / EL_GROUP_BANDS - el_list_band_of(list, row) / EL_GROUP_BANDS;
    return groups * el_list_record_bytes(EL_RECORD_THIN);
}

/* Puts a record's shares into the list's memory from byte `at` on, and into their bins. Returns where they end. */
uint32_t el_list_share(const el_list *list, const el_record *record, uint32_t at, int32_t row, int32_t row_end);

/* Appends a record to the open run, whose records have `bytes` each, and to the bin of the band that has screen row
 * `row`. Its run and next are set; the caller fills in the rest, and sees to its shares. NULL when the list has no room
 * for it and for `more` bytes. Where a caller has a copy of the list, for as long as nobody else looks at it, all that
 * this changes but the records stays in registers. */
static inline el_record *el_list_append_same(el_list *list, uint32_t bytes, uint32_t more, int32_t row)
{
    if (bytes + more > list->end - list->used) {
        return NULL;
    }
    el_record *const record = (el_record *)(void *)(list->base + list->used);
    list->used += bytes;
    record->run = list->run;
    el_list_put(list, record, row);
    return record;
}

/* The same for any kind, with its shares, for a triangle with rows [row, row_end) in the pass: opens a run if the last one
 * is of another kind, and for `draw` if the last draw call has ended. */
el_record *el_list_append(el_list *list, const el_draw_state *draw, el_record_kind kind, int32_t row, int32_t row_end);

/* Joins what was appended to `more`, a list in this one's memory from byte `begin` on, that has bins of its own and no room
 * behind it; there is room for a run's header before it. */
void el_list_join(el_list *list, const el_list *more, uint32_t begin);

/* Drops the triangles that begin at row_end or below and closes the gaps. Triangles that begin above `row_begin` stay in
 * the bin of row_begin. The run that takes records stays open. */
void el_list_keep_rows(el_list *list, int32_t row_begin, int32_t row_end);

/* With EL_WITH_THIN: makes the records of all whole triangles thin and closes the gaps. Triangles that begin above
 * `row_begin` stay in its bin. */
void el_list_make_thin(el_list *list, int32_t row_begin);

/* Takes the bin of `band` out of the list: the first of its records, chained by `next`; 0 when it is empty. */
uint16_t el_list_take_bin(const el_list *list, uint16_t band);

#ifdef __cplusplus
}
#endif

#endif
