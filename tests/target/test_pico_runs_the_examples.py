"""The programs of firmware/examples/programs as images for the Pico: each is built and fits, and what four of them
show in the emulator is what the simulator shows, pixel for pixel, keys included.
"""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from pico import MS, Pico
from target_tools import REPOSITORY, Image, Picture, Simulator, assert_same_picture, only_one

NAMES = sorted(path.stem for path in (REPOSITORY / "tests" / "golden").glob("example-*.png"))
SIZE = (320, 240)
ROTATION = 90
OLED_SIZE = (128, 64)
RAM_BYTES = 256 * 1024
WINDOWS = {"hello_triangle": 1, "textured_room": 1, "flush_callback": 5 + 24}
"""Pictures that the display's wire has for each frame: one, or the pieces of a GUI, 10 lines each, and the bands."""
FRAME_MS = 3000
"""More than any frame takes."""


@pytest.fixture(scope="module")
def examples(board_image: Callable[..., Image]) -> Path:
    """The folder with all of their images, by the command that users are told."""
    folder = board_image("rp2040").folder
    command = ["cmake", "--build", str(folder), "--parallel", "2", "--target", "examples"]
    with only_one(folder.name):
        done = subprocess.run(command, capture_output=True, text=True, timeout=600, check=False)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    return folder


def shown_by_the_simulator(
    simulator: Simulator, name: str, keys: str, folder: Path, size: tuple[int, int] = SIZE
) -> Picture:
    """Its frame number len(keys), the last one."""
    raw = folder / f"{name}.rgb565"
    program = str(simulator.path.parent / "examples" / name)
    command = [program, "--frames", str(len(keys)), "--keys", keys, "--raw", str(raw)]
    subprocess.run(command, check=True, timeout=60)
    picture: Picture = np.fromfile(raw, "<u2").reshape(len(keys), size[1], size[0])[-1]
    return picture


@pytest.mark.parametrize("name", NAMES)
def test_its_image_is_there_and_fits(examples: Path, name: str) -> None:
    assert (examples / f"{name}.uf2").stat().st_size % 512 == 0
    sizes = subprocess.run(
        ["arm-none-eabi-size", "-A", str(examples / f"{name}.elf")], capture_output=True, text=True, check=True
    ).stdout
    ram = {".hot", ".data", ".bss", ".arena", ".stack"}
    used = sum(int(words[1]) for words in map(str.split, sizes.splitlines()) if words and words[0] in ram)
    assert 0 < used <= RAM_BYTES


@pytest.mark.parametrize(
    ("name", "keys"), [("hello_triangle", "."), ("textured_room", ".wwd"), ("flush_callback", ".")]
)
def test_it_shows_what_the_simulator_shows(
    examples: Path, simulator: Simulator, tmp_path: Path, name: str, keys: str
) -> None:
    """Each key but the first, which is none, is sent when a frame has ended. The next frame takes it, or the one after
    that, whose picture has it in either case."""
    expected = shown_by_the_simulator(simulator, name, keys, tmp_path)
    with Pico(Image(examples, f"example-{name}"), tmp_path) as pico:
        wait_for_pictures(pico, WINDOWS[name])
        for key in keys[1:]:
            pico.step(MS, key.encode())
            wait_for_pictures(pico, 2 * WINDOWS[name])
        shown = simulator.look(pico.wire_until_picture(pico.frame_ends - 1), "ili9341", SIZE, ROTATION)
        assert_same_picture(shown, expected, name)
        pico.report().assert_clean()


def test_an_oled_shows_what_the_simulator_shows(examples: Path, simulator: Simulator, tmp_path: Path) -> None:
    """Its frames have no end on the wire: when the second one begins, the first has been handed over, and it is on the
    glass 100 us later, in which the second cannot have been drawn as far as its first band."""
    expected = shown_by_the_simulator(simulator, "one_bit", ".", tmp_path, OLED_SIZE)
    with Pico(Image(examples, "example-one_bit"), tmp_path, frame_at="el_frame_begin") as pico:
        for begun, step in ((1, MS), (2, MS // 10)):
            while pico.report().frame_count < begun:
                assert pico.now_ns < FRAME_MS * MS, f"frame {begun} has not begun within {FRAME_MS} ms"
                pico.step(step)
        pico.step(MS // 10)
        assert_same_picture(simulator.look(pico.trace, "ssd1306", OLED_SIZE), expected, "one_bit")
        pico.report().assert_clean()


def wait_for_pictures(pico: Pico, count: int) -> None:
    """Until so many more are complete."""
    wanted = pico.frame_ends + count
    end = pico.now_ns + count * FRAME_MS * MS
    while pico.frame_ends < wanted:
        assert pico.now_ns < end, f"no picture {wanted} within {count * FRAME_MS} ms"
        pico.step(20 * MS, until_frame=True)
