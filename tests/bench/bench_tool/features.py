"""What each feature costs where it is not used, and where it is.

An option of base/options.h: bytes of code and RAM with and without, and what the standard scenes take more with it
compiled in, by stage. The builds differ by that option alone, and each file is compiled once for all builds to which it
is the same. A module that nobody calls is not linked at all; of those, bytes. And what using a feature takes on a scene
(uses.c), beside the same scene without.
"""

from __future__ import annotations

import re
import tempfile
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .frames import Verdicts, measure_alike
from .machines import BENCH, BOARDS, CORES, MAIN_CORES, ROOT, BenchError, Line, Machines, output_of
from .size import CPU, PROGRAM, RENDERER, Compiler
from .stages import REST, Program, profile_of

SCENES = ("S1", "S2", "S2-no-depth", "S3", "S4")
TEXTURED = ("S2", "S2-no-depth")


@dataclass(frozen=True)
class Option:
    """An EL_WITH_ of base/options.h, and the standard scenes that use it."""

    name: str
    title: str
    used_by: tuple[str, ...] = ()


OPTIONS = (
    Option("GOURAUD", "vertex colours", ("S1",)),
    Option("TEXTURE", "textures", TEXTURED),
    Option("LIGHT", "a light per material"),
    Option("DITHER", "dithering"),
    Option("OVERDRAW", "overdraw shading"),
    Option("ORTHOGRAPHIC", "orthographic cameras"),
    Option("STATS", "work counters", SCENES),
    Option("CARRY", "set-up kept from band to band", SCENES),
    Option("THIN", "short records for full lists"),
    Option("CLUSTERS", "clusters"),
    Option("HIDDEN", "hidden triangles", SCENES),
    Option("PREPASS", "depth pre-pass"),
    Option("WORKERS", "several cores"),
    Option("REUSE", "unchanged frames and bands"),
    Option("MIXED", "blending, fog, images as textures"),
    Option("MIPMAPS", "mipmaps"),
    Option("SAMPLES", "4 and 8 samples per pixel"),
    Option("DEBUG_VIEWS", "debug views"),
)

# What is linked only where it is called: functions that bring all of it.
MODULES: dict[str, tuple[str, ...]] = {
    "lamps": ("el_light_vertices", "el_light_triangles"),
    "fog's tables": ("el_fog_linear", "el_fog_exponential"),
    "picking": ("el_pick_begin", "el_pick_draw", "el_pick_end"),
    "instances": ("el_instances_draw",),
    "quaternions": ("el_quaternion_about", "el_quaternion_slerp", "el_quaternion_to_rotation"),
    "look-at, billboards": ("el_pose_look_at", "el_billboard_face", "el_billboard_about"),
    "orbit camera": ("el_orbit_camera_at", "el_orbit_camera_turn", "el_orbit_camera_zoom", "el_orbit_camera_place"),
    "animation": ("el_animation_pose",),
    "hierarchy": ("el_hierarchy_update",),
    "level of detail": ("el_level_choose", "el_screen_size_q4"),
    "canvas: fills, lines": ("el_canvas_fill", "el_canvas_frame", "el_canvas_line"),
    "canvas: polygons": ("el_polygon_begin", "el_polygon_line", "el_polygon_fill"),
    "canvas: polygons, shapes, strokes": ("el_polygon_ellipse", "el_polygon_fill", "el_polygon_stroke"),
    "canvas: images": ("el_canvas_image",),
    "canvas: images, turned": ("el_canvas_image", "el_canvas_image_turned"),
    "canvas: text": ("el_canvas_text",),
}
LAYERS = (*RENDERER, "scene", "canvas")

# Bytes of a 320x240 screen in bands of 8 lines, as C has them: the program's own, and what a feature's user adds.
OWN_MEMORY = {"renderer": "sizeof(el_renderer)", "arena": "EL_MEMORY_BYTES(320, 240, 8, 1000, 1000, 10)"}
USED_MEMORY = {
    "4 samples": "EL_SAMPLES_BYTES(320, 8, 4)",
    "8 samples": "EL_SAMPLES_BYTES(320, 8, 8)",
    "a second core": "EL_WORKERS_BYTES(320, 240, 8, 2)",
    "fog, a table": "sizeof(el_fog)",
    "lamps, per vertex or triangle": "3",
    "picking": "EL_PICK_BYTES(320, 240)",
    "a polygon of 100 edges": "EL_POLYGON_BYTES(100, 320)",
}

SMALL, FAST = "small", "fast"
"""-Os for a Cortex-M0+, -O2 for a Cortex-M4F."""

# Parts of what a scene takes: by pixel, by row, by triangle or vertex, by band or frame.
PARTS = {
    "pixels": ("pixels",),
    "rows": ("rows",),
    "triangles": ("vertex", "clip", "set-up", "bin"),
    "frame": ("sink", REST),
}


# An instruction more in the loop over pixels is one for each or, where a loop draws several at a time, one for several;
# in that over rows it is one for each: so many times what a scene takes more must be below what it has. Less than that
# is taken where a fill or a piece of a texture begins.
LIMITS = {"pixels": 10, "rows": 1}


def compiler_of(core: str, optimise: str, folder: Path) -> Compiler:
    """With the core's flags as its toolchain file has them."""
    text = (BOARDS / "cortex_m" / "arm-none-eabi.cmake").read_text(encoding="utf-8")
    found = re.search(rf"set\(edgeline_cpu_{core} (.+)\)", text)
    if found is None:
        raise BenchError(f"arm-none-eabi.cmake has no edgeline_cpu_{core}")
    folder.mkdir()
    return Compiler(folder, (*found[1].split(), optimise, "-g"))


def _bytes(compiler: Compiler, name: str, memory: Mapping[str, str], options: Mapping[str, int] | None = None) -> Any:
    """What C says of `memory`, from the sizes of arrays that are never linked."""
    source = compiler.folder / f"{name}.c"
    arrays = [f"char memory_{i}[{size}];" for i, size in enumerate(memory.values())]
    source.write_text("\n".join(['#include "edgeline.h"', *arrays, ""]), encoding="ascii")
    symbols = output_of([CORES[CPU].tool("nm"), "-S", compiler.compile(source, options)])
    sizes = {int(i): int(size, 16) for size, i in re.findall(r" ([0-9a-f]+) [BCb] memory_(\d+)$", symbols, re.M)}
    return {key: sizes[i] for i, key in enumerate(memory)}


class Build:
    """A compiler, and what base/options.h has there unless it is asked for otherwise."""

    def __init__(self, compiler: Compiler) -> None:
        self.compiler = compiler
        # Arrays have a byte at least.
        sizes = _bytes(compiler, "defaults", {option.name: f"1 + EL_WITH_{option.name}" for option in OPTIONS})
        self.defaults = {name: size - 1 for name, size in sizes.items()}

    def options(self, name: str, value: int) -> dict[str, int]:
        """None where the option has that value by itself."""
        return {} if self.defaults[name] == value else {name: value}

    def sizes(self, options: Mapping[str, int]) -> dict[str, int]:
        """Bytes of the renderer."""
        name = "-".join(["build", *(f"{option}-{value}" for option, value in options.items())])
        code = self.compiler.link(name, PROGRAM, RENDERER, options).total
        return {"code": code, **_bytes(self.compiler, f"{name}-memory", OWN_MEMORY, options)}


def _measure_options(build: Build) -> dict[str, dict[str, Any]]:
    """With and without each option, and whether the build has it by itself."""
    with ThreadPoolExecutor(2) as pool:
        usual = pool.submit(build.sizes, {})
        others = {
            option.name: pool.submit(build.sizes, {option.name: 1 - build.defaults[option.name]}) for option in OPTIONS
        }
        found = {}
        for name, other in others.items():
            pair = (usual.result(), other.result())
            with_it, without = pair if build.defaults[name] else pair[::-1]
            found[name] = {"on": bool(build.defaults[name]), "with": with_it, "without": without}
        return found


def _measure_modules(build: Build) -> dict[str, int]:
    """Of each module, where fog can be drawn: small code is told that it can."""
    options = build.options("MIXED", 1)
    with ThreadPoolExecutor(2) as pool:
        base = pool.submit(build.compiler.link, "modules", PROGRAM, LAYERS, options)
        linked = {
            name: pool.submit(build.compiler.link, f"module-{i}", PROGRAM, LAYERS, options, calls)
            for i, (name, calls) in enumerate(MODULES.items())
        }
        return {name: one.result().total - base.result().total for name, one in linked.items()}


def measure_bytes(small: Build, fast: Build) -> dict[str, Any]:
    """Of each option with and without; of each module; and the memory of their users."""
    builds = {SMALL: small, FAST: fast}
    options = {kind: _measure_options(build) for kind, build in builds.items()}
    modules = {kind: _measure_modules(build) for kind, build in builds.items()}
    any_option = {kind: pairs[OPTIONS[0].name] for kind, pairs in options.items()}
    return {
        "defaults": {kind: pair["with" if pair["on"] else "without"] for kind, pair in any_option.items()},
        "options": {option.name: {kind: options[kind][option.name] for kind in builds} for option in OPTIONS},
        "modules": {name: {kind: modules[kind][name] for kind in builds} for name in MODULES},
        "memory": _bytes(fast.compiler, "used", USED_MEMORY),
    }


@dataclass(frozen=True)
class Drawn:
    """A scene as a build has drawn it: what was printed, and instructions by part."""

    line: Line
    parts: dict[str, int]


class Standard:
    """The standard scenes on a core, with options."""

    def __init__(self, machines: Machines, core: str, build: Build) -> None:
        self.machines = machines
        self.core = core
        self.build = build
        self._known: dict[tuple[Path, ...], dict[str, Drawn]] = {}

    def measure(self, options: Mapping[str, int]) -> dict[str, Drawn]:
        """The scenes that can be drawn. What compiles to the same is measured once."""
        compiler = self.build.compiler
        semihost = ROOT / "tests" / "target" / "semihost"
        include = (BENCH, ROOT / "firmware" / "apps", semihost, BOARDS / "cortex_m")
        own = [BENCH / "standard.c", BENCH / "frame.c", BENCH / "platform_text.c", BENCH / "target" / "platform.c"]
        own += [include[1] / "scene.c", include[1] / "bench" / "bench_scenes.c"]
        own += [semihost / "semihost.c", BOARDS / "cortex_m" / "start.c"]
        objects = {f"{i}.o": compiler.compile(file, options, include) for i, file in enumerate(own)}
        objects |= compiler.objects(RENDERER, options)
        known = tuple(objects.values())
        if known not in self._known:
            elf = compiler.folder / f"standard-{len(self._known)}" / "standard.elf"
            elf.parent.mkdir()
            # The memory of mps2-an385 and mps2-an386, as semihost/CMakeLists.txt has it.
            memory = ["-Wl,--defsym=el_code=0", "-Wl,--defsym=el_ram=0x21000000", f"-Wl,-T,{semihost / 'mps2.ld'}"]
            compiler.program(elf, objects, memory)
            self._known[known] = self._run(elf)
        return self._known[known]

    def _run(self, elf: Path) -> dict[str, Drawn]:
        measured, profiles = profile_of(self.machines, self.core, elf)
        program = Program(CORES[self.core], elf)
        found = {}
        for one, counts in zip(measured, profiles, strict=True):
            if one.line.values["status"] == "0":
                split = program.split(counts)
                split[REST] += one.instructions - sum(split.values())
                parts = {part: sum(split[stage] for stage in stages) for part, stages in PARTS.items()}
                found[one.line.words[0]] = Drawn(one.line, parts)
        return found


Parts = dict[str, int]
Unused = dict[str, dict[str, dict[str, Parts]]]
"""By option, core and scene: instructions with it less those without."""


def _more(
    what: str, with_it: Mapping[str, Drawn], without: Mapping[str, Drawn], verdicts: Verdicts
) -> dict[str, Parts]:
    """Of each scene that both draw, which must be the same picture."""
    for scene, there in without.items():
        crcs = with_it[scene].line.crc, there.line.crc
        verdicts.check(crcs[0] == crcs[1], f"{scene} is {crcs[0]} with {what}, {crcs[1]} without")
    return {
        scene: {part: with_it[scene].parts[part] - there.parts[part] for part in PARTS}
        for scene, there in without.items()
    }


def _rows_and_pixels(usual: Mapping[str, Drawn]) -> dict[str, Parts]:
    return {scene: {part: int(one.line.values[part]) for part in ("rows", "pixels")} for scene, one in usual.items()}


def measure_unused(standards: Mapping[str, Standard], verdicts: Verdicts) -> tuple[Unused, dict[str, Parts]]:
    """Of all options; and the scenes' rows and pixels."""
    found: Unused = {option.name: {} for option in OPTIONS}
    drawn: dict[str, Parts] = {}
    for core, standard in standards.items():
        for option in OPTIONS:
            with_it, without = (standard.measure(standard.build.options(option.name, value)) for value in (1, 0))
            found[option.name][core] = _more(f"EL_WITH_{option.name} on {core}", with_it, without, verdicts)
        drawn = _rows_and_pixels(standard.measure({}))
    return found, drawn


def check_quickly(machines: Machines, verdicts: Verdicts) -> None:
    """All options at once that no standard scene uses, on one core."""
    core = "cortex-m4f"
    with tempfile.TemporaryDirectory() as name:
        standard = Standard(machines, core, Build(compiler_of(core, "-O2", Path(name) / core)))
        usual = standard.measure({})
        least = standard.measure({option.name: 0 for option in OPTIONS if not option.used_by})
        more = _more(f"all options on {core}", usual, least, verdicts)
    check({"...": {core: more}}, _rows_and_pixels(usual), verdicts)


def measure_small(standards: Mapping[str, Standard], small: Mapping[str, Standard], verdicts: Verdicts) -> Any:
    """By core and scene, the instructions of -O2 and of -Os, which must make the same picture."""
    found: dict[str, dict[str, list[int]]] = {core: {} for core in standards}
    for core, standard in standards.items():
        there = small[core].measure({})
        for scene, here in standard.measure({}).items():
            crc = there[scene].line.crc
            verdicts.check(crc == here.line.crc, f"{scene} on {core} is {crc} with -Os, {here.line.crc} with -O2")
            found[core][scene] = [sum(one.parts.values()) for one in (here, there[scene])]
    return found


def measure_uses(machines: Machines, verdicts: Verdicts) -> list[dict[str, Any]]:
    """What uses.c draws, on the main cores."""
    return [
        {
            "name": line.words[0],
            "plain": line.words[1],
            "unit": line.words[2],
            "count": int(line.values["count"]),
            "instructions": counts,
        }
        for line, counts in measure_alike(machines, "uses", verdicts)
    ]


def measure(machines: Machines, verdicts: Verdicts) -> dict[str, Any]:
    """All of it, as features.json has it."""
    with tempfile.TemporaryDirectory() as name:
        fast, small = (
            {core: Build(compiler_of(core, optimise, Path(name) / f"{core}{optimise}")) for core in MAIN_CORES}
            for optimise in ("-O2", "-Os")
        )
        found = measure_bytes(small[CPU], fast["cortex-m4f"])
        standards, small_ones = (
            {core: Standard(machines, core, build) for core, build in builds.items()} for builds in (fast, small)
        )
        unused, drawn = measure_unused(standards, verdicts)
        of_small = measure_small(standards, small_ones, verdicts)
    check(unused, drawn, verdicts)
    uses = measure_uses(machines, verdicts)
    return {**found, "unused": unused, "drawn": drawn, "small": of_small, "uses": uses}


def check(
    unused: Mapping[str, Mapping[str, Mapping[str, Mapping[str, int]]]],
    drawn: Mapping[str, Mapping[str, int]],
    verdicts: Verdicts,
) -> None:
    """No option costs an instruction in a loop over another's pixels or rows."""
    used_by = {option.name: option.used_by for option in OPTIONS}
    for name, cores in unused.items():
        for core, scenes in cores.items():
            for scene, more in scenes.items():
                if scene not in used_by.get(name, ()):
                    for part, limit in LIMITS.items():
                        verdicts.check(
                            more[part] * limit < drawn[scene][part],
                            f"EL_WITH_{name} costs {scene} on {core} {more[part]:,} instructions by its {part}, of "
                            f"which it has {drawn[scene][part]:,}",
                        )
