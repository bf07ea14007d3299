/* Level of detail: how large a mesh is on the screen, and which of several to draw there. */
#ifndef EL_GEOMETRY_DETAIL_H
#define EL_GEOMETRY_DETAIL_H

#include <stdint.h>

#include "geometry/mesh.h"
#include "geometry/pose.h"
#include "geometry/transform.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One of several meshes of the same thing, the finest first. */
typedef struct el_level {
    const el_mesh *mesh;
    uint16_t
        least_px; /* drawn where the thing is so large, EL_LEVEL_FINER of it where it comes from a coarser one; falling
                          from level to level, and of no meaning at the last */
} el_level;

/* A finer level begins an eighth above the size at which it ends, so that what stands at the limit does not flicker. */
#define EL_LEVEL_FINER(size) ((size) + (size) / 8U)

/* The diameter of the mesh's bounding sphere on the screen, in lines of 1/16 px: as large as a disc across the view at
 * the distance of the sphere's middle, which is the near plane's at least. Within 1/16 px and 2^-16 of that, and as if
 * it stood 2^-14 units nearer or farther; UINT32_MAX where it is larger. `view` is el_renderer.view within a frame.
 * Pre: a pose that el_draw takes. */
uint32_t el_screen_size_q4(const el_view *view, const el_mesh *mesh, const el_pose *pose);

/* The level for that size where `current` is the one that was drawn last (any number; 0 at first). Asked again for the same
 * size, it says the same. count > 0. */
uint8_t el_level_choose(const el_level *levels, uint8_t count, uint32_t size_q4, uint8_t current);

#ifdef __cplusplus
}
#endif

#endif
