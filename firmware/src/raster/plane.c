#include "raster/plane.h"

#include "base/fixed.h"
#include "geometry/limits.h"

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
    frame->area = el_divisor_make((uint32_t)el_abs_u64(area));
}

void el_plane_make(el_plane *plane, const el_plane_frame *frame, const int32_t values[3])
{
    /* Differences below 2^32, times heights and widths below 2^16: |a|, |b| < 2^49; times 16 per pixel below 2^53. */
    const int64_t d1 = (int64_t)values[1] - values[0];
    const int64_t d2 = (int64_t)values[2] - values[0];
    const int64_t a = (d1 * frame->dy2 - d2 * frame->dy1) * frame->sign;
    const int64_t b = (d2 * frame->dx1 - d1 * frame->dx2) * frame->sign;
    plane->dx = (uint64_t)el_divide_q32(a * EL_SUBPIXELS, &frame->area);
    plane->dy = (uint64_t)el_divide_q32(b * EL_SUBPIXELS, &frame->area);

    /* The centre of the pixel that the first corner lies in is at most half a pixel away on each axis: the products
     * stay below 2^53 again. From there, whole pixels. */
    const int32_t column = frame->x0 >> EL_SUBPIXEL_BITS;
    const int32_t row = frame->y0 >> EL_SUBPIXEL_BITS;
    const int32_t to_centre_x = column * EL_SUBPIXELS + EL_SUBPIXELS / 2 - frame->x0;
    const int32_t to_centre_y = row * EL_SUBPIXELS + EL_SUBPIXELS / 2 - frame->y0;
    const int64_t offset = el_divide_q32(a * to_centre_x + b * to_centre_y, &frame->area);
    plane->row = ((uint64_t)(int64_t)values[0] << 32) + (uint64_t)offset - plane->dx * (uint64_t)(int64_t)column +
                 plane->dy * (uint64_t)(int64_t)(frame->row - row);
}
