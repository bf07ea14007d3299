"""The image of the LM3S6965 in QEMU: for every scene, QEMU's own OLED and the stream over the UART have the simulator's
pictures, pixel for pixel, in the RAM that the linker script allows."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import qemu
from oled_screen import assert_shows
from qemu_demo import FRAMES, SCENES, Demo, pictures, streaming
from target_tools import Image, Simulator, assert_same_picture, build_faulty

RAM_BEGIN = 0x20000000
RAM_LIMIT = 24 << 10

STACK_MARGIN = 512
"""Bytes of the stack that were never used: for an interrupt at the deepest point, and for the next compiler."""


@pytest.fixture(scope="module")
def image(board_image: Callable[..., Image]) -> Image:
    return board_image("lm3s6965")


@pytest.fixture(scope="module")
def demo(image: Image, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Demo]:
    """The board after its start, for all tests of this file: each goes on where the last one stopped."""
    paint = qemu.Stack.of(image.elf).paint(tmp_path_factory.mktemp("stack"))
    with streaming("lm3s6965evb", image.elf, *paint) as running:
        yield running


@pytest.mark.parametrize("scene", SCENES)
def test_every_scene_on_the_oled_and_on_the_stream(
    scene: str, demo: Demo, simulator: Simulator, tmp_path: Path
) -> None:
    glass = pictures(simulator, scene, tmp_path, "ssd0323")
    streamed = pictures(simulator, scene, tmp_path)
    for i, frame in enumerate(FRAMES):
        what = f"{scene}, frame {frame}"
        assert_same_picture(demo.show(SCENES.index(scene), frame), streamed[i], f"{what}, on the stream")
        assert_shows(demo.board, glass[i], what)
    assert demo.link.session.counts.damaged == 0


def test_the_scenes_are_those_of_the_simulator(simulator: Simulator) -> None:
    assert tuple(simulator.scenes()[: len(SCENES)]) == SCENES


def test_nothing_is_touched_that_is_not_there(demo: Demo) -> None:
    """QEMU complains of accesses to registers that the chip does not have."""
    expected = {"Timer with period zero, disabling"}  # the watchdog's, before the clocks run: QEMU's own start
    assert set(demo.board.said().splitlines()) <= expected | qemu.NO_CYCLE_COUNTER


def test_the_stack_has_room_left(image: Image, demo: Demo) -> None:
    left = qemu.Stack.of(image.elf).left(demo.board)
    print(f"{left} bytes of the stack were never used")
    assert left >= STACK_MARGIN


def test_it_takes_24_kb_of_ram_and_the_linker_sees_to_it(image: Image, tmp_path: Path) -> None:
    taken = qemu.symbols(image.elf)["el_stack_end"] - RAM_BEGIN
    print(f"{taken} bytes of RAM, stack included")
    assert taken <= RAM_LIMIT
    fault = ("ram_limit = 24K;", f"ram_limit = {taken - 8};")
    with pytest.raises(AssertionError, match="the program takes more RAM than ram_limit"):
        build_faulty("lm3s6965", {"firmware/boards/lm3s6965/lm3s6965.ld": [fault]}, tmp_path)
