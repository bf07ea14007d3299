"""What `edgeline convert` says at the end: what was made, how far it is from the model, what it takes to draw it."""

from __future__ import annotations

import argparse
import math

from edgeline import budget_facts as facts
from edgeline.budget import Wish, account
from edgeline.convert import estimate
from edgeline.convert.header import NamedMesh
from edgeline.convert.locality import cache_slots, per_triangle
from edgeline.convert.pipeline import Result

BAND = 8
Facts = dict[str, object]


def shading_of(meshes: list[NamedMesh]) -> str:
    """The dearest shading that the meshes have what it takes for."""
    if any(one.texture is not None for one in meshes):
        return "textured"
    smooth = any(one.mesh.normals is not None or one.mesh.colours is not None for one in meshes)
    return "gouraud" if smooth and any(one.mesh.triangle_colours is None for one in meshes) else "flat"


def texture_facts(named: NamedMesh) -> list[int] | None:
    return None if named.texture is None else [1 << named.texture.width_log2, 1 << named.texture.height_log2]


def mesh_facts(named: NamedMesh) -> Facts:
    mesh, texture = named.mesh, named.texture
    texture_bytes = 0 if texture is None else texture.texels.nbytes
    return {
        "name": named.name,
        "vertices": len(mesh.positions),
        "triangles": len(mesh.triangles),
        "clusters": 0 if mesh.clusters is None else len(mesh.clusters),
        "flash_bytes": mesh.flash_bytes + texture_bytes,
        "mesh_bytes": mesh.flash_bytes,
        "texture_bytes": texture_bytes,
        "texture_size": texture_facts(named),
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
    each = [mesh_facts(named) for named in result.meshes]
    meshes = [named.mesh for named in result.meshes]
    sums = {
        key: sum(len(mesh.positions) if key == "vertices" else len(mesh.triangles) for mesh in meshes)
        for key in ("vertices", "triangles")
    }
    texture_bytes = sum(0 if one.texture is None else one.texture.texels.nbytes for one in result.meshes)
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
        "position_error": result.position_error,
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
        present.append(f"a {1 << named.texture.width_log2}x{1 << named.texture.height_log2} texture")
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
    error = f"positions within {found['position_error']:.2g} of the model's"
    print(f"  unit 2^{unit}, {error}, radius {found['radius']:.4g}")
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
    print(
        f"  estimate: {frame['milliseconds']:.0f} ms a frame on {frame['core']} at {frame['clock_hz'] / 1e6:g} MHz, "
        f"seen whole ({frame['instructions']:,} instructions)"
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
