/* Flat meshes through a camera that maps model units to sub-pixels one to one: each pixel of the whole renderer's picture
 * is known exactly.
 *
 * Ties: triangles of one depth, each in a colour of its own. With the depth test the first of those that cover a pixel
 * stays, without it the last, in whatever bands they begin.
 *
 * Fans about a hub whose rim is any closed polygon, through a camera that maps model units to sub-pixels one to one. How
 * often front faces and back faces are drawn differs by the rim's winding number, at every pixel: an exact count of its
 * edges, which does not know the hub. */
#include <stdio.h>

#include "renders.h"

enum { MAX_RIM = 40, MAX_TIES = 24, FLAT_SCALE_LOG2 = -8, FLAT_RADIUS = 46341 /* int16_t in two directions */ };

/* A model unit is a sub-pixel; exact, because heights are powers of two. */
static el_camera flat_camera(uint16_t height)
{
    return (el_camera){
        .axes_q30 = {{EL_UNIT_Q30, 0, 0}, {0, EL_UNIT_Q30, 0}, {0, 0, EL_UNIT_Q30}},
        .position_q16 = {0, 0, EL_UNIT_Q16},
        .projection = EL_ORTHOGRAPHIC,
        .height_q16 = (uint32_t)height * EL_SUBPIXELS * (EL_UNIT_Q16 >> 8),
        .near_q16 = EL_UNIT_Q16 / 2,
        .far_q16 = EL_UNIT_Q16 * 2,
    };
}

static void put_vertex(int16_t position[3], point p, int64_t width, int64_t height)
{
    position[0] = (int16_t)(p.x - width * EL_SUBPIXELS / 2);
    position[1] = (int16_t)(height * EL_SUBPIXELS / 2 - p.y);
    position[2] = 0;
}

typedef struct fan {
    int16_t positions[MAX_RIM + 1][3]; /* the hub first */
    uint16_t triangles[MAX_RIM][3];
    uint16_t turned[MAX_RIM][3];
    point corners[MAX_RIM]; /* of the rim on the screen */
    unsigned count;
} fan;

/* Corners anywhere, near each other, or on pixel centres. */
static void make_fan(dice *r, fan *f, int64_t width, int64_t height)
{
    *f = (fan){.count = 3 + any_below(r, MAX_RIM - 2)};
    const int64_t margin = once_in(r, 2) ? 0 : 24;
    const bool centred = once_in(r, 3);
    for (unsigned i = 0; i <= f->count; i++) {
        const int64_t column = any_between(r, -margin, width + margin);
        const int64_t row = any_between(r, -margin, height + margin);
        point p = centre_of(column, row);
        if (!centred && !once_in(r, 4)) {
            p.x += any_between(r, -EL_SUBPIXELS / 2, EL_SUBPIXELS / 2);
            p.y += any_between(r, -EL_SUBPIXELS / 2, EL_SUBPIXELS / 2);
        }
        put_vertex(f->positions[i], p, width, height);
        if (i > 0) {
            f->corners[i - 1] = p;
        }
    }
    for (unsigned i = 0; i < f->count; i++) {
        const uint16_t a = (uint16_t)(1 + i);
        const uint16_t b = (uint16_t)(1 + (i + 1) % f->count);
        f->triangles[i][1] = f->turned[i][2] = a;
        f->triangles[i][2] = f->turned[i][1] = b;
    }
}

/* Edges that cross the row of the pixel's centre at it or on its left: down adds 1, up takes 1. Rows and columns are
 * half-open: a centre on an edge belongs to the right and to below, which is the top-left rule. */
static int winding_at(const fan *f, int64_t column, int64_t row)
{
    const point p = centre_of(column, row);
    int winding = 0;
    for (unsigned i = 0; i < f->count; i++) {
        const point a = f->corners[i];
        const point b = f->corners[(i + 1) % f->count];
        if (a.y <= p.y && p.y < b.y) {
            winding += exact_edge(a, b, p) <= 0;
        } else if (b.y <= p.y && p.y < a.y) {
            winding -= exact_edge(b, a, p) <= 0;
        }
    }
    return winding;
}

typedef struct counts {
    const fan *fan;
    const picture *front, *back;
} counts;

static int drawn_at(const counts *c, int64_t column, int64_t row)
{
    const int64_t at = row * c->front->width + column;
    return c->front->colour[at] - c->back->colour[at];
}

static char symbol(const void *context, int64_t column, int64_t row)
{
    const counts *const c = context;
    const int drawn = drawn_at(c, column, row);
    if (drawn != winding_at(c->fan, column, row)) {
        return '!';
    }
    return drawn == 0 ? '.' : (char)(drawn > 0 ? '0' + drawn : 'a' - 1 - drawn);
}

static unsigned run_fan(stress *s, unsigned argument)
{
    (void)argument;
    picture front = {.width = 64, .height = 64};
    if (once_in(&s->random, 2)) {
        front.width = 128;
    }
    picture back = {.width = front.width, .height = front.height};
    fan f;
    make_fan(&s->random, &f, front.width, front.height);
    el_mesh mesh = {
        .positions = f.positions,
        .triangles = f.triangles,
        .vertex_count = (uint16_t)(f.count + 1),
        .triangle_count = (uint16_t)f.count,
        .scale_log2 = FLAT_SCALE_LOG2,
        .radius = FLAT_RADIUS,
    };
    const el_camera camera = flat_camera(front.height);
    const el_pose pose = el_pose_identity();
    const el_material overdraw = {.shading = EL_SHADE_OVERDRAW};
    const drawing drawings = {&mesh, &pose, &overdraw};
    if (!render(s, &camera, &drawings, 1, &front)) {
        return f.count;
    }
    mesh.triangles = f.turned;
    if (!render(s, &camera, &drawings, 1, &back)) {
        return f.count;
    }
    const counts c = {&f, &front, &back};
    for (int64_t row = 0; row < front.height; row++) {
        for (int64_t column = 0; column < front.width; column++) {
            if (drawn_at(&c, column, row) != winding_at(&f, column, row)) {
                stress_fail(
                    s, "pixel (%d, %d) of a fan of %u triangles: %d front and %d back faces, the rim winds %d times",
                    (int)column, (int)row, f.count, front.colour[row * front.width + column],
                    back.colour[row * front.width + column], winding_at(&f, column, row));
                printf("  digits and letters: drawn as often to the left and to the right; ! wrong\n");
                stress_picture(front.width, front.height, column, row, symbol, &c);
                return f.count;
            }
        }
    }
    s->tally.samples += (uint64_t)front.width * front.height;
    return f.count;
}

/* The triangle that shows at a pixel; -1: none. */
static int shown_at(const exact_triangle triangles[], int count, bool last_wins, int64_t column, int64_t row)
{
    int shown = -1;
    for (int i = 0; i < count && (shown < 0 || last_wins); i++) {
        shown = exact_covers(&triangles[i], column, row) ? i : shown;
    }
    return shown;
}

static char letter_symbol(const void *context, int64_t column, int64_t row)
{
    const picture *const p = context;
    const uint16_t colour = p->colour[row * p->width + column];
    return colour == 0 ? '.' : (char)('a' + colour - 1);
}

static unsigned run_ties(stress *s, unsigned argument)
{
    (void)argument;
    dice *const r = &s->random;
    picture p = {.width = 64, .height = 64};
    int16_t positions[3 * MAX_TIES][3];
    uint16_t triangles[MAX_TIES][3];
    uint8_t colours[MAX_TIES][3];
    exact_triangle exact[MAX_TIES];
    const unsigned count = 2 + any_below(r, MAX_TIES - 1);
    for (unsigned i = 0; i < count; i++) {
        point corners[3];
        for (unsigned k = 0; k < 3; k++) {
            corners[k] = centre_of(any_between(r, -8, p.width + 8), any_between(r, -8, p.height + 8));
            corners[k].x += any_between(r, -EL_SUBPIXELS / 2, EL_SUBPIXELS / 2);
            put_vertex(positions[3 * i + k], corners[k], p.width, p.height);
            triangles[i][k] = (uint16_t)(3 * i + k);
        }
        exact[i] = exact_triangle_of(corners);
        /* RGB565 i + 1: 5 bits of blue */
        colours[i][0] = colours[i][1] = 0;
        colours[i][2] = (uint8_t)((i + 1) << 3);
    }
    const bool last_wins = once_in(r, 2);
    const el_mesh mesh = {
        .positions = (const int16_t(*)[3])positions,
        .triangles = (const uint16_t(*)[3])triangles,
        .triangle_colours = (const uint8_t(*)[3])colours,
        .vertex_count = (uint16_t)(3 * count),
        .triangle_count = (uint16_t)count,
        .scale_log2 = FLAT_SCALE_LOG2,
        .radius = FLAT_RADIUS,
    };
    const el_pose pose = el_pose_identity();
    const el_material material = {
        .shading = EL_SHADE_FLAT,
        .flags = (uint8_t)(EL_MATERIAL_TWO_SIDED | (last_wins ? EL_MATERIAL_NO_DEPTH : 0)),
    };
    const el_camera camera = flat_camera(p.height);
    const drawing drawings = {&mesh, &pose, &material};
    if (!render(s, &camera, &drawings, 1, &p)) {
        return count;
    }
    for (int64_t row = 0; row < p.height; row++) {
        for (int64_t column = 0; column < p.width; column++) {
            const int wanted = shown_at(exact, (int)count, last_wins, column, row);
            const int got = p.colour[row * p.width + column] - 1;
            if (got != wanted) {
                stress_fail(s, "pixel (%d, %d) must show triangle %d of %u and shows %d; -1 is none, the %s one wins",
                            (int)column, (int)row, wanted, count, got, last_wins ? "last" : "first");
                stress_picture(p.width, p.height, column, row, letter_symbol, &p);
                return count;
            }
        }
    }
    s->tally.samples += (uint64_t)p.width * p.height;
    return count;
}

const category flat_categories[] = {
    {"fans", 30, 0, run_fan},
    {"ties", 30, 0, run_ties},
    {0},
};
