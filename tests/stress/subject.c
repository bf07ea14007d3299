#include "subject.h"

#include <stdio.h>

static void choose_screen(dice *r, subject *t, bool is_wide)
{
    const uint32_t face = any_below(r, 1024);
    if (is_wide) {
        t->width = (int32_t)any_between(r, 481, EL_MAX_WIDTH);
        t->height = (int32_t)any_between(r, 1, 60);
    } else if (face < 4) {
        t->width = 480;
        t->height = 320;
    } else if (face < 32) {
        t->width = 320;
        t->height = 240;
    } else if (face < 128) {
        t->width = (int32_t)any_between(r, 1, 90);
        t->height = (int32_t)any_between(r, 1, 90);
    } else if (face < 256) {
        t->width = 160;
        t->height = 96;
    } else {
        t->width = 64;
        t->height = 48;
    }
}

static void fill_depth(dice *r, subject *t, filling_kind kind)
{
    const uint32_t level = any_below(r, 65000);
    const uint32_t face = kind == FILL_DEPTH_EXTREMES ? 0 : (kind == FILL_EQUAL_LEVELS ? 3 : any_below(r, 4));
    for (unsigned i = 0; i < 3; i++) {
        switch (face) {
        case 0:
            t->corners[i].z = (uint16_t)(once_in(r, 2) ? 65535U - any_below(r, 2) : any_below(r, 2));
            break;
        case 1:
            t->corners[i].z = (uint16_t)(level + any_below(r, 400));
            break;
        case 2:
            t->corners[i].z = (uint16_t)any_u64(r);
            break;
        default:
            t->corners[i].z = (uint16_t)level;
            break;
        }
    }
}

static void fill_w(dice *r, subject *t, filling_kind kind)
{
    const uint32_t face = kind == FILL_W_EXTREMES ? any_below(r, 5) : (kind == FILL_EQUAL_LEVELS ? 7 : any_below(r, 8));
    const uint32_t ratios[] = {64, 512, 65535};
    const uint32_t unit = 1U << any_below(r, 15);
    for (unsigned i = 0; i < 3; i++) {
        switch (face) {
        case 0:
        case 1:
        case 2:
            t->corners[i].w = once_in(r, 2) ? unit * ratios[face] : unit;
            break;
        case 3:
            t->corners[i].w = 1 + any_below(r, 3);
            break;
        case 4: /* any unit, as the renderer hands it on */
            t->corners[i].w = 0x7FFFFFFFU >> any_below(r, 16);
            break;
        case 5:
            t->corners[i].w = 1 + any_below(r, 65535);
            break;
        case 6:
            t->corners[i].w = 4000 + any_below(r, 4000);
            break;
        default:
            t->corners[i].w = unit;
            break;
        }
    }
}

static int32_t any_coordinate(dice *r, uint32_t kind)
{
    enum { MOST = (2048 << 16) - 1 };
    switch (kind) {
    case 0:
        return (int32_t)any_between(r, -MOST, MOST);
    case 1:
        return once_in(r, 2) ? MOST : -MOST;
    case 2: /* within a texel */
        return (int32_t)any_between(r, 7 << 16, 8 << 16);
    case 3: /* what a mesh has: texels as Q12.4 */
        return (int32_t)any_between(r, 0, 256 << 4) * (1 << 12);
    default:
        return (int32_t)any_between(r, 0, 64 << 16);
    }
}

static void fill_attributes(dice *r, subject *t, filling_kind kind)
{
    const uint32_t u_kind = any_below(r, 6);
    const uint32_t v_kind = any_below(r, 6);
    const bool extremes = once_in(r, 2);
    const bool one_colour = kind == FILL_EQUAL_LEVELS;
    for (unsigned i = 0; i < 3; i++) {
        t->corners[i].u_q16 = any_coordinate(r, u_kind);
        t->corners[i].v_q16 = any_coordinate(r, v_kind);
        for (unsigned channel = 0; channel < 3; channel++) {
            const uint32_t level = extremes ? any_below(r, 2) * 0xFF00U : any_below(r, 0xFF01);
            t->corners[i].rgb_q8[channel] = one_colour && i > 0 ? t->corners[0].rgb_q8[channel] : (uint16_t)level;
        }
    }
    t->uv_error_log2 = (uint8_t)any_between(r, 1, MAX_UV_ERROR_LOG2);
}

subject subject_make(dice *r, shape_kind shape, filling_kind filling, bool is_wide)
{
    subject t = {0};
    choose_screen(r, &t, is_wide);
    shape_make(shape, r, t.width, t.height, t.given);
    t.exact = exact_triangle_of(t.given);
    for (unsigned i = 0; i < 3; i++) {
        t.corners[i].x = (int32_t)t.given[i].x;
        t.corners[i].y = (int32_t)t.given[i].y;
    }
    fill_depth(r, &t, filling);
    fill_w(r, &t, filling);
    fill_attributes(r, &t, filling);
    return t;
}

void subject_draw(dice *r, const subject *t, const el_corner corners[3], const el_surface *surface,
                  const canvas_buffers *canvas)
{
    el_triangle triangle;
    el_stats stats = {0};
    bool is_set_up = false;
    const bool whole = once_in(r, 2);
    int32_t y_end;
    for (int32_t y = 0; y < t->height; y = y_end) {
        y_end = whole ? t->height : y + (int32_t)any_between(r, 1, t->height - y);
        if (!is_set_up || once_in(r, 2)) {
            is_set_up = el_triangle_setup(&triangle, corners, surface, y);
        }
        if (is_set_up && triangle.y < y_end) {
            const el_target target = {
                .colour = canvas->colour + (size_t)y * (size_t)t->width,
                .depth = canvas->depth + (size_t)y * (size_t)t->width,
                .width = t->width,
                .y = y,
                .y_end = y_end,
            };
            el_triangle_draw(&triangle, &target, &stats);
        }
    }
}

void subject_print(const subject *t)
{
    printf("  on a screen of %d x %d pixels, texture coordinates within 2^-%d texels, the triangle (1/%d px)\n",
           t->width, t->height, t->uv_error_log2, EL_SUBPIXELS);
    for (unsigned i = 0; i < 3; i++) {
        const el_corner *const c = &t->corners[i];
        printf("    x %d  y %d  z %u  1/w %u  u %.5f  v %.5f  rgb %.3f %.3f %.3f\n", c->x, c->y, c->z, (unsigned)c->w,
               c->u_q16 / 65536.0, c->v_q16 / 65536.0, c->rgb_q8[0] / 256.0, c->rgb_q8[1] / 256.0,
               c->rgb_q8[2] / 256.0);
    }
    printf("    doubled area %lld\n", (long long)t->exact.area);
}
