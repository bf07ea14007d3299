/* Cores for a frame (frame/workers.h) made of threads. */
#ifndef EL_SIM_THREADS_H
#define EL_SIM_THREADS_H

#include <stdbool.h>

#include "frame/workers.h"

typedef struct el_threads el_threads;

/* Starts count - 1 threads beside the caller's, 1 <= count <= EL_MAX_WORKERS. NULL after one line on stderr. */
el_threads *el_threads_open(unsigned count);

/* Ends them. NULL is allowed. */
void el_threads_close(el_threads *threads);

/* For el_config.workers, until el_threads_close. */
const el_workers *el_threads_workers(el_threads *threads);

#endif
