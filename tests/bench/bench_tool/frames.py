"""Whole frames: measured on each core, proven equal to the simulator's, and compared with what was recorded."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from .machines import CORES, MAIN_CORES, BenchError, Line, Machines, output_of
from .models import SCENES as MODEL_SCENES
from .stages import REST, STAGES, Program, profile

# Figures may be so much worse than the recorded ones before somebody must look and record anew.
TOLERANCE = 0.03

RECORD = "tests/bench/run --record-scenes"

# The best peer that draws the same, in million instructions: TGX 1.1.4, small3dlib and TinyGL, compiled and counted in
# the same way. small3dlib's S2 has errors of 31 to 89 texels, its S4 one depth per triangle.
PEERS = {
    "cortex-m0plus": {
        "S1": (5.05, "small3dlib"),
        "S2": (23.2, "TinyGL"),
        "S2-no-depth": (12.0, "small3dlib"),
        "S3": (18.6, "small3dlib"),
        "S4": (5.09, "small3dlib"),
    },
    "cortex-m4f": {
        "S1": (1.07, "TGX"),
        "S2": (3.19, "TGX"),
        "S2-no-depth": (2.20, "TGX"),
        "S3": (5.43, "TGX"),
        "S4": (2.33, "small3dlib"),
    },
    "cortex-m7": {
        "S1": (1.02, "TGX"),
        "S2": (3.18, "TGX"),
        "S2-no-depth": (2.19, "TGX"),
        "S3": (4.74, "TGX"),
        "S4": (2.37, "small3dlib"),
    },
}

# What the renderer is to reach, in million instructions, with 130 KB.
TARGETS = {
    "cortex-m0plus": {"S1": 0.9, "S2": 2.4, "S2-no-depth": 1.9, "S3": 4.3, "S4": 1.1},
    "cortex-m4f": {"S1": 0.45, "S2": 1.3, "S2-no-depth": 1.0, "S3": 2.2, "S4": 0.55},
}


# Of the arena, all the time.
FIXED_PARTS = ("colour", "depth", "bins", "list")

# Scenes that are the same picture.
EQUAL = (
    ("teapot", "teapot-again"),
    ("layers-front-to-back", "layers-back-to-front"),
    ("sheets-front-to-back", "sheets-back-to-front"),
    ("layers-back-to-front", "layers-back-to-front-prepass"),
    ("sheets-back-to-front", "sheets-back-to-front-prepass"),
    ("lit-back-to-front", "lit-back-to-front-prepass"),
    ("S4", "S4-clusters"),
    ("model-teapot", "model-teapot-whole"),
)


@dataclass(frozen=True)
class Frame:
    """One frame of a scene in one configuration. Memory is that of a 32-bit core: `ram` has the arena's parts, in which
    vertices, as far as they do not fit the depth band, and later states of triangles lie in the same place; states are
    0 when they take no more than vertices did."""

    scene: str
    arena_bytes: int
    uv_error_log2: int
    number: int
    subpixel_bits: int
    crc: str
    passes: int
    ram: dict[str, int]
    native_us: float
    instructions: dict[str, int]
    stages: dict[str, dict[str, int]]

    @property
    def key(self) -> tuple[str, int, int, int, int]:
        return self.scene, self.arena_bytes, self.uv_error_log2, self.number, self.subpixel_bits

    @property
    def memory_peak(self) -> int:
        fixed = (self.ram[part] for part in FIXED_PARTS)
        return sum(fixed) + max(self.ram["vertices"], self.ram["states"])

    @property
    def title(self) -> str:
        extras = [f"arena {self.arena_bytes // 1024} KB", f"texture error 1/{1 << self.uv_error_log2}"]
        extras += [f"{self.subpixel_bits} sub-pixel bits"] if self.subpixel_bits != 4 else []
        return f"{self.scene} frame {self.number} ({', '.join(extras)})"


@dataclass
class Verdicts:
    """Checks passed and failed; a failure is printed at once."""

    passed: int = 0
    failed: int = 0
    better: int = 0

    def check(self, good: bool, message: str) -> None:
        if good:
            self.passed += 1
        else:
            self.failed += 1
            print(f"FAIL {message}")

    def compare(self, what: str, now: float, recorded: float, command: str) -> None:
        """A figure, of which less is better, against the recorded one; it may be TOLERANCE worse. One that is better by
        more is told."""
        self.check(
            now <= recorded * (1 + TOLERANCE),
            f"{what}: {now:,}, recorded are {recorded:,} ({_change(now, recorded)}, {TOLERANCE:.0%} may be); if it is "
            f"meant, run {command} and commit tests/bench/results",
        )
        if now < recorded * (1 - TOLERANCE):
            self.better += 1
            print(f"better {what}: {now:,}, recorded are {recorded:,} ({_change(now, recorded)}); record it: {command}")


def _change(now: float, recorded: float) -> str:
    return f"{now / recorded - 1:+.1%}" if recorded > 0 else "new"


def measure(machines: Machines, verdicts: Verdicts, cores: Sequence[str] = tuple(CORES), bits: int = 4) -> list[Frame]:
    """All frames on the cores. Each core's picture must be the native build's, and with 4 bits the simulator's."""
    native = [line for line in machines.native("scenes", bits=bits) if line.words[0] != "empty"]
    lines: list[Line] = []
    counts: list[dict[str, int]] = [{} for _ in native]
    splits: list[dict[str, dict[str, int]]] = [{} for _ in native]
    for core in cores:
        found, profiles = profile(machines, core, "scenes", bits)
        if len(found) != len(native):
            raise BenchError(f"{core} drew {len(found)} frames, this computer {len(native)}")
        program = Program(CORES[core], machines.build(core, "scenes", bits))
        for index, (here, there) in enumerate(zip(native, found, strict=True)):
            verdicts.check(
                there.line.words == here.words and there.line.crc == here.crc,
                f"{core} draws {' '.join(there.line.words)} as {there.line.crc}, this computer as {here.crc}",
            )
            counts[index][core] = there.instructions
            splits[index][core] = program.split(profiles[index])
        lines = [one.line for one in found]
    frames = [
        _frame(line, here, bits, count, split)
        for line, here, count, split in zip(lines, native, counts, splits, strict=True)
    ]
    if missing := [scene for scene in MODEL_SCENES if scene not in {frame.scene for frame in frames}]:
        print(f"not measured, shared/models is not beside the repository: {', '.join(missing)}")
    _compare_with_each_other(frames, verdicts)
    if bits == 4:
        compare_with_simulator(machines, frames, verdicts)
    return frames


def measure_alike(machines: Machines, program: str, verdicts: Verdicts) -> list[tuple[Line, dict[str, int]]]:
    """A program's measurements on the main cores, each with its instructions by core. What is printed, pictures' CRCs
    among it, must be the same on each of them and on this computer."""
    native = [line for line in machines.native(program) if line.words[0] != "empty"]
    counts: list[dict[str, int]] = [{} for _ in native]
    for core in MAIN_CORES:
        found = machines.target(core, program)
        if len(found) != len(native):
            raise BenchError(f"{program}: {core} measured {len(found)} times, this computer {len(native)}")
        for here, there, count in zip(native, found, counts, strict=True):
            verdicts.check(there.line == here, f"{program}: {core} says {there.line}, this computer {here}")
            count[core] = there.instructions
    return list(zip(native, counts, strict=True))


def _frame(line: Line, native: Line, bits: int, counts: dict[str, int], splits: dict[str, dict[str, int]]) -> Frame:
    scene, arena_bytes, uv_error_log2, number = line.words
    ram = {part: int(line.values[part]) for part in FIXED_PARTS}
    fixed, peak, collecting = sum(ram.values()), int(line.values["peak"]), int(line.values["collecting"])
    ram |= {"vertices": collecting - fixed, "states": peak - fixed if peak > collecting else 0}
    for core, split in splits.items():
        # The markers' own cost, which the count does not have.
        split[REST] += counts[core] - sum(split.values())
    return Frame(
        scene=scene,
        arena_bytes=int(arena_bytes),
        uv_error_log2=int(uv_error_log2),
        number=int(number),
        subpixel_bits=bits,
        crc=line.crc,
        passes=int(line.values["passes"]),
        ram=ram,
        native_us=int(native.values["ns"]) / 1000,
        instructions=counts,
        stages=splits,
    )


def _compare_with_each_other(frames: Iterable[Frame], verdicts: Verdicts) -> None:
    crcs = {frame.scene: frame.crc for frame in frames if frame.number == 0}
    for one, other in EQUAL:
        if other in MODEL_SCENES and other not in crcs:
            continue
        verdicts.check(crcs[one] == crcs[other], f"{one} is {crcs[one]}, {other} is {crcs[other]}")


def _drawn(frame: Frame) -> str:
    return frame.scene.removesuffix("-again")


def compare_with_simulator(machines: Machines, frames: Iterable[Frame], verdicts: Verdicts) -> None:
    """`edgeline-sim render --crc` has the default texture error, so only frames with that are compared, of the scenes
    that it knows; what is drawn again is the same frame."""
    simulator = machines.simulator()
    known = [row.split()[0] for row in output_of([simulator, "list"]).splitlines()]
    compared = [frame for frame in frames if frame.uv_error_log2 == 3 and _drawn(frame) in known]
    for scene in dict.fromkeys(map(_drawn, compared)):
        of_scene = [frame for frame in compared if _drawn(frame) == scene]
        last = max(frame.number for frame in of_scene)
        crcs = output_of([simulator, "render", "--scene", scene, "--frames", str(last + 1), "--crc"]).split()
        for frame in of_scene:
            verdicts.check(
                crcs[frame.number] == frame.crc,
                f"{frame.title} is {frame.crc}, the simulator shows {crcs[frame.number]}",
            )


def compare_with_recorded(frames: Sequence[Frame], recorded: dict[str, Any], verdicts: Verdicts) -> None:
    """The same pictures as recorded, and figures that are not worse; better ones are told. All that is recorded for the
    frames' numbers of sub-pixel bits must have been measured, but for models that are not at hand."""
    known = {frame.key: frame for frame in (Frame(**row) for row in recorded["frames"])}
    measured = {frame.key for frame in frames}
    bits = {frame.subpixel_bits for frame in frames}
    for key, was in known.items():
        if was.subpixel_bits in bits and was.scene not in MODEL_SCENES:
            verdicts.check(key in measured, f"{was.title} is recorded, but was not measured; run {RECORD}")
    for frame in frames:
        if (was_there := known.get(frame.key)) is None:
            verdicts.check(False, f"{frame.title} is not recorded; run {RECORD}")
            continue
        _compare(frame, was_there, verdicts)


def _compare(frame: Frame, was: Frame, verdicts: Verdicts) -> None:
    verdicts.check(frame.crc == was.crc, f"{frame.title} is {frame.crc}, recorded is {was.crc}")
    verdicts.compare(f"{frame.title}: passes", frame.passes, was.passes, RECORD)
    verdicts.compare(f"{frame.title}: bytes of RAM", frame.memory_peak, was.memory_peak, RECORD)
    for core, count in frame.instructions.items():
        stages = ""
        if core in was.stages:
            grown = {name: frame.stages[core][name] - was.stages[core][name] for name in (*STAGES, REST)}
            # What is too little to matter is left out.
            told = {name: more for name, more in grown.items() if abs(more) > count / 1000}
            stages = ", ".join(f"{name} {more / 1e6:+.3f} M" for name, more in told.items())
        what = f"{frame.title} on {core}: instructions ({stages or 'as they were by stage'})"
        verdicts.compare(what, count, was.instructions.get(core, 0), RECORD)


def rows(frames: Iterable[Frame]) -> list[dict[str, Any]]:
    return [asdict(frame) for frame in frames]
