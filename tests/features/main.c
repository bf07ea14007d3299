/* Features on this computer, in any way, as checksums and as files.
 *
 *     features [--band N] [--samples 0|4|8] [--threads N] [--more BYTES] [--prepass] [--interlaced]
 *              [--raw FOLDER]
 *
 * One line per feature that the library has so: its name, the CRC-32 of its pixels and of its depth, and the passes that it
 * took. --more: bytes of the arena beyond the least; --raw: writes FOLDER/NAME.raw, little-endian RGB565.
 * Status 2 for a bad command line, 1 where drawing fails. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "files.h"
#include "play.h"
#include "threads.h"

enum { MAX_PATH = 1024 };

static bool write_raw(const char *folder, const char *name, const uint16_t *pixels)
{
    char path[MAX_PATH];
    el_output output = {0};
    if (snprintf(path, sizeof path, "%s/%s.raw", folder, name) >= MAX_PATH || !el_output_open(&output, path)) {
        return false;
    }
    el_output_pixels(&output, pixels, FEATURE_PIXELS);
    return el_output_commit(&output);
}

static bool parse(int argc, char **argv, feature_way *way, unsigned *threads, const char **raw)
{
    for (int i = 1; i < argc; i++) {
        const char *const name = argv[i];
        if (strcmp(name, "--prepass") == 0 || strcmp(name, "--interlaced") == 0) {
            *(strcmp(name, "--prepass") == 0 ? &way->depth_prepass : &way->interlaced) = true;
            continue;
        }
        if (i + 1 == argc) {
            return false;
        }
        const char *const value = argv[++i];
        const unsigned long number = strtoul(value, NULL, 10);
        if (strcmp(name, "--band") == 0) {
            way->band_lines = (uint16_t)number;
        } else if (strcmp(name, "--samples") == 0) {
            way->samples = (uint8_t)number;
        } else if (strcmp(name, "--threads") == 0) {
            *threads = (unsigned)number;
        } else if (strcmp(name, "--more") == 0) {
            way->more_bytes = (uint32_t)number;
        } else if (strcmp(name, "--raw") == 0) {
            *raw = value;
        } else {
            return false;
        }
    }
    return *threads >= 1 && *threads <= EL_MAX_WORKERS;
}

static bool show(const feature *of, const feature_way *way, void *memory, const char *raw)
{
    static uint16_t pixels[FEATURE_PIXELS];
    static uint16_t depth[FEATURE_PIXELS];
    uint32_t passes = 0;
    const el_status status = feature_play(of, way, memory, pixels, depth, &passes);
    if (status != EL_OK) {
        (void)fprintf(stderr, "%s: status %d\n", of->scene.name, (int)status);
        return false;
    }
    (void)printf("%s %08lx %08lx %lu\n", of->scene.name, (unsigned long)feature_crc(pixels),
                 (unsigned long)feature_crc(depth), (unsigned long)passes);
    return raw == NULL || write_raw(raw, of->scene.name, pixels);
}

int main(int argc, char **argv)
{
    feature_way way = {.band_lines = 8, .more_bytes = FEATURE_MORE_BYTES};
    unsigned count = 1;
    const char *raw = NULL;
    if (!parse(argc, argv, &way, &count, &raw)) {
        (void)fputs("features: bad arguments; the head of main.c has them\n", stderr);
        return 2;
    }
    el_threads *const threads = el_threads_open(count);
    way.workers = count > 1 && threads != NULL ? el_threads_workers(threads) : NULL;
    void *const memory = malloc(feature_bytes(&way));
    bool is_good = threads != NULL && memory != NULL;
    for (unsigned i = 0; features[i] != NULL && is_good; i++) {
        is_good = !feature_takes(features[i], &way) || show(features[i], &way, memory, raw);
    }
    free(memory);
    el_threads_close(threads);
    return is_good ? 0 : 1;
}
