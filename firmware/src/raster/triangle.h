/* One triangle under way: set up at a row, then drawn row by row through as many bands as it touches.
 *
 * Everything that pixels come from is exact or modulo 2^n, so a triangle that is set up at row 100 draws the same as one that
 * was set up at row 0 and walked there: pixels do not depend on bands. */
#ifndef EL_RASTER_TRIANGLE_H
#define EL_RASTER_TRIANGLE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/stats.h"
#include "raster/edge.h"
#include "raster/material.h"
#include "raster/plane.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A triangle for set-up: screen corners and what is shaded. Both windings are drawn. */
typedef struct el_corner {
    int32_t x, y; /* 1/EL_SUBPIXELS px, within +-EL_GUARD_SUB */
    uint16_t z;
    uint32_t w;           /* textured: 1/w in any unit that the corners share, 1 <= w < 2^31 */
    int32_t u_q16, v_q16; /* textured: texels, |u|, |v| < 2048 texels */
    uint16_t rgb_q8[3];   /* Gouraud and textured times Gouraud: 0..255 in 8.8 */
} el_corner;

typedef struct el_surface {
    el_shading shading;
    bool depth;            /* test and write depth; with overdraw, count what the test rejects: a debug view */
    uint8_t finish;        /* EL_FINISH_; other bits have no meaning */
    uint16_t colour;       /* flat: RGB565 */
    uint8_t uv_error_log2; /* textured: u and v are within 2^-uv_error_log2 texels; 1..5 */
    uint8_t level;         /* textured and mixed: which of the material's chain of textures */
    union {
        const el_texture *texture;   /* textured, not mixed */
        const el_material *material; /* mixed */
    };
} el_surface;

static inline bool el_is_mixed(const el_surface *surface)
{
    return (surface->finish & EL_FINISH_MIXED) != 0;
}

/* u/w, v/w and 1/w, from which texture coordinates are made. */
typedef struct el_perspective {
    el_plane w, u, v;
    int32_t u_base_q16; /* whole texels, in the middle of the triangle's range */
    int32_t v_base_q16;
    uint8_t u_shift; /* u - u_base in Q16 = (U << u_shift) / W */
    uint8_t v_shift;
} el_perspective;

/* 1 where it is known which columns a triangle reaches. */
#define EL_TRIANGLE_HAS_COLUMNS (!EL_SMALL_CODE || EL_WITH_HIDDEN)

typedef struct el_triangle {
    el_surface surface;
    int16_t y;        /* next row */
    int16_t y_middle; /* first row of the lower part; INT16_MAX when there is none, or it has begun */
    int16_t y_end;
    int16_t x_begin, x_end; /* no row reaches beyond these columns, if EL_TRIANGLE_HAS_COLUMNS */
    uint8_t kind;           /* what its pixels need (fill.h) */
    bool short_is_left;     /* the side that bends at y_middle */
    bool edges_are_short;   /* they are el_edge_q20, widened */
    el_edge left, right;    /* of the current part */
    el_edge lower;          /* the lower part's other edge */
    /* What a shading does not use, at the end, need not be in memory. */
    el_plane z;
    el_channel rgb[3];          /* vertex colours, or light on a texture */
    el_perspective perspective; /* textured */
} el_triangle;

/* Bytes of an el_triangle of that shading. */
uint32_t el_triangle_bytes(el_shading shading);

/* Sets up `corners` from `first_row` on, or from the first row below it that has a pixel centre inside. Returns false,
 * and sets up nothing, when no row of the triangle is left or its area is zero. */
bool el_triangle_setup(el_triangle *triangle, const el_corner corners[3], const el_surface *surface, int32_t first_row);

#if EL_WITH_SAMPLES
/* Puts corners into the order of their rows, and of their columns where they are level. */
void el_triangle_sort(const el_corner corners[3], const el_corner *sorted[3]);

/* Sets up what pixels are made of from `row` on, which may be any near the sorted corners: the surface, the kind, and what is
 * linear on the screen; no edges. The area is not 0. */
void el_triangle_setup_planes(el_triangle *triangle, const el_corner *const sorted[3], const el_surface *surface,
                              int32_t row);
#endif

/* Makes `depth` draw the depth of what `triangle` is about to draw, if it has one; flat, in the same colour. */
void el_triangle_take_depth(el_triangle *depth, const el_triangle *triangle);

/* Which lines of the screen a frame draws. */
typedef enum el_field { EL_FIELD_NONE, EL_FIELD_EVEN, EL_FIELD_ODD } el_field;

/* Where to draw: the rows [y, y_end) of the screen, or lines of a field (field.h). */
typedef struct el_target {
    uint16_t *colour; /* width pixels per row */
    uint16_t *depth;  /* width values per row */
    int32_t width;
    int32_t y;
    int32_t y_end;
    uint8_t field; /* el_field: all of the screen's rows where it is 0 */
} el_target;

/* Draws the triangle's rows from triangle->y to the target's last and moves it on to the row after them.
 * Pre: triangle->y >= target->y. */
void el_triangle_draw(el_triangle *triangle, const el_target *target, el_stats *stats);

/* Moves the triangle on by a row without drawing. */
void el_triangle_next_row(el_triangle *triangle);

static inline bool el_triangle_is_done(const el_triangle *triangle)
{
    return triangle->y >= triangle->y_end;
}

/* The values at a pixel before their last rounding, for tests and debug views. What is rounded to nearest by cutting
 * off its fraction has its half added already. */
typedef struct el_sample {
    uint32_t z_plus_half_q16;
    uint32_t rgb_plus_half_q24[3]; /* 8.24 */
    int32_t u_q16, v_q16;
} el_sample;

/* The values that el_triangle_draw has at pixel x of the triangle's next row, on a screen of `width` pixels: what its
 * loop arrives at after as many steps. Pre: the pixel is covered. */
void el_triangle_sample(const el_triangle *triangle, int32_t x, int32_t width, el_sample *sample);

#ifdef __cplusplus
}
#endif

#endif
