/* growth_scenes.h. Meshes lie one after the other in the arrays; `whole` is all that is in them. */
#include "growth_scenes.h"

enum {
    MOST_TRIANGLES = 50000,
    MOST_VERTICES = 26000, /* of 500 spheres of 52; one of 50,000 triangles has 25,002 */
    BOARD_COLUMNS = 4,
    BOARD_ROWS = 3,
    BOARD_VERTICES = (BOARD_COLUMNS + 1) * (BOARD_ROWS + 1),
    BOARD_TRIANGLES = 2 * BOARD_COLUMNS * BOARD_ROWS,
    SMALL_RINGS = 6,
    SMALL_SEGMENTS = 10,
    SMALL_VERTICES = (SMALL_RINGS - 1) * SMALL_SEGMENTS + 2,
    TEXTURE_LOG2 = 6,
    NEAREST_LAYER = 4 /* units from the camera; the next are one unit apart */
};

static int16_t positions[MOST_VERTICES][3];
static uint16_t triangles[MOST_TRIANGLES][3];
static uint8_t triangle_colours[MOST_TRIANGLES][3];
static uint8_t colours[BOARD_VERTICES][3];
static int16_t uvs[BOARD_VERTICES][2];
static uint16_t texels[1 << (2 * TEXTURE_LOG2)];

static el_mesh whole;                   /* all that is in the arrays */
static el_mesh spheres[GROWTH_SPHERES]; /* one for each part of them */
static el_mesh behind;                  /* many parts */
static el_material layers[GROWTH_LAYERS];

static const el_texture texture = {.texels = texels, .width_log2 = TEXTURE_LOG2, .height_log2 = TEXTURE_LOG2};

static void set_3(int16_t v[3], int32_t x, int32_t y, int32_t z)
{
    v[0] = (int16_t)x;
    v[1] = (int16_t)y;
    v[2] = (int16_t)z;
}

/* |value| <= 2^15, so the product stays below 2^46. */
static int32_t times_q30(int32_t value, int32_t factor_q30)
{
    return (int32_t)(((int64_t)value * factor_q30) / EL_UNIT_Q30);
}

static void add_triangle(uint32_t first, uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t at = whole.triangle_count++;
    const uint32_t corners[3] = {a, b, c};
    for (unsigned i = 0; i < 3; i++) {
        triangles[at][i] = (uint16_t)(first + corners[i]);
        triangle_colours[at][i] = (uint8_t)(64 + at * (37 + 20 * i) % 192);
    }
}

/* `rings` strips from the upper to the lower pole in `segments` parts each: 2 * segments * (rings - 1) triangles. */
static void add_sphere(uint32_t rings, uint32_t segments, const int32_t centre[3], int32_t radius)
{
    const uint32_t first = whole.vertex_count;
    const uint32_t last = (rings - 1) * segments + 1;
    int16_t(*const at)[3] = positions + first;
    set_3(at[0], centre[0], centre[1] + radius, centre[2]);
    set_3(at[last], centre[0], centre[1] - radius, centre[2]);
    for (uint32_t ring = 1; ring < rings; ring++) {
        const el_angle down = (el_angle)(((uint64_t)ring << 31) / rings);
        const int32_t height = times_q30(radius, el_cos_q30(down));
        const int32_t around = times_q30(radius, el_sin_q30(down));
        for (uint32_t i = 0; i < segments; i++) {
            const el_angle turn = (el_angle)(((uint64_t)i << 32) / segments);
            set_3(at[1 + (ring - 1) * segments + i], centre[0] + times_q30(around, el_sin_q30(turn)),
                  centre[1] + height, centre[2] + times_q30(around, el_cos_q30(turn)));
        }
    }
    whole.vertex_count = (uint16_t)(first + last + 1);
    for (uint32_t ring = 0; ring < rings; ring++) {
        for (uint32_t i = 0; i < segments; i++) {
            const uint32_t next = (i + 1) % segments;
            const uint32_t upper = 1 + (ring - 1) * segments; /* ring 0 has the pole in its place */
            const uint32_t lower = 1 + ring * segments;
            if (ring == 0) {
                add_triangle(first, 0, lower + i, lower + next);
            } else if (ring == rings - 1) {
                add_triangle(first, upper + i, last, upper + next);
            } else {
                add_triangle(first, upper + i, lower + i, lower + next);
                add_triangle(first, upper + i, lower + next, upper + next);
            }
        }
    }
}

static void begin_mesh(int8_t scale_log2, uint16_t radius)
{
    whole = (el_mesh){
        .positions = (const int16_t(*)[3])positions,
        .triangles = (const uint16_t(*)[3])triangles,
        .triangle_colours = (const uint8_t(*)[3])triangle_colours,
        .scale_log2 = scale_log2,
        .radius = radius,
    };
}

/* The one camera: at the origin, 160 px to the unit at distance 1. */
static void look_ahead(uint32_t frame, el_camera *camera)
{
    (void)frame;
    *camera = (el_camera){
        .axes_q30 = {{EL_UNIT_Q30, 0, 0}, {0, EL_UNIT_Q30, 0}, {0, 0, EL_UNIT_Q30}},
        .projection = EL_PERSPECTIVE,
        .fov_y = 879750026, /* 2 * atan(120 / 160) */
        .near_q16 = EL_UNIT_Q16 / 8,
        .far_q16 = 128 * EL_UNIT_Q16,
    };
}

/* A sphere of many triangles. */

typedef struct division {
    uint16_t rings;
    uint16_t segments;
} division;

const uint32_t growth_sphere_sizes[] = {100, 300, 1000, 3000, 10000, 20000, 30000, 40000, 50000};
static const division sphere_divisions[] = {{6, 10},    {11, 15},   {21, 25},   {31, 50},  {51, 100},
                                            {101, 100}, {101, 150}, {101, 200}, {126, 200}};
const size_t growth_sphere_size_count = sizeof growth_sphere_sizes / sizeof growth_sphere_sizes[0];

static void make_sphere(uint32_t frame)
{
    static const int32_t origin[3] = {0, 0, 0};
    enum { RADIUS = 8192 };
    begin_mesh(-13, RADIUS + 2);
    for (size_t i = 0; i < growth_sphere_size_count; i++) {
        if (growth_sphere_sizes[i] == frame) {
            add_sphere(sphere_divisions[i].rings, sphere_divisions[i].segments, origin, RADIUS);
        }
    }
}

static el_status sphere_draw(uint32_t frame, el_renderer *renderer)
{
    static const el_material material = {.shading = EL_SHADE_FLAT};
    (void)frame;
    el_pose pose = el_pose_identity();
    el_pose_turn(&pose, EL_AXIS_X, EL_DEGREES(50, 1));
    pose.position_q16[2] = -EL_UNIT_Q16 * 189 / 100; /* 160 / sqrt(1.89^2 - 1) = 100 px */
    return el_draw(renderer, &whole, &pose, &material);
}

const growth_scene growth_sphere = {{"sphere", "a sphere of many triangles", 0, look_ahead, sphere_draw, NULL},
                                    make_sphere};

/* A board, and layers of them. */

static void make_board(uint32_t frame)
{
    (void)frame;
    begin_mesh(-10, 5121);
    for (int32_t i = 0; i < BOARD_VERTICES; i++) {
        const int32_t column = i % (BOARD_COLUMNS + 1);
        const int32_t row = i / (BOARD_COLUMNS + 1);
        set_3(positions[i], (column - 2) * 2048, (3 - 2 * row) * 1024, 0);
        uvs[i][0] = (int16_t)(column * 64 * 16);
        uvs[i][1] = (int16_t)(row * 64 * 16);
        colours[i][0] = (uint8_t)(column * 60);
        colours[i][1] = (uint8_t)(row * 80);
        colours[i][2] = 128;
    }
    whole.vertex_count = BOARD_VERTICES;
    for (uint32_t cell = 0; cell < BOARD_COLUMNS * BOARD_ROWS; cell++) {
        const uint32_t corner = cell / BOARD_COLUMNS * (BOARD_COLUMNS + 1) + cell % BOARD_COLUMNS;
        const uint32_t below = corner + BOARD_COLUMNS + 1;
        add_triangle(0, corner, below, below + 1);
        add_triangle(0, corner, below + 1, corner + 1);
    }
    whole.triangle_colours = NULL;
    whole.colours = (const uint8_t(*)[3])colours;
    whole.uvs = (const int16_t(*)[2])uvs;
    for (uint32_t i = 0; i < sizeof texels / sizeof texels[0]; i++) {
        texels[i] = (uint16_t)(i * 40503U >> 3);
    }
}

static el_pose board_pose(int32_t distance_q16)
{
    el_pose pose = el_pose_identity();
    el_pose_turn(&pose, EL_AXIS_Y, EL_DEGREES(20, 1));
    pose.position_q16[2] = -distance_q16;
    return pose;
}

static el_status board_draw(uint32_t frame, el_renderer *renderer, const el_material *material)
{
    const el_pose pose = board_pose((int32_t)frame * (EL_UNIT_Q16 / 16));
    return el_draw(renderer, &whole, &pose, material);
}

static el_status board_draw_flat(uint32_t frame, el_renderer *renderer)
{
    static const el_material material = {.shading = EL_SHADE_FLAT};
    return board_draw(frame, renderer, &material);
}

static el_status board_draw_gouraud(uint32_t frame, el_renderer *renderer)
{
    static const el_material material = {.shading = EL_SHADE_GOURAUD};
    return board_draw(frame, renderer, &material);
}

static el_status board_draw_textured(uint32_t frame, el_renderer *renderer)
{
    static const el_material material = {.shading = EL_SHADE_TEXTURED, .texture = &texture};
    return board_draw(frame, renderer, &material);
}

const growth_scene growth_board_flat = {{"flat", "a board, flat", 0, look_ahead, board_draw_flat, NULL}, make_board};
const growth_scene growth_board_gouraud = {{"Gouraud", "a board, Gouraud", 0, look_ahead, board_draw_gouraud, NULL},
                                           make_board};
const growth_scene growth_board_textured = {{"textured", "a board, textured", 0, look_ahead, board_draw_textured, NULL},
                                            make_board};

/* Layer 0 is the nearest one. Each is as much larger as it is farther than 2 units, where a board covers the screen. */
static el_status layer_draw(uint32_t layer, el_renderer *renderer)
{
    el_pose pose = board_pose((int32_t)(NEAREST_LAYER + layer) * EL_UNIT_Q16);
    pose.scale_q16 = (NEAREST_LAYER + layer) * (EL_UNIT_Q16 / 2);
    return el_draw(renderer, &whole, &pose, &layers[layer]);
}

static void make_layers(uint32_t frame, uint8_t shading)
{
    make_board(frame);
    whole.colours = NULL; /* each layer has one colour, so that it shows which one is seen */
    for (uint32_t i = 0; i < frame; i++) {
        const uint8_t bright = (uint8_t)(255 - 15 * i);
        layers[i] = (el_material){.shading = shading, .colour = {bright, bright, 64}, .texture = &texture};
    }
}

static void make_layers_flat(uint32_t frame)
{
    make_layers(frame, EL_SHADE_FLAT);
}

static void make_layers_textured(uint32_t frame)
{
    make_layers(frame, EL_SHADE_TEXTURED);
}

static el_status layers_draw_back_to_front(uint32_t frame, el_renderer *renderer)
{
    el_status status = EL_OK;
    for (uint32_t i = frame; i-- > 0 && status == EL_OK;) {
        status = layer_draw(i, renderer);
    }
    return status;
}

static el_status layers_draw_front_to_back(uint32_t frame, el_renderer *renderer)
{
    el_status status = EL_OK;
    for (uint32_t i = 0; i < frame && status == EL_OK; i++) {
        status = layer_draw(i, renderer);
    }
    return status;
}

const growth_scene growth_layers_back_to_front = {
    {"flat-back-to-front", "layers, the farthest first", 0, look_ahead, layers_draw_back_to_front, NULL},
    make_layers_flat};
const growth_scene growth_layers_front_to_back = {
    {"flat-front-to-back", "layers, the nearest first", 0, look_ahead, layers_draw_front_to_back, NULL},
    make_layers_flat};
const growth_scene growth_layers_back_to_front_textured = {
    {"textured-back-to-front", "textured layers, the farthest first", 0, look_ahead, layers_draw_back_to_front, NULL},
    make_layers_textured};
const growth_scene growth_layers_front_to_back_textured = {
    {"textured-front-to-back", "textured layers, the nearest first", 0, look_ahead, layers_draw_front_to_back, NULL},
    make_layers_textured};

/* Spheres of which few are in the view. Positions are in 1/256 unit. */

static void place_sphere(uint32_t index, int32_t centre[3])
{
    static const int16_t seen[GROWTH_SPHERES_SEEN][3] = {
        {0, 0, -1024}, {-512, 256, -1024}, {512, 256, -1024}, {-512, -256, -1024}, {512, -256, -1024}};
    /* Left, right, above, below, behind: in quarters of a distance of 10 to 108 units. */
    static const int8_t aside[5][3] = {{-4, 0, -1}, {4, 0, -1}, {0, 4, -1}, {0, -4, -1}, {0, 0, 4}};
    const int32_t distance_q2 = (10 + (int32_t)((index - GROWTH_SPHERES_SEEN) / 5)) * 64;
    for (unsigned i = 0; i < 3; i++) {
        centre[i] = index < GROWTH_SPHERES_SEEN ? seen[index][i] : aside[index % 5][i] * distance_q2;
    }
}

/* Adds a sphere to the arrays, and makes `part` a mesh of it alone, with the first sphere's indices and colours. */
static void add_small_sphere(const int32_t centre[3], el_mesh *part)
{
    enum { RADIUS = 230 };
    *part = whole;
    part->positions += whole.vertex_count;
    part->vertex_count = SMALL_VERTICES;
    part->triangle_count = GROWTH_SPHERE_TRIANGLES;
    part->radius = RADIUS + 2;
    set_3(part->centre, centre[0], centre[1], centre[2]);
    add_sphere(SMALL_RINGS, SMALL_SEGMENTS, centre, RADIUS);
}

static void make_spheres(uint32_t frame)
{
    begin_mesh(-8, INT16_MAX);
    for (uint32_t i = 0; i < frame; i++) {
        int32_t centre[3];
        place_sphere(i, centre);
        add_small_sphere(centre, &spheres[i]);
    }
}

/* The spheres outside first: they are one mesh, `behind`; those in the view are meshes of their own. */
static void make_spheres_behind(uint32_t frame)
{
    enum { FROM = 10 * 256, TO = 108 * 256 };
    begin_mesh(-8, (TO - FROM) / 2 + 256);
    for (uint32_t i = GROWTH_SPHERES_SEEN; i < frame; i++) {
        const int32_t centre[3] = {0, 0, FROM + (int32_t)(i - GROWTH_SPHERES_SEEN) * 50};
        add_small_sphere(centre, &spheres[i]);
    }
    behind = whole;
    behind.centre[2] = (FROM + TO) / 2;
    for (uint32_t i = 0; i < GROWTH_SPHERES_SEEN; i++) {
        int32_t centre[3];
        place_sphere(i, centre);
        add_small_sphere(centre, &spheres[i]);
    }
}

static const el_material sphere_material = {.shading = EL_SHADE_FLAT};

static el_status outside_draw_meshes(uint32_t frame, el_renderer *renderer)
{
    const el_pose pose = el_pose_identity();
    el_status status = EL_OK;
    for (uint32_t i = 0; i < frame && status == EL_OK; i++) {
        status = el_draw(renderer, &spheres[i], &pose, &sphere_material);
    }
    return status;
}

static el_status outside_draw_behind(uint32_t frame, el_renderer *renderer)
{
    (void)frame;
    const el_pose pose = el_pose_identity();
    const el_status status = el_draw(renderer, &behind, &pose, &sphere_material);
    return status != EL_OK ? status : outside_draw_meshes(GROWTH_SPHERES_SEEN, renderer);
}

static el_status outside_draw_mesh(uint32_t frame, el_renderer *renderer)
{
    (void)frame;
    const el_pose pose = el_pose_identity();
    return el_draw(renderer, &whole, &pose, &sphere_material);
}

const growth_scene growth_outside_meshes = {
    {"many-meshes", "spheres, few of them in the view", 0, look_ahead, outside_draw_meshes, NULL}, make_spheres};
const growth_scene growth_outside_mesh = {
    {"one-mesh", "the same spheres as one mesh", 0, look_ahead, outside_draw_mesh, NULL}, make_spheres};
const growth_scene growth_outside_behind = {
    {"mesh-behind", "spheres in the view, many as one mesh behind it", 0, look_ahead, outside_draw_behind, NULL},
    make_spheres_behind};
