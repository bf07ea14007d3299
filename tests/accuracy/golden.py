"""Golden pictures: what somebody has looked at and found right, in tests/golden."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from PIL import Image, ImageChops

GOLDEN = Path(__file__).resolve().parents[1] / "golden"
UPDATE = bool(os.environ.get("EDGELINE_UPDATE_GOLDEN"))
"""Pictures and figures are to be written, not compared; somebody looks at them before committing them."""

GAP = 4
"""Pixels between the pictures of a report."""


def side_by_side(expected: Image.Image, got: Image.Image) -> tuple[Image.Image, int]:
    """What was expected, what came, and what differs - white where all of a channel does - in one picture; and how many
    pixels differ. A picture of another size differs where the other one has nothing."""
    width, height = (max(a, b) for a, b in zip(expected.size, got.size, strict=True))
    report = Image.new("RGB", (3 * width + 2 * GAP, height), (255, 0, 255))
    pictures = []
    for picture in (expected, got):
        whole = Image.new("RGBA", (width, height))
        whole.paste(picture, (0, 0))
        pictures.append(whole)
    difference = np.asarray(ImageChops.difference(*pictures).convert("RGBA")).max(axis=-1)
    lines = Image.fromarray(np.where(difference > 0, np.maximum(difference, 96), 0).astype(np.uint8))
    for i, picture in enumerate((expected, got, lines)):
        report.paste(picture, (i * (width + GAP), 0))
    return report, int((difference > 0).sum())


def expect_golden(picture: Image.Image, name: str, reports: Path) -> None:
    """Fails where the RGB picture is not that of `name`.png, and leaves it in the reports, with a comparison."""
    golden = GOLDEN / f"{name}.png"
    if UPDATE:
        picture.save(golden, optimize=True)
    expected = Image.open(golden).convert("RGB") if golden.is_file() else Image.new("RGB", (0, 0))
    report, wrong = side_by_side(expected, picture)
    if wrong:
        folder = reports / "golden"
        folder.mkdir(parents=True, exist_ok=True)
        picture.save(folder / golden.name)
        report.save(folder / f"{name}-diff.png")
        pytest.fail(
            f"{wrong} pixels differ from {golden.name}: see {folder / name}-diff.png, expected, got, difference"
        )


def rgb_of(rgb565: npt.NDArray[np.uint16]) -> Image.Image:
    """Eight bits per channel as PNG wants them, the upper bits repeated below."""
    wide = rgb565.astype(np.uint32)
    red, green, blue = wide >> 11, wide >> 5 & 63, wide & 31
    channels = [red << 3 | red >> 2, green << 2 | green >> 4, blue << 3 | blue >> 2]
    return Image.fromarray(np.stack(channels, axis=-1).astype(np.uint8), "RGB")


def stored_crcs(path: Path) -> dict[str, list[str]]:
    """The lines of a file of CRCs: a name, and what it has."""
    return {words[0]: words[1:] for words in map(str.split, path.read_text(encoding="ascii").splitlines())}


def expect_crcs(path: Path, found: dict[str, list[str]]) -> None:
    """Fails where the file has not these names, in this order, with these CRCs."""
    if UPDATE:
        path.write_text("".join(f"{' '.join([name, *crcs])}\n" for name, crcs in found.items()), encoding="ascii")
    stored = stored_crcs(path)
    assert list(found) == list(stored), f"{path.name} has other names"
    wrong = [name for name, crcs in found.items() if crcs != stored[name]]
    assert not wrong, f"{path.name}: {', '.join(wrong)} differ"
