/* Random cameras, poses, meshes and materials. Only what the caller must hold is held: pointers point somewhere, indices are
 * below the vertex count, textures have their texels. Bounding spheres may lie. */
#ifndef EL_FUZZ_ANY_SCENE_H
#define EL_FUZZ_ANY_SCENE_H

#include "picture.h"

enum { MAX_DRAWS = 4, MAX_VERTICES = 24, MAX_TRIANGLES = 32, TEXTURE_SIDE = 32, TEXELS = TEXTURE_SIDE * TEXTURE_SIDE };

typedef struct item {
    int16_t positions[MAX_VERTICES][3];
    uint16_t triangles[MAX_TRIANGLES][3];
    uint8_t colours[MAX_VERTICES][3];
    uint8_t triangle_colours[MAX_TRIANGLES][3];
    int8_t normals[MAX_VERTICES][3];
    int16_t uvs[MAX_VERTICES][2];
    el_mesh mesh;
    el_pose pose;
    el_texture texture, smaller;
    el_image image;
    el_light light;
    el_fog fog;
    el_material material;
} item;

typedef struct scene {
    uint16_t width, height;
    uint16_t background;
    uint8_t uv_error_log2;
    uint8_t samples; /* per pixel */
    el_camera camera;
    unsigned count;
    item items[MAX_DRAWS];
    uint16_t texels[TEXELS];
} scene;

static inline void take_matrix(input *in, int32_t matrix[3][3])
{
    const uint8_t kind = take_u8(in);
    el_pose turned = el_pose_identity();
    if (kind % 4 == 0) { /* anything */
        take_bytes(in, matrix, sizeof turned.rotation_q30);
        return;
    }
    for (el_axis axis = EL_AXIS_X; axis <= EL_AXIS_Z && kind % 4 > 1; axis++) {
        el_pose_turn(&turned, axis, (el_angle)take_u16(in) << 16);
    }
    memcpy(matrix, turned.rotation_q30, sizeof turned.rotation_q30);
}

static inline void take_camera(input *in, el_camera *camera)
{
    const uint8_t kind = take_u8(in);
    *camera = (el_camera){.projection = (kind & 1) != 0 ? EL_ORTHOGRAPHIC : EL_PERSPECTIVE};
    take_matrix(in, camera->axes_q30);
    if ((kind & 2) != 0) {
        take_bytes(in, camera->position_q16, sizeof camera->position_q16);
        camera->aspect_q16 = take_u32(in);
    }
    camera->fov_y = (el_angle)take_u16(in) << 16;
    camera->height_q16 = take_u32(in);
    camera->near_q16 = (kind & 4) != 0 ? take_u32(in) : 16U << (kind >> 4);
    camera->far_q16 = (kind & 8) != 0 ? take_u32(in) : 1U << 30;
}

static inline void take_mesh(input *in, item *t)
{
    const uint8_t content = take_u8(in);
    t->mesh = (el_mesh){
        .positions = (const int16_t(*)[3])t->positions,
        .triangles = (const uint16_t(*)[3])t->triangles,
        .colours = (content & 1) != 0 ? (const uint8_t(*)[3])t->colours : NULL,
        .triangle_colours = (content & 2) != 0 ? (const uint8_t(*)[3])t->triangle_colours : NULL,
        .normals = (content & 4) != 0 ? (const int8_t(*)[3])t->normals : NULL,
        .uvs = (content & 8) != 0 ? (const int16_t(*)[2])t->uvs : NULL,
        .vertex_count = (uint16_t)(1 + take_u8(in) % MAX_VERTICES),
        .triangle_count = (uint16_t)(take_u8(in) % (MAX_TRIANGLES + 1)),
        .scale_log2 = (int8_t)take_u8(in),
        .radius = UINT16_MAX,
    };
    if ((content & 16) != 0) { /* a sphere that may lie */
        take_bytes(in, t->mesh.centre, sizeof t->mesh.centre);
        t->mesh.radius = take_u16(in);
    }
#if EL_WITH_WIRES
    t->mesh.edges = (content & 64) != 0 ? t->triangle_colours[0] : NULL;
#endif
    if ((content & 32) == 0) { /* inside the range, more often than not */
        t->mesh.scale_log2 = (int8_t)(-30 + (uint8_t)t->mesh.scale_log2 % 39);
    }
    take_bytes(in, t->positions, sizeof t->positions[0] * t->mesh.vertex_count);
    take_bytes(in, t->colours, sizeof t->colours[0] * t->mesh.vertex_count);
    take_bytes(in, t->normals, sizeof t->normals[0] * t->mesh.vertex_count);
    take_bytes(in, t->uvs, sizeof t->uvs[0] * t->mesh.vertex_count);
    take_bytes(in, t->triangle_colours, sizeof t->triangle_colours[0] * t->mesh.triangle_count);
    for (unsigned i = 0; i < t->mesh.triangle_count * 3U; i++) {
        t->triangles[i / 3][i % 3] = take_u8(in) % t->mesh.vertex_count;
    }
}

/* What one loop draws for all: pictures of any format within the texels, borders, a chain, alpha, fog. */
static inline void take_mixed(input *in, const scene *s, item *t)
{
    const uint8_t kind = take_u8(in);
    t->texture.wrap_u = take_u8(in) % (EL_WRAP_MIRROR + 2);
    t->texture.wrap_v = take_u8(in) % (EL_WRAP_MIRROR + 1);
    t->texture.smooth = (kind & 1) != 0;
    if ((kind & 2) != 0) {
        t->image = (el_image){.width = take_u8(in) % (TEXTURE_SIDE + 1),
                              .height = take_u8(in) % (TEXTURE_SIDE + 1),
                              .format = take_u8(in) % (EL_IMAGE_MASK + 2),
                              .has_key = (kind & 4) != 0,
                              .key = take_u8(in),
                              .pixels = s->texels,
                              .palette = s->texels,
                              .alpha = (kind & 8) != 0 ? (const uint8_t *)s->texels : NULL};
        t->texture.image = &t->image;
    }
    if ((kind & 16) != 0) {
        const uint8_t sides = take_u8(in);
        t->smaller = (el_texture){.texels = s->texels, .width_log2 = sides % 6, .height_log2 = (sides >> 4) % 6};
        t->texture.smaller = &t->smaller;
    }
    if ((kind & 32) != 0) {
        t->material.alpha = take_u8(in);
    }
    if ((kind & 64) != 0 &&
        el_fog_linear(&t->fog, &s->camera, 0x8410, (uint32_t)take_u8(in) << 12, (uint32_t)take_u8(in) << 14) == EL_OK) {
        t->material.fog = &t->fog;
    }
}

static inline void take_material(input *in, const scene *s, item *t)
{
    const uint8_t kind = take_u8(in);
    t->material = (el_material){.shading = take_u8(in) % (EL_SHADE_OVERDRAW + 2), .flags = take_u8(in)};
    take_bytes(in, t->material.colour, sizeof t->material.colour);
    if ((kind & 1) != 0) {
        const uint8_t sides = take_u8(in);
        t->texture = (el_texture){.texels = s->texels, .width_log2 = sides % 6, .height_log2 = (sides >> 4) % 6};
        t->material.texture = &t->texture;
    }
    if ((kind & 2) != 0) {
        take_bytes(in, t->light.direction_q30, sizeof t->light.direction_q30);
        t->light.ambient = take_u8(in);
        t->light.diffuse = take_u8(in);
        t->material.light = &t->light;
    }
    if ((kind & 4) != 0) {
        take_mixed(in, s, t);
    }
}

static inline void take_scene(input *in, scene *s)
{
    s->width = (uint16_t)(1 + take_u8(in) % PICTURE_SIDE);
    s->height = (uint16_t)(1 + take_u8(in) % PICTURE_SIDE);
    s->background = take_u16(in);
    const uint8_t choices = take_u8(in);
    s->uv_error_log2 = choices % 7;
    s->samples = (uint8_t)(EL_WITH_SAMPLES ? choices / 7 % 3 * 4 : 0);
    for (unsigned i = 0; i < TEXELS; i++) {
        s->texels[i] = (uint16_t)(i * 2654435761U >> 16);
    }
    take_camera(in, &s->camera);
    s->count = 1U + take_u8(in) % MAX_DRAWS;
    for (unsigned i = 0; i < s->count; i++) {
        item *const t = &s->items[i];
        const uint8_t kind = take_u8(in);
        t->pose = el_pose_identity();
        take_matrix(in, t->pose.rotation_q30);
        if ((kind & 1) != 0) {
            take_bytes(in, t->pose.position_q16, sizeof t->pose.position_q16);
        }
        if ((kind & 2) != 0) {
            t->pose.scale_q16 = take_u32(in);
        }
        take_material(in, s, t);
        take_mesh(in, t);
    }
}

#endif
