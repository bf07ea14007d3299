/* What a host sets on a board by INPUT, set from the command line: the debug view, the shading, the camera's offsets. */
#ifndef EL_SIM_INPUTS_H
#define EL_SIM_INPUTS_H

#include <stdbool.h>

#include "player.h"

/* The command line's wishes; NULL where there is none. Numbers are in the units of WIRE.md's INPUT. */
typedef struct el_inputs {
    const char *view;    /* a name, see below */
    const char *shading; /* flat, gouraud (no textures) or textured (no vertex colours) */
    const char *yaw, *pitch, *zoom, *pan_x, *pan_y;
} el_inputs;

/* "picture", "overdraw", ... by el_debug_view, and a line on each. */
extern const char *const el_view_names[];
extern const char *const el_view_summaries[];
extern const unsigned el_view_count;

/* Gives the player what is wished. False after one line on stderr. */
bool el_inputs_give(const el_inputs *inputs, el_player *player);

/* Whether the camera is to be moved. */
bool el_inputs_move(const el_inputs *inputs);

#endif
