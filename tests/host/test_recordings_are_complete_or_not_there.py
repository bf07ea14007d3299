"""PNG, animated PNG, GIF and sequences read back with Pillow: pixels, durations, and what is left after a failure."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from edgeline.codec import Pixels
from edgeline.colour import to_rgb
from edgeline.errors import OutputError
from edgeline.recorder import recorder, save_png
from fake_device import bars

SCENE = bars(60, 40)


def flat(frame: int) -> Pixels:
    """Few colours, so that a GIF holds them exactly."""
    picture = np.full((40, 60), 0x1082, "<u2")
    picture[10:20, frame : frame + 20] = 0xFFE0
    return picture


def played(path: Path) -> list[tuple[np.ndarray, float]]:
    """Every frame as a viewer composes it, and its duration in ms."""
    frames = []
    with Image.open(path) as image:
        for i in range(getattr(image, "n_frames", 1)):
            image.seek(i)
            frames.append((np.asarray(image.convert("RGB")), image.info.get("duration", 0.0)))
    return frames


def record(path: Path, pictures: list[Pixels], times_us: list[int]) -> None:
    writer = recorder(str(path))
    for picture, time_us in zip(pictures, times_us, strict=True):
        writer.add(picture, time_us)
    writer.finish()


def test_a_shot_is_exact(tmp_path: Path) -> None:
    save_png(str(tmp_path / "shot.png"), SCENE(3))
    assert np.array_equal(played(tmp_path / "shot.png")[0][0], to_rgb(SCENE(3)))
    assert [path.name for path in tmp_path.iterdir()] == ["shot.png"]


@pytest.mark.parametrize("name", ["a.png", "a.apng"])
def test_an_animated_png_is_exact(tmp_path: Path, name: str) -> None:
    pictures = [SCENE(i) for i in range(9)]
    times = [40_000 * i for i in range(9)]
    record(tmp_path / name, pictures, times)
    frames = played(tmp_path / name)
    assert [duration for _, duration in frames] == [40.0] * 9
    for (shown, _), picture in zip(frames, pictures, strict=True):
        assert np.array_equal(shown, to_rgb(picture))


def test_a_gif_of_few_colours_is_exact(tmp_path: Path) -> None:
    pictures = [flat(i) for i in (0, 1, 2, 9, 30)]
    record(tmp_path / "a.gif", pictures, [0, 40_000, 80_000, 200_000, 240_000])
    frames = played(tmp_path / "a.gif")
    assert [duration for _, duration in frames] == [40, 40, 120, 40, 40]
    for (shown, _), picture in zip(frames, pictures, strict=True):
        assert np.array_equal(shown, to_rgb(picture))


def test_a_gif_of_many_colours_is_close(tmp_path: Path) -> None:
    pictures = [SCENE(i) for i in range(3)]
    record(tmp_path / "a.gif", pictures, [0, 40_000, 80_000])
    for (shown, _), picture in zip(played(tmp_path / "a.gif"), pictures, strict=True):
        exact = to_rgb(picture).astype(int)
        assert np.array_equal(shown[:10], exact[:10])
        assert np.abs(shown - exact).mean() < 8


def test_gif_delays_do_not_drift(tmp_path: Path) -> None:
    record(tmp_path / "a.gif", [flat(i % 30) for i in range(100)], [33_333 * i for i in range(100)])
    total = sum(duration for _, duration in played(tmp_path / "a.gif"))
    assert abs(total - 3333) <= 10


def test_a_gif_is_never_faster_than_viewers_play(tmp_path: Path) -> None:
    record(tmp_path / "a.gif", [flat(i) for i in range(20)], [2000 * i for i in range(20)])
    assert {duration for _, duration in played(tmp_path / "a.gif")} == {20}


def test_the_clock_may_wrap_and_restart(tmp_path: Path) -> None:
    record(tmp_path / "a.png", [flat(i) for i in range(4)], [2**32 - 40_000, 0, 40_000, 5])
    assert [duration for _, duration in played(tmp_path / "a.png")] == [40, 40, 40, 40]


def test_unchanged_frames_stay_frames(tmp_path: Path) -> None:
    for name in ("a.gif", "a.png"):
        record(tmp_path / name, [flat(1), flat(1), flat(1), flat(2)], [0, 50_000, 100_000, 150_000])
        with Image.open(tmp_path / name) as image:
            assert getattr(image, "n_frames", 1) == 4


def test_a_sequence_is_numbered_and_exact(tmp_path: Path) -> None:
    record(tmp_path / "frames/f%03d.png", [SCENE(i) for i in range(3)], [0, 1, 2])
    assert sorted(path.name for path in (tmp_path / "frames").iterdir()) == ["f000.png", "f001.png", "f002.png"]
    assert np.array_equal(played(tmp_path / "frames/f002.png")[0][0], to_rgb(SCENE(2)))


@pytest.mark.parametrize("name", ["a.gif", "a.png"])
def test_without_frames_or_when_discarded_the_old_file_stays(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_bytes(b"precious")
    recorder(str(tmp_path / name)).finish()
    writer = recorder(str(tmp_path / name))
    writer.add(flat(0), 0)
    writer.add(flat(1), 1)
    writer.discard()
    assert (tmp_path / name).read_bytes() == b"precious"
    assert [path.name for path in tmp_path.iterdir()] == [name]


@pytest.mark.parametrize("name", ["a.gif", "a.png"])
def test_a_full_disk_leaves_the_old_file(tmp_path: Path, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / name).write_bytes(b"precious")

    def full(_: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OutputError, match="No space left"):
        record(tmp_path / name, [flat(0)], [0])
    assert (tmp_path / name).read_bytes() == b"precious"
    assert [path.name for path in tmp_path.iterdir()] == [name]


@pytest.mark.parametrize(
    "name", ["a.bmp", "a", "%d.gif", "a%x.png", "a%d%d.png", "a%.png", "no/such/folder/a.gif", "."]
)
def test_names_that_cannot_be_written_are_refused_at_once(tmp_path: Path, name: str) -> None:
    with pytest.raises(OutputError):
        recorder(str(tmp_path / name))
    assert list(tmp_path.iterdir()) == []


def test_a_long_recording_takes_the_memory_of_one_frame(tmp_path: Path) -> None:
    writer = recorder(str(tmp_path / "a.gif"))
    for i in range(600):
        writer.add(flat(i % 40), 40_000 * i)
    held = [value for value in vars(writer).values() if isinstance(value, np.ndarray | list)]
    assert len(held) <= 2
    writer.finish()
    assert len(played(tmp_path / "a.gif")) == 600
