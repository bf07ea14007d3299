/* Filling a line's worth of memory with one value, many words at a time: what a whole frame costs at least. */
#ifndef EL_BASE_FILL_H
#define EL_BASE_FILL_H

#include <stdint.h>

#include "base/options.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Values that one turn of the loop sets, with as many instructions as memory may take. */
#if EL_SMALL_CODE
enum { EL_FILL_STEP = 16 };
#else
enum { EL_FILL_STEP = 64 };
#endif

/* Words that lie over the half words of a picture. */
typedef uint32_t __attribute__((may_alias)) el_word;

/* Sets `count` values at `at`, 4-byte aligned. */
static inline void el_fill_u16(uint16_t *at, uint16_t value, uint32_t count)
{
    el_word *word = (el_word *)(void *)at;
    const uint32_t pair = (uint32_t)value << 16 | value;
#if defined(__arm__) && defined(__thumb2__)
    /* Eight words per instruction: compilers do not find it. */
    register uint32_t a __asm__("r3") = pair;
    register uint32_t b __asm__("r4") = pair;
    register uint32_t c __asm__("r5") = pair;
    register uint32_t d __asm__("r6") = pair;
    register uint32_t e __asm__("r8") = pair;
    register uint32_t f __asm__("r9") = pair;
    register uint32_t g __asm__("r10") = pair;
    register uint32_t h __asm__("r12") = pair;
    for (uint32_t left = count / EL_FILL_STEP; left > 0; left--) {
        __asm__ volatile(".rept %c9\n"
                         "stmia %0!, {r3, r4, r5, r6, r8, r9, r10, r12}\n"
                         ".endr\n"
                         : "+r"(word)
                         : "r"(a), "r"(b), "r"(c), "r"(d), "r"(e), "r"(f), "r"(g), "r"(h), "i"(EL_FILL_STEP / 16)
                         : "memory");
    }
#elif defined(__arm__) && defined(__thumb__)
    /* Four, where instructions know eight registers. */
    register uint32_t a __asm__("r3") = pair;
    register uint32_t b __asm__("r4") = pair;
    register uint32_t c __asm__("r5") = pair;
    register uint32_t d __asm__("r6") = pair;
    for (uint32_t left = count / EL_FILL_STEP; left > 0; left--) {
        __asm__ volatile(".rept %c5\n"
                         "stmia %0!, {r3, r4, r5, r6}\n"
                         ".endr\n"
                         : "+l"(word)
                         : "r"(a), "r"(b), "r"(c), "r"(d), "i"(EL_FILL_STEP / 8)
                         : "memory");
    }
#else
    for (uint32_t left = count / EL_FILL_STEP; left > 0; left--) {
        for (unsigned i = 0; i < EL_FILL_STEP / 2; i++) {
            *word++ = pair;
        }
    }
#endif
    for (uint32_t left = count % EL_FILL_STEP / 2; left > 0; left--) {
        *word++ = pair;
    }
    if ((count & 1U) != 0) {
        at[count - 1U] = value;
    }
}

#ifdef __cplusplus
}
#endif

#endif
