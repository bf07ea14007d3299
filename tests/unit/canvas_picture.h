/* What canvas/ draws, in bands of any height: one picture, with guards that nothing may touch around each band. */
#ifndef EL_TEST_CANVAS_PICTURE_H
#define EL_TEST_CANVAS_PICTURE_H

#include <string.h>

#include "base/crc32.h"
#include "edgeline.h"
#include "unity.h"

enum { CANVAS_SIDE = 64, CANVAS_PIXELS = CANVAS_SIDE * CANVAS_SIDE, CANVAS_GUARD = 4 };

typedef struct canvas_picture {
    uint16_t width, height;
    uint16_t pixels[CANVAS_PIXELS];
} canvas_picture;

/* Draws with `draw` into the picture, which has what it had, band by band: `lines` each. */
static inline void paint_in_bands(canvas_picture *p, uint16_t lines, void (*draw)(void *, el_band *), void *context)
{
    enum { WORDS = CANVAS_PIXELS + 2 * CANVAS_GUARD };
    static uint16_t memory[WORDS];
    for (uint16_t y = 0; y < p->height; y = (uint16_t)(y + lines)) {
        const uint16_t there = (uint16_t)(p->height - y < lines ? p->height - y : lines);
        const uint32_t count = (uint32_t)there * p->width;
        memset(memory, 0x5A, sizeof memory);
        memcpy(memory + CANVAS_GUARD, p->pixels + (uint32_t)y * p->width, count * sizeof memory[0]);
        el_band band = {.pixels = memory + CANVAS_GUARD, .width = p->width, .y = y, .lines = there};
        draw(context, &band);
        memcpy(p->pixels + (uint32_t)y * p->width, memory + CANVAS_GUARD, count * sizeof memory[0]);
        for (uint32_t i = 0; i < WORDS; i++) {
            if (i < CANVAS_GUARD || i >= CANVAS_GUARD + count) {
                TEST_ASSERT_EQUAL_HEX16_MESSAGE(0x5A5A, memory[i], "a pixel beside the band was written");
            }
        }
    }
}

/* The same picture for every band height. */
static inline void paint_any_bands(canvas_picture *p, void (*draw)(void *, el_band *), void *context)
{
    static canvas_picture other;
    const canvas_picture before = *p;
    paint_in_bands(p, p->height, draw, context);
    static const uint16_t heights[] = {1, 2, 7, 8, 33};
    for (unsigned i = 0; i < sizeof heights / sizeof heights[0]; i++) {
        other = before;
        paint_in_bands(&other, heights[i], draw, context);
        TEST_ASSERT_EQUAL_HEX16_ARRAY_MESSAGE(p->pixels, other.pixels, (uint32_t)p->width * p->height,
                                              "another band height, another picture");
    }
}

static inline canvas_picture canvas_picture_of(uint16_t width, uint16_t height)
{
    canvas_picture p = {.width = width, .height = height};
    return p;
}

static inline uint32_t canvas_picture_crc(const canvas_picture *p)
{
    return el_crc32(0, p->pixels, sizeof p->pixels[0] * p->width * p->height);
}

/* Expects a picture as text: '.' is 0, '#' is 0xFFFF, any other character is any other value. */
static inline void expect_canvas(const canvas_picture *p, unsigned rows, const char *const *expected)
{
    static char got[CANVAS_PIXELS + CANVAS_SIDE + 1];
    static char wanted[sizeof got];
    TEST_ASSERT_EQUAL_UINT(p->height, rows);
    char *at = got;
    wanted[0] = 0;
    for (unsigned y = 0; y < p->height; y++) {
        for (unsigned x = 0; x < p->width; x++) {
            const uint16_t value = p->pixels[y * p->width + x];
            *at++ = value == 0 ? '.' : value == 0xFFFF ? '#' : '+';
        }
        *at++ = '\n';
        strcat(strncat(wanted, expected[y], CANVAS_SIDE), "\n");
    }
    *at = 0;
    TEST_ASSERT_EQUAL_STRING(wanted, got);
}

#define EXPECT_CANVAS(picture, ...)                                                                                    \
    expect_canvas(picture, sizeof((const char *const[]){__VA_ARGS__}) / sizeof(char *),                                \
                  (const char *const[]){__VA_ARGS__})

#endif
