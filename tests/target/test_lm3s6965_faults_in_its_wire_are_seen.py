"""Faults of the kinds that real displays punish, put into the sources one at a time: QEMU's OLED shows each of them, so
the comparison of its picture with the simulator's is no comparison of one thing with itself."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from oled_screen import levels, levels_of
from qemu_demo import SCENES, pictures, streaming
from target_tools import Simulator, build_faulty

DISPLAY = "firmware/boards/lm3s6965/display.c"
DRIVER = "firmware/src/panel/oled.c"
CONTROLLER = "firmware/src/panel/ssd0323.c"

FAULTS = {
    "D/C changes while bytes are on their way": {
        DISPLAY: [("    while ((SSI_STATUS & (SSI_STATUS_BUSY | SSI_STATUS_RX_NOT_EMPTY)) != 0) {", "    while (0) {")],
    },
    "a window that is one column too narrow": {
        DRIVER: [("(uint8_t)(end - 1U));", "(uint8_t)(end - (columns ? 2U : 1U)));")],
    },
    "a window that begins one row too low": {
        DRIVER: [("        set_units(panel, 0, ", "        set_units(panel, 1, ")],
    },
    "the left pixel in the lower half of a byte": {
        CONTROLLER: [("    .first_is_high = 1,", "    .first_is_high = 0,")],
    },
}


@pytest.mark.parametrize("fault", FAULTS)
def test_the_picture_is_wrong(fault: str, simulator: Simulator, tmp_path: Path) -> None:
    image = build_faulty("lm3s6965", FAULTS[fault], tmp_path)
    right = pictures(simulator, "solid", tmp_path, "ssd0323")[0]
    streamed = pictures(simulator, "solid", tmp_path)[0]
    with streaming("lm3s6965evb", image.elf) as demo:
        assert np.array_equal(demo.show(SCENES.index("solid"), 0), streamed), "the fault is not in the wire alone"
        wrong = int((levels(demo.board) != levels_of(right)).sum())
    print(f"{fault}: {wrong} pixels are wrong")
    assert wrong > 0
