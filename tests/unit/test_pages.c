/* The pages of firmware/apps/paint, which have one of everything: the same pixels in bands of any height, and on every
 * core. tests/accuracy/test_golden_pages.py has the same figures beside pictures. */
#include "canvas_picture.h"
#include "paint/pages.h"
#include "seeded.h"

enum { WIDTH = 320, HEIGHT = 240 };

static uint16_t pixels[WIDTH * HEIGHT];

void setUp(void)
{
}
void tearDown(void)
{
}

static uint32_t crc_of(const el_page *page, uint32_t frame, int32_t lines)
{
    el_page_frame at = {.page = page, .frame = frame};
    for (int32_t y = 0; y < HEIGHT; y += lines) {
        const int32_t there = HEIGHT - y < lines ? HEIGHT - y : lines;
        el_band band = {.pixels = pixels + y * WIDTH, .width = WIDTH, .y = (uint16_t)y, .lines = (uint16_t)there};
        for (int32_t i = 0; i < there * WIDTH; i++) {
            band.pixels[i] = page->background;
        }
        el_page_draw(&at, &band);
    }
    uint32_t crc = 0;
    for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
        const uint8_t bytes[2] = {(uint8_t)pixels[i], (uint8_t)(pixels[i] >> 8)};
        crc = el_crc32(crc, bytes, sizeof bytes);
    }
    return crc;
}

static void test_pages_are_the_same_in_all_bands_and_on_all_cores(void)
{
    static const struct {
        const char *name;
        uint32_t frame, crc;
    } known[] = {
        {"card", 0, 0x1EE97736},    {"card", 37, 0xBC602ACE},    {"lines", 0, 0xD1312ED5}, {"lines", 37, 0xBCC4D236},
        {"horizon", 0, 0x9C48537F}, {"horizon", 37, 0x58B6613B}, {"hud", 0, 0x13EAAAE4},   {"hud", 37, 0xDFD20213},
    };
    static const int32_t heights[] = {8, 240, 7, 1};
    for (unsigned i = 0; i < sizeof known / sizeof known[0]; i++) {
        const el_page *const page = el_page_find(known[i].name);
        TEST_ASSERT_NOT_NULL(page);
        /* Points lie elsewhere on a finer grid. */
        const uint32_t crc = EL_SUBPIXEL_BITS == 4 ? known[i].crc : crc_of(page, known[i].frame, HEIGHT);
        for (unsigned k = 0; k < PART_OF(4); k++) {
            TEST_ASSERT_EQUAL_HEX32_MESSAGE(crc, crc_of(page, known[i].frame, heights[k]), known[i].name);
        }
    }
}

static void test_pages_are_found_by_name(void)
{
    TEST_ASSERT_EQUAL_UINT(4, el_page_count);
    for (size_t i = 0; i < el_page_count; i++) {
        TEST_ASSERT_EQUAL_PTR(el_pages[i], el_page_find(el_pages[i]->name));
    }
    TEST_ASSERT_NULL(el_page_find("none"));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_pages_are_the_same_in_all_bands_and_on_all_cores);
    RUN_TEST(test_pages_are_found_by_name);
    return UNITY_END();
}
