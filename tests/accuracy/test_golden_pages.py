"""The pages of canvas/ look as they did when somebody last looked at them, in bands of every height; and what the
command line asks for that does not exist gets one clear line.

tests/golden has a PNG of frame 0 of each page, and pages.crc the CRC-32 of every tenth of the first 60 frames. After a
change that is meant to change pixels: `EDGELINE_UPDATE_GOLDEN=1 python -m pytest tests/accuracy/test_golden_pages.py`,
then look at the pictures before committing them. tests/unit/test_pages.c has figures of two frames for every core.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from PIL import Image

from golden import GOLDEN, UPDATE, expect_golden, stored_crcs
from sim_commands import Simulator

CRCS = GOLDEN / "pages.crc"
PAGES = ("card", "lines", "horizon", "hud")
FRAMES = 60
EVERY = 10


def _crcs(simulator: Simulator, page: str, *arguments: str) -> list[str]:
    text = simulator.run_well("paint", "--page", page, "--frames", str(FRAMES), "--crc", *arguments)
    return text.split()[::EVERY]


def test_every_page_has_its_golden(simulator: Simulator) -> None:
    listed = [line.split()[0] for line in simulator.run_well("list", "pages").splitlines()]
    assert tuple(listed) == PAGES


@pytest.mark.parametrize("page", PAGES)
def test_first_frame(simulator: Simulator, reports: Path, tmp_path: Path, page: str) -> None:
    png = tmp_path / "page.png"
    simulator.run_well("paint", "--page", page, "--png", str(png))
    expect_golden(Image.open(png).convert("RGB"), f"page-{page}", reports)


@pytest.mark.parametrize("page", PAGES)
def test_further_frames_in_all_bands(simulator: Simulator, page: str) -> None:
    crcs = _crcs(simulator, page)
    if UPDATE:
        stored = (stored_crcs(CRCS) if CRCS.exists() else {}) | {page: crcs}
        lines = [" ".join([name, *stored[name]]) for name in PAGES if name in stored]
        CRCS.write_text("\n".join(lines) + "\n", encoding="ascii")
    for lines_per_band in ("8", "1", "7", "240"):
        assert _crcs(simulator, page, "--band", lines_per_band) == stored_crcs(CRCS)[page]


@pytest.mark.parametrize(
    ("arguments", "what"),
    [
        (["--page", "none"], "no page 'none'"),
        (["--band", "0"], "--band"),
        (["--band", "241"], "--band"),
        (["--frames", "x"], "--frames"),
        (["--what"], "--what"),
        (["word"], "word"),
        (["--png", "/nowhere/at/all.png"], "/nowhere/at/all.png"),
    ],
)
def test_bad_options_get_one_line(simulator: Simulator, arguments: list[str], what: str) -> None:
    done = simulator.run("paint", *arguments)
    assert done.returncode == 2
    assert what in done.stderr
    assert done.stderr.count("\n") == 1
    assert done.stdout == ""
