"""Meshes and textures as C headers: const arrays in the layout of `geometry/mesh.h`, as compact as a compiler allows.

Members are named in the order of their declarations, which C++ asks for.

The text depends on nothing but the data and the words given: no dates, no folders, so that a regenerated header can be
compared byte for byte.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from edgeline.convert.mesh import Mesh
from edgeline.convert.texels import Format, Texture, Wrap
from edgeline.errors import EdgelineError

COLUMNS = 120
PLAIN = 200, 200, 200
WHITE = 255, 255, 255
"""The colour of what has none, and of what has a texture, which leaves its texels as they are; in the simulator too."""

RESERVED = re.compile(
    "auto|break|case|char|const|continue|default|do|double|else|enum|extern|float|for|goto|if|inline|int|long|main|register"
    "|restrict|return|short|signed|sizeof|static|struct|switch|typedef|union|unsigned|void|volatile|while"
)
"""Words that C does not leave to a program."""


@dataclass(frozen=True)
class Look:
    """What an `el_material` says beside its texture. `opacity` of 255."""

    two_sided: bool = False
    opacity: int = 255


@dataclass(frozen=True)
class NamedMesh:
    """One mesh of a header. `offset_q16` is where its origin lies in the world, in Q16.16 world units, if anywhere.
    With a `material` there is an el_material too."""

    name: str
    mesh: Mesh
    texture: Texture | None = None
    offset_q16: tuple[int, int, int] | None = None
    material: Look | None = None

    @property
    def shading(self) -> str:
        """The dearest that the mesh has what it takes for, as the simulator chooses it too."""
        if self.texture is not None:
            return "textured" if self.mesh.colours is None else "textured_gouraud"
        return "flat" if self.mesh.triangle_colours is not None and self.mesh.colours is None else "gouraud"


def check_name(name: str) -> str:
    """`name`, when it can be a C identifier. Raises EdgelineError otherwise."""
    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name) or RESERVED.fullmatch(name):
        raise EdgelineError(f"--name {name!r} cannot name a C object: letters, digits and _, a letter first")
    return name


def name_from(stem: str, kind: str = "mesh") -> str:
    """A C identifier out of a file's name: `spot-mesh.2` becomes `spot_mesh_2`, `3d` becomes `mesh_3d`."""
    name = re.sub(r"[^A-Za-z0-9]+", "_", stem).strip("_").lower()
    if not name or not name[0].isalpha() or RESERVED.fullmatch(name):
        name = f"{kind}_{name}".rstrip("_")
    return name


def is_name_of_part(name: str, mesh: str) -> bool:
    """Whether a header of that mesh may give that name to one of its arrays, or its texture or material."""
    parts = "positions|triangles|colours|triangle_colours|normals|uvs|clusters|offset_q16"
    own = f"{parts}|(level[0-9]+_)?(texels|alpha|image|texture)|palette|material"
    return re.fullmatch(f"{mesh}_({own})", name) is not None


def wrap(items: Iterable[str]) -> list[str]:
    """`items` in lines of at most COLUMNS characters, each item followed by a comma."""
    lines: list[str] = []
    line = ""
    for item in items:
        if line and len(line) + len(item) + 1 > COLUMNS:
            lines.append(line)
            line = ""
        line += f"{item},"
    return [*lines, line]


def rows_of(array: npt.NDArray[np.generic]) -> Iterable[str]:
    """One initialiser `{a,b,c}` per row."""
    return ("{" + ",".join(map(str, row)) + "}" for row in array.tolist())


def array_lines(c_type: str, name: str, array: npt.NDArray[np.generic]) -> list[str]:
    rows, columns = array.shape
    return [f"static const {c_type} {name}[{rows}][{columns}] = {{", *wrap(rows_of(array)), "};"]


def values_lines(c_type: str, name: str, values: npt.NDArray[np.generic]) -> list[str]:
    digits = 2 * values.itemsize
    items = (f"0x{value:0{digits}x}" for value in values.tolist())
    return [f"static const {c_type} {name}[{values.size}] = {{", *wrap(items), "};"]


def texel_lines(name: str, level: Texture) -> list[str]:
    texels = level.packed()
    return values_lines("uint16_t" if texels.dtype == np.uint16 else "uint8_t", f"{name}_texels", texels)


def image_lines(image: str, name: str, palette: str, level: Texture) -> list[str]:
    """The el_image `image` of texels `name`_texels."""
    height, width = level.texels.shape
    lines = [] if level.alpha is None else values_lines("uint8_t", f"{name}_alpha", level.alpha.reshape(-1))
    lines += [
        f"static const el_image {image} = {{",
        f"    .width = {width},",
        f"    .height = {height},",
        f"    .format = EL_IMAGE_{level.format.name},",
    ]
    if level.key is not None:
        lines += ["    .has_key = true,", f"    .key = {level.key},"]
    lines += [f"    .pixels = {name}_texels,"]
    if level.palette.size > 0:
        lines += [f"    .palette = {palette},"]
    if level.alpha is not None:
        lines += [f"    .alpha = {name}_alpha,"]
    return [*lines, "};"]


def level_lines(name: str, palette: str, smaller: str | None, level: Texture) -> list[str]:
    """The arrays and the el_texture `name`_texture of one level. Members that only some textures need are left out
    else, as small code has none of them."""
    lines = texel_lines(name, level)
    if level.is_image:
        lines += image_lines(f"{name}_image", name, palette, level)
    lines += [f"static const el_texture {name}_texture = {{"]
    if not level.is_image:
        lines += [
            f"    .texels = {name}_texels,",
            f"    .width_log2 = {level.width_log2},",
            f"    .height_log2 = {level.height_log2},",
        ]
    for axis, mode in zip("uv", level.wrap, strict=True):
        if mode != Wrap.REPEAT:
            lines += [f"    .wrap_{axis} = EL_WRAP_{mode.name},"]
    if level.smooth:
        lines += ["    .smooth = true,"]
    if level.is_image:
        lines += [f"    .image = &{name}_image,"]
    if smaller is not None:
        lines += [f"    .smaller = &{smaller}_texture,"]
    return [*lines, "};"]


def palette_lines(palette: str, texture: Texture) -> list[str]:
    return values_lines("uint16_t", palette, texture.palette) if texture.format != Format.RGB565 else []


def texture_lines(name: str, texture: Texture) -> list[str]:
    """The smallest level first, as each names the next one."""
    palette = f"{name}_palette"
    lines = palette_lines(palette, texture)
    smaller = None
    for number, level in reversed([*enumerate(texture.levels())]):
        own = f"{name}_level{number}" if number > 0 else name
        lines += level_lines(own, palette, smaller, level)
        smaller = own
    return lines


def material_lines(named: NamedMesh, look: Look) -> list[str]:
    lines = [
        f"static const el_material {named.name}_material = {{",
        f"    .shading = EL_SHADE_{named.shading.upper()},",
    ]
    if look.two_sided:
        lines += ["    .flags = EL_MATERIAL_TWO_SIDED,"]
    if named.mesh.colours is None and named.mesh.triangle_colours is None:
        lines += [f"    .colour = {{{', '.join(map(str, PLAIN if named.texture is None else WHITE))}}},"]
    if look.opacity != 255:
        lines += [f"    .alpha = {look.opacity},"]
    if named.texture is not None:
        lines += [f"    .texture = &{named.name}_texture,"]
    return [*lines, "};"]


def cluster_lines(name: str, clusters: npt.NDArray[np.void]) -> list[str]:
    """One initialiser per cluster, its members in el_cluster's order."""

    def initialiser(value: object) -> str:
        return "{" + ",".join(map(initialiser, value)) + "}" if isinstance(value, (tuple, list)) else str(value)

    members = ([m.tolist() if isinstance(m, np.ndarray) else m for m in cluster] for cluster in clusters.tolist())
    return [
        f"static const el_cluster {name}_clusters[{len(clusters)}] = {{",
        *wrap(map(initialiser, members)),
        "};",
    ]


def mesh_lines(named: NamedMesh) -> list[str]:
    """The arrays of a mesh, then the mesh, then its texture, material and offset."""
    name, mesh = named.name, named.mesh
    arrays = (
        ("int16_t", "positions", mesh.positions),
        ("uint16_t", "triangles", mesh.triangles),
        ("uint8_t", "colours", mesh.colours),
        ("uint8_t", "triangle_colours", mesh.triangle_colours),
        ("int8_t", "normals", mesh.normals),
        ("int16_t", "uvs", mesh.uvs),
    )
    present = [(c_type, member, array) for c_type, member, array in arrays if array is not None]
    lines: list[str] = []
    for c_type, member, array in present:
        lines += array_lines(c_type, f"{name}_{member}", array)
    if mesh.clusters is not None:
        lines += cluster_lines(name, mesh.clusters)
    lines += [f"static const el_mesh {name} = {{"]
    lines += [f"    .{member} = {name}_{member}," for _, member, _ in present]
    lines += [
        f"    .vertex_count = {len(mesh.positions)},",
        f"    .triangle_count = {len(mesh.triangles)},",
        f"    .scale_log2 = {mesh.scale_log2},",
        f"    .centre = {{{', '.join(map(str, mesh.centre))}}},",
        f"    .radius = {mesh.radius},",
    ]
    if mesh.clusters is not None:
        lines += [f"    .cluster_count = {len(mesh.clusters)},", f"    .clusters = {name}_clusters,"]
    lines += ["};"]
    if named.texture is not None:
        lines += texture_lines(name, named.texture)
    if named.material is not None:
        lines += material_lines(named, named.material)
    if named.offset_q16 is not None:
        lines += [f"static const int32_t {name}_offset_q16[3] = {{{', '.join(map(str, named.offset_q16))}}};"]
    return lines


def summary(named: NamedMesh) -> str:
    """One line with the counts of a mesh."""
    mesh = named.mesh
    text = (
        f"{named.name}: {len(mesh.triangles):,} triangles, {len(mesh.positions):,} vertices, "
        f"unit 2^{mesh.scale_log2}, {mesh.flash_bytes:,} bytes"
    )
    if named.texture is not None:
        height, width = named.texture.texels.shape
        text += f"; texture {width}x{height}, {named.texture.flash_bytes:,} bytes"
    return text + "."


def whole_header(guard: str, about: Sequence[str], lines: Iterable[str]) -> str:
    """The text of a header that includes only `edgeline.h`; `about` is its opening comment."""
    comment = "\n * ".join(text.replace("*/", "* /") for text in about)
    head = [f"/* {comment} */", f"#ifndef {guard}", f"#define {guard}", "", '#include "edgeline.h"', ""]
    return "\n".join([*head, "/* clang-format off */", *lines, "/* clang-format on */", "", "#endif", ""])


def image_header(name: str, about: Sequence[str], picture: Texture) -> str:
    """A picture of any size as `static const el_image NAME`."""
    palette = f"{name}_palette"
    lines = [*palette_lines(palette, picture), *texel_lines(name, picture), *image_lines(name, name, palette, picture)]
    return whole_header(f"IMAGE_{name.upper()}_H", about, lines)


def c_header(name: str, about: Sequence[str], meshes: Sequence[NamedMesh]) -> str:
    """The meshes with what belongs to them.

    `name` becomes the include guard, `about` (what it shows, what made it) the opening comment, before the counts.
    """
    lines = [line for named in meshes for line in mesh_lines(named)]
    return whole_header(f"MESH_{name.upper()}_H", [*about, *map(summary, meshes)], lines)
