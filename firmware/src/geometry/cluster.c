/* The two verdicts on a cluster, from its sphere and its cone, in the draw's own clip coordinates: what vertices are
 * compared with is an integer, and so is what is known of all of them before they are transformed. */
#include "geometry/cluster.h"

#include "base/fixed.h"

/* Cones are left alone where numbers are too coarse for them: an adjugate of fewer bits loses its directions, and with w
 * below so many units per pixel a corner's place is not known to a fraction of a sub-pixel. */
enum { MIN_DETERMINANT_BITS = 46, MIN_DIRECTION_BITS = 43, MIN_W_PER_SUBPIXEL = 12, NO_CONE = 252 };

/* log2(1 + f) is f + 0.344 f (1 - f), less 2/256 to more 5/256. */
static int32_t log2_near_q8(uint64_t x)
{
    const int leading = __builtin_clzll(x);
    const uint32_t f = (uint32_t)((x << leading) << 1 >> 56);
    return (63 - leading) * 256 + (int32_t)(f + (f * (256U - f) * 88U >> 16));
}

static int32_t log2_floor_q8(uint64_t x)
{
    return log2_near_q8(x) - 3;
}

static int32_t log2_ceil_q8(uint64_t x)
{
    return log2_near_q8(x) + 5;
}

/* 2^(log2_q8 / 256), rounded up: 2^f <= 1 + f. log2_q8 < 30 * 256. */
static uint32_t power_of_two(int32_t log2_q8)
{
    return log2_q8 < 0 ? 1U : ((uint32_t)(256 + (log2_q8 & 255)) << (log2_q8 >> 8) >> 8) + 1U;
}

/* Length of a row, rounded up. */
static uint32_t length_of(const int32_t row[3])
{
    uint64_t sum = 0; /* three squares below 2^58 */
    for (unsigned i = 0; i < 3; i++) {
        sum += (uint64_t)((int64_t)row[i] * row[i]);
    }
    return el_sqrt_u64(sum) + 1U;
}

/* The adjugate of the rows, rounded to 30 bits; returns how many bits were left out, or -1 where the rows are 0. It takes
 * clip coordinates to directions: rows * (point - camera) = 2^shift * clip, so point - camera goes with adjugate * clip. */
static int make_adjugate(const int32_t rows[3][3], int32_t adjugate[3][3])
{
    int64_t exact[3][3]; /* |element| < 2 * 2^58 */
    uint64_t all = 0;
    for (unsigned i = 0; i < 3; i++) {
        const int32_t *const a = rows[(i + 1) % 3];
        const int32_t *const b = rows[(i + 2) % 3];
        for (unsigned j = 0; j < 3; j++) {
            const unsigned k = (j + 1) % 3;
            const unsigned l = (j + 2) % 3;
            exact[j][i] = (int64_t)a[k] * b[l] - (int64_t)a[l] * b[k];
            all |= el_abs_u64(exact[j][i]);
        }
    }
    const int dropped = el_max_i32(0, el_bit_length_u64(all) - 29);
    for (unsigned i = 0; i < 3; i++) {
        for (unsigned j = 0; j < 3; j++) {
            adjugate[i][j] = (int32_t)el_shift_i64(exact[i][j], dropped);
        }
    }
    return all == 0 ? -1 : dropped;
}

/* What the sphere of a cluster must be within, in half screens from the middle: for that place is known what a pixel is. */
enum { AROUND_THE_SCREEN_Q3 = 9 };

static uint64_t product_of(const int32_t a[3], const int32_t b[3], unsigned dropped)
{
    int64_t sum = 0; /* three products below 2^58 */
    for (unsigned i = 0; i < 3; i++) {
        sum += (int64_t)a[i] * b[i];
    }
    return (el_abs_u64(sum) >> dropped) + 1U;
}

/* The most pixels that a position unit can have on the screen, times w and 2^shift. With X and Y the rows in pixels, D that
 * of the distance and s the place on the screen, a step e moves its point by (X.e - s D.e) / w, and the largest such step
 * squared is at most max(X.X, Y.Y) + |X.Y| + 2 |s| (|X.D| + |Y.D|) + s.s D.D. Products of rows without 22 bits, times
 * numbers of pixels below 2^11. */
static uint64_t pixels_per_unit(const el_transform *transform, const int32_t rows[3][3])
{
    enum { DROPPED = 22 };
    const uint64_t w = (transform->size[0] + 1U) / 2U;
    const uint64_t h = (transform->size[1] + 1U) / 2U;
    const int32_t *const x = rows[0];
    const int32_t *const y = rows[1];
    const int32_t *const d = rows[2];
    const uint64_t aside = ((w + h) * AROUND_THE_SCREEN_Q3 >> 3) + 1U;
    const uint64_t aside_squared = ((w * w + h * h) * AROUND_THE_SCREEN_Q3 * AROUND_THE_SCREEN_Q3 >> 6) + 1U;
    const uint64_t xx = product_of(x, x, DROPPED) * w * w;
    const uint64_t yy = product_of(y, y, DROPPED) * h * h;
    const uint64_t square = (xx > yy ? xx : yy) + product_of(x, y, DROPPED) * w * h +
                            2U * aside * (product_of(x, d, DROPPED) * w + product_of(y, d, DROPPED) * h) +
                            aside_squared * product_of(d, d, DROPPED);
    return ((uint64_t)el_sqrt_u64(square) + 1U) << (DROPPED / 2);
}

/* With W and H the screen in pixels, D the rows' determinant and P the pixels of a position unit times w: a triangle of
 * doubled area A whose plane has the camera m position units behind it has at least |D| W/2 H/2 A m / w^3 of doubled area on
 * the screen, and none of its edges e is longer there than P e / w. So its least altitude there is at least
 * |D| W/2 H/2 m altitude w_least / (P w_most^3). Snapping moves its corners by less than 0.9/S px, S = EL_SUBPIXELS: half a
 * sub-pixel and an eighth on each axis. A triangle whose least altitude is five times that keeps its winding:
 * with c for that move and L >= a for longest side and altitude on it, the new doubled area is at least
 * a L - 2c L - 2c (a + 2c), and above 0 for a >= 5c. */
static void make_cones(el_cluster_view *view, const el_transform *transform, const int32_t rows[3][3])
{
    const int32_t shift = (int32_t)el_transform_shift(transform);
    const int dropped = make_adjugate(rows, view->to_model);
    if (dropped < 0) {
        return;
    }
    int64_t determinant = 0; /* without `dropped` bits: three products below 2^58 */
    for (unsigned j = 0; j < 3; j++) {
        determinant += (int64_t)rows[0][j] * view->to_model[j][0];
    }
    const uint64_t magnitude = el_abs_u64(determinant);
    const int bits = el_bit_length_u64(magnitude);
    if (bits < MIN_DETERMINANT_BITS) {
        return;
    }
    view->cones = true;
    view->mirrored = determinant < 0;
    view->unit = (uint32_t)(magnitude >> (bits - 31));
    view->unit_log2 = (int8_t)(bits - 31 - shift);

    const int32_t one = 256;
    const int32_t area_q8 = log2_floor_q8(transform->size[0]) + log2_floor_q8(transform->size[1]) - 2 * one +
                            log2_floor_q8(magnitude) + one * (dropped - 3 * shift);
    const int32_t pixels_q8 = log2_ceil_q8(pixels_per_unit(transform, rows)) - one * shift;
    const int32_t least_altitude_q8 = 556 - one * EL_SUBPIXEL_BITS; /* log2(4.5 / S) */
    view->slack_log2_q8 = least_altitude_q8 + pixels_q8 - area_q8;
}

void el_cluster_view_make(el_cluster_view *view, const el_transform *transform, bool two_sided)
{
    int32_t rows[3][3];
    for (unsigned i = 0; i < 3; i++) {
        for (unsigned j = 0; j < 3; j++) {
            rows[i][j] = el_transform_element(transform, i, j);
        }
        view->reach[i] = length_of(rows[i]);
    }
    view->cones = false;
    if (!two_sided && !el_transform_is_orthographic(transform)) {
        make_cones(view, transform, (const int32_t(*)[3])rows);
    }
}

/* Whether all triangles of a cluster that lies before the camera face away. `least` and `most`: w of its vertices. */
static bool is_turned(const el_cluster_view *view, const el_cluster *cluster, const el_clip_vertex *centre,
                      int32_t least, int32_t most)
{
    const int32_t altitude_q8 = log2_floor_q8(cluster->altitude);
    const int32_t most_q8 = log2_ceil_q8((uint32_t)most);
    const int32_t slack_q8 = view->slack_log2_q8 + 3 * most_q8 - log2_floor_q8((uint32_t)least) - altitude_q8;
    if (slack_q8 >= 16 * 256) {
        return false;
    }
    /* From the camera to the sphere's centre, in view->unit's unit; three products below 2^59. */
    const int32_t clip[3] = {centre->x, centre->y, centre->d};
    int64_t exact[3];
    uint64_t all = 0;
    for (unsigned i = 0; i < 3; i++) {
        exact[i] = 0;
        for (unsigned j = 0; j < 3; j++) {
            exact[i] += (int64_t)view->to_model[i][j] * clip[j];
        }
        all |= el_abs_u64(exact[i]);
    }
    const int bits = el_bit_length_u64(all);
    if (bits < MIN_DIRECTION_BITS) {
        return false;
    }
    const int dropped = bits - 30;
    uint64_t squares = 0;
    int64_t along = 0; /* the axis, about 127 times */
    for (unsigned i = 0; i < 3; i++) {
        const int32_t part = (int32_t)(exact[i] >> dropped);
        squares += (uint64_t)((int64_t)part * part);
        along += (int64_t)part * cluster->axis[i];
    }
    if (view->mirrored) {
        along = -along;
    }
    /* With d that direction, r the radius, s the spread and m the slack: axis . d >= |d| s + r + m means that each
     * normal . (point - camera) >= m, for sin a - sin b <= sin(a - b). 2/256 of |d| cover what is cut off above. */
    const uint64_t room = (uint64_t)cluster->radius + power_of_two(slack_q8) + 2U; /* below 2^18 */
    const int shift = dropped - view->unit_log2;
    if (shift < -13) {
        return false; /* more than any direction has */
    }
    const uint64_t scaled =
        shift >= 0 ? (room * view->unit >> (shift < 63 ? shift : 63)) + 1U : room * view->unit << -shift;
    const uint64_t aside = ((uint64_t)(el_sqrt_u64(squares) + 1U) * (cluster->spread + 2U) >> 8) + 1U;
    return along >= 0 && (uint64_t)along >= 128U * (aside + scaled);
}

el_cluster_verdict el_cluster_look(const el_cluster_view *view, const el_transform *transform,
                                   const el_cluster *cluster)
{
    const el_clip_vertex centre = el_transform_position(transform, cluster->centre);
    /* How far x, y and d of a vertex may be from the centre's: below 2^31 * 2^16, and all of them are rounded down. */
    int64_t reach[3];
    for (unsigned i = 0; i < 3; i++) {
        reach[i] = (int64_t)(((uint64_t)view->reach[i] * cluster->radius) >> el_transform_shift(transform)) + 2;
    }
    const int64_t w_reach = el_transform_is_orthographic(transform) ? 0 : reach[2];
    const int64_t x = centre.x < 0 ? -(int64_t)centre.x : centre.x;
    const int64_t y = centre.y < 0 ? -(int64_t)centre.y : centre.y;
    if (x - reach[0] > centre.w + w_reach || y - reach[1] > centre.w + w_reach ||
        centre.d + reach[2] < transform->near || centre.d - reach[2] > transform->far) {
        return EL_CLUSTER_OUTSIDE;
    }
    const int64_t least = centre.w - w_reach;
    const int64_t most = centre.w + w_reach;
    const int32_t size = el_max_i32(transform->size[0], transform->size[1]);
    const bool wide = transform->guard_shift[0] == 0 || transform->guard_shift[1] == 0;
    const int64_t around = wide ? least : least * AROUND_THE_SCREEN_Q3 >> 3;
    /* No vertex is clipped, the guard band beginning at the screen's sides or at twice that, and each is at its place to a fraction of a sub-pixel. */
    if (!view->cones || cluster->spread >= NO_CONE || cluster->altitude == 0 || centre.d - reach[2] < transform->near ||
        centre.d + reach[2] > transform->far || least < (int64_t)size * EL_SUBPIXELS * MIN_W_PER_SUBPIXEL ||
        most > INT32_MAX || x + reach[0] > around || y + reach[1] > around) {
        return EL_CLUSTER_SEEN;
    }
    return is_turned(view, cluster, &centre, (int32_t)least, (int32_t)most) ? EL_CLUSTER_TURNED : EL_CLUSTER_SEEN;
}
