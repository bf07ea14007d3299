#include "geometry/transform.h"

#include <stdbool.h>
#include <string.h>

#include "base/fixed.h"
#include "geometry/cull.h"

_Static_assert(EL_SUBPIXEL_BITS > 4 || EL_GUARD_SUB < 32767, "rounding may add a unit");

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
        value += form->at[i] * mesh->centre[i];
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
        sum += (uint64_t)part * part;
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
    for (unsigned i = 0; i < 6; i++) {
        const el_factor factor = factors[i / 2];
        const int shift = el_max_i32(1, 32 - factor.exponent);
        const bool upper = (i & 1U) != 0;
        el_form plane;
        for (unsigned j = 0; j < 4; j++) {
            const int64_t scaled = scale_by(forms[i / 2].at[j], factor, shift);
            plane.at[j] = (upper ? -scaled : scaled) + (i < 4 ? el_shift_i64(w->at[j], shift) : 0);
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
    transform->shift = (uint8_t)(31 - drop);
    for (unsigned i = 0; i < 3; i++) {
        for (unsigned j = 0; j < 3; j++) {
            transform->rows[i][j] = (int32_t)el_shift_i64(forms[i].exact[j], drop);
        }
        /* Rounding of the shifted sum is made here, once. */
        const int64_t half = (int64_t)1 << (transform->shift - 1);
        transform->offsets[i] =
            scale_by(forms[i].at[OFFSET], factors[i], FORM_BITS - unit_log2 - transform->shift) + half;
    }

    transform->orthographic = is_orthographic(view);
    transform->mirrored = is_reflection(view->axes_q30) != is_reflection(pose->rotation_q30);
    memcpy(transform->guard_shift, view->guard_shift, sizeof transform->guard_shift);
    memcpy(transform->size, view->size, sizeof transform->size);

    /* The sphere reaches beyond the near plane, so near < 2^30 in the draw's unit. */
    const int64_t near_q32 = el_shift_i64(view->near_q16, 16 - unit_log2 - 32);
    const int64_t far_q32 = el_shift_i64(view->far_q16, 16 - unit_log2 - 32);
    transform->near_q32 = (uint64_t)near_q32;
#if !EL_SMALL_CODE
    transform->near_shift = (int8_t)(el_bit_length_u64((uint64_t)near_q32) - 32);
    transform->near_bits = (uint32_t)(transform->near_shift >= 0 ? (uint64_t)near_q32 >> transform->near_shift
                                                                 : (uint64_t)near_q32 << -transform->near_shift);
#endif
    transform->near = (int32_t)((near_q32 + 0xFFFFFFFFLL) >> 32);
    transform->far = far_q32 >= (int64_t)INT32_MAX << 32 ? INT32_MAX : (int32_t)((far_q32 + 0xFFFFFFFFLL) >> 32);
    transform->constant_w = 0;
    transform->depth_scale = view->depth_scale_q12;
    transform->depth_shift = 12;
    if (is_orthographic(view)) {
        make_orthographic(transform, view, unit_log2, w_log2);
    }
    return EL_VISIBLE;
}

static inline int32_t form_value(const el_transform *transform, unsigned i, const int16_t p[3])
{
    /* Three products below 2^46 and an offset below 2^62. */
    const uint64_t sum = (uint64_t)(transform->offsets[i] + el_dot_i32_i16(transform->rows[i], p));
    /* The lower word of sum >> shift, 1 <= shift <= 31. */
    return (int32_t)((uint32_t)(sum >> 32) << (32 - transform->shift) | (uint32_t)sum >> transform->shift);
}

static EL_SPECIALISED el_clip_vertex position_of(const el_transform *transform, const int16_t position[3])
{
    el_clip_vertex vertex;
    vertex.x = form_value(transform, 0, position);
    vertex.y = form_value(transform, 1, position);
    vertex.d = form_value(transform, 2, position);
    vertex.w = el_transform_is_orthographic(transform) ? transform->constant_w : vertex.d;
    return vertex;
}

el_clip_vertex el_transform_position(const el_transform *transform, const int16_t position[3])
{
    return position_of(transform, position);
}

/* The sides of the view that a vertex is beyond, whatever it and w are: ~w is -w - 1. */
static inline unsigned outside_code(const el_transform *transform, const el_clip_vertex *vertex)
{
    const int32_t w = vertex->w;
    unsigned code = vertex->x <= ~w ? EL_CODE_LEFT : 0U;
    code |= vertex->x > w ? EL_CODE_RIGHT : 0U;
    code |= vertex->y <= ~w ? EL_CODE_BELOW : 0U;
    code |= vertex->y > w ? EL_CODE_ABOVE : 0U;
    code |= vertex->d < transform->near ? EL_CODE_NEAR : 0U;
    code |= vertex->d > transform->far ? EL_CODE_FAR : 0U;
    return code;
}

/* Of one coordinate: v / 2^shift rounded down compares with a whole number as v does with that number times 2^shift. */
static bool is_beyond_guard(int32_t v, int32_t w, unsigned shift)
{
    return (v <= ~w && v >> shift <= ~w) || (v > w && (v - 1) >> shift >= w);
}

uint8_t el_outcode(const el_transform *transform, const el_clip_vertex *vertex)
{
    const unsigned code = outside_code(transform, vertex);
    const bool guard = is_beyond_guard(vertex->x, vertex->w, transform->guard_shift[0]) ||
                       is_beyond_guard(vertex->y, vertex->w, transform->guard_shift[1]);
    return (uint8_t)(code | (guard ? EL_CODE_GUARD : 0U));
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
    if (el_transform_is_orthographic(transform)) {
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

#if !EL_SMALL_CODE
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

/* el_project for what is in the view, which most vertices are: without the last bits, and once more where these might
 * matter. */
static inline void project_inside(const el_transform *transform, const el_clip_vertex *vertex, el_screen_vertex *screen)
{
    const uint32_t w = (uint32_t)vertex->w;
    const unsigned shift = (unsigned)__builtin_clz(w); /* w < 2^31: 1 at least */
    const uint32_t reciprocal = el_reciprocal_near(w << shift);
    const uint32_t x = (w + (uint32_t)vertex->x) << (shift - 1U);
    const uint32_t y = (w - (uint32_t)vertex->y) << (shift - 1U);
    if (!snap_fast(x, transform->size[0], reciprocal, &screen->x) ||
        !snap_fast(y, transform->size[1], reciprocal, &screen->y) || !keep_reciprocal_fast(screen, shift, reciprocal)) {
        el_project(transform, vertex, screen);
    } else if (el_transform_is_orthographic(transform) || !depth_fast(transform, shift, reciprocal, &screen->z)) {
        const el_divisor divisor = el_divisor_make(w);
        screen->z = depth_of(transform, vertex, w, &divisor);
    }
}

/* Most vertices are in the view, between near and far: three comparisons. */
static inline bool is_in_view(const el_transform *transform, const el_clip_vertex *vertex)
{
    const uint32_t w = (uint32_t)vertex->w;
    const uint32_t near = (uint32_t)transform->near;
    return (uint32_t)vertex->d - near <= (uint32_t)transform->far - near && (uint32_t)vertex->x + w <= 2U * w &&
           (uint32_t)vertex->y + w <= 2U * w;
}
#endif

void el_transform_vertex(const el_transform *transform, const int16_t position[3], el_screen_vertex *screen)
{
    const el_clip_vertex vertex = position_of(transform, position);
#if !EL_SMALL_CODE
    if (is_in_view(transform, &vertex)) {
        screen->code = 0;
        project_inside(transform, &vertex, screen);
        return;
    }
#endif
    screen->code = el_outcode(transform, &vertex);
    if ((screen->code & EL_CODE_CLIP) == 0) {
        el_project(transform, &vertex, screen);
    }
}

#if !EL_SMALL_CODE
static inline void transform_in_view(const el_transform *transform, const int16_t position[3], el_screen_vertex *screen)
{
    const el_clip_vertex vertex = position_of(transform, position);
    if (is_in_view(transform, &vertex)) {
        screen->code = 0;
        project_inside(transform, &vertex, screen);
    } else {
        screen->code = (uint8_t)(outside_code(transform, &vertex) | EL_CODE_LATER);
    }
}

void el_transform_vertex_in_view(const el_transform *transform, const int16_t position[3], el_screen_vertex *screen)
{
    transform_in_view(transform, position, screen);
}

void el_transform_vertices(const el_transform *transform, const int16_t (*positions)[3], uint32_t count,
                           el_screen_vertex *screen)
{
    for (uint32_t i = 0; i < count; i++) {
        transform_in_view(transform, positions[i], &screen[i]);
    }
}
#endif
