"""The debug views look as they did when somebody last looked at them, in every band height and arena; their colours are
what debug_view.h says; offsets and views of the command line that do not exist are named.

tests/golden has a PNG of each view of the room, and views.crc a CRC-32 of each view of frame 0 of each scene. After a
change that is meant to change them: `EDGELINE_UPDATE_GOLDEN=1 python -m pytest tests/accuracy/test_debug_views.py`,
and look at the pictures before committing them.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from pathlib import Path

import pytest
from PIL import Image

from conftest import REPOSITORY
from golden import GOLDEN, expect_crcs, expect_golden, stored_crcs
from sim_commands import Simulator

CRCS = GOLDEN / "views.crc"
HEADER = REPOSITORY / "firmware" / "src" / "frame" / "debug_view.h"
SOURCE = HEADER.with_suffix(".c")
VIEWS = ("overdraw", "depth", "triangles", "bands", "rejected")
SAME_IN_ALL_BANDS = ("overdraw", "depth", "triangles", "rejected")


def _crc(simulator: Simulator, scene: str, view: str, *arguments: str) -> str:
    return simulator.run_well("render", "--scene", scene, "--view", view, "--crc", *arguments).strip()


def test_the_simulator_names_its_views(simulator: Simulator) -> None:
    lines = [line.split(maxsplit=1) for line in simulator.run_well("list", "views").splitlines()]
    assert [name for name, _ in lines] == ["picture", *VIEWS]
    assert len({summary for _, summary in lines}) == len(lines)


@pytest.mark.parametrize("view", VIEWS)
def test_the_room_looks_as_it_did(simulator: Simulator, reports: Path, tmp_path: Path, view: str) -> None:
    drawn = tmp_path / "drawn.png"
    simulator.run_well("render", "--scene", "room", "--view", view, "--png", str(drawn))
    expect_golden(Image.open(drawn).convert("RGB"), f"view-{view}", reports)


def test_every_scene_has_the_views_it_had(simulator: Simulator) -> None:
    expect_crcs(CRCS, {scene: [_crc(simulator, scene, view) for view in VIEWS] for scene in simulator.scenes()})


@pytest.mark.parametrize("view", SAME_IN_ALL_BANDS)
def test_the_same_for_every_band_height_and_arena(simulator: Simulator, view: str) -> None:
    at = VIEWS.index(view)
    for scene, crcs in stored_crcs(CRCS).items():
        for arguments in (["--band", "1"], ["--band", "7", "--arena", "40000"], ["--band", "240"]):
            assert _crc(simulator, scene, view, *arguments) == crcs[at], f"{scene} {' '.join(arguments)}"


def test_the_picture_is_no_other_for_the_camera_at_rest(simulator: Simulator) -> None:
    picture = simulator.run_well("render", "--scene", "room", "--crc", "--frames", "3")
    at_rest = ["--view", "picture", "--yaw", "0", "--pitch", "0", "--zoom", "0", "--pan-x", "0", "--pan-y", "0"]
    assert simulator.run_well("render", "--scene", "room", "--crc", "--frames", "3", *at_rest) == picture
    assert simulator.run_well("render", "--scene", "room", "--crc", "--frames", "3", "--yaw", "65536") == picture


def test_a_mesh_has_views_too(simulator: Simulator, convert: Callable[..., Path]) -> None:
    mesh = str(convert("spot_control_mesh.obj"))
    crcs = {simulator.run_well("render", "--mesh", mesh, "--view", view, "--crc") for view in ("picture", *VIEWS)}
    assert len(crcs) == 1 + len(VIEWS)
    done = simulator.run("render", "--mesh", mesh, "--yaw", "1")
    assert (done.returncode, done.stdout) == (2, "")
    assert "go with a scene; a mesh has --eye and --look-at" in done.stderr


BAD = {
    "unknown view": (["--view", "x-ray"], "there is no view 'x-ray'; `edgeline-sim list views` names them"),
    "pitch beyond a quarter turn": (["--pitch", "16385"], "--pitch"),
    "zoom too large": (["--zoom=-1025"], "--zoom"),
    "pan no number": (["--pan-x", "left"], "--pan-x"),
    "shading unknown": (["--shading", "shiny"], "--shading takes flat, gouraud or textured, not 'shiny'"),
}


@pytest.mark.parametrize("case", BAD)
def test_what_is_not_there_is_named(checked_simulator: Simulator, case: str) -> None:
    arguments, words = BAD[case]
    done = checked_simulator.run("render", *arguments)
    assert done.returncode == 2
    assert words in done.stderr
    assert len(done.stderr.splitlines()) == 1, done.stderr


# --- the colours ------------------------------------------------------------------------------------------------------


def _linear(lightness: float, chroma: float, hue: float) -> list[float]:
    """CIE L*a*b* (D65) to linear sRGB; IEC 61966-2-1."""
    y = (lightness + 16) / 116
    a, b = chroma * math.cos(hue), chroma * math.sin(hue)
    edge = 6 / 29
    x, y, z = (t**3 if t > edge else 3 * edge**2 * (t - 4 / 29) for t in (y + a / 500, y, y - b / 200))
    x, z = x * 0.95047, z * 1.08883
    return [
        3.2404542 * x - 1.5371385 * y - 0.4985314 * z,
        -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
        0.0556434 * x - 0.2040259 * y + 1.0572252 * z,
    ]


def _heat(step: int) -> int:
    """RGB565 of a heat: equal steps of lightness, the chroma that the screen has."""
    if step == 0:
        return 0
    lightness, hue = 20 + 8 * (step - 1), math.radians(285 + 18.5 * (step - 1))
    least, most = 0.0, 90.0
    for _ in range(40):
        chroma = (least + most) / 2
        inside = all(-1e-9 <= value <= 1 + 1e-9 for value in _linear(lightness, chroma, hue))
        least, most = (chroma, most) if inside else (least, chroma)
    levels = []
    for value, top in zip(_linear(lightness, least, hue), (31, 63, 31), strict=True):
        level = min(1.0, max(0.0, value))
        levels.append(round(top * (12.92 * level if level <= 0.0031308 else 1.055 * level ** (1 / 2.4) - 0.055)))
    return levels[0] << 11 | levels[1] << 5 | levels[2]


def _row(words: str) -> list[int]:
    return [int(word, 16) for word in re.findall(r"\b(?:0x)?([0-9A-F]{4})\b", words)]


def test_heats_are_equal_steps_of_lightness() -> None:
    expected = [_heat(step) for step in range(12)]
    table = re.search(r"el_debug_heat\[EL_DEBUG_HEATS\] = \{([^}]*)\}", SOURCE.read_text(encoding="utf-8"))
    assert table is not None
    assert _row(table[1]) == expected
    legend = re.search(r"\* +565 +(.*)", HEADER.read_text(encoding="utf-8"))
    assert legend is not None
    assert _row(legend[1]) == expected
