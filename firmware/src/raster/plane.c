#include "raster/plane.h"

#include "base/fixed.h"

/* NOLINTBEGIN(readability-redundant-declaration): where the copy lies that small code shares. */
EL_INLINE_HERE uint64_t el_plane_times(uint64_t gradient, int32_t count);
EL_INLINE_HERE int64_t el_doubled_area(const int32_t x[3], const int32_t y[3]);
/* NOLINTEND(readability-redundant-declaration) */

#if EL_SUBPIXEL_BITS == 4
/* Negative where |difference| is more than EL_SMALL_SUB. */
static inline int32_t room_within_small(int32_t difference)
{
    return (EL_SMALL_SUB - difference) | (EL_SMALL_SUB + difference);
}
#endif

void el_plane_frame_make(el_plane_frame *frame, const int32_t x[3], const int32_t y[3])
{
    frame->x0 = x[0];
    frame->y0 = y[0];
    frame->dx1 = x[1] - x[0];
    frame->dy1 = y[1] - y[0];
    frame->dx2 = x[2] - x[0];
    frame->dy2 = y[2] - y[0];
    const int64_t area = el_doubled_area(x, y);
    frame->sign = area < 0 ? -1 : 1;
#if EL_SUBPIXEL_BITS == 4
    frame->small = (room_within_small(frame->dx1) | room_within_small(frame->dy1) | room_within_small(frame->dx2) |
                    room_within_small(frame->dy2)) >= 0;
#else
    frame->small = false;
#endif
#if EL_SUBPIXEL_BITS == 4
    frame->area = el_divisor_make((uint32_t)el_abs_u64(area));
#else
    frame->area = el_abs_u64(area);
#endif
}

/* value * 2^-fraction_bits / area, Q32. */
static uint64_t divide(int64_t value, unsigned fraction_bits, const el_area *area)
{
    const int64_t whole = value >> fraction_bits;
    const uint32_t fraction = fraction_bits == 0 ? 0U : (uint32_t)value << (32U - fraction_bits);
#if EL_SUBPIXEL_BITS == 4
    return (uint64_t)el_divide_q32(whole, fraction, area);
#else
    return (uint64_t)el_divide_wide_q32(whole, fraction, *area);
#endif
}

/* The pixel that the first corner lies in: from there, whole pixels. Its centre is at most half a pixel away on each
 * axis, so the sum of the products has the bound of one gradient. */
typedef struct anchor {
    int32_t to_centre_x, to_centre_y; /* 1/EL_SUBPIXELS px */
    int32_t columns, rows;            /* from there to the planes' first pixel */
} anchor;

static anchor anchor_of(const el_plane_frame *frame)
{
    const int32_t column = frame->x0 >> EL_SUBPIXEL_BITS;
    const int32_t row = frame->y0 >> EL_SUBPIXEL_BITS;
    return (anchor){
        .to_centre_x = column * EL_SUBPIXELS + EL_SUBPIXELS / 2 - frame->x0,
        .to_centre_y = row * EL_SUBPIXELS + EL_SUBPIXELS / 2 - frame->y0,
        .columns = frame->x - column,
        .rows = frame->row - row,
    };
}

/* A value's change in Q32: per pixel, per row, and from the first corner to its pixel's centre. */
typedef struct gradient {
    uint64_t dx, dy, offset;
} gradient;

/* `by_parts`: quotients per sub-pixel, truncated at 2^-32, and a pixel is EL_SUBPIXELS of them. The sums over the 1023
 * sub-pixels of a small triangle are off by less than 2^-20, where 2^-19 may be. */
static inline void wide_gradient(gradient *g, const el_plane_frame *frame, const anchor *at, int64_t d1, int64_t d2,
                                 unsigned fraction_bits, bool by_parts)
{
    /* With S sub-pixels and F extra bits of fraction, differences are below 2^(32 + F) and heights and widths below
     * 2^12 S: |a|, |b| < 2^(45 + F) S, and per pixel, times S, below 2^(45 + F) S^2: 2^61 for S = 16 and F = 8 as for
     * S = 256 and F = 0. */
    const int64_t a = (d1 * frame->dy2 - d2 * frame->dy1) * frame->sign;
    const int64_t b = (d2 * frame->dx1 - d1 * frame->dx2) * frame->sign;
    const int32_t length = by_parts ? 1 : EL_SUBPIXELS;
    const int64_t dividends[3] = {a * length, b * length, a * at->to_centre_x + b * at->to_centre_y};
    uint64_t quotients[3];
    for (unsigned i = 0; i < 3; i++) {
        quotients[i] = divide(dividends[i], fraction_bits, &frame->area);
    }
    *g = (gradient){.dx = quotients[0], .dy = quotients[1], .offset = quotients[2]};
    if (by_parts) {
        g->offset = el_multiply_u64(g->dx, at->to_centre_x) + el_multiply_u64(g->dy, at->to_centre_y);
        g->dx <<= EL_SUBPIXEL_BITS;
        g->dy <<= EL_SUBPIXEL_BITS;
    }
}

static void start_plane(el_plane *plane, const anchor *at, const gradient *g, uint64_t first_q32)
{
    plane->dx = g->dx;
    plane->dy = g->dy;
    plane->value = first_q32 + g->offset + el_plane_times(g->dx, at->columns) + el_plane_times(g->dy, at->rows);
}

void el_plane_make(el_plane *plane, const el_plane_frame *frame, const int64_t values[3], unsigned fraction_bits)
{
    const anchor at = anchor_of(frame);
    gradient g;
    wide_gradient(&g, frame, &at, values[1] - values[0], values[2] - values[0], fraction_bits, false);
    start_plane(plane, &at, &g, (uint64_t)values[0] << (32U - fraction_bits));
}

void el_plane_make_u16(el_plane *plane, const el_plane_frame *frame, const uint16_t values[3])
{
    const anchor at = anchor_of(frame);
    gradient g;
    wide_gradient(&g, frame, &at, values[1] - values[0], values[2] - values[0], 0, frame->small);
    start_plane(plane, &at, &g, (uint64_t)values[0] << 32);
}

#if EL_WITH_SAMPLES
void el_plane_parts_make(el_plane_parts *parts, const el_plane_frame *frame, const int64_t values[3],
                         unsigned fraction_bits)
{
    const int64_t d1 = values[1] - values[0];
    const int64_t d2 = values[2] - values[0];
    /* As in wide_gradient. */
    parts->dx = divide((d1 * frame->dy2 - d2 * frame->dy1) * frame->sign, fraction_bits, &frame->area);
    parts->dy = divide((d2 * frame->dx1 - d1 * frame->dx2) * frame->sign, fraction_bits, &frame->area);
}
#endif

void el_channel_make(el_channel *channel, const el_plane_frame *frame, const uint16_t values[3])
{
    const anchor at = anchor_of(frame);
    gradient g;
    wide_gradient(&g, frame, &at, values[1] - values[0], values[2] - values[0], 0, frame->small);
    const uint32_t dx = el_q32_to_q24(g.dx);
    const uint32_t dy = el_q32_to_q24(g.dy);
    channel->dx = dx;
    channel->dy = dy;
    channel->value = ((uint32_t)values[0] << 16) + EL_CHANNEL_HALF + el_q32_to_q24(g.offset) +
                     dx * (uint32_t)at.columns + dy * (uint32_t)at.rows;
}
