/* Drawing the collected triangles into bands, and handing bands to the sinks. Internal to the frame layer. */
#ifndef EL_FRAME_BANDS_H
#define EL_FRAME_BANDS_H

#include "frame/renderer.h"
#include "raster/triangle.h"

/* The painter of core `worker`, 0 being the caller's. */
static inline el_painter *el_renderer_painter(el_renderer *renderer, unsigned worker)
{
    return !EL_WITH_WORKERS || worker == 0 ? &renderer->painter : &renderer->others[worker - 1U].painter;
}

/* Samples per pixel, as they are asked for; 0 is 1. */
static inline unsigned el_config_samples(const el_config *config)
{
#if EL_WITH_SAMPLES
    return config->samples;
#else
    (void)config;
    return 1U;
#endif
}

static inline bool el_config_has_stripes(const el_config *config)
{
#if EL_WITH_STRIPES
    return config->stripes != EL_STRIPES_NONE;
#else
    (void)config;
    return false;
#endif
}

/* Samples per pixel of the frame: a view of what is drawn has one. */
static inline unsigned el_renderer_samples(const el_renderer *renderer)
{
    const unsigned samples = el_config_samples(&renderer->config);
    return samples > 1U && renderer->config.view == EL_DEBUG_PICTURE ? samples : 1U;
}

/* Lines of the frame: the screen's, or a field's. */
static inline int32_t el_renderer_lines(const el_renderer *renderer)
{
    const unsigned field = el_list_field(&renderer->list);
    const int32_t height = renderer->config.height;
    return !EL_WITH_INTERLACED || field == EL_FIELD_NONE ? height : (height + (field == EL_FIELD_EVEN)) >> 1;
}

/* Counts a use of `bytes` of the list's memory in the peak. */
void el_bands_note_use(el_renderer *renderer, uint32_t bytes);

/* Draws every listed triangle into the pass' only band, which stays open, and empties the list. */
void el_bands_flush(el_renderer *renderer);

/* Draws the pass' bands and hands them over. */
void el_bands_finish(el_renderer *renderer);

/* What one core does with a band, frame/painter.c: */

/* Lets `painter` carry what it may in bytes [begin, end) of the list's memory, and count in `stats`. */
static inline void el_painter_begin(el_painter *painter, const el_list *list, uint32_t begin, uint32_t end,
                                    el_stats *stats)
{
    painter->stats = stats;
    painter->carrying =
        (el_carrying){.first_state = (uint16_t)(list->used / EL_LIST_UNIT), .begin = begin, .used = begin, .end = end};
}

/* Draws the triangles of the chain that begins with `fresh`, and those carried on from above, into an open band. Carries on
 * what reaches beyond it, where the painter goes on. */
void el_painter_draw(el_painter *painter, const el_renderer *renderer, const el_target *target, uint16_t fresh);

#if EL_WITH_WORKERS
/* For frame/workers.c: */

/* Opens the painter's current buffer, which is free, for `band`, unless it is open, and draws what has been collected of it.
 * Carries on what reaches beyond, where `goes_on`. */
void el_bands_draw(el_painter *painter, const el_renderer *renderer, uint16_t band, bool goes_on);

/* All triangles of the painter's current band are drawn: what comes over them. */
void el_bands_complete(el_painter *painter, const el_renderer *renderer);

/* Gives a complete band to the sinks. */
void el_bands_hand_over(el_renderer *renderer, el_band *band);

/* Lets the sinks go on, or sleep, while `band` is theirs. */
void el_bands_wait_for_sinks(const el_renderer *renderer, const el_band *band);

/* el_bands_finish with several workers. */
void el_workers_draw_pass(el_renderer *renderer);
#endif

#endif
