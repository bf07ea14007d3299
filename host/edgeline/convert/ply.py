"""PLY, ASCII and binary of both byte orders: what the header declares, read element by element, checked.

Understood are vertices with positions, normals, colours and texture coordinates, faces of any number of corners with
colours and with texture coordinates of their own, and the comment TextureFile. No files are opened here.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from edgeline.convert.mesh import Floats, Ints
from edgeline.convert.source import Part, Picture, Source, as_floats, check_count, check_positions, to_bytes
from edgeline.convert.triangulate import triangulate
from edgeline.errors import EdgelineError

TYPES = {"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4"}
TYPES |= {"float": "f4", "double": "f8", "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2"}
TYPES |= {"int32": "i4", "uint32": "u4", "float32": "f4", "float64": "f8"}
ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
MOST_CORNERS = 1 << 16
"""Of a face; a list that is longer is damage."""

MOST_INDEX = 1 << 32

Row = dict[str, npt.NDArray[np.generic]]
Columns = dict[str, npt.NDArray[np.generic] | list[npt.NDArray[np.generic]]]
"""By property: an array with a value for each, a row of values for each, or a list of such rows of any length."""


@dataclass(frozen=True)
class Property:
    """`count` is the type of a list's length, or empty for a single value."""

    name: str
    kind: str
    count: str = ""


@dataclass(frozen=True)
class Element:
    name: str
    count: int
    properties: list[Property] = field(default_factory=list)

    @property
    def least_bytes(self) -> int:
        """Of one of them in a binary file."""
        return sum(np.dtype(p.count or p.kind).itemsize for p in self.properties)


@dataclass(frozen=True)
class Header:
    order: str
    elements: list[Element]
    image: str | None
    size: int  # bytes
    lines: int


def parse_ply(name: str, data: bytes, picture_of: Callable[[str], Picture]) -> Source:
    """The triangles in `data`. Raises EdgelineError with the place for what cannot be meant."""
    header = _header(name, data)
    if header.order:
        body = _Binary(name, header.order, data[header.size :])
        columns = {element.name: body.element(element) for element in header.elements}
    else:
        columns = _read_ascii(name, header, data[header.size :])
    for element in ("vertex", "face"):
        if element not in columns:
            raise EdgelineError(f"{name}: no element '{element}'; export the model as a mesh of polygons")
    return _source(name, header, columns["vertex"], columns["face"], picture_of)


def _header(name: str, data: bytes) -> Header:
    def error(line: int, text: str) -> EdgelineError:
        return EdgelineError(f"{name}:{line}: {text}; export the model again")

    elements: list[Element] = []
    order = image = None
    end = 0
    number = 0
    while True:
        number += 1
        begin, end = end, data.find(b"\n", end) + 1
        if end == 0:
            raise EdgelineError(f"{name}: its header has no end_header; it is cut short or no PLY, export it again")
        text = data[begin:end].decode("latin-1").strip()
        words = text.split()
        if number == 1 and words != ["ply"]:
            raise EdgelineError(f"{name}: it does not begin with 'ply'; is it a PLY?")
        keyword = words[0] if words else ""
        if keyword == "format":
            order = ORDERS.get(words[1]) if len(words) == 3 else None
            if order is None:
                raise error(number, f"{text[:60]!r} is no format of PLY")
        elif keyword == "comment" and words[1:2] == ["TextureFile"]:
            image = text.split(None, 2)[2] if len(words) > 2 else None
        elif keyword == "element":
            if len(words) != 3 or not words[2].isascii() or not words[2].isdigit() or len(words[2]) > 10:
                raise error(number, f"{text[:60]!r} is no element with its count")
            elements.append(Element(words[1], int(words[2])))
        elif keyword == "property":
            listed = words[1:2] == ["list"]
            kinds = words[2:-1] if listed else words[1:-1]
            if not elements or len(kinds) != 1 + listed or any(kind not in TYPES for kind in kinds):
                raise error(number, f"{text[:60]!r} is no property of an element")
            elements[-1].properties.append(Property(words[-1], TYPES[kinds[-1]], TYPES[kinds[0]] if listed else ""))
        elif keyword == "end_header":
            break
    if order is None:
        raise EdgelineError(f"{name}: its header names no format; export the model again")
    return Header(order, elements, image, end, number)


def _cut_short(name: str, element: Element, row: int) -> EdgelineError:
    return EdgelineError(
        f"{name}: {element.name} {row} of {element.count} lies beyond the end; it is cut short, export it again"
    )


def _gathered(element: Element, rows: list[Row]) -> Columns:
    """Lists stay lists of arrays, single values become one array."""
    columns: Columns = {}
    for p in element.properties:
        column = [row[p.name] for row in rows]
        columns[p.name] = column if p.count or not column else np.concatenate(column)
    return columns


@dataclass
class _Binary:
    """What follows the header of a binary file, read from `at` on."""

    name: str
    order: str
    data: bytes
    at: int = 0

    def element(self, element: Element) -> Columns:
        if not element.properties:
            return {}
        left = len(self.data) - self.at
        if element.least_bytes * element.count > left:
            raise _cut_short(self.name, element, left // max(element.least_bytes, 1))
        begin = self.at
        if element.count > 0:
            columns = self.alike(element, self.row(element, 0), begin)
            if columns is not None:
                return columns
        self.at = begin
        return _gathered(element, [self.row(element, number) for number in range(element.count)])

    def alike(self, element: Element, first: Row, begin: int) -> Columns | None:
        """All rows at once when their lists are as long as those of the first one; None where they are not."""
        fields: list[tuple[str, str] | tuple[str, str, tuple[int]]] = []
        for i, p in enumerate(element.properties):
            if p.count:
                fields += [(f"count {i}", self.order + p.count), (f"{i}", self.order + p.kind, (len(first[p.name]),))]
            else:
                fields.append((f"{i}", self.order + p.kind))
        row = np.dtype(fields)
        if row.itemsize * element.count > len(self.data) - begin or row.itemsize == 0:
            return None
        rows = np.frombuffer(self.data, row, element.count, begin)
        lists = [(i, p.name) for i, p in enumerate(element.properties) if p.count]
        if any(np.any(rows[f"count {i}"] != len(first[name])) for i, name in lists):
            return None
        self.at = begin + row.itemsize * element.count
        return {p.name: rows[f"{i}"] for i, p in enumerate(element.properties)}

    def row(self, element: Element, number: int) -> Row:
        row: Row = {}
        for p in element.properties:
            length = 1
            if p.count:
                length = int(self.values(element, number, p.count, 1)[0])
                if not 0 <= length <= MOST_CORNERS:
                    raise EdgelineError(
                        f"{self.name}: {element.name} {number} has a list of {length}; repair the model"
                    )
            row[p.name] = self.values(element, number, p.kind, length)
        return row

    def values(self, element: Element, number: int, kind: str, count: int) -> npt.NDArray[np.generic]:
        one = np.dtype(self.order + kind)
        if self.at + count * one.itemsize > len(self.data):
            raise _cut_short(self.name, element, number)
        found = np.frombuffer(self.data, one, count, self.at)
        self.at += count * one.itemsize
        return found


def _read_ascii(name: str, header: Header, data: bytes) -> dict[str, Columns]:
    lines = data.decode("latin-1").splitlines()
    found: dict[str, Columns] = {}
    at = 0
    for element in header.elements:
        rows: list[Row] = []
        while element.properties and len(rows) < element.count:
            if at == len(lines):
                raise _cut_short(name, element, len(rows))
            at += 1
            words = lines[at - 1].split()
            if words:
                rows.append(_ascii_row(f"{name}:{header.lines + at}", element, words))
        found[element.name] = _gathered(element, rows)
    return found


def _ascii_row(where: str, element: Element, words: list[str]) -> Row:
    try:
        values = np.array(words, dtype=np.float64)
    except ValueError:
        raise EdgelineError(f"{where}: not all of this line are numbers; export the model again") from None
    row: Row = {}
    at = 0
    for p in element.properties:
        length = 1
        if p.count:
            length = int(values[at]) if at < len(values) and 0 <= values[at] <= MOST_CORNERS else len(values)
            at += 1
        row[p.name] = _typed(where, p, values[at : at + length])
        at += length
    if at != len(values):
        raise EdgelineError(f"{where}: {len(values)} numbers are not what a {element.name} has; export the model again")
    return row


def _typed(where: str, declared: Property, values: Floats) -> npt.NDArray[np.generic]:
    """The numbers as the header declares them."""
    kind = np.dtype(declared.kind)
    if kind.kind == "f":
        return values
    limits = np.iinfo(kind)
    if not np.all((values >= limits.min) & (values <= limits.max)):
        raise EdgelineError(f"{where}: {declared.name} is outside of its type's range; export the model again")
    return values.astype(kind)


# --- Triangles --------------------------------------------------------------------------------------------------------


def _floats(columns: Columns, *choices: tuple[str, ...]) -> Floats | None:
    """The columns of the first choice that is all there, side by side, (n, k)."""
    for names in choices:
        found = [columns.get(name) for name in names]
        arrays = [as_floats(c) for c in found if isinstance(c, np.ndarray)]
        if len(arrays) == len(names) and all(a.ndim == 1 for a in arrays):
            return np.stack(arrays, axis=1)
    return None


def _colours(columns: Columns) -> npt.NDArray[np.uint8] | None:
    """As bytes. Floating-point ones are fractions, unless one is above 1: there are programs that write 0 to 255."""
    names = [("red", "green", "blue"), ("r", "g", "b"), ("diffuse_red", "diffuse_green", "diffuse_blue")]
    values = _floats(columns, *names)
    if values is None or len(values) == 0:
        return None
    first = next(columns[red] for red, _, _ in names if red in columns)
    fractions = isinstance(first, np.ndarray) and first.dtype.kind == "f" and float(np.nanmax(values)) <= 1.0
    values = np.nan_to_num(values, nan=1.0)
    return to_bytes(np.clip(values if fractions else values / 255, 0.0, 1.0))


def _source(
    name: str,
    header: Header,
    vertices: Columns,
    faces: Columns,
    picture_of: Callable[[str], Picture],
) -> Source:
    positions = _floats(vertices, ("x", "y", "z"))
    if positions is None:
        raise EdgelineError(f"{name}: its vertices have no x, y and z; export the model again")
    corners = faces.get("vertex_indices", faces.get("vertex_index"))
    if corners is None:
        raise EdgelineError(f"{name}: its faces have no list vertex_indices; export the model as a mesh of polygons")
    rows, slots, face_of = _triangles(name, positions, list(corners))
    loop_uvs = faces.get("texcoord")
    vertex_uvs = _floats(vertices, ("s", "t"), ("u", "v"), ("texture_u", "texture_v"))
    uvs = None
    if loop_uvs is not None:
        uvs = _loop_uvs(name, list(loop_uvs), slots, face_of)
    elif vertex_uvs is not None:
        uvs = vertex_uvs[rows]
    normals = _floats(vertices, ("nx", "ny", "nz"))
    colours, face_colours = _colours(vertices), _colours(faces)
    in_file = face_of.tolist()
    return check_positions(
        Source(
            name=name,
            positions=positions[rows],
            parts=(Part("", None if header.image is None or uvs is None else picture_of(header.image)),),
            part_of=np.zeros(len(rows), dtype=np.int64),
            where=lambda row: f"{name}: face {in_file[row]}",
            normals=None if normals is None else np.nan_to_num(normals[rows], posinf=0.0, neginf=0.0),
            uvs=None if uvs is None else np.stack([uvs[..., 0], 1.0 - uvs[..., 1]], axis=2),
            colours=None if colours is None else colours[rows],
            triangle_colours=None if face_colours is None else face_colours[face_of],
        )
    )


def _triangles(name: str, positions: Floats, corners: list[npt.NDArray[np.generic]]) -> tuple[Ints, Ints, Ints]:
    """Per triangle the vertices of its corners, their places in the face's list, and the face; (m, 3), (m, 3), (m,)."""
    check_count(name, sum(max(0, len(face) - 2) for face in corners))
    rows: list[list[int]] = []
    slots: list[tuple[int, int, int]] = []
    face_of: list[int] = []
    for number, listed in enumerate(corners):
        face = [int(i) if abs(i) < MOST_INDEX else -1 for i in listed.tolist()]
        if len(face) < 3:
            raise EdgelineError(f"{name}: face {number} has {len(face)} corners, 3 are needed; repair the model")
        if min(face) < 0 or max(face) >= len(positions):
            wrong = next(i for i in face if not 0 <= i < len(positions))
            raise EdgelineError(
                f"{name}: face {number} names vertex {wrong}, of {len(positions)} counted from 0; export it again"
            )
        with np.errstate(all="ignore"):  # positions that are no numbers are found later, with a message
            cut = triangulate(positions[face])
        for triangle in cut:
            rows.append([face[i] for i in triangle])
            slots.append(triangle)
            face_of.append(number)
    return (
        np.array(rows, dtype=np.int64).reshape(-1, 3),
        np.array(slots, dtype=np.int64).reshape(-1, 3),
        np.array(face_of, dtype=np.int64),
    )


def _loop_uvs(name: str, listed: list[npt.NDArray[np.generic]], slots: Ints, face_of: Ints) -> Floats:
    """Texture coordinates (m, 3, 2) of faces that have a pair for each corner."""
    rows = []
    for face, triangle in zip(face_of.tolist(), slots.tolist(), strict=True):
        values = as_floats(np.asarray(listed[face]))
        if len(values) < 2 * (max(triangle) + 1):
            raise EdgelineError(f"{name}: face {face} has too few texture coordinates; export the model again")
        rows.append(values.reshape(-1)[[[2 * i, 2 * i + 1] for i in triangle]])
    return np.array(rows, dtype=np.float64).reshape(-1, 3, 2)
