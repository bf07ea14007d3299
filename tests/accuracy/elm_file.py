"""A reader and a writer of .elm files, after geometry/elm.h; nothing in them is the firmware's or the converter's."""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

VERTEX_COLOURS, TRIANGLE_COLOURS, NORMALS, TEXTURE_COORDINATES, TEXTURE, CLUSTERS = 1, 2, 4, 8, 16, 32
CLUSTER_BYTES = 18


@dataclass(frozen=True)
class ElmMesh:
    """positions (n, 3) in units of 2^scale_log2, triangles (m, 3), uvs (n, 2) in texels 12.4, texels (v, u)."""

    positions: npt.NDArray[np.int64]
    triangles: npt.NDArray[np.int64]
    scale_log2: int
    centre: npt.NDArray[np.int64]
    radius: int
    uvs: npt.NDArray[np.int64] | None
    texels: npt.NDArray[np.uint16] | None


def write_elm(path: Path, mesh: ElmMesh) -> None:
    """Writes positions, triangles and, where both are there, texture coordinates and texels."""
    textured = mesh.uvs is not None and mesh.texels is not None
    sections = [mesh.positions.astype("<i2"), mesh.triangles.astype("<u2")]
    logarithms = [0, 0]
    if mesh.uvs is not None and mesh.texels is not None:
        sections += [mesh.uvs.astype("<i2"), mesh.texels.astype("<u2")]
        logarithms = [size.bit_length() - 1 for size in mesh.texels.shape[::-1]]
    head = struct.pack(
        "<HHbBBB3hH",
        len(mesh.positions),
        len(mesh.triangles),
        mesh.scale_log2,
        (TEXTURE_COORDINATES | TEXTURE) if textured else 0,
        *logarithms,
        *mesh.centre.tolist(),
        mesh.radius,
    )
    body = head + b"".join(part.tobytes() + bytes(-part.nbytes % 4) for part in sections)
    path.write_bytes(struct.pack("<4sHHII", b"ELM\x1a", 1, 0, 16 + len(body), zlib.crc32(body)) + body)


def read_elm(path: Path) -> ElmMesh:
    """Reads a file that is right; AssertionError where it is not."""
    data = path.read_bytes()
    magic, major, _, size, crc, vertices, triangles, scale_log2, content, *rest = struct.unpack_from(
        "<4sHHIIHHbBBB3hH", data
    )
    width_log2, height_log2, *centre, radius = rest
    assert (magic, major, size, crc) == (b"ELM\x1a", 1, len(data), zlib.crc32(data[16:]))
    at = 32

    def take(wanted: bool, kind: str, rows: int, columns: int) -> npt.NDArray[np.int64]:
        nonlocal at
        if not wanted:
            return np.zeros((0, columns), np.int64)
        table = np.frombuffer(data, kind, rows * columns, at).reshape(rows, columns).astype(np.int64)
        at += -(-rows * columns * np.dtype(kind).itemsize // 4) * 4
        return table

    positions = take(True, "<i2", vertices, 3)
    indices = take(True, "<u2", triangles, 3)
    take(bool(content & VERTEX_COLOURS), "u1", vertices, 3)
    take(bool(content & TRIANGLE_COLOURS), "u1", triangles, 3)
    take(bool(content & NORMALS), "i1", vertices, 3)
    uvs = take(bool(content & TEXTURE_COORDINATES), "<i2", vertices, 2)
    texels = take(bool(content & TEXTURE), "<u2", 1 << height_log2, 1 << width_log2)
    if content & CLUSTERS:  # how many, and what nothing here needs
        (clusters,) = struct.unpack_from("<I", data, at)
        at += 4
        take(True, "u1", clusters, CLUSTER_BYTES)
    assert at == len(data), f"{len(data) - at} bytes after the last section"
    return ElmMesh(
        positions,
        indices,
        scale_log2,
        np.array(centre),
        radius,
        uvs if content & TEXTURE_COORDINATES else None,
        texels.astype(np.uint16) if content & TEXTURE else None,
    )
