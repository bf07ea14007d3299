"""The LM3S6965's OLED as QEMU draws it, compared with what the simulator's glass shows."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

import qemu
from target_tools import Picture, assert_same_picture

MAGNIFIED = 4
"""QEMU draws a pixel of the OLED as a square of so many."""

LEVEL = 17
"""And one of its 16 levels as so much grey."""


def levels(board: qemu.Machine) -> npt.NDArray[np.uint16]:
    """What the OLED shows: 0..15, (64, 128)."""
    screen = board.screen()
    height, width, _ = screen.shape
    assert (width, height) == (128 * MAGNIFIED, 64 * MAGNIFIED), f"QEMU's picture is {width}x{height}"
    squares = screen.reshape(64, MAGNIFIED, 128, MAGNIFIED * 3)
    grey = squares[:, 0, :, 0]
    assert np.array_equal(squares, np.broadcast_to(grey[:, None, :, None], squares.shape)), "no grey squares"
    assert not (grey % LEVEL).any(), "grey that is no level"
    return (grey // LEVEL).astype(np.uint16)


def levels_of(glass: Picture) -> npt.NDArray[np.uint16]:
    """The same of the simulator's picture, whose grey is RGB565: the upper bits of red."""
    return (glass >> 12).astype(np.uint16)


def assert_shows(board: qemu.Machine, glass: Picture, what: str) -> None:
    assert_same_picture(levels(board), levels_of(glass), f"{what}, on the OLED")
