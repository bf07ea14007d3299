/* Pictures of hits as text, one digit per pixel and '.' for none, drawn between guards: a method that writes beside its
 * picture is found at once. */
#ifndef EL_TEST_METHODS_HITS_H
#define EL_TEST_METHODS_HITS_H

#include <stdio.h>
#include <string.h>

#include "methods/shapes.h"
#include "unity.h"

enum { HITS_ACROSS = 12, HITS_DOWN = 10, HITS_GUARD = 64 };

/* A place in half pixels: odd numbers are pixel centres. */
#define HALF(x, y)                                                                                                     \
    {                                                                                                                  \
        (x) * EL_SUBPIXELS / 2, (y)*EL_SUBPIXELS / 2                                                                   \
    }

typedef struct hits_picture {
    uint16_t before[HITS_GUARD];
    uint16_t counts[HITS_ACROSS * HITS_DOWN];
    uint16_t after[HITS_GUARD];
} hits_picture;

static inline el_hits hits_clear(hits_picture *p)
{
    memset(p, 0, sizeof *p);
    return (el_hits){HITS_ACROSS, HITS_DOWN, p->counts};
}

static inline void hits_to_text(const uint16_t *counts, char text[HITS_DOWN * (HITS_ACROSS + 1) + 1])
{
    for (size_t row = 0; row < HITS_DOWN; row++) {
        for (size_t column = 0; column < HITS_ACROSS; column++) {
            const uint16_t count = counts[row * HITS_ACROSS + column];
            *text++ = count == 0 ? '.' : (char)(count > 9 ? '#' : '0' + count);
        }
        *text++ = '\n';
    }
    *text = '\0';
}

/* `expected` holds the upper rows; those below are empty. */
static inline void expect_hits(const hits_picture *p, const char *name, size_t rows, const char *const *expected)
{
    char got[HITS_DOWN * (HITS_ACROSS + 1) + 1];
    char wanted[sizeof got] = "";
    hits_to_text(p->counts, got);
    for (size_t row = 0; row < HITS_DOWN; row++) {
        char line[HITS_ACROSS + 2];
        snprintf(line, sizeof line, "%s\n", row < rows ? expected[row] : "............");
        strcat(wanted, line);
    }
    TEST_ASSERT_EQUAL_STRING_MESSAGE(wanted, got, name);
    TEST_ASSERT_EACH_EQUAL_UINT16(0, p->before, HITS_GUARD);
    TEST_ASSERT_EACH_EQUAL_UINT16(0, p->after, HITS_GUARD);
}

#define EXPECT_HITS(picture, name, ...)                                                                                \
    expect_hits(picture, name, sizeof((const char *const[]){__VA_ARGS__}) / sizeof(char *),                            \
                (const char *const[]){__VA_ARGS__})

/* Says both pictures when they differ. */
static inline void expect_same_hits(const hits_picture *wanted, const hits_picture *got, const char *message)
{
    if (memcmp(wanted, got, sizeof *wanted) != 0) {
        char wanted_text[HITS_DOWN * (HITS_ACROSS + 1) + 1];
        char got_text[sizeof wanted_text];
        hits_to_text(wanted->counts, wanted_text);
        hits_to_text(got->counts, got_text);
        TEST_ASSERT_EQUAL_STRING_MESSAGE(wanted_text, got_text, message);
        TEST_FAIL_MESSAGE(message); /* the same text: beside the picture, or a count above 9 */
    }
}

#endif
