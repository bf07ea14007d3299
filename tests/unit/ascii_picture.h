/* Small pictures as text: a character per pixel, '.' where nothing was drawn. Triangles are given in pixels with
 * fractions of 1/16, written with PX; each is drawn with a letter of its own, and a pixel that is drawn twice shows as
 * '#', so that overdraw along shared edges is seen at once. */
#ifndef EL_TEST_ASCII_PICTURE_H
#define EL_TEST_ASCII_PICTURE_H

#include <string.h>

#include "raster/triangle.h"
#include "unity.h"

enum { PICTURE_MAX = 32 };

/* whole + sixteenths / 16 pixels */
#define PX(whole, sixteenths) ((whole)*EL_SUBPIXELS + (sixteenths) * (EL_SUBPIXELS / 16))

typedef struct picture {
    unsigned width, height;
    char pixels[PICTURE_MAX][PICTURE_MAX + 1];
} picture;

static inline picture picture_of(unsigned width, unsigned height)
{
    picture p = {.width = width, .height = height};
    for (unsigned y = 0; y < height; y++) {
        memset(p.pixels[y], '.', width);
    }
    return p;
}

/* Draws the triangle alone and marks what it covers. Pixels beside the picture are the rasterizer's fault: the buffers
 * have guards around them. */
static inline void picture_add(picture *p, const el_corner corners[3], char letter)
{
    enum { GUARD = PICTURE_MAX };
    uint16_t counts[GUARD + PICTURE_MAX * PICTURE_MAX + GUARD];
    memset(counts, 0, sizeof counts);
    const unsigned used = p->width * p->height;
    const el_target target = {
        .colour = counts + GUARD, .width = (int32_t)p->width, .y = 0, .y_end = (int32_t)p->height};
    const el_surface surface = {.shading = EL_SHADE_OVERDRAW};
    el_triangle triangle;
    el_stats stats = {0};
    if (el_triangle_setup(&triangle, corners, &surface, 0)) {
        el_triangle_draw(&triangle, &target, &stats);
    }
    TEST_ASSERT_EACH_EQUAL_UINT16(0, counts, GUARD);
    TEST_ASSERT_EACH_EQUAL_UINT16(0, counts + GUARD + used, PICTURE_MAX);
    uint32_t pixels = 0;
    for (unsigned i = 0; i < used; i++) {
        char *const pixel = &p->pixels[i / p->width][i % p->width];
        const uint16_t count = counts[GUARD + i];
        pixels += count;
        if (count != 0) {
            *pixel = *pixel == '.' && count == 1 ? letter : '#';
        }
    }
    TEST_ASSERT_EQUAL_UINT32(pixels, stats.pixels);
}

static inline void picture_add_points(picture *p, const int32_t points[3][2], char letter)
{
    el_corner corners[3] = {0};
    for (unsigned i = 0; i < 3; i++) {
        corners[i].x = points[i][0];
        corners[i].y = points[i][1];
    }
    picture_add(p, corners, letter);
}

/* The same triangle in all six orders of its corners looks the same. */
static inline void picture_add_any_order(picture *p, const int32_t points[3][2], char letter)
{
    static const unsigned orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    picture first = *p;
    picture_add_points(&first, points, letter);
    for (unsigned i = 1; i < 6; i++) {
        picture other = *p;
        int32_t turned[3][2];
        for (unsigned k = 0; k < 3; k++) {
            memcpy(turned[k], points[orders[i][k]], sizeof turned[k]);
        }
        picture_add_points(&other, (const int32_t(*)[2])turned, letter);
        TEST_ASSERT_EQUAL_MEMORY(&first, &other, sizeof other);
    }
    *p = first;
}

/* Says what was drawn, all of it, when it is not what was wanted. */
static inline void expect_picture(const picture *p, unsigned rows, const char *const *expected)
{
    char got[PICTURE_MAX * (PICTURE_MAX + 1) + 1] = "";
    char wanted[sizeof got] = "";
    TEST_ASSERT_EQUAL_UINT(p->height, rows);
    for (unsigned y = 0; y < rows; y++) {
        strcat(strcat(got, p->pixels[y]), "\n");
        strncat(strncat(wanted, expected[y], PICTURE_MAX), "\n", 2);
    }
    TEST_ASSERT_EQUAL_STRING(wanted, got);
}

#define EXPECT_PICTURE(picture, ...)                                                                                   \
    expect_picture(picture, sizeof((const char *const[]){__VA_ARGS__}) / sizeof(char *),                               \
                   (const char *const[]){__VA_ARGS__})

#endif
