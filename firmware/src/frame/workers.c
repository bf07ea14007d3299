/* The bands of a pass, drawn by several cores.
 *
 * Each core draws groups of EL_GROUP_BANDS neighbouring bands in turn, core 0 (the caller's) the first, core 1 the second
 * and so on, with its own buffers and its own memory for what it carries within a group. What a band needs is in the bins
 * of its group (raster/list.h), so cores wait for each other only where a buffer is not free. All sinks are called by the
 * caller's core, in the bands' order, whenever it has drawn a band of its own or has nothing to draw.
 *
 * The cores tell each other two counts, each with one writer: how many of a core's bands are complete, and how many of
 * those the sinks have got. The lowest band that is not complete can always be drawn: its buffer's last contents are
 * above it, so they are complete and can be handed over. So nobody waits for ever. */
#include "frame/workers.h"

#include "base/fixed.h"
#include "frame/bands.h"
#include "frame/debug_hooks.h"
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

/* The core that draws `band`. */
static unsigned owner_of(const el_renderer *renderer, uint16_t band)
{
    const unsigned group = band / EL_GROUP_BANDS - renderer->pass_begin / (unsigned)EL_GROUP_BANDS;
    return group % renderer->workers;
}

/* Whether the next band's buffer has been handed over, if it was drawn into in this pass, and the sinks have released it. */
static bool can_draw(const el_painter *painter)
{
    return load(&painter->handed) + 1U >= painter->drawn && el_band_is_free(&painter->bands[painter->current]);
}

static void draw_band(el_painter *painter, const el_renderer *renderer, uint16_t band)
{
    const bool goes_on = (band + 1) % EL_GROUP_BANDS != 0 && band + 1 < renderer->pass_end;
    el_painter_draw(painter, renderer, band, goes_on);
    el_debug_finish_band(renderer, painter);
    painter->current ^= 1U;
    painter->band_is_open = 0;
    store(&painter->drawn, (uint16_t)(painter->drawn + 1U));
}

static void draw_groups(void *argument, unsigned worker)
{
    el_renderer *const renderer = argument;
    const el_workers *const workers = renderer->config.workers;
    el_painter *const painter = el_renderer_painter(renderer, worker);
    for (uint16_t band = renderer->pass_begin; band < renderer->pass_end; band++) {
        if (owner_of(renderer, band) != worker) {
            continue;
        }
        while (!can_draw(painter)) {
            workers->pause(workers->context);
        }
        draw_band(painter, renderer, band);
    }
}

/* Hands over the bands from `band` on that are complete. Returns the first that is not. */
static uint16_t hand_over_complete(el_renderer *renderer, uint16_t band)
{
    while (band < renderer->pass_end) {
        el_painter *const painter = el_renderer_painter(renderer, owner_of(renderer, band));
        const uint16_t handed = painter->handed;
        if (handed == load(&painter->drawn)) {
            break;
        }
        (void)el_quiet_leaves_out(renderer, band, false); /* each is drawn */
        el_bands_hand_over(renderer, &painter->bands[(painter->first + handed) & 1U]);
        store(&painter->handed, (uint16_t)(handed + 1U));
        band++;
    }
    return band;
}

/* Nothing can be handed over or drawn: lets whoever is waited for go on. A sink sleeps until its interrupt comes only where
 * it has a band, so that one comes. */
static void wait_for_others(el_renderer *renderer)
{
    const el_workers *const workers = renderer->config.workers;
    for (unsigned i = 0; i < renderer->workers * 2U; i++) {
        const el_band *const band = &el_renderer_painter(renderer, i / 2)->bands[i % 2];
        el_bands_wait_for_sinks(renderer, band);
    }
    workers->pause(workers->context);
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
    el_painter *const painter = &renderer->painter;
    uint16_t next = renderer->pass_begin; /* the first band that the sinks have not got */
    begin(renderer);
    workers->start(workers->context, draw_groups, renderer);
    for (uint16_t band = renderer->pass_begin; band < renderer->pass_end; band++) {
        if (owner_of(renderer, band) != 0) {
            continue;
        }
        next = hand_over_complete(renderer, next);
        while (!can_draw(painter)) {
            wait_for_others(renderer);
            next = hand_over_complete(renderer, next);
        }
        draw_band(painter, renderer, band);
    }
    for (;;) {
        next = hand_over_complete(renderer, next);
        if (next == renderer->pass_end) {
            break;
        }
        wait_for_others(renderer);
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
}

#endif
