/* Runs all cases. One line each: "GROUP NAME crc CRC ns NANOSECONDS", after an empty measurement that tells what a pair of
 * markers costs. */
#include <string.h>

#include "alternatives.h"
#include "base/crc32.h"
#include "platform.h"

bench_triangle bench_triangles[TRIANGLES];
uint16_t bench_colour[PICTURES][PIXELS];
uint16_t bench_depth[PICTURES][PIXELS];

/* Marsaglia, "Xorshift RNGs", Journal of Statistical Software 8(14), 2003. */
static uint32_t random_bits(void)
{
    static uint32_t state = 2463534242U;
    state ^= state << 13;
    state ^= state >> 17;
    state ^= state << 5;
    return state;
}

/* 0 to below - 1; below at most 2^20. */
static int32_t random_below(uint32_t below)
{
    return (int32_t)(((uint64_t)random_bits() * below) >> 32);
}

/* Within the tile, a pixel from its border at least: an error of a pixel stays in it. Corners of every fourth triangle
 * lie on pixel centres, where edges pass through centres too and the fill rule decides. */
static int32_t random_place(uint32_t index, int32_t begin_px, int32_t tile_px)
{
    if (index % 4 == 0) {
        return ((begin_px + 1 + random_below((uint32_t)tile_px - 2)) << FINE_BITS) + (1 << (FINE_BITS - 1));
    }
    return ((begin_px + 1) << FINE_BITS) + random_below(((uint32_t)tile_px - 2) << FINE_BITS);
}

static int32_t snap(int32_t fine)
{
    const int shift = FINE_BITS - EL_SUBPIXEL_BITS;
    return (fine + (1 << (shift - 1))) >> shift;
}

static void make_triangle(bench_triangle *triangle, uint32_t index, int32_t x_px, int32_t y_px, int32_t tile_px,
                          uint32_t w_shifts)
{
    /* About one texel per pixel. */
    const uint32_t texels = (uint32_t)tile_px;
    for (unsigned i = 0; i < 3; i++) {
        triangle->fine_x[i] = random_place(index, x_px, tile_px);
        triangle->fine_y[i] = random_place(index, y_px, tile_px);
        triangle->corners[i] = (el_corner){
            .x = snap(triangle->fine_x[i]),
            .y = snap(triangle->fine_y[i]),
            .z = (uint16_t)random_below(EL_DEPTH_MAX + 1),
            .w = (1U << 29 | random_bits() >> 4) >> random_below(w_shifts),
            .u_q16 = random_below(texels << 10) << 6,
            .v_q16 = random_below(texels << 10) << 6,
        };
        for (unsigned channel = 0; channel < 3; channel++) {
            triangle->corners[i].rgb_q8[channel] = (uint16_t)(random_below(256) << 8);
        }
    }
}

void bench_triangles_make(void)
{
    static const struct {
        uint8_t tile_px, pictures, w_shifts;
    } plan[] = {{8, 2, 3}, {32, 1, 3}, {120, 2, 3}, {240, 1, 3}, {32, 1, 7}, {120, 2, 7}, {240, 1, 7}};
    uint32_t index = 0;
    uint32_t picture = 0;
    for (size_t i = 0; i < sizeof plan / sizeof plan[0]; i++) {
        const int32_t tile_px = plan[i].tile_px;
        for (const uint32_t end = picture + plan[i].pictures; picture < end; picture++) {
            for (int32_t y_px = 0; y_px + tile_px <= HEIGHT; y_px += tile_px) {
                for (int32_t x_px = 0; x_px + tile_px <= WIDTH; x_px += tile_px) {
                    bench_triangle *const triangle = &bench_triangles[index];
                    triangle->picture = picture;
                    make_triangle(triangle, index, x_px, y_px, tile_px, plan[i].w_shifts);
                    index++;
                }
            }
        }
    }
}

static void run_case(const bench_case *c)
{
    uint64_t best_ns = UINT64_MAX;
    for (unsigned i = 0; i < bench_repeats; i++) {
        memset(bench_colour, 0, sizeof bench_colour);
        memset(bench_depth, 0xFF, sizeof bench_depth);
        bench_next();
        c->run(c, NULL);
        best_ns = bench_elapsed_ns() < best_ns ? bench_elapsed_ns() : best_ns;
    }
    bench_print(c->group);
    bench_print(" ");
    bench_print(c->name);
    bench_print(" crc ");
    bench_print_hex(el_crc32(0, c->output, c->output_bytes));
    bench_print(" ns ");
    bench_print_u64(best_ns);
    bench_print("\n");
    int32_t *const record = c->record_bytes != 0 ? bench_scratch(c->record_bytes) : NULL;
    if (record != NULL) {
        c->run(c, record);
        bench_keep(c->group, c->name, record, c->record_bytes);
    } else {
        bench_keep(c->group, c->name, c->output, c->output_bytes);
    }
}

int bench_main(void)
{
    static const bench_case *const groups[] = {edge_cases,   subpixel_cases, depth_cases,      gouraud_cases,
                                               dither_cases, texture_cases,  reciprocal_cases, smoothing_cases};
    bench_next();
    bench_start();
    bench_stop();
    bench_print("empty empty crc 00000000 ns 0\n");
    bench_triangles_make();
    bench_keep("input", "triangles", bench_triangles, sizeof bench_triangles);
    for (size_t i = 0; i < sizeof groups / sizeof groups[0]; i++) {
        for (const bench_case *c = groups[i]; c->group != NULL; c++) {
            run_case(c);
        }
    }
    return 0;
}
