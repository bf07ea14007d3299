/* memory: what RAM a program needs, from the macros that firmware sizes its arena with. */
#include <getopt.h>
#include <stdio.h>

#include "commands.h"
#include "edgeline.h"
#include "options.h"
#include "panel/tft.h"
#include "report.h"

typedef struct memory_options {
    uint16_t width, height;
    long band, vertices, triangles, draws;
} memory_options;

static bool parse(int argc, char **argv, memory_options *o)
{
    enum { SIZE = 1, BAND, VERTICES, TRIANGLES, DRAWS };
    static const struct option options[] = {
        {"size", required_argument, NULL, SIZE},         {"band", required_argument, NULL, BAND},
        {"vertices", required_argument, NULL, VERTICES}, {"triangles", required_argument, NULL, TRIANGLES},
        {"draws", required_argument, NULL, DRAWS},       {NULL, 0, NULL, 0},
    };
    *o = (memory_options){.width = 320, .height = 240, .band = 8, .vertices = 600, .triangles = 1000, .draws = 4};
    int which;
    optind = 0;
    opterr = 0;
    while ((which = getopt_long(argc, argv, "+", options, NULL)) != -1) {
        bool good = false;
        switch (which) {
        case SIZE:
            good = el_option_size("--size", optarg, &o->width, &o->height);
            break;
        case BAND:
            good = el_option_integer("--band", optarg, 1, EL_MAX_HEIGHT, &o->band);
            break;
        case VERTICES:
            good = el_option_integer("--vertices", optarg, 0, EL_MESH_MAX_VERTICES, &o->vertices);
            break;
        case TRIANGLES:
            good = el_option_integer("--triangles", optarg, 0, 65535, &o->triangles);
            break;
        case DRAWS:
            good = el_option_integer("--draws", optarg, 0, 65535, &o->draws);
            break;
        default:
            el_report("memory: '%s' is unknown or lacks its value", argv[optind - 1]);
        }
        if (!good) {
            return false;
        }
    }
    if (optind != argc) {
        el_report("memory: '%s' is no option", argv[optind]);
        return false;
    }
    return true;
}

/* The deepest chain of calls is el_draw, a list drawn early, a triangle set up: 1.8 KB by gcc's -fstack-usage for Cortex-M0+
 * and M4. Interrupts and the caller's own frames are not in it. */
enum { STACK_BYTES = 2048 };

static void row(const char *part, size_t bytes)
{
    printf("%-44s %8zu\n", part, bytes);
}

int el_command_memory(int argc, char **argv)
{
    memory_options o;
    if (!parse(argc + 1, argv - 1, &o)) {
        return EL_EXIT_BAD;
    }
    const size_t width = o.width;
    const size_t height = o.height;
    const size_t band = (size_t)o.band;
    const size_t vertices = (size_t)o.vertices;
    const size_t triangles = (size_t)o.triangles;
    const size_t draws = (size_t)o.draws;
    const size_t depth = EL_DEPTH_BAND_BYTES(width, band);
    const size_t vertex_bytes = EL_ROUND_UP_8(vertices * EL_VERTEX_BYTES);
    const size_t fixed = sizeof(el_renderer) + sizeof(el_tft);
    const size_t arena = EL_MEMORY_BYTES(width, height, band, vertices, triangles, draws);

    printf("%zu x %zu, bands of %zu lines, %zu vertices in the largest mesh, %zu visible triangles, %zu draws\n", width,
           height, band, vertices, triangles, draws);
    row("two colour bands", 2 * EL_COLOUR_BAND_BYTES(width, band));
    row("depth band", depth);
    row("vertices, beyond what fits the depth band", vertex_bytes > depth ? vertex_bytes - depth : 0);
    row("bins", EL_BIN_BYTES(height, band));
    row("triangles, textured", triangles * EL_TEXTURED_TRIANGLE_BYTES);
    row("draws, and slack", draws * EL_RUN_BYTES + EL_MIN_LIST_BYTES / 2 + 16);
    row("arena (EL_MEMORY_BYTES)", arena);
    row("el_renderer and el_tft, this machine's", fixed);
    row("stack", STACK_BYTES);
    row("in all", arena + fixed + STACK_BYTES);
    row("in all, when no triangle is textured",
        arena + fixed + STACK_BYTES - triangles * (EL_TEXTURED_TRIANGLE_BYTES - EL_TRIANGLE_BYTES));
    return EL_EXIT_OK;
}
