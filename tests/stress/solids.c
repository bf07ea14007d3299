#include "solids.h"

#include <math.h>

static void put_triangle(solid *s, unsigned a, unsigned b, unsigned c)
{
    uint16_t *const t = s->triangles[s->triangle_count++];
    t[0] = (uint16_t)a;
    t[1] = (uint16_t)b;
    t[2] = (uint16_t)c;
}

static void make_tetrahedron(dice *r, solid *s)
{
    int64_t volume = 0;
    do {
        int64_t d[3][3];
        for (unsigned i = 0; i < 4; i++) {
            for (unsigned k = 0; k < 3; k++) {
                s->positions[i][k] = (int16_t)any_between(r, -2000, 2000);
                if (i > 0) {
                    d[i - 1][k] = s->positions[i][k] - s->positions[0][k];
                }
            }
        }
        volume = 0;
        for (unsigned k = 0; k < 3; k++) {
            volume += d[0][k] * (d[1][(k + 1) % 3] * d[2][(k + 2) % 3] - d[1][(k + 2) % 3] * d[2][(k + 1) % 3]);
        }
    } while (volume > -1000000000 && volume < 1000000000); /* not flat */
    for (unsigned k = 0; k < 3; k++) {                     /* its centre becomes the origin */
        const int16_t middle =
            (int16_t)((s->positions[0][k] + s->positions[1][k] + s->positions[2][k] + s->positions[3][k]) / 4);
        for (unsigned i = 0; i < 4; i++) {
            s->positions[i][k] = (int16_t)(s->positions[i][k] - middle);
        }
    }
    static const uint8_t faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    s->vertex_count = 4;
    for (unsigned i = 0; i < 4; i++) {
        put_triangle(s, faces[i][0], faces[i][volume > 0 ? 1 : 2], faces[i][volume > 0 ? 2 : 1]);
    }
}

static void make_box(dice *r, solid *s)
{
    int16_t half[3];
    for (unsigned k = 0; k < 3; k++) {
        half[k] = (int16_t)any_between(r, 400, 2000);
    }
    s->vertex_count = 8;
    for (unsigned i = 0; i < 8; i++) {
        for (unsigned k = 0; k < 3; k++) {
            s->positions[i][k] = (int16_t)(((i >> k) & 1U) != 0 ? half[k] : -half[k]);
        }
    }
    static const uint8_t sides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                        {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (unsigned i = 0; i < 6; i++) {
        const unsigned first = any_below(r, 4); /* either diagonal */
        const uint8_t *const side = sides[i];
        put_triangle(s, side[first], side[(first + 1) % 4], side[(first + 2) % 4]);
        put_triangle(s, side[first], side[(first + 2) % 4], side[(first + 3) % 4]);
    }
}

static unsigned middle_of(solid *s, unsigned a, unsigned b, double radius)
{
    double p[3];
    double length = 0;
    for (unsigned k = 0; k < 3; k++) {
        p[k] = s->positions[a][k] + s->positions[b][k];
        length += p[k] * p[k];
    }
    int16_t q[3];
    for (unsigned k = 0; k < 3; k++) {
        q[k] = (int16_t)lrint(p[k] * radius / sqrt(length));
    }
    for (unsigned i = 0; i < s->vertex_count; i++) {
        if (s->positions[i][0] == q[0] && s->positions[i][1] == q[1] && s->positions[i][2] == q[2]) {
            return i;
        }
    }
    for (unsigned k = 0; k < 3; k++) {
        s->positions[s->vertex_count][k] = q[k];
    }
    return s->vertex_count++;
}

/* An octahedron, its faces cut in four 0 to 2 times. */
static void make_sphere(dice *r, solid *s, unsigned times)
{
    const int16_t radius = (int16_t)any_between(r, 500, 4000);
    s->vertex_count = 6;
    for (unsigned i = 0; i < 6; i++) {
        s->positions[i][i / 2] = (i & 1U) == 0 ? radius : (int16_t)-radius;
    }
    for (unsigned i = 0; i < 8; i++) {
        const unsigned x = i & 1U;
        const unsigned y = 2 + ((i >> 1) & 1U);
        const unsigned z = 4 + ((i >> 2) & 1U);
        const bool odd = ((x + y + z) & 1U) != 0;
        put_triangle(s, x, odd ? z : y, odd ? y : z);
    }
    for (; times > 0; times--) {
        const solid before = *s;
        s->triangle_count = 0;
        for (unsigned i = 0; i < before.triangle_count; i++) {
            const uint16_t *const t = before.triangles[i];
            unsigned m[3];
            for (unsigned k = 0; k < 3; k++) {
                m[k] = middle_of(s, t[k], t[(k + 1) % 3], radius);
            }
            put_triangle(s, t[0], m[0], m[2]);
            put_triangle(s, t[1], m[1], m[0]);
            put_triangle(s, t[2], m[2], m[1]);
            put_triangle(s, m[0], m[1], m[2]);
        }
    }
}

void solid_make(dice *r, solid *s)
{
    *s = (solid){0};
    const uint32_t kind = any_below(r, 5);
    s->is_box = kind == 1 || kind == 2;
    switch (kind) {
    case 0:
        make_tetrahedron(r, s);
        break;
    case 1:
        make_box(r, s);
        break;
    default:
        make_sphere(r, s, kind - 2);
        break;
    }
    const uint8_t colour[3] = {(uint8_t)any_between(r, 8, 255), (uint8_t)any_u64(r), (uint8_t)any_u64(r)};
    const int16_t uv[2] = {(int16_t)any_signed_of_bits(r, 15), (int16_t)any_signed_of_bits(r, 15)};
    for (unsigned i = 0; i < s->vertex_count; i++) {
        int64_t squared = 0;
        for (unsigned k = 0; k < 3; k++) {
            s->colours[i][k] = colour[k];
            squared += (int64_t)s->positions[i][k] * s->positions[i][k];
        }
        s->uvs[i][0] = uv[0];
        s->uvs[i][1] = uv[1];
        const int32_t distance = (int32_t)ceil(sqrt((double)squared));
        s->radius = distance > s->radius ? distance : s->radius;
    }
}

el_mesh solid_mesh(const solid *s, int8_t scale_log2)
{
    return (el_mesh){
        .positions = s->positions,
        .triangles = s->triangles,
        .colours = s->colours,
        .uvs = s->uvs,
        .vertex_count = s->vertex_count,
        .triangle_count = s->triangle_count,
        .scale_log2 = scale_log2,
        .radius = (uint16_t)(s->radius + 1),
    };
}

viewpoint viewpoint_of(const el_camera *camera, int32_t width, int32_t height)
{
    const bool perspective = camera->projection == EL_PERSPECTIVE;
    const double half = perspective ? tan(camera->fov_y / 4294967296.0 * acos(-1.0)) : camera->height_q16 / 131072.0;
    const double aspect = camera->aspect_q16 != 0 ? camera->aspect_q16 / 65536.0 : (double)width / height;
    return (viewpoint){.half = {half * aspect, half}, .perspective = perspective, .width = width, .height = height};
}

static void to_view(const int16_t position[3], const el_mesh *mesh, const el_pose *pose, const el_camera *camera,
                    double view[3])
{
    double relative[3];
    const double scale = ldexp(pose->scale_q16, mesh->scale_log2 - 16);
    for (unsigned i = 0; i < 3; i++) {
        double turned = 0;
        for (unsigned j = 0; j < 3; j++) {
            turned += (double)pose->rotation_q30[i][j] / EL_UNIT_Q30 * position[j];
        }
        relative[i] = turned * scale + ((double)pose->position_q16[i] - camera->position_q16[i]) / 65536;
    }
    for (unsigned i = 0; i < 3; i++) {
        view[i] = 0;
        for (unsigned j = 0; j < 3; j++) {
            view[i] += (double)camera->axes_q30[i][j] / EL_UNIT_Q30 * relative[j];
        }
    }
    view[2] = -view[2];
}

void solid_view_make(solid_view *view, const solid *s, const el_mesh *mesh, const el_pose *pose,
                     const el_camera *camera, const viewpoint *from)
{
    static const int16_t model_origin[3] = {0, 0, 0};
    double vertices[SOLID_MAX_VERTICES][3];
    double origin[3];
    to_view(model_origin, mesh, pose, camera, origin);
    *view = (solid_view){.faces = s->triangle_count, .nearest = INFINITY, .farthest = -INFINITY, .reach = 1};
    for (unsigned i = 0; i < s->vertex_count; i++) {
        to_view(s->positions[i], mesh, pose, camera, vertices[i]);
        view->nearest = fmin(view->nearest, vertices[i][2]);
        view->farthest = fmax(view->farthest, vertices[i][2]);
        for (unsigned k = 0; k < 3; k++) {
            view->reach = fmax(view->reach, fabs(vertices[i][k]) / (k < 2 ? from->half[k] : 1));
        }
    }
    for (unsigned i = 0; i < s->triangle_count; i++) {
        const double *const a = vertices[s->triangles[i][0]];
        const double *const b = vertices[s->triangles[i][1]];
        const double *const c = vertices[s->triangles[i][2]];
        double *const n = view->normals[i];
        double length = 0;
        for (unsigned k = 0; k < 3; k++) {
            const unsigned l = (k + 1) % 3;
            const unsigned m = (k + 2) % 3;
            n[k] = (b[m] - a[m]) * (c[l] - a[l]) - (b[l] - a[l]) * (c[m] - a[m]);
            length += n[k] * n[k];
        }
        /* The model's origin is inside, whether its pose is a rotation or a reflection. */
        double towards_origin = 0;
        for (unsigned k = 0; k < 3; k++) {
            towards_origin += n[k] * (origin[k] - a[k]);
        }
        length = towards_origin > 0 ? -sqrt(length) : sqrt(length);
        for (unsigned k = 0; k < 3; k++) {
            n[k] /= length;
            view->offsets[i] += n[k] * a[k];
        }
    }
}

void solid_meet(const solid_view *view, const viewpoint *from, int32_t column, int32_t row, double margin,
                double *enters, double *leaves)
{
    const double x = ((column + 0.5) * 2 / from->width - 1) * from->half[0];
    const double y = (1 - (row + 0.5) * 2 / from->height) * from->half[1];
    *enters = -INFINITY;
    *leaves = INFINITY;
    for (unsigned i = 0; i < view->faces; i++) {
        const double *const n = view->normals[i];
        const double across = n[0] * x + n[1] * y;
        const double slope = n[2] + (from->perspective ? across : 0);
        const double room = view->offsets[i] + margin - (from->perspective ? 0 : across);
        /* slope * d <= room */
        if (slope > 0) {
            *leaves = fmin(*leaves, room / slope);
        } else if (slope < 0) {
            *enters = fmax(*enters, room / slope);
        } else if (room < 0) {
            *enters = INFINITY;
        }
    }
}
