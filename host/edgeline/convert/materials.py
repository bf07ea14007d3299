"""How the parts of a model are to be drawn: what its file says of textures and materials, and what was asked for."""

from __future__ import annotations

import argparse
from dataclasses import replace

from edgeline.convert import atlas
from edgeline.convert.header import Look
from edgeline.convert.options import TEXTURE_OPTIONS, given_options
from edgeline.convert.progress import Steps
from edgeline.convert.source import Part, Picture, Source, fitted_wrap
from edgeline.convert.texels import MAX_TEXTURE_LOG2, Format, Texture, Wrap
from edgeline.convert.texture import Alpha, ColourError, Pixels, Style, colour_error, textured


def style_of(args: argparse.Namespace) -> Style:
    """What the command line says of textures; `with_texture` adds what the model does."""
    texture_format = next(one for one in Format if one.option == (args.texture_format or Format.RGB565.option))
    most = atlas.LEVELS if args.atlas else MAX_TEXTURE_LOG2 + 1
    return Style(texture_format, args.dither or "none", most if args.mipmaps else 1, smooth=args.filter == "bilinear")


def as_asked(source: Source, args: argparse.Namespace) -> Source:
    """`source` with the alpha, borders and filter that were asked for in place of the model's."""

    def changed(picture: Picture) -> Picture:
        alpha = picture.alpha if args.alpha in (None, "file") else Alpha(args.alpha)
        if alpha == Alpha.BLEND and args.texture_format == Format.MASK.option:
            alpha = Alpha.TEST
        wrap = picture.wrap if args.wrap in (None, "file") else (Wrap[args.wrap.upper()],) * 2
        smooth = picture.smooth if args.filter == "file" else args.filter == "bilinear"
        return replace(picture, alpha=alpha, wrap=wrap, smooth=smooth)

    parts = (p if p.picture is None else replace(p, picture=changed(p.picture)) for p in source.parts)
    return replace(source, parts=tuple(parts))


def load_pictures(source: Source, style: Style, limit: int, steps: Steps) -> list[Pixels | None]:
    """Of each part, its sides at most `limit`. Raises EdgelineError."""
    pixels: list[Pixels | None] = []
    with steps.bar("images", len(source.parts)) as done:
        for part in source.parts:
            picture = part.picture
            with_alpha = picture is not None and (style.format == Format.MASK or picture.alpha != Alpha.NONE)
            pixels.append(None if picture is None else picture.load(limit, with_alpha))
            done(1)
    return pixels


def look_of(part: Part) -> Look:
    return Look(part.two_sided, part.opacity)


def is_blended(part: Part) -> bool:
    return part.opacity < 255 or (part.picture is not None and part.picture.alpha == Alpha.BLEND)


def in_drawing_order(source: Source, names: list[str]) -> list[tuple[int, str]]:
    """The parts' numbers and names: those that are blended last, as they are to be drawn."""
    return sorted(enumerate(names), key=lambda one: is_blended(source.parts[one[0]]))


def with_texture(
    source: Source, part: Part, pixels: Pixels | None, style: Style
) -> tuple[Source, Texture | None, ColourError | None]:
    """The triangles of a part, the texture made of its picture, and how far that is from it."""
    if pixels is None or part.picture is None:
        return source, None, None
    picture = part.picture
    style = replace(style, smooth=picture.smooth, alpha=picture.alpha, cutoff=picture.cutoff)
    if not part.is_atlas:
        height, width = pixels.rgb.shape[:2]
        source, wrap = fitted_wrap(source, replace(style, wrap=picture.wrap), (width, height))
        style = replace(style, wrap=wrap)
    texture = textured(pixels, style)
    return source, texture, colour_error(pixels, texture)


def notes_of(source: Source, pixels: list[Pixels | None], args: argparse.Namespace) -> list[str]:
    notes = []
    idle = given_options(args, TEXTURE_OPTIONS)
    if idle and all(image is None for image in pixels):
        notes.append(f"there is no texture, so nothing comes of {', '.join(idle)}")
    elif args.atlas and not any(part.is_atlas for part in source.parts):
        notes.append("--atlas joins nothing, as no two parts differ only in their images")
    for part, image in zip(source.parts, pixels, strict=True):
        name = part.name or "the model"
        if is_blended(part):
            notes.append(f"{name}: it is blended; draw it after all that is opaque")
        elif image is not None and image.is_clear and args.alpha is None and image.alpha is None:
            notes.append(f"{name}: its image has clear places, which are drawn; give --alpha test or --alpha blend")
    return notes
