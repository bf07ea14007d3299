/* Which scene a program shows, which of its frames comes next, and whether it stands still: what a host sets by INPUT
 * (stream/session.h, EL_CONTROL_...). */
#ifndef EL_APPS_PLAYER_H
#define EL_APPS_PLAYER_H

#include <stdbool.h>
#include <stdint.h>

#include "scene.h"

/* All may be read and written between frames; {.scene = ...} begins at its frame 0. */
typedef struct el_player {
    const el_scene *scene;
    uint32_t frame; /* the next one */
    bool paused;    /* `frame` stays */
} el_player;

/* For el_stream_config.input, with the player as its context. Safe in the middle of a frame, which it does not change. A
 * scene that is not there, a negative frame and unknown controls are ignored. */
void el_player_input(void *player, uint8_t control, int32_t value);

/* Draws the next frame, on the scene's background. EL_OK or an error; the player goes on in either case. */
el_status el_player_play(el_player *player, el_renderer *renderer);

#endif
