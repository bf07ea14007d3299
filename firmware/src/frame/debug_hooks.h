/* Where the frame layer asks for the debug views (debug_view.h); internal to it. Without EL_WITH_DEBUG_VIEWS the functions
 * are empty, so that they cost nothing where they are called. */
#ifndef EL_FRAME_DEBUG_HOOKS_H
#define EL_FRAME_DEBUG_HOOKS_H

#include <stdbool.h>

#include "frame/renderer.h"
#include "raster/triangle.h"

#if EL_WITH_DEBUG_VIEWS

/* A pass begins. */
static inline void el_debug_begin_pass(el_renderer *renderer)
{
    renderer->pass_draws = (uint8_t)renderer->stats.draws;
}

/* A draw call is about to make its records: sets the state's reshading and number, and `shading` to what is in force then.
 * False: the view shows nothing of it. */
bool el_debug_begin_draw(const el_renderer *renderer, el_draw_state *draw, el_shading *shading);

/* What the painter's current band is cleared to; it is opened. */
uint16_t el_debug_begin_band(const el_renderer *renderer, el_painter *painter);

/* A record that is not yet set up has got its surface. */
void el_debug_surface(const el_renderer *renderer, const el_record *record, el_surface *surface);

/* All triangles are drawn into the current band: makes its pixels what the view shows. */
void el_debug_finish_band(const el_renderer *renderer, const el_painter *painter);

#else

static inline void el_debug_begin_pass(const el_renderer *renderer)
{
    (void)renderer;
}

static inline bool el_debug_begin_draw(const el_renderer *renderer, const el_draw_state *draw, el_shading *shading)
{
    (void)renderer;
    (void)draw;
    (void)shading;
    return true;
}

static inline uint16_t el_debug_begin_band(const el_renderer *renderer, const el_painter *painter)
{
    (void)painter;
    return renderer->config.background;
}

static inline void el_debug_surface(const el_renderer *renderer, const el_record *record, const el_surface *surface)
{
    (void)renderer;
    (void)record;
    (void)surface;
}

static inline void el_debug_finish_band(const el_renderer *renderer, const el_painter *painter)
{
    (void)renderer;
    (void)painter;
}

#endif

#endif
