/* Numbers as text, without a printf that would not fit small cores. */
#include "platform.h"

void bench_print_u64(uint64_t value)
{
    char text[21];
    char *at = text + sizeof text - 1;
    *at = '\0';
    do {
        *--at = (char)('0' + value % 10);
        value /= 10;
    } while (value != 0);
    bench_print(at);
}

void bench_print_hex(uint32_t value)
{
    char text[9];
    for (unsigned i = 0; i < 8; i++) {
        text[i] = "0123456789abcdef"[(value >> (28 - 4 * i)) & 15U];
    }
    text[8] = '\0';
    bench_print(text);
}
