#include "codec_first.h"

#include <stdbool.h>
#include <stddef.h>

#include "codec_sequences.h"
#include "stream/packet.h"
#include "stream/session.h"

enum { FULL_BYTES = 1000, MAX_GAP = 12, MOST_LITERALS = 16, GOOD_LENGTH = 16, LENGTHS = 24, DITHER_LAG = 4 };

/* A packet that is being built, as far as its size goes. */
typedef struct packet {
    uint32_t tokens;
    uint32_t literals;
    uint32_t lines;
    bool lagging;
} packet;

typedef struct place {
    const uint16_t *pixels; /* of the line */
    const uint16_t *above;  /* or NULL */
    uint32_t lag;
} place;

static uint32_t end_packet(packet *p)
{
    const uint32_t head = EL_PACKET_OVERHEAD_BYTES + EL_STREAM_BAND_HEADER_BYTES;
    const uint32_t bytes = head + (p->lagging ? (p->lines + 7) / 8 : 0) + p->tokens + 2 * p->literals;
    const bool empty = p->lines == 0;
    *p = (packet){0};
    return empty ? 0 : bytes;
}

static uint32_t tokens_for(uint32_t count)
{
    static const uint16_t lengths[LENGTHS] = {1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11,  12,
                                              13, 14, 15, 16, 20, 24, 32, 48, 64, 96, 128, CODEC_WIDTH};
    uint32_t tokens = 0;
    for (uint32_t i = LENGTHS; i-- > 0;) {
        tokens += count / lengths[i];
        count %= lengths[i];
    }
    return tokens;
}

static uint16_t left_of(const place *at, uint32_t x)
{
    return x >= at->lag ? at->pixels[x - at->lag] : at->above != NULL ? at->above[x] : 0;
}

static uint32_t matching(const place *at, uint32_t x, uint32_t end, int32_t slant)
{
    uint32_t count = 0;
    while (x + count < end && (int32_t)(x + count) + slant >= 0 && (int32_t)(x + count) + slant < CODEC_WIDTH &&
           at->pixels[x + count] == at->above[(int32_t)(x + count) + slant]) {
        count++;
    }
    return count;
}

static uint32_t longest_stretch(const place *at, uint32_t x, uint32_t end)
{
    uint32_t best = 0;
    while (x + best < end && at->pixels[x + best] == left_of(at, x + best)) {
        best++;
    }
    if (best < GOOD_LENGTH && at->above != NULL) {
        for (int32_t slant = -1; slant <= 1; slant++) {
            const uint32_t count = matching(at, x, end, slant);
            best = count > best ? count : best;
        }
    }
    return best;
}

static bool is_delta(uint16_t difference)
{
    for (int dg = -6; dg <= 6; dg++) {
        const int q = (dg + 6) / 2 - 3; /* floor(dg / 2) */
        for (int i = 0; i < 9; i++) {
            if (difference == (uint16_t)(2048 * (i / 3 - 1 + q) + 32 * dg + i % 3 - 1 + q)) {
                return true;
            }
        }
    }
    return false;
}

static void put_pixels(packet *p, const place *at, uint32_t x, uint32_t end)
{
    uint32_t literals = MOST_LITERALS; /* of the token before */
    while (x < end) {
        const uint32_t count = longest_stretch(at, x, end);
        if (count > 0) {
            p->tokens += tokens_for(count);
            literals = MOST_LITERALS;
            x += count;
        } else {
            if (is_delta((uint16_t)(at->pixels[x] - left_of(at, x)))) {
                p->tokens++;
                literals = MOST_LITERALS;
            } else {
                p->tokens += literals == MOST_LITERALS;
                literals = literals == MOST_LITERALS ? 1 : literals + 1;
                p->literals++;
            }
            x++;
        }
    }
}

static uint32_t lag_of(const uint16_t *pixels)
{
    uint32_t near = 0;
    uint32_t far = 0;
    for (uint32_t x = DITHER_LAG; x < CODEC_WIDTH; x++) {
        near += pixels[x] == pixels[x - 1];
        far += pixels[x] == pixels[x - DITHER_LAG];
    }
    return far > near ? DITHER_LAG : 1;
}

static bool equals(const uint16_t *one, const uint16_t *other, uint32_t begin, uint32_t end)
{
    while (begin < end && one[begin] == other[begin]) {
        begin++;
    }
    return begin == end;
}

/* The line, without the units that the host has; `known` is NULL where all is sent. */
static void put_line(packet *p, const place *at, const uint16_t *known, uint32_t unit)
{
    uint32_t skipped = 0;
    for (uint32_t x = 0, end; x < CODEC_WIDTH; x = end) {
        end = x + unit < CODEC_WIDTH ? x + unit : CODEC_WIDTH;
        if (known != NULL && equals(at->pixels, known, x, end)) {
            skipped += end - x;
            continue;
        }
        while (end < CODEC_WIDTH && (known == NULL || !equals(at->pixels, known, end,
                                                              end + unit < CODEC_WIDTH ? end + unit : CODEC_WIDTH))) {
            end = end + unit < CODEC_WIDTH ? end + unit : CODEC_WIDTH;
        }
        p->tokens += tokens_for(skipped);
        skipped = 0;
        put_pixels(p, at, x, end);
    }
    p->tokens += tokens_for(skipped);
}

uint32_t codec_first_bytes(const uint16_t *frame, const uint16_t *known, uint32_t unit, uint32_t refresh)
{
    packet p = {0};
    uint32_t bytes = 0;
    uint32_t gap = 0;
    for (uint32_t y = 0; y < CODEC_HEIGHT; y++) {
        const uint16_t *const pixels = frame + y * CODEC_WIDTH;
        const uint16_t *const had = known == NULL || y == refresh || y == refresh + 1 ? NULL : known + y * CODEC_WIDTH;
        if (had != NULL && equals(pixels, had, 0, CODEC_WIDTH)) {
            gap++;
            continue;
        }
        if (gap > MAX_GAP || p.tokens + 2 * p.literals >= FULL_BYTES) {
            bytes += end_packet(&p);
        } else if (p.lines > 0) {
            p.tokens += gap;
            p.lines += gap;
        }
        gap = 0;
        const place at = {pixels, p.lines > 0 ? pixels - CODEC_WIDTH : NULL, lag_of(pixels)};
        p.lagging = p.lagging || at.lag != 1;
        p.lines++;
        put_line(&p, &at, had, unit);
    }
    return bytes + end_packet(&p);
}
