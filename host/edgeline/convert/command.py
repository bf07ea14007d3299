"""`edgeline convert`: a model into a C header or an .elm file.

    edgeline convert spot.obj --texture spot.png -o spot.h

Exit status 0, or an EdgelineError (status 2), one line that says what, where and what to do; then nothing is written.
"""

from __future__ import annotations

import argparse
import json
import math
import shlex
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from edgeline.convert import elm
from edgeline.convert.clusters import with_clusters
from edgeline.convert.files import write_whole
from edgeline.convert.header import NamedMesh, c_header, check_name, name_from
from edgeline.convert.mesh import MAX_TEXTURE_LOG2, Mesh, Texture, quantise
from edgeline.convert.model import soup_from, textured_face
from edgeline.convert.obj import Material, ObjModel, parse_mtl, parse_obj
from edgeline.convert.texture import load_texture
from edgeline.errors import EdgelineError

if TYPE_CHECKING:
    SubParsers = argparse._SubParsersAction[argparse.ArgumentParser]

DEFAULT_CREASE = 60.0
DEFAULT_TEXTURE_SIZE = 128
MODEL_OPTIONS = ("crease", "no_normals", "texture", "no_texture", "texture_size", "scale", "centre", "no_clusters")
"""What can be asked of an OBJ; an .elm is passed on as it is."""


@dataclass(frozen=True)
class Result:
    """A converted model and what there is to say about it. Errors are in world units."""

    mesh: Mesh
    texture: Texture | None
    position_error: float
    dropped_triangles: int
    notes: list[str]


def add_parser(subparsers: SubParsers) -> None:
    """Adds the command to the command line of `edgeline`; the parser's `func` takes the arguments, returns a status."""
    parser = subparsers.add_parser(
        "convert",
        help="make a mesh for the firmware out of a model",
        description="Converts a Wavefront OBJ (or an .elm) to a C header or an .elm file.",
    )
    parser.add_argument("model", type=Path, help="a file .obj or .elm")
    parser.add_argument(
        "-o", "--output", type=Path, required=True, metavar="FILE", help="the result: FILE.h or FILE.elm"
    )
    parser.add_argument("--name", help="C name of the mesh (default: from the output's name)")
    parser.add_argument(
        "--crease", type=float, metavar="DEGREES", help="edges sharper than this stay sharp (default: 60; 0 is flat)"
    )
    parser.add_argument("--no-normals", action="store_true", help="leave normals out")
    image = parser.add_mutually_exclusive_group()
    image.add_argument("--texture", type=Path, metavar="IMAGE", help="the texture (default: map_Kd of the materials)")
    image.add_argument("--no-texture", action="store_true", help="no texture; colours of the materials instead")
    parser.add_argument(
        "--texture-size", type=int, metavar="TEXELS", help="longest side of the texture, a power of two (default: 128)"
    )
    parser.add_argument("--scale", type=float, metavar="FACTOR", help="multiply all coordinates (default: 1)")
    parser.add_argument("--centre", action="store_true", help="move the middle of the bounding box to the origin")
    parser.add_argument(
        "--no-clusters",
        action="store_true",
        help="keep the model's order of triangles, without the clusters by which hidden parts are skipped",
    )
    parser.add_argument("--json", action="store_true", help="report as one JSON object")
    parser.set_defaults(func=run)


def read_bytes(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise EdgelineError(f"cannot read {path}: {error.strerror or error}") from error


def check_options(args: argparse.Namespace) -> None:
    """Raises EdgelineError for options that make no sense, alone or for this kind of file."""
    if args.output.suffix.lower() not in (".h", ".elm"):
        raise EdgelineError(f"-o {args.output}: the result is a C header (.h) or an .elm; name it so")
    suffix = args.model.suffix.lower()
    if suffix not in (".obj", ".elm"):
        raise EdgelineError(f"{args.model}: models are read from .obj or .elm; export it as Wavefront OBJ")
    given = [f"--{name.replace('_', '-')}" for name in MODEL_OPTIONS if getattr(args, name) not in (None, False)]
    if suffix == ".elm" and given:
        raise EdgelineError(f"{given[0]} is for .obj models; an .elm is passed on as it is")
    if args.crease is not None and not 0 <= args.crease <= 180:
        raise EdgelineError(f"--crease {args.crease:g}: it is an angle of 0 to 180 degrees")
    if args.scale is not None and (not math.isfinite(args.scale) or args.scale <= 0):
        raise EdgelineError(f"--scale {args.scale:g}: it is a factor above 0")
    if args.texture_size is not None and args.texture_size not in [1 << i for i in range(MAX_TEXTURE_LOG2 + 1)]:
        raise EdgelineError(f"--texture-size {args.texture_size}: it is a power of two, 1024 at most")
    if args.name is not None:
        check_name(args.name)


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


def find_texture(
    args: argparse.Namespace, model: ObjModel, materials: dict[str, Material], library_of: dict[str, str]
) -> Texture | None:
    """The texture that was asked for, or the one that the materials name."""
    size = args.texture_size or DEFAULT_TEXTURE_SIZE
    if args.texture is not None:
        return load_texture(args.texture, size)
    images = {} if args.no_texture else textured_face(model, materials)
    if not images:
        return None
    if len(images) > 1:
        names = ", ".join(sorted(images))
        raise EdgelineError(
            f"{model.name}: {len(images)} textures ({names}), a mesh has one; "
            "put them into one image, or give --texture or --no-texture"
        )
    (image, face), *_ = images.items()
    material = model.materials[face.material]
    try:
        return load_texture(args.model.parent / image.replace("\\", "/"), size)
    except EdgelineError as error:
        where = f"{library_of[material]}:{materials[material].line}"
        raise EdgelineError(f"{where}: map_Kd: {error}, by --texture, or give --no-texture") from error


def convert_obj(args: argparse.Namespace) -> Result:
    model = parse_obj(args.model.name, read_bytes(args.model))
    notes: list[str] = []
    materials, library_of = read_materials(args.model, model, notes)
    texture = find_texture(args, model, materials, library_of)
    if texture is None and model.uvs:
        notes.append("texture coordinates are left out, as there is no texture; give one with --texture")
    soup = soup_from(
        model,
        materials,
        texture,
        crease_degrees=DEFAULT_CREASE if args.crease is None else args.crease,
        with_normals=not args.no_normals,
        scale=args.scale or 1.0,
        centre=args.centre,
    )
    try:
        result = quantise(soup)
    except EdgelineError as error:
        raise EdgelineError(f"{model.name}: {error}") from error
    mesh = result.mesh if args.no_clusters else with_clusters(result.mesh)
    return Result(mesh, texture, result.position_error, result.dropped_triangles, notes)


def convert_elm(path: Path) -> Result:
    try:
        mesh, texture = elm.decode(read_bytes(path))
    except EdgelineError as error:
        raise EdgelineError(f"{path}: {error}") from error
    return Result(mesh, texture, 0.0, 0, [])


def command_words(args: argparse.Namespace) -> str:
    """The command line with base names only: what another machine would be told to repeat."""
    words = ["edgeline", "convert", args.model.name]
    for name in MODEL_OPTIONS:
        value = getattr(args, name)
        option = f"--{name.replace('_', '-')}"
        if value is True:
            words.append(option)
        elif value not in (None, False):
            words += [option, value.name if isinstance(value, Path) else f"{value:g}"]
    return shlex.join(words)


def report(args: argparse.Namespace, name: str, result: Result) -> dict[str, object]:
    mesh, texture = result.mesh, result.texture
    texture_bytes = 0 if texture is None else texture.texels.nbytes
    return {
        "output": str(args.output),
        "name": name,
        "vertices": len(mesh.positions),
        "triangles": len(mesh.triangles),
        "clusters": 0 if mesh.clusters is None else len(mesh.clusters),
        "dropped_triangles": result.dropped_triangles,
        "flash_bytes": mesh.flash_bytes + texture_bytes,
        "mesh_bytes": mesh.flash_bytes,
        "texture_bytes": texture_bytes,
        "texture_size": None if texture is None else [1 << texture.width_log2, 1 << texture.height_log2],
        "scale_log2": mesh.scale_log2,
        "position_error": result.position_error,
        "radius": math.ldexp(mesh.radius, mesh.scale_log2),
        "notes": result.notes,
    }


def print_report(facts: dict[str, object], mesh: Mesh, texture: Texture | None) -> None:
    kinds = {
        "vertex colours": mesh.colours,
        "triangle colours": mesh.triangle_colours,
        "normals": mesh.normals,
        "texture coordinates": mesh.uvs,
    }
    present = [kind for kind, array in kinds.items() if array is not None]
    if texture is not None:
        present.append(f"a {1 << texture.width_log2}x{1 << texture.height_log2} texture")
    print(f"{facts['output']}: {facts['name']}, with {', '.join(present) or 'positions only'}")
    counts = f"{facts['triangles']:,} triangles, {facts['vertices']:,} vertices"
    print(f"  {counts}, {facts['flash_bytes']:,} bytes of flash")
    error = f"positions within {facts['position_error']:.2g} of the model's"
    print(f"  unit 2^{mesh.scale_log2}, {error}, radius {facts['radius']:.4g}")
    if facts["clusters"]:
        print(f"  {facts['clusters']:,} clusters, skipped where they are outside the view or face away")
    if facts["dropped_triangles"]:
        print(f"  {facts['dropped_triangles']} triangles without an area were dropped")
    for note in facts["notes"] if isinstance(facts["notes"], list) else []:
        print(f"  note: {note}")


def run(args: argparse.Namespace) -> int:
    """Converts as `args` say, prints the report. Raises EdgelineError; then the output is as it was before."""
    check_options(args)
    name = args.name or name_from(args.output.stem)
    result = convert_obj(args) if args.model.suffix.lower() == ".obj" else convert_elm(args.model)
    if args.output.suffix.lower() == ".elm":
        data = elm.encode(result.mesh, result.texture)
    else:
        about = [f"{args.model.name} as a mesh for Edgeline.", f"Made by: {command_words(args)}"]
        data = c_header(name, about, [NamedMesh(name, result.mesh, result.texture)]).encode("utf-8", "backslashreplace")
    write_whole(args.output, data)
    facts = report(args, name, result)
    if args.json:
        print(json.dumps(facts))
    else:
        print_report(facts, result.mesh, result.texture)
    return 0
