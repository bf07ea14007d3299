/* A display's stripes: a frame is that of three times the width, filtered; for any band height, arena, and samples. */
#include <string.h>

#include "any_scene.h"
#include "recording_sink.h"

void setUp(void)
{
}

void tearDown(void)
{
}

#if EL_WITH_STRIPES

enum { WIDTH = 40, HEIGHT = 30, COLUMNS = EL_STRIPED_WIDTH(WIDTH), LINES = 16, BACKGROUND = 0x39E7 };

static uint8_t memory[EL_MEMORY_BYTES(COLUMNS, HEIGHT, LINES, SCENE_VERTICES, 200, 4) +
                      EL_SAMPLES_BYTES(COLUMNS, LINES, EL_MAX_SAMPLES)];
static recording found;
static recording wide;

static el_config config_for(recording *r, el_sink *sink, uint16_t width)
{
    *sink = recording_sink(r);
    return (el_config){.width = width,
                       .height = HEIGHT,
                       .band_lines = LINES,
                       .background = BACKGROUND,
                       .memory = memory,
                       .memory_bytes = sizeof memory,
                       .sinks = {sink}};
}

static void play(const el_config *config, const any_scene *scene, recording *r)
{
    el_renderer renderer;
    TEST_ASSERT_EQUAL_INT(EL_OK, el_init(&renderer, config));
    play_scene(&renderer, scene);
    finish_recording(r);
}

/* One channel of a pixel whose middle stripe is there: five weighted stripes, the last one beyond the sides. */
static uint32_t filtered(const uint16_t *line, int32_t middle, unsigned down, uint32_t most)
{
    static const uint32_t weights[] = {1, 2, 3, 2, 1};
    uint32_t sum = 0;
    for (int32_t i = 0; i < 5; i++) {
        int32_t stripe = middle + i - 2;
        stripe = stripe < 0 ? 0 : stripe >= COLUMNS ? COLUMNS - 1 : stripe;
        sum += weights[i] * (line[stripe] >> down & most);
    }
    return (2U * sum + 9U) / 18U << down;
}

static void check_frame(const seeded *s, bool blue_first)
{
    for (int32_t i = 0; i < WIDTH * HEIGHT; i++) {
        const int32_t x = EL_STRIPES_PER_PIXEL * (i % WIDTH);
        const uint16_t *const line = wide.pixels + i / WIDTH * COLUMNS;
        const uint16_t *const depth = wide.depth + EL_STRIPES_PER_PIXEL * i;
        const uint32_t wanted = filtered(line, blue_first ? x + 2 : x, 11, 31) | filtered(line, x + 1, 5, 63) |
                                filtered(line, blue_first ? x : x + 2, 0, 31);
        uint16_t nearest = depth[0] < depth[1] ? depth[0] : depth[1];
        nearest = depth[2] < nearest ? depth[2] : nearest;
        if (found.pixels[i] != wanted || found.depth[i] != nearest) {
            fail_at(s, "pixel %d is %04x at %u, not %04x at %u", (int)i, found.pixels[i], found.depth[i],
                    (unsigned)wanted, nearest);
        }
    }
}

/* The picture of three times the width shows the same part of the world: its pixels are a third as wide. */
static void test_a_frame_is_the_wide_one_filtered(void)
{
    seeded s = seeded_from(81);
    any_scene scene;
    el_sink sink;
    for (s.round = 0; s.round < PART_OF(60); s.round++) {
        fill_mixed_scene(&s, &scene);
        scene.camera.aspect_q16 = any_below(&s, 2) == 0 ? 1U << 16 : (WIDTH << 16) / HEIGHT;
        const uint8_t samples = EL_WITH_SAMPLES && any_below(&s, 3) == 0 ? 4 : 1;
        el_config config = config_for(&wide, &sink, COLUMNS);
        config.samples = samples;
        play(&config, &scene, &wide);
        config = config_for(&found, &sink, WIDTH);
        config.samples = samples;
        config.stripes = (uint8_t)any_between(&s, EL_STRIPES_RGB, EL_STRIPES_BGR);
        config.band_lines = (uint16_t)any_between(&s, 1, LINES);
        play(&config, &scene, &found);
        TEST_ASSERT_EQUAL_UINT16(WIDTH, found.width);
        check_frame(&s, config.stripes == EL_STRIPES_BGR);
    }
}

/* Without an aspect of its own a camera has that of the pixels, not of the stripes. */
static void test_stripes_are_a_third_as_wide_as_pixels(void)
{
    seeded s = seeded_from(82);
    any_scene scene;
    el_sink sink;
    fill_scene(&s, &scene);
    scene.camera.aspect_q16 = (4U << 16) / 3U;
    _Static_assert(WIDTH * 3 == HEIGHT * 4, "the same up to rounding");
    el_config config = config_for(&wide, &sink, COLUMNS);
    play(&config, &scene, &wide);
    scene.camera.aspect_q16 = 0;
    config = config_for(&found, &sink, WIDTH);
    config.stripes = EL_STRIPES_RGB;
    play(&config, &scene, &found);
    check_frame(&s, false);
}

static void draw_columns(void *context, el_band *band)
{
    TEST_ASSERT_EQUAL_UINT16(WIDTH, band->width);
    for (uint32_t i = 0; i < (uint32_t)band->width * band->lines; i++) {
        band->pixels[i] = (uint16_t)(i % band->width % 8U < 4U ? *(const uint16_t *)context : BACKGROUND);
    }
}

/* Layers draw pixels; the one below is filtered, the one above is not. */
static void test_layers_draw_pixels(void)
{
    static const uint16_t ink = 0xFFFF;
    const el_layer layer = {.context = (void *)(uintptr_t)&ink, .draw = draw_columns};
    any_scene scene;
    seeded s = seeded_from(83);
    el_sink sink;
    fill_scene(&s, &scene);
    for (unsigned above = 0; above < 2; above++) {
        el_config config = config_for(&found, &sink, WIDTH);
        config.stripes = EL_STRIPES_RGB;
        *(above != 0 ? &config.over : &config.under) = &layer;
        el_renderer renderer;
        TEST_ASSERT_EQUAL_INT(EL_OK, el_init(&renderer, &config));
        TEST_ASSERT_EQUAL_INT(EL_OK, el_frame_begin(&renderer, &scene.camera));
        TEST_ASSERT_EQUAL_INT(0, el_frame_next(&renderer));
        finish_recording(&found);
        for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
            const uint32_t x = i % WIDTH % 8U;
            if (above != 0 || (x != 0 && x != 3 && x != 4 && x != 7)) {
                TEST_ASSERT_EQUAL_HEX16(x < 4 ? ink : BACKGROUND, found.pixels[i]);
            } else if (i % WIDTH != 0 && i % WIDTH != WIDTH - 1) {
                TEST_ASSERT_NOT_EQUAL(x < 4 ? ink : BACKGROUND, found.pixels[i]);
            }
        }
    }
}

static void test_what_cannot_be_is_refused(void)
{
    el_sink sink;
    el_renderer renderer;
    el_config config = config_for(&found, &sink, WIDTH);
    config.stripes = EL_STRIPES_COUNT;
    TEST_ASSERT_EQUAL_INT(EL_ERROR_SIZE, el_init(&renderer, &config));
    config.stripes = EL_STRIPES_BGR;
    config.memory_bytes = EL_MIN_MEMORY_BYTES(COLUMNS, HEIGHT, LINES);
    TEST_ASSERT_EQUAL_INT(EL_OK, el_init(&renderer, &config));
    config.memory_bytes--;
    TEST_ASSERT_EQUAL_INT(EL_ERROR_MEMORY, el_init(&renderer, &config));
    config.memory_bytes = sizeof memory;
    config.height = config.band_lines = 1;
    config.width = EL_MAX_STRIPED;
    TEST_ASSERT_EQUAL_INT(EL_OK, el_init(&renderer, &config));
    config.width++;
    TEST_ASSERT_EQUAL_INT(EL_ERROR_SIZE, el_init(&renderer, &config));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_frame_is_the_wide_one_filtered);
    RUN_TEST(test_stripes_are_a_third_as_wide_as_pixels);
    RUN_TEST(test_layers_draw_pixels);
    RUN_TEST(test_what_cannot_be_is_refused);
    return UNITY_END();
}

#else

static void test_stripes_are_left_out(void)
{
    TEST_ASSERT_EQUAL_INT(0, EL_WITH_STRIPES);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_stripes_are_left_out);
    return UNITY_END();
}

#endif
