/* From model space to the snapped screen: the camera's part once per frame (el_view), the mesh's part once per draw
 * (el_transform), then each vertex once.
 *
 * Clip coordinates of a draw share one unit, a power of two of a world unit chosen so that the whole mesh fits 30 bits;
 * only their ratios and their comparison with the near and far distance in the same unit matter. x and y are scaled so
 * that -w <= x, y <= w is the screen; y is up. d is the distance along the view; w is d in perspective and a constant in
 * orthographic projection. */
#ifndef EL_GEOMETRY_TRANSFORM_H
#define EL_GEOMETRY_TRANSFORM_H

#include <stdbool.h>
#include <stdint.h>

#include "base/fixed.h"
#include "base/options.h"
#include "base/status.h"
#include "geometry/limits.h"
#include "geometry/mesh.h"
#include "geometry/pose.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A positive factor: mantissa * 2^-exponent, mantissa in [2^30, 2^31). */
typedef struct el_factor {
    uint32_t mantissa;
    int16_t exponent;
} el_factor;

/* A camera before a screen of width x height pixels. */
typedef struct el_view {
    int32_t axes_q30[3][3];
    int32_t position_q16[3];
    el_projection projection;
    el_factor focal[2]; /* x and y on the screen's half sizes per unit of x/w and y/w */
    uint32_t near_q16;
    uint32_t far_q16;
    uint32_t depth_scale_q12; /* EL_DEPTH_MAX * far / (far - near), perspective */
    uint16_t size[2];         /* width, height in pixels */
    uint8_t guard_shift[2];   /* the guard band is |x| <= w << shift */
} el_view;

/* Checks the camera and prepares a view. 1 <= width, height <= EL_MAX_WIDTH, EL_MAX_HEIGHT.
 * EL_ERROR_CAMERA, EL_ERROR_RANGE (position) or EL_ERROR_SIZE. */
el_status el_view_make(el_view *view, const el_camera *camera, uint16_t width, uint16_t height);

/* Cuts each of its pixels into so many side by side; the screen shows the same. Pre: EL_MAX_WIDTH at most then. */
void el_view_cut_pixels(el_view *view, uint16_t columns);

enum {
    EL_CODE_LEFT = 1,
    EL_CODE_RIGHT = 2,
    EL_CODE_BELOW = 4,
    EL_CODE_ABOVE = 8,
    EL_CODE_NEAR = 16,
    EL_CODE_FAR = 32,
    EL_CODE_GUARD = 64,  /* beyond the guard band */
    EL_CODE_LATER = 128, /* beyond a side of the view; the others are not asked yet, nor is it projected */
    EL_CODE_OUTSIDE = EL_CODE_LEFT | EL_CODE_RIGHT | EL_CODE_BELOW | EL_CODE_ABOVE | EL_CODE_NEAR | EL_CODE_FAR,
    EL_CODE_CLIP = EL_CODE_NEAR | EL_CODE_FAR | EL_CODE_GUARD /* cannot be projected: its triangles are cut first */
};

/* Of a row's elements, and the most that their magnitudes add up to: what a core without long products adds up in 32 bits. */
enum { EL_ROW_BITS = 29, EL_ROW_MOST = 0x70000000 };

/* What rows are shifted by where they can be: with it known a coordinate takes two instructions less. */
enum { EL_ROW_SHIFT = 15 };

/* A clip coordinate as a linear form on positions: (offset + the sum of element times position) / 2^shift, rounded down.
 * |offset| < 2^62. */
typedef struct el_row {
#if defined(EL_PRODUCTS_IN_HALVES)
    /* Products of 32 bits: element = high * 2^split + low / up, |low| <= 2^14, up = 2^(EL_ROW_SHIFT - split);
     * offset = whole * 2^shift + rest_high * 2^split + rest_low / up, rest_low < 2^15, shift = split + over. */
    uint16_t rest_high;
    uint16_t rest_low;
    uint32_t whole;
    int32_t high[3];
    int32_t low[3];
#else
    int64_t offset;
    int32_t elements[3];
#endif
} el_row;

typedef struct el_transform {
#if defined(EL_PRODUCTS_IN_HALVES)
    uint8_t split; /* 1..15 */
    uint8_t over;  /* 0..16, and 0 where split is not 15 */
#else
    uint8_t shift; /* 1..31 */
#if !EL_SMALL_CODE
    uint8_t raise; /* 0..14: rows and shift were moved up by so much */
#endif
#endif
    uint8_t orthographic;
    uint8_t mirrored; /* 1: the screen shows the model's mirror image: its front runs clockwise there */
    uint8_t guard_shift[2];
    uint8_t depth_shift;
    uint8_t depth_excess; /* unless EL_SMALL_CODE: see depth_near; 0 where that is not used */
    uint16_t size[2];
    el_row rows[3];       /* x, y, d */
    int32_t near;         /* in the draw's unit: 1 <= near < 2^30 */
    int32_t far;          /* likewise, or INT32_MAX */
    int32_t constant_w;   /* orthographic: w of every vertex */
    uint32_t depth_near;  /* unless EL_SMALL_CODE, perspective: depth_scale * near in Q14, times 2^depth_excess */
    uint32_t depth_scale; /* perspective: Q12; orthographic: per unit of d, times 2^depth_shift */
    uint64_t near_q32;    /* near with 32 bits of fraction; near_q32 <= near * 2^32 */
} el_transform;

#if !defined(EL_PRODUCTS_IN_HALVES)
static inline unsigned el_transform_raise(const el_transform *transform)
{
#if EL_SMALL_CODE
    (void)transform;
    return 0;
#else
    return transform->raise;
#endif
}
#endif

/* An element of a row, per position unit times 2^el_transform_shift. */
static inline int32_t el_transform_element(const el_transform *transform, unsigned row, unsigned i)
{
#if defined(EL_PRODUCTS_IN_HALVES)
    return transform->rows[row].high[i] * (1 << transform->split) +
           (transform->rows[row].low[i] >> (EL_ROW_SHIFT - transform->split));
#else
    return transform->rows[row].elements[i] >> el_transform_raise(transform);
#endif
}

static inline unsigned el_transform_shift(const el_transform *transform)
{
#if defined(EL_PRODUCTS_IN_HALVES)
    return (unsigned)transform->split + transform->over;
#else
    return transform->shift - el_transform_raise(transform);
#endif
}

static inline bool el_transform_is_orthographic(const el_transform *transform)
{
    return EL_WITH_ORTHOGRAPHIC && transform->orthographic != 0;
}

typedef enum el_visibility { EL_VISIBLE = 0, EL_CULLED = 1 } el_visibility;

/* Prepares the draw of `mesh` at `pose`. Returns EL_VISIBLE, EL_CULLED when the bounding sphere is outside the view
 * (nothing else is prepared then), or EL_ERROR_RANGE. */
int el_transform_make(el_transform *transform, const el_view *view, const el_mesh *mesh, const el_pose *pose);

typedef struct el_clip_vertex {
    int32_t x, y, d, w;
} el_clip_vertex;

/* A vertex on the screen. Where code has a bit of EL_CODE_CLIP or EL_CODE_LATER, only code is valid. */
typedef struct el_screen_vertex {
    el_coordinate x; /* right */
    el_coordinate y; /* down */
    uint16_t z;      /* 0 near .. EL_DEPTH_MAX far */
    uint16_t w;      /* 1/w is w * 2^-w_shift in a unit of the draw; 2^15 <= w */
    uint8_t code;    /* EL_CODE_ bits */
    uint8_t w_shift; /* 0..31 */
} el_screen_vertex;

/* The rows of x, y and d. 1 <= shift <= 31; the magnitudes of a row's elements add up to EL_ROW_MOST at most. */
void el_transform_set_rows(el_transform *transform, const int32_t elements[3][3], const int64_t offsets[3],
                           unsigned shift);

/* In perspective: near, 2^20 <= near_q32 < 2^62 with 31 bits or fewer between its first and its last, and the scale of
 * depth. Where far is at least twice as far as near, and near not much less than the draw's unit, vertices in the view
 * take a short way to their depth. */
void el_transform_set_depth(el_transform *transform, uint64_t near_q32, uint32_t scale_q12);

/* The clip coordinates of a mesh position. */
el_clip_vertex el_transform_position(const el_transform *transform, const int16_t position[3]);

/* All of what follows for one mesh position. */
void el_transform_vertex(const el_transform *transform, const int16_t position[3], el_screen_vertex *screen);

/* The same, but a vertex outside the view gets EL_CODE_LATER and one side that it is beyond, since few of its triangles
 * will ask for more: where they do, el_transform_vertex has it. */
void el_transform_vertex_in_view(const el_transform *transform, const int16_t position[3], el_screen_vertex *screen);

/* That for `count` of them. Without `keeps_w`, w and w_shift are not valid: nothing but textures asks for 1/w. */
void el_transform_vertices(const el_transform *transform, const int16_t (*positions)[3], uint32_t count,
                           el_screen_vertex *screen, bool keeps_w);

/* Where a clip vertex lies. */
uint8_t el_outcode(const el_transform *transform, const el_clip_vertex *vertex);

/* Perspective division, viewport, snapping (to nearest, ties to the right and down) and depth.
 * Pre: el_outcode has no bit of EL_CODE_CLIP. Sets all but code. */
void el_project(const el_transform *transform, const el_clip_vertex *vertex, el_screen_vertex *screen);

#ifdef __cplusplus
}
#endif

#endif
