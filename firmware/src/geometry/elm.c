/* The reader of .elm: one walk over the bytes that proves everything the renderer relies on, so that nothing needs to be
 * checked again while drawing. What it returns are pointers into the caller's bytes: a mesh in flash costs no RAM.
 *
 * The order of the checks makes the answer the most useful one: first whether it is an .elm at all, then its version
 * (a newer layout must not be called corrupt), its length (a cut download must not either), its CRC, and last what a
 * faulty writer may have put under a correct CRC. */
#include "geometry/elm.h"

#include <stdbool.h>
#include <string.h>

#include "base/crc32.h"
#include "geometry/elm_surface.h"

/* The views are the file's bytes as they lie, so the machine's byte order has to be the file's. */
_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "an .elm is read in place, on little-endian machines only");

typedef struct elm_header {
    uint8_t magic[4];
    uint16_t major;
    uint16_t minor;
    uint32_t size;
    uint32_t crc;
    uint16_t vertex_count;
    uint16_t triangle_count;
    int8_t scale_log2;
    uint8_t content;
    uint8_t width_log2;
    uint8_t height_log2;
    int16_t centre[3];
    uint16_t radius;
} elm_header;

_Static_assert(sizeof(elm_header) == 32, "the header is the file's, byte for byte");
_Static_assert(sizeof(el_cluster) == 18, "clusters are the file's, byte for byte");

enum {
    MAJOR_VERSION = 1,
    MAJOR_VERSION_SURFACE = 2,
    CRC_FROM = 16,
    CLUSTERS_FROM = 4, /* behind their number */
    CONTENT_COLOURS = 1,
    CONTENT_TRIANGLE_COLOURS = 2,
    CONTENT_NORMALS = 4,
    CONTENT_UVS = 8,
    CONTENT_TEXTURE = 16,
    CONTENT_CLUSTERS = 32,
    CONTENT_SURFACE = 64,
    CONTENT_ALL = 63, /* of version 1 */
    MAX_SIDE_LOG2 = 10,
    MIN_SCALE_LOG2 = -30,
    MAX_SCALE_LOG2 = 8
};

/* The sections in the file's order; an absent one has no bytes. */
enum { POSITIONS, TRIANGLES, COLOURS, TRIANGLE_COLOURS, NORMALS, UVS, TEXELS, CLUSTERS, SURFACE, SECTION_COUNT };

typedef struct layout {
    uint32_t offset[SECTION_COUNT]; /* from the beginning of the file, in bytes */
    uint32_t bytes[SECTION_COUNT];  /* without the padding */
    uint32_t size;                  /* of the file */
} layout;

/* Sizes are added up in 32 bits: the largest mesh with the largest texture stays far below them. */
_Static_assert(sizeof(elm_header) + EL_MESH_MAX_VERTICES * (6 + 3 + 3 + 4) + EL_MESH_MAX_TRIANGLES * (6 + 3) +
                       (8 << (2 * MAX_SIDE_LOG2)) + 4 + EL_MESH_MAX_TRIANGLES * (int)sizeof(el_cluster) +
                       3 * SECTION_COUNT <
                   INT32_MAX,
               "the size of a file fits 31 bits");

static uint32_t padded(uint32_t bytes)
{
    return (bytes + 3u) & ~3u;
}

/* `cluster_count`, `surface_bytes`: of the sections that say so themselves. */
static layout layout_of(const elm_header *header, uint32_t cluster_count, uint32_t surface_bytes)
{
    const uint32_t vertices = header->vertex_count;
    const uint32_t triangles = header->triangle_count;
    const uint32_t content = header->content;
    layout at = {
        .bytes =
            {
                [POSITIONS] = vertices * 6,
                [TRIANGLES] = triangles * 6,
                [COLOURS] = content & CONTENT_COLOURS ? vertices * 3 : 0,
                [TRIANGLE_COLOURS] = content & CONTENT_TRIANGLE_COLOURS ? triangles * 3 : 0,
                [NORMALS] = content & CONTENT_NORMALS ? vertices * 3 : 0,
                [UVS] = content & CONTENT_UVS ? vertices * 4 : 0,
                [TEXELS] = content & CONTENT_TEXTURE ? 2u << (header->width_log2 + header->height_log2) : 0,
                [CLUSTERS] =
                    content & CONTENT_CLUSTERS ? CLUSTERS_FROM + cluster_count * (uint32_t)sizeof(el_cluster) : 0,
                [SURFACE] = surface_bytes,
            },
        .size = sizeof(elm_header),
    };
    for (int i = 0; i < SECTION_COUNT; i++) {
        at.offset[i] = at.size;
        at.size += padded(at.bytes[i]);
    }
    return at;
}

/* Whether the header's own fields make sense together; the layout is computed only after this. */
static bool is_consistent(const elm_header *header)
{
    const bool has_texture = (header->content & CONTENT_TEXTURE) != 0;
    if (header->vertex_count == 0 || header->triangle_count == 0 || header->triangle_count > EL_MESH_MAX_TRIANGLES) {
        return false;
    }
#if EL_WITH_MIXED
    if (header->major == MAJOR_VERSION_SURFACE) {
        /* A picture needs texture coordinates, too; its sides are 0 where there is none, which its section has to say. */
        const bool has_uvs = (header->content & CONTENT_UVS) != 0;
        return (header->content & ~CONTENT_ALL) == CONTENT_SURFACE && !has_texture &&
               header->width_log2 <= (has_uvs ? MAX_SIDE_LOG2 : 0) &&
               header->height_log2 <= (has_uvs ? MAX_SIDE_LOG2 : 0);
    }
#endif
    if ((header->content & ~CONTENT_ALL) != 0 || (has_texture && (header->content & CONTENT_UVS) == 0)) {
        return false;
    }
    const int side_limit_log2 = has_texture ? MAX_SIDE_LOG2 : 0;
    return header->width_log2 <= side_limit_log2 && header->height_log2 <= side_limit_log2;
}

static bool is_padded_with_zeros(const uint8_t *file, const layout *at)
{
    for (int i = 0; i < SECTION_COUNT; i++) {
        const uint32_t end = at->offset[i] + at->bytes[i];
        for (uint32_t k = end; k < at->offset[i] + padded(at->bytes[i]); k++) {
            if (file[k] != 0) {
                return false;
            }
        }
    }
    return true;
}

/* Frustum tests trust the spheres: a vertex outside would make a visible mesh vanish. */
static bool is_inside_sphere(const int16_t position[3], const int16_t centre[3], uint16_t radius)
{
    uint64_t distance_squared = 0; /* at most 3 * 65535^2, which is below 2^34 */
    for (int axis = 0; axis < 3; axis++) {
        /* NOLINTNEXTLINE(clang-analyzer-core.NullDereference): a mesh has a vertex. */
        const int64_t d = position[axis] - centre[axis];
        distance_squared += (uint64_t)(d * d);
    }
    return distance_squared <= (uint64_t)radius * radius;
}

/* Clusters hold all triangles and all vertices; their spheres are around their corners, with centres in the mesh's.
 * Cones and altitudes are trusted: a wrong one makes a cluster vanish. */
static bool has_whole_clusters(const elm_header *header, const int16_t (*positions)[3], const uint16_t (*triangles)[3],
                               const el_cluster *clusters, uint32_t cluster_count)
{
    uint32_t triangle = 0;
    uint32_t vertices = 0; /* both are at most 61440 * 65535 */
    for (uint32_t i = 0; i < cluster_count; i++) {
        const el_cluster *const cluster = &clusters[i];
        vertices += cluster->vertex_count;
        const uint32_t end = triangle + cluster->triangle_count;
        if (end > header->triangle_count || vertices > header->vertex_count ||
            !is_inside_sphere(cluster->centre, header->centre, header->radius)) {
            return false;
        }
        for (; triangle < end; triangle++) {
            for (int corner = 0; corner < 3; corner++) {
                if (!is_inside_sphere(positions[triangles[triangle][corner]], cluster->centre, cluster->radius)) {
                    return false;
                }
            }
        }
    }
    return cluster_count == 0 || (triangle == header->triangle_count && vertices == header->vertex_count);
}

static bool is_in_range(const elm_header *header, const int16_t (*positions)[3], const uint16_t (*triangles)[3])
{
    if (header->scale_log2 < MIN_SCALE_LOG2 || header->scale_log2 > MAX_SCALE_LOG2) {
        return false;
    }
    for (uint32_t i = 0; i < header->triangle_count; i++) {
        for (int corner = 0; corner < 3; corner++) {
            /* NOLINTNEXTLINE(clang-analyzer-core.NullDereference): a mesh has a triangle. */
            if (triangles[i][corner] >= header->vertex_count) {
                return false;
            }
        }
    }
    for (uint32_t i = 0; i < header->vertex_count; i++) {
        if (!is_inside_sphere(positions[i], header->centre, header->radius)) {
            return false;
        }
    }
    return true;
}

/* The number at the beginning of the last section, where that is there; no more than fits the file. */
static uint32_t cluster_count_of(const elm_header *header, const uint8_t *file, size_t size)
{
    const uint32_t at = layout_of(header, 0, 0).offset[CLUSTERS];
    uint32_t count = 0;
    if ((header->content & CONTENT_CLUSTERS) != 0 && at <= size - CLUSTERS_FROM) {
        memcpy(&count, file + at, sizeof count);
    }
    return count <= EL_MESH_MAX_TRIANGLES ? count : 0;
}

/* NULL for a section that is absent: mesh.h's way to say so. */
static const void *section(const uint8_t *file, const layout *at, int index)
{
    return at->bytes[index] != 0 ? file + at->offset[index] : NULL;
}

#if EL_WITH_MIXED
/* The size of the last section, by its own head; 0 where that is not there or wrong. */
static uint32_t surface_bytes_of(const elm_header *header, const uint8_t *file, size_t size, uint32_t cluster_count)
{
    const uint32_t at = layout_of(header, cluster_count, 0).offset[SURFACE];
    if (at > size || size - at < EL_ELM_SURFACE_HEAD) {
        return 0;
    }
    const uint32_t bytes = el_elm_surface_bytes(file + at, header->width_log2, header->height_log2);
    /* Only a picture needs texture coordinates. */
    return (header->content & CONTENT_UVS) != 0 || bytes == EL_ELM_SURFACE_HEAD ? bytes : 0;
}
#endif

/* What a file holds, all of it checked but for the inside of its surface. */
typedef struct opened {
    elm_header header;
    layout at;
    el_mesh mesh;
} opened;

/* `last_version`: the newest that the caller can take. */
static el_elm_status open_file(const void *bytes, size_t size, uint16_t last_version, opened *found)
{
    static const uint8_t magic[4] = {'E', 'L', 'M', 0x1a};
    const uint8_t *file = bytes;
    if ((uintptr_t)bytes % 4 != 0 || size < sizeof magic || memcmp(file, magic, sizeof magic) != 0) {
        return EL_ELM_NOT_ELM;
    }
    if (size < sizeof(elm_header)) {
        return EL_ELM_TRUNCATED;
    }
    elm_header header;
    memcpy(&header, file, sizeof header);
    if (header.major < MAJOR_VERSION || header.major > last_version) {
        return EL_ELM_VERSION;
    }
    if (header.size > size) {
        return EL_ELM_TRUNCATED;
    }
    if (header.size != size || el_crc32(0, file + CRC_FROM, size - CRC_FROM) != header.crc || !is_consistent(&header)) {
        return EL_ELM_CORRUPT;
    }
    const uint32_t cluster_count = cluster_count_of(&header, file, size);
    uint32_t surface_bytes = 0;
#if EL_WITH_MIXED
    if (header.major == MAJOR_VERSION_SURFACE) {
        surface_bytes = surface_bytes_of(&header, file, size, cluster_count);
        if (surface_bytes == 0) {
            return EL_ELM_CORRUPT;
        }
    }
#endif
    const layout at = layout_of(&header, cluster_count, surface_bytes);
    if (at.size != size || !is_padded_with_zeros(file, &at)) {
        return EL_ELM_CORRUPT;
    }
    const el_mesh view = {
        .positions = (const int16_t(*)[3])section(file, &at, POSITIONS),
        .triangles = (const uint16_t(*)[3])section(file, &at, TRIANGLES),
        .colours = (const uint8_t(*)[3])section(file, &at, COLOURS),
        .triangle_colours = (const uint8_t(*)[3])section(file, &at, TRIANGLE_COLOURS),
        .normals = (const int8_t(*)[3])section(file, &at, NORMALS),
        .uvs = (const int16_t(*)[2])section(file, &at, UVS),
        .vertex_count = header.vertex_count,
        .triangle_count = header.triangle_count,
        .scale_log2 = header.scale_log2,
        .centre = {header.centre[0], header.centre[1], header.centre[2]},
        .radius = header.radius,
        .cluster_count = (uint16_t)cluster_count,
        .clusters =
            cluster_count != 0 ? (const el_cluster *)(const void *)(file + at.offset[CLUSTERS] + CLUSTERS_FROM) : NULL,
    };
    if (!is_in_range(&header, view.positions, view.triangles) ||
        !has_whole_clusters(&header, view.positions, view.triangles, view.clusters, cluster_count)) {
        return EL_ELM_RANGE;
    }
    *found = (opened){.header = header, .at = at, .mesh = view};
    return EL_ELM_OK;
}

/* Of version 1. */
static el_texture texture_of(const uint8_t *file, const opened *found)
{
    return (el_texture){
        .texels = section(file, &found->at, TEXELS),
        .width_log2 = found->header.width_log2,
        .height_log2 = found->header.height_log2,
    };
}

el_elm_status el_elm_open(const void *bytes, size_t size, el_mesh *mesh, el_texture *texture)
{
    opened found;
    const el_elm_status status = open_file(bytes, size, MAJOR_VERSION, &found);
    if (status == EL_ELM_OK) {
        *mesh = found.mesh;
        *texture = texture_of(bytes, &found);
    }
    return status;
}

el_elm_status el_elm_open_surface(const void *bytes, size_t size, el_mesh *mesh, el_elm_surface *surface)
{
    opened found;
    const el_elm_status status = open_file(bytes, size, EL_WITH_MIXED ? MAJOR_VERSION_SURFACE : MAJOR_VERSION, &found);
    if (status != EL_ELM_OK) {
        return status;
    }
#if EL_WITH_MIXED
    if (found.header.major == MAJOR_VERSION_SURFACE) {
        if (!el_elm_surface_open((const uint8_t *)bytes + found.at.offset[SURFACE], found.header.width_log2,
                                 found.header.height_log2, surface)) {
            return EL_ELM_CORRUPT;
        }
        *mesh = found.mesh;
        return EL_ELM_OK;
    }
#endif
    *surface = (el_elm_surface){.alpha = 255, .levels[0] = texture_of(bytes, &found)};
    *mesh = found.mesh;
    return EL_ELM_OK;
}

const char *el_elm_message(el_elm_status status)
{
    switch (status) {
    case EL_ELM_OK:
        return "the mesh is in order";
    case EL_ELM_NOT_ELM:
        return "not an .elm mesh (or its bytes are not 4-byte aligned); convert a model with: edgeline convert";
    case EL_ELM_VERSION:
        return "an .elm of another major version, or with a surface; convert the model again, or update Edgeline";
    case EL_ELM_TRUNCATED:
        return "the .elm is cut short: it has fewer bytes than its header says; copy it again";
    case EL_ELM_CORRUPT:
        return "the .elm is damaged: its checksum, sizes or counts do not agree; copy or convert it again";
    case EL_ELM_RANGE:
        return "the .elm holds an index, a scale or a bounding sphere out of range; convert the model again";
    }
    return "unknown .elm status";
}
