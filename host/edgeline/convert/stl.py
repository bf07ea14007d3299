"""STL, binary and ASCII: loose triangles. Normals are made anew, as most programs write them badly or as zeros.

No files are opened here. A binary file is known by its size, which its count of triangles gives to the byte.
"""

from __future__ import annotations

import numpy as np

from edgeline.convert.mesh import Floats
from edgeline.convert.obj import numbers, statements
from edgeline.convert.source import Part, Source, as_floats, check_count, check_positions
from edgeline.errors import EdgelineError

HEADER_BYTES = 84
TRIANGLE = np.dtype([("normal", "<f4", (3,)), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])

FOLLOWING = {
    "": ("solid",),
    "solid": ("facet", "endsolid"),
    "facet": ("outer",),
    "outer": ("vertex",),
    "vertex": ("vertex", "endloop"),
    "endloop": ("endfacet",),
    "endfacet": ("facet", "endsolid"),
    "endsolid": ("solid",),
}
"""What may come after each keyword of an ASCII file."""


def parse_stl(name: str, data: bytes) -> Source:
    """The triangles in `data`. Raises EdgelineError with the place for what cannot be meant."""
    expected = HEADER_BYTES + int.from_bytes(data[80:84], "little") * TRIANGLE.itemsize
    if len(data) >= HEADER_BYTES and len(data) == expected:
        positions = as_floats(np.frombuffer(data, TRIANGLE, offset=HEADER_BYTES)["corners"])
        lines = None
    elif data[:512].lstrip()[:5].lower() == b"solid" and b"\0" not in data:
        positions, lines = _ascii(name, data)
    elif len(data) < HEADER_BYTES:
        raise EdgelineError(
            f"{name}: {len(data)} bytes are no STL; it is cut short or of another kind, export it again"
        )
    else:
        what = "cut short" if len(data) < expected else "damaged or no STL"
        count = (expected - HEADER_BYTES) // TRIANGLE.itemsize
        raise EdgelineError(
            f"{name}: {len(data)} bytes, but its {count} triangles would be {expected}; it is {what}, export it again"
        )
    check_count(name, len(positions))
    return check_positions(
        Source(
            name=name,
            positions=positions,
            parts=(Part(""),),
            part_of=np.zeros(len(positions), dtype=np.int64),
            where=lambda row: f"{name}: triangle {row}" if lines is None else f"{name}:{lines[row]}",
        )
    )


def _ascii(name: str, data: bytes) -> tuple[Floats, list[int]]:
    """Corners (m, 3, 3) and the line of each triangle."""
    corners: list[list[float]] = []
    lines: list[int] = []
    before = ""
    in_loop = 0
    for line, words, _ in statements(name, data):
        keyword = words[0].lower()
        if keyword not in FOLLOWING[before]:
            wanted = " or ".join(FOLLOWING[before])
            raise EdgelineError(f"{name}:{line}: {words[0][:40]!r} where {wanted} is due; export the model again")
        if keyword == "vertex":
            corners.append(numbers(name, line, words, 3, 3))
            in_loop += 1
        elif keyword == "endloop":
            if in_loop != 3:
                raise EdgelineError(
                    f"{name}:{line}: a facet with {in_loop} corners; STL has triangles, export it again"
                )
            in_loop = 0
        elif keyword == "facet":
            lines.append(line)
        before = keyword
    if before != "endsolid":
        raise EdgelineError(f"{name}: it ends without endsolid; it is cut short, export it again")
    return np.array(corners, dtype=np.float64).reshape(-1, 3, 3), lines
