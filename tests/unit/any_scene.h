/* Seeded scenes for the renderer's tests: a few draws of random meshes, with every shading and kind of texture, some of them
 * blended, triangles that reach behind the camera, back faces, and draws without depth among those with it. */
#ifndef EL_TEST_ANY_SCENE_H
#define EL_TEST_ANY_SCENE_H

#include "edgeline.h"
#include "seeded.h"

enum { SCENE_VERTICES = 48, SCENE_TRIANGLES = 70, SCENE_MESHES = 3, SCENE_TEXELS = 64 };

typedef struct any_mesh {
    int16_t positions[SCENE_VERTICES][3];
    uint16_t triangles[SCENE_TRIANGLES][3];
    uint8_t colours[SCENE_VERTICES][3];
    int8_t normals[SCENE_VERTICES][3];
    int16_t uvs[SCENE_VERTICES][2];
    uint16_t texels[SCENE_TEXELS];
    el_texture texture;
    el_texture smaller;
    el_image image;
    uint16_t values[SCENE_TEXELS]; /* of any format */
    uint16_t palette[256];
    uint8_t shown[SCENE_TEXELS];
    el_fog fog;
    el_light light;
    el_material material;
    el_mesh mesh;
    el_pose pose;
} any_mesh;

typedef struct any_scene {
    any_mesh meshes[SCENE_MESHES];
    el_camera camera;
} any_scene;

static inline void fill_mesh(seeded *s, any_mesh *m)
{
    for (unsigned i = 0; i < SCENE_VERTICES; i++) {
        for (unsigned k = 0; k < 3; k++) {
            m->positions[i][k] = (int16_t)any_between(s, -1000, 1000);
            m->colours[i][k] = (uint8_t)any_u64(s);
            m->normals[i][k] = (int8_t)any_between(s, -73, 73);
        }
        m->uvs[i][0] = (int16_t)any_between(s, -600, 600);
        m->uvs[i][1] = (int16_t)any_between(s, -600, 600);
    }
    for (unsigned i = 0; i < SCENE_TRIANGLES * 3; i++) {
        m->triangles[i / 3][i % 3] = (uint16_t)any_below(s, SCENE_VERTICES);
    }
    for (unsigned i = 0; i < SCENE_TEXELS; i++) {
        m->texels[i] = (uint16_t)any_u64(s);
    }
    m->texture = (el_texture){.texels = m->texels, .width_log2 = 3, .height_log2 = 3};
    m->light = (el_light){.direction_q30 = {0, 759250125, 759250125}, .ambient = 60, .diffuse = 190};
    m->mesh = (el_mesh){.positions = (const int16_t(*)[3])m->positions,
                        .triangles = (const uint16_t(*)[3])m->triangles,
                        .colours = (const uint8_t(*)[3])m->colours,
                        .normals = (const int8_t(*)[3])m->normals,
                        .uvs = (const int16_t(*)[2])m->uvs,
                        .vertex_count = SCENE_VERTICES,
                        .triangle_count = SCENE_TRIANGLES,
                        .scale_log2 = -8,
                        .radius = 1733};
}

#if EL_WITH_MIXED
/* Any kind of texture; often blended, or in fog. */
static inline void mix_material(any_mesh *m, const el_camera *camera, seeded *s)
{
    m->texture.wrap_u = (uint8_t)any_below(s, 3);
    m->texture.wrap_v = (uint8_t)any_below(s, 3);
    m->texture.smooth = any_below(s, 2) == 0;
    m->image = (el_image){.width = (uint16_t)(2U * any_between(s, 1, 4)),
                          .height = (uint16_t)(2U * any_between(s, 1, 4)),
                          .format = (uint8_t)any_below(s, EL_IMAGE_MASK + 1),
                          .has_key = any_below(s, 2) == 0,
                          .key = (uint16_t)any_below(s, 2),
                          .pixels = m->values,
                          .palette = m->palette,
                          .alpha = any_below(s, 3) == 0 ? m->shown : NULL};
    for (unsigned i = 0; i < SCENE_TEXELS; i++) {
        m->shown[i] = (uint8_t)any_u64(s);
        m->values[i] = (uint16_t)any_u64(s);
    }
    for (unsigned i = 0; i < 256; i++) {
        m->palette[i] = (uint16_t)any_u64(s);
    }
    if (any_below(s, 2) == 0) {
        m->texture.image = &m->image;
#if EL_WITH_MIPMAPS
    } else if (any_below(s, 2) == 0) {
        m->smaller = (el_texture){.texels = m->texels, .width_log2 = 2, .height_log2 = 2};
        m->texture.smaller = &m->smaller;
#endif
    }
    m->material.alpha = any_below(s, 2) == 0 ? (uint8_t)any_u64(s) : 0;
    if (any_below(s, 2) == 0 && camera->projection == EL_PERSPECTIVE &&
        (m->material.flags & EL_MATERIAL_NO_DEPTH) == 0) {
        TEST_ASSERT_EQUAL_INT(EL_OK, el_fog_linear(&m->fog, camera, 0x1234, EL_UNIT_Q16, 5 * EL_UNIT_Q16));
        m->material.fog = &m->fog;
    }
}
#endif

/* A cloud of about 8 units around the origin, seen from its edge: much of it is behind the camera. */
static inline void fill_scene(seeded *s, any_scene *scene)
{
    static const int32_t up[3] = {0, EL_UNIT_Q16, 0};
    static const int32_t target[3] = {0, 0, 0};
    for (unsigned i = 0; i < SCENE_MESHES; i++) {
        any_mesh *const m = &scene->meshes[i];
        fill_mesh(s, m);
        m->material = (el_material){.shading = (uint8_t)any_below(s, EL_SHADE_OVERDRAW),
                                    .flags = (uint8_t)(any_u64(s) & 7U),
                                    .texture = &m->texture,
                                    .light = any_below(s, 2) == 0 ? &m->light : NULL};
        m->pose = el_pose_identity();
        el_pose_turn(&m->pose, EL_AXIS_Y, (el_angle)any_u64(s));
        m->pose.position_q16[0] = (int32_t)any_between(s, -EL_UNIT_Q16, EL_UNIT_Q16);
    }
    const int32_t eye[3] = {(int32_t)any_between(s, -2, 2) * EL_UNIT_Q16, (int32_t)any_between(s, -2, 2) * EL_UNIT_Q16,
                            (int32_t)any_between(s, 3, 8) * EL_UNIT_Q16};
    scene->camera = (el_camera){.projection = any_below(s, 5) == 0 ? EL_ORTHOGRAPHIC : EL_PERSPECTIVE,
                                .fov_y = EL_DEGREES(70, 1),
                                .height_q16 = 6 * EL_UNIT_Q16,
                                .near_q16 = EL_UNIT_Q16 / 4,
                                .far_q16 = (uint32_t)any_between(s, 6, 30) * EL_UNIT_Q16};
    TEST_ASSERT_EQUAL_INT(EL_OK, el_camera_look_at(&scene->camera, eye, target, up));
}

/* The same, where half of the materials are drawn by el_fill_mixed. */
static inline void fill_mixed_scene(seeded *s, any_scene *scene)
{
    fill_scene(s, scene);
#if EL_WITH_MIXED
    for (unsigned i = 0; i < SCENE_MESHES; i++) {
        if (any_below(s, 2) == 0) {
            mix_material(&scene->meshes[i], &scene->camera, s);
        }
    }
#endif
}

/* Draws the frame in as many passes as it takes. */
static inline void play_scene(el_renderer *renderer, const any_scene *scene)
{
    TEST_ASSERT_EQUAL_INT(EL_OK, el_frame_begin(renderer, &scene->camera));
    int more;
    do {
        for (unsigned i = 0; i < SCENE_MESHES; i++) {
            const any_mesh *const m = &scene->meshes[i];
            TEST_ASSERT_EQUAL_INT(EL_OK, el_draw(renderer, &m->mesh, &m->pose, &m->material));
        }
        more = el_frame_next(renderer);
        TEST_ASSERT_GREATER_OR_EQUAL_INT(0, more);
    } while (more > 0);
}

#endif
