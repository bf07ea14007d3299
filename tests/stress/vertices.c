/* Vertices from model space to the snapped screen against long double, written from the conventions of edgeline.h; and
 * cameras that move by tiny steps, under which no vertex may go back. */
#include <math.h>
#include <stdio.h>

#include "edgeline.h"
#include "geometry/transform.h"
#include "stress.h"

enum { POINTS = 24, STEPS = 48, WORLD_Q16 = 1 << 30 };

static const long double pi = 3.14159265358979323846264338327950288L;

/* More than this, in 1/16 px, no vertex may be off: twice what snapping to the nearest costs at 4 bits of sub-pixels. */
static const long double most_off_sixteenths = 1;

typedef struct setting {
    int16_t points[POINTS][3];
    el_mesh mesh;
    el_pose pose;
    el_camera camera;
    uint16_t width, height;
    long double half[2]; /* half the picture at distance 1, or anywhere in orthographic projection */
} setting;

static void print_setting(const setting *t, const int16_t p[3])
{
    printf("  vertex %d %d %d, scale %.8f, position %.5f %.5f %.5f; eye %.5f %.5f %.5f, %s, %.3f degrees or %.4f units "
           "high, %u x %u pixels\n",
           p[0], p[1], p[2], ldexp(t->pose.scale_q16, t->mesh.scale_log2 - 16), t->pose.position_q16[0] / 65536.0,
           t->pose.position_q16[1] / 65536.0, t->pose.position_q16[2] / 65536.0, t->camera.position_q16[0] / 65536.0,
           t->camera.position_q16[1] / 65536.0, t->camera.position_q16[2] / 65536.0,
           t->camera.projection == EL_PERSPECTIVE ? "perspective" : "orthographic", t->camera.fov_y / 11930464.711,
           t->camera.height_q16 / 65536.0, t->width, t->height);
}

/* --- Settings ------------------------------------------------------------------------------------------------------ */

static const el_pose *any_turn(dice *r, el_pose *pose)
{
    *pose = el_pose_identity();
    for (el_axis axis = EL_AXIS_X; axis <= EL_AXIS_Z; axis++) {
        el_pose_turn(pose, axis, (el_angle)any_u64(r));
    }
    return pose;
}

/* Points of a mesh whose scale is 2^-8 to 2^8 world units, as large as the world lets it be or smaller. */
static long double make_mesh(dice *r, setting *t)
{
    const int scale_log2 = (int)any_between(r, -8, 8);
    const unsigned bits = (unsigned)any_between(r, 3, scale_log2 > -1 ? 13 - scale_log2 : 14);
    double squared_most = 0;
    for (unsigned i = 0; i < POINTS; i++) {
        double squared = 0;
        for (unsigned k = 0; k < 3; k++) {
            t->points[i][k] = (int16_t)any_between(r, -(1 << bits), (1 << bits) - 1);
            squared += t->points[i][k] * (double)t->points[i][k];
        }
        squared_most = fmax(squared_most, squared);
    }
    t->mesh = (el_mesh){
        .positions = (const int16_t(*)[3])t->points,
        .vertex_count = POINTS,
        .scale_log2 = (int8_t)scale_log2,
        .radius = (uint16_t)ceil(sqrt(squared_most)),
    };
    (void)any_turn(r, &t->pose);
    t->pose.scale_q16 = (uint32_t)any_between(r, EL_UNIT_Q16 / 2, EL_UNIT_Q16);
    return t->mesh.radius * ldexpl(t->pose.scale_q16, scale_log2 - 16);
}

static void set_picture(dice *r, setting *t)
{
    const bool usual = once_in(r, 2);
    t->width = usual ? 320 : (uint16_t)any_between(r, 1, EL_MAX_WIDTH);
    t->height = usual ? 240 : (uint16_t)any_between(r, 1, EL_MAX_HEIGHT);
    const bool perspective = t->camera.projection == EL_PERSPECTIVE;
    t->half[1] = perspective ? tanl(t->camera.fov_y / 4294967296.0L * pi) : t->camera.height_q16 / 131072.0L;
    t->half[0] = t->half[1] * t->width / t->height;
}

/* The mesh stands before the camera, anywhere in the world. False when the dice fell outside of it. */
static bool any_setting(dice *r, setting *t, el_projection projection, const el_pose *axes)
{
    const long double radius = make_mesh(r, t);
    const long double distance = radius * (0.2L + 4 * (long double)any_fraction(r)) + 0.25L;
    el_camera *const c = &t->camera;
    *c = (el_camera){.projection = projection};
    c->fov_y = (el_angle)any_between(r, EL_DEGREES(20, 1), EL_DEGREES(110, 1));
    c->height_q16 = (uint32_t)fminl(fmaxl(radius * 131072, 256), WORLD_Q16);
    c->near_q16 = (uint32_t)any_between(r, 64, 4096);
    c->far_q16 = WORLD_Q16;
    for (unsigned i = 0; i < 3; i++) {
        const unsigned bits = once_in(r, 2) ? 30 : 20;
        c->position_q16[i] = (int32_t)any_signed_of_bits(r, bits);
        for (unsigned j = 0; j < 3; j++) {
            c->axes_q30[i][j] = axes->rotation_q30[i][j];
        }
    }
    for (unsigned i = 0; i < 3; i++) {
        const long double back = (long double)c->axes_q30[2][i] / EL_UNIT_Q30 * distance * 65536;
        const long double at = c->position_q16[i] - back;
        if (fabsl(at) > WORLD_Q16) {
            return false;
        }
        t->pose.position_q16[i] = (int32_t)at;
    }
    set_picture(r, t);
    return true;
}

/* --- Against long double ------------------------------------------------------------------------------------------- */

typedef struct exact_vertex {
    long double x, y; /* 1/16 px */
    long double depth;
} exact_vertex;

static exact_vertex project(const setting *t, const int16_t p[3])
{
    long double relative[3];
    long double view[3];
    const el_camera *const c = &t->camera;
    for (unsigned i = 0; i < 3; i++) {
        long double turned = 0;
        for (unsigned j = 0; j < 3; j++) {
            turned += ldexpl(t->pose.rotation_q30[i][j], -30) * p[j];
        }
        relative[i] = turned * ldexpl(t->pose.scale_q16, t->mesh.scale_log2 - 16) +
                      ((long double)t->pose.position_q16[i] - c->position_q16[i]) / 65536;
    }
    for (unsigned i = 0; i < 3; i++) {
        view[i] = 0;
        for (unsigned j = 0; j < 3; j++) {
            view[i] += ldexpl(c->axes_q30[i][j], -30) * relative[j];
        }
    }
    const long double distance = -view[2];
    const bool perspective = c->projection == EL_PERSPECTIVE;
    const long double w = perspective ? distance : 1;
    const long double near = c->near_q16 / 65536.0L;
    const long double far = c->far_q16 / 65536.0L;
    const long double linear = (distance - near) / (far - near);
    return (exact_vertex){
        .x = (1 + view[0] / (t->half[0] * w)) * t->width * 8,
        .y = (1 - view[1] / (t->half[1] * w)) * t->height * 8,
        .depth = EL_DEPTH_MAX * (perspective ? linear * far / distance : linear),
    };
}

/* The snapped vertex; false when it is beyond the view or the guard band. */
static bool snapped(const el_transform *transform, const int16_t p[3], el_screen_vertex *screen)
{
    const el_clip_vertex clip = el_transform_position(transform, p);
    screen->code = el_outcode(transform, &clip);
    if ((screen->code & EL_CODE_CLIP) != 0) {
        return false;
    }
    el_project(transform, &clip, screen);
    return true;
}

static bool check_vertex(stress *s, const setting *t, const el_transform *transform, const int16_t p[3])
{
    el_screen_vertex got = {0};
    if (!snapped(transform, p, &got)) {
        return true;
    }
    const exact_vertex exact = project(t, p);
    const long double unit = 16.0L / EL_SUBPIXELS;
    const long double off = fmaxl(fabsl(got.x * unit - exact.x), fabsl(got.y * unit - exact.y));
    category_tally *const tally = &s->tally;
    tally->samples++;
    tally->vertices++;
    tally->vertices_exact += off <= unit / 2;
    keep_largest(&tally->vertex_most_off, (double)off);
    keep_largest(&tally->vertex_depth_most_off, (double)fabsl(got.z - exact.depth));
    if (off <= most_off_sixteenths) {
        return true;
    }
    stress_fail(s, "a vertex must be at %.4Lf, %.4Lf and is at %.4Lf, %.4Lf (1/16 px)", exact.x, exact.y, got.x * unit,
                got.y * unit);
    print_setting(t, p);
    return false;
}

static unsigned run_vertices(stress *s, unsigned argument)
{
    setting t;
    el_pose axes;
    while (!any_setting(&s->random, &t, (el_projection)argument, any_turn(&s->random, &axes))) {
    }
    el_view view;
    el_transform transform;
    int status = el_view_make(&view, &t.camera, t.width, t.height);
    status = status == EL_OK ? el_transform_make(&transform, &view, &t.mesh, &t.pose) : status;
    if (status < 0) {
        stress_fail(s, "a mesh inside the world gets the error %d", status);
        print_setting(&t, t.points[0]);
        return POINTS / 3;
    }
    bool right = true;
    for (unsigned i = 0; i < POINTS && right && status == EL_VISIBLE; i++) {
        right = check_vertex(s, &t, &transform, t.points[i]);
    }
    return POINTS / 3;
}

/* --- Wobble -------------------------------------------------------------------------------------------------------- */

/* Camera axes that are the world's, so that a step along one is exact in Q16: what changes is one coordinate. */
static const el_pose *any_quarter_turn(dice *r, el_pose *pose)
{
    *pose = el_pose_identity();
    el_pose_turn(pose, EL_AXIS_Y, any_below(r, 4) << 30);
    el_pose_turn(pose, EL_AXIS_X, any_below(r, 4) << 30);
    return pose;
}

/* Half of the time the camera starts where its steps take the mesh's reach over a power of two, at which clip coordinates
 * change their unit. */
static void place_before_unit_change(dice *r, setting *t, const int32_t step_q16[3], unsigned axis)
{
    const long double radius = t->mesh.radius * ldexpl(t->pose.scale_q16, t->mesh.scale_log2 - 16);
    const long double scale = axis < 2 ? t->half[axis] : 1;
    const long double reach = ldexpl(1, (int)any_between(r, -4, 12)) * scale - radius;
    if (reach < 0 || reach > radius * 2) {
        return;
    }
    for (unsigned i = 0; i < 3; i++) {
        const int32_t direction = (step_q16[i] > 0) - (step_q16[i] < 0);
        if (direction != 0) { /* the mesh is left behind */
            const long double at = t->camera.position_q16[i] - (long double)direction * reach * 65536;
            const long double place = at + (long double)step_q16[i] * STEPS / 2;
            if (axis < 2 && fabsl(place) < WORLD_Q16) {
                t->pose.position_q16[i] = (int32_t)place;
            }
        }
    }
}

/* Where a coordinate has to go, 1 up, -1 down, or 0 where it has to stay. What must stay may take a step where
 * rounding changes, but it must not come back from it. */
typedef struct path {
    int32_t place;
    int way;
    bool known;
} path;

/* Whether the coordinate went against its way; 0 finds its way with its first step. */
static bool goes_back(path *p, int32_t now, int way)
{
    const int moved = p->known ? (now > p->place) - (now < p->place) : 0;
    p->way = way != 0 ? way : (p->way != 0 ? p->way : moved);
    const bool back = moved != 0 && moved != p->way;
    p->place = now;
    p->known = true;
    return back;
}

/* Moving right (up), a vertex goes left (down). Moving forward in perspective, it leaves the middle of the picture. */
static bool has_gone_back(const setting *t, unsigned axis, path paths[2], const el_screen_vertex *now)
{
    const int32_t places[2] = {now->x, now->y};
    const int32_t sizes[2] = {t->width, t->height};
    bool back = false;
    for (unsigned i = 0; i < 2; i++) {
        int way = 0;
        if (axis == i) {
            way = axis == 0 ? -1 : 1;
        } else if (axis == 2 && t->camera.projection == EL_PERSPECTIVE && paths[i].known) {
            const int32_t middle = sizes[i] * EL_SUBPIXELS / 2;
            way = (paths[i].place > middle) - (paths[i].place < middle);
        }
        back = goes_back(&paths[i], places[i], way) || back;
    }
    return back;
}

static unsigned run_wobble(stress *s, unsigned argument)
{
    dice *const r = &s->random;
    setting t;
    el_pose axes;
    while (!any_setting(r, &t, (el_projection)argument, any_quarter_turn(r, &axes))) {
    }
    const unsigned axis = any_below(r, 3);
    const int32_t length_q16 = (int32_t)any_between(r, 1, 200);
    int32_t step_q16[3];
    for (unsigned i = 0; i < 3; i++) {
        const int32_t along = t.camera.axes_q30[axis][i] / (EL_UNIT_Q30 / 2) / 2; /* -1, 0 or 1 */
        step_q16[i] = (axis == 2 ? -along : along) * length_q16;
    }
    if (once_in(r, 2)) {
        place_before_unit_change(r, &t, step_q16, axis);
    }
    path paths[POINTS][2] = {0};
    for (unsigned step = 0; step < STEPS && !s->failed; step++) {
        el_view view;
        el_transform transform;
        if (el_view_make(&view, &t.camera, t.width, t.height) != EL_OK ||
            el_transform_make(&transform, &view, &t.mesh, &t.pose) != EL_VISIBLE) {
            break;
        }
        for (unsigned i = 0; i < POINTS && !s->failed; i++) {
            el_screen_vertex now = {0};
            const path before[2] = {paths[i][0], paths[i][1]};
            if (!snapped(&transform, t.points[i], &now)) {
                paths[i][0] = paths[i][1] = (path){0};
            } else if (has_gone_back(&t, axis, paths[i], &now)) {
                stress_fail(
                    s, "step %u of %d/65536 units along axis %u moved a vertex back, from %d, %d to %d, %d (1/%d px)",
                    step, length_q16, axis, before[0].place, before[1].place, now.x, now.y, EL_SUBPIXELS);
                print_setting(&t, t.points[i]);
            } else {
                s->tally.samples++;
            }
        }
        for (unsigned i = 0; i < 3; i++) {
            t.camera.position_q16[i] += step_q16[i];
        }
    }
    return POINTS / 3;
}

const category vertex_categories[] = {
    {"vertices", 40, EL_PERSPECTIVE, run_vertices},
    {"vertices_orthographic", 20, EL_ORTHOGRAPHIC, run_vertices},
    {"wobble", 20, EL_PERSPECTIVE, run_wobble},
    {"wobble_orthographic", 10, EL_ORTHOGRAPHIC, run_wobble},
    {0},
};
