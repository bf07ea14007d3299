"""The same image in QEMU, whose STM32F405 has neither clocks to wait for, nor pins, nor a DMA: it starts nevertheless,
and its stream shows the simulator's pictures.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import qemu
from qemu_demo import Demo, streaming
from target_tools import Image, Simulator, assert_same_picture
from unicorn_f405 import SIZE

MACHINE = "netduinoplus2"
FRAME = 1
SCENES = ("demo", "teapot", "room", "solid", "field", "S1", "S2")


@pytest.fixture(scope="module")
def demo(board_image: Callable[..., Image]) -> Iterator[Demo]:
    with streaming(MACHINE, board_image("stm32f405").elf) as running:
        yield running


@pytest.mark.parametrize("scene", SCENES)
def test_stream_shows_the_simulators_picture(scene: str, demo: Demo, simulator: Simulator, tmp_path: Path) -> None:
    wanted = simulator.render(scene, SIZE, tmp_path, frames=FRAME + 1)[FRAME]
    assert_same_picture(demo.show(SCENES.index(scene), FRAME), wanted, scene)


def test_qemu_has_nothing_to_complain_about(demo: Demo) -> None:
    assert set(demo.board.said().splitlines()) <= qemu.NO_CYCLE_COUNTER
