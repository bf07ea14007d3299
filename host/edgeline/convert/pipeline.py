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
import numpy.typing as npt

from edgeline.convert import elm
from edgeline.convert.atlas import with_atlases
from edgeline.convert.clusters import with_clusters
from edgeline.convert.gltf import parse_gltf
from edgeline.convert.header import NamedMesh, is_name_of_part, name_from
from edgeline.convert.locality import per_triangle
from edgeline.convert.materials import (
    as_asked,
    in_drawing_order,
    load_pictures,
    look_of,
    notes_of,
    style_of,
    with_texture,
)
from edgeline.convert.mesh import (
    MAX_TRIANGLES,
    Quantised,
    check_triangle_count,
    has_area,
    quantise,
    scale_log2_for,
)
from edgeline.convert.model import source_from
from edgeline.convert.obj import Material, ObjModel, parse_mtl, parse_obj
from edgeline.convert.options import DEFAULT_CREASE, DEFAULT_TEXTURE_SIZE
from edgeline.convert.ply import parse_ply
from edgeline.convert.progress import Steps
from edgeline.convert.simplify import Simplified, simplified
from edgeline.convert.source import NO_GLOW, Picture, Source, placed, soup_of, with_normals
from edgeline.convert.stl import parse_stl
from edgeline.convert.texels import Wrap
from edgeline.convert.texture import Alpha, ColourError, Pixels, Style
from edgeline.errors import EdgelineError

NOTED_BITS = 3
"""By so many bits finer, --centre is worth a note."""


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


def file_beside(path: Path, name: str, notes: list[str]) -> Path:
    """The file that the model at `path` names; where that is not there, as on another computer, the one of that name in
    the model's own folder, if there is one, which is noted."""
    named = path.parent / name.replace("\\", "/")
    near = path.parent / named.name
    if named.exists() or not near.is_file():
        return named
    notes.append(f"{name} is not there; {near.name} beside the model is taken")
    return near


def read_materials(path: Path, model: ObjModel, notes: list[str]) -> tuple[dict[str, Material], dict[str, str]]:
    """The materials of all libraries that the model names, and the library of each. A missing one is only noted."""
    materials: dict[str, Material] = {}
    library_of: dict[str, str] = {}
    for _, name in model.libraries:
        library = file_beside(path, name, notes)
        if not library.is_file():
            notes.append(f"the material library {name} is not there; its colours and textures are left out")
            continue
        found = parse_mtl(library.name, read_bytes(library))
        materials |= found
        for material, made in found.items():
            if made.glows:
                notes.append(f"{material}: {NO_GLOW}")
            if made.clear_image is not None and not made.has_alpha:
                notes.append(f"{material}: map_d is left out; what is clear has to be the alpha of map_Kd's own image")
        library_of |= dict.fromkeys(found, library.name)
    return materials, library_of


def read_obj(path: Path) -> Source:
    model = parse_obj(path.name, read_bytes(path))
    notes: list[str] = []
    materials, library_of = read_materials(path, model, notes)

    def picture_of(material: str) -> Picture:
        found = materials[material]
        image = file_beside(path, found.image or "", notes)
        wrap = Wrap.CLAMP if found.clamps else Wrap.REPEAT
        alpha = Alpha.BLEND if found.has_alpha else Alpha.NONE
        return Picture(f"{library_of[material]}:{found.line}: map_Kd", image, wrap=(wrap, wrap), alpha=alpha)

    source = source_from(model, materials, picture_of)
    return replace(source, notes=(*dict.fromkeys(notes), *source.notes))


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
        colours = np.repeat(source.triangle_colours[:, None], 3, axis=1)
        source = replace(source, colours=colours, tints=False, triangle_colours=None)  # pictures have their factors
    if source.colours is not None and not source.tints:
        plain = np.array([part.picture is None for part in source.parts])[source.part_of]
        source = replace(source, colours=np.where(plain[:, None, None], source.colours, np.uint8(255)))
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


def reduced(source: Source, args: argparse.Namespace, steps: Steps) -> tuple[Source, Simplified | None]:
    """`source` with as few triangles as were asked for. Raises EdgelineError for more than meshes hold."""
    if args.triangles is not None or args.tolerance is not None:
        fewer = simplified(source, args.triangles, args.tolerance, steps)
        return fewer.source, fewer
    if len(source.positions) > 2 * len(source.parts) * MAX_TRIANGLES:
        check_triangle_count(len(source.positions))  # before any work is done on them
    return source, None


def scale_log2_of(source: Source) -> int:
    return scale_log2_for(float(np.abs(source.positions).max()))


def triangles_with_area(source: Source) -> npt.NDArray[np.bool_]:
    """Which triangles have one when their positions are whole units."""
    return has_area(np.rint(np.ldexp(source.positions, -scale_log2_of(source))))


def centred(source: Source) -> Source:
    return placed(source, "y", 1.0, centre=True)


def meshes_of(
    source: Source, pixels: list[Pixels | None], style: Style, names: list[str], steps: Steps, *, clustered: bool
) -> Result:
    """A mesh of each part that has an area, named so; those that are blended last. Raises EdgelineError."""
    scale_log2 = scale_log2_of(source)
    drawn = triangles_with_area(source)
    named: list[NamedMesh] = []
    found: list[Quantised] = []
    errors: list[ColourError | None] = []
    dropped = 0
    with steps.bar("meshes", len(source.parts)) as done:
        for i, part_name in in_drawing_order(source, names):
            rows = source.part_of == i
            done(1)
            if not drawn[rows].any():
                dropped += int(rows.sum())
                continue
            part = source.parts[i]
            chosen, texture, colours = with_texture(source.chosen(rows), part, pixels[i], style)
            found.append(quantise(soup_of(chosen, texture), scale_log2))
            errors.append(colours)
            mesh = with_clusters(found[-1].mesh, per_triangle) if clustered else found[-1].mesh
            named.append(NamedMesh(part_name, mesh, texture, material=look_of(part)))
    counts = [len(one.mesh.triangles) for one in found]
    total = sum(counts)
    if total == 0 and triangles_with_area(centred(source)).any():
        raise EdgelineError("it is so far from its origin that no triangle is left with an area; give --centre")
    check_triangle_count(min(total, 1))
    before = sum(per_triangle(one.mesh) * count for one, count in zip(found, counts, strict=True)) / total
    squares = sum(one.position_rms**2 * count for one, count in zip(found, counts, strict=True)) / total
    return Result(
        named,
        max(one.position_error for one in found),
        math.sqrt(squares),
        dropped + sum(one.dropped_triangles for one in found),
        transforms_before=before if any(one.mesh.clusters is not None for one in named) else None,
        colour_errors=tuple(errors),
    )


def convert_model(args: argparse.Namespace, name: str, steps: Steps) -> Result:
    """The meshes of the model that `args` name, the first of them called `name`. Raises EdgelineError."""
    if args.model.suffix.lower() == ".elm":
        return convert_elm(args.model, name)
    source = as_asked(coloured(read_source(args.model), args), args)
    style = style_of(args)
    pixels = load_pictures(source, style, args.texture_size or DEFAULT_TEXTURE_SIZE, steps)
    source = placed(source, args.up or "y", args.scale or 1.0, args.centre)
    source, fewer = reduced(source, args, steps)
    if args.atlas:
        source, pixels = with_atlases(source, pixels, style.levels)
    if args.no_normals:
        source = replace(source, normals=None)
    else:
        source = with_normals(source, DEFAULT_CREASE if args.crease is None else args.crease)
    try:
        result = meshes_of(source, pixels, style, part_names(source, name), steps, clustered=not args.no_clusters)
    except EdgelineError as problem:
        text = str(problem)
        raise problem if text.startswith(source.name) else EdgelineError(f"{source.name}: {text}") from problem
    notes = [*source.notes, *notes_of(source, pixels, args)]
    if (bits := scale_log2_of(source) - scale_log2_of(centred(source))) >= NOTED_BITS:
        notes.append(f"it is far from its origin; --centre makes its positions {1 << bits} times as fine")
    return replace(result, notes=tuple(notes), simplified=fewer)


def convert_elm(path: Path, name: str) -> Result:
    try:
        mesh, texture, material = elm.decode_all(read_bytes(path))
    except EdgelineError as error:
        raise EdgelineError(f"{path}: {error}") from error
    return Result([NamedMesh(name, mesh, texture, material=material)])
