/* Codec 1, run lengths: a line of RGB565 pixels as tokens and literals.
 *
 *     token 0..127     the next token + 1 literals                  (1..128 pixels)
 *     token 128..255   the next literal, token - 126 times          (2..129 pixels)
 *
 * A token never crosses the end of a line. A band's tokens and literals are two streams, but only the tokens need a
 * buffer: walking the tokens over the pixels gives the literals again, in the very place where they are. */
#ifndef EL_STREAM_RUNS_H
#define EL_STREAM_RUNS_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Bytes of tokens and literals of a line of `width` pixels, at most. A run of two costs what two literals cost and one
 * token more for the literals behind it, so runs never add to the bill; splitting 129 literals does. */
#define EL_RUNS_LINE_MAX_BYTES(width) (2 * (width) + ((width) + 127) / 128)

enum { EL_RUNS_TOO_LONG = -1 };

/* Pixels that a token covers, and how many of them are literals, in front. */
static inline uint32_t el_runs_pixels(uint8_t token)
{
    return token < 128 ? token + 1U : token - 126U;
}

static inline uint32_t el_runs_literals(uint8_t token)
{
    return token < 128 ? token + 1U : 1U;
}

/* Encodes one line of 1..2040 pixels. Writes its tokens and returns their number; `*literals` is what they use. Returns
 * EL_RUNS_TOO_LONG when tokens and literals together would take more than `budget_bytes`; then both are spoilt. Never
 * writes more than budget_bytes / 3 tokens, since each has a literal. */
int32_t el_runs_encode(const uint16_t *pixels, uint32_t width, size_t budget_bytes, uint8_t *tokens,
                       uint32_t *literals);

#ifdef __cplusplus
}
#endif

#endif
