/* The methods that give each pixel of a triangle a value: depth, or one channel of a colour.
 *
 * The corners' values are whole numbers, 0 to 65534 for depth and 0 to 255 for colour, and so are the results, rounded
 * to nearest. Which pixels are covered is given, so that only the value is measured. */
#ifndef EL_METHODS_VALUES_H
#define EL_METHODS_VALUES_H

#include "methods/shapes.h"

enum { EL_VALUES_ROWS = 128 };

typedef struct el_valued_triangle {
    el_spot corners[3]; /* the area is not 0 */
    int32_t values[3];
    /* The covered pixels: columns [x, x_end) of each row of [y, y_end). */
    int32_t y, y_end;
    struct {
        int32_t x, x_end;
    } spans[EL_VALUES_ROWS]; /* of row y first */
} el_valued_triangle;

/* Finds the covered pixels. Pre: the picture has at most EL_VALUES_ROWS rows. */
void el_valued_triangle_cover(el_valued_triangle *triangle, const el_hits *picture);

/* A picture of values. A method writes the covered pixels; Edgeline's tests depth, so they hold 65535 beforehand. */
typedef struct el_value_picture {
    int32_t width, height;
    uint16_t *values;
    uint16_t *scratch; /* width * height */
} el_value_picture;

/* The plane through the three corners (x, y, value): its normal is the cross product of two edges, and a point of it
 * gives the value at any other, in float. What is far outside the range is cut to it. */
void el_value_normal(const el_valued_triangle *triangle, el_value_picture *picture);

/* The corners' values times the barycentric weights, in float. */
void el_value_interpolated(const el_valued_triangle *triangle, el_value_picture *picture);

/* The gradient: how much the value changes per pixel, added from pixel to pixel, in float. */
void el_value_gradient(const el_valued_triangle *triangle, el_value_picture *picture);

/* One value for the whole triangle: the corners' mean, and the first corner's. */
void el_value_mean(const el_valued_triangle *triangle, el_value_picture *picture);
void el_value_of_first(const el_valued_triangle *triangle, el_value_picture *picture);

/* The yardstick: Edgeline's exact plane, as el_triangle_draw steps it for depth. It finds the pixels itself. */
void el_value_edgeline(const el_valued_triangle *triangle, el_value_picture *picture);

typedef struct el_value_method {
    const char *id;
    const char *title;
    const char *numbers;
    bool for_depth, for_colour;
    void (*fill)(const el_valued_triangle *triangle, el_value_picture *picture);
} el_value_method;

enum { EL_VALUE_METHODS = 6 };

extern const el_value_method el_value_methods[EL_VALUE_METHODS];

#endif
