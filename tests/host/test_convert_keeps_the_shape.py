"""Triangulating, smoothing, quantising and welding keep the model: its area, its winding, its positions, its edges."""

from __future__ import annotations

import math
import random
from collections.abc import Callable

import numpy as np
import pytest

from converting import soup_from
from edgeline.convert import mesh as mesh_module
from edgeline.convert.mesh import Floats, Soup, bounding_sphere, enclosing_radius, quantise, scale_log2_for
from edgeline.convert.normals import face_vectors, smooth_normals
from edgeline.convert.obj import parse_obj
from edgeline.convert.triangulate import newell_normal, triangulate
from edgeline.errors import EdgelineError

CUBE = "".join(f"v {x} {y} {z}\n" for z in (0, 1) for y in (0, 1) for x in (0, 1)) + (
    "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n"
)


def rotation(source: random.Random) -> Floats:
    """A random rotation matrix from a unit quaternion."""
    w, x, y, z = (source.gauss(0, 1) for _ in range(4))
    n = math.sqrt(w * w + x * x + y * y + z * z)
    w, x, y, z = w / n, x / n, y / n, z / n
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def star(source: random.Random, corners: int) -> Floats:
    """A simple polygon around the origin, mostly concave, in a random plane."""
    angles = [(i + 0.9 * source.random()) / corners * 2 * math.pi for i in range(corners)]
    flat = [(r * math.cos(a), r * math.sin(a), 0.0) for a in angles for r in [source.uniform(0.2, 1.0)]]
    return np.asarray(np.array(flat) @ rotation(source).T)


def untangled(source: random.Random, corners: int) -> Floats:
    """A simple polygon through random points: where two of its edges cross, the way between them is turned around."""
    points = [(source.random(), source.random()) for _ in range(corners)]

    def left(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> bool:
        return (b[0] - a[0]) * (c[1] - a[1]) > (b[1] - a[1]) * (c[0] - a[0])

    def untangle_one() -> bool:
        for i in range(corners - 2):
            for j in range(i + 2, corners - (i == 0)):
                a, b, c, d = points[i], points[i + 1], points[j], points[(j + 1) % corners]
                if left(a, b, c) != left(a, b, d) and left(c, d, a) != left(c, d, b):
                    points[i + 1 : j + 1] = points[i + 1 : j + 1][::-1]
                    return True
        return False

    while untangle_one():
        pass
    return np.asarray(np.array([(x, y, 0.0) for x, y in points]) @ rotation(source).T)


@pytest.mark.parametrize("seed", range(200))
@pytest.mark.parametrize("make", [star, untangled])
def test_polygons_become_triangles_of_the_same_area_and_winding(
    make: Callable[[random.Random, int], Floats], seed: int
) -> None:
    source = random.Random(seed)
    polygon = make(source, source.randint(3, 24))
    triangles = triangulate(polygon)
    assert len(triangles) == len(polygon) - 2
    normal = newell_normal(polygon)
    areas = [newell_normal(polygon[list(triangle)]) @ normal for triangle in triangles]
    assert min(areas) >= -1e-12, "a triangle turned over, or outside the polygon"
    assert math.isclose(sum(areas), normal @ normal, rel_tol=1e-9)


@pytest.mark.parametrize("concave", range(4))
def test_arrow_heads_are_cut_at_their_dent(concave: int) -> None:
    arrow = np.roll(np.array([(0, 0, 0), (2, 1, 0), (0, 2, 0), (0.5, 1, 0)], dtype=np.float64), concave, axis=0)
    dent = (3 + concave) % 4
    assert all(dent in triangle for triangle in triangulate(arrow))


def test_polygons_with_a_bridge_to_a_hole() -> None:
    outer = [(0, 0), (4, 0), (4, 4), (0, 4)]
    hole = [(1, 1), (1, 3), (3, 3), (3, 1)]
    points = np.array([(x, y, 0) for x, y in [*outer, outer[0], hole[0], *hole[1:], hole[0]]], dtype=np.float64)
    doubled = [newell_normal(points[list(t)])[2] for t in triangulate(points)]
    assert min(doubled) >= 0
    assert sum(doubled) == 2 * (16 - 4)


def test_crossing_polygons_end() -> None:
    bow = np.array([(0, 0, 0), (1, 1, 0), (1, 0, 0), (0, 1, 0)], dtype=np.float64)
    assert len(triangulate(bow)) == 2
    assert len(triangulate(np.zeros((7, 3)))) == 5


def test_a_cube_keeps_its_edges_and_shares_what_it_can() -> None:
    model = parse_obj("cube.obj", CUBE.encode())
    sharp = quantise(soup_from(model, {}, None)).mesh
    assert (len(sharp.triangles), len(sharp.positions)) == (12, 24)
    round_cube = quantise(soup_from(model, {}, None, crease_degrees=180)).mesh
    assert (len(round_cube.triangles), len(round_cube.positions)) == (12, 8)
    bare = quantise(soup_from(model, {}, None, normals=False)).mesh
    assert bare.normals is None
    assert len(bare.positions) == 8
    assert sharp.normals is not None
    corners = sharp.positions.astype(np.float64)[sharp.triangles]
    faces = face_vectors(corners)
    faces /= np.linalg.norm(faces, axis=1, keepdims=True)
    assert np.array_equal(sharp.normals[sharp.triangles], np.repeat(faces[:, None] * 127, 3, axis=1))
    assert np.all(((corners.mean(axis=1) - corners.reshape(-1, 3).mean(axis=0)) * faces).sum(axis=1) > 0)


def test_normals_weigh_by_area() -> None:
    # A big and a small face meet at 60 degrees along an edge; the big one is three times as large.
    c, s = math.cos(math.radians(120)), math.sin(math.radians(120))
    positions = np.array([[(0, 0, 0), (0, 1, 0), (-3, 0, 0)], [(0, 1, 0), (0, 0, 0), (-c, 0, s)]], dtype=np.float64)
    vectors = face_vectors(positions)
    expected = vectors.sum(axis=0) / np.linalg.norm(vectors.sum(axis=0))
    smooth = smooth_normals(positions, 180)
    assert np.allclose(smooth[0, 0], expected)
    assert np.allclose(smooth[1, 0], expected)
    assert np.allclose(smooth[0, 2], vectors[0] / np.linalg.norm(vectors[0]))


def test_normals_of_the_file_are_kept_and_missing_ones_made() -> None:
    text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 3 4\nvn 0 0 0\nf 1//1 2//2 3\n"
    normals = soup_from(parse_obj("m.obj", text.encode()), {}, None).normals
    assert normals is not None
    assert np.allclose(normals[0], [(0, 0.6, 0.8), (0, 0, 1), (0, 0, 1)])


@pytest.mark.parametrize("extent", [1e-12, 1e-5, 0.5, 0.99998, 1.0, 3.7, 32767.0, 32767.49, 32767.5, 8388352.0])
def test_scale_is_the_smallest_that_holds(extent: float) -> None:
    log2 = scale_log2_for(extent)
    assert round(math.ldexp(extent, -log2)) <= 32767
    assert log2 == mesh_module.MIN_SCALE_LOG2 or round(math.ldexp(extent, 1 - log2)) > 32767


def test_models_too_large_to_store_are_refused() -> None:
    with pytest.raises(EdgelineError, match="make it smaller with --scale"):
        scale_log2_for(8388500.0)


@pytest.mark.parametrize("seed", range(50))
def test_positions_are_rounded_to_nearest_and_the_error_is_reported(seed: int) -> None:
    numbers = np.random.default_rng(seed)
    soup = Soup(numbers.normal(size=(40, 3, 3)) * 10.0 ** numbers.integers(-4, 5))
    result = quantise(soup)
    stored = np.ldexp(result.mesh.positions.astype(np.float64), result.mesh.scale_log2)[result.mesh.triangles]
    assert np.abs(stored - soup.positions).max() == pytest.approx(result.position_error, rel=1e-6)
    rms = np.sqrt(((stored - soup.positions) ** 2).mean())
    assert rms == pytest.approx(result.position_rms, rel=1e-6)
    assert result.position_error <= math.ldexp(0.5, result.mesh.scale_log2)


@pytest.mark.parametrize("seed", range(100))
def test_the_bounding_sphere_holds_every_vertex_and_is_tight(seed: int) -> None:
    numbers = np.random.default_rng(seed)
    count = int(numbers.integers(1, 200))
    spread = int(numbers.integers(1, 32768))
    positions = numbers.integers(-spread, spread, size=(count, 3)).astype(np.int16)
    centre, radius = bounding_sphere(positions)
    distances = np.sqrt(((positions.astype(np.int64) - np.array(centre)) ** 2).sum(axis=1).astype(np.float64))
    assert distances.max() <= radius < distances.max() + 1
    middle = (positions.astype(np.int64).min(axis=0) + positions.astype(np.int64).max(axis=0)) // 2
    assert radius <= enclosing_radius(positions, (int(middle[0]), int(middle[1]), int(middle[2]))) + 1


def test_triangles_without_area_are_dropped_and_counted() -> None:
    good = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
    lines = [(0, 0, 0), (0.5, 0.5, 0.5), (1, 1, 1)]
    points = [(1, 1, 1)] * 3
    result = quantise(Soup(np.array([lines, good, points], dtype=np.float64)))
    assert result.dropped_triangles == 2
    assert len(result.mesh.triangles) == 1
    with pytest.raises(EdgelineError, match="no triangle with an area"):
        quantise(Soup(np.array([lines, points], dtype=np.float64)))
    with pytest.raises(EdgelineError, match="no triangle with an area"):
        quantise(Soup(np.zeros((0, 3, 3))))


def ribbon(count: int) -> Floats:
    """`count` triangles in a strip, (count, 3, 3), with count + 2 vertices."""
    i = np.arange(count)
    points = np.stack([np.arange(count + 2) // 2, np.arange(count + 2) % 2 * 5, np.zeros(count + 2)], axis=1)
    return points[np.stack([i, i + 1, i + 2], axis=1)].astype(np.float64)


def test_limits_are_met_and_not_crossed() -> None:
    assert len(quantise(Soup(ribbon(61440))).mesh.triangles) == 61440
    with pytest.raises(EdgelineError, match=r"^61441 triangles: a mesh holds 61440 at most; split"):
        quantise(Soup(ribbon(61441)))
    apart = np.arange(3 * 21846, dtype=np.float64)
    separate = np.stack([apart % 256, apart // 256, (apart % 3) ** 2], axis=1).reshape(-1, 3, 3)
    assert len(quantise(Soup(separate[:21845])).mesh.positions) == 65535
    with pytest.raises(EdgelineError, match=r"^65538 vertices: a mesh holds 65535 at most; split"):
        quantise(Soup(separate))
