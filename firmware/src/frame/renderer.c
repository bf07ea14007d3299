/* Frames: what el_init takes, how it divides the memory, and when a pass ends and another begins. */
#include "frame/renderer.h"

#include <string.h>

#include "base/fixed.h"
#include "frame/bands.h"
#include "frame/debug_hooks.h"
#include "frame/quiet.h"
#include "raster/samples.h"

_Static_assert(sizeof(el_record) <= EL_TRIANGLE_BYTES, "the size that EL_MEMORY_BYTES counts with");
_Static_assert(sizeof(el_record_perspective) <= EL_TEXTURED_TRIANGLE_BYTES,
               "the size that EL_MEMORY_BYTES counts with");
_Static_assert(sizeof(el_screen_vertex) == EL_VERTEX_BYTES, "the size that EL_MEMORY_BYTES counts with");
_Static_assert(sizeof(el_worker) <= EL_PAINTER_BYTES, "the size that EL_WORKERS_BYTES counts with");
_Static_assert(sizeof(el_run) + EL_DRAW_STATE_BYTES <= EL_RUN_BYTES, "the size that EL_MEMORY_BYTES counts with");

#if EL_WITH_SAMPLES
static bool samples_are_valid(const el_config *config)
{
    return config->samples <= 1 || ((config->samples == 4 || config->samples == EL_MAX_SAMPLES) &&
                                    !config->depth_prepass && config->view == EL_DEBUG_PICTURE);
}
#endif

static inline uint16_t bands_of(uint32_t lines, uint32_t band_lines)
{
    return (uint16_t)((lines + band_lines - 1U) / band_lines);
}

#if EL_WITH_INTERLACED
static el_status check_interlacing(const el_config *config)
{
    if (config->height == 1 || el_config_samples(config) > 1 || el_config_has_stripes(config) || config->reuse != 0 ||
        config->depth_prepass || config->view != EL_DEBUG_PICTURE || config->shading_off != 0 ||
        (config->workers != NULL && config->workers->count > 1)) {
        return EL_ERROR_SIZE;
    }
    for (unsigned i = 0; i < EL_MAX_SINKS; i++) {
        if (config->sinks[i] != NULL && !config->sinks[i]->takes_gaps) {
            return EL_ERROR_ARGUMENT;
        }
    }
    return EL_OK;
}

/* The other half of the lines than in the frame before; the even ones first. */
static void begin_field(el_renderer *renderer)
{
    const uint8_t field = renderer->list.field == EL_FIELD_EVEN ? EL_FIELD_ODD : EL_FIELD_EVEN;
    renderer->list.field = field;
    renderer->band_count = bands_of((uint32_t)el_renderer_lines(renderer), renderer->config.band_lines);
}
#endif

/* What sinks see. */
static uint16_t width_shown(const el_renderer *renderer)
{
    const uint16_t width = renderer->config.width;
    return el_config_has_stripes(&renderer->config) ? (uint16_t)(width / EL_STRIPES_PER_PIXEL) : width;
}

/* Pixels of a line as it is drawn: a stripe each where there are stripes. */
static uint32_t width_drawn(const el_config *config)
{
    return el_config_has_stripes(config) ? EL_STRIPED_WIDTH((uint32_t)config->width) : config->width;
}

static uint32_t workers_of(const el_config *config)
{
    return EL_WITH_WORKERS && config->workers != NULL ? config->workers->count : 1U;
}

static bool sizes_are_valid(const el_config *config)
{
    if (config->width < 1 || config->width > EL_MAX_WIDTH || config->height < 1 || config->height > EL_MAX_HEIGHT ||
        config->band_lines < 1 || config->band_lines > config->height || config->uv_error_log2 > 5 ||
        config->view >= EL_DEBUG_VIEWS || (config->shading_off & ~EL_DEBUG_SHADINGS) != 0 ||
        (config->reuse & ~EL_REUSES) != 0 || (config->depth_prepass && !EL_WITH_PREPASS)) {
        return false;
    }
#if EL_WITH_SAMPLES
    if (!samples_are_valid(config)) {
        return false;
    }
#endif
#if EL_WITH_STRIPES
    if (config->stripes >= EL_STRIPES_COUNT || (config->stripes != EL_STRIPES_NONE && config->width > EL_MAX_STRIPED)) {
        return false;
    }
#endif
    return config->workers == NULL ||
           (config->workers->count >= 1 && config->workers->count <= (EL_WITH_WORKERS ? EL_MAX_WORKERS : 1));
}

static uint32_t least_bytes(const el_config *config, uint32_t width, uint32_t workers)
{
    const uint32_t lines = config->band_lines;
    return EL_MIN_MEMORY_BYTES(width, config->height, lines) + EL_WORKERS_BYTES(width, config->height, lines, workers) +
           workers * EL_SAMPLES_BYTES(width, lines, el_config_samples(config));
}

/* Two colour bands of each core, bins, the other cores' painters and bins, all cores' samples, the list, depth bands: the
 * vertices of a draw lie at the end of the list's memory and reach over the depth bands while no band is open. Names of records
 * do not reach beyond EL_LIST_MAX_BYTES; what is more stays unused. */
static void divide_memory(el_renderer *renderer, const el_config *config, uint32_t width, uint32_t workers)
{
    const uint32_t lines = config->band_lines;
    const uintptr_t at = (uintptr_t)config->memory;
    const uint32_t skipped = (uint32_t)(((at + 7U) & ~(uintptr_t)7U) - at);
    uint8_t *const memory = (uint8_t *)config->memory + skipped;
    const uint32_t bytes = ((uint32_t)config->memory_bytes - skipped) / 8 * 8;
    const uint32_t colour_bytes = EL_COLOUR_BAND_BYTES(width, lines);
    const uint32_t one_depth = EL_DEPTH_BAND_BYTES(width, lines);
    const uint32_t sample_bytes = EL_SAMPLES_BYTES(width, lines, el_config_samples(config));
    const uint32_t bin_bytes = EL_BIN_BYTES(config->height, lines);
    const uint32_t bins_at = 2 * workers * colour_bytes;
    const uint32_t others_at = bins_at + bin_bytes;
    const uint32_t part_bins_at = others_at + (workers - 1U) * EL_PAINTER_BYTES;
    const uint32_t samples_at = part_bins_at + (workers - 1U) * bin_bytes;
    const uint32_t list_at = samples_at + workers * sample_bytes;
    renderer->depth_bytes = workers > 1 ? 2 * workers * one_depth : one_depth;
    const uint32_t left = bytes - list_at - renderer->depth_bytes;
    renderer->list_bytes = left < EL_LIST_MAX_BYTES ? left : EL_LIST_MAX_BYTES;
    renderer->fixed_bytes = list_at + renderer->depth_bytes;
    uint8_t *const depth = memory + list_at + renderer->list_bytes;
    if (EL_WITH_WORKERS && workers > 1) {
        renderer->others = (el_worker *)(void *)(memory + others_at);
        renderer->part_bins = (uint16_t *)(void *)(memory + part_bins_at);
        renderer->bin_stride = bin_bytes / (uint32_t)sizeof renderer->part_bins[0];
        memset(renderer->others, 0, (workers - 1U) * sizeof renderer->others[0]);
    }
    for (unsigned i = 0; i < 2 * workers; i++) {
        el_painter *const painter = el_renderer_painter(renderer, i / 2);
        el_band *const band = &painter->bands[i % 2];
        band->width = renderer->config.width;
        band->pixels = (uint16_t *)(void *)(memory + i * colour_bytes);
        painter->depth[i % 2] = (uint16_t *)(void *)(workers > 1 ? depth + i * one_depth : depth);
        band->depth = painter->depth[i % 2];
    }
#if EL_WITH_SAMPLES
    for (unsigned i = 0; i < workers && sample_bytes > 0; i++) {
        el_painter *const painter = el_renderer_painter(renderer, i);
        painter->samples = (uint32_t *)(void *)(memory + samples_at + i * sample_bytes);
        memset(painter->samples, 0, 4U * EL_MIXED_WORDS(width) * lines);
    }
#endif
    el_list_init(&renderer->list, memory + list_at, renderer->list_bytes, (uint16_t *)(void *)(memory + bins_at),
                 renderer->band_count, config->band_lines);
}

el_status el_init(el_renderer *renderer, const el_config *config)
{
    if (renderer == NULL || config == NULL || config->memory == NULL) {
        return EL_ERROR_ARGUMENT;
    }
    if (!sizes_are_valid(config)) {
        return EL_ERROR_SIZE;
    }
#if EL_WITH_INTERLACED
    if (config->interlaced && check_interlacing(config) != EL_OK) {
        return check_interlacing(config);
    }
#endif
    const uint32_t width = width_drawn(config);
    const uint32_t workers = workers_of(config);
    if (config->memory_bytes < least_bytes(config, width, workers) || config->memory_bytes > INT32_MAX) {
        return EL_ERROR_MEMORY;
    }
    memset(renderer, 0, sizeof *renderer);
    renderer->config = *config;
#if EL_WITH_STRIPES
    renderer->config.width = (uint16_t)width;
#endif
    renderer->config.uv_error_log2 = config->uv_error_log2 != 0 ? config->uv_error_log2 : 3;
    renderer->band_count = bands_of(config->height, config->band_lines);
    renderer->pass_bands = renderer->band_count;
#if EL_WITH_WORKERS
    renderer->workers = (uint8_t)workers;
#endif
    divide_memory(renderer, config, width, workers);
#if EL_WITH_WORKERS
    renderer->list.is_shared = workers > 1;
#endif
    return EL_OK;
}

static void begin_pass(el_renderer *renderer, uint16_t first_band)
{
    renderer->pass_begin = first_band;
    renderer->pass_end = (uint16_t)el_min_i32(renderer->band_count, (int32_t)first_band + renderer->pass_bands);
    el_debug_begin_pass(renderer);
    el_count(&renderer->stats.passes, 1);
}

el_status el_frame_begin(el_renderer *renderer, const el_camera *camera)
{
    if (renderer == NULL || camera == NULL || renderer->in_frame) {
        return EL_ERROR_ARGUMENT;
    }
    const el_status status = el_view_make(&renderer->view, camera, width_shown(renderer), renderer->config.height);
    if (status != EL_OK) {
        return status;
    }
#if EL_WITH_STRIPES
    if (el_config_has_stripes(&renderer->config)) {
        el_view_cut_pixels(&renderer->view, EL_STRIPES_PER_PIXEL);
    }
#endif
    memset(&renderer->stats, 0, sizeof renderer->stats);
    renderer->in_frame = 1;
#if EL_WITH_SAMPLES
    renderer->list.reach = el_samples_reach(el_renderer_samples(renderer));
#endif
#if EL_WITH_INTERLACED
    if (renderer->config.interlaced) {
        begin_field(renderer);
    }
#endif
    el_quiet_begin(renderer);
    begin_pass(renderer, 0);
    for (unsigned i = 0; i < EL_MAX_SINKS; i++) {
        const el_sink *const sink = renderer->config.sinks[i];
        if (sink != NULL) {
            sink->begin(sink->context, width_shown(renderer), renderer->config.height);
        }
    }
    return EL_OK;
}

static int end_frame(el_renderer *renderer)
{
    el_quiet_end(renderer);
    renderer->in_frame = 0;
    for (unsigned i = 0; i < EL_MAX_SINKS; i++) {
        const el_sink *const sink = renderer->config.sinks[i];
        if (sink != NULL) {
            sink->end(sink->context, &renderer->stats);
        }
    }
    return 0;
}

int el_frame_next(el_renderer *renderer)
{
    if (renderer == NULL || !renderer->in_frame) {
        return EL_ERROR_ARGUMENT;
    }
    if (el_quiet_looks(renderer)) {
        if (el_quiet_is_unchanged(renderer)) {
            return end_frame(renderer);
        }
        begin_pass(renderer, 0);
        return 1;
    }
    el_bands_finish(renderer);

    /* What fitted this time fits again, and perhaps a little more: scenes change slowly. */
    const int32_t fitted = renderer->pass_end - renderer->pass_begin;
    if (renderer->pass_end < renderer->band_count) {
        renderer->pass_bands = (uint16_t)(fitted + fitted / 4 + 1);
        begin_pass(renderer, renderer->pass_end);
        return 1;
    }
    if (renderer->pass_begin == 0) {
        renderer->pass_bands = renderer->band_count;
    }
    return end_frame(renderer);
}

void el_frame_forget(el_renderer *renderer)
{
    el_quiet_forget(renderer);
}

const el_stats *el_frame_stats(const el_renderer *renderer)
{
    return &renderer->stats;
}
