/* Meshes and textures: const data, usable from flash, never copied and never written.
 *
 * A converter writes them as C headers (`edgeline convert model.obj -o model.h`) or as .elm files (elm.h). */
#ifndef EL_GEOMETRY_MESH_H
#define EL_GEOMETRY_MESH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/image.h"
#include "base/options.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The most that a mesh can have. Triangle indices above are reserved. */
enum { EL_MESH_MAX_TRIANGLES = 61440, EL_MESH_MAX_VERTICES = 65535 };

/* What lies beyond a texture's borders: period 1 of it, its outermost texels, period 2 with every other one turned around. */
typedef enum el_wrap { EL_WRAP_REPEAT, EL_WRAP_CLAMP, EL_WRAP_MIRROR } el_wrap;

enum { EL_TEXTURE_MAX_SIDE = 1024 };

/* A picture, row 0 on top: 2^width_log2 x 2^height_log2 RGB565 texels, which is drawn fastest if it repeats in both
 * directions and is not smooth; or `image`, in any format of base/image.h and of any size up to EL_TEXTURE_MAX_SIDE.
 * Ranges: 0 <= width_log2, height_log2 <= 10.
 *
 * Of an image with a key, or a mask, texels that show less than half are not drawn: neither their colour nor their depth. One
 * with `alpha` is blended (el_material.alpha).
 *
 * `smaller` is the same picture at half the size: of a side of n texels n / 2, n even, or 1 of 1. A triangle is drawn with the
 * first of this chain in which it has less than two texels for each pixel that it covers, by the areas of its corners:
 * those on the screen, and those of u and v; or with the last one. So whatever is chosen is chosen for a whole triangle, or
 * for the piece of it that clipping leaves. Texture coordinates are those of the first texture. Each has its own wrap_u,
 * wrap_v and smooth. */
typedef struct el_texture {
    const uint16_t *texels; /* not looked at where there is an image */
    uint8_t width_log2;
    uint8_t height_log2;
#if EL_WITH_MIXED
    uint8_t wrap_u, wrap_v; /* el_wrap */
    bool smooth;            /* bilinear: the mean of four texels by their centres' distances in sixteenths */
    const el_image *image;  /* or NULL */
#endif
#if EL_WITH_MIPMAPS
    const struct el_texture *smaller; /* or NULL */
#endif
} el_texture;

/* A part of a mesh that can be skipped whole: triangles that follow each other, a sphere around them and a cone around
 * their normals. `edgeline convert` makes them. */
typedef struct el_cluster {
    uint16_t triangle_count; /* of the mesh's triangles, those that follow the cluster before */
    uint16_t vertex_count;   /* of its vertices, likewise: mostly its own; triangles may name any */
    int16_t centre[3];       /* sphere around all corners of its triangles, in position units; within the mesh's */
    uint16_t radius;         /* rounded up */
    int8_t axis[3];          /* of the cone, about 127 long */
    uint8_t spread;    /* the cone: each normal is within the angle of this sine, times 256 and rounded up, from the
                                axis; 255: no cone */
    uint16_t altitude; /* least altitude of a triangle, in position units, rounded down; 0: no cone either */
} el_cluster;

/* Right-handed model space. A triangle is seen from its front when its vertices run counter-clockwise. Vertices that
 * differ in any attribute are stored apart. Optional arrays are NULL. */
typedef struct el_mesh {
    const int16_t (*positions)[3];        /* [vertex_count] x, y, z in units of 2^scale_log2 */
    const uint16_t (*triangles)[3];       /* [triangle_count] indices below vertex_count */
    const uint8_t (*colours)[3];          /* [vertex_count] red, green, blue; or NULL */
    const uint8_t (*triangle_colours)[3]; /* [triangle_count] red, green, blue, for flat shading; or NULL */
    const int8_t (*normals)[3];           /* [vertex_count] unit normals times 127; or NULL */
    const int16_t (*uvs)[2];              /* [vertex_count] u (right), v (down) in texels, Q12.4: texel (i, j) covers
                                           [i, i+1) x [j, j+1); or NULL */
#if EL_WITH_WIRES
    const uint8_t *edges; /* [triangle_count] which edges EL_MATERIAL_WIRES draws: bit i, from corner i to the next one,
                             in both triangles of the edge; NULL: all */
#endif
    uint16_t vertex_count;
    uint16_t triangle_count; /* 0 to EL_MESH_MAX_TRIANGLES */
    int8_t scale_log2;       /* one position unit is 2^scale_log2 world units; -30 to 8 */
    int16_t centre[3];       /* bounding sphere, in position units */
    uint16_t radius;         /* rounded up; every vertex lies within it */
    uint16_t cluster_count;
    const el_cluster *clusters; /* [cluster_count] all triangles and all vertices, in their order; or NULL */
} el_mesh;

#if EL_WITH_WIRES
static inline unsigned el_mesh_edges(const el_mesh *mesh, uint16_t triangle)
{
    return mesh->edges != NULL ? mesh->edges[triangle] : 7U;
}
#endif

#ifdef __cplusplus
}
#endif

#endif
