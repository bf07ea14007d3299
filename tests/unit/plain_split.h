/* A decoder of codec 2 that follows WIRE.md ("Split streams") token by token, checks each rule of it, and shares nothing
 * with the encoder. */
#ifndef EL_TEST_PLAIN_SPLIT_H
#define EL_TEST_PLAIN_SPLIT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A packet's body behind its header, and how far it has been read; all but the last three members are the caller's. */
typedef struct plain_split {
    const uint8_t *tokens;
    uint32_t token_count;
    const uint16_t *literals; /* as the packet has them: the first one last */
    uint32_t literal_count;
    const uint8_t *lags; /* a bit per line */
    uint32_t width;
    uint32_t line;
    uint32_t token;
    uint32_t used; /* literals */
} plain_split;

static inline uint16_t plain_split_delta(uint8_t token)
{
    const int green = token / 9 - 3;
    const int q = green >= 0 ? green / 2 : -((1 - green) / 2);
    return (uint16_t)(2048 * (token / 3 % 3 - 1 + q) + 32 * green + token % 3 - 1 + q);
}

static inline uint16_t plain_split_class(uint32_t class)
{
    static const int8_t classes[8][3] = {{0, 0, 0}, {-1, -1, 0},  {0, -1, 0}, {0, 1, 0},
                                         {1, 1, 0}, {-1, -1, -1}, {1, 1, 1},  {-1, 0, 0}};
    return (uint16_t)(2048 * classes[class][0] + 32 * classes[class][1] + classes[class][2]);
}

/* The next line, over `row`, which holds the host's pixels. `above` is the line above it, or NULL. False where the packet
 * breaks a rule. */
static inline bool plain_split_line(plain_split *packet, const uint16_t *above, uint16_t *row)
{
    const uint32_t width = packet->width;
    const uint32_t lag = (packet->lags[packet->line / 8] >> packet->line % 8 & 1) != 0 ? 4 : 1;
    uint8_t going = 0; /* the token that 239..247 go on with; 0: none */
    packet->line++;
    for (uint32_t x = 0; x < width;) {
        if (packet->token == packet->token_count) {
            return false;
        }
        uint8_t t = packet->tokens[packet->token++];
        uint32_t count = 1;
        if (t >= 63 && t < 127) {
            count = 2;
        } else if (t >= 175 && t < 239) {
            count = (t - 175U) % 16 + 1;
        } else if (t >= 239 && t < 247) {
            count = 16 * (t - 238U);
        } else if (t == 248) {
            count = 64;
        } else if (t == 247 || t == 249) {
            count = width - x;
        } else if (t >= 250) {
            count = t - 249U;
        }
        if (t >= 239 && t < 248 && going == 0) {
            return false;
        }
        t = t >= 239 && t < 248 ? going : t;
        going = t >= 175 && t < 250 ? t : 0;
        const int32_t from = (int32_t)x + (t < 207 ? 0 : t < 223 ? -1 : 1);
        const bool copies = t >= 191 && t < 239;
        if (x + count > width || (copies && (above == NULL || from < 0 || (uint32_t)from + count > width)) ||
            (t >= 127 && t < 175 && packet->used <= t - 127U) ||
            (t >= 250 && packet->used + count > packet->literal_count)) {
            return false;
        }
        const uint16_t *const end = packet->literals + packet->literal_count;
        for (uint32_t i = 0; i < count; i++, x++) {
            const uint16_t left = x >= lag ? row[x - lag] : (uint16_t)(above != NULL ? above[x] : 0);
            if (t < 63) {
                row[x] = (uint16_t)(left + plain_split_delta(t));
            } else if (t < 127) {
                row[x] = (uint16_t)(left + plain_split_class(i == 0 ? (t - 63U) / 8 : (t - 63U) % 8));
            } else if (t < 175) {
                row[x] = *(end - (packet->used - (t - 127U)));
            } else if (t < 191) {
                row[x] = left;
            } else if (t < 239) {
                row[x] = above[from + (int32_t)i];
            } else if (t >= 250) {
                row[x] = *(end - ++packet->used);
            }
        }
    }
    return true;
}

/* Whether the packet ends here. */
static inline bool plain_split_ends(const plain_split *packet)
{
    return packet->token == packet->token_count && packet->used == packet->literal_count;
}

#endif
