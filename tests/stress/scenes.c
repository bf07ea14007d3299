/* Whole scenes through the public interface: closed solids with the camera outside, inside, on and passing through their
 * surface, at deep zooms, cut by the near and far plane; solids drawn twice; fans.
 *
 * A ray from the near to the far plane enters a closed solid as often as it leaves it, but for where it begins and ends.
 * After snapping this holds for pixels, exactly: front faces and back faces are drawn equally often, whatever has been
 * folded over at a silhouette, and the cut at the near (far) plane adds 1 (takes 1) where the ray begins (ends) inside.
 * A crack, a pixel drawn twice or a lost triangle breaks it. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "renders.h"
#include "solids.h"

typedef enum place { PLACE_OUTSIDE, PLACE_INSIDE, PLACE_TOUCHING, PLACE_PASSING, PLACE_DEEP_ZOOM } place;

typedef struct stage {
    solid solid;
    el_mesh mesh;
    el_pose pose;
    el_camera camera;
    viewpoint from;
    solid_view view;
    double margin;   /* world units: a quarter of a pixel where the solid is farthest, and rounding */
    double rounding; /* of distances */
} stage;

/* --- Setting the stage --------------------------------------------------------------------------------------------- */

static double any_real(dice *r, double least, double most)
{
    return least + (most - least) * any_fraction(r);
}

static void any_direction(dice *r, double direction[3])
{
    double squared;
    do {
        squared = 0;
        for (unsigned i = 0; i < 3; i++) {
            direction[i] = any_real(r, -1, 1);
            squared += direction[i] * direction[i];
        }
    } while (squared > 1 || squared < 0.01);
    for (unsigned i = 0; i < 3; i++) {
        direction[i] /= sqrt(squared);
    }
}

static double world_radius(const stage *t)
{
    return t->solid.radius * ldexp(t->pose.scale_q16, t->mesh.scale_log2 - 16);
}

static void pose_solid(dice *r, stage *t)
{
    solid_make(r, &t->solid);
    const int8_t scale_log2 = (int8_t)any_between(r, -11, -3);
    t->mesh = solid_mesh(&t->solid, scale_log2);
    t->pose = el_pose_identity();
    if (!once_in(r, 4)) {
        for (el_axis axis = EL_AXIS_X; axis <= EL_AXIS_Z; axis++) {
            el_pose_turn(&t->pose, axis, (el_angle)any_u64(r));
        }
    }
    if (once_in(r, 8)) { /* a reflection */
        for (unsigned i = 0; i < 3; i++) {
            t->pose.rotation_q30[i][0] = -t->pose.rotation_q30[i][0];
        }
    }
    t->pose.scale_q16 = once_in(r, 2) ? EL_UNIT_Q16 : (uint32_t)any_between(r, 1 << 14, 1 << 18);
    for (unsigned i = 0; i < 3; i++) {
        t->pose.position_q16[i] = (int32_t)any_signed_of_bits(r, 29);
    }
}

/* A vertex, the middle of an edge or of a face, in world units from the solid's centre. */
static void surface_point(dice *r, const stage *t, double at[3])
{
    const uint16_t *const triangle = t->solid.triangles[any_below(r, t->solid.triangle_count)];
    const unsigned corners = 1 + any_below(r, 3);
    const double scale = ldexp(t->pose.scale_q16, t->mesh.scale_log2 - 16);
    for (unsigned i = 0; i < 3; i++) {
        at[i] = 0;
        for (unsigned k = 0; k < corners; k++) {
            for (unsigned j = 0; j < 3; j++) {
                at[i] += (double)t->pose.rotation_q30[i][j] / EL_UNIT_Q30 * t->solid.positions[triangle[k]][j] * scale /
                         corners;
            }
        }
    }
}

static void eye_of(dice *r, const stage *t, place where, double eye[3])
{
    const double radius = world_radius(t);
    double direction[3];
    any_direction(r, direction);
    double distance = any_real(r, 0, 0.3);
    switch (where) {
    case PLACE_OUTSIDE:
        distance = any_real(r, 1.05, 12);
        break;
    case PLACE_DEEP_ZOOM:
        distance = any_real(r, 30, 150);
        break;
    case PLACE_PASSING:
        distance = any_real(r, 0.3, 1.2);
        break;
    case PLACE_TOUCHING:
        surface_point(r, t, eye);
        return;
    case PLACE_INSIDE:
        break;
    }
    for (unsigned i = 0; i < 3; i++) {
        eye[i] = direction[i] * distance * radius;
    }
}

static uint32_t q16_between(double units, double least, double most)
{
    return (uint32_t)lrint(fmin(fmax(units * 65536, least), most));
}

/* False when the dice fell outside of the world. */
static bool aim(dice *r, stage *t, place where)
{
    static const int32_t up_q16[3] = {0, EL_UNIT_Q16, 0};
    enum { WORLD_Q16 = 1 << 30 };
    const double radius = world_radius(t);
    double eye[3];
    double towards[3];
    eye_of(r, t, where, eye);
    any_direction(r, towards);
    int32_t eye_q16[3];
    int32_t target_q16[3];
    double distance = 0;
    for (unsigned i = 0; i < 3; i++) {
        const double target = where == PLACE_INSIDE ? eye[i] + towards[i] * radius : towards[i] * radius * 0.5;
        const double place_q16 = t->pose.position_q16[i];
        if (fabs(place_q16 + eye[i] * 65536) > WORLD_Q16 || fabs(place_q16 + target * 65536) > WORLD_Q16) {
            return false;
        }
        eye_q16[i] = (int32_t)lrint(place_q16 + eye[i] * 65536);
        target_q16[i] = (int32_t)lrint(place_q16 + target * 65536);
        distance += eye[i] * eye[i];
    }
    distance = sqrt(distance);
    el_camera *const camera = &t->camera;
    *camera = (el_camera){.projection = EL_PERSPECTIVE};
    if (el_camera_look_at(camera, eye_q16, target_q16, up_q16) != EL_OK) {
        return false;
    }
    const bool deep = where == PLACE_DEEP_ZOOM;
    camera->fov_y = deep ? (el_angle)any_between(r, EL_DEGREES(1, 1), EL_DEGREES(3, 1))
                         : (el_angle)any_between(r, EL_DEGREES(10, 1), EL_DEGREES(130, 1));
    camera->aspect_q16 = once_in(r, 4) ? (uint32_t)any_between(r, EL_UNIT_Q16 / 2, EL_UNIT_Q16 * 2) : 0;
    if (once_in(r, 5)) {
        camera->projection = EL_ORTHOGRAPHIC;
        camera->height_q16 = q16_between(radius * any_real(r, 0.5, 4), 256, WORLD_Q16);
    }
    /* Mostly a near plane in front of all; or through the solid. Half of the time as near as it goes: ratios of far to
     * near beyond 10^5. */
    const double front = once_in(r, 3) ? any_real(r, 0, distance + radius) : fmax(distance - radius, 0) * 0.9;
    camera->near_q16 = once_in(r, 2) ? (uint32_t)any_between(r, 16, 4096) : q16_between(front, 16, WORLD_Q16 / 2);
    const double back = distance + radius * (once_in(r, 4) ? any_real(r, -1, 1) : 1.1);
    camera->far_q16 = q16_between(back, 1.2 * camera->near_q16 + 8, WORLD_Q16);
    return true;
}

static void set_stage(dice *r, stage *t, place where, picture *p)
{
    p->width = (uint16_t)(once_in(r, 4) ? any_between(r, 20, 128) : 64);
    p->height = (uint16_t)(once_in(r, 4) ? any_between(r, 20, 128) : 48);
    do {
        pose_solid(r, t);
    } while (!aim(r, t, where));
    t->from = viewpoint_of(&t->camera, p->width, p->height);
    solid_view_make(&t->view, &t->solid, &t->mesh, &t->pose, &t->camera, &t->from);
    const double pixel = 2 * fmax(t->from.half[0] / p->width, t->from.half[1] / p->height);
    const double depth = t->from.perspective ? fmax(t->view.farthest, t->camera.near_q16 / 65536.0) : 1;
    t->rounding = ldexp(t->view.reach, -26);
    t->margin = pixel * depth / 4 + t->rounding * fmax(1, fmax(t->from.half[0], t->from.half[1]));
}

/* --- What a pixel must show ---------------------------------------------------------------------------------------- */

enum { UNSURE = -9 };

typedef struct expectation {
    bool miss;                /* nothing at all is drawn */
    int front, back;          /* how often front and back faces are drawn; UNSURE near silhouettes and cuts */
    int net;                  /* back minus front, or UNSURE */
    double nearest, farthest; /* where front = 1: between which distances */
} expectation;

/* 1: the ray is inside the solid at distance d; 0: outside. */
static int inside_at(double d, double rounding, const double outer[2], const double inner[2])
{
    if (inner[0] < d - rounding && d + rounding < inner[1]) {
        return 1;
    }
    return outer[0] > outer[1] || d + rounding < outer[0] || d - rounding > outer[1] ? 0 : UNSURE;
}

static expectation expected_at(const stage *t, int32_t column, int32_t row)
{
    const double near = t->camera.near_q16 / 65536.0;
    const double far = t->camera.far_q16 / 65536.0;
    const double e = t->rounding;
    double outer[2];
    double inner[2];
    solid_meet(&t->view, &t->from, column, row, t->margin, &outer[0], &outer[1]);
    solid_meet(&t->view, &t->from, column, row, -t->margin, &inner[0], &inner[1]);
    const bool hit = inner[0] < inner[1];
    const int begins = inside_at(near, e, outer, inner);
    const int ends = inside_at(far, e, outer, inner);
    expectation x = {
        .miss = outer[0] > outer[1] || outer[0] > far + e || outer[1] < near - e,
        .front = UNSURE,
        .back = UNSURE,
        .net = begins == UNSURE || ends == UNSURE ? UNSURE : begins - ends,
    };
    if (hit && outer[0] > near + e && inner[0] < far - e) {
        x.front = 1;
        x.nearest = outer[0];
        x.farthest = inner[0];
    } else if (x.miss || (hit && inner[0] < near - e)) {
        x.front = 0;
    }
    if (hit && outer[1] < far - e && inner[1] > near + e) {
        x.back = 1;
    } else if (x.miss || (hit && inner[1] > far + e)) {
        x.back = 0;
    }
    return x;
}

/* Small faces, and what a cut leaves of larger ones, may be folded over by snapping: then one more is in front and one
 * more behind. */
static bool count_fits(const stage *t, const expectation *x, int expected, int got)
{
    if (expected == UNSURE) {
        return true;
    }
    const bool is_exact = x->miss || (t->solid.is_box && x->net != UNSURE);
    return is_exact ? got == expected : got >= expected;
}

typedef struct counts {
    const picture *front, *back;
} counts;

static char count_symbol(const void *context, int64_t column, int64_t row)
{
    const counts *const c = context;
    const size_t at = (size_t)(row * c->front->width + column);
    const int net = c->back->colour[at] - c->front->colour[at];
    const bool any = c->back->colour[at] != 0 || c->front->colour[at] != 0;
    return net == 0 ? (any ? '=' : '.') : (net < 0 ? (net == -1 ? '-' : '!') : (net == 1 ? '+' : '!'));
}

static void print_stage(const stage *t)
{
    const el_camera *const c = &t->camera;
    printf("  %d faces, radius %.4f units, scale %.6f; eye at %.4f %.4f %.4f from its centre; %s, %.3f degrees or %.4f "
           "units high; near %.6f far %.6f; vertices %.4f to %.4f away\n",
           t->solid.triangle_count, world_radius(t), ldexp(t->pose.scale_q16, t->mesh.scale_log2 - 16),
           (c->position_q16[0] - (double)t->pose.position_q16[0]) / 65536,
           (c->position_q16[1] - (double)t->pose.position_q16[1]) / 65536,
           (c->position_q16[2] - (double)t->pose.position_q16[2]) / 65536,
           t->from.perspective ? "perspective" : "orthographic", c->fov_y / 11930464.711, c->height_q16 / 65536.0,
           c->near_q16 / 65536.0, c->far_q16 / 65536.0, t->view.nearest, t->view.farthest);
}

static bool check_counts(stress *s, const stage *t, const picture *front, const picture *back)
{
    for (int32_t row = 0; row < front->height; row++) {
        for (int32_t column = 0; column < front->width; column++) {
            const size_t at = (size_t)row * front->width + (size_t)column;
            const int fronts = front->colour[at];
            const int backs = back->colour[at];
            const expectation x = expected_at(t, column, row);
            if ((x.net == UNSURE || backs - fronts == x.net) && count_fits(t, &x, x.front, fronts) &&
                count_fits(t, &x, x.back, backs)) {
                continue;
            }
            stress_fail(
                s,
                "pixel (%d, %d): %d front and %d back faces were drawn; expected %d and %d, their difference %d "
                "(-9: not known)",
                (int)column, (int)row, fronts, backs, x.front, x.back, x.net);
            print_stage(t);
            printf("  = as many back faces as front faces, + one more back face, - one more front face\n");
            const counts c = {front, back};
            stress_picture(front->width, front->height, column, row, count_symbol, &c);
            return false;
        }
    }
    s->tally.samples += (uint64_t)front->width * front->height;
    return true;
}

/* --- Depth and attributes ------------------------------------------------------------------------------------------ */

static double depth_at(const stage *t, double distance)
{
    const double near = t->camera.near_q16 / 65536.0;
    const double far = t->camera.far_q16 / 65536.0;
    const double linear = (distance - near) / (far - near);
    return EL_DEPTH_MAX * (t->from.perspective ? linear * far / distance : linear);
}

static char depth_symbol(const void *context, int64_t column, int64_t row)
{
    const picture *const p = context;
    return p->depth[row * p->width + column] == 0xFFFF ? '.' : '#';
}

/* All vertices have one colour and one texture coordinate: so has each pixel, cut or not. Depths lie between those of the
 * inflated and the deflated solid; vertices and pixels round them by a half each, 1/w of the vertices by another. */
static bool check_surface(stress *s, const stage *t, const picture *p, uint16_t colour)
{
    for (int32_t row = 0; row < p->height; row++) {
        for (int32_t column = 0; column < p->width; column++) {
            const size_t at = (size_t)row * p->width + (size_t)column;
            const expectation x = expected_at(t, column, row);
            const uint16_t z = p->depth[at];
            const uint16_t wanted = z == 0xFFFF ? 0 : colour;
            const bool wrong_depth =
                x.front == 1 && (z < depth_at(t, x.nearest) - 2 || z > depth_at(t, x.farthest) + 2);
            if (p->colour[at] == wanted && !wrong_depth) {
                continue;
            }
            stress_fail(s, "pixel (%d, %d) has colour %04X at depth %u; expected %04X", (int)column, (int)row,
                        p->colour[at], z, wanted);
            if (x.front == 1) {
                printf("  the depth lies between %.2f and %.2f\n", depth_at(t, x.nearest), depth_at(t, x.farthest));
            }
            print_stage(t);
            stress_picture(p->width, p->height, column, row, depth_symbol, p);
            return false;
        }
    }
    s->tally.samples += (uint64_t)p->width * p->height;
    return true;
}

static bool check_same(stress *s, const stage *t, const picture *wanted, const picture *got, const char *what)
{
    for (size_t at = 0; at < (size_t)wanted->width * wanted->height; at++) {
        if (wanted->colour[at] != got->colour[at] || wanted->depth[at] != got->depth[at]) {
            const int column = (int)(at % wanted->width);
            const int row = (int)(at / wanted->width);
            stress_fail(s, "pixel (%d, %d) is %04X at depth %u, and %04X at depth %u %s", column, row,
                        wanted->colour[at], wanted->depth[at], got->colour[at], got->depth[at], what);
            print_stage(t);
            stress_picture(wanted->width, wanted->height, column, row, depth_symbol, got);
            return false;
        }
    }
    return true;
}

/* --- Categories ---------------------------------------------------------------------------------------------------- */

typedef struct surface {
    uint16_t texels[64];
    el_texture texture;
    el_material material;
    uint16_t colour; /* what every pixel has */
} surface;

static void any_surface(dice *r, const solid *of, surface *f)
{
    for (unsigned i = 0; i < 64; i++) {
        f->texels[i] = (uint16_t)(any_u64(r) | 1U);
    }
    f->texture = (el_texture){.texels = f->texels, .width_log2 = 3, .height_log2 = 3};
    const bool textured = once_in(r, 2);
    f->material = (el_material){.shading = textured ? EL_SHADE_TEXTURED : EL_SHADE_GOURAUD, .texture = &f->texture};
    const uint8_t *const c = of->colours[0];
    const int16_t *const uv = of->uvs[0];
    f->colour = textured ? f->texels[((uv[1] >> 4) & 7) * 8 + ((uv[0] >> 4) & 7)] : el_rgb565(c[0], c[1], c[2]);
}

static unsigned run_solid(stress *s, unsigned argument)
{
    const el_material one_sided = {.shading = EL_SHADE_OVERDRAW};
    const el_material two_sided = {.shading = EL_SHADE_OVERDRAW, .flags = EL_MATERIAL_TWO_SIDED};
    stage t;
    picture front;
    picture back;
    set_stage(&s->random, &t, (place)argument, &front);
    back.width = front.width;
    back.height = front.height;
    const drawing fronts = {&t.mesh, &t.pose, &one_sided};
    const drawing both = {&t.mesh, &t.pose, &two_sided};
    if (!render(s, &t.camera, &fronts, 1, &front) || !render(s, &t.camera, &both, 1, &back)) {
        return t.solid.triangle_count;
    }
    for (size_t i = 0; i < (size_t)back.width * back.height; i++) {
        back.colour[i] = (uint16_t)(back.colour[i] - front.colour[i]);
    }
    if (check_counts(s, &t, &front, &back)) {
        surface f;
        any_surface(&s->random, &t.solid, &f);
        const drawing shaded = {&t.mesh, &t.pose, &f.material};
        (void)(render(s, &t.camera, &shaded, 1, &front) && check_surface(s, &t, &front, f.colour) &&
               render(s, &t.camera, &shaded, 1, &back) && check_same(s, &t, &front, &back, "in other bands or passes"));
    }
    return t.solid.triangle_count;
}

/* The same solid again, in white: nothing of it may show. Its triangles begin with other corners where none was cut; what
 * was cut is cut into other triangles then. */
static unsigned run_coplanar(stress *s, unsigned argument)
{
    stage t;
    uint16_t turned[SOLID_MAX_TRIANGLES][3];
    picture once;
    picture twice;
    set_stage(&s->random, &t, (place)any_below(&s->random, PLACE_DEEP_ZOOM + 1), &once);
    twice.width = once.width;
    twice.height = once.height;
    surface f;
    any_surface(&s->random, &t.solid, &f);
    const uint8_t flags = (uint8_t)(once_in(&s->random, 2) ? EL_MATERIAL_TWO_SIDED : argument);
    f.material.flags = flags;
    const el_material white = {.shading = EL_SHADE_FLAT, .flags = flags, .colour = {255, 255, 255}};
    drawing both[2] = {{&t.mesh, &t.pose, &f.material}, {&t.mesh, &t.pose, &white}};
    el_mesh again = t.mesh;
    again.colours = NULL;
    both[1].mesh = &again;
    if (render(s, &t.camera, both, 1, &once)) {
        if (once.stats.triangles_clipped == 0) {
            for (unsigned i = 0; i < t.solid.triangle_count; i++) {
                const unsigned turn = any_below(&s->random, 3);
                for (unsigned k = 0; k < 3; k++) {
                    turned[i][k] = t.solid.triangles[i][(k + turn) % 3];
                }
            }
            again.triangles = turned;
        }
        if (render(s, &t.camera, both, 2, &twice)) {
            (void)check_same(s, &t, &once, &twice, "when the same is drawn again in white");
        }
    }
    s->tally.samples += (uint64_t)once.width * once.height;
    return 2U * t.solid.triangle_count;
}

const category solid_categories[] = {
    {"solid_outside", 30, PLACE_OUTSIDE, run_solid},
    {"solid_inside", 30, PLACE_INSIDE, run_solid},
    {"solid_touched", 30, PLACE_TOUCHING, run_solid},
    {"solid_passed", 30, PLACE_PASSING, run_solid},
    {"deep_zoom", 20, PLACE_DEEP_ZOOM, run_solid},
    {"coplanar", 20, 0, run_coplanar},
    {0},
};
