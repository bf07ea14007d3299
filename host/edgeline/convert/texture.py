"""Pictures as textures: any image that Pillow reads, resized to powers of two, in RGB565."""

from __future__ import annotations

import math
import warnings
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import Image, UnidentifiedImageError

from edgeline.convert.mesh import Texture
from edgeline.errors import EdgelineError


def rgb565(rgb: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint16]:
    """RGB565 (...) out of 8-bit colours (..., 3), each channel rounded to nearest."""
    red, green, blue = (rgb[..., i].astype(np.uint32) for i in range(3))
    r5, g6, b5 = (red * 31 + 127) // 255, (green * 63 + 127) // 255, (blue * 31 + 127) // 255
    return (r5 << 11 | g6 << 5 | b5).astype(np.uint16)


def power_of_two_near(side: int, limit: int) -> int:
    """The power of two nearest to `side` on a logarithmic scale, at most `limit` (a power of two)."""
    return min(1 << round(math.log2(side)), limit)


def load_texture(path: Path, limit: int) -> Texture:
    """The image at `path` with sides of at most `limit` texels. Raises EdgelineError when there is no image."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", Image.DecompressionBombWarning)
            with Image.open(path) as image:
                size = power_of_two_near(image.width, limit), power_of_two_near(image.height, limit)
                picture = image.convert("RGB")
        if picture.size != size:
            picture = picture.resize(size, Image.Resampling.LANCZOS)
    except UnidentifiedImageError:
        raise EdgelineError(f"{path} is no image that can be read; give a PNG or JPEG") from None
    except (Image.DecompressionBombError, Image.DecompressionBombWarning):
        raise EdgelineError(f"{path} is an image of unreasonable size; make it smaller") from None
    except OSError as error:
        raise EdgelineError(f"cannot read the image {path}: {error.strerror or error}; give another one") from error
    except (ValueError, SyntaxError, EOFError) as error:
        raise EdgelineError(f"{path} is a damaged image ({error}); give another one") from error
    return Texture(rgb565(np.asarray(picture)))
