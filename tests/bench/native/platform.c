/* platform.h on the computer that builds: monotonic nanoseconds, files. */
#include "platform.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

const unsigned bench_repeats = 25;

static const char *folder;
static uint64_t elapsed_ns;
static uint64_t started_ns;

static uint64_t now_ns(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000000000U + (uint64_t)now.tv_nsec;
}

void bench_next(void)
{
    elapsed_ns = 0;
}

void bench_start(void)
{
    started_ns = now_ns();
}

void bench_stop(void)
{
    elapsed_ns += now_ns() - started_ns;
}

uint64_t bench_elapsed_ns(void)
{
    return elapsed_ns;
}

void bench_print(const char *text)
{
    fputs(text, stdout);
}

void *bench_scratch(size_t size)
{
    static void *scratch;
    free(scratch);
    scratch = calloc(1, size);
    return scratch;
}

void bench_keep(const char *group, const char *name, const void *bytes, size_t size)
{
    char path[1024];
    if (folder == NULL) {
        return;
    }
    snprintf(path, sizeof path, "%s/%s.%s", folder, group, name);
    FILE *const file = fopen(path, "wb");
    if (file == NULL || fwrite(bytes, 1, size, file) != size || fclose(file) != 0) {
        fprintf(stderr, "bench: cannot write %s\n", path);
    }
}

int main(int argc, char **argv)
{
    folder = argc > 1 ? argv[1] : NULL;
    return bench_main();
}
