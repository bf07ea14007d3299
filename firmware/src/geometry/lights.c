#include "geometry/lights.h"

#include <stddef.h>

#include "base/divide.h"
#include "base/fixed.h"
#include "geometry/vector.h"

enum { LENGTH_BITS = 28 }; /* of what lengths are made from: squares of three stay below 2^58 */

/* A place on a surface, in world space. */
typedef struct spot {
    int64_t place_q16[3];
    int32_t normal_q30[3];
    int32_t to_eye_q30[3];
} spot;

/* How much light of each colour arrives, 255 for all, Q16: 32 lamps make it 2^29 at most. */
typedef struct sums {
    uint32_t diffuse_q16[3], specular_q16[3];
} sums;

/* Of directions: a . b, within a few units of +-1. */
static int32_t cosine_q30(const int32_t a_q30[3], const int32_t b_q30[3])
{
    int64_t sum_q58 = 0;
    for (unsigned i = 0; i < 3; i++) {
        sum_q58 += el_product_q58(a_q30[i], b_q30[i]);
    }
    return el_clamp_unit(sum_q58 >> 28);
}

/* n * 2^16 / d, 0 <= n <= d, d > 0. */
static uint32_t ratio_q16(uint64_t n, uint64_t d)
{
    const int more = el_bit_length_u64(d) - 32;
    const int shift = more > 0 ? more : 0;
    const el_divisor divisor = el_divisor_make((uint32_t)(d >> shift));
    const uint32_t part = (uint32_t)(n >> shift);
    return part == (uint32_t)(d >> shift) ? 1U << 16 : el_divide_u64((uint64_t)part << 16, &divisor);
}

/* 1 / (1 + (length of v / half)^2) in Q16; to_lamp_q30 is v's direction. */
static uint32_t attenuation_q16(const int64_t v_q16[3], const int32_t to_lamp_q30[3], uint32_t half_q16)
{
    if (half_q16 == 0) {
        return 1U << 16;
    }
    uint64_t bits = half_q16;
    for (unsigned i = 0; i < 3; i++) {
        bits |= el_abs_u64(v_q16[i]);
    }
    const int more = el_bit_length_u64(bits) - LENGTH_BITS;
    const int shift = more > 0 ? more : 0;
    int64_t length_q46 = 0; /* v . v / |v|: below 3 * 2^58 */
    for (unsigned i = 0; i < 3; i++) {
        length_q46 += (v_q16[i] >> shift) * to_lamp_q30[i];
    }
    const uint64_t length = length_q46 > 0 ? (uint64_t)length_q46 >> 30 : 0U; /* below 2^30 */
    const uint64_t half = (uint64_t)half_q16 >> shift;
    const uint64_t half_squared = half * half;
    const uint64_t sum = half_squared + length * length;
    return sum == 0 ? 1U << 16 : ratio_q16(half_squared, sum);
}

/* What of a spot's light goes there, Q16. */
static uint32_t cone_q16(const el_lamp *lamp, const int32_t to_lamp_q30[3])
{
    const int64_t cosine = -(int64_t)cosine_q30(lamp->direction_q30, to_lamp_q30);
    if (cosine <= lamp->outer_q30) {
        return 0;
    }
    if (cosine >= lamp->inner_q30) {
        return 1U << 16;
    }
    const uint64_t t =
        ratio_q16((uint64_t)(cosine - lamp->outer_q30), (uint64_t)((int64_t)lamp->inner_q30 - lamp->outer_q30));
    return (uint32_t)((t * t >> 16) * ((3U << 16) - 2U * t) >> 16);
}

/* c^exponent, 0 <= c <= 1, rounded down at each of its products. */
static uint32_t power_q30(uint32_t c_q30, uint32_t exponent)
{
    uint64_t square_q30 = c_q30;
    uint64_t product_q30 = EL_UNIT_Q30;
    for (; exponent > 0; exponent >>= 1) {
        if ((exponent & 1U) != 0) {
            product_q30 = product_q30 * square_q30 >> 30;
        }
        square_q30 = square_q30 * square_q30 >> 30;
    }
    return (uint32_t)product_q30;
}

enum { STEP_BITS = 30 + EL_HIGHLIGHT_STEP_LOG2 }; /* of (1 - c) * exponent in Q30: below 2^41 */

el_status el_highlight_make(el_highlight *highlight, uint32_t exponent)
{
    if (exponent == 0 || exponent > EL_HIGHLIGHT_EXPONENT_MAX) {
        return EL_ERROR_RANGE;
    }
    highlight->exponent = (uint16_t)exponent;
    const el_divisor divisor = el_divisor_make(exponent);
    for (uint32_t i = 0; i <= EL_HIGHLIGHT_STEPS; i++) {
        const uint64_t along = (uint64_t)i << STEP_BITS;
        const bool is_beyond = along >= (uint64_t)exponent << 30;
        const uint32_t c_q30 = is_beyond ? 0U : (uint32_t)EL_UNIT_Q30 - el_divide_u64(along, &divisor);
        highlight->power_q15[i] = (uint16_t)((power_q30(c_q30, exponent) + (1U << 14)) >> 15);
    }
    return EL_OK;
}

/* max(0, n . h)^exponent, Q16. */
static uint32_t highlight_q16(const spot *at, const int32_t to_lamp_q30[3], const el_highlight *highlight)
{
    int64_t between[3];
    int32_t half_q30[3];
    for (unsigned i = 0; i < 3; i++) {
        between[i] = (int64_t)to_lamp_q30[i] + at->to_eye_q30[i];
    }
    if (!el_vector_normalise(between, 3, half_q30)) {
        return 0;
    }
    const int32_t cosine = cosine_q30(at->normal_q30, half_q30);
    if (cosine <= 0) {
        return 0;
    }
    const uint64_t along = (uint64_t)(uint32_t)(EL_UNIT_Q30 - el_min_i32(cosine, EL_UNIT_Q30)) * highlight->exponent;
    const uint32_t step = (uint32_t)(along >> STEP_BITS);
    if (step >= EL_HIGHLIGHT_STEPS) {
        return 0;
    }
    const uint32_t nearer = highlight->power_q15[step];
    const uint32_t fall = nearer - highlight->power_q15[step + 1U]; /* at most 2^15, times less than 2^16 */
    return (nearer << 1) - (fall * ((uint32_t)(along >> (STEP_BITS - 16)) & 0xFFFFU) >> 15);
}

static void add_lamp(sums *s, const el_lighting *l, const el_lamp *lamp, const spot *at, bool shines)
{
    int32_t to_lamp_q30[3];
    uint32_t arrives_q16 = 1U << 16;
    if (lamp->kind == EL_LAMP_DIRECTIONAL) {
        for (unsigned i = 0; i < 3; i++) {
            to_lamp_q30[i] = lamp->direction_q30[i];
        }
    } else {
        int64_t v_q16[3];
        for (unsigned i = 0; i < 3; i++) {
            v_q16[i] = lamp->position_q16[i] - at->place_q16[i];
        }
        if (!el_vector_normalise(v_q16, 3, to_lamp_q30)) {
            return; /* the lamp is in the surface */
        }
        arrives_q16 = attenuation_q16(v_q16, to_lamp_q30, lamp->half_q16);
        if (lamp->kind == EL_LAMP_SPOT) {
            arrives_q16 = (uint32_t)((uint64_t)arrives_q16 * cone_q16(lamp, to_lamp_q30) >> 16);
        }
    }
    const int32_t cosine = cosine_q30(at->normal_q30, to_lamp_q30);
    if (cosine <= 0 || arrives_q16 == 0) {
        return;
    }
    const uint32_t diffuse_q16 = (uint32_t)((uint64_t)arrives_q16 * (uint32_t)cosine >> 30);
    const uint32_t specular_q16 =
        shines ? (uint32_t)((uint64_t)arrives_q16 * highlight_q16(at, to_lamp_q30, l->highlight) >> 16) : 0U;
    for (unsigned i = 0; i < 3; i++) {
        s->diffuse_q16[i] += lamp->colour[i] * diffuse_q16;
        s->specular_q16[i] += lamp->colour[i] * specular_q16;
    }
}

/* colour * light / 255, in 8.8; light in 255ths, Q16, below 2^30. */
static uint32_t part_q8(uint32_t colour, uint32_t light_q16)
{
    return colour * ((light_q16 + 128U) >> 8) / 255U; /* 2^8 * 2^22 */
}

static void light(const el_lighting *l, const spot *at, const uint8_t own[3], uint8_t colour[3])
{
    const bool shines = l->highlight != NULL && (l->specular[0] | l->specular[1] | l->specular[2]) != 0;
    sums s = {{0}, {0}};
    for (unsigned i = 0; i < l->lamp_count; i++) {
        add_lamp(&s, l, &l->lamps[i], at, shines);
    }
    for (unsigned i = 0; i < 3; i++) {
        const uint32_t sum_q8 = ((uint32_t)l->emissive[i] << 8) +
                                part_q8(own[i], ((uint32_t)l->ambient[i] << 16) + s.diffuse_q16[i]) +
                                part_q8(l->specular[i], s.specular_q16[i]);
        colour[i] = (uint8_t)el_min_u32((sum_q8 + 128U) >> 8, 255U);
    }
}

/* Where a place of the mesh, in 1/unit of its position units, and a sum of its normals are. The normal's length is left out;
 * one that has none looks along z. */
static void find_spot(spot *at, const el_lighting *l, const el_mesh *mesh, const el_pose *pose, const int32_t place[3],
                      uint32_t unit, const int32_t normal[3], const int32_t eye_q16[3])
{
    int64_t scaled_q16[3];
    int64_t turned[3];
    int64_t to_eye[3];
    for (unsigned i = 0; i < 3; i++) {
        /* |place / unit| <= 2^15 and 2^32 make 2^47; a shift to the left saturates, far beyond the world. */
        const int64_t product = (int64_t)place[i] * pose->scale_q16 / (int64_t)unit;
        scaled_q16[i] = el_clamp_place(el_shift_i64(product, -mesh->scale_log2));
    }
    for (unsigned i = 0; i < 3; i++) {
        const int32_t *const row = pose->rotation_q30[i];
        at->place_q16[i] = el_vector_along(row, scaled_q16) + pose->position_q16[i];
        turned[i] = (int64_t)row[0] * normal[0] + (int64_t)row[1] * normal[1] + (int64_t)row[2] * normal[2];
        to_eye[i] = eye_q16[i] - at->place_q16[i];
    }
    if (!el_vector_normalise(turned, 3, at->normal_q30)) {
        at->normal_q30[0] = 0;
        at->normal_q30[1] = 0;
        at->normal_q30[2] = EL_UNIT_Q30;
    }
    if (!el_vector_normalise(to_eye, 3, at->to_eye_q30)) {
        for (unsigned i = 0; i < 3; i++) {
            at->to_eye_q30[i] = at->normal_q30[i];
        }
    }
    if (l->two_sided && cosine_q30(at->normal_q30, at->to_eye_q30) < 0) {
        for (unsigned i = 0; i < 3; i++) {
            at->normal_q30[i] = -at->normal_q30[i];
        }
    }
}

static el_status check(const el_lighting *l, const el_mesh *mesh, const el_pose *pose, const int32_t *eye_q16,
                       const void *colours)
{
    if (l == NULL || mesh == NULL || pose == NULL || eye_q16 == NULL || colours == NULL ||
        (l->lamp_count > 0 && l->lamps == NULL)) {
        return EL_ERROR_ARGUMENT;
    }
    if (l->lamp_count > EL_LAMPS_MAX) {
        return EL_ERROR_SIZE;
    }
    if (l->highlight != NULL && (l->highlight->exponent == 0 || l->highlight->exponent > EL_HIGHLIGHT_EXPONENT_MAX)) {
        return EL_ERROR_MATERIAL;
    }
    for (unsigned i = 0; i < l->lamp_count; i++) {
        const el_lamp *const lamp = &l->lamps[i];
        if (lamp->kind > EL_LAMP_SPOT || (lamp->kind == EL_LAMP_SPOT && lamp->inner_q30 <= lamp->outer_q30)) {
            return EL_ERROR_MATERIAL;
        }
    }
    return mesh->normals != NULL ? EL_OK : EL_ERROR_MATERIAL;
}

el_status el_light_vertices(const el_lighting *lighting, const el_mesh *mesh, const el_pose *pose,
                            const int32_t eye_q16[3], uint8_t (*colours)[3])
{
    const el_status status = check(lighting, mesh, pose, eye_q16, colours);
    if (status != EL_OK) {
        return status;
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const int16_t *const p = mesh->positions[v];
        const int8_t *const n = mesh->normals[v];
        const int32_t place[3] = {p[0], p[1], p[2]};
        const int32_t normal[3] = {n[0], n[1], n[2]};
        spot at;
        find_spot(&at, lighting, mesh, pose, place, 1, normal, eye_q16);
        light(lighting, &at, mesh->colours != NULL ? mesh->colours[v] : lighting->colour, colours[v]);
    }
    return EL_OK;
}

static const uint8_t *colour_of_triangle(const el_lighting *l, const el_mesh *mesh, uint32_t triangle)
{
    if (mesh->triangle_colours != NULL) {
        return mesh->triangle_colours[triangle];
    }
    return mesh->colours != NULL ? mesh->colours[mesh->triangles[triangle][0]] : l->colour;
}

el_status el_light_triangles(const el_lighting *lighting, const el_mesh *mesh, const el_pose *pose,
                             const int32_t eye_q16[3], uint8_t (*colours)[3])
{
    const el_status status = check(lighting, mesh, pose, eye_q16, colours);
    if (status != EL_OK) {
        return status;
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        int32_t place[3] = {0};
        int32_t normal[3] = {0};
        for (unsigned corner = 0; corner < 3; corner++) {
            const uint16_t v = mesh->triangles[t][corner];
            for (unsigned i = 0; i < 3; i++) {
                place[i] += mesh->positions[v][i];
                normal[i] += mesh->normals[v][i];
            }
        }
        spot at;
        find_spot(&at, lighting, mesh, pose, place, 3, normal, eye_q16);
        light(lighting, &at, colour_of_triangle(lighting, mesh, t), colours[t]);
    }
    return EL_OK;
}
