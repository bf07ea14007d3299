/* el_transform_vertex takes short ways where they are exact: its vertices are el_project's, to the last bit. Millions of
 * clip coordinates, chosen where a short way could go wrong: beside ties, at the view's sides, at w of any size. */
#include "reference_view.h"
#include "seeded.h"

void setUp(void)
{
}

void tearDown(void)
{
}

/* A transform that gives each position the clip coordinates that it is set to. */
static void set_clip(el_transform *transform, int64_t x, int64_t y, int64_t d)
{
    static const int32_t elements[3][3] = {{0}};
    el_transform_set_rows(transform, elements, (const int64_t[3]){x * 2, y * 2, d * 2}, 1);
}

/* One vertex and a series of them: what is in the view is `vertex`, the rest has a side of it and is left for later. */
static void expect_in_view(const el_transform *transform, const int16_t position[3], const el_screen_vertex *vertex)
{
#if EL_SMALL_CODE
    (void)transform, (void)position, (void)vertex; /* has neither */
#else
    const int16_t positions[2][3] = {{position[0], position[1], position[2]}, {position[0], position[1], position[2]}};
    el_screen_vertex found[3] = {0};
    el_transform_vertex_in_view(transform, position, &found[0]);
    el_transform_vertices(transform, positions, 2, &found[1], true);
    for (unsigned i = 0; i < 3; i++) {
        const unsigned sides = found[i].code & EL_CODE_OUTSIDE;
        TEST_ASSERT_EQUAL(vertex->code == 0 ? 0 : sides | EL_CODE_LATER, found[i].code);
        TEST_ASSERT_EQUAL(sides, sides & vertex->code);
        TEST_ASSERT_EQUAL(vertex->code == 0, sides == 0);
        if (vertex->code == 0) {
            TEST_ASSERT_EQUAL(vertex->x, found[i].x);
            TEST_ASSERT_EQUAL(vertex->y, found[i].y);
            TEST_ASSERT_EQUAL(vertex->z, found[i].z);
            TEST_ASSERT_EQUAL(vertex->w, found[i].w);
            TEST_ASSERT_EQUAL(vertex->w_shift, found[i].w_shift);
        }
    }
#endif
}

static void expect_same(const seeded *s, const el_transform *transform, const int16_t position[3])
{
    const el_clip_vertex clip = el_transform_position(transform, position);
    el_screen_vertex expected = {.code = el_outcode(transform, &clip)};
    el_screen_vertex got = {0};
    el_transform_vertex(transform, position, &got);
    bool same = got.code == expected.code;
    if ((expected.code & EL_CODE_CLIP) == 0) {
        el_project(transform, &clip, &expected);
        same = same && got.x == expected.x && got.y == expected.y && got.z == expected.z && got.w == expected.w &&
               got.w_shift == expected.w_shift;
    }
    expect_in_view(transform, position, &got);
    if (!same) {
        fail_at(s, "x %ld, y %ld, d %ld, w %ld: (%ld, %ld), depth %u and code %u, not (%ld, %ld), %u and %u",
                (long)clip.x, (long)clip.y, (long)clip.d, (long)clip.w, (long)got.x, (long)got.y, got.z, got.code,
                (long)expected.x, (long)expected.y, expected.z, expected.code);
    }
}

static void expect_clip(const seeded *s, el_transform *transform, int64_t x, int64_t y, int64_t d)
{
    static const int16_t origin[3] = {0, 0, 0};
    const int64_t limit = INT32_MAX;
    if (x < -limit || x > limit || y < -limit || y > limit || d < 1 || d > limit) {
        return;
    }
    set_clip(transform, x, y, d);
    expect_same(s, transform, origin);
}

/* near in Q16 as cameras have it, in a unit of its own. */
static void set_near(el_transform *transform, uint32_t near_q16, int unit_log2)
{
    el_transform_set_depth(transform, (uint64_t)near_q16 << (16 + unit_log2), transform->depth_scale);
}

static el_transform any_transform(seeded *s)
{
    el_transform transform = {.far = INT32_MAX, .depth_shift = 12, .guard_shift = {0, 0}};
    transform.size[0] = (uint16_t)any_between(s, 1, EL_MAX_WIDTH);
    transform.size[1] = (uint16_t)any_between(s, 1, EL_MAX_HEIGHT);
    /* EL_DEPTH_MAX * far / (far - near), far from 9/8 near to beyond all. */
    transform.depth_scale = (uint32_t)(EL_DEPTH_MAX << 12) + (uint32_t)any_of_bits(s, 31) % (EL_DEPTH_MAX << 15);
    const uint32_t near_q16 = 16 + (uint32_t)any_of_bits(s, 29);
    set_near(&transform, near_q16, (int)any_between(s, 0, 30 - el_bit_length_u32(near_q16) + 16 - 1));
    return transform;
}

/* Where middle + half c / w is between two units, or on one, and at the sides. */
static void expect_beside_ties(seeded *s, el_transform *transform, int64_t w)
{
    const int64_t half = transform->size[0] * (EL_SUBPIXELS / 2);
    const int64_t unit = any_between(s, 0, half);
    const int64_t tie = (2 * unit + 1) * w / (2 * half);
    const int64_t whole = unit * w / half;
    for (int64_t beside = -1; beside <= 2; beside++) {
        expect_clip(s, transform, tie + beside, -tie - beside, w);
        expect_clip(s, transform, -tie - beside, whole + beside, w);
        expect_clip(s, transform, w - beside, beside - w, w);
    }
}

/* Where scale (1 - near / w) is between two units of depth, or on one. */
static void expect_beside_steps_of_depth(seeded *s, el_transform *transform)
{
    const long double near = ldexpl((long double)transform->near_q32, -32);
    const long double scale = transform->depth_scale / 4096.0L;
    const long double depth = (long double)any_between(s, 0, EL_DEPTH_MAX - 1) + (long double)any_below(s, 2) / 2;
    const long double w = near * scale / (scale - depth);
    for (int64_t beside = -2; beside <= 2 && w < 0x1p31L; beside++) {
        expect_clip(s, transform, 0, 0, (int64_t)w + beside);
    }
    expect_clip(s, transform, 0, 0, transform->near);
    expect_clip(s, transform, 0, 0, transform->near - 1);
}

static void test_clip_coordinates_of_all_kinds(void)
{
    for (seeded s = seeded_from(90); s.round < PART_OF(150000); s.round++) {
        el_transform transform = any_transform(&s);
        const int64_t any = 1 + (int64_t)any_of_bits(&s, 31) % INT32_MAX;
        expect_beside_steps_of_depth(&s, &transform);
        transform.near = 1; /* for snapping alone: any w is beyond */
        set_near(&transform, 16, 0);
        expect_beside_ties(&s, &transform, any);
        expect_beside_ties(&s, &transform, (1LL << any_below(&s, 31)) + any_between(&s, -1, 1));
        expect_clip(&s, &transform, any_signed_of_bits(&s, 31), any_signed_of_bits(&s, 31), any);
    }
}

static void test_orthographic_projection(void)
{
    for (seeded s = seeded_from(91); s.round < PART_OF(200000); s.round++) {
        el_transform transform = any_transform(&s);
        transform.orthographic = 1;
        transform.constant_w = (int32_t)(1U << any_between(&s, 8, 30));
        transform.depth_excess = 0;
        transform.depth_scale = (uint32_t)any_u64(&s);
        transform.depth_shift = (uint8_t)any_between(&s, 16, 46);
        transform.far = transform.near + (int32_t)any_of_bits(&s, 30);
        const int64_t x = any_signed_of_bits(&s, (unsigned)el_bit_length_u32((uint32_t)transform.constant_w));
        expect_clip(&s, &transform, x, -x, transform.near + any_signed_of_bits(&s, 30));
        expect_clip(&s, &transform, transform.constant_w, -x, transform.far);
        expect_clip(&s, &transform, x, -transform.constant_w - 1, transform.far + 1LL);
    }
}

/* What el_transform_make prepares: vertices of every kind through it. */
static void test_transforms_of_cameras(void)
{
    static const el_mesh mesh = {.vertex_count = 1, .scale_log2 = -8, .radius = 32767};
    for (seeded s = seeded_from(92); s.round < PART_OF(20000); s.round++) {
        el_camera camera = plain_camera();
        el_view view;
        el_transform transform;
        el_pose pose = el_pose_identity();
        el_pose_turn(&pose, (el_axis)any_below(&s, 3), (el_angle)any_u64(&s));
        camera.near_q16 = 16 + (uint32_t)any_of_bits(&s, 20);
        camera.far_q16 = camera.near_q16 * 2 + (uint32_t)any_of_bits(&s, 28);
        camera.fov_y = (el_angle)any_between(&s, EL_DEGREES(1, 1), EL_DEGREES(179, 1));
        TEST_ASSERT_EQUAL_INT(EL_OK, el_view_make(&view, &camera, 320, 240));
        const int visibility = el_transform_make(&transform, &view, &mesh, &pose);
        if (visibility != EL_VISIBLE) {
            continue; /* too coarse for its field of view, or too near for it */
        }
        for (unsigned i = 0; i < 20; i++) {
            const int16_t position[3] = {(int16_t)any_signed_of_bits(&s, 15), (int16_t)any_signed_of_bits(&s, 15),
                                         (int16_t)any_signed_of_bits(&s, 15)};
            expect_same(&s, &transform, position);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_clip_coordinates_of_all_kinds);
    RUN_TEST(test_orthographic_projection);
    RUN_TEST(test_transforms_of_cameras);
    return UNITY_END();
}
