/* A pass, band by band: waiting for buffers, opening them, having them drawn (painter.c), handing them over. */
#include "frame/bands.h"

#include "base/fill.h"
#include "base/fixed.h"
#include "frame/debug_hooks.h"
#include "frame/painter_sampled.h"
#include "frame/quiet.h"
#include "raster/field.h"

/* What frame/workers.c calls too, if there are workers. */
#if EL_WITH_WORKERS
#define OF_WORKERS_TOO
#else
#define OF_WORKERS_TOO static
#endif

/* What a depth band is cleared to; before a pre-pass a unit less, which is added then (painter.c). */
enum { EMPTY = 0xFFFF, FARTHEST = EL_DEPTH_MAX };

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

#if EL_WITH_INTERLACED
/* Layers know of no gaps, and draw the same into bands of any height. */
static EL_SELDOM void draw_layer_by_lines(const el_band *band, const el_layer *layer)
{
    for (unsigned i = 0; i < band->lines; i++) {
        const uint32_t at = i * band->width;
        el_band line = {.pixels = band->pixels + at,
                        .depth = band->depth + at,
                        .width = band->width,
                        .y = (uint16_t)(band->y + i * (1U + el_band_gap(band))),
                        .lines = 1};
        layer->draw(layer->context, &line);
    }
}
#endif

static EL_APART_IF_SMALL void draw_layer(el_painter *painter, const el_layer *layer)
{
    if (layer == NULL) {
        return;
    }
    el_band *const band = &painter->bands[painter->current];
#if EL_WITH_INTERLACED
    if (band->gap != 0) {
        draw_layer_by_lines(band, layer);
        return;
    }
#endif
    layer->draw(layer->context, band);
}

#if EL_WITH_STRIPES
/* A layer draws pixels: what it drew into a cleared band, of which they take the first third, is cut into stripes then. */
static EL_SELDOM void draw_under_stripes(el_painter *painter, const el_config *config)
{
    el_band *const buffer = &painter->bands[painter->current];
    if (config->under != NULL) {
        buffer->width = (uint16_t)(config->width / EL_STRIPES_PER_PIXEL);
        draw_layer(painter, config->under);
        el_stripes_cut(buffer->pixels, (uint32_t)buffer->width * buffer->lines);
    }
    buffer->width = config->width;
}

static EL_SELDOM void make_pixels_of_stripes(el_painter *painter, const el_config *config)
{
    el_band *const buffer = &painter->bands[painter->current];
    buffer->width = (uint16_t)(config->width / EL_STRIPES_PER_PIXEL);
    el_stripes_filter(buffer->pixels, painter->depth[painter->current], buffer->width, buffer->lines,
                      config->stripes == EL_STRIPES_BGR);
}
#endif

/* Makes `band` of the screen the one that is drawn into; its buffer is free, or open. */
static el_target open_band(el_painter *painter, const el_renderer *renderer, uint16_t band)
{
    const el_config *const config = &renderer->config;
    el_band *const buffer = &painter->bands[painter->current];
    uint16_t *const depth = painter->depth[painter->current];
    const int32_t y = band * config->band_lines;
    const int32_t y_end = el_min_i32(y + config->band_lines, el_renderer_lines(renderer));
    const uint8_t field = el_list_field(&renderer->list);
    if (!painter->band_is_open) {
        buffer->y = (uint16_t)el_screen_row(field, y);
#if EL_WITH_INTERLACED
        buffer->gap = field != EL_FIELD_NONE;
#endif
        buffer->lines = (uint16_t)(y_end - y);
        const uint32_t pixels = (uint32_t)buffer->lines * config->width;
        el_fill_u16(buffer->pixels, el_debug_begin_band(renderer, painter), pixels);
        el_fill_u16(depth, EL_WITH_PREPASS && painter->first_depth ? FARTHEST : EMPTY, pixels);
#if EL_WITH_STRIPES
        if (config->stripes != EL_STRIPES_NONE) {
            draw_under_stripes(painter, config);
        } else
#endif
        {
            draw_layer(painter, config->under);
        }
        painter->band_is_open = 1;
    }
    return (el_target){
        .colour = buffer->pixels, .depth = depth, .width = config->width, .y = y, .y_end = y_end, .field = field};
}

OF_WORKERS_TOO void el_bands_draw(el_painter *painter, const el_renderer *renderer, uint16_t band, bool goes_on)
{
#if EL_WITH_PREPASS
    painter->first_depth = renderer->config.depth_prepass && !painter->band_is_open &&
                           renderer->config.view == EL_DEBUG_PICTURE && el_renderer_samples(renderer) == 1;
#endif
    const el_target target = open_band(painter, renderer, band);
    painter->goes_on = goes_on;
    el_painter_draw(painter, renderer, &target, el_list_take_bin(&renderer->list, band));
}

OF_WORKERS_TOO void el_bands_complete(el_painter *painter, const el_renderer *renderer)
{
#if EL_WITH_SAMPLES
    el_painter_resolve_samples(painter, renderer);
#endif
    el_debug_finish_band(renderer, painter);
#if EL_WITH_STRIPES
    if (renderer->config.stripes != EL_STRIPES_NONE) {
        make_pixels_of_stripes(painter, &renderer->config);
    }
#endif
    draw_layer(painter, renderer->config.over);
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
    el_painter *painter = &renderer->painter;
    EL_SETTLE(painter); /* its address is not made anew at each use */
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
        el_bands_draw(painter, renderer, band, band + 1 < renderer->pass_end);
        if (hand_over_bands) {
            el_bands_complete(painter, renderer);
            el_bands_hand_over(renderer, buffer);
            painter->current ^= 1U;
            painter->band_is_open = 0;
        }
    }
    el_bands_note_use(renderer, painter->carrying.used);
    el_list_clear(&renderer->list);
}

void el_bands_flush(el_renderer *renderer)
{
    el_count(&renderer->stats.flushes, 1);
    draw_pass(renderer, false);
}

void el_bands_finish(el_renderer *renderer)
{
#if EL_WITH_WORKERS
    /* An open band is the pass' only one, and in the caller's core's buffer. */
    if (renderer->workers > 1 && !renderer->painter.band_is_open) {
        el_workers_draw_pass(renderer);
        return;
    }
#endif
    draw_pass(renderer, true);
}
