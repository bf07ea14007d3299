"""Several samples per pixel: the same pixels for every band height, arena and number of cores; golden pictures; and how
far pictures are from what 256 samples show."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

from golden import expect_golden, rgb_of
from sim_commands import Simulator

SCENES = ("S1", "S2", "S2-no-depth", "S3", "teapot", "room", "solid", "field")
WIDTH, HEIGHT, FINER = 120, 90, 16

# The root of the mean squared error in 8-bit levels with 1, 4 and 8 samples, rounded up; see the report.
ERRORS = {"S1": (7.0, 2.8, 1.9), "S3": (33.2, 14.0, 8.9), "solid": (8.1, 3.1, 2.1), "field": (7.7, 3.3, 2.2)}


def _crcs(simulator: Simulator, scene: str, *arguments: str) -> list[str]:
    return simulator.render("--scene", scene, "--frames=2", *arguments, width=200, height=120, pictures=False).crcs


@pytest.mark.parametrize("samples", [4, 8])
@pytest.mark.parametrize("scene", SCENES)
def test_every_band_arena_and_core_draws_the_same(simulator: Simulator, scene: str, samples: int) -> None:
    option = f"--samples={samples}"
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


def _levels(rgb565: npt.NDArray[np.uint16]) -> npt.NDArray[np.float64]:
    wide = rgb565.astype(np.float64)
    red, green, blue = wide // 2048, wide // 32 % 64, wide % 32
    return np.stack([red * (255 / 31), green * (255 / 63), blue * (255 / 31)], axis=-1)


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
    (reports / f"samples-{scene}.txt").write_text("\n".join(lines) + "\n", encoding="ascii")
    assert all(is_ <= most for is_, most in zip(found, ERRORS[scene], strict=True)), lines
    assert found[1] < found[0] / 2 and found[2] < found[1], lines
