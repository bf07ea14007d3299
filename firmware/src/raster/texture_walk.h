/* Perspective-correct texture coordinates along a span, within an error that the user chooses.
 *
 * u = U / W with U and W linear along the row. A span is cut into pieces; at the knots between them u is exact, inside
 * a piece it is linear. How long a piece may be follows from the error: the derivation is in firmware/DESIGN.md,
 * "Textures". In short, along a row J = U' W - U W' is constant and u'' = -2 J W' / W^3, so over a piece of n pixels
 *
 *     |error| <= max|u''| n^2 / 8 = n^2 |J W'| / (4 Wmin^3)
 *
 * where Wmin is W at one of the piece's ends. In base-2 logarithms that is one comparison per piece:
 *
 *     log2 Wmin >= (log2 |J W'| + 2 log2 n - 2 - log2 error) / 3
 *
 * Logarithms are taken to 1/256, rounded so that the test errs on the short side. */
#ifndef EL_RASTER_TEXTURE_WALK_H
#define EL_RASTER_TEXTURE_WALK_H

#include <stdbool.h>
#include <stdint.h>

#include "raster/triangle.h"

/* The longest piece, in pixels. */
enum { EL_MAX_PIECE = 64 };

/* Added to W. At covered pixels 1 <= W < 2^31 and |U| <= W, as at the corners; each plane is off by less than 2^-19 there, so
 * with 2^-18 more, what is computed keeps to that. A knot moves by at most 2^-18 / W of u's range, which is less than 2^-8 of
 * what the rounding of U at the corners may move it. */
#define EL_W_MARGIN_Q32 (1U << 14)

/* u or v along a span. */
typedef struct el_texture_axis {
    uint64_t value, dx;       /* its plane, Q32: at the span's first pixel, and per pixel */
    int32_t q16, step_q16;    /* texels: at the piece's first pixel, and per pixel */
    int32_t next_q16;         /* at the next piece's first pixel, or the span's last */
    int32_t base_q16;         /* the plane's 0, */
    uint32_t down;            /* and 30 less what its values are shifted by */
    uint32_t curvature_shift; /* leading zeros of the last row's J */
} el_texture_axis;

typedef struct el_texture_walk {
    el_texture_axis u, v;
    uint64_t w, w_dx;             /* W at the span's first pixel, with its margin, and per pixel, Q32 */
    int32_t w_log2_q8;            /* of W at the next knot, rounded down */
    int32_t more_q8;              /* if that is so much, pieces become longer */
    int32_t enough_q8;            /* if it is less at the piece's end, the piece is too long */
    uint32_t pixels;              /* of a piece that is long enough and does not reach the span's end */
    uint32_t w_shift, reciprocal; /* leading zeros of W at the next knot, and 2^63 over what is left without them */
    int32_t limit_q8;             /* log2 W must be this much and 2/3 log2 n */
    int32_t without_j_q8;         /* three times that, but for J */
    uint32_t length;              /* index of `pixels` */
    uint32_t first_length;        /* of the last row's first piece, if W was enough */
    bool is_curved;               /* the limit depends on the row */
} el_texture_walk;

/* For the rows of a triangle. */
void el_texture_walk_start(el_texture_walk *walk, const el_triangle *triangle);

/* Begins a span of so many pixels, 1 at least, at column x of the row that the triangle's planes are at; x and pixels are
 * below 2^16. */
void el_texture_walk_begin(el_texture_walk *walk, const el_perspective *planes, uint32_t x, uint32_t pixels);

#if !EL_SMALL_CODE && EL_WITH_SAMPLES
/* A span of one pixel, off whose centre by `wuv`: what 1/w, u/w and v/w are more there, Q32. el_texture_walk_last has it. */
void el_texture_walk_point(el_texture_walk *walk, const el_perspective *planes, uint32_t x, const uint64_t wuv[3]);
#endif

/* Makes the piece that begins `at` pixels after the span's first, and has `most` pixels at most, 1 or more: those before
 * the span's last, on which its last knot is, for beyond it 1/w may be anything. Returns its length, 1 to EL_MAX_PIECE:
 * u.q16 and v.q16 belong to its first pixel, the steps lead to the others. */
uint32_t el_texture_walk_piece(el_texture_walk *walk, uint32_t at, uint32_t most);

#if !EL_SMALL_CODE
struct el_texels;

/* Makes the pieces that have the span's first `pixels` pixels, all but its last, and draws them from `colour` on. */
void el_texture_walk_draw(el_texture_walk *walk, const struct el_texels *texels, uint16_t *colour, uint32_t pixels);

/* Draws the first `count` pixels of the piece that was made, one at least. */
void el_texture_walk_draw_part(const el_texture_walk *walk, const struct el_texels *texels, uint16_t *colour,
                               uint32_t count);
#endif

/* Moves the piece's beginning on by so many of its pixels. */
static inline void el_texture_walk_skip(el_texture_walk *walk, uint32_t pixels)
{
    walk->u.q16 = (int32_t)((uint32_t)walk->u.q16 + (uint32_t)walk->u.step_q16 * pixels);
    walk->v.q16 = (int32_t)((uint32_t)walk->v.q16 + (uint32_t)walk->v.step_q16 * pixels);
}

/* Makes the last pixel, which no piece has. */
static inline void el_texture_walk_last(el_texture_walk *walk)
{
    walk->u.q16 = walk->u.next_q16;
    walk->v.q16 = walk->v.next_q16;
}

#endif
