"""A bad file of any format that is converted gets one line: its name, what is wrong, what to do. Nothing is written.

For each format the same ways to be bad: empty, of another kind, cut short, too large to be meant, no number, an index
beyond the end. What else a format can have wrong is in the tests of its reader.
"""

from __future__ import annotations

import io
import random
import struct
import zlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageFont

from edgeline.cli import main
from edgeline.convert import elm
from edgeline.convert.mesh import Mesh
from edgeline.convert.texels import Format, Texture
from models import Gltf, checks, ply, ring, stl_ascii, stl_binary

MODEL = ring(6, 4)
TRIANGLE = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl paint\nf 1/1 2/1 3/1\n"
MATERIAL = "newmtl paint\nKd 1 0.5 0\nmap_Kd m.png\n"


def jpeg() -> bytes:
    file = io.BytesIO()
    Image.open(io.BytesIO(checks())).resize((64, 64)).save(file, "JPEG")
    return file.getvalue()


def png_of_size(width: int, height: int) -> bytes:
    """One that says to be that large, and is not."""
    data = bytearray(checks())
    struct.pack_into(">II", data, 16, width, height)
    struct.pack_into(">I", data, 29, zlib.crc32(bytes(data[12:29])))
    return bytes(data)


def glb() -> bytes:
    gltf = Gltf()
    gltf.node(gltf.primitive(MODEL))
    return gltf.glb()


def changed(accessor: Callable[[dict[str, object]], object]) -> bytes:
    """A .gltf whose positions' accessor is another one."""
    gltf = Gltf()
    gltf.node(gltf.primitive(MODEL))
    accessor(gltf.json["accessors"][0])
    return gltf.gltf()


def nan_glb() -> bytes:
    gltf = Gltf()
    gltf.node(gltf.primitive(MODEL))
    gltf.chunk[0:4] = struct.pack("<f", float("nan"))
    return gltf.glb()


def elm_file(form: Format = Format.INDEX4) -> bytearray:
    """With everything in it; of version 2."""
    mesh = Mesh(np.eye(3, dtype=np.int16), np.array([[0, 1, 2]], np.uint16), 0, uvs=np.zeros((3, 2), np.int16))
    texture = Texture(np.zeros((4, 4), np.uint16), form, np.zeros(form.colours, np.uint16))
    return bytearray(elm.encode(mesh, texture))


def resealed(data: bytearray, at: int, value: int) -> bytes:
    """With another 16 bits at that place, and the checksum right again."""
    struct.pack_into("<H", data, at, value)
    struct.pack_into("<I", data, 12, zlib.crc32(data[16:]))
    return bytes(data)


def font() -> bytes:
    found = ImageFont.load_default(10)
    assert isinstance(found, ImageFont.FreeTypeFont)
    return bytes(found.font_bytes)


def font_with_tables_beyond_its_end() -> bytes:
    data = bytearray(font())
    for i in range(struct.unpack_from(">H", data, 4)[0]):
        struct.pack_into(">I", data, 12 + 16 * i + 8, 0x7FFFFFFF)
    return bytes(data)


BAD: dict[str, dict[str, tuple[bytes, str]]] = {
    "m.obj": {
        "empty": (b"", "no face in this file"),
        "other": (b"\x89PNG\r\n\0\0", "this is not text"),
        "cut": (TRIANGLE[: TRIANGLE.index("v 0 1 0")].encode() + b"f 1 2 3\n", "vertex 3, but the file has 2"),
        "cut in a line": (b"v 0 0 0\nv 1 0 0\nv 0 1", "needs 3 to 7 numbers and has 2"),
        "huge": (TRIANGLE.replace("1 0 0", "1e39 0 0").encode(), "a position is no finite number"),
        "large": (TRIANGLE.replace("1 0 0", "1e29 0 0").encode(), "can be stored; make it smaller with --scale"),
        "nan": (TRIANGLE.replace("1 0 0", "nan 0 0").encode(), "m.obj:3: 'nan' is no finite number"),
        "index": (TRIANGLE.replace("3/1", "4/1").encode(), "m.obj:7: vertex 4, but the file has 3"),
        "index of 0": (TRIANGLE.replace("3/1", "0/1").encode(), "m.obj:7: vertex 0, but there are 3"),
        "index huge": (TRIANGLE.replace("3/1", "99999999999999999999/1").encode(), "is no index of a vertex"),
    },
    "m.mtl": {
        "other": (b"newmtl paint\0", "this is not text"),
        "cut": (b"newmtl paint\nKd 1 0.5 \\", "m.mtl:2: the file ends in a continued line"),
        "nan": (b"newmtl paint\nKd nan 0 0\n", "m.mtl:2: 'nan' is no finite number"),
        "no number": (b"newmtl paint\nd half\n", "m.mtl:2: 'half' is no number"),
        "image": (b"newmtl paint\nmap_Kd absent.png\n", "m.mtl:2: map_Kd: cannot read the image"),
    },
    "m.stl": {
        "empty": (b"", "0 bytes are no STL"),
        "other": (checks(), "109 bytes, but its 755222156 triangles would be 37761107884"),
        "cut": (stl_binary(MODEL)[:-9], "it is cut short"),
        "huge": (bytes(80) + b"\xff\xff\xff\xff" + bytes(50), "4294967295 triangles would be"),
        "nan": (stl_binary(MODEL)[:96] + b"\0\0\xc0\x7f" + stl_binary(MODEL)[100:], "a position is no finite number"),
        "text cut": (stl_ascii(MODEL)[:-20], "m.stl"),
        "text nan": (b"solid\nfacet normal 0 0 0\nouter loop\nvertex nan 0 0\n", "m.stl:4: 'nan' is no finite number"),
    },
    "m.ply": {
        "empty": (b"", "its header has no end_header"),
        "other": (checks(), "it does not begin with 'ply'"),
        "cut": (ply(MODEL, "<")[:-1], "it is cut short"),
        "text cut": (ply(MODEL, "")[:-30], "m.ply"),
        "huge": (ply(MODEL, "<").replace(b"vertex 35", b"vertex 4294967295"), "lies beyond the end"),
        "nan": (ply(MODEL, "").replace(b"end_header\n", b"end_header\nnan ", 1), "m.ply"),
        "index": (ply(MODEL, "").replace(b"\n3 0 ", b"\n3 999 ", 1), "names vertex 999"),
    },
    "m.gltf": {
        "empty": (b"", "this is no glTF"),
        "other": (checks(), "this is no glTF"),
        "cut": (changed(lambda a: None)[:-9], "this is no glTF"),
        "huge": (changed(lambda a: a.update(count=10**15)), "12000000 at most are read"),
        "nan": (changed(lambda a: a.update(count=float("nan"))), "'count' is of the wrong type"),
        "index": (changed(lambda a: a.update(bufferView=9)), "names number 9 of bufferViews"),
    },
    "m.glb": {
        "empty": (b"", "this is no glTF"),
        "other": (checks(), "this is no glTF"),
        "cut": (glb()[:-1], "the .glb is cut short"),
        "huge": (glb()[:8] + b"\xff\xff\xff\xff" + glb()[12:], "the .glb is cut short"),
        "nan": (nan_glb(), "a position is no finite number"),
    },
    "m.elm": {
        "empty": (b"", "not an .elm mesh"),
        "other": (checks(), "not an .elm mesh"),
        "cut": (bytes(elm_file()[:-4]), "cut short"),
        "huge": (bytes(elm_file()[:8]) + b"\xff\xff\xff\x7f" + bytes(elm_file()[12:]), "cut short"),
        "index": (resealed(elm_file(), 52, 7), "index 7 with 3 vertices"),
        "counts": (resealed(elm_file(), 16, 60000), "its counts do not agree"),
        "surface": (resealed(elm_file(), 74, 9), "its surface contradicts itself"),
        "version": (b"ELM\x1a\x09\0" + bytes(elm_file()[6:]), "has version 9.0, this Edgeline reads 1.x and 2.x"),
    },
    "m.png": {
        "empty": (b"", "is no image that can be read"),
        "other": (stl_binary(MODEL), "is no image that can be read"),
        "cut": (checks()[:-30], "image"),
        "head alone": (checks()[:33], "image"),
        "huge": (png_of_size(60000, 60000), "is an image of unreasonable size"),
        "no size": (png_of_size(0, 16), "image"),
    },
    "m.jpg": {
        "empty": (b"", "is no image that can be read"),
        "other": (b"GIF89a", "image"),
        "cut": (jpeg()[: len(jpeg()) // 2], "image"),
        "head alone": (jpeg()[:40], "image"),
    },
    "m.ttf": {
        "empty": (b"", "it is no font that can be read"),
        "other": (checks(), "it is no font that can be read"),
        "cut": (font()[:600], "it is no font that can be read"),
        "head alone": (font()[:12], "it is no font that can be read"),
        "index": (font_with_tables_beyond_its_end(), "it is no font that can be read"),
    },
}


def command(folder: Path, name: str) -> list[str]:
    """What reads the file: by itself, or as what a good model names."""
    (folder / "good.obj").write_text(TRIANGLE)
    if name.endswith(".ttf"):
        return ["font", str(folder / name), "-o", str(folder / "out.h")]
    words = ["convert", str(folder / name), "-o", str(folder / "out.h")]
    if name.endswith((".png", ".jpg", ".mtl")):
        words[1] = str(folder / "good.obj")
    if name.endswith((".png", ".jpg")):
        words += ["--texture", str(folder / name)]
    return words


@pytest.mark.parametrize(("name", "case"), [(name, case) for name, cases in BAD.items() for case in cases])
def test_bad_files(tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, case: str) -> None:
    data, told = BAD[name][case]
    words = command(tmp_path, name)
    (tmp_path / name).write_bytes(data)
    (tmp_path / "out.h").write_text("precious")
    assert main(words) == 2
    shown = capsys.readouterr()
    assert shown.out == ""
    assert shown.err.startswith("edgeline: ") and shown.err.count("\n") == 1
    assert told in shown.err and name in shown.err
    assert ";" in shown.err or "?" in shown.err  # what to do follows, or is asked
    assert (tmp_path / "out.h").read_text() == "precious"


@pytest.mark.parametrize("name", [*BAD])
def test_what_is_good_is_converted(tmp_path: Path, name: str) -> None:
    """So that it is the damage that is refused."""
    words = command(tmp_path, name)
    good = {
        "m.obj": TRIANGLE.encode(),
        "m.mtl": b"newmtl paint\nKd 1 0.5 0\nd 0.5\n",
        "m.stl": stl_binary(MODEL),
        "m.ply": ply(MODEL, "<"),
        "m.gltf": changed(lambda a: None),
        "m.glb": glb(),
        "m.elm": bytes(elm_file()),
        "m.png": checks(),
        "m.jpg": jpeg(),
        "m.ttf": font(),
    }
    (tmp_path / name).write_bytes(good[name])
    assert main(words) == 0


@pytest.mark.parametrize("name", ["m.png", "m.jpg"])
def test_damaged_images_are_read_or_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str) -> None:
    """Whatever of Pillow's decoders finds the damage."""
    source = random.Random(name)
    good = checks() if name == "m.png" else jpeg()
    words = command(tmp_path, name)
    outcomes = {0: 0, 2: 0}
    for _ in range(150):
        data = bytearray(good)
        for _ in range(source.randrange(1, 4)):
            data[source.randrange(len(data))] = source.randrange(256)
        (tmp_path / name).write_bytes(data[: source.choice((len(data), source.randrange(len(data))))])
        status = main(words)
        outcomes[status] += 1
        assert capsys.readouterr().err.count("\n") == (status == 2)
    assert min(outcomes.values()) > 5, outcomes
