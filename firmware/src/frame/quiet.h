/* What the frame layer need not do because the frame before has it already (el_config.reuse); internal to it.
 *
 * Two facts, each found for next to nothing. A band into which no triangle was binned is background; if it was so in the
 * frame before, its lines are unchanged. And a frame for which the same was submitted is unchanged as a whole. What then
 * need not be done is for each sink to say: one whose display heals by being sent again takes some bands in any case. */
#ifndef EL_FRAME_QUIET_H
#define EL_FRAME_QUIET_H

#include <stdbool.h>

#include "frame/renderer.h"

/* A frame begins; the view is made. */
void el_quiet_begin(el_renderer *renderer);

/* A draw call that has passed its checks. True: this pass only looks. */
bool el_quiet_looks_at(el_renderer *renderer, const el_mesh *mesh, const el_pose *pose, const el_material *material);

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

/* Sink `index` if it takes the band of which el_quiet_leaves_out was asked last, else NULL. */
static inline const el_sink *el_quiet_taker(const el_renderer *renderer, unsigned index)
{
    return (renderer->quiet.band_takers >> index & 1U) != 0 ? renderer->config.sinks[index] : NULL;
}

/* The frame is done. */
void el_quiet_end(el_renderer *renderer);

#endif
