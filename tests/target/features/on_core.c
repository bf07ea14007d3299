/* Every feature with 1, 4 and 8 samples per pixel, as tests/golden/features.crc has them: one line per feature, its name and
 * its CRCs; those of samples that small code leaves out, or that are refused, are missing. */
#include <stdio.h>

#include "play.h"

static uint16_t pixels[FEATURE_PIXELS];
static uint16_t depth[FEATURE_PIXELS];

static int show(const feature *of)
{
    static _Alignas(8) uint8_t memory[EL_MIN_MEMORY_BYTES(FEATURE_WIDTH, FEATURE_HEIGHT, 8U) +
                                      EL_SAMPLES_BYTES(FEATURE_WIDTH, 8U, 8U) + FEATURE_MORE_BYTES];
    static const uint8_t samples[] = {0, 4, 8};
    (void)fputs(of->scene.name, stdout);
    for (unsigned i = 0; i < (EL_WITH_SAMPLES ? 3 : 1); i++) {
        const feature_way way = {.band_lines = 8, .samples = samples[i], .more_bytes = FEATURE_MORE_BYTES};
        uint32_t passes;
        if (!feature_takes(of, &way)) {
            continue;
        }
        if (feature_bytes(&way) > sizeof memory || feature_play(of, &way, memory, pixels, depth, &passes) != EL_OK) {
            return 1;
        }
        (void)printf(" %08lx", (unsigned long)feature_crc(pixels));
    }
    (void)puts("");
    return 0;
}

int main(void)
{
    for (unsigned i = 0; features[i] != NULL; i++) {
        if (show(features[i]) != 0) {
            return 1;
        }
    }
    return 0;
}
