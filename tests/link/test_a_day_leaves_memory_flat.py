"""A hundredth of a day's frames through both sides, begun just before the counters' wraps: each frame is right and the
one after the last, the time stamps go on, and nothing is left behind. The whole day: tests/link/run --day."""

from __future__ import annotations

from pathlib import Path

import pytest

import day
from day import DAY_FRAMES, FRAME_US, live_through
from edgeline.events import Frame

FRAMES = DAY_FRAMES // 100
GROWTH_BLOCKS = FRAMES // 50
"""Python keeps some of what it gave out, ever less often: 130 blocks here, 0.005 a frame."""

GROWTH_KIB = 512


def test_counters_wrap_and_memory_is_flat(program: Path) -> None:
    lived = live_through(program, FRAMES)
    assert (lived.frames, lived.wrong, lived.damaged) == (FRAMES, 0, 0)
    assert lived.frame_wraps == 1 and lived.clock_wraps == 1
    assert lived.seconds == pytest.approx((FRAMES - 1) * FRAME_US / 1e6, abs=0.5)
    assert lived.blocks[1] - lived.blocks[0] < GROWTH_BLOCKS
    assert lived.host_kib[1] - lived.host_kib[0] < GROWTH_KIB
    assert lived.device_kib[1] == lived.device_kib[0]


def test_what_each_frame_leaves_behind_is_noticed(program: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    kept: list[Frame] = []

    def keep(frame: Frame, truths: object, last: int) -> bool:
        kept.append(frame)
        return True

    monkeypatch.setattr(day, "_is_right", keep)
    lived = live_through(program, FRAMES // 5)
    assert lived.blocks[1] - lived.blocks[0] > GROWTH_BLOCKS
