/* .elm: a mesh in one file or one block of flash, little-endian, read in place.
 *
 *   offset size  content
 *        0    4  "ELM\x1a"
 *        4    2  major version, 1, or 2 with a surface: a reader refuses what it does not know
 *        6    2  minor version, 1 or 0: a reader accepts any
 *        8    4  size of the file in bytes
 *       12    4  CRC-32 (zlib's) of the bytes from 16 to the end
 *       16    2  vertex count, 1..65535
 *       18    2  triangle count, 1..61440
 *       20    1  scale_log2, signed, -30..8
 *       21    1  content: 1 vertex colours, 2 triangle colours, 4 normals, 8 texture coordinates, 16 texture,
 *                32 clusters (since 1.1), 64 surface (2.0, and always there); a texture and a surface with a picture
 *                need texture coordinates; there is no texture beside a surface; other bits are 0
 *       22    1  texture or picture width_log2, 0..10 (0 without either)
 *       23    1  texture or picture height_log2, 0..10 (0 without either)
 *       24    6  bounding sphere's centre, 3 x i16
 *       30    2  bounding sphere's radius, u16
 *       32       positions i16[][3], triangles u16[][3], colours u8[][3], triangle colours u8[][3], normals i8[][3],
 *                texture coordinates i16[][2], texels u16[][], clusters, surface: those that are there, in this order,
 *                each padded with zero bytes to a multiple of 4; their meaning is that of mesh.h. Clusters are their
 *                number, u32, and 18 bytes each: triangle count u16, vertex count u16, centre 3 x i16, radius u16,
 *                axis 3 x i8, spread u8, altitude u16
 *
 * A surface is what a material says of the mesh, and its picture in any format of base/image.h:
 *
 *        0    1  el_material.flags: EL_MATERIAL_TWO_SIDED or 0
 *        1    1  el_material.alpha, 1..255
 *        2    1  el_image_format
 *        3    1  levels: of a picture and those at half its size (el_texture.smaller), 1..11; 0: there is no picture, and
 *                what follows is 0
 *        4    2  wrap_u, wrap_v
 *        6    1  1 smooth, 2 has a key, 4 has alpha
 *        7    1  0
 *        8    2  key, 0 without
 *       10    2  0
 *       12       palette u16[256], [16] or [1], none for RGB565; then of each level its texels, and its alpha if there is
 *                any: each padded with zero bytes to a multiple of 4
 *
 * After the last section the file ends. */
#ifndef EL_GEOMETRY_ELM_H
#define EL_GEOMETRY_ELM_H

#include <stddef.h>
#include <stdint.h>

#include "geometry/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum el_elm_status {
    EL_ELM_OK = 0,
    EL_ELM_NOT_ELM = -1,   /* no magic: another kind of file, or misaligned bytes */
    EL_ELM_VERSION = -2,   /* written for a newer Edgeline, or with a surface and for el_elm_open_surface */
    EL_ELM_TRUNCATED = -3, /* shorter than its header says */
    EL_ELM_CORRUPT = -4,   /* CRC, sizes or counts do not agree */
    EL_ELM_RANGE = -5      /* an index, the scale or the bounding sphere is out of range */
} el_elm_status;

/* Checks the `size` bytes at `bytes` (4-byte aligned, unchanged as long as the views are used) and makes `mesh` and
 * `texture` views of them. `texture->texels` is NULL where there is none. On an error nothing is written. Of version 1. */
el_elm_status el_elm_open(const void *bytes, size_t size, el_mesh *mesh, el_texture *texture);

enum { EL_ELM_LEVELS = EL_WITH_MIPMAPS ? 11 : 1 };

/* What there is beside the mesh. It points to itself: it stays where it is. */
typedef struct el_elm_surface {
    uint8_t flags; /* for el_material: two-sided or not */
    uint8_t alpha;
    el_texture levels[EL_ELM_LEVELS]; /* the first is the texture; neither texels nor an image: there is none */
    el_image images[EL_ELM_LEVELS];
} el_elm_surface;

/* The same for both versions; a file of version 1 is opaque and has front faces alone. Without EL_WITH_MIXED a file of version
 * 2 is refused as one for a newer Edgeline. */
el_elm_status el_elm_open_surface(const void *bytes, size_t size, el_mesh *mesh, el_elm_surface *surface);

/* One line in English that says what is wrong. */
const char *el_elm_message(el_elm_status status);

#ifdef __cplusplus
}
#endif

#endif
