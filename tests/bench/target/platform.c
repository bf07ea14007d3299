/* platform.h on a bare core in QEMU: start-up, text and exit by semihosting as the unit tests on target have them
 * (tests/target/semihost). Whatever goes wrong ends the program with status 99. */
#include "platform.h"

#include "semihost.h"

const unsigned bench_repeats = 1;

/* Empty, but never inlined, merged or left out. */
__attribute__((noinline)) void bench_next(void)
{
    __asm__ volatile("nop" ::: "memory");
}

__attribute__((noinline)) void bench_start(void)
{
    __asm__ volatile("nop" ::: "memory");
}

__attribute__((noinline)) void bench_stop(void)
{
    __asm__ volatile("nop" ::: "memory");
}

uint64_t bench_elapsed_ns(void)
{
    return 0;
}

void bench_print(const char *text)
{
    semihost_print(text);
}

void *bench_scratch(size_t size)
{
    (void)size;
    return NULL;
}

void bench_keep(const char *group, const char *name, const void *bytes, size_t size)
{
    (void)group;
    (void)name;
    (void)bytes;
    (void)size;
}

int main(void)
{
    semihost_exit(bench_main());
}
