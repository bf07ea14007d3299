/* A draw call's clusters: each is looked at before its vertices are. */
#include "frame/drawing.h"
#include "geometry/cluster.h"

#if EL_WITH_CLUSTERS

/* Clusters that may be seen and follow each other. */
typedef struct stretch {
    uint32_t vertex, vertex_end;
    uint32_t triangle, triangle_end;
} stretch;

static void draw_stretch(el_drawing *d, const stretch *s)
{
    if (s->triangle == s->triangle_end) {
        return;
    }
    if (d->direct) {
        el_vertices_transform(d, s->vertex, s->vertex_end - s->vertex, d->vertices + s->vertex);
    }
    (void)el_drawing_run(d, s->triangle, s->triangle_end);
}

uint32_t el_drawing_run_clusters(el_drawing *d)
{
    el_stats *const stats = &d->renderer->stats;
    el_cluster_view view;
    el_cluster_view_make(&view, &d->state->transform, d->culling.two_sided);
    stretch seen = {0};
    uint32_t skipped = 0;
    for (uint32_t i = 0; i < d->mesh->cluster_count; i++) {
        const el_cluster *const cluster = &d->mesh->clusters[i];
        const el_cluster_verdict verdict = el_cluster_look(&view, &d->state->transform, cluster);
        if (verdict == EL_CLUSTER_SEEN) {
            seen.vertex_end += cluster->vertex_count;
            seen.triangle_end += cluster->triangle_count;
            continue;
        }
        draw_stretch(d, &seen);
        seen.vertex = seen.vertex_end += cluster->vertex_count;
        seen.triangle = seen.triangle_end += cluster->triangle_count;
        skipped += cluster->triangle_count;
        el_count(verdict == EL_CLUSTER_OUTSIDE ? &stats->clusters_outside : &stats->clusters_turned, 1);
    }
    draw_stretch(d, &seen);
    return skipped;
}

#endif
