/* Wires: which pixels an edge has, by fractions; their depth and when it is hidden; and the same pictures in whatever bands,
 * arenas and passes. */
#include "any_scene.h"
#include "any_triangle.h"
#include "ascii_picture.h"
#include "raster/wires.h"
#include "recording_sink.h"

void setUp(void)
{
}

void tearDown(void)
{
}

#if EL_WITH_WIRES

enum { SIZE = 48, WIRE = 0xF81F, SURFACE = 0x1234, EMPTY = 0xFFFF, TRIANGLES = 40 + PART_OF(2000) };

static uint16_t colour[SIZE * SIZE];
static uint16_t depth[SIZE * SIZE];

static int64_t floor_of(int64_t n, int64_t d)
{
    const int64_t quotient = n / d;
    return quotient - ((n % d != 0) && ((n < 0) != (d < 0)));
}

static int64_t ceiling_of(int64_t n, int64_t d)
{
    return -floor_of(-n, d);
}

static int64_t absolute(int64_t value)
{
    return value < 0 ? -value : value;
}

/* --- One triangle ------------------------------------------------------------------------------------------------- */

/* What of an edge is to be there: -1 where there is nothing, else its depth. */
static int32_t expected[SIZE * SIZE];

static void expect_at(int64_t x, int64_t y, int64_t z)
{
    if (x >= 0 && x < SIZE && y >= 0 && y < SIZE) {
        int32_t *const at = &expected[y * SIZE + x];
        *at = *at < 0 || z < *at ? (int32_t)z : *at;
    }
}

/* By its definition: of each row (or column) whose centre it crosses the pixel that it is in there, and its ends. */
static void expect_edge(const el_corner *a, const el_corner *b)
{
    const bool steep = absolute(b->y - a->y) > absolute(b->x - a->x);
    const el_corner *const from = (steep ? a->y <= b->y : a->x <= b->x) ? a : b;
    const el_corner *const to = from == a ? b : a;
    const int64_t along[2] = {steep ? from->y : from->x, steep ? to->y : to->x};
    const int64_t across[2] = {steep ? from->x : from->y, steep ? to->x : to->y};
    const int64_t length = along[1] - along[0];
    bool has_ends[2] = {false, false};
    for (int64_t i = -2; i < SIZE + 2; i++) {
        const int64_t centre = i * EL_SUBPIXELS + EL_SUBPIXELS / 2;
        if (centre < along[0] || centre >= along[1]) {
            continue;
        }
        const int64_t way = centre - along[0];
        const int64_t at = ceiling_of(across[0] * length + way * (across[1] - across[0]), length * EL_SUBPIXELS) - 1;
        const int64_t z = floor_of(2 * (from->z * length + way * (to->z - from->z)) + length, 2 * length);
        expect_at(steep ? at : i, steep ? i : at, z);
        for (unsigned end = 0; end < 2; end++) {
            has_ends[end] = has_ends[end] || i == ceiling_of(along[end], EL_SUBPIXELS) - 1;
        }
    }
    for (unsigned end = 0; end < 2; end++) {
        if (!has_ends[end]) {
            const int64_t i = ceiling_of(along[end], EL_SUBPIXELS) - 1;
            const int64_t at = ceiling_of(across[end], EL_SUBPIXELS) - 1;
            expect_at(steep ? at : i, steep ? i : at, end == 0 ? from->z : to->z);
        }
    }
}

static void clear(void)
{
    for (unsigned i = 0; i < SIZE * SIZE; i++) {
        colour[i] = 0;
        depth[i] = EMPTY;
        expected[i] = -1;
    }
}

/* In bands of so many lines. */
static uint32_t draw_wires(const el_corner corners[3], unsigned edges, bool has_depth, int32_t lines)
{
    const el_surface surface = {.depth = has_depth, .colour = WIRE};
    el_stats stats = {0};
    for (int32_t y = 0; y < SIZE; y += lines) {
        const el_target target = {.colour = colour + y * SIZE,
                                  .depth = depth + y * SIZE,
                                  .width = SIZE,
                                  .y = y,
                                  .y_end = y + lines < SIZE ? y + lines : SIZE};
        el_wires_draw(corners, edges, &surface, &target, &stats);
    }
    return stats.pixels;
}

static void any_corners(seeded *s, el_corner corners[3])
{
    const int32_t spread = (any_below(s, 2) == 0 ? 12 : 60) * EL_SUBPIXELS;
    for (unsigned i = 0; i < 3; i++) {
        corners[i] = any_corner(s, SIZE * EL_SUBPIXELS / 2, spread);
    }
    if (any_below(s, 4) == 0) { /* level, upright or at 45 degrees, on pixels' borders and centres */
        corners[1].x = corners[0].x;
        corners[2].y = corners[0].y = corners[0].y / (EL_SUBPIXELS / 2) * (EL_SUBPIXELS / 2);
    }
}

/* Depth is off by less than 2^-12 before it is rounded: only what lies exactly between two may be one less. */
static void test_an_edge_has_the_pixels_that_it_is_in(void)
{
    seeded s = seeded_from(1);
    for (; s.round < TRIANGLES; s.round++) {
        el_corner corners[3];
        any_corners(&s, corners);
        const unsigned edges = any_below(&s, 8);
        clear();
        for (unsigned i = 0; i < 3; i++) {
            if ((edges >> i & 1U) != 0) {
                expect_edge(&corners[i], &corners[(i + 1) % 3]);
            }
        }
        const int32_t lines = (int32_t)any_between(&s, 1, SIZE);
        (void)draw_wires(corners, edges, true, lines);
        for (unsigned i = 0; i < SIZE * SIZE; i++) {
            const bool is_wanted = expected[i] >= 0;
            if (is_wanted != (colour[i] == WIRE) ||
                (is_wanted && depth[i] != expected[i] && depth[i] + 1 != expected[i])) {
                fail_at(&s, "pixel (%u, %u) has colour %04x, depth %d, not %d", i % SIZE, i / SIZE, colour[i], depth[i],
                        (int)expected[i]);
            }
        }
    }
}

/* From either end, and from either of its triangles. */
static void test_an_edge_is_the_same_from_both_its_triangles(void)
{
    static uint16_t first[SIZE * SIZE];
    seeded s = seeded_from(2);
    for (; s.round < TRIANGLES; s.round++) {
        el_corner corners[3];
        any_corners(&s, corners);
        clear();
        (void)draw_wires(corners, 1, false, SIZE);
        memcpy(first, colour, sizeof first);
        clear();
        const el_corner other[3] = {corners[1], corners[0], any_corner(&s, 0, 60 * EL_SUBPIXELS)};
        (void)draw_wires(other, 1, false, 7);
        if (memcmp(first, colour, sizeof first) != 0) {
            fail_at(&s, "the edge is another one from its other end");
        }
    }
}

static void test_what_wires_look_like(void)
{
    picture p = picture_of(16, 9);
    const el_corner corners[3] = {
        {.x = PX(1, 3), .y = PX(7, 12)}, {.x = PX(14, 8), .y = PX(6, 1)}, {.x = PX(5, 0), .y = PX(0, 8)}};
    clear();
    (void)draw_wires(corners, 7, false, 4);
    for (unsigned y = 0; y < p.height; y++) {
        for (unsigned x = 0; x < p.width; x++) {
            p.pixels[y][x] = colour[y * SIZE + x] == WIRE ? 'w' : '.';
        }
    }
    EXPECT_PICTURE(&p,                 /**/
                   "....ww..........", /**/
                   "....w.ww........", /**/
                   "...w....w.......", /**/
                   "...w.....ww.....", /**/
                   "..w........ww...", /**/
                   "..w..........w..", /**/
                   ".w.....wwwwwwww.", /**/
                   ".wwwwww.........", /**/
                   "................");
}

/* Each pixel of a wire whose centre lies in its triangle is seen on that triangle's surface, however steep that is. */
static void test_wires_are_seen_on_their_own_surface(void)
{
    uint32_t seen = 0;
    seeded s = seeded_from(3);
    for (; s.round < TRIANGLES; s.round++) {
        el_corner corners[3];
        any_corners(&s, corners);
        for (unsigned i = 0; i < 3; i++) {
            corners[i].z = (uint16_t)(20000U + any_of_bits(&s, 15)); /* any slope */
        }
        clear();
        const el_target target = {.colour = colour, .depth = depth, .width = SIZE, .y_end = SIZE};
        const el_surface surface = {.depth = true, .colour = SURFACE};
        el_stats stats = {0};
        el_triangle triangle;
        if (!el_triangle_setup(&triangle, corners, &surface, 0)) {
            continue;
        }
        el_triangle_draw(&triangle, &target, &stats);
        for (unsigned i = 0; i < 3; i++) {
            expect_edge(&corners[i], &corners[(i + 1) % 3]);
        }
        (void)draw_wires(corners, 7, true, 5);
        for (unsigned i = 0; i < SIZE * SIZE; i++) {
            if (expected[i] >= 0) {
                seen += depth[i] != EMPTY;
                if (colour[i] != WIRE) {
                    fail_at(&s, "the wire is hidden at (%u, %u)", i % SIZE, i / SIZE);
                }
            }
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(TRIANGLES, seen);
}

/* A triangle that does not slope allows its wires one unit. */
static void test_wires_are_hidden_by_what_is_before_them(void)
{
    const el_corner corners[3] = {{.x = PX(4, 0), .y = PX(4, 0), .z = 1000},
                                  {.x = PX(40, 0), .y = PX(9, 0), .z = 1000},
                                  {.x = PX(9, 0), .y = PX(40, 0), .z = 1000}};
    for (uint16_t before = 998; before <= 1001; before++) {
        clear();
        memset(colour, 0, sizeof colour);
        for (unsigned i = 0; i < SIZE * SIZE; i++) {
            depth[i] = before;
        }
        TEST_ASSERT_GREATER_THAN_UINT32(90, draw_wires(corners, 7, true, 3));
        for (unsigned i = 0; i < SIZE * SIZE; i++) {
            if (before < 1000) {
                TEST_ASSERT_EQUAL_HEX16(0, colour[i]);
            }
            TEST_ASSERT_EQUAL_UINT16(colour[i] == WIRE && before > 1000 ? 1000 : before, depth[i]);
        }
        TEST_ASSERT_EQUAL_HEX16(before < 1000 ? 0 : WIRE, colour[4 * SIZE - SIZE + 3]);
    }
}

/* --- Scenes ------------------------------------------------------------------------------------------------------- */

enum { WIDTH = 40, HEIGHT = 70, PLENTY = 60000, ROUNDS = 12 + PART_OF(60) };

static any_scene scene;
static recording wanted, got;
static uint8_t memory[2][PLENTY] __attribute__((aligned(8)));
static uint8_t edges[SCENE_MESHES][SCENE_TRIANGLES];

static void make_wires(seeded *s, any_mesh *m, uint8_t bits[SCENE_TRIANGLES])
{
    m->material.shading = EL_SHADE_FLAT;
    m->material.flags =
        (uint8_t)((m->material.flags & (EL_MATERIAL_TWO_SIDED | EL_MATERIAL_NO_DEPTH)) | EL_MATERIAL_WIRES);
#if EL_WITH_MIXED
    m->material.alpha = 0;
    m->material.fog = NULL;
#endif
    for (unsigned k = 0; k < 3; k++) {
        m->material.colour[k] = (uint8_t)any_u64(s);
    }
    for (unsigned i = 0; i < SCENE_TRIANGLES; i++) {
        bits[i] = (uint8_t)any_u64(s);
    }
    m->mesh.edges = any_below(s, 2) == 0 ? bits : NULL;
}

static el_config any_config(seeded *s, size_t bytes)
{
    return (el_config){.band_lines = (uint16_t)any_between(s, 1, HEIGHT),
                       .depth_prepass = EL_WITH_PREPASS && any_below(s, 2) == 0,
                       .memory_bytes = bytes};
}

static void play(el_config config, unsigned arena, recording *r)
{
    const el_sink sink = recording_sink(r);
    config.width = WIDTH;
    config.height = HEIGHT;
    config.memory = memory[arena];
    config.sinks[0] = &sink;
    const size_t least = EL_MIN_MEMORY_BYTES((unsigned)WIDTH, (unsigned)HEIGHT, (unsigned)config.band_lines);
    config.memory_bytes = config.memory_bytes > least ? config.memory_bytes : least;
    el_renderer renderer;
    memset(r, 0, sizeof *r);
    TEST_ASSERT_EQUAL_INT(EL_OK, el_init(&renderer, &config));
    play_scene(&renderer, &scene);
}

static void test_wires_do_not_depend_on_bands(void)
{
    uint32_t clipped = 0;
    uint32_t passes = 0;
    seeded s = seeded_from(4);
    for (; s.round < ROUNDS; s.round++) {
        fill_mixed_scene(&s, &scene);
        for (unsigned i = 0; i < SCENE_MESHES; i++) {
            if (i == 1 || any_below(&s, 2) == 0) {
                make_wires(&s, &scene.meshes[i], edges[i]);
            }
        }
        play((el_config){.band_lines = HEIGHT, .memory_bytes = PLENTY}, 0, &wanted);
        play(any_config(&s, any_below(&s, 2) == 0 ? 0 : PLENTY), 1, &got);
        clipped += wanted.stats.triangles_clipped;
        passes += got.stats.passes > 1 || got.stats.flushes > 0;
        if (memcmp(wanted.pixels, got.pixels, sizeof wanted.pixels) != 0) {
            fail_at(&s, "other pixels in other bands");
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(ROUNDS, clipped);
    TEST_ASSERT_GREATER_THAN_UINT32(0, passes);
}

/* --- Draws -------------------------------------------------------------------------------------------------------- */

static const int16_t corners_of_one[3][3] = {{-200, -100, 0}, {200, -100, 0}, {0, 300, 0}};
static const uint16_t one_triangle[1][3] = {{0, 1, 2}};
static const uint8_t red_colours[3][3] = {{255, 0, 0}, {255, 0, 0}, {255, 0, 0}};
static el_mesh one = {.positions = corners_of_one,
                      .triangles = one_triangle,
                      .colours = red_colours,
                      .vertex_count = 3,
                      .triangle_count = 1,
                      .scale_log2 = -8,
                      .radius = 310};

static el_status draw_one(el_pose pose, const el_material materials[], unsigned count, el_config config)
{
    const el_sink sink = recording_sink(&got);
    const el_camera camera = {.axes_q30 = {{1 << 30, 0, 0}, {0, 1 << 30, 0}, {0, 0, 1 << 30}},
                              .fov_y = EL_DEGREES(60, 1),
                              .near_q16 = EL_UNIT_Q16 / 4,
                              .far_q16 = 9 * EL_UNIT_Q16};
    config.width = WIDTH;
    config.height = HEIGHT;
    config.band_lines = 9;
    config.memory = memory[0];
    config.memory_bytes = PLENTY;
    config.sinks[0] = &sink;
    el_renderer renderer;
    memset(&got, 0, sizeof got);
    TEST_ASSERT_EQUAL_INT(EL_OK, el_init(&renderer, &config));
    TEST_ASSERT_EQUAL_INT(EL_OK, el_frame_begin(&renderer, &camera));
    el_status status = EL_OK;
    for (unsigned i = 0; i < count && status == EL_OK; i++) {
        status = el_draw(&renderer, &one, &pose, &materials[i]);
    }
    TEST_ASSERT_EQUAL_INT(0, el_frame_next(&renderer));
    return status;
}

static uint32_t count_of(uint16_t pixel)
{
    uint32_t count = 0;
    for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
        count += got.pixels[i] == pixel;
    }
    return count;
}

static el_pose pose_at(int32_t z_q16)
{
    el_pose pose = el_pose_identity();
    pose.position_q16[2] = z_q16;
    return pose;
}

static const el_material green_wires = {.flags = EL_MATERIAL_WIRES, .colour = {0, 255, 0}};
enum { GREEN = 0x07E0 };

/* In the material's colour, though the mesh has others; seen from behind, nothing. */
static void test_a_mesh_has_wires_in_the_materials_colour(void)
{
    el_pose pose = pose_at(-3 * EL_UNIT_Q16);
    TEST_ASSERT_EQUAL_INT(EL_OK, draw_one(pose, &green_wires, 1, (el_config){0}));
    const uint32_t pixels = count_of(GREEN);
    TEST_ASSERT_GREATER_THAN_UINT32(60, pixels);
    TEST_ASSERT_EQUAL_UINT32(WIDTH * HEIGHT, pixels + count_of(0));
    const el_material over_surface[2] = {{.shading = EL_SHADE_FLAT}, green_wires};
    TEST_ASSERT_EQUAL_INT(EL_OK, draw_one(pose, over_surface, 2, (el_config){0}));
    TEST_ASSERT_EQUAL_UINT32(pixels, count_of(GREEN));
    TEST_ASSERT_GREATER_THAN_UINT32(100, count_of(0xF800));
    el_pose_turn(&pose, EL_AXIS_Y, 1U << 31);
    TEST_ASSERT_EQUAL_INT(EL_OK, draw_one(pose, &green_wires, 1, (el_config){0}));
    TEST_ASSERT_EQUAL_UINT32(0, count_of(GREEN));
}

/* Where a triangle is cut at the near plane, no line runs along the cut, nor between the pieces of what is left: its wires
 * are those of its base and of its sides, which meet at an end of the base. */
static void test_a_cut_has_no_wire(void)
{
    static const uint8_t bits[3] = {7, 1, 6};
    uint32_t pixels[3];
    el_pose pose = pose_at(-EL_UNIT_Q16);
    el_pose_turn(&pose, EL_AXIS_X, EL_DEGREES(60, 1)); /* the tip comes towards the camera, and behind it */
    pose.position_q16[0] = EL_UNIT_Q16 / 2;            /* one of the sides is in the view */
    pose.position_q16[1] = EL_UNIT_Q16 / 2;
    for (unsigned i = 0; i < 3; i++) {
        one.edges = &bits[i];
        TEST_ASSERT_EQUAL_INT(EL_OK, draw_one(pose, &green_wires, 1, (el_config){0}));
        TEST_ASSERT_EQUAL_UINT32(1, got.stats.triangles_clipped);
        pixels[i] = count_of(GREEN);
    }
    one.edges = NULL;
    TEST_ASSERT_GREATER_THAN_UINT32(5, pixels[1]);
    TEST_ASSERT_GREATER_THAN_UINT32(20, pixels[2]);
    TEST_ASSERT_LESS_OR_EQUAL_UINT32(pixels[1] + pixels[2], pixels[0]);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT32(pixels[1] + pixels[2], pixels[0] + 8);
}

#if EL_WITH_MIXED
/* A surface of the least alpha, with depth: what is behind it is hidden, and nothing of it is seen. */
static void test_depth_alone_hides_wires_and_leaves_colours(void)
{
    for (uint32_t i = 0; i < 0x10000U; i++) {
        const uint16_t own = (uint16_t)(i * 40503U >> 3);
        TEST_ASSERT_EQUAL_HEX16(i, el_rgb565_blend((uint16_t)i, own, 1));
    }
    const el_pose pose = pose_at(-3 * EL_UNIT_Q16);
    const el_material depth_alone = {.flags = EL_MATERIAL_BLEND_DEPTH, .alpha = 1};
    TEST_ASSERT_EQUAL_INT(EL_OK, draw_one(pose, &green_wires, 1, (el_config){.background = 0x5A5A}));
    const uint32_t alone = count_of(GREEN);
    const el_material both[2] = {depth_alone, green_wires};
    TEST_ASSERT_EQUAL_INT(EL_OK, draw_one(pose, both, 2, (el_config){.background = 0x5A5A}));
    TEST_ASSERT_EQUAL_UINT32(alone, count_of(GREEN));
    TEST_ASSERT_EQUAL_UINT32(WIDTH * HEIGHT - alone, count_of(0x5A5A));
    uint32_t hiding = 0;
    for (unsigned i = 0; i < WIDTH * HEIGHT; i++) {
        hiding += got.depth[i] != EMPTY && got.pixels[i] == 0x5A5A;
    }
    TEST_ASSERT_GREATER_THAN_UINT32(100, hiding);
}
#endif

static void expect_refused(el_material material, el_config config)
{
    material.flags |= EL_MATERIAL_WIRES;
    TEST_ASSERT_EQUAL_INT(EL_ERROR_MATERIAL, draw_one(pose_at(-3 * EL_UNIT_Q16), &material, 1, config));
}

static void test_wires_are_flat_and_opaque_and_of_one_sample(void)
{
    if (EL_WITH_GOURAUD) {
        expect_refused((el_material){.shading = EL_SHADE_GOURAUD}, (el_config){0});
    }
    if (EL_WITH_OVERDRAW) {
        expect_refused((el_material){.shading = EL_SHADE_OVERDRAW}, (el_config){0});
    }
#if EL_WITH_SAMPLES
    expect_refused(green_wires, (el_config){.samples = 4});
#endif
#if EL_WITH_MIXED
    expect_refused((el_material){.alpha = 100}, (el_config){0});
#endif
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_an_edge_has_the_pixels_that_it_is_in);
    RUN_TEST(test_an_edge_is_the_same_from_both_its_triangles);
    RUN_TEST(test_what_wires_look_like);
    RUN_TEST(test_wires_are_seen_on_their_own_surface);
    RUN_TEST(test_wires_are_hidden_by_what_is_before_them);
    RUN_TEST(test_wires_do_not_depend_on_bands);
    RUN_TEST(test_a_mesh_has_wires_in_the_materials_colour);
    RUN_TEST(test_a_cut_has_no_wire);
#if EL_WITH_MIXED
    RUN_TEST(test_depth_alone_hides_wires_and_leaves_colours);
#endif
    RUN_TEST(test_wires_are_flat_and_opaque_and_of_one_sample);
    return UNITY_END();
}

#else

/* Without: see test_options_leave_the_rest_as_it_is.py. */
static void test_wires_are_left_out(void)
{
    TEST_ASSERT_EQUAL_INT(0, EL_WITH_WIRES);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_wires_are_left_out);
    return UNITY_END();
}

#endif
