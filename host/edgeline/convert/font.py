"""Bitmap fonts for the firmware (canvas/text.h) out of TrueType and OpenType fonts, rasterised by Pillow's FreeType.

The text of a header depends on the font, the words given and the version of FreeType, on nothing else.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import ImageFont, features

from edgeline.convert.header import whole_header, wrap
from edgeline.errors import EdgelineError

MAX_SIZE = 120
MAX_CHARACTERS = 20000
LAST_CHARACTER = 0x10FFFF
ABSENT = "\U0010ffff"
"""A character that no font has: what is drawn for it is drawn for all that a font lacks."""

Coverage = npt.NDArray[np.uint8]


@dataclass(frozen=True)
class Glyph:
    """A character's picture: levels of coverage, rows from the top; `top` rows of them lie above the base line."""

    levels: Coverage
    left: int
    top: int
    advance: int


@dataclass(frozen=True)
class Font:
    """Glyphs by character, in order, and kerning by pairs of characters."""

    family: str
    size: int
    bits: int
    glyphs: dict[int, Glyph]
    kerns: dict[tuple[int, int], int]
    line_height: int
    absent: list[int]

    @property
    def ascent(self) -> int:
        return max(glyph.top for glyph in self.glyphs.values())

    @property
    def descent(self) -> int:
        return max(len(glyph.levels) - glyph.top for glyph in self.glyphs.values())


def parse_characters(text: str) -> list[int]:
    """Characters of `32-126,176,0x20AC`, in order, each once. Raises EdgelineError."""
    characters: set[int] = set()
    for part in text.split(","):
        ends = part.split("-")
        try:
            first, last = int(ends[0], 0), int(ends[-1], 0)
        except ValueError:
            first, last = 1, 0
        if len(ends) > 2 or not 0 < first <= last <= LAST_CHARACTER:
            raise EdgelineError(f"--range {text!r}: {part!r} is no character's number, nor two as in 32-126")
        if last - first >= MAX_CHARACTERS or len(characters) > MAX_CHARACTERS:
            raise EdgelineError(f"--range {text!r} has more than {MAX_CHARACTERS:,} characters; give fewer")
        characters.update(range(first, last + 1))
    return sorted(characters - set(range(0xD800, 0xE000)))


def open_font(path: Path, size: int) -> ImageFont.FreeTypeFont:
    """The font at `path`, `size` pixels to the em. Raises EdgelineError when it is none."""
    if not 4 <= size <= MAX_SIZE:
        raise EdgelineError(f"--size {size} is not from 4 to {MAX_SIZE} pixels")
    try:
        return font_of(path.read_bytes(), size)
    except OSError as error:
        # FreeType's own errors have no errno.
        why = error.strerror if error.errno else f"it is no font that can be read ({error})"
        raise EdgelineError(f"cannot read {path}: {why}; give a TTF or OTF file") from error


def font_of(data: bytes, size: int) -> ImageFont.FreeTypeFont:
    """The font whose file has these bytes. Raises OSError."""
    return ImageFont.truetype(BytesIO(data), size, layout_engine=ImageFont.Layout.BASIC)


def _coverage(font: ImageFont.FreeTypeFont, text: str, bits: int) -> tuple[Coverage, int, int]:
    """What is covered, in levels, and where its upper left pixel lies from the base line's beginning, x and y."""
    mask, (left, top) = font.getmask2(text, mode="1" if bits == 1 else "L", anchor="ls")
    width, height = mask.size
    raw = np.array([mask.getpixel((x, y)) for y in range(height) for x in range(width)], np.uint32)
    most = (1 << bits) - 1
    levels = ((raw * most + 127) // 255).reshape(height, width).astype(np.uint8)
    rows, columns = np.flatnonzero(levels.any(axis=1)), np.flatnonzero(levels.any(axis=0))
    if not len(rows):
        return levels[:0, :0], 0, 0
    cut = levels[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
    return cut, int(left + columns[0]), int(top + rows[0])


def _glyph(font: ImageFont.FreeTypeFont, text: str, bits: int) -> Glyph:
    levels, left, top = _coverage(font, text, bits)
    advance = int(font.getlength(text) + 0.5)
    if max(levels.shape, default=0) > 127 or not (-128 <= left <= 127 and -128 <= -top <= 127 and advance <= 255):
        raise EdgelineError(f"the font's character U+{ord(text):04X} is larger than 127 pixels; give a smaller --size")
    return Glyph(levels, left, -top, advance)


def _same(a: Glyph, b: Glyph) -> bool:
    return a.left == b.left and a.top == b.top and a.advance == b.advance and np.array_equal(a.levels, b.levels)


def rasterise(font: ImageFont.FreeTypeFont, characters: Sequence[int], bits: int, kerning: bool) -> Font:
    """Those of the characters that the font has. Raises EdgelineError when it has none or they are too large."""
    try:
        absent = _glyph(font, ABSENT, bits)
        glyphs = {character: _glyph(font, chr(character), bits) for character in characters}
        glyphs = {c: glyph for c, glyph in glyphs.items() if chr(c).isspace() or not _same(glyph, absent)}
        kerns = _kerns(font, list(glyphs)) if kerning else {}
    except (OSError, ValueError) as error:
        raise EdgelineError(f"the font is damaged ({error}); give another one") from error
    if not glyphs:
        raise EdgelineError("the font has none of the characters of --range; give others")
    if not any(glyph.levels.size for glyph in glyphs.values()):
        raise EdgelineError("nothing of the characters of --range can be seen: the font is damaged, or give others")
    family = " ".join(part for part in font.getname() if part)
    ascent, descent = font.getmetrics()
    missing = [character for character in characters if character not in glyphs]
    return Font(family, int(font.size), bits, glyphs, kerns, min(255, ascent + descent), missing)


def _kerns(font: ImageFont.FreeTypeFont, characters: Sequence[int]) -> dict[tuple[int, int], int]:
    """Pairs that the font moves by half a pixel or more. Of large sets only those among the first 128 characters."""
    if not features.check("raqm"):
        raise EdgelineError("--kerning needs a Pillow with libraqm, which this one lacks; leave it out")
    font = font.font_variant(layout_engine=ImageFont.Layout.RAQM)
    texts = [chr(character) for character in characters if character < 128 or len(characters) <= 128]
    alone = {text: font.getlength(text) for text in texts}
    kerns: dict[tuple[int, int], int] = {}
    for before in texts:
        for after in texts:
            by = round(font.getlength(before + after, features=["-liga", "-clig"]) - alone[before] - alone[after])
            if by != 0:
                kerns[ord(before), ord(after)] = max(-128, min(127, by))
    return kerns


def _packed(levels: Coverage, bits: int) -> bytes:
    """Values one after the other, the first one in a byte's highest bits; the last byte is filled with 0."""
    flat = levels.reshape(-1)
    ones = (flat[:, None] >> np.arange(bits - 1, -1, -1, dtype=np.uint8)) & 1
    return np.packbits(ones.reshape(-1)).tobytes()


def _ranges(characters: Iterable[int]) -> list[tuple[int, int, int]]:
    """First character, count and first glyph of each run of neighbours."""
    ranges: list[tuple[int, int, int]] = []
    for glyph, character in enumerate(characters):
        if ranges and ranges[-1][0] + ranges[-1][1] == character:
            first, count, start = ranges[-1]
            ranges[-1] = first, count + 1, start
        else:
            ranges.append((character, 1, glyph))
    return ranges


def font_header(name: str, about: Sequence[str], font: Font) -> str:
    """The text of a header with the font as `static const el_font NAME`, which includes only `edgeline.h`."""
    pieces = [_packed(glyph.levels, font.bits) for glyph in font.glyphs.values()]
    places = np.cumsum([0, *map(len, pieces)]).tolist()
    bits = b"".join(pieces) or b"\0"
    numbers = {character: i for i, character in enumerate(font.glyphs)}
    ranges = _ranges(font.glyphs)
    glyphs = [
        f"{{{place},{glyph.levels.shape[1]},{glyph.levels.shape[0]},{glyph.left},{glyph.top},{glyph.advance}}}"
        for place, glyph in zip(places, font.glyphs.values(), strict=False)
    ]
    kerns = sorted((numbers[before], numbers[after], by) for (before, after), by in font.kerns.items())
    flash = len(bits) + 12 * len(glyphs) + 8 * len(ranges) + 6 * len(kerns)
    summary = (
        f"{name}: {font.family}, {font.size} pixels, {len(glyphs):,} characters, {font.bits} bits per pixel, "
        f"{len(kerns):,} pairs, {flash:,} bytes."
    )
    lines = [f"static const uint8_t {name}_bits[{len(bits)}] = {{"]
    lines += [*wrap(map(str, bits)), "};", f"static const el_glyph {name}_glyphs[{len(glyphs)}] = {{"]
    lines += [*wrap(glyphs), "};", f"static const el_font_range {name}_ranges[{len(ranges)}] = {{"]
    lines += [*wrap(f"{{{first},{count},{glyph}}}" for first, count, glyph in ranges), "};"]
    if kerns:
        lines += [f"static const el_font_kern {name}_kerns[{len(kerns)}] = {{"]
        lines += [*wrap(f"{{{before},{after},{by}}}" for before, after, by in kerns), "};"]
    lines += [
        f"static const el_font {name} = {{",
        f"    .glyphs = {name}_glyphs,",
        f"    .ranges = {name}_ranges,",
        f"    .bits = {name}_bits,",
        *([f"    .kerns = {name}_kerns,"] if kerns else []),
        f"    .range_count = {len(ranges)},",
        f"    .kern_count = {len(kerns)},",
        f"    .bits_per_pixel = {font.bits},",
        f"    .ascent = {font.ascent},",
        f"    .descent = {font.descent},",
        f"    .line_height = {font.line_height},",
        "};",
    ]
    return whole_header(f"FONT_{name.upper()}_H", [*about, summary], lines)
