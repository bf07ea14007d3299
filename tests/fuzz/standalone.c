/* Runs a fuzz target without libFuzzer, wherever there is a C compiler: on files, and on seeded inputs made here.
 *
 *     fuzz_TARGET INPUTS [FILE...]
 *
 * Status 0 when nothing was found; a finding ends it as a crash. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

enum { MAX_BYTES = 2048 };

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count);

static uint8_t input[MAX_BYTES];

static int run_file(const char *path)
{
    FILE *const file = fopen(path, "rb");
    if (file == NULL) {
        fprintf(stderr, "%s: cannot be read\n", path);
        return 2;
    }
    const size_t count = fread(input, 1, sizeof input, file);
    fclose(file);
    return LLVMFuzzerTestOneInput(input, count);
}

int main(int argc, char **argv)
{
    const long inputs = argc > 1 ? strtol(argv[1], NULL, 10) : 0;
    uint32_t random = 1;
    int status = 0;
    for (int i = 2; i < argc && status == 0; i++) {
        status = run_file(argv[i]);
    }
    for (long i = 0; i < inputs && status == 0; i++) {
        random = random * 1664525U + 1013904223U;
        const size_t count = (random >> 16) % MAX_BYTES;
        for (size_t at = 0; at < count; at++) {
            random = random * 1664525U + 1013904223U;
            input[at] = (uint8_t)(random >> 24);
        }
        status = LLVMFuzzerTestOneInput(input, count);
    }
    return status;
}
