/* What the scene's helpers cost: each function once, on numbers of no special kind.
 *
 * One line per measurement, with the CRC of what it made:
 *
 *     NAME crc CRC
 */
#include "base/crc32.h"
#include "bench/meshes/s1.h"
#include "edgeline.h"
#include "platform.h"
#include "scene.h"

enum { WIDTH = 320, HEIGHT = 240, NODES = 16 };

typedef struct things {
    el_quaternion a, b, made;
    el_camera camera;
    el_view view;
    el_pose pose;
    el_node nodes[NODES];
    el_pose world[NODES];
    el_orbit_camera orbit;
    uint32_t number;
    el_picked picked;
} things;

static things all;
static uint8_t pick_memory[EL_PICK_BYTES(WIDTH, HEIGHT) + 60000];

static const int32_t axis[3] = {3, -5, 11};
static const int32_t point_q16[3] = {123456, -234567, 345678};
static const uint32_t at_ms[4] = {0, 500, 1300, 2000};
static const int32_t places_q16[4][3] = {{0, 0, 0}, {65536, 7, 99999}, {-5, 65536, 0}, {1, 2, 3}};
static const el_quaternion turns[4] = {
    {{1073741824, 0, 0, 0}}, {{992008094, 0, 0, 410903207}}, {{759250125, 0, 759250125, 0}}, {{0, 1073741824, 0, 0}}};

static void about(void)
{
    all.made = el_quaternion_about(axis, 0x12345678U);
}

static void multiply(void)
{
    all.made = el_quaternion_multiply(&all.a, &all.b);
}

static void to_rotation(void)
{
    el_quaternion_to_rotation(&all.b, all.pose.rotation_q30);
}

static void from_rotation(void)
{
    all.made = el_quaternion_from_rotation((const int32_t(*)[3])all.pose.rotation_q30);
}

static void slerp(void)
{
    all.made = el_quaternion_slerp(&all.a, &all.b, 0x12345678U);
}

static void camera_look_at(void)
{
    (void)el_camera_look_at(&all.camera, point_q16, places_q16[1], axis);
}

static void pose_look_at(void)
{
    (void)el_pose_look_at(&all.pose, point_q16, axis);
}

static void billboard_about(void)
{
    (void)el_billboard_about(&all.pose, &all.camera, axis);
}

static void orbit(void)
{
    el_orbit_camera_turn(&all.orbit, 0x1234567, 0x765432);
    el_orbit_camera_place(&all.orbit, &all.camera);
}

static void position_linear(void)
{
    const el_position_track track = {.keys = {.at_ms = at_ms, .count = 4, .between = EL_BETWEEN_LINEAR},
                                     .values_q16 = places_q16};
    el_position_at(&track, 777, all.pose.position_q16);
}

static void position_smooth(void)
{
    const el_position_track track = {.keys = {.at_ms = at_ms, .count = 4, .between = EL_BETWEEN_SMOOTH},
                                     .values_q16 = places_q16};
    el_position_at(&track, 777, all.pose.position_q16);
}

static void rotation_smooth(void)
{
    const el_rotation_track track = {.keys = {.at_ms = at_ms, .count = 4, .between = EL_BETWEEN_SMOOTH},
                                     .values = turns};
    all.made = el_rotation_at(&track, 777);
}

static void hierarchy(void)
{
    (void)el_hierarchy_update(all.nodes, all.world, NODES);
}

static void screen_size(void)
{
    all.number = el_screen_size_q4(&all.view, &s1, &all.pose);
}

static void pick_in(size_t bytes)
{
    const el_scene *const scene = el_scene_find("S1");
    const el_pose pose = el_pose_identity();
    const el_material material = {.shading = EL_SHADE_GOURAUD};
    el_camera camera = {0};
    el_pick pick;
    scene->place_camera(0, &camera);
    (void)el_pick_begin(&pick, &camera, WIDTH, HEIGHT, WIDTH / 2, HEIGHT / 2, pick_memory, bytes);
    (void)el_pick_draw(&pick, &s1, &pose, &material);
    (void)el_pick_end(&pick, &all.picked);
}

static void pick_least(void)
{
    pick_in(EL_PICK_BYTES(WIDTH, HEIGHT));
}

static void pick_more(void)
{
    pick_in(sizeof pick_memory);
}

static void make_things(void)
{
    const el_scene *const scene = el_scene_find("S1");
    all.a = el_quaternion_about(point_q16, 0x23456789U);
    all.b = el_quaternion_about(axis, 0x89ABCDEFU);
    all.pose = el_pose_identity();
    all.orbit = el_orbit_camera_at(point_q16, 5 * EL_UNIT_Q16);
    scene->place_camera(0, &all.camera);
    (void)el_view_make(&all.view, &all.camera, WIDTH, HEIGHT);
    for (int16_t i = 0; i < NODES; i++) {
        all.nodes[i] = (el_node){.parent = (int16_t)(i - 1), .local = el_pose_identity()};
        el_quaternion_to_rotation(&all.a, all.nodes[i].local.rotation_q30);
        all.nodes[i].local.position_q16[0] = point_q16[0];
    }
}

int bench_main(void)
{
    static const struct {
        const char *name;
        void (*function)(void);
    } helpers[] = {
        {"el_quaternion_about", about},
        {"el_quaternion_multiply", multiply},
        {"el_quaternion_to_rotation", to_rotation},
        {"el_quaternion_from_rotation", from_rotation},
        {"el_quaternion_slerp", slerp},
        {"el_camera_look_at", camera_look_at},
        {"el_pose_look_at", pose_look_at},
        {"el_billboard_about", billboard_about},
        {"el_orbit_camera_place", orbit},
        {"el_position_at,linear", position_linear},
        {"el_position_at,smooth", position_smooth},
        {"el_rotation_at,smooth", rotation_smooth},
        {"el_hierarchy_update,16_nodes", hierarchy},
        {"el_screen_size_q4", screen_size},
        {"el_pick,S1,3_KB", pick_least},
        {"el_pick,S1,63_KB", pick_more},
    };

    /* What a pair of markers costs by itself. */
    bench_next();
    bench_start();
    bench_stop();
    bench_print("empty crc 00000000\n");

    make_things();
    for (size_t i = 0; i < sizeof helpers / sizeof helpers[0]; i++) {
        bench_next();
        bench_start();
        helpers[i].function();
        bench_stop();
        /* Members apart: there are gaps between them. */
        uint32_t crc = el_crc32(0, &all.made, sizeof all.made);
        crc = el_crc32(crc, all.camera.axes_q30, sizeof all.camera.axes_q30);
        crc = el_crc32(crc, all.camera.position_q16, sizeof all.camera.position_q16);
        crc = el_crc32(crc, &all.pose, sizeof all.pose);
        crc = el_crc32(crc, all.world, sizeof all.world);
        crc = el_crc32(crc, &all.number, sizeof all.number);
        crc = el_crc32(crc, &all.picked.triangle, sizeof all.picked.triangle);
        bench_print(helpers[i].name);
        bench_print(" crc ");
        bench_print_hex(crc);
        bench_print("\n");
    }
    return 0;
}
