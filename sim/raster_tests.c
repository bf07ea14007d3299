/* coverage and attributes: the real rasterizer, one triangle at a time, for comparison with exact references. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/crc32.h"
#include "commands.h"
#include "files.h"
#include "raster/triangle.h"
#include "report.h"

static uint32_t u32_at(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static int32_t i32_at(const uint8_t *bytes)
{
    return (int32_t)u32_at(bytes);
}

static uint16_t u16_at(const uint8_t *bytes)
{
    return (uint16_t)(bytes[0] | bytes[1] << 8);
}

static void put_u32(uint32_t value, FILE *stream)
{
    const uint8_t bytes[4] = {(uint8_t)value, (uint8_t)(value >> 8), (uint8_t)(value >> 16), (uint8_t)(value >> 24)};
    fwrite(bytes, 1, sizeof bytes, stream);
}

static bool corner_in_range(const el_corner *corner)
{
    return corner->x >= -EL_GUARD_SUB && corner->x <= EL_GUARD_SUB && corner->y >= -EL_GUARD_SUB &&
           corner->y <= EL_GUARD_SUB;
}

/* Draws the triangle on the cleared `counts` and writes how many pixels it covers and the CRC of their indices; clears
 * what it found. A pixel that is drawn twice counts twice. */
static void cover(const el_corner corners[3], const el_target *target, uint32_t pixel_count, FILE *out)
{
    const el_surface surface = {.shading = EL_SHADE_OVERDRAW};
    el_triangle triangle;
    el_stats stats = {0};
    uint32_t covered = 0;
    uint32_t crc = 0;
    if (el_triangle_setup(&triangle, corners, &surface, target->y)) {
        el_triangle_draw(&triangle, target, &stats);
        for (uint32_t i = 0; i < pixel_count; i++) {
            for (; target->colour[i] > 0; target->colour[i]--) {
                const uint8_t index[4] = {(uint8_t)i, (uint8_t)(i >> 8), (uint8_t)(i >> 16), (uint8_t)(i >> 24)};
                crc = el_crc32(crc, index, sizeof index);
                covered++;
            }
        }
    }
    put_u32(covered, out);
    put_u32(crc, out);
}

static int run_coverage(const char *in_path, const uint8_t *bytes, size_t size, FILE *out)
{
    enum { HEADER = 20, TRIANGLE = 24 };
    if (size < HEADER || memcmp(bytes, "HOC1", 4) != 0) {
        return el_report("%s is not a coverage file: it does not begin with HOC1", in_path);
    }
    const int32_t count = i32_at(bytes + 4);
    const int32_t width = i32_at(bytes + 8);
    const int32_t height = i32_at(bytes + 12);
    if (width < 1 || width > EL_MAX_WIDTH || height < 1 || height > EL_MAX_HEIGHT) {
        return el_report("%s: the target is %d x %d pixels; 1 to %d each can be drawn", in_path, (int)width,
                         (int)height, (int)EL_MAX_WIDTH);
    }
    if (i32_at(bytes + 16) != EL_SUBPIXELS) {
        return el_report("%s: coordinates are in 1/%d px, this build has 1/%d px", in_path, (int)i32_at(bytes + 16),
                         EL_SUBPIXELS);
    }
    if (count < 0 || size != HEADER + (size_t)count * TRIANGLE) {
        return el_report("%s: %d triangles take %zu bytes, the file has %zu", in_path, (int)count,
                         HEADER + (size_t)(count < 0 ? 0 : count) * TRIANGLE, size);
    }
    const uint32_t pixel_count = (uint32_t)width * (uint32_t)height;
    uint16_t *const counts = calloc(pixel_count, sizeof counts[0]);
    if (counts == NULL) {
        return el_report("no memory for %d x %d pixels", (int)width, (int)height);
    }
    const el_target target = {.colour = counts, .width = width, .y = 0, .y_end = height};
    int status = EL_EXIT_OK;
    for (int32_t i = 0; i < count && status == EL_EXIT_OK; i++) {
        const uint8_t *const at = bytes + HEADER + (size_t)i * TRIANGLE;
        el_corner corners[3] = {0};
        for (unsigned k = 0; k < 3; k++) {
            corners[k].x = i32_at(at + 8 * k);
            corners[k].y = i32_at(at + 8 * k + 4);
            if (!corner_in_range(&corners[k])) {
                status =
                    el_report("%s: triangle %d leaves the guard band of +-%d px", in_path, (int)i, (int)EL_GUARD_PX);
            }
        }
        if (status == EL_EXIT_OK) {
            cover(corners, &target, pixel_count, out);
        }
    }
    free(counts);
    return status;
}

static void put_float(double value, FILE *stream)
{
    const float single = (float)value;
    uint32_t bits;
    memcpy(&bits, &single, sizeof bits);
    put_u32(bits, stream);
}

/* The six values at one pixel. Depth and colour come from a Gouraud triangle, texture coordinates from a textured one:
 * together they are what a textured Gouraud triangle steps. */
static bool sample(const el_corner corners[3], int32_t x, int32_t y, FILE *out)
{
    static const uint16_t texel = 0;
    static const el_texture texture = {.texels = &texel};
    const el_surface surface = {
        .shading = EL_SHADE_TEXTURED_GOURAUD, .depth = true, .uv_error_log2 = 3, .texture = &texture};
    el_triangle triangle;
    el_sample values;
    if (!el_triangle_setup(&triangle, corners, &surface, y) || triangle.y != y || x < el_edge_x(&triangle.left) ||
        x >= el_edge_x(&triangle.right)) {
        return false;
    }
    el_triangle_sample(&triangle, x, EL_MAX_WIDTH, &values);
    put_float(values.z_plus_half_q16 / 65536.0 - 0.5, out);
    for (unsigned i = 0; i < 3; i++) {
        put_float(values.rgb_plus_half_q24[i] / 16777216.0 - 0.5, out);
    }
    put_float(values.u_q16 / 65536.0, out);
    put_float(values.v_q16 / 65536.0, out);
    return true;
}

static void read_corner(const uint8_t *at, el_corner *corner)
{
    *corner = (el_corner){
        .x = i32_at(at),
        .y = i32_at(at + 4),
        .z = u16_at(at + 8),
        .w = u16_at(at + 10),
        .u_q16 = (int16_t)u16_at(at + 12) * (1 << 12),
        .v_q16 = (int16_t)u16_at(at + 14) * (1 << 12),
    };
    for (unsigned i = 0; i < 3; i++) {
        corner->rgb_q8[i] = (uint16_t)(at[16 + i] << 8);
    }
}

static int run_attributes(const char *in_path, const uint8_t *bytes, size_t size, FILE *out)
{
    enum { HEADER = 12, CORNER = 20, SAMPLE = 12 };
    if (size < HEADER || memcmp(bytes, "HOA1", 4) != 0) {
        return el_report("%s is not an attributes file: it does not begin with HOA1", in_path);
    }
    const int32_t triangles = i32_at(bytes + 4);
    const int32_t samples = i32_at(bytes + 8);
    const size_t samples_at = HEADER + (size_t)(triangles < 0 ? 0 : triangles) * 3 * CORNER;
    if (triangles < 0 || samples < 0 || size != samples_at + (size_t)samples * SAMPLE) {
        return el_report("%s: %d triangles and %d samples do not fill its %zu bytes", in_path, (int)triangles,
                         (int)samples, size);
    }
    for (int32_t i = 0; i < samples; i++) {
        const uint8_t *const at = bytes + samples_at + (size_t)i * SAMPLE;
        const int32_t index = i32_at(at);
        if (index < 0 || index >= triangles) {
            return el_report("%s: sample %d asks for triangle %d of %d", in_path, (int)i, (int)index, (int)triangles);
        }
        el_corner corners[3];
        for (unsigned k = 0; k < 3; k++) {
            read_corner(bytes + HEADER + ((size_t)index * 3 + k) * CORNER, &corners[k]);
            if (!corner_in_range(&corners[k])) {
                return el_report("%s: triangle %d leaves the guard band of +-%d px", in_path, (int)index,
                                 (int)EL_GUARD_PX);
            }
            if (corners[k].w == 0) {
                return el_report("%s: triangle %d has a corner with 1/w = 0", in_path, (int)index);
            }
        }
        if (!sample(corners, i32_at(at + 4), i32_at(at + 8), out)) {
            return el_report("%s: sample %d, pixel (%d, %d), is not covered by triangle %d", in_path, (int)i,
                             (int)i32_at(at + 4), (int)i32_at(at + 8), (int)index);
        }
    }
    return EL_EXIT_OK;
}

static int convert_file(int argc, char **argv, const char *name,
                        int (*run)(const char *in_path, const uint8_t *bytes, size_t size, FILE *out))
{
    if (argc != 2) {
        return el_report("%s takes two files, IN and OUT", name);
    }
    size_t size;
    uint8_t *const bytes = el_file_read(argv[0], &size);
    if (bytes == NULL) {
        return EL_EXIT_BAD;
    }
    el_output output;
    int status = EL_EXIT_BAD;
    if (el_output_open(&output, argv[1])) {
        status = run(argv[0], bytes, size, output.stream);
        if (status != EL_EXIT_OK) {
            el_output_discard(&output);
        } else if (!el_output_commit(&output)) {
            status = EL_EXIT_BAD;
        }
    }
    free(bytes);
    return status;
}

int el_command_coverage(int argc, char **argv)
{
    return convert_file(argc, argv, "coverage", run_coverage);
}

int el_command_attributes(int argc, char **argv)
{
    return convert_file(argc, argv, "attributes", run_attributes);
}
