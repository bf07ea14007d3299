/* Several cores, here threads: the same pixels and depths as one core draws, for every scene, band height, arena and number
 * of workers, with sinks that give bands back at once or late, each of which gets the bands in order. */
#include "scene.h"
#include "seeded.h"
#include "threads.h"

#include "recording_sink.h"

enum { WIDTH = 320, HEIGHT = 240, LARGE = 1400 * 1024, FRAMES = 2, FRAME_STEP = 47 };

static uint8_t memory[LARGE] __attribute__((aligned(8)));
static recording record;
static const uint16_t band_heights[] = {1, 7, 8, 30, 240};
static const unsigned counts[] = {2, 3, 4, EL_MAX_WORKERS};
static el_threads *threads[sizeof counts / sizeof counts[0]];

void setUp(void)
{
    memset(&record, 0, sizeof record);
}

void tearDown(void)
{
}

static size_t least(uint16_t lines, unsigned workers)
{
    return EL_MIN_MEMORY_BYTES((unsigned)WIDTH, (unsigned)HEIGHT, (unsigned)lines) +
           EL_WORKERS_BYTES((unsigned)WIDTH, (unsigned)HEIGHT, (unsigned)lines, workers);
}

static uint32_t crc_of_frame(const recording *r)
{
    const uint32_t crc = el_crc32(0, r->pixels, sizeof r->pixels);
    return el_crc32(crc, r->depth, sizeof r->depth);
}

static el_stats draw(const el_scene *scene, uint32_t frame, uint16_t band_lines, size_t bytes,
                     const el_workers *workers)
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
                                                                 .sinks = {&sink},
                                                                 .workers = workers}));
    TEST_ASSERT_EQUAL_INT_MESSAGE(EL_OK, el_scene_play(scene, frame, &renderer), scene->name);
    finish_recording(&record);
    return *el_frame_stats(&renderer);
}

/* One scene and frame: as one core draws it, and as all numbers of workers do. */
static void expect_same(const el_scene *scene, uint32_t frame)
{
    const el_stats one = draw(scene, frame, 8, sizeof memory, NULL);
    const uint32_t expected = crc_of_frame(&record);
    for (unsigned i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        const el_workers *const workers = el_threads_workers(threads[i]);
        for (unsigned k = 0; k < sizeof band_heights / sizeof band_heights[0]; k++) {
            const uint16_t lines = band_heights[k];
            const size_t arenas[] = {least(lines, counts[i]), least(lines, counts[i]) + 12000, sizeof memory};
            for (unsigned a = 0; a < 3; a++) {
                if (arenas[a] > sizeof memory || arenas[0] > sizeof memory) {
                    continue;
                }
                record.defers = (k + a) % 2 != 0;
                const el_stats stats = draw(scene, frame, lines, arenas[a], workers);
                char what[80];
                (void)snprintf(what, sizeof what, "%s, frame %u, %u workers, %u lines, %zu bytes", scene->name,
                               (unsigned)frame, counts[i], lines, arenas[a]);
                TEST_ASSERT_EQUAL_HEX32_MESSAGE(expected, crc_of_frame(&record), what);
                /* How much is found to be hidden depends on the bands' height. */
                if (a == 2 && one.triangles_hidden + stats.triangles_hidden == 0) {
                    TEST_ASSERT_EQUAL_UINT32_MESSAGE(one.rows, stats.rows, what);
                    TEST_ASSERT_EQUAL_UINT32_MESSAGE(one.pixels, stats.pixels, what);
                    TEST_ASSERT_EQUAL_UINT32_MESSAGE(one.triangles_listed, stats.triangles_listed, what);
                }
                record.defers = false;
            }
        }
    }
}

static void test_workers_draw_what_one_core_draws(void)
{
    for (size_t i = 0; i < el_scene_count(); i++) {
        for (uint32_t frame = 0; frame < PART_OF(FRAMES) * FRAME_STEP; frame += FRAME_STEP) {
            expect_same(el_scene_at(i), frame);
        }
    }
}

static void test_a_number_of_workers_that_cannot_be(void)
{
    el_renderer renderer;
    el_workers workers = *el_threads_workers(threads[0]);
    el_config config = {.width = WIDTH,
                        .height = HEIGHT,
                        .band_lines = 8,
                        .memory = memory,
                        .memory_bytes = least(8, 2),
                        .workers = &workers};
    TEST_ASSERT_EQUAL_INT(EL_OK, el_init(&renderer, &config));
    config.memory_bytes--;
    TEST_ASSERT_EQUAL_INT(EL_ERROR_MEMORY, el_init(&renderer, &config));
    config.memory_bytes = sizeof memory;
    workers.count = 0;
    TEST_ASSERT_EQUAL_INT(EL_ERROR_SIZE, el_init(&renderer, &config));
    workers.count = EL_MAX_WORKERS + 1;
    TEST_ASSERT_EQUAL_INT(EL_ERROR_SIZE, el_init(&renderer, &config));
}

int main(void)
{
    for (unsigned i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        threads[i] = el_threads_open(counts[i]);
        if (threads[i] == NULL) {
            return 1;
        }
    }
    UNITY_BEGIN();
    RUN_TEST(test_workers_draw_what_one_core_draws);
    RUN_TEST(test_a_number_of_workers_that_cannot_be);
    const int failures = UNITY_END();
    for (unsigned i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        el_threads_close(threads[i]);
    }
    return failures;
}
