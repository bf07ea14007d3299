/* stress: the library against exact references, at scale. One process, one thread; every case follows from its
 * category's name, the seed and its index. Exit status 0 when all held, 1 when something failed, 2 on a bad command
 * line. */
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stress.h"

enum { DEFAULT_TRIANGLES = 200000, MAX_CATEGORIES = 48 };

/* Of the depths of a category, so many must be equal to the correctly rounded plane; of its vertices, so many must be
 * snapped to the nearest. */
static const double depth_share = 0.999;
static const double vertex_share = 0.99;

typedef struct options {
    uint64_t triangles;
    uint64_t seed;
    int64_t index; /* the only case to run; -1: all */
    const char *category;
    const char *report;
} options;

void stress_fail(stress *s, const char *format, ...)
{
    va_list arguments;
    s->failed = true;
    printf("FAILED %s, case %" PRIu64 ": ", s->category, s->index);
    va_start(arguments, format);
    vprintf(format, arguments);
    va_end(arguments);
    printf("\n  again: %s --category %s --seed %" PRIu64 " --index %" PRIu64 "\n", s->program, s->category, s->seed,
           s->index);
}

void stress_picture(int64_t width, int64_t height, int64_t column, int64_t row,
                    char (*symbol)(const void *context, int64_t column, int64_t row), const void *context)
{
    enum { BESIDE = 30, ABOVE = 8 };
    const int64_t left = column > BESIDE ? column - BESIDE : 0;
    const int64_t top = row > ABOVE ? row - ABOVE : 0;
    printf("         from column %d\n", (int)left);
    for (int64_t y = top; y < height && y <= row + ABOVE; y++) {
        printf("  %5d  ", (int)y);
        for (int64_t x = left; x < width && x <= column + BESIDE; x++) {
            if (x == column && y == row) {
                printf("[%c]", symbol(context, x, y));
            } else {
                putchar(symbol(context, x, y));
            }
        }
        putchar('\n');
    }
}

static const category *all_categories(unsigned i)
{
    const category *const lists[] = {triangle_categories, solid_categories, flat_categories, vertex_categories};
    for (unsigned k = 0; k < sizeof lists / sizeof lists[0]; k++) {
        for (const category *c = lists[k]; c->name != NULL; c++) {
            if (i-- == 0) {
                return c;
            }
        }
    }
    return NULL;
}

static unsigned all_shares(void)
{
    unsigned sum = 0;
    for (unsigned i = 0; all_categories(i) != NULL; i++) {
        sum += all_categories(i)->share;
    }
    return sum;
}

/* Checks of a whole category. */
static void check_shares(stress *s)
{
    const category_tally *const t = &s->tally;
    if (t->depths > 0 && (double)t->depths_exact < depth_share * (double)t->depths) {
        s->failed = true;
        printf("FAILED %s: %" PRIu64 " of %" PRIu64 " depths are correctly rounded, fewer than %.1f %%\n", s->category,
               t->depths_exact, t->depths, 100 * depth_share);
    }
    if (t->vertices > 0 && (double)t->vertices_exact < vertex_share * (double)t->vertices) {
        s->failed = true;
        printf("FAILED %s: %" PRIu64 " of %" PRIu64 " vertices are snapped to the nearest, fewer than %.1f %%\n",
               s->category, t->vertices_exact, t->vertices, 100 * vertex_share);
    }
}

static stress run_category(const options *o, const char *program, const category *c, const canvas_buffers *canvas)
{
    stress s = {.program = program, .category = c->name, .seed = o->seed, .canvas = canvas};
    const uint64_t wanted = o->triangles * c->share / all_shares() + 1;
    s.index = o->index >= 0 ? (uint64_t)o->index : 0;
    do {
        s.random = random_of(c->name, o->seed, s.index);
        s.tally.triangles += c->run(&s, c->argument);
        s.tally.cases++;
        s.index++;
    } while (o->index < 0 && !s.failed && s.tally.triangles < wanted);
    if (o->index < 0 && !s.failed) {
        check_shares(&s);
    }
    return s;
}

static void write_texels(FILE *f, const char *name, const double errors[MAX_UV_ERROR_LOG2 + 1])
{
    fprintf(f, ",\n    \"%s\": {", name);
    for (unsigned i = 1; i <= MAX_UV_ERROR_LOG2; i++) {
        fprintf(f, "%s\"1/%u\": %.6f", i > 1 ? ", " : "", 1U << i, errors[i]);
    }
    fprintf(f, "}");
}

static void write_category(FILE *f, const stress *s)
{
    const category_tally *const t = &s->tally;
    fprintf(f, "  \"%s\": {\n    \"passed\": %s,\n    \"cases\": %" PRIu64 ",\n    \"triangles\": %" PRIu64,
            s->category, s->failed ? "false" : "true", t->cases, t->triangles);
    fprintf(f, ",\n    \"samples\": %" PRIu64, t->samples);
    if (t->depths > 0) {
        fprintf(f, ",\n    \"depth_correctly_rounded\": %.9f,\n    \"depth_most_off\": %" PRId64,
                (double)t->depths_exact / (double)t->depths, t->depth_most_off);
    }
    if (t->texels > 0) {
        fprintf(f, ",\n    \"colour_most_off\": %.9f,\n    \"texture_coordinates\": %" PRIu64, t->colour_most_off,
                t->texels);
        write_texels(f, "texels_most_off", t->texel_most_off);
        fprintf(f, ",\n    \"texture_coordinates_beyond_domain\": %" PRIu64, t->texels_beyond);
        write_texels(f, "texels_most_off_beyond_domain", t->texel_most_off_beyond);
    }
    if (t->vertices > 0) {
        fprintf(f,
                ",\n    \"vertices\": %" PRIu64 ",\n    \"vertices_correctly_rounded\": %.9f,\n"
                "    \"vertex_most_off_sixteenths\": %.6f,\n    \"vertex_depth_most_off\": %.6f",
                t->vertices, (double)t->vertices_exact / (double)t->vertices, t->vertex_most_off,
                t->vertex_depth_most_off);
    }
    fprintf(f, "\n  }");
}

/* Writes beside the file and moves: a report is whole or not there. */
static bool write_report(const char *path, const options *o, const stress results[], unsigned count)
{
    char beside[4096];
    if (snprintf(beside, sizeof beside, "%s.new", path) >= (int)sizeof beside) {
        return false;
    }
    FILE *const f = fopen(beside, "w");
    if (f == NULL) {
        return false;
    }
    fprintf(f, "{\n  \"seed\": %" PRIu64 ",\n  \"subpixel_bits\": %d", o->seed, EL_SUBPIXEL_BITS);
    for (unsigned i = 0; i < count; i++) {
        fprintf(f, ",\n");
        write_category(f, &results[i]);
    }
    fprintf(f, "\n}\n");
    const bool bad = ferror(f) != 0;
    return fclose(f) == 0 && !bad && rename(beside, path) == 0;
}

static int usage(const char *message, const char *what)
{
    fprintf(stderr,
            "stress: %s '%s'; usage: stress [--triangles N] [--seed N] [--category NAME [--index N]] [--report FILE] "
            "[--list]\n",
            message, what);
    return 2;
}

/* Returns 0, or an exit status plus 1. */
static int parse(int argc, char **argv, options *o)
{
    for (int i = 1; i < argc; i += 2) {
        if (strcmp(argv[i], "--list") == 0) {
            for (unsigned k = 0; all_categories(k) != NULL; k++) {
                printf("%s\n", all_categories(k)->name);
            }
            return 1;
        }
        const char *const value = i + 1 < argc ? argv[i + 1] : "";
        char *end = NULL;
        const uint64_t number = strtoull(value, &end, 10);
        const bool is_number = *value >= '0' && *value <= '9' && *end == '\0';
        if (strcmp(argv[i], "--category") == 0 && *value != '\0') {
            o->category = value;
        } else if (strcmp(argv[i], "--report") == 0 && *value != '\0') {
            o->report = value;
        } else if (strcmp(argv[i], "--triangles") == 0 && is_number) {
            o->triangles = number;
        } else if (strcmp(argv[i], "--seed") == 0 && is_number) {
            o->seed = number;
        } else if (strcmp(argv[i], "--index") == 0 && is_number && number <= INT64_MAX) {
            o->index = (int64_t)number;
        } else {
            return usage("cannot use", argv[i]) + 1;
        }
    }
    return o->index >= 0 && o->category == NULL ? usage("needs --category:", "--index") + 1 : 0;
}

static bool canvas_make(canvas_buffers *c)
{
    const size_t pixels = (size_t)MAX_SIDE * MAX_SIDE;
    c->colour = calloc(pixels, sizeof c->colour[0]);
    c->depth = malloc(pixels * sizeof c->depth[0]);
    c->zeros = calloc(MAX_SIDE, sizeof c->zeros[0]);
    c->ones = calloc(MAX_SIDE, sizeof c->ones[0]);
    c->empty = calloc(MAX_SIDE, sizeof c->empty[0]);
    if (c->colour == NULL || c->depth == NULL || c->zeros == NULL || c->ones == NULL || c->empty == NULL) {
        return false;
    }
    memset(c->depth, 0xFF, pixels * sizeof c->depth[0]);
    for (unsigned i = 0; i < MAX_SIDE; i++) {
        c->ones[i] = 1;
        c->empty[i] = 0xFFFF;
    }
    return true;
}

static void canvas_free(canvas_buffers *c)
{
    free(c->colour);
    free(c->depth);
    free(c->zeros);
    free(c->ones);
    free(c->empty);
}

int main(int argc, char **argv)
{
    options o = {.triangles = DEFAULT_TRIANGLES, .seed = 1, .index = -1};
    const int parsed = parse(argc, argv, &o);
    if (parsed != 0) {
        return parsed - 1;
    }
    canvas_buffers canvas;
    if (!canvas_make(&canvas)) {
        fprintf(stderr, "stress: no memory for a canvas of %d x %d pixels\n", MAX_SIDE, MAX_SIDE);
        return 2;
    }
    stress results[MAX_CATEGORIES];
    unsigned count = 0;
    unsigned failed = 0;
    uint64_t triangles = 0;
    for (unsigned i = 0; i < MAX_CATEGORIES && all_categories(i) != NULL; i++) {
        const category *const c = all_categories(i);
        if (o.category != NULL && strcmp(o.category, c->name) != 0) {
            continue;
        }
        results[count] = run_category(&o, argv[0], c, &canvas);
        const stress *const s = &results[count++];
        printf("%s %-22s %9" PRIu64 " triangles %10" PRIu64 " samples\n", s->failed ? "failed" : "held  ", s->category,
               s->tally.triangles, s->tally.samples);
        fflush(stdout);
        failed += s->failed;
        triangles += s->tally.triangles;
        if (s->failed) { /* what a failed check left behind must not fail the next one */
            canvas_free(&canvas);
            if (!canvas_make(&canvas)) {
                fprintf(stderr, "stress: no memory\n");
                return 2;
            }
        }
    }
    canvas_free(&canvas);
    if (count == 0) {
        return usage("there is no category", o.category);
    }
    if (o.report != NULL && !write_report(o.report, &o, results, count)) {
        fprintf(stderr, "stress: cannot write %s\n", o.report);
        return 2;
    }
    printf("%u categories held, %u failed, %" PRIu64 " triangles\n", count - failed, failed, triangles);
    return failed == 0 ? 0 : 1;
}
