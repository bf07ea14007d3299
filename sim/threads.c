/* A frame has dozens of jobs of some ten microseconds, less than a thread takes to wake up. So a thread that has nothing to
 * do looks for a job again and again, as a second core on a microcontroller does, and goes to sleep only where none has
 * come for about a millisecond: between frames. */
#include "threads.h"

#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdlib.h>

#include "report.h"

enum { LOOKS_BEFORE_SLEEP = 2000 };

typedef struct member {
    el_threads *threads;
    pthread_t thread;
    unsigned number; /* 1 to count - 1 */
} member;

struct el_threads {
    el_workers workers;
    member members[EL_MAX_WORKERS];
    unsigned running; /* members that have a thread */
    /* Written by the caller's thread before `jobs` grows. */
    el_job *job; /* NULL: end */
    void *argument;
    unsigned jobs;    /* started so far */
    unsigned taken;   /* numbers of the last one */
    unsigned at_work; /* threads that are not done with the last one */
    pthread_mutex_t mutex;
    pthread_cond_t more;
    unsigned asleep; /* threads that wait for `more`; under the mutex */
};

static unsigned load(const unsigned *value)
{
    return __atomic_load_n(value, __ATOMIC_ACQUIRE);
}

/* Waits for more jobs than `seen`. */
static void wait_for_job(el_threads *threads, unsigned seen)
{
    for (unsigned i = 0; i < LOOKS_BEFORE_SLEEP; i++) {
        if (load(&threads->jobs) != seen) {
            return;
        }
        (void)sched_yield();
    }
    (void)pthread_mutex_lock(&threads->mutex);
    threads->asleep++;
    while (load(&threads->jobs) == seen) {
        (void)pthread_cond_wait(&threads->more, &threads->mutex);
    }
    threads->asleep--;
    (void)pthread_mutex_unlock(&threads->mutex);
}

static void *run(void *context)
{
    const member *const self = context;
    el_threads *const threads = self->threads;
    for (unsigned seen = 0;; seen++) {
        wait_for_job(threads, seen);
        if (threads->job == NULL) {
            return NULL;
        }
        threads->job(threads->argument, self->number);
        (void)__atomic_sub_fetch(&threads->at_work, 1, __ATOMIC_RELEASE);
    }
}

static void start(void *context, el_job *job, void *argument)
{
    el_threads *const threads = context;
    threads->job = job;
    threads->argument = argument;
    threads->taken = 0;
    threads->at_work = threads->running;
    (void)pthread_mutex_lock(&threads->mutex);
    (void)__atomic_add_fetch(&threads->jobs, 1, __ATOMIC_RELEASE);
    if (threads->asleep > 0) {
        (void)pthread_cond_broadcast(&threads->more);
    }
    (void)pthread_mutex_unlock(&threads->mutex);
}

static unsigned take(void *context)
{
    el_threads *const threads = context;
    return __atomic_fetch_add(&threads->taken, 1, __ATOMIC_RELAXED);
}

static void wait_for_all(void *context)
{
    const el_threads *const threads = context;
    while (load(&threads->at_work) != 0) {
        (void)sched_yield();
    }
}

static void pause_thread(void *context)
{
    (void)context;
    (void)sched_yield();
}

el_threads *el_threads_open(unsigned count)
{
    el_threads *const threads = calloc(1, sizeof *threads);
    if (threads == NULL) {
        el_report("no memory for %u threads", count);
        return NULL;
    }
    threads->workers = (el_workers){
        .context = threads, .count = count, .start = start, .take = take, .wait = wait_for_all, .pause = pause_thread};
    (void)pthread_mutex_init(&threads->mutex, NULL);
    (void)pthread_cond_init(&threads->more, NULL);
    /* Signals are for the main thread. */
    sigset_t all, before;
    (void)sigfillset(&all);
    for (unsigned i = 1; i < count; i++) {
        member *const one = &threads->members[i];
        *one = (member){.threads = threads, .number = i};
        (void)pthread_sigmask(SIG_SETMASK, &all, &before);
        const int problem = pthread_create(&one->thread, NULL, run, one);
        (void)pthread_sigmask(SIG_SETMASK, &before, NULL);
        if (problem != 0) {
            el_report("cannot start thread %u of %u", i, count);
            el_threads_close(threads);
            return NULL;
        }
        threads->running++;
    }
    return threads;
}

void el_threads_close(el_threads *threads)
{
    if (threads == NULL) {
        return;
    }
    start(threads, NULL, NULL);
    for (unsigned i = 1; i <= threads->running; i++) {
        (void)pthread_join(threads->members[i].thread, NULL);
    }
    (void)pthread_cond_destroy(&threads->more);
    (void)pthread_mutex_destroy(&threads->mutex);
    free(threads);
}

const el_workers *el_threads_workers(el_threads *threads)
{
    return &threads->workers;
}
