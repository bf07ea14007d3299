"""Which stage of the renderer each executed instruction belongs to.

The line tables say which function of which file an instruction was compiled from, inlining seen through: of the chain
of functions that were merged into each other the innermost one with a stage decides. Headers have none, they work for
whoever includes them. What is called by several stages, divisions and memcpy among them, is divided among its callers
by how often each calls it.
"""

from __future__ import annotations

import bisect
import re
import subprocess
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from fnmatch import fnmatch
from functools import cache, cached_property
from pathlib import Path

from .machines import ROOT, BenchError, Core, Machines, Measured, output_of

STAGES = ("vertex", "clip", "set-up", "bin", "rows", "pixels", "sink")
REST = "rest"
"""The scene's own functions and the benchmark's."""

SHARED = None

# File, functions, stage: the first row that fits decides. Files are below the repository's root.
RULES: tuple[tuple[str, str, str | None], ...] = (
    ("firmware/src/base/fill.h", "*", "sink"),
    ("firmware/src/raster/fill.h", "el_slopes*", "rows"),
    ("firmware/src/raster/fill.h", "el_values_at", "rows"),
    ("firmware/src/*.h", "*", SHARED),
    ("firmware/src/base/*.c", "*", SHARED),
    ("firmware/src/geometry/transform.c", "*", "vertex"),
    ("firmware/src/geometry/vertex.c", "*", "vertex"),
    ("firmware/src/geometry/pose.c", "*", "vertex"),
    ("firmware/src/geometry/vector.c", "*", "vertex"),
    ("firmware/src/geometry/clip.c", "*", "clip"),
    ("firmware/src/geometry/cull.c", "*", "bin"),
    ("firmware/src/geometry/cluster.c", "*", "bin"),
    ("firmware/src/geometry/sides.c", "*", "bin"),
    ("firmware/src/frame/draw.c", "clip_triangle", "clip"),
    ("firmware/src/frame/draw.c", "seen_from_back", "clip"),
    ("firmware/src/frame/draw.c", "fan_root", "clip"),
    ("firmware/src/frame/draw.c", "fill_clipped", "clip"),
    ("firmware/src/frame/draw.c", "transform_*", "vertex"),
    ("firmware/src/frame/draw*.c", "*", "bin"),
    ("firmware/src/frame/vertices.c", "*", "vertex"),
    ("firmware/src/raster/list.c", "*", "bin"),
    ("firmware/src/raster/hidden.c", "*", "bin"),
    ("firmware/src/raster/gather.c", "*", "set-up"),
    ("firmware/src/raster/small_gouraud.c", "walk_*", "rows"),
    ("firmware/src/raster/small_gouraud.c", "move_right", "rows"),
    ("firmware/src/raster/small_gouraud.c", "down_and_back", "rows"),
    ("firmware/src/raster/small_gouraud.c", "*", "pixels"),
    ("firmware/src/raster/small_sampled.c", "el_*", "set-up"),
    ("firmware/src/raster/small_sampled_setup.c", "*", "set-up"),
    ("firmware/src/raster/small_sampled.c", "*row*", "rows"),
    ("firmware/src/raster/small_sampled.c", "draw_part*", "rows"),
    ("firmware/src/raster/small_sampled.c", "move_down*", "rows"),
    ("firmware/src/raster/small_sampled.c", "*", "pixels"),
    ("firmware/src/raster/small_triangle.c", "draw_rows", "pixels"),
    ("firmware/src/raster/small_triangle.c", "*", "set-up"),
    ("firmware/src/raster/tiny_triangle.c", "draw_rows", "pixels"),
    ("firmware/src/raster/tiny_triangle.c", "*", "set-up"),
    ("firmware/src/raster/triangle.c", "*", "set-up"),
    ("firmware/src/raster/field.c", "*", "set-up"),
    ("firmware/src/raster/wires.c", "*", "pixels"),
    ("firmware/src/raster/plane.c", "*", "set-up"),
    ("firmware/src/raster/rows.c", "*", "rows"),
    ("firmware/src/raster/spans.c", "*", "rows"),
    ("firmware/src/raster/sampled.c", "make_*", "set-up"),
    ("firmware/src/raster/sampled.c", "parts_times", "set-up"),
    ("firmware/src/raster/sampled.c", "draw_any", "set-up"),
    ("firmware/src/raster/sampled.c", "is_small", "set-up"),
    ("firmware/src/raster/sampled.c", "el_sampled_draw", "set-up"),
    ("firmware/src/raster/sampled.c", "*row*", "rows"),
    ("firmware/src/raster/sampled.c", "*", "pixels"),
    ("firmware/src/raster/samples.c", "*", "pixels"),
    ("firmware/src/raster/fill_mixed.c", "el_mixed_brush_begin", "set-up"),
    ("firmware/src/raster/fill_mixed.c", "el_*", "rows"),
    ("firmware/src/raster/stripes.c", "*", "pixels"),
    ("firmware/src/raster/fill*.c", "*", "pixels"),
    ("firmware/src/raster/texel_*.c", "*", "pixels"),
    ("firmware/src/raster/sampler.c", "*make*", "set-up"),
    ("firmware/src/raster/sampler.c", "*", "pixels"),
    ("firmware/src/raster/texture.c", "el_mip_level", "set-up"),
    ("firmware/src/raster/texture.c", "*", "bin"),
    ("firmware/src/raster/texture_walk.c", "*", "pixels"),
    ("firmware/src/raster/depth_row.c", "*", "pixels"),
    ("firmware/src/frame/bands.c", "open_band", "sink"),
    ("firmware/src/frame/bands.c", "el_bands_complete", "sink"),
    ("firmware/src/frame/bands.c", "*wait_for*", "sink"),
    ("firmware/src/frame/bands.c", "*hand_over", "sink"),
    ("firmware/src/frame/bands.c", "*", "bin"),
    ("firmware/src/frame/painter*.c", "*", "bin"),
    ("firmware/src/frame/workers.c", "*", "bin"),
    ("firmware/src/frame/debug_view.c", "*", "bin"),
    ("firmware/src/frame/renderer.c", "*", "sink"),
    ("firmware/src/frame/quiet.c", "*", "sink"),
    ("firmware/src/geometry/aim.c", "*", REST),
    ("firmware/src/geometry/animation.c", "*", REST),
    ("firmware/src/geometry/arrow.c", "*", REST),
    ("firmware/src/geometry/detail.c", "*", REST),
    ("firmware/src/geometry/elm*.c", "*", REST),
    ("firmware/src/geometry/hierarchy.c", "*", REST),
    ("firmware/src/geometry/lights.c", "*", REST),
    ("firmware/src/geometry/orbit.c", "*", REST),
    ("firmware/src/geometry/quaternion.c", "*", REST),
    ("firmware/src/frame/pick.c", "*", REST),
    ("firmware/src/raster/fog.c", "*", REST),
    ("firmware/src/scene/*", "*", REST),
    ("firmware/src/canvas/*", "*", REST),
    ("firmware/apps/*", "*", REST),
    ("sim/*", "*", REST),
    ("tests/bench/*", "*", REST),
)

Counts = dict[str, int]


@dataclass(frozen=True)
class Place:
    """A function, and its file as the compiler names it; "??" where it is a library's."""

    function: str
    file: str

    @cache  # noqa: B019 (few places, asked for by hundred thousands of instructions)
    def rule(self) -> tuple[str, str, str | None] | None:
        """The row of RULES; None for what is not the project's."""
        path = Path(self.file)
        if not path.is_relative_to(ROOT):
            return None
        name = str(path.relative_to(ROOT))
        # Clones have suffixes: fan_root.part.0.
        function = self.function.split(".", maxsplit=1)[0]
        for rule in RULES:
            if fnmatch(name, rule[0]) and fnmatch(function, rule[1]):
                return rule
        here = Path(__file__).relative_to(ROOT)
        raise BenchError(f"{self.function} of {name} belongs to no stage; say in RULES of {here} to which")


def stage_of(chain: Iterable[Place]) -> str | None:
    """The stage of an instruction by its functions, the innermost first; None when all of them are shared."""
    for place in chain:
        rule = place.rule()
        if rule is not None and rule[2] is not SHARED:
            return rule[2]
    return None


class Program:
    """What a program's file says of its instructions."""

    def __init__(self, core: Core, elf: Path) -> None:
        self.core = core
        self.elf = elf
        self._stages: dict[int, str | None] = {}

    @cached_property
    def functions(self) -> list[tuple[int, str]]:
        """In the order of their addresses."""
        rows = [row.split() for row in output_of([self.core.tool("nm"), self.elf]).splitlines()]
        return sorted((int(row[0], 16) & ~1, row[2]) for row in rows if len(row) == 3 and row[1] in "tTwW")

    @cached_property
    def _starts(self) -> list[int]:
        return [address for address, _ in self.functions]

    def function_at(self, address: int) -> int:
        """Where the function begins that has that instruction."""
        return self._starts[bisect.bisect_right(self._starts, address) - 1]

    @cached_property
    def calls(self) -> dict[int, list[int]]:
        """By where a function begins: the instructions elsewhere that branch there."""
        found: dict[int, list[int]] = {}
        row = re.compile(r"^ *([0-9a-f]+):\t.*\t[^;#@]*\b([0-9a-f]+) <[^+>]+>")
        for text in output_of([self.core.tool("objdump"), "-d", "--no-show-raw-insn", self.elf]).splitlines():
            if (match := row.match(text)) is not None:
                at, target = int(match[1], 16), int(match[2], 16)
                if self.function_at(at) != target:
                    found.setdefault(target, []).append(at)
        return found

    def _learn(self, addresses: Iterable[int]) -> None:
        """Looks the stages of instructions up that are not known yet."""
        unknown = [address for address in addresses if address not in self._stages]
        if not unknown:
            return
        command = [self.core.tool("addr2line"), "-a", "-i", "-f", "-e", str(self.elf)]
        asked = "\n".join(f"{address:x}" for address in unknown)
        said = subprocess.run(command, input=asked, capture_output=True, text=True, check=True).stdout
        parts = re.split(r"^0x[0-9a-f]+\n", said, flags=re.MULTILINE)[1:]
        for address, part in zip(unknown, parts, strict=True):
            rows = part.splitlines()
            chain = [Place(name, place.rsplit(":", 1)[0]) for name, place in zip(rows[::2], rows[1::2], strict=True)]
            self._stages[address] = stage_of(chain)

    def split(self, counts: Mapping[int, int]) -> Counts:
        """Executed instructions by stage, from those of each address."""
        self._learn(counts)
        found: Counter[str] = Counter(dict.fromkeys((*STAGES, REST), 0))
        shared: Counter[int] = Counter()
        for address, count in counts.items():
            stage = self._stages[address]
            if stage is None:
                shared[self.function_at(address)] += count
            else:
                found[stage] += count
        callers = _Callers(self, counts)
        for function, count in shared.items():
            parts = callers.of(function)
            for stage, share in parts.items():
                found[stage] += round(count * share)
        # What rounding has lost or made.
        found[REST] += sum(counts.values()) - sum(found.values())
        return dict(found)

    def by_function(self, counts: Mapping[int, int]) -> dict[str, int]:
        """Executed instructions by function, most first; inlined ones count for their caller."""
        names = dict(self.functions)
        found: Counter[str] = Counter()
        for address, count in counts.items():
            found[names[self.function_at(address)]] += count
        return dict(found.most_common())

    def stage_at(self, address: int) -> str | None:
        return self._stages[address]


class _Callers:
    """By stage, which share of a shared function's calls come from it, in one measurement."""

    def __init__(self, program: Program, counts: Mapping[int, int]) -> None:
        self.program = program
        self.counts = counts
        self._known: dict[int, dict[str, float]] = {}

    def of(self, function: int) -> dict[str, float]:
        if function not in self._known:
            self._known[function] = {REST: 1.0}  # for functions that call themselves
            self._known[function] = self._find(function)
        return self._known[function]

    def _find(self, function: int) -> dict[str, float]:
        weights: Counter[str] = Counter()
        for at in self.program.calls.get(function, []):
            if at not in self.counts:
                continue
            stage = self.program.stage_at(at)
            parts = {stage: 1.0} if stage is not None else self.of(self.program.function_at(at))
            for name, share in parts.items():
                weights[name] += self.counts[at] * share  # type: ignore[assignment]
        total = sum(weights.values())
        if total == 0:
            name = dict(self.program.functions)[function]
            raise BenchError(f"{self.program.elf.name}: {name} is executed, but nothing that was executed calls it")
        return {stage: weight / total for stage, weight in weights.items()}


def profile(machines: Machines, core: str, program: str, bits: int = 4) -> tuple[list[Measured], list[dict[int, int]]]:
    """A program's measurements on a core, and each one's executed instructions by address."""
    return profile_of(machines, core, machines.build(core, program, bits))


def profile_of(machines: Machines, core: str, elf: Path) -> tuple[list[Measured], list[dict[int, int]]]:
    """The same of a program that is built already."""
    path = elf.with_suffix(".profile")
    measured = machines.run(core, elf, path)
    profiles = read_profile(path.read_text(encoding="ascii"))
    if len(profiles) != len(measured):
        raise BenchError(f"{core}: {len(measured)} measurements, {len(profiles)} profiles")
    return measured, profiles


def read_profile(text: str) -> list[dict[int, int]]:
    """The plugin's profile: for each measurement the executed instructions of each address. Start-up and the empty
    measurement, which come first, are left out."""
    found = []
    for part in text.split("next\n")[2:-1]:
        rows = (row.split() for row in part.splitlines())
        found.append({int(address, 16): int(count) for address, count in rows})
    return found
