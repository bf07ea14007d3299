"""Whole frames: measured on each core, proven equal to the simulator's, and compared with what was recorded."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import Any

from .machines import MAIN_CORES, BenchError, Line, Machines, output_of

# Counts may differ by that much from the recorded ones before somebody must look and record anew.
TOLERANCE = 0.03

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
}


@dataclass(frozen=True)
class Frame:
    """One frame of a scene in one configuration."""

    scene: str
    arena_bytes: int
    uv_error_log2: int
    number: int
    subpixel_bits: int
    crc: str
    passes: int
    memory_peak: int
    native_us: float
    instructions: dict[str, int]

    @property
    def key(self) -> tuple[str, int, int, int, int]:
        return self.scene, self.arena_bytes, self.uv_error_log2, self.number, self.subpixel_bits

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

    def check(self, good: bool, message: str) -> None:
        if good:
            self.passed += 1
        else:
            self.failed += 1
            print(f"FAIL {message}")


def measure(machines: Machines, verdicts: Verdicts, bits: int = 4) -> list[Frame]:
    """All frames on all cores. Each core's picture must be the native build's, and with 4 bits the simulator's."""
    native = [line for line in machines.native("scenes", bits=bits) if line.words[0] != "empty"]
    counts: dict[str, list[int]] = {}
    for core in MAIN_CORES:
        found = machines.target(core, "scenes", bits)
        if len(found) != len(native):
            raise BenchError(f"{core} drew {len(found)} frames, this computer {len(native)}")
        counts[core] = [one.instructions for one in found]
        for here, there in zip(native, found, strict=True):
            verdicts.check(
                there.line.words == here.words and there.line.crc == here.crc,
                f"{core} draws {' '.join(there.line.words)} as {there.line.crc}, this computer as {here.crc}",
            )
    frames = [
        _frame(line, bits, {core: counts[core][index] for core in MAIN_CORES}) for index, line in enumerate(native)
    ]
    if bits == 4:
        compare_with_simulator(machines, frames, verdicts)
    return frames


def _frame(line: Line, bits: int, instructions: dict[str, int]) -> Frame:
    scene, arena_bytes, uv_error_log2, number = line.words
    return Frame(
        scene=scene,
        arena_bytes=int(arena_bytes),
        uv_error_log2=int(uv_error_log2),
        number=int(number),
        subpixel_bits=bits,
        crc=line.crc,
        passes=int(line.values["passes"]),
        memory_peak=int(line.values["peak"]),
        native_us=int(line.values["ns"]) / 1000,
        instructions=instructions,
    )


def compare_with_simulator(machines: Machines, frames: Iterable[Frame], verdicts: Verdicts) -> None:
    """`edgeline-sim render --crc` has the default texture error, so only frames with that are compared."""
    simulator = machines.simulator()
    compared = [frame for frame in frames if frame.uv_error_log2 == 3]
    for scene in dict.fromkeys(frame.scene for frame in compared):
        of_scene = [frame for frame in compared if frame.scene == scene]
        last = max(frame.number for frame in of_scene)
        crcs = output_of([simulator, "render", "--scene", scene, "--frames", str(last + 1), "--crc"]).split()
        for frame in of_scene:
            verdicts.check(
                crcs[frame.number] == frame.crc,
                f"{frame.title} is {frame.crc}, the simulator shows {crcs[frame.number]}",
            )


def compare_with_recorded(frames: Iterable[Frame], recorded: dict[str, Any], verdicts: Verdicts) -> None:
    """Counts within TOLERANCE of the recorded ones, each of which must have been measured again."""
    known = {Frame(**row).key: Frame(**row) for row in recorded["frames"]}
    for frame in frames:
        was = known.get(frame.key)
        for core, count in frame.instructions.items():
            if was is None:
                verdicts.check(False, f"{frame.title} is not recorded; run tests/bench/run --all")
                continue
            change = count / was.instructions[core] - 1
            verdicts.check(
                abs(change) <= TOLERANCE,
                f"{frame.title} on {core}: {count / 1e6:.3f} M instructions, recorded are "
                f"{was.instructions[core] / 1e6:.3f} M ({change:+.1%}, {TOLERANCE:.0%} may be); if it is meant, run "
                "tests/bench/run --all and commit tests/bench/results",
            )


def rows(frames: Iterable[Frame]) -> list[dict[str, Any]]:
    return [asdict(frame) for frame in frames]


def table(frames: Iterable[Frame]) -> str:
    """A Markdown table: million instructions per frame, and how many times the best peer's count that is."""
    lines = [
        "| scene, frame | arena | passes | used | texture | bits | Cortex-M0+ | / peer | Cortex-M4F | / peer |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for frame in frames:
        cells = [
            f"{frame.scene}, {frame.number}",
            f"{frame.arena_bytes // 1024} KB",
            str(frame.passes),
            f"{frame.memory_peak / 1024:.1f} KB",
            f"1/{1 << frame.uv_error_log2}",
            str(frame.subpixel_bits),
        ]
        for core in MAIN_CORES:
            millions = frame.instructions[core] / 1e6
            cells.append(f"{millions:.3f} M")
            peer = PEERS[core].get(frame.scene)
            cells.append(f"{millions / peer[0]:.2f} ({peer[1]})" if peer else "")
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)
