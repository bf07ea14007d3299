"""The Pico's image, as it is dropped onto the board, runs from power-on: boot stage, clocks, display, stream. For every
scene what the display shows and what the host receives is what the simulator draws, pixel for pixel; and on the way
there nothing was done that the chip or the display would not have taken.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from edgeline.protocol import Control
from pico import Host, Pico
from target_tools import Image, Simulator, assert_same_picture

ROTATION = 90
FRAME = 7
"""Of each scene; not the first, so that FRAME is seen to work."""

CPU_HZ = 125e6
SPI_HZ = 62.5e6
STACK_BYTES = 4096

PANELS = {"ili9341": (320, 240), "st7789-240x240": (240, 240)}
"""Panel and what it shows as it is turned."""

DEMO_SCENES = ("demo", "teapot", "room", "solid", "field")
BENCH_SCENES = ("S1", "S2", "S4")
"""S3 is left out for its time alone: in the demo's arena it takes 18 passes and over 400 million cycles a frame."""

CASES = [("ili9341", scene) for scene in DEMO_SCENES + BENCH_SCENES]
CASES += [("st7789-240x240", scene) for scene in DEMO_SCENES]


def image_of(board_image: Callable[..., Image], panel: str) -> Image:
    """The board's own image, which is for ILI9341, or the one for another panel."""
    return board_image("rp2040") if panel == "ili9341" else board_image("rp2040", EDGELINE_PANEL=panel)


@pytest.mark.parametrize(("panel", "scene"), CASES)
def test_display_and_stream_equal_the_simulator(
    panel: str, scene: str, board_image: Callable[..., Image], simulator: Simulator, tmp_path: Path
) -> None:
    size = PANELS[panel]
    expected = simulator.render(scene, size, tmp_path, panel, rotation=ROTATION, frames=FRAME + 1)[FRAME]
    with Pico(image_of(board_image, panel), tmp_path) as pico:
        host = Host(pico)
        host.session.input(Control.PAUSE, 1)
        host.session.input(Control.SCENE, simulator.scenes().index(scene))
        host.session.input(Control.FRAME, FRAME)
        frame = host.next_frame()
        assert_same_picture(frame.picture, expected, f"{scene}, stream")
        host.run_until_picture(frame.number)
        shown = simulator.look(pico.wire_until_picture(frame.number), panel, size, ROTATION)
        assert_same_picture(shown, expected, f"{scene}, {panel}")
        report = pico.report()
    report.assert_clean()
    assert host.session.counts.damaged == 0
    assert report.clk_sys_hz == CPU_HZ
    assert report.pixel_hz == SPI_HZ
    assert report.stack_bytes <= STACK_BYTES * 3 // 4, f"{report.stack_bytes} bytes of stack used: too near to its end"


def test_a_frame_leaves_time_on_the_wire_to_draw_the_next_band(
    board_image: Callable[..., Image], simulator: Simulator, tmp_path: Path
) -> None:
    """Double buffering works: while a band is sent the next one is drawn, so a frame takes less than both together."""
    with Pico(board_image("rp2040"), tmp_path) as pico:
        host = Host(pico)
        host.session.autostart = False
        host.session.input(Control.SCENE, simulator.scenes().index("solid"))
        while pico.frame_ends < 4:
            host.step()
        report = pico.report()
    frame = report.frames[-1]
    width, height = PANELS["ili9341"]
    assert frame["wire_cycles"] >= width * height * 16 * CPU_HZ / SPI_HZ
    print({name: value for name, value in frame.items() if name != "asleep_cycles_of_bands"}, report.stack_bytes)
    assert frame["cycles"] < frame["wire_cycles"] * 1.5, "the wire waits for the drawing"
    assert frame["asleep_cycles"] > 0, "the processor never slept, though this scene is drawn faster than it is sent"
    report.assert_clean()
