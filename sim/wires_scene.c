/* Three teapots: wires on a lit surface, wires on depth alone, before a floor that is seen through them, and all wires. */
#include "wires_scene.h"

#include "demo/meshes/teapot.h"
#include "scene_units.h"

#if EL_HAS_WIRES_SCENE

enum { PAPER = 0xEF7C, TURN = 240 /* frames */ };

static const el_light light = {.direction_q30 = {-619925131, 619925131, 619925131}, .ambient = 90, .diffuse = 165};

/* Of each teapot, from the left: what is drawn first, and the wires. */
static const el_material surfaces[] = {
    {.colour = {235, 150, 60}, .light = &light},
    {.flags = EL_MATERIAL_BLEND_DEPTH, .alpha = 1},
};
static const el_material wires[] = {
    {.flags = EL_MATERIAL_WIRES, .colour = {70, 30, 0}},
    {.flags = EL_MATERIAL_WIRES, .colour = {0, 40, 120}},
    {.flags = EL_MATERIAL_WIRES | EL_MATERIAL_NO_DEPTH | EL_MATERIAL_TWO_SIDED, .colour = {0, 110, 60}},
};

/* A grid of two squares a side, whose diagonals are no edges. */
static const int16_t floor_positions[9][3] = {{-4, 0, -4}, {0, 0, -4}, {4, 0, -4}, {-4, 0, 0}, {0, 0, 0},
                                              {4, 0, 0},   {-4, 0, 4}, {0, 0, 4},  {4, 0, 4}};
static const uint16_t floor_triangles[8][3] = {{0, 3, 4}, {4, 1, 0}, {1, 4, 5}, {5, 2, 1},
                                               {3, 6, 7}, {7, 4, 3}, {4, 7, 8}, {8, 5, 4}};
static const uint8_t floor_edges[8] = {3, 3, 3, 3, 3, 3, 3, 3};
static const el_mesh floor_mesh = {.positions = floor_positions,
                                   .triangles = floor_triangles,
                                   .edges = floor_edges,
                                   .vertex_count = COUNT(floor_positions),
                                   .triangle_count = COUNT(floor_triangles),
                                   .radius = 6};
static const el_material floor_wires = {.flags = EL_MATERIAL_WIRES, .colour = {200, 30, 30}};

static void place_camera(uint32_t frame, el_camera *camera)
{
    static const int32_t up_q16[3] = {0, EL_UNIT_Q16, 0};
    static const int32_t eye_q16[3] = {0, TENTHS_Q16(36), TENTHS_Q16(76)};
    static const int32_t target_q16[3] = {0, TENTHS_Q16(5), 0};
    (void)frame;
    *camera = (el_camera){.fov_y = EL_DEGREES(31, 1), .near_q16 = TENTHS_Q16(10), .far_q16 = TENTHS_Q16(300)};
    (void)el_camera_look_at(camera, eye_q16, target_q16, up_q16);
}

static el_status draw(uint32_t frame, el_renderer *renderer)
{
    el_pose pose = el_pose_identity();
    el_status status = el_draw(renderer, &floor_mesh, &pose, &floor_wires);
    for (unsigned i = 0; i < COUNT(wires) && status == EL_OK; i++) {
        pose = el_pose_identity();
        pose.position_q16[0] = TENTHS_Q16(18) * ((int32_t)i - 1);
        pose.scale_q16 = TENTHS_Q16(4);
        el_pose_turn(&pose, EL_AXIS_Y, frame * (0xFFFFFFFFU / TURN + 1U));
        if (i < COUNT(surfaces)) {
            status = el_draw(renderer, &teapot, &pose, &surfaces[i]);
        }
        if (status == EL_OK) {
            status = el_draw(renderer, &teapot, &pose, &wires[i]);
        }
    }
    return status;
}

const el_scene el_wires_scene = {
    "wires", "a mesh's edges on a surface, on depth alone and all of them", PAPER, place_camera, draw, NULL};
#endif
