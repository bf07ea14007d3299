/* What is done once per frame and once per draw: from a camera to a view, from a mesh's pose to the rows of its draw.
 *
 * Everything is chosen from the mesh's bounding sphere, so that what is done per vertex (vertex.c) keeps its widths. */
#include "geometry/transform.h"

#include <stdbool.h>
#include <string.h>

#include "base/divide.h"
#include "geometry/cull.h"

/* Position of models and cameras, Q16.16: +-16384 units. */
#define MAX_POSITION_Q16 (1 << 30)

/* value_q32 >= 1 */
static el_factor factor_from_q32(uint64_t value_q32)
{
    el_factor factor = {.exponent = 32};
    for (; value_q32 >> 31 != 0; value_q32 >>= 1) {
        factor.exponent--;
    }
    for (; value_q32 >> 30 == 0; value_q32 <<= 1) {
        factor.exponent++;
    }
    factor.mantissa = (uint32_t)value_q32;
    return factor;
}

/* The guard band about the screen's middle: half the size, times 1 + 2^shift, at most EL_GUARD_PX from the origin. */
static uint8_t guard_shift(uint16_t size)
{
    uint8_t shift = 0;
    while (size * (1 + (2 << shift)) <= 2 * EL_GUARD_PX) {
        shift++;
    }
    return shift;
}

/* A rotation and a position: EL_ERROR_CAMERA when an element is beyond +-1, EL_ERROR_RANGE when the place is outside the
 * world. */
static el_status check_place(const int32_t matrix_q30[3][3], const int32_t position_q16[3])
{
    /* A few units of rounding beyond 1 are no error of the caller's. */
    const uint32_t unit = EL_UNIT_Q30 + 16;
    for (unsigned i = 0; i < 3; i++) {
        for (unsigned j = 0; j < 3; j++) {
            if ((uint32_t)matrix_q30[i][j] + unit > 2U * unit) {
                return EL_ERROR_CAMERA;
            }
        }
    }
    for (unsigned i = 0; i < 3; i++) {
        if ((uint32_t)position_q16[i] + MAX_POSITION_Q16 > 2U * MAX_POSITION_Q16) {
            return EL_ERROR_RANGE;
        }
    }
    return EL_OK;
}

static bool is_orthographic(const el_view *view)
{
    return EL_WITH_ORTHOGRAPHIC && view->projection == EL_ORTHOGRAPHIC;
}

/* floor(n / d), n < 2^63. */
static uint64_t divide(uint64_t n, uint32_t d)
{
    const el_divisor divisor = el_divisor_make(d);
    return (uint64_t)el_divide_q32((int64_t)(n >> 32), (uint32_t)n, &divisor);
}

el_status el_view_make(el_view *view, const el_camera *camera, uint16_t width, uint16_t height)
{
    if (width < 1 || width > EL_MAX_WIDTH || height < 1 || height > EL_MAX_HEIGHT) {
        return EL_ERROR_SIZE;
    }
    const uint32_t near = camera->near_q16;
    const uint32_t far = camera->far_q16;
    const uint32_t aspect = camera->aspect_q16;
    if (near < 16 || far > MAX_POSITION_Q16 || near > far || far - near < (near + 7) / 8 ||
        (aspect != 0 && (aspect < 256 || aspect > 1U << 24))) {
        return EL_ERROR_CAMERA;
    }
    const el_status place = check_place(camera->axes_q30, camera->position_q16);
    if (place != EL_OK) {
        return place;
    }

    /* The focal factor of y, 2^25 < focal_q32 < 2^39 in perspective, at most 2^41 in orthographic projection, is
     * cosine / sine or 2^17 / height. */
    uint32_t numerator;
    uint32_t denominator;
    if (camera->projection == EL_PERSPECTIVE) {
        if (camera->fov_y < EL_DEGREES(1, 1) || camera->fov_y > EL_DEGREES(179, 1)) {
            return EL_ERROR_CAMERA;
        }
        numerator = (uint32_t)el_cos_q30(camera->fov_y / 2);
        denominator = (uint32_t)el_sin_q30(camera->fov_y / 2);
    } else {
        if (!EL_WITH_ORTHOGRAPHIC || camera->projection != EL_ORTHOGRAPHIC || camera->height_q16 < 256 ||
            camera->height_q16 > 2U * MAX_POSITION_Q16) {
            return EL_ERROR_CAMERA;
        }
        numerator = 1U << 17;
        denominator = camera->height_q16;
    }
    uint64_t focal_q32[2];
    focal_q32[1] = divide((uint64_t)numerator << 32, denominator);
    focal_q32[0] = divide(focal_q32[1] * (aspect != 0 ? 1U << 16 : height), aspect != 0 ? aspect : width);

    memcpy(view->axes_q30, camera->axes_q30, sizeof view->axes_q30);
    memcpy(view->position_q16, camera->position_q16, sizeof view->position_q16);
    view->projection = camera->projection;
    view->near_q16 = near;
    view->far_q16 = far;
    /* far >= 9/8 near, so far / (far - near) <= 9 and the scale is at most 65534 * 9 * 2^12 < 2^32. */
    view->depth_scale_q12 = (uint32_t)divide(((uint64_t)EL_DEPTH_MAX * far) << 12, far - near);
    view->size[0] = width;
    view->size[1] = height;
    for (unsigned i = 0; i < 2; i++) {
        view->focal[i] = factor_from_q32(focal_q32[i]);
        view->guard_shift[i] = guard_shift(view->size[i]);
    }
    return EL_OK;
}

void el_view_cut_pixels(el_view *view, uint16_t columns)
{
    view->size[0] = (uint16_t)(view->size[0] * columns);
    view->guard_shift[0] = guard_shift(view->size[0]);
}

/* Sign of the determinant: true for a reflection. */
static bool is_reflection(const int32_t m_q30[3][3])
{
    /* 16 bits of each element: products of three below 2^46. */
    return el_determinant_is_negative(m_q30, 15);
}

/* A coordinate in view space as a linear form on positions, in world units: at[0..2] are the coefficients of x, y and z,
 * at[3] is added; Q44. World positions differ by at most 2^15 per axis and meshes reach at most 2^15 from their origin
 * (checked), so offsets and sums stay below 3 * 2^59. The rows that are drawn with come from `exact`, which keeps the bits
 * of small scales: exact * 2^exponent is a row's element in world units, |exact| < 2^60. */
enum { FORM_BITS = 44, OFFSET = 3 };

typedef struct el_form {
    int64_t at[4];
    int64_t exact[3];
} el_form;

static int64_t form_at_centre(const el_form *form, const el_mesh *mesh)
{
    int64_t value = form->at[OFFSET];
    for (unsigned i = 0; i < 3; i++) {
        value += (int64_t)el_multiply_u64((uint64_t)form->at[i], mesh->centre[i]);
    }
    return value;
}

/* The most that the form differs from its value at the centre, within a sphere that is a unit larger, and two at least:
 * the length of its row, rounded up, times the radius. So a row is no longer than half of what coordinates may be. */
static int64_t form_reach(const el_form *form, const el_mesh *mesh)
{
    uint64_t all = 0;
    for (unsigned i = 0; i < 3; i++) {
        all |= el_abs_u64(form->at[i]);
    }
    const int shift = el_max_i32(0, el_bit_length_u64(all) - 30);
    uint64_t sum = 0;
    for (unsigned i = 0; i < 3; i++) {
        const uint32_t part = (uint32_t)(el_abs_u64(form->at[i]) >> shift) + 1U;
        sum += el_product_u64(part, part);
    }
    return (int64_t)((((uint64_t)el_sqrt_u64(sum) + 1U) << shift) * ((uint32_t)el_max_i32(mesh->radius, 1) + 1U));
}

/* value * factor * 2^-shift, rounded. */
static int64_t scale_by(int64_t value, el_factor factor, int shift)
{
    const int total = factor.exponent + shift;
    if (total > 94) {
        return 0;
    }
    return total >= 0 ? el_scale_i64(value, factor.mantissa, total)
                      : el_shift_i64(el_scale_i64(value, factor.mantissa, 0), total);
}

/* The view-space rows of the mesh: right, up, distance. False when the mesh leaves the world. */
static bool view_forms(const el_view *view, const el_mesh *mesh, const el_pose *pose, el_form forms[3], int *exponent)
{
    /* The scale with at most 28 bits: model scales below 4096 with their whole fraction. */
    const int scale_shift = el_max_i32(0, el_bit_length_u32(pose->scale_q16) - 28);
    const int64_t scale = pose->scale_q16 >> scale_shift;
    *exponent = scale_shift + mesh->scale_log2 - (30 + 16);
    /* |row| * reach < 2^(FORM_BITS + 15) */
    const int row_bits = FORM_BITS + 15 - el_bit_length_u32(el_cull_reach(mesh));

    for (unsigned i = 0; i < 3; i++) {
        const int32_t *const axis = view->axes_q30[i];
        el_form *const form = &forms[i];
        int64_t offset = 0;
        for (unsigned j = 0; j < 3; j++) {
            /* Q30 * Q16 is Q46; positions within +-2^30 differ by at most 2^31, so a term is at most 2^61. */
            offset += (int64_t)axis[j] * ((int64_t)pose->position_q16[j] - view->position_q16[j]);
            form->exact[j] =
                el_shift_i64(el_dot_column(axis, pose->rotation_q30, j), 30) * scale; /* below 2^32 * 2^28 */
        }
        form->at[OFFSET] = el_shift_i64(offset, 46 - FORM_BITS);
        if (i == 2) { /* distance runs against the backward axis */
            form->at[OFFSET] = -form->at[OFFSET];
            for (unsigned j = 0; j < 3; j++) {
                form->exact[j] = -form->exact[j];
            }
        }
        for (unsigned j = 0; j < 3; j++) {
            form->at[j] = el_shift_i64(form->exact[j], -(*exponent + FORM_BITS));
            if (el_abs_u64(form->at[j]) >> row_bits != 0) {
                return false;
            }
        }
    }
    return true;
}

/* Whether the sphere lies outside of one of the planes of the view: form 2 less near, far less form 2, and with form 2 or 1
 * for w, w - x, w + x, w - y, w + y; inside where they are not negative. They are divided by a power of two that is larger
 * than 1 + focal, so that their values are no larger than the forms'. Rows and offsets are rounded to a unit, and a row
 * times a position is off by 2^16 units then: the sphere gets that much more room. */
static bool sphere_is_outside(const el_view *view, const el_mesh *mesh, const el_form forms[3],
                              const el_factor factors[3])
{
    static const el_form constant = {.at = {0, 0, 0, (int64_t)1 << FORM_BITS}};
    const el_form *const w = is_orthographic(view) ? &constant : &forms[2];
    int64_t scaled[4] = {0};
    for (unsigned i = 0; i < 6; i++) {
        const el_factor factor = factors[i / 2];
        const int shift = el_max_i32(1, 32 - factor.exponent);
        const bool upper = (i & 1U) != 0;
        el_form plane;
        for (unsigned j = 0; j < 4; j++) {
            scaled[j] = upper ? -scaled[j] : scale_by(forms[i / 2].at[j], factor, shift);
            plane.at[j] = scaled[j] + (i < 4 ? el_shift_i64(w->at[j], shift) : 0);
        }
        if (i >= 4) {
            const int64_t limit_q16 = upper ? view->far_q16 : -(int64_t)view->near_q16;
            plane.at[OFFSET] += limit_q16 * ((int64_t)1 << (FORM_BITS - 16)) >> shift;
        }
        if (form_at_centre(&plane, mesh) + form_reach(&plane, mesh) + (1LL << 20) < 0) {
            return true;
        }
    }
    return false;
}

/* The most that |form| can be within the sphere, below 2^62. */
static uint64_t bound_of(const el_form *form, const el_mesh *mesh)
{
    return el_abs_u64(form_at_centre(form, mesh)) + (uint64_t)form_reach(form, mesh);
}

/* In orthographic projection w is constant and may be any unit: 2^w_log2 world units, no less than the mesh's distance can
 * be, so that x and y have the bits that d needs anyway, wherever the camera stands. */
static int choose_w_log2(const el_view *view, const el_mesh *mesh, const el_form forms[3])
{
    if (!is_orthographic(view)) {
        return 0;
    }
    return el_max_i32(0, el_bit_length_u64(bound_of(&forms[2], mesh)) - FORM_BITS);
}

/* The draw's unit, 2^-unit world units: the smallest in which |x|, |y|, d and w are below 2^30 for the whole sphere. */
static int choose_unit(const el_view *view, const el_mesh *mesh, const el_form forms[3], const el_factor factors[3],
                       int w_log2)
{
    /* Wide fields of view have focal factors up to 2^17, so the largest coordinate is taken with 22 bits less. */
    enum { COARSE = 22 };
    int64_t largest = is_orthographic(view) ? (int64_t)1 << (FORM_BITS - COARSE + w_log2) : 1;
    for (unsigned i = 0; i < 3; i++) {
        /* Saturated where it does not fit: far beyond what MIN_UNIT_LOG2 lets through. */
        const int64_t scaled = scale_by((int64_t)bound_of(&forms[i], mesh), factors[i], COARSE);
        largest = scaled >= largest ? scaled | 1 : largest;
    }
    return 30 - (el_bit_length_u64((uint64_t)largest) - (FORM_BITS - COARSE));
}

/* A coarser unit leaves too few bits to d, or to the constant w: meshes of thousands of units before a camera whose
 * picture is a fraction of one across. */
enum { MIN_UNIT_LOG2 = 0, MIN_W_BITS_ORTHOGRAPHIC = 8 };

/* EL_DEPTH_MAX / (far - near) per unit, its mantissa below 2^32; w_log2: of the constant w. */
static void make_orthographic(el_transform *transform, const el_view *view, int unit_log2, int w_log2)
{
    transform->constant_w = (int32_t)el_shift_i64(1, -(unit_log2 + w_log2));
    uint64_t scale = divide((uint64_t)EL_DEPTH_MAX << 46, view->far_q16 - view->near_q16); /* Q16 world units */
    int shift = 46 - 16 + unit_log2;
    const int bits = el_bit_length_u64(scale) - 32;
    if (bits > 0) {
        scale >>= bits;
        shift -= bits;
    }
    transform->depth_scale = (uint32_t)scale;
    transform->depth_shift = (uint8_t)shift;
    transform->depth_excess = 0;
}

int el_transform_make(el_transform *transform, const el_view *view, const el_mesh *mesh, const el_pose *pose)
{
    el_form forms[3];
    int exponent;
    if (check_place(pose->rotation_q30, pose->position_q16) != EL_OK || pose->scale_q16 == 0 ||
        mesh->scale_log2 < -30 || mesh->scale_log2 > 8) {
        return EL_ERROR_RANGE;
    }
    if (!EL_SMALL_CODE && el_cull_is_far_outside(view, mesh, pose)) {
        return EL_CULLED;
    }
    if (!view_forms(view, mesh, pose, forms, &exponent)) {
        return EL_ERROR_RANGE;
    }
    el_factor factors[3] = {view->focal[0], view->focal[1], {.mantissa = 1U << 30, .exponent = 30}};
    if (sphere_is_outside(view, mesh, forms, factors)) {
        return EL_CULLED;
    }

    const int w_log2 = choose_w_log2(view, mesh, forms);
    factors[0].exponent = (int16_t)(factors[0].exponent - w_log2);
    factors[1].exponent = (int16_t)(factors[1].exponent - w_log2);
    const int unit_log2 = choose_unit(view, mesh, forms, factors, w_log2);
    if (unit_log2 < MIN_UNIT_LOG2 || (is_orthographic(view) && unit_log2 + w_log2 < MIN_W_BITS_ORTHOGRAPHIC)) {
        return EL_ERROR_RANGE;
    }

    /* Rows with 31 extra bits first, then as many bits less as the largest element needs to fit EL_ROW_BITS. Meshes of a
     * unit or two keep up to 30: a row is shorter than 2^30 then, and its elements add up to sqrt(3) of that. */
    uint64_t all = 0;
    for (unsigned i = 0; i < 3; i++) {
        for (unsigned j = 0; j < 3; j++) {
            int64_t *const element = &forms[i].exact[j];
            *element = scale_by(*element, factors[i], -(exponent + unit_log2 + 31));
            all |= el_abs_u64(*element);
        }
    }
    const int drop = el_max_i32(0, el_min_i32(30, el_bit_length_u64(all) - EL_ROW_BITS));
    const int shift = 31 - drop;
    int32_t elements[3][3];
    int64_t offsets[3];
    for (unsigned i = 0; i < 3; i++) {
        for (unsigned j = 0; j < 3; j++) {
            elements[i][j] = (int32_t)el_shift_i64(forms[i].exact[j], drop);
        }
        /* Rounding of the shifted sum is made here, once. */
        const int64_t half = (int64_t)1 << (shift - 1);
        offsets[i] = scale_by(forms[i].at[OFFSET], factors[i], FORM_BITS - unit_log2 - shift) + half;
    }
    el_transform_set_rows(transform, (const int32_t(*)[3])elements, offsets, (unsigned)shift);

    transform->orthographic = is_orthographic(view);
    transform->mirrored = is_reflection(view->axes_q30) != is_reflection(pose->rotation_q30);
    memcpy(transform->guard_shift, view->guard_shift, sizeof transform->guard_shift);
    memcpy(transform->size, view->size, sizeof transform->size);

    /* The sphere reaches beyond the near plane, so near < 2^30 in the draw's unit. */
    const int64_t near_q32 = el_shift_i64(view->near_q16, 16 - unit_log2 - 32);
    const int64_t far_q32 = el_shift_i64(view->far_q16, 16 - unit_log2 - 32);
    el_transform_set_depth(transform, (uint64_t)near_q32, view->depth_scale_q12);
    transform->far = far_q32 >= (int64_t)INT32_MAX << 32 ? INT32_MAX : (int32_t)((far_q32 + 0xFFFFFFFFLL) >> 32);
    transform->constant_w = 0;
    if (is_orthographic(view)) {
        make_orthographic(transform, view, unit_log2, w_log2);
    }
    return EL_VISIBLE;
}
