#include "methods/tables.h"

#include <inttypes.h>

const char *const el_edge_rule_names[] = {
    [EL_EDGES_ALL] = "all", [EL_EDGES_NONE] = "none", [EL_EDGES_LEFT_TOP] = "left-top"};
const char *const el_fill_rule_names[] = {[EL_FILL_EVEN_ODD] = "even-odd", [EL_FILL_NON_ZERO] = "non-zero"};
const char *const el_value_use_names[] = {[EL_VALUE_DEPTH] = "depth", [EL_VALUE_COLOUR] = "colour"};

static double per(double part, double whole)
{
    return whole > 0.0 ? part / whole : 0.0;
}

/* --- To read ------------------------------------------------------------------------------------------------------ */

static void print_triangles(const el_scores *scores, FILE *stream)
{
    const el_fan_score *const fans = scores->fans;
    fprintf(stream, "Triangles: %" PRIu32 " of each kind, fans of %d to %d; wrong by the method's own edge rule\n\n",
            scores->count, EL_FAN_LEAST, EL_FAN_MOST);
    fprintf(stream, "%-24s %-9s %-12s %34s %7s %9s %7s %7s\n", "", "", "", "ns per triangle        ", "asked",
            "wrong of", "", "double");
    fprintf(stream, "%-24s %-9s %-12s %8s %8s %8s %8s %7s %9s %7s %7s\n", "method", "edges", "numbers", "small",
            "medium", "large", "sliver", "per px", "1000 edge", "cracks", "hits");
    for (unsigned m = 0; m < EL_TRIANGLE_METHODS; m++) {
        const el_triangle_method *const method = &el_triangle_methods[m];
        const el_score *const kinds = scores->triangles[m];
        const el_score sum = el_score_sum(kinds, EL_TRIANGLE_KINDS);
        fprintf(stream, "%-24s %-9s %-12s %8.0f %8.0f %8.0f %8.0f %7.2f %9.3f %7" PRIu64 " %7" PRIu64 "\n",
                method->title, el_edge_rule_names[method->rule], method->numbers,
                kinds[EL_TRIANGLES_SMALL].ns_per_shape, kinds[EL_TRIANGLES_MEDIUM].ns_per_shape,
                kinds[EL_TRIANGLES_LARGE].ns_per_shape, kinds[EL_TRIANGLES_SLIVER].ns_per_shape,
                per((double)sum.work, (double)sum.covered), el_score_wrong(&sum), fans[m].cracks, fans[m].double_hits);
    }
    fprintf(stream, "\ncracks and double hits: in %" PRIu32 " closed fans of %" PRIu64 " pixels\n\n", fans[0].fans,
            fans[0].inner);
}

static void print_polygons(const el_scores *scores, FILE *stream)
{
    fprintf(stream, "Polygons: %" PRIu32 " of each kind; wrong by the method's own fill rule\n\n", scores->count);
    fprintf(stream, "%-24s %-9s %-7s", "", "", "");
    fprintf(stream, " %44s %7s %9s\n", "ns per polygon             ", "asked", "wrong of");
    fprintf(stream, "%-24s %-9s %-7s", "method", "rule", "numbers");
    for (unsigned kind = 0; kind < EL_POLYGON_KINDS; kind++) {
        fprintf(stream, " %8s", el_polygon_kind_names[kind]);
    }
    fprintf(stream, " %7s %9s\n", "per px", "1000 edge");
    for (unsigned m = 0; m < EL_POLYGON_METHODS; m++) {
        const el_polygon_method *const method = &el_polygon_methods[m];
        const el_score sum = el_score_sum(scores->polygons[m], EL_POLYGON_KINDS);
        fprintf(stream, "%-24s %-9s %-7s", method->title, el_fill_rule_names[method->rule], method->numbers);
        for (unsigned kind = 0; kind < EL_POLYGON_KINDS; kind++) {
            fprintf(stream, " %8.0f", scores->polygons[m][kind].ns_per_shape);
        }
        fprintf(stream, " %7.2f %9.3f\n", per((double)sum.work, (double)sum.covered), el_score_wrong(&sum));
    }
    fputc('\n', stream);
}

static void print_values(const el_scores *scores, FILE *stream)
{
    fprintf(stream,
            "Values: %" PRIu32 " triangles of each kind; usual: small, medium, large; units of 16 and of 8 bits\n\n",
            scores->count);
    fprintf(stream, "%-7s %-27s %-7s %8s %24s %24s %10s\n", "", "", "", "ns", "off by rounding, per 1000",
            "largest error  ", "mean");
    fprintf(stream, "%-7s %-27s %-7s %8s %12s %12s %12s %12s %9s\n", "value", "method", "numbers", "per px", "usual",
            "slivers", "usual", "slivers", "error");
    for (unsigned use = 0; use < EL_VALUE_USES; use++) {
        for (unsigned m = 0; m < EL_VALUE_METHODS; m++) {
            const el_value_method *const method = &el_value_methods[m];
            const el_value_score *const kinds = scores->values[m][use];
            if (!(use == EL_VALUE_DEPTH ? method->for_depth : method->for_colour)) {
                continue;
            }
            el_value_score others = {0};
            for (unsigned kind = 0; kind < EL_TRIANGLES_SLIVER; kind++) {
                others.pixels += kinds[kind].pixels;
                others.off += kinds[kind].off;
                others.max_error = kinds[kind].max_error > others.max_error ? kinds[kind].max_error : others.max_error;
                others.mean_error += kinds[kind].mean_error * (double)kinds[kind].pixels;
            }
            const el_value_score *const slivers = &kinds[EL_TRIANGLES_SLIVER];
            fprintf(stream, "%-7s %-27s %-7s %8.2f %12.3f %12.3f %12" PRIu32 " %12" PRIu32 " %9.3f\n",
                    el_value_use_names[use], method->title, method->numbers, kinds[EL_TRIANGLES_MEDIUM].ns_per_pixel,
                    1000.0 * per((double)others.off, (double)others.pixels),
                    1000.0 * per((double)slivers->off, (double)slivers->pixels), others.max_error, slivers->max_error,
                    per(others.mean_error, (double)others.pixels));
        }
    }
}

void el_table_print(const el_scores *scores, FILE *stream)
{
    print_triangles(scores, stream);
    print_polygons(scores, stream);
    print_values(scores, stream);
}

/* --- JSON --------------------------------------------------------------------------------------------------------- */

static void write_json_kinds(const el_score *scores, const char *const *names, size_t kinds, FILE *stream)
{
    fputs("\"kinds\": {", stream);
    for (size_t i = 0; i < kinds; i++) {
        const el_score *const s = &scores[i];
        fprintf(stream,
                "%s\n      \"%s\": {\"shapes\": %" PRIu32 ", \"ns_per_shape\": %.1f, \"work\": %" PRIu64
                ", \"covered\": %" PRIu64 ", \"edge_pixels\": %" PRIu64 ", \"missing\": %" PRIu64
                ", \"extra\": %" PRIu64 "}",
                i == 0 ? "" : ",", names[i], s->shapes, s->ns_per_shape, s->work, s->covered, s->edge_pixels,
                s->missing, s->extra);
    }
    fputc('}', stream);
}

static void write_json_method(const char *id, const char *title, const char *rule, const char *numbers, bool exact,
                              FILE *stream)
{
    fprintf(stream,
            "    {\"method\": \"%s\", \"title\": \"%s\", \"rule\": \"%s\", \"numbers\": \"%s\", \"exact\": %s,\n     ",
            id, title, rule, numbers, exact ? "true" : "false");
}

static void write_json_values(const el_scores *scores, FILE *stream)
{
    const char *separator = "";
    for (unsigned use = 0; use < EL_VALUE_USES; use++) {
        for (unsigned m = 0; m < EL_VALUE_METHODS; m++) {
            const el_value_method *const method = &el_value_methods[m];
            if (!(use == EL_VALUE_DEPTH ? method->for_depth : method->for_colour)) {
                continue;
            }
            fprintf(stream,
                    "%s    {\"use\": \"%s\", \"method\": \"%s\", \"title\": \"%s\", \"numbers\": \"%s\",\n     "
                    "\"kinds\": {",
                    separator, el_value_use_names[use], method->id, method->title, method->numbers);
            for (unsigned kind = 0; kind < EL_VALUE_KINDS; kind++) {
                const el_value_score *const s = &scores->values[m][use][kind];
                fprintf(stream,
                        "%s\n      \"%s\": {\"triangles\": %" PRIu32 ", \"pixels\": %" PRIu64
                        ", \"ns_per_pixel\": %.2f, \"off\": %" PRIu64 ", \"outside\": %" PRIu64
                        ", \"max_error\": %" PRIu32 ", \"mean_error\": %.4f}",
                        kind == 0 ? "" : ",", el_triangle_kind_names[kind], s->triangles, s->pixels, s->ns_per_pixel,
                        s->off, s->outside, s->max_error, s->mean_error);
            }
            fputs("}}", stream);
            separator = ",\n";
        }
    }
}

void el_table_write_json(const el_scores *scores, FILE *stream)
{
    fprintf(stream,
            "{\n  \"seed\": %" PRIu32 ", \"count\": %" PRIu32 ", \"width\": %d, \"height\": %d,\n  \"triangles\": [\n",
            scores->seed, scores->count, EL_CASES_WIDTH, EL_CASES_HEIGHT);
    for (unsigned m = 0; m < EL_TRIANGLE_METHODS; m++) {
        const el_triangle_method *const method = &el_triangle_methods[m];
        const el_fan_score *const fans = &scores->fans[m];
        write_json_method(method->id, method->title, el_edge_rule_names[method->rule], method->numbers, method->exact,
                          stream);
        write_json_kinds(scores->triangles[m], el_triangle_kind_names, EL_TRIANGLE_KINDS, stream);
        fprintf(stream,
                ",\n     \"fans\": {\"fans\": %" PRIu32 ", \"inner\": %" PRIu64 ", \"cracks\": %" PRIu64
                ", \"double_hits\": %" PRIu64 "}}%s\n",
                fans->fans, fans->inner, fans->cracks, fans->double_hits, m + 1 < EL_TRIANGLE_METHODS ? "," : "");
    }
    fputs("  ],\n  \"polygons\": [\n", stream);
    for (unsigned m = 0; m < EL_POLYGON_METHODS; m++) {
        const el_polygon_method *const method = &el_polygon_methods[m];
        write_json_method(method->id, method->title, el_fill_rule_names[method->rule], method->numbers, method->exact,
                          stream);
        write_json_kinds(scores->polygons[m], el_polygon_kind_names, EL_POLYGON_KINDS, stream);
        fprintf(stream, "}%s\n", m + 1 < EL_POLYGON_METHODS ? "," : "");
    }
    fputs("  ],\n  \"values\": [\n", stream);
    write_json_values(scores, stream);
    fputs("\n  ]\n}\n", stream);
}

/* --- CSV ---------------------------------------------------------------------------------------------------------- */

static void write_csv_score(const el_score *s, FILE *stream)
{
    fprintf(stream, "%" PRIu32 ",%.1f,%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%" PRIu64 ",%" PRIu64, s->shapes,
            s->ns_per_shape, s->work, s->covered, s->edge_pixels, s->missing, s->extra);
}

void el_table_write_csv(const el_scores *scores, FILE *stream)
{
    fputs(
        "family,method,rule,numbers,kind,shapes,ns_per_shape,work,covered,edge_pixels,missing,extra,cracks,double_hits,"
        "ns_per_pixel,off,outside,max_error,mean_error\n",
        stream);
    for (unsigned m = 0; m < EL_TRIANGLE_METHODS; m++) {
        const el_triangle_method *const method = &el_triangle_methods[m];
        for (unsigned kind = 0; kind < EL_TRIANGLE_KINDS; kind++) {
            fprintf(stream, "triangle,%s,%s,%s,%s,", method->id, el_edge_rule_names[method->rule], method->numbers,
                    el_triangle_kind_names[kind]);
            write_csv_score(&scores->triangles[m][kind], stream);
            if (kind == EL_TRIANGLES_FAN) {
                fprintf(stream, ",%" PRIu64 ",%" PRIu64, scores->fans[m].cracks, scores->fans[m].double_hits);
            } else {
                fputs(",,", stream);
            }
            fputs(",,,,,\n", stream);
        }
    }
    for (unsigned m = 0; m < EL_POLYGON_METHODS; m++) {
        const el_polygon_method *const method = &el_polygon_methods[m];
        for (unsigned kind = 0; kind < EL_POLYGON_KINDS; kind++) {
            fprintf(stream, "polygon,%s,%s,%s,%s,", method->id, el_fill_rule_names[method->rule], method->numbers,
                    el_polygon_kind_names[kind]);
            write_csv_score(&scores->polygons[m][kind], stream);
            fputs(",,,,,,,\n", stream);
        }
    }
    for (unsigned use = 0; use < EL_VALUE_USES; use++) {
        for (unsigned m = 0; m < EL_VALUE_METHODS; m++) {
            const el_value_method *const method = &el_value_methods[m];
            for (unsigned kind = 0; kind < EL_VALUE_KINDS; kind++) {
                const el_value_score *const s = &scores->values[m][use][kind];
                if (use == EL_VALUE_DEPTH ? method->for_depth : method->for_colour) {
                    fprintf(stream,
                            "%s,%s,,%s,%s,%" PRIu32 ",,,%" PRIu64 ",,,,,,%.2f,%" PRIu64 ",%" PRIu64 ",%" PRIu32
                            ",%.4f\n",
                            el_value_use_names[use], method->id, method->numbers, el_triangle_kind_names[kind],
                            s->triangles, s->pixels, s->ns_per_pixel, s->off, s->outside, s->max_error, s->mean_error);
                }
            }
        }
    }
}
