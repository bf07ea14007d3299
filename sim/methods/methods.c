/* methods: the textbooks' ways to fill triangles and polygons, side by side. */
#include <getopt.h>
#include <stdlib.h>

#include "commands.h"
#include "files.h"
#include "methods/picture.h"
#include "methods/score.h"
#include "methods/tables.h"
#include "options.h"
#include "png_file.h"
#include "report.h"

typedef struct methods_options {
    long seed, count;
    const char *json, *csv, *png;
} methods_options;

static bool parse(int argc, char **argv, methods_options *o)
{
    enum { SEED = 1, COUNT, JSON, CSV, PNG_FILE };
    static const struct option options[] = {
        {"seed", required_argument, NULL, SEED},    {"count", required_argument, NULL, COUNT},
        {"json", required_argument, NULL, JSON},    {"csv", required_argument, NULL, CSV},
        {"png", required_argument, NULL, PNG_FILE}, {NULL, 0, NULL, 0},
    };
    *o = (methods_options){.seed = 1, .count = 50};
    int which;
    optind = 0;
    opterr = 0;
    while ((which = getopt_long(argc, argv, "+", options, NULL)) != -1) {
        bool good = true;
        switch (which) {
        case SEED:
            good = el_option_integer("--seed", optarg, 0, INT32_MAX, &o->seed);
            break;
        case COUNT:
            good = el_option_integer("--count", optarg, 1, 10000, &o->count);
            break;
        case JSON:
            o->json = optarg;
            break;
        case CSV:
            o->csv = optarg;
            break;
        case PNG_FILE:
            o->png = optarg;
            break;
        default:
            el_report("methods: '%s' is unknown or lacks its value", argv[optind - 1]);
            good = false;
        }
        if (!good) {
            return false;
        }
    }
    if (optind != argc) {
        el_report("methods: '%s' is no option", argv[optind]);
        return false;
    }
    return true;
}

static bool write_picture(el_output *output)
{
    static uint16_t pixels[EL_METHODS_PICTURE_WIDTH * EL_METHODS_PICTURE_HEIGHT];
    el_sheet canvas = {EL_METHODS_PICTURE_WIDTH, EL_METHODS_PICTURE_HEIGHT, pixels};
    el_methods_picture(&canvas);
    return el_png_write(output, pixels, canvas.width, canvas.height);
}

/* The files that were asked for, all opened before anything is measured. */
typedef struct outputs {
    el_output json, csv, png;
} outputs;

static bool open_output(el_output *output, const char *path)
{
    return path == NULL || el_output_open(output, path);
}

static bool commit_output(el_output *output)
{
    return output->stream == NULL || el_output_commit(output);
}

static bool write_all(const el_scores *scores, outputs *out)
{
    if (out->json.stream != NULL) {
        el_table_write_json(scores, out->json.stream);
    }
    if (out->csv.stream != NULL) {
        el_table_write_csv(scores, out->csv.stream);
    }
    return (out->png.stream == NULL || write_picture(&out->png)) && commit_output(&out->json) &&
           commit_output(&out->csv) && commit_output(&out->png);
}

int el_command_methods(int argc, char **argv)
{
    methods_options o;
    if (!parse(argc + 1, argv - 1, &o)) {
        return EL_EXIT_BAD;
    }
    static el_scores scores;
    scores.seed = (uint32_t)o.seed;
    scores.count = (uint32_t)o.count;
    outputs out = {0};
    int status = EL_EXIT_BAD;
    if (open_output(&out.json, o.json) && open_output(&out.csv, o.csv) && open_output(&out.png, o.png)) {
        if (!el_score_all(&scores)) {
            el_report("methods: no memory for %ld shapes of each kind; a smaller --count needs less", o.count);
        } else if (write_all(&scores, &out)) {
            el_table_print(&scores, stdout);
            status = EL_EXIT_OK;
        }
    }
    el_output_discard(&out.json);
    el_output_discard(&out.csv);
    el_output_discard(&out.png);
    return status;
}
