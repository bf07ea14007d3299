"""Every feature looks as it did when somebody last looked at it: tests/features says what each picture should show.

tests/golden has feature-NAME.png, and features.crc with the CRC-32 of each with 1, 4 and 8 samples per pixel, which
tests/target compares on all cores. After a change that is meant to change them: `EDGELINE_UPDATE_GOLDEN=1 python -m
pytest tests/accuracy/test_golden_features.py`, then look at the pictures before committing them.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

from conftest import REPOSITORY
from features_program import Features
from golden import GOLDEN, expect_crcs, expect_golden, rgb_of

CRCS = GOLDEN / "features.crc"
SAMPLES = ("0", "4", "8")
SMOOTH = "4"
SHARP = {"wires"}
"""What is refused with several samples."""

LIST = REPOSITORY / "tests" / "features" / "features.c"
NAMES = re.findall(r"&feature_(\w+)", LIST.read_text(encoding="utf-8"))

SMOOTH_NAMES = [name for name in NAMES if name not in SHARP]

Pictures = dict[str, npt.NDArray[np.uint16]]


@pytest.fixture(scope="module")
def pictures(features: Features, tmp_path_factory: pytest.TempPathFactory) -> Pictures:
    return features.pictures(tmp_path_factory.mktemp("features"))


@pytest.fixture(scope="module")
def smooth_pictures(features: Features, tmp_path_factory: pytest.TempPathFactory) -> Pictures:
    return features.pictures(tmp_path_factory.mktemp("smooth"), "--samples", SMOOTH)


def test_every_feature_has_its_picture(pictures: Pictures, smooth_pictures: Pictures) -> None:
    assert list(pictures) == NAMES
    assert list(smooth_pictures) == SMOOTH_NAMES
    stored = {path.stem.removeprefix("feature-") for path in GOLDEN.glob("feature-*.png")}
    assert stored == {*NAMES, *(f"{name}-{SMOOTH}-samples" for name in SMOOTH_NAMES)}


@pytest.mark.parametrize("name", NAMES)
def test_a_feature_looks_as_it_did(pictures: Pictures, reports: Path, name: str) -> None:
    expect_golden(rgb_of(pictures[name]), f"feature-{name}", reports)


@pytest.mark.parametrize("name", SMOOTH_NAMES)
def test_a_smooth_feature_looks_as_it_did(smooth_pictures: Pictures, reports: Path, name: str) -> None:
    expect_golden(rgb_of(smooth_pictures[name]), f"feature-{name}-{SMOOTH}-samples", reports)


def test_every_feature_has_the_crcs_it_had(features: Features) -> None:
    drawn = [features.draw("--samples", samples) for samples in SAMPLES]
    expect_crcs(CRCS, {name: [way[name].crc for way in drawn if name in way] for name in drawn[0]})


def test_polygons_and_triangles_share_edges_exactly(pictures: Pictures) -> None:
    """Half-transparent polygons fill what triangles leave: a pixel drawn twice, or not at all, has a fourth colour."""
    assert len(np.unique(pictures["seams"])) == 3


def test_what_is_picked_is_what_is_seen(pictures: Pictures) -> None:
    """The inner square of each mark has the colour of the draw call that was picked in its middle: it is that of the
    pixels around the mark, where these have only one."""
    picture = pictures["picking"]
    seen = 0
    for y in range(8, picture.shape[0], 16):
        for x in range(8, picture.shape[1], 16):
            around = picture[y - 5 : y + 5, x - 5 : x + 5].copy()
            inside = np.unique(around[3:7, 3:7])
            around[1:9, 1:9] = around[0, 0]
            if len(np.unique(around)) == 1 and around[0, 0] != 0:
                seen += 1
                assert inside.tolist() == [around[0, 0]], (x, y)
    assert seen > 20
