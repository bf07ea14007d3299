/* Clusters of a mesh that need not be looked at: outside the view, or facing away as a whole.
 *
 * Both verdicts are exact in what they promise: of a cluster that is called outside every vertex is beyond one and the
 * same plane of the view, and of one that is called turned away every triangle has the winding of a back face after its
 * corners were snapped. So skipping never changes a pixel. firmware/DESIGN.md, "Clusters", has the derivation. */
#ifndef EL_GEOMETRY_CLUSTER_H
#define EL_GEOMETRY_CLUSTER_H

#include <stdbool.h>
#include <stdint.h>

#include "geometry/transform.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What a draw's transform says about all of its clusters. */
typedef struct el_cluster_view {
    uint16_t reach[3]; /* the most that x, y and d change per position unit, rounded up: reach * 2^reach_log2 */
    int8_t reach_log2;
    bool cones;       /* the rest is valid */
    bool mirrored;    /* the transform's determinant is negative */
    int8_t unit_log2; /* a position unit is unit * 2^unit_log2 of to_model * clip coordinates */
    uint16_t unit;    /* 13 bits, rounded up */
    int16_t to_model[3]
                    [3]; /* from clip coordinates to directions in model space, in a common unit, 14 bits and a sign */
    int32_t slack_log2_q8; /* log2 of how far the camera must be behind a plane, times altitude and w / w^3 */
} el_cluster_view;

/* `two_sided`: no triangle may be skipped for facing away. */
void el_cluster_view_make(el_cluster_view *view, const el_transform *transform, bool two_sided);

typedef enum el_cluster_verdict {
    EL_CLUSTER_SEEN,    /* or not known */
    EL_CLUSTER_OUTSIDE, /* of the view */
    EL_CLUSTER_TURNED   /* away */
} el_cluster_verdict;

el_cluster_verdict el_cluster_look(const el_cluster_view *view, const el_transform *transform,
                                   const el_cluster *cluster);

#ifdef __cplusplus
}
#endif

#endif
