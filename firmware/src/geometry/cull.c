/* cull.h. Preparing a draw takes thousands of instructions, in 64 bits, because 30 bits of each coordinate must be right;
 * most of what is outside is so far outside that 14 bits do. All products here have 32 bits: what is cut off is added to
 * the sphere. */
#include "geometry/cull.h"

#include "base/fixed.h"

enum {
    WORLD_BITS = 14, /* of world units; the world's 2^15 units make 2^29 */
    UNIT_BITS = 14,  /* of rotations, axes and the scale's mantissa */
    COORDINATE_BITS = 15,
    /* A coordinate before the camera is off by 3 of the centre's own units, 1 per axis for its bits below
     * COORDINATE_BITS, 2 per axis for those of the camera's axes below UNIT_BITS, and 1: at most 3 + 3 + 6 + 1. */
    SLACK = 16
};

uint32_t el_cull_reach(const el_mesh *mesh)
{
    int32_t reach = 0;
    for (unsigned i = 0; i < 3; i++) {
        const int32_t distance = mesh->centre[i];
        reach = el_max_i32(reach, distance < 0 ? -distance : distance);
    }
    return (uint32_t)reach + mesh->radius + 1U;
}

/* value * 2^shift, rounded down. Where shift > 0, |value * 2^shift| < 2^31. */
static int32_t shifted(int32_t value, int shift)
{
    return shift >= 0 ? (int32_t)((uint32_t)value << shift) : value >> el_min_i32(-shift, 31);
}

/* value * 2^-shift, or less. */
static uint32_t shifted_down(uint32_t value, int shift)
{
    return value >> el_min_i32(el_max_i32(shift, 0), 31);
}

/* A row of a rotation with UNIT_BITS. Returns the sum of its squares, twice UNIT_BITS, at most 3 * 2^28. */
static uint32_t row_of(const int32_t row_q30[3], int32_t row[3])
{
    uint32_t squares = 0;
    for (unsigned i = 0; i < 3; i++) {
        row[i] = row_q30[i] >> (30 - UNIT_BITS);
        squares += (uint32_t)(row[i] * row[i]);
    }
    return squares;
}

/* The sum of the squares of `rows` rows of length 1, and what rounding may add. */
static uint32_t most_squares(uint32_t rows)
{
    return (rows << (2 * UNIT_BITS)) + (rows << (UNIT_BITS + 3));
}

/* Below 2^15 * 2^14 * 3. */
static int32_t dot(const int32_t row[3], const int32_t v[3])
{
    return (row[0] * v[0] + row[1] * v[1] + row[2] * v[2]) >> UNIT_BITS;
}

/* A sphere before the camera: its centre to the right, up and ahead, and its radius, in 2^unit of the world's. */
typedef struct el_cull_sphere {
    int32_t centre[3];
    int32_t radius;
    int unit;
} el_cull_sphere;

/* The sphere in the world: its centre relative to the camera's place, and its radius, both with WORLD_BITS. False where
 * the mesh may leave the world, or the pose is no rotation. */
static bool sphere_in_world(const el_view *view, const el_mesh *mesh, const el_pose *pose, int32_t centre[3],
                            int32_t *radius)
{
    /* The mesh reaches less than 2^14 units, so with a rotation no row of el_transform_make's is too long, and all that
     * follows is below 2^(14 + WORLD_BITS) * 1.75 * sqrt(3). */
    const uint32_t reach = el_cull_reach(mesh);
    const int scale_bits = el_bit_length_u32(pose->scale_q16);
    if (scale_bits + mesh->scale_log2 + el_bit_length_u32(reach) > 30) {
        return false;
    }
    const uint32_t scale = (uint32_t)shifted((int32_t)(pose->scale_q16 >> el_max_i32(0, scale_bits - UNIT_BITS)),
                                             el_max_i32(0, UNIT_BITS - scale_bits));
    const int shift = scale_bits - UNIT_BITS + mesh->scale_log2 - (16 - WORLD_BITS);

    int32_t position[3] = {mesh->centre[0], mesh->centre[1], mesh->centre[2]};
    uint32_t squares = 0;
    for (unsigned i = 0; i < 3; i++) {
        int32_t row[3];
        squares += row_of(pose->rotation_q30[i], row);
        /* |dot| < 3 * 2^15, the mantissa is below 2^14. */
        centre[i] = shifted(dot(row, position) * (int32_t)scale, shift) + (pose->position_q16[i] >> (16 - WORLD_BITS)) -
                    (view->position_q16[i] >> (16 - WORLD_BITS));
    }
    /* A matrix makes nothing longer than by the root of its squares' sum: sqrt(3) < 7/4 for a rotation. The centre was
     * rotated and scaled with errors below reach / 512. */
    const uint32_t position_units = mesh->radius * 7U / 4U + reach / 512U + 8U; /* below 2^17 */
    *radius = shifted((int32_t)(position_units * (scale + 1U)), shift) + 1;
    return squares <= most_squares(3);
}

static bool sphere_in_view(const el_view *view, const el_mesh *mesh, const el_pose *pose, el_cull_sphere *sphere)
{
    int32_t centre[3];
    if (!sphere_in_world(view, mesh, pose, centre, &sphere->radius)) {
        return false;
    }
    uint32_t all = (uint32_t)sphere->radius;
    for (unsigned i = 0; i < 3; i++) {
        all |= (uint32_t)(centre[i] < 0 ? ~centre[i] : centre[i]);
    }
    sphere->unit = el_max_i32(0, el_bit_length_u32(all) - COORDINATE_BITS);
    sphere->radius = (sphere->radius >> sphere->unit) + SLACK;
    for (unsigned i = 0; i < 3; i++) {
        centre[i] >>= sphere->unit;
    }
    for (unsigned i = 0; i < 3; i++) {
        int32_t row[3];
        if (row_of(view->axes_q30[i], row) > most_squares(1)) {
            return false;
        }
        sphere->centre[i] = dot(row, centre);
    }
    sphere->centre[2] = -sphere->centre[2];
    return true;
}

/* Beyond the left or right plane (axis 0), or the lower or upper one: focal * (|x| - radius) > w + radius; orthographic:
 * focal * (|x| - radius) >= 1. */
static bool is_beside(const el_view *view, const el_cull_sphere *sphere, unsigned axis)
{
    const int32_t x = sphere->centre[axis];
    const int32_t nearest = (x < 0 ? -x : x) - sphere->radius;
    if (nearest <= 0) {
        return false;
    }
    /* |x| < 2^15 * 1.74, and of the focal factor come the upper 15 bits: below 2^31. */
    const el_factor focal = view->focal[axis];
    const uint32_t scaled = (uint32_t)nearest * (focal.mantissa >> 16);
    const int shift = focal.exponent - 16;
    if (EL_WITH_ORTHOGRAPHIC && view->projection == EL_ORTHOGRAPHIC) {
        return shifted_down(scaled, shift + WORLD_BITS - sphere->unit) >= 1;
    }
    return (int32_t)shifted_down(scaled, shift) > sphere->centre[2] + sphere->radius;
}

bool el_cull_is_far_outside(const el_view *view, const el_mesh *mesh, const el_pose *pose)
{
    el_cull_sphere sphere;
    if (!sphere_in_view(view, mesh, pose, &sphere)) {
        return false;
    }
    const int32_t ahead = sphere.centre[2];
    const int down = 16 - WORLD_BITS + sphere.unit; /* at most 2 + 16 */
    return ahead + sphere.radius < (int32_t)(view->near_q16 >> down) ||
           ahead - sphere.radius > (int32_t)(view->far_q16 >> down) + 1 || is_beside(view, &sphere, 0) ||
           is_beside(view, &sphere, 1);
}
