"""Each executed instruction belongs to the stage of the function that it was written in, whoever it was merged into;
what is shared is divided among its callers; and a function that nobody has sorted is told."""

from __future__ import annotations

import re
import sys
from fnmatch import fnmatch
from pathlib import Path

import pytest

BENCH = Path(__file__).parents[1] / "bench"
sys.path.insert(0, str(BENCH))

from bench_tool import machines, stages  # noqa: E402

SOURCES = machines.ROOT / "firmware" / "src"


def place(function: str, file: str) -> stages.Place:
    return stages.Place(function, str(SOURCES / file))


def test_the_innermost_function_with_a_stage_decides() -> None:
    helper = place("el_min_i32", "base/fixed.h")
    assert stages.stage_of([helper, place("el_clip_polygon", "geometry/clip.c")]) == "clip"
    assert stages.stage_of([place("try_triangle", "frame/draw.c"), place("clip_triangle", "frame/draw.c")]) == "bin"
    assert stages.stage_of([helper, place("clip_triangle.constprop.0", "frame/draw.c")]) == "clip"
    assert stages.stage_of([place("el_fill_u16", "base/fill.h"), place("el_list_clear", "raster/list.c")]) == "sink"


def test_what_is_all_shared_has_none() -> None:
    assert stages.stage_of([stages.Place("memcpy", "??")]) is None
    assert stages.stage_of([stages.Place("__udivsi3", "/build/gcc/libgcc/config/arm/lib1funcs.S")]) is None
    assert stages.stage_of([place("el_divide_u64", "base/divide.c")]) is None


def test_a_function_that_nobody_sorted_is_told() -> None:
    with pytest.raises(machines.BenchError, match=r"new_one of firmware/src/raster/new\.c belongs to no stage"):
        stages.stage_of([place("new_one", "raster/new.c")])


@pytest.mark.parametrize("file", sorted(str(one.relative_to(SOURCES)) for one in SOURCES.glob("*/*.c")))
def test_every_file_of_the_renderer_is_sorted(file: str) -> None:
    if not file.startswith(("panel/", "stream/")):
        assert place("any", file).rule() is not None


def functions_of(text: str) -> list[str]:
    """The functions that a source file defines: their heads begin a line, and a brace alone follows."""
    heads = re.findall(r"^(?:\w[^;{}()#]*?[ *])(\w+)\([^;{}]*\)\n\{", text, flags=re.MULTILINE)
    return [name for name in heads if not name.startswith("__")]


FUNCTIONS = {
    str(file.relative_to(machines.ROOT)): functions_of(file.read_text("utf-8"))
    for file in sorted((*SOURCES.glob("*/*.c"), *SOURCES.glob("*/*.h")))
}


def test_functions_are_found_in_sources() -> None:
    text = (
        "static EL_APART void two(int a,\n  int b)\n{\n    if (a) {\n    }\n}\n\nint *one(void)\n{\n}\nint no(void);\n"
    )
    assert functions_of(text) == ["two", "one"]
    assert {"walk_sides", "el_small_gouraud_draw"} <= set(FUNCTIONS["firmware/src/raster/small_gouraud.c"])


def test_every_rule_has_functions() -> None:
    """A rule for functions that are called otherwise by now would leave them to the next one unseen."""
    for pattern, function, _ in stages.RULES:
        if function != "*":
            names = [name for file, found in FUNCTIONS.items() if fnmatch(file, pattern) for name in found]
            assert any(fnmatch(name, function) for name in names), f"{function} of {pattern}"


@pytest.mark.parametrize(
    ("file", "function", "stage"),
    [
        ("raster/small_gouraud.c", "walk_sides", "rows"),
        ("raster/small_gouraud.c", "move_right", "rows"),
        ("raster/small_gouraud.c", "el_small_gouraud_draw", "pixels"),
        ("raster/small_triangle.c", "draw_rows", "pixels"),
        ("raster/small_triangle.c", "el_small_triangle_draw", "set-up"),
        ("raster/small_sampled_setup.c", "el_small_sampled_setup", "set-up"),
        ("raster/small_sampled.c", "draw_mixed", "pixels"),
        ("raster/sampled.c", "make_edges", "set-up"),
        ("raster/sampled.c", "sample_row", "rows"),
        ("raster/sampled.c", "draw_inner", "pixels"),
        ("raster/samples.c", "resolve_all", "pixels"),
        ("raster/fill_mixed.c", "el_mixed_brush_begin", "set-up"),
        ("raster/fill_mixed.c", "draw_pixel", "pixels"),
        ("raster/sampler.c", "el_sampler_make", "set-up"),
        ("raster/sampler.c", "el_sampler_at", "pixels"),
        ("raster/texture.c", "el_mip_level", "set-up"),
        ("raster/fog.c", "make_table", "rest"),
        ("geometry/lights.c", "el_light_vertices", "rest"),
        ("geometry/arrow.c", "el_arrow_measure", "rest"),
    ],
)
def test_functions_are_sorted_by_what_they_do(file: str, function: str, stage: str) -> None:
    assert function in FUNCTIONS[f"firmware/src/{file}"]
    assert stages.stage_of([place(function, file)]) == stage


def test_every_rule_names_a_stage() -> None:
    assert {stage for _, _, stage in stages.RULES} == {*stages.STAGES, stages.REST, stages.SHARED}


class Known(stages.Program):
    """A program with two functions of stages, at 0 and 100; a division at 200 that both call; at 300 what it calls."""

    def __init__(self) -> None:
        super().__init__(machines.CORES["cortex-m0plus"], Path("known.elf"))
        self.functions = [(0, "vertex"), (100, "setup"), (200, "divide"), (300, "clz"), (400, "never")]
        self.calls = {200: [10, 110, 120], 300: [210]}
        stage = {0: "vertex", 100: "set-up"}
        self._stages = {at: stage.get(at // 100 * 100) for at in range(500)}


def test_shared_functions_are_divided_by_calls() -> None:
    # 10 calls from the one stage, 20 and 10 from the other.
    counts = {10: 10, 110: 20, 120: 10, 210: 40, 211: 40, 300: 400}
    found = Known().split(counts)
    assert found["vertex"] == 10 + 80 / 4 + 400 / 4
    assert found["set-up"] == 30 + 80 * 3 / 4 + 400 * 3 / 4
    assert sum(found.values()) == sum(counts.values())


def test_calls_that_were_not_executed_do_not_count() -> None:
    assert Known().split({110: 5, 200: 50})["set-up"] == 55


def test_what_nobody_calls_is_told() -> None:
    with pytest.raises(machines.BenchError, match="never is executed, but nothing that was executed calls it"):
        Known().split({400: 1})


def test_a_profile_begins_after_the_empty_measurement() -> None:
    text = "0 9\nnext\n2 8\nnext\n1a 7\n1c 6\nnext\n2 5\nnext\n"
    assert stages.read_profile(text) == [{0x1A: 7, 0x1C: 6}, {2: 5}]
