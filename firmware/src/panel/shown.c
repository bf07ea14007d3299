/* The hash is the cost of all this, so it takes two pixels at a step. */
#include "panel/shown.h"

#include <string.h>

#include "base/fill.h"
#include "base/hash.h"
#include "base/options.h"

/* A whole segment at a multiple of 4 bytes: nearly all that is hashed. */
static uint32_t hash_segment(const uint16_t *pixels)
{
    const el_word *word = (const el_word *)(const void *)pixels;
    const el_word *const end = word + EL_SHOWN_SEGMENT / 2;
    uint32_t hash = 0;
    for (; word < end; word += 8) {
        hash = el_hash_word(hash, word[0]);
        hash = el_hash_word(hash, word[1]);
        hash = el_hash_word(hash, word[2]);
        hash = el_hash_word(hash, word[3]);
        hash = el_hash_word(hash, word[4]);
        hash = el_hash_word(hash, word[5]);
        hash = el_hash_word(hash, word[6]);
        hash = el_hash_word(hash, word[7]);
    }
    return hash;
}
_Static_assert(EL_SHOWN_SEGMENT % 16 == 0, "words of a segment in eights");

/* The end of a line, and lines of odd width, which lie at odd places by turns. */
static uint32_t hash_pixels(const uint16_t *pixels, unsigned count)
{
    uint32_t hash = 0;
    for (unsigned i = 0; i < count; i++) {
        hash = el_hash_word(hash, pixels[i]);
    }
    return hash;
}

static unsigned lesser(unsigned a, unsigned b)
{
    return a < b ? a : b;
}

static unsigned greater(unsigned a, unsigned b)
{
    return a > b ? a : b;
}

static void add(el_shown_part *part, unsigned left, unsigned right, unsigned top, unsigned bottom)
{
    if (el_shown_is_empty(part)) {
        *part = (el_shown_part){(uint16_t)left, (uint16_t)right, (uint16_t)top, (uint16_t)bottom};
        return;
    }
    part->left = (uint16_t)lesser(part->left, left);
    part->right = (uint16_t)greater(part->right, right);
    part->top = (uint16_t)lesser(part->top, top);
    part->bottom = (uint16_t)greater(part->bottom, bottom);
}

el_shown_part el_shown_update(uint32_t *hashes, const uint16_t *pixels, unsigned width, unsigned lines)
{
    const bool by_words = !EL_SMALL_CODE && (width & 1U) == 0 && ((uintptr_t)pixels & 3U) == 0;
    el_shown_part part = {0};
    for (unsigned line = 0; line < lines; line++, pixels += width) {
        unsigned left = width;
        unsigned right = 0;
        for (unsigned x = 0; x < width; x += EL_SHOWN_SEGMENT, hashes++) {
            const unsigned count = lesser(width - x, EL_SHOWN_SEGMENT);
            const uint32_t hash =
                by_words && count == EL_SHOWN_SEGMENT ? hash_segment(pixels + x) : hash_pixels(pixels + x, count);
            if (*hashes != hash) {
                *hashes = hash;
                left = lesser(left, x);
                right = x + count;
            }
        }
        if (right > 0) {
            add(&part, left, right, line, line + 1U);
        }
    }
    return part;
}

void el_shown_add_lines(el_shown_part *part, unsigned width, unsigned top, unsigned bottom)
{
    add(part, 0, width, top, bottom);
}

uint16_t *el_shown_pack(uint16_t *pixels, unsigned width, const el_shown_part *part)
{
    const size_t count = (size_t)part->right - part->left;
    uint16_t *const first = pixels + (size_t)part->top * width + part->left;
    if (count < width) {
        /* Each line moves towards the first, over lines that have moved already. */
        for (unsigned line = 1; line < (unsigned)part->bottom - part->top; line++) {
            memmove(first + line * count, first + (size_t)line * width, count * sizeof pixels[0]);
        }
    }
    return first;
}
