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

typedef struct el_texture_walk {
    const el_perspective *planes;
    uint64_t w, u, v;     /* planes' values at the next knot, W with its margin, Q32 */
    int32_t u_q16, v_q16; /* texture coordinates at the piece's first pixel */
    int32_t u_step_q16, v_step_q16;
    int32_t next_u_q16, next_v_q16; /* at the next knot */
    int32_t w_log2_q8;              /* of W there, rounded down */
    int32_t limit_q8;               /* log2 W must be this much and 2/3 log2 n */
    uint8_t length;                 /* index of the length that the last piece had */
} el_texture_walk;

/* Begins at column x of the triangle's next row; 0 <= x < 2^16. */
void el_texture_walk_begin(el_texture_walk *walk, const el_triangle *triangle, int32_t x);

/* Makes the next piece of a span that has `left` pixels to go, left >= 1, and returns its length in pixels, 1 to
 * EL_MAX_PIECE: u_q16 and v_q16 belong to its first pixel, the steps lead to the others. */
int32_t el_texture_walk_piece(el_texture_walk *walk, int32_t left);

#endif
