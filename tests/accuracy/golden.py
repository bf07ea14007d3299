"""Golden pictures: what somebody has looked at and found right, in tests/golden."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageChops

GOLDEN = Path(__file__).resolve().parents[1] / "golden"
UPDATE = bool(os.environ.get("EDGELINE_UPDATE_GOLDEN"))
"""Pictures and figures are to be written, not compared; somebody looks at them before committing them."""


def expect_golden(picture: Image.Image, name: str, reports: Path) -> None:
    """Fails where the RGB picture is not that of `name`.png, and leaves it in the reports with where it differs."""
    golden = GOLDEN / f"{name}.png"
    if UPDATE:
        picture.save(golden, optimize=True)
    difference = ImageChops.difference(picture, Image.open(golden).convert("RGB"))
    if difference.getbbox() is not None:
        folder = reports / "golden"
        folder.mkdir(parents=True, exist_ok=True)
        picture.save(folder / f"{name}.png")
        difference.point(lambda value: 255 if value else 0).save(folder / f"{name}-diff.png")
        wrong = int((np.asarray(difference).max(axis=-1) > 0).sum())
        pytest.fail(f"{wrong} pixels differ from {golden.name} within {difference.getbbox()}: see {folder}")


def stored_crcs(path: Path) -> dict[str, list[str]]:
    """The lines of a file of CRCs: a name, and what it has."""
    return {words[0]: words[1:] for words in map(str.split, path.read_text(encoding="ascii").splitlines())}
