/* What a host sets by INPUT (stream/session.h, EL_CONTROL_...; WIRE.md): which scene a program shows, which of its frames
 * comes next, whether it stands still; from where it is seen, how it is shaded, and which debug view is shown. */
#ifndef EL_APPS_PLAYER_H
#define EL_APPS_PLAYER_H

#include <stdbool.h>
#include <stdint.h>

#include "geometry/orbit.h"
#include "scene.h"
#include "stream/session.h"

/* What HELLO says of it: a bit for each control that it knows, and for each debug view, in programs that have them. */
#define EL_PLAYER_CONTROLS                                                                                             \
    (1U << EL_CONTROL_SCENE | 1U << EL_CONTROL_FRAME | 1U << EL_CONTROL_PAUSE | 1U << EL_CONTROL_STEP |                \
     1U << EL_CONTROL_YAW | 1U << EL_CONTROL_PITCH | 1U << EL_CONTROL_ZOOM | 1U << EL_CONTROL_PAN_X |                  \
     1U << EL_CONTROL_PAN_Y | (EL_WITH_TEXTURE ? 1U << EL_CONTROL_TEXTURE_ERROR : 0U) |                                \
     (EL_WITH_DEBUG_VIEWS ? 1U << EL_CONTROL_SHADING | 1U << EL_CONTROL_VIEW : 0U))
#define EL_PLAYER_VIEWS (EL_WITH_DEBUG_VIEWS ? (1U << EL_DEBUG_VIEWS) - 1U : 0U)

/* All may be read and written between frames; {.scene = ...} begins at its frame 0, as the scene is made. */
typedef struct el_player {
    const el_scene *scene;
    uint32_t frame;            /* the next one */
    bool paused;               /* `frame` stays */
    el_orbit orbit;            /* how its camera is moved */
    uint8_t shading_off;       /* as el_config has it */
    uint8_t view;              /* likewise */
    uint8_t texture_error;     /* uv_error_log2, 1..5; 0: what the renderer had at the first frame: */
    uint8_t own_texture_error; /* the player's: that, or 0 before the first frame */
} el_player;

/* For el_stream_config.input, with the player as its context. Safe in the middle of a frame, which it does not change.
 * Controls that it does not know, and values out of their range, are ignored. */
void el_player_input(void *player, uint8_t control, int32_t value);

/* Draws the next frame with all that, on the scene's background. EL_OK or an error; the player goes on in either case. */
el_status el_player_play(el_player *player, el_renderer *renderer);

#endif
