/* Shapes first, then one method after the other on all of them: once for its pixels, then timed. */
#include "methods/score.h"

#include <stdlib.h>
#include <string.h>

#include "methods/clock.h"
#include "methods/reference.h"

enum { PIXELS = EL_CASES_WIDTH * EL_CASES_HEIGHT };

/* The pictures that scoring needs, and all shapes of one kind. */
typedef struct bench {
    uint16_t expected[PIXELS];
    uint16_t got[PIXELS];
    uint16_t others[PIXELS];
    size_t triangle_count;
    el_spot (*triangles)[3]; /* room for EL_FAN_MOST per shape */
    el_fan *fans;
    el_polygon *polygons;
    el_valued_triangle *valued;
} bench;

static el_hits picture_of(uint16_t *counts)
{
    return (el_hits){EL_CASES_WIDTH, EL_CASES_HEIGHT, counts};
}

static void clear(uint16_t *counts)
{
    memset(counts, 0, PIXELS * sizeof counts[0]);
}

double el_score_wrong(const el_score *score)
{
    return score->edge_pixels == 0 ? 0.0
                                   : 1000.0 * (double)(score->missing + score->extra) / (double)score->edge_pixels;
}

el_score el_score_sum(const el_score *scores, size_t kinds)
{
    el_score sum = {0};
    double ns = 0.0;
    for (size_t i = 0; i < kinds; i++) {
        sum.shapes += scores[i].shapes;
        sum.covered += scores[i].covered;
        sum.edge_pixels += scores[i].edge_pixels;
        sum.work += scores[i].work;
        sum.missing += scores[i].missing;
        sum.extra += scores[i].extra;
        ns += scores[i].ns_per_shape * scores[i].shapes;
    }
    sum.ns_per_shape = sum.shapes == 0 ? 0.0 : ns / sum.shapes;
    return sum;
}

static bool covered_at(const uint16_t *counts, int32_t column, int32_t row)
{
    return column >= 0 && column < EL_CASES_WIDTH && row >= 0 && row < EL_CASES_HEIGHT &&
           counts[row * EL_CASES_WIDTH + column] != 0;
}

/* Adds what b->got has beside b->expected. */
static void compare(const bench *b, el_score *score)
{
    for (int32_t row = 0; row < EL_CASES_HEIGHT; row++) {
        for (int32_t column = 0; column < EL_CASES_WIDTH; column++) {
            const uint16_t expected = b->expected[row * EL_CASES_WIDTH + column];
            const uint16_t got = b->got[row * EL_CASES_WIDTH + column];
            score->missing += got < expected;
            score->extra += got > expected;
            if (expected != 0) {
                score->covered++;
                score->edge_pixels +=
                    !covered_at(b->expected, column - 1, row) || !covered_at(b->expected, column + 1, row) ||
                    !covered_at(b->expected, column, row - 1) || !covered_at(b->expected, column, row + 1);
            }
        }
    }
    score->shapes++;
}

/* --- Triangles ---------------------------------------------------------------------------------------------------- */

static void make_triangles(bench *b, const el_scores *scores, el_triangle_kind kind)
{
    el_random random = el_random_of(scores->seed, (uint32_t)kind);
    b->triangle_count = 0;
    for (uint32_t i = 0; i < scores->count; i++) {
        if (kind == EL_TRIANGLES_FAN) {
            el_any_fan(&random, i, &b->fans[i]);
            memcpy(b->triangles[b->triangle_count], b->fans[i].triangles, b->fans[i].count * sizeof b->triangles[0]);
            b->triangle_count += b->fans[i].count;
        } else {
            el_any_triangle(&random, kind, b->triangles[b->triangle_count++]);
        }
    }
}

/* Every triangle is drawn over the others: no clearing in the time. */
static double time_triangles(bench *b, const el_triangle_method *method)
{
    el_hits hits = picture_of(b->got);
    uint64_t runs[EL_TIMED_RUNS];
    for (unsigned run = 0; run < EL_TIMED_RUNS; run++) {
        const uint64_t start = el_work_ns();
        for (size_t i = 0; i < b->triangle_count; i++) {
            method->draw((const el_spot *)b->triangles[i], &hits);
        }
        runs[run] = el_work_ns() - start;
    }
    return (double)el_median(runs) / (double)b->triangle_count;
}

static void score_triangle_kind(bench *b, el_triangle_kind kind, el_scores *scores)
{
    static const el_edge_rule rules[] = {EL_EDGES_ALL, EL_EDGES_NONE, EL_EDGES_LEFT_TOP};
    el_hits expected = picture_of(b->expected);
    el_hits got = picture_of(b->got);
    for (size_t i = 0; i < b->triangle_count; i++) {
        const el_spot *const corners = (const el_spot *)b->triangles[i];
        for (unsigned r = 0; r < sizeof rules / sizeof rules[0]; r++) {
            el_reference_triangle(corners, rules[r], &expected);
            for (unsigned m = 0; m < EL_TRIANGLE_METHODS; m++) {
                if (el_triangle_methods[m].rule == rules[r]) {
                    el_score *const score = &scores->triangles[m][kind];
                    clear(b->got);
                    score->work += el_triangle_methods[m].draw(corners, &got);
                    compare(b, score);
                }
            }
        }
    }
    for (unsigned m = 0; m < EL_TRIANGLE_METHODS; m++) {
        scores->triangles[m][kind].ns_per_shape = time_triangles(b, &el_triangle_methods[m]);
    }
}

/* --- Fans --------------------------------------------------------------------------------------------------------- */

/* Whether the point lies on one of the fan's outer edges. */
static bool is_on_rim(const el_fan *fan, el_spot p)
{
    for (size_t i = 0; i < fan->count; i++) {
        const el_spot a = fan->triangles[i][1];
        const el_spot b = fan->triangles[i][2];
        const int64_t along = (int64_t)(p.x - a.x) * (p.x - b.x) + (int64_t)(p.y - a.y) * (p.y - b.y);
        if (el_side(a, b, p) == 0 && along <= 0) {
            return true;
        }
    }
    return false;
}

static void score_fans(bench *b, el_scores *scores)
{
    el_hits expected = picture_of(b->others);
    el_hits got = picture_of(b->got);
    for (uint32_t i = 0; i < scores->count; i++) {
        const el_fan *const fan = &b->fans[i];
        clear(b->expected);
        for (size_t t = 0; t < fan->count; t++) {
            el_reference_triangle((const el_spot *)fan->triangles[t], EL_EDGES_LEFT_TOP, &expected);
            for (size_t p = 0; p < PIXELS; p++) {
                b->expected[p] = (uint16_t)(b->expected[p] + b->others[p]);
            }
        }
        for (unsigned m = 0; m < EL_TRIANGLE_METHODS; m++) {
            el_fan_score *const score = &scores->fans[m];
            clear(b->got);
            for (size_t t = 0; t < fan->count; t++) {
                el_triangle_methods[m].draw((const el_spot *)fan->triangles[t], &got);
            }
            score->fans++;
            for (int32_t p = 0; p < PIXELS; p++) {
                score->inner += b->expected[p];
                score->double_hits += b->got[p] > 1;
                score->cracks +=
                    b->got[p] < b->expected[p] && !is_on_rim(fan, el_centre_of(p % EL_CASES_WIDTH, p / EL_CASES_WIDTH));
            }
        }
    }
}

/* --- Polygons ----------------------------------------------------------------------------------------------------- */

/* As with triangles, without clearing: what these leave in the picture is wrong then, but the work is the same. */
static double time_polygons(bench *b, const el_polygon_method *method, uint32_t count)
{
    el_hits hits = picture_of(b->got);
    uint64_t runs[EL_TIMED_RUNS];
    for (unsigned run = 0; run < EL_TIMED_RUNS; run++) {
        const uint64_t start = el_work_ns();
        for (uint32_t i = 0; i < count; i++) {
            method->draw(&b->polygons[i], method->rule, &hits);
        }
        runs[run] = el_work_ns() - start;
    }
    return (double)el_median(runs) / (double)count;
}

static void score_polygon_kind(bench *b, el_polygon_kind kind, el_scores *scores)
{
    static const el_fill_rule rules[] = {EL_FILL_EVEN_ODD, EL_FILL_NON_ZERO};
    el_hits expected = picture_of(b->expected);
    el_hits got = picture_of(b->got);
    el_random random = el_random_of(scores->seed, EL_TRIANGLE_KINDS + (uint32_t)kind);
    for (uint32_t i = 0; i < scores->count; i++) {
        el_any_polygon(&random, kind, i, &b->polygons[i]);
        for (unsigned r = 0; r < sizeof rules / sizeof rules[0]; r++) {
            el_reference_polygon(&b->polygons[i], rules[r], &expected);
            for (unsigned m = 0; m < EL_POLYGON_METHODS; m++) {
                const el_polygon_method *const method = &el_polygon_methods[m];
                if (method->rule == rules[r]) {
                    el_score *const score = &scores->polygons[m][kind];
                    clear(b->got);
                    score->work += method->draw(&b->polygons[i], method->rule, &got);
                    compare(b, score);
                }
            }
        }
    }
    for (unsigned m = 0; m < EL_POLYGON_METHODS; m++) {
        scores->polygons[m][kind].ns_per_shape = time_polygons(b, &el_polygon_methods[m], scores->count);
    }
}

/* --- Values ------------------------------------------------------------------------------------------------------- */

static el_value_picture value_picture_of(bench *b)
{
    return (el_value_picture){EL_CASES_WIDTH, EL_CASES_HEIGHT, b->got, b->others};
}

/* The triangles of the kind that have an area, each with three values up to `most`. */
static size_t make_valued(bench *b, const el_scores *scores, el_triangle_kind kind, int32_t most)
{
    const el_hits picture = picture_of(b->got);
    size_t count = 0;
    make_triangles(b, scores, kind);
    el_random random = el_random_of(scores->seed, EL_TRIANGLE_KINDS + EL_POLYGON_KINDS + (uint32_t)kind);
    for (size_t i = 0; i < b->triangle_count; i++) {
        el_valued_triangle *const valued = &b->valued[count];
        memcpy(valued->corners, b->triangles[i], sizeof valued->corners);
        for (unsigned k = 0; k < 3; k++) {
            valued->values[k] = el_random_between(&random, 0, most);
        }
        if (el_side(valued->corners[0], valued->corners[1], valued->corners[2]) != 0) {
            el_valued_triangle_cover(valued, &picture);
            count++;
        }
    }
    return count;
}

static double score_pixel(const el_valued_triangle *valued, int32_t x, int32_t row, int32_t got, el_value_score *score)
{
    const int32_t *const values = valued->values;
    const int32_t expected = el_reference_value(valued->corners, values, el_centre_of(x, row));
    const uint32_t error = (uint32_t)(got > expected ? got - expected : expected - got);
    const bool below = got < values[0] && got < values[1] && got < values[2];
    const bool above = got > values[0] && got > values[1] && got > values[2];
    score->pixels++;
    score->off += error != 0;
    score->outside += below || above;
    score->max_error = error > score->max_error ? error : score->max_error;
    return error;
}

/* Each alone, because Edgeline tests depth against what is in the picture. */
static uint64_t time_value(bench *b, const el_value_method *method, const el_valued_triangle *valued)
{
    el_value_picture picture = value_picture_of(b);
    uint64_t runs[EL_TIMED_RUNS];
    for (unsigned run = 0; run < EL_TIMED_RUNS; run++) {
        memset(b->got, 0xFF, sizeof b->got);
        const uint64_t start = el_time_ns();
        method->fill(valued, &picture);
        runs[run] = el_time_ns() - start;
    }
    return el_median(runs);
}

static void score_values(bench *b, const el_value_method *method, size_t count, el_value_score *score)
{
    el_value_picture picture = value_picture_of(b);
    double error_sum = 0.0;
    uint64_t ns = 0;
    for (size_t i = 0; i < count; i++) {
        const el_valued_triangle *const valued = &b->valued[i];
        memset(b->got, 0xFF, sizeof b->got);
        method->fill(valued, &picture);
        for (int32_t row = valued->y; row < valued->y_end; row++) {
            for (int32_t x = valued->spans[row - valued->y].x; x < valued->spans[row - valued->y].x_end; x++) {
                error_sum += score_pixel(valued, x, row, b->got[row * EL_CASES_WIDTH + x], score);
            }
        }
        ns += time_value(b, method, valued);
    }
    score->triangles = (uint32_t)count;
    if (score->pixels > 0) {
        score->mean_error = error_sum / (double)score->pixels;
        score->ns_per_pixel = (double)ns / (double)score->pixels;
    }
}

static void score_all_values(bench *b, el_scores *scores)
{
    static const int32_t most[EL_VALUE_USES] = {[EL_VALUE_DEPTH] = EL_DEPTH_MAX, [EL_VALUE_COLOUR] = 255};
    for (unsigned use = 0; use < EL_VALUE_USES; use++) {
        for (unsigned kind = 0; kind < EL_VALUE_KINDS; kind++) {
            const size_t count = make_valued(b, scores, (el_triangle_kind)kind, most[use]);
            for (unsigned m = 0; m < EL_VALUE_METHODS; m++) {
                const el_value_method *const method = &el_value_methods[m];
                if (use == EL_VALUE_DEPTH ? method->for_depth : method->for_colour) {
                    score_values(b, method, count, &scores->values[m][use][kind]);
                }
            }
        }
    }
}

/* --- All ---------------------------------------------------------------------------------------------------------- */

bool el_score_all(el_scores *scores)
{
    *scores = (el_scores){.seed = scores->seed, .count = scores->count};
    bench *const b = calloc(1, sizeof *b);
    if (b == NULL) {
        return false;
    }
    b->triangles = calloc((size_t)scores->count * EL_FAN_MOST, sizeof b->triangles[0]);
    b->fans = calloc(scores->count, sizeof b->fans[0]);
    b->polygons = calloc(scores->count, sizeof b->polygons[0]);
    b->valued = calloc(scores->count, sizeof b->valued[0]);
    const bool has_memory = b->triangles != NULL && b->fans != NULL && b->polygons != NULL && b->valued != NULL;
    if (has_memory) {
        for (unsigned kind = 0; kind < EL_TRIANGLE_KINDS; kind++) {
            make_triangles(b, scores, (el_triangle_kind)kind);
            score_triangle_kind(b, (el_triangle_kind)kind, scores);
            if (kind == EL_TRIANGLES_FAN) {
                score_fans(b, scores);
            }
        }
        for (unsigned kind = 0; kind < EL_POLYGON_KINDS; kind++) {
            score_polygon_kind(b, (el_polygon_kind)kind, scores);
        }
        score_all_values(b, scores);
    }
    free(b->valued);
    free(b->polygons);
    free(b->fans);
    free(b->triangles);
    free(b);
    return has_memory;
}
