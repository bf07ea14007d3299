"""Clusters of a mesh: parts that the firmware skips whole, outside the view or facing away (`geometry/cluster.h`).

A cluster grows over the edges of its triangles, towards those that lie near and face alike, so that its sphere and its
cone of normals stay small; what is not connected follows along a Morton curve. The mesh's triangles and vertices are
put into the clusters' order. All decisions are made from sums in a fixed order: the same mesh gives the same bytes.
"""

from __future__ import annotations

import heapq
import math
from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from edgeline.convert.mesh import CLUSTER, Ints, Mesh, bounding_sphere, enclosing_radius

MOST_TRIANGLES = 24
FEWEST_TRIANGLES = 8
"""Smaller ones join a neighbour."""
WORTHWHILE = 64
"""Triangles of a mesh that gets clusters at all."""
LEAST_ALIKE = math.cos(math.radians(30))
"""Cosine between a triangle's normal and its cluster's."""
NO_CONE = 255
SPHERE_STEPS = 24
REMEMBERED = 8
FORGETTING = 0.3
"""How many clusters back shared vertices count, and how much less for each."""

Vector = tuple[float, float, float]


def _dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _plus(a: Vector, b: Vector) -> Vector:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def _unit(a: Vector) -> Vector:
    length = math.sqrt(_dot(a, a))
    return (a[0] / length, a[1] / length, a[2] / length) if length > 0 else (0.0, 0.0, 0.0)


def _vectors(rows: npt.NDArray[np.generic]) -> list[Vector]:
    return [(float(x), float(y), float(z)) for x, y, z in rows.tolist()]


@dataclass(frozen=True)
class _Shape:
    """What growing looks at, per triangle."""

    normals: list[Vector]  # unit length
    middles: list[Vector]  # position units
    neighbours: list[list[int]]  # over an edge, by position
    order: list[int]  # along a Morton curve


def _neighbours(positions: Ints, triangles: Ints) -> list[list[int]]:
    """Triangles that share an edge; vertices at one place count as one."""
    _, place = np.unique(positions, axis=0, return_inverse=True)
    corners = place.reshape(-1)[triangles]
    at_edge: defaultdict[tuple[int, int], list[int]] = defaultdict(list)
    for i, (a, b, c) in enumerate(corners.tolist()):
        for edge in ((a, b), (b, c), (c, a)):
            at_edge[min(edge), max(edge)].append(i)
    found: list[list[int]] = [[] for _ in range(len(triangles))]
    for sharing in at_edge.values():
        for i in sharing[:8]:
            found[i] += [k for k in sharing[:8] if k != i]
    return found


def _morton(middles: Ints) -> list[int]:
    """The triangles along a Morton curve through the mesh's box, 1024 steps to a side."""
    low, high = middles.min(axis=0), middles.max(axis=0)
    cells = (middles - low) * 1023 // np.maximum(high - low, 1).max()
    keys = np.zeros(len(middles), dtype=np.int64)
    for bit in range(10):
        for axis in range(3):
            keys |= ((cells[:, axis] >> bit) & 1) << (3 * bit + axis)
    return [int(i) for i in np.argsort(keys, kind="stable")]


def _shape(mesh: Mesh) -> _Shape:
    positions = mesh.positions.astype(np.int64)
    triangles = mesh.triangles.astype(np.int64)
    corners = positions[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    middles = corners.sum(axis=1) // 3
    return _Shape(
        [_unit(n) for n in _vectors(normals)], _vectors(middles), _neighbours(positions, triangles), _morton(middles)
    )


def _grow(shape: _Shape) -> list[list[int]]:
    """Triangles by cluster."""
    left = [True] * len(shape.normals)
    clusters: list[list[int]] = []
    cursor = 0
    while cursor < len(shape.order):
        seed = shape.order[cursor]
        if not left[seed]:
            cursor += 1
            continue
        clusters.append(_grow_from(seed, shape, left, cursor))
    return clusters


def _grow_from(seed: int, shape: _Shape, left: list[bool], cursor: int) -> list[int]:
    members: list[int] = []
    axis: Vector = (0.0, 0.0, 0.0)
    reach = 0.0
    heap = [(0.0, seed)]
    while len(members) < MOST_TRIANGLES:
        if not heap:
            # Loose triangles go on with the next on the curve; a connected patch ends at its edges.
            near = shape.order[cursor : cursor + (0 if shape.neighbours[seed] else 4 * MOST_TRIANGLES)]
            heap = [(0.0, k) for k in near if left[k] and _is_near(shape, seed, k, 3.0 * reach)][:1]
            if not heap:
                break
        _, i = heapq.heappop(heap)
        if not left[i]:
            continue
        left[i] = False
        members.append(i)
        axis = _plus(axis, shape.normals[i])
        reach = max(reach, math.dist(shape.middles[seed], shape.middles[i]))
        towards = _unit(axis)
        for k in shape.neighbours[i]:
            alike = _dot(towards, shape.normals[k])
            if left[k] and alike >= LEAST_ALIKE:
                distance = math.dist(shape.middles[seed], shape.middles[k])
                heapq.heappush(heap, (distance * (2.0 - alike), k))
    return members


def _is_near(shape: _Shape, a: int, b: int, limit: float) -> bool:
    """Within `limit` position units, if that is one yet."""
    return limit == 0.0 or math.dist(shape.middles[a], shape.middles[b]) <= limit


def _join_small(clusters: list[list[int]], shape: _Shape) -> list[list[int]]:
    """A small cluster joins the neighbour that faces most alike, if that has room for it."""
    cluster_of = {i: number for number, members in enumerate(clusters) for i in members}
    axes = [_axis(members, shape) for members in clusters]
    for number, members in enumerate(clusters):
        if len(members) >= FEWEST_TRIANGLES:
            continue
        beside = sorted({cluster_of[k] for i in members for k in shape.neighbours[i]} - {number})
        fitting = [k for k in beside if len(clusters[k]) + len(members) <= MOST_TRIANGLES + FEWEST_TRIANGLES]
        if fitting:
            into = max(fitting, key=lambda k: _dot(axes[number], axes[k]))
            clusters[into] += members
            cluster_of |= dict.fromkeys(members, into)
            axes[into] = _axis(clusters[into], shape)
            clusters[number] = []
    return [members for members in clusters if members]


def _axis(members: list[int], shape: _Shape) -> Vector:
    total: Vector = (0.0, 0.0, 0.0)
    for i in members:
        total = _plus(total, shape.normals[i])
    return _unit(total)


def _cone(corners: Ints) -> tuple[tuple[int, int, int], int]:
    """Axis (about 127 long) and spread of the normals of triangles (k, 3, 3)."""
    normals = _vectors(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    total: Vector = (0.0, 0.0, 0.0)
    for normal in normals:
        total = _plus(total, _unit(normal))
    x, y, z = (round(127 * c) for c in _unit(total))
    axis = _unit((x, y, z))
    least = min(_dot(axis, _unit(normal)) for normal in normals)
    if least <= 0.0:
        return (x, y, z), NO_CONE
    spread = math.ceil(256 * math.sqrt(max(0.0, 1.0 - least * least)) + 0.01)
    return (x, y, z), min(spread, NO_CONE)


def _least_altitude(corners: Ints) -> int:
    """Of triangles (k, 3, 3): twice the area by the longest side, rounded down; exact."""
    least = 65535
    for a, b, c in corners.tolist():
        sides = [[q - p for p, q in zip(*pair, strict=True)] for pair in ((a, b), (b, c), (c, a))]
        (ux, uy, uz), (vx, vy, vz) = sides[0], sides[1]
        doubled = (uy * vz - uz * vy) ** 2 + (uz * vx - ux * vz) ** 2 + (ux * vy - uy * vx) ** 2
        longest = max(x * x + y * y + z * z for x, y, z in sides)
        least = min(least, math.isqrt(doubled // longest) if longest > 0 else 0)
    return least


def _cluster(mesh: Mesh, corners: Ints, vertex_count: int) -> tuple[object, ...]:
    """One record of CLUSTER for triangles (k, 3, 3)."""
    points = np.unique(corners.reshape(-1, 3), axis=0)
    centre, radius = bounding_sphere(points, SPHERE_STEPS)
    if math.dist(centre, mesh.centre) > mesh.radius:  # rounding, of a mesh that is hardly larger
        x, y, z = (int(c) for c in points[0])
        centre, radius = (x, y, z), enclosing_radius(points, (x, y, z))
    axis, spread = _cone(corners)
    return len(corners), vertex_count, centre, radius, axis, spread, _least_altitude(corners)


def _chained(clusters: list[list[int]], triangles: Ints) -> list[list[int]]:
    """The same clusters, each followed by the one that shares most with the last few."""
    vertices = [set(triangles[members].reshape(-1).tolist()) for members in clusters]
    users: defaultdict[int, list[int]] = defaultdict(list)
    for number, named in enumerate(vertices):
        for vertex in sorted(named):
            users[vertex].append(number)
    left = dict.fromkeys(range(len(clusters)))
    order: list[int] = []
    while left:
        shared: defaultdict[int, float] = defaultdict(float)
        for age, number in enumerate(reversed(order[-REMEMBERED:])):
            for vertex in sorted(vertices[number]):
                for user in users[vertex]:
                    if user in left:
                        shared[user] += 1.0 / (1.0 + FORGETTING * age)
        following = max(sorted(shared), key=lambda k: shared[k] / len(vertices[k])) if shared else next(iter(left))
        order.append(following)
        del left[following]
    return [clusters[number] for number in order]


def with_clusters(mesh: Mesh, cost: Callable[[Mesh], float] | None = None) -> Mesh:
    """`mesh` in the order of its clusters, with them; as it is where it has too few triangles.

    They follow a curve through the mesh; with a `cost`, or each other by the vertices they share, if that costs less.
    """
    if len(mesh.triangles) < WORTHWHILE:
        return mesh
    shape = _shape(mesh)
    clusters = _join_small(_grow(shape), shape)
    best = _arranged(mesh, clusters)
    if cost is not None:
        chained = _chained(clusters, mesh.triangles.astype(np.int64))
        other = _arranged(mesh, chained)
        if cost(other) < cost(best):
            clusters, best = chained, other
    return replace(best, clusters=_describe(best, [len(members) for members in clusters]))


def _arranged(mesh: Mesh, clusters: list[list[int]]) -> Mesh:
    """`mesh` with its triangles as the clusters have them, its vertices as the triangles first name them."""
    order = np.concatenate([np.asarray(members, dtype=np.int64) for members in clusters])
    named = mesh.triangles[order].astype(np.int64)
    first, position = np.unique(named.reshape(-1), return_index=True)
    by_use = first[np.argsort(position, kind="stable")]
    unused = np.setdiff1d(np.arange(len(mesh.positions)), by_use)
    vertices = np.concatenate([by_use, unused])
    rank = np.empty(len(vertices), dtype=np.int64)
    rank[vertices] = np.arange(len(vertices))
    triangles = rank[named]
    return replace(
        mesh,
        positions=mesh.positions[vertices],
        triangles=triangles.astype(np.uint16),
        colours=None if mesh.colours is None else mesh.colours[vertices],
        triangle_colours=None if mesh.triangle_colours is None else mesh.triangle_colours[order],
        normals=None if mesh.normals is None else mesh.normals[vertices],
        uvs=None if mesh.uvs is None else mesh.uvs[vertices],
    )


def _describe(mesh: Mesh, counts: list[int]) -> npt.NDArray[np.void]:
    """The records of clusters of so many triangles each, in the mesh's order."""
    corners = mesh.positions.astype(np.int64)[mesh.triangles.astype(np.int64)]
    records = []
    triangle = vertex = 0
    for number, count in enumerate(counts):
        end = triangle + count
        last = number == len(counts) - 1
        reached = len(mesh.positions) if last else max(vertex, int(mesh.triangles[triangle:end].max()) + 1)
        records.append(_cluster(mesh, corners[triangle:end], reached - vertex))
        triangle, vertex = end, reached
    return np.array(records, dtype=CLUSTER)


def in_order(mesh: Mesh, most: int = MOST_TRIANGLES) -> Mesh:
    """`mesh` with clusters of its triangles as they stand, `most` to each: for meshes whose order is given."""
    total = len(mesh.triangles)
    return replace(mesh, clusters=_describe(mesh, [min(most, total - begin) for begin in range(0, total, most)]))
