/* The split-stream encoder on any lines: any width, lines that are noise, runs, slopes, dithered, moved or repeated, any
 * segments changed, gaps between lines, packets joined to the line above or not. What a decoder that follows WIRE.md makes of
 * the packets must be the lines, to the last pixel, and no packet may leave its buffer or be larger than split.h says. */
#include <stdio.h>
#include <stdlib.h>

#include "plain_split.h"
#include "stream/split.h"
#include "take.h"

enum { MAX_WIDTH = 2040, MAX_LINES = 64, MAX_PIXELS = 1 << 14, UNKNOWN = 0xDEAD };

/* A picture that is being sent, and what the host has of it. */
typedef struct mirror {
    uint32_t width;
    uint32_t lines; /* so far */
    uint16_t *drawn;
    uint16_t *host;
} mirror;

static uint16_t *line_of(const mirror *m, uint16_t *pixels, uint32_t line)
{
    return pixels + (size_t)line * m->width;
}

static void draw_line(input *in, const mirror *m, uint16_t *to)
{
    const uint16_t *const above = m->lines > 0 ? line_of(m, m->drawn, m->lines - 1) : NULL;
    const uint8_t how = take_u8(in);
    const uint32_t amount = how >> 4;
    uint16_t value = take_u16(in);
    uint32_t random = value * 2654435761U + 1;
    for (uint32_t x = 0; x < m->width; x++) {
        random = random * 1664525U + 1013904223U;
        switch (how % 8) {
        case 0: /* as the input says */
            value = in->left > 0 ? take_u16(in) : value;
            break;
        case 1: /* few colours or many */
            value = (uint16_t)((random >> 16) % (amount * amount * amount + 2) * 977);
            break;
        case 2: /* runs */
            value = (random >> 24) < amount * 4 ? (uint16_t)(random >> 8) : value;
            break;
        case 3: /* a slope, of green or of all channels, more or less rough */
            value =
                (uint16_t)(value + ((random >> 28) % (amount + 1) - amount / 2) * (amount % 2 == 0 ? 0x20U : 0x0841U));
            break;
        case 4: /* dithered in blocks of four */
            value = (uint16_t)(((x + (random >> 31 & (amount & 1))) % 4 * 16 + x) / 64 * 0x0841);
            break;
        case 5: /* bits of the input */
            value = (uint16_t)(value ^ (x % 8 == 0 ? take_u8(in) : 0));
            break;
        default: /* the line above, moved, with faults */
            value = above == NULL || x + amount % 5 < 2 || x + amount % 5 - 2 >= m->width || random >> 25 < amount / 5
                        ? (uint16_t)(value + 33)
                        : above[x + amount % 5 - 2];
        }
        to[x] = value;
    }
}

/* What the host had before: the pixels that are left out, and elsewhere what nothing may take for granted. */
static void prepare_host(const mirror *m, uint32_t line, uint32_t changed)
{
    const uint16_t *const drawn = line_of(m, m->drawn, line);
    uint16_t *const host = line_of(m, m->host, line);
    for (uint32_t x = 0; x < m->width; x++) {
        host[x] = (changed >> x / EL_SPLIT_SEGMENT_PIXELS & 1U) != 0 ? (uint16_t)UNKNOWN : drawn[x];
    }
}

/* The packet's lines, as a host gets them, are those from `first` on. */
static void check_packet(const mirror *m, const el_split *split, uint32_t first)
{
    plain_split packet = {.tokens = split->tokens,
                          .token_count = split->token_count,
                          .literals = split->literals,
                          .literal_count = split->literal_count,
                          .lags = split->lags,
                          .width = m->width};
    FUZZ_EXPECT(split->lines <= EL_SPLIT_MAX_LINES && first + split->lines == m->lines);
    FUZZ_EXPECT((const uint8_t *)(split->literals + split->literal_count) ==
                split->tokens + EL_SPLIT_BUFFER_BYTES(m->width));
    FUZZ_EXPECT(split->tokens + split->token_count <= (const uint8_t *)split->literals);
    const uint16_t *above = split->joined ? line_of(m, m->host, first - 1) : NULL;
    for (uint32_t line = first; line < m->lines; line++) {
        uint16_t *const host = line_of(m, m->host, line);
        FUZZ_EXPECT(plain_split_line(&packet, above, host));
        FUZZ_EXPECT(memcmp(host, line_of(m, m->drawn, line), 2 * (size_t)m->width) == 0);
        above = host;
    }
    FUZZ_EXPECT(plain_split_ends(&packet));
}

static void send_lines(input *in, mirror *m, uint8_t *buffer)
{
    el_split split;
    uint32_t first = 0;
    el_split_init(&split, buffer, (uint16_t)m->width);
    while (in->left > 0 && m->lines < MAX_LINES && (m->lines + 1) * m->width <= MAX_PIXELS) {
        const uint8_t how = take_u8(in);
        if (split.lines > 0 && (el_split_is_full(&split) || how % 16 == 0)) {
            check_packet(m, &split, first);
            el_split_begin(&split);
            first = m->lines;
        }
        uint16_t *const drawn = line_of(m, m->drawn, m->lines);
        draw_line(in, m, drawn);
        if (how % 16 == 1 && split.lines > 0) { /* a gap: the host has this one */
            prepare_host(m, m->lines, 0);
            el_split_add_gap(&split, 1);
        } else {
            const uint32_t changed =
                how % 16 < 8 ? UINT32_MAX : take_u32(in) | 1U << (how >> 4) % ((m->width + 63) / 64);
            const bool joins = m->lines > 0 && (split.lines > 0 || how % 2 != 0);
            const uint32_t before = split.token_count + 2 * split.literal_count;
            prepare_host(m, m->lines, changed);
            el_split_add(&split, drawn, joins ? line_of(m, m->drawn, m->lines - 1) : NULL, changed);
            FUZZ_EXPECT(split.token_count + 2 * split.literal_count - before <= EL_SPLIT_LINE_MAX_BYTES(m->width));
        }
        m->lines++;
    }
    check_packet(m, &split, first);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count);

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count)
{
    input in = {bytes, count};
    const uint32_t width = take_u16(&in);
    mirror m = {.width = 1 + ((width & 0x8000) != 0 ? width % MAX_WIDTH : width % 140)};
    const size_t buffer_bytes = EL_SPLIT_BUFFER_BYTES(m.width);
    uint8_t *const buffer = malloc(buffer_bytes);
    m.drawn = malloc(2 * MAX_PIXELS);
    m.host = malloc(2 * MAX_PIXELS);
    FUZZ_EXPECT(buffer != NULL && m.drawn != NULL && m.host != NULL);
    send_lines(&in, &m, buffer);
    free(m.host);
    free(m.drawn);
    free(buffer);
    return 0;
}
