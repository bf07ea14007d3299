"""`edgeline image`: a picture into a C header, for sprites and icons (canvas/image.h) and for textures of meshes.

    edgeline image rocket.png --format palette4 -o rocket.h

It keeps its size, each pixel is one of the result. Exit status 0, or an EdgelineError (status 2), one line that says
what, where and what to do; then nothing is written.
"""

from __future__ import annotations

import argparse
import json
import shlex
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from edgeline.convert.files import write_whole
from edgeline.convert.header import check_name, image_header, name_from
from edgeline.convert.palette import DITHERS
from edgeline.convert.texels import MAX_TEXTURE_LOG2, Format, Texture
from edgeline.convert.texture import Alpha, Pixels, Style, colour_error, load_pixels, textured
from edgeline.errors import EdgelineError

if TYPE_CHECKING:
    SubParsers = argparse._SubParsersAction[argparse.ArgumentParser]

MAX_SIDE = 32767
"""EL_IMAGE_MAX."""


def add_parser(subparsers: SubParsers) -> None:
    """Adds the command to the command line of `edgeline`; the parser's `func` takes the arguments, returns a status."""
    parser = subparsers.add_parser(
        "image",
        help="make a sprite or a texture for the firmware out of a picture",
        description="Converts a picture (PNG, JPEG or what else Pillow reads) to a C header with an el_image.",
    )
    parser.add_argument("image", type=Path, metavar="FILE", help="the picture")
    parser.add_argument("-o", "--output", type=Path, required=True, metavar="FILE.h", help="the result")
    parser.add_argument(
        "--format",
        choices=[one.option for one in Format],
        default=Format.RGB565.option,
        help="what pixels are: RGB565, 256 or 16 colours, or a bit each in one colour (default: rgb565)",
    )
    parser.add_argument(
        "--dither", choices=DITHERS, default="none", help="how colours that there are not are mixed (default: none)"
    )
    parser.add_argument(
        "--alpha",
        choices=[one.value for one in Alpha],
        help="what its alpha is for: nothing, pixels that are drawn or not, or mixing, for a byte per pixel "
        "(default: test where nothing is half clear, else blend)",
    )
    parser.add_argument("--name", help="C name of the el_image (default: from the output's name)")
    parser.add_argument("--json", action="store_true", help="report as one JSON object")
    parser.set_defaults(func=run)


def alpha_of(pixels: Pixels) -> Alpha:
    """What an image's own alpha looks like."""
    if pixels.alpha is None:
        return Alpha.NONE
    return Alpha.TEST if bool(np.isin(pixels.alpha, (0, 255)).all()) else Alpha.BLEND


def picture_of(options: argparse.Namespace) -> tuple[Pixels, Texture]:
    """What is in the file, and what becomes of it. Raises EdgelineError."""
    pixels = load_pixels(options.image, None, with_alpha=options.alpha != Alpha.NONE.value)
    height, width = pixels.rgb.shape[:2]
    if max(height, width) > MAX_SIDE:
        raise EdgelineError(f"{options.image}: {width}x{height} pixels, {MAX_SIDE:,} a side at most; make it smaller")
    style = Style(
        format=next(one for one in Format if one.option == options.format),
        dither=options.dither,
        alpha=alpha_of(pixels) if options.alpha is None else Alpha(options.alpha),
        any_size=True,
    )
    try:
        return pixels, textured(pixels, style)
    except EdgelineError as error:
        raise EdgelineError(f"{options.image}: {error}") from error


def command_words(options: argparse.Namespace) -> str:
    """The words that make it again, without folders."""
    words = ["edgeline", "image", options.image.name, "--format", options.format, "--dither", options.dither]
    return shlex.join(words + (["--alpha", options.alpha] if options.alpha is not None else []))


def run(options: argparse.Namespace) -> int:
    output: Path = options.output
    if output.suffix != ".h":
        raise EdgelineError(f"-o {output}: a picture becomes a C header; name it FILE.h")
    name = check_name(options.name) if options.name is not None else name_from(output.stem, "image")
    pixels, picture = picture_of(options)
    height, width = picture.texels.shape
    what = f"{width}x{height} pixels, {options.format}"
    if picture.alpha is not None:
        what += ", mixed by alpha"
    elif picture.key is not None:
        what += ", clear places not drawn"
    about = [f"A picture; {command_words(options)} makes it.", f"{name}: {what}, {picture.flash_bytes:,} bytes."]
    write_whole(output, image_header(name, about, picture).encode("utf-8", "backslashreplace"))
    error = colour_error(replace(pixels, alpha=None), picture)
    if options.json:
        facts = {"name": name, "width": width, "height": height, "format": options.format}
        colours = {"rms": error.rms, "largest": error.largest}
        blends = picture.alpha is not None
        facts |= {"alpha": blends, "key": picture.key, "flash_bytes": picture.flash_bytes, "colour_error": colours}
        print(json.dumps(facts))
        return 0
    print(f"{output.name}: {name}, {what}, {picture.flash_bytes:,} bytes of flash")
    if picture.format != Format.MASK:
        print(f"  colours within {error.largest} of 255 of the image's, {error.rms:.2g} rms")
    if max(height, width) > 1 << MAX_TEXTURE_LOG2:
        print(f"  note: too large for a texture of a mesh, of which a side has {1 << MAX_TEXTURE_LOG2:,} at most")
    return 0
