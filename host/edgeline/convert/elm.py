""".elm files: the firmware's mesh in one block of bytes. `geometry/elm.h` is the format's description.

No files are opened here: `encode` makes bytes, `decode` takes them and refuses what the firmware's reader refuses. What
version 1 can hold is written as that, so that older readers know it; else there is a surface, and version 2.
"""

from __future__ import annotations

import struct
import zlib
from typing import Any

import numpy as np
import numpy.typing as npt

from edgeline.convert.header import Look
from edgeline.convert.mesh import CLUSTER, Mesh
from edgeline.convert.texels import MAX_TEXTURE_LOG2, Format, Texture, Wrap, linked
from edgeline.errors import EdgelineError

MAGIC = b"ELM\x1a"
MAJOR, MINOR = 1, 1
MAJOR_SURFACE, MINOR_SURFACE = 2, 0
PREFIX = struct.Struct("<4sHHII")
"""Magic, version, size, CRC-32 of all that follows."""
FIELDS = struct.Struct("<HHbBBB3hH")
HEADER_BYTES = PREFIX.size + FIELDS.size

COLOURS, TRIANGLE_COLOURS, NORMALS, UVS, TEXTURE, CLUSTERS, SURFACE = 1, 2, 4, 8, 16, 32, 64
COUNT = struct.Struct("<I")
"""Before the clusters: how many."""
HEAD = struct.Struct("<BBBBBBBBHH")
"""Of a surface: flags, alpha, format, levels, wrap_u, wrap_v, bits, 0, key, 0."""
SMOOTH, HAS_KEY, HAS_ALPHA = 1, 2, 4
INCONSISTENT = "the .elm is damaged: its counts do not agree with its size; convert the model again"


def padded(data: bytes) -> bytes:
    return data + bytes(-len(data) % 4)


def surface_bytes(texture: Texture | None, look: Look) -> bytes:
    """The section that says what a material is like, with its picture."""
    if texture is None:
        return HEAD.pack(int(look.two_sided), look.opacity, 0, 0, 0, 0, 0, 0, 0, 0)
    bits = SMOOTH * texture.smooth + HAS_KEY * (texture.key is not None) + HAS_ALPHA * (texture.alpha is not None)
    levels = [*texture.levels()]
    head = HEAD.pack(
        *(int(look.two_sided), look.opacity, texture.format, len(levels)),
        *(*texture.wrap, bits, 0, texture.key or 0, 0),
    )
    rest = padded(texture.palette.astype("<u2").tobytes())
    for level in levels:
        texels = level.packed()
        rest += padded(texels.astype(texels.dtype.newbyteorder("<")).tobytes())
        if level.alpha is not None:
            rest += padded(level.alpha.tobytes())
    return head + rest


def encode(mesh: Mesh, texture: Texture | None = None, look: Look | None = None) -> bytes:
    """The file's bytes. Raises EdgelineError for a texture without texture coordinates."""
    look = look or Look()
    has_surface = look != Look() or (texture is not None and not texture.is_plain)
    if texture is not None and mesh.uvs is None:
        raise EdgelineError("an .elm with a texture needs texture coordinates in its mesh")
    content = 0
    sections: list[npt.NDArray[np.generic]] = [mesh.positions, mesh.triangles]
    for bit, array in (
        (COLOURS, mesh.colours),
        (TRIANGLE_COLOURS, mesh.triangle_colours),
        (NORMALS, mesh.normals),
        (UVS, mesh.uvs),
        (TEXTURE, None if texture is None or has_surface else texture.texels),
    ):
        if array is not None:
            content |= bit
            sections.append(array)
    clusters = b""
    if mesh.clusters is not None:
        content |= CLUSTERS
        clusters = padded(COUNT.pack(len(mesh.clusters)) + mesh.clusters.tobytes())
    version = (MAJOR, MINOR)
    surface = b""
    if has_surface:
        content |= SURFACE
        version = (MAJOR_SURFACE, MINOR_SURFACE)
        surface = surface_bytes(texture, look)
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
    rest += clusters + surface
    return PREFIX.pack(MAGIC, *version, PREFIX.size + len(rest), zlib.crc32(rest)) + rest


def decode(data: bytes) -> tuple[Mesh, Texture | None]:
    """The mesh and the texture in `data`. Raises EdgelineError with one line that says what is wrong."""
    return decode_all(data)[:2]


def decode_all(data: bytes) -> tuple[Mesh, Texture | None, Look]:
    """The same, with what is said of the material."""
    if data[:4] != MAGIC:
        raise EdgelineError("not an .elm mesh; make one with: edgeline convert model.obj -o model.elm")
    if len(data) < HEADER_BYTES:
        raise EdgelineError(f"the .elm is cut short: {len(data)} bytes, its header alone has {HEADER_BYTES}")
    _, major, minor, size, crc = PREFIX.unpack_from(data)
    if major not in (MAJOR, MAJOR_SURFACE):
        known = f"{MAJOR}.x and {MAJOR_SURFACE}.x"
        raise EdgelineError(f"the .elm has version {major}.{minor}, this Edgeline reads {known}; update Edgeline")
    if size > len(data):
        raise EdgelineError(f"the .elm is cut short: {len(data)} of {size} bytes; copy it again")
    if size != len(data) or zlib.crc32(data[PREFIX.size :]) != crc:
        raise EdgelineError("the .elm is damaged: its size or checksum does not agree; copy it again")
    vertices, triangles, scale_log2, content, width_log2, height_log2, cx, cy, cz, radius = FIELDS.unpack_from(
        data, PREFIX.size
    )
    has_texture, has_surface = bool(content & TEXTURE), bool(content & SURFACE)
    side_limit_log2 = MAX_TEXTURE_LOG2 if has_texture or (has_surface and content & UVS) else 0
    if (
        content > 127
        or has_surface != (major == MAJOR_SURFACE)
        or (has_texture and (has_surface or not content & UVS))
        or max(width_log2, height_log2) > side_limit_log2
    ):
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
            raise EdgelineError(INCONSISTENT)
        view = np.frombuffer(data[offset:end], dtype).reshape(shape)
        arrays[name] = view.astype(view.dtype.newbyteorder("="))
        offset = following
    clusters = None
    if content & CLUSTERS:
        clusters, offset = _clusters(data, offset)
    texels = arrays.pop("texels", None)
    texture = None if texels is None else Texture(texels)
    look = Look()
    if has_surface:
        texture, look, offset = _surface(data, offset, (width_log2, height_log2))
    if offset != size or (texture is not None and not content & UVS):
        raise EdgelineError(INCONSISTENT)
    mesh = Mesh(**arrays, scale_log2=scale_log2, centre=(cx, cy, cz), radius=radius, clusters=clusters)
    return mesh, texture, look


def _taken(data: bytes, offset: int, count: int) -> tuple[bytes, int]:
    """So many bytes, and the offset behind their padding."""
    end = offset + count
    following = end + -end % 4
    if following > len(data) or any(data[end:following]):
        raise EdgelineError(INCONSISTENT)
    return data[offset:end], following


def _unpacked(data: bytes, form: Format, width: int, height: int) -> npt.NDArray[np.uint16]:
    """Texels (height, width) out of rows as `Texture.packed` has them."""
    if form == Format.RGB565:
        return np.frombuffer(data, "<u2").reshape(height, width).astype(np.uint16)
    rows = np.frombuffer(data, np.uint8).reshape(height, -1)
    if form == Format.MASK:
        rows = np.unpackbits(rows, axis=1)
    elif form == Format.INDEX4:
        rows = np.stack([rows >> 4, rows & 15], axis=2).reshape(height, -1)
    return rows[:, :width].astype(np.uint16)


def _surface(data: bytes, offset: int, sides_log2: tuple[int, int]) -> tuple[Texture | None, Look, int]:
    """Picture and material of the section at `offset`, and the offset behind it."""
    head, offset = _taken(data, offset, HEAD.size)
    flags, opacity, form, count, wrap_u, wrap_v, bits, zero, key, zeros = HEAD.unpack(head)
    good = flags <= 1 and opacity > 0 and form <= Format.MASK and max(wrap_u, wrap_v) <= Wrap.MIRROR and bits <= 7
    good = good and zero == zeros == 0 and count <= max(sides_log2) + 1
    good = good and (key < 1 << Format(form).bits if bits & HAS_KEY else key == 0)
    if not good or (count == 0 and any((form, wrap_u, wrap_v, bits, *sides_log2))):
        raise EdgelineError("the .elm is damaged: its surface contradicts itself; convert the model again")
    look = Look(bool(flags), opacity)
    if count == 0:
        return None, look, offset
    form = Format(form)
    palette, offset = _taken(data, offset, 2 * form.colours)
    levels = []
    for level in range(count):
        width, height = (1 << max(0, log2 - level) for log2 in sides_log2)
        texels, offset = _taken(data, offset, height * ((width * form.bits + 7) // 8))
        alpha = None
        if bits & HAS_ALPHA:
            raw, offset = _taken(data, offset, height * width)
            alpha = np.frombuffer(raw, np.uint8).reshape(height, width)
        levels.append(
            Texture(
                _unpacked(texels, form, width, height),
                form,
                np.frombuffer(palette, "<u2").astype(np.uint16),
                alpha,
                key if bits & HAS_KEY else None,
                (Wrap(wrap_u), Wrap(wrap_v)),
                bool(bits & SMOOTH),
            )
        )
    return linked(levels), look, offset


def _clusters(data: bytes, offset: int) -> tuple[npt.NDArray[np.void] | None, int]:
    """The clusters whose number lies at `offset`, None where it is 0, and the offset behind their padding."""
    count = COUNT.unpack_from(data, offset)[0] if offset + COUNT.size <= len(data) else 0
    end = offset + COUNT.size + count * CLUSTER.itemsize
    following = end + -end % 4
    if following > len(data) or any(data[end:following]):
        raise EdgelineError(INCONSISTENT)
    return (np.frombuffer(data[offset + COUNT.size : end], CLUSTER) if count else None), following
