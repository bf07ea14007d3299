"""raster/wires: in any rows of the screen a wire has the pixels that its edge is in, wherever its ends are.

Bands are short, and most of a flat edge lies above or below one: its columns there are found by a division, and not
walked along. Edges of all lengths in the guard band are drawn into six rows near one of their ends, against the
definition, which goes through every column.
"""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from c_source import DIVISION, SOURCES, faulty_tree
from proof import EVERY_PRECISION, Fault, compile_c

FILE = "raster/wires.c"

PROGRAM = r"""
#include "raster/wires.c"
#include <stdio.h>
#include <string.h>

enum { WIDE = 2040, HIGH = 6 };

static uint64_t state = 1;

static int32_t any(int32_t least, int32_t most)
{
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return least + (int32_t)((state >> 33) % (uint64_t)(most - least + 1));
}

static uint16_t drawn[HIGH][WIDE], wanted[HIGH][WIDE];

static int32_t ceiling(int64_t n, int64_t d)
{
    return (int32_t)(n / d + (n % d > 0));
}

static void want(int32_t x, int32_t y, int32_t top)
{
    if (x >= 0 && x < WIDE && y >= top && y < top + HIGH) {
        wanted[y - top][x] = 1;
    }
}

/* By the definition, column by column or row by row. */
static void want_edge(const el_corner *a, const el_corner *b, int32_t top)
{
    const int steep = el_abs_u64(b->y - a->y) > el_abs_u64(b->x - a->x);
    const el_corner *const from = (steep ? a->y <= b->y : a->x <= b->x) ? a : b;
    const el_corner *const to = from == a ? b : a;
    const int64_t begin = steep ? from->y : from->x, length = (steep ? to->y : to->x) - begin;
    const int64_t across = steep ? from->x : from->y, rise = (steep ? to->x : to->y) - across;
    for (int32_t at = steep ? top : 0; at < (steep ? top + HIGH : WIDE); at++) {
        const int64_t way = at * EL_SUBPIXELS + EL_SUBPIXELS / 2 - begin;
        if (way >= 0 && way < length) {
            const int32_t pixel = ceiling(across * length + way * rise, length * EL_SUBPIXELS) - 1;
            want(steep ? pixel : at, steep ? at : pixel, top);
        }
    }
    const el_corner *const ends[2] = {from, to};
    for (unsigned i = 0; i < 2; i++) {
        const int64_t along = steep ? ends[i]->y : ends[i]->x;
        const int32_t at = ceiling(along, EL_SUBPIXELS) - 1;
        const int64_t way = at * EL_SUBPIXELS + EL_SUBPIXELS / 2 - begin;
        if (way < 0 || way >= length) {
            want(ceiling(ends[i]->x, EL_SUBPIXELS) - 1, ceiling(ends[i]->y, EL_SUBPIXELS) - 1, top);
        }
    }
}

int main(void)
{
    const int32_t guard = EL_GUARD_SUB;
    for (unsigned round = 0; round < 20000; round++) {
        el_corner c[3];
        memset(c, 0, sizeof c);
        const int32_t high = any(0, 3) == 0 ? guard : any(0, 2) == 0 ? 40 * EL_SUBPIXELS : 4 * EL_SUBPIXELS;
        const int32_t middle = any(high - guard, guard - high);
        for (unsigned i = 0; i < 2; i++) {
            c[i].x = (el_coordinate)any(-guard, guard);
            c[i].y = (el_coordinate)(middle + any(-high, high));
        }
        if (any(0, 9) == 0) {
            c[1].y = c[0].y;
        }
        const int32_t row = pixel_of(c[any(0, 1)].y) + any(-12, 12);
        const int32_t top = row < 0 ? 0 : row > 2040 - HIGH ? 2040 - HIGH : row;
        memset(drawn, 0, sizeof drawn);
        memset(wanted, 0, sizeof wanted);
        const el_surface surface = {.colour = 1};
        const el_target target = {.colour = drawn[0], .width = WIDE, .y = top, .y_end = top + HIGH};
        el_stats stats = {0};
        el_wires_draw(c, 1, &surface, &target, &stats);
        want_edge(&c[0], &c[1], top);
        if (memcmp(drawn, wanted, sizeof drawn) != 0) {
            return printf("round %u: (%d, %d) to (%d, %d), rows from %d on\n", round, c[0].x, c[0].y, c[1].x, c[1].y,
                          top);
        }
    }
    return 0;
}
"""


def run(folder: Path, bits: int, tree: Path = SOURCES) -> subprocess.CompletedProcess[str]:
    program = folder / "wires"
    units = [str(tree / name) for name in ("raster/list.c", "base/fixed.c", *DIVISION)]
    compile_c(PROGRAM, program, f"-DEL_SUBPIXEL_BITS={bits}", "-O1", "-fsanitize=undefined", *units, tree=tree)
    return subprocess.run([program], capture_output=True, text=True, check=False)


@EVERY_PRECISION
def test_a_wire_has_its_edges_pixels(tmp_path: Path, bits: int) -> None:
    done = run(tmp_path, bits)
    assert done.returncode == 0 and not done.stderr, done.stdout + done.stderr


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("*first = least - 2 > *first", "*first = least + 1 > *first"),
        ("most + 3 < *last", "most - 1 < *last"),
        ("upper < lower ? upper : lower", "upper > lower ? upper : lower"),
        ("(int64_t)p->bottom * EL_SUBPIXELS", "(int64_t)p->bottom"),
        ("along < first || along >= last", "along < first"),
        ("from->across - half, from->along, to->across - half", "from->across, from->along, to->across"),
        ("if (bottom < p->top || top >= p->bottom)", "if (bottom <= p->top || top >= p->bottom)"),
    ],
)
def test_a_pixel_that_is_missing_is_found(tmp_path: Path, old: str, new: str) -> None:
    assert run(tmp_path, 4, faulty_tree(tmp_path / "src", Fault(FILE, old, new))).returncode != 0
