/* Small triangles in one colour or in their vertices' colours, with depth, where pixels have several samples: what nearly all
 * of a mesh's are. To the same pixels as sampled.c's. */
#ifndef EL_RASTER_SMALL_SAMPLED_H
#define EL_RASTER_SMALL_SAMPLED_H

#include "raster/fill.h"
#include "raster/sampled_pixel.h"
#include "raster/samples.h"
#include "raster/small_plane.h"

#if EL_WITH_SMALL_SAMPLED

/* No row begins so many columns to the left of where the one above ends. */
enum { EL_SAMPLED_BACK_LOG2 = 7, EL_SAMPLED_BACK = 1 << EL_SAMPLED_BACK_LOG2 };
_Static_assert((int)EL_EDGE_NARROW + 2 * EL_SUBPIXELS < EL_SAMPLED_BACK * EL_SUBPIXELS, "so many columns at most");

/* How many ways there are for: each of the latter two of four samples is opposite to one of the first two. */
static EL_SPECIALISED uint32_t el_known_ways(uint32_t count)
{
    return count == 4 ? 2U : count;
}

/* An edge in the next row, for all samples, Q20 modulo 2^32: of sample k it is x + at[k], whose whole part is the first pixel
 * of which that sample is not left of the edge.
 *
 * Of four samples, two are as far to one side as the other two to the other: least, -near, near, most. So where the edge
 * passes between the samples of a pixel, two comparisons with `near` tell which of `masks` is that of the covered ones. */
typedef struct el_sampled_side {
    uint32_t x, step;
    int32_t most, least; /* of at[]; of four samples, the least is as far on the other side */
    int32_t near;
    uint8_t masks[3];
    int32_t at[EL_MAX_SAMPLES]; /* of four samples, the latter two are those of the first two, with the other sign */
} el_sampled_side;

/* From a pixel's centre to a sample. */
typedef struct el_sampled_way {
    uint64_t z;
    uint32_t rgb[3];
} el_sampled_way;

/* A triangle under way, in its next row. What pixels need comes first: Thumb code reaches it at once there. */
typedef struct el_small_sampled {
    /* `first` is where the row above ended, and per_row leads from there to column `column` of this one, which begins on the
     * right of that. */
    el_slopes slopes;
    el_sampled_place at; /* the band */
    uint32_t row;        /* the number of the row's first pixel in it */
    int32_t column;
    uint16_t first_column; /* with a sample */
    uint16_t flat;
    uint8_t kind;
    bool short_is_left;
    el_sampled_way ways[EL_MAX_SAMPLES];
    el_sampled_side straight, upper, lower;
    int32_t y0, y1, y2; /* corners, 1/EL_SUBPIXELS px */
    int16_t y, y_end;   /* the next row, and that below the last */
    /* Rows in which all samples are between the same two edges. */
    int16_t upper_begin, upper_end;
    int16_t lower_begin, lower_end;
} el_small_sampled;

/* Sets up a triangle whose corners are sorted by their rows, of such a shape and area, not 0, whose samples are on the screen's
 * columns, from row y on, one of those that may have some. `kind`: in its corners' colours or `flat`, with depth. */
void el_small_sampled_setup(el_small_sampled *s, const el_corner *const corners[3], const el_small_shape *shape,
                            int32_t area, uint8_t kind, uint16_t flat, uint32_t count, int32_t y);

/* Draws down to the target's last row, or the triangle's. Returns whether it goes on below.
 * Pre: its next row is not above the target's first. */
bool el_small_sampled_go_on(el_small_sampled *s, const el_sampled_target *target, el_stats *stats);

#endif

#endif
