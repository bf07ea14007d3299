/* The split-stream encoder: greedy, one pass over a line, the cheapest test first. */
#include "stream/split.h"

#include <string.h>

enum {
    PAIRS = 63, /* the end of the deltas, too */
    RECENT = 127,
    RUN = 175,
    ABOVE = 196,
    ABOVE_LEFT = 217,
    ABOVE_RIGHT = 230,
    SKIP = 243,
    SKIP_TO_END = 247,
    LITERALS = 248,

    GREEN_REACH = 3, /* of dg */
    PAIR_CLASSES = 8,
    LONGEST_LITERALS = 8,
    MOST_RECENT = RUN - RECENT,
    RUN_LENGTHS = 20, /* and the line's width */
    SLANT_LENGTHS = 13,
    EVERY_LENGTH_TO = 8, /* that is no longer has a token of its own, of every kind */
    GOOD_LENGTH = 16,    /* a stretch of this length is taken without a look for a longer one */
    DITHER_LAG = 4,
    PROBES = 16 /* places of a line that are looked at to find its lag */
};

static const uint8_t run_lengths[RUN_LENGTHS] = {1,  2,  3,  4,  5,  6,  7,  8,  9,  10,
                                                 12, 14, 16, 20, 24, 32, 48, 64, 96, 128};
static const uint8_t slant_lengths[SLANT_LENGTHS] = {1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 24, 32, 64};

/* Token of a delta of these; q is floor(dg / 2). */
#define DELTA(dr, dg, db, q) (((dg) + GREEN_REACH) * 9 + ((dr) - (q) + 1) * 3 + ((db) - (q) + 1))

/* The class of a delta that can be half of a pair, and 1; 0 for all other tokens. */
static const uint8_t pair_classes[256] = {
    [DELTA(0, 0, 0, 0)] = 1, [DELTA(-1, -1, 0, -1)] = 2,  [DELTA(0, -1, 0, -1)] = 3, [DELTA(0, 1, 0, 0)] = 4,
    [DELTA(1, 1, 0, 0)] = 5, [DELTA(-1, -1, -1, -1)] = 6, [DELTA(1, 1, 1, 0)] = 7,   [DELTA(-1, 0, 0, 0)] = 8,
};

void el_split_init(el_split *split, uint8_t *buffer, uint16_t width)
{
    *split = (el_split){.tokens = buffer, .width = width};
    el_split_begin(split);
}

void el_split_begin(el_split *split)
{
    split->literals = split->tokens + EL_SPLIT_BUFFER_BYTES(split->width);
    split->token_count = 0;
    split->literal_count = 0;
    split->lines = 0;
    split->lagging = false;
    split->joined = false;
    memset(split->lags, 0, sizeof split->lags);
    memset(split->seen, 0, sizeof split->seen);
}

/* --- Tokens ------------------------------------------------------------------------------------------------------- */

/* The functions that put tokens get the place of the next one and return the place of the one after. Where the last token
 * may still be changed they get the place of the line's first one, too: it has none before it. */

static inline uint8_t *put_token(uint8_t *to, uint32_t token)
{
    *to = (uint8_t)token;
    return to + 1;
}

/* A run or a copy, of the kind whose tokens begin with `kind`. */
static uint8_t *put_lengths(uint8_t *to, uint32_t kind, uint32_t count, uint32_t width)
{
    if (count <= EVERY_LENGTH_TO && count != width) {
        return put_token(to, kind + count - 1);
    }
    if (count == width) {
        return put_token(to, kind + RUN_LENGTHS); /* nothing slanted is as long */
    }
    const bool slanted = kind >= ABOVE_LEFT;
    const uint8_t *const lengths = slanted ? slant_lengths : run_lengths;
    for (uint32_t i = slanted ? SLANT_LENGTHS : RUN_LENGTHS; i-- >= EVERY_LENGTH_TO;) {
        for (; count >= lengths[i]; count -= lengths[i]) {
            to = put_token(to, kind + i);
        }
    }
    return count > 0 ? put_token(to, kind + count - 1) : to;
}

/* The token that makes `value` of `left`; PAIRS if there is none. */
static inline uint32_t find_delta(uint32_t value, uint32_t left)
{
    const uint32_t difference = value - left;
    /* db, -3..3, does not reach dg's bits when 4 is added. */
    const uint32_t green = ((difference + 32 * GREEN_REACH + 4) >> 5) & 63U; /* dg + GREEN_REACH */
    const uint32_t q = ((green + 1) >> 1) - 2;                               /* floor((green - 3) / 2) */
    const uint32_t rest = (difference - 32 * (green - GREEN_REACH) - 2049 * (q - 1)) & 0xFFFFU;
    const uint32_t red = rest >> 11;
    const uint32_t blue = rest & 2047U;
    return green <= 2 * GREEN_REACH && red <= 2 && blue <= 2 ? green * 9 + red * 3 + blue : (uint32_t)PAIRS;
}
_Static_assert(GREEN_REACH == 3, "q is computed for it");

static inline uint8_t *put_delta(uint8_t *to, const uint8_t *first, uint32_t token)
{
    const uint32_t class = pair_classes[token];
    const uint32_t last = class != 0 && to != first ? pair_classes[to[-1]] : 0;
    if (last != 0) {
        to[-1] = (uint8_t)(PAIRS + PAIR_CLASSES * (last - 1) + class - 1);
        return to;
    }
    return put_token(to, token);
}

/* Neighbouring colours get slots of their own; 40503 is 2^16 over the golden ratio. */
static inline uint32_t slot_of(uint32_t value)
{
    return (value * 40503U >> 9) % EL_SPLIT_SLOTS;
}

static uint8_t *put_literal(el_split *split, uint8_t *to, const uint8_t *first, uint16_t value)
{
    uint16_t *const slot = &split->seen[slot_of(value)];
    const uint32_t ago = split->literal_count - *slot;
    if (*slot != 0 && ago < MOST_RECENT) {
        const uint8_t *const known = split->literals + 2 * ago;
        if ((known[0] | known[1] << 8) == value) {
            return put_token(to, RECENT + ago);
        }
    }
    split->literals -= 2;
    split->literals[0] = (uint8_t)value;
    split->literals[1] = (uint8_t)(value >> 8);
    *slot = (uint16_t)++split->literal_count;
    if (to != first && to[-1] >= LITERALS && to[-1] < LITERALS + LONGEST_LITERALS - 1) {
        to[-1]++;
        return to;
    }
    return put_token(to, LITERALS);
}

/* --- Stretches ---------------------------------------------------------------------------------------------------- */

/* Two pixels at a 4-aligned place. No memcpy: to a freestanding compiler that is a function to be called. */
typedef uint32_t __attribute__((may_alias)) two_pixels;

static inline uint32_t load_two(const uint16_t *at)
{
    return *(const two_pixels *)(const void *)at;
}

static inline bool is_aligned(const uint16_t *at)
{
    return ((uintptr_t)at & 3U) == 0;
}

/* Where the pixels that equal `value` end; p < end. */
static const uint16_t *end_of_run(const uint16_t *p, const uint16_t *end, uint32_t value)
{
    if (!is_aligned(p)) {
        if (*p != value) {
            return p;
        }
        p++;
    }
    const uint16_t *const last = end - 1;
    for (const uint32_t two = value << 16 | value; p < last && load_two(p) == two;) {
        p += 2;
    }
    return p < end && *p == value ? p + 1 : p;
}

/* Where the pixels that equal those at `other` end; p < end. */
static const uint16_t *end_of_match(const uint16_t *p, const uint16_t *end, const uint16_t *other)
{
    if ((((uintptr_t)p ^ (uintptr_t)other) & 3U) == 0) {
        if (!is_aligned(p)) {
            if (*p != *other) {
                return p;
            }
            p++;
            other++;
        }
        const uint16_t *const last = end - 1;
        while (p < last && load_two(p) == load_two(other)) {
            p += 2;
            other += 2;
        }
    }
    while (p < end && *p == *other) {
        p++;
        other++;
    }
    return p;
}

/* The longest of several stretches, and the first token of its kind. */
typedef struct choice {
    uint32_t count;
    uint32_t kind;
} choice;

static inline void consider(choice *best, uint32_t kind, uint32_t count)
{
    if (count > best->count) {
        *best = (choice){count, kind};
    }
}

static inline uint32_t pixels_between(const uint16_t *begin, const uint16_t *end)
{
    return (uint32_t)(end - begin);
}

/* What one line and its tokens are made of. */
typedef struct line {
    el_split *split;
    const uint16_t *pixels;
    const uint16_t *above; /* or NULL */
    const uint8_t *first;  /* token */
} line;

/* Pixels from p on that equal those at `other`, the first of which does. Most stretches are short. */
static inline uint32_t matching(const uint16_t *p, const uint16_t *end, const uint16_t *other)
{
    return p + 1 == end || p[1] != other[1] ? 1 : pixels_between(p, end_of_match(p + 1, end, other + 1));
}

/* Looks for something longer in the line above, for pixels p .. end-1, p[0] being below a[0]; `inside`: not at x = 0. */
static inline void consider_above(choice *best, const line *from, const uint16_t *p, const uint16_t *end,
                                  const uint16_t *a, bool inside)
{
    const uint16_t *const last = from->pixels + from->split->width - 1;
    const uint16_t value = *p;
    if (value == a[0]) {
        consider(best, ABOVE, matching(p, end, a));
    }
    if (inside && value == a[-1] && best->count < GOOD_LENGTH) {
        consider(best, ABOVE_LEFT, matching(p, end, a - 1));
    }
    if (p < last && value == a[1] && best->count < GOOD_LENGTH) {
        consider(best, ABOVE_RIGHT, matching(p, end < last ? end : last, a + 1));
    }
}

/* Says the stretch; or the pixel alone, where deltas, which may share a token, are no worse. `*said` counts pixels. */
static inline uint8_t *put_choice(const line *from, uint8_t *to, const choice *best, uint16_t value, uint16_t left,
                                  uint32_t *said)
{
    *said = 1;
    if (best->count <= 1 || (best->count == 2 && to != from->first && pair_classes[to[-1]] != 0)) {
        const uint32_t token = find_delta(value, left);
        if (token < PAIRS && (best->count == 0 || pair_classes[token] != 0)) {
            return put_delta(to, from->first, token);
        }
    }
    if (best->count == 0) {
        return put_literal(from->split, to, from->first, value);
    }
    *said = best->count;
    return put_lengths(to, best->kind, best->count, from->split->width);
}

/* The pixels that have none `lag` to their left, and what their last token takes along. `*x` is where it stopped. */
static uint8_t *put_head(const line *from, uint8_t *to, uint32_t end, uint32_t lag, uint32_t *x)
{
    static const uint16_t black[DITHER_LAG];
    const uint16_t *const pixels = from->pixels;
    const uint16_t *const left = from->above != NULL ? from->above : black;
    for (uint32_t said = 0; *x < lag && *x < end; *x += said) {
        const uint16_t *const p = pixels + *x;
        const uint16_t *const head = pixels + (end < lag ? end : lag);
        const uint16_t *stop = end_of_match(p, head, left + *x);
        if (stop == head && lag < end) {
            stop = lag == 1 ? end_of_run(head, pixels + end, *p) : end_of_match(head, pixels + end, pixels);
        }
        choice best = {pixels_between(p, stop), RUN};
        if (best.count < GOOD_LENGTH && from->above != NULL) {
            consider_above(&best, from, p, pixels + end, from->above + *x, *x > 0);
        }
        to = put_choice(from, to, &best, *p, left[*x], &said);
    }
    return to;
}

/* Pixels from p on where the first equals its left neighbour or one of three above; `a` is what is above p, or NULL. */
static inline uint8_t *put_match(const line *from, uint8_t *to, const uint16_t *p, const uint16_t *end,
                                 const uint16_t *a, uint32_t lag, uint32_t *said)
{
    const uint16_t value = *p;
    const uint16_t left = *(p - lag);
    choice best = {0, RUN};
    if (value == left) {
        const bool alone = p + 1 == end || p[1] != *(p + 1 - lag);
        const uint16_t *const stop = alone      ? p + 1
                                     : lag == 1 ? end_of_run(p + 1, end, value)
                                                : end_of_match(p + 1, end, p + 1 - lag);
        best.count = pixels_between(p, stop);
    }
    if (best.count < GOOD_LENGTH && a != NULL) {
        consider_above(&best, from, p, end, a, true);
    }
    return put_choice(from, to, &best, value, left, said);
}

/* Pixels x .. end-1, x >= lag. In a picture without structure nothing matches: that path is the short one. */
static inline uint8_t *put_rest(const line *from, uint8_t *to, uint32_t x, uint32_t end_x, uint32_t lag)
{
    const uint16_t *p = from->pixels + x;
    const uint16_t *a = from->above != NULL ? from->above + x : NULL;
    const uint16_t *const end = from->pixels + end_x;
    const uint16_t *const last = from->pixels + from->split->width - 1;
    while (p < end) {
        const uint16_t value = *p;
        const uint16_t left = *(p - lag);
        uint32_t said = 1;
        if (value == left || (a != NULL && (value == a[0] || value == a[-1] || (p < last && value == a[1])))) {
            to = put_match(from, to, p, end, a, lag, &said);
        } else {
            const uint32_t token = find_delta(value, left);
            to = token < PAIRS ? put_delta(to, from->first, token) : put_literal(from->split, to, from->first, value);
        }
        p += said;
        a = a != NULL ? a + said : NULL;
    }
    return to;
}

/* --- Lines -------------------------------------------------------------------------------------------------------- */

/* A dithered line repeats itself after 4 pixels rather than after one; some places of it tell. */
static bool is_dithered(const uint16_t *pixels, uint32_t width)
{
    uint32_t near = 0;
    uint32_t far = 0;
    for (uint32_t x = DITHER_LAG; x < width; x += width / PROBES + 1) {
        near += pixels[x] == pixels[x - 1];
        far += pixels[x] == pixels[x - DITHER_LAG];
    }
    return far > near;
}

static uint8_t *put_stretch(const line *from, uint8_t *to, uint32_t x, uint32_t end, bool lagging)
{
    if (x == 0) {
        to = put_head(from, to, end, lagging ? DITHER_LAG : 1, &x);
    }
    return lagging ? put_rest(from, to, x, end, DITHER_LAG) : put_rest(from, to, x, end, 1);
}

static uint8_t *put_skip(uint8_t *to, uint32_t pixels)
{
    enum { LONGEST = SKIP_TO_END - SKIP };
    uint32_t segments = pixels / EL_SPLIT_SEGMENT_PIXELS;
    for (; segments > LONGEST; segments -= LONGEST) {
        to = put_token(to, SKIP + LONGEST - 1);
    }
    return put_token(to, SKIP + segments - 1);
}

/* The first x of the next segment whose bit is not `bit`; or the line's end. */
static uint32_t end_of_stretch(uint32_t changed, uint32_t x, uint32_t width)
{
    const uint32_t bit = changed >> x / EL_SPLIT_SEGMENT_PIXELS & 1U;
    while (x < width && (changed >> x / EL_SPLIT_SEGMENT_PIXELS & 1U) == bit) {
        x += EL_SPLIT_SEGMENT_PIXELS;
    }
    return x < width ? x : width;
}

void el_split_add_gap(el_split *split, uint32_t lines)
{
    memset(split->tokens + split->token_count, SKIP_TO_END, lines);
    split->token_count += lines;
    split->lines += lines;
}

void el_split_add(el_split *split, const uint16_t *pixels, const uint16_t *above, uint32_t changed)
{
    const uint32_t width = split->width;
    const bool lagging = is_dithered(pixels, width);
    uint8_t *to = split->tokens + split->token_count;
    const line from = {.split = split, .pixels = pixels, .above = above, .first = to};

    for (uint32_t x = 0, end; x < width; x = end) {
        end = end_of_stretch(changed, x, width);
        if ((changed >> x / EL_SPLIT_SEGMENT_PIXELS & 1U) != 0) {
            to = put_stretch(&from, to, x, end, lagging);
        } else if (end == width) {
            to = put_token(to, SKIP_TO_END);
        } else {
            to = put_skip(to, end - x);
        }
    }
    if (lagging) {
        split->lags[split->lines / 8] = (uint8_t)(split->lags[split->lines / 8] | 1U << split->lines % 8);
        split->lagging = true;
    }
    split->joined = split->joined || (split->lines == 0 && above != NULL);
    split->lines++;
    split->token_count = (uint32_t)(to - split->tokens);
}
