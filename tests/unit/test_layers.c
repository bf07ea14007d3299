/* Layers under and over the triangles: drawn once into every line, in whatever bands, arena and passes; and left out with
 * the lines that they leave as they are, where the renderer may do that. */
#include "any_scene.h"
#include "recording_sink.h"

enum { WIDTH = 40, HEIGHT = 70, PLENTY = 60000, ROUNDS = 12 + PART_OF(52), FRAMES = 6 + PART_OF(10) };

static any_scene scene;
static recording anew, record;
static uint8_t memory[2][PLENTY] __attribute__((aligned(8)));

/* A layer that fills some lines with a colour, and counts how often it has drawn into each. */
typedef struct test_layer {
    uint16_t colour, was_colour; /* of this frame and the one before */
    uint16_t begin, end;         /* of its lines */
    uint16_t was_begin, was_end;
    uint8_t drawn[HEIGHT]; /* times, in this frame */
} test_layer;

static void draw_layer(void *context, el_band *band)
{
    test_layer *const layer = context;
    for (uint16_t y = band->y; y < band->y + band->lines; y++) {
        layer->drawn[y]++;
        for (uint16_t x = 0; y >= layer->begin && y < layer->end && x < band->width; x += 3) {
            band->pixels[(y - band->y) * band->width + x] = layer->colour;
        }
    }
}

static bool overlaps(uint16_t begin, uint16_t end, uint16_t y, uint16_t lines)
{
    return begin < end && begin < y + lines && y < end;
}

static bool layer_unchanged(void *context, uint16_t y, uint16_t lines)
{
    const test_layer *const layer = context;
    if (layer->begin == layer->was_begin && layer->end == layer->was_end && layer->colour == layer->was_colour) {
        return true;
    }
    return !overlaps(layer->begin, layer->end, y, lines) && !overlaps(layer->was_begin, layer->was_end, y, lines);
}

static el_layer el_layer_of(test_layer *layer, bool tells)
{
    return (el_layer){.context = layer, .draw = draw_layer, .unchanged = tells ? layer_unchanged : NULL};
}

void setUp(void)
{
    memset(&anew, 0, sizeof anew);
    memset(&record, 0, sizeof record);
}

void tearDown(void)
{
}

static void start(el_renderer *renderer, el_config config, size_t bytes, unsigned arena, const el_sink *sink)
{
    config.width = WIDTH;
    config.height = HEIGHT;
    config.memory = memory[arena];
    config.memory_bytes = bytes;
    config.sinks[0] = sink;
    TEST_ASSERT_EQUAL_INT(EL_OK, el_init(renderer, &config));
}

/* A pixel that is the same over two backgrounds is a triangle's. */
static void record_scene(uint16_t background, uint16_t *pixels)
{
    const el_sink sink = recording_sink(&anew);
    el_renderer renderer;
    start(&renderer, (el_config){.band_lines = 8, .background = background}, PLENTY, 0, &sink);
    play_scene(&renderer, &scene);
    memcpy(pixels, anew.pixels, sizeof *pixels * WIDTH * HEIGHT);
}

static bool is_layer_s(const test_layer *layer, unsigned i)
{
    return i / WIDTH >= layer->begin && i / WIDTH < layer->end && i % WIDTH % 3 == 0;
}

static void test_triangles_lie_between_the_layers(void)
{
    static const uint16_t heights[] = {1, 3, 8, 16, HEIGHT};
    static uint16_t first[WIDTH * HEIGHT];
    static uint16_t second[WIDTH * HEIGHT];
    uint32_t passes = 0;
    uint32_t covered = 0;
    seeded s = seeded_from(1);
    for (; s.round < ROUNDS; s.round++) {
        fill_scene(&s, &scene);
        record_scene(0x1111, first);
        record_scene(0x2222, second);
        test_layer under = {.colour = 0x00FF, .begin = 0, .end = HEIGHT};
        test_layer over = {.colour = 0xFF00, .begin = 20, .end = (uint16_t)(20 + any_below(&s, 50))};
        const el_layer layers[2] = {el_layer_of(&under, false), el_layer_of(&over, false)};
        const uint16_t lines = heights[s.round % 5];
        const el_sink sink = recording_sink(&record);
        el_renderer renderer;
        const size_t least = EL_MIN_MEMORY_BYTES((unsigned)WIDTH, (unsigned)HEIGHT, (unsigned)lines);
        start(&renderer,
              (el_config){.band_lines = lines, .background = 0x1111, .under = &layers[0], .over = &layers[1]},
              any_below(&s, 2) == 0 ? least : PLENTY, 1, &sink);
        play_scene(&renderer, &scene);
        passes += record.stats.passes > 1;
        for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
            const bool is_triangle_s = first[i] == second[i];
            covered += is_triangle_s;
            const uint16_t wanted = is_layer_s(&over, i)                      ? over.colour
                                    : !is_triangle_s && is_layer_s(&under, i) ? under.colour
                                                                              : first[i];
            if (record.pixels[i] != wanted) {
                fail_at(&s, "pixel (%u, %u) is %04x, not %04x", i % WIDTH, i / WIDTH, record.pixels[i], wanted);
            }
        }
        for (unsigned y = 0; y < HEIGHT; y++) {
            TEST_ASSERT_EQUAL_UINT8(1, under.drawn[y]);
            TEST_ASSERT_EQUAL_UINT8(1, over.drawn[y]);
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(0, passes);
    TEST_ASSERT_GREATER_THAN_UINT32(ROUNDS * 50, covered);
}

/* Without triangles each band has its layers all the same. */
static void test_layers_are_drawn_without_triangles(void)
{
    test_layer over = {.colour = 0xFFFF, .begin = 3, .end = 60};
    const el_layer layer = el_layer_of(&over, false);
    const el_sink sink = recording_sink(&record);
    el_renderer renderer;
    const el_camera camera = {.projection = EL_ORTHOGRAPHIC,
                              .axes_q30 = {{1 << 30, 0, 0}, {0, 1 << 30, 0}, {0, 0, 1 << 30}},
                              .height_q16 = EL_UNIT_Q16,
                              .near_q16 = EL_UNIT_Q16,
                              .far_q16 = 9 * EL_UNIT_Q16};
    start(&renderer, (el_config){.band_lines = 9, .over = &layer, .reuse = EL_REUSES}, PLENTY, 0, &sink);
    for (unsigned frame = 0; frame < 3; frame++) {
        TEST_ASSERT_EQUAL_INT(EL_OK, el_frame_begin(&renderer, &camera));
        while (el_frame_next(&renderer) > 0) {
        }
        TEST_ASSERT_EQUAL_UINT32(8, record.bands);
        for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
            TEST_ASSERT_EQUAL_HEX16(is_layer_s(&over, i) ? 0xFFFF : 0, record.pixels[i]);
        }
    }
}

#if EL_WITH_REUSE
static void move_layer(seeded *s, test_layer *layer)
{
    layer->was_begin = layer->begin;
    layer->was_end = layer->end;
    layer->was_colour = layer->colour;
    memset(layer->drawn, 0, sizeof layer->drawn);
    if (any_below(s, 4) == 0) {
        layer->begin = (uint16_t)any_below(s, HEIGHT);
        layer->end = (uint16_t)(layer->begin + any_below(s, 9));
    }
    layer->colour = (uint16_t)(any_below(s, 4) == 0 ? any_u64(s) : layer->colour);
}

/* Beside a renderer that makes each frame anew. */
static void test_what_is_left_out_changes_no_pixel(void)
{
    uint32_t unchanged = 0;
    uint32_t background = 0;
    static seeded answers;
    answers = seeded_from(2);
    for (seeded s = seeded_from(3); s.round < ROUNDS; s.round++) {
        setUp();
        test_layer under = {.colour = 0x0F0F};
        test_layer over = {.colour = 0xF0F0};
        const bool tell = any_below(&s, 4) != 0;
        const el_layer layers[2] = {el_layer_of(&under, tell), el_layer_of(&over, true)};
        const el_config config = {.background = 0x1234, .under = &layers[0], .over = &layers[1]};
        const el_sink sinks[2] = {recording_sink(&anew), recording_sink(&record)};
        el_renderer plain;
        el_renderer sparing;
        el_config other = config;
        other.band_lines = (uint16_t)(1U + any_below(&s, 16));
        other.reuse = (uint8_t)any_below(&s, 4);
        start(&plain, (el_config){.band_lines = HEIGHT, .background = 0x1234, .under = &layers[0], .over = &layers[1]},
              PLENTY, 0, &sinks[0]);
        start(&sparing, other, PLENTY, 1, &sinks[1]);
        record.answers = &answers;
        fill_scene(&s, &scene);
        for (unsigned i = 0; i < SCENE_MESHES; i++) {
            scene.meshes[i].pose.scale_q16 = EL_UNIT_Q16 / 16;
        }
        for (unsigned frame = 0; frame < FRAMES; frame++) {
            move_layer(&s, &under);
            move_layer(&s, &over);
            if (any_below(&s, 4) == 0) {
                el_pose_turn(&scene.meshes[0].pose, EL_AXIS_Y, (el_angle)any_u64(&s));
            }
            play_scene(&plain, &scene);
            play_scene(&sparing, &scene);
            for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
                if (record.pixels[i] != anew.pixels[i]) {
                    fail_at(&s, "frame %u, pixel (%u, %u) is %04x, not %04x", frame, i % WIDTH, i / WIDTH,
                            record.pixels[i], anew.pixels[i]);
                }
            }
            TEST_ASSERT_TRUE(tell || record.stats.frames_unchanged + record.stats.lines_background == 0);
            unchanged += record.stats.frames_unchanged;
            background += record.stats.lines_background;
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(0, unchanged);
    TEST_ASSERT_GREATER_THAN_UINT32(HEIGHT, background);
}
#endif

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_triangles_lie_between_the_layers);
    RUN_TEST(test_layers_are_drawn_without_triangles);
#if EL_WITH_REUSE
    RUN_TEST(test_what_is_left_out_changes_no_pixel);
#endif
    return UNITY_END();
}
