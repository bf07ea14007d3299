"""`edgeline convert` reports what it made, and every wrong input gets one line and loses nothing."""

from __future__ import annotations

import errno
import json
import os
import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from converting import convert, refused
from edgeline.convert import elm
from edgeline.convert.palette import rgb565
from edgeline.convert.texture import load_pixels

QUAD = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
FACE = "f 1/1 2/2 3/3 4/4\n"


def refusal(*words: object) -> str:
    return refused("convert", *words)


@pytest.fixture
def quad(tmp_path: Path) -> Path:
    path = tmp_path / "quad.obj"
    path.write_text("mtllib quad.mtl\nusemtl wood\n" + QUAD + FACE)
    (tmp_path / "quad.mtl").write_text("newmtl wood\nKd 0.5 0.25 1\nmap_Kd textures\\wood.png\n")
    (tmp_path / "textures").mkdir()
    Image.new("RGB", (100, 40), (255, 128, 0)).save(tmp_path / "textures" / "wood.png")
    return path


def test_a_textured_model_with_its_report(quad: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert convert(quad, "-o", quad.with_suffix(".elm")) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].endswith("quad.elm: quad, with normals, texture coordinates, a 128x32 texture")
    assert lines[1] == "  2 triangles, 4 vertices, 8,256 bytes of flash"
    mesh, texture = elm.decode(quad.with_suffix(".elm").read_bytes())
    assert texture is not None
    assert set(texture.texels.reshape(-1).tolist()) == {0xFC00}
    assert mesh.triangle_colours is None


def test_the_report_as_json(quad: Path, capsys: pytest.CaptureFixture[str]) -> None:
    output = quad.with_suffix(".h")
    assert convert(quad, "-o", output, "--no-texture", "--name", "board", "--json") == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["name"] == "board"
    assert (facts["vertices"], facts["triangles"], facts["texture_size"]) == (4, 2, None)
    assert facts["flash_bytes"] == 4 * 6 + 2 * 6 + 2 * 3 + 4 * 3
    text = output.read_text()
    assert "static const el_mesh board = {" in text
    assert "{128,64,255},{128,64,255}," in text
    assert "Made by: edgeline convert quad.obj --no-texture\n" in text
    assert str(quad.parent) not in text


def test_the_same_input_gives_the_same_bytes(quad: Path) -> None:
    for suffix in (".h", ".elm"):
        output = quad.with_suffix(suffix)
        convert(quad, "-o", output)
        first = output.read_bytes()
        convert(quad, "-o", output)
        assert output.read_bytes() == first
    assert sorted(path.name for path in quad.parent.iterdir()) == [
        "quad.elm",
        "quad.h",
        "quad.mtl",
        "quad.obj",
        "textures",
    ]


def test_an_elm_becomes_the_header_of_its_model(quad: Path) -> None:
    convert(quad, "-o", quad.with_suffix(".h"))
    convert(quad, "-o", quad.with_suffix(".elm"))
    second = quad.with_name("second.h")
    convert(quad.with_suffix(".elm"), "-o", second, "--name", "quad")
    assert second.read_text().splitlines()[2:] == quad.with_suffix(".h").read_text().splitlines()[2:]
    assert refusal(quad.with_suffix(".elm"), "-o", second, "--crease", 30).startswith(
        "--crease is for models in other formats"
    )


def test_scale_and_centre(quad: Path) -> None:
    convert(quad, "-o", quad.with_suffix(".elm"), "--scale", 4, "--centre")
    mesh, _ = elm.decode(quad.with_suffix(".elm").read_bytes())
    positions = np.ldexp(mesh.positions.astype(float), mesh.scale_log2)
    assert sorted(positions.tolist()) == [[-2, -2, 0], [-2, 2, 0], [2, -2, 0], [2, 2, 0]]


def test_a_model_far_from_its_origin_is_told_of_centre(quad: Path, capsys: pytest.CaptureFixture[str]) -> None:
    output, text = quad.with_suffix(".elm"), quad.read_text()

    def moved(x: float) -> Path:
        quad.write_text(re.sub(r"^v (\S+)", lambda v: f"v {float(v[1]) + x}", text, flags=re.MULTILINE))
        return quad

    convert(moved(2), "-o", output)
    assert "--centre" not in capsys.readouterr().out
    convert(moved(100), "-o", output)
    assert "it is far from its origin; --centre makes its positions 128 times as fine\n" in capsys.readouterr().out
    assert "no triangle is left with an area; give --centre" in refused("convert", moved(1e5), "-o", output)
    convert(moved(1e5), "-o", output, "--centre")
    assert "--centre" not in capsys.readouterr().out


def test_headers_name_the_command_that_makes_them_again(quad: Path) -> None:
    output = quad.with_suffix(".h")
    for words in ("--crease 12.3456789 --up z --scale 0.5 --centre --triangles 1234567", "--crease 0 --mipmaps"):
        convert(quad, "-o", output, *words.split())
        assert f"Made by: edgeline convert quad.obj {words}\n" in output.read_text()


def test_a_missing_library_is_only_noted(quad: Path, capsys: pytest.CaptureFixture[str]) -> None:
    quad.with_suffix(".mtl").unlink()
    assert convert(quad, "-o", quad.with_suffix(".h")) == 0
    notes = [line for line in capsys.readouterr().out.splitlines() if "note:" in line]
    assert len(notes) == 2
    assert "quad.mtl is not there" in notes[0]


def test_files_with_another_computer_s_paths_are_found_beside_the_model(
    quad: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    convert(quad, "-o", quad.with_suffix(".elm"))
    expected = quad.with_suffix(".elm").read_bytes()
    quad.write_text(quad.read_text().replace("mtllib quad.mtl", "mtllib C:\\gone\\quad.mtl"))
    library = quad.with_suffix(".mtl")
    library.write_text(library.read_text().replace("map_Kd ", "map_Kd /gone/"))
    (quad.parent / "textures" / "wood.png").rename(quad.parent / "wood.png")
    capsys.readouterr()
    assert convert(quad, "-o", quad.with_suffix(".elm")) == 0
    assert quad.with_suffix(".elm").read_bytes() == expected
    notes = [line for line in capsys.readouterr().out.splitlines() if "note:" in line]
    assert [note.split("note: ")[1].split(" is not there; ")[0] for note in notes] == [
        "C:\\gone\\quad.mtl",
        "/gone/textures\\wood.png",
    ]


def test_missing_and_broken_files(quad: Path) -> None:
    folder, output = quad.parent, quad.with_suffix(".h")
    output.write_text("precious")
    (folder / "text.png").write_text("no image")
    Image.effect_noise((64, 64), 50).save(folder / "cut.png")
    (folder / "cut.png").write_bytes((folder / "cut.png").read_bytes()[:900])
    (folder / "odd.elm").write_bytes(b"ELM\x1a\x03\0\0\0" + bytes(40))
    assert refusal(folder / "no.obj", "-o", output) == f"cannot read {folder / 'no.obj'}: No such file or directory"
    assert refusal(quad, "-o", output, "--texture", folder / "no.png").startswith("cannot read the image ")
    assert "is no image that can be read" in refusal(quad, "-o", output, "--texture", folder / "text.png")
    assert "image" in refusal(quad, "-o", output, "--texture", folder / "cut.png")
    assert "has version 3.0" in refusal(folder / "odd.elm", "-o", output)
    (folder / "textures" / "wood.png").unlink()
    assert refusal(quad, "-o", output).startswith("quad.mtl:3: map_Kd: cannot read the image ")
    assert output.read_text() == "precious"


@pytest.mark.parametrize(
    ("words", "start"),
    [
        (["-o", "x.stl"], "-o x.stl: the result is a C header (.h) or an .elm"),
        (["-o", "x.h", "--crease", "190"], "--crease 190: it is an angle"),
        (["-o", "x.h", "--crease", "nan"], "--crease nan: it is an angle"),
        (["-o", "x.h", "--scale", "0"], "--scale 0: it is a factor above 0"),
        (["-o", "x.h", "--scale", "inf"], "--scale inf: it is a factor above 0"),
        (["-o", "x.h", "--texture-size", "100"], "--texture-size 100: it is a power of two"),
        (["-o", "x.h", "--name", "2nd"], "--name '2nd' cannot name a C object"),
        (["-o", "x.h", "--name", "while"], "--name 'while' cannot name a C object"),
    ],
)
def test_options_that_make_no_sense(quad: Path, words: list[str], start: str) -> None:
    assert refusal(quad, *words).startswith(start)
    assert refusal(quad.with_suffix(".fbx"), "-o", "x.h").endswith("export it as one of these")


def test_outputs_that_cannot_be_written(quad: Path) -> None:
    folder = quad.parent
    assert refusal(quad, "-o", folder / "absent" / "x.h").startswith(
        f"cannot write {folder / 'absent' / 'x.h'}: No such"
    )
    (folder / "folder.h").mkdir()
    assert "it is a folder" in refusal(quad, "-o", folder / "folder.h")
    if os.geteuid() != 0:
        folder.chmod(0o500)
        assert "Permission denied" in refusal(quad, "-o", folder / "x.h")
        folder.chmod(0o700)
    assert [path.name for path in folder.iterdir() if path.name.startswith(".")] == []


def test_a_full_disk_leaves_the_old_output_and_nothing_else(quad: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    output = quad.with_suffix(".h")
    output.write_text("precious")

    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(Path, "replace", full)
    assert refusal(quad, "-o", output) == f"cannot write {output}: No space left on device; give another -o"
    assert output.read_text() == "precious"
    assert [path.name for path in quad.parent.iterdir() if path.name.startswith(".")] == []


def test_names_are_made_c_identifiers(quad: Path) -> None:
    for stem, name in (("3d-Model.v2", "mesh_3d_model_v2"), ("int", "mesh_int"), ("---", "mesh"), ("Cow", "cow")):
        convert(quad, "-o", quad.with_name(f"{stem}.h"))
        assert f"static const el_mesh {name} = {{" in quad.with_name(f"{stem}.h").read_text()


def test_colours_are_rounded_to_nearest() -> None:
    levels = np.arange(256, dtype=np.uint8)
    texels = rgb565(np.stack([levels, levels, levels], axis=1)).astype(int)
    for level, texel in enumerate(texels):
        assert texel >> 11 == (2 * level * 31 + 255) // 510 == texel & 31
        assert texel >> 5 & 63 == (2 * level * 63 + 255) // 510


@pytest.mark.parametrize(
    ("size", "limit", "texels"), [((1, 1), 128, (1, 1)), ((100, 40), 128, (128, 32)), ((3000, 700), 64, (64, 64))]
)
def test_images_become_powers_of_two(
    size: tuple[int, int], limit: int, texels: tuple[int, int], tmp_path: Path
) -> None:
    for mode in ("RGB", "RGBA", "L", "P", "1"):
        Image.new(mode, size).save(tmp_path / "image.png")
        assert load_pixels(tmp_path / "image.png", limit).rgb.shape[:2] == texels[::-1]
