/* Clocks for measurements, and the median that makes them repeatable. */
#ifndef EL_METHODS_CLOCK_H
#define EL_METHODS_CLOCK_H

#include <stdint.h>
#include <time.h>

enum { EL_TIMED_RUNS = 5 };

static inline uint64_t el_clock_ns(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (uint64_t)now.tv_sec * 1000000000U + (uint64_t)now.tv_nsec;
}

/* What this thread has worked: other programs do not count, but reading it takes most of a microsecond. For loops. */
static inline uint64_t el_work_ns(void)
{
    return el_clock_ns(CLOCK_THREAD_CPUTIME_ID);
}

/* Reading it takes some nanoseconds. For single shapes. */
static inline uint64_t el_time_ns(void)
{
    return el_clock_ns(CLOCK_MONOTONIC);
}

/* Sorts the runs. */
static inline uint64_t el_median(uint64_t runs[EL_TIMED_RUNS])
{
    for (unsigned i = 1; i < EL_TIMED_RUNS; i++) {
        for (unsigned k = i; k > 0 && runs[k] < runs[k - 1]; k--) {
            const uint64_t less = runs[k];
            runs[k] = runs[k - 1];
            runs[k - 1] = less;
        }
    }
    return runs[EL_TIMED_RUNS / 2];
}

#endif
