/* Meshes and textures: const data, usable from flash, never copied and never written.
 *
 * A converter writes them as C headers (`edgeline convert model.obj -o model.h`) or as .elm files (elm.h). */
#ifndef EL_GEOMETRY_MESH_H
#define EL_GEOMETRY_MESH_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The most that a mesh can have. Triangle indices above are reserved. */
enum { EL_MESH_MAX_TRIANGLES = 61440, EL_MESH_MAX_VERTICES = 65535 };

/* A picture of 2^width_log2 x 2^height_log2 RGB565 texels, row 0 on top; it repeats in both directions.
 * Ranges: 0 <= width_log2, height_log2 <= 10. */
typedef struct el_texture {
    const uint16_t *texels;
    uint8_t width_log2;
    uint8_t height_log2;
} el_texture;

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
    uint16_t vertex_count;
    uint16_t triangle_count; /* 0 to EL_MESH_MAX_TRIANGLES */
    int8_t scale_log2;       /* one position unit is 2^scale_log2 world units; -30 to 8 */
    int16_t centre[3];       /* bounding sphere, in position units */
    uint16_t radius;         /* rounded up; every vertex lies within it */
} el_mesh;

#ifdef __cplusplus
}
#endif

#endif
