"""Meshes as the firmware holds them (`geometry/mesh.h`), and the step from floating-point triangles to them.

Triangles arrive as a soup: every corner with its own attributes. Quantising comes first and welding second, so that two
corners share a vertex exactly when the firmware could not tell them apart.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from edgeline.errors import EdgelineError

MAX_VERTICES = 65535
MAX_TRIANGLES = 61440
MIN_SCALE_LOG2 = -30
MAX_SCALE_LOG2 = 8
POSITION_LIMIT = 32767
NORMAL_ONE = 127
TEXEL_ONE = 16
"""One texel in Q12.4."""

CLUSTER = np.dtype(
    [
        ("triangle_count", "<u2"),
        ("vertex_count", "<u2"),
        ("centre", "<i2", (3,)),
        ("radius", "<u2"),
        ("axis", "i1", (3,)),
        ("spread", "u1"),
        ("altitude", "<u2"),
    ]
)
"""An `el_cluster`, 18 bytes."""

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Mesh:
    """An `el_mesh`, n vertices and m triangles; optional arrays are None. Raises EdgelineError where mesh.h forbids it.

    `centre` and `radius` are the bounding sphere in position units; they are computed when they are not given.
    """

    positions: npt.NDArray[np.int16]  # (n, 3), units of 2^scale_log2
    triangles: npt.NDArray[np.uint16]  # (m, 3), counter-clockwise seen from the front
    scale_log2: int
    colours: npt.NDArray[np.uint8] | None = None  # (n, 3) red, green, blue
    triangle_colours: npt.NDArray[np.uint8] | None = None  # (m, 3)
    normals: npt.NDArray[np.int8] | None = None  # (n, 3) unit vectors times 127
    uvs: npt.NDArray[np.int16] | None = None  # (n, 2) texels, Q12.4, v down
    centre: tuple[int, int, int] = (0, 0, 0)
    radius: int = -1
    clusters: npt.NDArray[np.void] | None = None  # (k,) of CLUSTER, all triangles and vertices in their order

    def __post_init__(self) -> None:
        n, m = len(self.positions), len(self.triangles)
        for name, array, shape, dtype in (
            ("positions", self.positions, (n, 3), np.int16),
            ("triangles", self.triangles, (m, 3), np.uint16),
            ("colours", self.colours, (n, 3), np.uint8),
            ("triangle_colours", self.triangle_colours, (m, 3), np.uint8),
            ("normals", self.normals, (n, 3), np.int8),
            ("uvs", self.uvs, (n, 2), np.int16),
        ):
            if array is not None and (array.shape != shape or array.dtype != dtype):
                raise EdgelineError(f"mesh {name}: {array.dtype}{array.shape} where {np.dtype(dtype)}{shape} is needed")
        check_triangle_count(m)
        check_vertex_count(n)
        if int(self.triangles.max()) >= n:
            text = f"mesh triangles: index {int(self.triangles.max())} with {n} vertices; convert the model again"
            raise EdgelineError(text)
        if not MIN_SCALE_LOG2 <= self.scale_log2 <= MAX_SCALE_LOG2:
            limits = f"it is 2^{MIN_SCALE_LOG2} to 2^{MAX_SCALE_LOG2}; convert the model again"
            raise EdgelineError(f"mesh scale 2^{self.scale_log2}: {limits}")
        if self.radius < 0:
            centre, radius = bounding_sphere(self.positions)
            object.__setattr__(self, "centre", centre)
            object.__setattr__(self, "radius", radius)
        elif enclosing_radius(self.positions, self.centre) > self.radius:
            raise EdgelineError("mesh bounding sphere: a vertex lies outside; convert the model again")
        if self.clusters is not None:
            self._check_clusters(self.clusters)

    def _check_clusters(self, clusters: npt.NDArray[np.void]) -> None:
        """Raises EdgelineError where the firmware's reader would refuse them."""
        sums = [int(clusters[name].astype(np.int64).sum()) for name in ("triangle_count", "vertex_count")]
        if clusters.dtype != CLUSTER or sums != [len(self.triangles), len(self.positions)]:
            raise EdgelineError("mesh clusters: they do not add up to its triangles and vertices; convert it again")
        triangle = 0
        for cluster in clusters:
            centre = tuple(int(c) for c in cluster["centre"])
            named = self.triangles[triangle : triangle + int(cluster["triangle_count"])].reshape(-1)
            triangle += int(cluster["triangle_count"])
            offset = sum((c - m) ** 2 for c, m in zip(centre, self.centre, strict=True))
            if offset > self.radius**2 or (
                len(named) > 0
                and enclosing_radius(self.positions[named], (centre[0], centre[1], centre[2])) > int(cluster["radius"])
            ):
                raise EdgelineError("mesh clusters: a vertex lies outside of its cluster's sphere; convert it again")

    @property
    def parts_bytes(self) -> dict[str, int]:
        """Of each array that there is."""
        arrays = {
            "positions": self.positions,
            "triangles": self.triangles,
            "colours": self.colours,
            "triangle_colours": self.triangle_colours,
            "normals": self.normals,
            "uvs": self.uvs,
            "clusters": self.clusters,
        }
        return {name: array.nbytes for name, array in arrays.items() if array is not None}

    @property
    def flash_bytes(self) -> int:
        """Bytes of the arrays."""
        return sum(self.parts_bytes.values())


@dataclass(frozen=True)
class Soup:
    """m triangles, each corner for itself, counter-clockwise. Positions in world units, uvs in texels with v down."""

    positions: Floats  # (m, 3 corners, 3)
    normals: Floats | None = None  # (m, 3 corners, 3), unit length
    uvs: Floats | None = None  # (m, 3 corners, 2)
    colours: npt.NDArray[np.uint8] | None = None  # (m, 3 corners, 3)
    triangle_colours: npt.NDArray[np.uint8] | None = None  # (m, 3)


@dataclass(frozen=True)
class Quantised:
    """A mesh, the largest position error in world units and their root mean square over coordinates, and how many
    triangles had no area left."""

    mesh: Mesh
    position_error: float
    position_rms: float
    dropped_triangles: int


SPLIT_ADVICE = "split the model into several meshes, or simplify it with --triangles"


def check_triangle_count(count: int) -> None:
    """Raises EdgelineError when a mesh cannot have that many triangles."""
    if count == 0:
        raise EdgelineError("no triangle with an area: there is nothing to draw in this model")
    if count > MAX_TRIANGLES:
        raise EdgelineError(f"{count} triangles: a mesh holds {MAX_TRIANGLES} at most; {SPLIT_ADVICE}")


def check_vertex_count(count: int) -> None:
    """Raises EdgelineError when a mesh cannot have that many vertices."""
    if count > MAX_VERTICES:
        raise EdgelineError(f"{count} vertices: a mesh holds {MAX_VERTICES} at most; {SPLIT_ADVICE}")


def scale_log2_for(extent: float) -> int:
    """The smallest scale with which coordinates up to +-`extent` world units fit 16 bits.

    Raises EdgelineError when none does.
    """
    log2 = MIN_SCALE_LOG2
    while round(math.ldexp(extent, -log2)) > POSITION_LIMIT:
        log2 += 1
        if log2 > MAX_SCALE_LOG2:
            limit = math.ldexp(POSITION_LIMIT, MAX_SCALE_LOG2)
            raise EdgelineError(f"coordinates reach {extent:g}, {limit:g} can be stored; make it smaller with --scale")
    return log2


def enclosing_radius(positions: npt.NDArray[np.int16] | Ints, centre: tuple[int, int, int]) -> int:
    """The smallest whole radius around `centre` that reaches every position; exact."""
    offsets = positions.astype(np.int64) - np.asarray(centre, dtype=np.int64)
    squared = int((offsets * offsets).sum(axis=1).max())
    root = math.isqrt(squared)
    return root if root * root == squared else root + 1


def bounding_sphere(positions: npt.NDArray[np.int16] | Ints, steps: int = 256) -> tuple[tuple[int, int, int], int]:
    """A nearly smallest sphere around `positions`: whole centre, radius rounded up.

    Badoiu and Clarkson's iteration ("Smaller core-sets for balls", SODA 2003): step towards the farthest point by
    1/(i+1) of the way. In integers (Q8), so that every machine gets the same sphere.
    """
    points_q8 = positions.astype(np.int64) << 8
    centre_q8 = (points_q8.min(axis=0) + points_q8.max(axis=0)) >> 1
    best: tuple[tuple[int, int, int], int] | None = None
    for i in range(1, steps + 1):
        x, y, z = (int(c) for c in (centre_q8 + 128) >> 8)
        radius = enclosing_radius(positions, (x, y, z))
        if best is None or radius < best[1]:
            best = (x, y, z), radius
        offsets = points_q8 - centre_q8
        farthest = int((offsets * offsets).sum(axis=1).argmax())
        centre_q8 = centre_q8 + offsets[farthest] // (i + 1)
    assert best is not None
    return best


def weld(corners: Ints | Floats) -> tuple[Ints, Ints]:
    """Equal rows of `corners` (k, columns) become one vertex.

    Returns the row of each vertex's first appearance, in that order, and the vertex of each corner (k,).
    """
    _, first, vertex_of = np.unique(corners, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first, kind="stable")
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return first[order].astype(np.int64), rank[vertex_of.reshape(-1)].astype(np.int64)


def has_area(corners: Ints | Floats) -> npt.NDArray[np.bool_]:
    """Which of the triangles (m, 3, 3) in position units are not degenerate; exact."""
    product = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return np.asarray(np.any(product != 0, axis=1))


def quantise(soup: Soup, scale_log2: int | None = None) -> Quantised:
    """Makes a mesh of `soup`, by default at the smallest scale that holds it. Raises EdgelineError where limits are
    exceeded."""
    if scale_log2 is None:
        scale_log2 = scale_log2_for(float(np.abs(soup.positions).max(initial=0.0)))
    exact = np.ldexp(soup.positions, -scale_log2)
    positions = np.rint(exact).astype(np.int64)
    apart = positions - exact
    error = math.ldexp(float(np.abs(apart).max(initial=0.0)), scale_log2)
    rms = math.ldexp(math.sqrt(float((apart * apart).sum()) / max(1, apart.size)), scale_log2)
    keep = has_area(positions)
    check_triangle_count(int(keep.sum()))
    columns = [positions[keep]]
    if soup.normals is not None:
        columns.append(np.rint(soup.normals[keep] * NORMAL_ONE).astype(np.int64))
    if soup.uvs is not None:
        columns.append(np.rint(soup.uvs[keep] * TEXEL_ONE).astype(np.int64))
    if soup.colours is not None:
        columns.append(soup.colours[keep].astype(np.int64))
    rows = np.concatenate(columns, axis=2).reshape(-1, sum(c.shape[2] for c in columns))
    first, vertex_of = weld(rows)
    check_vertex_count(len(first))
    parts = iter(np.split(rows[first], np.cumsum([c.shape[2] for c in columns])[:-1], axis=1))
    mesh = Mesh(
        positions=next(parts).astype(np.int16),
        triangles=vertex_of.reshape(-1, 3).astype(np.uint16),
        scale_log2=scale_log2,
        normals=None if soup.normals is None else next(parts).astype(np.int8),
        uvs=None if soup.uvs is None else next(parts).astype(np.int16),
        colours=None if soup.colours is None else next(parts).astype(np.uint8),
        triangle_colours=None if soup.triangle_colours is None else soup.triangle_colours[keep],
    )
    return Quantised(mesh, error, rms, int((~keep).sum()))
