"""From what an OBJ file says to a soup of triangles: polygons cut up, attributes gathered, all of it checked.

This is where an OBJ's conventions end: v of a texture coordinate turns from up to down, fractions become texels.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from edgeline.convert.mesh import MAX_TRIANGLES, TEXEL_ONE, Floats, Ints, Soup, Texture, check_triangle_count
from edgeline.convert.normals import smooth_normals, unit
from edgeline.convert.obj import NONE, Face, Material, ObjModel
from edgeline.convert.triangulate import triangulate

DEFAULT_COLOUR = 0.8, 0.8, 0.8
"""Of faces without a material in a model with materials; it is Wavefront's default too."""
UV_LIMIT = 32767


@dataclass(frozen=True)
class Corners:
    """The corners of all triangles, as indices into the lists of the model, (m, 3) each, and the face of each, (m,)."""

    positions: Ints
    uvs: Ints
    normals: Ints
    faces: Ints


def gather(model: ObjModel, positions: Floats) -> Corners:
    """Triangles out of the model's faces; `positions` are its vertices as they will be stored, (n, 3)."""
    # Some triangles may have no area and be dropped later; twice too many are too many before any work is done on them.
    count = sum(len(face.positions) - 2 for face in model.faces)
    if count > 2 * MAX_TRIANGLES:
        check_triangle_count(count)
    rows: list[tuple[int, ...]] = []
    for number, face in enumerate(model.faces):
        for triangle in triangulate(positions[list(face.positions)]):
            row = [column[i] for column in (face.positions, face.uvs, face.normals) for i in triangle]
            rows.append((*row, number))
    table = np.array(rows, dtype=np.int64)
    return Corners(table[:, 0:3], table[:, 3:6], table[:, 6:9], table[:, 9])


def placed(model: ObjModel, scale: float, centre: bool) -> Floats:
    """The vertices (n, 3) times `scale`, with the middle of their bounding box at the origin when `centre`."""
    positions = np.array(model.positions, dtype=np.float64)
    if centre:
        positions = positions - (positions.min(axis=0) + positions.max(axis=0)) / 2
    return np.asarray(positions * scale)


def corner_normals(model: ObjModel, corners: Corners, positions: Floats, crease_degrees: float) -> Floats:
    """Unit normals (m, 3, 3): the file's, and smooth ones where it has none or one without length."""
    computed = smooth_normals(positions, crease_degrees)
    if not model.normals:
        return computed
    given = np.array(model.normals, dtype=np.float64)[corners.normals]
    usable = (corners.normals != NONE) & np.any(given != 0, axis=2)
    return np.where(usable[:, :, None], unit(given), computed)


def texel_coordinates(model: ObjModel, corners: Corners, texture: Texture) -> Floats:
    """Texture coordinates (m, 3, 2) in texels, v down. Raises EdgelineError where one is missing or out of range.

    As a texture repeats, all coordinates are moved by whole repetitions together when they would not fit otherwise.
    """
    missing = np.any(corners.uvs == NONE, axis=1)
    if missing.any():
        line = model.faces[corners.faces[np.argmax(missing)]].line
        text = "a corner without a texture coordinate (v/vt); unwrap the model, or give --no-texture"
        raise model.error(line, text)
    height, width = texture.texels.shape
    texels = np.array(model.uvs, dtype=np.float64)[corners.uvs]
    texels = np.stack([texels[..., 0] * width, (1.0 - texels[..., 1]) * height], axis=2)
    limit = UV_LIMIT / TEXEL_ONE
    if np.abs(texels).max() > limit:
        period = np.array([width, height], dtype=np.float64)
        middle = (texels.min(axis=(0, 1)) + texels.max(axis=(0, 1))) / 2
        texels = texels - np.rint(middle / period) * period
    outside = np.any(np.abs(texels) > limit, axis=2)
    if outside.any():
        row, corner = np.unravel_index(int(np.argmax(outside)), outside.shape)
        face = model.faces[corners.faces[row]]
        u, v = model.uvs[corners.uvs[row, corner]]
        vertex = corners.positions[row, corner] + 1
        text = (
            f"vertex {vertex} has texture coordinate {u:g} {v:g}, more than {limit:g} texels "
            f"of a {width}x{height} texture; repeat it less often, or give a smaller --texture-size"
        )
        raise model.error(face.line, text)
    return texels


def to_bytes(colours: Sequence[tuple[float, float, float]]) -> npt.NDArray[np.uint8]:
    """Colours of 0 to 1 as bytes, rounded to nearest."""
    return np.rint(np.array(colours, dtype=np.float64) * 255).astype(np.uint8)


def vertex_colours(model: ObjModel, corners: Corners) -> npt.NDArray[np.uint8] | None:
    """Colours (m, 3, 3) where the file has any; white for vertices without."""
    if not model.colours:
        return None
    white = (1.0, 1.0, 1.0)
    return to_bytes([model.colours.get(i, white) for i in range(len(model.positions))])[corners.positions]


def material_colours(model: ObjModel, corners: Corners, materials: dict[str, Material]) -> npt.NDArray[np.uint8] | None:
    """Colours per triangle (m, 3) when a material in use has one."""
    colours = [materials.get(name, Material()).colour for name in model.materials]
    used = {face.material for face in model.faces if face.material != NONE}
    if not any(colours[i] is not None for i in used):
        return None
    palette = to_bytes([colour or DEFAULT_COLOUR for colour in [*colours, None]])  # index NONE, -1, is the default
    of_face = np.array([face.material for face in model.faces], dtype=np.int64)
    return palette[of_face[corners.faces]]


def textured_face(model: ObjModel, materials: dict[str, Material]) -> dict[str, Face]:
    """For each image that materials in use name, the first face that has it."""
    images: dict[str, Face] = {}
    for face in model.faces:
        if face.material != NONE:
            image = materials.get(model.materials[face.material], Material()).image
            if image is not None:
                images.setdefault(image, face)
    return images


def soup_from(
    model: ObjModel,
    materials: dict[str, Material],
    texture: Texture | None,
    *,
    crease_degrees: float = 60.0,
    with_normals: bool = True,
    scale: float = 1.0,
    centre: bool = False,
) -> Soup:
    """The model's triangles with all their attributes. Raises EdgelineError with file and line for what cannot be met.

    Texture coordinates are kept when there is a texture, colours of materials when there is none.
    """
    vertices = placed(model, scale, centre)
    corners = gather(model, vertices)
    positions = vertices[corners.positions]
    return Soup(
        positions=positions,
        normals=corner_normals(model, corners, positions, crease_degrees) if with_normals else None,
        uvs=None if texture is None else texel_coordinates(model, corners, texture),
        colours=vertex_colours(model, corners),
        triangle_colours=material_colours(model, corners, materials) if texture is None else None,
    )
