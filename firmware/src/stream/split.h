/* Codec 2, split streams: lines of RGB565 pixels as one-byte tokens and, apart from them, literal pixels.
 *
 *       0 ..  62   delta: L + 2048 dr + 32 dg + db, modulo 2^16, where
 *                  token = (dg + 3) * 9 + (dr - q + 1) * 3 + (db - q + 1), q = floor(dg / 2), dg in -3..3
 *      63 .. 126   two pixels, each a delta to its own L: 63 + 8 a + b, a and b of the classes (dr, dg, db) =
 *                  (0, 0, 0) (-1, -1, 0) (0, -1, 0) (0, 1, 0) (1, 1, 0) (-1, -1, -1) (1, 1, 1) (-1, 0, 0)
 *     127 .. 174   one of the packet's last 48 literals: 127 is the last one
 *     175 .. 190   run of 1..16 pixels, each its own L
 *     191 .. 206   copy of 1..16 pixels from the line above
 *     207 .. 222   copy of 1..16 pixels from the line above, from one pixel further left
 *     223 .. 238   the same, from one pixel further right
 *     239 .. 246   what the token before is, a run, a copy or a skip, for 16, 32, ... 128 pixels more
 *     247          the same, up to the end of the line
 *     248          skip: the host keeps its 64 pixels
 *     249          skip to the end of the line
 *     250 .. 255   1..6 literals
 *
 * L is the pixel `lag` to the left, lag being 1 or, where a line is dithered in blocks of 4x4, 4; where there is none, the
 * pixel above. A token never crosses the end of a line. Above a packet's first line is the host's line, if the packet says
 * so; else L is 0 there, and there are no copies.
 *
 * A packet is built line by line in one buffer: tokens from its front upwards, literals from its end downwards, so that
 * neither needs a buffer of its own, and both leave it as they lie. The literals are therefore sent last one first. A
 * packet goes on over the end of a band: it does not depend on how high bands are. WIRE.md tells the receiver's side. */
#ifndef EL_STREAM_SPLIT_H
#define EL_STREAM_SPLIT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
    EL_SPLIT_FULL_BYTES = 986, /* a packet with more of tokens and literals takes no further line */
    EL_SPLIT_MAX_LINES = 255,
    EL_SPLIT_MAX_GAP = 12,        /* unchanged lines, a token each, that cost less than another packet's head */
    EL_SPLIT_SEGMENT_PIXELS = 64, /* what is left out is a multiple of this, but for a line's last segment */
    EL_SPLIT_SLOTS = 256          /* half of them cost 0.9 % more bytes in a textured room, twice as many save 0.1 % */
};

/* Bytes of tokens and literals of a line of `width` pixels, at most: nothing costs more than literals do, which come 6 to a
 * token, since every other token has a byte for a pixel or more. */
#define EL_SPLIT_LINE_MAX_BYTES(width) (2 * (width) + ((width) + 5) / 6)

/* Tokens and literals of a packet, at most, and an even number: the last line begins in a packet that is just not full. */
#define EL_SPLIT_BUFFER_BYTES(width)                                                                                   \
    (((int)EL_SPLIT_FULL_BYTES + (int)EL_SPLIT_MAX_GAP + EL_SPLIT_LINE_MAX_BYTES(width) + 1) / 2 * 2)

/* A packet that is being built. The caller owns it; all but the last two members may be read. */
typedef struct el_split {
    uint8_t *tokens;    /* [token_count], at the front of the buffer */
    uint16_t *literals; /* [literal_count], at its end; the last one comes first */
    uint32_t token_count;
    uint32_t literal_count;
    uint16_t width;
    uint16_t lines;               /* 0: empty */
    bool joined;                  /* to the host's line above the first one */
    bool lagging;                 /* a line has lag 4 */
    int8_t dithering;             /* more than 0 while lines look dithered */
    uint8_t seen[EL_SPLIT_SLOTS]; /* by its hash: how many literals there were, modulo 256, with the last such one */
    uint8_t lags[(EL_SPLIT_MAX_LINES + 7) / 8]; /* bit l % 8 of byte l / 8: line l has lag 4 */
} el_split;

/* Begins the first packet. `buffer` has EL_SPLIT_BUFFER_BYTES(width), at an even address; width is 1..2040. */
void el_split_init(el_split *split, uint8_t *buffer, uint16_t width);

/* Begins the next packet. */
void el_split_begin(el_split *split);

/* True when the packet has to be sent before a gap and a further line are added. */
static inline bool el_split_is_full(const el_split *split)
{
    return split->token_count + 2 * split->literal_count > EL_SPLIT_FULL_BYTES ||
           split->lines + EL_SPLIT_MAX_GAP >= EL_SPLIT_MAX_LINES;
}

/* Adds lines that the host has; EL_SPLIT_MAX_GAP at most, to a packet that is not full. */
void el_split_add_gap(el_split *split, uint32_t lines);

/* Adds a line. `above` is the line above it as it is drawn now, or NULL in a packet's first line if the packet shall not
 * need it. Bit s of `changed` says that the pixels from 64 s on, up to the next segment, are not those that the host has;
 * one bit at least is set. */
void el_split_add(el_split *split, const uint16_t *pixels, const uint16_t *above, uint32_t changed);

#ifdef __cplusplus
}
#endif

#endif
