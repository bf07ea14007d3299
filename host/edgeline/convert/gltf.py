"""glTF 2.0: the triangles of a scene, where its nodes put them, with their materials' colours and images.

Left out, each with a note: points and lines, skins, morph targets, animations, what glows, extensions that are
not known here. Refused: those of them that a file requires, compression above all.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from edgeline.convert.gltf_file import GltfFile, Json, open_gltf
from edgeline.convert.mesh import Floats, Ints
from edgeline.convert.source import NO_GLOW, Part, Picture, Source, as_floats, check_count, check_positions, to_bytes
from edgeline.convert.texels import Wrap
from edgeline.convert.texture import Alpha, encoded
from edgeline.errors import EdgelineError

KNOWN_EXTENSIONS = {"KHR_texture_transform", "KHR_mesh_quantization", "KHR_materials_unlit"}
TRIANGLES, STRIP, FAN = 4, 5, 6
REPEAT = 10497
WRAPS = {REPEAT: Wrap.REPEAT, 33071: Wrap.CLAMP, 33648: Wrap.MIRROR}
LINEAR = 9729
ALPHAS = {"OPAQUE": Alpha.NONE, "MASK": Alpha.TEST, "BLEND": Alpha.BLEND}


@dataclass(frozen=True)
class Material:
    """`factor` in linear light, `opacity` of 255; `image` is its image's number, `uv_set` whose coordinates it has."""

    name: str
    factor: tuple[float, float, float] = (1.0, 1.0, 1.0)
    image: int | None = None
    uv_set: int = 0
    offset: tuple[float, float] = (0.0, 0.0)
    rotation: float = 0.0
    scale: tuple[float, float] = (1.0, 1.0)
    wrap: tuple[Wrap, Wrap] = (Wrap.REPEAT, Wrap.REPEAT)
    smooth: bool = False
    alpha: Alpha = Alpha.NONE
    cutoff: float = 0.5
    opacity: int = 255
    two_sided: bool = False

    @property
    def look(self) -> object:
        """What triangles have to share to be one part."""
        drawn = self.two_sided, self.opacity
        if self.image is None:
            return drawn
        return drawn, self.image, self.factor, self.wrap, self.smooth, self.alpha, self.cutoff


@dataclass(frozen=True)
class Piece:
    """The triangles of a primitive where a node puts it, (m, 3, ...)."""

    where: str
    material: Material
    positions: Floats
    normals: Floats | None
    uvs: Floats | None
    colours: Floats | None  # linear, times the material's factor where it has no image


@dataclass
class _Reader:
    file: GltfFile
    notes: dict[str, None] = field(default_factory=dict)  # in order, each once
    materials: dict[int, Material] = field(default_factory=dict)
    triangles: int = 0

    def note(self, text: str) -> None:
        self.notes[text] = None

    # --- nodes --------------------------------------------------------------------------------------------------------

    def nodes(self) -> Iterator[tuple[int, Json, Floats]]:
        """Number, object and matrix (4, 4) of each node of the scene, parents first."""
        file = self.file
        if "scenes" in file.json:
            scene = file.item("scenes", file.json.get("scene", 0), "the file")
            roots = file.value(scene, "scene", "nodes", list, [])
        else:
            nodes = file.value(file.json, "the file", "nodes", list, [])
            below = [
                file.value(file.item("nodes", i, "the file"), f"nodes[{i}]", "children", list, [])
                for i in range(len(nodes))
            ]
            roots = [i for i in range(len(nodes)) if not any(i in children for children in below)]
        seen: set[int] = set()
        waiting: list[tuple[object, Floats]] = [(root, np.eye(4)) for root in reversed(roots)]
        while waiting:
            number, above = waiting.pop()
            node = file.item("nodes", number, "a scene or a node")
            assert isinstance(number, int)
            if number in seen:
                raise file.error(f"nodes[{number}] has two parents, or is its own")
            seen.add(number)
            matrix = np.asarray(above @ self.matrix(node, f"nodes[{number}]"))
            yield number, node, matrix
            children = file.value(node, f"nodes[{number}]", "children", list, [])
            waiting += [(child, matrix) for child in reversed(children)]

    def matrix(self, node: Json, where: str) -> Floats:
        file = self.file
        if "matrix" in node:
            return np.asarray(np.reshape(file.numbers(node, where, "matrix", [0.0] * 16), (4, 4)).T)
        x, y, z, w = file.numbers(node, where, "rotation", [0.0, 0.0, 0.0, 1.0])
        length = np.sqrt(x * x + y * y + z * z + w * w) or 1.0
        x, y, z, w = x / length, y / length, z / length, w / length
        rotation = np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
            ]
        )
        matrix = np.eye(4)
        matrix[:3, :3] = rotation * file.numbers(node, where, "scale", [1.0] * 3)
        matrix[:3, 3] = file.numbers(node, where, "translation", [0.0] * 3)
        return matrix

    # --- materials ----------------------------------------------------------------------------------------------------

    def material(self, index: object, user: str) -> Material:
        if index is None:
            return Material("")
        found = self.file.item("materials", index, user)
        assert isinstance(index, int)
        if index not in self.materials:
            self.materials[index] = self.read_material(found, f"materials[{index}]")
        return self.materials[index]

    def read_material(self, material: Json, where: str) -> Material:
        file = self.file
        name = file.value(material, where, "name", str, where)
        mode = file.value(material, where, "alphaMode", str, "OPAQUE")
        if mode not in ALPHAS:
            raise file.error(f"{where}: 'alphaMode' is {mode:.20}")
        two_sided = file.value(material, where, "doubleSided", bool, False)
        if max(file.numbers(material, where, "emissiveFactor", [0.0] * 3)) > 0:
            self.note(f"{name}: {NO_GLOW}")
        surface = file.value(material, where, "pbrMetallicRoughness", dict, {})
        red, green, blue, opacity = file.numbers(surface, where, "baseColorFactor", [1.0] * 4)
        opacity = min(max(opacity, 0.0), 1.0)
        cutoff = min(max(file.numbers({"c": [material.get("alphaCutoff", 0.5)]}, where, "c", [0.5])[0], 0.0), 1.0)
        plain = Material(
            name,
            (red, green, blue),
            alpha=ALPHAS[mode],
            cutoff=min(cutoff / opacity, 1.0) if opacity > 0 else cutoff,
            opacity=(round(opacity * 255) or 255) if mode == "BLEND" else 255,
            two_sided=two_sided,
        )
        if "baseColorTexture" not in surface:
            return plain
        used = file.value(surface, where, "baseColorTexture", dict)
        texture = file.item("textures", used.get("index"), where)
        sampler = file.item("samplers", texture["sampler"], where) if "sampler" in texture else {}
        wraps = [file.count(sampler, where, key, REPEAT) for key in ("wrapS", "wrapT")]
        if not all(wrap in WRAPS for wrap in wraps):
            raise file.error(f"{where}: its sampler wraps by {wraps[0]} and {wraps[1]}, of which one is unknown")
        file.item("images", texture.get("source"), f"the texture of {where}")
        extensions = file.value(used, where, "extensions", dict, {})
        moved = file.value(extensions, where, "KHR_texture_transform", dict, {})
        offset, scale = file.numbers(moved, where, "offset", [0.0] * 2), file.numbers(moved, where, "scale", [1.0] * 2)
        return replace(
            plain,
            image=texture["source"],
            uv_set=file.count(moved, where, "texCoord", file.count(used, where, "texCoord", 0)),
            offset=(offset[0], offset[1]),
            rotation=file.numbers({"rotation": [moved.get("rotation", 0.0)]}, where, "rotation", [0.0])[0],
            scale=(scale[0], scale[1]),
            wrap=(WRAPS[wraps[0]], WRAPS[wraps[1]]),
            smooth=sampler.get("magFilter") == LINEAR,
        )

    def picture(self, index: int, material: Material) -> Picture:
        file = self.file
        where = f"images[{index}]"
        image = file.item("images", index, "a texture")
        if "uri" in image:
            data = file.resource(file.value(image, where, "uri", str), where)
        else:
            data, _ = file.view(image.get("bufferView"), where)
        return Picture(
            f"{file.name}: {where}",
            data,
            material.factor,
            material.wrap,
            material.smooth,
            material.alpha,
            material.cutoff,
        )

    # --- primitives ---------------------------------------------------------------------------------------------------

    def pieces(self) -> Iterator[Piece]:
        for number, node, matrix in self.nodes():
            if "mesh" not in node:
                continue
            mesh = self.file.item("meshes", node["mesh"], f"nodes[{number}]")
            where = f"meshes[{node['mesh']}]"
            if "skin" in node:  # then the node's own place does not count
                self.note(f"{where}: its skin is left out; it is as it was modelled, not posed")
            place = np.eye(4) if "skin" in node else matrix
            for i, primitive in enumerate(self.file.value(mesh, where, "primitives", list)):
                if not isinstance(primitive, dict):
                    raise self.file.error(f"{where}: a primitive is no object")
                piece = self.piece(primitive, f"{where} primitive {i}", place)
                if piece is not None:
                    yield piece

    def piece(self, primitive: Json, where: str, matrix: Floats) -> Piece | None:
        file = self.file
        mode = file.count(primitive, where, "mode", TRIANGLES)
        if mode not in (TRIANGLES, STRIP, FAN):
            self.note(f"{where}: points or lines, which are left out")
            return None
        if "targets" in primitive:
            self.note(f"{where}: its morph targets are left out")
        attributes = file.value(primitive, where, "attributes", dict)
        if "POSITION" not in attributes:
            raise file.error(f"{where}: it has no positions")
        vertices = self.attribute(attributes, "POSITION", where, None, ("VEC3",))
        assert vertices is not None
        corners = self.corners(primitive, where, mode, len(vertices))
        self.triangles += len(corners)
        check_count(file.name, self.triangles)
        material = self.material(primitive.get("material"), where)
        uvs = None
        if material.image is not None:
            uvs = self.attribute(attributes, f"TEXCOORD_{material.uv_set}", where, len(vertices), ("VEC2",))
        normals = self.attribute(attributes, "NORMAL", where, len(vertices), ("VEC3",))
        colours = self.attribute(attributes, "COLOR_0", where, len(vertices), ("VEC3", "VEC4"))
        own_factor = material.factor if material.image is None else (1.0, 1.0, 1.0)  # else the picture has it
        linear = matrix[:3, :3]
        with np.errstate(all="ignore"):  # what is no number is found by check_positions
            vertices = vertices @ linear.T + matrix[:3, 3]
            if np.linalg.det(linear) < 0:  # a mirror turns the winding around
                corners = corners[:, ::-1]
            if normals is not None:
                normals = np.nan_to_num(normals @ _normal_matrix(linear).T, posinf=0.0, neginf=0.0)
        return Piece(
            where,
            material,
            vertices[corners],
            None if normals is None else normals[corners],
            None if uvs is None else self.transformed(uvs[corners], material),
            None if colours is None else np.nan_to_num(colours[corners][..., :3]) * own_factor,
        )

    def attribute(
        self, attributes: Json, key: str, where: str, count: int | None, widths: tuple[str, ...]
    ) -> Floats | None:
        if key not in attributes:
            return None
        rows = as_floats(self.file.accessor(attributes[key], f"{where} {key}", widths))
        if count is not None and len(rows) != count:
            raise self.file.error(f"{where}: {len(rows)} of {key} for {count} positions")
        return rows

    def corners(self, primitive: Json, where: str, mode: int, vertices: int) -> Ints:
        """Vertices of triangles (m, 3)."""
        if "indices" in primitive:
            rows = self.file.accessor(primitive["indices"], f"{where} indices", ("SCALAR",))
            if rows.dtype.kind != "u":
                raise self.file.error(f"{where}: its indices are no unsigned numbers")
            indices = rows.reshape(-1).astype(np.int64)
        else:
            indices = np.arange(vertices)
        if len(indices) > 0 and int(indices.max()) >= vertices:
            raise self.file.error(f"{where}: index {int(indices.max())} with {vertices} vertices")
        count = len(indices)
        if mode == TRIANGLES:
            if count % 3 != 0:
                raise self.file.error(f"{where}: {count} indices are no whole triangles")
            return indices.reshape(-1, 3)
        steps = np.arange(max(0, count - 2))
        if mode == FAN:
            return indices[np.stack([steps * 0, steps + 1, steps + 2], axis=1)]
        odd = steps % 2
        return indices[np.stack([steps, steps + 1 + odd, steps + 2 - odd], axis=1)]

    def transformed(self, uvs: Floats, material: Material) -> Floats:
        """As KHR_texture_transform has it: scale, then rotation, then offset."""
        sine, cosine = np.sin(material.rotation), np.cos(material.rotation)
        uvs = uvs * material.scale
        if material.rotation != 0.0:
            uvs = uvs @ np.array([[cosine, -sine], [sine, cosine]])
        return np.asarray(uvs + material.offset)


def _normal_matrix(m: Floats) -> Floats:
    """The inverse transposed, by which normals are turned, times the determinant's magnitude: defined for every
    matrix, and in a mirror what looked outwards still does."""
    cofactors = np.stack([np.cross(m[1], m[2]), np.cross(m[2], m[0]), np.cross(m[0], m[1])])
    return cofactors if np.linalg.det(m) >= 0 else -cofactors


def unknown_extensions(file: GltfFile, key: str) -> list[str]:
    names = map(str, file.value(file.json, "the file", key, list, []))
    return [extension for extension in names if extension not in KNOWN_EXTENSIONS]


def parse_gltf(name: str, data: bytes, read_beside: Callable[[str], bytes]) -> Source:
    """The triangles of the file's scene. Raises EdgelineError with the place for what cannot be meant."""
    file = open_gltf(name, data, read_beside)
    asset = file.value(file.json, "the file", "asset", dict)
    version = file.value(asset, "asset", "version", str)
    if version.split(".")[0] != "2":
        raise EdgelineError(f"{name}: glTF version {version:.10}, this reads version 2; export the model as glTF 2.0")
    unknown = unknown_extensions(file, "extensionsRequired")
    if unknown:
        raise EdgelineError(
            f"{name}: it needs {unknown[0]:.60}, which is not read; export it without compression or it"
        )
    reader = _Reader(file)
    pieces = list(reader.pieces())
    if "animations" in file.json:
        reader.note("animations are left out")
    for extension in unknown_extensions(file, "extensionsUsed"):
        reader.note(f"what {extension:.60} says is left out")
    if not any(len(piece.positions) for piece in pieces):
        raise EdgelineError(f"{name}: no triangle in its scene; is it a mesh of polygons?")
    return _source(reader, pieces)


def _source(reader: _Reader, pieces: list[Piece]) -> Source:
    parts: list[Part] = []
    number_of: dict[object, int] = {}
    part_of = []
    for piece in pieces:
        material = piece.material
        if material.look not in number_of:
            number_of[material.look] = len(parts)
            picture = None if material.image is None else reader.picture(material.image, material)
            parts.append(Part(material.name, picture, material.two_sided, material.opacity))
        part_of.append(number_of[material.look])
    counts = [len(piece.positions) for piece in pieces]
    ends = np.cumsum(counts)

    def where(row: int) -> str:
        number = int(np.searchsorted(ends, row, side="right"))
        return f"{reader.file.name}: {pieces[number].where} triangle {row - int(ends[number]) + counts[number]}"

    return check_positions(
        Source(
            name=reader.file.name,
            positions=np.concatenate([piece.positions for piece in pieces]),
            parts=tuple(parts),
            part_of=np.repeat(np.array(part_of, dtype=np.int64), counts),
            where=where,
            normals=_joined([piece.normals for piece in pieces], counts, 3, 0.0),
            uvs=_joined([piece.uvs for piece in pieces], counts, 2, np.nan),
            colours=_vertex_colours(pieces),
            tints=True,
            triangle_colours=_triangle_colours(pieces, counts),
            notes=tuple(reader.notes),
        )
    )


def _joined(arrays: list[Floats | None], counts: list[int], width: int, filler: float) -> Floats | None:
    """One array of all, None where no piece has any."""
    if all(array is None for array in arrays):
        return None
    return np.concatenate(
        [np.full((m, 3, width), filler) if a is None else a for a, m in zip(arrays, counts, strict=True)]
    )


def _vertex_colours(pieces: list[Piece]) -> npt.NDArray[np.uint8] | None:
    """Where a piece has some; the others then have their material's."""
    if all(piece.colours is None for piece in pieces):
        return None
    factors = [p.material.factor if p.material.image is None else (1.0, 1.0, 1.0) for p in pieces]
    rows = [
        np.broadcast_to(np.array(factor), p.positions.shape) if p.colours is None else p.colours
        for p, factor in zip(pieces, factors, strict=True)
    ]
    return to_bytes(encoded(np.concatenate(rows)))


def _triangle_colours(pieces: list[Piece], counts: list[int]) -> npt.NDArray[np.uint8] | None:
    """The materials' factors where one is not white and no vertex has a colour."""
    factors = np.array([piece.material.factor for piece in pieces])
    if np.all(factors == 1.0) or any(piece.colours is not None for piece in pieces):
        return None
    return np.repeat(to_bytes(encoded(factors)), counts, axis=0)
