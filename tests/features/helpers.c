/* What helps to make a scene: things that look at others, move by keys, hang on each other, are there many times, face the
 * camera, and are picked. */
#include "feature.h"
#include "paint/paint_colours.h"
#include "things.h"

static const el_material gouraud = {.shading = EL_SHADE_GOURAUD};
static const el_material lit = {.shading = EL_SHADE_GOURAUD, .flags = EL_MATERIAL_TWO_SIDED, .light = &white_light};

/* --- aim -------------------------------------------------------------------------------------------------------------------- */

/* Cones around a ball, before it and behind it, that look at it. */
static el_status draw_aim(uint32_t frame, el_renderer *renderer)
{
    static const int32_t target_q16[3] = {0, 0, 0};
    static const int32_t up[3] = {0, 1, 0};
    (void)frame;
    make_things();
    const el_pose middle = at(0, 0, 0, 5);
    el_status status = el_draw(renderer, &ball, &middle, &lit);
    for (uint32_t i = 0; i < 10; i++) {
        const el_angle angle = i * (0xFFFFFFFFU / 10 + 1U);
        const int32_t x = el_sin_q30(angle) / (EL_UNIT_Q30 / 44);
        const int32_t y = el_cos_q30(angle) / (EL_UNIT_Q30 / 26);
        el_pose pose = at(x, y, (int32_t)(i % 3) * 15 - 15, 7);
        status = worse(status, el_pose_look_at(&pose, target_q16, up));
        status = worse(status, el_draw(renderer, &cone, &pose, &lit));
    }
    return status;
}

const feature feature_aim = {
    .scene = {.name = "aim", .background = NIGHT, .place_camera = place_camera, .draw = draw_aim}};

/* --- keys ------------------------------------------------------------------------------------------------------------------- */

enum { KEYS = 4, STEPS = 25, STEP_MS = 125 };

static const uint32_t times_ms[KEYS] = {0, 1000, 2000, 3000};
static const int32_t places_q16[KEYS][3] = {{TENTHS_Q16(-50), TENTHS_Q16(-6), 0},
                                            {TENTHS_Q16(-17), TENTHS_Q16(8), 0},
                                            {TENTHS_Q16(17), TENTHS_Q16(-8), 0},
                                            {TENTHS_Q16(50), TENTHS_Q16(6), 0}};
static const uint32_t scales_q16[KEYS] = {TENTHS_Q16(2), TENTHS_Q16(4), TENTHS_Q16(2), TENTHS_Q16(3)};

/* The way of a cone through four keys, which it passes by steps (above), straight and smoothly (below). */
static el_status draw_keys(uint32_t frame, el_renderer *renderer)
{
    static const int32_t about[3] = {1, 2, 0};
    el_quaternion turns[KEYS];
    (void)frame;
    make_things();
    for (uint32_t i = 0; i < KEYS; i++) {
        turns[i] = el_quaternion_about(about, i * EL_DEGREES(80, 1));
    }
    el_status status = EL_OK;
    for (int32_t between = EL_BETWEEN_STEP; between <= EL_BETWEEN_SMOOTH; between++) {
        const el_key_times keys = {times_ms, KEYS, (uint8_t)between};
        const el_animation animation = {.position = {keys, places_q16},
                                        .rotation = {keys, turns},
                                        .scale = {keys, scales_q16},
                                        .length_ms = 3000,
                                        .repeat = EL_REPEAT_PING_PONG};
        for (uint32_t step = 0; step < STEPS; step++) {
            el_pose pose = el_pose_identity();
            el_animation_pose(&animation, step * STEP_MS, &pose);
            pose.position_q16[1] += TENTHS_Q16(25) - between * TENTHS_Q16(25);
            status = worse(status, el_draw(renderer, &cone, &pose, &lit));
        }
    }
    return status;
}

const feature feature_keys = {
    .scene = {.name = "keys", .background = NIGHT, .place_camera = place_camera, .draw = draw_keys}};

/* --- hierarchy -------------------------------------------------------------------------------------------------------------- */

enum { LINKS = 5, ARMS = 3 };

/* Three arms of tubes that are bent more and more at each joint, each link smaller than the one it hangs on. */
static el_status draw_hierarchy(uint32_t frame, el_renderer *renderer)
{
    (void)frame;
    make_things();
    el_status status = EL_OK;
    for (int32_t arm = 0; arm < ARMS; arm++) {
        el_node nodes[LINKS];
        el_pose world[LINKS];
        for (int32_t i = 0; i < LINKS; i++) {
            nodes[i].parent = (int16_t)(i - 1);
            nodes[i].local = i == 0 ? at(35 * arm - 30, -28, 0, 5) : at(0, 20, 0, 8);
            el_pose_turn(&nodes[i].local, EL_AXIS_Z, (uint32_t)(ARMS - 1 - arm) * EL_DEGREES(20, 1));
            el_pose_turn(&nodes[i].local, EL_AXIS_X, (uint32_t)arm * EL_DEGREES(12, 1));
        }
        status = worse(status, el_hierarchy_update(nodes, world, LINKS));
        for (unsigned i = 0; i < LINKS; i++) {
            status = worse(status, el_draw(renderer, &tube, &world[i], &lit));
        }
    }
    return status;
}

const feature feature_hierarchy = {
    .scene = {.name = "hierarchy", .background = NIGHT, .place_camera = place_camera, .draw = draw_hierarchy}};

/* --- instances -------------------------------------------------------------------------------------------------------------- */

enum { ROWS = 6, COLUMNS = 7, CROWD = ROWS * COLUMNS };

/* A crowd that goes away: balls, then tubes, then cards, by their size on the screen. */
static el_status draw_instances(uint32_t frame, el_renderer *renderer)
{
    static const el_level levels[3] = {{&ball, 24}, {&tube, 14}, {&card, 0}};
    static el_pose poses[CROWD];
    static el_instance crowd[CROWD];
    (void)frame;
    make_things();
    for (int32_t i = 0; i < CROWD; i++) {
        const int32_t row = i / COLUMNS;
        poses[i] = at((i % COLUMNS - COLUMNS / 2) * 20, 10 * row - 25, -40 * row, 7);
        crowd[i] = (el_instance){.levels = levels, .pose = &poses[i], .material = &gouraud, .level_count = 3};
    }
    return el_instances_draw(renderer, crowd, CROWD);
}

const feature feature_instances = {
    .scene = {.name = "instances", .background = NIGHT, .place_camera = place_camera, .draw = draw_instances}};

/* --- billboards ------------------------------------------------------------------------------------------------------------- */

static void look_down(uint32_t frame, el_camera *camera)
{
    static const int32_t up_q16[3] = {0, EL_UNIT_Q16, 0};
    static const int32_t target_q16[3] = {0, 0, 0};
    static const int32_t eye_q16[3] = {TENTHS_Q16(30), TENTHS_Q16(55), TENTHS_Q16(60)};
    place_camera(frame, camera);
    (void)el_camera_look_at(camera, eye_q16, target_q16, up_q16); /* not from above */
}

/* Cards on a floor, seen from above and from the right: behind as they are, in the middle upright, before facing the camera. */
static el_status draw_billboards(uint32_t frame, el_renderer *renderer)
{
    static const int32_t up[3] = {0, 1, 0};
    static const el_texture texture = {.texels = picture, .width_log2 = 4, .height_log2 = 4};
    static const el_material board = {.shading = EL_SHADE_TEXTURED, .texture = &texture};
    static const el_material ground = {.shading = EL_SHADE_FLAT, .flags = EL_MATERIAL_FLAT_MEAN};
    el_camera camera;
    make_things();
    look_down(frame, &camera);
    const el_pose below = turned(at(0, -10, 0, 45), EL_DEGREES(270, 1), 0);
    el_status status = el_draw(renderer, &card, &below, &ground);
    for (int32_t i = 0; i < 9; i++) {
        el_pose pose = at(25 * (i % 3) - 25, 0, 25 * (i / 3) - 25, 9);
        if (i / 3 == 1) {
            status = worse(status, el_billboard_about(&pose, &camera, up));
        } else if (i / 3 == 2) {
            el_billboard_face(&pose, &camera);
        }
        status = worse(status, el_draw(renderer, &card, &pose, &board));
    }
    return status;
}

const feature feature_billboards = {
    .scene = {.name = "billboards", .background = NIGHT, .place_camera = look_down, .draw = draw_billboards}};

/* --- picking ---------------------------------------------------------------------------------------------------------------- */

enum { PICK_STEP = 16, PICKS_ACROSS = FEATURE_WIDTH / PICK_STEP, PICKS_DOWN = FEATURE_HEIGHT / PICK_STEP, PICKED = 6 };

static const uint8_t picked_colours[PICKED][3] = {{240, 60, 60},  {60, 200, 90},   {70, 110, 250},
                                                  {240, 220, 60}, {220, 100, 220}, {80, 220, 230}};
static el_picked picks[PICKS_DOWN][PICKS_ACROSS];
static bool is_picked[PICKS_DOWN][PICKS_ACROSS];

static const el_mesh *picked_thing(unsigned number, el_pose *pose, el_material *material, el_mesh *bare)
{
    const int32_t x = 16 * (int32_t)number - 40;
    *pose = turned(at(x, number % 2 == 0 ? 8 : -8, -6 * (int32_t)number, 17), EL_DEGREES(40, 1) * number, 0);
    *material = (el_material){.flags = EL_MATERIAL_TWO_SIDED};
    for (unsigned i = 0; i < 3; i++) {
        material->colour[i] = picked_colours[number][i];
    }
    *bare = *(number % 3 == 0 ? &ball : number % 3 == 1 ? &tube : &cone);
    bare->colours = NULL;
    return bare;
}

static el_status pick_at(uint32_t column, uint32_t row, const el_mesh meshes[], const el_pose poses[],
                         const el_material materials[])
{
    static _Alignas(8) uint8_t memory[EL_PICK_BYTES(FEATURE_WIDTH, FEATURE_HEIGHT) + 4000];
    static el_pick pick;
    el_camera camera;
    place_camera(0, &camera);
    el_status status =
        el_pick_begin(&pick, &camera, FEATURE_WIDTH, FEATURE_HEIGHT, (uint16_t)(column * PICK_STEP + PICK_STEP / 2),
                      (uint16_t)(row * PICK_STEP + PICK_STEP / 2), memory, sizeof memory);
    for (unsigned i = 0; i < PICKED; i++) {
        status = worse(status, el_pick_draw(&pick, &meshes[i], &poses[i], &materials[i]));
    }
    is_picked[row][column] = el_pick_end(&pick, &picks[row][column]) > 0;
    return status;
}

/* Things of one colour each, and what is picked at points of a grid: a frame around a square in the colour of the draw call,
 * which should be the colour around it, upon one that comes from the triangle's number. */
static el_status draw_picking(uint32_t frame, el_renderer *renderer)
{
    static el_pose poses[PICKED];
    static el_material materials[PICKED];
    static el_mesh meshes[PICKED];
    (void)frame;
    make_things();
    el_status status = EL_OK;
    for (unsigned i = 0; i < PICKED; i++) {
        (void)picked_thing(i, &poses[i], &materials[i], &meshes[i]);
        status = worse(status, el_draw(renderer, &meshes[i], &poses[i], &materials[i]));
    }
    for (uint32_t i = 0; i < PICKS_ACROSS * PICKS_DOWN; i++) {
        status = worse(status, pick_at(i % PICKS_ACROSS, i / PICKS_ACROSS, meshes, poses, materials));
    }
    return status;
}

static void draw_picks(void *context, el_band *band)
{
    const el_canvas canvas = el_canvas_of(band);
    (void)context;
    for (int32_t i = 0; i < PICKS_ACROSS * PICKS_DOWN; i++) {
        const el_picked *const picked = &picks[i / PICKS_ACROSS][i % PICKS_ACROSS];
        const int32_t x = i % PICKS_ACROSS * PICK_STEP + PICK_STEP / 2;
        const int32_t y = i / PICKS_ACROSS * PICK_STEP + PICK_STEP / 2;
        if (is_picked[i / PICKS_ACROSS][i % PICKS_ACROSS]) {
            const uint8_t *const of = picked_colours[picked->draw];
            el_canvas_fill(&canvas, (el_rect){x - 4, y - 4, x + 4, y + 4},
                           el_solid((uint16_t)(picked->triangle * 509)));
            el_canvas_fill(&canvas, (el_rect){x - 2, y - 2, x + 2, y + 2}, el_solid(el_rgb565(of[0], of[1], of[2])));
        } else {
            el_canvas_fill(&canvas, (el_rect){x - 1, y - 1, x + 1, y + 1}, el_solid(GREY));
        }
    }
}

const feature feature_picking = {
    .scene = {.name = "picking", .background = BLACK, .place_camera = place_camera, .draw = draw_picking},
    .over = {.draw = draw_picks}};
