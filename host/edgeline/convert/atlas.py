"""Several pictures in one: parts that look alike but for their images become one part, with one texture.

Each image lies in the atlas with a border of its outermost texels around it, wide enough that neighbours do not show in
its smaller levels. What an atlas cannot do is repeat: a triangle across an image's edge is refused, with its place.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from edgeline.convert.mesh import Floats
from edgeline.convert.source import Part, Source
from edgeline.convert.texels import MAX_TEXTURE_LOG2
from edgeline.convert.texture import Pixels
from edgeline.errors import EdgelineError

BORDER = 2
"""Texels around an image: what bilinear sampling and rounding may reach."""
BORDER_WITH_LEVELS = 8
LEVELS = 4
"""So many levels of an atlas: at the last one that border is one texel wide."""
BEYOND = 1 / 256
"""By which a coordinate may lie outside of its image, in images: what exporters round."""


@dataclass(frozen=True)
class Place:
    """Where an image begins, in texels."""

    x: int
    y: int


def _shelves(sizes: Sequence[tuple[int, int]], width: int, height: int) -> list[Place] | None:
    """Rows of rectangles (width, height), the highest first; None where they do not fit."""
    places: dict[int, Place] = {}
    x = y = shelf = 0
    for i in sorted(range(len(sizes)), key=lambda i: (-sizes[i][1], -sizes[i][0], i)):
        across, down = sizes[i]
        if x + across > width:
            x, y, shelf = 0, y + shelf, 0
        if x + across > width or y + down > height:
            return None
        places[i] = Place(x, y)
        x, shelf = x + across, max(shelf, down)
    return [places[i] for i in range(len(sizes))]


def arranged(sizes: Sequence[tuple[int, int]]) -> tuple[int, int, list[Place]]:
    """The smallest texture that holds rectangles (width, height), and where they lie. Raises EdgelineError."""
    sides = [1 << log2 for log2 in range(MAX_TEXTURE_LOG2 + 1)]
    for width, height in sorted(((w, h) for w in sides for h in sides), key=lambda s: (s[0] * s[1], abs(s[0] - s[1]))):
        places = _shelves(sizes, width, height)
        if places is not None:
            return width, height, places
    raise EdgelineError(
        f"--atlas: the {len(sizes)} images of the model do not fit {sides[-1]}x{sides[-1]} texels; give a smaller "
        "--texture-size"
    )


def _within_an_image(source: Source, rows: npt.NDArray[np.bool_]) -> Floats:
    """Coordinates of these triangles as 0 to 1, each moved by whole repetitions. Raises EdgelineError."""
    uvs = np.full((int(rows.sum()), 3, 2), np.nan) if source.uvs is None else source.uvs[rows]
    moved = uvs - np.floor(uvs.min(axis=1, keepdims=True) + BEYOND)
    bad = np.any((moved < -BEYOND) | (moved > 1 + BEYOND), axis=(1, 2))
    if bad.any():
        row = int(np.flatnonzero(rows)[int(np.argmax(bad))])
        (u, v), (u_end, v_end) = uvs[bad][0].min(axis=0), uvs[bad][0].max(axis=0)
        raise EdgelineError(
            f"{source.where(row)}: u {u:g} to {u_end:g}, v {1 - v_end:g} to {1 - v:g}: its image repeats, which in an "
            "atlas it cannot; cut the triangle at the image's edges where it was made, or leave out --atlas"
        )
    return np.asarray(np.clip(moved, 0.0, 1.0))


def _groups(source: Source) -> list[list[int]]:
    """Numbers of parts that can share a texture, those of each part without an image alone; in order."""
    groups: dict[object, list[int]] = {}
    for i, part in enumerate(source.parts):
        picture = part.picture
        alike: object = i
        if picture is not None:
            alike = part.two_sided, part.opacity, picture.alpha, picture.cutoff, picture.smooth
        groups.setdefault(alike, []).append(i)
    return list(groups.values())


def with_atlases(source: Source, pixels: list[Pixels | None], levels: int) -> tuple[Source, list[Pixels | None]]:
    """`source` with as few parts as can be, and the picture of each. Raises EdgelineError for images that repeat."""
    groups = _groups(source)
    uvs = None if source.uvs is None else source.uvs.copy()
    border = BORDER if levels == 1 else BORDER_WITH_LEVELS
    parts: list[Part] = []
    pictures: list[Pixels | None] = []
    part_of = np.zeros_like(source.part_of)
    for number, members in enumerate(groups):
        images = [pixels[i] for i in members]
        for i in members:
            part_of[source.part_of == i] = number
        parts.append(source.parts[members[0]])
        if len(members) == 1 or uvs is None:
            pictures.append(images[0])
            continue
        found = [one for one in images if one is not None]
        # Multiples of the border, so that no texel of a smaller level is of two images.
        sizes = [[(-(-side // border) + 2) * border for side in one.rgb.shape[1::-1]] for one in found]
        width, height, places = arranged([(across, down) for across, down in sizes])
        pictures.append(_painted(found, places, width, height, border))
        parts[-1] = replace(parts[-1], name="atlas", is_atlas=True)
        for i, one, place in zip(members, found, places, strict=True):
            rows = source.part_of == i
            begin = np.array([place.x + border, place.y + border])
            size = np.array([one.rgb.shape[1], one.rgb.shape[0]])
            uvs[rows] = (begin + _within_an_image(source, rows) * size) / (width, height)
    return replace(source, parts=tuple(parts), part_of=part_of, uvs=uvs), pictures


def _painted(images: Sequence[Pixels], places: Sequence[Place], width: int, height: int, border: int) -> Pixels:
    """All images at their places, with their borders; what is between is black, and clear where there is alpha."""
    has_alpha = any(one.alpha is not None for one in images)
    rgb = np.zeros((height, width, 3), np.uint8)
    alpha = np.zeros((height, width), np.uint8)
    around = ((border, border), (border, border))
    for one, place in zip(images, places, strict=True):
        down, across = (side + 2 * border for side in one.rgb.shape[:2])
        here = np.s_[place.y : place.y + down, place.x : place.x + across]
        rgb[here] = np.pad(one.rgb, (*around, (0, 0)), mode="edge")
        alpha[here] = 255 if one.alpha is None else np.pad(one.alpha, around, mode="edge")
    return Pixels(rgb, alpha if has_alpha else None, any(one.is_clear for one in images))
