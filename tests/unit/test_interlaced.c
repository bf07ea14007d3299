/* Interlaced frames: two of what stands still are the whole picture, to the last bit, with every kind of material, in any
 * bands and arenas; each has its own lines alone; and on the glass of a panel they come together. */
#include "any_scene.h"
#include "display.h"
#include "recording_sink.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static any_scene scene;
static recording whole;

#if EL_WITH_INTERLACED

enum { WIDTH = 40, HEIGHT = 70, PLENTY = 60000, ROUNDS = 12 + PART_OF(100) };

static uint8_t memory[2][PLENTY] __attribute__((aligned(8)));
static uint8_t edges[SCENE_TRIANGLES];

/* Puts the lines of fields together. */
static struct {
    uint16_t width, height;
    uint16_t pixels[RECORD_MAX_PIXELS];
    uint16_t depth[RECORD_MAX_PIXELS];
    uint8_t times[EL_MAX_HEIGHT]; /* that a line came */
    uint16_t next_line;
    uint32_t bands;
    el_stats stats;
} fields;

static void field_begin(void *context, uint16_t width, uint16_t height)
{
    (void)context;
    fields.width = width;
    fields.height = height;
    fields.next_line = 0;
}

static void field_rows(void *context, el_band *band, unsigned slot)
{
    (void)context;
    TEST_ASSERT_EQUAL_UINT8(1, band->gap);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT16(fields.next_line, band->y);
    for (unsigned i = 0; i < band->lines; i++) {
        const unsigned y = band->y + 2U * i;
        TEST_ASSERT_LESS_THAN_UINT(fields.height, y);
        memcpy(fields.pixels + y * band->width, band->pixels + i * band->width, 2U * band->width);
        memcpy(fields.depth + y * band->width, band->depth + i * band->width, 2U * band->width);
        fields.times[y]++;
        fields.next_line = (uint16_t)(y + 1);
    }
    fields.bands++;
    el_band_release(band, slot);
}

static void field_end(void *context, const el_stats *stats)
{
    (void)context;
    fields.stats = *stats;
}

static const el_sink field_sink = {.begin = field_begin, .rows = field_rows, .end = field_end, .takes_gaps = true};

/* A layer that draws by the screen's lines. */
static void draw_stripes(void *context, el_band *band)
{
    for (unsigned i = 0; i < (unsigned)band->lines * band->width; i++) {
        const unsigned y = band->y + i / band->width;
        if ((i % band->width + y) % 3 == 0) {
            band->pixels[i] ^= (uint16_t)(y * 77U + *(const uint16_t *)context);
        }
    }
}

static uint16_t keys[2] = {0x0123, 0x4567};
static const el_layer layers[2] = {{.context = &keys[0], .draw = draw_stripes},
                                   {.context = &keys[1], .draw = draw_stripes}};

static el_config config_of(uint16_t height, uint16_t band_lines, size_t bytes, unsigned arena)
{
    const size_t least = EL_MIN_MEMORY_BYTES((unsigned)WIDTH, (unsigned)height, (unsigned)band_lines);
    return (el_config){.width = WIDTH,
                       .height = height,
                       .band_lines = band_lines,
                       .background = 0x8410,
                       .memory = memory[arena],
                       .memory_bytes = bytes > least ? bytes : least,
                       .under = &layers[0],
                       .over = &layers[1]};
}

static void any_materials(seeded *s)
{
    fill_mixed_scene(s, &scene);
    for (unsigned i = 0; i < SCENE_MESHES; i++) {
        el_material *const material = &scene.meshes[i].material;
        if (EL_WITH_DITHER && any_below(s, 2) == 0) {
            material->flags |= EL_MATERIAL_DITHER;
        }
#if EL_WITH_WIRES
        if (any_below(s, 4) == 0) {
            *material = (el_material){.flags = (uint8_t)(EL_MATERIAL_WIRES | (material->flags & 3U)),
                                      .colour = {(uint8_t)any_u64(s), 200, 30}};
            scene.meshes[i].mesh.edges = any_below(s, 2) == 0 ? edges : NULL;
        }
#endif
    }
    for (unsigned i = 0; i < SCENE_TRIANGLES; i++) {
        edges[i] = (uint8_t)any_u64(s);
    }
}

static void test_two_frames_are_the_whole_picture(void)
{
    uint32_t passes = 0;
    seeded s = seeded_from(1);
    for (; s.round < ROUNDS; s.round++) {
        any_materials(&s);
        const uint16_t height = (uint16_t)any_between(&s, 2, HEIGHT);
        const el_sink sink = recording_sink(&whole);
        memset(&whole, 0, sizeof whole);
        el_config config = config_of(height, height < 9 ? height : 9, PLENTY, 0);
        config.sinks[0] = &sink;
        el_renderer renderer;
        TEST_ASSERT_EQUAL_INT(EL_OK, el_init(&renderer, &config));
        play_scene(&renderer, &scene);

        memset(&fields, 0, sizeof fields);
        config = config_of(height, (uint16_t)any_between(&s, 1, height), any_below(&s, 2) == 0 ? 0 : PLENTY, 1);
        config.interlaced = true;
        config.sinks[0] = &field_sink;
        TEST_ASSERT_EQUAL_INT(EL_OK, el_init(&renderer, &config));
        for (unsigned frame = 0; frame < 2; frame++) {
            play_scene(&renderer, &scene);
            passes += fields.stats.passes > 1 || fields.stats.flushes > 0;
            for (unsigned y = 0; y < height; y++) {
                TEST_ASSERT_EQUAL_UINT8(y % 2 <= frame, fields.times[y]);
            }
        }
        for (unsigned i = 0; i < (unsigned)WIDTH * height; i++) {
            if (whole.pixels[i] != fields.pixels[i] || whole.depth[i] != fields.depth[i]) {
                fail_at(&s, "pixel (%u, %u) is %04x at %04x, not %04x at %04x", i % WIDTH, i / WIDTH, fields.pixels[i],
                        fields.depth[i], whole.pixels[i], whole.depth[i]);
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(0, passes);
}

/* Half of the pixels are drawn, and of small triangles only those that have a line. */
static void test_a_frame_does_half_of_the_work(void)
{
    seeded s = seeded_from(2);
    fill_scene(&s, &scene);
    const el_sink sink = recording_sink(&whole);
    memset(&whole, 0, sizeof whole);
    el_config config = config_of(HEIGHT, 10, PLENTY, 0);
    config.sinks[0] = &sink;
    el_renderer renderer;
    TEST_ASSERT_EQUAL_INT(EL_OK, el_init(&renderer, &config));
    play_scene(&renderer, &scene);
    config.interlaced = true;
    config.sinks[0] = &field_sink;
    TEST_ASSERT_EQUAL_INT(EL_OK, el_init(&renderer, &config));
    uint32_t pixels = 0;
    for (unsigned frame = 0; frame < 2; frame++) {
        fields.bands = 0;
        play_scene(&renderer, &scene);
        TEST_ASSERT_EQUAL_UINT32(4, fields.bands);
        TEST_ASSERT_UINT32_WITHIN(EL_WITH_STATS ? whole.stats.pixels / 20 : 0, whole.stats.pixels / 2,
                                  fields.stats.pixels);
        pixels += fields.stats.pixels;
    }
    if (!EL_WITH_HIDDEN) {
        TEST_ASSERT_EQUAL_UINT32(whole.stats.pixels, pixels);
    }
}

static void expect_init(const el_config *config, el_status status)
{
    el_renderer renderer;
    TEST_ASSERT_EQUAL_INT(status, el_init(&renderer, config));
}

static void test_what_does_not_go_with_it_is_refused(void)
{
    const el_sink deaf = recording_sink(&whole);
    const el_config good = {.width = WIDTH,
                            .height = HEIGHT,
                            .band_lines = 8,
                            .interlaced = true,
                            .memory = memory[0],
                            .memory_bytes = PLENTY,
                            .sinks = {&field_sink, NULL, &field_sink}};
    expect_init(&good, EL_OK);
    el_config bad = good;
    bad.sinks[1] = &deaf;
    expect_init(&bad, EL_ERROR_ARGUMENT);
    bad = good;
    bad.height = 1;
    bad.band_lines = 1;
    expect_init(&bad, EL_ERROR_SIZE);
    bad = good;
    bad.reuse = EL_REUSE_BACKGROUND;
    expect_init(&bad, EL_ERROR_SIZE);
#if EL_WITH_SAMPLES
    bad = good;
    bad.samples = 4;
    expect_init(&bad, EL_ERROR_SIZE);
#endif
    bad = good;
    bad.depth_prepass = true;
    expect_init(&bad, EL_ERROR_SIZE);
    bad = good;
    bad.view = EL_DEBUG_DEPTH;
    expect_init(&bad, EL_ERROR_SIZE);
}

/* On the glass: two frames of what stands still are what one is without gaps; and half of the wire, but for the windows. */
static void test_a_panel_shows_both_fields(void)
{
    static uint16_t expected[128 * 160];
    static uint16_t glass[128 * 160];
    static uint8_t arena[200000] __attribute__((aligned(8)));
    seeded s = seeded_from(3);
    fill_scene(&s, &scene);
    for (unsigned way = 0; way < 4; way++) {
        uint64_t bytes[2];
        for (unsigned interlaced = 0; interlaced < 2; interlaced++) {
            el_display display = {0};
            TEST_ASSERT_TRUE(el_display_open(&display, &(el_display_config){.panel = "st7735",
                                                                            .band_lines = 8,
                                                                            .rotation = (el_rotation)way,
                                                                            .bytes_only = way % 2 != 0,
                                                                            .sparing = way == 3,
                                                                            .chunk = way == 2 ? 50 : 0}));
            el_renderer renderer;
            const el_config config = {.width = display.width,
                                      .height = display.height,
                                      .band_lines = 8,
                                      .interlaced = interlaced != 0,
                                      .memory = arena,
                                      .memory_bytes = sizeof arena,
                                      .sinks = {&display.sink}};
            TEST_ASSERT_EQUAL_INT(EL_OK, el_init(&renderer, &config));
            const uint64_t before = display.bus_state.traffic.pixel_bytes + display.bus_state.traffic.command_bytes;
            for (unsigned frame = 0; frame <= interlaced; frame++) {
                play_scene(&renderer, &scene);
            }
            TEST_ASSERT_TRUE(el_display_look(&display, interlaced != 0 ? glass : expected));
            bytes[interlaced] =
                display.bus_state.traffic.pixel_bytes + display.bus_state.traffic.command_bytes - before;
            const uint32_t lines = display.height;
            el_display_close(&display);
            if (interlaced !=
                0) { /* columns are set in each frame; rows and the write command once, or for each line */
                TEST_ASSERT_EQUAL_UINT64(bytes[0] + 5 + 6 * (lines - 1), bytes[1]);
                TEST_ASSERT_EQUAL_MEMORY(expected, glass, sizeof glass);
            }
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_two_frames_are_the_whole_picture);
    RUN_TEST(test_a_frame_does_half_of_the_work);
    RUN_TEST(test_what_does_not_go_with_it_is_refused);
    RUN_TEST(test_a_panel_shows_both_fields);
    return UNITY_END();
}

#else

static void test_it_is_left_out(void)
{
    (void)scene;
    (void)whole;
    TEST_ASSERT_EQUAL_INT(0, EL_WITH_INTERLACED);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_it_is_left_out);
    return UNITY_END();
}

#endif
