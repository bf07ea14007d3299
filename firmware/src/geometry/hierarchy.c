#include "geometry/hierarchy.h"

#include "base/fixed.h"
#include "geometry/vector.h"

static uint32_t multiply_scales(uint32_t a_q16, uint32_t b_q16)
{
    const uint64_t product_q16 =
        (el_product_u64(a_q16, b_q16) + EL_UNIT_Q16 / 2) >> 16; /* below 2^64: both are below 2^32 */
    return product_q16 > UINT32_MAX ? UINT32_MAX : (product_q16 == 0 ? 1U : (uint32_t)product_q16);
}

el_pose el_pose_within(const el_pose *parent, const el_pose *local)
{
    el_pose world;
    int64_t place_q16[3];
    for (unsigned i = 0; i < 3; i++) {
        place_q16[i] = el_clamp_place(el_shift_i64((int64_t)parent->scale_q16 * local->position_q16[i], 16)); /* 2^63 */
    }
    for (unsigned i = 0; i < 3; i++) {
        const int32_t *const row = parent->rotation_q30[i];
        for (unsigned j = 0; j < 3; j++) {
            int64_t sum_q58 = 0;
            for (unsigned k = 0; k < 3; k++) {
                sum_q58 += el_product_q58(row[k], local->rotation_q30[k][j]);
            }
            world.rotation_q30[i][j] = el_clamp_unit(el_shift_i64(sum_q58, 28));
        }
        world.position_q16[i] = el_saturate_i32(parent->position_q16[i] + el_vector_along(row, place_q16));
    }
    world.scale_q16 = multiply_scales(parent->scale_q16, local->scale_q16);
    return world;
}

el_status el_hierarchy_update(const el_node *nodes, el_pose *world, uint16_t count)
{
    for (int32_t i = 0; i < count; i++) {
        const el_node *const node = &nodes[i];
        if (node->parent < EL_NO_PARENT || node->parent >= i) {
            return EL_ERROR_ARGUMENT;
        }
        world[i] = node->parent == EL_NO_PARENT ? node->local : el_pose_within(&world[node->parent], &node->local);
    }
    return EL_OK;
}
