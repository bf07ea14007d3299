/* Triangles where pixels have several samples (samples.h).
 *
 * A sample's coverage is that of a pixel centre in a triangle that is shifted the other way, so each sample has edges of its
 * own, walked as all edges are: exact, and watertight, for nothing. What all of a row's samples have in common is the row's
 * inner part, which is drawn like a row without samples; only the pixels beside it, few at each end, need to know which of
 * their samples are covered. */
#include "raster/samples.h"

#include "base/fixed.h"
#include "raster/fill_mixed.h"
#include "raster/fill_row.h"
#include "raster/fill_texture_row.h"
#include "raster/sampled_pixel.h"
#include "raster/small_sampled.h"

#if EL_WITH_SAMPLES

/* What fill_texture.c draws is drawn as without samples; in small code, as all else, by rows of any shading. */
static inline bool is_textured(unsigned kind)
{
    return !EL_SMALL_CODE && (kind & (EL_FILL_TEXTURE | EL_FILL_MIXED)) == EL_FILL_TEXTURE;
}

/* A sample's edges, from its next row on. */
typedef struct sample_edges {
    el_edge left, right; /* of the current part */
    el_edge lower;       /* the lower part's other edge */
    int16_t y, y_middle, y_end;
} sample_edges;

/* A triangle under way. */
typedef struct sampled {
    const el_sampled_target *target;
    el_triangle triangle; /* without edges: what its pixels are made of, in the next row */
    const el_sample_point *points;
    bool short_is_left;
    /* From the centre to each sample, and to the centre: what is linear on the screen. */
    uint64_t z_at[EL_MAX_SAMPLES + 1];
    uint32_t rgb_at[EL_MAX_SAMPLES + 1][3];
    uint64_t wuv_at[EL_MAX_SAMPLES + 1][3];
    union {
        el_row_brush brush;
#if !EL_SMALL_CODE
        el_texture_brush texture_brush; /* of what is_textured; its slopes are set for each row */
#endif
#if EL_WITH_MIXED
        el_mixed_brush mixed_brush; /* of EL_FILL_MIXED */
#endif
    };
    sample_edges edges[EL_MAX_SAMPLES];
} sampled;

/* Pixels of a row: those from `begin` to `end` have samples in the triangle, those from `inner` to `inner_end` all. */
typedef struct sampled_row {
    int32_t begin, inner, inner_end, end;
    int32_t left[EL_MAX_SAMPLES], right[EL_MAX_SAMPLES]; /* of each sample [left, right) */
} sampled_row;

/* --- Set-up ------------------------------------------------------------------------------------------------------- */

static uint64_t parts_times(const el_plane_parts *parts, const el_sample_point *point)
{
    return el_multiply_u64(parts->dx, point->x) + el_multiply_u64(parts->dy, point->y);
}

/* 1/w, u/w or v/w of the corners, as el_triangle_setup_planes has made planes of them. */
static void make_perspective_parts(sampled *s, const el_corner *const corners[3], const el_plane_frame *frame)
{
    const el_perspective *const p = &s->triangle.perspective;
    const int shift = 31 - el_bit_length_u32(corners[0]->w | corners[1]->w | corners[2]->w);
    int64_t w[3];
    int64_t u[3];
    int64_t v[3];
    for (unsigned i = 0; i < 3; i++) {
        w[i] = (int64_t)((uint64_t)corners[i]->w << shift);
        u[i] = el_shift_i64((corners[i]->u_q16 - p->u_base_q16) * w[i], p->u_shift - EL_PLANE_FRACTION_BITS);
        v[i] = el_shift_i64((corners[i]->v_q16 - p->v_base_q16) * w[i], p->v_shift - EL_PLANE_FRACTION_BITS);
    }
    el_plane_parts parts[3];
    el_plane_parts_make(&parts[0], frame, w, 0);
    el_plane_parts_make(&parts[1], frame, u, EL_PLANE_FRACTION_BITS);
    el_plane_parts_make(&parts[2], frame, v, EL_PLANE_FRACTION_BITS);
    for (unsigned i = 0; i < 3; i++) {
        for (unsigned k = 0; k < s->target->count; k++) {
            s->wuv_at[k][i] = parts_times(&parts[i], &s->points[k]);
        }
        s->wuv_at[s->target->count][i] = 0;
    }
}

static void make_parts(sampled *s, const el_corner *const corners[3])
{
    const unsigned count = s->target->count;
    const unsigned kind = s->triangle.kind;
    const int32_t x[3] = {corners[0]->x, corners[1]->x, corners[2]->x};
    const int32_t y[3] = {corners[0]->y, corners[1]->y, corners[2]->y};
    el_plane_frame frame;
    el_plane_parts parts;
    el_plane_frame_make(&frame, x, y);
    s->z_at[count] = 0;
    s->rgb_at[count][0] = s->rgb_at[count][1] = s->rgb_at[count][2] = 0;
    if ((kind & EL_FILL_DEPTH) != 0) {
        const int64_t z[3] = {corners[0]->z, corners[1]->z, corners[2]->z};
        el_plane_parts_make(&parts, &frame, z, 0);
        for (unsigned k = 0; k < count; k++) {
            s->z_at[k] = parts_times(&parts, &s->points[k]);
        }
    }
    for (unsigned i = 0; i < 3 && (kind & EL_FILL_COLOURS) != 0; i++) {
        const int64_t values[3] = {corners[0]->rgb_q8[i], corners[1]->rgb_q8[i], corners[2]->rgb_q8[i]};
        el_plane_parts_make(&parts, &frame, values, 0);
        for (unsigned k = 0; k < count; k++) {
            s->rgb_at[k][i] = el_q32_to_q24(parts_times(&parts, &s->points[k]));
        }
    }
    if ((kind & EL_FILL_TEXTURE) != 0) {
        make_perspective_parts(s, corners, &frame);
    }
}

/* The edges of the sample at `point` from `row` on. */
static void make_edges(sample_edges *e, const el_corner *const corners[3], const el_sample_point *point, int32_t row,
                       bool short_is_left)
{
    int32_t x[3];
    int32_t y[3];
    for (unsigned i = 0; i < 3; i++) {
        x[i] = corners[i]->x - point->x;
        y[i] = corners[i]->y - point->y;
    }
    const int32_t y_begin = el_max_i32(row, el_first_centre(y[0]));
    const int32_t y_middle = el_first_centre(y[1]);
    const int32_t y_end = el_first_centre(y[2]);
    e->y = (int16_t)y_begin;
    e->y_middle = (int16_t)y_middle;
    e->y_end = (int16_t)y_end;
    if (y_begin >= y_end) {
        return;
    }
    el_edge *const straight = short_is_left ? &e->right : &e->left;
    el_edge *const bent = short_is_left ? &e->left : &e->right;
    el_edge_make(straight, x[0], y[0], x[2], y[2], y_begin);
    if (y_begin < y_middle) {
        el_edge_make(bent, x[0], y[0], x[1], y[1], y_begin);
    }
    if (y_middle < y_end) {
        el_edge_make(y_begin < y_middle ? &e->lower : bent, x[1], y[1], x[2], y[2], el_max_i32(y_begin, y_middle));
    }
}

/* --- Rows --------------------------------------------------------------------------------------------------------- */

/* The columns of one sample in row y. */
static void sample_row(const sampled *s, sample_edges *e, int32_t y, int32_t *left, int32_t *right)
{
    const int32_t width = s->target->target.width;
    *left = width;
    *right = 0;
    if (y < e->y || y >= e->y_end) {
        return;
    }
    if (y == e->y_middle && y != e->y) {
        *(s->short_is_left ? &e->left : &e->right) = e->lower;
    }
    const int32_t x = el_max_i32(el_edge_x(&e->left), 0);
    const int32_t x_end = el_min_i32(el_edge_x(&e->right), width);
    if (x < x_end) {
        *left = x;
        *right = x_end;
    }
    el_edge_next_row(&e->left);
    el_edge_next_row(&e->right);
}

static void next_row(sampled *s, int32_t y, sampled_row *row)
{
    row->begin = row->inner_end = s->target->target.width;
    row->inner = row->end = 0;
    for (unsigned k = 0; k < s->target->count; k++) {
        sample_row(s, &s->edges[k], y, &row->left[k], &row->right[k]);
        row->begin = el_min_i32(row->begin, row->left[k]);
        row->inner = el_max_i32(row->inner, row->left[k]);
        row->inner_end = el_min_i32(row->inner_end, row->right[k]);
        row->end = el_max_i32(row->end, row->right[k]);
    }
}

/* A bit for each of the pixel's samples that is covered. */
static uint32_t covered(const sampled_row *row, int32_t x, unsigned count)
{
    uint32_t mask = 0;
    for (unsigned k = 0; k < count; k++) {
        /* NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): next_row has set as many. */
        mask |= (uint32_t)(x >= row->left[k] && x < row->right[k]) << k;
    }
    return mask;
}

/* --- Pixels ------------------------------------------------------------------------------------------------------- */

/* From the pixel's centre to sample k, and back with `sign` -1. */
static void shift_values(sampled *s, unsigned k, int sign)
{
    el_triangle *const triangle = &s->triangle;
    const uint64_t times = (uint64_t)(int64_t)sign;
    for (unsigned i = 0; i < 3 && (triangle->kind & EL_FILL_COLOURS) != 0; i++) {
        triangle->rgb[i].value += s->rgb_at[k][i] * (uint32_t)sign;
    }
    if ((triangle->kind & EL_FILL_TEXTURE) != 0) {
        triangle->perspective.w.value += s->wuv_at[k][0] * times;
        triangle->perspective.u.value += s->wuv_at[k][1] * times;
        triangle->perspective.v.value += s->wuv_at[k][2] * times;
    }
}

/* The colour of a shading that few triangles have, by drawing the pixel: of row and column, but where the sample is. */
static EL_APART uint32_t draw_colour(sampled *s, const el_sampled_place *at, uint32_t x, unsigned k)
{
    const uint8_t kind = s->triangle.kind;
    const el_cursor cursor = {.row = at->colour};
    const uint16_t before = at->colour[x];
    s->triangle.kind = (uint8_t)(kind & ~(unsigned)EL_FILL_DEPTH);
    shift_values(s, k, 1);
    el_fill_row(&s->triangle, &s->brush, &cursor, x, x + 1U);
    shift_values(s, k, -1);
    s->triangle.kind = kind;
    const uint32_t colour = at->colour[x];
    at->colour[x] = before;
    return colour;
}

/* The colour at sample k of a pixel, whose centre has values v; the centre's is k = count. */
static EL_SPECIALISED uint32_t colour_at(sampled *s, const el_sampled_place *at, const el_values *v, uint32_t x,
                                         unsigned k, unsigned kind)
{
    el_values there = {0};
    if ((kind & EL_FILL_COLOURS) != 0) {
        there.red = v->red + s->rgb_at[k][0];
        there.green = v->green + s->rgb_at[k][1];
        there.blue = v->blue + s->rgb_at[k][2];
    }
#if !EL_SMALL_CODE
    if (is_textured(kind)) {
        const uint32_t texel = el_texture_texel_at(&s->texture_brush, &s->triangle.perspective, x, s->wuv_at[k]);
        const uint32_t threshold_q16 = el_dither_threshold_q16(x, (uint32_t)s->triangle.y);
        return (kind & EL_FILL_COLOURS) != 0 ? el_modulate(texel, &there, threshold_q16, kind) : texel;
    }
#endif
    if ((kind & (EL_FILL_TEXTURE | EL_FILL_DITHER)) != 0) {
        return draw_colour(s, at, x, k);
    }
    return (kind & EL_FILL_COLOURS) != 0 ? el_coloured(&there) : s->triangle.surface.colour;
}

/* Gives samples of their own to a pixel that has none. */
static inline void mix(const el_sampled_place *at, uint32_t x, uint32_t count)
{
    uint32_t *const samples = at->samples + x * count;
    const uint32_t old = (uint32_t)at->depth[x] << 16 | at->colour[x];
    for (uint32_t i = 0; i < count; i++) {
        samples[i] = old;
    }
    el_set_bit(at->mixed, at->first + x);
    at->depth[x] = 0;
    at->colour[x] = 0;
}

#if EL_WITH_MIXED
/* draw_samples of what is mixed with what is there: with that of each sample. */
static EL_APART void blend_samples(sampled *s, const el_sampled_place *at, uint32_t z, uint32_t x, uint32_t mask,
                                   unsigned k)
{
    const unsigned count = s->target->count;
    uint32_t *const samples = at->samples + x * count;
    const bool tests = (s->triangle.kind & EL_FILL_DEPTH) != 0;
    const bool writes = tests && s->mixed_brush.writes_depth;
    const bool is_mixed = el_pixel_is_mixed(at, x);
    if (is_mixed) {
        el_spread(at, x, count);
    }
    uint16_t colour = 0;
    shift_values(s, k, 1);
    const uint32_t shown = el_mixed_pixel(&s->mixed_brush, &s->triangle, x, z, &colour);
    shift_values(s, k, -1);
    if (shown == 0) {
        return;
    }
    if (!is_mixed) {
        mix(at, x, count);
    }
    for (unsigned i = 0; i < count; i++) {
        const uint32_t old = samples[i];
        if ((mask >> i & 1U) != 0 && (!tests || z < old >> 16)) {
            const uint32_t blended = shown == 256 ? colour : el_rgb565_blend((uint16_t)old, colour, shown);
            samples[i] = (writes ? z << 16 : old & 0xFFFF0000U) | blended;
        }
    }
}
#endif

/* Draws the samples of `mask`, not 0, of a pixel, in the depth and colour at sample k. */
static EL_SPECIALISED void draw_samples(sampled *s, const el_sampled_place *at, const el_values *v, uint32_t x,
                                        uint32_t mask, unsigned k, unsigned kind)
{
    const unsigned count = s->target->count;
    uint32_t *const samples = at->samples + x * count;
    const bool tests = (kind & EL_FILL_DEPTH) != 0;
    const uint32_t z = tests ? (uint32_t)((v->z + s->z_at[k]) >> 32) : 0U;
    bool mixed = false;
    if (!tests || z >= at->depth[x]) {
        mixed = el_pixel_is_mixed(at, x);
        if (tests && !mixed) {
            return;
        }
    }
#if EL_WITH_MIXED
    if ((kind & EL_FILL_MIXED) != 0) {
        blend_samples(s, at, z, x, mask, k);
        return;
    }
#endif
    if (mixed) {
        el_spread(at, x, count);
    } else {
        mix(at, x, count);
    }
    const uint32_t colour = colour_at(s, at, v, x, k, kind);
    for (unsigned i = 0; i < count; i++) {
        if ((mask >> i & 1U) == 0) {
            continue;
        }
        if (!tests) {
            samples[i] = (samples[i] & 0xFFFF0000U) | colour;
        } else if (z < samples[i] >> 16) {
            samples[i] = z << 16 | colour;
        }
    }
}

/* Pixels [x, x_end) of a row, of which some samples are covered. */
static EL_SPECIALISED void draw_ends(sampled *s, const el_sampled_place *at, const sampled_row *row,
                                     const el_slopes *slopes, int32_t x, int32_t x_end, unsigned kind)
{
    el_values v = el_values_at(slopes, x, kind);
    for (; x < x_end; x++) {
        const uint32_t mask = covered(row, x, s->target->count);
        if (mask != 0) {
            unsigned first = 0;
            while ((mask >> first & 1U) == 0) {
                first++;
            }
            draw_samples(s, at, &v, (uint32_t)x, mask, first, kind);
        }
        el_values_add(&v, &slopes->per_column, kind);
    }
}

/* Those of pixels [x, x_end) that are mixed, and covered as a whole. */
static EL_SPECIALISED void draw_mixed(sampled *s, const el_sampled_place *at, const el_slopes *slopes, uint32_t x,
                                      uint32_t x_end, unsigned kind)
{
    const unsigned count = s->target->count;
    for (; x < x_end; x++) {
        if (!el_pixel_is_mixed(at, x)) {
            continue;
        }
        const el_values v = el_values_at(slopes, (int32_t)x, kind);
        if ((kind & EL_FILL_DEPTH) == 0) {
            at->colour[x] = 0; /* which was drawn over; el_spread came before */
        }
        draw_samples(s, at, &v, x, (1U << count) - 1U, count, kind);
        el_unmix(at, x, count);
    }
}

/* Before a row is drawn over without asking for its depth. */
static void spread_all(const el_sampled_place *at, uint32_t x, uint32_t x_end, uint32_t count)
{
    for (; x < x_end; x++) {
        if (el_pixel_is_mixed(at, x)) {
            el_spread(at, x, count);
        }
    }
}

#if !EL_SMALL_CODE
static EL_SPECIALISED void draw_textured_row(sampled *s, const el_sampled_place *at, const el_slopes *slopes,
                                             uint32_t x, uint32_t x_end, unsigned kind)
{
    el_texture_brush *const brush = &s->texture_brush;
    const el_perspective *const planes = &s->triangle.perspective;
    if ((kind & EL_FILL_COLOURS) != 0) {
        brush->slopes = *slopes;
        brush->y = (uint32_t)s->triangle.y;
    }
    if ((kind & EL_FILL_DEPTH) != 0) {
        el_texture_draw_tested(brush, planes, slopes, at->colour, at->depth, x, x_end, kind);
    } else {
        el_texture_draw_all(brush, planes, at->colour, x, x_end, kind);
    }
}
#endif

/* Pixels [x, x_end) of a row, one at least, covered as a whole. */
static EL_SPECIALISED void draw_inner(sampled *s, const el_sampled_place *at, const el_slopes *slopes, uint32_t x,
                                      uint32_t x_end, unsigned kind)
{
    const bool any_mixed = el_any_is_mixed(at, x, x_end);
    if (any_mixed && (kind & EL_FILL_DEPTH) == 0) {
        spread_all(at, x, x_end, s->target->count);
    }
#if EL_WITH_MIXED
    if ((kind & EL_FILL_MIXED) != 0) {
        el_mixed_draw_row(&s->mixed_brush, &s->triangle, x, x_end, at->colour, at->depth);
    } else
#endif
#if !EL_SMALL_CODE
        if (is_textured(kind)) {
        draw_textured_row(s, at, slopes, x, x_end, kind);
    } else
#endif
        if ((kind & (EL_FILL_TEXTURE | EL_FILL_DITHER)) != 0) {
        const el_cursor cursor = {
            .row = (kind & EL_FILL_DEPTH) != 0 ? at->depth : at->colour,
            .to_colour = (kind & EL_FILL_DEPTH) != 0 ? (uintptr_t)at->colour - (uintptr_t)at->depth : 0U,
        };
        el_fill_row(&s->triangle, &s->brush, &cursor, x, x_end);
    } else {
        uint16_t *depth = at->depth + x;
        uint16_t *colour = at->colour + x;
        const uint16_t *const end = at->colour + x_end;
        const uint16_t flat = s->triangle.surface.colour;
        el_values v = el_values_at(slopes, (int32_t)x, kind);
        do {
            if (el_passes(&v, depth, kind)) {
                *colour = (kind & EL_FILL_COLOURS) != 0 ? (uint16_t)el_coloured(&v) : flat;
            }
            el_values_add(&v, &slopes->per_column, kind);
            depth++;
        } while (++colour != end);
    }
    if (any_mixed) {
        draw_mixed(s, at, slopes, x, x_end, kind);
    }
}

static EL_SPECIALISED void draw_rows(sampled *s, int32_t y, int32_t y_end, el_stats *stats, unsigned kind)
{
    el_slopes slopes = el_slopes_of(&s->triangle, kind);
    for (; y < y_end; y++) {
        const el_sampled_place at = el_sampled_place_at(s->target, y);
        sampled_row row;
        next_row(s, y, &row);
        el_count(&stats->rows, 1);
        if (row.begin < row.end) {
            el_count(&stats->spans, 1);
            el_count(&stats->pixels, (uint32_t)(row.end - row.begin));
            if (row.inner < row.inner_end) {
                draw_ends(s, &at, &row, &slopes, row.begin, row.inner, kind);
                draw_inner(s, &at, &slopes, (uint32_t)row.inner, (uint32_t)row.inner_end, kind);
                draw_ends(s, &at, &row, &slopes, row.inner_end, row.end, kind);
            } else {
                draw_ends(s, &at, &row, &slopes, row.begin, row.end, kind);
            }
        }
        s->triangle.y++;
        el_values_add(&slopes.first, &slopes.per_row, kind);
        el_slopes_keep(&slopes, &s->triangle, kind);
        if ((kind & EL_FILL_TEXTURE) != 0) {
            el_perspective_next_row(&s->triangle.perspective);
        }
    }
}

static EL_APART void draw_coloured(sampled *s, int32_t y, int32_t y_end, el_stats *stats)
{
    draw_rows(s, y, y_end, stats, EL_FILL_COLOURS | EL_FILL_DEPTH);
}

static EL_APART void draw_flat(sampled *s, int32_t y, int32_t y_end, el_stats *stats)
{
    draw_rows(s, y, y_end, stats, EL_FILL_DEPTH);
}

static EL_APART void draw_textured(sampled *s, int32_t y, int32_t y_end, el_stats *stats)
{
    draw_rows(s, y, y_end, stats, EL_FILL_TEXTURE | EL_FILL_DEPTH);
}

static EL_APART void draw_other(sampled *s, int32_t y, int32_t y_end, el_stats *stats)
{
    draw_rows(s, y, y_end, stats, s->triangle.kind);
}

/* Of the planes, what draws them. */
static inline void begin_brush(sampled *s)
{
#if EL_WITH_MIXED
    if ((s->triangle.kind & EL_FILL_MIXED) != 0) {
        el_mixed_brush_begin(&s->mixed_brush, &s->triangle);
        return;
    }
#endif
#if !EL_SMALL_CODE
    if (is_textured(s->triangle.kind)) {
        s->texture_brush.texels = el_texels_of(s->triangle.surface.texture);
        el_texture_walk_start(&s->texture_brush.walk, &s->triangle);
        return;
    }
#endif
    el_row_brush_begin(&s->brush, &s->triangle);
}

/* The way of all but small triangles in few colours. */
static EL_APART void draw_any(const el_corner *const sorted[3], int64_t area, const el_surface *surface,
                              const el_sampled_target *target, int32_t y, int32_t y_end, int32_t y_last,
                              el_stats *stats)
{
    sampled s;
    s.target = target;
    s.points = el_sample_points(target->count);
    s.short_is_left = area < 0;
    el_triangle_setup_planes(&s.triangle, sorted, surface, y);
    s.triangle.y_end = (int16_t)y_last;
    make_parts(&s, sorted);
    for (unsigned k = 0; k < target->count; k++) {
        make_edges(&s.edges[k], sorted, &s.points[k], y, s.short_is_left);
    }
    begin_brush(&s);
    if (s.triangle.kind == (EL_FILL_COLOURS | EL_FILL_DEPTH)) {
        draw_coloured(&s, y, y_end, stats);
    } else if (s.triangle.kind == EL_FILL_DEPTH) {
        draw_flat(&s, y, y_end, stats);
    } else if (s.triangle.kind == (EL_FILL_TEXTURE | EL_FILL_DEPTH)) {
        draw_textured(&s, y, y_end, stats);
    } else {
        draw_other(&s, y, y_end, stats);
    }
}

#if EL_WITH_SMALL_SAMPLED
/* A small one's shape, if it is one, and it is on the screen's columns. */
static bool is_small(const el_corner *const sorted[3], int32_t reach, const el_sampled_target *target,
                     el_small_shape *shape)
{
    *shape = (el_small_shape){
        .dx1 = sorted[1]->x - sorted[0]->x,
        .dy1 = sorted[1]->y - sorted[0]->y,
        .dx2 = sorted[2]->x - sorted[0]->x,
        .dy2 = sorted[2]->y - sorted[0]->y,
    };
    const int32_t left = el_min3_i32(sorted[0]->x, sorted[1]->x, sorted[2]->x);
    const int32_t right = el_max3_i32(sorted[0]->x, sorted[1]->x, sorted[2]->x);
    return el_shape_is_small(shape) && el_first_centre(left - reach) >= 0 &&
           el_first_centre(right + reach) <= target->target.width;
}
#endif

el_sampled_rest el_sampled_draw(const el_corner corners[3], const el_surface *surface, const el_sampled_target *target,
                                el_stats *stats, el_small_sampled *place)
{
    const el_corner *sorted[3];
    el_triangle_sort(corners, sorted);
    const int32_t reach = el_samples_reach(target->count);
    const int32_t y = el_max_i32(el_first_centre(sorted[0]->y - reach), target->target.y);
    const int32_t y_last = el_first_centre(sorted[2]->y + reach);
    const int32_t y_end = el_min_i32(y_last, target->target.y_end);
    const int32_t xs[3] = {sorted[0]->x, sorted[1]->x, sorted[2]->x};
    const int32_t ys[3] = {sorted[0]->y, sorted[1]->y, sorted[2]->y};
    const int64_t area = el_doubled_area(xs, ys);
    if (area == 0 || y >= y_last) {
        return EL_SAMPLED_DONE;
    }
    if (y >= y_end) {
        return EL_SAMPLED_GOES_ON;
    }
#if EL_WITH_SMALL_SAMPLED
    const uint8_t kind = el_fill_kind(surface);
    el_small_shape shape;
    if ((kind == EL_FILL_DEPTH || kind == (EL_FILL_COLOURS | EL_FILL_DEPTH)) &&
        is_small(sorted, reach, target, &shape)) {
        el_small_sampled_setup(place, sorted, &shape, (int32_t)area, kind, surface->colour, target->count, y);
        return el_small_sampled_go_on(place, target, stats) ? EL_SAMPLED_CARRIED : EL_SAMPLED_DONE;
    }
#else
    (void)place;
#endif
    draw_any(sorted, area, surface, target, y, y_end, y_last, stats);
    return y_last > target->target.y_end ? EL_SAMPLED_GOES_ON : EL_SAMPLED_DONE;
}

#endif
