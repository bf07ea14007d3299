"""The standard benchmark scenes S1..S4 as meshes, vertex for vertex exact.

The scenes' unit, 1/512 of a model unit, becomes the meshes' position unit, so nothing is rounded. S4 is wider than 16
bits reach: it becomes as few meshes as possible, each of them around an origin of its own.
"""

from __future__ import annotations

from itertools import combinations, product
from pathlib import Path
from string import ascii_lowercase

import numpy as np
import numpy.typing as npt

from edgeline.convert.header import NamedMesh
from edgeline.convert.mesh import TEXEL_ONE, Ints, Mesh, weld
from edgeline.convert.texels import Texture
from edgeline.errors import EdgelineError

SCALE_LOG2 = -9
REACH = 65535
"""Widest extent of a mesh in position units."""
Scenes = dict[str, npt.NDArray[np.generic]]


def load(path: Path) -> Scenes:
    """The arrays of a scenes file. Raises EdgelineError when it is none."""
    try:
        with np.load(path) as archive:
            return {name: archive[name] for name in archive.files}
    except (OSError, ValueError, KeyError) as error:
        raise EdgelineError(f"cannot read the scenes {path}: {error}; give the benchmark's scenes.npz") from error


def flat_mesh(vertices: Ints, triangles: Ints, rgb: npt.NDArray[np.uint8]) -> Mesh:
    """A mesh with one colour per triangle, of those vertices that a triangle names, in their order."""
    used, renamed = np.unique(triangles, return_inverse=True)
    return Mesh(
        positions=vertices[used].astype(np.int16),
        triangles=renamed.reshape(-1, 3).astype(np.uint16),
        scale_log2=SCALE_LOG2,
        triangle_colours=rgb.astype(np.uint8),
    )


def windows(corners: Ints) -> list[Ints]:
    """Lower corners of the fewest cubes of side REACH such that each triangle (m, 3, 3) lies within one.

    The candidates touch an end of the whole extent on each axis; two on an axis suffice up to twice the reach.
    """
    low, high = corners.min(axis=1), corners.max(axis=1)
    ends = list(zip(low.min(axis=0).tolist(), (high.max(axis=0) - REACH).tolist(), strict=True))
    candidates = [np.array(corner) for corner in product(*ends)]
    holds = [np.all((low >= corner) & (high <= corner + REACH), axis=1) for corner in candidates]
    for count in range(1, len(candidates) + 1):
        for chosen in combinations(range(len(candidates)), count):
            if np.all(np.any([holds[i] for i in chosen], axis=0)):
                return [candidates[i] for i in chosen]
    raise EdgelineError(f"a triangle of this scene is wider than {REACH} units: it fits no mesh")


def split(name: str, vertices: Ints, triangles: Ints, rgb: npt.NDArray[np.uint8]) -> list[NamedMesh]:
    """One mesh when 16 bits reach, otherwise `name_a`, `name_b`, ... with offsets; triangles keep their order."""
    if vertices.min() >= -REACH // 2 and vertices.max() <= REACH // 2:
        return [NamedMesh(name, flat_mesh(vertices, triangles, rgb))]
    corners = vertices[triangles]
    left = np.ones(len(triangles), dtype=bool)
    meshes = []
    for letter, corner in zip(ascii_lowercase, windows(corners), strict=False):
        inside = np.all((corners >= corner) & (corners <= corner + REACH), axis=(1, 2)) & left
        left &= ~inside
        origin = corner + (REACH + 1) // 2
        mesh = flat_mesh(vertices - origin, triangles[inside], rgb[inside])
        x, y, z = (int(c) << (16 + SCALE_LOG2) for c in origin)
        meshes.append(NamedMesh(f"{name}_{letter}", mesh, offset_q16=(x, y, z)))
    return meshes


def sphere(scenes: Scenes) -> list[NamedMesh]:
    mesh = Mesh(
        positions=scenes["S1_vertices"].astype(np.int16),
        triangles=scenes["S1_triangles"].astype(np.uint16),
        scale_log2=SCALE_LOG2,
        colours=scenes["S1_vertex_rgb"].astype(np.uint8),
    )
    return [NamedMesh("s1", mesh)]


def room(scenes: Scenes) -> list[NamedMesh]:
    positions = scenes["S2_vertices"].astype(np.int64)[scenes["S2_triangles"]]
    uvs = scenes["S2_corner_uv_texels"].astype(np.int64) * TEXEL_ONE
    corners = np.concatenate([positions, uvs], axis=2).reshape(-1, 5)
    first, vertex_of = weld(corners)
    mesh = Mesh(
        positions=corners[first, :3].astype(np.int16),
        triangles=vertex_of.reshape(-1, 3).astype(np.uint16),
        scale_log2=SCALE_LOG2,
        uvs=corners[first, 3:].astype(np.int16),
    )
    return [NamedMesh("s2", mesh, Texture(scenes["texture_rgb565"].astype(np.uint16)))]


def scattered(name: str, scenes: Scenes) -> list[NamedMesh]:
    key = name.upper()
    vertices = scenes[f"{key}_vertices"].astype(np.int64)
    triangles = scenes[f"{key}_triangles"].astype(np.int64)
    return split(name, vertices, triangles, scenes[f"{key}_triangle_rgb"].astype(np.uint8))


ABOUT = {
    "s1": "Benchmark scene S1: a sphere, Gouraud.",
    "s2": "Benchmark scene S2: a textured room.",
    "s3": "Benchmark scene S3: many small triangles.",
    "s4": "Benchmark scene S4: many small triangles, most of them off the screen.",
}


def all_scenes(scenes: Scenes) -> dict[str, list[NamedMesh]]:
    """The meshes of each scene, by the name of its header."""
    return {
        "s1": sphere(scenes),
        "s2": room(scenes),
        "s3": scattered("s3", scenes),
        "s4": scattered("s4", scenes),
    }
