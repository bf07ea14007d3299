"""Models for the converter's tests, written byte by byte: a ring with colours or texture coordinates in each format."""

from __future__ import annotations

import base64
import io
import json
import struct
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import Image

Array = npt.NDArray[Any]
KINDS = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126}
SHAPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


@dataclass(frozen=True)
class Ring:
    """A torus around the y axis, its seams doubled as texture coordinates need it."""

    positions: Array
    triangles: Array
    uvs: Array
    colours: Array


def ring(around: int = 24, across: int = 12) -> Ring:
    u, v = np.meshgrid(np.arange(around + 1), np.arange(across + 1), indexing="ij")
    # Whole turns end where they began, to the last bit.
    a, b = 2 * np.pi * (u % around) / around, 2 * np.pi * (v % across) / across
    out = 1.0 + 0.4 * np.cos(b)
    positions = np.stack([out * np.sin(a), 0.4 * np.sin(b), out * np.cos(a)], axis=2).reshape(-1, 3)
    i, k = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    p = (i * (across + 1) + k).reshape(-1)
    q = p + across + 1
    triangles = np.stack([p, q, q + 1, p, q + 1, p + 1], axis=1).reshape(-1, 3)
    colours = np.rint(np.clip((positions / 1.4 + 1) / 2, 0, 1) * 255).astype(np.uint8)
    uvs = np.stack([4 * u / around, v / across], axis=2).reshape(-1, 2)
    return Ring(positions.astype(np.float32), triangles, uvs.astype(np.float32), colours)


def checks(dark: tuple[int, int, int] = (200, 40, 20), light: tuple[int, int, int] = (250, 240, 200)) -> bytes:
    """A PNG of 16 x 16 with 4 x 4 fields."""
    fields = (np.add.outer(np.arange(16) // 4, np.arange(16) // 4) % 2)[:, :, None]
    pixels = np.where(fields == 0, np.array(dark), np.array(light)).astype(np.uint8)
    file = io.BytesIO()
    Image.fromarray(pixels).save(file, "PNG")
    return file.getvalue()


# --- STL and PLY ------------------------------------------------------------------------------------------------------


def stl_binary(model: Ring) -> bytes:
    rows = np.zeros(len(model.triangles), np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")]))
    rows["corners"] = model.positions[model.triangles]
    return b"made by a test".ljust(80) + struct.pack("<I", len(rows)) + rows.tobytes()


def stl_ascii(model: Ring) -> bytes:
    lines = ["solid ring"]
    for corners in model.positions[model.triangles].tolist():
        lines += ["facet normal 0 0 0", " outer loop", *(f"  vertex {x!r} {y!r} {z!r}" for x, y, z in corners)]
        lines += [" endloop", "endfacet"]
    return "\n".join([*lines, "endsolid ring", ""]).encode()


def ply(model: Ring, order: str, image: str | None = None, polygons: bool = False) -> bytes:
    """`order` "", "<" or ">"; texture coordinates with an image, colours without; two triangles as a quad if asked."""
    kind = {"": "ascii", "<": "binary_little_endian", ">": "binary_big_endian"}[order]
    faces: list[list[int]] = model.triangles.tolist()
    if polygons:
        faces = [[a[0], a[1], a[2], b[2]] for a, b in zip(faces[::2], faces[1::2], strict=True)]
    head = ["ply", f"format {kind} 1.0", "comment made by a test", *([f"comment TextureFile {image}"] if image else [])]
    head += [f"element vertex {len(model.positions)}", *(f"property float {axis}" for axis in "xyz")]
    head += (
        [f"property float {c}" for c in "st"] if image else [f"property uchar {c}" for c in ("red", "green", "blue")]
    )
    head += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header", ""]
    rest: Array = model.uvs if image else model.colours
    text = "\n".join(head).encode()
    if not order:
        rows = [" ".join(map(repr, [*p, *c])) for p, c in zip(model.positions.tolist(), rest.tolist(), strict=True)]
        return text + "\n".join([*rows, *(" ".join(map(str, [len(f), *f])) for f in faces), ""]).encode()
    mark = "2f" if image else "3B"
    vertices = b"".join(
        struct.pack(f"{order}3f{mark}", *p, *c) for p, c in zip(model.positions.tolist(), rest.tolist(), strict=True)
    )
    return text + vertices + b"".join(struct.pack(f"{order}B{len(f)}i", len(f), *f) for f in faces)


# --- glTF -------------------------------------------------------------------------------------------------------------


@dataclass
class Gltf:
    """A glTF under construction. `json` may be changed before it is written."""

    json: dict[str, Any] = field(default_factory=lambda: {"asset": {"version": "2.0"}, "scene": 0})
    chunk: bytearray = field(default_factory=bytearray)

    def add(self, array: str, item: object) -> int:
        """Gives the item's number."""
        self.json.setdefault(array, []).append(item)
        return len(self.json[array]) - 1

    def view(self, data: bytes, **more: object) -> int:
        self.chunk += bytes(-len(self.chunk) % 4)
        begin = len(self.chunk)
        self.chunk += data
        return self.add("bufferViews", {"buffer": 0, "byteOffset": begin, "byteLength": len(data), **more})

    def accessor(self, array: Array, kind: str, **more: object) -> int:
        rows = array.reshape(len(array), -1).astype(f"<{kind}")
        shape = {"componentType": KINDS[kind], "type": SHAPES[rows.shape[1]], "count": len(rows)}
        return self.add("accessors", {"bufferView": self.view(rows.tobytes()), **shape, **more})

    def material(self, factor: list[float] | None = None, image: object = None, **more: object) -> int:
        surface: dict[str, object] = {} if factor is None else {"baseColorFactor": factor}
        if image is not None:
            texture = self.add("textures", {"source": self.add("images", image)})
            surface["baseColorTexture"] = {"index": texture}
        return self.add(
            "materials",
            {"name": f"paint {len(self.json.get('materials', []))}", **more}
            | ({"pbrMetallicRoughness": surface} if surface else {}),
        )

    def primitive(
        self, model: Ring, indices: str | None = "u2", attributes: str = "p", **more: object
    ) -> dict[str, Any]:
        """`attributes`: p positions, t texture coordinates, c colours. Without indices every corner is a vertex."""
        pick: Any = slice(None) if indices else model.triangles.reshape(-1)
        found: dict[str, object] = {"POSITION": self.accessor(model.positions[pick], "f4")}
        if "t" in attributes:
            found["TEXCOORD_0"] = self.accessor(model.uvs[pick], "f4")
        if "c" in attributes:
            found["COLOR_0"] = self.accessor(model.colours[pick], "u1", normalized=True)
        if indices:
            more["indices"] = self.accessor(model.triangles.reshape(-1), indices)
        return {"attributes": found, **more}

    def node(self, *primitives: dict[str, Any], **more: object) -> int:
        return self.add("nodes", {"mesh": self.add("meshes", {"primitives": list(primitives)}), **more})

    def finished(self, roots: list[int] | None = None) -> dict[str, Any]:
        nodes = list(range(len(self.json.get("nodes", [])))) if roots is None else roots
        return self.json | {"scenes": [{"nodes": nodes}]}

    def glb(self, roots: list[int] | None = None) -> bytes:
        content = self.finished(roots)
        if self.chunk:
            content = {"buffers": [{"byteLength": len(self.chunk)}], **content}
        text = json.dumps(content).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text
        if self.chunk:
            data = bytes(self.chunk) + bytes(-len(self.chunk) % 4)
            chunks += struct.pack("<I4s", len(data), b"BIN\0") + data
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks

    def gltf(self, uri: str | None = None) -> bytes:
        """With its buffer inside, or in the file `uri` beside it."""
        inside = "data:application/octet-stream;base64," + base64.b64encode(bytes(self.chunk)).decode()
        buffers = [{"byteLength": len(self.chunk), "uri": uri or inside}]
        return json.dumps(self.finished() | {"buffers": buffers}).encode()
