/* Children follow their parents: exactly for quarter turns, near a double's product for any, and in one pass. */
#include "geometry/hierarchy.h"

#include <math.h>
#include <string.h>

#include "seeded.h"

void setUp(void)
{
}

void tearDown(void)
{
}

/* A quarter turn about z, twice as large, at (10, 0, 0): the child's (1, 0, 0) is at (10, 2, 0). */
static void test_a_child_by_hand(void)
{
    el_pose parent = el_pose_identity();
    el_pose_turn(&parent, EL_AXIS_Z, EL_DEGREES(90, 1));
    parent.scale_q16 = 2 * EL_UNIT_Q16;
    parent.position_q16[0] = 10 * EL_UNIT_Q16;
    el_pose local = el_pose_identity();
    local.position_q16[0] = EL_UNIT_Q16;
    local.scale_q16 = EL_UNIT_Q16 / 4;
    el_pose expected = parent;
    expected.position_q16[1] = 2 * EL_UNIT_Q16;
    expected.scale_q16 = EL_UNIT_Q16 / 2;
    const el_pose world = el_pose_within(&parent, &local);
    TEST_ASSERT_EQUAL_MEMORY(&expected, &world, sizeof world);
}

static el_pose any_pose(seeded *s)
{
    el_pose pose = el_pose_identity();
    for (unsigned i = 0; i < 3; i++) {
        el_pose_turn(&pose, (el_axis)i, (el_angle)any_u64(s));
        pose.position_q16[i] = (int32_t)any_signed_of_bits(s, 24);
    }
    pose.scale_q16 = 1 + (uint32_t)any_of_bits(s, 20);
    return pose;
}

/* rotation * (scale * v) + position, in units. */
static void apply(const el_pose *pose, const double v[3], double moved[3])
{
    for (unsigned i = 0; i < 3; i++) {
        moved[i] = pose->position_q16[i] / 65536.0;
        for (unsigned j = 0; j < 3; j++) {
            moved[i] += pose->rotation_q30[i][j] / 1073741824.0 * (pose->scale_q16 / 65536.0) * v[j];
        }
    }
}

static void test_poses_within_poses_seeded(void)
{
    for (seeded s = seeded_from(731); s.round < PART_OF(20000); s.round++) {
        const el_pose parent = any_pose(&s);
        const el_pose local = any_pose(&s);
        const el_pose world = el_pose_within(&parent, &local);
        const double v[3] = {0.5, -0.25, 0.75};
        double inner[3];
        double expected[3];
        double got[3];
        apply(&local, v, inner);
        apply(&parent, inner, expected);
        apply(&world, v, got);
        for (unsigned i = 0; i < 3; i++) {
            /* The position's unit, and half a unit of the scale and of each element times what they scale. */
            const double slack = 2 / 65536.0 + (1 + world.scale_q16 / 65536.0) / 65536.0;
            if (fabs(got[i] - expected[i]) > slack) {
                fail_at(&s, "a point is off by %.3g of %.3g", got[i] - expected[i], slack);
            }
        }
    }
}

/* A chain of eighths of a turn about z, each one unit along its parent's x: an octagon. */
static void test_a_chain_in_one_pass(void)
{
    enum { NODES = 800 };
    static el_node nodes[NODES];
    static el_pose world[NODES];
    for (int16_t i = 0; i < NODES; i++) {
        nodes[i] = (el_node){.parent = (int16_t)(i - 1), .local = el_pose_identity()};
        el_pose_turn(&nodes[i].local, EL_AXIS_Z, EL_DEGREES(45, 1));
        nodes[i].local.position_q16[0] = i > 0 ? EL_UNIT_Q16 : 0;
    }
    TEST_ASSERT_EQUAL_INT(EL_OK, el_hierarchy_update(nodes, world, NODES));
    for (unsigned i = 0; i + 8 < NODES; i += 8) {
        /* After a whole turn it is where it was, but for a unit per node. */
        TEST_ASSERT_INT32_WITHIN(8, world[i].position_q16[0], world[i + 8].position_q16[0]);
        TEST_ASSERT_INT32_WITHIN(8, world[i].position_q16[1], world[i + 8].position_q16[1]);
        TEST_ASSERT_EQUAL_INT32(0, world[i].position_q16[2]);
    }
    TEST_ASSERT_INT32_WITHIN(2, 46341 + 65536, world[2].position_q16[1]); /* sin 45 + sin 90 */
}

static void test_parents_stand_before_their_children(void)
{
    el_node nodes[3] = {{.parent = EL_NO_PARENT}, {.parent = 0}, {.parent = 2}};
    el_pose world[3];
    for (unsigned i = 0; i < 3; i++) {
        nodes[i].local = el_pose_identity();
    }
    memset(world, 0x55, sizeof world);
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_hierarchy_update(nodes, world, 3));
    TEST_ASSERT_EQUAL_MEMORY(&nodes[1].local, &world[1], sizeof world[1]);
    TEST_ASSERT_EACH_EQUAL_HEX8(0x55, &world[2], sizeof world[2]);
    nodes[2].parent = -2;
    TEST_ASSERT_EQUAL_INT(EL_ERROR_ARGUMENT, el_hierarchy_update(nodes, world, 3));
    nodes[2].parent = 1;
    TEST_ASSERT_EQUAL_INT(EL_OK, el_hierarchy_update(nodes, world, 3));
    TEST_ASSERT_EQUAL_INT(EL_OK, el_hierarchy_update(nodes, world, 0));
}

/* Sanitizers look at what these do; scales stay in their range, and what leaves the world does not come back. */
static void test_any_words_do_no_harm(void)
{
    for (seeded s = seeded_from(732); s.round < PART_OF(20000); s.round++) {
        el_pose poses[2];
        for (unsigned i = 0; i < sizeof poses; i++) {
            ((uint8_t *)poses)[i] = (uint8_t)(any_below(&s, 4) == 0 ? 0x80 : any_u64(&s));
        }
        const el_pose world = el_pose_within(&poses[0], &poses[1]);
        TEST_ASSERT_GREATER_THAN_UINT32(0, world.scale_q16);
    }
    el_pose far = el_pose_identity();
    far.position_q16[1] = INT32_MIN;
    far.scale_q16 = UINT32_MAX;
    const el_pose beyond = el_pose_within(&far, &far);
    TEST_ASSERT_EQUAL_INT32(INT32_MIN, beyond.position_q16[1]);
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, beyond.scale_q16);
    far.scale_q16 = 1;
    TEST_ASSERT_EQUAL_UINT32(1, el_pose_within(&far, &far).scale_q16);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_child_by_hand);
    RUN_TEST(test_poses_within_poses_seeded);
    RUN_TEST(test_a_chain_in_one_pass);
    RUN_TEST(test_parents_stand_before_their_children);
    RUN_TEST(test_any_words_do_no_harm);
    return UNITY_END();
}
