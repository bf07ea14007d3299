/* The sides of the view in 32 bits: a position that they call beyond one has the side's bit in its outcode, and of positions
 * that are outside they find most. */
#include "geometry/sides.h"

#include "any_setting.h"

enum { WIDTH = 320, HEIGHT = 240, POSITIONS = 32 };

void setUp(void)
{
}

void tearDown(void)
{
}

#if !EL_SMALL_CODE
/* In the sphere: along each axis within half the radius, or at one of its ends. */
static void any_position(seeded *s, const el_mesh *mesh, int16_t position[3])
{
    const bool at_an_end = any_below(s, 4) == 0;
    const unsigned end = (unsigned)any_below(s, 3);
    for (unsigned i = 0; i < 3; i++) {
        const int32_t reach = at_an_end ? (i == end ? mesh->radius : 0) : mesh->radius / 2;
        const int32_t offset = at_an_end && any_below(s, 2) == 0 ? -reach : (int32_t)any_between(s, -reach, reach);
        const int32_t at = mesh->centre[i] + offset;
        position[i] = (int16_t)(at < INT16_MIN ? INT16_MIN : (at > INT16_MAX ? INT16_MAX : at));
    }
}

static void expect_bounds(const el_side sides[EL_SIDES])
{
    for (unsigned i = 0; i < EL_SIDES; i++) {
        TEST_ASSERT_INT_WITHIN((1 << 28) + (1 << 18), 0, sides[i].offset);
        for (unsigned k = 0; k < 3; k++) {
            TEST_ASSERT_INT_WITHIN(1 << 13, 0, sides[i].elements[k]);
        }
    }
}

static void test_what_is_beyond_a_side_has_its_bit(void)
{
    unsigned outside = 0;
    unsigned found[EL_SIDES] = {0};
    unsigned all_found = 0;
    for (seeded s = seeded_from(71); s.round < PART_OF(40000); s.round++) {
        const setting t = any_setting(&s, 8 + (unsigned)any_below(&s, 20));
        el_view view;
        el_transform transform;
        if (el_view_make(&view, &t.camera, WIDTH, HEIGHT) != EL_OK ||
            el_transform_make(&transform, &view, &t.mesh, &t.pose) != EL_VISIBLE) {
            continue;
        }
        el_side sides[EL_SIDES];
        el_sides_make(sides, &transform, &t.mesh);
        expect_bounds(sides);
        for (unsigned k = 0; k < POSITIONS; k++) {
            int16_t position[3];
            any_position(&s, &t.mesh, position);
            const el_clip_vertex vertex = el_transform_position(&transform, position);
            const unsigned code = el_outcode(&transform, &vertex);
            unsigned passed = 0;
            for (unsigned i = 0; i < EL_SIDES; i++) {
                if (el_side_is_passed(&sides[i], position)) {
                    passed |= 1U << i;
                    found[i]++;
                }
            }
            if ((passed & ~code) != 0) {
                fail_at(&s, "sides %02X passed, outcode %02X", passed, code);
            }
            outside += (code & EL_CODE_OUTSIDE) != 0;
            all_found += passed != 0;
        }
    }
    for (unsigned i = 0; i < EL_SIDES; i++) {
        TEST_ASSERT_GREATER_THAN_UINT(PART_OF(1000), found[i]);
    }
    /* Nearly all; so few because of spheres that are much larger than the view. */
    TEST_ASSERT_GREATER_THAN_UINT(outside / 100 * 90, all_found);
}

static void test_a_triangle_is_beside_the_view_by_one_side(void)
{
    static const el_side sides[EL_SIDES] = {
        {.offset = 0, .elements = {1, 0, 0}}, {.offset = 9, .elements = {-1, 0, 0}},
        {.offset = 0, .elements = {0, 1, 0}}, {.offset = 9, .elements = {0, -1, 0}},
        {.offset = 0, .elements = {0, 0, 1}}, {.offset = 9, .elements = {0, 0, -1}}};
    static const int16_t inside[3][3] = {{0, 0, 0}, {9, 9, 9}, {5, 5, 5}};
    static const int16_t left[3][3] = {{-1, 0, 0}, {-5, 5, 5}, {-9, 9, 9}};
    static const int16_t far[3][3] = {{0, 0, 10}, {9, 9, 11}, {5, 5, 12}};
    static const int16_t second_inside[3][3] = {{-1, 0, 0}, {0, 0, 0}, {-1, 5, 5}};
    static const int16_t third_inside[3][3] = {{0, 12, 0}, {0, 10, 0}, {0, 9, 0}};
    TEST_ASSERT_FALSE(el_sides_are_passed(sides, inside));
    TEST_ASSERT_TRUE(el_sides_are_passed(sides, left));
    TEST_ASSERT_TRUE(el_sides_are_passed(sides, far));
    TEST_ASSERT_FALSE(el_sides_are_passed(sides, second_inside));
    TEST_ASSERT_FALSE(el_sides_are_passed(sides, third_inside));
}
#endif

int main(void)
{
    UNITY_BEGIN();
#if !EL_SMALL_CODE
    RUN_TEST(test_what_is_beyond_a_side_has_its_bit);
    RUN_TEST(test_a_triangle_is_beside_the_view_by_one_side);
#endif
    return UNITY_END();
}
