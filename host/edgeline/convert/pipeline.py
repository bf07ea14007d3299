"""The way from a model's file to meshes: read, place, simplify, shade, quantise, gather in clusters.

A model whose triangles have several materials becomes several meshes, as the firmware draws a mesh with one. They share
unit and origin, so that they fit together without cracks; an atlas makes one of those that differ only in their images.
"""

from __future__ import annotations

import argparse
import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from edgeline.convert import atlas, elm
from edgeline.convert.clusters import with_clusters
from edgeline.convert.gltf import parse_gltf
from edgeline.convert.header import Look, NamedMesh, is_name_of_part, name_from
from edgeline.convert.locality import per_triangle
from edgeline.convert.mesh import MAX_TRIANGLES, check_triangle_count, has_area, quantise, scale_log2_for
from edgeline.convert.model import source_from
from edgeline.convert.obj import Material, ObjModel, parse_mtl, parse_obj
from edgeline.convert.options import DEFAULT_CREASE, DEFAULT_TEXTURE_SIZE
from edgeline.convert.ply import parse_ply
from edgeline.convert.progress import Steps
from edgeline.convert.simplify import Simplified, simplified
from edgeline.convert.source import Part, Picture, Source, fitted_wrap, placed, soup_of, with_normals
from edgeline.convert.stl import parse_stl
from edgeline.convert.texels import MAX_TEXTURE_LOG2, Format, Texture, Wrap
from edgeline.convert.texture import Alpha, ColourError, Pixels, Style, colour_error, textured
from edgeline.errors import EdgelineError


@dataclass(frozen=True)
class Result:
    """Converted meshes and what there is to say about them. Errors are in world units."""

    meshes: list[NamedMesh]
    position_error: float = 0.0
    position_rms: float = 0.0
    dropped_triangles: int = 0
    notes: tuple[str, ...] = ()
    simplified: Simplified | None = None
    transforms_before: float | None = None
    """Per triangle, with the model's own order; None where that stays."""
    colour_errors: tuple[ColourError | None, ...] = ()
    """Of each mesh's texture; empty where they are not known."""


def read_bytes(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise EdgelineError(f"cannot read {path}: {error.strerror or error}") from error


def read_materials(path: Path, model: ObjModel, notes: list[str]) -> tuple[dict[str, Material], dict[str, str]]:
    """The materials of all libraries that the model names, and the library of each. A missing one is only noted."""
    materials: dict[str, Material] = {}
    library_of: dict[str, str] = {}
    for _, name in model.libraries:
        library = path.parent / name.replace("\\", "/")
        if not library.is_file():
            notes.append(f"the material library {name} is not there; its colours and textures are left out")
            continue
        found = parse_mtl(library.name, read_bytes(library))
        materials |= found
        library_of |= dict.fromkeys(found, library.name)
    return materials, library_of


def read_obj(path: Path) -> Source:
    model = parse_obj(path.name, read_bytes(path))
    notes: list[str] = []
    materials, library_of = read_materials(path, model, notes)

    def picture_of(material: str) -> Picture:
        found = materials[material]
        image = path.parent / (found.image or "").replace("\\", "/")
        wrap = Wrap.CLAMP if found.clamps else Wrap.REPEAT
        alpha = Alpha.BLEND if found.has_alpha else Alpha.NONE
        return Picture(f"{library_of[material]}:{found.line}: map_Kd", image, wrap=(wrap, wrap), alpha=alpha)

    return source_from(model, materials, picture_of, tuple(notes))


def read_source(path: Path) -> Source:
    """The triangles of a model's file. Raises EdgelineError."""
    suffix = path.suffix.lower()
    if suffix == ".obj":
        return read_obj(path)
    data = read_bytes(path)
    if suffix == ".stl":
        return parse_stl(path.name, data)
    if suffix == ".ply":
        return parse_ply(path.name, data, lambda image: Picture(f"{path.name}: TextureFile", path.parent / image))
    return parse_gltf(path.name, data, lambda name: read_bytes(path.parent / name))


def coloured(source: Source, args: argparse.Namespace) -> Source:
    """`source` with the images and colours that were asked for."""
    notes = source.notes
    if args.texture is not None:
        source = source.in_one(Picture("", args.texture))
    elif args.no_texture:
        source = source.in_one(None)
    if source.uvs is not None and all(part.picture is None for part in source.parts):
        notes = (*notes, "texture coordinates are left out, as there is no texture; give one with --texture")
        source = replace(source, uvs=None)
    if args.vertex_colours and source.colours is None and source.triangle_colours is not None:
        source = replace(source, colours=np.repeat(source.triangle_colours[:, None], 3, axis=1), triangle_colours=None)
    return replace(source, notes=notes)


def part_names(source: Source, name: str) -> list[str]:
    """A C identifier for each part: the model's name, with the material's where there are several parts."""
    if len(source.parts) == 1:
        return [name]
    names: list[str] = []
    for i, part in enumerate(source.parts):
        candidate = f"{name}_{name_from(part.name) if part.name else 'plain'}"
        names.append(f"{candidate}_{i}" if candidate in names else candidate)
    # A header has arrays and structures of each mesh, too, whose names begin with its own.
    return [f"{one}_{i}" if any(is_name_of_part(one, other) for other in names) else one for i, one in enumerate(names)]


def style_of(args: argparse.Namespace) -> Style:
    """What the command line says of textures; `with_texture` adds what the model does."""
    texture_format = next(one for one in Format if one.option == (args.texture_format or Format.RGB565.option))
    most = atlas.LEVELS if args.atlas else MAX_TEXTURE_LOG2 + 1
    return Style(texture_format, args.dither or "none", most if args.mipmaps else 1, smooth=args.filter == "bilinear")


def with_alpha_of(source: Source, args: argparse.Namespace) -> Source:
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
    for part, image in zip(source.parts, pixels, strict=True):
        name = part.name or "the model"
        if is_blended(part):
            notes.append(f"{name}: it is blended; draw it after all that is opaque")
        elif image is not None and image.is_clear and args.alpha is None and image.alpha is None:
            notes.append(f"{name}: its image has clear places, which are drawn; give --alpha test or --alpha blend")
    return notes


def convert_model(args: argparse.Namespace, name: str, steps: Steps) -> Result:
    """The meshes of the model that `args` name, the first of them called `name`. Raises EdgelineError."""
    if args.model.suffix.lower() == ".elm":
        return convert_elm(args.model, name)
    source = with_alpha_of(coloured(read_source(args.model), args), args)
    size = args.texture_size or DEFAULT_TEXTURE_SIZE
    style = style_of(args)
    with_alpha = style.format == Format.MASK
    pixels: list[Pixels | None] = []
    with steps.bar("images", len(source.parts)) as done:
        for part in source.parts:
            picture = part.picture
            load_alpha = picture is not None and (with_alpha or picture.alpha != Alpha.NONE)
            pixels.append(None if picture is None else picture.load(size, load_alpha))
            done(1)
    source = placed(source, args.up or "y", args.scale or 1.0, args.centre)
    fewer = None
    if args.triangles is not None or args.tolerance is not None:
        fewer = simplified(source, args.triangles, args.tolerance, steps)
        source = fewer.source
    elif len(source.positions) > 2 * len(source.parts) * MAX_TRIANGLES:
        check_triangle_count(len(source.positions))  # before any work is done on them
    if args.atlas:
        source, pixels = atlas.with_atlases(source, pixels, style.levels)
    if args.no_normals:
        source = replace(source, normals=None)
    else:
        source = with_normals(source, DEFAULT_CREASE if args.crease is None else args.crease)
    try:
        scale_log2 = scale_log2_for(float(np.abs(source.positions).max()))
        named, error, squares, dropped, before = [], 0.0, 0.0, 0, 0.0
        errors: list[ColourError | None] = []
        with steps.bar("meshes", len(source.parts)) as done:
            for i, part_name in in_drawing_order(source, part_names(source, name)):
                rows = source.part_of == i
                done(1)
                if not has_area(np.rint(np.ldexp(source.positions[rows], -scale_log2))).any():
                    dropped += int(rows.sum())
                    continue
                chosen, texture, colours = with_texture(source.chosen(rows), source.parts[i], pixels[i], style)
                found = quantise(soup_of(chosen, texture), scale_log2)
                mesh = found.mesh if args.no_clusters else with_clusters(found.mesh, per_triangle)
                named.append(NamedMesh(part_name, mesh, texture, material=look_of(source.parts[i])))
                errors.append(colours)
                before += per_triangle(found.mesh) * len(mesh.triangles)
                squares += found.position_rms**2 * len(mesh.triangles)
                error, dropped = max(error, found.position_error), dropped + found.dropped_triangles
        if not named:
            check_triangle_count(0)
    except EdgelineError as problem:
        text = str(problem)
        raise problem if text.startswith(source.name) else EdgelineError(f"{source.name}: {text}") from problem
    total = sum(len(one.mesh.triangles) for one in named)
    reordered = any(one.mesh.clusters is not None for one in named)
    return Result(
        named,
        error,
        math.sqrt(squares / total),
        dropped,
        (*source.notes, *notes_of(source, pixels, args)),
        fewer,
        before / total if reordered else None,
        tuple(errors),
    )


def convert_elm(path: Path, name: str) -> Result:
    try:
        mesh, texture, material = elm.decode_all(read_bytes(path))
    except EdgelineError as error:
        raise EdgelineError(f"{path}: {error}") from error
    return Result([NamedMesh(name, mesh, texture, material=material)])
