"""`edgeline font`: a TrueType or OpenType font into a C header with a bitmap font.

    edgeline font DejaVuSans.ttf --size 16 --range 32-126,176 -o label.h

Exit status 0, or an EdgelineError (status 2), one line that says what, where and what to do; then nothing is written.
"""

from __future__ import annotations

import argparse
import json
import shlex
from pathlib import Path
from typing import TYPE_CHECKING

from edgeline.convert.files import write_whole
from edgeline.convert.font import font_header, open_font, parse_characters, rasterise
from edgeline.convert.header import check_name, name_from
from edgeline.errors import EdgelineError

if TYPE_CHECKING:
    SubParsers = argparse._SubParsersAction[argparse.ArgumentParser]

DEFAULT_RANGE = "32-126"


def add_parser(subparsers: SubParsers) -> None:
    """Adds the command to the command line of `edgeline`; the parser's `func` takes the arguments, returns a status."""
    parser = subparsers.add_parser(
        "font",
        help="make a bitmap font for the firmware out of a TrueType font",
        description="Rasterises characters of a TTF or OTF file into a C header.",
    )
    parser.add_argument("font", type=Path, metavar="FILE", help="a file .ttf or .otf")
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="FILE.h", help="the result")
    parser.add_argument("--size", type=int, default=16, metavar="PIXELS", help="of the em (default: 16)")
    parser.add_argument(
        "--range",
        dest="characters",
        default=DEFAULT_RANGE,
        metavar="LIST",
        help=f"characters by number, as in 32-126,176,0x20ac (default: {DEFAULT_RANGE})",
    )
    parser.add_argument(
        "--bits", type=int, choices=(1, 2, 4), default=4, help="per pixel: 1 is sharp, 4 is smooth (default: 4)"
    )
    parser.add_argument("--kerning", action="store_true", help="have pairs such as AV nearer to each other")
    parser.add_argument("--name", help="C name of the font (default: from the output's name)")
    parser.add_argument("--json", action="store_true", help="report as one JSON object")
    parser.set_defaults(func=run)


def run(options: argparse.Namespace) -> int:
    output: Path = options.output
    if output.suffix != ".h":
        raise EdgelineError(f"-o {output}: a font becomes a C header; name it FILE.h")
    name = check_name(options.name) if options.name is not None else name_from(output.stem, "font")
    characters = parse_characters(options.characters)
    opened = open_font(options.font, options.size)
    font = rasterise(opened, characters, options.bits, options.kerning)
    # The words that make it again, without folders.
    words = ["edgeline", "font", options.font.name, "--size", str(options.size), "--range", options.characters]
    words += ["--bits", str(options.bits), *(["--kerning"] if options.kerning else [])]
    about = [f"A font; {shlex.join(words)} makes it. The font's licence holds for it, too."]
    write_whole(output, font_header(name, about, font).encode())
    absent = [f"U+{character:04X}" for character in font.absent]
    if options.json:
        report = {
            "name": name,
            "family": font.family,
            "characters": len(font.glyphs),
            "absent": absent,
            "ascent": font.ascent,
            "descent": font.descent,
            "line_height": font.line_height,
        }
        print(json.dumps(report))
        return 0
    print(f"{output.name}: {font.family}, {len(font.glyphs):,} characters, {font.ascent} + {font.descent} pixels high")
    if absent:
        more = f" and {len(absent) - 8:,} more" if len(absent) > 8 else ""
        print(f"not in the font: {' '.join(absent[:8])}{more}")
    return 0
