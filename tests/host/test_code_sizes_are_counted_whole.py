"""What the linker put into a program is counted whole, by file, and what has grown is said."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import pytest

BENCH = Path(__file__).parents[1] / "bench"
sys.path.insert(0, str(BENCH))

from bench_tool import frames, machines, size  # noqa: E402

MAP = """
Discarded input sections
 .text.unused   0x00000000       0xff /x/raster-rows.o

Linker script and memory map

 .text.start    0x00008000       0x44 /x/program.o
 .text.a_function_with_a_name_of_many_letters
                0x00008044       0x10 /x/raster-rows.o
 .rodata.table  0x00008054        0x6 /x/raster-rows.o
 .text.b        0x0000805a        0x0 /x/raster-list.o
 .text          0x0000805c       0x20 /usr/lib/libgcc.a(_udivsi3.o)
 .text          0x0000807c        0x8 /usr/lib/libgcc.a(_clzsi2.o)
 .text          0x00008084       0x30 /usr/lib/libc_nano.a(lib_a-memset.o)
 .bss.renderer  0x00008100      0x100 /x/program.o
"""


def entry(total: int) -> dict[str, Any]:
    return {"total": total, "modules": {"base/fixed.c": total}, "libc": {}}


def found(total: int, compiler: str = "12.2.1") -> dict[str, Any]:
    return {"compiler": compiler, "options": {"all": entry(total)}, "panels": {"ili9341": 1000}, "stream": 5000}


def failures(now: dict[str, Any], recorded: dict[str, Any]) -> int:
    verdicts = frames.Verdicts()
    size.check(now, recorded, verdicts)
    return verdicts.failed


def test_a_map_is_read_by_file() -> None:
    read = size.read_map(MAP)
    assert read.modules == {"raster/rows.c": 0x16, "libgcc": 0x28}
    assert read.libc == {"memset": 0x30}
    assert read.total == 0x3E


def test_a_map_of_cmake_s_libraries_is_read_by_file(tmp_path: Path) -> None:
    rows = [
        " .text.a  0x00000010  0x20 edgeline/firmware/libedgeline_raster.a(list.c.obj)",
        " .text.b  0x00000030  0x08 edgeline/firmware/libedgeline_base.a(crc32.c.obj)",
        " .rodata  0x00000040  0x80 edgeline/firmware/libedgeline_scenes.a(demo_scenes.c.obj)",
        " .text.c  0x000000c0  0x04 CMakeFiles/scenes.dir/scenes.c.obj",
        " .text    0x000000d0  0x02 /usr/lib/libgcc.a(_clzsi2.o)",
    ]
    path = tmp_path / "scenes.map"
    path.write_text("\n".join(["Linker script and memory map", "", *rows, ""]))
    assert size.linked(path) == {"libgcc": 2, "raster/list.c": 0x20}
    path.write_text("\n".join(["Linker script and memory map", "", *rows[1:], ""]))
    with pytest.raises(machines.BenchError, match=r"scenes\.map has no raster/list\.c; build it anew"):
        size.linked(path)


def test_a_text_that_is_no_map_is_refused() -> None:
    with pytest.raises(machines.BenchError, match="Linker script and memory map"):
        size.read_map("nothing")


def test_growth_beyond_the_tolerance_fails() -> None:
    assert failures(found(10300), found(10000)) == 0
    assert failures(found(10301), found(10000)) == 1
    assert failures(found(9000), found(10000)) == 0


def test_a_broken_budget_fails_whatever_the_compiler() -> None:
    budget = size.BUDGETS["all"]
    assert failures(found(budget), found(budget)) == 0
    assert failures(found(budget + 1), found(budget + 1)) == 1
    assert failures(found(budget + 1, "99.0"), found(budget)) == 1
    assert failures(found(15000, "99.0"), found(10000)) == 0


def test_what_is_not_recorded_fails() -> None:
    now = found(10000)
    now["panels"]["new"] = 1
    assert failures(now, found(10000)) == 1


def test_the_committed_figures_are_those_of_today_s_options() -> None:
    recorded = json.loads(size.RESULT.read_text(encoding="utf-8"))
    assert list(recorded["options"]) == list(size.OPTIONS)
    assert list(recorded["panels"]) == list(size.PANELS)
    for name, one in recorded["options"].items():
        assert one["total"] == sum(one["modules"].values())
        assert one["total"] <= size.BUDGETS.get(name, one["total"])
