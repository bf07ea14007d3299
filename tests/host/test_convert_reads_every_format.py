"""STL, PLY and glTF say the same triangles however they are written, and the same as a well-kept library reads."""

from __future__ import annotations

import base64
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from converting import convert, library
from edgeline.convert import elm
from edgeline.convert.palette import rgb565
from edgeline.convert.pipeline import read_source
from edgeline.convert.source import Source, placed
from edgeline.convert.texture import decoded, encoded
from models import Gltf, checks, ply, ring, stl_ascii, stl_binary

MODEL = ring()
CORNERS = MODEL.positions[MODEL.triangles].astype(np.float64)

Read = Callable[[str, bytes], Source]


@pytest.fixture
def read(tmp_path: Path) -> Read:
    def run(name: str, data: bytes) -> Source:
        (tmp_path / name).write_bytes(data)
        return read_source(tmp_path / name)

    return run


def simple(indices: str | None = "u2", attributes: str = "p", **more: object) -> Gltf:
    gltf = Gltf()
    gltf.node(gltf.primitive(MODEL, indices, attributes), **more)
    return gltf


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("ring.stl", stl_binary(MODEL)),
        ("ring.stl", stl_ascii(MODEL)),
        ("ring.stl", stl_ascii(MODEL).upper().replace(b"\n", b"\r\n")),
        ("ring.stl", b"solid of a binary file".ljust(80) + stl_binary(MODEL)[80:]),
        *(("ring.ply", ply(MODEL, order)) for order in ("", "<", ">")),
        ("ring.ply", ply(MODEL, "").replace(b"\n", b"\r\n")),
        *(("ring.glb", simple(indices).glb()) for indices in ("u2", "u4", None)),
        ("ring.gltf", simple().gltf()),
    ],
)
def test_the_same_triangles_in_every_format(read: Read, name: str, data: bytes) -> None:
    source = read(name, data)
    np.testing.assert_array_equal(source.positions, CORNERS)
    assert len(source.parts) == 1


@pytest.mark.parametrize("order", ["", "<", ">"])
def test_ply_with_polygons_colours_and_texture(read: Read, tmp_path: Path, order: str) -> None:
    quads = read("ring.ply", ply(MODEL, order, polygons=True))
    assert len(quads.positions) == len(CORNERS)
    assert quads.colours is not None
    at = {tuple(p): tuple(c) for p, c in zip(MODEL.positions.tolist(), MODEL.colours.tolist(), strict=True)}
    for position, colour in zip(quads.positions.reshape(-1, 3), quads.colours.reshape(-1, 3), strict=True):
        assert at[tuple(position.tolist())] == tuple(colour.tolist())
    source = read("ring.ply", ply(MODEL, order, image="fields.png"))
    assert source.uvs is not None
    np.testing.assert_allclose(source.uvs[..., 1], 1.0 - MODEL.uvs[MODEL.triangles][..., 1])
    assert source.parts[0].picture is not None
    assert source.parts[0].picture.image == tmp_path / "fields.png"


def test_ply_of_mixed_polygons_and_other_elements(read: Read) -> None:
    text = (
        "ply\nformat ascii 1.0\nelement camera 1\nproperty float f\nelement vertex 5\nproperty double x\n"
        "property double y\nproperty double z\nelement nothing 0\nproperty int i\nelement face 2\n"
        "property list uchar int vertex_index\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
        "property list uchar float texcoord\nelement edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n"
        "1.5\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 0.5 0\n\n"
        "4 0 1 2 3 255 0 128 8 0 0 1 0 1 1 0 1\n3 1 4 2 1 1 1 6 0 0 1 0.25 1 1\n0 1\n"
    )
    source = read("m.ply", text.encode())
    assert source.positions.shape == (3, 3, 3)
    assert source.triangle_colours is not None and source.uvs is not None
    assert source.triangle_colours.tolist() == [[255, 0, 128], [255, 0, 128], [1, 1, 1]]
    assert source.uvs[2].tolist() == [[0, 1], [1, 0.75], [1, 0]]
    assert source.where(2) == "m.ply: face 1"


def test_floating_point_colours_of_ply_are_fractions(read: Read) -> None:
    head = "ply\nformat ascii 1.0\nelement vertex 3\n" + "".join(
        f"property float {name}\n" for name in ("x", "y", "z", "red", "green", "blue")
    )
    head += "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    source = read("m.ply", (head + "0 0 0 1 0.5 0\n1 0 0 0 0 0\n0 1 0 0 1 0\n3 0 1 2\n").encode())
    assert source.colours is not None
    assert source.colours[0, 0].tolist() == [255, 128, 0]


def test_nodes_put_their_meshes_in_place(read: Read) -> None:
    gltf = simple()
    mesh = {"mesh": 0}
    half = math.sqrt(0.5)
    child = gltf.add("nodes", {**mesh, "translation": [1, 2, 3]})
    parent = gltf.add("nodes", {"children": [child], "rotation": [0, 0, half, half], "scale": [2, 2, 2]})
    mirrored = gltf.add("nodes", {**mesh, "matrix": [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1]})
    source = read("m.glb", gltf.glb([0, parent, mirrored]))
    first, second, third = np.split(source.positions, 3)
    np.testing.assert_array_equal(first, CORNERS)
    x, y, z = np.moveaxis(CORNERS + np.array([1, 2, 3]), -1, 0)
    np.testing.assert_allclose(second, 2 * np.stack([-y, x, z], axis=-1), atol=1e-12)
    np.testing.assert_array_equal(third, (CORNERS * [-1, 1, 1] + np.array([0, 0, 5]))[:, ::-1])
    assert source.where(len(CORNERS) + 1) == "m.glb: meshes[0] primitive 0 triangle 1"


@pytest.mark.parametrize("scale", [[1, 1, 1], [3, 1, 0.5], [-1, 1, 1], [-1, -1, -1], [-2, -1, 1], [1, -4, 2]])
def test_normals_stay_with_their_triangles_in_turned_stretched_and_mirrored_nodes(
    read: Read, scale: list[float]
) -> None:
    corners = np.array([(0, 0, 0), (2, 0, 1), (0, 1, 1)])
    normal = np.cross(corners[1], corners[2])
    gltf = Gltf()
    attributes = {"POSITION": gltf.accessor(corners, "f4"), "NORMAL": gltf.accessor(np.tile(normal, (3, 1)), "f4")}
    gltf.node({"attributes": attributes}, scale=scale, rotation=[0.5, 0.1, 0.7, 0.5])
    source = read("m.glb", gltf.glb())
    assert source.normals is not None
    a, b, c = source.positions[0]
    faces = np.cross(b - a, c - a)
    for turned in source.normals[0]:
        np.testing.assert_allclose(turned / np.linalg.norm(turned), faces / np.linalg.norm(faces), atol=1e-6)


def test_strips_fans_and_sparse_accessors(read: Read) -> None:
    points = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (0, 2, 0)], dtype=np.float32)
    gltf = Gltf()
    position = gltf.accessor(points, "f4")
    for mode in (5, 6):
        gltf.node({"attributes": {"POSITION": position}, "mode": mode})
    replaced = gltf.add(
        "accessors",
        {
            **{"componentType": 5126, "type": "VEC3", "count": 3},
            "sparse": {
                "count": 2,
                "indices": {"bufferView": gltf.view(bytes([1, 2])), "componentType": 5121},
                "values": {"bufferView": gltf.view(points[[1, 2]].tobytes())},
            },
        },
    )
    gltf.node({"attributes": {"POSITION": replaced}})
    found = read("m.glb", gltf.glb()).positions
    expected = [(0, 1, 2), (1, 3, 2), (2, 3, 4), (0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 1, 2)]
    np.testing.assert_array_equal(found, points[np.array(expected)])


def test_interleaved_and_normalised_attributes(read: Read) -> None:
    gltf = Gltf()
    rows = np.zeros(3, np.dtype([("p", "<i2", 3), ("pad", "<i2"), ("uv", "<u2", 2)]))
    rows["p"] = [(0, 0, 0), (32767, 0, 0), (0, -32767, -32768)]
    rows["uv"] = [(0, 0), (65535, 0), (0, 65535)]
    view = gltf.view(rows.tobytes(), byteStride=12)
    shape = {"bufferView": view, "count": 3, "normalized": True}
    position = gltf.add("accessors", {**shape, "componentType": 5122, "type": "VEC3"})
    uv = gltf.add("accessors", {**shape, "componentType": 5123, "type": "VEC2", "byteOffset": 8})
    gltf.json["extensionsRequired"] = ["KHR_mesh_quantization"]
    image = {"bufferView": gltf.view(checks()), "mimeType": "image/png"}
    gltf.node({"attributes": {"POSITION": position, "TEXCOORD_0": uv}, "material": gltf.material(image=image)})
    source = read("m.glb", gltf.glb())
    assert source.positions.tolist() == [[[0, 0, 0], [1, 0, 0], [0, -1, -1]]]
    assert source.uvs is not None and source.uvs.tolist() == [[[0, 0], [1, 0], [0, 1]]]


def test_colours_are_encoded_for_the_display(read: Read) -> None:
    gltf = Gltf()
    paint = gltf.material([0.5, 0.0, 1.0, 1.0])
    gltf.node(gltf.primitive(MODEL, material=paint))
    plain = read("m.glb", gltf.glb())
    assert plain.triangle_colours is not None
    assert {tuple(c) for c in plain.triangle_colours.tolist()} == {(188, 0, 255)}
    gltf.node(gltf.primitive(MODEL, attributes="pc", material=paint))
    both = read("m.glb", gltf.glb())
    assert both.triangle_colours is None and both.colours is not None
    assert {tuple(c) for c in both.colours[: len(CORNERS)].reshape(-1, 3).tolist()} == {(188, 0, 255)}
    linear = MODEL.colours[MODEL.triangles] / 255 * [0.5, 0.0, 1.0]
    np.testing.assert_array_equal(both.colours[len(CORNERS) :], np.rint(encoded(linear) * 255))


def test_srgb_turns_back() -> None:
    levels = np.arange(256) / 255
    np.testing.assert_allclose(encoded(decoded(levels)), levels, atol=1e-12)


@pytest.mark.parametrize("kind", ["embedded", "data uri", "beside"])
def test_images_embedded_and_beside(read: Read, tmp_path: Path, kind: str) -> None:
    gltf = Gltf()
    image: dict[str, object] = {"uri": "my%20fields.png"}
    (tmp_path / "my fields.png").write_bytes(checks())
    if kind == "embedded":
        image = {"bufferView": gltf.view(checks()), "mimeType": "image/png"}
    elif kind == "data uri":
        image = {"uri": "data:image/png;base64," + base64.b64encode(checks()).decode()}
    paint = gltf.material([0.5, 1.0, 1.0, 1.0], image)
    gltf.node(gltf.primitive(MODEL, attributes="pt", material=paint))
    (tmp_path / "ring.bin").write_bytes(bytes(gltf.chunk))
    (tmp_path / "ring.gltf").write_bytes(gltf.gltf("ring.bin"))
    assert convert(tmp_path / "ring.gltf", "-o", tmp_path / "ring.elm", "--texture-size", 16) == 0
    mesh, texture = elm.decode((tmp_path / "ring.elm").read_bytes())
    assert texture is not None and mesh.uvs is not None
    dark = rgb565(np.array([[round(float(encoded(decoded(np.array(200 / 255)) * 0.5)) * 255), 40, 20]], np.uint8))
    assert texture.texels[0, 0] == dark[0]
    np.testing.assert_array_equal(np.unique(mesh.uvs[:, 1]), np.unique(np.rint(MODEL.uvs[:, 1] * 16 * 16)))


def test_texture_transforms_are_applied(read: Read) -> None:
    gltf = Gltf()
    paint = gltf.material(image={"bufferView": gltf.view(checks()), "mimeType": "image/png"})
    used = gltf.json["materials"][paint]["pbrMetallicRoughness"]["baseColorTexture"]
    moved = {"offset": [0.5, 0.25], "rotation": math.pi / 2, "scale": [2, 1]}
    used["extensions"] = {"KHR_texture_transform": moved}
    gltf.json["extensionsRequired"] = ["KHR_texture_transform"]
    gltf.node(gltf.primitive(MODEL, attributes="pt", material=paint))
    source = read("m.glb", gltf.glb())
    u, v = np.moveaxis(MODEL.uvs[MODEL.triangles].astype(np.float64), -1, 0)
    # Its matrix: translation * rotation * scale, rotation counter-clockwise in a space whose v points down.
    assert source.uvs is not None
    np.testing.assert_allclose(source.uvs, np.stack([v + 0.5, -2 * u + 0.25], axis=-1), atol=1e-12)


def test_what_is_left_out_is_named(read: Read) -> None:
    gltf = Gltf()
    points = gltf.accessor(MODEL.positions, "f4")
    see_through = gltf.material(alphaMode="BLEND", doubleSided=True, emissiveFactor=[0, 0.5, 0])
    target = {"targets": [{"POSITION": points}], "material": see_through}
    gltf.node({"attributes": {"POSITION": points}, "mode": 0}, gltf.primitive(MODEL, **target), skin=0)
    gltf.json |= {"skins": [{"joints": [0]}], "animations": [{}]}
    told = " / ".join(read("m.glb", gltf.glb()).notes)
    for word in ("points or lines", "morph targets", "skin", "animations", "paint 0: its glow"):
        assert word in told


def test_up_scale_and_centre(read: Read) -> None:
    source = placed(read("ring.stl", stl_binary(MODEL)), "z", 2.0, True)
    x, y, z = np.moveaxis(CORNERS - (CORNERS.min(axis=(0, 1)) + CORNERS.max(axis=(0, 1))) / 2, -1, 0)
    np.testing.assert_allclose(source.positions, 2 * np.stack([x, z, -y], axis=-1), atol=1e-6)


# --- As a library reads and writes them -------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["stl", "stl_ascii", "ply", "ply ascii", "glb", "gltf", "obj"])
def test_files_of_trimesh_are_read_as_it_reads_them(tmp_path: Path, kind: str) -> None:
    trimesh = library("trimesh")
    mesh = trimesh.Trimesh(MODEL.positions, MODEL.triangles, process=False, vertex_colors=MODEL.colours)
    suffix, _, encoding = kind.partition(" ")
    path = tmp_path / f"ring.{suffix.removesuffix('_ascii')}"
    if suffix == "gltf":
        for name, data in trimesh.exchange.gltf.export_gltf(mesh.scene()).items():
            (tmp_path / (path.name if name == "model.gltf" else name)).write_bytes(data)
    else:
        more = {"encoding": encoding} if encoding else {}
        mesh.export(path, file_type=suffix, **more)
    theirs = trimesh.load_mesh(path, process=False)
    source = read_source(path)
    np.testing.assert_allclose(source.positions, theirs.vertices[theirs.faces], rtol=1e-6, atol=1e-6)
    assert (source.colours is None) == (suffix.removesuffix("_ascii") == "stl")


def test_scenes_of_trimesh_are_read_as_it_reads_them(tmp_path: Path) -> None:
    trimesh = library("trimesh")
    numbers = np.random.default_rng(5)
    scene = trimesh.Scene()
    for i in range(5):
        mesh = trimesh.creation.box(numbers.uniform(0.1, 2, 3))
        mesh.apply_transform(np.diag([*numbers.choice([-1.0, 1.0], 3), 1.0]))
        matrix = trimesh.transformations.random_rotation_matrix(numbers.random(3))
        matrix[:3, :3] *= numbers.uniform(0.2, 3)
        matrix[:3, 3] = numbers.uniform(-5, 5, 3)
        scene.add_geometry(mesh, node_name=f"n{i}", transform=matrix, parent_node_name=f"n{i - 1}" if i else None)
    scene.export(tmp_path / "m.glb")
    theirs = trimesh.load_scene(tmp_path / "m.glb", process=False).to_mesh()
    mine = read_source(tmp_path / "m.glb").positions
    expected = np.asarray(theirs.vertices)[theirs.faces]
    middles = [p.mean(axis=1) for p in (mine, expected)]
    order = [np.lexsort(np.round(m, 5).T) for m in middles]
    np.testing.assert_allclose(mine[order[0]].mean(axis=1), expected[order[1]].mean(axis=1), atol=1e-5)
