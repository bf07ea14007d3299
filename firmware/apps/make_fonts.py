#!/usr/bin/env python3
"""Makes the font headers of the pages in paint/.

    firmware/apps/make_fonts.py             paint/fonts, out of Aileron, which comes with Pillow
    firmware/apps/make_fonts.py -o FOLDER   into another folder, for comparison

The headers are committed; a test makes them again and compares byte for byte, with the Pillow that the tests have.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from PIL import ImageFont

from edgeline.convert.font import font_header, font_of, parse_characters, rasterise
from edgeline.errors import EdgelineError
from header_files import write_headers

APPS = Path(__file__).resolve().parent

ABOUT = "Made by firmware/apps/make_fonts.py. Aileron is free of rights (CC0 1.0): see LICENSE beside it."
FONTS = (
    # Size, bits per pixel, kerning, characters.
    (11, 1, False, "32-126,176"),
    (13, 4, False, "32-126,176"),
    (22, 2, True, "32-126,176"),
)


def font_headers() -> dict[str, str]:
    """Each header's name and its text."""
    default = ImageFont.load_default(10)
    if not isinstance(default, ImageFont.FreeTypeFont):
        raise EdgelineError("this Pillow has no FreeType, and so no Aileron; install another one")
    headers = {}
    for size, bits, kerning, characters in FONTS:
        font = rasterise(font_of(default.font_bytes, size), parse_characters(characters), bits, kerning)
        name = f"aileron_{size}"
        headers[name] = font_header(name, [ABOUT], font)
    return headers


def main() -> int:
    parser = argparse.ArgumentParser(description="Makes the font headers of the pages in paint/.")
    parser.add_argument("-o", "--output", type=Path, default=APPS / "paint" / "fonts", metavar="FOLDER")
    folder: Path = parser.parse_args().output
    return write_headers("make_fonts", folder, font_headers)


if __name__ == "__main__":
    sys.exit(main())
