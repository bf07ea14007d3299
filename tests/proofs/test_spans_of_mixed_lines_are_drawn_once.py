"""raster/fill_mixed_line: of a span each pixel that the depth test lets pass is drawn once, with its own texel.

A span is gathered from pieces, along which texture coordinates are linear, and runs, which nothing hides; what is drawn
at once is a stretch of both. With pieces of three pixels at most, in place of 64, all of that is small: of spans up to
eight pixels every way is tried in which they are cut and hidden. Of longer ones, with pieces as they are, many are.

What is around the source is replaced: a walk whose pieces are given, texels that say where they were fetched, a depth
test of given runs. Each pixel is blended into what is there, so that one that is drawn twice, or left out, is another.
"""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from c_source import SOURCES, faulty_tree
from proof import Fault, compile_c

FILE, WALK = "raster/fill_mixed_line.c", "raster/texture_walk.h"

PROGRAM = """
#include "raster/fill_mixed_line.c"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 400, BEFORE = 0x1111 };

static uint8_t hidden[MOST], cut[MOST]; /* of the span's pixels: not seen; a piece begins there */
static uint32_t span_x, span_count;
static uint32_t piece_at;   /* the piece's first pixel, of the span */
static uint32_t fetched[MOST];

/* --- The walk: u is the pixel's number ---------------------------------------------------------------------------- */

void el_texture_walk_start(el_texture_walk *walk, const el_triangle *triangle)
{
    (void)walk, (void)triangle;
}

void el_texture_walk_begin(el_texture_walk *walk, const el_perspective *planes, uint32_t x, uint32_t pixels)
{
    (void)planes;
    if (x != span_x || pixels != span_count) {
        printf("the walk begins at %u, %u pixels\\n", x, pixels);
        exit(1);
    }
    walk->u = walk->v = (el_texture_axis){0};
    piece_at = 0;
}

uint32_t el_texture_walk_piece(el_texture_walk *walk, uint32_t at, uint32_t most)
{
    if (at != piece_at || at + most != span_count - 1U) {
        printf("a piece at %u with %u at most, not at %u\\n", at, most, piece_at);
        exit(1);
    }
    uint32_t length = 1;
    while (length < most && length < EL_MAX_PIECE && !cut[at + length]) {
        length++;
    }
    piece_at += length;
    walk->u.q16 = (int32_t)(at << 16);
    walk->u.step_q16 = 1 << 16;
    walk->u.next_q16 = (int32_t)(piece_at << 16);
    return length;
}

/* --- Texels: each is the number of the pixel that it is for ------------------------------------------------------- */

static void fetch(const el_texel_row *row)
{
    for (uint32_t i = 0; i < row->count; i++) {
        const uint32_t at = (row->u_q16 + i * row->u_step_q16) >> 16;
        if (at >= span_count) {
            printf("a texel of pixel %u\\n", at);
            exit(1);
        }
        fetched[at]++;
        row->colour[i] = (uint16_t)(at * 37U + 5U);
    }
}

void el_texel_line_draw_plain(const el_texel_line *line, const el_texel_row *row)
{
    (void)line;
    fetch(row);
}

void el_texel_line_draw_other(el_texel_line *line, const el_texel_row *row, uint16_t *shown)
{
    (void)line;
    fetch(row);
    for (uint32_t i = 0; i < row->count; i++) {
        shown[i] = 200;
    }
}

/* --- The depth test ----------------------------------------------------------------------------------------------- */

static uint32_t go(el_depth_row *row, uint8_t while_it_is)
{
    uint32_t count = 0;
    for (; row->next != row->end && *row->next == while_it_is; row->next++) {
        count++;
    }
    return count;
}

uint32_t el_depth_row_take(el_depth_row *row)
{
    return go(row, 0);
}

uint32_t el_depth_row_pass(el_depth_row *row)
{
    return go(row, 0);
}

uint32_t el_depth_row_skip(el_depth_row *row)
{
    return go(row, 1);
}

/* --- Spans -------------------------------------------------------------------------------------------------------- */

static const struct way {
    el_mixed_way way;
    unsigned kind;
} ways[] = {{EL_MIXED_OPAQUE, EL_FILL_TEXTURE | EL_FILL_DEPTH}, {EL_MIXED_BLENDED, EL_FILL_TEXTURE | EL_FILL_DEPTH},
            {EL_MIXED_SHOWN, EL_FILL_TEXTURE | EL_FILL_DEPTH},  {EL_MIXED_TESTED, EL_FILL_TEXTURE | EL_FILL_DEPTH},
            {EL_MIXED_BLENDED, EL_FILL_TEXTURE},                {EL_MIXED_BLENDED, EL_FILL_DEPTH},
            {EL_MIXED_OPAQUE, EL_FILL_DEPTH},                   {EL_MIXED_BLENDED, 0}};

static int draw(const struct way *way)
{
    static _Alignas(4) uint16_t row[MOST + 8];
    static uint16_t depth[MOST + 8];
    el_mixed_brush b;
    memset(&b, 0, sizeof b);
    b.way = way->way;
    b.kind = way->kind;
    b.texels.way = EL_TEXELS_STRIPS; /* texels come with what of them shows */
    b.flat = 0xABCD;
    b.alpha = way->way == EL_MIXED_OPAQUE ? 256 : 100;
    b.slopes.first.z = 0;
    memset(fetched, 0, sizeof fetched);
    for (uint32_t i = 0; i < MOST + 8U; i++) {
        row[i] = BEFORE;
        depth[i] = i >= span_x && i - span_x < span_count ? hidden[i - span_x] : 1;
    }
    const el_mixed_span span = {0, span_x, span_x + span_count, row, depth};
    const el_perspective planes = {0};
    el_mixed_draw_span(&b, &span, &planes);
    const int has_texels = (way->kind & EL_FILL_TEXTURE) != 0;
    for (uint32_t i = 0; i < MOST + 8U; i++) {
        const uint32_t at = i - span_x;
        const int is_seen = i >= span_x && at < span_count && ((way->kind & EL_FILL_DEPTH) == 0 || !hidden[at]);
        const uint16_t colour = has_texels ? (uint16_t)(at * 37U + 5U) : b.flat;
        const uint32_t part = way->way == EL_MIXED_SHOWN ? (200U * b.alpha + 128U) >> 8 : b.alpha;
        const int is_whole = way->way == EL_MIXED_OPAQUE || way->way == EL_MIXED_TESTED;
        const uint16_t wanted = !is_seen ? BEFORE : is_whole ? colour : el_rgb565_blend(BEFORE, colour, part);
        if (row[i] != wanted || (at < span_count && fetched[at] != (uint32_t)(has_texels && is_seen))) {
            return printf("way %u, kind %u: pixel %u of [%u, %u) is %04x, not %04x\\n", way->way, way->kind, i, span_x,
                          span_x + span_count, row[i], wanted);
        }
    }
    return 0;
}

static int draw_all(void)
{
    for (unsigned i = 0; i < sizeof ways / sizeof ways[0]; i++) {
        if (draw(&ways[i]) != 0) {
            return 1;
        }
    }
    return 0;
}

int main(void)
{
    for (span_count = 1; EL_MAX_PIECE < 8 && span_count <= 8; span_count++) {
        for (uint32_t mask = 0; mask < 1U << (2U * span_count - 1U); mask++) {
            for (uint32_t i = 0; i < span_count; i++) {
                hidden[i] = mask >> i & 1U;
                cut[i] = i > 0 && (mask >> (span_count + i - 1U) & 1U) != 0;
            }
            span_x = mask % 3U;
            if (draw_all() != 0) {
                return 1;
            }
        }
    }
    srand(1);
    for (unsigned round = 0; round < 2000; round++) {
        span_count = 1U + (unsigned)rand() % (MOST - 4U);
        span_x = (unsigned)rand() % 4U;
        const int seldom = 1 + rand() % 100, often = 1 + rand() % 100;
        for (uint32_t i = 0; i < span_count; i++) {
            hidden[i] = i > 0 && rand() % seldom != 0 ? hidden[i - 1] : rand() % 2;
            cut[i] = rand() % often == 0;
        }
        if (draw_all() != 0) {
            return 1;
        }
    }
    return 0;
}
"""

# Of the same source, with pieces that are short.
SHORT = Fault(WALK, "enum { EL_MAX_PIECE = 64 };", "enum { EL_MAX_PIECE = 3 };")


def run(folder: Path, tree: Path) -> subprocess.CompletedProcess[str]:
    program = folder / "spans"
    compile_c(PROGRAM, program, "-O1", "-fsanitize=address,undefined", "-fno-sanitize-recover", tree=tree)
    return subprocess.run([program], capture_output=True, text=True, check=False, timeout=300)


def test_long_spans(tmp_path: Path) -> None:
    done = run(tmp_path, SOURCES)
    assert done.returncode == 0, done.stdout + done.stderr


def test_all_short_spans(tmp_path: Path) -> None:
    done = run(tmp_path, faulty_tree(tmp_path / "src", SHORT))
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("drawn - r.begin >= EL_MAX_PIECE", "drawn - r.begin >= EL_MAX_PIECE + 2"),
        ("r.begin = drawn;", "r.begin = drawn - (drawn < r.end);"),
        ("el_texture_walk_skip(&b->walk, drawn - x);", "el_texture_walk_skip(&b->walk, 0);"),
        ("            x = drawn;\n", ""),
        ("r.begin += count;", "r.begin += count - (count > 1U);"),
        ("? r.end - r.begin : LINE;", "? r.end - r.begin : LINE + 1;"),
        ("el_rgb565_share(colour >> 11, alpha)", "el_rgb565_share(colour >> 12, alpha)"),
        ("LINE = 2 * EL_MAX_PIECE", "LINE = EL_MAX_PIECE"),
        ("line + ((uintptr_t)pixels >> 1 & 1U)", "line"),
        ("el_rgb565_blend_pair(*word, *colours++, alpha)", "el_rgb565_blend_pair(*word, *colours, alpha)"),
    ],
)
def test_a_wrong_one_is_found(tmp_path: Path, old: str, new: str) -> None:
    tree = faulty_tree(tmp_path / "src", Fault(FILE, old, new))
    assert run(tmp_path, tree).returncode != 0
