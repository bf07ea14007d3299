"""Whatever a model's file holds, it is read, or refused in one line that says what, where and what to do."""

from __future__ import annotations

import random
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from conftest import Edgeline
from converting import refused
from edgeline.convert.pipeline import read_source
from edgeline.errors import EdgelineError
from models import Gltf, checks, ply, ring, stl_ascii, stl_binary

MODEL = ring(6, 4)
ASCII_HEAD = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
ASCII_HEAD += "element face 1\nproperty list uchar int vertex_indices\nend_header\n"


def edited(change: Callable[[dict[str, Any]], object], attributes: str = "pt") -> bytes:
    """A .glb with an image, one thing of which is wrong."""
    gltf = Gltf()
    paint = gltf.material([0.5] * 4, {"bufferView": gltf.view(checks()), "mimeType": "image/png"})
    gltf.node(gltf.primitive(MODEL, attributes=attributes, material=paint))
    change(gltf.json)
    return gltf.glb()


def primitive(content: dict[str, Any]) -> dict[str, Any]:
    found: dict[str, Any] = content["meshes"][0]["primitives"][0]
    return found


def positions(content: dict[str, Any]) -> dict[str, Any]:
    found: dict[str, Any] = content["accessors"][primitive(content)["attributes"]["POSITION"]]
    return found


def binary(model: object, at: int, value: float) -> bytes:
    """A binary STL in which a number of the first triangle is another one."""
    data = bytearray(stl_binary(MODEL))
    data[84 + 4 * at : 88 + 4 * at] = np.float32(value).tobytes()
    return bytes(data)


BAD = {
    "stl: empty": ("m.stl", b"", "m.stl: 0 bytes are no STL"),
    "stl: other": ("m.stl", b"\1" * 90, "m.stl: 90 bytes, but its 16843009 triangles would be 842150534"),
    "stl: short": ("m.stl", stl_binary(MODEL)[:-1], "it is cut short, export it again"),
    "stl: long": ("m.stl", stl_binary(MODEL) + b"\0", "it is damaged or no STL, export it again"),
    "stl: none": ("m.stl", bytes(84), "m.stl: no triangle in this file"),
    "stl: nan": ("m.stl", binary(MODEL, 3, float("nan")), "m.stl: triangle 0: a position is no finite number"),
    "stl: inf": ("m.stl", binary(MODEL, 11, float("-inf")), "m.stl: triangle 0: a position is no finite number"),
    "stl: huge": ("m.stl", binary(MODEL, 5, 3e30), "m.stl: triangle 0: a position is no finite number"),
    "stl: text": ("m.stl", b"solid\nfacet normal 0 0 0\nvertex 0 0 0\n", "m.stl:3: 'vertex' where outer is due"),
    "stl: text nan": (
        "m.stl",
        b"solid\nfacet normal 0 0 0\nouter loop\nvertex 0 nan 0\n",
        "m.stl:4: 'nan' is no finite number",
    ),
    "stl: quad": (
        "m.stl",
        b"solid\nfacet normal 0 0 0\nouter loop\n" + b"vertex 0 0 0\n" * 4 + b"endloop\nendfacet\nendsolid\n",
        "m.stl:8: a facet with 4 corners",
    ),
    "stl: text cut": ("m.stl", stl_ascii(MODEL)[:-14], "m.stl: it ends without endsolid; it is cut short"),
    "ply: empty": ("m.ply", b"", "m.ply: its header has no end_header"),
    "ply: other": ("m.ply", b"solid\nend_header\n", "m.ply: it does not begin with 'ply'"),
    "ply: format": ("m.ply", b"ply\nformat binary_middle_endian 1.0\n", "m.ply:2: 'format binary_middle_endian 1.0'"),
    "ply: no format": ("m.ply", b"ply\nend_header\n", "m.ply: its header names no format"),
    "ply: count": ("m.ply", b"ply\nformat ascii 1.0\nelement vertex many\n", "m.ply:3: 'element vertex many' is no"),
    "ply: type": (
        "m.ply",
        b"ply\nformat ascii 1.0\nelement vertex 3\nproperty half x\n",
        "m.ply:4: 'property half x' is no property",
    ),
    "ply: no vertices": ("m.ply", b"ply\nformat ascii 1.0\nend_header\n", "m.ply: no element 'vertex'"),
    "ply: no x": (
        "m.ply",
        ASCII_HEAD.replace("float x", "float w").encode() + b"0 0 0\n" * 3 + b"3 0 1 2\n",
        "m.ply: its vertices have no x, y and z",
    ),
    "ply: no indices": (
        "m.ply",
        ASCII_HEAD.replace("vertex_indices", "corners").encode() + b"0 0 0\n" * 3 + b"3 0 1 2\n",
        "m.ply: its faces have no list vertex_indices",
    ),
    "ply: cut": ("m.ply", ply(MODEL, "<")[:-1], "of 48 lies beyond the end; it is cut short"),
    "ply: text cut": ("m.ply", ASCII_HEAD.encode() + b"0 0 0\n", "m.ply: vertex 1 of 3 lies beyond the end"),
    "ply: huge count": (
        "m.ply",
        ply(MODEL, "<").replace(b"vertex 35", b"vertex 4000000000"),
        "of 4000000000 lies beyond the end",
    ),
    "ply: words": ("m.ply", ASCII_HEAD.encode() + b"0 0 zero\n", "m.ply:10: not all of this line are numbers"),
    "ply: nan": (
        "m.ply",
        ASCII_HEAD.encode() + b"0 0 nan\n" * 3 + b"3 0 1 2\n",
        "m.ply: face 0: a position is no finite number",
    ),
    "ply: too few": ("m.ply", ASCII_HEAD.encode() + b"0 0\n", "m.ply:10: 2 numbers are not what a vertex has"),
    "ply: index": (
        "m.ply",
        ASCII_HEAD.encode() + b"0 0 0\n" * 3 + b"3 0 1 3\n",
        "m.ply: face 0 names vertex 3, of 3 counted from 0",
    ),
    "ply: negative": ("m.ply", ASCII_HEAD.encode() + b"0 0 0\n" * 3 + b"3 0 1 -1\n", "m.ply: face 0 names vertex -1"),
    "ply: line": ("m.ply", ASCII_HEAD.encode() + b"0 0 0\n" * 3 + b"2 0 1\n", "m.ply: face 0 has 2 corners"),
    "ply: range": (
        "m.ply",
        ASCII_HEAD.encode() + b"0 0 0\n" * 3 + b"3 0 1 1e300\n",
        "m.ply:13: vertex_indices is outside",
    ),
    "glb: empty": ("m.glb", b"", "m.glb:1: this is no glTF"),
    "glb: text": ("m.gltf", b"{'asset'}", "m.gltf:1: this is no glTF"),
    "glb: list": ("m.gltf", b"[]", "m.gltf: this is no glTF"),
    "glb: deep": ("m.gltf", b"[" * 200_000, "m.gltf: this is no glTF"),
    "glb: header": ("m.glb", b"glTF\2\0\0\0", "m.glb: 8 bytes; the .glb is cut short"),
    "glb: version 1": ("m.glb", b"glTF\1\0\0\0" + bytes(20), "m.glb: glTF version 1, this reads version 2"),
    "glb: cut": ("m.glb", edited(lambda c: None)[:-1], "bytes; the .glb is cut short"),
    "glb: no asset": ("m.glb", edited(lambda c: c.pop("asset")), "the file: 'asset' is missing"),
    "glb: asset 1.0": ("m.glb", edited(lambda c: c["asset"].update(version="1.0")), "glTF version 1.0, this reads"),
    "glb: Draco": (
        "m.glb",
        edited(lambda c: c.update(extensionsRequired=["KHR_draco_mesh_compression"])),
        "m.glb: it needs KHR_draco_mesh_compression, which is not read; export it without",
    ),
    "glb: extension a list": (
        "m.glb",
        edited(lambda c: c.update(extensionsRequired=[["KHR"]])),
        "m.glb: it needs ['KHR'], which is not read",
    ),
    "glb: no scene": (
        "m.glb",
        edited(lambda c: c.update(scene=3)),
        "the file names number 3 of scenes",
    ),
    "glb: no mesh": ("m.glb", edited(lambda c: c["nodes"][0].update(mesh=7)), "nodes[0] names number 7 of meshes"),
    "glb: mesh a word": (
        "m.glb",
        edited(lambda c: c["nodes"][0].update(mesh="m")),
        "nodes[0] names number 'm'",
    ),
    "glb: mesh true": ("m.glb", edited(lambda c: c["nodes"][0].update(mesh=True)), "nodes[0] names number True"),
    "glb: own parent": ("m.glb", edited(lambda c: c["nodes"][0].update(children=[0])), "nodes[0] has two parents"),
    "glb: bad matrix": (
        "m.glb",
        edited(lambda c: c["nodes"][0].update(matrix=[1, 2])),
        "nodes[0]: 'matrix' has to be 16 finite numbers",
    ),
    "glb: NaN": (
        "m.glb",
        edited(lambda c: c["nodes"][0].update(translation=[float("nan")] * 3)),
        "nodes[0]: 'translation' has to be 3 finite numbers",
    ),
    "glb: far": (
        "m.glb",
        edited(lambda c: c["nodes"][0].update(scale=[1e29, 1e29, 1e29], translation=[9e29] * 3)),
        "m.glb: meshes[0] primitive 0 triangle",
    ),
    "glb: no positions": (
        "m.glb",
        edited(lambda c: primitive(c)["attributes"].pop("POSITION")),
        "meshes[0] primitive 0: it has no positions",
    ),
    "glb: accessor": (
        "m.glb",
        edited(lambda c: primitive(c).update(indices=99)),
        "meshes[0] primitive 0 indices names number 99 of accessors",
    ),
    "glb: type": ("m.glb", edited(lambda c: positions(c).update(type="VEC2")), "needs VEC3"),
    "glb: component": ("m.glb", edited(lambda c: positions(c).update(componentType=5124)), "type VEC3 of 5124"),
    "glb: count": ("m.glb", edited(lambda c: positions(c).update(count=36)), "36 elements do not fit its buffer view"),
    "glb: many": ("m.glb", edited(lambda c: positions(c).update(count=10**12)), "12000000 at most are read"),
    "glb: negative": ("m.glb", edited(lambda c: positions(c).update(count=-1)), "'count' is -1"),
    "glb: offset": ("m.glb", edited(lambda c: positions(c).update(byteOffset=8)), "do not fit its buffer view"),
    "glb: view": (
        "m.glb",
        edited(lambda c: c["bufferViews"][1].update(byteLength=10**9)),
        "bufferViews[1]: it ends at byte",
    ),
    "glb: no buffer": ("m.glb", edited(lambda c: c.update(buffers=[])), "bufferViews[1] names number 0 of buffers"),
    "glb: uri": (
        "m.glb",
        edited(lambda c: c.update(buffers=[{"byteLength": 9, "uri": "http://example.org/b.bin"}])),
        "only files beside the model are read",
    ),
    "glb: base64": (
        "m.glb",
        edited(lambda c: c.update(buffers=[{"byteLength": 9, "uri": "data:;base64,a*b"}])),
        "buffers[0]: its base64 is damaged",
    ),
    "glb: index": ("m.glb", edited(lambda c: positions(c).update(count=30)), "index"),
    "glb: uvs": (
        "m.glb",
        edited(lambda c: c["accessors"][primitive(c)["attributes"]["TEXCOORD_0"]].update(count=30)),
        "30 of TEXCOORD_0 for 35 positions",
    ),
    "glb: no triangles": ("m.glb", edited(lambda c: primitive(c).update(mode=1)), "m.glb: no triangle in its scene"),
    "glb: two corners": (
        "m.glb",
        edited(lambda c: c["accessors"][primitive(c)["indices"]].update(count=5)),
        "5 indices are no whole triangles",
    ),
    "glb: float indices": (
        "m.glb",
        edited(lambda c: c["accessors"][primitive(c)["indices"]].update(componentType=5126, count=3)),
        "its indices are no unsigned numbers",
    ),
    "glb: factor": (
        "m.glb",
        edited(lambda c: c["materials"][0]["pbrMetallicRoughness"].update(baseColorFactor=[1, 1])),
        "'baseColorFactor' has to be 4 finite numbers",
    ),
    "glb: image": ("m.glb", edited(lambda c: c["textures"][0].update(source=4)), "names number 4 of images"),
    "glb: no image": (
        "m.glb",
        edited(lambda c: c["images"][0].update(uri="absent.png")),
        "absent.png: No such file or directory",
    ),
    "glb: image damaged": (
        "m.glb",
        edited(lambda c: c["bufferViews"][0].update(byteOffset=4)),
        "m.glb: images[0]: what is embedded is no image that can be read; give a PNG or JPEG, by --texture",
    ),
    "glb: no uvs": (
        "m.glb",
        edited(lambda c: None, attributes="p"),
        "m.glb: meshes[0] primitive 0 triangle 0: a corner without texture coordinates",
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_models(tmp_path: Path, case: str) -> None:
    name, data, told = BAD[case]
    (tmp_path / name).write_bytes(data)
    output = tmp_path / "m.h"
    output.write_text("precious")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        message = refused("convert", tmp_path / name, "-o", output)
    assert told in message
    assert name in message
    assert output.read_text() == "precious"
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted([name, "m.h"])


def test_as_a_user_sees_it(edgeline: Edgeline, tmp_path: Path) -> None:
    (tmp_path / "m.ply").write_bytes(ply(MODEL, "<")[:-1])
    done = edgeline("convert", "m.ply", "-o", "m.h")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == ("edgeline: m.ply: face 47 of 48 lies beyond the end; it is cut short, export it again\n")


GOOD = {
    "m.stl": [stl_binary(MODEL), stl_ascii(MODEL)],
    "m.ply": [
        ply(MODEL, order, image, polygons)
        for order in ("", "<", ">")
        for image, polygons in ((None, True), ("x", False))
    ],
    "m.glb": [edited(lambda c: None, "ptc")],
}


def damaged(data: bytes, source: random.Random) -> bytes:
    """Cut off, overwritten, doubled or left out somewhere, or with another number in its text."""
    at = source.randrange(len(data))
    length = min(source.choice((1, 1, 2, 4, 40)), len(data) - at)
    kind = source.randrange(5)
    if kind == 0:
        return data[:at]
    if kind == 1:
        return data[:at] + source.randbytes(length) + data[at + length :]
    if kind == 2:
        return data[:at] + data[at : at + length] + data[at:]
    if kind == 3:
        return data[:at] + data[at + length :]
    digits = [i for i, byte in enumerate(data[:4000]) if chr(byte).isdigit()]
    i = source.choice(digits)
    return data[:i] + source.choice((b"-1", b"99999999", b"1e99", b"null", b"[]", b'"x"')) + data[i + 1 :]


@pytest.mark.parametrize("name", GOOD)
def test_damaged_files_are_read_or_refused(tmp_path: Path, name: str) -> None:
    source = random.Random(name)
    path = tmp_path / name
    outcomes = {"read": 0, "refused": 0}
    for _ in range(600):
        path.write_bytes(damaged(source.choice(GOOD[name]), source))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            try:
                found = read_source(path)
            except EdgelineError as error:
                outcomes["refused"] += 1
                assert "\n" not in str(error) and name in str(error)
                continue
        outcomes["read"] += 1
        assert np.isfinite(found.positions).all()
        assert len(found.part_of) == len(found.positions) > 0
        assert name in found.where(len(found.positions) - 1)
    assert min(outcomes.values()) > 20, outcomes


def test_every_cut_of_a_text_is_noticed(tmp_path: Path) -> None:
    """A text that ends early is never taken for a smaller model."""
    for name, data in (("m.stl", stl_ascii(MODEL)), ("m.ply", ply(MODEL, ""))):
        lines = data.splitlines(keepends=True)
        for count in range(len(lines)):
            (tmp_path / name).write_bytes(b"".join(lines[:count]))
            with pytest.raises(EdgelineError):
                read_source(tmp_path / name)


def test_json_numbers_of_any_size(tmp_path: Path) -> None:
    gltf = Gltf()
    gltf.node(gltf.primitive(MODEL), translation=[10**400, 0, 0])
    (tmp_path / "m.gltf").write_bytes(gltf.gltf())
    with pytest.raises(EdgelineError, match="finite numbers"):
        read_source(tmp_path / "m.gltf")
