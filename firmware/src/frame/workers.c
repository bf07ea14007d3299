/* The bands of a pass, drawn by several cores.
 *
 * A core that has nothing to draw takes the next group of EL_GROUP_BANDS neighbouring bands, with its own buffers and its
 * own memory for what it carries within a group. What a band needs is in the bins of its group (raster/list.h), so cores
 * wait for each other only where a buffer is not free. All sinks are called by the caller's core, in the bands' order,
 * whenever it has drawn a band of its own or has nothing to draw.
 *
 * The cores tell each other two counts, each with one writer: how many of a core's bands are complete, and how many of
 * those the sinks have got. The lowest band that is not complete can always be drawn: its buffer's last contents are
 * above it, so they are complete and can be handed over. So nobody waits for ever. */
#include "frame/workers.h"

#include "base/fixed.h"
#include "frame/bands.h"
#include "frame/quiet.h"

#if EL_WITH_WORKERS

static uint16_t load(const uint16_t *count)
{
    return __atomic_load_n(count, __ATOMIC_ACQUIRE);
}

static void store(uint16_t *count, uint16_t value)
{
    __atomic_store_n(count, value, __ATOMIC_RELEASE);
}

/* Whether the next band's buffer has been handed over, if it was drawn into in this pass, and the sinks have released it. */
static bool can_draw(const el_painter *painter)
{
    return load(&painter->handed) + 1U >= painter->drawn && el_band_is_free(&painter->bands[painter->current]);
}

static void draw_band(el_painter *painter, const el_renderer *renderer, uint16_t band, bool goes_on)
{
    el_bands_draw(painter, renderer, band, goes_on);
    el_bands_complete(painter, renderer);
    painter->current ^= 1U;
    painter->band_is_open = 0;
    store(&painter->drawn, (uint16_t)(painter->drawn + 1U));
}

typedef struct pass_job {
    el_renderer *renderer;
    uint16_t next; /* the first band that the sinks have not got; the caller's core's */
} pass_job;

/* Hands over the bands from job->next on that are complete. */
static void hand_over_complete(pass_job *job)
{
    el_renderer *const renderer = job->renderer;
    for (unsigned i = 0; i < renderer->workers && job->next < renderer->pass_end;) {
        el_painter *const painter = el_renderer_painter(renderer, i);
        el_band *const band = &painter->bands[(painter->first + painter->handed) & 1U];
        if (painter->handed == load(&painter->drawn) || band->y != job->next * renderer->config.band_lines) {
            i++;
            continue;
        }
        (void)el_quiet_leaves_out(renderer, job->next, false); /* each is drawn */
        el_bands_hand_over(renderer, band);
        store(&painter->handed, (uint16_t)(painter->handed + 1U));
        job->next++;
        i = 0;
    }
}

/* Nothing can be handed over or drawn: lets whoever is waited for go on. A sink sleeps until its interrupt comes only where
 * it has a band, so that one comes. */
static void wait_for_others(pass_job *job)
{
    el_renderer *const renderer = job->renderer;
    for (unsigned i = 0; i < renderer->workers * 2U; i++) {
        el_bands_wait_for_sinks(renderer, &el_renderer_painter(renderer, i / 2)->bands[i % 2]);
    }
    renderer->config.workers->pause(renderer->config.workers->context);
    hand_over_complete(job);
}

static void draw_groups(void *argument, unsigned worker)
{
    pass_job *const job = argument;
    el_renderer *const renderer = job->renderer;
    const el_workers *const workers = renderer->config.workers;
    el_painter *const painter = el_renderer_painter(renderer, worker);
    for (;;) {
        const uint32_t group = renderer->pass_begin / (uint32_t)EL_GROUP_BANDS + workers->take(workers->context);
        const int32_t begin = el_max_i32((int32_t)group * EL_GROUP_BANDS, renderer->pass_begin);
        const int32_t end = el_min_i32((int32_t)(group + 1U) * EL_GROUP_BANDS, renderer->pass_end);
        if (begin >= renderer->pass_end) {
            break;
        }
        for (int32_t band = begin; band < end; band++) {
            while (!can_draw(painter)) {
                if (worker == 0) {
                    wait_for_others(job);
                } else {
                    workers->pause(workers->context);
                }
            }
            draw_band(painter, renderer, (uint16_t)band, band + 1 < end);
            if (worker == 0) {
                hand_over_complete(job);
            }
        }
    }
}

static void add_stats(el_stats *sum, const el_stats *part)
{
    el_count(&sum->vertices, part->vertices);
    el_count(&sum->setups, part->setups);
    el_count(&sum->rows, part->rows);
    el_count(&sum->spans, part->spans);
    el_count(&sum->pixels, part->pixels);
    el_count(&sum->triangles_hidden, part->triangles_hidden);
    el_count(&sum->pixels_prepass, part->pixels_prepass);
}

/* What the list has left of its memory, in a part for each core. */
static void begin(el_renderer *renderer)
{
    const el_list *const list = &renderer->list;
    const uint32_t part = (list->end - list->used) / renderer->workers / EL_LIST_UNIT * EL_LIST_UNIT;
    for (unsigned i = 0; i < renderer->workers; i++) {
        el_painter *const painter = el_renderer_painter(renderer, i);
        const uint32_t begin = list->used + i * part;
        el_stats *stats = &renderer->stats;
        if (i > 0) {
            stats = &renderer->others[i - 1].stats;
            *stats = (el_stats){0};
        }
        el_painter_begin(painter, list, begin, begin + part, stats);
        painter->first = painter->current;
        painter->drawn = 0;
        painter->handed = 0;
    }
}

void el_workers_draw_pass(el_renderer *renderer)
{
    const el_workers *const workers = renderer->config.workers;
    pass_job job = {.renderer = renderer, .next = renderer->pass_begin};
    begin(renderer);
    workers->start(workers->context, draw_groups, &job);
    draw_groups(&job, 0);
    while (job.next < renderer->pass_end) {
        wait_for_others(&job);
    }
    workers->wait(workers->context);

    uint32_t used = renderer->list.used;
    for (unsigned i = 0; i < renderer->workers; i++) {
        const el_carrying *const carrying = &el_renderer_painter(renderer, i)->carrying;
        used += carrying->used - carrying->begin;
        if (i > 0) {
            add_stats(&renderer->stats, &renderer->others[i - 1].stats);
        }
    }
    el_bands_note_use(renderer, used);
    el_list_clear(&renderer->list);
}

#endif
