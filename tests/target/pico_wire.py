"""What a Pico's frames cost beside what its display's wire can carry, in the emulator. As a program, which
tests/bench/run --pico runs, it prints JSON; status 77 when a tool is missing.

For each scene of the demo: cycles of a frame; those in which the core slept at the ends of bands, because the DMA still
had the band before; and those in which the wire was in use. A frame whose drawing is hidden takes the wire's time and
no more. Three courses: every frame sent whole; only what changes (EDGELINE_SPARING); the same with the scene standing
still.

The figures are rp2040js' estimate with memory that never waits: a Pico's flash has a cache of 16 KB, whose misses come
to them.
"""

from __future__ import annotations

import json
import sys
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path

if __name__ == "__main__":  # as a program it stands outside of pytest's paths
    sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[1])]

import pytest

from edgeline.protocol import Control
from pico import Host, Pico
from target_tools import REPOSITORY, Image, build_board

LABEL = "rp2040js estimate, zero-wait memory"
RESULTS = REPOSITORY / "tests" / "bench" / "results" / "pico.json"

CLOCK_HZ = 125e6
WIRE_CYCLES = 320 * 240 * 16 * 2
"""A whole frame of 320x240 pixels at 62.5 MHz: 2.46 M cycles, 50.9 frames per second."""

SCENES = ("demo", "teapot", "room", "solid", "field")
"""In the order of their numbers; the first shows the others in turn and is not measured."""

CASES = [(scene, course) for scene in SCENES[1:] for course in ("whole", "changes")]
CASES += [("teapot", "still"), ("solid", "still")]

SETTLED = 3
"""Frames before the first that counts: one that was begun before FRAME came, one in which all has changed."""
COUNTED = 4


@dataclass(frozen=True)
class Course:
    """Means of a scene's frames, in cycles of the processor."""

    scene: str
    course: str
    cycles: int
    wire_cycles: int
    idle_cycles: int
    """asleep at the ends of bands, until the DMA had sent the band before"""
    bands: int
    late_bands: int
    """at whose ends the core did not sleep: the wire waited for it"""

    @property
    def frames_per_s(self) -> float:
        return CLOCK_HZ / self.cycles


def image_for(course: str) -> Image:
    """The demo for an ILI9341, built for that course."""
    return build_board("rp2040") if course == "whole" else build_board("rp2040", EDGELINE_SPARING="ON")


def measure(scene: str, course: str, folder: Path) -> Course:
    """Runs the board without a host that takes frames, from its power-on."""
    with Pico(image_for(course), folder, frame_at="el_frame_begin") as pico:
        host = Host(pico)
        host.session.autostart = False
        host.session.input(Control.SCENE, SCENES.index(scene))
        host.session.input(Control.PAUSE, 1 if course == "still" else 0)
        while host.session.inputs_waiting:
            host.step()
        # The same frames each time, however long those took that were drawn meanwhile.
        host.session.input(Control.FRAME, 0)
        host.step()
        began = pico.report().frame_count
        while pico.report().frame_count < began + SETTLED + COUNTED:
            host.step()
        report = pico.report()
    report.assert_clean()
    last = began + SETTLED + COUNTED - report.frame_count or None
    frames = report.frames[:last][-COUNTED:] if course != "still" else report.frames[-COUNTED:]
    idle = [cycles for frame in frames for cycles in frame["asleep_cycles_of_bands"]]
    return Course(
        scene=scene,
        course=course,
        cycles=round(sum(frame["cycles"] for frame in frames) / COUNTED),
        wire_cycles=round(sum(frame["wire_cycles"] for frame in frames) / COUNTED),
        idle_cycles=round(sum(frame["asleep_cycles"] for frame in frames) / COUNTED),
        bands=round(len(idle) / COUNTED),
        late_bands=round(sum(cycles == 0 for cycles in idle) / COUNTED),
    )


def recorded() -> dict[tuple[str, str], Course]:
    """What tests/bench/run --record-pico wrote, by scene and course."""
    rows = json.loads(RESULTS.read_text(encoding="utf-8"))["courses"]
    return {(row["scene"], row["course"]): Course(**row) for row in rows}


def main() -> int:
    try:
        with tempfile.TemporaryDirectory() as folder:
            courses = [asdict(measure(scene, course, Path(folder))) for scene, course in CASES]
    except pytest.skip.Exception as error:
        print(error, file=sys.stderr)
        return 77
    print(json.dumps({"figures": LABEL, "clock_hz": int(CLOCK_HZ), "courses": courses}))
    return 0


if __name__ == "__main__":
    sys.exit(main())
