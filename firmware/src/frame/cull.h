/* Whether a triangle on the screen is worth a record: the tests of el_draw, in the order in which most triangles fail
 * them, and the rows that it touches.
 *
 * Nearly all triangles have all corners in the view. Their coordinates are not negative and fit 15 bits, which takes the
 * area into 32 bits and two coordinates into a word; any other triangle takes the general way to the same answers. */
#ifndef EL_FRAME_CULL_H
#define EL_FRAME_CULL_H

#include <stdbool.h>
#include <stdint.h>

#include "base/fixed.h"
#include "geometry/transform.h"
#include "raster/edge.h"
#include "raster/field.h"
#include "raster/plane.h"

/* 1 where el_cull_in_view is faster than el_cull, which small code has alone and larger coordinates need. */
#define EL_CULLS_IN_VIEW (EL_SUBPIXEL_BITS == 4 && !EL_SMALL_CODE)

/* One of these for each triangle, the first that holds. */
typedef enum el_verdict {
    EL_VERDICT_EMPTY,   /* zero area, or no row or column of pixel centres inside the bounding box */
    EL_VERDICT_BACK,    /* facing away */
    EL_VERDICT_OUTSIDE, /* beside the screen */
    EL_VERDICT_OTHER,   /* above or below the rows of the pass */
    EL_VERDICT_SEEN,
    EL_VERDICTS
} el_verdict;

/* What is asked, the same for all triangles of a draw call in a pass. */
typedef struct el_culling {
    int32_t facing; /* 1: el_doubled_area is positive where a triangle shows its back; -1: negative */
    bool two_sided;
    int32_t width; /* of the screen */
    int32_t height;
    int32_t row_begin; /* rows of the pass, on the screen; of a field, its lines */
    int32_t row_end;
    int32_t
        reach; /* how far from pixels' centres a triangle counts on either axis, in 1/EL_SUBPIXELS px: samples, wires */
    uint8_t field; /* el_field of the frame */
} el_culling;

/* Rows of a triangle that is seen: [first, end), of which `begin` is the first in the pass. */
typedef struct el_cull_rows {
    int32_t first, end;
    int32_t begin;
} el_cull_rows;

static inline el_verdict el_cull_by_rows(const el_culling *culling, el_cull_rows *rows)
{
    rows->begin = el_max_i32(rows->first, culling->row_begin);
    return rows->end <= culling->row_begin || rows->begin >= culling->row_end ? EL_VERDICT_OTHER : EL_VERDICT_SEEN;
}

static inline el_verdict el_cull(const el_culling *culling, const el_screen_vertex *const v[3], el_cull_rows *rows)
{
    const int32_t x[3] = {v[0]->x, v[1]->x, v[2]->x};
    const int32_t y[3] = {v[0]->y, v[1]->y, v[2]->y};
    const int64_t area = el_doubled_area(x, y);
    if (area == 0) {
        return EL_VERDICT_EMPTY;
    }
    if ((area > 0) == (culling->facing > 0) && !culling->two_sided) {
        return EL_VERDICT_BACK;
    }
    const int32_t reach = EL_WITH_SAMPLES + EL_WITH_WIRES > 0 ? culling->reach : 0;
    const int32_t x_begin = el_first_centre(el_min3_i32(x[0], x[1], x[2]) - reach);
    const int32_t x_end = el_first_centre(el_max3_i32(x[0], x[1], x[2]) + reach);
    rows->first = el_first_centre(el_min3_i32(y[0], y[1], y[2]) - reach);
    rows->end = el_first_centre(el_max3_i32(y[0], y[1], y[2]) + reach);
    if (x_begin >= x_end || rows->first >= rows->end) {
        return EL_VERDICT_EMPTY;
    }
    if (x_end <= 0 || x_begin >= culling->width || rows->end <= 0 || rows->first >= culling->height) {
        return EL_VERDICT_OUTSIDE;
    }
    if (EL_WITH_INTERLACED && culling->field != EL_FIELD_NONE) {
        rows->first = el_field_row(culling->field, rows->first);
        rows->end = el_field_row(culling->field, rows->end);
        if (rows->first >= rows->end) {
            return EL_VERDICT_EMPTY;
        }
    }
    return el_cull_by_rows(culling, rows);
}

#if EL_CULLS_IN_VIEW
/* The same, for triangles that nearly all begin in the pass. */
static inline el_verdict el_cull_begun(const el_culling *culling, el_cull_rows *rows)
{
    if (rows->first >= culling->row_begin && rows->first < culling->row_end) {
        rows->begin = rows->first;
        return EL_VERDICT_SEEN;
    }
    return el_cull_by_rows(culling, rows);
}

#if defined(__ARM_FEATURE_SIMD32) && defined(__ARM_FEATURE_UNALIGNED)
#include <arm_acle.h>

/* y in the upper half, x in the lower. */
static inline uint16x2_t el_packed_point(const el_screen_vertex *v)
{
    uint16x2_t yx;
    __builtin_memcpy(&yx, &v->x, sizeof yx);
    return yx;
}

/* The same for a triangle whose corners are all in the view: 0 <= x, y <= EL_SUBPIXELS * 2040 < 2^15. `reach`: the culling's,
 * which the compiler may know, less than EL_SUBPIXELS / 2. */
static inline el_verdict el_cull_in_view(const el_culling *culling, const el_screen_vertex *a,
                                         const el_screen_vertex *b, const el_screen_vertex *c, uint32_t reach,
                                         el_cull_rows *rows)
{
    const uint16x2_t p = el_packed_point(a);
    const uint16x2_t q = el_packed_point(b);
    const uint16x2_t r = el_packed_point(c);
    /* Differences fit 16 bits, and an area is the bounding box' at most, below 2^30. */
    const int32_t area = __smusdx((int16x2_t)__usub16(q, p), (int16x2_t)__usub16(r, p)) * culling->facing;
    if (area >= 0) {
        if (area == 0) {
            return EL_VERDICT_EMPTY;
        }
        if (!culling->two_sided) {
            return EL_VERDICT_BACK;
        }
    }
    /* A subtraction sets the flags by which the selection takes the larger or the smaller half words. */
    (void)__usub16(p, q);
    uint32_t most = __sel(p, q);
    uint32_t least = __sel(q, p);
    (void)__usub16(most, r);
    most = __sel(most, r) + (EL_SUBPIXELS / 2 - 1 + reach) * 0x10001U;
    (void)__usub16(least, r);
    least = __sel(r, least) + (EL_SUBPIXELS / 2 - 1 - reach) * 0x10001U;
    /* A row is where the bits of whole pixels differ. */
    const uint32_t unlike = least ^ most;
    if (unlike >> (16 + EL_SUBPIXEL_BITS) == 0 || (unlike & (0x10000U - EL_SUBPIXELS)) == 0) {
        return EL_VERDICT_EMPTY;
    }
    rows->first = (int32_t)(least >> (16 + EL_SUBPIXEL_BITS));
    rows->end = (int32_t)(most >> (16 + EL_SUBPIXEL_BITS));
    return el_cull_begun(culling, rows);
}
#else
/* The same for a triangle whose corners are all in the view: 0 <= x, y <= EL_SUBPIXELS * 2040 < 2^15. Thumb's first set
 * loads unsigned half words only at an offset. `reach`: the culling's, which the compiler may know. */
static inline el_verdict el_cull_in_view(const el_culling *culling, const el_screen_vertex *a,
                                         const el_screen_vertex *b, const el_screen_vertex *c, uint32_t reach,
                                         el_cull_rows *rows)
{
    const int32_t x0 = (uint16_t)a->x;
    const int32_t y0 = (uint16_t)a->y;
    const int32_t x1 = (uint16_t)b->x - x0;
    const int32_t y1 = (uint16_t)b->y - y0;
    const int32_t x2 = (uint16_t)c->x - x0;
    const int32_t y2 = (uint16_t)c->y - y0;
    /* Each product is below 2^30, and so is the area. */
    const int32_t area = (x1 * y2 - y1 * x2) * culling->facing;
    if (area >= 0) {
        if (area == 0) {
            return EL_VERDICT_EMPTY;
        }
        if (!culling->two_sided) {
            return EL_VERDICT_BACK;
        }
    }
    EL_READ_AGAIN();
    int32_t top = (uint16_t)b->y;
    int32_t bottom = (uint16_t)c->y;
    if (top > bottom) {
        top = (uint16_t)c->y;
        bottom = (uint16_t)b->y;
    }
    top = el_min_i32(top, y0);
    bottom = el_max_i32(bottom, y0);
    const int32_t height = bottom - top;
    rows->first = el_first_centre(top - (int32_t)reach);
    rows->end = el_first_centre(bottom + (int32_t)reach);
    if (height < EL_SUBPIXELS && rows->first == rows->end) {
        return EL_VERDICT_EMPTY;
    }
    /* An area is its box' at most: where it is that of a column as wide as a pixel, a column of centres lies inside. */
    if (area > -height * EL_SUBPIXELS && el_first_centre(x0 + el_min_i32(el_min_i32(x1, x2), 0) - (int32_t)reach) ==
                                             el_first_centre(x0 + el_max_i32(el_max_i32(x1, x2), 0) + (int32_t)reach)) {
        return EL_VERDICT_EMPTY;
    }
    return el_cull_begun(culling, rows);
}
#endif
#endif

#endif
