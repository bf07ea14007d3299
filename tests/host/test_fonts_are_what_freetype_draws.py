"""`edgeline font` writes what FreeType draws, the same each time; the pages' fonts are what their script makes; what is
no font, or too much of one, gets one clear line and leaves no file."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from PIL import ImageFont

APPS = Path(__file__).resolve().parents[2] / "firmware" / "apps"
sys.path.insert(0, str(APPS))

import make_fonts  # noqa: E402
from edgeline.cli import main  # noqa: E402
from edgeline.convert.font import font_of, parse_characters  # noqa: E402
from edgeline.errors import EdgelineError  # noqa: E402


@pytest.fixture(scope="module")
def ttf(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Aileron, which comes with Pillow, as a file."""
    font = ImageFont.load_default(10)
    assert isinstance(font, ImageFont.FreeTypeFont)
    path = tmp_path_factory.mktemp("font") / "aileron.ttf"
    path.write_bytes(font.font_bytes)
    return path


def _numbers(text: str, name: str) -> list[int]:
    found = re.search(rf"\w+_{name}\[\d+\] = \{{(.*?)\n\}};", text, re.DOTALL)
    return [int(word) for word in re.findall(r"-?\d+", found.group(1))] if found else []


def _levels(data: list[int], at: int, width: int, height: int, bits: int) -> npt.NDArray[np.uint8]:
    """A glyph out of the header's bytes."""
    ones = np.unpackbits(np.array(data[at:], np.uint8))[: width * height * bits].reshape(-1, bits)
    return (ones @ (1 << np.arange(bits - 1, -1, -1))).astype(np.uint8).reshape(height, width)


@pytest.mark.parametrize("bits", [1, 2, 4])
@pytest.mark.parametrize("size", [8, 17, 40])
def test_glyphs_are_what_freetype_draws(ttf: Path, tmp_path: Path, size: int, bits: int) -> None:
    header = tmp_path / "f.h"
    arguments = ["font", str(ttf), "--size", str(size), "--bits", str(bits), "--range", "32-126,176", "-o", str(header)]
    assert main(arguments) == 0
    text = header.read_text(encoding="ascii")
    data, glyphs = _numbers(text, "bits"), np.array(_numbers(text, "glyphs")).reshape(-1, 6)
    assert _numbers(text, "ranges") == [32, 95, 0, 176, 1, 95]
    font = font_of(ttf.read_bytes(), size)
    most = (1 << bits) - 1
    for character, (at, width, height, left, top, advance) in zip([*range(32, 127), 176], glyphs.tolist(), strict=True):
        mask, (x, y) = font.getmask2(chr(character), mode="1" if bits == 1 else "L", anchor="ls")
        wanted = np.zeros((200, 200), np.int64)
        for j in range(mask.size[1]):
            for i in range(mask.size[0]):
                wanted[100 + y + j, 100 + x + i] = (mask.getpixel((i, j)) * most + 127) // 255
        got = np.zeros((200, 200), np.int64)
        got[100 - top : 100 - top + height, 100 + left : 100 + left + width] = _levels(data, at, width, height, bits)
        assert np.array_equal(got, wanted), chr(character)
        assert advance == int(font.getlength(chr(character)) + 0.5)
    ascent, descent = (int(re.search(rf"\.{word} = (-?\d+)", text)[1]) for word in ("ascent", "descent"))  # type: ignore[index]
    assert ascent == max(glyphs[:, 4])
    assert descent == max(glyphs[:, 2] - glyphs[:, 4])


def test_kerns_are_in_order_and_move_av(ttf: Path, tmp_path: Path) -> None:
    header = tmp_path / "f.h"
    assert main(["font", str(ttf), "--size", "30", "--kerning", "-o", str(header)]) == 0
    kerns = np.array(_numbers(header.read_text(encoding="ascii"), "kerns")).reshape(-1, 3).tolist()
    assert kerns == sorted(kerns)
    assert dict(((a, b), by) for a, b, by in kerns)[ord("A") - 32, ord("V") - 32] < 0
    assert all(by != 0 for _, _, by in kerns)


def test_the_pages_fonts_are_what_their_script_makes() -> None:
    made = make_fonts.font_headers()
    stored = {path.stem: path.read_text(encoding="ascii") for path in (APPS / "paint" / "fonts").glob("*.h")}
    assert made == stored


def test_the_same_each_time_and_characters_left_out_are_named(
    ttf: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    texts = []
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        header = tmp_path / folder / "label-2.h"
        assert main(["font", str(ttf), "--range", "65-70,0xE000", "-o", str(header)]) == 0
        texts.append(header.read_text(encoding="ascii"))
    assert texts[0] == texts[1]
    assert "static const el_font label_2 = {" in texts[0]
    assert "not in the font: U+E000" in capsys.readouterr().out


def test_ranges_are_read() -> None:
    assert parse_characters("65") == [65]
    assert parse_characters("0x41-67,65,8364") == [65, 66, 67, 8364]
    assert parse_characters("0xD7FF-0xE000") == [0xD7FF, 0xE000]
    for wrong in ("", "a", "5-4", "1-2-3", "0", "-5", "1114112", "1-1114111"):
        with pytest.raises(EdgelineError):
            parse_characters(wrong)


@pytest.mark.parametrize(
    ("arguments", "what"),
    [
        (["--size", "3"], "--size 3"),
        (["--size", "121"], "--size 121"),
        (["--range", "x"], "'x'"),
        (["--range", "0xE000-0xE010"], "none of the characters"),
        (["--name", "int"], "--name"),
    ],
)
def test_bad_options_get_one_line(
    ttf: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], what: str
) -> None:
    header = tmp_path / "f.h"
    assert main(["font", str(ttf), "-o", str(header), *arguments]) == 2
    said = capsys.readouterr()
    assert what in said.err
    assert said.err.count("\n") == 1
    assert said.out == ""
    assert not header.exists()


def test_bad_fonts_get_one_line(ttf: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    header = tmp_path / "f.h"
    good = ttf.read_bytes()
    files = {
        "empty.ttf": b"",
        "text.ttf": b"no font\n" * 100,
        "cut.ttf": good[: len(good) // 3],
        "shorter.ttf": good[:300],
    }
    for name, data in files.items():
        (tmp_path / name).write_bytes(data)
    for name in [*files, "absent.ttf", "."]:
        assert main(["font", str(tmp_path / name), "-o", str(header)]) == 2, name
        assert capsys.readouterr().err.count("\n") == 1
        assert not header.exists()
    assert main(["font", str(ttf), "-o", str(tmp_path / "f.txt")]) == 2
    assert main(["font", str(ttf), "-o", str(tmp_path / "no" / "f.h")]) == 2


def test_damaged_fonts_never_break_the_command(ttf: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    random = np.random.default_rng(1)
    good = np.frombuffer(ttf.read_bytes(), np.uint8)
    for _ in range(60):
        data = good.copy()
        places = random.integers(0, len(data), random.integers(1, 40))
        data[places] = random.integers(0, 256, len(places))
        path = tmp_path / "damaged.ttf"
        path.write_bytes(data.tobytes())
        status = main(["font", str(path), "--range", "60-80", "--size", "20", "-o", str(tmp_path / "f.h")])
        assert status in (0, 2)
        assert capsys.readouterr().err.count("\n") == (1 if status else 0)
