"""The scenes look as they did when somebody last looked at them.

tests/golden has a PNG of frame 0 of each scene, and the CRC-32 of every tenth of the first 120 frames. After a change
that is meant to change pixels: `EDGELINE_UPDATE_GOLDEN=1 python -m pytest tests/accuracy/test_golden_pictures.py`, then
look at the pictures before committing them.
"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from PIL import Image, ImageChops

from sim_commands import Simulator

GOLDEN = Path(__file__).resolve().parents[1] / "golden"
CRCS = GOLDEN / "scenes.crc"
SCENES = ("demo", "teapot", "room", "solid", "field", "S1", "S2", "S2-no-depth", "S3", "S4")
FRAMES = 120
EVERY = 10
UPDATE = bool(os.environ.get("EDGELINE_UPDATE_GOLDEN"))


def _rgb(rgb565: npt.NDArray[np.uint16]) -> Image.Image:
    """Eight bits per channel as PNG wants them, the upper bits repeated below."""
    wide = rgb565.astype(np.uint32)
    red, green, blue = wide >> 11, wide >> 5 & 63, wide & 31
    channels = [red << 3 | red >> 2, green << 2 | green >> 4, blue << 3 | blue >> 2]
    return Image.fromarray(np.stack(channels, axis=-1).astype(np.uint8), "RGB")


def _crcs(simulator: Simulator, scene: str) -> list[str]:
    done = simulator.run("render", "--scene", scene, "--frames", str(FRAMES), "--crc")
    assert done.returncode == 0, done.stderr
    return done.stdout.split()[::EVERY]


def _stored() -> dict[str, list[str]]:
    return {words[0]: words[1:] for words in map(str.split, CRCS.read_text(encoding="ascii").splitlines())}


def test_every_scene_has_its_golden(simulator: Simulator) -> None:
    listed = [line.split()[0] for line in simulator.run("list").stdout.splitlines()]
    assert tuple(listed) == SCENES


@pytest.mark.parametrize("scene", SCENES)
def test_first_frame(simulator: Simulator, reports: Path, tmp_path: Path, scene: str) -> None:
    raw = tmp_path / "frame.raw"
    png = tmp_path / "frame.png"
    done = simulator.run("render", "--scene", scene, "--raw", str(raw), "--png", str(png))
    assert done.returncode == 0, done.stderr
    picture = _rgb(np.fromfile(raw, "<u2").reshape(240, 320))
    assert ImageChops.difference(picture, Image.open(png)).getbbox() is None, "--png and --raw differ"
    golden = GOLDEN / f"{scene}.png"
    if UPDATE:
        picture.save(golden, optimize=True)
    difference = ImageChops.difference(picture, Image.open(golden).convert("RGB"))
    if difference.getbbox() is not None:
        folder = reports / "golden"
        folder.mkdir(parents=True, exist_ok=True)
        picture.save(folder / f"{scene}.png")
        difference.point(lambda value: 255 if value else 0).save(folder / f"{scene}-diff.png")
        wrong = int((np.asarray(difference).max(axis=-1) > 0).sum())
        pytest.fail(f"{wrong} pixels differ from {golden.name} within {difference.getbbox()}: see {folder}")


@pytest.mark.parametrize("scene", SCENES)
def test_further_frames(simulator: Simulator, scene: str) -> None:
    crcs = _crcs(simulator, scene)
    if UPDATE:
        stored = (_stored() if CRCS.exists() else {}) | {scene: crcs}
        lines = [" ".join([name, *stored[name]]) for name in SCENES if name in stored]
        CRCS.write_text("\n".join(lines) + "\n", encoding="ascii")
    wrong = [EVERY * i for i, (is_, was) in enumerate(zip(crcs, _stored()[scene], strict=True)) if is_ != was]
    assert not wrong, f"frames {wrong} differ"
