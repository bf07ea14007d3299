/* Random calls of canvas/ with random numbers. Only what the caller must hold is held: images have their pixels and palettes,
 * fonts are sound. */
#ifndef EL_FUZZ_ANY_CALL_H
#define EL_FUZZ_ANY_CALL_H

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "edgeline.h"
#include "take.h"

/* CALL_SIDE: of the pictures into which most calls draw. */
enum { CALL_SIDE = 48, EDGES = 48, POINTS = 16, IMAGE_BYTES = 512, TEXT = 24 };

/* Everything that a call may need; which of it counts is the call's business. */
typedef struct call {
    uint8_t kind;
    el_paint paint;
    uint8_t pattern[8];
    el_rect rect, clip;
    int32_t numbers[6];
    uint8_t choices[4];
    uint32_t count;
    int32_t points[POINTS][2];
    uint32_t begins; /* a bit for each point that begins a contour */
    el_stroke stroke;
    el_image image;
    el_image_place place;
    uint8_t bytes[IMAGE_BYTES];
    char text[TEXT + 1];
} call;

static const uint8_t font_bits[8] = {0x92, 0x70, 0x80, 0xFC, 0x1B, 0xE4, 0x5A, 0xC3};
static const el_glyph font_glyphs[] = {
    {0, 3, 4, 0, 4, 4}, {2, 1, 1, 1, 4, 3}, {3, 3, 2, -1, 0, 3}, {4, 4, 2, -2, 9, 1}};
static const el_font_range font_ranges[] = {{'A', 2, 0}, {0xE9, 1, 2}, {0x20AC, 1, 3}};
static const el_font_kern font_kerns[] = {{0, 1, -1}, {1, 0, 2}};

/* Near the picture more often than not. */
static inline int32_t take_place(input *in)
{
    const uint8_t kind = take_u8(in);
    if (kind < 200) {
        return (int32_t)(take_u16(in) % ((CALL_SIDE + 16) * EL_SUBPIXELS)) - 8 * EL_SUBPIXELS;
    }
    return kind < 230 ? (int32_t)take_u16(in) * EL_SUBPIXELS / 16 - EL_GUARD_SUB : take_i32(in);
}

static inline int32_t take_pixel(input *in)
{
    const uint8_t kind = take_u8(in);
    return kind < 220 ? kind % (CALL_SIDE + 16) - 8 : take_i32(in);
}

static inline el_rect take_rect(input *in)
{
    el_rect rect = {take_pixel(in), take_pixel(in), 0, 0};
    rect.x_end = take_pixel(in);
    rect.y_end = take_pixel(in);
    return rect;
}

static inline void take_image(input *in, call *c)
{
    c->image = (el_image){.width = (uint16_t)(1 + take_u8(in) % 15),
                          .height = (uint16_t)(1 + take_u8(in) % 15),
                          .format = take_u8(in) % 4,
                          .has_key = take_u8(in) % 2 == 1,
                          .key = take_u8(in),
                          .pixels = c->bytes,
                          .palette = (const uint16_t *)(const void *)c->bytes}; /* of 256, as any bytes are */
    c->image.alpha = take_u8(in) % 2 == 1 ? c->bytes + 100 : NULL;
    c->place = (el_image_place){.x = take_place(in), .y = take_place(in), .angle = take_u32(in)};
    c->place.scale_q16 = take_u8(in) < 200 ? 4096U + take_u16(in) * 8U : take_u32(in);
    c->place.smooth = take_u8(in) % 2 == 1;
    c->place.alpha = take_u8(in);
    take_bytes(in, c->bytes, sizeof c->bytes);
}

static inline void take_call(input *in, call *c)
{
    c->kind = take_u8(in);
    c->paint = el_glaze(take_u16(in), take_u8(in));
    if (take_u8(in) % 4 == 1) {
        take_bytes(in, c->pattern, sizeof c->pattern);
        c->paint.pattern = c->pattern;
    }
    c->clip = take_u8(in) % 4 == 1 ? take_rect(in) : (el_rect){INT32_MIN, INT32_MIN, INT32_MAX, INT32_MAX};
    take_bytes(in, c->choices, sizeof c->choices);
    switch (c->kind % 8) {
    case 0:
    case 1:
        c->rect = take_rect(in);
        c->numbers[0] = take_pixel(in);
        break;
    case 2:
        for (unsigned i = 0; i < 4; i++) {
            c->numbers[i] = take_pixel(in);
        }
        break;
    case 3:
    case 4:
        c->count = take_u8(in) % (POINTS + 1);
        c->begins = take_u32(in);
        for (unsigned i = 0; i < c->count; i++) {
            c->points[i][0] = take_place(in);
            c->points[i][1] = take_place(in);
        }
        c->stroke = (el_stroke){take_u8(in), take_u8(in) % 4, take_u8(in) % 4, take_u8(in)};
        c->stroke.width = (uint16_t)(c->stroke.width << take_u8(in) % 9);
        break;
    case 5:
        for (unsigned i = 0; i < 6; i++) {
            c->numbers[i] = take_place(in);
        }
        break;
    case 6:
        take_image(in, c);
        break;
    default:
        c->numbers[0] = take_pixel(in);
        c->numbers[1] = take_pixel(in);
        take_bytes(in, c->text, TEXT);
        break;
    }
}

static inline void draw_polygon(const call *c, const el_canvas *canvas)
{
    static const el_smooth kinds[4] = {EL_SHARP, EL_SMOOTH_4, EL_SMOOTH_8, EL_SMOOTH_16};
    uint8_t *const memory = malloc(EL_POLYGON_BYTES(EDGES, CALL_SIDE + 1));
    el_polygon p;
    FUZZ_EXPECT(memory != NULL);
    el_polygon_begin(&p, memory + c->choices[3] % 2U, EL_POLYGON_BYTES(EDGES, CALL_SIDE + 1) - c->choices[3] % 2U);
    const int32_t *const n = c->numbers;
    if (c->kind % 8 == 3) {
        for (unsigned i = 0; i < c->count; i++) {
            ((c->begins >> i & 1U) != 0 ? el_polygon_move : el_polygon_line)(&p, c->points[i][0], c->points[i][1]);
        }
    } else if (c->kind % 8 == 4) {
        el_polygon_stroke(&p, (const int32_t(*)[2])c->points, c->count, c->choices[2] % 2 == 1, &c->stroke);
    } else if (c->choices[2] % 3 == 0) {
        el_polygon_ellipse(&p, n[0], n[1], n[2], n[3]);
    } else if (c->choices[2] % 3 == 1) {
        el_polygon_sector(&p, n[0], n[1], n[2], n[3], (el_angle)n[4], (el_angle)n[5]);
    } else {
        el_polygon_rectangle(&p, n[0], n[1], n[2], n[3], n[4]);
    }
    (void)el_polygon_fill(&p, canvas, (el_rule)(c->choices[0] % 2), kinds[c->choices[1] % 4], c->paint);
    free(memory);
}

static inline void draw_call(const call *c, const el_canvas *whole)
{
    const el_canvas canvas = el_canvas_clipped(whole, c->clip);
    const el_font font = {.glyphs = font_glyphs,
                          .ranges = font_ranges,
                          .bits = font_bits,
                          .kerns = font_kerns,
                          .range_count = 3,
                          .kern_count = 2,
                          .bits_per_pixel = 1,
                          .ascent = 9,
                          .descent = 2,
                          .line_height = c->choices[1]};
    switch (c->kind % 8) {
    case 0:
        el_canvas_fill(&canvas, c->rect, c->paint);
        break;
    case 1:
        el_canvas_frame(&canvas, c->rect, c->numbers[0], c->paint);
        break;
    case 2:
        el_canvas_line(&canvas, (int16_t)c->numbers[0], (int16_t)c->numbers[1], (int16_t)c->numbers[2],
                       (int16_t)c->numbers[3], c->paint);
        break;
    case 6:
        if (c->choices[0] % 2 == 0) {
            el_canvas_image(&canvas, &c->image, c->place.x, c->place.y, c->place.alpha);
        } else {
            (void)el_canvas_image_turned(&canvas, &c->image, &c->place);
        }
        break;
    case 7:
        el_canvas_text(&canvas, &font, (int16_t)c->numbers[0], (int16_t)c->numbers[1], (el_align)(c->choices[0] % 3),
                       c->text, c->paint);
        break;
    default:
        draw_polygon(c, &canvas);
        break;
    }
}

#endif
