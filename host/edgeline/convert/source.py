"""What every reader makes of its file: triangles, each corner for itself, with what the file says of them.

Conventions end here: counter-clockwise is the front, v of a texture coordinate points down, colours are as displays
take them. What follows (placing, simplifying, texels, quantising) knows no file format.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import numpy.typing as npt

from edgeline.convert.mesh import TEXEL_ONE, Floats, Ints, Soup
from edgeline.convert.normals import smooth_normals, unit
from edgeline.convert.texels import Texture, Wrap
from edgeline.convert.texture import Alpha, Pixels, Style, load_pixels
from edgeline.errors import EdgelineError

NO_GLOW = "its glow is left out; el_lighting.emissive makes surfaces glow"
UV_LIMIT = 32767
UV_ERROR = 1 / 8
"""Texels, el_config.uv_error_log2's default."""
MOST_TRIANGLES = 4_000_000
"""Of a file. What is above the firmware's own limit has to be simplified."""


@dataclass(frozen=True)
class Picture:
    """An image that a model names, not opened yet, and how the model wants it drawn. `where` is the place that names
    it, for messages; empty when that was the command line."""

    where: str
    image: Path | bytes
    factor: tuple[float, float, float] = (1.0, 1.0, 1.0)
    """By which its colours are to be multiplied, in linear light."""
    wrap: tuple[Wrap, Wrap] = (Wrap.REPEAT, Wrap.REPEAT)
    smooth: bool = False
    alpha: Alpha = Alpha.NONE
    cutoff: float = 0.5

    def load(self, limit: int, with_alpha: bool) -> Pixels:
        """Raises EdgelineError."""
        try:
            return load_pixels(self.image, limit, self.factor, with_alpha)
        except EdgelineError as error:
            if not self.where:
                raise
            raise EdgelineError(f"{self.where}: {error}, by --texture, or give --no-texture") from error


@dataclass(frozen=True)
class Part:
    """Triangles that share a material; they become a mesh of their own where there are several. `opacity` is of 255."""

    name: str
    picture: Picture | None = None
    two_sided: bool = False
    opacity: int = 255
    is_atlas: bool = False


@dataclass(frozen=True)
class Source:
    """m triangles. Rows of `normals` without length, and of `uvs` that are NaN, stand for none."""

    name: str  # the file's, for messages
    positions: Floats  # (m, 3 corners, 3)
    parts: tuple[Part, ...]
    part_of: Ints  # (m,)
    where: Callable[[int], str] = field(repr=False)  # place of a triangle in the file, for messages
    normals: Floats | None = None  # (m, 3 corners, 3), of any length
    uvs: Floats | None = None  # (m, 3 corners, 2) in repetitions of the image, v down
    colours: npt.NDArray[np.uint8] | None = None  # (m, 3 corners, 3)
    tints: bool = False  # the format says that a picture is multiplied by `colours`; else it stands in their place
    triangle_colours: npt.NDArray[np.uint8] | None = None  # (m, 3)
    notes: tuple[str, ...] = ()

    def chosen(self, rows: Ints | npt.NDArray[np.bool_]) -> Source:
        """Only these triangles."""
        places = np.arange(len(self.positions))[rows].tolist()
        return replace(
            self,
            positions=self.positions[rows],
            part_of=self.part_of[rows],
            where=lambda row: self.where(places[row]),
            normals=None if self.normals is None else self.normals[rows],
            uvs=None if self.uvs is None else self.uvs[rows],
            colours=None if self.colours is None else self.colours[rows],
            triangle_colours=None if self.triangle_colours is None else self.triangle_colours[rows],
        )

    def in_one(self, picture: Picture | None) -> Source:
        """All triangles in one part, which is opaque; two-sided where one of them is."""
        part = Part(self.parts[0].name, picture, any(part.two_sided for part in self.parts))
        return replace(self, parts=(part,), part_of=np.zeros(len(self.positions), dtype=np.int64))


def check_positions(source: Source) -> Source:
    """`source`, all of whose positions are finite numbers that 32-bit floats can hold. Raises EdgelineError."""
    if len(source.positions) == 0:
        raise EdgelineError(f"{source.name}: no triangle in this file; is it a mesh of polygons?")
    bad = ~np.all(np.abs(source.positions) < 1e30, axis=(1, 2))
    if bad.any():
        row = int(np.argmax(bad))
        raise EdgelineError(f"{source.where(row)}: a position is no finite number; repair the model")
    return source


def check_count(name: str, count: int) -> None:
    """Raises EdgelineError for more triangles than there can be work for."""
    if count > MOST_TRIANGLES:
        raise EdgelineError(
            f"{name}: {count} triangles, {MOST_TRIANGLES} at most are read; reduce it where it was made"
        )


def placed(source: Source, up: str, scale: float, centre: bool) -> Source:
    """`source` with its axis `up` ("y" or "z") turned to y, then its box' middle at the origin, then scaled."""
    positions, normals = source.positions, source.normals
    if up == "z":
        turned = [0, 2, 1]
        signs = np.array([1.0, 1.0, -1.0])
        positions = positions[..., turned] * signs
        normals = None if normals is None else normals[..., turned] * signs
    if centre:
        positions = positions - (positions.min(axis=(0, 1)) + positions.max(axis=(0, 1))) / 2
    return replace(source, positions=positions * scale, normals=normals)


def with_normals(source: Source, crease_degrees: float) -> Source:
    """`source` with unit normals everywhere: the file's, and smooth ones where it has none or one without length."""
    computed = smooth_normals(source.positions, crease_degrees)
    if source.normals is None:
        return replace(source, normals=computed)
    usable = np.any(source.normals != 0, axis=2)
    return replace(source, normals=np.where(usable[:, :, None], unit(source.normals), computed))


def texel_coordinates(source: Source, texture: Texture) -> Floats:
    """Texture coordinates (m, 3, 2) in texels. Raises EdgelineError where one is missing or out of range.

    Where a texture repeats, all coordinates are moved by whole repetitions together when they would not fit otherwise.
    """
    shape = (*source.positions.shape[:2], 2)
    uvs = np.full(shape, np.nan) if source.uvs is None else source.uvs
    missing = np.any(np.isnan(uvs), axis=(1, 2))
    if missing.any():
        text = (
            "a corner without texture coordinates (vt in OBJ, TEXCOORD in glTF); unwrap the model, or give --no-texture"
        )
        raise EdgelineError(f"{source.where(int(np.argmax(missing)))}: {text}")
    height, width = texture.texels.shape
    sides = np.array([width, height], dtype=np.float64)
    texels = uvs * sides
    limit = UV_LIMIT / TEXEL_ONE
    if np.abs(texels).max() > limit:
        middle = (texels.min(axis=(0, 1)) + texels.max(axis=(0, 1))) / 2
        periods = sides * [{Wrap.REPEAT: 1, Wrap.MIRROR: 2, Wrap.CLAMP: np.inf}[wrap] for wrap in texture.wrap]
        moved = np.rint(middle / periods)
        texels = texels - np.where(moved == 0, 0.0, moved * periods)
    outside = np.any(np.abs(texels) > limit, axis=2)
    if outside.any():
        row, corner = np.unravel_index(int(np.argmax(outside)), outside.shape)
        u, v = uvs[row, corner]
        text = (
            f"corner {corner + 1} has texture coordinate {u:g} {1.0 - v:g}, more than {limit:g} texels "
            f"of a {width}x{height} texture; repeat it less often, or give a smaller --texture-size"
        )
        raise EdgelineError(f"{source.where(int(row))}: {text}")
    return np.asarray(texels)


def fitted_wrap(source: Source, style: Style, sides: tuple[int, int]) -> tuple[Source, tuple[Wrap, Wrap]]:
    """`source`, and how its picture of `sides` (width, height) goes on beyond its borders.

    A texture that repeats is drawn fastest. So where all coordinates of an axis lie within the image, and no texels are
    mixed, it repeats whatever the model says, and the coordinates keep so far from the borders that this never shows:
    half a texel with smaller levels, else what the renderer may be wrong by.
    """
    wrap = list(style.wrap)
    if source.uvs is None or style.smooth:
        return source, style.wrap
    uvs = source.uvs.copy()
    for axis, side in enumerate(sides):
        inset = (0.5 if style.levels > 1 else UV_ERROR) / side
        found = uvs[..., axis]
        if wrap[axis] != Wrap.REPEAT and np.all((found >= -1e-6) & (found <= 1 + 1e-6)):
            wrap[axis] = Wrap.REPEAT
            uvs[..., axis] = np.clip(found, inset, 1.0 - inset)
    return replace(source, uvs=uvs), (wrap[0], wrap[1])


def soup_of(source: Source, texture: Texture | None) -> Soup:
    """The triangles of a source with one part. Raises EdgelineError for what cannot be met.

    Texture coordinates are kept when there is a texture, colours of triangles when there is none; colours of vertices,
    which texels are multiplied by, when one of them is not white.
    """
    is_white = texture is not None and source.colours is not None and bool(np.all(source.colours == 255))
    return Soup(
        positions=source.positions,
        normals=source.normals,
        uvs=None if texture is None else texel_coordinates(source, texture),
        colours=None if is_white else source.colours,
        triangle_colours=source.triangle_colours if texture is None else None,
    )


def as_floats(array: npt.NDArray[np.generic]) -> Floats:
    """The numbers in 64 bits; a NaN of any kind stays one, without a warning."""
    with np.errstate(invalid="ignore"):
        return np.asarray(array.astype(np.float64))


def to_bytes(colours: Sequence[Sequence[float]] | Floats) -> npt.NDArray[np.uint8]:
    """Colours of 0 to 1 as bytes, rounded to nearest."""
    return np.rint(np.asarray(colours, dtype=np.float64) * 255).astype(np.uint8)
