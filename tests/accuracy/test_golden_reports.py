"""A picture that is not golden fails, and the report beside it shows what was expected, what came, and what differs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import golden

LIGHT = (40, 80, 120)


@pytest.fixture
def stored(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of golden pictures with `a.png`, of 8 x 6 pixels of one colour."""
    folder = tmp_path / "golden"
    folder.mkdir()
    Image.new("RGB", (8, 6), LIGHT).save(folder / "a.png")
    monkeypatch.setattr(golden, "GOLDEN", folder)
    monkeypatch.setattr(golden, "UPDATE", False)
    return folder


def _failure(picture: Image.Image, reports: Path, name: str = "a") -> tuple[str, Image.Image]:
    with pytest.raises(pytest.fail.Exception) as failed:
        golden.expect_golden(picture, name, reports)
    return str(failed.value), Image.open(reports / "golden" / f"{name}-diff.png").convert("RGB")


def test_the_same_picture_leaves_no_report(stored: Path, tmp_path: Path) -> None:
    golden.expect_golden(Image.open(stored / "a.png"), "a", tmp_path / "reports")
    assert not (tmp_path / "reports").exists()


def test_one_pixel_is_found_and_shown(stored: Path, tmp_path: Path) -> None:
    picture = Image.new("RGB", (8, 6), LIGHT)
    picture.putpixel((5, 2), (41, 80, 120))
    said, report = _failure(picture, tmp_path)
    assert said.startswith("1 pixels differ from a.png")
    assert str(tmp_path / "golden" / "a-diff.png") in said
    assert report.size == (3 * 8 + 2 * golden.GAP, 6)
    assert report.getpixel((5, 2)) == LIGHT
    assert report.getpixel((8 + golden.GAP + 5, 2)) == (41, 80, 120)
    differs = np.asarray(report)[:, 2 * (8 + golden.GAP) :].max(axis=-1)
    assert np.argwhere(differs).tolist() == [[2, 5]]
    assert Image.open(tmp_path / "golden" / "a.png").tobytes() == picture.tobytes()


def test_another_size_is_a_difference(stored: Path, tmp_path: Path) -> None:
    said, report = _failure(Image.new("RGB", (9, 6), LIGHT), tmp_path)
    assert said.startswith("6 pixels differ")
    assert report.size == (3 * 9 + 2 * golden.GAP, 6)


def test_what_nobody_has_looked_at_is_a_difference(stored: Path, tmp_path: Path) -> None:
    said, _ = _failure(Image.new("RGB", (8, 6), LIGHT), tmp_path, "new")
    assert said.startswith("48 pixels differ from new.png")


def test_a_crc_of_another_name_or_value_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(golden, "UPDATE", False)
    path = tmp_path / "x.crc"
    path.write_text("a 1 2\nb 3 4\n", encoding="ascii")
    golden.expect_crcs(path, {"a": ["1", "2"], "b": ["3", "4"]})
    with pytest.raises(AssertionError, match="b differ"):
        golden.expect_crcs(path, {"a": ["1", "2"], "b": ["3", "5"]})
    with pytest.raises(AssertionError, match="other names"):
        golden.expect_crcs(path, {"a": ["1", "2"]})
