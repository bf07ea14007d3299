/* From a record back to colours, light and texture coordinates, with the formulas of material.h worked out apart. */
#include <string.h>

#include "base/rgb565.h"
#include "raster/gather.h"
#include "seeded.h"

enum { BYTES = 1024, ONE_Q14 = 16384 };

static const int16_t positions[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
static const uint16_t triangles[1][3] = {{2, 0, 1}};
static uint8_t colours[3][3] = {{10, 20, 30}, {100, 110, 120}, {255, 0, 128}};
static const uint8_t triangle_colours[1][3] = {{200, 100, 50}};
static int8_t normals[3][3] = {{0, 0, 127}, {0, 127, 0}, {0, 0, -127}};
static const int16_t uvs[3][2] = {{-32768, 32767}, {16, -16}, {5, 0}};
static const el_texture texture = {0};

static uint8_t memory[BYTES] __attribute__((aligned(8)));
static uint16_t bins[1];
static el_list list;
static el_mesh mesh;
static el_material material;
static el_light light;
static el_draw_state draw;
static el_corner corners[3];
static el_surface surface;

void setUp(void)
{
    el_list_init(&list, memory, sizeof memory, bins, 1, 100);
    mesh = (el_mesh){.positions = positions,
                     .triangles = triangles,
                     .colours = (const uint8_t(*)[3])colours,
                     .normals = (const int8_t(*)[3])normals,
                     .uvs = uvs,
                     .vertex_count = 3,
                     .triangle_count = 1};
    light = (el_light){.ambient = 0, .diffuse = 255};
    material = (el_material){.colour = {1, 2, 3}, .texture = &texture};
    draw = (el_draw_state){.mesh = &mesh, .material = &material, .light_q14 = {0, 0, ONE_Q14}};
}

void tearDown(void)
{
}

/* Puts a triangle on the list, its front to the viewer unless `back`, and gathers it. */
static void gather(el_record_kind kind, bool back)
{
    el_record *const record = el_list_append(&list, &draw, kind, 0, 1);
    TEST_ASSERT_NOT_NULL(record);
    record->index = 0;
    record->at.points[0] = (el_point){.x = 0, .y = 0, .z = 11};
    record->at.points[back ? 2 : 1] = (el_point){.x = 0, .y = 160, .z = 22};
    record->at.points[back ? 1 : 2] = (el_point){.x = 160, .y = 0, .z = 33};
    if (kind != EL_RECORD_PLAIN) {
        el_record_perspective *const perspective = (el_record_perspective *)(void *)record;
        for (unsigned i = 0; i < 3; i++) {
            perspective->w[i] = 0x8000;
        }
        perspective->w_shifts = 3 | 5 << 5 | 31 << 10;
    }
    if (kind == EL_RECORD_CLIPPED) {
        el_record_clipped *const clipped = (el_record_clipped *)(void *)record;
        for (unsigned i = 0; i < 3; i++) {
            clipped->attributes[i] = (el_attributes){
                .u_q16 = (int32_t)i * 100, .v_q16 = (int32_t)i * -100, .rgb_q8 = {(uint16_t)i, 0xFF00, 77}};
        }
    }
    el_list_gather(&list, record, corners, &surface);
}

static void expect_vertex(unsigned red_q8, unsigned green_q8, unsigned blue_q8, uint16_t vertex, bool turned)
{
    uint16_t rgb_q8[3];
    el_shade_vertex(&draw, vertex, turned, rgb_q8);
    TEST_ASSERT_EQUAL_UINT16(red_q8, rgb_q8[0]);
    TEST_ASSERT_EQUAL_UINT16(green_q8, rgb_q8[1]);
    TEST_ASSERT_EQUAL_UINT16(blue_q8, rgb_q8[2]);
}

/* --- Vertices ----------------------------------------------------------------------------------------------------- */

static void test_without_light_colours_are_as_they_are(void)
{
    expect_vertex(100 << 8, 110 << 8, 120 << 8, 1, false);
    mesh.colours = NULL;
    expect_vertex(1 << 8, 2 << 8, 3 << 8, 1, false);
}

/* Facing the light, beside it, away from it; and the same seen from the back. */
static void test_light_by_direction(void)
{
    material.light = &light;
    expect_vertex(10 << 8, 20 << 8, 30 << 8, 0, false);
    expect_vertex(0, 0, 0, 1, false);
    expect_vertex(0, 0, 0, 2, false);
    expect_vertex(0, 0, 0, 0, true);
    expect_vertex(255 << 8, 0, 128 << 8, 2, true);
}

static void test_ambient_adds_up_to_the_own_colour_and_no_further(void)
{
    material.light = &light;
    light = (el_light){.ambient = 51, .diffuse = 0};
    expect_vertex(51 << 8, 0, 128 * 51 * 256 / 255 + 1, 2, false); /* a fifth; 25.6 in 8.8 is 6553.6 */
    light = (el_light){.ambient = 200, .diffuse = 255};
    expect_vertex(10 << 8, 20 << 8, 30 << 8, 0, false);
}

/* Against ambient + diffuse * cosine in whole numbers: within a unit of 8.8 and what the two steps cut off. */
static void test_light_seeded(void)
{
    material.light = &light;
    for (seeded s = seeded_from(95); s.round < 20000; s.round++) {
        int64_t dot = 0;
        for (unsigned i = 0; i < 3; i++) {
            normals[0][i] = (int8_t)any_between(&s, -73, 73);
            draw.light_q14[i] = (int16_t)any_between(&s, -9459, 9459);
            colours[0][i] = (uint8_t)any_u64(&s);
            dot += (int64_t)normals[0][i] * draw.light_q14[i];
        }
        light.ambient = (uint8_t)any_u64(&s);
        light.diffuse = (uint8_t)any_u64(&s);
        const bool turned = any_below(&s, 2) == 0;
        dot = turned ? -dot : dot;
        const int64_t full = (int64_t)light.ambient * 256 + (dot > 0 ? light.diffuse * dot / (127 * 64) : 0);
        const int64_t level = full > 0xFF00 ? 0xFF00 : full;
        uint16_t got[3];
        el_shade_vertex(&draw, 0, turned, got);
        for (unsigned i = 0; i < 3; i++) {
            const int64_t expected = colours[0][i] * level / 255;
            const int64_t error = got[i] - expected;
            if (error < -4 || error > 1 || got[i] > 0xFF00) { /* dot / 64 cut off: up to 255 / 127 of a unit, twice */
                fail_at(&s, "channel %u is %u, not %lld", i, got[i], (long long)expected);
            }
        }
    }
    memset(normals, 0, sizeof normals);
    normals[0][2] = normals[1][1] = 127;
    normals[2][2] = -127;
    memcpy(colours, (const uint8_t[3][3]){{10, 20, 30}, {100, 110, 120}, {255, 0, 128}}, sizeof colours);
}

/* --- Triangles ---------------------------------------------------------------------------------------------------- */

static void test_flat_takes_the_first_vertex(void)
{
    gather(EL_RECORD_PLAIN, false);
    TEST_ASSERT_EQUAL_HEX16(el_rgb565(255, 0, 128), surface.colour);
    TEST_ASSERT_EQUAL_INT(EL_SHADE_FLAT, surface.shading);
    TEST_ASSERT_TRUE(surface.depth);
    TEST_ASSERT_EQUAL_INT32(160, corners[2].x);
    TEST_ASSERT_EQUAL_INT32(160, corners[1].y);
    TEST_ASSERT_EQUAL_UINT16(33, corners[2].z);
}

static void test_flat_mean(void)
{
    material.flags = EL_MATERIAL_FLAT_MEAN;
    gather(EL_RECORD_PLAIN, false);
    TEST_ASSERT_EQUAL_HEX16(el_rgb565((255 + 10 + 100 + 1) / 3, (20 + 110) / 3, (128 + 30 + 120 + 1) / 3),
                            surface.colour);
}

static void test_flat_prefers_the_triangle_then_the_vertex_then_the_material(void)
{
    mesh.triangle_colours = triangle_colours;
    gather(EL_RECORD_PLAIN, false);
    TEST_ASSERT_EQUAL_HEX16(el_rgb565(200, 100, 50), surface.colour);
    mesh.triangle_colours = NULL;
    mesh.colours = NULL;
    gather(EL_RECORD_PLAIN, false);
    TEST_ASSERT_EQUAL_HEX16(el_rgb565(1, 2, 3), surface.colour);
}

/* The first vertex faces away from the light, so its back is lit. */
static void test_a_back_is_lit_by_the_turned_normal(void)
{
    material.light = &light;
    material.flags = EL_MATERIAL_TWO_SIDED;
    gather(EL_RECORD_PLAIN, false);
    TEST_ASSERT_EQUAL_HEX16(0, surface.colour);
    gather(EL_RECORD_PLAIN, true);
    TEST_ASSERT_EQUAL_HEX16(el_rgb565(255, 0, 128), surface.colour);
    draw.flags = EL_DRAW_MIRRORED; /* in a mirror the front runs the other way */
    el_list_end_draw(&list);
    gather(EL_RECORD_PLAIN, true);
    TEST_ASSERT_EQUAL_HEX16(0, surface.colour);
}

static void test_gouraud_takes_each_vertex(void)
{
    material.shading = EL_SHADE_GOURAUD;
    gather(EL_RECORD_PLAIN, false);
    for (unsigned i = 0; i < 3; i++) {
        for (unsigned channel = 0; channel < 3; channel++) {
            TEST_ASSERT_EQUAL_UINT16(colours[triangles[0][i]][channel] << 8, corners[i].rgb_q8[channel]);
        }
    }
}

/* Q12.4 to Q16; 1/w in the unit of the largest, which keeps its 31 bits, and never 0. */
static void test_textured_takes_coordinates_and_w(void)
{
    material.shading = EL_SHADE_TEXTURED;
    gather(EL_RECORD_PERSPECTIVE, false);
    TEST_ASSERT_EQUAL_PTR(&texture, surface.texture);
    for (unsigned i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_INT32(uvs[triangles[0][i]][0] * 4096, corners[i].u_q16);
        TEST_ASSERT_EQUAL_INT32(uvs[triangles[0][i]][1] * 4096, corners[i].v_q16);
    }
    TEST_ASSERT_EQUAL_UINT32(1U << 30, corners[0].w);
    TEST_ASSERT_EQUAL_UINT32(1U << 28, corners[1].w);
    TEST_ASSERT_EQUAL_UINT32(1U << 2, corners[2].w);
}

static void test_clipped_triangles_bring_their_own(void)
{
    material.shading = EL_SHADE_TEXTURED_GOURAUD;
    gather(EL_RECORD_CLIPPED, false);
    for (unsigned i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_INT32((int32_t)i * 100, corners[i].u_q16);
        TEST_ASSERT_EQUAL_INT32((int32_t)i * -100, corners[i].v_q16);
        TEST_ASSERT_EQUAL_UINT16(i, corners[i].rgb_q8[0]);
        TEST_ASSERT_EQUAL_UINT16(0xFF00, corners[i].rgb_q8[1]);
        TEST_ASSERT_EQUAL_UINT16(77, corners[i].rgb_q8[2]);
    }
}

static void test_depth_is_off_when_asked_and_for_overdraw(void)
{
    material.flags = EL_MATERIAL_NO_DEPTH;
    gather(EL_RECORD_PLAIN, false);
    TEST_ASSERT_FALSE(surface.depth);
    material.flags = 0;
    material.shading = EL_SHADE_OVERDRAW;
    gather(EL_RECORD_PLAIN, false);
    TEST_ASSERT_FALSE(surface.depth);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_without_light_colours_are_as_they_are);
    RUN_TEST(test_light_by_direction);
    RUN_TEST(test_ambient_adds_up_to_the_own_colour_and_no_further);
    RUN_TEST(test_light_seeded);
    RUN_TEST(test_flat_takes_the_first_vertex);
    RUN_TEST(test_flat_mean);
    RUN_TEST(test_flat_prefers_the_triangle_then_the_vertex_then_the_material);
    RUN_TEST(test_a_back_is_lit_by_the_turned_normal);
    RUN_TEST(test_gouraud_takes_each_vertex);
    RUN_TEST(test_textured_takes_coordinates_and_w);
    RUN_TEST(test_clipped_triangles_bring_their_own);
    RUN_TEST(test_depth_is_off_when_asked_and_for_overdraw);
    return UNITY_END();
}
