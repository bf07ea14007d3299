/* Every scene of the demo and the benchmark: named once, drawn without an error in the smallest arena, and the same
 * picture for bands of 1 and 8 lines. */
#include "scene.h"
#include "seeded.h"

#include "recording_sink.h"

enum { WIDTH = 320, HEIGHT = 240, FRAMES = PART_OF(2), FRAME_STEP = 47 };

static uint8_t memory[EL_MIN_MEMORY_BYTES(WIDTH, HEIGHT, 8U) + 4096] __attribute__((aligned(8)));
static recording record;

void setUp(void)
{
    memset(&record, 0, sizeof record);
}

void tearDown(void)
{
}

/* The CRC of frame number `frame` in an arena of exactly `bytes`. */
static uint32_t draw(const el_scene *scene, uint32_t frame, uint16_t band_lines, size_t bytes)
{
    const el_sink sink = recording_sink(&record);
    el_renderer renderer;
    TEST_ASSERT_LESS_OR_EQUAL_UINT(sizeof memory, bytes);
    TEST_ASSERT_EQUAL_INT(EL_OK, el_init(&renderer, &(el_config){.width = WIDTH,
                                                                 .height = HEIGHT,
                                                                 .band_lines = band_lines,
                                                                 .background = scene->background,
                                                                 .memory = memory,
                                                                 .memory_bytes = bytes,
                                                                 .sinks = {&sink}}));
    TEST_ASSERT_EQUAL_INT_MESSAGE(EL_OK, el_scene_play(scene, frame, &renderer), scene->name);
    return recorded_crc(&record);
}

static void test_names_are_unique_and_found(void)
{
    TEST_ASSERT_GREATER_THAN_UINT(0, el_scene_count());
    for (size_t i = 0; i < el_scene_count(); i++) {
        const el_scene *const scene = el_scene_at(i);
        TEST_ASSERT_EQUAL_PTR_MESSAGE(scene, el_scene_find(scene->name), scene->name);
        TEST_ASSERT_TRUE_MESSAGE(scene->name[0] != 0 && scene->summary[0] != 0, scene->name);
        TEST_ASSERT_NULL_MESSAGE(strchr(scene->summary, '\n'), scene->name);
    }
    TEST_ASSERT_NULL(el_scene_find("no such scene"));
    TEST_ASSERT_NULL(el_scene_find(""));
}

static void test_same_picture_for_bands_of_1_and_8_in_the_smallest_arena(void)
{
    const size_t least_1 = EL_MIN_MEMORY_BYTES(WIDTH, HEIGHT, 1U);
    const size_t least_8 = EL_MIN_MEMORY_BYTES(WIDTH, HEIGHT, 8U);
    for (size_t i = 0; i < el_scene_count(); i++) {
        const el_scene *const scene = el_scene_at(i);
        for (uint32_t frame = 0; frame < FRAMES * FRAME_STEP; frame += FRAME_STEP) {
            const uint32_t expected = draw(scene, frame, 8, least_8);
            TEST_ASSERT_EQUAL_HEX32_MESSAGE(expected, draw(scene, frame, 8, least_8 + 4096), scene->name);
            if (frame == 0) {
                TEST_ASSERT_EQUAL_HEX32_MESSAGE(expected, draw(scene, frame, 1, least_1), scene->name);
            }
        }
    }
}

/* A picture of a single colour would pass every comparison. */
static void test_every_scene_shows_something(void)
{
    for (size_t i = 0; i < el_scene_count(); i++) {
        const el_scene *const scene = el_scene_at(i);
        (void)draw(scene, 0, 8, sizeof memory);
        unsigned changes = 0;
        for (unsigned k = 1; k < WIDTH * HEIGHT; k++) {
            changes += record.pixels[k] != record.pixels[k - 1];
        }
        TEST_ASSERT_GREATER_THAN_UINT_MESSAGE(500, changes, scene->name);
    }
}

static el_status refuse(uint32_t frame, el_renderer *renderer)
{
    (void)frame;
    (void)renderer;
    return EL_ERROR_RANGE;
}

/* What cannot be drawn is said, and the frame is finished all the same. */
static void test_play_passes_on_what_draw_refuses(void)
{
    const el_sink sink = recording_sink(&record);
    const el_scene scene = {.place_camera = el_scene_at(0)->place_camera, .draw = refuse};
    el_renderer renderer;
    TEST_ASSERT_EQUAL_INT(EL_OK, el_init(&renderer, &(el_config){.width = WIDTH,
                                                                 .height = HEIGHT,
                                                                 .band_lines = 8,
                                                                 .memory = memory,
                                                                 .memory_bytes = sizeof memory,
                                                                 .sinks = {&sink}}));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_RANGE, el_scene_play(&scene, 0, &renderer));
    TEST_ASSERT_EQUAL_UINT32(1, record.frames);
}

/* A frame that has begun is an error of the caller's. */
static void test_play_passes_on_what_begin_refuses(void)
{
    const el_scene *const scene = el_scene_at(0);
    el_renderer renderer;
    TEST_ASSERT_EQUAL_INT(EL_OK, el_init(&renderer, &(el_config){.width = WIDTH,
                                                                 .height = HEIGHT,
                                                                 .band_lines = 8,
                                                                 .memory = memory,
                                                                 .memory_bytes = sizeof memory}));
    el_camera camera = {0};
    scene->place_camera(0, &camera);
    TEST_ASSERT_EQUAL_INT(EL_OK, el_frame_begin(&renderer, &camera));
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_scene_play(scene, 0, &renderer));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_names_are_unique_and_found);
    RUN_TEST(test_same_picture_for_bands_of_1_and_8_in_the_smallest_arena);
    RUN_TEST(test_every_scene_shows_something);
    RUN_TEST(test_play_passes_on_what_draw_refuses);
    RUN_TEST(test_play_passes_on_what_begin_refuses);
    return UNITY_END();
}
