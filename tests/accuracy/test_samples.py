"""Several samples per pixel, and pixels of three stripes: the same pixels for every band height, arena and number of cores;
golden pictures; and how far pictures are from what 256 samples show."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

from golden import expect_golden, rgb_of
from sim_commands import Simulator

SCENES = ("S1", "S2", "S2-no-depth", "S3", "teapot", "room", "solid", "field")
WIDTH, HEIGHT, FINER = 120, 90, 16
THIRD = round(FINER / 3)

# The root of the mean squared error in 8-bit levels with 1, 4 and 8 samples, rounded up; see the report.
ERRORS = {"S1": (7.0, 2.8, 1.9), "S3": (33.2, 14.0, 8.9), "solid": (8.1, 3.1, 2.1), "field": (7.7, 3.3, 2.2)}


# The same with RGB stripes, each channel against the 256 samples about its stripe.
STRIPES_ERRORS = {"S1": 3.5, "S3": 17.2, "solid": 4.8, "field": 6.1}


def _crcs(simulator: Simulator, scene: str, *arguments: str) -> list[str]:
    return simulator.render("--scene", scene, "--frames=2", *arguments, width=200, height=120, pictures=False).crcs


@pytest.mark.parametrize("option", ["--samples=4", "--samples=8", "--stripes=rgb"])
@pytest.mark.parametrize("scene", SCENES)
def test_every_band_arena_and_core_draws_the_same(simulator: Simulator, scene: str, option: str) -> None:
    crcs = _crcs(simulator, scene, option)
    assert crcs != _crcs(simulator, scene), "there is nothing to smooth"
    for band in (1, 2, 3, 16, 120):
        assert _crcs(simulator, scene, option, f"--band={band}") == crcs, band
    for arena in (60_000, 90_000):
        assert _crcs(simulator, scene, option, f"--arena={arena}", "--band=4") == crcs, arena
    for threads in (2, 3):
        assert _crcs(simulator, scene, option, f"--threads={threads}") == crcs, threads


@pytest.mark.parametrize(("scene", "samples"), [("S1", 4), ("S3", 8), ("solid", 4), ("room", 8)])
def test_golden(simulator: Simulator, reports: Path, scene: str, samples: int) -> None:
    picture = simulator.render("--scene", scene, f"--samples={samples}").colour[0]
    expect_golden(rgb_of(picture), f"{scene}-{samples}-samples", reports)


@pytest.mark.parametrize(("scene", "order"), [("S1", "rgb"), ("solid", "bgr")])
def test_golden_stripes(simulator: Simulator, reports: Path, scene: str, order: str) -> None:
    picture = simulator.render("--scene", scene, f"--stripes={order}").colour[0]
    expect_golden(rgb_of(picture), f"{scene}-{order}-stripes", reports)


def test_orders_of_stripes_differ_in_the_outer_two(simulator: Simulator) -> None:
    """That a frame is the one of three times the width, filtered, is for tests/unit/test_stripes.c."""
    rgb = simulator.render("--scene", "S1", "--stripes=rgb").colour[0]
    bgr = simulator.render("--scene", "S1", "--stripes=bgr").colour[0]
    assert (rgb != bgr).any() and ((rgb ^ bgr) & 0x07E0 == 0).all()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--stripes=grb"], "none, rgb or bgr"),
        (["--stripes=rgb", "--size=681x8"], "680 pixels"),
        (["--stripes=rgb", "--arena=20000"], "too small"),
    ],
)
def test_bad_stripes_get_one_line(checked_simulator: Simulator, arguments: list[str], words: str) -> None:
    done = checked_simulator.run("render", "--scene", "S1", "--crc", *arguments)
    assert (done.returncode, done.stdout) == (2, "") and words in done.stderr, done.stderr
    assert len(done.stderr.splitlines()) == 1


def _levels(rgb565: npt.NDArray[np.uint16]) -> npt.NDArray[np.float64]:
    wide = rgb565.astype(np.float64)
    red, green, blue = wide // 2048, wide // 32 % 64, wide % 32
    return np.stack([red * (255 / 31), green * (255 / 63), blue * (255 / 31)], axis=-1)


def _about(fine: npt.NDArray[np.uint16], channel: int, shift: int) -> npt.NDArray[np.float64]:
    """A channel's means over areas of a pixel, so many of the fine columns to the right of the pixels."""
    padded = np.pad(_levels(fine)[..., channel], ((0, 0), (FINER, FINER)), mode="edge")
    moved = padded[:, FINER + shift : FINER + shift + WIDTH * FINER]
    means: npt.NDArray[np.float64] = moved.reshape(HEIGHT, FINER, WIDTH, FINER).mean(axis=(1, 3))
    return means


@pytest.mark.parametrize("scene", ERRORS)
def test_error_against_256_samples(simulator: Simulator, scene: str, reports: Path) -> None:
    """The picture of 16 times the width and height has 256 samples for each pixel of this one."""
    fine = simulator.render("--scene", scene, width=WIDTH * FINER, height=HEIGHT * FINER).colour[0]
    reference = _levels(fine).reshape(HEIGHT, FINER, WIDTH, FINER, 3).mean(axis=(1, 3))
    lines = []
    found = []
    for samples in (1, 4, 8):
        picture = simulator.render("--scene", scene, f"--samples={samples}", width=WIDTH, height=HEIGHT).colour[0]
        error = np.abs(_levels(picture) - reference).max(axis=-1)
        found.append(float(np.sqrt((error**2).mean())))
        lines.append(f"{scene} {samples} mean {error.mean():.2f} rms {found[-1]:.2f} max {error.max():.0f}")
    shown = simulator.render("--scene", scene, "--stripes=rgb", width=WIDTH, height=HEIGHT).colour[0]
    about = np.stack([_about(fine, channel, shift) for channel, shift in enumerate((-THIRD, 0, THIRD))], axis=-1)
    error = np.abs(_levels(shown) - about).max(axis=-1)
    striped = float(np.sqrt((error**2).mean()))
    lines.append(f"{scene} stripes mean {error.mean():.2f} rms {striped:.2f} max {error.max():.0f}")
    (reports / f"samples-{scene}.txt").write_text("\n".join(lines) + "\n", encoding="ascii")
    assert all(is_ <= most for is_, most in zip(found, ERRORS[scene], strict=True)), lines
    assert found[1] < found[0] / 2 and found[2] < found[1], lines
    assert striped <= STRIPES_ERRORS[scene], lines
