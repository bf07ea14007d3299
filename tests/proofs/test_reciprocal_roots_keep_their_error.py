"""base/root: el_reciprocal_root is within EL_ROOT_ERROR of 2^47 / sqrt(x) for each x from 2^30 to 2^32 - 1.

r - E < 2^47 / sqrt(x) < r + E says (r - E)^2 x < 2^94 < (r + E)^2 x, in 128 bits: checked for each of them, and so is
that r has its top bit, which a sum beyond 2^32 would not have.
"""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from c_source import SOURCES, faulty_tree
from proof import ARMV6M, Fault, compile_c, core_options

FILE, HEADER = "base/root.c", "base/root.h"

EVERY_ROOT = """
#include "base/root.c"
#include <stdio.h>

typedef unsigned __int128 wide;

int main(void)
{
    for (uint32_t x = 1U << 30; x != 0; x++) {
        const uint32_t root = el_reciprocal_root(x);
        const uint64_t low = (uint64_t)root - EL_ROOT_ERROR;
        const uint64_t high = (uint64_t)root + EL_ROOT_ERROR;
        if (root >> 31 == 0 || (wide)(low * low) * x >= (wide)1 << 94 || (wide)high * high * x <= (wide)1 << 94) {
            printf("the reciprocal root of %u is %u\\n", x, root);
            return 1;
        }
    }
    return 0;
}
"""


def first_wrong(folder: Path, tree: Path = SOURCES, core: str = "") -> str:
    """The first number whose reciprocal root is wrong, or nothing."""
    program = folder / "every_root"
    compile_c(EVERY_ROOT, program, "-O3", *core_options(core), tree=tree)
    return subprocess.run([str(program)], capture_output=True, text=True, check=False, timeout=300).stdout


@pytest.mark.parametrize("core", ["", ARMV6M], ids=["long products", "products in halves"])
def test_every_reciprocal_root(tmp_path: Path, core: str) -> None:
    assert first_wrong(tmp_path, core=core) == ""


@pytest.mark.parametrize(
    "fault",
    [
        Fault(HEADER, "EL_ROOT_ERROR = 34", "EL_ROOT_ERROR = 33"),
        Fault(FILE, "254, 250,", "254, 246,"),
        Fault(FILE, "130, 129, 129, 128", "130, 129, 129, 124"),
        Fault(FILE, "3 * e_q26 * e_q26", "2 * e_q26 * e_q26"),
        Fault(FILE, "(e_q30 + 8) >> 4", "e_q30 >> 4"),
    ],
    ids=lambda fault: fault.new,
)
def test_the_check_of_every_root_can_fail(tmp_path: Path, fault: Fault) -> None:
    assert first_wrong(tmp_path, faulty_tree(tmp_path / "tree", fault)).startswith("the reciprocal root of")
