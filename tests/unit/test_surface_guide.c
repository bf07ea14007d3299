/* The guide's examples of lamps, fog and smooth edges, each as it stands there, and that it does what is said there. */
#include "edgeline.h"
#include "unity.h"

enum { WIDTH = 64, HEIGHT = 48 };

static uint16_t picture[HEIGHT][WIDTH];

static void begin(void *context, uint16_t width, uint16_t height)
{
    (void)context, (void)width, (void)height;
}

static void rows(void *context, el_band *band, unsigned slot)
{
    (void)context;
    for (unsigned i = 0; i < (unsigned)band->lines * WIDTH; i++) {
        picture[band->y + i / WIDTH][i % WIDTH] = band->pixels[i];
    }
    el_band_release(band, slot);
}

static void end(void *context, const el_stats *stats)
{
    (void)context, (void)stats;
}

static const el_sink lcd = {.begin = begin, .rows = rows, .end = end};

/* A square of 2 x 2 units that looks at the camera, 5 units before it. */
static const int16_t corners[4][3] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
static const int8_t normals[4][3] = {{0, 0, 127}, {0, 0, 127}, {0, 0, 127}, {0, 0, 127}};
static const uint16_t halves[2][3] = {{0, 1, 2}, {0, 2, 3}};
static const el_mesh square = {
    .positions = corners, .normals = normals, .triangles = halves, .vertex_count = 4, .triangle_count = 2, .radius = 2};

static el_renderer r;
static el_camera camera;
static el_pose pose;

void setUp(void)
{
    camera = (el_camera){.fov_y = EL_DEGREES(60, 1), .near_q16 = EL_UNIT_Q16 / 4, .far_q16 = 100 * EL_UNIT_Q16};
    const el_orbit_camera orbit = el_orbit_camera_at((const int32_t[]){0, 0, 0}, 5 * EL_UNIT_Q16);
    el_orbit_camera_place(&orbit, &camera);
    pose = el_pose_identity();
}

void tearDown(void)
{
}

static void start(void)
{
    static uint8_t memory[EL_MEMORY_BYTES(WIDTH, HEIGHT, 8, 4, 2, 1)];
    const el_config config = {.width = WIDTH,
                              .height = HEIGHT,
                              .band_lines = 8,
                              .memory = memory,
                              .memory_bytes = sizeof memory,
                              .sinks = {&lcd}};
    TEST_ASSERT_EQUAL_INT(EL_OK, el_init(&r, &config));
}

static void draw(const el_mesh *mesh, const el_material *material)
{
    TEST_ASSERT_EQUAL_INT(EL_OK, el_frame_begin(&r, &camera));
    do {
        TEST_ASSERT_EQUAL_INT(EL_OK, el_draw(&r, mesh, &pose, material));
    } while (el_frame_next(&r) > 0);
}

/* A warm lamp at a place and a dim blue sky. */
static const el_lamp lamps[] = {
    {.kind = EL_LAMP_POINT,
     .colour = {255, 220, 160},
     .position_q16 = {0, 0, 2 * EL_UNIT_Q16},
     .half_q16 = EL_UNIT_Q16},
    {.kind = EL_LAMP_DIRECTIONAL, .colour = {40, 50, 90}, .direction_q30 = {0, EL_UNIT_Q30, 0}},
};
static el_highlight shine; /* el_highlight_make(&shine, 40), once */
static uint8_t colours[4][3];

static el_mesh in_the_light(const el_mesh *mesh)
{
    const el_lighting lighting = {.lamps = lamps,
                                  .lamp_count = 2,
                                  .highlight = &shine,
                                  .specular = {120, 120, 120},
                                  .ambient = {20, 20, 30},
                                  .colour = {226, 146, 74}};
    el_mesh lit = *mesh;
    if (el_light_vertices(&lighting, mesh, &pose, camera.position_q16, colours) == EL_OK) {
        lit.colours = (const uint8_t(*)[3])colours;
    }
    return lit;
}

static void test_lamps(void)
{
    TEST_ASSERT_EQUAL_INT(EL_OK, el_highlight_make(&shine, 40));
    start();
    const el_mesh lit = in_the_light(&square);
    TEST_ASSERT_EQUAL_PTR(colours, lit.colours);
    draw(&lit, &(el_material){.shading = EL_SHADE_GOURAUD});
    const uint16_t middle = picture[HEIGHT / 2][WIDTH / 2];
    TEST_ASSERT_NOT_EQUAL(0, middle);
    TEST_ASSERT_GREATER_THAN_UINT32(middle & 31U, middle >> 11); /* warm */
    TEST_ASSERT_EQUAL_HEX16(0, picture[0][0]);
}

#if EL_WITH_MIXED
static el_fog mist;

static void test_fog(void)
{
    /* From 4 units on, all of it from 6: a half at 5. */
    const el_status made = el_fog_linear(&mist, &camera, 0xFFFF, 4 * EL_UNIT_Q16, 6 * EL_UNIT_Q16);
    TEST_ASSERT_EQUAL_INT(EL_OK, made);
    start();
    draw(&square, &(el_material){.colour = {0, 0, 0}, .fog = &mist});
    TEST_ASSERT_UINT16_WITHIN(1, 16, picture[HEIGHT / 2][WIDTH / 2] & 31U);
}
#endif

#if EL_WITH_SAMPLES
static uint8_t smooth_memory[EL_MEMORY_BYTES(WIDTH, HEIGHT, 8, 4, 2, 1) + EL_SAMPLES_BYTES(WIDTH, 8, 4)];

static void test_samples(void)
{
    const el_config config = {.width = WIDTH,
                              .height = HEIGHT,
                              .band_lines = 8,
                              .samples = 4,
                              .memory = smooth_memory,
                              .memory_bytes = sizeof smooth_memory,
                              .sinks = {&lcd}};
    TEST_ASSERT_EQUAL_INT(EL_OK, el_init(&r, &config));
    el_pose_turn(&pose, EL_AXIS_Z, EL_DEGREES(10, 1));
    draw(&square, &(el_material){.colour = {255, 255, 255}});
    unsigned between = 0;
    for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
        const uint16_t pixel = picture[i / WIDTH][i % WIDTH];
        between += pixel != 0 && pixel != 0xFFFF;
    }
    TEST_ASSERT_GREATER_THAN_UINT32(20, between);
}
#endif

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_lamps);
#if EL_WITH_MIXED
    RUN_TEST(test_fog);
#endif
#if EL_WITH_SAMPLES
    RUN_TEST(test_samples);
#endif
    return UNITY_END();
}
