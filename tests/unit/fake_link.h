/* A link that tests hold in their hands, and a plain host at its other end.
 *
 * The port takes as many bytes as the test gives it room for; its clock stands still unless the stream waits or the test
 * moves it. The host is written for clarity, shares no code with the device (CRC bit by bit, its own COBS and codecs)
 * and fails the test on whatever breaks a rule of WIRE.md. */
#ifndef FAKE_LINK_H
#define FAKE_LINK_H

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/port.h"
#include "plain_crc32.h"
#include "plain_split.h"
#include "unity.h"

/* --- Seeded numbers (Marsaglia, "Xorshift RNGs", 2003) --------------------------------------------------------- */

static inline uint32_t random_u32(uint32_t *seed)
{
    *seed ^= *seed << 13;
    *seed ^= *seed >> 17;
    *seed ^= *seed << 5;
    return *seed;
}

static inline uint32_t random_below(uint32_t *seed, uint32_t limit)
{
    return random_u32(seed) % limit;
}

/* --- Plain twins ----------------------------------------------------------------------------------------------- */

/* By the definition: cut into blocks, with a 00 thought at the end of the packet. */
static inline size_t plain_cobs_encode(const uint8_t *bytes, size_t count, uint8_t *out)
{
    size_t size = 0;
    size_t at = 0;
    bool more = true;
    while (more) {
        size_t length = 0;
        while (at + length < count && bytes[at + length] != 0 && length < 254) {
            length++;
        }
        out[size++] = (uint8_t)(length + 1);
        memcpy(out + size, bytes + at, length);
        size += length;
        at += length;
        more = at < count;
        if (length < 254) {
            at++; /* the 00 that the block stands for */
        }
    }
    return size;
}

static inline size_t plain_cobs_decode(const uint8_t *bytes, size_t count, uint8_t *out)
{
    size_t size = 0;
    for (size_t at = 0; at < count; at += bytes[at]) {
        if (bytes[at] == 0 || at + bytes[at] > count) {
            return 0; /* no packet either */
        }
        memcpy(out + size, bytes + at + 1, bytes[at] - 1U);
        size += bytes[at] - 1U;
        if (bytes[at] < 255 && at + bytes[at] < count) {
            out[size++] = 0;
        }
    }
    return size;
}

static inline uint32_t get_u16(const uint8_t *bytes)
{
    return bytes[0] + 256U * bytes[1];
}

static inline uint32_t get_u32(const uint8_t *bytes)
{
    return get_u16(bytes) + 65536U * get_u16(bytes + 2);
}

/* "01 02 FF" to bytes; returns their number. */
static inline size_t from_hex(const char *hex, uint8_t *bytes)
{
    size_t count = 0;
    for (char *end; *hex != '\0'; hex = end) {
        bytes[count++] = (uint8_t)strtoul(hex, &end, 16);
        while (*end == ' ') {
            end++;
        }
    }
    return count;
}

/* --- The port -------------------------------------------------------------------------------------------------- */

enum { FAKE_OUT_BYTES = 1 << 20, FAKE_IN_BYTES = 1 << 16 };

typedef struct fake_link {
    uint8_t out[FAKE_OUT_BYTES]; /* device to host */
    size_t out_count;
    size_t out_read; /* the host has seen these */
    size_t room;     /* bytes that the port still takes */
    size_t most;     /* bytes that it takes at once, at most */
    size_t room_per_wait;
    uint8_t in[FAKE_IN_BYTES]; /* host to device */
    size_t in_count;
    size_t in_read;
    uint32_t clock_us;
    uint32_t wait_us; /* how far a wait moves the clock */
    uint32_t waits;
    bool gone;
    int calls_after_gone;
    void (*on_wait)(struct fake_link *link); /* the host's answer while the device waits; or NULL */
    uint8_t host_seq;
    uint32_t baud;    /* of the device's end; the host's is not looked at */
    bool bits_on_way; /* the last byte is not out yet: the rate cannot be changed */
} fake_link;

static inline int32_t fake_write(void *context, const uint8_t *bytes, size_t count)
{
    fake_link *link = context;
    if (link->gone) {
        link->calls_after_gone++;
        return -1;
    }
    count = count < link->most ? count : link->most;
    count = count < link->room ? count : link->room;
    TEST_ASSERT_LESS_OR_EQUAL_UINT32_MESSAGE(FAKE_OUT_BYTES, link->out_count + count, "fake link: out is full");
    memcpy(link->out + link->out_count, bytes, count);
    link->out_count += count;
    link->room -= count;
    return (int32_t)count;
}

static inline int32_t fake_read(void *context, uint8_t *bytes, size_t capacity)
{
    fake_link *link = context;
    size_t count = link->in_count - link->in_read;
    if (link->gone) {
        link->calls_after_gone++;
        return -1;
    }
    count = count < capacity ? count : capacity;
    memcpy(bytes, link->in + link->in_read, count);
    link->in_read += count;
    return (int32_t)count;
}

static inline uint32_t fake_micros(void *context)
{
    const fake_link *link = context;
    return link->clock_us;
}

static inline void fake_wait(void *context)
{
    fake_link *link = context;
    link->waits++;
    link->clock_us += link->wait_us;
    link->room += link->room_per_wait;
    TEST_ASSERT_LESS_THAN_UINT32_MESSAGE(10000000, link->waits, "the device waits for ever");
    if (link->on_wait != NULL) {
        link->on_wait(link);
    }
}

static inline uint32_t fake_cycles(void *context)
{
    return 125 * fake_micros(context);
}

/* A UART whose clock has 16 MHz, 16 of them to a bit at least. */
static inline uint32_t fake_find_baud(void *context, uint32_t rate)
{
    (void)context;
    const uint32_t divider = (16000000 + rate / 2) / rate;
    return 16000000 / (divider < 16 ? 16 : divider);
}

static inline bool fake_set_baud(void *context, uint32_t rate)
{
    fake_link *link = context;
    if (!link->bits_on_way) {
        link->baud = rate;
    }
    return !link->bits_on_way;
}

/* A link that takes everything at once; the clock begins shortly before it wraps. */
static inline void fake_link_init(fake_link *link)
{
    memset(link, 0, sizeof *link);
    link->room = FAKE_OUT_BYTES;
    link->most = FAKE_OUT_BYTES;
    link->wait_us = 1000;
    link->clock_us = 0xFFFFF000;
    link->baud = 115200;
}

static inline el_port fake_port(fake_link *link)
{
    return (el_port){.context = link,
                     .write = fake_write,
                     .read = fake_read,
                     .micros = fake_micros,
                     .wait = fake_wait,
                     .cycles = fake_cycles,
                     .find_baud = fake_find_baud,
                     .set_baud = fake_set_baud};
}

/* --- The host -------------------------------------------------------------------------------------------------- */

static inline void host_bytes(fake_link *link, const uint8_t *bytes, size_t count)
{
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(FAKE_IN_BYTES, link->in_count + count);
    memcpy(link->in + link->in_count, bytes, count);
    link->in_count += count;
}

/* Encodes a packet of any sender; returns its bytes on the wire, the 00 included. */
static inline size_t make_packet(uint8_t type, uint8_t seq, const uint8_t *body, size_t count, uint8_t *wire)
{
    uint8_t packet[4096] = {type, seq};
    memcpy(packet + 2, body, count);
    uint32_t crc = plain_crc32(packet, count + 2);
    for (size_t i = 0; i < 4; i++) {
        packet[count + 2 + i] = (uint8_t)(crc >> 8 * i);
    }
    size_t size = plain_cobs_encode(packet, count + 6, wire);
    wire[size] = 0;
    return size + 1;
}

static inline void host_packet(fake_link *link, uint8_t type, const char *body_hex)
{
    uint8_t body[256];
    uint8_t wire[600];
    size_t count = from_hex(body_hex, body);
    host_bytes(link, wire, make_packet(type, link->host_seq++, body, count, wire));
}

typedef struct host_view {
    uint32_t width;
    uint32_t height;
    uint32_t capabilities;
    uint16_t pixels[128 * 128];
    uint32_t bands;      /* of the frame that is coming in */
    uint32_t band_bytes; /* on the wire */
    uint32_t next_y;
    uint32_t frame; /* its number */
    uint32_t largest_packet;
    bool has_both_codecs; /* set by the test: each band must have the smaller one */
    uint32_t raw_bands;   /* in all */
    uint32_t run_bands;
    uint32_t lines;   /* sent, in all */
    uint32_t damaged; /* chunks */
    uint32_t gaps;    /* packets that the sender's seq says are missing */
    uint32_t hellos;
    uint32_t input_number; /* HELLO's */
    uint32_t rate;         /* the same */
    uint32_t bauds;        /* BAUD packets */
    uint32_t baud;         /* the last one's */
    uint32_t logs;
    char log[256]; /* the last one */
    uint32_t frames;
    uint32_t bad_frames; /* wrong digest or missing bands, though nothing is owed */
    uint32_t owing;      /* frames after which the device still owes lines */
    uint8_t frame_end[256];
    size_t frame_end_bytes;
    bool seen;
    uint8_t next_seq;
} host_view;

/* A band in codec 2, over what the host has. */
static inline void host_take_split(host_view *host, const uint8_t *body, size_t count)
{
    const uint32_t y = get_u16(body + 2);
    const uint32_t lines = body[4];
    const uint8_t no_lags[32] = {0};
    const uint32_t lag_bytes = (body[5] & 8) != 0 ? (lines + 7) / 8 : 0;
    const uint32_t tokens = get_u16(body + 6);
    const size_t used = 8 + lag_bytes + tokens;
    uint16_t literals[2048];
    TEST_ASSERT_TRUE(used <= count && count - used <= sizeof literals && (count - used) % 2 == 0);
    memcpy(literals, body + used, count - used);
    plain_split packet = {.tokens = body + 8 + lag_bytes,
                          .token_count = tokens,
                          .literals = literals,
                          .literal_count = (uint32_t)(count - used) / 2,
                          .lags = lag_bytes > 0 ? body + 8 : no_lags,
                          .width = host->width};
    for (uint32_t line = 0; line < lines; line++) {
        uint16_t *const row = host->pixels + (size_t)(y + line) * host->width;
        const bool has_above = line > 0 || (body[5] & 16) != 0;
        TEST_ASSERT_TRUE_MESSAGE(plain_split_line(&packet, has_above ? row - host->width : NULL, row),
                                 "codec 2 breaks a rule");
    }
    TEST_ASSERT_TRUE(plain_split_ends(&packet));
}

static inline void host_take_band(host_view *host, const uint8_t *body, size_t count)
{
    if (host->width == 0) {
        TEST_FAIL_MESSAGE("BAND before HELLO");
        return;
    }
    TEST_ASSERT_GREATER_OR_EQUAL_UINT32(8, count);
    uint32_t y = get_u16(body + 2);
    uint32_t lines = body[4];
    uint32_t tokens = get_u16(body + 6);
    const uint8_t *token = body + 8;
    const uint8_t *literal = token + tokens;
    uint16_t *out = host->pixels + (size_t)y * host->width;
    uint32_t pixels = lines * host->width;

    if (get_u16(body) != host->frame) { /* the one before was abandoned */
        host->frame = get_u16(body);
        host->bands = 0;
        host->band_bytes = 0;
        host->next_y = 0;
    }
    TEST_ASSERT_TRUE_MESSAGE(lines >= 1 && y + lines <= host->height, "BAND outside the picture");
    TEST_ASSERT_TRUE_MESSAGE(y >= host->next_y, "BANDs overlap or are not in order");
    host->next_y = y + lines;
    if (body[5] == 0) {
        host->raw_bands++;
        TEST_ASSERT_EQUAL_UINT32(0, tokens);
        TEST_ASSERT_EQUAL_UINT32(8 + 2 * (size_t)pixels, count);
        memcpy(out, literal, 2 * (size_t)pixels);
    } else if ((body[5] & 7) == 2) {
        host_take_split(host, body, count);
    } else {
        uint32_t x = 0;
        uint32_t done = 0;
        host->run_bands++;
        TEST_ASSERT_EQUAL_UINT8(1, body[5]);
        for (uint32_t i = 0; i < tokens; i++) {
            uint32_t length = token[i] < 128 ? token[i] + 1U : token[i] - 126U;
            TEST_ASSERT_TRUE_MESSAGE(x + length <= host->width, "token across a line's end");
            for (uint32_t k = 0; k < length; k++) {
                out[done++] = (uint16_t)get_u16(literal);
                literal += token[i] < 128 || k + 1 == length ? 2 : 0;
            }
            x = (x + length) % host->width;
        }
        TEST_ASSERT_EQUAL_UINT32(pixels, done);
        TEST_ASSERT_EQUAL_PTR(body + count, literal);
        TEST_ASSERT_TRUE_MESSAGE(!host->has_both_codecs || count < 8 + 2 * (size_t)pixels, "raw would be smaller");
    }
    host->bands++;
    host->lines += lines;
}

static inline void host_take_frame_end(host_view *host, const uint8_t *body, size_t count)
{
    uint8_t crcs[4 * 128];

    TEST_ASSERT_EQUAL_UINT32(33 + 4 * (size_t)body[28], count);
    for (uint32_t y = 0; y < host->height; y++) {
        const uint8_t *line = (const uint8_t *)(host->pixels + (size_t)y * host->width);
        uint32_t crc = plain_crc32(line, 2 * (size_t)host->width) * 0x9E3779B1U;
        for (uint32_t i = 0; i < 4; i++) {
            crcs[4 * y + i] = (uint8_t)(crc >> 8 * i);
        }
    }
    if (get_u16(body) != host->frame) {
        host->bands = 0;
        host->band_bytes = 0;
    }
    bool good = plain_crc32(crcs, 4 * (size_t)host->height) == get_u32(body + 24);
    const bool owing = (body[23] & 2) != 0;
    host->owing += owing;
    if (get_u16(body + 2) != host->bands || (!good && !owing)) {
        host->bad_frames++;
    } else {
        TEST_ASSERT_EQUAL_UINT32(host->band_bytes, get_u32(body + 16));
    }
    host->frames++;
    host->bands = 0;
    host->band_bytes = 0;
    host->next_y = 0;
    memcpy(host->frame_end, body, count);
    host->frame_end_bytes = count;
}

static inline void host_take_chunk(host_view *host, const uint8_t *chunk, size_t count)
{
    static uint8_t packet[FAKE_OUT_BYTES];
    size_t size = plain_cobs_decode(chunk, count, packet);

    if (size < 6 || plain_crc32(packet, size - 4) != get_u32(packet + size - 4)) {
        host->damaged++;
        return;
    }
    host->gaps += host->seen ? (uint8_t)(packet[1] - host->next_seq) : 0U;
    host->seen = true;
    host->next_seq = (uint8_t)(packet[1] + 1);
    host->largest_packet = size > host->largest_packet ? (uint32_t)size : host->largest_packet;
    switch (packet[0]) {
    case 0x01:
        host->hellos++;
        host->width = get_u16(packet + 2 + 6);
        host->height = get_u16(packet + 2 + 8);
        host->capabilities = get_u32(packet + 2 + 16);
        host->input_number = packet[size - 4 - 12];
        host->rate = get_u32(packet + size - 4 - 4);
        break;
    case 0x03:
        host_take_band(host, packet + 2, size - 6);
        host->band_bytes += (uint32_t)count + 1;
        break;
    case 0x04:
        host_take_frame_end(host, packet + 2, size - 6);
        break;
    case 0x09:
        host->logs++;
        TEST_ASSERT_LESS_THAN_UINT32(sizeof host->log, size - 6);
        memcpy(host->log, packet + 2, size - 6);
        host->log[size - 6] = '\0';
        break;
    case 0x0C:
        TEST_ASSERT_EQUAL_UINT32(6 + 4, size);
        host->bauds++;
        host->baud = get_u32(packet + 2);
        break;
    default:
        TEST_FAIL_MESSAGE("a device sends no packet of this type");
    }
}

/* Takes all that the device has sent since the last call. */
static inline void host_listen(host_view *host, fake_link *link)
{
    for (size_t at = link->out_read; at < link->out_count; at++) {
        if (link->out[at] == 0) {
            if (at > link->out_read) {
                host_take_chunk(host, link->out + link->out_read, at - link->out_read);
            }
            link->out_read = at + 1;
        }
    }
}

#endif
