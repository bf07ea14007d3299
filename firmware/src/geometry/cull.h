/* The first look at a mesh: is its bounding sphere clearly outside the view? */
#ifndef EL_GEOMETRY_CULL_H
#define EL_GEOMETRY_CULL_H

#include <stdbool.h>

#include "geometry/transform.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Whether the sphere lies outside one of the view's six planes by so much that arithmetic of 14 bits can tell. True only
 * where el_transform_make's own test, which is exact to a unit, would say so too, and where nothing that it calls an error
 * is hidden; false says nothing.
 * Pre: what el_view_make and el_transform_make check of camera and pose: elements within +-1, positions in the world, a
 * scale that is not 0, scale_log2 of -30 to 8. */
bool el_cull_is_far_outside(const el_view *view, const el_mesh *mesh, const el_pose *pose);

/* How far the mesh reaches from its origin along any axis, in position units. */
uint32_t el_cull_reach(const el_mesh *mesh);

#ifdef __cplusplus
}
#endif

#endif
