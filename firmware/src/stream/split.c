/* The split-stream encoder: greedy, one pass over a line.
 *
 * Most of a picture's pixels are in long stretches; most of its tokens, where it is noisy, are deltas. So there are two
 * short ways: along a stretch by two pixels at a time, and from delta to delta (put_inner), where a pixel becomes part of a
 * stretch only together with the next one. What has no line above it or stands at the ends of a line takes the long way
 * (put_any), which looks at all that there is. Costs per pixel and the alternatives: DESIGN.md, "The codec". */
#include "stream/split.h"

#include <string.h>

/* The loops are compiled for each lag, and must not share their registers with what is called now and then. */
#define SPECIALISED inline __attribute__((always_inline))
#define APART __attribute__((noinline))

enum {
    PAIRS = 63,
    RECENT = 127,
    RUN = 175,
    ABOVE = 191,
    ABOVE_LEFT = 207,
    ABOVE_RIGHT = 223,
    MORE = 239,
    MORE_TO_END = 247,
    SKIP = 248,
    SKIP_TO_END = 249,
    LITERALS = 250,

    PAIR_CLASSES = 8,
    MOST_RECENT = RUN - RECENT,
    MOST_LITERALS = 256 - LITERALS, /* of a token */
    STRETCH = ABOVE - RUN,          /* pixels of the longest token of a kind, and the unit of those that go on */
    DITHER_LAG = 4,
    PROBES = 16 /* places of a line that are looked at to find its lag */
};

void el_split_init(el_split *split, uint8_t *buffer, uint16_t width)
{
    *split = (el_split){.tokens = buffer, .width = width};
    el_split_begin(split);
}

void el_split_begin(el_split *split)
{
    split->literals = (uint16_t *)(void *)(split->tokens + EL_SPLIT_BUFFER_BYTES(split->width));
    split->token_count = 0;
    split->literal_count = 0;
    split->lines = 0;
    split->lagging = false;
    split->joined = false;
    memset(split->lags, 0, sizeof split->lags);
}

/* --- Deltas ------------------------------------------------------------------------------------------------------- */

typedef struct delta {
    uint16_t difference;
    uint8_t token;
    uint8_t class; /* in a pair, from 1; 0: none */
} delta;

/* Each difference has its own place in the table: to a compiler, two in one are an error. */
#define PLACE(difference) ((uint8_t)((difference) + ((difference) >> 9)))

#define CLASS(dr, dg, db)                                                                                              \
    ((dr) == 0 && (dg) == 0 && (db) == 0      ? 1                                                                      \
     : (dr) == -1 && (dg) == -1 && (db) == 0  ? 2                                                                      \
     : (dr) == 0 && (dg) == -1 && (db) == 0   ? 3                                                                      \
     : (dr) == 0 && (dg) == 1 && (db) == 0    ? 4                                                                      \
     : (dr) == 1 && (dg) == 1 && (db) == 0    ? 5                                                                      \
     : (dr) == -1 && (dg) == -1 && (db) == -1 ? 6                                                                      \
     : (dr) == 1 && (dg) == 1 && (db) == 1    ? 7                                                                      \
     : (dr) == -1 && (dg) == 0 && (db) == 0   ? 8                                                                      \
                                              : 0)
#define DIFFERENCE(dr, dg, db) ((uint32_t)(2048 * (dr) + 32 * (dg) + (db)) & 0xFFFFU)
#define DELTA(dr, dg, db, q)                                                                                           \
    [PLACE(DIFFERENCE(dr, dg, db))] = {DIFFERENCE(dr, dg, db), ((dg) + 3) * 9 + ((dr) - (q) + 1) * 3 + (db) - (q) + 1, \
                                       CLASS(dr, dg, db)}
#define DELTAS_OF_RED(dr, dg, q) DELTA(dr, dg, (q)-1, q), DELTA(dr, dg, q, q), DELTA(dr, dg, (q) + 1, q)
#define DELTAS_OF_GREEN(dg, q) DELTAS_OF_RED((q)-1, dg, q), DELTAS_OF_RED(q, dg, q), DELTAS_OF_RED((q) + 1, dg, q)

/* What is empty has difference 0, whose place is another one. */
static const delta deltas[256] = {
    DELTAS_OF_GREEN(-3, -2), DELTAS_OF_GREEN(-2, -1), DELTAS_OF_GREEN(-1, -1), DELTAS_OF_GREEN(0, 0),
    DELTAS_OF_GREEN(1, 0),   DELTAS_OF_GREEN(2, 1),   DELTAS_OF_GREEN(3, 1),
};

/* The delta that makes `value` of `left`, or NULL. */
static inline const delta *find_delta(uint32_t value, uint32_t left)
{
    const uint32_t difference = (value - left) & 0xFFFFU;
    const delta *const found = &deltas[PLACE(difference)];
    return found->difference == difference ? found : NULL;
}

static inline bool are_pair(const delta *first, const delta *second)
{
    return first->class != 0 && second != NULL && second->class != 0;
}

static inline uint32_t pair_of(const delta *first, const delta *second)
{
    return PAIRS - (PAIR_CLASSES + 1U) + (uint32_t)PAIR_CLASSES * first->class + second->class;
}

/* --- Tokens ------------------------------------------------------------------------------------------------------- */

/* A line, and how far its tokens are. */
typedef struct line {
    el_split *split;
    const uint16_t *pixels;
    const uint16_t *above; /* or NULL */
    const uint16_t *head;  /* where those end that have no pixel `lag` to their left */
    const uint16_t *last;  /* its last pixel */
    const uint16_t *end;   /* of the pixels that are being told, half-open */
    uint32_t lag;
    const uint8_t *first; /* token */
    uint8_t *to;          /* where the next one goes */
} line;

static inline void put_token(line *l, uint32_t token)
{
    *l->to++ = (uint8_t)token;
}

/* 40503 is 2^16 over the golden ratio. These bits of the product, the top one a carry, spread colours best. */
static inline uint32_t slot_of(uint32_t value)
{
    return (value * 40503U >> 9) % EL_SPLIT_SLOTS;
}

/* A pixel that is none of the last literals; a[0] is above it, a[-1] and a[1] beside that. `a` is NULL where those have been
 * looked at. */
static APART uint8_t *put_new(const line *l, uint8_t *to, const uint16_t *a, uint32_t value)
{
    el_split *const split = l->split;
    uint32_t token = LITERALS;
    if (a != NULL && value == a[0]) {
        token = ABOVE;
    } else if (a != NULL && value == a[-1]) {
        token = ABOVE_LEFT;
    } else if (a != NULL && value == a[1]) {
        token = ABOVE_RIGHT;
    } else {
        *--split->literals = (uint16_t)value;
        split->seen[slot_of(value)] = (uint8_t)++split->literal_count;
        if (to != l->first && to[-1] >= LITERALS && to[-1] < LITERALS + MOST_LITERALS - 1) {
            to[-1]++;
            return to;
        }
    }
    *to = (uint8_t)token;
    return to + 1;
}

/* A pixel that is no delta. The number in a slot may be a former packet's, or older than 256 literals: the literal itself
 * decides. */
static APART uint8_t *put_single(const line *l, uint8_t *to, const uint16_t *a, uint32_t value)
{
    const el_split *const split = l->split;
    const uint32_t count = split->literal_count;
    const uint32_t ago = (count - split->seen[slot_of(value)]) % EL_SPLIT_SLOTS;
    if (ago < MOST_RECENT && ago < count && split->literals[ago] == value) {
        *to = (uint8_t)(RECENT + ago);
        return to + 1;
    }
    return put_new(l, to, a, value);
}

/* What is a stretch or a skip already goes on, for as many times STRETCH as there are in `pixels`. */
static void put_more(line *l, uint32_t pixels)
{
    enum { LONGEST = MORE_TO_END - MORE };
    uint32_t units = pixels / STRETCH;
    for (; units > LONGEST; units -= LONGEST) {
        put_token(l, MORE + LONGEST - 1);
    }
    if (units > 0) {
        put_token(l, MORE + units - 1);
    }
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

/* Where the pixels that equal `value` end. */
static const uint16_t *end_of_equal(const uint16_t *p, const uint16_t *end, uint32_t value)
{
    if (p < end && !is_aligned(p)) {
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

/* Where the pixels that equal those at `other` end. */
static const uint16_t *end_of_match(const uint16_t *p, const uint16_t *end, const uint16_t *other)
{
    if ((((uintptr_t)p ^ (uintptr_t)other) & 3U) == 0) {
        if (p < end && !is_aligned(p)) {
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

/* Where a run from p on ends; `inside` promises that p has a left neighbour. */
static SPECIALISED const uint16_t *end_of_run(const line *l, const uint16_t *p, bool inside)
{
    static const uint16_t black[DITHER_LAG];
    if (!inside && p < l->head) {
        const uint16_t *const stop = l->end < l->head ? l->end : l->head;
        p = end_of_match(p, stop, (l->above != NULL ? l->above : black) + (p - l->pixels));
        if (p < stop || p == l->end) {
            return p;
        }
    }
    if (*p != *(p - l->lag)) {
        return p;
    }
    return l->lag == 1 ? end_of_equal(p + 1, l->end, *p) : end_of_match(p + 1, l->end, p + 1 - l->lag);
}

/* The longest stretch so far. */
typedef struct stretch {
    const uint16_t *stop; /* where it ends */
    uint32_t kind;        /* its first token */
} stretch;

/* Looks for a longer one, from p to `end` at most, that equals the pixels at `other`. */
static SPECIALISED void consider(stretch *best, uint32_t kind, const uint16_t *p, const uint16_t *end,
                                 const uint16_t *other)
{
    if (best->stop < end && *best->stop == other[best->stop - p] && *p == *other) {
        const uint16_t *const stop = end_of_match(p + 1, end, other + 1);
        if (stop > best->stop) {
            *best = (stretch){stop, kind};
        }
    }
}

/* The longest stretch from p on; it ends at p if there is none. `a` is above p, or NULL; `inside` promises that both have
 * left neighbours. */
static SPECIALISED stretch find_stretch(const line *l, const uint16_t *p, const uint16_t *a, bool inside)
{
    const uint16_t *const end = l->end;
    stretch best = {p, ABOVE};
    if (a != NULL) {
        consider(&best, ABOVE, p, end, a);
    }
    if (best.stop < end) {
        const uint16_t *const stop = end_of_run(l, p, inside);
        if (stop > best.stop) {
            best = (stretch){stop, RUN};
        }
    }
    if (a != NULL && (inside || p > l->pixels)) {
        consider(&best, ABOVE_LEFT, p, end, a - 1);
    }
    if (a != NULL) {
        consider(&best, ABOVE_RIGHT, p, end < l->last ? end : l->last, a + 1);
    }
    return best;
}

static inline void put_stretch(line *l, const uint16_t *p, const stretch *best)
{
    const uint32_t count = (uint32_t)(best->stop - p);
    if (count <= STRETCH) {
        put_token(l, best->kind + count - 1);
    } else if (best->stop > l->last) {
        put_token(l, best->kind + STRETCH - 1);
        put_token(l, MORE_TO_END);
    } else {
        put_token(l, best->kind + (count - 1) % STRETCH);
        put_more(l, count - 1);
    }
}

/* --- Pixels ------------------------------------------------------------------------------------------------------- */

static inline uint32_t left_of(const line *l, const uint16_t *p)
{
    return p >= l->head ? *(p - l->lag) : l->above != NULL ? l->above[p - l->pixels] : 0U;
}

/* A pixel anywhere, and what goes with it; returns what comes next. */
static const uint16_t *put_any(line *l, const uint16_t *p)
{
    const delta *const found = find_delta(*p, left_of(l, p));
    const stretch best = find_stretch(l, p, l->above != NULL ? l->above + (p - l->pixels) : NULL, false);
    if (best.stop > p + (found != NULL)) {
        put_stretch(l, p, &best);
        return best.stop;
    }
    if (found == NULL) {
        l->to = put_single(l, l->to, NULL, *p);
        return p + 1;
    }
    const delta *const next = p + 1 < l->end ? find_delta(p[1], left_of(l, p + 1)) : NULL;
    const bool two = are_pair(found, next);
    put_token(l, two ? pair_of(found, next) : found->token);
    return p + 1 + two;
}

static APART const uint16_t *put_inner_stretch(line *l, const uint16_t *p, const uint16_t *a)
{
    const stretch best = find_stretch(l, p, a, true);
    put_stretch(l, p, &best);
    return best.stop;
}

/* From p on, which has `lag` pixels to its left and the line above; ends one or two pixels before l->end, or later.
 * Looking two pixels ahead keeps lone ones, of which noise is full, out of the search for stretches. */
static SPECIALISED const uint16_t *put_inner(line *l, const uint16_t *p, const uint32_t lag)
{
    const uint16_t *const stop = (l->end < l->last ? l->end : l->last) - 1 - lag;
    const uint16_t *a = l->above + (p - l->pixels) - 1; /* above left */
    uint8_t *to = l->to;
    p -= lag; /* Thumb's loads reach ahead only */
    while (p < stop) {
        const uint32_t value = p[lag];
        if ((value == p[0] && p[lag + 1] == p[1]) || (value == a[1] && p[lag + 1] == a[2]) ||
            (value == a[0] && p[lag + 1] == a[1]) || (value == a[2] && p[lag + 1] == a[3])) {
            l->to = to;
            const uint16_t *const next = put_inner_stretch(l, p + lag, a + 1) - lag;
            to = l->to;
            a += next - p;
            p = next;
            continue;
        }
        const delta *const found = find_delta(value, p[0]);
        if (found == NULL) {
            to = put_single(l, to, a + 1, value);
        } else {
            const delta *const next = found->class != 0 ? find_delta(p[lag + 1], p[1]) : NULL;
            if (are_pair(found, next)) {
                *to++ = (uint8_t)pair_of(found, next);
                p++;
                a++;
            } else {
                *to++ = found->token;
            }
        }
        p++;
        a++;
    }
    l->to = to;
    return l->pixels + (a + 1 - l->above); /* by a, so that p + lag needs no register */
}

/* From p to l->end. */
static APART void put_pixels(line *l, const uint16_t *p)
{
    if (l->above != NULL) {
        while (p < l->end && p < l->head) {
            p = put_any(l, p);
        }
        if (p + 1 < l->end && p < l->last) {
            p = l->lag == 1 ? put_inner(l, p, 1) : put_inner(l, p, DITHER_LAG);
        }
    }
    while (p < l->end) {
        p = put_any(l, p);
    }
}

/* --- Lines -------------------------------------------------------------------------------------------------------- */

/* A dithered line repeats itself after 4 pixels rather than after one. Some places of it tell, and lines before it, which
 * count half, a quarter, and so on. */
static bool is_dithered(el_split *split, const uint16_t *pixels)
{
    const uint32_t width = split->width;
    int32_t score = split->dithering / 2;
    for (uint32_t x = DITHER_LAG; x < width; x += width / PROBES + 1) {
        const uint16_t *const p = pixels + x - DITHER_LAG;
        score += (p[DITHER_LAG] == p[0]) - (p[DITHER_LAG] == p[DITHER_LAG - 1]);
    }
    split->dithering = (int8_t)score;
    return score > 0;
}

/* The first x of the next segment whose bit is not `bit`; or the line's end. */
static uint32_t end_of_segments(uint32_t changed, uint32_t x, uint32_t width)
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
    split->lines = (uint16_t)(split->lines + lines);
}

void el_split_add(el_split *split, const uint16_t *pixels, const uint16_t *above, uint32_t changed)
{
    const uint32_t width = split->width;
    const bool lagging = is_dithered(split, pixels);
    const uint32_t lag = lagging ? DITHER_LAG : 1;
    uint8_t *const first = split->tokens + split->token_count;
    line l = {.split = split,
              .pixels = pixels,
              .above = above,
              .head = pixels + (lag < width ? lag : width),
              .last = pixels + width - 1,
              .lag = lag,
              .first = first,
              .to = first};

    for (uint32_t x = 0, end; x < width; x = end) {
        end = end_of_segments(changed, x, width);
        if ((changed >> x / EL_SPLIT_SEGMENT_PIXELS & 1U) != 0) {
            l.end = pixels + end;
            put_pixels(&l, pixels + x);
        } else if (end == width) {
            put_token(&l, SKIP_TO_END);
        } else {
            put_token(&l, SKIP);
            put_more(&l, end - x - EL_SPLIT_SEGMENT_PIXELS);
        }
    }
    if (lagging) {
        split->lags[split->lines / 8] = (uint8_t)(split->lags[split->lines / 8] | 1U << split->lines % 8);
        split->lagging = true;
    }
    split->joined = split->joined || (split->lines == 0 && above != NULL);
    split->lines++;
    split->token_count = (uint32_t)(l.to - split->tokens);
}
