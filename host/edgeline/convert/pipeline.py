"""The way from a model's file to meshes: read, place, simplify, shade, quantise, gather in clusters.

A model whose triangles have several textures, or some and some none, becomes several meshes, as the firmware draws a
mesh with one texture. They share unit and origin, so that they fit together without cracks.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from edgeline.convert import elm
from edgeline.convert.clusters import with_clusters
from edgeline.convert.gltf import parse_gltf
from edgeline.convert.header import NamedMesh, name_from
from edgeline.convert.locality import per_triangle
from edgeline.convert.mesh import MAX_TRIANGLES, check_triangle_count, has_area, quantise, scale_log2_for
from edgeline.convert.model import source_from
from edgeline.convert.obj import Material, ObjModel, parse_mtl, parse_obj
from edgeline.convert.options import DEFAULT_CREASE, DEFAULT_TEXTURE_SIZE
from edgeline.convert.ply import parse_ply
from edgeline.convert.progress import Steps
from edgeline.convert.simplify import Simplified, simplified
from edgeline.convert.source import Picture, Source, placed, soup_of, with_normals
from edgeline.convert.stl import parse_stl
from edgeline.errors import EdgelineError


@dataclass(frozen=True)
class Result:
    """Converted meshes and what there is to say about them. Errors are in world units."""

    meshes: list[NamedMesh]
    position_error: float = 0.0
    dropped_triangles: int = 0
    notes: tuple[str, ...] = ()
    simplified: Simplified | None = None
    transforms_before: float | None = None
    """Per triangle, with the model's own order; None where that stays."""


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
        image = materials[material].image or ""
        where = f"{library_of[material]}:{materials[material].line}: map_Kd"
        return Picture(where, path.parent / image.replace("\\", "/"))

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
    return names


def convert_model(args: argparse.Namespace, name: str, steps: Steps) -> Result:
    """The meshes of the model that `args` name, the first of them called `name`. Raises EdgelineError."""
    if args.model.suffix.lower() == ".elm":
        return convert_elm(args.model, name)
    source = coloured(read_source(args.model), args)
    size = args.texture_size or DEFAULT_TEXTURE_SIZE
    textures = [None if part.picture is None else part.picture.load(size) for part in source.parts]
    source = placed(source, args.up or "y", args.scale or 1.0, args.centre)
    fewer = None
    if args.triangles is not None or args.tolerance is not None:
        fewer = simplified(source, args.triangles, args.tolerance, steps)
        source = fewer.source
    elif len(source.positions) > 2 * len(source.parts) * MAX_TRIANGLES:
        check_triangle_count(len(source.positions))  # before any work is done on them
    if args.no_normals:
        source = replace(source, normals=None)
    else:
        source = with_normals(source, DEFAULT_CREASE if args.crease is None else args.crease)
    try:
        scale_log2 = scale_log2_for(float(np.abs(source.positions).max()))
        named, error, dropped, before = [], 0.0, 0, 0.0
        for i, (part_name, texture) in enumerate(zip(part_names(source, name), textures, strict=True)):
            rows = source.part_of == i
            if not has_area(np.rint(np.ldexp(source.positions[rows], -scale_log2))).any():
                dropped += int(rows.sum())
                continue
            part = quantise(soup_of(source.chosen(rows), texture), scale_log2)
            mesh = part.mesh if args.no_clusters else with_clusters(part.mesh, per_triangle)
            named.append(NamedMesh(part_name, mesh, texture))
            before += per_triangle(part.mesh) * len(mesh.triangles)
            error, dropped = max(error, part.position_error), dropped + part.dropped_triangles
        if not named:
            check_triangle_count(0)
    except EdgelineError as problem:
        text = str(problem)
        raise problem if text.startswith(source.name) else EdgelineError(f"{source.name}: {text}") from problem
    total = sum(len(one.mesh.triangles) for one in named)
    reordered = any(one.mesh.clusters is not None for one in named)
    return Result(named, error, dropped, source.notes, fewer, before / total if reordered else None)


def convert_elm(path: Path, name: str) -> Result:
    try:
        mesh, texture = elm.decode(read_bytes(path))
    except EdgelineError as error:
        raise EdgelineError(f"{path}: {error}") from error
    return Result([NamedMesh(name, mesh, texture)])
