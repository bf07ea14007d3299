/* Components are within +-1 where they mean something; products are taken so that no numbers overflow (el_product_q58). */
#include "geometry/quaternion.h"

#include "base/fixed.h"
#include "geometry/vector.h"

el_quaternion el_quaternion_identity(void)
{
    return (el_quaternion){.q30 = {EL_UNIT_Q30, 0, 0, 0}};
}

/* A step of Newton's towards length 1, q (3 - |q|^2) / 2: off by e before, it is off by 3/2 e^2 and by rounding after. That
 * is half a unit of four components whose magnitudes add up to 2 at most: the length is within a unit or two. */
static el_quaternion polish(el_quaternion q)
{
    int64_t excess_q58 = -(1LL << 58);
    for (unsigned i = 0; i < 4; i++) {
        excess_q58 += el_product_q58(q.q30[i], q.q30[i]); /* 2^58 at most: components are within +-1 here */
    }
    const int64_t excess_q30 = el_shift_i64(excess_q58, 28); /* -1 to 3 */
    for (unsigned i = 0; i < 4; i++) {
        q.q30[i] = el_clamp_unit(q.q30[i] - el_shift_i64(q.q30[i] * excess_q30, 31)); /* 2^30 * 3 * 2^30 */
    }
    return q;
}

/* `otherwise` where all are 0. */
static el_quaternion of_length_1(const int64_t numbers[4], const el_quaternion *otherwise)
{
    el_quaternion q;
    return el_vector_normalise(numbers, 4, q.q30) != 0 ? polish(q) : *otherwise;
}

el_quaternion el_quaternion_normalise(const el_quaternion *q)
{
    const el_quaternion identity = el_quaternion_identity();
    return of_length_1((const int64_t[4]){q->q30[0], q->q30[1], q->q30[2], q->q30[3]}, &identity);
}

el_quaternion el_quaternion_about(const int32_t axis[3], el_angle angle)
{
    int32_t unit_q30[3];
    if (el_vector_normalise((const int64_t[3]){axis[0], axis[1], axis[2]}, 3, unit_q30) == 0) {
        return el_quaternion_identity();
    }
    const int64_t sine_q30 = el_sin_q30(angle / 2);
    el_quaternion q = {.q30 = {el_cos_q30(angle / 2)}};
    for (unsigned i = 0; i < 3; i++) {
        q.q30[1 + i] = el_clamp_unit(el_shift_i64(sine_q30 * unit_q30[i], 30)); /* 2^60 */
    }
    return polish(q);
}

el_quaternion el_quaternion_multiply(const el_quaternion *a, const el_quaternion *b)
{
    const int32_t *const p = a->q30;
    const int32_t *const q = b->q30;
    int64_t sum_q58 = el_product_q58(p[0], q[0]);
    for (unsigned i = 1; i < 4; i++) {
        sum_q58 -= el_product_q58(p[i], q[i]);
    }
    el_quaternion product = {.q30 = {el_clamp_unit(el_shift_i64(sum_q58, 28))}};
    for (unsigned i = 1; i < 4; i++) {
        const unsigned j = i % 3U + 1U;
        const unsigned k = j % 3U + 1U;
        sum_q58 = el_product_q58(p[0], q[i]) + el_product_q58(p[i], q[0]) + el_product_q58(p[j], q[k]) -
                  el_product_q58(p[k], q[j]);
        product.q30[i] = el_clamp_unit(el_shift_i64(sum_q58, 28));
    }
    return polish(product);
}

el_quaternion el_quaternion_conjugate(const el_quaternion *q)
{
    el_quaternion back = *q;
    for (unsigned i = 1; i < 4; i++) {
        back.q30[i] = el_clamp_unit(-(int64_t)q->q30[i]);
    }
    return back;
}

void el_quaternion_to_rotation(const el_quaternion *q, int32_t rotation_q30[3][3])
{
    /* 1 - 2 (y^2 + z^2), 2 (x y - w z), 2 (x y + w z) and so on around the axes. Twice a Q58 is a Q57. */
    const int32_t w = q->q30[0];
    const int32_t *const v = &q->q30[1];
    for (unsigned i = 0; i < 3; i++) {
        const unsigned j = (i + 1U) % 3U;
        const unsigned k = (i + 2U) % 3U;
        const int64_t squares_q58 = el_product_q58(v[j], v[j]) + el_product_q58(v[k], v[k]);
        const int64_t mixed_q58 = el_product_q58(v[i], v[j]);
        const int64_t turned_q58 = el_product_q58(w, v[k]);
        rotation_q30[i][i] = el_clamp_unit(EL_UNIT_Q30 - el_shift_i64(squares_q58, 27));
        rotation_q30[i][j] = el_clamp_unit(el_shift_i64(mixed_q58 - turned_q58, 27));
        rotation_q30[j][i] = el_clamp_unit(el_shift_i64(mixed_q58 + turned_q58, 27));
    }
}

void el_quaternion_rotate(const el_quaternion *q, const int32_t v[3], int32_t rotated[3])
{
    const int64_t from[3] = {v[0], v[1], v[2]};
    int32_t rotation_q30[3][3];
    el_quaternion_to_rotation(q, rotation_q30);
    for (unsigned i = 0; i < 3; i++) {
        rotated[i] = el_saturate_i32(el_vector_along(rotation_q30[i], from));
    }
}

el_quaternion el_quaternion_from_rotation(const int32_t rotation_q30[3][3])
{
    /* The symmetric matrix of all products of two components, times 4 (Shepperd, "Quaternion from rotation matrix", Journal
     * of Guidance and Control 1(3), 1978). A row is the quaternion times four times one of its components; the row of the
     * largest one has length 2 at least, since the four on the diagonal add up to 4. */
    int64_t products_q30[4][4];
    products_q30[0][0] = EL_UNIT_Q30;
    for (unsigned i = 0; i < 3; i++) {
        const unsigned j = (i + 1U) % 3U;
        const unsigned k = (i + 2U) % 3U;
        const int64_t with_w = (int64_t)rotation_q30[k][j] - rotation_q30[j][k];
        const int64_t mixed = (int64_t)rotation_q30[i][j] + rotation_q30[j][i];
        products_q30[0][0] += rotation_q30[i][i];
        products_q30[1 + i][1 + i] =
            (int64_t)EL_UNIT_Q30 + rotation_q30[i][i] - rotation_q30[j][j] - rotation_q30[k][k];
        products_q30[0][1 + i] = products_q30[1 + i][0] = with_w;
        products_q30[1 + i][1 + j] = products_q30[1 + j][1 + i] = mixed;
    }
    unsigned largest = 0;
    for (unsigned i = 1; i < 4; i++) {
        largest = products_q30[i][i] > products_q30[largest][largest] ? i : largest;
    }
    const el_quaternion identity = el_quaternion_identity();
    return of_length_1(products_q30[largest], &identity);
}

bool el_quaternion_is_far(const el_quaternion *a, const el_quaternion *b)
{
    int64_t sum_q58 = 0;
    for (unsigned i = 0; i < 4; i++) {
        sum_q58 += el_product_q58(a->q30[i], b->q30[i]);
    }
    return sum_q58 < 0;
}

el_quaternion el_quaternion_slerp(const el_quaternion *from, const el_quaternion *to, uint32_t part_q30)
{
    if (part_q30 == 0) {
        return *from;
    }
    if (part_q30 >= EL_UNIT_Q30) {
        return *to;
    }
    /* The angle between them is twice that whose tangent is |a - b| / |a + b| (Kahan): good for small ones, where an arc
     * cosine is not. It is a quarter turn at most, seen from the nearer of b and -b. */
    const int64_t sign = el_quaternion_is_far(from, to) ? -1 : 1;
    uint64_t apart_q60 = 0;
    uint64_t together_q60 = 0;
    for (unsigned i = 0; i < 4; i++) {
        const uint64_t difference = (uint64_t)(from->q30[i] - sign * to->q30[i]); /* squares modulo 2^64 have no sign */
        const uint64_t sum = (uint64_t)(from->q30[i] + sign * to->q30[i]);
        apart_q60 += difference * difference;
        together_q60 += sum * sum;
    }
    const el_angle angle = 2U * el_atan2(el_sqrt_u64(apart_q60), el_sqrt_u64(together_q60));
    const el_angle first = (el_angle)(((uint64_t)angle * part_q30 + EL_UNIT_Q30 / 2) >> 30);
    const int64_t to_q30 = sign * el_sin_q30(first);
    const int64_t from_q30 = el_sin_q30(angle - first);
    /* (a sin(rest) + b sin(first)) / sin(angle): what it is divided by comes out of its length, which is 1. */
    int64_t sum_q60[4];
    for (unsigned i = 0; i < 4; i++) {
        sum_q60[i] = from->q30[i] * from_q30 + to->q30[i] * to_q30; /* 2^62 for any numbers */
    }
    return of_length_1(sum_q60, from);
}
