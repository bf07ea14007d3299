#include "raster/fog.h"

#include "base/divide.h"
#include "geometry/transform.h"

#if EL_WITH_MIXED

enum {
    FULL_Q15 = 1 << 15,
    LN2_Q30 = 744261118,
    LOG2_E_Q16 = 94548,
    MOST_EXPONENT = 20, /* 2^-20 is nothing of FULL_Q15 */
    TERMS = 8           /* of e^-x, x < ln 2: what is left out is below 2^-22 */
};

/* What a distance is behind, of all. */
typedef struct law {
    uint32_t begin_q16, end_q16; /* linear */
    uint32_t density_q16;        /* exponential; 0: linear */
} law;

/* floor(n / d), which is below 2^32. */
static uint32_t divide(uint64_t n, uint32_t d)
{
    const el_divisor divisor = el_divisor_make(d);
    return el_divide_u64(n, &divisor);
}

/* e^-x, 0..1 in Q15. */
static uint32_t exponential_q15(uint64_t x_q16)
{
    /* e^-x = 2^-whole * e^-(rest * ln 2) */
    const uint64_t log2_q16 = x_q16 >= MOST_EXPONENT << 16 ? MOST_EXPONENT << 16 : x_q16 * LOG2_E_Q16 >> 16;
    const uint32_t whole = (uint32_t)(log2_q16 >> 16);
    const int64_t rest_q30 = (int64_t)((log2_q16 & 0xFFFFU) * LN2_Q30 >> 16);
    /* 1 - x (1 - x/2 (1 - x/3 ...)): each bracket is within 0..1. */
    int64_t sum_q30 = 1 << 30;
    for (int32_t i = TERMS; i > 0; i--) {
        sum_q30 = (1 << 30) - (rest_q30 * sum_q30 >> 30) / i;
    }
    return (uint32_t)((uint64_t)sum_q30 >> 15 >> whole);
}

static uint16_t alpha_at(const law *l, uint32_t distance_q16)
{
    if (l->density_q16 != 0) {
        return (uint16_t)(FULL_Q15 - exponential_q15((uint64_t)distance_q16 * l->density_q16 >> 16));
    }
    if (distance_q16 <= l->begin_q16) {
        return 0;
    }
    if (distance_q16 >= l->end_q16) {
        return FULL_Q15;
    }
    return (uint16_t)divide((uint64_t)(distance_q16 - l->begin_q16) * FULL_Q15, l->end_q16 - l->begin_q16);
}

/* Its nearness, scale * near / distance: the same relation leads back. Distances are near at least. */
static uint32_t other_of(const el_view *view, uint32_t one)
{
    return divide((uint64_t)view->depth_scale_q12 * view->near_q16, one);
}

static uint32_t nearness_of(uint32_t place)
{
    return (uint32_t)((uint64_t)(0x10000U | (place & 0xFFFFU)) << (place >> 16) >> 17);
}

/* The table from where the law is all fog, or from the far plane, to where it is none, or to the near plane. */
static void make_table(el_fog *fog, const el_view *view, const law *l)
{
    const uint32_t begin_q16 = el_min_u32(l->begin_q16, view->far_q16);
    const uint32_t begin = el_fog_place(other_of(view, begin_q16 > view->near_q16 ? begin_q16 : view->near_q16));
    fog->scale_q12 = view->depth_scale_q12;
    fog->end = el_fog_place(other_of(view, el_min_u32(l->end_q16, view->far_q16)));
    fog->step_log2 = 0;
    while (begin > fog->end && (begin - fog->end) >> fog->step_log2 >= EL_FOG_STEPS) {
        fog->step_log2++;
    }
    for (uint32_t i = 0; i < EL_FOG_STEPS + 2U; i++) {
        const uint32_t place = fog->end + (i << fog->step_log2);
        const uint32_t nearness = place < el_fog_place(fog->scale_q12) ? nearness_of(place) : fog->scale_q12;
        fog->alpha_q7[i] = alpha_at(l, other_of(view, nearness));
    }
}

static el_status look_through(el_view *view, const el_camera *camera)
{
    return camera->projection == EL_PERSPECTIVE && el_view_make(view, camera, 1, 1) == EL_OK ? EL_OK : EL_ERROR_CAMERA;
}

el_status el_fog_linear(el_fog *fog, const el_camera *camera, uint16_t colour, uint32_t begin_q16, uint32_t end_q16)
{
    el_view view;
    if (look_through(&view, camera) != EL_OK) {
        return EL_ERROR_CAMERA;
    }
    if (begin_q16 >= end_q16 || end_q16 <= view.near_q16) {
        return EL_ERROR_RANGE;
    }
    fog->colour = colour;
    make_table(fog, &view, &(law){.begin_q16 = begin_q16, .end_q16 = end_q16});
    return EL_OK;
}

el_status el_fog_exponential(el_fog *fog, const el_camera *camera, uint16_t colour, uint32_t density_q16)
{
    /* Times density: where 1/512 of all is left, ln 512, and where there is 1/512 of it, which is about that. */
    enum { END_Q16 = 408838, BEGIN_Q16 = 128 };
    el_view view;
    if (look_through(&view, camera) != EL_OK) {
        return EL_ERROR_CAMERA;
    }
    if (density_q16 == 0) {
        return EL_ERROR_RANGE;
    }
    fog->colour = colour;
    law l = {.density_q16 = density_q16, .begin_q16 = divide((uint64_t)BEGIN_Q16 << 16, density_q16)};
    l.end_q16 = density_q16 > END_Q16 >> 14 ? divide((uint64_t)END_Q16 << 16, density_q16) : view.far_q16;
    l.end_q16 = l.end_q16 > view.near_q16 ? l.end_q16 : view.near_q16;
    l.begin_q16 = l.begin_q16 < l.end_q16 ? l.begin_q16 : l.end_q16;
    make_table(fog, &view, &l);
    return EL_OK;
}
#endif
