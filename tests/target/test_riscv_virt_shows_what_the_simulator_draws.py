"""The image of the RISC-V board in QEMU: for every scene, the stream over its UART and what its display's wire carries
are the simulator's pictures, pixel for pixel."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

import qemu
import qemu_virt
from needs import need_tool
from qemu_demo import FRAMES, SCENES
from target_tools import Image, LookError, Simulator, assert_same_picture

STACK_MARGIN = 512
"""Bytes of the stack that were never used: for the next compiler. Traps have a stack of their own."""


@pytest.fixture(scope="module")
def image(board_image: Callable[..., Image]) -> Image:
    need_tool("riscv64-unknown-elf-gcc", "gcc-riscv64-unknown-elf and picolibc-riscv64-unknown-elf")
    return board_image("riscv_virt")


@pytest.fixture(scope="module")
def recorded(image: Image, tmp_path_factory: pytest.TempPathFactory) -> Iterator[qemu_virt.Recorded]:
    """The board after its start, for all tests of this file: each goes on where the last one stopped."""
    folder = tmp_path_factory.mktemp("virt")
    with qemu_virt.recorded(image, folder, *qemu.Stack.of(image.elf).paint(folder)) as running:
        yield running


@pytest.mark.parametrize("scene", SCENES)
def test_every_scene_on_the_wire_and_on_the_stream(
    scene: str, recorded: qemu_virt.Recorded, simulator: Simulator, tmp_path: Path
) -> None:
    frames = FRAMES[-1] + 1
    streamed = simulator.render(scene, qemu_virt.SIZE, tmp_path, frames=frames)
    glass = simulator.render(
        scene, qemu_virt.SIZE, tmp_path, qemu_virt.PANEL, rotation=qemu_virt.ROTATION, frames=frames
    )
    for frame in FRAMES:
        what = f"{scene}, frame {frame}"
        shown = recorded.show(SCENES.index(scene), frame)
        assert_same_picture(shown, streamed[frame], f"{what}, on the stream")
        assert_same_picture(recorded.glass(simulator), glass[frame], f"{what}, on the glass")
    assert recorded.demo.link.session.counts.damaged == 0


def test_a_byte_that_the_wire_loses_is_seen(recorded: qemu_virt.Recorded, simulator: Simulator, tmp_path: Path) -> None:
    """The recording without one byte of the last whole frame: what follows it in the frame is shifted."""
    recorded.show(SCENES.index("room"), 0)
    right = recorded.glass(simulator)
    records = recorded.trace.read_bytes()
    frame_bytes = right.size * 2 * 2  # two bytes of a pixel, two of a record
    at = len(records) - frame_bytes * 3 // 2 & ~1
    assert records[at] == 1, "a byte with D/C high"
    shifted = tmp_path / "shifted.hot1"
    shifted.write_bytes(records[:at] + records[at + 2 : len(records) - frame_bytes])
    try:
        seen = simulator.look(shifted, qemu_virt.PANEL, qemu_virt.SIZE, qemu_virt.ROTATION)
    except LookError:
        return
    assert not np.array_equal(seen, right)


def test_nothing_is_touched_that_is_not_there(recorded: qemu_virt.Recorded) -> None:
    """QEMU complains of what the machine does not have."""
    assert recorded.demo.board.said() == ""


def test_the_stack_has_room_left(image: Image, recorded: qemu_virt.Recorded) -> None:
    left = qemu.Stack.of(image.elf).left(recorded.demo.board)
    print(f"{left} bytes of the stack were never used")
    assert left >= STACK_MARGIN
