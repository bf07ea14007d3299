/* What a program of this folder is: two functions, called by board_main.c on a board and by sim/examples/main.c on a PC,
 * so that the same source shows the same picture on both.
 *
 * Its build gives it the screen: EXAMPLE_WIDTH and EXAMPLE_HEIGHT in pixels, as the viewer sees it, and EXAMPLE_BAND,
 * the lines of a band. */
#ifndef EL_EXAMPLE_H
#define EL_EXAMPLE_H

#include "edgeline.h"

/* Both stay. */
typedef struct example_screen {
    const el_sink *sink; /* the panel's driver, started */
    const el_bus *bus;   /* the wire below it, for programs that drive the panel themselves */
} example_screen;

/* What has happened when a frame begins. */
typedef struct example_input {
    uint32_t ms; /* since the first frame, modulo 2^32 */
    char key; /* the last letter that came over the serial line since the frame before; 0: none. w a s d are up, left,
                    down and right, or walking and turning; q and e nearer and farther; a space chooses */
} example_input;

/* Once, before the first frame. What is not EL_OK ends the program with a report of it; so does the other. */
el_status example_setup(const example_screen *screen);

/* Draws the next frame, again and again. */
el_status example_frame(const example_input *input);

/* --- What several of them share; hello_triangle.c does without ------------------------------------------------- */

/* A frame with one mesh in it. */
el_status example_show(el_renderer *renderer, const el_camera *camera, const el_mesh *mesh, const el_pose *pose,
                       const el_material *material);

/* From the upper left, a little from behind the viewer. */
extern const el_light example_light;

#endif
