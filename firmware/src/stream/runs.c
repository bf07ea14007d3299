/* The run-length encoder: greedy, which here is also the shortest but for the split of long stretches. */
#include "stream/runs.h"

enum { LONGEST_STRETCH = 128, LONGEST_RUN = 129 };

/* Equal pixels in front of pixels[x], that one included; LONGEST_RUN at most. */
static uint32_t run_length(const uint16_t *pixels, uint32_t x, uint32_t width)
{
    uint32_t limit = width - x < LONGEST_RUN ? width - x : LONGEST_RUN;
    uint32_t length = 1;

    while (length < limit && pixels[x + length] == pixels[x]) {
        length++;
    }
    return length;
}

/* Pixels from x on that begin no run; LONGEST_STRETCH at most. pixels[x] begins none. */
static uint32_t stretch_length(const uint16_t *pixels, uint32_t x, uint32_t width)
{
    uint32_t limit = width - x < LONGEST_STRETCH ? width - x : LONGEST_STRETCH;
    uint32_t length = 1;

    while (length < limit && (x + length + 1 == width || pixels[x + length] != pixels[x + length + 1])) {
        length++;
    }
    return length;
}

int32_t el_runs_encode(const uint16_t *pixels, uint32_t width, size_t budget_bytes, uint8_t *tokens, uint32_t *literals)
{
    int32_t count = 0;
    uint32_t x = 0;
    size_t left = budget_bytes;

    *literals = 0;
    while (x < width) {
        uint32_t length = run_length(pixels, x, width);
        uint8_t token = (uint8_t)(length + 126);
        if (length == 1) {
            token = (uint8_t)(stretch_length(pixels, x, width) - 1);
        }
        size_t cost = 1 + 2 * (size_t)el_runs_literals(token);
        if (cost > left) {
            return EL_RUNS_TOO_LONG;
        }
        left -= cost;
        tokens[count++] = token;
        *literals += el_runs_literals(token);
        x += el_runs_pixels(token);
    }
    return count;
}
