/* The guide's examples of two dimensions (firmware/guide/layers.md), each as it stands there, and that it draws what is said
 * there. */
#include <string.h>

#include "edgeline.h"
#include "unity.h"

/* A font of one glyph: a filled square of 4 x 4 pixels, the box of what it lacks is drawn for all else. */
static const uint8_t label_bits[] = {0xFF, 0xFF};
static const el_glyph label_glyphs[] = {{.at = 0, .width = 4, .height = 4, .top = 4, .advance = 5}};
static const el_font_range label_ranges[] = {{.first = 'A', .count = 1, .glyph = 0}};
static const el_font label = {.glyphs = label_glyphs,
                              .ranges = label_ranges,
                              .bits = label_bits,
                              .range_count = 1,
                              .bits_per_pixel = 1,
                              .ascent = 4,
                              .line_height = 6};

static uint16_t screen[320 * 240];

void setUp(void)
{
    memset(screen, 0, sizeof screen);
}

void tearDown(void)
{
}

static uint16_t at(int32_t x, int32_t y)
{
    return screen[y * 320 + x];
}

static void hud(void *context, el_band *band)
{
    (void)context;
    const el_canvas canvas = el_canvas_of(band);
    el_canvas_fill(&canvas, (el_rect){8, 8, 120, 30}, el_glaze(0x0000, 130));
    el_canvas_text(&canvas, &label, 16, 24, EL_ALIGN_LEFT, "31.5 °C", el_solid(0xFFFF));
}

static const el_layer over = {.draw = hud};

static void test_a_hud(void)
{
    static uint8_t arena[EL_MIN_MEMORY_BYTES(320, 240, 8)];
    static el_renderer r;
    el_init(&r, &(el_config){.width = 320,
                             .height = 240,
                             .band_lines = 8,
                             .memory = arena,
                             .memory_bytes = sizeof arena,
                             .background = 0xFFFF,
                             .over = &over});
    TEST_ASSERT_EQUAL_PTR(&over, r.config.over);
    memset(screen, 0xFF, sizeof screen);
    el_band band = {.pixels = screen, .width = 320, .lines = 240};
    hud(NULL, &band);
    TEST_ASSERT_EQUAL_HEX16(0xFFFF, at(7, 8));
    TEST_ASSERT_TRUE(at(8, 8) != 0xFFFF); /* glass */
}

static void send(const el_band *band)
{
    memcpy(screen + band->y * 320, band->pixels, 320U * band->lines * sizeof screen[0]);
}

static void without_a_renderer(void)
{
    static uint16_t pixels[320 * 4];
    for (uint16_t y = 0; y < 240; y += 4) {
        el_band band = {.pixels = pixels, .width = 320, .y = y, .lines = 4};
        memset(pixels, 0, sizeof pixels);
        hud(NULL, &band);
        send(&band);
    }
}

static void test_only_two_dimensions(void)
{
    static uint16_t whole[320 * 240];
    el_band band = {.pixels = whole, .width = 320, .lines = 240};
    hud(NULL, &band);
    without_a_renderer();
    TEST_ASSERT_EQUAL_HEX16_ARRAY(whole, screen, 320 * 240);
}

static const el_canvas canvas = {.pixels = screen, .stride = 320, .clip = {0, 0, 320, 240}};
static uint8_t memory[EL_POLYGON_BYTES(1500, 320)];
static el_polygon p;

static void test_a_polygon_with_a_hole(void)
{
    el_polygon_begin(&p, memory, sizeof memory);
    el_polygon_rectangle(&p, EL_SUB(20), EL_SUB(20), EL_SUB(120), EL_SUB(80), EL_SUB(8));
    el_polygon_move(&p, EL_SUB(40), EL_SUB(40));
    el_polygon_line(&p, EL_SUB(90), EL_SUB(45));
    el_polygon_line(&p, EL_SUB(60), EL_SUB(70));
    if (el_polygon_fill(&p, &canvas, EL_EVEN_ODD, EL_SMOOTH_4, el_solid(0xFFE0)) != EL_OK) {
        TEST_FAIL_MESSAGE("too little memory");
    }
    TEST_ASSERT_EQUAL_HEX16(0xFFE0, at(30, 30));
    TEST_ASSERT_EQUAL_HEX16(0, at(62, 50));
}

static void test_a_curve_of_a_plot(void)
{
    const int32_t points[][2] = {{EL_SUB(10), EL_SUB(100)}, {EL_SUB(60), EL_SUB(40)}, {EL_SUB(110), EL_SUB(100)}};
    const uint32_t count = 3;
    el_polygon_begin(&p, memory, sizeof memory);
    el_polygon_stroke(&p, points, count, false,
                      &(el_stroke){.width = EL_SUB(3), .cap = EL_CAP_ROUND, .join = EL_JOIN_ROUND});
    el_polygon_fill(&p, &canvas, EL_NON_ZERO, EL_SMOOTH_8, el_solid(0x07E0));
    TEST_ASSERT_EQUAL_HEX16(0x07E0, at(60, 40));
    TEST_ASSERT_EQUAL_HEX16(0, at(60, 60));
}

static void test_a_gauge(void)
{
    const uint32_t value = 50;
    el_polygon_begin(&p, memory, sizeof memory);
    el_polygon_sector(&p, EL_SUB(160), EL_SUB(120), EL_SUB(60), EL_SUB(48), EL_DEGREES(135, 1),
                      value * EL_DEGREES(27, 10));
    el_polygon_fill(&p, &canvas, EL_NON_ZERO, EL_SMOOTH_4, el_solid(0xF800));
    TEST_ASSERT_EQUAL_HEX16(0xF800, at(106, 118)); /* on the left: in the half that is shown */
    TEST_ASSERT_EQUAL_HEX16(0, at(214, 118));
}

static const uint8_t ship_pixels[16 * 8] = {[4 * 8 + 3] = 0x12}; /* a pixel of each of two colours */
static const uint16_t ship_palette[16] = {0, 0x001F, 0xFFFF};
static const el_image ship = {.width = 16,
                              .height = 16,
                              .format = EL_IMAGE_INDEX4,
                              .has_key = true,
                              .key = 0,
                              .pixels = ship_pixels,
                              .palette = ship_palette};

static void test_a_sprite(void)
{
    el_canvas_image(&canvas, &ship, 40, 50, 255);
    el_canvas_image_turned(&canvas, &ship,
                           &(el_image_place){.x = EL_SUB(90),
                                             .y = EL_SUB(60),
                                             .angle = EL_DEGREES(30, 1),
                                             .scale_q16 = 2 << 16,
                                             .smooth = true,
                                             .alpha = 255});
    TEST_ASSERT_EQUAL_HEX16(0x001F, at(46, 54));
    TEST_ASSERT_EQUAL_HEX16(0xFFFF, at(47, 54));
    TEST_ASSERT_EQUAL_HEX16(0, at(48, 54));
}

static void test_a_clip_rectangle(void)
{
    const el_canvas window = el_canvas_clipped(&canvas, (el_rect){10, 10, 150, 110});
    el_canvas_line(&window, 0, 0, 319, 239, el_solid(0xFFFF));
    TEST_ASSERT_EQUAL_HEX16(0, at(0, 0));
    TEST_ASSERT_EQUAL_HEX16(0xFFFF, at(40, 30));
    TEST_ASSERT_EQUAL_HEX16(0, at(200, 150));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_hud);
    RUN_TEST(test_only_two_dimensions);
    RUN_TEST(test_a_polygon_with_a_hole);
    RUN_TEST(test_a_curve_of_a_plot);
    RUN_TEST(test_a_gauge);
    RUN_TEST(test_a_sprite);
    RUN_TEST(test_a_clip_rectangle);
    return UNITY_END();
}
