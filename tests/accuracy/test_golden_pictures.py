"""The scenes look as they did when somebody last looked at them.

tests/golden has a PNG of frame 0 of each scene, and the CRC-32 of every tenth of the first 120 frames. After a change
that is meant to change pixels: `EDGELINE_UPDATE_GOLDEN=1 python -m pytest tests/accuracy/test_golden_pictures.py`, then
look at the pictures before committing them.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageChops

from golden import GOLDEN, UPDATE, expect_golden, rgb_of, stored_crcs
from sim_commands import Simulator

CRCS = GOLDEN / "scenes.crc"
SCENES = (
    *("demo", "teapot", "room", "solid", "field", "S1", "S2", "S2-no-depth", "S3", "S4"),
    *("materials", "lamps", "wires"),
)
FRAMES = 120
EVERY = 10


def _crcs(simulator: Simulator, scene: str) -> list[str]:
    done = simulator.run("render", "--scene", scene, "--frames", str(FRAMES), "--crc")
    assert done.returncode == 0, done.stderr
    return done.stdout.split()[::EVERY]


def test_every_scene_has_its_golden(simulator: Simulator) -> None:
    listed = [line.split()[0] for line in simulator.run("list").stdout.splitlines()]
    assert tuple(listed) == SCENES


@pytest.mark.parametrize("scene", SCENES)
def test_first_frame(simulator: Simulator, reports: Path, tmp_path: Path, scene: str) -> None:
    raw = tmp_path / "frame.raw"
    png = tmp_path / "frame.png"
    done = simulator.run("render", "--scene", scene, "--raw", str(raw), "--png", str(png))
    assert done.returncode == 0, done.stderr
    picture = rgb_of(np.fromfile(raw, "<u2").reshape(240, 320))
    assert ImageChops.difference(picture, Image.open(png)).getbbox() is None, "--png and --raw differ"
    expect_golden(picture, scene, reports)


@pytest.mark.parametrize("scene", SCENES)
def test_further_frames(simulator: Simulator, scene: str) -> None:
    crcs = _crcs(simulator, scene)
    if UPDATE:
        stored = (stored_crcs(CRCS) if CRCS.exists() else {}) | {scene: crcs}
        lines = [" ".join([name, *stored[name]]) for name in SCENES if name in stored]
        CRCS.write_text("\n".join(lines) + "\n", encoding="ascii")
    wrong = [EVERY * i for i, (is_, was) in enumerate(zip(crcs, stored_crcs(CRCS)[scene], strict=True)) if is_ != was]
    assert not wrong, f"frames {wrong} differ"
