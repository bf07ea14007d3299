/* Codec 2: whatever goes in comes back from a decoder that follows WIRE.md token by token, within the packet's bounds, and
 * the bytes do not depend on the bands. */
#include "plain_split.h"
#include "seeded.h"
#include "stream_device.h"

enum { MAX_WIDTH = 2040, GUARD = 0xA5, MAX_LINES = 12 };

void setUp(void)
{
}

void tearDown(void)
{
}

/* --- Lines of all kinds ------------------------------------------------------------------------------------------- */

static uint16_t lines[MAX_LINES][MAX_WIDTH];

static void paint(seeded *seed, uint32_t y, uint32_t width)
{
    static const uint8_t order[4] = {0, 8, 2, 10};
    const uint32_t kind = any_below(seed, 6);
    const uint32_t shift = any_below(seed, 3);
    uint16_t value = (uint16_t)any_below(seed, 65536);
    for (uint32_t x = 0; x < width; x++) {
        switch (kind) {
        case 0: /* noise of few or many colours */
            value = (uint16_t)(any_below(seed, shift == 0 ? 65536 : 60) * 977);
            break;
        case 1: /* runs */
            value = any_below(seed, 1 + 40 * shift) == 0 ? (uint16_t)any_below(seed, 65536) : value;
            break;
        case 2: /* a slope */
            value = (uint16_t)(value + (any_below(seed, 3) << 11) + (any_below(seed, 5) << 5) + any_below(seed, 3) -
                               2049 - 64);
            break;
        case 3: /* dithering */
            value = (uint16_t)((x + order[x & 3] * 8) / 64 * 0x0841);
            break;
        default: /* the line above, moved, with faults */
            value = y == 0 || x + shift < 1 || x + shift > width || any_below(seed, 20) == 0
                        ? (uint16_t)any_below(seed, 65536)
                        : lines[y - 1][x + shift - 1];
        }
        lines[y][x] = value;
    }
}

static void check_packet(seeded *seed, uint32_t width)
{
    static _Alignas(2) uint8_t buffer[EL_SPLIT_BUFFER_BYTES(MAX_WIDTH) + 4];
    static uint16_t host[MAX_LINES][MAX_WIDTH];
    static el_split split;
    memset(buffer, GUARD, sizeof buffer);
    el_split_init(&split, buffer + 2, (uint16_t)width);
    const bool joined = any_below(seed, 2) != 0;
    uint32_t y = 1;
    paint(seed, 0, width); /* above the packet's first line */
    for (; y < MAX_LINES && !el_split_is_full(&split); y++) {
        paint(seed, y, width);
        uint32_t changed = any_below(seed, 2) != 0 ? UINT32_MAX : (uint32_t)any_u64(seed) | 1U << (width - 1) / 64;
        if (y > 1 && any_below(seed, 8) == 0) {
            el_split_add_gap(&split, 1);
            changed = 0;
        } else {
            const uint32_t before = split.token_count + 2 * split.literal_count;
            el_split_add(&split, lines[y], y > 1 || joined ? lines[y - 1] : NULL, changed);
            EXPECT(seed, split.token_count + 2 * split.literal_count - before <= EL_SPLIT_LINE_MAX_BYTES(width));
        }
        for (uint32_t x = 0; x < width; x++) {
            host[y][x] = (changed >> x / 64 & 1U) != 0 ? 0xDEAD : lines[y][x];
        }
    }
    EXPECT(seed, split.joined == joined && split.lines == y - 1);
    const uint8_t *const end = buffer + 2 + EL_SPLIT_BUFFER_BYTES(width);
    EXPECT(seed, buffer[0] == GUARD && buffer[1] == GUARD && end[0] == GUARD && end[1] == GUARD);
    EXPECT(seed, (const uint8_t *)(split.literals + split.literal_count) == end);
    plain_split packet = {.tokens = split.tokens,
                          .token_count = split.token_count,
                          .literals = split.literals,
                          .literal_count = split.literal_count,
                          .lags = split.lags,
                          .width = width};
    for (uint32_t line = 1; line < y; line++) {
        EXPECT(seed, plain_split_line(&packet, line > 1 ? host[line - 1] : joined ? lines[0] : NULL, host[line]));
        EXPECT(seed, memcmp(host[line], lines[line], 2 * width) == 0);
    }
    EXPECT(seed, plain_split_ends(&packet));
}

static void test_seeded_packets_come_back(void)
{
    seeded seed = seeded_from(5201);
    for (seed.round = 0; seed.round < PART_OF(4000); seed.round++) {
        check_packet(&seed, 1 + any_below(&seed, seed.round % 16 == 0 ? MAX_WIDTH : 400));
    }
}

/* Noise: nothing but literals, as many bytes as the bound says. */
static void test_the_bound_is_met(void)
{
    static _Alignas(2) uint8_t buffer[EL_SPLIT_BUFFER_BYTES(320)];
    static el_split split;
    for (uint32_t x = 0; x < 320; x++) {
        lines[0][x] = (uint16_t)(x * 25717 + 777);
    }
    el_split_init(&split, buffer, 320);
    el_split_add(&split, lines[0], NULL, UINT32_MAX);
    TEST_ASSERT_EQUAL_UINT32(EL_SPLIT_LINE_MAX_BYTES(320), split.token_count + 2 * split.literal_count);
}

/* --- In a session ------------------------------------------------------------------------------------------------- */

/* What a device sends of three frames whose bands have `band_lines`. */
static size_t record(uint16_t band_lines, uint8_t *bytes)
{
    static fake_link wire;
    static test_device dev;
    seeded seed = seeded_from(5202);
    fake_link_init(&wire);
    device_init(&dev, &wire, 100, 60, false);
    dev.band_lines = band_lines;
    host_packet(&wire, EL_PACKET_START, "00 03 00 00 04 00");
    el_stream_poll(&dev.stream);
    const size_t begin = wire.out_count;
    for (uint32_t frame = 0; frame < 3; frame++) {
        for (uint32_t y = 0; y < 60; y++) {
            if (frame == 0 || any_below(&seed, 3) == 0) {
                paint(&seed, 1, 100);
                memcpy(dev.pixels + 100 * y, lines[1], 200);
            }
        }
        device_draw(&dev);
    }
    device_check_guards(&dev);
    memcpy(bytes, wire.out + begin, wire.out_count - begin);
    return wire.out_count - begin;
}

static void test_bytes_do_not_depend_on_bands(void)
{
    static uint8_t expected[FAKE_OUT_BYTES];
    static uint8_t bytes[FAKE_OUT_BYTES];
    const size_t count = record(60, expected);
    TEST_ASSERT_GREATER_THAN_UINT32(5000, count);
    for (uint16_t band_lines = 1; band_lines < 20; band_lines++) {
        TEST_ASSERT_EQUAL_UINT32(count, record(band_lines, bytes));
        TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, bytes, count);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_seeded_packets_come_back);
    RUN_TEST(test_the_bound_is_met);
    RUN_TEST(test_bytes_do_not_depend_on_bands);
    return UNITY_END();
}
