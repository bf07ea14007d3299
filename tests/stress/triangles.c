/* One triangle at a time through the rasterizer: every pixel of the screen against exact edge functions, every depth
 * and colour that was drawn against the exact plane, texture coordinates and unrounded colours at chosen pixels, and all
 * orders of the corners against each other. */
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "subject.h"

enum { TEXTURE_SIDE_LOG2 = 10, TEXTURE_SIDE = 1 << TEXTURE_SIDE_LOG2 };

/* Doubled products of depth and area, and sums of colours and areas, stay within 63 bits. */
_Static_assert(2LL * (2LL * EL_GUARD_SUB) * (2LL * EL_GUARD_SUB) < INT64_MAX / 65536 / 8, "64 bits suffice for planes");

/* --- Failures ------------------------------------------------------------------------------------------------------ */

typedef struct drawn {
    const subject *subject;
    const uint16_t *pixels;
    uint16_t background;
} drawn;

static char coverage_symbol(const void *context, int64_t column, int64_t row)
{
    const drawn *const d = context;
    const bool wanted = exact_covers(&d->subject->exact, column, row);
    const bool got = d->pixels[row * d->subject->width + column] != d->background;
    return wanted ? (got ? '#' : '-') : (got ? '+' : '.');
}

/* What is wrong has been printed by stress_fail; this adds the triangle and the pixels around. */
static void show(const subject *t, int64_t column, int64_t row, const uint16_t *pixels, uint16_t background)
{
    const drawn d = {t, pixels, background};
    subject_print(t);
    printf("  # drawn, - missing, + too much\n");
    stress_picture(t->width, t->height, column, row, coverage_symbol, &d);
}

/* --- Coverage ------------------------------------------------------------------------------------------------------ */

/* Rows on which attributes are sampled: any one that has pixels, and the last one. */
typedef struct sample_rows {
    int64_t seen;
    int32_t row[2];
} sample_rows;

/* The first column of the row that does not hold `wanted` inside the span or `background` outside it; -1: none. */
static int64_t first_wrong(const uint16_t *pixels, int64_t width, int64_t begin, int64_t end, const uint16_t *wanted,
                           const uint16_t *background)
{
    const size_t pixel = sizeof pixels[0];
    if (memcmp(pixels, background, (size_t)begin * pixel) == 0 &&
        (wanted == NULL || memcmp(pixels + begin, wanted, (size_t)(end - begin) * pixel) == 0) &&
        memcmp(pixels + end, background, (size_t)(width - end) * pixel) == 0) {
        return -1;
    }
    int64_t i = 0;
    while (i >= begin && i < end ? wanted == NULL || pixels[i] == wanted[0] : pixels[i] == background[0]) {
        i++;
    }
    return i;
}

static bool check_coverage(stress *s, const subject *t, sample_rows *rows)
{
    const canvas_buffers *const canvas = s->canvas;
    const el_surface surface = {.shading = EL_SHADE_OVERDRAW};
    subject_draw(&s->random, t, t->corners, &surface, canvas);
    for (int32_t row = 0; row < t->height; row++) {
        uint16_t *const pixels = canvas->colour + (size_t)row * (size_t)t->width;
        int64_t begin;
        int64_t end;
        exact_span(&t->exact, row, t->width, &begin, &end);
        const int64_t wrong = first_wrong(pixels, t->width, begin, end, canvas->ones, canvas->zeros);
        if (wrong >= 0) {
            stress_fail(s, "pixel (%d, %d) must be drawn %d times and was drawn %u times", (int)wrong, row,
                        wrong >= begin && wrong < end, pixels[wrong]);
            show(t, wrong, row, canvas->colour, 0);
            return false;
        }
        if (begin < end) {
            rows->seen++;
            rows->row[0] = once_in(&s->random, (uint32_t)rows->seen) ? row : rows->row[0];
            rows->row[1] = row;
            memset(pixels + begin, 0, (size_t)(end - begin) * sizeof pixels[0]);
        }
    }
    return true;
}

/* --- Depth and drawn colours --------------------------------------------------------------------------------------- */

static bool check_depth(stress *s, const subject *t, int64_t sum, int64_t got, int64_t column, int64_t row)
{
    const int64_t area = t->exact.area;
    category_tally *const tally = &s->tally;
    tally->depths++;
    /* Between two whole depths both are nearest. */
    const int64_t twice_off = 2 * (got * area - sum);
    if (-area <= twice_off && twice_off <= area) {
        tally->depths_exact++;
        return true;
    }
    const int64_t wanted = exact_rounded(sum, area);
    const int64_t off = got > wanted ? got - wanted : wanted - got;
    tally->depth_most_off = off > tally->depth_most_off ? off : tally->depth_most_off;
    int64_t least = 65535;
    int64_t most = 0;
    for (unsigned i = 0; i < 3; i++) {
        least = t->corners[i].z < least ? t->corners[i].z : least;
        most = t->corners[i].z > most ? t->corners[i].z : most;
    }
    if (off <= 1 && got >= least && got <= most) {
        return true;
    }
    stress_fail(s, "pixel (%d, %d) must have depth %d and has %d; the corners' are %d to %d", (int)column, (int)row,
                (int)wanted, (int)got, (int)least, (int)most);
    show(t, column, row, s->canvas->depth, 0xFFFF);
    return false;
}

/* A channel of an RGB565 pixel against sum / area in 8.8: the 8-bit value may be 0.5 off, is rounded, and loses its
 * lower bits. */
static bool channel_fits(int64_t sum, int64_t area, int64_t got, int64_t levels)
{
    const int64_t one = area * 256;
    return got * levels * one <= sum + one && sum < (got + 1) * levels * one;
}

static bool check_colour(stress *s, const subject *t, const int64_t sums[3], uint16_t got, int64_t column, int64_t row)
{
    if (channel_fits(sums[0], t->exact.area, got >> 11, 8) &&
        channel_fits(sums[1], t->exact.area, (got >> 5) & 63, 4) && channel_fits(sums[2], t->exact.area, got & 31, 8)) {
        return true;
    }
    const double one = 256.0 * (double)t->exact.area;
    stress_fail(s, "pixel (%d, %d) must have red, green, blue %.4f %.4f %.4f and has the RGB565 levels %d %d %d",
                (int)column, (int)row, (double)sums[0] / one, (double)sums[1] / one, (double)sums[2] / one, got >> 11,
                (got >> 5) & 63, got & 31);
    show(t, column, row, s->canvas->depth, 0xFFFF);
    return false;
}

static bool check_row(stress *s, const subject *t, int32_t row, int64_t begin, int64_t end)
{
    const size_t at = (size_t)row * (size_t)t->width;
    const int32_t z[3] = {t->corners[0].z, t->corners[1].z, t->corners[2].z};
    exact_row depth = exact_plane(&t->exact, z, begin, row);
    exact_row rgb[3];
    for (unsigned channel = 0; channel < 3; channel++) {
        const int32_t values[3] = {t->corners[0].rgb_q8[channel], t->corners[1].rgb_q8[channel],
                                   t->corners[2].rgb_q8[channel]};
        rgb[channel] = exact_plane(&t->exact, values, begin, row);
    }
    for (int64_t column = begin; column < end; column++) {
        const uint16_t got = s->canvas->depth[at + (size_t)column];
        const int64_t sums[3] = {rgb[0].sum, rgb[1].sum, rgb[2].sum};
        /* A depth of 65535 does not pass the test against an empty buffer: that pixel keeps its colour. */
        if (!check_depth(s, t, depth.sum, got, column, row) ||
            (got != 0xFFFF && !check_colour(s, t, sums, s->canvas->colour[at + (size_t)column], column, row))) {
            return false;
        }
        depth.sum += depth.step;
        for (unsigned channel = 0; channel < 3; channel++) {
            rgb[channel].sum += rgb[channel].step;
        }
    }
    s->tally.samples += (uint64_t)(end - begin);
    return true;
}

static bool check_gouraud(stress *s, const subject *t)
{
    const canvas_buffers *const canvas = s->canvas;
    const el_surface surface = {.shading = EL_SHADE_GOURAUD, .depth = true};
    subject_draw(&s->random, t, t->corners, &surface, canvas);
    for (int32_t row = 0; row < t->height; row++) {
        const size_t at = (size_t)row * (size_t)t->width;
        int64_t begin;
        int64_t end;
        exact_span(&t->exact, row, t->width, &begin, &end);
        int64_t wrong = first_wrong(canvas->colour + at, t->width, begin, end, NULL, canvas->zeros);
        wrong = wrong >= 0 ? wrong : first_wrong(canvas->depth + at, t->width, begin, end, NULL, canvas->empty);
        if (wrong >= 0) {
            stress_fail(s, "pixel (%d, %d) is outside of the triangle and was written to by the Gouraud loop",
                        (int)wrong, row);
            show(t, wrong, row, canvas->depth, 0xFFFF);
            return false;
        }
        if (!check_row(s, t, row, begin, end)) {
            return false;
        }
        memset(canvas->colour + at + begin, 0, (size_t)(end - begin) * sizeof canvas->colour[0]);
        memset(canvas->depth + at + begin, 0xFF, (size_t)(end - begin) * sizeof canvas->depth[0]);
    }
    return true;
}

/* --- Samples: unrounded colours and texture coordinates -------------------------------------------------------------- */

static bool check_unrounded_colours(stress *s, const subject *t, const el_sample *got, int32_t column, int32_t row)
{
    for (unsigned channel = 0; channel < 3; channel++) {
        const int32_t values[3] = {t->corners[0].rgb_q8[channel], t->corners[1].rgb_q8[channel],
                                   t->corners[2].rgb_q8[channel]};
        const wide exact = (wide)exact_plane(&t->exact, values, column, row).sum << 16; /* 8.24 times the area */
        const wide off = ((wide)got->rgb_plus_half_q24[channel] - (1 << 23)) * t->exact.area - exact;
        const double error = (double)((long double)(off < 0 ? -off : off) / (long double)t->exact.area) / 16777216.0;
        keep_largest(&s->tally.colour_most_off, error);
        if (2 * (off < 0 ? -off : off) > (wide)t->exact.area << 24) {
            stress_fail(s, "pixel (%d, %d) has channel %u %.6f off before rounding: more than a half", column, row,
                        channel, error);
            return false;
        }
    }
    return true;
}

/* Below which product of range and ratio of 1/w the bound 2^-bits holds: firmware/DESIGN.md, "Textures". Values of 1/w
 * and u/w have 31 bits, so that their rounding takes range * ratio * 2^-32 texels. */
static bool is_in_domain(const uint32_t w[3], const int32_t u_q16[3], unsigned bits)
{
    uint32_t w_least = w[0];
    uint32_t w_most = w[0];
    int64_t u_least = u_q16[0];
    int64_t u_most = u_q16[0];
    for (unsigned i = 1; i < 3; i++) {
        w_least = w[i] < w_least ? w[i] : w_least;
        w_most = w[i] > w_most ? w[i] : w_most;
        u_least = u_q16[i] < u_least ? u_q16[i] : u_least;
        u_most = u_q16[i] > u_most ? u_q16[i] : u_most;
    }
    return (wide)(u_most - u_least) * w_most <= ((wide)w_least << (31 - bits)) << 16;
}

static bool check_coordinate(stress *s, const subject *t, char name, const int32_t u_q16[3], int32_t got,
                             int32_t column, int32_t row)
{
    const uint32_t w[3] = {t->corners[0].w, t->corners[1].w, t->corners[2].w};
    const exact_ratio exact = exact_coordinate(&t->exact, w, u_q16, column, row);
    const double error = exact_error(exact, got) / 65536;
    const unsigned bits = t->uv_error_log2;
    if (!is_in_domain(w, u_q16, bits)) {
        s->tally.texels_beyond++;
        keep_largest(&s->tally.texel_most_off_beyond[bits], error);
        return true;
    }
    s->tally.texels++;
    keep_largest(&s->tally.texel_most_off[bits], error);
    if (exact_is_within(exact, got, bits)) {
        return true;
    }
    const double wanted = (double)((long double)exact.numerator / (long double)exact.denominator) / 65536;
    stress_fail(s, "pixel (%d, %d) must have %c = %.6f and has %.6f: %.6f texels off, more than 1/%d", column, row,
                name, wanted, got / 65536.0, error, 1 << bits);
    return false;
}

/* The textures' texels are the numbers of their columns (or lines), so a drawn pixel tells its texture coordinate. */
static bool check_sample(stress *s, const subject *t, int32_t column, int32_t row, bool shows_v)
{
    const el_texture any = {.texels = s->canvas->zeros};
    const el_surface surface = {
        .shading = EL_SHADE_TEXTURED_GOURAUD, .depth = true, .uv_error_log2 = t->uv_error_log2, .texture = &any};
    el_triangle triangle;
    el_sample got;
    if (!el_triangle_setup(&triangle, t->corners, &surface, row) || triangle.y != row) {
        stress_fail(s, "row %d has pixels, and set-up says that it has none", row);
        subject_print(t);
        return false;
    }
    el_triangle_sample(&triangle, column, t->width, &got);
    const int32_t u_q16[3] = {t->corners[0].u_q16, t->corners[1].u_q16, t->corners[2].u_q16};
    const int32_t v_q16[3] = {t->corners[0].v_q16, t->corners[1].v_q16, t->corners[2].v_q16};
    const uint16_t texel = s->canvas->colour[row * t->width + column];
    const uint32_t told = ((uint32_t)(shows_v ? got.v_q16 : got.u_q16) >> 16) % TEXTURE_SIDE;
    bool right = check_unrounded_colours(s, t, &got, column, row) &&
                 check_coordinate(s, t, 'u', u_q16, got.u_q16, column, row) &&
                 check_coordinate(s, t, 'v', v_q16, got.v_q16, column, row);
    if (right && told != texel) {
        stress_fail(s, "pixel (%d, %d) shows texel %u, and its %c is %u", column, row, texel, shows_v ? 'v' : 'u',
                    told);
        right = false;
    }
    if (!right) {
        show(t, column, row, s->canvas->colour, 0);
    }
    return right;
}

/* Both ends of the row, its tail of three pixels and six others, on two rows. */
static bool check_samples(stress *s, const subject *t, const sample_rows *rows)
{
    const canvas_buffers *const canvas = s->canvas;
    const bool shows_v = once_in(&s->random, 2);
    uint16_t texels[TEXTURE_SIDE];
    for (unsigned i = 0; i < TEXTURE_SIDE; i++) {
        texels[i] = (uint16_t)i;
    }
    const el_texture texture = {.texels = texels,
                                .width_log2 = shows_v ? 0 : TEXTURE_SIDE_LOG2,
                                .height_log2 = shows_v ? TEXTURE_SIDE_LOG2 : 0};
    const el_surface surface = {.shading = EL_SHADE_TEXTURED, .uv_error_log2 = t->uv_error_log2, .texture = &texture};
    subject_draw(&s->random, t, t->corners, &surface, canvas);
    bool right = true;
    for (unsigned i = 0; i < 2 && right; i++) {
        const int32_t row = rows->row[i];
        int64_t begin;
        int64_t end;
        exact_span(&t->exact, row, t->width, &begin, &end);
        for (int64_t k = 0; k < 10 && right; k++) {
            const int64_t ends[4] = {begin, end - 1, end - 2, end - 3};
            const int64_t column = k < 4 ? ends[k] : any_between(&s->random, begin, end - 1);
            if (column >= begin) {
                right = check_sample(s, t, (int32_t)column, row, shows_v);
            }
        }
    }
    for (int32_t row = 0; row < t->height; row++) {
        uint16_t *const pixels = canvas->colour + (size_t)row * (size_t)t->width;
        int64_t begin;
        int64_t end;
        exact_span(&t->exact, row, t->width, &begin, &end);
        const int64_t wrong = first_wrong(pixels, t->width, begin, end, NULL, canvas->zeros);
        if (wrong >= 0 && right) {
            stress_fail(s, "pixel (%d, %d) is outside of the triangle and was written to by the texture loop",
                        (int)wrong, row);
            show(t, wrong, row, canvas->colour, 0);
            right = false;
        }
        memset(pixels, 0, (size_t)t->width * sizeof pixels[0]);
    }
    return right;
}

/* --- Orders of the corners ------------------------------------------------------------------------------------------ */

static bool check_orders(stress *s, const subject *t)
{
    static const uint8_t orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    static const uint16_t texels[4] = {0xFFFF, 0x8410, 0x1234, 0xEDCB};
    const el_texture texture = {.texels = texels, .width_log2 = 1, .height_log2 = 1};
    const el_surface surface = {
        .shading = EL_SHADE_TEXTURED_GOURAUD, .depth = true, .uv_error_log2 = t->uv_error_log2, .texture = &texture};
    const size_t pixels = (size_t)t->width * (size_t)t->height;
    /* The later orders are drawn into the second half of the canvas and compared with the first. */
    const canvas_buffers first = *s->canvas;
    canvas_buffers other = first;
    other.colour += pixels;
    other.depth += pixels;
    if (2 * pixels > (size_t)MAX_SIDE * MAX_SIDE) {
        return true;
    }
    subject_draw(&s->random, t, t->corners, &surface, &first);
    bool right = true;
    for (unsigned i = 1; i < 6 && right; i++) {
        const uint8_t *const order = orders[i];
        const el_corner corners[3] = {t->corners[order[0]], t->corners[order[1]], t->corners[order[2]]};
        subject_draw(&s->random, t, corners, &surface, &other);
        for (size_t k = 0; k < pixels && right; k++) {
            if (first.colour[k] != other.colour[k] || first.depth[k] != other.depth[k]) {
                const int64_t column = (int64_t)(k % (size_t)t->width);
                const int64_t row = (int64_t)(k / (size_t)t->width);
                stress_fail(s,
                            "pixel (%d, %d) is %04X at depth %u with the corners in order, and %04X at depth %u in the "
                            "order %d, %d, %d or in other bands",
                            (int)column, (int)row, first.colour[k], first.depth[k], other.colour[k], other.depth[k],
                            order[0], order[1], order[2]);
                show(t, column, row, other.depth, 0xFFFF);
                right = false;
            }
        }
        memset(other.colour, 0, pixels * sizeof other.colour[0]);
        memset(other.depth, 0xFF, pixels * sizeof other.depth[0]);
    }
    memset(first.colour, 0, pixels * sizeof first.colour[0]);
    memset(first.depth, 0xFF, pixels * sizeof first.depth[0]);
    return right;
}

/* --- The categories ------------------------------------------------------------------------------------------------- */

enum { FILLING_SHIFT = 8, ORDERS = 1 << 16, WIDE = 1 << 17 };

static unsigned run_triangle(stress *s, unsigned argument)
{
    const subject t = subject_make(&s->random, (shape_kind)(argument & 255),
                                   (filling_kind)((argument >> FILLING_SHIFT) & 255), (argument & WIDE) != 0);
    sample_rows rows = {0};
    const bool all_orders = (argument & ORDERS) != 0 || once_in(&s->random, 8);
    (void)(check_coverage(s, &t, &rows) && check_gouraud(s, &t) &&
           (rows.seen == 0 || (check_samples(s, &t, &rows) && (!all_orders || check_orders(s, &t)))));
    return 1;
}

const category triangle_categories[] = {
    {"on_screen", 80, SHAPE_ON_SCREEN, run_triangle},
    {"small", 80, SHAPE_SMALL, run_triangle},
    {"tiny", 80, SHAPE_TINY, run_triangle},
    {"slivers", 100, SHAPE_SLIVER | FILL_DEPTH_EXTREMES << FILLING_SHIFT, run_triangle},
    {"slivers_any_depth", 60, SHAPE_SLIVER, run_triangle},
    {"guard_band", 80, SHAPE_GUARD, run_triangle},
    {"near_misses", 80, SHAPE_NEAR_MISS, run_triangle},
    {"centred", 60, SHAPE_CENTRED, run_triangle},
    {"axis_aligned", 50, SHAPE_AXIS_ALIGNED, run_triangle},
    {"long_prestep", 50, SHAPE_LONG_PRESTEP, run_triangle},
    {"touching_border", 40, SHAPE_TOUCHING, run_triangle},
    {"depth_extremes", 40, SHAPE_ANY | FILL_DEPTH_EXTREMES << FILLING_SHIFT, run_triangle},
    {"w_extremes", 60, SHAPE_ANY | FILL_W_EXTREMES << FILLING_SHIFT, run_triangle},
    {"no_slope", 20, SHAPE_ANY | FILL_EQUAL_LEVELS << FILLING_SHIFT, run_triangle},
    {"wide_screens", 10, SHAPE_ANY | WIDE, run_triangle},
    {"orders", 20, SHAPE_ANY | ORDERS, run_triangle},
    {0},
};
