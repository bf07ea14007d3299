#include "methods/values.h"

#include <math.h>

#include "base/fixed.h"
#include "raster/triangle.h"

void el_valued_triangle_cover(el_valued_triangle *triangle, const el_hits *picture)
{
    const el_spot *const c = triangle->corners;
    const el_box box = el_box_of_spots(c, 3, picture);
    triangle->y = box.y;
    triangle->y_end = el_max_i32(box.y, box.y_end);
    for (int32_t row = box.y; row < box.y_end; row++) {
        const int32_t y = el_centre_of(0, row).y;
        int32_t x = picture->width;
        int32_t x_end = 0;
        for (unsigned i = 0; i < 3; i++) {
            const el_spot a = c[i];
            const el_spot b = c[(i + 1) % 3];
            if ((a.y <= y) != (b.y <= y)) {
                const int32_t column = el_crossing_column(a, b, row);
                x = el_min_i32(x, column);
                x_end = el_max_i32(x_end, column);
            }
        }
        triangle->spans[row - box.y].x = el_max_i32(x, 0);
        triangle->spans[row - box.y].x_end = el_min_i32(x_end, picture->width);
    }
}

/* To nearest, halves up; cut to what a picture holds, which also makes the conversion defined. */
static uint16_t rounded(float value)
{
    return (uint16_t)fminf(fmaxf(floorf(value + 0.5F), 0.0F), 65535.0F);
}

#define ALWAYS_INLINE static inline __attribute__((always_inline))

/* A value as a function of the place, in pixels: value + right * x + down * y. */
typedef struct gradients {
    float x, y, value; /* a place and the value there */
    float right, down;
} gradients;

static gradients gradients_of(const el_valued_triangle *t)
{
    const float x = (float)t->corners[0].x / EL_SUBPIXELS;
    const float y = (float)t->corners[0].y / EL_SUBPIXELS;
    const float x1 = (float)t->corners[1].x / EL_SUBPIXELS - x;
    const float y1 = (float)t->corners[1].y / EL_SUBPIXELS - y;
    const float x2 = (float)t->corners[2].x / EL_SUBPIXELS - x;
    const float y2 = (float)t->corners[2].y / EL_SUBPIXELS - y;
    const float v1 = (float)(t->values[1] - t->values[0]);
    const float v2 = (float)(t->values[2] - t->values[0]);
    /* The normal of the plane through (0, 0, 0), (x1, y1, v1), (x2, y2, v2). */
    const float normal_x = y1 * v2 - v1 * y2;
    const float normal_y = v1 * x2 - x1 * v2;
    const float normal_value = x1 * y2 - y1 * x2;
    return (gradients){x, y, (float)t->values[0], -normal_x / normal_value, -normal_y / normal_value};
}

ALWAYS_INLINE float value_at(const gradients *g, int32_t column, int32_t row)
{
    return g->value + g->right * ((float)column + 0.5F - g->x) + g->down * ((float)row + 0.5F - g->y);
}

void el_value_normal(const el_valued_triangle *triangle, el_value_picture *picture)
{
    const gradients g = gradients_of(triangle);
    for (int32_t row = triangle->y; row < triangle->y_end; row++) {
        const int32_t x_end = triangle->spans[row - triangle->y].x_end;
        for (int32_t x = triangle->spans[row - triangle->y].x; x < x_end; x++) {
            picture->values[row * picture->width + x] = rounded(value_at(&g, x, row));
        }
    }
}

void el_value_gradient(const el_valued_triangle *triangle, el_value_picture *picture)
{
    const gradients g = gradients_of(triangle);
    for (int32_t row = triangle->y; row < triangle->y_end; row++) {
        const int32_t x_end = triangle->spans[row - triangle->y].x_end;
        int32_t x = triangle->spans[row - triangle->y].x;
        float value = value_at(&g, x, row);
        for (; x < x_end; x++) {
            picture->values[row * picture->width + x] = rounded(value);
            value += g.right;
        }
    }
}

void el_value_interpolated(const el_valued_triangle *triangle, el_value_picture *picture)
{
    const el_spot *const c = triangle->corners;
    const float area = (float)el_side(c[0], c[1], c[2]);
    for (int32_t row = triangle->y; row < triangle->y_end; row++) {
        const int32_t x_end = triangle->spans[row - triangle->y].x_end;
        for (int32_t x = triangle->spans[row - triangle->y].x; x < x_end; x++) {
            const el_spot p = el_centre_of(x, row);
            const float a = (float)el_side(c[1], c[2], p) / area;
            const float b = (float)el_side(c[2], c[0], p) / area;
            const float w = (float)el_side(c[0], c[1], p) / area;
            const float value =
                a * (float)triangle->values[0] + b * (float)triangle->values[1] + w * (float)triangle->values[2];
            picture->values[row * picture->width + x] = rounded(value);
        }
    }
}

static void fill_with(const el_valued_triangle *triangle, uint16_t value, el_value_picture *picture)
{
    for (int32_t row = triangle->y; row < triangle->y_end; row++) {
        const int32_t x_end = triangle->spans[row - triangle->y].x_end;
        for (int32_t x = triangle->spans[row - triangle->y].x; x < x_end; x++) {
            picture->values[row * picture->width + x] = value;
        }
    }
}

void el_value_mean(const el_valued_triangle *triangle, el_value_picture *picture)
{
    const int32_t sum = triangle->values[0] + triangle->values[1] + triangle->values[2];
    fill_with(triangle, (uint16_t)((2 * sum + 3) / 6), picture);
}

void el_value_of_first(const el_valued_triangle *triangle, el_value_picture *picture)
{
    fill_with(triangle, (uint16_t)triangle->values[0], picture);
}

void el_value_edgeline(const el_valued_triangle *triangle, el_value_picture *picture)
{
    el_corner placed[3] = {0};
    for (unsigned i = 0; i < 3; i++) {
        placed[i].x = triangle->corners[i].x;
        placed[i].y = triangle->corners[i].y;
        placed[i].z = (uint16_t)triangle->values[i];
    }
    const el_surface surface = {.shading = EL_SHADE_FLAT, .depth = true};
    const el_target target = {.colour = picture->scratch,
                              .depth = picture->values,
                              .width = picture->width,
                              .y = 0,
                              .y_end = picture->height};
    el_triangle set_up;
    el_stats stats = {0};
    if (el_triangle_setup(&set_up, placed, &surface, 0)) {
        el_triangle_draw(&set_up, &target, &stats);
    }
}

const el_value_method el_value_methods[EL_VALUE_METHODS] = {
    {"of-first", "of the first corner", "int32", false, true, el_value_of_first},
    {"mean", "mean of the corners", "int32", false, true, el_value_mean},
    {"normal", "plane's normal", "float", true, false, el_value_normal},
    {"interpolated", "barycentric interpolation", "float", true, true, el_value_interpolated},
    {"gradient", "gradient, stepped", "float", true, true, el_value_gradient},
    {"edgeline", "Edgeline's plane", "Q32", true, true, el_value_edgeline},
};
