/* The two verdicts on a cluster, from its sphere and its cone, in the draw's own clip coordinates: what vertices are
 * compared with is an integer, and so is what is known of all of them before they are transformed. */
#include "geometry/cluster.h"

#include "base/fixed.h"

/* Cones are left alone where numbers are too coarse for them: an adjugate of fewer bits loses its directions, and with w
 * below so many units per pixel a corner's place is not known to a fraction of a sub-pixel. */
enum { MIN_DETERMINANT_BITS = 46, MIN_DIRECTION_BITS = 26, MIN_W_PER_SUBPIXEL = 12, NO_CONE = 250 };

/* log2(1 + f) is f + 0.344 f (1 - f), less 2/256 to more 5/256. */
static int32_t log2_near_q8(uint32_t x)
{
    const int32_t zeros = (int32_t)el_normalise(&x);
    const uint32_t f = x << 1 >> 24;
    return (31 - zeros) * 256 + (int32_t)(f + (f * (256U - f) * 88U >> 16));
}

static int32_t log2_floor_q8(uint32_t x)
{
    return log2_near_q8(x) - 3;
}

static int32_t log2_ceil_q8(uint32_t x)
{
    return log2_near_q8(x) + 5;
}

/* What is cut off changes less than 2^-31 of x. */
static int32_t wide_log2_near_q8(uint64_t x)
{
    return x >> 32 == 0 ? log2_near_q8((uint32_t)x) : 32 * 256 + log2_near_q8((uint32_t)(x >> 32));
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

/* The adjugate of the rows, rounded to 29 bits and a sign; returns how many bits were left out, or -1 where the rows
 * are 0. It takes clip coordinates to directions: rows * (point - camera) = 2^shift * clip, so point - camera goes with
 * adjugate * clip. */
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
enum { LEFT_OUT = 15 }; /* bits of the adjugate that directions are found without */

static void make_cones(el_cluster_view *view, const el_transform *transform, const int32_t rows[3][3])
{
    const int32_t shift = (int32_t)el_transform_shift(transform);
    int32_t adjugate[3][3];
    const int dropped = make_adjugate(rows, adjugate);
    if (dropped < 0) {
        return;
    }
    int64_t determinant = 0; /* without `dropped` bits: three products below 2^58 */
    for (unsigned j = 0; j < 3; j++) {
        determinant += (int64_t)rows[0][j] * adjugate[j][0];
    }
    const uint64_t magnitude = el_abs_u64(determinant);
    const int bits = el_bit_length_u64(magnitude);
    if (bits < MIN_DETERMINANT_BITS) {
        return;
    }
    view->cones = true;
    view->mirrored = determinant < 0;
    view->unit = (uint16_t)((magnitude >> (bits - 13)) + 1U);
    view->unit_log2 = (int8_t)(bits - 13 - shift - LEFT_OUT);
    for (unsigned i = 0; i < 3; i++) {
        for (unsigned j = 0; j < 3; j++) {
            view->to_model[i][j] = (int16_t)((adjugate[i][j] + (1 << (LEFT_OUT - 1))) >> LEFT_OUT);
        }
    }

    const int32_t one = 256;
    const int32_t area_q8 = log2_floor_q8(transform->size[0]) + log2_floor_q8(transform->size[1]) - 2 * one +
                            wide_log2_near_q8(magnitude) - 3 + one * (dropped - 3 * shift);
    const int32_t pixels_q8 = wide_log2_near_q8(pixels_per_unit(transform, rows)) + 5 - one * shift;
    const int32_t least_altitude_q8 = 556 - one * EL_SUBPIXEL_BITS; /* log2(4.5 / S) */
    view->slack_log2_q8 = least_altitude_q8 + pixels_q8 - area_q8;
}

void el_cluster_view_make(el_cluster_view *view, const el_transform *transform, bool two_sided)
{
    int32_t rows[3][3];
    uint32_t reach[3];
    for (unsigned i = 0; i < 3; i++) {
        for (unsigned j = 0; j < 3; j++) {
            rows[i][j] = el_transform_element(transform, i, j);
        }
        reach[i] = length_of(rows[i]);
    }
    const int bits = el_bit_length_u32(reach[0] | reach[1] | reach[2]);
    view->reach_log2 = (int8_t)el_max_i32(0, bits - 16);
    for (unsigned i = 0; i < 3; i++) {
        view->reach[i] = (uint16_t)el_min_i32((int32_t)(reach[i] >> view->reach_log2) + 1, UINT16_MAX);
    }
    view->reach_log2 = (int8_t)(view->reach_log2 - (int)el_transform_shift(transform));
    view->cones = false;
    if (!two_sided && !el_transform_is_orthographic(transform)) {
        make_cones(view, transform, (const int32_t(*)[3])rows);
    }
}

/* From the camera to a cluster's middle, 15 bits, and the way from there to the verdict. */
typedef struct sight {
    int32_t along;     /* the cone's axis: 128 times, or a little less */
    uint32_t squares;  /* the squared length */
    int32_t unit_log2; /* a position unit is view->unit * 2^unit_log2 in the same unit */
} sight;

/* False where the direction is not known well enough, or the axis looks back at the camera. */
static bool look_along(const el_cluster_view *view, const el_cluster *cluster, const el_clip_vertex *centre, sight *s)
{
    const uint32_t all = (uint32_t)(centre->x < 0 ? -centre->x : centre->x) |
                         (uint32_t)(centre->y < 0 ? -centre->y : centre->y) | (uint32_t)centre->d;
    const int32_t down = el_max_i32(0, el_bit_length_u32(all) - 15);
    const int32_t clip[3] = {centre->x >> down, centre->y >> down, centre->d >> down};
    /* Three products below 2^14 * 2^15, off by 2^17 at most. */
    int32_t direction[3];
    uint32_t magnitudes = 0;
    for (unsigned i = 0; i < 3; i++) {
        const int16_t *const row = view->to_model[i];
        direction[i] = row[0] * clip[0] + row[1] * clip[1] + row[2] * clip[2];
        magnitudes |= (uint32_t)(direction[i] < 0 ? -direction[i] : direction[i]);
    }
    const int32_t bits = el_bit_length_u32(magnitudes);
    if (bits < MIN_DIRECTION_BITS) {
        return false;
    }
    s->along = 0;
    s->squares = 0;
    for (unsigned i = 0; i < 3; i++) {
        const int32_t part = direction[i] >> (bits - 15);
        s->squares += (uint32_t)(part * part); /* at most 3 * 2^30 */
        s->along += part * cluster->axis[i];
    }
    s->along = view->mirrored ? -s->along : s->along;
    s->unit_log2 = view->unit_log2 - down - (bits - 15);
    return s->along > 0;
}

/* With d that direction, s the spread: axis . d >= |d| s + room means that each normal . (point - camera) is at least what
 * `room`, in position units, has beyond the sphere's radius, for sin a - sin b <= sin(a - b). 4/256 of |d| cover what was
 * cut off. */
static bool leaves_room(const el_cluster_view *view, const el_cluster *cluster, const sight *s, uint32_t room)
{
    const uint32_t scaled = room * view->unit; /* below 2^18 * 2^13 */
    if (s->unit_log2 > 0 || s->unit_log2 < -31) {
        return false; /* closer than anything is to a camera, or too far to matter */
    }
    const int32_t left = (s->along >> 7) - (int32_t)(scaled >> -s->unit_log2) - 1; /* below 2^16 */
    const uint32_t sine_q8 = cluster->spread + 4U;
    return left > 0 &&
           (uint32_t)left * (uint32_t)left > (uint32_t)(el_product_u32_u16(s->squares, sine_q8 * sine_q8) >> 16);
}

/* Whether all triangles of a cluster that lies before the camera face away. `least` and `most`: w of its vertices. */
static bool is_turned(const el_cluster_view *view, const el_cluster *cluster, const el_clip_vertex *centre,
                      int32_t least, int32_t most)
{
    sight s;
    const uint32_t room = cluster->radius + 3U;
    if (!look_along(view, cluster, centre, &s) || !leaves_room(view, cluster, &s, room)) {
        return false;
    }
    const int32_t slack_q8 = view->slack_log2_q8 + 3 * log2_ceil_q8((uint32_t)most) - log2_floor_q8((uint32_t)least) -
                             log2_floor_q8(cluster->altitude);
    return slack_q8 < 16 * 256 && leaves_room(view, cluster, &s, room + power_of_two(slack_q8));
}

/* How far a coordinate of a vertex may be from the centre's, for both are rounded down; INT32_MAX where that is too far for
 * 32 bits. */
static int32_t reach_of(const el_cluster_view *view, const el_cluster *cluster, unsigned i)
{
    enum { MOST = 1 << 28 };
    const uint32_t product = (uint32_t)view->reach[i] * cluster->radius;
    if (view->reach_log2 > 0) {
        return product >= (uint32_t)MOST >> view->reach_log2 ? INT32_MAX : (int32_t)(product << view->reach_log2) + 2;
    }
    const uint32_t reach = product >> -view->reach_log2;
    return reach >= MOST ? INT32_MAX : (int32_t)reach + 2;
}

el_cluster_verdict el_cluster_look(const el_cluster_view *view, const el_transform *transform,
                                   const el_cluster *cluster)
{
    const int32_t x_reach = reach_of(view, cluster, 0);
    const int32_t y_reach = reach_of(view, cluster, 1);
    const int32_t d_reach = reach_of(view, cluster, 2);
    if (x_reach == INT32_MAX || y_reach == INT32_MAX || d_reach == INT32_MAX) {
        return EL_CLUSTER_SEEN;
    }
    /* |coordinates| < 2^30: the centre lies in the mesh's sphere. */
    const el_clip_vertex centre = el_transform_position(transform, cluster->centre);
    const int32_t w_reach = el_transform_is_orthographic(transform) ? 0 : d_reach;
    const int32_t x = centre.x < 0 ? -centre.x : centre.x;
    const int32_t y = centre.y < 0 ? -centre.y : centre.y;
    const int32_t least = centre.w - w_reach;
    const int32_t most = centre.w + w_reach;
    if (x - x_reach > most || y - y_reach > most || centre.d + d_reach < transform->near ||
        centre.d - d_reach > transform->far) {
        return EL_CLUSTER_OUTSIDE;
    }
    if (!view->cones || cluster->spread >= NO_CONE || cluster->altitude == 0) {
        return EL_CLUSTER_SEEN;
    }
    /* No vertex is clipped, the guard band beginning at the screen's sides or at twice that, and each is at its place to a
     * fraction of a sub-pixel. */
    const int32_t size = el_max_i32(transform->size[0], transform->size[1]);
    const bool wide = transform->guard_shift[0] == 0 || transform->guard_shift[1] == 0;
    const int32_t around = wide ? least : least + (least >> 3);
    if (least < size * (EL_SUBPIXELS * MIN_W_PER_SUBPIXEL) || centre.d - d_reach < transform->near ||
        centre.d + d_reach > transform->far || x + x_reach > around || y + y_reach > around) {
        return EL_CLUSTER_SEEN;
    }
    return is_turned(view, cluster, &centre, least, most) ? EL_CLUSTER_TURNED : EL_CLUSTER_SEEN;
}
