/* The surface of an .elm of version 2: one small file is read back member by member, then cut at every length, and changed in
 * every way that keeps the CRC right. What is accepted is good for the renderer. */
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "elm_bytes.h"
#include "geometry/elm.h"
#include "raster/texture.h"
#include "unity.h"

#if EL_WITH_MIXED

enum {
    VERTICES = 3,
    HEADER = 32,
    POSITIONS_AT = HEADER,
    TRIANGLES_AT = POSITIONS_AT + 20, /* 18 bytes and 2 of padding */
    UVS_AT = TRIANGLES_AT + 8,        /* 6 + 2 */
    SURFACE_AT = UVS_AT + 12,
    PALETTE_AT = SURFACE_AT + 12,
    TEXELS_AT = PALETTE_AT + 32, /* 16 colours */
    ALPHA_AT = TEXELS_AT + 16,   /* 8 x 4 of 4 bits */
    SMALLER_AT = ALPHA_AT + 32,
    SMALLER_ALPHA_AT = SMALLER_AT + 4, /* 4 x 2 of 4 bits */
    SMALLEST_AT = SMALLER_ALPHA_AT + 8,
    SMALLEST_ALPHA_AT = SMALLEST_AT + 4, /* 2 x 1: a byte and 3 of padding */
    SIZE = SMALLEST_ALPHA_AT + 4,        /* 2 + 2 */
    CONTENT_AT = 21,
    UVS_AND_SURFACE = 8 + 64,
    PLAIN_SIZE = SURFACE_AT + 12 /* with a surface that has no picture */
};

static uint32_t words[SIZE / 4];
static uint8_t *const file = (uint8_t *)words;
static el_mesh mesh;
static el_elm_surface surface;

static el_elm_status open_as(size_t size)
{
    elm_put(file, 8, (uint32_t)size, 4);
    elm_seal(file, size);
    return el_elm_open_surface(file, size, &mesh, &surface);
}

static el_elm_status status_with(size_t at, uint32_t value)
{
    elm_put(file, at, value, 1);
    return open_as(SIZE);
}

void setUp(void)
{
    memset(words, 0, sizeof words);
    memcpy(file, "ELM\x1a\2", 5);
    elm_put(file, 16, VERTICES, 2);
    elm_put(file, 18, 1, 2);
    elm_put(file, CONTENT_AT, UVS_AND_SURFACE, 1);
    elm_put(file, 22, 3, 1);
    elm_put(file, 23, 2, 1);
    elm_put(file, 30, 2, 2);
    elm_put(file, POSITIONS_AT + 6, 1, 2);
    elm_put(file, POSITIONS_AT + 14, 1, 2);
    elm_put(file, TRIANGLES_AT + 2, 0x00020001, 4);
    static const uint8_t head[12] = {
        EL_MATERIAL_TWO_SIDED, 128, EL_IMAGE_INDEX4, 3, EL_WRAP_CLAMP, EL_WRAP_MIRROR, 7, 0, 15};
    memcpy(file + SURFACE_AT, head, sizeof head);
    for (uint8_t i = 0; i < 32; i++) {
        file[PALETTE_AT + i] = (uint8_t)(i + 1);
        file[ALPHA_AT + i] = (uint8_t)(8 * i);
    }
    memset(file + TEXELS_AT, 0x5A, 16);
    memset(file + SMALLER_AT, 0x3C, 4);
    memset(file + SMALLER_ALPHA_AT, 77, 8);
    file[SMALLEST_AT] = 0xE1;
    file[SMALLEST_ALPHA_AT] = 9;
}

void tearDown(void)
{
}

static void test_every_member_is_what_the_file_says(void)
{
    static const size_t texels_at[3] = {TEXELS_AT, SMALLER_AT, SMALLEST_AT};
    static const size_t alpha_at[3] = {ALPHA_AT, SMALLER_ALPHA_AT, SMALLEST_ALPHA_AT};
    TEST_ASSERT_EQUAL_INT(EL_ELM_OK, open_as(SIZE));
    TEST_ASSERT_EQUAL_PTR(file + UVS_AT, mesh.uvs);
    TEST_ASSERT_EQUAL_UINT8(EL_MATERIAL_TWO_SIDED, surface.flags);
    TEST_ASSERT_EQUAL_UINT8(128, surface.alpha);
    TEST_ASSERT_TRUE(el_texture_is_good(&surface.levels[0]));
    for (unsigned i = 0; i < 3 && i < EL_ELM_LEVELS; i++) {
        const el_texture *const level = &surface.levels[i];
        TEST_ASSERT_NULL(level->texels);
        TEST_ASSERT_EQUAL_PTR(&surface.images[i], level->image);
        TEST_ASSERT_EQUAL_UINT8(EL_WRAP_CLAMP, level->wrap_u);
        TEST_ASSERT_EQUAL_UINT8(EL_WRAP_MIRROR, level->wrap_v);
        TEST_ASSERT_TRUE(level->smooth);
#if EL_WITH_MIPMAPS
        TEST_ASSERT_EQUAL_PTR(i < 2 ? &surface.levels[i + 1] : NULL, level->smaller);
#endif
        TEST_ASSERT_EQUAL_UINT16(8 >> i, level->image->width);
        TEST_ASSERT_EQUAL_UINT16(4 >> i, level->image->height);
        TEST_ASSERT_EQUAL_UINT8(EL_IMAGE_INDEX4, level->image->format);
        TEST_ASSERT_TRUE(level->image->has_key);
        TEST_ASSERT_EQUAL_UINT16(15, level->image->key);
        TEST_ASSERT_EQUAL_PTR(file + texels_at[i], level->image->pixels);
        TEST_ASSERT_EQUAL_PTR(file + PALETTE_AT, level->image->palette);
        TEST_ASSERT_EQUAL_PTR(file + alpha_at[i], level->image->alpha);
    }
}

/* 8 x 4 texels and nothing else: what the fastest loops draw, but for its borders. */
static void test_bare_texels_are_no_image(void)
{
    elm_put(file, SURFACE_AT + 2, EL_IMAGE_RGB565, 1);
    elm_put(file, SURFACE_AT + 3, 1, 1);
    elm_put(file, SURFACE_AT + 6, 0, 1);
    elm_put(file, SURFACE_AT + 8, 0, 1);
    TEST_ASSERT_EQUAL_INT(EL_ELM_OK, open_as(PALETTE_AT + 64));
    TEST_ASSERT_EQUAL_PTR(file + PALETTE_AT, surface.levels[0].texels);
    TEST_ASSERT_NULL(surface.levels[0].image);
    TEST_ASSERT_EQUAL_UINT8(3, surface.levels[0].width_log2);
    TEST_ASSERT_EQUAL_UINT8(2, surface.levels[0].height_log2);
    TEST_ASSERT_FALSE(surface.levels[0].smooth);
    TEST_ASSERT_TRUE(el_texture_is_good(&surface.levels[0]));
}

static void test_a_surface_without_a_picture(void)
{
    memset(file + SURFACE_AT + 2, 0, 10);
    elm_put(file, 22, 0, 2);
    TEST_ASSERT_EQUAL_INT(EL_ELM_OK, open_as(PLAIN_SIZE));
    TEST_ASSERT_NULL(surface.levels[0].texels);
    TEST_ASSERT_NULL(surface.levels[0].image);
    TEST_ASSERT_EQUAL_UINT8(128, surface.alpha);
    for (size_t at = SURFACE_AT + 2; at < PLAIN_SIZE; at++) {
        elm_put(file, at, 1, 1);
        TEST_ASSERT_EQUAL_INT(EL_ELM_CORRUPT, open_as(PLAIN_SIZE));
        elm_put(file, at, 0, 1);
    }
    elm_put(file, 23, 1, 1);
    TEST_ASSERT_EQUAL_INT(EL_ELM_CORRUPT, open_as(PLAIN_SIZE));
}

static void test_a_picture_needs_texture_coordinates(void)
{
    memmove(file + UVS_AT, file + SURFACE_AT, SIZE - SURFACE_AT);
    elm_put(file, CONTENT_AT, 64, 1);
    elm_put(file, 22, 0, 2);
    elm_put(file, UVS_AT + 3, 1, 1);
    for (size_t size = UVS_AT + 12; size <= SIZE; size += 4) {
        TEST_ASSERT_EQUAL_INT(EL_ELM_CORRUPT, open_as(size));
    }
}

static void test_versions_are_told_apart(void)
{
    el_texture texture;
    TEST_ASSERT_EQUAL_INT(EL_ELM_OK, open_as(SIZE));
    TEST_ASSERT_EQUAL_INT(EL_ELM_VERSION, el_elm_open(file, SIZE, &mesh, &texture));
    elm_put(file, 4, 3, 1);
    TEST_ASSERT_EQUAL_INT(EL_ELM_VERSION, open_as(SIZE));
    elm_put(file, 4, 0, 1);
    TEST_ASSERT_EQUAL_INT(EL_ELM_VERSION, open_as(SIZE));
    elm_put(file, 4, 1, 1);
    TEST_ASSERT_EQUAL_INT(EL_ELM_CORRUPT, open_as(SIZE));
    /* As a file of version 1 it has no surface. */
    elm_put(file, CONTENT_AT, 8, 1);
    elm_put(file, 22, 0, 2);
    TEST_ASSERT_EQUAL_INT(EL_ELM_OK, open_as(SURFACE_AT));
    TEST_ASSERT_EQUAL_UINT8(255, surface.alpha);
    TEST_ASSERT_EQUAL_UINT8(0, surface.flags);
    TEST_ASSERT_NULL(surface.levels[0].texels);
    elm_put(file, 4, 2, 1);
    TEST_ASSERT_EQUAL_INT(EL_ELM_CORRUPT, open_as(SURFACE_AT));
}

static void test_cut_at_every_length(void)
{
    for (size_t size = HEADER; size < SIZE; size++) {
        /* Memory of exactly that size, so that a sanitizer sees any read beyond it. */
        setUp();
        TEST_ASSERT_NOT_EQUAL(EL_ELM_OK, open_as(size));
        uint8_t *const cut = malloc(size);
        TEST_ASSERT_NOT_NULL(cut);
        memcpy(cut, file, size);
        TEST_ASSERT_EQUAL_INT(EL_ELM_CORRUPT, el_elm_open_surface(cut, size, &mesh, &surface));
        free(cut);
    }
}

/* Of each byte of the head, all values: those that are left out are the good ones. */
static void test_the_head_under_a_right_crc(void)
{
    static const uint8_t accepted[12] = {2, 255, 1, 1, 3, 3, 2, 1, 16, 1, 1, 1};
    for (size_t at = 0; at < 12; at++) {
        unsigned good = 0;
        for (uint32_t value = 0; value < 256; value++) {
            setUp();
            if (status_with(SURFACE_AT + at, value) == EL_ELM_OK) {
                good++;
                TEST_ASSERT_TRUE(el_texture_is_good(&surface.levels[0]));
            }
        }
        TEST_ASSERT_EQUAL_UINT(accepted[at], good);
    }
}

static void test_padding_is_zero(void)
{
    static const size_t padding[] = {SMALLEST_AT + 1, SMALLEST_AT + 3, SMALLEST_ALPHA_AT + 2, SIZE - 1};
    for (size_t i = 0; i < sizeof padding / sizeof *padding; i++) {
        setUp();
        const el_mesh mesh_before = mesh;
        const el_elm_surface surface_before = surface;
        TEST_ASSERT_EQUAL_INT(EL_ELM_CORRUPT, status_with(padding[i], 1));
        TEST_ASSERT_EQUAL_MEMORY(&mesh_before, &mesh, sizeof mesh);
        TEST_ASSERT_EQUAL_MEMORY(&surface_before, &surface, sizeof surface);
    }
}

static uint32_t next_random(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u; /* Numerical Recipes' generator */
    return *state >> 8;
}

static void test_changed_files_are_refused_or_good(void)
{
    uint32_t state = 20261122;
    unsigned accepted = 0;
    for (int round = 0; round < 100000; round++) {
        setUp();
        for (uint32_t changes = 1 + next_random(&state) % 3; changes > 0; changes--) {
            const bool in_head = next_random(&state) % 2 != 0;
            const uint32_t at = in_head ? SURFACE_AT + next_random(&state) % 12 : 16 + next_random(&state) % 16;
            elm_put(file, at, next_random(&state) % 2 != 0 ? next_random(&state) % 12 : next_random(&state), 1);
        }
        if (open_as(SIZE - next_random(&state) % 8 * 4) == EL_ELM_OK) {
            accepted++;
            const el_texture *const texture = &surface.levels[0];
            TEST_ASSERT_TRUE((texture->texels == NULL && texture->image == NULL) || el_texture_is_good(texture));
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT(1000, accepted);
}

#else
void setUp(void)
{
}

void tearDown(void)
{
}
#endif

int main(void)
{
    UNITY_BEGIN();
#if EL_WITH_MIXED
    RUN_TEST(test_every_member_is_what_the_file_says);
    RUN_TEST(test_bare_texels_are_no_image);
    RUN_TEST(test_a_surface_without_a_picture);
    RUN_TEST(test_a_picture_needs_texture_coordinates);
    RUN_TEST(test_versions_are_told_apart);
    RUN_TEST(test_cut_at_every_length);
    RUN_TEST(test_the_head_under_a_right_crc);
    RUN_TEST(test_padding_is_zero);
    RUN_TEST(test_changed_files_are_refused_or_good);
#endif
    return UNITY_END();
}
