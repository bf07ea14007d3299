"""The Pico's frames beside what its display's wire can carry (pico_wire.py; rp2040js estimate, zero-wait memory): none
takes longer than was recorded, and where little changes more frames are shown than the wire could carry whole.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

import pico_wire
from pico_wire import Course

Measure = Callable[[str, str], Course]

TOLERANCE = 0.03
"""A frame may take so much longer than was recorded before somebody must look and record anew."""


@pytest.fixture(scope="module")
def measured(tmp_path_factory: pytest.TempPathFactory) -> Measure:
    folder: Path = tmp_path_factory.mktemp("pico")

    @cache
    def measure(scene: str, course: str) -> Course:
        return pico_wire.measure(scene, course, folder)

    return measure


@pytest.mark.parametrize(("scene", "course"), pico_wire.CASES)
def test_no_scene_takes_longer_than_was_recorded(scene: str, course: str, measured: Measure) -> None:
    found = measured(scene, course)
    was = pico_wire.recorded()[scene, course]
    assert found.cycles <= was.cycles * (1 + TOLERANCE), (
        f"{found}\nwas {was}\nif it is meant: tests/bench/run --record-pico"
    )


def test_a_whole_frame_takes_the_wire_what_it_must(measured: Measure) -> None:
    for scene in pico_wire.SCENES[1:]:
        found = measured(scene, "whole")
        # What is left of a frame's last band when the next frame begins is counted there, a little more or less.
        assert found.wire_cycles == pytest.approx(pico_wire.WIRE_CYCLES, rel=0.001), found
        assert found.bands == 60


def test_the_core_sleeps_while_bands_are_sent(measured: Measure) -> None:
    """Double buffering: what the core does and what the wire does takes less than both one after the other."""
    found = measured("solid", "whole")
    assert found.idle_cycles > 0
    assert found.cycles < found.cycles - found.idle_cycles + found.wire_cycles * 0.7, found


def test_where_little_changes_more_frames_are_shown_than_the_wire_could_carry(measured: Measure) -> None:
    limit = pico_wire.CLOCK_HZ / pico_wire.WIRE_CYCLES
    assert measured("solid", "whole").frames_per_s < limit
    assert measured("solid", "changes").frames_per_s > 1.1 * limit


def test_what_stands_still_leaves_the_core_free(measured: Measure) -> None:
    """63 of 64 frames are found unchanged; the last one is drawn."""
    for scene in ("teapot", "solid"):
        assert measured(scene, "still").cycles < 0.05 * measured(scene, "changes").cycles
