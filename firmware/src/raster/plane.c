#include "raster/plane.h"

#include "base/fixed.h"

void el_plane_frame_make(el_plane_frame *frame, const int32_t x[3], const int32_t y[3], int32_t row)
{
    frame->x0 = x[0];
    frame->y0 = y[0];
    frame->dx1 = x[1] - x[0];
    frame->dy1 = y[1] - y[0];
    frame->dx2 = x[2] - x[0];
    frame->dy2 = y[2] - y[0];
    frame->row = row;
    const int64_t area = el_doubled_area(x, y);
    frame->sign = area < 0 ? -1 : 1;
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

void el_plane_make(el_plane *plane, const el_plane_frame *frame, const int64_t values[3], unsigned fraction_bits)
{
    /* With S sub-pixels and F extra bits of fraction, differences are below 2^(32 + F) and heights and widths below
     * 2^12 S: |a|, |b| < 2^(45 + F) S, and per pixel, times S, below 2^(45 + F) S^2: 2^61 for S = 16 and F = 8 as for
     * S = 256 and F = 0. */
    const int64_t d1 = values[1] - values[0];
    const int64_t d2 = values[2] - values[0];
    const int64_t a = (d1 * frame->dy2 - d2 * frame->dy1) * frame->sign;
    const int64_t b = (d2 * frame->dx1 - d1 * frame->dx2) * frame->sign;
    plane->dx = divide(a * EL_SUBPIXELS, fraction_bits, &frame->area);
    plane->dy = divide(b * EL_SUBPIXELS, fraction_bits, &frame->area);

    /* The centre of the pixel that the first corner lies in is at most half a pixel away on each axis: the sum of the
     * products has the bound of one gradient. From there, whole pixels. */
    const int32_t column = frame->x0 >> EL_SUBPIXEL_BITS;
    const int32_t row = frame->y0 >> EL_SUBPIXEL_BITS;
    const int32_t to_centre_x = column * EL_SUBPIXELS + EL_SUBPIXELS / 2 - frame->x0;
    const int32_t to_centre_y = row * EL_SUBPIXELS + EL_SUBPIXELS / 2 - frame->y0;
    const uint64_t offset = divide(a * to_centre_x + b * to_centre_y, fraction_bits, &frame->area);
    const uint64_t first = (uint64_t)values[0] << (32U - fraction_bits);
    plane->row =
        first + offset - plane->dx * (uint64_t)(int64_t)column + plane->dy * (uint64_t)(int64_t)(frame->row - row);
}
