#include "subpixel.h"

const bench_case subpixel_cases[] = {
    {"subpixel", "bits4", run_subpixel_4, bench_colour, sizeof bench_colour, 0, {0, TRIANGLES}, 0},
    {"subpixel", "bits6", run_subpixel_6, bench_colour, sizeof bench_colour, 0, {0, TRIANGLES}, 0},
    {"subpixel", "bits8", run_subpixel_8, bench_colour, sizeof bench_colour, 0, {0, TRIANGLES}, 0},
    {0},
};
