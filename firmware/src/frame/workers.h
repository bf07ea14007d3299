/* More than one core for a frame.
 *
 * A board with another core implements el_workers and names it in el_config.workers. Then vertices are transformed and
 * bands are drawn by all cores at the same time, with the same pixels; everything else, and every call of a sink, stays on
 * the core that calls el_draw and el_frame_next. The simulator has an implementation with threads (sim/threads.h). A job
 * takes up to 2,048 bytes of its core's stack, el_draw on the caller's up to 2,560. */
#ifndef EL_FRAME_WORKERS_H
#define EL_FRAME_WORKERS_H

#ifdef __cplusplus
extern "C" {
#endif

enum { EL_MAX_WORKERS = 8 };

/* What one worker does; it has number `worker` of el_workers.count. */
typedef void el_job(void *argument, unsigned worker);

typedef struct el_workers {
    void *context;
    unsigned count; /* cores, the caller's own included: 1..EL_MAX_WORKERS */
    /* Has each other core call job(argument, worker), with worker from 1 to count - 1, and returns at once: the caller does
     * the part of worker 0 itself. They see what was written before. Not called again before `wait`. */
    void (*start)(void *context, el_job *job, void *argument);
    /* In a job: 0, 1, 2 and so on since `start`, each number once, whichever core asks. */
    unsigned (*take)(void *context);
    /* Returns when all jobs have. The caller sees what they wrote. */
    void (*wait)(void *context);
    /* Called again and again, on any core, while it waits for something that another one does: sleep until an event, let
     * somebody else run, or nothing. */
    void (*pause)(void *context);
} el_workers;

#ifdef __cplusplus
}
#endif

#endif
