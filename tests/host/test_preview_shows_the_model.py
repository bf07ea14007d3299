"""`edgeline preview` shows a model of each format as somebody looked at it, and as the panel would.

After a change that is meant to change pixels: `EDGELINE_UPDATE_GOLDEN=1 python -m pytest` on this file, then look at
tests/golden/convert-*.png before committing them.
"""

from __future__ import annotations

import io
import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageChops

from converting import refused, run_preview
from edgeline.convert import preview
from models import Gltf, checks, ply, ring, stl_ascii, stl_binary

GOLDEN = Path(__file__).resolve().parents[1] / "golden"
UPDATE = bool(os.environ.get("EDGELINE_UPDATE_GOLDEN"))
MODEL = ring(40, 20)

HOUSE = """mtllib house.mtl
v -1 0 -0.7
v 1 0 -0.7
v 1 0 0.7
v -1 0 0.7
v -1 1 -0.7
v 1 1 -0.7
v 1 1 0.7
v -1 1 0.7
v -1 1.7 0
v 1 1.7 0
vt 0 0
vt 2 0
vt 2 1
vt 0 1
vt 1 1.7
usemtl wall
f 4/1 3/2 7/3 8/4
f 3/1 2/2 6/3 10/5 7/4
f 2/1 1/2 5/3 6/4
f 1/1 4/2 8/3 9/5 5/4
usemtl roof
f 8 7 10 9
f 6 5 9 10
"""
HOUSE_MATERIALS = "newmtl wall\nmap_Kd wall.png\nnewmtl roof\nKd 0.7 0.2 0.1\n"


def house(folder: Path) -> Path:
    (folder / "house.obj").write_text(HOUSE)
    (folder / "house.mtl").write_text(HOUSE_MATERIALS)
    (folder / "wall.png").write_bytes(checks((150, 110, 80), (220, 200, 170)))
    return folder / "house.obj"


def scene() -> Gltf:
    """Two rings through each other, one textured, one of a plain colour."""
    gltf = Gltf()
    fields = gltf.material([1.0, 0.8, 0.6, 1.0], {"bufferView": gltf.view(checks()), "mimeType": "image/png"})
    paint = gltf.material([0.05, 0.3, 0.8, 1.0])
    gltf.node(gltf.primitive(MODEL, attributes="pt", material=fields))
    turned = [0.5**0.5, 0.0, 0.0, 0.5**0.5]
    gltf.node(gltf.primitive(MODEL, material=paint), rotation=turned, translation=[1.0, 0.0, 0.0])
    return gltf


def panes() -> Gltf:
    """A ring whose image has holes, seen from both sides, and one that can be looked through, before a third."""
    fields = np.asarray(Image.open(io.BytesIO(checks())))
    alpha = np.where(fields[..., :1] > 220, 0, 255).astype(np.uint8)
    file = io.BytesIO()
    Image.fromarray(np.concatenate([fields, alpha], axis=2)).save(file, "PNG")
    gltf = Gltf()
    view = {"bufferView": gltf.view(file.getvalue()), "mimeType": "image/png"}
    holes = gltf.material(image=view, alphaMode="MASK", doubleSided=True)
    glass = gltf.material([0.1, 0.9, 0.3, 0.4], alphaMode="BLEND")
    paint = gltf.material([0.05, 0.3, 0.8, 1.0])
    gltf.node(gltf.primitive(MODEL, material=glass), translation=[-0.6, 0.6, 0.6])
    gltf.node(gltf.primitive(MODEL, attributes="pt", material=holes))
    gltf.node(gltf.primitive(MODEL, material=paint), translation=[0.3, -0.7, -0.5])
    return gltf


def written(name: str, data: bytes) -> Callable[[Path], Path]:
    def write(folder: Path) -> Path:
        (folder / name).write_bytes(data)
        return folder / name

    return write


def gltf_beside(folder: Path) -> Path:
    gltf = Gltf()
    (folder / "fields.png").write_bytes(checks())
    paint = gltf.material(image={"uri": "fields.png"})
    gltf.node(gltf.primitive(MODEL, "u4", "pt", material=paint))
    (folder / "ring.bin").write_bytes(bytes(gltf.chunk))
    (folder / "ring.gltf").write_bytes(gltf.gltf("ring.bin"))
    return folder / "ring.gltf"


def coloured() -> Gltf:
    """A texture times vertex colours."""
    gltf = Gltf()
    paint = gltf.material(image={"bufferView": gltf.view(checks()), "mimeType": "image/png"})
    gltf.node(gltf.primitive(MODEL, "u4", "ptc", material=paint))
    return gltf


CASES: dict[str, tuple[Callable[[Path], Path], list[str]]] = {
    "obj": (house, ["--texture-size", "16", "--no-clusters"]),
    "stl": (written("ring.stl", stl_binary(MODEL)), ["--up", "z"]),
    "stl-ascii": (written("ring.stl", stl_ascii(MODEL)), ["--panel", "ssd1306", "--crease", "0"]),
    "ply": (written("ring.ply", ply(MODEL, ">")), ["--panel", "st7789", "--rotation", "90"]),
    "ply-textured": (written("ring.ply", ply(MODEL, "", "fields.png", True)), ["--panel", "st7735"]),
    "glb": (written("scene.glb", scene().glb()), ["--panel", "ili9341", "--texture-size", "16"]),
    "obj-palette": (house, ["--texture-format", "palette4", "--texture-size", "16", "--mipmaps", "--crease", "0"]),
    "glb-coloured": (written("ring.glb", coloured().glb()), ["--texture-size", "16"]),
    "obj-lit": (house, ["--shading", "lit", "--texture-size", "16", "--crease", "0"]),
    "glb-alpha": (written("panes.glb", panes().glb()), ["--texture-size", "16"]),
    "gltf": (gltf_beside, ["--texture-size", "16"]),
}


@pytest.fixture(autouse=True)
def named(simulator: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("EDGELINE_SIM", simulator)


@pytest.mark.parametrize("case", CASES)
def test_pictures_as_somebody_looked_at_them(tmp_path: Path, case: str) -> None:
    make, options = CASES[case]
    (tmp_path / "fields.png").write_bytes(checks())
    picture = tmp_path / "out.png"
    assert run_preview(make(tmp_path), "-o", picture, *options) == 0
    golden = GOLDEN / f"convert-{case}.png"
    shown = Image.open(picture).convert("RGB")
    if UPDATE:
        shown.save(golden, optimize=True)
    difference = ImageChops.difference(shown, Image.open(golden).convert("RGB"))
    if difference.getbbox() is not None:
        reports = Path(os.environ.get("EDGELINE_REPORTS") or GOLDEN.parents[1] / "build" / "reports") / "golden"
        reports.mkdir(parents=True, exist_ok=True)
        shown.save(reports / golden.name)
        difference.point(lambda value: 255 if value else 0).save(reports / f"convert-{case}-diff.png")
        pytest.fail(f"the picture differs from {golden.name} within {difference.getbbox()}: see {reports}")


def test_the_same_model_in_two_formats_is_one_picture(tmp_path: Path) -> None:
    for name, data in (("a.stl", stl_binary(MODEL)), ("b.stl", stl_ascii(MODEL))):
        (tmp_path / name).write_bytes(data)
        run_preview(tmp_path / name, "-o", tmp_path / f"{name}.png")
    assert (tmp_path / "a.stl.png").read_bytes() == (tmp_path / "b.stl.png").read_bytes()


def test_a_part_in_front_hides_what_is_behind_it(tmp_path: Path) -> None:
    """However the parts are ordered: the picture is the one of all triangles in one mesh."""
    (tmp_path / "m.obj").write_text(
        "mtllib m.mtl\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nv -1 -1 -1\nv 2 -1 -1\nv 0 2 -1\nvt 0 0\n"
        "usemtl a\nf 1/1 2/1 3/1\nusemtl b\nf 4/1 5/1 6/1\n"
    )
    (tmp_path / "m.mtl").write_text("newmtl a\nmap_Kd a.png\nnewmtl b\nmap_Kd b.png\n")
    colours = ((255, 0, 0), (0, 0, 255))
    for name, colour in zip("ab", colours, strict=True):
        Image.new("RGB", (4, 4), colour).save(tmp_path / f"{name}.png")
    run_preview(tmp_path / "m.obj", "-o", tmp_path / "two.png")
    (tmp_path / "m.mtl").write_text("newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 0 1\n")
    camera = ("--eye", "2,1.5,3", "--look-at", "0,0,-0.5")
    run_preview(tmp_path / "m.obj", "-o", tmp_path / "one.png", "--no-normals", *camera)
    (tmp_path / "m.mtl").write_text("newmtl a\nmap_Kd a.png\nnewmtl b\nmap_Kd b.png\n")
    run_preview(tmp_path / "m.obj", "-o", tmp_path / "two.png", *camera)
    one, two = (Image.open(tmp_path / name).convert("RGB") for name in ("one.png", "two.png"))
    assert ImageChops.difference(one, two).getbbox() is None
    assert {colour for _, colour in one.getcolors() or []} == {(0, 0, 0), *colours}


def test_what_is_wrong_gets_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "m.stl").write_bytes(stl_binary(MODEL))
    output = tmp_path / "out.png"
    assert refused("preview", tmp_path / "m.stl", "-o", "x.jpg") == "-o x.jpg: the picture is a PNG; name it so"
    told = refused("preview", tmp_path / "m.stl", "-o", output, "--panel", "st7735", "--size", "200x200")
    assert told.startswith("the simulator: ") and "larger than the st7735" in told
    told = refused("preview", tmp_path / "m.stl", "-o", output, "--shading", "textured")
    assert told.startswith("the simulator: edgeline-sim: m has no texture: ")
    monkeypatch.setenv("EDGELINE_SIM", str(tmp_path / "absent"))
    assert "there is no such file; build the simulator, or unset it" in refused("preview", tmp_path / "m.stl")
    monkeypatch.delenv("EDGELINE_SIM")
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(preview, "TREE", tmp_path)
    assert "preview needs the simulator; build it" in refused("preview", tmp_path / "m.stl")
    assert not output.exists()
    (tmp_path / "edgeline-sim").write_bytes(b"no program")
    (tmp_path / "edgeline-sim").chmod(0o700)
    assert "the simulator does not run" in refused("preview", tmp_path / "m.stl", "-o", output)
    assert not output.exists()
