/* Things that hang on others: an arm on a robot, a wheel on a car.
 *
 * A node has a pose in its parent's space, and stands behind its parent in the caller's array: so one pass from the front
 * has all poses in the world, without recursion, however deep it is. */
#ifndef EL_GEOMETRY_HIERARCHY_H
#define EL_GEOMETRY_HIERARCHY_H

#include <stdint.h>

#include "base/status.h"
#include "geometry/pose.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { EL_NO_PARENT = -1 };

typedef struct el_node {
    int16_t parent; /* index below its own, or EL_NO_PARENT: `local` is in the world */
    el_pose local;  /* in the parent's space: its rotation, scale and position apply to this as they do to models */
} el_node;

/* Where a model at `local` is in the world when local's space is `parent`: rotations are multiplied, scales too, the
 * position is scaled, turned and added. Positions saturate beyond the world, where el_draw refuses them, scales at 1 and
 * 2^32 - 1. */
el_pose el_pose_within(const el_pose *parent, const el_pose *local);

/* world[i] for all nodes. EL_ERROR_ARGUMENT at the first node whose parent does not stand before it: world's poses from
 * there on are not written. A turn is rounded per level, by 2^-30 of its matrix. */
el_status el_hierarchy_update(const el_node *nodes, el_pose *world, uint16_t count);

#ifdef __cplusplus
}
#endif

#endif
