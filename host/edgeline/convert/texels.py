"""Textures as the firmware holds them (`geometry/mesh.h`, `base/image.h`): formats, borders, smaller ones."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from enum import IntEnum

import numpy as np
import numpy.typing as npt

from edgeline.colour import to_rgb
from edgeline.errors import EdgelineError

MAX_TEXTURE_LOG2 = 10

Values = npt.NDArray[np.uint16]


class Format(IntEnum):
    """An `el_image_format`."""

    RGB565 = 0
    INDEX8 = 1
    INDEX4 = 2
    MASK = 3

    @property
    def bits(self) -> int:
        """Of a texel."""
        return (16, 8, 4, 1)[self]

    @property
    def colours(self) -> int:
        """In its palette."""
        return (0, 256, 16, 1)[self]

    @property
    def option(self) -> str:
        """As the command line has it."""
        return ("rgb565", "palette8", "palette4", "mask")[self]


class Wrap(IntEnum):
    """An `el_wrap`."""

    REPEAT = 0
    CLAMP = 1
    MIRROR = 2


@dataclass(frozen=True)
class Texture:
    """A picture of `texels`, shape (height, width), both powers of two up to 1024, or of any size; row 0 on top.

    Texels are colours in RGB565, or indices of `palette`, or a mask's bits. `key` is the value that is not drawn.
    """

    texels: Values
    format: Format = Format.RGB565
    palette: Values = field(default_factory=lambda: np.zeros(0, np.uint16))
    alpha: npt.NDArray[np.uint8] | None = None
    key: int | None = None
    wrap: tuple[Wrap, Wrap] = (Wrap.REPEAT, Wrap.REPEAT)
    smooth: bool = False
    any_size: bool = False
    """Drawn as a sprite, too: always an `el_image`, without smaller ones."""
    smaller: Texture | None = None
    """Half as large, of the same format, with the same palette, key, wrap and smoothness; alpha if this has alpha."""

    def __post_init__(self) -> None:
        if self.texels.dtype != np.uint16 or self.texels.ndim != 2:
            raise EdgelineError("a texture has to be a two-dimensional array of uint16")
        sides = {1 << log2 for log2 in range(MAX_TEXTURE_LOG2 + 1)}
        if not self.any_size and any(side not in sides for side in self.texels.shape):
            height, width = self.texels.shape
            raise EdgelineError(f"a texture of {width}x{height}: both sides have to be powers of two, 1024 at most")
        if self.palette.shape != (self.format.colours,) or int(self.texels.max()) >> self.format.bits != 0:
            raise EdgelineError(f"a texture's palette or texels are not those of {self.format.option}")
        if self.alpha is not None and self.alpha.shape != self.texels.shape:
            raise EdgelineError("a texture's alpha has another size than its texels")

    @property
    def width_log2(self) -> int:
        return int(self.texels.shape[1]).bit_length() - 1

    @property
    def height_log2(self) -> int:
        return int(self.texels.shape[0]).bit_length() - 1

    @property
    def is_image(self) -> bool:
        """Whether it takes an `el_image`, or else bare texels do."""
        return self.any_size or self.format != Format.RGB565 or self.alpha is not None or self.key is not None

    @property
    def is_plain(self) -> bool:
        """Whether the firmware's fastest loops draw it, and an .elm of version 1 holds it."""
        repeats = self.wrap == (Wrap.REPEAT, Wrap.REPEAT)
        return not self.is_image and repeats and not self.smooth and self.smaller is None

    def levels(self) -> Iterator[Texture]:
        """It, and the smaller ones."""
        level: Texture | None = self
        while level is not None:
            yield level
            level = level.smaller

    def packed(self) -> npt.NDArray[np.uint8] | Values:
        """The texels as `base/image.h` has them in memory: uint16, or bytes of which each row begins a new one."""
        if self.format == Format.RGB565:
            return self.texels.reshape(-1)
        if self.format == Format.INDEX8:
            return self.texels.reshape(-1).astype(np.uint8)
        if self.format == Format.MASK:
            return np.packbits(self.texels.astype(np.uint8), axis=1).reshape(-1)
        even = np.pad(self.texels, ((0, 0), (0, self.texels.shape[1] % 2))).astype(np.uint8)
        return np.asarray(even[:, 0::2] << 4 | even[:, 1::2]).reshape(-1)

    @property
    def parts_bytes(self) -> dict[str, int]:
        """Of the first level's texels, the smaller ones', the palette, and all alpha, where there are any."""
        levels = [*self.levels()]
        texels = [one.packed().nbytes for one in levels]
        found = {
            "texels": texels[0],
            "mipmaps": sum(texels[1:]),
            "palette": self.palette.nbytes,
            "alpha": sum(one.alpha.nbytes for one in levels if one.alpha is not None),
        }
        return {name: count for name, count in found.items() if count > 0}

    @property
    def flash_bytes(self) -> int:
        """Bytes of the arrays."""
        return sum(self.parts_bytes.values())

    def colours(self) -> npt.NDArray[np.uint8]:
        """What a display shows of each texel, 8 bits per channel, (height, width, 3)."""
        if self.format == Format.RGB565:
            return to_rgb(self.texels)
        return to_rgb(self.palette[np.zeros_like(self.texels) if self.format == Format.MASK else self.texels])

    def shown(self) -> npt.NDArray[np.bool_]:
        """Which texels are drawn."""
        if self.format == Format.MASK:
            return np.asarray(self.texels != 0)
        return np.ones(self.texels.shape, bool) if self.key is None else np.asarray(self.texels != self.key)


def linked(levels: Sequence[Texture]) -> Texture:
    """The first, which leads to all others."""
    whole = levels[-1]
    for level in levels[-2::-1]:
        whole = replace(level, smaller=whole)
    return whole
