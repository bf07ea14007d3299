"""Pictures as textures: any image that Pillow reads, resized to powers of two, in RGB565."""

from __future__ import annotations

import io
import math
import warnings
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import Image, UnidentifiedImageError

from edgeline.convert.mesh import Floats, Texture
from edgeline.errors import EdgelineError

Factor = tuple[float, float, float]


def rgb565(rgb: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint16]:
    """RGB565 (...) out of 8-bit colours (..., 3), each channel rounded to nearest."""
    red, green, blue = (rgb[..., i].astype(np.uint32) for i in range(3))
    r5, g6, b5 = (red * 31 + 127) // 255, (green * 63 + 127) // 255, (blue * 31 + 127) // 255
    return (r5 << 11 | g6 << 5 | b5).astype(np.uint16)


def encoded(linear: Floats) -> Floats:
    """Linear light, 0 to 1, as sRGB has it (IEC 61966-2-1), 0 to 1; what is outside is taken to the nearer end."""
    light = np.clip(linear, 0.0, 1.0)
    return np.where(light <= 0.0031308, light * 12.92, 1.055 * light ** (1 / 2.4) - 0.055)


def decoded(colour: Floats) -> Floats:
    """The inverse of `encoded`."""
    return np.where(colour <= 0.04045, colour / 12.92, ((colour + 0.055) / 1.055) ** 2.4)


def power_of_two_near(side: int, limit: int) -> int:
    """The power of two nearest to `side` on a logarithmic scale, at most `limit` (a power of two)."""
    return min(1 << round(math.log2(side)), limit)


def multiplied(rgb: npt.NDArray[np.uint8], factor: Factor) -> npt.NDArray[np.uint8]:
    """8-bit sRGB colours (..., 3) times a factor in linear light."""
    levels = decoded(np.arange(256) / 255)[:, None] * np.asarray(factor)
    table = np.rint(encoded(levels) * 255).astype(np.uint8)
    return np.stack([table[rgb[..., i], i] for i in range(3)], axis=-1)


def load_texture(image_file: Path | bytes, limit: int, factor: Factor = (1.0, 1.0, 1.0)) -> Texture:
    """The image with sides of at most `limit` texels. Raises EdgelineError when there is no image."""
    name = str(image_file) if isinstance(image_file, Path) else "what is embedded"
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", Image.DecompressionBombWarning)
            with Image.open(image_file if isinstance(image_file, Path) else io.BytesIO(image_file)) as image:
                size = power_of_two_near(image.width, limit), power_of_two_near(image.height, limit)
                picture = image.convert("RGB")
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
    texels = np.asarray(picture)
    return Texture(rgb565(texels if factor == (1.0, 1.0, 1.0) else multiplied(texels, factor)))
