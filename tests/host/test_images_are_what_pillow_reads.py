"""`edgeline image` writes each pixel of a picture, in every format, the same each time; what is no picture gets one
clear line and leaves no file.
"""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from PIL import Image

from edgeline.cli import main
from edgeline.convert.image_command import MAX_SIDE
from edgeline.convert.palette import rgb565

WIDTH, HEIGHT = 13, 6  # neither whole bytes of masks nor whole pairs of pixels
PAINTS = np.array([(250, 20, 0), (0, 200, 30), (10, 0, 255), (255, 255, 255), (0, 0, 0)], np.uint8)
Pixels = npt.NDArray[np.uint8]


def picture(seed: int, alphas: tuple[int, ...] = (255,)) -> Pixels:
    """(height, width, 4), of few colours."""
    random = np.random.default_rng(seed)
    rgb = PAINTS[random.integers(0, len(PAINTS), (HEIGHT, WIDTH))]
    alpha = random.choice(np.array(alphas, np.uint8), (HEIGHT, WIDTH))
    alpha[0, : len(alphas)] = alphas
    return np.concatenate([rgb, alpha[..., None]], axis=2)


def saved(folder: Path, pixels: Pixels) -> Path:
    Image.fromarray(pixels).save(folder / "ship.png")
    return folder / "ship.png"


def numbers(text: str, name: str) -> npt.NDArray[np.int64]:
    found = re.search(rf"ship_{name}\[\d+\] = \{{(.*?)\n\}};", text, re.DOTALL)
    return np.array([int(word, 16) for word in re.findall(r"0x[0-9a-f]+", found[1])] if found else [], np.int64)


def member(text: str, name: str) -> str | None:
    found = re.search(rf"\.{name} = (\w+),", text)
    return found[1] if found else None


def values(text: str) -> npt.NDArray[np.int64]:
    """The header's pixels, (height, width), as base/image.h lays them out."""
    texels = numbers(text, "texels")
    bits = {"EL_IMAGE_RGB565": 16, "EL_IMAGE_INDEX8": 8, "EL_IMAGE_INDEX4": 4, "EL_IMAGE_MASK": 1}
    each = bits[str(member(text, "format"))]
    if each >= 8:
        return texels.reshape(HEIGHT, WIDTH)
    places = np.unpackbits(texels.astype(np.uint8)).reshape(HEIGHT, -1, each)
    return np.asarray((places @ (1 << np.arange(each - 1, -1, -1)))[:, :WIDTH].astype(np.int64))


@pytest.mark.parametrize("chosen", ["rgb565", "palette8", "palette4"])
@pytest.mark.parametrize("alphas", [(255,), (255, 0), (255, 0, 90)], ids=["opaque", "key", "blend"])
def test_every_pixel_is_there(tmp_path: Path, chosen: str, alphas: tuple[int, ...]) -> None:
    pixels = picture(len(alphas), alphas)
    header = tmp_path / "ship.h"
    assert main(["image", str(saved(tmp_path, pixels)), "--format", chosen, "-o", str(header)]) == 0
    text = header.read_text(encoding="ascii")
    assert (member(text, "width"), member(text, "height")) == (str(WIDTH), str(HEIGHT))
    found, palette = values(text), numbers(text, "palette")
    colours = found if chosen == "rgb565" else palette[found]
    shown = np.ones((HEIGHT, WIDTH), bool) if len(alphas) != 2 else pixels[..., 3] > 0
    assert np.array_equal(colours[shown], rgb565(pixels[..., :3])[shown])
    key = member(text, "key")
    assert (key is not None) == (len(alphas) == 2)
    if key is not None:
        assert np.array_equal(found != int(key), shown)
    alpha = numbers(text, "alpha")
    assert np.array_equal(alpha, pixels[..., 3].reshape(-1) if len(alphas) == 3 else alpha[:0])


def test_masks_have_the_image_s_shape(tmp_path: Path) -> None:
    pixels = picture(7, (255, 0))
    pixels[..., :3] = 255, 0, 0
    header = tmp_path / "ship.h"
    assert main(["image", str(saved(tmp_path, pixels)), "--format", "mask", "-o", str(header)]) == 0
    text = header.read_text(encoding="ascii")
    assert np.array_equal(values(text) != 0, pixels[..., 3] > 0)
    assert numbers(text, "palette").tolist() == [0xF800]


def test_alpha_as_asked_and_the_same_each_time(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    image, header = saved(tmp_path, picture(3, (255, 0, 90))), tmp_path / "ship.h"
    texts = []
    for words in (["--alpha", "none"], ["--alpha", "test"], ["--alpha", "blend"], []):
        assert main(["image", str(image), *words, "-o", str(header)]) == 0
        texts.append(header.read_text(encoding="ascii"))
    none, test, blend, default = texts
    assert ".key" not in none and ".alpha" not in none
    assert ".key" in test and ".alpha" not in test
    assert ".key" not in blend and ".alpha" in blend
    assert default == blend.replace(" --alpha blend", "")
    capsys.readouterr()
    assert main(["image", str(image), "--json", "-o", str(header)]) == 0
    told = json.loads(capsys.readouterr().out)
    assert (told["width"], told["height"], told["alpha"]) == (WIDTH, HEIGHT, True)
    assert told["flash_bytes"] == 3 * WIDTH * HEIGHT
    assert header.read_text(encoding="ascii") == default


def test_large_pictures(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    image, header = tmp_path / "long.png", tmp_path / "long.h"
    Image.new("L", (1025, 1)).save(image)
    assert main(["image", str(image), "-o", str(header)]) == 0
    assert "too large for a texture of a mesh" in capsys.readouterr().out
    Image.new("L", (MAX_SIDE + 1, 1)).save(image)
    assert main(["image", str(image), "-o", str(tmp_path / "other.h")]) == 2
    assert "32768x1 pixels, 32,767 a side at most" in capsys.readouterr().err
    assert not (tmp_path / "other.h").exists()


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["absent.png", "-o", "x.h"], "cannot read the image"),
        (["text.png", "-o", "x.h"], "is no image that can be read"),
        (["half.png", "-o", "x.h"], "half.png"),
        (["clear.png", "--alpha", "test", "-o", "x.h"], "clear.png: all of the image is transparent"),
        (["dark.png", "--format", "mask", "-o", "x.h"], "dark.png: nothing of the image shows as a mask"),
        (["dark.png", "-o", "x.png"], "a picture becomes a C header"),
        (["dark.png", "--name", "int", "-o", "x.h"], "cannot name a C object"),
        (["dark.png", "-o", "absent/x.h"], "cannot write"),
    ],
)
def test_what_cannot_be_done_is_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], words: list[str], told: str
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("text.png").write_text("no picture")
    Image.new("RGB", (4, 4)).save("dark.png")
    Image.new("RGBA", (4, 4)).save("clear.png")
    Image.fromarray(picture(1)).save("whole.png")
    Path("half.png").write_bytes(Path("whole.png").read_bytes()[:-60])
    assert main(["image", *words]) == 2
    error = capsys.readouterr().err
    assert error.startswith("edgeline: ") and told in error and error.count("\n") == 1
    assert not Path("x.h").exists()
