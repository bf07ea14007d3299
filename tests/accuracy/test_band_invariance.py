"""The same pixels for every band height, every size of the arena and every number of passes."""

from __future__ import annotations

import zlib
from functools import cache

import numpy as np
import pytest

from features_program import Features
from sim_commands import Simulator, SimulatorError

BANDS = [1, 2, 3, 7, 8, 16, 240]
FRAMES = 3
PASSES = [2, 5]
LARGEST = 64 << 20


def _scenes(simulator: Simulator) -> list[str]:
    scenes = simulator.scenes()
    assert {"S1", "S2", "S3", "S4"} <= {scene.upper() for scene in scenes}, scenes
    return scenes


def _crcs(simulator: Simulator, scene: str, *arguments: str) -> list[str]:
    crcs = simulator.render("--scene", scene, "--frames", str(FRAMES), *arguments, pictures=False).crcs
    assert len(crcs) == FRAMES, crcs
    return crcs


@cache
def _passes(simulator: Simulator, scene: str, arena: int, band: int) -> int:
    """The most passes of any frame with this arena; 1000 when it is too small to draw at all."""
    try:
        answer = simulator.render(
            "--scene", scene, f"--frames={FRAMES}", f"--arena={arena}", f"--band={band}", pictures=False
        )
    except SimulatorError:
        return 1000
    return max(int(stats["passes"]) for stats in answer.stats)


def _arena_for(simulator: Simulator, scene: str, passes: int, band: int) -> int | None:
    """The smallest arena, to 16 bytes, with which no frame takes more passes; None where such frames need fewer."""
    low, high = 0, LARGEST
    while high - low > 16:
        middle = (low + high) // 2
        low, high = (low, middle) if _passes(simulator, scene, middle, band) <= passes else (middle, high)
    return high if _passes(simulator, scene, high, band) == passes else None


def test_every_band_height_draws_the_same(simulator: Simulator) -> None:
    for scene in _scenes(simulator):
        crcs = {band: _crcs(simulator, scene, "--band", str(band)) for band in BANDS}
        assert all(crcs[band] == crcs[BANDS[0]] for band in BANDS), (scene, crcs)


@pytest.mark.parametrize("band", [1, 8, 16])
def test_every_number_of_passes_draws_the_same(simulator: Simulator, band: int) -> None:
    """Arenas that force just so many passes are found by bisection; most scenes must have some for each number."""
    found = dict.fromkeys(PASSES, 0)
    scenes = _scenes(simulator)
    for scene in scenes:
        one_pass = _crcs(simulator, scene, f"--arena={LARGEST}", f"--band={band}")
        assert _passes(simulator, scene, LARGEST, band) == 1, f"{scene}: more than one pass with {LARGEST} bytes"
        for passes in PASSES:
            arena = _arena_for(simulator, scene, passes, band)
            if arena is not None:
                found[passes] += 1
                crcs = _crcs(simulator, scene, f"--arena={arena}", f"--band={band}")
                assert crcs == one_pass, f"{scene}: --arena {arena} --band {band} takes {passes} passes"
    assert all(count >= 2 for count in found.values()), f"scenes with so many passes: {found} of {len(scenes)}"


@pytest.mark.parametrize(("width", "height"), [(1, 1), (7, 5), (33, 200), (240, 320), (321, 17)])
def test_other_screens_are_drawn_the_same(simulator: Simulator, width: int, height: int) -> None:
    """Colour and depth of each pixel, on screens that bands and passes do not divide evenly."""
    for scene in _scenes(simulator):
        pictures = [
            simulator.render("--scene", scene, "--band", str(band), width=width, height=height)
            for band in {1, min(3, height), height}
        ]
        for picture in pictures[1:]:
            assert np.array_equal(picture.colour, pictures[0].colour), scene
            assert np.array_equal(picture.depth, pictures[0].depth), scene


def test_a_crc_is_that_of_the_pixels(simulator: Simulator) -> None:
    for scene in _scenes(simulator):
        answer = simulator.render("--scene", scene, "--frames", "2")
        assert [int(line.split()[-1], 16) for line in answer.crcs] == [
            zlib.crc32(frame.astype("<u2").tobytes()) for frame in answer.colour
        ]


def test_frames_differ(simulator: Simulator) -> None:
    """A scene that stands still, or a CRC of nothing, would make the other tests empty."""
    moving = [scene for scene in _scenes(simulator) if len(set(_crcs(simulator, scene))) == FRAMES]
    assert moving


# --- features: every kind of material, light, layer and helper --------------------------------------------------------

FEATURE_BANDS = (1, 3, 8, 17, 160)
WAYS = {
    "one core": [],
    "one core, little memory": ["--more", "0"],
    "two cores": ["--threads", "2"],
    "two cores, some memory": ["--threads", "2", "--more", "2000"],
}


@pytest.mark.parametrize("samples", ["0", "4", "8"])
def test_every_feature_is_drawn_the_same(checked_features: Features, samples: str) -> None:
    """Colour and depth, in bands of any height, by one core and by two, in one pass and in several."""
    option = ["--samples", samples]
    expected = checked_features.draw(*option)
    most_passes = dict.fromkeys(expected, 0)
    for name, way in WAYS.items():
        for band in FEATURE_BANDS:
            drawn = checked_features.draw(*option, *way, "--band", str(band))
            wrong = [feature for feature, is_ in drawn.items() if is_[:2] != expected[feature][:2]]
            assert not wrong, f"{name}, bands of {band} lines, {samples} samples: {wrong}"
            most_passes = {feature: max(most, drawn[feature].passes) for feature, most in most_passes.items()}
    assert set(drawn) == set(expected)
    assert sum(most >= 2 for most in most_passes.values()) > len(expected) / 2, "too much memory for several passes"


def test_features_are_drawn_the_same_with_a_depth_pre_pass(checked_features: Features) -> None:
    """All but those whose blended depth the pre-pass refuses."""
    expected = checked_features.draw()
    assert set(expected) - set(checked_features.draw("--prepass")) == {"alpha", "wires"}
    for band in FEATURE_BANDS:
        for name, is_ in checked_features.draw("--prepass", "--band", str(band)).items():
            assert is_[:2] == expected[name][:2], (name, band)


def test_two_interlaced_frames_are_the_whole_picture(checked_features: Features) -> None:
    expected = checked_features.draw()
    for band in FEATURE_BANDS:
        for arena in ("0", "200000"):
            drawn = checked_features.draw("--interlaced", "--band", str(band), "--more", arena)
            assert {name: is_[:2] for name, is_ in drawn.items()} == {name: is_[:2] for name, is_ in expected.items()}


def test_samples_show(features: Features) -> None:
    """Where nothing were smoothed, the comparison of samples would be one of nothing."""
    plain, smooth, smoother = (features.draw("--samples", samples) for samples in ("0", "4", "8"))
    flat = {"sprites"}  # a layer alone
    for name, drawn in smooth.items():
        assert (len({plain[name].crc, drawn.crc, smoother[name].crc}) == 3) == (name not in flat), name
