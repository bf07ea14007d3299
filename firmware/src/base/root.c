#include "base/root.h"

#include "base/fixed.h"

/* 2^8 / sqrt(m) in the middle of each m = i / 32 to (i + 1) / 32, i from 32 to 127: 1 to 4, off by less than 2^-6 of it. */
/* clang-format off */
static const uint8_t first_guesses[96] = {
    254, 250, 247, 243, 240, 236, 233, 230, 228, 225, 222, 220, 217, 215, 212, 210,
    208, 206, 204, 202, 200, 198, 196, 194, 193, 191, 189, 188, 186, 185, 183, 182,
    180, 179, 178, 176, 175, 174, 172, 171, 170, 169, 168, 167, 166, 165, 163, 162,
    161, 160, 159, 158, 158, 157, 156, 155, 154, 153, 152, 151, 151, 150, 149, 148,
    147, 147, 146, 145, 144, 144, 143, 142, 142, 141, 140, 140, 139, 138, 138, 137,
    137, 136, 135, 135, 134, 134, 133, 132, 132, 131, 131, 130, 130, 129, 129, 128,
};
/* clang-format on */

/* m = x / 2^30, and g a guess of 1 / sqrt(m). */
uint32_t el_reciprocal_root(uint32_t x)
{
    /* A step of Newton's, g (3 - m g^2) / 2, makes 12 bits of 6. */
    const uint32_t guess_q8 = first_guesses[(x >> 25) - 32U];
    const uint32_t ratio_q30 = guess_q8 * guess_q8 * (x >> 16); /* m g^2: 1, or 2^-5 more or less */
    const uint32_t root_q16 = (guess_q8 * (((3U << 30) - ratio_q30) >> 8)) >> 15;
    /* 1 / sqrt(1 - e) = 1 + e / 2 + 3 e^2 / 8 + ..., e = 1 - m g^2 of the better g: below 18,000 in Q26. */
    const int32_t e_q30 = (1 << 30) - (int32_t)el_product_high_u32(x, root_q16 * root_q16);
    const int32_t e_q26 = (e_q30 + 8) >> 4;
    const int32_t more_q27 = e_q26 + ((3 * e_q26 * e_q26 + (1 << 27)) >> 28);
    return (root_q16 << 16) + (uint32_t)(((int32_t)root_q16 * more_q27) >> 11);
}
