#include "demo/demo_scenes.h"

#include "base/fixed.h"
#include "demo/meshes/field.h"
#include "demo/meshes/room.h"
#include "demo/meshes/solid.h"
#include "demo/meshes/teapot.h"
#include "scene_units.h"

/* A turn in `frames` frames. */
#define TURN_IN(frames) (0xFFFFFFFFU / (frames) + 1U)

enum { DEMO_PART_FRAMES = 30 };

/* From the upper left, a little from behind the viewer; (-2, 3, 2) / sqrt(17). */
static const el_light key_light = {.direction_q30 = {-520841137, 781261706, 520841137}, .ambient = 80, .diffuse = 190};

static const int32_t up_q16[3] = {0, EL_UNIT_Q16, 0};

static void perspective(el_camera *camera, el_angle fov_y, uint32_t near_q16, uint32_t far_q16)
{
    camera->projection = EL_PERSPECTIVE;
    camera->fov_y = fov_y;
    camera->near_q16 = near_q16;
    camera->far_q16 = far_q16;
}

static int32_t scale_q16(int32_t length_q16, int32_t factor_q30)
{
    return (int32_t)(((int64_t)length_q16 * factor_q30) >> 30);
}

/* Looks at `target` from `distance` away and `height` above it, at `angle` around it. */
static void orbit(el_camera *camera, const int32_t target_q16[3], int32_t distance_q16, int32_t height_q16,
                  el_angle angle)
{
    const int32_t eye_q16[3] = {
        target_q16[0] + scale_q16(distance_q16, el_sin_q30(angle)),
        target_q16[1] + height_q16,
        target_q16[2] + scale_q16(distance_q16, el_cos_q30(angle)),
    };
    (void)el_camera_look_at(camera, eye_q16, target_q16, up_q16); /* never straight above the target */
}

static void teapot_camera(uint32_t frame, el_camera *camera)
{
    static const int32_t middle_q16[3] = {0, 0, 0};
    (void)frame;
    perspective(camera, EL_DEGREES(40, 1), TENTHS_Q16(10), TENTHS_Q16(200));
    orbit(camera, middle_q16, TENTHS_Q16(68), TENTHS_Q16(34), 0);
}

static el_status teapot_draw(uint32_t frame, el_renderer *renderer)
{
    static const el_material material = {.shading = EL_SHADE_GOURAUD, .colour = {226, 146, 74}, .light = &key_light};
    el_pose pose = el_pose_identity();
    el_pose_turn(&pose, EL_AXIS_Y, frame * TURN_IN(120));
    return el_draw(renderer, &teapot, &pose, &material);
}

/* A walk through both rooms: a figure of eight through the doorway in the middle. */
static void walk_at(el_angle angle, int32_t position_q16[3])
{
    position_q16[0] = scale_q16(TENTHS_Q16(14), el_sin_q30(angle * 2));
    position_q16[1] = TENTHS_Q16(14);
    position_q16[2] = scale_q16(TENTHS_Q16(34), el_sin_q30(angle));
}

static void look_at(uint32_t frame, int32_t eye_q16[3], int32_t target_q16[3])
{
    const el_angle angle = frame * TURN_IN(240) + EL_DEGREES(10, 1);
    walk_at(angle, eye_q16);
    walk_at(angle + EL_DEGREES(18, 1), target_q16);
}

static void room_camera(uint32_t frame, el_camera *camera)
{
    int32_t eye_q16[3];
    int32_t target_q16[3];
    look_at(frame, eye_q16, target_q16);
    perspective(camera, EL_DEGREES(65, 1), TENTHS_Q16(1), TENTHS_Q16(200));
    (void)el_camera_look_at(camera, eye_q16, target_q16, up_q16);
}

/* The walk turns about what it looks at. */
static uint32_t room_focus_q16(uint32_t frame)
{
    int32_t eye_q16[3];
    int32_t target_q16[3];
    uint64_t square_q32 = 0;
    look_at(frame, eye_q16, target_q16);
    for (unsigned i = 0; i < 3; i++) {
        const int64_t difference_q16 = (int64_t)target_q16[i] - eye_q16[i]; /* within 10 units */
        square_q32 += (uint64_t)(difference_q16 * difference_q16);
    }
    return el_sqrt_u64(square_q32);
}

static el_status room_draw(uint32_t frame, el_renderer *renderer)
{
    static const el_material material = {.shading = EL_SHADE_TEXTURED, .texture = &room_texture};
    (void)frame;
    const el_pose pose = el_pose_identity();
    return el_draw(renderer, &room, &pose, &material);
}

static void solid_camera(uint32_t frame, el_camera *camera)
{
    static const int32_t middle_q16[3] = {0, 0, 0};
    (void)frame;
    perspective(camera, EL_DEGREES(40, 1), TENTHS_Q16(10), TENTHS_Q16(100));
    orbit(camera, middle_q16, TENTHS_Q16(32), 0, 0);
}

static el_status solid_draw(uint32_t frame, el_renderer *renderer)
{
    static const el_material material = {.shading = EL_SHADE_FLAT, .light = &key_light};
    el_pose pose = el_pose_identity();
    el_pose_turn(&pose, EL_AXIS_X, EL_DEGREES(25, 1));
    el_pose_turn(&pose, EL_AXIS_Y, frame * TURN_IN(120));
    el_pose_turn(&pose, EL_AXIS_Z, frame * TURN_IN(300));
    return el_draw(renderer, &solid, &pose, &material);
}

static void field_camera(uint32_t frame, el_camera *camera)
{
    static const int32_t middle_q16[3] = {0, TENTHS_Q16(3), 0};
    perspective(camera, EL_DEGREES(50, 1), TENTHS_Q16(5), TENTHS_Q16(300));
    orbit(camera, middle_q16, TENTHS_Q16(96), TENTHS_Q16(56), frame * TURN_IN(240));
}

static el_status field_draw(uint32_t frame, el_renderer *renderer)
{
    static const el_material material = {.shading = EL_SHADE_FLAT, .flags = EL_MATERIAL_FLAT_MEAN, .light = &key_light};
    (void)frame;
    const el_pose pose = el_pose_identity();
    return el_draw(renderer, &field, &pose, &material);
}

#define NAVY 0x10A3
#define SKY 0x7DDD

const el_scene el_teapot_scene = {"teapot", "Newell's teapot, lit, Gouraud-shaded", NAVY, teapot_camera, teapot_draw,
                                  NULL};
const el_scene el_room_scene = {"room",        "two textured rooms to walk through", 0, room_camera, room_draw,
                                room_focus_q16};
const el_scene el_solid_scene = {
    "solid", "a truncated icosahedron, one colour per face", NAVY, solid_camera, solid_draw, NULL};
const el_scene el_field_scene = {"field", "an island of 2,592 small flat triangles", SKY, field_camera, field_draw,
                                 NULL};

/* The demo proper: a part of each of the scenes above, one after the other, each from where it stopped. */
static const el_scene *const parts[] = {&el_teapot_scene, &el_room_scene, &el_solid_scene, &el_field_scene};
enum { DEMO_PARTS = sizeof parts / sizeof parts[0] };

static const el_scene *part_of(uint32_t frame)
{
    return parts[frame / DEMO_PART_FRAMES % DEMO_PARTS];
}

static uint32_t part_frame(uint32_t frame)
{
    return frame / (DEMO_PART_FRAMES * DEMO_PARTS) * DEMO_PART_FRAMES + frame % DEMO_PART_FRAMES;
}

static void demo_camera(uint32_t frame, el_camera *camera)
{
    part_of(frame)->place_camera(part_frame(frame), camera);
}

static el_status demo_draw(uint32_t frame, el_renderer *renderer)
{
    return part_of(frame)->draw(part_frame(frame), renderer);
}

static uint32_t demo_focus_q16(uint32_t frame)
{
    const el_scene *const part = part_of(frame);
    return part->focus_q16 != NULL ? part->focus_q16(part_frame(frame)) : 0;
}

static const el_scene demo = {
    "demo", "all of the following in turn, 30 frames each", NAVY, demo_camera, demo_draw, demo_focus_q16};

const el_scene *const el_demo_scenes[] = {&demo, &el_teapot_scene, &el_room_scene, &el_solid_scene, &el_field_scene};
const size_t el_demo_scene_count = sizeof el_demo_scenes / sizeof el_demo_scenes[0];
_Static_assert(sizeof el_demo_scenes / sizeof el_demo_scenes[0] == 1 + DEMO_PARTS, "the demo shows every scene");
