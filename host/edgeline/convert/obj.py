"""Wavefront OBJ and MTL as text: what a file says, checked, with the line of every face for later messages.

Understood are v (with colours), vt, vn, f, usemtl and mtllib, and newmtl, Kd, Ke, d, Tr, map_Kd and map_d in materials.
Groups, objects, smoothing groups, lines, points and free-form surfaces are passed over. No files are opened here.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from edgeline.errors import EdgelineError

NONE = -1
"""Where a corner has no texture coordinate or normal, or a face no material."""

MAP_OPTION_ARGUMENTS = {"-blendu": 1, "-blendv": 1, "-bm": 1, "-boost": 1, "-cc": 1, "-clamp": 1, "-imfchan": 1}
MAP_OPTION_ARGUMENTS |= {"-mm": 2, "-texres": 1, "-type": 1}
MAP_VECTOR_OPTIONS = {"-o", "-s", "-t"}
"""These take one to three numbers."""


@dataclass(frozen=True)
class Face:
    """A polygon: per corner the indices of its position, texture coordinate and normal, from 0 or NONE."""

    line: int
    positions: tuple[int, ...]
    uvs: tuple[int, ...]
    normals: tuple[int, ...]
    material: int


@dataclass
class ObjModel:
    """The content of one OBJ file. `name` is the file's, for messages."""

    name: str
    positions: list[tuple[float, float, float]] = field(default_factory=list)
    colours: dict[int, tuple[float, float, float]] = field(default_factory=dict)  # by position, 0 to 1
    uvs: list[tuple[float, float]] = field(default_factory=list)
    normals: list[tuple[float, float, float]] = field(default_factory=list)
    faces: list[Face] = field(default_factory=list)
    materials: list[str] = field(default_factory=list)
    libraries: list[tuple[int, str]] = field(default_factory=list)  # line and file name

    def error(self, line: int, text: str) -> EdgelineError:
        return EdgelineError(f"{self.name}:{line}: {text}")


@dataclass
class Material:
    """`colour` is Kd, `opacity` d, 0 to 1; `image` the file name of map_Kd; `line` where that stands; `clamps`: its
    option -clamp on; `clear_image` the file name of map_d; `glows`: its Ke is not black."""

    colour: tuple[float, float, float] | None = None
    opacity: float = 1.0
    image: str | None = None
    line: int = 0
    clamps: bool = False
    clear_image: str | None = None
    glows: bool = False

    @property
    def has_alpha(self) -> bool:
        """Whether the image's own alpha is how much of it shows."""
        return self.image is not None and self.clear_image == self.image


def statements(name: str, data: bytes) -> Iterator[tuple[int, list[str], str]]:
    """Line number, words, and text after the first word of each statement; continuation lines joined, comments gone."""
    if b"\0" in data:
        raise EdgelineError(f"{name}: this is not text; give a Wavefront file, exported as such")
    begin, text = 0, ""
    for number, raw in enumerate(data.decode("utf-8-sig", "replace").splitlines(), 1):
        line = raw.split("#", 1)[0].rstrip()
        begin = begin or number
        if line.endswith("\\"):
            text += line[:-1] + " "
            continue
        text += line
        words = text.split()
        if words:
            yield begin, words, text.strip()[len(words[0]) :].strip()
        begin, text = 0, ""
    if text.strip():
        raise EdgelineError(f"{name}:{begin}: the file ends in a continued line; it is cut short, export it again")


def numbers(name: str, line: int, words: list[str], least: int, most: int) -> list[float]:
    """The numbers after the keyword. Raises EdgelineError when they are too few, too many, or none."""
    if not least <= len(words) - 1 <= most:
        span = str(least) if least == most else f"{least} to {most}"
        raise EdgelineError(f"{name}:{line}: {words[0]} needs {span} numbers and has {len(words) - 1}; export it again")
    values = []
    for word in words[1:]:
        try:
            value = float(word)
        except ValueError:
            raise EdgelineError(f"{name}:{line}: {word[:40]!r} is no number; export the model again") from None
        if not math.isfinite(value) or "_" in word:
            raise EdgelineError(f"{name}:{line}: {word[:40]!r} is no finite number; repair the model")
        values.append(value)
    return values


def corner_index(model: ObjModel, line: int, word: str, what: str, count: int) -> int:
    """An index from 0 out of one from 1, or from -1 backwards. What lies beyond the end is found by `check_indices`."""
    if not re.fullmatch(r"[+-]?[0-9]{1,10}", word):
        raise model.error(line, f"{word[:40]!r} is no index of a {what}; export the model again")
    index = int(word)
    if index == 0 or index < -count:
        raise model.error(line, f"{what} {index}, but there are {count} so far; indices start at 1, repair the model")
    return index - 1 if index > 0 else count + index


def read_face(model: ObjModel, line: int, words: list[str], material: int) -> Face:
    if len(words) < 4:
        raise model.error(line, f"a face needs 3 corners and has {len(words) - 1}; export the model again")
    columns: list[list[int]] = [[], [], []]
    targets = (
        ("vertex", len(model.positions)),
        ("texture coordinate", len(model.uvs)),
        ("normal", len(model.normals)),
    )
    for word in words[1:]:
        parts = word.split("/")
        if len(parts) > 3 or not parts[0]:
            raise model.error(line, f"{word[:40]!r} is no corner; it should be v, v/vt, v//vn or v/vt/vn")
        for column, part, (what, count) in zip(columns, [*parts, "", ""], targets, strict=False):
            column.append(corner_index(model, line, part, what, count) if part else NONE)
    positions, uvs, normals = (tuple(column) for column in columns)
    return Face(line, positions, uvs, normals, material)


def check_indices(model: ObjModel) -> None:
    """Raises EdgelineError for the first face that names what the file does not hold."""
    for face in model.faces:
        for what, indices, count in (
            ("vertex", face.positions, len(model.positions)),
            ("texture coordinate", face.uvs, len(model.uvs)),
            ("normal", face.normals, len(model.normals)),
        ):
            if max(indices) >= count:
                text = f"{what} {max(indices) + 1}, but the file has {count}; it is cut short, export it again"
                raise model.error(face.line, text)


def read_vertex(model: ObjModel, line: int, words: list[str]) -> None:
    """v x y z, with a weight (which only free-form surfaces use), or with red, green, blue and perhaps alpha."""
    values = numbers(model.name, line, words, 3, 7)
    if len(values) == 5:
        raise model.error(line, "v with 5 numbers: neither a position nor one with a colour; export the model again")
    if len(values) >= 6:
        colour = values[3], values[4], values[5]
        if not all(0 <= c <= 1 for c in colour):
            raise model.error(line, "a vertex colour outside 0 to 1; export the colours as fractions")
        model.colours[len(model.positions)] = colour
    model.positions.append((values[0], values[1], values[2]))


def parse_obj(name: str, data: bytes) -> ObjModel:
    """The model in `data`. Raises EdgelineError with file and line for what cannot be meant."""
    model = ObjModel(name)
    material_of: dict[str, int] = {}
    material = NONE
    for line, words, rest in statements(name, data):
        keyword = words[0]
        if keyword == "v":
            read_vertex(model, line, words)
        elif keyword == "vt":
            values = numbers(name, line, words, 1, 3)
            model.uvs.append((values[0], values[1] if len(values) > 1 else 0.0))
        elif keyword == "vn":
            x, y, z = numbers(name, line, words, 3, 3)
            model.normals.append((x, y, z))
        elif keyword == "f":
            model.faces.append(read_face(model, line, words, material))
        elif keyword == "usemtl":
            material = material_of.setdefault(rest, len(material_of))
        elif keyword == "mtllib":
            model.libraries.append((line, rest))
    if not model.faces:
        raise EdgelineError(f"{name}: no face in this file; is it a Wavefront OBJ with polygons?")
    check_indices(model)
    model.materials = list(material_of)
    return model


def map_file(words: list[str], rest: str) -> str:
    """The file name of a map statement, which may have options before it and spaces in it."""
    at = 1
    while at < len(words) - 1 and words[at].startswith("-"):
        option = words[at].lower()
        at += 1
        if option in MAP_VECTOR_OPTIONS:
            for _ in range(3):
                if at < len(words) - 1 and re.fullmatch(r"[-+]?[0-9.]+([eE][-+]?[0-9]+)?", words[at]):
                    at += 1
        else:
            at += MAP_OPTION_ARGUMENTS.get(option, 0)
    if at == 1:
        return rest
    return " ".join(words[at:])


def parse_mtl(name: str, data: bytes) -> dict[str, Material]:
    """The materials in `data` by their names. Raises EdgelineError with file and line."""
    materials: dict[str, Material] = {}
    current = Material()
    for line, words, rest in statements(name, data):
        if words[0] == "newmtl":
            current = materials.setdefault(rest, Material())
        elif words[0] == "Kd" and words[1:2] not in (["spectral"], ["xyz"]):
            values = numbers(name, line, words, 1, 3)
            red, green, blue = (min(max(v, 0.0), 1.0) for v in (values * 3)[:3])
            current.colour = red, green, blue
        elif words[0] == "Ke" and words[1:2] not in (["spectral"], ["xyz"]):
            current.glows = max(numbers(name, line, words, 1, 3)) > 0
        elif words[0] in ("d", "Tr") and words[1:2] != ["-halo"]:
            (value,) = numbers(name, line, words, 1, 1)
            current.opacity = min(max(value if words[0] == "d" else 1.0 - value, 0.0), 1.0)
        elif words[0] == "map_Kd" and rest:
            current.image, current.line = map_file(words, rest), line
            current.clamps = "-clamp on" in " ".join(words).lower()
        elif words[0] == "map_d" and rest:
            current.clear_image = map_file(words, rest)
    return materials
