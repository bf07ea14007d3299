"""The host's controls on a board: HELLO names them, and each picture that they lead to is the simulator's, pixel for
pixel: debug views, shadings, texture errors, the camera's offsets. A board's HELLO names no control that it lacks."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from edgeline.codec import Pixels
from edgeline.protocol import Control
from qemu_demo import SCENES, SIZE, Demo, streaming
from target_tools import Image, Simulator, assert_same_picture

# What is set on the board, and the same for the simulator. Bands' work depends on the arena: that view is apart.
CASES: dict[str, tuple[dict[str, int], tuple[str, ...]]] = {
    "overdraw": ({"view": 1}, ("--view", "overdraw")),
    "depth": ({"view": 2}, ("--view", "depth")),
    "triangles": ({"view": 3}, ("--view", "triangles")),
    "rejected": ({"view": 5}, ("--view", "rejected")),
    "flat": ({"shading": 1}, ("--shading", "flat")),
    "no textures": ({"shading": 2}, ("--shading", "gouraud")),
    "no vertex colours": ({"shading": 3}, ("--shading", "textured")),
    "texture error": ({"texture_error": 1}, ("--uv-error", "2")),
    "turned": ({"yaw": -9000, "pitch": 5000}, ("--yaw=-9000", "--pitch=5000")),
    "moved": ({"zoom": -300, "pan_x": 70, "pan_y": -90}, ("--zoom=-300", "--pan-x=70", "--pan-y=-90")),
    "all at once": (
        {"view": 2, "yaw": 20000, "pitch": -3000, "zoom": 200, "pan_x": -40},
        ("--view", "depth", "--yaw=20000", "--pitch=-3000", "--zoom=200", "--pan-x=-40"),
    ),
}


def _simulated(simulator: Simulator, folder: Path, scene: str, *arguments: str) -> Pixels:
    raw = folder / "picture.rgb565"
    size = ("--size", f"{SIZE[0]}x{SIZE[1]}")
    done = simulator.run("render", "--scene", scene, *size, "--raw", str(raw), *arguments)
    assert done.returncode == 0, done.stderr
    return np.fromfile(raw, "<u2").reshape(SIZE[1], SIZE[0])


@pytest.fixture(scope="module")
def demo(board_image: Callable[..., Image]) -> Iterator[Demo]:
    with streaming("lm3s6965evb", board_image("lm3s6965").elf) as running:
        yield running


def _set(demo: Demo, controls: dict[str, int]) -> Pixels:
    for control, value in controls.items():
        demo.link.control(control, value)
    return demo.link.next_frame(20, settled=True).picture


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("scene", ["teapot", "room"])
def test_a_board_shows_what_the_simulator_shows(
    scene: str, case: str, demo: Demo, simulator: Simulator, tmp_path: Path
) -> None:
    controls, arguments = CASES[case]
    at_rest = _set(demo, {"pause": 1, "scene": SCENES.index(scene), "frame": 0})
    assert_same_picture(at_rest, _simulated(simulator, tmp_path, scene), f"{scene} at rest")
    try:
        assert_same_picture(
            _set(demo, controls), _simulated(simulator, tmp_path, scene, *arguments), f"{scene}, {case}"
        )
    finally:
        _set(demo, dict.fromkeys(controls, 0))


def test_bands_are_shown(demo: Demo) -> None:
    picture = _set(demo, {"pause": 1, "scene": SCENES.index("room"), "frame": 0})
    bands = _set(demo, {"view": 4})
    assert not np.array_equal(picture, bands)
    assert np.array_equal(picture, _set(demo, {"view": 0}))


def test_steps_lead_to_the_frame(demo: Demo, simulator: Simulator, tmp_path: Path) -> None:
    _set(demo, {"pause": 1, "scene": SCENES.index("solid"), "frame": 2})
    stepped = _set(demo, {"step": 3})
    raw = tmp_path / "frames.rgb565"
    arguments = ("--scene", "solid", "--size", f"{SIZE[0]}x{SIZE[1]}", "--frames", "6", "--raw", str(raw))
    assert simulator.run("render", *arguments).returncode == 0
    assert_same_picture(stepped, np.fromfile(raw, "<u2").reshape(6, SIZE[1], SIZE[0])[5], "solid, 2 + 3")


def test_hello_names_what_the_board_takes(demo: Demo) -> None:
    hello = demo.link.hello
    assert hello is not None
    assert hello.scenes == len(SCENES)
    assert {control for control in Control if hello.knows(control)} == set(Control) - {Control.ANTIALIASING}
    assert [view for view in range(16) if hello.has_view(view)] == list(range(6))


def test_a_board_without_debug_views_says_so(board_image: Callable[..., Image]) -> None:
    with streaming("stm32vldiscovery", board_image("stm32vldiscovery").elf) as small:
        small.link.next_frame(20)
        hello = small.link.hello
    assert hello is not None
    missing = {control for control in Control if not hello.knows(control)}
    assert missing == {Control.SHADING, Control.ANTIALIASING, Control.VIEW}
    assert not any(hello.has_view(view) for view in range(16))
