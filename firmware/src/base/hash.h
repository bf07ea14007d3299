/* A hash of 32-bit words that is cheap on cores without a long product: it tells that something changed, and is no
 * protection against anybody who means it to fail. */
#ifndef EL_BASE_HASH_H
#define EL_BASE_HASH_H

#include <stdint.h>

/* Takes one more word. A bijection of the word, and of the hash: of two sequences that differ in a single word the hashes
 * differ always; of any others they are equal with a probability of 2^-32.
 *
 * The product moves differences up only, the shift brings them down again. With a rotation in its place, or nothing, a
 * change of one bit is undone by that of one bit in the next word, whatever else they hold: in a line of RGB565 red going
 * from 0 to 16 in two neighbouring pixels would be such changes. */
static inline uint32_t el_hash_word(uint32_t hash, uint32_t word)
{
    uint32_t factor = 0x9E3779B1U; /* odd: its product is a bijection modulo 2^32 */
#ifdef __ARM_ARCH_6M__
    /* Not known to the compiler, or gcc takes 14 shifts and sums for what the core does in one cycle. */
    __asm__("" : "+r"(factor));
#endif
    hash = (hash ^ word) * factor;
    return hash ^ hash >> 15;
}

#endif
