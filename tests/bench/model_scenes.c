/* Models that others made, as bench_tool/models.py has them converted into headers; EL_BENCH_MODELS says that there are
 * any. Each is seen whole, from its front's right and a little from above. */
#include "own_scenes.h"

#ifdef EL_BENCH_MODELS

#include "base/fixed.h"
#include "beetle.h"
#include "clustered/s4.h"
#include "newell.h"
#include "spot.h"
#include "suzanne.h"

/* From the upper left, a little from behind the viewer; (-2, 3, 2) / sqrt(17). */
static const el_light key_light = {.direction_q30 = {-520841137, 781261706, 520841137}, .ambient = 80, .diffuse = 190};

/* Lengths of a mesh in the world. All models are less than 32,768 units large, so their scale_log2 is below 0. */
static int32_t to_q16(const el_mesh *mesh, int64_t units)
{
    return (int32_t)(units * EL_UNIT_Q16 / ((int64_t)1 << -mesh->scale_log2));
}

/* 2.5 radii away, where its bounding sphere fills 47 of 50 degrees. */
static void look_at(const el_mesh *mesh, el_camera *camera)
{
    static const int32_t up_q16[3] = {0, EL_UNIT_Q16, 0};
    static const int32_t away_q8[3] = {384, 205, 469}; /* length 2.5 */
    int32_t middle_q16[3];
    int32_t eye_q16[3];
    for (unsigned i = 0; i < 3; i++) {
        middle_q16[i] = to_q16(mesh, mesh->centre[i]);
        eye_q16[i] = middle_q16[i] + to_q16(mesh, (int64_t)mesh->radius * away_q8[i] / 256);
    }
    *camera = (el_camera){
        .projection = EL_PERSPECTIVE,
        .fov_y = EL_DEGREES(50, 1),
        .near_q16 = (uint32_t)to_q16(mesh, mesh->radius),
        .far_q16 = (uint32_t)to_q16(mesh, (int64_t)4 * mesh->radius),
    };
    (void)el_camera_look_at(camera, eye_q16, middle_q16, up_q16); /* neither equal nor in line with `up` */
}

static el_status draw(el_renderer *renderer, const el_mesh *mesh, const el_material *material)
{
    const el_pose pose = el_pose_identity();
    return el_draw(renderer, mesh, &pose, material);
}

static void spot_camera(uint32_t frame, el_camera *camera)
{
    (void)frame;
    look_at(&spot, camera);
}

static el_status spot_draw(uint32_t frame, el_renderer *renderer)
{
    static const el_material material = {
        .shading = EL_SHADE_TEXTURED_GOURAUD, .colour = {255, 255, 255}, .texture = &spot_texture, .light = &key_light};
    (void)frame;
    return draw(renderer, &spot, &material);
}

static void suzanne_camera(uint32_t frame, el_camera *camera)
{
    (void)frame;
    look_at(&suzanne, camera);
}

static el_status suzanne_draw(uint32_t frame, el_renderer *renderer)
{
    static const el_material material = {.shading = EL_SHADE_GOURAUD, .colour = {226, 146, 74}, .light = &key_light};
    (void)frame;
    return draw(renderer, &suzanne, &material);
}

static void beetle_camera(uint32_t frame, el_camera *camera)
{
    (void)frame;
    look_at(&beetle, camera);
}

static el_status beetle_draw(uint32_t frame, el_renderer *renderer)
{
    static const el_material material = {
        .shading = EL_SHADE_FLAT, .flags = EL_MATERIAL_TWO_SIDED, .colour = {200, 60, 50}, .light = &key_light};
    (void)frame;
    return draw(renderer, &beetle, &material);
}

static void newell_camera(uint32_t frame, el_camera *camera)
{
    (void)frame;
    look_at(&newell, camera);
}

static el_status newell_draw(uint32_t frame, el_renderer *renderer)
{
    static const el_material material = {.shading = EL_SHADE_GOURAUD, .colour = {226, 146, 74}, .light = &key_light};
    (void)frame;
    return draw(renderer, &newell, &material);
}

/* S4 in the order of clusters; most of them are beside the view. */
static void s4_camera(uint32_t frame, el_camera *camera)
{
    el_scene_find("S4")->place_camera(frame, camera);
}

static el_status s4_clusters_draw(uint32_t frame, el_renderer *renderer)
{
    static const el_material material = {.shading = EL_SHADE_FLAT};
    static const struct {
        const el_mesh *mesh;
        const int32_t *offset_q16;
    } parts[] = {{&s4_a, s4_a_offset_q16}, {&s4_b, s4_b_offset_q16}, {&s4_c, s4_c_offset_q16}};
    el_status status = EL_OK;
    (void)frame;
    for (size_t i = 0; i < sizeof parts / sizeof parts[0] && status == EL_OK; i++) {
        el_pose pose = el_pose_identity();
        for (unsigned axis = 0; axis < 3; axis++) {
            pose.position_q16[axis] = parts[i].offset_q16[axis];
        }
        status = el_draw(renderer, parts[i].mesh, &pose, &material);
    }
    return status;
}

static el_status newell_whole_draw(uint32_t frame, el_renderer *renderer)
{
    static const el_material material = {.shading = EL_SHADE_GOURAUD, .colour = {226, 146, 74}, .light = &key_light};
    static el_mesh whole;
    whole = newell;
    whole.clusters = NULL;
    whole.cluster_count = 0;
    (void)frame;
    return draw(renderer, &whole, &material);
}

#define NAVY 0x10A3

const el_scene model_scenes[] = {
    {"model-spot", "textured and lit", NAVY, spot_camera, spot_draw, NULL},
    {"model-suzanne", "lit, Gouraud", NAVY, suzanne_camera, suzanne_draw, NULL},
    {"model-beetle", "an open surface, both sides, lit, flat", NAVY, beetle_camera, beetle_draw, NULL},
    {"model-teapot", "6,320 small triangles, lit, Gouraud", NAVY, newell_camera, newell_draw, NULL},
    {"model-teapot-whole", "the same without clusters", NAVY, newell_camera, newell_whole_draw, NULL},
    {"S4-clusters", "S4 in the order of clusters", 0x0000, s4_camera, s4_clusters_draw, NULL},
};
const size_t model_scene_count = sizeof model_scenes / sizeof model_scenes[0];

#else

const el_scene model_scenes[1];
const size_t model_scene_count = 0;

#endif
