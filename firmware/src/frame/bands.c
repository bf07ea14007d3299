/* A pass, band by band: waiting for buffers, having them drawn (painter.c), handing them over. */
#include "frame/bands.h"

#include "frame/quiet.h"

/* What frame/workers.c calls too, if there are workers. */
#if EL_WITH_WORKERS
#define OF_WORKERS_TOO
#else
#define OF_WORKERS_TOO static
#endif

OF_WORKERS_TOO void el_bands_wait_for_sinks(const el_renderer *renderer, const el_band *band)
{
    for (unsigned i = 0; i < EL_MAX_SINKS && !el_band_is_free(band); i++) {
        const el_sink *const sink = renderer->config.sinks[i];
        if (sink != NULL && sink->wait != NULL) {
            sink->wait(sink->context);
        }
    }
}

OF_WORKERS_TOO EL_APART_IF_SMALL void el_bands_hand_over(el_renderer *renderer, el_band *band)
{
    for (unsigned i = 0; i < EL_MAX_SINKS; i++) {
        band->held[i] = el_quiet_taker(renderer, i) != NULL;
    }
    for (unsigned i = 0; i < EL_MAX_SINKS; i++) {
        const el_sink *const sink = el_quiet_taker(renderer, i);
        if (sink != NULL) {
            sink->rows(sink->context, band, i);
        }
    }
    el_count(&renderer->stats.bands, 1);
}

void el_bands_note_use(el_renderer *renderer, uint32_t bytes)
{
    const uint32_t use = renderer->fixed_bytes + bytes;
    if (EL_WITH_STATS && use > renderer->stats.memory_peak) {
        renderer->stats.memory_peak = use;
    }
}

static void draw_pass(el_renderer *renderer, bool hand_over_bands)
{
    el_painter *const painter = &renderer->painter;
    el_painter_begin(painter, &renderer->list, renderer->list.used, renderer->list.end, &renderer->stats);
    for (uint16_t band = renderer->pass_begin; band < renderer->pass_end; band++) {
        el_band *const buffer = &painter->bands[painter->current];
        const bool is_empty = !painter->band_is_open && painter->carrying.first == 0 && renderer->list.bins[band] == 0;
        if (hand_over_bands && el_quiet_leaves_out(renderer, band, is_empty)) {
            continue;
        }
        while (!painter->band_is_open && !el_band_is_free(buffer)) {
            el_bands_wait_for_sinks(renderer, buffer);
        }
        el_painter_draw(painter, renderer, band, band + 1 < renderer->pass_end);
        if (hand_over_bands) {
            el_painter_finish(painter, renderer);
            el_bands_hand_over(renderer, buffer);
            painter->current ^= 1U;
            painter->band_is_open = 0;
        }
    }
    el_bands_note_use(renderer, painter->carrying.used);
}

void el_bands_flush(el_renderer *renderer)
{
    el_count(&renderer->stats.flushes, 1);
    draw_pass(renderer, false);
    el_list_clear(&renderer->list);
}

void el_bands_finish(el_renderer *renderer)
{
#if EL_WITH_WORKERS
    /* An open band is the pass' only one, and in the caller's core's buffer. */
    if (renderer->workers > 1 && !renderer->painter.band_is_open) {
        el_workers_draw_pass(renderer);
    } else {
        draw_pass(renderer, true);
    }
#else
    draw_pass(renderer, true);
#endif
    el_list_clear(&renderer->list);
}
