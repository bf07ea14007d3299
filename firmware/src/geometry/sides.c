/* sides.h. All is rounded so that what is left out makes a form larger: what is negative still is so with all bits. */
#include "geometry/sides.h"

#if !EL_SMALL_CODE

/* A side's form with more bits: its value at the mesh's centre in the draw's unit, rounded up, and elements in 2^-shift of
 * it, |elements| < 2^32. */
typedef struct form {
    int64_t value;
    int64_t elements[3];
} form;

static void add_row(form *f, const el_transform *transform, unsigned row, int32_t sign)
{
    for (unsigned i = 0; i < 3; i++) {
        f->elements[i] += (int64_t)el_transform_element(transform, row, i) * sign;
    }
}

static void shorten(el_side *side, const form *f, unsigned row_shift, const int16_t centre[3])
{
    /* In quarters of the elements' unit: what is in the sphere is below 2^30 in the draw's, and row_shift is 31 at most. */
    int64_t offset = (int64_t)((uint64_t)f->value << row_shift) >> 2;
    uint64_t most = 0;
    for (unsigned i = 0; i < 3; i++) {
        offset -= f->elements[i] * centre[i] >> 2;
        most += el_abs_u64(f->elements[i]) << 13;
    }
    most += el_abs_u64(offset);
    const int excess = el_bit_length_u64(most) - 28;
    const int shift = excess > 0 ? excess : 0;
    /* The offset loses less than 1, each product less than 2^15. */
    side->offset = (int32_t)(offset >> shift) + 3 * (1 << 15) + 1;
    for (unsigned i = 0; i < 3; i++) {
        side->elements[i] = (int32_t)(f->elements[i] >> (shift + 2));
    }
}

void el_sides_make(el_side sides[EL_SIDES], const el_transform *transform, const el_mesh *mesh)
{
    enum { D = 2 };
    const el_clip_vertex centre = el_transform_position(transform, mesh->centre);
    const int32_t coordinates[2] = {centre.x, centre.y};
    for (unsigned i = 0; i < EL_SIDES; i++) {
        /* Coordinates are rounded down, by less than a unit; el_outcode compares them as they are then. */
        form f = {0};
        if (i < 4) {
            const int32_t sign = i % 2 == 0 ? 1 : -1;
            f.value = (int64_t)coordinates[i / 2] * sign + centre.w + 2;
            add_row(&f, transform, i / 2, sign);
            if (!el_transform_is_orthographic(transform)) {
                add_row(&f, transform, D, 1);
            }
        } else if (i == 4) {
            f.value = (int64_t)centre.d + 1 - transform->near;
            add_row(&f, transform, D, 1);
        } else {
            f.value = (int64_t)transform->far + 1 - centre.d;
            add_row(&f, transform, D, -1);
        }
        shorten(&sides[i], &f, el_transform_shift(transform), mesh->centre);
    }
}
#endif
