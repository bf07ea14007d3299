/* Picking: which draw call, and which of its triangles, has a pixel.
 *
 *     el_pick_begin(&pick, &camera, 320, 240, x, y, memory, sizeof memory);
 *     el_pick_draw(&pick, &mesh, &pose, &material);       as the frame's el_draw, in the same order
 *     if (el_pick_end(&pick, &picked) > 0) { ... }
 *
 * What is picked is what is seen: the answer comes from a renderer of its own that draws the pixel's line, through the
 * same clipping, culling, coverage and depth test, ties included. What is blended, or has texels that do not show,
 * counts as if it were opaque, and wires as the triangles that they are of. No sink gets anything. It takes about two
 * frames' vertices and culling, and the set-up of what touches the line. */
#ifndef EL_FRAME_PICK_H
#define EL_FRAME_PICK_H

#include <stddef.h>
#include <stdint.h>

#include "frame/renderer.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The least memory that picking takes; with room for more vertices and triangles it is faster. */
#define EL_PICK_BYTES(width, height) EL_MIN_MEMORY_BYTES(width, height, 1U)

typedef struct el_picked {
    uint32_t draw;     /* the draw call, 0 for the first; those that failed are counted too */
    uint32_t triangle; /* its index in the mesh; of one that was cut, the whole one's */
    uint16_t depth;    /* at that pixel, 0 near; of a material without depth, what is behind it */
} el_picked;

/* Owned by the caller; its members are the picker's. */
typedef struct el_pick {
    el_renderer renderer;
    uint16_t x;
    uint32_t draws;
    el_picked best;
    const el_mesh *mesh; /* of the best; NULL: nothing so far */
    el_pose pose;        /* likewise */
    uint8_t flags;       /* of its material */
} el_pick;

/* For pixel (x, y) of a screen of width x height pixels. `memory` is the picker's until el_pick_end; any alignment, at least
 * EL_PICK_BYTES. EL_ERROR_ARGUMENT for a pixel beside the screen, and the errors of el_init and el_frame_begin. */
el_status el_pick_begin(el_pick *pick, const el_camera *camera, uint16_t width, uint16_t height, uint16_t x, uint16_t y,
                        void *memory, size_t memory_bytes);

/* What el_draw would draw, with its errors. The mesh must stay until el_pick_end; pose and material may change. */
el_status el_pick_draw(el_pick *pick, const el_mesh *mesh, const el_pose *pose, const el_material *material);

/* Returns 1 and says what has the pixel, or 0 where it shows the background; `picked` is unchanged then. EL_ERROR_ARGUMENT
 * before el_pick_begin. */
int el_pick_end(el_pick *pick, el_picked *picked);

#ifdef __cplusplus
}
#endif

#endif
