/* What is skipped could not have been seen: of a cluster that is called outside all vertices lie beyond one plane of the view,
 * and of one that is called turned away every triangle, snapped, shows its back. Seeded clusters of all sizes, from slivers
 * to squares, before seeded cameras; and enough of both verdicts that clusters are worth their bytes. */
#include <math.h>

#include "geometry/cluster.h"
#include "raster/plane.h"
#include "seeded.h"

enum { TRIANGLES = 5, VERTICES = 3 * TRIANGLES, ROUNDS = PART_OF(60000) };

typedef struct patch {
    int16_t positions[VERTICES][3];
    uint16_t triangles[TRIANGLES][3];
    el_cluster cluster;
    el_mesh mesh;
} patch;

void setUp(void)
{
}

void tearDown(void)
{
}

static void cross(const double a[3], const double b[3], double product[3])
{
    for (unsigned i = 0; i < 3; i++) {
        product[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    }
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void any_direction(seeded *s, double direction[3])
{
    double length;
    do {
        for (unsigned i = 0; i < 3; i++) {
            direction[i] = (double)any_between(s, -1000, 1000);
        }
        length = sqrt(dot(direction, direction));
    } while (length < 100);
    for (unsigned i = 0; i < 3; i++) {
        direction[i] /= length;
    }
}

static void normal_of(const patch *p, unsigned triangle, double sides[3][3], double normal[3])
{
    for (unsigned i = 0; i < 3; i++) {
        for (unsigned k = 0; k < 3; k++) {
            sides[i][k] = p->positions[3 * triangle + (i + 1) % 3][k] - p->positions[3 * triangle + i][k];
        }
    }
    cross(sides[0], sides[1], normal);
}

/* Sphere, cone and altitude as the converter makes them. */
static void describe(patch *p, const double axis[3])
{
    double radius = 0;
    double least_altitude = 65535;
    double least_cosine = 1;
    double quantised[3];
    for (unsigned i = 0; i < 3; i++) {
        p->cluster.axis[i] = (int8_t)lround(axis[i] * 127);
        quantised[i] = p->cluster.axis[i];
    }
    for (unsigned t = 0; t < TRIANGLES; t++) {
        double sides[3][3];
        double normal[3];
        normal_of(p, t, sides, normal);
        const double area = sqrt(dot(normal, normal));
        double longest = 1;
        for (unsigned i = 0; i < 3; i++) {
            longest = fmax(longest, sqrt(dot(sides[i], sides[i])));
            double from_centre[3];
            for (unsigned k = 0; k < 3; k++) {
                from_centre[k] = p->positions[3 * t + i][k] - p->cluster.centre[k];
            }
            radius = fmax(radius, sqrt(dot(from_centre, from_centre)));
        }
        least_altitude = fmin(least_altitude, area / longest);
        least_cosine =
            area == 0 ? -1 : fmin(least_cosine, dot(normal, quantised) / area / sqrt(dot(quantised, quantised)));
    }
    const double sine = least_cosine <= 0 ? 1 : sqrt(fmax(0, 1 - least_cosine * least_cosine));
    p->cluster.spread = (uint8_t)fmin(255, ceil(256 * sine + 0.01));
    p->cluster.altitude = (uint16_t)floor(least_altitude);
    p->cluster.radius = (uint16_t)fmin(65535, ceil(radius));
    p->cluster.triangle_count = TRIANGLES;
    p->cluster.vertex_count = VERTICES;
}

/* Triangles around a place, facing about one way. */
static void fill_patch(seeded *s, patch *p)
{
    double axis[3];
    any_direction(s, axis);
    const int64_t size = 4 + (int64_t)any_of_bits(s, 12);
    const double roughness = (double)any_below(s, 6) * any_below(s, 6) / 100;
    for (unsigned i = 0; i < 3; i++) {
        p->cluster.centre[i] = (int16_t)any_between(s, -12000, 12000);
    }
    const bool slivers = any_below(s, 8) == 0;
    for (unsigned t = 0; t < TRIANGLES; t++) {
        double tilt[3];
        double right[3];
        double up[3];
        any_direction(s, tilt);
        for (unsigned i = 0; i < 3; i++) {
            tilt[i] = axis[i] + tilt[i] * roughness;
        }
        any_direction(s, up);
        cross(tilt, up, right);
        cross(tilt, right, up);
        const double aside =
            (double)size * ((double)any_below(s, 200) / 100 - 1); /* in front of the others, or behind */
        const double scale = (double)size / fmax(0.01, fmax(sqrt(dot(right, right)), sqrt(dot(up, up))));
        for (unsigned i = 0; i < 3; i++) {
            const double angle = (double)(any_below(s, 100) + (slivers ? 0U : 200 * i)) / 100;
            const double u = cos(angle) * (0.6 + 0.4 * (t % 2));
            const double v = sin(angle) * (0.6 + 0.4 * (t % 2));
            p->triangles[t][i] = (uint16_t)(3 * t + i);
            for (unsigned k = 0; k < 3; k++) {
                p->positions[3 * t + i][k] =
                    (int16_t)lround(p->cluster.centre[k] + aside * axis[k] + scale * (u * right[k] + v * up[k]));
            }
        }
        double sides[3][3];
        double normal[3];
        normal_of(p, t, sides, normal);
        for (unsigned k = 0; k < 3 && dot(normal, axis) < 0; k++) { /* turn it around */
            const int16_t kept = p->positions[3 * t][k];
            p->positions[3 * t][k] = p->positions[3 * t + 1][k];
            p->positions[3 * t + 1][k] = kept;
        }
    }
    describe(p, axis);
    p->mesh = (el_mesh){.positions = (const int16_t(*)[3])p->positions,
                        .triangles = (const uint16_t(*)[3])p->triangles,
                        .vertex_count = VERTICES,
                        .triangle_count = TRIANGLES,
                        .scale_log2 = (int8_t)any_between(s, -14, -10),
                        .radius = 40000,
                        .cluster_count = 1,
                        .clusters = &p->cluster};
}

/* False where the camera cannot see such a mesh at all. */
static bool make_transform(seeded *s, const patch *p, el_transform *transform)
{
    static const uint16_t sizes[][2] = {{320, 240}, {128, 64}, {240, 240}, {1600, 1200}, {8, 8}};
    const unsigned size = any_below(s, sizeof sizes / sizeof sizes[0]);
    el_camera camera = {.projection = any_below(s, 6) == 0 ? EL_ORTHOGRAPHIC : EL_PERSPECTIVE,
                        .fov_y = EL_DEGREES(any_between(s, 8, 120), 1),
                        .height_q16 = (uint32_t)any_between(s, 1, 20) * EL_UNIT_Q16,
                        .near_q16 = EL_UNIT_Q16 / 16,
                        .far_q16 = 200 * EL_UNIT_Q16};
    static const int32_t up[3] = {0, EL_UNIT_Q16, 0};
    const int32_t reach = EL_UNIT_Q16 << any_below(s, 5);
    const int32_t eye[3] = {(int32_t)any_between(s, -reach, reach), (int32_t)any_between(s, -reach, reach), reach};
    const int32_t target[3] = {(int32_t)any_between(s, -reach, reach) / 8, 0, 0};
    if (el_camera_look_at(&camera, eye, target, up) != EL_OK) {
        return false;
    }
    if (any_below(s, 4) == 0) { /* a mirror */
        for (unsigned i = 0; i < 3; i++) {
            camera.axes_q30[0][i] = -camera.axes_q30[0][i];
        }
    }
    el_view view;
    TEST_ASSERT_EQUAL_INT(EL_OK, el_view_make(&view, &camera, sizes[size][0], sizes[size][1]));
    el_pose pose = el_pose_identity();
    el_pose_turn(&pose, EL_AXIS_Y, (el_angle)any_u64(s));
    el_pose_turn(&pose, EL_AXIS_X, (el_angle)any_u64(s));
    if (any_below(s, 4) == 0) { /* no rotation at all */
        pose.rotation_q30[1][1] /= 2;
        pose.rotation_q30[0][2] /= 3;
    }
    return el_transform_make(transform, &view, &p->mesh, &pose) == EL_VISIBLE;
}

static void expect_outside(const seeded *s, const patch *p, const el_transform *transform)
{
    unsigned codes = EL_CODE_OUTSIDE;
    for (unsigned i = 0; i < VERTICES; i++) {
        const el_clip_vertex vertex = el_transform_position(transform, p->positions[i]);
        codes &= el_outcode(transform, &vertex);
    }
    if (codes == 0) {
        fail_at(s, "a cluster that reaches into the view is called outside");
    }
}

/* Returns whether all triangles show their backs, whole and unclipped. */
static bool all_turned(const patch *p, const el_transform *transform)
{
    for (unsigned t = 0; t < TRIANGLES; t++) {
        int32_t x[3];
        int32_t y[3];
        for (unsigned i = 0; i < 3; i++) {
            el_screen_vertex v;
            el_transform_vertex(transform, p->positions[3 * t + i], &v);
            if ((v.code & EL_CODE_CLIP) != 0) {
                return false;
            }
            x[i] = v.x;
            y[i] = v.y;
        }
        const int64_t area = el_doubled_area(x, y);
        if (area == 0 || (area > 0) == (transform->mirrored != 0)) {
            return false;
        }
    }
    return true;
}

static void test_only_what_cannot_be_seen_is_skipped(void)
{
    static patch p;
    uint32_t outside = 0;
    uint32_t turned = 0;
    uint32_t all = 0;
    uint32_t looked = 0;
    for (seeded s = seeded_from(600); s.round < ROUNDS; s.round++) {
        el_transform transform;
        fill_patch(&s, &p);
        if (!make_transform(&s, &p, &transform)) {
            continue;
        }
        looked++;
        el_cluster_view view;
        el_cluster_view_make(&view, &transform, false);
        const el_cluster_verdict verdict = el_cluster_look(&view, &transform, &p.cluster);
        const bool backs = all_turned(&p, &transform);
        if (verdict == EL_CLUSTER_TURNED && !backs) {
            fail_at(&s, "a cluster with a front is called turned away");
        }
        if (verdict == EL_CLUSTER_OUTSIDE) {
            expect_outside(&s, &p, &transform);
        }
        outside += verdict == EL_CLUSTER_OUTSIDE;
        turned += verdict == EL_CLUSTER_TURNED;
        all += backs && verdict != EL_CLUSTER_OUTSIDE && transform.orthographic == 0;
        el_cluster_view_make(&view, &transform, true);
        if (el_cluster_look(&view, &transform, &p.cluster) == EL_CLUSTER_TURNED) {
            fail_at(&s, "a cluster with two sides is called turned away");
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(looked / 5, outside);
    TEST_ASSERT_GREATER_THAN_UINT32(PART_OF(500), turned);
    TEST_ASSERT_GREATER_THAN_UINT32(all / 8, turned);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_only_what_cannot_be_seen_is_skipped);
    return UNITY_END();
}
