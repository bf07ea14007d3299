"""base/dither: over each block of 16 pixels the mean of a value's levels is that value, to 1/32 of a level.

All values are tried with all numbers of levels that formats have, and every colour's brightness. The thresholds of a
row are those of its pixels, from wherever it begins; any four that are side by side lie in different quarters.
"""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from c_source import SOURCES, faulty_tree
from proof import Fault, compile_c

FILE = "base/dither.h"

EVERY_VALUE = """
#include "base/dither.h"
#include <stdio.h>

enum { FULL = 65536 };

static int differ(int is_wrong, const char *what, uint32_t a, uint32_t b)
{
    return is_wrong && printf("%s: %u, %u\\n", what, a, b);
}

/* Each sixteenth's middle is once in every block, wherever that lies, and each quarter once in four pixels. */
static int check_thresholds(void)
{
    int wrong = 0;
    for (uint32_t x = 0; x < 4; x++) {
        for (uint32_t y = 0; y < 4; y++) {
            uint32_t found = 0, quarters = 0;
            for (uint32_t i = 0; i < 16; i++) {
                const uint32_t threshold = el_dither_threshold_q16(x + i % 4, y + i / 4);
                wrong |= differ(threshold % 4096 != 2048, "no sixteenth's middle", x, y);
                found |= 1U << threshold / 4096;
                quarters |= i % 4 < 2 && i < 8 ? 1U << threshold / 16384 : 0U;
            }
            wrong |= differ(found != 0xFFFF, "a threshold is twice in a block", x, y);
            wrong |= differ(quarters != 15, "a quarter is twice in four pixels", x, y);
        }
    }
    return wrong;
}

static int check_rows(void)
{
    int wrong = 0;
    for (uint32_t i = 0; i < 16; i++) {
        const uint32_t x = i / 4 - 1U, y = i % 4;
        el_dither_row row = el_dither_row_at(x, y);
        for (uint32_t next = 0; next < 12; next++) {
            wrong |= differ(el_dither_row_next_q16(&row) != el_dither_threshold_q16(x + next, y), "a row", x + next, y);
        }
    }
    return wrong;
}

static int check_means(uint32_t levels)
{
    int wrong = 0;
    for (uint32_t value = 0; value <= FULL; value++) {
        uint32_t sum = 0;
        for (uint32_t i = 0; i < 16; i++) {
            const uint32_t level = el_dither(value, levels, el_dither_threshold_q16(i % 4, i / 4));
            wrong |= differ(level > levels, "more than all levels", value, levels);
            sum += level;
        }
        /* |sum / 16 - value levels / 2^16| <= 1/32, in 2^-16 of a sixteenth */
        const int64_t error = (int64_t)sum * FULL - (int64_t)value * levels * 16;
        wrong |= differ(error > FULL / 2 || error < -FULL / 2, "a mean", value, levels);
    }
    return wrong;
}

int main(void)
{
    int wrong = check_thresholds() | check_rows();
    for (uint32_t levels = 1; levels <= 63; levels++) {
        wrong |= check_means(levels);
    }
    wrong |= check_means(255);
    for (uint32_t colour = 0; colour < 65536; colour++) {
        /* 0.299 red + 0.587 green + 0.114 blue to 5/4 of a unit, in parts of 1000 * 31 * 63 */
        const int64_t part = 1000 * 31 * 63, grey = el_luma_q16((uint16_t)colour);
        const uint32_t exact = (colour >> 11) * 299 * 63 + (colour >> 5 & 63) * 587 * 31 + (colour & 31) * 114 * 63;
        const int64_t error = grey * part - (int64_t)exact * FULL;
        const int is_off = 4 * error > 5 * part || 4 * error < -5 * part;
        wrong |= differ(grey > FULL || is_off, "brightness", colour, (uint32_t)grey);
    }
    return wrong;
}
"""


def run(folder: Path, tree: Path = SOURCES) -> subprocess.CompletedProcess[str]:
    program = folder / "every"
    compile_c(EVERY_VALUE, program, tree=tree)
    return subprocess.run([program], capture_output=True, text=True, check=False)


def test_every_value_keeps_its_mean(tmp_path: Path) -> None:
    done = run(tmp_path)
    assert done.returncode == 0, done.stdout[:1000]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("{3, 11, 1, 9}", "{3, 11, 2, 9}"),
        ("{12, 4, 14, 6}", "{12, 4, 6, 14}"),
        ("<< 12) + 2048U", "<< 12) + 1024U"),
        ("(x - 1U) & 3U) * 8U", "x & 3U) * 8U"),
        ("row->next << 24", "row->next << 16"),
        ("(value_q16 * levels + threshold_q16) >> 16", "(value_q16 * (levels + 1U) + threshold_q16 - 1U) >> 16"),
        ("EL_LUMA_BLUE_Q24 = 61697", "EL_LUMA_BLUE_Q24 = 61717"),
    ],
)
def test_a_wrong_one_is_found(tmp_path: Path, old: str, new: str) -> None:
    assert run(tmp_path, faulty_tree(tmp_path / "src", Fault(FILE, old, new))).returncode != 0
