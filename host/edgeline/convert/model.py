"""From what an OBJ file says to triangles: polygons cut up, attributes gathered, all of it checked.

This is where an OBJ's conventions end: v of a texture coordinate turns from up to down.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from edgeline.convert.mesh import Floats, Ints
from edgeline.convert.obj import NONE, Material, ObjModel
from edgeline.convert.source import Part, Picture, Source, check_count, check_positions, to_bytes
from edgeline.convert.triangulate import triangulate

DEFAULT_COLOUR = 0.8, 0.8, 0.8
"""Of faces without a material in a model with materials; it is Wavefront's default too."""


@dataclass(frozen=True)
class Corners:
    """The corners of all triangles, as indices into the lists of the model, (m, 3) each, and the face of each, (m,)."""

    positions: Ints
    uvs: Ints
    normals: Ints
    faces: Ints


def gather(model: ObjModel, positions: Floats) -> Corners:
    """Triangles out of the model's faces; `positions` are its vertices, (n, 3)."""
    check_count(model.name, sum(len(face.positions) - 2 for face in model.faces))
    rows: list[tuple[int, ...]] = []
    for number, face in enumerate(model.faces):
        with np.errstate(all="ignore"):  # positions too large to compute with are found later, with a message
            cut = triangulate(positions[list(face.positions)])
        for triangle in cut:
            row = [column[i] for column in (face.positions, face.uvs, face.normals) for i in triangle]
            rows.append((*row, number))
    table = np.array(rows, dtype=np.int64)
    return Corners(table[:, 0:3], table[:, 3:6], table[:, 6:9], table[:, 9])


def corner_normals(model: ObjModel, corners: Corners) -> Floats | None:
    """The file's normals (m, 3, 3), 0 where a corner has none."""
    if not model.normals:
        return None
    return np.array([*model.normals, (0.0, 0.0, 0.0)], dtype=np.float64)[corners.normals]  # index NONE, -1, is the last


def corner_uvs(model: ObjModel, corners: Corners) -> Floats | None:
    """The file's texture coordinates (m, 3, 2), NaN where a corner has none."""
    if not model.uvs:
        return None
    uvs = np.array([*model.uvs, (np.nan, np.nan)], dtype=np.float64)[corners.uvs]
    return np.stack([uvs[..., 0], 1.0 - uvs[..., 1]], axis=2)


def vertex_colours(model: ObjModel, corners: Corners) -> npt.NDArray[np.uint8] | None:
    """Colours (m, 3, 3) where the file has any; white for vertices without."""
    if not model.colours:
        return None
    white = (1.0, 1.0, 1.0)
    return to_bytes([model.colours.get(i, white) for i in range(len(model.positions))])[corners.positions]


def material_colours(
    model: ObjModel, face_materials: Ints, materials: dict[str, Material]
) -> npt.NDArray[np.uint8] | None:
    """Colours per triangle (m, 3) when a material in use has one."""
    colours = [materials.get(name, Material()).colour for name in model.materials]
    used = {face.material for face in model.faces if face.material != NONE}
    if not any(colours[i] is not None for i in used):
        return None
    palette = to_bytes([colour or DEFAULT_COLOUR for colour in [*colours, None]])  # index NONE, -1, is the default
    return palette[face_materials]


def image_parts(
    model: ObjModel,
    face_materials: Ints,
    materials: dict[str, Material],
    picture_of: Callable[[str], Picture],
) -> tuple[tuple[Part, ...], Ints]:
    """A part per image, and one for triangles without any, as often as they differ in how they are drawn, in the order
    of the file; and the part of each triangle."""
    found = [materials.get(name, Material()) for name in model.materials] + [Material()]  # index NONE is the last
    looks = [(one.image, one.opacity, one.image is not None and (one.clamps, one.has_alpha)) for one in found]
    number_of: dict[object, int] = {}
    parts: list[Part] = []
    for i in dict.fromkeys(face_materials.tolist()):
        if looks[i] not in number_of:
            number_of[looks[i]] = len(parts)
            name = "" if i == NONE else model.materials[i]
            picture = None if found[i].image is None else picture_of(name)
            # What nobody could see is what exporters write that mean the opposite.
            parts.append(Part(name, picture, opacity=round(found[i].opacity * 255) or 255))
    part_of_material = np.array([number_of.get(look, 0) for look in looks], dtype=np.int64)
    return tuple(parts), part_of_material[face_materials]


def source_from(model: ObjModel, materials: dict[str, Material], picture_of: Callable[[str], Picture]) -> Source:
    """The model's triangles with all their attributes. `picture_of` tells the image of a material by its name."""
    vertices = np.array(model.positions, dtype=np.float64).reshape(-1, 3)
    corners = gather(model, vertices)
    face_materials = np.array([face.material for face in model.faces], dtype=np.int64)[corners.faces]
    parts, part_of = image_parts(model, face_materials, materials, picture_of)
    faces = corners.faces.tolist()
    return check_positions(
        Source(
            name=model.name,
            positions=vertices[corners.positions],
            parts=parts,
            part_of=part_of,
            where=lambda row: f"{model.name}:{model.faces[faces[row]].line}",
            normals=corner_normals(model, corners),
            uvs=corner_uvs(model, corners),
            colours=vertex_colours(model, corners),
            triangle_colours=material_colours(model, face_materials, materials),
        )
    )
