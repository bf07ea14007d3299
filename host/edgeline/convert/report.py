"""What `edgeline convert` says at the end: what was made, how far it is from the model, what it takes to draw it."""

from __future__ import annotations

import argparse
import math
from collections import Counter

from edgeline import budget_facts as facts
from edgeline.budget import Wish, account
from edgeline.convert import estimate
from edgeline.convert.header import NamedMesh
from edgeline.convert.locality import cache_slots, per_triangle
from edgeline.convert.pipeline import Result
from edgeline.convert.texels import Format, Texture
from edgeline.convert.texture import ColourError

BAND = 8
Facts = dict[str, object]
PART_TITLES = {"triangle_colours": "triangles' colours", "uvs": "texture coordinates"}


def shading_of(meshes: list[NamedMesh]) -> str:
    """The dearest shading that the meshes have what it takes for."""
    if any(one.texture is not None for one in meshes):
        return "textured"
    smooth = any(one.mesh.normals is not None or one.mesh.colours is not None for one in meshes)
    return "gouraud" if smooth and any(one.mesh.triangle_colours is None for one in meshes) else "flat"


def texture_facts(named: NamedMesh) -> list[int] | None:
    return None if named.texture is None else [1 << named.texture.width_log2, 1 << named.texture.height_log2]


def parts_bytes(meshes: list[NamedMesh]) -> dict[str, int]:
    """Bytes of flash by what is in them, those of all meshes together."""
    total: Counter[str] = Counter()
    for one in meshes:
        total.update(one.mesh.parts_bytes)
    for one in meshes:
        total.update({} if one.texture is None else one.texture.parts_bytes)
    return dict(total)


def colour_facts(found: ColourError | None) -> Facts | None:
    return None if found is None else {"rms": found.rms, "largest": found.largest}


def worst_colours(errors: tuple[ColourError | None, ...]) -> ColourError | None:
    """Of all textures together: the mean over all texels, and the largest."""
    known = [one for one in errors if one is not None]
    if not known:
        return None
    texels = sum(one.texels for one in known)
    squares = sum(one.rms**2 * one.texels for one in known)
    return ColourError(math.sqrt(squares / texels), max(one.largest for one in known), texels)


def is_mixed(meshes: list[NamedMesh]) -> bool:
    """Whether one is drawn by what is slower than the laws that the estimate is made of."""
    textures = [level for one in meshes if one.texture is not None for level in one.texture.levels()]
    looks = [one.material for one in meshes if one.material is not None]
    return (
        any(t.is_image or t.smooth or any(t.wrap) for t in textures)
        or any(look.opacity < 255 for look in looks)
        or any(one.texture is not None and one.mesh.colours is not None for one in meshes)
    )


def mesh_facts(named: NamedMesh, error: ColourError | None) -> Facts:
    mesh, texture = named.mesh, named.texture
    texture_bytes = 0 if texture is None else texture.flash_bytes
    return {
        "name": named.name,
        "vertices": len(mesh.positions),
        "triangles": len(mesh.triangles),
        "clusters": 0 if mesh.clusters is None else len(mesh.clusters),
        "flash_bytes": mesh.flash_bytes + texture_bytes,
        "mesh_bytes": mesh.flash_bytes,
        "texture_bytes": texture_bytes,
        "texture_size": texture_facts(named),
        "texture_format": None if texture is None else texture.format.option,
        "texture_levels": 0 if texture is None else len([*texture.levels()]),
        "colour_error": colour_facts(error),
        "scale_log2": mesh.scale_log2,
        "radius": math.ldexp(mesh.radius, mesh.scale_log2),
    }


def ram_bytes(meshes: list[NamedMesh], shading: str) -> int:
    """EL_MEMORY_BYTES of a renderer of 320 x 240 that draws all triangles in one pass."""
    wish = Wish(
        panel="ili9341",
        width=estimate.WIDTH,
        height=estimate.HEIGHT,
        band=BAND,
        vertices=max(len(one.mesh.positions) for one in meshes),
        triangles=sum(len(one.mesh.triangles) for one in meshes),
        draws=len(meshes),
        shading=shading,
    )
    return account(wish).arena


def frame_facts(meshes: list[NamedMesh], shading: str, core: str, clock_hz: int | None) -> Facts:
    view = estimate.look_at([one.mesh for one in meshes])
    count = estimate.instructions(view, shading, core)
    hertz = clock_hz or estimate.CLOCKS_HZ[core]
    return {
        "estimate": True,
        "at_least": is_mixed(meshes),
        "source": facts.LAWS_SOURCE,
        "core": core,
        "clock_hz": hertz,
        "instructions": count,
        "milliseconds": 1000 * count / hertz,
        "facing_triangles": view.facing,
        "rows": view.rows,
        "pixels": view.pixels,
    }


def report(args: argparse.Namespace, outputs: list[str], result: Result) -> Facts:
    """Everything, as --json prints it: of several meshes the sums, then each."""
    errors = result.colour_errors or (None,) * len(result.meshes)
    each = [mesh_facts(named, error) for named, error in zip(result.meshes, errors, strict=True)]
    meshes = [named.mesh for named in result.meshes]
    sums = {
        key: sum(len(mesh.positions) if key == "vertices" else len(mesh.triangles) for mesh in meshes)
        for key in ("vertices", "triangles")
    }
    texture_bytes = sum(0 if one.texture is None else one.texture.flash_bytes for one in result.meshes)
    mesh_bytes = sum(mesh.flash_bytes for mesh in meshes)
    shading = shading_of(result.meshes)
    _, radius = estimate.sphere_around(meshes)
    found: Facts = {
        "output": str(args.output),
        "outputs": outputs,
        "name": result.meshes[0].name,
        **sums,
        "clusters": sum(0 if mesh.clusters is None else len(mesh.clusters) for mesh in meshes),
        "dropped_triangles": result.dropped_triangles,
        "flash_bytes": mesh_bytes + texture_bytes,
        "mesh_bytes": mesh_bytes,
        "texture_bytes": texture_bytes,
        "texture_size": texture_facts(result.meshes[0]),
        "scale_log2": meshes[0].scale_log2,
        "flash_parts": parts_bytes(result.meshes),
        "position_error": result.position_error,
        "position_rms": result.position_rms,
        "colour_error": colour_facts(worst_colours(errors)),
        "radius": each[0]["radius"] if len(each) == 1 else radius,
        "shading": shading,
        "ram_bytes": ram_bytes(result.meshes, shading),
        "transforms_per_triangle": transforms_facts(result),
        "frame": frame_facts(result.meshes, shading, args.core, args.cpu),
        "simplified": simplified_facts(result),
        "meshes": each,
        "notes": list(result.notes),
    }
    return found


def transforms_facts(result: Result) -> Facts:
    total = sum(len(one.mesh.triangles) for one in result.meshes)
    after = sum(per_triangle(one.mesh) * len(one.mesh.triangles) for one in result.meshes) / total
    before = after if result.transforms_before is None else result.transforms_before
    return {"cache_slots": cache_slots(), "before": before, "after": after}


def simplified_facts(result: Result) -> Facts | None:
    found = result.simplified
    if found is None:
        return None
    size = found.size or 1.0
    return {
        "triangles_before": found.triangles_before,
        "largest_distance": found.largest_distance,
        "mean_distance": found.mean_distance,
        "largest_fraction": found.largest_distance / size,
        "mean_fraction": found.mean_distance / size,
    }


# --- As text ----------------------------------------------------------------------------------------------------------


def texture_words(texture: Texture) -> str:
    kinds = [] if texture.format == Format.RGB565 else [texture.format.option]
    kinds += [f"{len([*texture.levels()])} levels"] if texture.smaller is not None else []
    kinds += ["alpha test"] if texture.key is not None else []
    kinds += ["alpha"] if texture.alpha is not None else []
    kinds += ["bilinear"] if texture.smooth else []
    kinds += [f"{mode.name.lower()} {axis}" for axis, mode in zip("uv", texture.wrap, strict=True) if mode]
    more = f" ({', '.join(kinds)})" if kinds else ""
    return f"a {1 << texture.width_log2}x{1 << texture.height_log2} texture{more}"


def contents(named: NamedMesh) -> str:
    mesh = named.mesh
    kinds = {
        "vertex colours": mesh.colours,
        "triangle colours": mesh.triangle_colours,
        "normals": mesh.normals,
        "texture coordinates": mesh.uvs,
    }
    present = [kind for kind, array in kinds.items() if array is not None]
    if named.texture is not None:
        present.append(texture_words(named.texture))
    return ", ".join(present) or "positions only"


def print_report(found: Facts, result: Result) -> None:
    outputs = found["outputs"]
    assert isinstance(outputs, list)
    for i, named in enumerate(result.meshes):
        output = outputs[i] if len(outputs) > 1 else outputs[0]
        print(f"{output}: {named.name}, with {contents(named)}")
    print(
        f"  {found['triangles']:,} triangles, {found['vertices']:,} vertices, {found['flash_bytes']:,} bytes of flash"
    )
    unit = result.meshes[0].mesh.scale_log2
    error = f"positions within {found['position_error']:.2g} of the model's, {found['position_rms']:.2g} rms"
    print(f"  unit 2^{unit}, {error}, radius {found['radius']:.4g}")
    parts = parts_bytes(result.meshes)
    print("  " + ", ".join(f"{count:,} {PART_TITLES.get(part, part)}" for part, count in parts.items()))
    colours = worst_colours(result.colour_errors)
    if colours is not None:
        print(f"  colours within {colours.largest} of 255 of the images', {colours.rms:.2g} rms")
    _print_simplified(result)
    if found["clusters"]:
        print(f"  {found['clusters']:,} clusters, skipped where they are outside the view or face away")
    if result.dropped_triangles:
        print(f"  {result.dropped_triangles} triangles without an area were dropped")
    moved = transforms_facts(result)
    print(
        f"  {moved['after']:.2f} vertices transformed per triangle, {moved['before']:.2f} in the model's order, "
        f"where RAM keeps {moved['cache_slots']}"
    )
    print(f"  {found['ram_bytes']:,} bytes of RAM draw it in one pass: {found['shading']}, 320x240, bands of {BAND}")
    frame = found["frame"]
    assert isinstance(frame, dict)
    at_least = "at least " if frame["at_least"] else ""
    print(
        f"  estimate: {at_least}{frame['milliseconds']:.0f} ms a frame on {frame['core']} at "
        f"{frame['clock_hz'] / 1e6:g} MHz, seen whole ({frame['instructions']:,} instructions)"
    )
    for note in result.notes:
        print(f"  note: {note}")


def _print_simplified(result: Result) -> None:
    found = result.simplified
    if found is None:
        return
    size = found.size or 1.0
    print(
        f"  simplified from {found.triangles_before:,} triangles; surfaces {found.largest_distance:.3g} apart at most "
        f"({found.largest_distance / size:.2%} of the size), {found.mean_distance:.2g} on average"
    )
