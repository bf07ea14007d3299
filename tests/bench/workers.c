/* A frame drawn by one core and by several, which are threads here: measurements one right after the other, so that what
 * else the computer does meets all. On this computer only.
 *
 *     SCENE LINES WORKERS crc CRC of-one NANOSECONDS ns NANOSECONDS gain-q10 RATIO path NANOSECONDS path-gain-q10 RATIO
 *
 * `ns` is what the clock on the wall shows; where other programs have the processors, threads do not run at the same time,
 * and that says nothing. So there is the frame's longest path as well: the processor time of the caller's thread, where for
 * the time of each job that of the thread with the most work stands. Waits for buffers are not in it, a start of a job and
 * the threads' fight for caches are. LINES is the bands' height. As with a DMA, what a sink does is not in any of them.
 *
 * All are medians over the rounds; a ratio is that of a round, of one core's time by the workers', times 1024. */
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/crc32.h"
#include "platform.h"
#include "scene.h"
#include "threads.h"

enum { WIDTH = 320, HEIGHT = 240, ARENA = 224 * 1024, ROUNDS = 101, NAP_NS = 20000 };

static _Alignas(8) uint8_t arena[ARENA];
static uint16_t picture[WIDTH * HEIGHT];
static bool takes_picture;

static void sink_begin(void *context, uint16_t width, uint16_t height)
{
    (void)context;
    (void)width;
    (void)height;
}

static void sink_rows(void *context, el_band *band, unsigned slot)
{
    (void)context;
    if (takes_picture) {
        memcpy(picture + (size_t)band->y * WIDTH, band->pixels, (size_t)band->lines * WIDTH * sizeof picture[0]);
    }
    el_band_release(band, slot);
}

static void sink_end(void *context, const el_stats *stats)
{
    (void)context;
    (void)stats;
}

static const el_sink sink = {.begin = sink_begin, .rows = sink_rows, .end = sink_end};

static uint64_t draw_ns(const el_scene *scene, uint16_t lines, const el_workers *workers)
{
    const el_config config = {
        .width = WIDTH,
        .height = HEIGHT,
        .band_lines = lines,
        .background = scene->background,
        .memory = arena,
        .memory_bytes = sizeof arena,
        .sinks = {&sink},
        .workers = workers,
    };
    el_renderer renderer;
    bench_next();
    if (el_init(&renderer, &config) != EL_OK) {
        return 0;
    }
    bench_start();
    const el_status status = el_scene_play(scene, 0, &renderer);
    bench_stop();
    return status == EL_OK ? bench_elapsed_ns() : 0;
}

/* --- The longest path --------------------------------------------------------------------------------------------- */

static uint64_t thread_ns(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (uint64_t)now.tv_sec * 1000000000U + (uint64_t)now.tv_nsec;
}

/* el_workers that look at the clock of each thread, around others. */
static struct {
    const el_workers *inner;
    el_job *job;
    void *argument;
    uint64_t busy_ns[EL_MAX_WORKERS]; /* with the job under way */
    uint64_t started_ns;              /* the caller's clock when it began its part */
    uint64_t saved_ns;                /* by what the path is shorter than the caller's time */
} timed;

/* What the thread's naps took since its part of the job began. */
static _Thread_local uint64_t napped_ns;
static _Thread_local unsigned next_number; /* for timed_take */

static void timed_job(void *argument, unsigned worker)
{
    (void)argument;
    napped_ns = 0;
    next_number = worker;
    const uint64_t before = thread_ns();
    timed.job(timed.argument, worker);
    timed.busy_ns[worker] = thread_ns() - before - napped_ns;
}

static void timed_start(void *context, el_job *job, void *argument)
{
    (void)context;
    timed.job = job;
    timed.argument = argument;
    timed.inner->start(timed.inner->context, timed_job, NULL);
    napped_ns = 0;
    next_number = 0;
    timed.started_ns = thread_ns();
}

/* Numbers in turn: whose thread happens to run would take them all. A core of its own may do better. */
static unsigned timed_take(void *context)
{
    (void)context;
    const unsigned number = next_number;
    next_number += timed.inner->count;
    return number;
}

static void timed_wait(void *context)
{
    (void)context;
    timed.busy_ns[0] = thread_ns() - timed.started_ns - napped_ns;
    timed.inner->wait(timed.inner->context);
    uint64_t longest = 0;
    for (unsigned i = 0; i < timed.inner->count; i++) {
        longest = timed.busy_ns[i] > longest ? timed.busy_ns[i] : longest;
    }
    timed.saved_ns += thread_ns() - timed.started_ns - longest;
}

/* A nap instead of looking again at once, which would be taken for work. */
static void timed_pause(void *context)
{
    (void)context;
    const uint64_t before = thread_ns();
    (void)nanosleep(&(struct timespec){.tv_nsec = NAP_NS}, NULL);
    napped_ns += thread_ns() - before;
}

static uint64_t draw_path_ns(const el_scene *scene, uint16_t lines, const el_workers *inner)
{
    const el_workers workers = {
        .count = inner->count, .start = timed_start, .take = timed_take, .wait = timed_wait, .pause = timed_pause};
    timed.inner = inner;
    timed.saved_ns = 0;
    const uint64_t before = thread_ns();
    const bool good = draw_ns(scene, lines, &workers) != 0;
    return good ? thread_ns() - before - timed.saved_ns : 0;
}

/* --- Rounds ------------------------------------------------------------------------------------------------------- */

static int compare(const void *a, const void *b)
{
    const uint64_t first = *(const uint64_t *)a;
    const uint64_t second = *(const uint64_t *)b;
    return (first > second) - (first < second);
}

static uint64_t median(uint64_t values[ROUNDS])
{
    qsort(values, ROUNDS, sizeof values[0], compare);
    return values[ROUNDS / 2];
}

static void print_item(const char *name, uint64_t value)
{
    bench_print(name);
    bench_print_u64(value);
}

/* Of the frame; 0 when it could not be drawn. */
static uint32_t crc_of(const el_scene *scene, uint16_t lines, const el_workers *workers)
{
    takes_picture = true;
    const bool good = draw_ns(scene, lines, workers) != 0;
    takes_picture = false;
    return good ? el_crc32(0, picture, sizeof picture) : 0;
}

/* Returns 0, or 1 when a frame could not be drawn or was another one. */
static int measure(const el_scene *scene, uint16_t lines, const el_workers *workers)
{
    static uint64_t one[ROUNDS];
    static uint64_t many[ROUNDS];
    static uint64_t path[ROUNDS];
    static uint64_t gain_q10[ROUNDS];
    static uint64_t path_gain_q10[ROUNDS];
    const uint32_t crc = crc_of(scene, lines, NULL);
    if (crc == 0 || crc_of(scene, lines, workers) != crc) {
        bench_print(scene->name);
        bench_print(" is not drawn, or not the same by several cores\n");
        return 1;
    }
    for (unsigned i = 0; i < ROUNDS; i++) {
        const uint64_t before = thread_ns();
        one[i] = draw_ns(scene, lines, NULL);
        const uint64_t one_path = thread_ns() - before;
        many[i] = draw_ns(scene, lines, workers);
        path[i] = draw_path_ns(scene, lines, workers);
        gain_q10[i] = (one[i] << 10) / many[i];
        path_gain_q10[i] = (one_path << 10) / path[i];
    }
    bench_print(scene->name);
    print_item(" ", lines);
    print_item(" ", workers->count);
    bench_print(" crc ");
    bench_print_hex(crc);
    print_item(" of-one ", median(one));
    print_item(" ns ", median(many));
    print_item(" gain-q10 ", median(gain_q10));
    print_item(" path ", median(path));
    print_item(" path-gain-q10 ", median(path_gain_q10));
    bench_print("\n");
    return 0;
}

int bench_main(void)
{
    static const char *const names[] = {"S1", "S2", "S2-no-depth", "S3", "S4", "teapot", "room", "field"};
    el_threads *const threads = el_threads_open(2);
    int failed = threads == NULL;
    for (size_t i = 0; i < sizeof names / sizeof names[0] && !failed; i++) {
        failed = measure(el_scene_find(names[i]), 8, el_threads_workers(threads)) ||
                 measure(el_scene_find(names[i]), 16, el_threads_workers(threads));
    }
    el_threads_close(threads);
    return failed;
}
