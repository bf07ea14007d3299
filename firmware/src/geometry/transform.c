#include "geometry/transform.h"

#include <stdbool.h>

#include "base/fixed.h"

_Static_assert(EL_SUBPIXEL_BITS > 4 || EL_GUARD_SUB < 32767, "rounding may add a unit");

/* Position of models and cameras, Q16.16: +-16384 units. */
#define MAX_POSITION_Q16 (1 << 30)

static el_factor factor_from_q32(uint64_t value_q32)
{
    const int shift = el_bit_length_u64(value_q32) - 31;
    const uint64_t mantissa = shift >= 0 ? value_q32 >> shift : value_q32 << -shift;
    return (el_factor){.mantissa = (uint32_t)mantissa, .exponent = (int16_t)(32 - shift)};
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

static bool outside_unit(const int32_t matrix_q30[3][3])
{
    /* A few units of rounding beyond 1 are no error of the caller's. */
    const uint64_t limit = EL_UNIT_Q30 + 16;
    for (unsigned i = 0; i < 9; i++) {
        if (el_abs_u64(matrix_q30[i / 3][i % 3]) > limit) {
            return true;
        }
    }
    return false;
}

static bool outside_world(const int32_t position_q16[3])
{
    for (unsigned i = 0; i < 3; i++) {
        if (el_abs_u64(position_q16[i]) > MAX_POSITION_Q16) {
            return true;
        }
    }
    return false;
}

el_status el_view_make(el_view *view, const el_camera *camera, uint16_t width, uint16_t height)
{
    if (width < 1 || width > EL_MAX_WIDTH || height < 1 || height > EL_MAX_HEIGHT) {
        return EL_ERROR_SIZE;
    }
    const uint64_t near = camera->near_q16;
    const uint64_t far = camera->far_q16;
    if ((camera->projection != EL_PERSPECTIVE && camera->projection != EL_ORTHOGRAPHIC) ||
        outside_unit(camera->axes_q30) || near < 16 || far < near + (near + 7) / 8 || far > MAX_POSITION_Q16 ||
        (camera->aspect_q16 != 0 && (camera->aspect_q16 < 256 || camera->aspect_q16 > (1U << 24)))) {
        return EL_ERROR_CAMERA;
    }
    if (outside_world(camera->position_q16)) {
        return EL_ERROR_RANGE;
    }

    uint64_t focal_q32; /* of y: 2^25 < focal_q32 < 2^39 in perspective, at most 2^41 in orthographic projection */
    if (camera->projection == EL_PERSPECTIVE) {
        if (camera->fov_y < EL_DEGREES(1, 1) || camera->fov_y > EL_DEGREES(179, 1)) {
            return EL_ERROR_CAMERA;
        }
        const uint64_t cosine = (uint64_t)el_cos_q30(camera->fov_y / 2);
        focal_q32 = (cosine << 32) / (uint64_t)el_sin_q30(camera->fov_y / 2);
    } else {
        if (camera->height_q16 < 256 || camera->height_q16 > 2U * MAX_POSITION_Q16) {
            return EL_ERROR_CAMERA;
        }
        focal_q32 = (1ULL << 49) / camera->height_q16;
    }
    const uint64_t focal_x_q32 =
        camera->aspect_q16 != 0 ? (focal_q32 << 16) / camera->aspect_q16 : focal_q32 * height / width;

    for (unsigned i = 0; i < 9; i++) {
        view->axes_q30[i / 3][i % 3] = camera->axes_q30[i / 3][i % 3];
    }
    for (unsigned i = 0; i < 3; i++) {
        view->position_q16[i] = camera->position_q16[i];
    }
    view->projection = camera->projection;
    view->focal[0] = factor_from_q32(focal_x_q32);
    view->focal[1] = factor_from_q32(focal_q32);
    view->near_q16 = camera->near_q16;
    view->far_q16 = camera->far_q16;
    /* far >= 9/8 near, so far / (far - near) <= 9 and the scale is at most 65534 * 9 * 2^12 < 2^32. */
    view->depth_scale_q12 = (uint32_t)(((EL_DEPTH_MAX * far) << 12) / (far - near));
    view->size[0] = width;
    view->size[1] = height;
    view->guard_shift[0] = guard_shift(width);
    view->guard_shift[1] = guard_shift(height);
    return EL_OK;
}

/* Sign of the determinant: true for a reflection. */
static bool is_reflection(const int32_t m_q30[3][3])
{
    /* 16 bits of each element: products of three below 2^46. */
    int64_t determinant = 0;
    for (unsigned j = 0; j < 3; j++) {
        const unsigned k = (j + 1U) % 3U;
        const unsigned l = (j + 2U) % 3U;
        const int64_t minor =
            (int64_t)(m_q30[1][k] >> 15) * (m_q30[2][l] >> 15) - (int64_t)(m_q30[1][l] >> 15) * (m_q30[2][k] >> 15);
        determinant += (m_q30[0][j] >> 15) * minor;
    }
    return determinant < 0;
}

/* A coordinate in view space as a linear form on positions, in world units: (offset + sum(row * p)), Q44. World positions
 * differ by at most 2^15 per axis and meshes reach at most 2^15 from their origin (checked), so offsets and sums stay
 * below 3 * 2^59. The rows that are drawn with come from `exact`, which keeps the bits of small scales:
 * exact * 2^exponent is a row's element in world units, |exact| < 2^60. */
typedef struct el_form {
    int64_t row[3];
    int64_t offset;
    int64_t exact[3];
} el_form;

enum { FORM_BITS = 44 };

/* Length of a row, rounded up. */
static uint64_t row_length(const int64_t row[3])
{
    const uint64_t all = el_abs_u64(row[0]) | el_abs_u64(row[1]) | el_abs_u64(row[2]);
    const int excess = el_bit_length_u64(all) - 30;
    const int shift = excess > 0 ? excess : 0;
    uint64_t sum = 0;
    for (unsigned i = 0; i < 3; i++) {
        const uint64_t part = (el_abs_u64(row[i]) >> shift) + 1U;
        sum += part * part;
    }
    return ((uint64_t)el_sqrt_u64(sum) + 1U) << shift;
}

static int64_t form_at_centre(const el_form *form, const el_mesh *mesh)
{
    int64_t value = form->offset;
    for (unsigned i = 0; i < 3; i++) {
        value += form->row[i] * mesh->centre[i];
    }
    return value;
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

/* How far the mesh reaches from its origin along any axis, in position units. */
static uint32_t reach_of(const el_mesh *mesh)
{
    uint32_t reach = 0;
    for (unsigned i = 0; i < 3; i++) {
        const uint32_t distance = (uint32_t)el_abs_u64(mesh->centre[i]);
        reach = distance > reach ? distance : reach;
    }
    return reach + mesh->radius + 1U;
}

/* The view-space rows of the mesh: right, up, distance. False when the mesh leaves the world. */
static bool view_forms(const el_view *view, const el_mesh *mesh, const el_pose *pose, el_form forms[3], int *exponent)
{
    /* The scale with at most 28 bits: model scales below 4096 with their whole fraction. */
    const int excess = el_bit_length_u32(pose->scale_q16) - 28;
    const int scale_shift = excess > 0 ? excess : 0;
    const int64_t scale = pose->scale_q16 >> scale_shift;
    *exponent = scale_shift + mesh->scale_log2 - (30 + 16);
    /* |row| * reach < 2^(FORM_BITS + 15) */
    const int row_bits = FORM_BITS + 15 - el_bit_length_u32(reach_of(mesh));

    for (unsigned i = 0; i < 3; i++) {
        const int32_t *axis = view->axes_q30[i];
        const int sign = i == 2 ? -1 : 1; /* distance runs against the backward axis */
        int64_t offset = 0;
        for (unsigned j = 0; j < 3; j++) {
            /* Q30 * Q16 is Q46; positions within +-2^30 differ by at most 2^31, so a term is at most 2^61. */
            offset += (int64_t)axis[j] * ((int64_t)pose->position_q16[j] - view->position_q16[j]);

            int64_t dot = 0; /* at most 3 * 2^60 */
            for (unsigned k = 0; k < 3; k++) {
                dot += (int64_t)axis[k] * pose->rotation_q30[k][j];
            }
            forms[i].exact[j] = sign * (el_shift_i64(dot, 30) * scale); /* below 2^32 * 2^28 */
            forms[i].row[j] = el_shift_i64(forms[i].exact[j], -(*exponent + FORM_BITS));
            if (el_bit_length_u64(el_abs_u64(forms[i].row[j])) > row_bits) {
                return false;
            }
        }
        forms[i].offset = sign * el_shift_i64(offset, 46 - FORM_BITS);
    }
    return true;
}

/* Whether the sphere lies beyond the plane `form >= 0`. Rows and offsets are rounded to a unit, and a row times a
 * position is off by 2^16 units then: the sphere gets that much more room. */
static bool is_beyond(const el_form *plane, const el_mesh *mesh)
{
    const int64_t reach = (int64_t)(row_length(plane->row) * mesh->radius);
    return form_at_centre(plane, mesh) + reach + (1LL << 20) < 0;
}

static bool sphere_is_outside(const el_view *view, const el_mesh *mesh, const el_form forms[3])
{
    const el_form *const distance = &forms[2];
    el_form plane = *distance;
    plane.offset = distance->offset - ((int64_t)view->near_q16 << (FORM_BITS - 16));
    if (is_beyond(&plane, mesh)) {
        return true;
    }
    plane.offset = ((int64_t)view->far_q16 << (FORM_BITS - 16)) - distance->offset;
    for (unsigned j = 0; j < 3; j++) {
        plane.row[j] = -distance->row[j];
    }
    if (is_beyond(&plane, mesh)) {
        return true;
    }
    for (unsigned i = 0; i < 4; i++) {
        /* w - x, w + x, w - y, w + y: inside where they are not negative. Divided by a power of two that is larger than
         * 1 + focal, so that the plane's values are no larger than the forms'. */
        const el_form *const side = &forms[i / 2];
        const el_factor focal = view->focal[i / 2];
        const int sign = (i & 1U) != 0 ? 1 : -1;
        const int shift = focal.exponent < 31 ? 32 - focal.exponent : 1;
        const bool perspective = view->projection == EL_PERSPECTIVE;
        const int64_t one = (int64_t)1 << FORM_BITS;
        for (unsigned j = 0; j < 3; j++) {
            plane.row[j] =
                sign * scale_by(side->row[j], focal, shift) + (perspective ? el_shift_i64(distance->row[j], shift) : 0);
        }
        plane.offset =
            sign * scale_by(side->offset, focal, shift) + el_shift_i64(perspective ? distance->offset : one, shift);
        if (is_beyond(&plane, mesh)) {
            return true;
        }
    }
    return false;
}

/* The most that |form| can be within the sphere, below 2^62. */
static uint64_t bound_of(const el_form *form, const el_mesh *mesh)
{
    return el_abs_u64(form_at_centre(form, mesh)) + row_length(form->row) * (mesh->radius + 1U);
}

/* In orthographic projection w is constant and may be any unit: 2^w_log2 world units, no less than the mesh's distance can
 * be, so that x and y have the bits that d needs anyway, wherever the camera stands. */
static int choose_w_log2(const el_view *view, const el_mesh *mesh, const el_form forms[3])
{
    if (view->projection == EL_PERSPECTIVE) {
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
    int64_t largest = view->projection == EL_PERSPECTIVE ? 1 : (int64_t)1 << (FORM_BITS - COARSE + w_log2);
    for (unsigned i = 0; i < 3; i++) {
        /* Saturated where it does not fit: far beyond what MIN_UNIT_LOG2 lets through. */
        const int64_t scaled = scale_by((int64_t)bound_of(&forms[i], mesh), factors[i], COARSE);
        largest = scaled >= largest ? scaled | 1 : largest;
    }
    return 30 - (el_bit_length_u64((uint64_t)largest) - (FORM_BITS - COARSE));
}

/* A coarser unit leaves too few bits to d, or to the constant w: meshes of thousands of units before a camera whose picture is a
 * fraction of one across. */
enum { MIN_UNIT_LOG2 = 0, MIN_W_BITS_ORTHOGRAPHIC = 8 };

int el_transform_make(el_transform *transform, const el_view *view, const el_mesh *mesh, const el_pose *pose)
{
    el_form forms[3];
    int exponent;
    if (outside_world(pose->position_q16) || outside_unit(pose->rotation_q30) || pose->scale_q16 == 0 ||
        mesh->scale_log2 < -30 || mesh->scale_log2 > 8 || !view_forms(view, mesh, pose, forms, &exponent)) {
        return EL_ERROR_RANGE;
    }
    if (sphere_is_outside(view, mesh, forms)) {
        return EL_CULLED;
    }

    const el_factor one = {.mantissa = 1U << 30, .exponent = 30};
    const int w_log2 = choose_w_log2(view, mesh, forms);
    el_factor factors[3] = {view->focal[0], view->focal[1], one};
    factors[0].exponent = (int16_t)(factors[0].exponent - w_log2);
    factors[1].exponent = (int16_t)(factors[1].exponent - w_log2);
    const int unit_log2 = choose_unit(view, mesh, forms, factors, w_log2);
    if (unit_log2 < MIN_UNIT_LOG2 ||
        (view->projection == EL_ORTHOGRAPHIC && unit_log2 + w_log2 < MIN_W_BITS_ORTHOGRAPHIC)) {
        return EL_ERROR_RANGE;
    }

    /* Rows with 31 extra bits first, then as many bits less as the largest element needs to fit 29: what a core without
     * long products adds up in 32 bits. Meshes of a unit or two keep up to 31. */
    int64_t rows[9];
    uint64_t all = 0;
    for (unsigned i = 0; i < 9; i++) {
        rows[i] = scale_by(forms[i / 3].exact[i % 3], factors[i / 3], -(exponent + unit_log2 + 31));
        all |= el_abs_u64(rows[i]);
    }
    const int excess = el_bit_length_u64(all) - EL_ROW_BITS;
    const int drop = excess <= 0 ? 0 : (excess > 30 ? 30 : excess);
    for (unsigned i = 0; i < 9; i++) {
        transform->rows[i / 3][i % 3] = (int32_t)el_shift_i64(rows[i], drop);
    }
    transform->shift = (uint8_t)(31 - drop);
    for (unsigned i = 0; i < 3; i++) {
        const int shift = FORM_BITS - unit_log2 - transform->shift;
        /* Rounding of the shifted sum is made here, once. */
        const int64_t half = (int64_t)1 << (transform->shift - 1);
        transform->offsets[i] = scale_by(forms[i].offset, factors[i], shift) + half;
    }

    transform->orthographic = view->projection == EL_ORTHOGRAPHIC;
    transform->mirrored = is_reflection(view->axes_q30) != is_reflection(pose->rotation_q30);
    transform->guard_shift[0] = view->guard_shift[0];
    transform->guard_shift[1] = view->guard_shift[1];
    transform->size[0] = view->size[0];
    transform->size[1] = view->size[1];

    /* The sphere reaches beyond the near plane, so near < 2^30 in the draw's unit. */
    const int64_t near_q32 = el_shift_i64(view->near_q16, 16 - unit_log2 - 32);
    const int64_t far_q32 = el_shift_i64(view->far_q16, 16 - unit_log2 - 32);
    transform->near_q32 = (uint64_t)near_q32;
    transform->near_shift = (int8_t)(el_bit_length_u64((uint64_t)near_q32) - 32);
    transform->near_bits = (uint32_t)(transform->near_shift >= 0 ? (uint64_t)near_q32 >> transform->near_shift
                                                                 : (uint64_t)near_q32 << -transform->near_shift);
    transform->near = (int32_t)((near_q32 + 0xFFFFFFFFLL) >> 32);
    transform->far = far_q32 >= (int64_t)INT32_MAX << 32 ? INT32_MAX : (int32_t)((far_q32 + 0xFFFFFFFFLL) >> 32);
    transform->constant_w = 0;
    if (!transform->orthographic) {
        transform->depth_scale = view->depth_scale_q12;
        transform->depth_shift = 12;
        return EL_VISIBLE;
    }
    transform->constant_w = (int32_t)el_shift_i64(1, -(unit_log2 + w_log2));
    /* EL_DEPTH_MAX / (far - near) per unit, its mantissa below 2^32. */
    const uint64_t range = (uint64_t)(view->far_q16 - view->near_q16); /* Q16 world units */
    uint64_t scale = ((uint64_t)EL_DEPTH_MAX << 46) / range;
    int shift = 46 - 16 + unit_log2;
    const int bits = el_bit_length_u64(scale) - 32;
    if (bits > 0) {
        scale >>= bits;
        shift -= bits;
    }
    transform->depth_scale = (uint32_t)scale;
    transform->depth_shift = (uint8_t)shift;
    return EL_VISIBLE;
}

static inline int32_t form_value(const el_transform *transform, unsigned i, const int16_t p[3])
{
    /* Three products below 2^46 and an offset below 2^62. */
    const uint64_t sum = (uint64_t)(transform->offsets[i] + el_dot_i32_i16(transform->rows[i], p));
    /* The lower word of sum >> shift, 1 <= shift <= 31. */
    return (int32_t)((uint32_t)(sum >> 32) << (32 - transform->shift) | (uint32_t)sum >> transform->shift);
}

static inline el_clip_vertex position_of(const el_transform *transform, const int16_t position[3])
{
    el_clip_vertex vertex;
    vertex.x = form_value(transform, 0, position);
    vertex.y = form_value(transform, 1, position);
    vertex.d = form_value(transform, 2, position);
    vertex.w = transform->orthographic ? transform->constant_w : vertex.d;
    return vertex;
}

el_clip_vertex el_transform_position(const el_transform *transform, const int16_t position[3])
{
    return position_of(transform, position);
}

uint8_t el_outcode(const el_transform *transform, const el_clip_vertex *vertex)
{
    unsigned code = 0;
    code |= vertex->d < transform->near ? EL_CODE_NEAR : 0U;
    code |= vertex->d > transform->far ? EL_CODE_FAR : 0U;
    const int64_t w = vertex->w;
    code |= vertex->x < -w ? EL_CODE_LEFT : 0U;
    code |= vertex->x > w ? EL_CODE_RIGHT : 0U;
    code |= vertex->y < -w ? EL_CODE_BELOW : 0U;
    code |= vertex->y > w ? EL_CODE_ABOVE : 0U;
    if ((code & (EL_CODE_LEFT | EL_CODE_RIGHT | EL_CODE_BELOW | EL_CODE_ABOVE)) != 0) {
        const int64_t x_limit = w * (1 << transform->guard_shift[0]);
        const int64_t y_limit = w * (1 << transform->guard_shift[1]);
        if (vertex->x < -x_limit || vertex->x > x_limit || vertex->y < -y_limit || vertex->y > y_limit) {
            code |= EL_CODE_GUARD;
        }
    }
    return (uint8_t)code;
}

/* middle + half * c / w in 1/EL_SUBPIXELS px, to the nearest, ties up.
 * |c| <= w << guard_shift keeps the quotient within EL_GUARD_SUB; |c| * half < 2^30 * 2^18. */
static el_coordinate snap(int64_t c, uint16_t size, uint32_t w, const el_divisor *divisor)
{
    const int32_t half = size * (EL_SUBPIXELS / 2);
    const int32_t offset = el_divide_floor_i64(c * half + (w >> 1), divisor);
    return (el_coordinate)(half + offset);
}

static uint16_t depth_of(const el_transform *transform, const el_clip_vertex *vertex, uint32_t w,
                         const el_divisor *divisor)
{
    uint32_t z;
    if (transform->orthographic) {
        const uint64_t distance = (uint64_t)(vertex->d - transform->near);
        const uint64_t product = distance * transform->depth_scale;
        z = (uint32_t)((product + ((1ULL << transform->depth_shift) >> 1)) >> transform->depth_shift);
    } else {
        /* depth = scale * (1 - near / w) */
        const uint32_t ratio_q32 =
            transform->near_q32 < (uint64_t)w << 32 ? el_divide_u64(transform->near_q32, divisor) : 0xFFFFFFFFU;
        const uint64_t product = (uint64_t)transform->depth_scale * ~ratio_q32;
        z = (uint32_t)((product + (1ULL << 43)) >> 44);
    }
    return (uint16_t)(z > EL_DEPTH_MAX ? EL_DEPTH_MAX : z);
}

/* 1/w = (2^32 + reciprocal) * 2^(shift - 64): the upper 16 bits of the sum, rounded, its first bit included. */
static void keep_reciprocal(el_screen_vertex *screen, const el_divisor *divisor)
{
    const uint32_t rest = ((divisor->reciprocal >> 16) + 1U) >> 1;
    screen->w = (uint16_t)(0x8000U + (rest > 0x7FFFU ? 0x7FFFU : rest));
    screen->w_shift = (uint8_t)(31 - divisor->shift);
}

void el_project(const el_transform *transform, const el_clip_vertex *vertex, el_screen_vertex *screen)
{
    const uint32_t w = (uint32_t)vertex->w;
    const el_divisor divisor = el_divisor_make(w);
    screen->x = snap(vertex->x, transform->size[0], w, &divisor);
    screen->y = snap(-(int64_t)vertex->y, transform->size[1], w, &divisor);
    screen->z = depth_of(transform, vertex, w, &divisor);
    keep_reciprocal(screen, &divisor);
}

#if !defined(__OPTIMIZE_SIZE__)
/* snap without the last bits, for what is in the view. c + w is in [0, 2w], so with w moved up to 31 bits, and c + w alike,
 * no bit is lost, and their ratio with 30 bits of fraction is a product with the reciprocal, too low by less than
 * EL_RECIPROCAL_ERROR + 1 units, 19. Times `half` it is the result, too low by less than 20 half units. False where that
 * might matter: below a tie. */
static inline bool snap_fast(uint32_t from_the_side, uint16_t size, uint32_t reciprocal, el_coordinate *result)
{
    const uint32_t half = size * (uint32_t)(EL_SUBPIXELS / 2);
    const uint32_t ratio = el_product_high_u32(from_the_side, reciprocal);
    const uint64_t scaled =
        (EL_SUBPIXEL_BITS == 4 ? el_product_u32_u16(ratio, half) : el_product_u64(ratio, half)) + (1U << 29);
    *result = (el_coordinate)((uint32_t)(scaled >> 30));
    return (uint32_t)scaled << 2 < 0U - half * (20U << 2);
}

/* depth_of without the last bits: near / w from 32 bits of near, with at least 31 bits of fraction, too low by less than
 * EL_RECIPROCAL_ERROR + 1 units; so scale * near / w, Q12 + 31, by less than 19 * 2^32, 19 of the 2^11 units that are
 * kept, and two for their rounding; and depth_of's own rounding of the ratio is less than one of them. */
static inline bool depth_fast(const el_transform *transform, unsigned w_shift, uint32_t reciprocal, uint16_t *result)
{
    enum { OFF = 24 };
    const uint32_t ratio = el_product_high_u32(transform->near_bits, reciprocal);
    const int excess = 32 - (int)w_shift - transform->near_shift; /* bits of fraction beyond 31, 0 and more */
    if (excess < 0 || excess > 31) {
        return false;
    }
    const uint32_t high = el_product_high_u32(transform->depth_scale, ratio) >> excess;
    const uint32_t z = (transform->depth_scale >> 1) - high + (1U << 10);
    const uint32_t fraction = z & 2047U;
    if (fraction < OFF || fraction > 2047U - OFF || z >> 11 > EL_DEPTH_MAX) {
        return false;
    }
    *result = (uint16_t)(z >> 11);
    return true;
}

/* keep_reciprocal from the reciprocal's upper bits. False where that might matter. */
static inline bool keep_reciprocal_fast(el_screen_vertex *screen, unsigned w_shift, uint32_t reciprocal)
{
    const uint32_t rounded = ((reciprocal >> 15) + 1U) >> 1;
    screen->w = (uint16_t)(rounded > 0xFFFFU ? 0xFFFFU : rounded);
    screen->w_shift = (uint8_t)(31U - w_shift);
    return ((reciprocal + 0x8000U) & 0xFFFFU) < 0x10000U - EL_RECIPROCAL_ERROR;
}
#endif

/* el_project for what is in the view, which most vertices are: without the last bits, and once more where these might
 * matter. */
static inline void project_inside(const el_transform *transform, const el_clip_vertex *vertex, el_screen_vertex *screen)
{
#if defined(__OPTIMIZE_SIZE__)
    el_project(transform, vertex, screen);
#else
    const uint32_t w = (uint32_t)vertex->w;
    const unsigned shift = (unsigned)__builtin_clz(w); /* w < 2^31: 1 at least */
    const uint32_t reciprocal = el_reciprocal_near(w << shift);
    const uint32_t x = (w + (uint32_t)vertex->x) << (shift - 1U);
    const uint32_t y = (w - (uint32_t)vertex->y) << (shift - 1U);
    if (!snap_fast(x, transform->size[0], reciprocal, &screen->x) ||
        !snap_fast(y, transform->size[1], reciprocal, &screen->y) || !keep_reciprocal_fast(screen, shift, reciprocal)) {
        el_project(transform, vertex, screen);
    } else if (transform->orthographic || !depth_fast(transform, shift, reciprocal, &screen->z)) {
        const el_divisor divisor = el_divisor_make(w);
        screen->z = depth_of(transform, vertex, w, &divisor);
    }
#endif
}

/* Most vertices are in the view, between near and far: three comparisons. */
static inline bool is_in_view(const el_transform *transform, const el_clip_vertex *vertex)
{
    const uint32_t w = (uint32_t)vertex->w;
    const uint32_t near = (uint32_t)transform->near;
    return (uint32_t)vertex->d - near <= (uint32_t)transform->far - near && (uint32_t)vertex->x + w <= 2U * w &&
           (uint32_t)vertex->y + w <= 2U * w;
}

void el_transform_vertex(const el_transform *transform, const int16_t position[3], el_screen_vertex *screen)
{
    const el_clip_vertex vertex = position_of(transform, position);
    if (is_in_view(transform, &vertex)) {
        screen->code = 0;
        project_inside(transform, &vertex, screen);
        return;
    }
    screen->code = el_outcode(transform, &vertex);
    if ((screen->code & EL_CODE_CLIP) == 0) {
        el_project(transform, &vertex, screen);
    }
}

void el_transform_vertices(const el_transform *transform, const int16_t (*positions)[3], uint32_t count,
                           el_screen_vertex *screen)
{
    for (uint32_t i = 0; i < count; i++) {
        const el_clip_vertex vertex = position_of(transform, positions[i]);
        if (is_in_view(transform, &vertex)) {
            screen[i].code = 0;
            project_inside(transform, &vertex, &screen[i]);
        } else {
            screen[i].code = (uint8_t)(el_outcode(transform, &vertex) | EL_CODE_LATER);
        }
    }
}
