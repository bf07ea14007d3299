#include "bench/bench_scenes.h"

#include "bench/meshes/s1.h"
#include "bench/meshes/s2.h"
#include "bench/meshes/s3.h"
#include "bench/meshes/s4.h"

/* The scenes' model_to_view, whose view has z forward: its rows are this camera's right, up and forward, and the eye
 * is where it maps to the origin. The meshes are drawn where they are. */
static void bench_camera(uint32_t frame, el_camera *camera)
{
    (void)frame;
    *camera = (el_camera){
        .axes_q30 = {{929887697, 0, 536870912},
                     {111621739, 1050277989, -193334523},
                     {525138994, -223243478, -909567419}},
        .position_q16 = {16388, -805, -67706},
        .projection = EL_PERSPECTIVE,
        .fov_y = 879750026, /* 2 * atan(120 / 160) = 73.74 degrees */
        .near_q16 = EL_UNIT_Q16 / 8,
        .far_q16 = 128 * EL_UNIT_Q16,
    };
}

/* Of the middle of S1's sphere, and of S3's triangles and S4's, along the view. */
static uint32_t s1_focus_q16(uint32_t frame)
{
    (void)frame;
    return 39 * EL_UNIT_Q16 / 4;
}

static uint32_t cloud_focus_q16(uint32_t frame)
{
    (void)frame;
    return 23 * EL_UNIT_Q16;
}

static el_status s1_draw(uint32_t frame, el_renderer *renderer)
{
    static const el_material material = {.shading = EL_SHADE_GOURAUD};
    (void)frame;
    const el_pose pose = el_pose_identity();
    return el_draw(renderer, &s1, &pose, &material);
}

static el_status s2_draw(uint32_t frame, el_renderer *renderer)
{
    static const el_material material = {.shading = EL_SHADE_TEXTURED, .texture = &s2_texture};
    (void)frame;
    const el_pose pose = el_pose_identity();
    return el_draw(renderer, &s2, &pose, &material);
}

static el_status s2_no_depth_draw(uint32_t frame, el_renderer *renderer)
{
    static const el_material material = {
        .shading = EL_SHADE_TEXTURED, .flags = EL_MATERIAL_NO_DEPTH, .texture = &s2_texture};
    (void)frame;
    const el_pose pose = el_pose_identity();
    return el_draw(renderer, &s2, &pose, &material);
}

static const el_material flat = {.shading = EL_SHADE_FLAT};

static el_status s3_draw(uint32_t frame, el_renderer *renderer)
{
    (void)frame;
    const el_pose pose = el_pose_identity();
    return el_draw(renderer, &s3, &pose, &flat);
}

static el_status draw_at(el_renderer *renderer, const el_mesh *mesh, const int32_t offset_q16[3])
{
    el_pose pose = el_pose_identity();
    for (unsigned i = 0; i < 3; i++) {
        pose.position_q16[i] = offset_q16[i];
    }
    return el_draw(renderer, mesh, &pose, &flat);
}

/* S4 is wider than 16-bit positions of its unit, so it comes in three meshes. */
static el_status s4_draw(uint32_t frame, el_renderer *renderer)
{
    (void)frame;
    const el_status a = draw_at(renderer, &s4_a, s4_a_offset_q16);
    const el_status b = draw_at(renderer, &s4_b, s4_b_offset_q16);
    const el_status c = draw_at(renderer, &s4_c, s4_c_offset_q16);
    return a != EL_OK ? a : (b != EL_OK ? b : c);
}

const el_scene el_bench_scenes[] = {
    {"S1", "sphere of 1,024 triangles, Gouraud, depth", 0x0000, bench_camera, s1_draw, s1_focus_q16},
    {"S2", "room of 12 triangles, textured, full screen, depth", 0x0000, bench_camera, s2_draw, NULL},
    {"S2-no-depth", "S2 without depth", 0x0000, bench_camera, s2_no_depth_draw, NULL},
    {"S3", "4,000 small triangles, flat, depth", 0x0000, bench_camera, s3_draw, cloud_focus_q16},
    {"S4", "4,000 triangles of which 403 are on the screen, flat, depth", 0x0000, bench_camera, s4_draw,
     cloud_focus_q16},
};
const size_t el_bench_scene_count = sizeof el_bench_scenes / sizeof el_bench_scenes[0];
