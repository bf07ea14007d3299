"""A model with several textures becomes several meshes, which fit together; all of them are written, or none."""

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
from edgeline.convert.mesh import Mesh
from models import Gltf, checks, ring

TWO = (
    "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 100.3 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "usemtl oak wood\nf 1/1 2/2 3/3\nusemtl stone\nf 1/1 3/3 4/4\nusemtl paint\nf 1 2 5\nf 2 6 5\nusemtl Oak.wood\n"
    "f 1/1 2/2 3/3\n"
)
MATERIALS = (
    "newmtl oak wood\nmap_Kd oak.png\nnewmtl stone\nmap_Kd stone.png\nnewmtl paint\nKd 1 0 0\n"
    "newmtl Oak.wood\nmap_Kd other.png\n"
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "m.obj").write_text(TWO)
    (tmp_path / "m.mtl").write_text(MATERIALS)
    for i, name in enumerate(("oak", "stone", "other")):
        Image.new("RGB", (8, 8), (80 * i, 0, 255)).save(tmp_path / f"{name}.png")
    return tmp_path


def world(mesh: Mesh) -> list[list[float]]:
    positions = np.ldexp(mesh.positions.astype(float), mesh.scale_log2)
    found: list[list[float]] = positions.tolist()
    return found


def test_an_elm_for_each(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert convert(folder / "m.obj", "-o", folder / "made.elm") == 0
    names = ["made-oak_wood.elm", "made-stone.elm", "made-paint.elm", "made-oak_wood_3.elm"]
    lines = capsys.readouterr().out.splitlines()
    assert [Path(line.split(": ")[0]).name for line in lines[:4]] == names
    assert not (folder / "made.elm").exists()
    meshes = [elm.decode((folder / name).read_bytes()) for name in names]
    assert [texture is not None for _, texture in meshes] == [True, True, False, True]
    assert len({mesh.scale_log2 for mesh, _ in meshes}) == 1
    paint = meshes[2][0]
    assert paint.triangle_colours is not None and paint.uvs is None
    assert paint.triangle_colours.tolist() == [[255, 0, 0], [255, 0, 0]]
    # What they share lies at the same place in all of them.
    for mesh, _ in meshes[:2]:
        assert [0, 0, 0] in world(mesh) and [1, 1, 0] in world(mesh)


def test_one_header_for_all(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert convert(folder / "m.obj", "-o", folder / "made.h", "--json") == 0
    found = json.loads(capsys.readouterr().out)
    names = ["made_oak_wood", "made_stone", "made_paint", "made_oak_wood_3"]
    assert [one["name"] for one in found["meshes"]] == names
    assert found["triangles"] == sum(one["triangles"] for one in found["meshes"]) == 5
    assert found["flash_bytes"] == sum(one["flash_bytes"] for one in found["meshes"])
    assert found["texture_bytes"] == 3 * 8 * 8 * 2
    assert found["outputs"] == [str(folder / "made.h")]
    text = (folder / "made.h").read_text()
    assert re.findall(r"^static const el_mesh (\w+) = ", text, re.MULTILINE) == names
    assert len(re.findall(r"^static const el_texture ", text, re.MULTILINE)) == 3


def test_no_mesh_has_the_name_of_another_s_part(folder: Path) -> None:
    for name, material in (("stone", "oak wood texture"), ("Oak.wood", "oak wood level1 image"), ("paint", "material")):
        for path in (folder / "m.obj", folder / "m.mtl"):
            path.write_text(path.read_text().replace(f"mtl {name}\n", f"mtl {material}\n"))
    convert(folder / "m.obj", "-o", folder / "made.h", "--mipmaps")
    names = re.findall(r"^static const \w+ (\w+)", (folder / "made.h").read_text(), re.MULTILINE)
    assert len(set(names)) == len(names) > 20
    assert {"made_oak_wood", "made_oak_wood_texture_1", "made_oak_wood_level1_image_3", "made_material"} <= set(names)


def test_asked_for_one_texture_or_none_it_stays_one_mesh(folder: Path) -> None:
    (folder / "m.obj").write_text(TWO.replace("f 1 2 5\nf 2 6 5\n", ""))
    for options in (["--no-texture"], ["--texture", str(folder / "oak.png")]):
        convert(folder / "m.obj", "-o", folder / "made.elm", *options)
        mesh, _ = elm.decode((folder / "made.elm").read_bytes())
        assert len(mesh.triangles) == 3


def test_parts_without_area_are_dropped(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "m.obj").write_text(TWO.replace("f 1/1 3/3 4/4", "f 1/1 3/3 3/3"))
    convert(folder / "m.obj", "-o", folder / "made.h", "--json")
    found = json.loads(capsys.readouterr().out)
    assert (len(found["meshes"]), found["dropped_triangles"]) == (3, 1)
    (folder / "m.obj").write_text(re.sub(r"f (\S+) (\S+) \S+", r"f \1 \2 \2", TWO))
    assert refused("convert", folder / "m.obj", "-o", folder / "x.h").startswith("m.obj: no triangle with an area")


def test_all_are_written_or_none(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (folder / "made-stone.elm").mkdir()
    before = sorted(path.name for path in folder.iterdir())
    assert "it is a folder" in refused("convert", folder / "m.obj", "-o", folder / "made.elm")
    assert sorted(path.name for path in folder.iterdir()) == before
    (folder / "made-stone.elm").rmdir()

    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(Path, "chmod", full)
    assert "No space left" in refused("convert", folder / "m.obj", "-o", folder / "made.elm")
    assert [path.name for path in folder.iterdir() if "made" in path.name] == []


def test_materials_of_gltf(tmp_path: Path) -> None:
    gltf = Gltf()
    model = ring(6, 4)
    image = {"bufferView": gltf.view(checks()), "mimeType": "image/png"}
    first = gltf.material(image=image)
    second = gltf.material([0.25, 1, 1, 1])
    gltf.json["materials"][second]["pbrMetallicRoughness"]["baseColorTexture"] = {"index": 0}
    plain = gltf.material([0.0, 1.0, 0.0, 1.0])
    for paint in (first, second, plain, first):
        gltf.node(gltf.primitive(model, attributes="pt", material=paint))
    (tmp_path / "m.glb").write_bytes(gltf.glb())
    convert(tmp_path / "m.glb", "-o", tmp_path / "m.elm", "--texture-size", 16)
    a, b, c = (elm.decode((tmp_path / f"m-paint_{i}.elm").read_bytes()) for i in range(3))
    assert [len(mesh.triangles) for mesh, _ in (a, b, c)] == [96, 48, 48]
    assert a[1] is not None and b[1] is not None and c[1] is None
    assert int(a[1].texels[0, 0]) >> 11 > int(b[1].texels[0, 0]) >> 11 > 0
    assert c[0].triangle_colours is not None
    assert {tuple(colour) for colour in c[0].triangle_colours.tolist()} == {(0, 255, 0)}


def test_vertex_colours_of_materials(folder: Path) -> None:
    convert(folder / "m.obj", "-o", folder / "made.elm", "--no-texture", "--vertex-colours")
    mesh, _ = elm.decode((folder / "made.elm").read_bytes())
    assert mesh.triangle_colours is None and mesh.colours is not None
    assert {tuple(colour) for colour in mesh.colours.tolist()} == {(255, 0, 0), (204, 204, 204)}
