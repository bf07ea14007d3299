"""Pictures as textures: any image that Pillow reads, resized to powers of two, in any format that the firmware draws.

Smaller levels are means of 2 x 2 texels in linear light, weighted by what they show.
"""

from __future__ import annotations

import io
import math
import warnings
from dataclasses import dataclass, replace
from enum import Enum
from pathlib import Path

import numpy as np
from PIL import Image, UnidentifiedImageError

from edgeline.convert.mesh import Floats, Ints
from edgeline.convert.palette import Bytes, all_of_rgb565, chosen_values, palette_of, rgb565, those_of
from edgeline.convert.texels import Format, Texture, Wrap, linked
from edgeline.errors import EdgelineError

Factor = tuple[float, float, float]
KEY = 0xF81F
"""The colour of RGB565 that stands for texels which are not drawn, and the nearest one, for those that had it."""
BESIDE_KEY = 0xF83F


class Alpha(Enum):
    """What an image's alpha means: nothing, texels that are drawn or not, or how much of each is seen."""

    NONE = "none"
    TEST = "test"
    BLEND = "blend"


@dataclass(frozen=True)
class Style:
    """How a picture is to become a texture. `levels`: at most, with the first; `cutoff`: the least alpha drawn."""

    format: Format = Format.RGB565
    dither: str = "none"
    levels: int = 1
    alpha: Alpha = Alpha.NONE
    cutoff: float = 0.5
    wrap: tuple[Wrap, Wrap] = (Wrap.REPEAT, Wrap.REPEAT)
    smooth: bool = False
    any_size: bool = False


@dataclass(frozen=True)
class Pixels:
    """8-bit sRGB colours (height, width, 3), both sides powers of two or as they were; alpha (height, width), if asked
    for, of an image that has any.

    `is_clear`: the image has transparent places, whether or not they were asked for.
    """

    rgb: Bytes
    alpha: Bytes | None = None
    is_clear: bool = False


def encoded(linear: Floats) -> Floats:
    """Linear light, 0 to 1, as sRGB has it (IEC 61966-2-1), 0 to 1; what is outside is taken to the nearer end."""
    light = np.clip(linear, 0.0, 1.0)
    return np.where(light <= 0.0031308, light * 12.92, 1.055 * light ** (1 / 2.4) - 0.055)


def decoded(colour: Floats) -> Floats:
    """The inverse of `encoded`."""
    return np.where(colour <= 0.04045, colour / 12.92, ((colour + 0.055) / 1.055) ** 2.4)


LIGHT_Q16 = np.rint(decoded(np.arange(256) / 255) * 65536).astype(np.int64)
"""Linear light of an 8-bit level; means are made of these whole numbers, so that all machines have the same."""
BETWEEN_Q16 = np.rint(decoded((np.arange(255) + 0.5) / 255) * 65536).astype(np.int64)
"""From which light on the next level is nearer."""


def power_of_two_near(side: int, limit: int) -> int:
    """The power of two nearest to `side` on a logarithmic scale, at most `limit` (a power of two)."""
    return min(1 << round(math.log2(side)), limit)


def multiplied(rgb: Bytes, factor: Factor) -> Bytes:
    """8-bit sRGB colours (..., 3) times a factor in linear light."""
    levels = decoded(np.arange(256) / 255)[:, None] * np.asarray(factor)
    table = np.rint(encoded(levels) * 255).astype(np.uint8)
    return np.stack([table[rgb[..., i], i] for i in range(3)], axis=-1)


def _has_clear_places(image: Image.Image) -> bool:
    if "A" not in image.getbands() and "a" not in image.getbands() and "transparency" not in image.info:
        return False
    least = image.convert("RGBA").getchannel("A").getextrema()[0]
    return isinstance(least, int) and least < 255


def load_pixels(
    image_file: Path | bytes, limit: int | None, factor: Factor = (1.0, 1.0, 1.0), with_alpha: bool = False
) -> Pixels:
    """The image with sides of at most `limit` texels; None: as it is. Raises EdgelineError when there is no image."""
    name = str(image_file) if isinstance(image_file, Path) else "what is embedded"
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", Image.DecompressionBombWarning)
            with Image.open(image_file if isinstance(image_file, Path) else io.BytesIO(image_file)) as image:
                size = image.size
                if limit is not None:
                    size = power_of_two_near(image.width, limit), power_of_two_near(image.height, limit)
                clear = _has_clear_places(image)
                picture = image.convert("RGBA" if with_alpha else "RGB")
        if picture.size != size:
            picture = picture.resize(size, Image.Resampling.LANCZOS)
    except UnidentifiedImageError:
        raise EdgelineError(f"{name} is no image that can be read; give a PNG or JPEG") from None
    except (Image.DecompressionBombError, Image.DecompressionBombWarning):
        raise EdgelineError(f"{name} is an image of unreasonable size; make it smaller") from None
    except OSError as error:
        raise EdgelineError(f"cannot read the image {name}: {error.strerror or error}; give another one") from error
    except (ValueError, SyntaxError, EOFError) as error:
        raise EdgelineError(f"{name} is a damaged image ({error}); give another one") from error
    array = np.asarray(picture)
    rgb = array[..., :3]
    rgb = rgb if factor == (1.0, 1.0, 1.0) else multiplied(rgb, factor)
    return Pixels(rgb, array[..., 3] if with_alpha and clear else None, clear)


def _boxes(array: Ints) -> Ints:
    """Sums of 2 x 2 (height, width, ...), or of two along a side that has more than one."""
    height, width = array.shape[:2]
    down, across = min(2, height), min(2, width)
    return np.asarray(array.reshape(height // down, down, width // across, across, -1).sum(axis=(1, 3)))


def halved(pixels: Pixels) -> Pixels:
    """The picture at half the size."""
    light = LIGHT_Q16[pixels.rgb]
    ones = np.full(pixels.rgb.shape[:2], 255, np.int64)
    weight = ones if pixels.alpha is None else pixels.alpha.astype(np.int64)
    weight = weight[..., None]
    total, most = _boxes(weight), _boxes(ones)
    mean = np.where(total > 0, _boxes(light * weight) // np.maximum(total, 1), _boxes(light) * 255 // most)
    rgb = np.searchsorted(BETWEEN_Q16, mean, side="right").astype(np.uint8)
    if pixels.alpha is None:
        return Pixels(rgb)
    alpha = (2 * 255 * total + most) // (2 * most)
    return Pixels(rgb, alpha[..., 0].astype(np.uint8))


def chain(pixels: Pixels, levels: int) -> list[Pixels]:
    """The picture and smaller ones, to a single texel or `levels` of them."""
    found = [pixels]
    while len(found) < levels and max(found[-1].rgb.shape[:2]) > 1:
        found.append(halved(found[-1]))
    return found


def _mask(pictures: list[Pixels], style: Style) -> Texture:
    """Where an image has alpha that shows; else what is brighter than the cutoff. In the mean colour of what shows."""
    least = max(1, math.ceil(style.cutoff * 255))
    both = those_of(np.array([0x0000, 0xFFFF], np.uint16))
    values = []
    for one in pictures:
        level = one.alpha if one.alpha is not None else (one.rgb.astype(np.int64) @ [299, 587, 114] + 500) // 1000
        moved = np.clip(level.astype(np.int64) + 128 - least, 0, 255)  # so that the cutoff lies in the middle
        grey = np.repeat(moved[..., None], 3, axis=2).astype(np.uint8)
        everywhere = np.ones(grey.shape[:2], bool)
        values.append(chosen_values(grey, both, style.dither, everywhere).astype(np.uint16))
    shown = pictures[0].rgb[values[0] != 0]
    if len(shown) == 0:
        raise EdgelineError("nothing of the image shows as a mask; give it alpha or bright places")
    mean = np.searchsorted(BETWEEN_Q16, LIGHT_Q16[shown].sum(axis=0) // len(shown), side="right")
    ink = rgb565(mean[None].astype(np.uint8))
    plain = Texture(values[0], Format.MASK, ink, wrap=style.wrap, smooth=style.smooth, any_size=style.any_size)
    return linked([replace(plain, texels=v) for v in values])


def textured(pixels: Pixels, style: Style) -> Texture:
    """The texture that `style` asks for; no key or alpha where all texels are drawn whole. Raises EdgelineError."""
    pictures = chain(pixels, style.levels)
    if style.format == Format.MASK:
        return _mask(pictures, style)
    least = max(1, math.ceil(style.cutoff * 255))
    shown = [
        np.ones(one.rgb.shape[:2], bool) if one.alpha is None or style.alpha != Alpha.TEST else one.alpha >= least
        for one in pictures
    ]
    if not shown[0].any():
        raise EdgelineError("all of the image is transparent; give another one, or --alpha none")
    has_key = not all(one.all() for one in shown)
    blended = style.alpha == Alpha.BLEND and pixels.alpha is not None and bool((pixels.alpha < 255).any())
    palette = np.zeros(style.format.colours, np.uint16)
    if style.format == Format.RGB565:
        colours, key = all_of_rgb565(), KEY
    else:
        table = palette_of(pixels.rgb[shown[0]], style.format.colours - has_key)
        colours, key = those_of(table), style.format.colours - 1
        palette[: len(table)] = table
    levels = []
    for one, drawn in zip(pictures, shown, strict=True):
        values = chosen_values(one.rgb, colours, style.dither, drawn).astype(np.uint16)
        if has_key and style.format == Format.RGB565:
            values[values == KEY] = BESIDE_KEY
        if has_key:
            values[~drawn] = key
        alpha = one.alpha if blended else None
        own_key = key if has_key else None
        levels.append(
            Texture(values, style.format, palette, alpha, own_key, style.wrap, style.smooth, any_size=style.any_size)
        )
    return linked(levels)


@dataclass(frozen=True)
class ColourError:
    """Between an image's colours and those that a texture shows, in levels of 255: of `texels` that are drawn."""

    rms: float
    largest: int
    texels: int


def colour_error(pixels: Pixels, texture: Texture) -> ColourError:
    """Of the first level; a mask's is that of its one colour."""
    shown = texture.shown()
    apart = np.abs(texture.colours().astype(np.int64) - pixels.rgb)[shown]
    return ColourError(float(np.sqrt((apart * apart).mean())), int(apart.max()), int(shown.sum()))
