/* The .elm reader takes exactly what elm.h describes: one small file with everything in it is read back member by member,
 * then cut at every length, changed in every bit of its header and its data, and put together wrongly in every way that
 * keeps the CRC right. A seeded fuzz loop adds what nobody thought of; run it under sanitizers to make it count. */
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "elm_bytes.h"
#include "geometry/elm.h"
#include "unity.h"

enum {
    VERTICES = 5,
    TRIANGLES = 3,
    HEADER = 32,
    POSITIONS_AT = HEADER,
    TRIANGLES_AT = POSITIONS_AT + 32,      /* 30 bytes and 2 of padding */
    COLOURS_AT = TRIANGLES_AT + 20,        /* 18 + 2 */
    TRIANGLE_COLOURS_AT = COLOURS_AT + 16, /* 15 + 1 */
    NORMALS_AT = TRIANGLE_COLOURS_AT + 12, /* 9 + 3 */
    UVS_AT = NORMALS_AT + 16,              /* 15 + 1 */
    TEXELS_AT = UVS_AT + 20,
    SIZE = TEXELS_AT + 16, /* 4 x 2 texels */
    CONTENT_AT = 21,
    RADIUS_AT = 30
};

static const int16_t positions[VERTICES][3] = {{0, 0, 0}, {300, 0, 0}, {0, 400, 0}, {0, 0, -500}, {-32768, 0, 0}};
static const uint16_t triangles[TRIANGLES][3] = {{0, 1, 2}, {0, 2, 3}, {4, 1, 2}};
static const int16_t uvs[VERTICES][2] = {{0, 16}, {-32768, 32767}, {1, 2}, {3, 4}, {5, 6}};

static uint32_t words[SIZE / 4];
static uint8_t *const file = (uint8_t *)words;
static el_mesh mesh;
static el_texture texture;

static el_elm_status open_all(void)
{
    return el_elm_open(file, SIZE, &mesh, &texture);
}

/* Writes `value` where the header has it, makes the CRC right again, and says what the reader answers. */
static el_elm_status status_with(size_t at, uint32_t value, size_t bytes)
{
    elm_put(file, at, value, bytes);
    elm_seal(file, SIZE);
    return open_all();
}

void setUp(void)
{
    memset(words, 0, sizeof words);
    memcpy(file, "ELM\x1a", 4);
    elm_put(file, 4, 1, 2);
    elm_put(file, 8, SIZE, 4);
    elm_put(file, 16, VERTICES, 2);
    elm_put(file, 18, TRIANGLES, 2);
    elm_put(file, 20, 0xF7, 1); /* -9 */
    elm_put(file, CONTENT_AT, 31, 1);
    elm_put(file, 22, 2, 1);
    elm_put(file, 23, 1, 1);
    elm_put(file, 24, 0xC000, 2); /* -16384 */
    elm_put(file, 26, 7, 2);
    elm_put(file, 28, 0xFFF8, 2); /* -8 */
    elm_put(file, RADIUS_AT, 16700, 2);
    memcpy(file + POSITIONS_AT, positions, sizeof positions);
    memcpy(file + TRIANGLES_AT, triangles, sizeof triangles);
    for (uint8_t i = 0; i < 15; i++) {
        file[COLOURS_AT + i] = (uint8_t)(200 + i);
        file[NORMALS_AT + i] = (uint8_t)(120 + i);
    }
    for (uint8_t i = 0; i < 9; i++) {
        file[TRIANGLE_COLOURS_AT + i] = (uint8_t)(100 + i);
    }
    memcpy(file + UVS_AT, uvs, sizeof uvs);
    for (uint8_t i = 0; i < 16; i++) {
        file[TEXELS_AT + i] = (uint8_t)(i * 16);
    }
    elm_seal(file, SIZE);
    memset(&mesh, 0x5a, sizeof mesh);
    memset(&texture, 0x5a, sizeof texture);
}

void tearDown(void)
{
}

static void test_every_member_is_a_view_of_the_bytes(void)
{
    TEST_ASSERT_EQUAL_INT(EL_ELM_OK, open_all());
    TEST_ASSERT_EQUAL_PTR(file + POSITIONS_AT, mesh.positions);
    TEST_ASSERT_EQUAL_PTR(file + TRIANGLES_AT, mesh.triangles);
    TEST_ASSERT_EQUAL_PTR(file + COLOURS_AT, mesh.colours);
    TEST_ASSERT_EQUAL_PTR(file + TRIANGLE_COLOURS_AT, mesh.triangle_colours);
    TEST_ASSERT_EQUAL_PTR(file + NORMALS_AT, mesh.normals);
    TEST_ASSERT_EQUAL_PTR(file + UVS_AT, mesh.uvs);
    TEST_ASSERT_EQUAL_PTR(file + TEXELS_AT, texture.texels);
    TEST_ASSERT_EQUAL_UINT16(VERTICES, mesh.vertex_count);
    TEST_ASSERT_EQUAL_UINT16(TRIANGLES, mesh.triangle_count);
    TEST_ASSERT_EQUAL_INT8(-9, mesh.scale_log2);
    TEST_ASSERT_EQUAL_INT16(-16384, mesh.centre[0]);
    TEST_ASSERT_EQUAL_INT16(7, mesh.centre[1]);
    TEST_ASSERT_EQUAL_INT16(-8, mesh.centre[2]);
    TEST_ASSERT_EQUAL_UINT16(16700, mesh.radius);
    TEST_ASSERT_EQUAL_UINT8(2, texture.width_log2);
    TEST_ASSERT_EQUAL_UINT8(1, texture.height_log2);
    TEST_ASSERT_EQUAL_INT16(-32768, mesh.positions[4][0]);
    TEST_ASSERT_EQUAL_INT16(32767, mesh.uvs[1][1]);
    TEST_ASSERT_EQUAL_HEX16(0x3020, texture.texels[1]);
}

static void test_absent_sections_are_null(void)
{
    memmove(file + COLOURS_AT, file + NORMALS_AT, 16); /* what stays: positions, triangles, normals */
    enum { SHORT_SIZE = COLOURS_AT + 16 };
    elm_put(file, 8, SHORT_SIZE, 4);
    elm_put(file, CONTENT_AT, 4, 1);
    elm_put(file, 22, 0, 2);
    elm_seal(file, SHORT_SIZE);
    TEST_ASSERT_EQUAL_INT(EL_ELM_OK, el_elm_open(file, SHORT_SIZE, &mesh, &texture));
    TEST_ASSERT_EQUAL_PTR(file + COLOURS_AT, mesh.normals);
    TEST_ASSERT_NULL(mesh.colours);
    TEST_ASSERT_NULL(mesh.triangle_colours);
    TEST_ASSERT_NULL(mesh.uvs);
    TEST_ASSERT_NULL(texture.texels);
}

static void test_cut_at_every_length(void)
{
    for (size_t size = 0; size < SIZE; size++) {
        /* Memory of exactly that size, so that a sanitizer sees any read beyond it. */
        uint8_t *cut = malloc(size + (size == 0));
        TEST_ASSERT_NOT_NULL(cut);
        memcpy(cut, file, size);
        const el_elm_status status = el_elm_open(cut, size, &mesh, &texture);
        free(cut);
        TEST_ASSERT_EQUAL_INT_MESSAGE(size < 4 ? EL_ELM_NOT_ELM : EL_ELM_TRUNCATED, status, "a cut file");
    }
}

static void test_bytes_after_the_end_are_refused(void)
{
    uint32_t longer[SIZE / 4 + 1] = {0};
    memcpy(longer, file, SIZE);
    TEST_ASSERT_EQUAL_INT(EL_ELM_CORRUPT, el_elm_open(longer, sizeof longer, &mesh, &texture));
}

static void test_misaligned_bytes_are_refused(void)
{
    uint32_t shifted[SIZE / 4 + 1] = {0};
    for (size_t by = 1; by < 4; by++) {
        memcpy((uint8_t *)shifted + by, file, SIZE);
        TEST_ASSERT_EQUAL_INT(EL_ELM_NOT_ELM, el_elm_open((uint8_t *)shifted + by, SIZE, &mesh, &texture));
    }
}

/* What the reader has to answer when a bit of the byte at `at` is wrong and the CRC was not made anew. */
static el_elm_status expected_for_flip(size_t at, bool raises)
{
    if (at < 4) {
        return EL_ELM_NOT_ELM;
    }
    if (at < 6) {
        return EL_ELM_VERSION;
    }
    if (at < 8) {
        return EL_ELM_OK; /* any minor version is read */
    }
    return at < 12 && raises ? EL_ELM_TRUNCATED : EL_ELM_CORRUPT;
}

static void test_every_bit_of_the_file_counts(void)
{
    for (size_t at = 0; at < SIZE; at++) {
        for (unsigned bit = 0; bit < 8; bit++) {
            const uint8_t before = file[at];
            file[at] ^= (uint8_t)(1u << bit);
            TEST_ASSERT_EQUAL_INT(expected_for_flip(at, file[at] > before), open_all());
            file[at] = before;
        }
    }
    TEST_ASSERT_EQUAL_INT(EL_ELM_OK, open_all());
}

static void test_an_error_writes_nothing(void)
{
    el_mesh mesh_before = mesh;
    el_texture texture_before = texture;
    TEST_ASSERT_EQUAL_INT(EL_ELM_RANGE, status_with(RADIUS_AT, 16000, 2));
    TEST_ASSERT_EQUAL_MEMORY(&mesh_before, &mesh, sizeof mesh);
    TEST_ASSERT_EQUAL_MEMORY(&texture_before, &texture, sizeof texture);
}

static void test_counts_under_a_right_crc(void)
{
    static const uint16_t counts[] = {0, 4, 6, 7, 61440, 61441, 65535};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        TEST_ASSERT_EQUAL_INT(EL_ELM_CORRUPT, status_with(16, counts[i], 2));
        setUp();
        TEST_ASSERT_EQUAL_INT(EL_ELM_CORRUPT, status_with(18, counts[i], 2));
        setUp();
    }
}

static void test_content_under_a_right_crc(void)
{
    for (unsigned content = 0; content < 256; content++) {
        TEST_ASSERT_EQUAL_INT(content == 31 ? EL_ELM_OK : EL_ELM_CORRUPT, status_with(CONTENT_AT, content, 1));
    }
}

static void test_a_texture_needs_texture_coordinates(void)
{
    enum { SHORT_SIZE = SIZE - (TEXELS_AT - UVS_AT) };
    memmove(file + UVS_AT, file + TEXELS_AT, SIZE - TEXELS_AT);
    elm_put(file, 8, SHORT_SIZE, 4);
    elm_put(file, CONTENT_AT, 31 - 8, 1);
    elm_seal(file, SHORT_SIZE);
    TEST_ASSERT_EQUAL_INT(EL_ELM_CORRUPT, el_elm_open(file, SHORT_SIZE, &mesh, &texture));
}

static void test_texture_sides_under_a_right_crc(void)
{
    for (unsigned log2 = 0; log2 < 256; log2++) {
        TEST_ASSERT_EQUAL_INT(log2 == 2 ? EL_ELM_OK : EL_ELM_CORRUPT, status_with(22, log2, 1));
    }
    setUp();
    TEST_ASSERT_EQUAL_INT(EL_ELM_OK, status_with(22, 0x0003, 2)); /* 8 x 1: as many texels */
    TEST_ASSERT_EQUAL_UINT8(0, texture.height_log2);
}

static void test_padding_under_a_right_crc(void)
{
    static const size_t padding[] = {62, 63, 82, 83, 99, 109, 110, 111, 127};
    for (size_t i = 0; i < sizeof padding / sizeof *padding; i++) {
        TEST_ASSERT_EQUAL_INT(EL_ELM_CORRUPT, status_with(padding[i], 1, 1));
        setUp();
    }
}

/* Two clusters behind the texels: 2 + 1 triangles, 4 + 1 vertices. */
enum { CLUSTERS_AT = SIZE, WITH_CLUSTERS = CLUSTERS_AT + 4 + 2 * 18 };

static uint32_t longer_words[WITH_CLUSTERS / 4];

static el_elm_status open_with(const el_cluster clusters[2], uint32_t count)
{
    uint8_t *const longer = (uint8_t *)longer_words;
    elm_put(file, 8, WITH_CLUSTERS, 4);
    elm_put(file, CONTENT_AT, 63, 1);
    memcpy(longer, file, SIZE);
    memcpy(longer + CLUSTERS_AT, &count, sizeof count);
    memcpy(longer + CLUSTERS_AT + 4, clusters, 2 * sizeof clusters[0]);
    elm_seal(longer, WITH_CLUSTERS);
    return el_elm_open(longer, WITH_CLUSTERS, &mesh, &texture);
}

static void test_clusters_hold_the_mesh_whole(void)
{
    static const el_cluster good[2] = {
        {.triangle_count = 2, .vertex_count = 4, .centre = {-16384, 7, -8}, .radius = 16700, .spread = 255},
        {.triangle_count = 1, .vertex_count = 1, .centre = {-16384, 100, 0}, .radius = 16700, .axis = {1, -2, 3}}};
    TEST_ASSERT_EQUAL_INT(EL_ELM_OK, open_with(good, 2));
    TEST_ASSERT_EQUAL_UINT16(2, mesh.cluster_count);
    TEST_ASSERT_EQUAL_PTR((uint8_t *)longer_words + CLUSTERS_AT + 4, mesh.clusters);
    TEST_ASSERT_EQUAL_INT8(-2, mesh.clusters[1].axis[1]);
    TEST_ASSERT_EQUAL_INT(EL_ELM_CORRUPT, open_with(good, 1));
    TEST_ASSERT_EQUAL_INT(EL_ELM_CORRUPT, open_with(good, 3));
    TEST_ASSERT_EQUAL_INT(EL_ELM_CORRUPT, open_with(good, UINT32_MAX));

    el_cluster bad[2] = {good[0], good[1]};
    bad[1].triangle_count = 0; /* one triangle is in none */
    TEST_ASSERT_EQUAL_INT(EL_ELM_RANGE, open_with(bad, 2));
    bad[1].triangle_count = 2; /* one more than there are */
    TEST_ASSERT_EQUAL_INT(EL_ELM_RANGE, open_with(bad, 2));
    bad[1] = good[1];
    bad[0].vertex_count = 3;
    TEST_ASSERT_EQUAL_INT(EL_ELM_RANGE, open_with(bad, 2));
    bad[0].vertex_count = 5;
    TEST_ASSERT_EQUAL_INT(EL_ELM_RANGE, open_with(bad, 2));
    bad[0] = good[0];
    bad[1].radius = 16000; /* a corner lies outside */
    TEST_ASSERT_EQUAL_INT(EL_ELM_RANGE, open_with(bad, 2));
    bad[1] = good[1];
    bad[1].centre[0] = 32767; /* so does its middle, of the mesh's */
    bad[1].radius = 65535;
    TEST_ASSERT_EQUAL_INT(EL_ELM_RANGE, open_with(bad, 2));
}

static void test_scale_range(void)
{
    for (int scale = -128; scale < 128; scale++) {
        const bool fits = scale >= -30 && scale <= 8;
        TEST_ASSERT_EQUAL_INT(fits ? EL_ELM_OK : EL_ELM_RANGE, status_with(20, (uint32_t)scale, 1));
    }
}

static void test_index_range(void)
{
    for (size_t corner = 0; corner < 3 * TRIANGLES; corner++) {
        TEST_ASSERT_EQUAL_INT(EL_ELM_OK, status_with(TRIANGLES_AT + 2 * corner, VERTICES - 1, 2));
        TEST_ASSERT_EQUAL_INT(EL_ELM_RANGE, status_with(TRIANGLES_AT + 2 * corner, VERTICES, 2));
        setUp();
    }
}

static void test_the_sphere_holds_every_vertex(void)
{
    elm_put(file, 24, 0, 2);
    elm_put(file, 26, 0, 2);
    elm_put(file, 28, 0, 2); /* around the origin, the farthest vertex is 32768 away */
    TEST_ASSERT_EQUAL_INT(EL_ELM_OK, status_with(RADIUS_AT, 32768, 2));
    TEST_ASSERT_EQUAL_INT(EL_ELM_RANGE, status_with(RADIUS_AT, 32767, 2));
    elm_put(file, 24, 0x7FFF, 2); /* 65535 away: as far as it goes */
    TEST_ASSERT_EQUAL_INT(EL_ELM_OK, status_with(RADIUS_AT, 65535, 2));
    TEST_ASSERT_EQUAL_INT(EL_ELM_RANGE, status_with(RADIUS_AT, 65534, 2));
}

static void test_newer_minor_version_is_read(void)
{
    TEST_ASSERT_EQUAL_INT(EL_ELM_OK, status_with(6, 0xFFFF, 2));
    TEST_ASSERT_EQUAL_INT(EL_ELM_VERSION, status_with(4, 2, 2));
    TEST_ASSERT_EQUAL_INT(EL_ELM_VERSION, status_with(4, 0, 2));
}

static uint32_t next_random(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u; /* Numerical Recipes' generator */
    return *state >> 8;
}

/* Whatever is accepted has to be safe to draw. */
static void check_accepted(size_t size)
{
    for (uint32_t i = 0; i < mesh.triangle_count; i++) {
        for (int corner = 0; corner < 3; corner++) {
            TEST_ASSERT_LESS_THAN_UINT16(mesh.vertex_count, mesh.triangles[i][corner]);
        }
    }
    const uint8_t *end = (const uint8_t *)(mesh.positions + mesh.vertex_count);
    TEST_ASSERT_TRUE(end <= file + size);
    if (texture.texels != NULL) {
        end = (const uint8_t *)(texture.texels + (1u << (texture.width_log2 + texture.height_log2)));
        TEST_ASSERT_TRUE(end <= file + size);
        TEST_ASSERT_NOT_NULL(mesh.uvs);
    }
}

static void test_fuzzed_files_are_refused_or_safe(void)
{
    uint32_t state = 20261121;
    unsigned accepted = 0;
    for (int round = 0; round < 200000; round++) {
        setUp();
        const uint32_t changes = 1 + next_random(&state) % 4;
        for (uint32_t i = 0; i < changes; i++) {
            /* Mostly the header, where a change does more than alter a number in the data. */
            const uint32_t range = next_random(&state) % 4 != 0 ? HEADER - 16 : SIZE - 16;
            file[16 + next_random(&state) % range] = (uint8_t)next_random(&state);
        }
        const size_t size = next_random(&state) % 8 != 0 ? SIZE : next_random(&state) % (SIZE + 1);
        elm_put(file, 8, (uint32_t)size, 4);
        if (size >= 16) {
            elm_seal(file, size);
        }
        if (el_elm_open(file, size, &mesh, &texture) == EL_ELM_OK) {
            accepted++;
            check_accepted(size);
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT(1000, accepted);
}

static void test_every_status_has_a_line_of_its_own(void)
{
    for (int a = EL_ELM_RANGE; a <= EL_ELM_OK; a++) {
        TEST_ASSERT_NOT_EQUAL(0, strlen(el_elm_message((el_elm_status)a)));
        for (int b = EL_ELM_RANGE; b < a; b++) {
            TEST_ASSERT_NOT_EQUAL(0, strcmp(el_elm_message((el_elm_status)a), el_elm_message((el_elm_status)b)));
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_member_is_a_view_of_the_bytes);
    RUN_TEST(test_absent_sections_are_null);
    RUN_TEST(test_cut_at_every_length);
    RUN_TEST(test_bytes_after_the_end_are_refused);
    RUN_TEST(test_misaligned_bytes_are_refused);
    RUN_TEST(test_every_bit_of_the_file_counts);
    RUN_TEST(test_an_error_writes_nothing);
    RUN_TEST(test_counts_under_a_right_crc);
    RUN_TEST(test_content_under_a_right_crc);
    RUN_TEST(test_a_texture_needs_texture_coordinates);
    RUN_TEST(test_texture_sides_under_a_right_crc);
    RUN_TEST(test_padding_under_a_right_crc);
    RUN_TEST(test_clusters_hold_the_mesh_whole);
    RUN_TEST(test_scale_range);
    RUN_TEST(test_index_range);
    RUN_TEST(test_the_sphere_holds_every_vertex);
    RUN_TEST(test_newer_minor_version_is_read);
    RUN_TEST(test_fuzzed_files_are_refused_or_safe);
    RUN_TEST(test_every_status_has_a_line_of_its_own);
    return UNITY_END();
}
