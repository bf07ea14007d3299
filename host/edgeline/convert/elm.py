""".elm files: the firmware's mesh in one block of bytes. `geometry/elm.h` is the format's description.

No files are opened here: `encode` makes bytes, `decode` takes them and refuses what the firmware's reader refuses.
"""

from __future__ import annotations

import struct
import zlib
from typing import Any

import numpy as np
import numpy.typing as npt

from edgeline.convert.mesh import CLUSTER, MAX_TEXTURE_LOG2, Mesh, Texture
from edgeline.errors import EdgelineError

MAGIC = b"ELM\x1a"
MAJOR, MINOR = 1, 1
PREFIX = struct.Struct("<4sHHII")
"""Magic, version, size, CRC-32 of all that follows."""
FIELDS = struct.Struct("<HHbBBB3hH")
HEADER_BYTES = PREFIX.size + FIELDS.size

COLOURS, TRIANGLE_COLOURS, NORMALS, UVS, TEXTURE, CLUSTERS = 1, 2, 4, 8, 16, 32
COUNT = struct.Struct("<I")
"""Before the clusters: how many."""


def padded(data: bytes) -> bytes:
    return data + bytes(-len(data) % 4)


def encode(mesh: Mesh, texture: Texture | None = None) -> bytes:
    """The file's bytes. Raises EdgelineError for a texture without texture coordinates."""
    if texture is not None and mesh.uvs is None:
        raise EdgelineError("an .elm with a texture needs texture coordinates in its mesh")
    content = 0
    sections: list[npt.NDArray[np.generic]] = [mesh.positions, mesh.triangles]
    for bit, array in (
        (COLOURS, mesh.colours),
        (TRIANGLE_COLOURS, mesh.triangle_colours),
        (NORMALS, mesh.normals),
        (UVS, mesh.uvs),
        (TEXTURE, None if texture is None else texture.texels),
    ):
        if array is not None:
            content |= bit
            sections.append(array)
    clusters = b""
    if mesh.clusters is not None:
        content |= CLUSTERS
        clusters = padded(COUNT.pack(len(mesh.clusters)) + mesh.clusters.tobytes())
    fields = FIELDS.pack(
        len(mesh.positions),
        len(mesh.triangles),
        mesh.scale_log2,
        content,
        0 if texture is None else texture.width_log2,
        0 if texture is None else texture.height_log2,
        *mesh.centre,
        mesh.radius,
    )
    rest = fields + b"".join(padded(s.astype(s.dtype.newbyteorder("<")).tobytes()) for s in sections)
    rest += clusters
    return PREFIX.pack(MAGIC, MAJOR, MINOR, PREFIX.size + len(rest), zlib.crc32(rest)) + rest


def decode(data: bytes) -> tuple[Mesh, Texture | None]:
    """The mesh and the texture in `data`. Raises EdgelineError with one line that says what is wrong."""
    if data[:4] != MAGIC:
        raise EdgelineError("not an .elm mesh; make one with: edgeline convert model.obj -o model.elm")
    if len(data) < HEADER_BYTES:
        raise EdgelineError(f"the .elm is cut short: {len(data)} bytes, its header alone has {HEADER_BYTES}")
    _, major, minor, size, crc = PREFIX.unpack_from(data)
    if major != MAJOR:
        raise EdgelineError(f"the .elm has version {major}.{minor}, this Edgeline reads {MAJOR}.x; update Edgeline")
    if size > len(data):
        raise EdgelineError(f"the .elm is cut short: {len(data)} of {size} bytes; copy it again")
    if size != len(data) or zlib.crc32(data[PREFIX.size :]) != crc:
        raise EdgelineError("the .elm is damaged: its size or checksum does not agree; copy it again")
    vertices, triangles, scale_log2, content, width_log2, height_log2, cx, cy, cz, radius = FIELDS.unpack_from(
        data, PREFIX.size
    )
    has_texture = bool(content & TEXTURE)
    side_limit_log2 = MAX_TEXTURE_LOG2 if has_texture else 0
    if content > 63 or (has_texture and not content & UVS) or max(width_log2, height_log2) > side_limit_log2:
        raise EdgelineError("the .elm is damaged: its header contradicts itself; convert the model again")
    layout = [
        ("positions", "<i2", (vertices, 3), True),
        ("triangles", "<u2", (triangles, 3), True),
        ("colours", "u1", (vertices, 3), content & COLOURS),
        ("triangle_colours", "u1", (triangles, 3), content & TRIANGLE_COLOURS),
        ("normals", "i1", (vertices, 3), content & NORMALS),
        ("uvs", "<i2", (vertices, 2), content & UVS),
        ("texels", "<u2", (1 << height_log2, 1 << width_log2), has_texture),
    ]
    arrays: dict[str, npt.NDArray[Any]] = {}
    offset = HEADER_BYTES
    for name, dtype, shape, present in layout:
        if not present:
            continue
        end = offset + shape[0] * shape[1] * np.dtype(dtype).itemsize
        following = end + -end % 4
        if following > size or any(data[end:following]):
            raise EdgelineError("the .elm is damaged: its counts do not agree with its size; convert the model again")
        view = np.frombuffer(data[offset:end], dtype).reshape(shape)
        arrays[name] = view.astype(view.dtype.newbyteorder("="))
        offset = following
    clusters = None
    if content & CLUSTERS:
        clusters, offset = _clusters(data, offset)
    if offset != size:
        raise EdgelineError("the .elm is damaged: its counts do not agree with its size; convert the model again")
    texels = arrays.pop("texels", None)
    mesh = Mesh(**arrays, scale_log2=scale_log2, centre=(cx, cy, cz), radius=radius, clusters=clusters)
    return mesh, None if texels is None else Texture(texels)


def _clusters(data: bytes, offset: int) -> tuple[npt.NDArray[np.void] | None, int]:
    """The clusters whose number lies at `offset`, None where it is 0, and the offset behind their padding."""
    count = COUNT.unpack_from(data, offset)[0] if offset + COUNT.size <= len(data) else 0
    end = offset + COUNT.size + count * CLUSTER.itemsize
    following = end + -end % 4
    if following > len(data) or any(data[end:following]):
        raise EdgelineError("the .elm is damaged: its counts do not agree with its size; convert the model again")
    return (np.frombuffer(data[offset + COUNT.size : end], CLUSTER) if count else None), following
