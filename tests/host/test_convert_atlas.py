"""An atlas: parts that differ only in their images become one mesh, which looks the same."""

from __future__ import annotations

import json
import random
import re
import subprocess
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from PIL import Image

from converting import convert, refused
from edgeline.convert import elm
from edgeline.convert.atlas import BORDER, BORDER_WITH_LEVELS, LEVELS, Place, arranged
from edgeline.errors import EdgelineError

SIZES = [(16, 16), (1, 4), (32, 16), (2, 2)]
CELL = 32
"""Pixels of a square in the picture; whole pixels to each texel of all images."""


def squares(folder: Path, plain: bool = False, shifts: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0)) -> Path:
    """Four squares beside each other, an image each, drawn from any whole number of repetitions on."""
    lines, materials = ["mtllib m.mtl"], []
    for i, (size, shift) in enumerate(zip(SIZES, shifts, strict=True)):
        texels = np.random.default_rng(i).integers(64, 256, (size[1], size[0], 3)).astype(np.uint8)
        Image.fromarray(texels).save(folder / f"{i}.png")
        x = 0.5 * i - 1
        lines += [f"v {x} -0.25 0", f"v {x + 0.5} -0.25 0", f"v {x + 0.5} 0.25 0", f"v {x} 0.25 0"]
        lines += [f"vt {u + shift} {v}" for u, v in ((0, 0), (1, 0), (1, 1), (0, 1))]
        lines += [f"usemtl paint{i}", "f " + " ".join(f"{4 * i + k}/{4 * i + k}" for k in (1, 2, 3, 4))]
        materials += [f"newmtl paint{i}", f"map_Kd {i}.png"]
    if plain:
        lines += ["usemtl plain", "f 1 2 3"]
        materials += ["newmtl plain", "Kd 1 0 0"]
    (folder / "m.obj").write_text("\n".join([*lines, ""]))
    (folder / "m.mtl").write_text("\n".join([*materials, ""]))
    return folder / "m.obj"


def drawn(simulator: str, folder: Path, side: int = CELL) -> npt.NDArray[np.uint16]:
    """The squares in a row, so many pixels each; of all .elm files in the folder."""
    width, height = 4 * side, side
    words: list[object] = [simulator, "render", "--raw", folder / "m.raw", "--size", f"{width}x{height}"]
    for path in sorted(folder.glob("*.elm")):
        words += ["--mesh", path]
    subprocess.run([*words, "--eye", "0,0,0.25", "--look-at", "0,0,0", "--fov", "90"], check=True)
    return np.fromfile(folder / "m.raw", "<u2").reshape(height, width)


def test_an_atlas_that_joins_nothing_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    said = "note: --atlas joins nothing, as no two parts differ only in their images\n"
    model = squares(tmp_path)
    convert(model, "-o", tmp_path / "m.h", "--atlas")
    assert said not in capsys.readouterr().out
    convert(model, "-o", tmp_path / "m.h", "--atlas", "--texture", tmp_path / "0.png")
    assert said in capsys.readouterr().out


@pytest.mark.parametrize("mipmaps", [False, True])
def test_an_atlas_looks_the_same(simulator: str, tmp_path: Path, mipmaps: bool) -> None:
    model = squares(tmp_path, shifts=(0.0, 3.0, -2.0, 1e-4))
    options = ["--mipmaps"] if mipmaps else []
    convert(model, "-o", tmp_path / "m.elm", *options)
    assert len(list(tmp_path.glob("*.elm"))) == 4
    apart = drawn(simulator, tmp_path)
    for path in tmp_path.glob("*.elm"):
        path.unlink()
    convert(model, "-o", tmp_path / "m.elm", "--atlas", *options)
    mesh, texture = elm.decode((tmp_path / "m.elm").read_bytes())
    assert len(mesh.triangles) == 8 and texture is not None
    assert len([*texture.levels()]) == (LEVELS if mipmaps else 1)
    assert np.array_equal(drawn(simulator, tmp_path), apart)
    assert len(np.unique(apart)) > 300


@pytest.mark.parametrize("kind", ["nearest", "bilinear"])
def test_neighbours_do_not_show_in_smaller_levels(simulator: str, tmp_path: Path, kind: str) -> None:
    """Squares of one colour each stay that, however far away."""
    model = squares(tmp_path)
    colours = (0xF800, 0x07E0, 0x001F, 0xFFFF)
    for i, (rgb, size) in enumerate(zip(((255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 255)), SIZES, strict=True)):
        Image.new("RGB", size, rgb).save(tmp_path / f"{i}.png")
    convert(model, "-o", tmp_path / "m.elm", "--atlas", "--mipmaps", "--filter", kind)
    for side in range(1, CELL):
        shown = drawn(simulator, tmp_path, side)
        for i, colour in enumerate(colours):
            assert set(shown[:, i * side : (i + 1) * side].reshape(-1).tolist()) == {colour}


def test_what_has_no_image_or_another_look_stays_apart(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    model = squares(tmp_path, plain=True)
    convert(model, "-o", tmp_path / "m.h", "--atlas", "--json")
    found = json.loads(capsys.readouterr().out)
    assert [one["name"] for one in found["meshes"]] == ["m_atlas", "m_plain"]
    assert [one["triangles"] for one in found["meshes"]] == [8, 1]
    text = (tmp_path / "m.mtl").read_text()
    (tmp_path / "m.mtl").write_text(text.replace("newmtl paint2\n", "newmtl paint2\nd 0.5\n"))
    convert(model, "-o", tmp_path / "m.h", "--atlas", "--json")
    found = json.loads(capsys.readouterr().out)
    # What is blended comes last.
    assert [one["triangles"] for one in found["meshes"]] == [6, 1, 2]


def test_what_repeats_is_refused_with_its_place(tmp_path: Path) -> None:
    model = squares(tmp_path, shifts=(0.0, 0.5, 0.0, 0.0))
    told = refused("convert", model, "-o", tmp_path / "m.h", "--atlas")
    line = 1 + (tmp_path / "m.obj").read_text().splitlines().index("f 5/5 6/6 7/7 8/8")
    assert told.startswith(f"m.obj:{line}: u 0.5 to 1.5, v 0 to 1: its image repeats, which in an atlas it cannot; cut")
    assert not (tmp_path / "m.h").exists()
    # Alone there is nothing to repeat against.
    text = re.sub("map_Kd .*", "map_Kd 1.png", (tmp_path / "m.mtl").read_text())
    (tmp_path / "m.mtl").write_text(text)
    assert convert(model, "-o", tmp_path / "m.h", "--atlas") == 0


def test_rectangles_are_apart_and_within() -> None:
    source = random.Random(5)
    for _ in range(40):
        sizes = [(source.randint(1, 80), source.randint(1, 80)) for _ in range(source.randint(1, 30))]
        width, height, places = arranged(sizes)
        taken = np.zeros((height, width), np.int64)
        for (across, down), place in zip(sizes, places, strict=True):
            taken[place.y : place.y + down, place.x : place.x + across] += 1
        assert taken.max() == 1 and taken.sum() == sum(across * down for across, down in sizes)
    assert arranged([(512, 1024), (512, 1024)]) == (1024, 1024, [Place(0, 0), Place(512, 0)])
    with pytest.raises(
        EdgelineError, match="--atlas: the 2 images of the model do not fit 1024x1024 texels; give a sm"
    ):
        arranged([(1024, 1024), (1, 1)])
    assert BORDER_WITH_LEVELS >> (LEVELS - 1) == 1 < BORDER
