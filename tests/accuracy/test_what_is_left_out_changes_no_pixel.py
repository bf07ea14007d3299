"""`render --sparing` neither draws nor sends what has not changed. After every frame the display shows, and depths are,
what comes of drawing and sending everything; and less is drawn and sent.
"""

from __future__ import annotations

import itertools

import pytest

from sim_commands import Simulator

SIZES = {
    "ili9341": (240, 320),
    "st7789-240x240": (240, 240),
    "st7735": (128, 160),
    "ssd1306": (128, 64),
    "ssd0323": (128, 64),
}

FRAMES = 36
"""More than an OLED's round of 32, and the demo's first change of scenes."""

WHOLE_FRAME = 11
"""Bytes of the commands with which a frame begins that is sent whole."""


@pytest.fixture(scope="module")
def scenes(simulator: Simulator) -> list[str]:
    return simulator.scenes()


def _compare(simulator: Simulator, *arguments: str, width: int, height: int, frames: int = FRAMES) -> tuple[int, int]:
    """The display's bytes of all frames, everything sent and sparingly; pictures and depths must be equal."""
    command = [*arguments, "--frames", str(frames)]
    whole = simulator.render(*command, width=width, height=height)
    sparing = simulator.render(*command, "--sparing", width=width, height=height)
    assert sparing.crcs == whole.crcs
    assert (sparing.colour == whole.colour).all() and (sparing.depth == whole.depth).all()
    assert len(whole.crcs) == frames
    sent, sent_sparingly = (sum(stats["wire_bytes"] for stats in run.stats) for run in (whole, sparing))
    return sent, sent_sparingly


@pytest.mark.parametrize("band", [1, 8, 30, 240])
def test_every_scene_shows_the_same(simulator: Simulator, scenes: list[str], band: int) -> None:
    for scene in scenes:
        frames = FRAMES if band == 8 else 4
        whole, sparing = _compare(
            simulator, "--scene", scene, "--band", str(band), width=320, height=240, frames=frames
        )
        assert sparing <= whole, scene


@pytest.mark.parametrize(("panel", "rotation"), list(itertools.product(SIZES, (0, 90, 180, 270))))
def test_every_panel_shows_the_same(simulator: Simulator, panel: str, rotation: int) -> None:
    width, height = SIZES[panel] if rotation % 180 == 0 else SIZES[panel][::-1]
    for scene, band in (("demo", 8), ("teapot", 5), ("S1", 16)):
        arguments = ["--scene", scene, "--band", str(band), "--panel", panel, "--rotation", str(rotation)]
        whole, sparing = _compare(simulator, *arguments, width=width, height=height)
        # The teapot reaches into each band of 5 lines of an OLED, which has no hashes.
        assert sparing < whole or (scene == "teapot" and panel.startswith("ssd")), scene
        smaller = [*arguments, "--frames", "6"]  # than the glass, which the CRCs are of
        crcs = [
            simulator.render(*smaller, *mode, width=width - 5, height=height - 3, pictures=False).crcs
            for mode in ((), ("--sparing",))
        ]
        assert crcs[0] == crcs[1], scene


def test_little_memory_shows_the_same(simulator: Simulator, scenes: list[str]) -> None:
    """Several passes, and bands that are drawn before all was submitted."""
    for scene in scenes:
        _compare(simulator, "--scene", scene, "--arena", "20480", width=320, height=240, frames=3)


def test_a_still_scene_costs_nothing_and_is_sent_whole_every_64_frames(simulator: Simulator) -> None:
    frames = simulator.render("--scene", "S1", "--sparing", "--frames", "130", pictures=False).stats
    whole = [index for index, stats in enumerate(frames) if stats["wire_bytes"] > 0]
    assert whole == [0, 64, 128]
    for index, stats in enumerate(frames):
        assert stats["frames_unchanged"] == (index not in whole)
        assert stats["wire_bytes"] in (0, 2 * 320 * 240 + WHOLE_FRAME)
        assert stats["vertices"] == 0 or index in whole


def test_background_above_and_below_the_teapot_is_neither_drawn_nor_sent(simulator: Simulator) -> None:
    frames = simulator.render("--scene", "teapot", "--sparing", "--frames", "64", pictures=False).stats
    assert frames[0]["lines_background"] == 0
    kept = [stats["lines_background"] for stats in frames[1:]]
    assert min(kept) >= 48
    assert all(stats["bands"] * 8 + stats["lines_background"] == 240 for stats in frames)
    sent = sum(stats["wire_bytes"] for stats in frames[1:]) / len(kept)
    assert sent < 0.55 * (2 * 320 * 240 + WHOLE_FRAME)


def test_a_debug_view_is_drawn_each_time(simulator: Simulator) -> None:
    """It shows work, which is less where something is left out."""
    for view in ("bands", "overdraw", "depth"):
        arguments = ["--scene", "S1", "--view", view]
        whole = simulator.render(*arguments, "--frames", "3")
        sparing = simulator.render(*arguments, "--frames", "3", "--sparing")
        assert sparing.crcs == whole.crcs
        assert all(stats["frames_unchanged"] == 0 and stats["lines_background"] == 0 for stats in sparing.stats)
