#include "geometry/detail.h"

#include "base/fixed.h"
#include "geometry/vector.h"

/* Of the sphere's middle from the camera, along its view, Q16: at least the near plane's. */
static uint32_t distance_q16(const el_view *view, const el_mesh *mesh, const el_pose *pose)
{
    int64_t middle_q16[3]; /* from the model's origin, before it is turned */
    int64_t way_q16[3];    /* from the middle to the camera */
    for (unsigned i = 0; i < 3; i++) {
        /* The product is below 2^47. */
        middle_q16[i] =
            el_clamp_place(el_shift_i64((int64_t)pose->scale_q16 * mesh->centre[i], -(int)mesh->scale_log2));
    }
    for (unsigned i = 0; i < 3; i++) {
        way_q16[i] = el_clamp_place((int64_t)view->position_q16[i] - pose->position_q16[i] -
                                    el_vector_along(pose->rotation_q30[i], middle_q16));
    }
    const int64_t distance = el_vector_along(view->axes_q30[2], way_q16);
    if (distance < (int64_t)view->near_q16) {
        return view->near_q16;
    }
    return distance > UINT32_MAX ? UINT32_MAX : (uint32_t)distance;
}

uint32_t el_screen_size_q4(const el_view *view, const el_mesh *mesh, const el_pose *pose)
{
    /* 2 r focal height / 2 / distance. The product of radius and scale is below 2^48; radii of the world are below 2^15 units,
     * and what is larger saturates. */
    const int64_t radius_q40 = el_shift_i64((int64_t)pose->scale_q16 * mesh->radius, -(mesh->scale_log2 + 24));
    const int64_t before_q20 = el_scale_i64(radius_q40, view->focal[1].mantissa, view->focal[1].exponent + 20);
    const uint64_t most_q20 = 1ULL << 52; /* times a height of 2^11 it is below 2^63 */
    const uint64_t lines_q20 = ((uint64_t)before_q20 < most_q20 ? (uint64_t)before_q20 : most_q20) * view->size[1];
    const bool is_orthographic = EL_WITH_ORTHOGRAPHIC && view->projection == EL_ORTHOGRAPHIC;
    const uint32_t distance = is_orthographic ? EL_UNIT_Q16 : distance_q16(view, mesh, pose); /* not 0 */
    /* NOLINTNEXTLINE(clang-analyzer-core.DivideZero): near is not 0. */
    const uint64_t size_q4 = (lines_q20 + distance / 2U) / distance;
    return size_q4 > UINT32_MAX ? UINT32_MAX : (uint32_t)size_q4;
}

uint8_t el_level_choose(const el_level *levels, uint8_t count, uint32_t size_q4, uint8_t current)
{
    uint8_t level = current < count ? current : (uint8_t)(count - 1U);
    while (level > 0 && size_q4 >= EL_LEVEL_FINER(16U * levels[level - 1].least_px)) {
        level--;
    }
    while (level + 1 < count && size_q4 < 16U * levels[level].least_px) {
        level++;
    }
    return level;
}
