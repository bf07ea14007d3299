#include "geometry/lights.h"

#include <stddef.h>

#include "base/divide.h"
#include "base/fixed.h"
#include "geometry/arrow.h"
#include "geometry/vector.h"

/* Parts of a whole are 16 bits, the whole 1 less than 1, so that two make a product of 32. */
enum { WHOLE_Q16 = 65535 };

/* Places are multiplied by halves of factors, and moved down, or up to no more than 2^57: where a mesh's units are so large
 * that the world has no room for two of them. */
enum { HALF_BITS = 12, FALL_MIN = -26, FALL_MAX = 30 };

/* What all spots of a mesh have in common. */
typedef struct setting {
    const el_lighting *lighting;
    const el_pose *pose;
    const int32_t *eye_q16;
    /* Rotation times scale, upper * 2^HALF_BITS + lower, within 2^26; and how far down a place is moved by to be Q16. */
    int32_t upper[3][3], lower[3][3];
    int fall;
    int32_t half; /* of what falls away, for rounding */
    bool shines;  /* there are highlights */
} setting;

/* A place on a surface, in world space. */
typedef struct spot {
    int64_t place_q16[3];
    int32_t normal_q30[3];
    int32_t to_eye_q30[3]; /* where it is asked for */
    int32_t towards_eye_q28;
} spot;

/* How much light of each colour arrives, 255 for all, Q16: 32 lamps make it 2^29 at most. */
typedef struct sums {
    uint32_t diffuse_q16[3], specular_q16[3];
} sums;

static uint32_t times_q16(uint32_t a_q16, uint32_t b_q16)
{
    return (a_q16 * b_q16 + (1U << 15)) >> 16; /* below 2^32 */
}

/* n / d in Q31, too low by less than 2^-27 of it: n <= d, d > 0. */
static uint32_t ratio_q31(uint32_t n, uint32_t d)
{
    uint32_t moved_d = d;
    const unsigned zeros = el_normalise(&moved_d);
    return el_product_high_u32(n << zeros, el_reciprocal_near(moved_d));
}

/* 1 / (1 + (length of v / half)^2). */
static uint32_t attenuation_q16(const el_arrow *v, uint32_t half_q16)
{
    if (half_q16 == 0) {
        return WHOLE_Q16;
    }
    /* Squares of 31 bits, each with its exponent. */
    uint32_t half = half_q16;
    const int zeros = (int)el_normalise(&half);
    uint32_t near_part = el_product_high_u32(half, half) >> 1;
    uint32_t far_part = v->square >> 1;
    const int apart = 2 * (zeros - v->shift);
    if (apart >= 0) {
        near_part >>= el_min_i32(apart, 31);
    } else {
        far_part >>= el_min_i32(-apart, 31);
    }
    return el_min_u32((ratio_q31(near_part, near_part + far_part) + (1U << 14)) >> 15, WHOLE_Q16);
}

/* What of a spot's light goes there. */
static uint32_t cone_q16(const el_lamp *lamp, const int32_t to_lamp_q30[3])
{
    const int64_t cosine_q30 = -4 * (int64_t)el_vector_dot_high(lamp->direction_q30, to_lamp_q30);
    if (cosine_q30 <= lamp->outer_q30) {
        return 0;
    }
    if (cosine_q30 >= lamp->inner_q30) {
        return WHOLE_Q16;
    }
    /* Between the two, whose difference is below 2^32. */
    const uint32_t t_q16 =
        ratio_q31((uint32_t)(cosine_q30 - lamp->outer_q30), (uint32_t)lamp->inner_q30 - (uint32_t)lamp->outer_q30) >>
        15;
    return ((t_q16 * t_q16 >> 16) * ((3U << 15) - t_q16)) >> 15; /* the last product is 2^31 where t is 1 */
}

/* c^exponent, 0 <= c < 1, rounded down at each of its products. */
static uint32_t power_q32(uint32_t c_q32, uint32_t exponent)
{
    uint32_t product_q32 = UINT32_MAX;
    for (; exponent > 0; exponent >>= 1) {
        if ((exponent & 1U) != 0) {
            product_q32 = el_product_high_u32(product_q32, c_q32);
        }
        c_q32 = el_product_high_u32(c_q32, c_q32);
    }
    return product_q32;
}

el_status el_highlight_make(el_highlight *highlight, uint32_t exponent)
{
    if (exponent == 0 || exponent > EL_HIGHLIGHT_EXPONENT_MAX) {
        return EL_ERROR_RANGE;
    }
    highlight->exponent = (uint16_t)exponent;
    highlight->power_q15[0] = 1U << 15;
    /* 1 - c goes up by a step / exponent: a quotient, and a remainder that makes one more of it now and then. */
    const uint32_t whole = (1U << (32 + EL_HIGHLIGHT_STEP_LOG2)) / exponent;
    const uint32_t more = (1U << (32 + EL_HIGHLIGHT_STEP_LOG2)) % exponent;
    uint32_t c_q32 = 0; /* 1, modulo 2^32 */
    uint32_t rest = 0;
    for (uint32_t i = 1; i <= EL_HIGHLIGHT_STEPS; i++) {
        c_q32 -= whole;
        rest += more;
        if (rest >= exponent) {
            rest -= exponent;
            c_q32--;
        }
        const bool is_beyond = i >> -EL_HIGHLIGHT_STEP_LOG2 >= exponent;
        highlight->power_q15[i] = (uint16_t)(is_beyond ? 0U : (power_q32(c_q32, exponent) + (1U << 16)) >> 17);
    }
    return EL_OK;
}

/* Where the light comes from so nearly against the view that what is halfway has no more than 15 bits, nothing is seen. */
enum { HALFWAY_SHIFT_MAX = 14 };

/* max(0, n . h)^exponent. */
static uint32_t highlight_q16(const spot *at, const int32_t to_lamp_q30[3], int32_t towards_lamp_q28,
                              const el_highlight *highlight)
{
    const int32_t along_q28 = towards_lamp_q28 + at->towards_eye_q28; /* n . (l + e), which is |l + e| at most */
    int32_t halfway_q29[3];
    for (unsigned i = 0; i < 3; i++) {
        halfway_q29[i] = (to_lamp_q30[i] >> 1) + (at->to_eye_q30[i] >> 1);
    }
    el_arrow halfway;
    if (along_q28 <= 0 || !el_arrow_make(&halfway, halfway_q29) || halfway.shift > HALFWAY_SHIFT_MAX) {
        return 0;
    }
    el_arrow_measure(&halfway);
    const uint32_t cosine_q30 = el_product_high_u32((uint32_t)along_q28 << (halfway.shift + 1), halfway.to_unit);
    const uint32_t less_q30 = EL_UNIT_Q30 - el_min_u32(cosine_q30, EL_UNIT_Q30);
    /* Steps of the table in Q16. */
    const uint32_t steps_q16 =
        (uint32_t)(el_product_u32_u16(less_q30, highlight->exponent) >> (30 + EL_HIGHLIGHT_STEP_LOG2 - 16));
    const uint32_t step = steps_q16 >> 16;
    if (step >= EL_HIGHLIGHT_STEPS) {
        return 0;
    }
    const uint32_t nearer = highlight->power_q15[step];
    const uint32_t fall = nearer - highlight->power_q15[step + 1U]; /* at most 2^15, times less than 2^16 */
    return el_min_u32((nearer << 1) - (fall * (steps_q16 & 0xFFFFU) >> 15), WHOLE_Q16);
}

static void add_lamp(sums *s, const setting *set, const el_lamp *lamp, const spot *at)
{
    int32_t direction_q30[3];
    const int32_t *to_lamp_q30 = lamp->direction_q30;
    uint32_t arrives_q16 = WHOLE_Q16;
    int32_t cosine_q28; /* of a direction that has length 1 */
    if (lamp->kind == EL_LAMP_DIRECTIONAL) {
        cosine_q28 = el_vector_dot_high(at->normal_q30, to_lamp_q30);
        if (cosine_q28 <= 0) {
            return;
        }
    } else {
        el_arrow v;
        if (!el_arrow_between(&v, at->place_q16, lamp->position_q16)) {
            return; /* the lamp is in the surface */
        }
        /* Which side of the surface it is on is known before its distance. */
        const int32_t along = el_vector_dot_high(at->normal_q30, v.v);
        if (along <= 0) {
            return;
        }
        el_arrow_measure(&v);
        cosine_q28 = (int32_t)el_product_high_u32((uint32_t)along, v.to_unit);
        if (set->shines || lamp->kind == EL_LAMP_SPOT) {
            el_arrow_direction(&v, direction_q30);
            to_lamp_q30 = direction_q30;
        }
        if (lamp->kind == EL_LAMP_SPOT) {
            arrives_q16 = cone_q16(lamp, to_lamp_q30);
            if (arrives_q16 == 0) {
                return;
            }
        }
        arrives_q16 = times_q16(arrives_q16, attenuation_q16(&v, lamp->half_q16));
    }
    const uint32_t diffuse_q16 =
        times_q16(arrives_q16, el_min_u32(((uint32_t)cosine_q28 + (1U << 11)) >> 12, WHOLE_Q16));
    const uint32_t specular_q16 =
        set->shines ? times_q16(arrives_q16, highlight_q16(at, to_lamp_q30, cosine_q28, set->lighting->highlight)) : 0U;
    for (unsigned i = 0; i < 3; i++) {
        s->diffuse_q16[i] += lamp->colour[i] * diffuse_q16;
        s->specular_q16[i] += lamp->colour[i] * specular_q16;
    }
}

/* x / 255 rounded down, or 1 less. x < 2^31. */
static uint32_t divide_by_255(uint32_t x)
{
    return (x + (x >> 8) + (x >> 16) + (x >> 24)) >> 8;
}

static void light(const setting *set, const spot *at, const uint8_t own[3], uint8_t colour[3])
{
    const el_lighting *const l = set->lighting;
    sums s;
    for (unsigned i = 0; i < 3; i++) {
        s.diffuse_q16[i] = ((uint32_t)l->ambient[i] << 16) + 128U;
        s.specular_q16[i] = 128U;
    }
    for (unsigned i = 0; i < l->lamp_count; i++) {
        add_lamp(&s, set, &l->lamps[i], at);
    }
    for (unsigned i = 0; i < 3; i++) {
        /* Light in 255ths, 8.8, below 2^22; times two colours below 2^31. */
        const uint32_t reflected = own[i] * (s.diffuse_q16[i] >> 8) + l->specular[i] * (s.specular_q16[i] >> 8);
        const uint32_t sum_q8 = ((uint32_t)l->emissive[i] << 8) + divide_by_255(reflected);
        colour[i] = (uint8_t)el_min_u32((sum_q8 + 128U) >> 8, 255U);
    }
}

/* `count`: of how many places each one is the sum. */
static void set_up(setting *set, const el_lighting *l, const el_mesh *mesh, const el_pose *pose, const int32_t *eye_q16,
                   uint32_t count)
{
    uint32_t scale = el_max_u32(pose->scale_q16, 1);
    const int zeros = (int)el_normalise(&scale);
    scale /= count;
    for (unsigned i = 0; i < 3; i++) {
        for (unsigned j = 0; j < 3; j++) {
            /* Times scale / 2^32: within 2^30, and 2^26 of it are kept. */
            const int32_t factor = (el_multiply_high_i32_u32(el_clamp_unit(pose->rotation_q30[i][j]), scale) + 8) >> 4;
            set->upper[i][j] = factor >> HALF_BITS;
            set->lower[i][j] = (int32_t)((uint32_t)factor & ((1U << HALF_BITS) - 1U));
        }
    }
    set->fall = el_max_i32(el_min_i32(zeros - 6 - HALF_BITS - mesh->scale_log2, FALL_MAX), FALL_MIN);
    set->half = set->fall > 0 && set->fall < FALL_MAX ? 1 << (set->fall - 1) : 0;
    set->lighting = l;
    set->pose = pose;
    set->eye_q16 = eye_q16;
    set->shines = l->highlight != NULL && (l->specular[0] | l->specular[1] | l->specular[2]) != 0;
}

/* (high * 2^HALF_BITS + low) / 2^(HALF_BITS + fall), rounded to nearest, or down where that is within 2. */
static int64_t moved(const setting *set, int32_t high, int32_t low)
{
    if (set->fall >= 0) {
        return (high + (low >> HALF_BITS) + set->half) >> set->fall;
    }
    const int32_t factor = 1 << -set->fall;
    return (int64_t)high * factor + ((int64_t)low * factor >> HALF_BITS);
}

/* Where a place of the mesh and a sum of its normals are. The normal's length is left out; one that has none looks along
 * z. */
static void find_spot(spot *at, const setting *set, const int32_t place[3], const int32_t normal[3])
{
    int32_t turned[3];
    el_arrow arrow;
    for (unsigned i = 0; i < 3; i++) {
        /* |place| <= 2^15, or 3 * 2^15 with a third of the factors: 3 * 2^29 at most, which leaves 2^28 and more
         * for the half, and less than 9 * 2^27. */
        const int32_t *const upper = set->upper[i];
        const int32_t *const lower = set->lower[i];
        const int32_t high = upper[0] * place[0] + upper[1] * place[1] + upper[2] * place[2];
        const int32_t low = lower[0] * place[0] + lower[1] * place[1] + lower[2] * place[2];
        at->place_q16[i] = set->pose->position_q16[i] + moved(set, high, low);
        const int32_t *const row = set->pose->rotation_q30[i];
        /* |normal| <= 3 * 2^7: below 2^29 each. */
        turned[i] = el_product_down_11(normal[0], row[0]) + el_product_down_11(normal[1], row[1]) +
                    el_product_down_11(normal[2], row[2]);
    }
    if (el_arrow_make(&arrow, turned)) {
        el_arrow_measure(&arrow);
        el_arrow_direction(&arrow, at->normal_q30);
    } else {
        at->normal_q30[0] = 0;
        at->normal_q30[1] = 0;
        at->normal_q30[2] = EL_UNIT_Q30;
    }
    if (!set->shines && !set->lighting->two_sided) {
        return; /* nothing asks for the eye */
    }
    if (el_arrow_between(&arrow, at->place_q16, set->eye_q16)) {
        el_arrow_measure(&arrow);
        el_arrow_direction(&arrow, at->to_eye_q30);
    } else {
        for (unsigned i = 0; i < 3; i++) {
            at->to_eye_q30[i] = at->normal_q30[i];
        }
    }
    at->towards_eye_q28 = el_vector_dot_high(at->normal_q30, at->to_eye_q30);
    if (set->lighting->two_sided && at->towards_eye_q28 < 0) {
        at->towards_eye_q28 = -at->towards_eye_q28;
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
    setting set;
    set_up(&set, lighting, mesh, pose, eye_q16, 1);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const int16_t *const p = mesh->positions[v];
        const int8_t *const n = mesh->normals[v];
        const int32_t place[3] = {p[0], p[1], p[2]};
        const int32_t normal[3] = {n[0], n[1], n[2]};
        spot at;
        find_spot(&at, &set, place, normal);
        light(&set, &at, mesh->colours != NULL ? mesh->colours[v] : lighting->colour, colours[v]);
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
    setting set;
    set_up(&set, lighting, mesh, pose, eye_q16, 3);
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
        find_spot(&at, &set, place, normal);
        light(&set, &at, colour_of_triangle(lighting, mesh, t), colours[t]);
    }
    return EL_OK;
}
