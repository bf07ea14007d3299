/* Images of every format, as they are, turned and scaled, against their definitions. */
#include "canvas_picture.h"
#include "seeded.h"

enum { SIDE = 24, MOST = 9 };

void setUp(void)
{
}
void tearDown(void)
{
}

/* An image of any format, and what it holds. */
typedef struct sample {
    el_image image;
    uint16_t words[MOST * MOST];
    uint8_t bytes[MOST * MOST];
    uint8_t alpha[MOST * MOST];
    uint16_t palette[256];
    uint16_t colour[MOST][MOST];
    uint32_t shown[MOST][MOST]; /* 0..256 */
} sample;

static void make_sample(seeded *s, sample *t)
{
    const uint32_t width = 1U + any_below(s, MOST);
    const uint32_t height = 1U + any_below(s, MOST);
    memset(t, 0, sizeof *t);
    t->image = (el_image){.width = (uint16_t)width,
                          .height = (uint16_t)height,
                          .format = (uint8_t)any_below(s, 4),
                          .has_key = any_below(s, 3) == 0,
                          .key = (uint16_t)any_below(s, 4),
                          .palette = t->palette,
                          .alpha = any_below(s, 2) == 0 ? t->alpha : NULL};
    t->image.pixels = t->image.format == EL_IMAGE_RGB565 ? (const void *)t->words : t->bytes;
    for (unsigned i = 0; i < 256; i++) {
        t->palette[i] = (uint16_t)any_u64(s);
    }
    for (uint32_t y = 0; y < height; y++) {
        for (uint32_t x = 0; x < width; x++) {
            const uint32_t i = y * width + x;
            uint32_t value = any_below(s, 2) == 0 ? any_below(s, 4) : any_below(s, 65536);
            switch (t->image.format) {
            case EL_IMAGE_RGB565:
                t->words[i] = (uint16_t)value;
                t->colour[y][x] = (uint16_t)value;
                break;
            case EL_IMAGE_INDEX8:
                value &= 255U;
                t->bytes[i] = (uint8_t)value;
                t->colour[y][x] = t->palette[value];
                break;
            case EL_IMAGE_INDEX4:
                value &= 15U;
                t->bytes[y * ((width + 1) / 2) + x / 2] |= (uint8_t)(x % 2 == 0 ? value << 4 : value);
                t->colour[y][x] = t->palette[value];
                break;
            default:
                value &= 1U;
                t->bytes[y * ((width + 7) / 8) + x / 8] |= (uint8_t)(value << (7 - x % 8));
                t->colour[y][x] = t->palette[0];
                break;
            }
            t->alpha[i] = (uint8_t)(any_below(s, 3) == 0 ? any_u64(s) : 255 * any_below(s, 2));
            const bool is_key = t->image.has_key && value == t->image.key;
            const uint32_t own = t->image.alpha == NULL ? 256 : t->alpha[i] + (t->alpha[i] >= 128 ? 1U : 0U);
            t->shown[y][x] = is_key || (t->image.format == EL_IMAGE_MASK && value == 0) ? 0 : own;
        }
    }
}

typedef struct drawing {
    const el_image *image;
    int32_t x, y;
    uint8_t alpha;
    el_image_place place;
} drawing;

static void draw_plain(void *context, el_band *band)
{
    const drawing *const d = context;
    const el_canvas canvas = el_canvas_of(band);
    el_canvas_image(&canvas, d->image, d->x, d->y, d->alpha);
}

static void draw_turned(void *context, el_band *band)
{
    const drawing *const d = context;
    const el_canvas canvas = el_canvas_of(band);
    TEST_ASSERT_EQUAL_INT(EL_OK, el_canvas_image_turned(&canvas, d->image, &d->place));
}

static void fill_with_noise(seeded *s, canvas_picture *p)
{
    *p = canvas_picture_of(SIDE, SIDE);
    for (unsigned i = 0; i < SIDE * SIDE; i++) {
        p->pixels[i] = (uint16_t)any_u64(s);
    }
}

static uint16_t over(uint16_t under, uint16_t colour, uint32_t shown, uint8_t alpha)
{
    return el_rgb565_blend(under, colour, (shown * (alpha + (alpha >= 128 ? 1U : 0U)) + 128U) / 256U);
}

static void test_images_of_every_format_lie_where_they_should(void)
{
    static sample t;
    static canvas_picture p;
    static canvas_picture before;
    seeded s = seeded_from(1);
    for (s.round = 0; s.round < PART_OF(2000); s.round++) {
        make_sample(&s, &t);
        drawing d = {.image = &t.image, .alpha = (uint8_t)(any_below(&s, 2) == 0 ? 255 : any_u64(&s))};
        d.x = any_below(&s, 10) == 0 ? (int32_t)any_u64(&s) : (int32_t)any_between(&s, -MOST, SIDE);
        d.y = any_below(&s, 10) == 0 ? (int32_t)any_u64(&s) : (int32_t)any_between(&s, -MOST, SIDE);
        fill_with_noise(&s, &p);
        before = p;
        paint_any_bands(&p, draw_plain, &d);
        for (int32_t y = 0; y < SIDE; y++) {
            for (int32_t x = 0; x < SIDE; x++) {
                const int64_t u = (int64_t)x - d.x;
                const int64_t v = (int64_t)y - d.y;
                uint16_t wanted = before.pixels[y * SIDE + x];
                if (u >= 0 && u < t.image.width && v >= 0 && v < t.image.height) {
                    wanted = over(wanted, t.colour[v][u], t.shown[v][u], d.alpha);
                }
                if (p.pixels[y * SIDE + x] != wanted) {
                    fail_at(&s, "format %u, pixel (%d, %d)", t.image.format, (int)x, (int)y);
                }
            }
        }
    }
}

/* A quotient rounded down. */
static int64_t down(int64_t n, int64_t d)
{
    return n / d - (n % d < 0);
}

/* By the four nearest pixels, with weights of sixteenths; what is beyond the border shows nothing. */
static uint32_t smooth_reference(const sample *t, int64_t u_q16, int64_t v_q16, uint16_t *colour)
{
    const int64_t x = down(u_q16, 65536);
    const int64_t y = down(v_q16, 65536);
    const uint32_t right = (uint32_t)(u_q16 - x * 65536) / 4096U;
    const uint32_t lower = (uint32_t)(v_q16 - y * 65536) / 4096U;
    uint32_t sums[4] = {0};
    for (int64_t j = 0; j < 2; j++) {
        for (int64_t i = 0; i < 2; i++) {
            if (x + i < 0 || x + i >= t->image.width || y + j < 0 || y + j >= t->image.height) {
                continue;
            }
            const uint32_t weight = (i != 0 ? right : 16 - right) * (j != 0 ? lower : 16 - lower);
            const uint32_t part = weight * t->shown[y + j][x + i];
            const uint16_t c = t->colour[y + j][x + i];
            sums[0] += part * (c >> 11);
            sums[1] += part * (c >> 5 & 63U);
            sums[2] += part * (c & 31U);
            sums[3] += part;
        }
    }
    if (sums[3] == 0) {
        return 0;
    }
    const uint32_t half = sums[3] / 2U;
    *colour =
        (uint16_t)((sums[0] + half) / sums[3] << 11 | (sums[1] + half) / sums[3] << 5 | (sums[2] + half) / sums[3]);
    return (sums[3] + 128U) / 256U;
}

static void test_turned_images_are_what_the_definition_says(void)
{
    static sample t;
    static canvas_picture p;
    static canvas_picture before;
    seeded s = seeded_from(2);
    for (s.round = 0; s.round < PART_OF(3000); s.round++) {
        make_sample(&s, &t);
        drawing d = {.image = &t.image};
        const bool even = any_below(&s, 3) == 0; /* pixels' borders meet */
        d.place = (el_image_place){.x = (int32_t)any_between(&s, -EL_SUB(8), EL_SUB(SIDE + 8)),
                                   .y = (int32_t)any_between(&s, -EL_SUB(8), EL_SUB(SIDE + 8)),
                                   .angle = (el_angle)any_u64(&s) & (any_below(&s, 2) == 0 ? 0xC0000000U : UINT32_MAX),
                                   .scale_q16 = (uint32_t)any_between(&s, 256, 1 << (12 + any_below(&s, 13))),
                                   .smooth = any_below(&s, 2) == 0,
                                   .alpha = (uint8_t)(any_below(&s, 2) == 0 ? 255 : any_u64(&s))};
        if (even) {
            d.place.x &= -EL_SUBPIXELS / 2;
            d.place.y &= -EL_SUBPIXELS / 2;
            d.place.scale_q16 = 1U << (14 + any_below(&s, 5));
        }
        fill_with_noise(&s, &p);
        before = p;
        paint_any_bands(&p, draw_turned, &d);
        const int64_t a = down(4LL * el_cos_q30(d.place.angle), d.place.scale_q16);
        const int64_t b = down(4LL * el_sin_q30(d.place.angle), d.place.scale_q16);
        const int64_t cx = d.place.x - EL_SUBPIXELS / 2;
        const int64_t cy = d.place.y - EL_SUBPIXELS / 2;
        const int64_t c = t.image.width * 32768LL - down(a * cx + b * cy, EL_SUBPIXELS);
        const int64_t e = t.image.height * 32768LL - down(a * cy - b * cx, EL_SUBPIXELS);
        for (int32_t y = 0; y < SIDE; y++) {
            for (int32_t x = 0; x < SIDE; x++) {
                const int64_t u = a * x + b * y + c;
                const int64_t v = a * y - b * x + e;
                uint16_t wanted = before.pixels[y * SIDE + x];
                uint16_t colour = 0;
                uint32_t shown = 0;
                if (d.place.smooth) {
                    shown = smooth_reference(&t, u - 32768, v - 32768, &colour);
                } else if (u >= 0 && u < t.image.width * 65536LL && v >= 0 && v < t.image.height * 65536LL) {
                    colour = t.colour[v >> 16][u >> 16];
                    shown = t.shown[v >> 16][u >> 16];
                }
                wanted = over(wanted, colour, shown, d.place.alpha);
                if (p.pixels[y * SIDE + x] != wanted) {
                    fail_at(&s, "format %u, pixel (%d, %d) is %04x, not %04x", t.image.format, (int)x, (int)y,
                            p.pixels[y * SIDE + x], wanted);
                }
            }
        }
    }
}

/* Not turned and of its own size, an image is what it is; in quarter turns each pixel is one of its pixels. */
static void test_quarter_turns_keep_every_pixel(void)
{
    static const uint8_t bits[4] = {0xF0, 0x80, 0xC0, 0x80};
    static const uint16_t ink[1] = {0xFFFF};
    static const el_image letter = {.width = 4, .height = 4, .format = EL_IMAGE_MASK, .pixels = bits, .palette = ink};
    static const char *const turned[4][4] = {{"####", "#...", "##..", "#..."},
                                             {"####", ".#.#", "...#", "...#"},
                                             {"...#", "..##", "...#", "####"},
                                             {"#...", "#...", "#.#.", "####"}};
    for (uint32_t i = 0; i < 4; i++) {
        drawing d = {.image = &letter,
                     .place = {.x = EL_SUB(2), .y = EL_SUB(2), .angle = i << 30, .scale_q16 = 65536, .alpha = 255}};
        canvas_picture p = canvas_picture_of(4, 4);
        paint_in_bands(&p, 4, draw_turned, &d);
        expect_canvas(&p, 4, turned[i]);
    }
}

static void test_what_is_out_of_range_is_refused(void)
{
    uint16_t pixels[4] = {0};
    el_band band = {.pixels = pixels, .width = 2, .lines = 2};
    const el_canvas canvas = el_canvas_of(&band);
    static const uint16_t dot[1] = {0xFFFF};
    el_image image = {.width = 1, .height = 1, .format = EL_IMAGE_RGB565, .pixels = dot};
    const struct {
        el_image_place place;
        uint16_t width;
        el_status wanted;
    } cases[] = {
        {{.scale_q16 = 256, .alpha = 255}, 1, EL_OK},
        {{.scale_q16 = 1 << 24, .alpha = 255}, 1, EL_OK},
        {{.scale_q16 = 255, .alpha = 255}, 1, EL_ERROR_RANGE},
        {{.scale_q16 = (1 << 24) + 1, .alpha = 255}, 1, EL_ERROR_RANGE},
        {{.x = EL_GUARD_SUB + 1, .scale_q16 = 65536, .alpha = 255}, 1, EL_ERROR_RANGE},
        {{.y = -EL_GUARD_SUB - 1, .scale_q16 = 65536, .alpha = 255}, 1, EL_ERROR_RANGE},
        {{.scale_q16 = 65536, .alpha = 255}, 0, EL_ERROR_SIZE},
        {{.scale_q16 = 65536, .alpha = 255}, EL_IMAGE_MAX + 1, EL_ERROR_SIZE},
    };
    for (unsigned i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        image.width = cases[i].width;
        TEST_ASSERT_EQUAL_INT(cases[i].wanted, el_canvas_image_turned(&canvas, &image, &cases[i].place));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_images_of_every_format_lie_where_they_should);
    RUN_TEST(test_turned_images_are_what_the_definition_says);
    RUN_TEST(test_quarter_turns_keep_every_pixel);
    RUN_TEST(test_what_is_out_of_range_is_refused);
    return UNITY_END();
}
