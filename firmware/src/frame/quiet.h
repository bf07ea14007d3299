/* What the frame layer need not do because the frame before has it already (el_config.reuse); internal to it.
 *
 * Two facts, each found for next to nothing. A band into which no triangle was binned is background; if it was so in
 * the frame before, its lines are unchanged. And a frame for which the same was submitted is unchanged as a whole. What
 * then need not be done is for each layer and each sink to say: one whose display heals by being sent again takes some
 * bands in any case. Without EL_WITH_REUSE the functions are empty, so that they cost nothing where they are called. */
#ifndef EL_FRAME_QUIET_H
#define EL_FRAME_QUIET_H

#include <stdbool.h>

#include "frame/renderer.h"

#if EL_WITH_REUSE

/* A frame begins; the view is made. */
void el_quiet_begin(el_renderer *renderer);

/* Whether this pass only looks at what is submitted. */
static inline bool el_quiet_looks(const el_renderer *renderer)
{
    return renderer->quiet.looks;
}

/* A draw call that has passed its checks, in a pass that only looks. */
void el_quiet_look_at(el_renderer *renderer, const el_mesh *mesh, const el_pose *pose, const el_material *material);

/* A draw call has got an error that not each pass gives: the next frame is drawn. */
static inline void el_quiet_refuse(el_renderer *renderer)
{
    renderer->quiet.refused = 1;
}

/* The pass that looks is over. True: nothing has changed, and no sink wants the frame: it is done. */
bool el_quiet_is_unchanged(el_renderer *renderer);

/* Asks the sinks about a band that is to be drawn and handed over. `is_empty`: nothing is drawn into it. True: none wants
 * it. */
bool el_quiet_leaves_out(el_renderer *renderer, uint16_t band, bool is_empty);

/* Sink `index` if it takes the band of which el_quiet_leaves_out was asked last, or, before that, the frame; else NULL. */
static inline const el_sink *el_quiet_taker(const el_renderer *renderer, unsigned index)
{
    return ((unsigned)renderer->quiet.band_takers >> index & 1U) != 0 ? renderer->config.sinks[index] : NULL;
}

/* The frame is done. */
void el_quiet_end(el_renderer *renderer);

static inline void el_quiet_forget(el_renderer *renderer)
{
    renderer->quiet.known = 0;
}

#else

static inline void el_quiet_begin(const el_renderer *renderer)
{
    (void)renderer;
}

static inline bool el_quiet_looks(const el_renderer *renderer)
{
    (void)renderer;
    return false;
}

static inline void el_quiet_look_at(const el_renderer *renderer, const el_mesh *mesh, const el_pose *pose,
                                    const el_material *material)
{
    (void)renderer;
    (void)mesh;
    (void)pose;
    (void)material;
}

static inline void el_quiet_refuse(const el_renderer *renderer)
{
    (void)renderer;
}

static inline bool el_quiet_is_unchanged(const el_renderer *renderer)
{
    (void)renderer;
    return false;
}

static inline bool el_quiet_leaves_out(const el_renderer *renderer, uint16_t band, bool is_empty)
{
    (void)renderer;
    (void)band;
    (void)is_empty;
    return false;
}

static inline const el_sink *el_quiet_taker(const el_renderer *renderer, unsigned index)
{
    return renderer->config.sinks[index];
}

static inline void el_quiet_end(const el_renderer *renderer)
{
    (void)renderer;
}

static inline void el_quiet_forget(const el_renderer *renderer)
{
    (void)renderer;
}

#endif

#endif
