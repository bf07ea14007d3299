/* What a measuring program needs of the machine it runs on: target/platform.c (QEMU, instructions) and
 * native/platform.c (this computer, nanoseconds) implement it.
 *
 * A measurement is bench_next, then any number of stretches between bench_start and bench_stop, which are added up: work
 * that is none of the measured business, such as checking a picture, stands outside. On the target the three are empty
 * functions whose arrival the QEMU plugin notes, so the counts never pass through the program. */
#ifndef EL_BENCH_PLATFORM_H
#define EL_BENCH_PLATFORM_H

#include <stddef.h>
#include <stdint.h>

void bench_next(void);
void bench_start(void);
void bench_stop(void);

/* How often a measurement is repeated; the least time counts. 1 where counts are exact. */
extern const unsigned bench_repeats;

/* Nanoseconds between start and stop since bench_next; 0 on the target. */
uint64_t bench_elapsed_ns(void);

/* To standard output. */
void bench_print(const char *text);
void bench_print_u64(uint64_t value);
void bench_print_hex(uint32_t value);

/* Keeps the bytes as a file GROUP.NAME in the folder that the program's first argument names; on the target, and without
 * that argument, nothing. */
void bench_keep(const char *group, const char *name, const void *bytes, size_t size);

/* Memory to record in, zeroed, until the next call; NULL on the target, where nothing can be kept. */
void *bench_scratch(size_t size);

/* The program. Returns its exit status, 0 or 1. */
int bench_main(void);

#endif
