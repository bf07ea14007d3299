/* Rows of texels: those along which u and v are linear, drawn in the fastest way that a texture allows. Private to this
 * layer, and for its two callers, one of which goes on from piece to piece. */
#ifndef EL_RASTER_TEXEL_ROW_H
#define EL_RASTER_TEXEL_ROW_H

#include "base/fixed.h"
#include "raster/texel.h"

#if !EL_SMALL_CODE
/* Both coordinates in one number of 64 bits, which one addition steps. Its upper word has u at the top, so that what runs
 * over is what repeats, u's fraction of 16 bits, and v in what is left below, whose fraction is in the lower word:
 *
 *     | u | fraction of u | v, from the middle of its field | fraction of v | 0 |
 *
 * v has a field of 16 - width_log2 bits. If those are two more than a texture's height has, and v begins in their middle, it
 * is in the third quarter there; EL_MAX_PIECE pixels of less than a 256th of the field each lead by less than a quarter up
 * or down, so it never runs over into u, where a single unit shows at a texel's edge (test_texels). Turned left by u's bits,
 * the upper word ends in the index of a texel; by one bit more, in twice that, which is its offset. */
typedef struct el_packing {
    uint32_t mask;             /* of an offset, in bytes */
    unsigned turn;             /* to the right, 0 to 31 */
    unsigned u_up;             /* from Q16 to the top */
    uint32_t v_mask, v_middle; /* Q16 */
    uint32_t v_step_most;      /* Q16: v's step must be less; 0 where no step is small enough */
} el_packing;

static inline el_packing el_packing_of(const el_texture *texture)
{
    const unsigned width_log2 = texture->width_log2;
    const unsigned height_log2 = texture->height_log2;
    return (el_packing){
        .mask = ((1U << (width_log2 + height_log2)) - 1U) << 1,
        .turn = 31U - width_log2,
        .u_up = 16U - width_log2,
        .v_mask = (1U << (16U + height_log2)) - 1U,
        .v_middle = 0x80000000U >> width_log2,
        .v_step_most = width_log2 + height_log2 <= 14U ? 1U << (24U - width_log2) : 0U,
    };
}

/* Where texels are, in both ways. */
typedef struct el_texels {
    el_texel_source source;
    el_packing packing;
} el_texels;

static inline el_texels el_texels_of(const el_texture *texture)
{
    return (el_texels){.source = el_texel_source_of(texture), .packing = el_packing_of(texture)};
}

/* So many pixels from a place in the texture on, one at least. */
typedef struct el_texel_row {
    uint32_t u_q16, v_q16, u_step_q16, v_step_q16;
    uint16_t *colour;
    uint32_t count;
} el_texel_row;

/* Moves its beginning on by so many of its pixels. */
static inline void el_texel_row_skip(el_texel_row *row, uint32_t count)
{
    row->u_q16 += count * row->u_step_q16;
    row->v_q16 += count * row->v_step_q16;
    row->colour += count;
    row->count -= count;
}

/* The same, counted from the centres of texels. */
static inline el_texel_row el_texel_row_between_centres(const el_texel_row *row)
{
    return (el_texel_row){.u_q16 = row->u_q16 - (1U << 15),
                          .v_q16 = row->v_q16 - (1U << 15),
                          .u_step_q16 = row->u_step_q16,
                          .v_step_q16 = row->v_step_q16,
                          .colour = row->colour,
                          .count = row->count};
}

static inline bool el_can_pack(const el_texels *texels, uint32_t v_step_q16)
{
    return v_step_q16 + texels->packing.v_step_most < 2U * texels->packing.v_step_most;
}

static EL_SPECIALISED void el_draw_packed(const el_texels *from, const el_texel_row *row)
{
    const el_packing p = from->packing;
    const uint8_t *const texels = (const uint8_t *)from->source.texels;
    const uint32_t v_q16 = (row->v_q16 & p.v_mask) + p.v_middle;
    const uint32_t upper = (row->u_q16 << p.u_up) + (v_q16 >> 16);
    const uint32_t upper_step = (row->u_step_q16 << p.u_up) + (uint32_t)((int32_t)row->v_step_q16 >> 16);
    const uint64_t step = (uint64_t)upper_step << 32 | row->v_step_q16 << 16;
    uint64_t at = (uint64_t)upper << 32 | v_q16 << 16;
    uint16_t *colour = row->colour;
    const uint16_t *const end = colour + row->count;
    /* By twos: a piece has a dozen pixels, and what a longer loop needs to begin costs more than it saves. */
#pragma GCC unroll 2
    do {
        const uint32_t word = (uint32_t)(at >> 32);
        const uint32_t offset = (word >> p.turn | word << (-p.turn & 31U)) & p.mask;
        *colour++ = *(const uint16_t *)(const void *)(texels + offset);
        at += step;
    } while (colour != end);
}

/* Of any texture and step. */
static inline void el_draw_each_texel(const el_texels *texels, const el_texel_row *row)
{
    const el_texel_source source = texels->source;
    uint32_t u_q16 = row->u_q16;
    uint32_t v_q16 = row->v_q16;
    uint16_t *colour = row->colour;
    const uint16_t *const end = colour + row->count;
    do {
        *colour++ = (uint16_t)el_texel_at(&source, u_q16, v_q16);
        u_q16 += row->u_step_q16;
        v_q16 += row->v_step_q16;
    } while (colour != end);
}

static EL_SPECIALISED void el_draw_texels(const el_texels *texels, const el_texel_row *row)
{
    if (el_can_pack(texels, row->v_step_q16)) {
        el_draw_packed(texels, row);
    } else {
        el_draw_each_texel(texels, row);
    }
}
#endif

#endif
