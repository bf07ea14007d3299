"""What base/options.h leaves out is refused with the error it names; what remains draws the same pixels, also where
small code takes other ways to them."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from conftest import REPOSITORY
from needs import missing

SOURCES = REPOSITORY / "firmware" / "src"
PROGRAM = Path(__file__).with_name("options_program.c")

ERROR_CAMERA = -4
ERROR_MATERIAL = -6
NOTHING = "00000000"

# Ways of drawing of options_program.c, by the option that each needs.
NEEDS = {
    "ORTHOGRAPHIC": {"orthographic"},
    "LIGHT": {"lit", "gouraud-lit"},
    "GOURAUD": {"gouraud", "gouraud-lit", "gouraud-dithered", "textured-gouraud", "textured-gouraud-dithered"},
    "TEXTURE": {
        "textured",
        "textured-gouraud",
        "textured-gouraud-dithered",
        "textured-smooth",
    },
    "DITHER": {"gouraud-dithered", "textured-gouraud-dithered"},
    "OVERDRAW": {"overdraw"},
}
FLAT = tuple(NEEDS)

# Ways that do not compile without the option: what they set is no member then.
MIXED = {"blended", "fogged", "textured-smooth"}
MIPMAPS = {"textured-smaller"}
WIRES = {"wires"}

# Small code, but with every way of drawing.
SMALL = ("-DEL_SMALL_CODE=1", "-DEL_WITH_MIXED=1", "-DEL_WITH_MIPMAPS=1", "-DEL_WITH_WIRES=1")

# Name: status, CRC-32 of the frames, pixels counted.
Drawn = dict[str, tuple[int, str, int]]


def _compile(folder: Path, *flags: str) -> subprocess.CompletedProcess[str]:
    if shutil.which("cc") is None:
        missing("no C compiler: cc is not installed")
    sources = [path for layer in ("base", "geometry", "raster", "frame") for path in (SOURCES / layer).glob("*.c")]
    command = ["cc", "-std=c11", "-Wall", "-Wextra", "-Werror", "-I", str(SOURCES), *flags, str(PROGRAM)]
    command += [*map(str, sources), "-o", str(folder / "program")]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def _draw(folder: Path, *flags: str) -> Drawn:
    done = _compile(folder, *flags)
    assert done.returncode == 0, done.stderr
    said = subprocess.run([folder / "program"], capture_output=True, text=True, check=True).stdout
    rows = [line.split() for line in said.splitlines()]
    return {name: (int(status), crc, int(pixels)) for name, status, crc, pixels in rows}


def _pictures(drawn: Drawn) -> dict[str, tuple[int, str]]:
    return {name: (status, crc) for name, (status, crc, _) in drawn.items()}


@pytest.fixture(scope="module")
def everything(tmp_path_factory: pytest.TempPathFactory) -> Drawn:
    drawn = _draw(tmp_path_factory.mktemp("everything"))
    assert all(status == 0 for status, _, _ in drawn.values())
    crcs = {crc for _, crc, _ in drawn.values()}
    assert len(crcs) == len(drawn), "each way of drawing has a picture of its own"
    return drawn


@pytest.fixture(scope="module")
def nothing_hidden(everything: Drawn, tmp_path_factory: pytest.TempPathFactory) -> Drawn:
    """The same pictures, of more pixels: triangles that lie behind all that is drawn are drawn, as small code does."""
    drawn = _draw(tmp_path_factory.mktemp("nothing_hidden"), "-DEL_WITH_HIDDEN=0")
    assert _pictures(drawn) == _pictures(everything)
    assert all(drawn[name][2] >= pixels for name, (_, _, pixels) in everything.items())
    assert drawn != everything, "the scene hides something"
    return drawn


@pytest.mark.parametrize("small", [False, True], ids=["fast", "small"])
@pytest.mark.parametrize("left_out", [*((name,) for name in NEEDS), FLAT], ids=lambda names: "-".join(names).lower())
def test_a_mode_is_left_out(
    everything: Drawn, nothing_hidden: Drawn, tmp_path: Path, left_out: tuple[str, ...], small: bool
) -> None:
    flags = [f"-DEL_WITH_{option}=0" for option in left_out]
    if small:
        flags = [*(flag for flag in SMALL if flag.replace("=1", "=0") not in flags), *flags]
    unknown: set[str] = set()
    if "TEXTURE" in left_out:
        flags = [flag for flag in flags if "MIPMAPS" not in flag] + ["-DEL_WITH_MIPMAPS=0"]
        unknown = MIPMAPS
    drawn = _draw(tmp_path, *flags)
    refused = set().union(*(NEEDS[option] for option in left_out))
    for name, expected in (nothing_hidden if small else everything).items():
        if name in unknown:
            assert name not in drawn
        elif name not in refused:
            assert drawn[name] == expected, name
        elif name == "orthographic":
            assert drawn[name] == (ERROR_CAMERA, NOTHING, 0)
        else:
            status, crc, pixels = drawn[name]
            assert (status, pixels) == (ERROR_MATERIAL, 0), name
            assert crc not in {other for _, other, _ in everything.values()}, "a picture of the background"


@pytest.mark.parametrize("flags", [("-O2",), ("-O2", "-DEL_WITH_DEBUG_VIEWS=1")], ids=" ".join)
def test_optimised_code_draws_the_same(everything: Drawn, tmp_path: Path, flags: tuple[str, ...]) -> None:
    assert _draw(tmp_path, *flags) == everything


@pytest.mark.parametrize("flags", [SMALL, ("-Os", *SMALL[1:])], ids=["small", "-Os"])
def test_small_code_draws_the_same(nothing_hidden: Drawn, tmp_path: Path, flags: tuple[str, ...]) -> None:
    assert _draw(tmp_path, *flags) == nothing_hidden


def test_small_code_begins_without_mixing(nothing_hidden: Drawn, tmp_path: Path) -> None:
    drawn = _draw(tmp_path, "-DEL_SMALL_CODE=1")
    assert drawn == {name: way for name, way in nothing_hidden.items() if name not in MIXED | MIPMAPS | WIRES}


@pytest.mark.parametrize(("option", "ways"), [("MIXED", MIXED), ("MIPMAPS", MIPMAPS), ("WIRES", WIRES)])
def test_without_members_the_rest_is_drawn(everything: Drawn, tmp_path: Path, option: str, ways: set[str]) -> None:
    drawn = _draw(tmp_path, f"-DEL_WITH_{option}=0")
    assert drawn == {name: way for name, way in everything.items() if name not in ways}


@pytest.mark.parametrize("option", ["THIN", "CLUSTERS", "HIDDEN", "PREPASS", "WORKERS", "REUSE", "SAMPLES"])
def test_small_code_takes_what_it_begins_without(
    everything: Drawn, nothing_hidden: Drawn, tmp_path: Path, option: str
) -> None:
    drawn = _draw(tmp_path, *SMALL, f"-DEL_WITH_{option}=1")
    assert drawn == (everything if option == "HIDDEN" else nothing_hidden)


@pytest.mark.parametrize(
    "option", ["CARRY", "THIN", "CLUSTERS", "PREPASS", "WORKERS", "REUSE", "SAMPLES", "INTERLACED"]
)
def test_without_what_makes_no_pixel(everything: Drawn, tmp_path: Path, option: str) -> None:
    assert _draw(tmp_path, f"-DEL_WITH_{option}=0") == everything


def test_without_counters_nothing_is_counted(everything: Drawn, tmp_path: Path) -> None:
    drawn = _draw(tmp_path, "-DEL_WITH_STATS=0")
    assert _pictures(drawn) == _pictures(everything)
    assert all(pixels == 0 for _, _, pixels in drawn.values())


def test_a_header_sets_options(everything: Drawn, tmp_path: Path) -> None:
    header = tmp_path / "edgeline_config.h"
    header.write_text("#define EL_WITH_TEXTURE 0\n", encoding="ascii")
    drawn = _draw(tmp_path, f'-DEL_CONFIG_FILE="{header}"')
    assert drawn["textured"][0] == ERROR_MATERIAL
    assert drawn["gouraud"] == everything["gouraud"]


def test_a_header_that_is_not_there_stops_the_compiler(tmp_path: Path) -> None:
    done = _compile(tmp_path, '-DEL_CONFIG_FILE="nowhere_config.h"')
    assert done.returncode != 0
    assert "nowhere_config.h" in done.stderr


def test_what_is_hidden_needs_counters(tmp_path: Path) -> None:
    done = _compile(tmp_path, "-DEL_WITH_HIDDEN=1", "-DEL_WITH_STATS=0")
    assert done.returncode != 0
    assert "EL_WITH_HIDDEN needs EL_WITH_STATS" in done.stderr


def test_debug_views_need_counters(tmp_path: Path) -> None:
    done = _compile(tmp_path, "-DEL_WITH_DEBUG_VIEWS=1", "-DEL_WITH_STATS=0")
    assert done.returncode != 0
    assert "it needs EL_WITH_OVERDRAW and EL_WITH_STATS" in done.stderr


def test_an_option_is_0_or_1(tmp_path: Path) -> None:
    done = _compile(tmp_path, "-DEL_WITH_LIGHT=2")
    assert done.returncode != 0
    assert "each EL_WITH_ option is 0 or 1" in done.stderr
