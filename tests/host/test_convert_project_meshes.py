"""The committed mesh headers are what the generators make, and the meshes are sound: closed, outward, in range."""

from __future__ import annotations

import os
import sys
from collections import Counter
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

ROOT = Path(__file__).resolve().parents[2]
APPS = ROOT / "firmware" / "apps"
SCENES = ROOT.parent / "shared" / "bench" / "scenes.npz"
sys.path.insert(0, str(APPS))

from edgeline.convert.header import NamedMesh  # noqa: E402
from edgeline.convert.normals import face_vectors  # noqa: E402
from mesh_sources import bench, demo, headers  # noqa: E402

Edge = tuple[int, int]
MESHES = demo.all_meshes()


def world_corners(named: NamedMesh) -> npt.NDArray[np.float64]:
    """The corners of the triangles in world units, (m, 3, 3)."""
    return np.ldexp(named.mesh.positions.astype(np.float64), named.mesh.scale_log2)[named.mesh.triangles]


def edges(named: NamedMesh) -> Counter[Edge]:
    """How often each directed edge occurs, vertices at the same position taken as one."""
    _, place = np.unique(named.mesh.positions, axis=0, return_inverse=True)
    corners = place.reshape(-1)[named.mesh.triangles]
    return Counter((int(a), int(b)) for t in corners for a, b in zip(t, np.roll(t, -1), strict=True))


def open_edges(named: NamedMesh) -> list[Edge]:
    found = edges(named)
    return [edge for edge in found if found[edge[1], edge[0]] != found[edge]]


@pytest.mark.parametrize("name", MESHES)
def test_demo_headers_are_what_the_generators_make(name: str) -> None:
    assert (APPS / "demo" / "meshes" / f"{name}.h").read_text() == headers.demo_headers()[name]


def test_every_committed_header_has_a_generator() -> None:
    assert {path.stem for path in (APPS / "demo" / "meshes").iterdir()} == set(MESHES)
    assert {path.stem for path in (APPS / "bench" / "meshes").iterdir()} == set(bench.ABOUT)


@pytest.mark.parametrize("name", MESHES)
def test_no_edge_is_walked_twice_in_one_direction(name: str) -> None:
    assert max(edges(MESHES[name]).values()) == 1


def test_the_solid_is_closed_and_faces_outwards() -> None:
    assert open_edges(MESHES["solid"]) == []
    corners = world_corners(MESHES["solid"])
    assert np.all((face_vectors(corners) * corners.mean(axis=1)).sum(axis=1) > 0)
    assert len(np.unique(MESHES["solid"].mesh.positions, axis=0)) == 60
    assert MESHES["solid"].mesh.triangle_colours is not None
    assert len(np.unique(MESHES["solid"].mesh.triangle_colours, axis=0)) == 32


def test_the_teapot_is_open_only_where_handle_and_spout_enter_the_body() -> None:
    mesh = MESHES["teapot"].mesh
    places = np.ldexp(np.unique(mesh.positions, axis=0).astype(np.float64), mesh.scale_log2)
    ends = places[sorted({vertex for edge in open_edges(MESHES["teapot"]) for vertex in edge})]
    assert len(ends) == 30
    x, y = ends[:, 0], ends[:, 1]
    unit = 2.0**mesh.scale_log2
    upper_end = (x >= -1.6 - unit) & (x <= -1.5 + unit) & (y >= 0.525 - unit) & (y <= 0.75 + unit)
    lower_end = (x >= -2.0 - unit) & (x <= -1.9 + unit) & (y >= -0.9 - unit) & (y <= -0.6 + unit)
    spout = np.abs(x - 1.7) <= unit
    assert [int(part.sum()) for part in (upper_end, lower_end, spout)] == [10, 10, 10]


def test_the_teapot_faces_outwards_and_its_normals_agree() -> None:
    mesh = MESHES["teapot"].mesh
    assert 1000 <= len(mesh.triangles) <= 1650
    assert mesh.normals is not None
    corners = world_corners(MESHES["teapot"])
    faces = face_vectors(corners)
    assert np.sum(corners[:, 0] * np.cross(corners[:, 1], corners[:, 2])) / 6 > 20
    normals = mesh.normals.astype(np.float64)
    assert np.all(np.abs(np.linalg.norm(normals, axis=1) - 127) < 1)
    cosines = (normals[mesh.triangles] * faces[:, None]).sum(axis=2) / 127 / np.linalg.norm(faces, axis=1)[:, None]
    # The spout's lip turns by more than half a circle within two of its triangles' widths.
    lip = (corners[..., 0].max(axis=1) > 2.8) & (corners[..., 1].min(axis=1) > 0.9)
    assert cosines[~lip].min() > 0.5
    assert np.count_nonzero(cosines < 0) <= 3


def test_poles_of_the_teapot_look_up_and_down() -> None:
    mesh = MESHES["teapot"].mesh
    assert mesh.normals is not None
    at_pole = np.all(mesh.positions[:, [0, 2]] == 0, axis=1)
    heights = np.ldexp(mesh.positions[at_pole, 1].astype(np.float64), mesh.scale_log2)
    found = {round(float(y), 2): normal for y, normal in zip(heights, mesh.normals[at_pole].tolist(), strict=True)}
    assert found == {1.65: [0, 127, 0], -1.5: [0, -127, 0]}


def test_the_island_is_many_small_triangles_that_look_up() -> None:
    mesh = MESHES["field"].mesh
    assert len(mesh.triangles) >= 2000
    assert np.all(face_vectors(world_corners(MESHES["field"]))[:, 1] > 0)
    assert mesh.normals is not None
    assert mesh.normals[:, 1].min() > 0


def first_hits(named: NamedMesh, origin: npt.NDArray[np.float64], way: npt.NDArray[np.float64]) -> float:
    """Turn of the first triangle that a ray meets: above 0 when it shows its front; 0 when it meets none."""
    a, b, c = (world_corners(named)[:, i] for i in range(3))
    ab, ac = b - a, c - a
    p = np.cross(way, ac)
    determinant = (ab * p).sum(axis=1)
    usable = np.abs(determinant) > 1e-12
    scale = 1 / np.where(usable, determinant, 1.0)
    s = origin - a
    u = (s * p).sum(axis=1) * scale
    q = np.cross(s, ab)
    v = (q @ way) * scale
    t = (ac * q).sum(axis=1) * scale
    hit = usable & (u >= 0) & (v >= 0) & (u + v <= 1) & (t > 1e-9)
    return float(determinant[hit][np.argmin(t[hit])]) if hit.any() else 0.0


def test_whoever_stands_in_the_room_sees_fronts_everywhere() -> None:
    numbers = np.random.default_rng(11)
    for _ in range(400):
        origin = np.array([numbers.uniform(-0.9, 0.9), numbers.uniform(0.2, 1.9), numbers.uniform(-4.9, 4.9)])
        way = numbers.normal(size=3)
        assert first_hits(MESHES["room"], origin, way) > 0, f"a gap or a back face from {origin} towards {way}"


def test_every_strip_of_the_room_stays_within_its_material() -> None:
    mesh = MESHES["room"].mesh
    assert mesh.uvs is not None
    v = mesh.uvs[mesh.triangles][..., 1].astype(np.int64)
    strip = v.min(axis=1) // (32 * 16)
    assert np.all(v.min(axis=1) >= strip * 512 + 4)
    assert np.all(v.max(axis=1) <= (strip + 1) * 512 - 4)


def scenes() -> bench.Scenes:
    if not SCENES.is_file():
        assert "CI" not in os.environ, "the benchmark's scenes.npz is absent"
        pytest.skip("the benchmark's scenes.npz is absent")
    return bench.load(SCENES)


def test_bench_headers_are_what_the_scenes_make() -> None:
    scenes()
    for name, text in headers.bench_headers(SCENES).items():
        assert (APPS / "bench" / "meshes" / f"{name}.h").read_text() == text


@pytest.mark.parametrize("name", list(bench.ABOUT))
def test_bench_meshes_are_exact(name: str) -> None:
    """Every triangle of the scene is there once, in order within its mesh, with its exact corners and attributes."""
    data = scenes()
    key = name.upper()
    corners = data[f"{key}_vertices"].astype(np.int64)[data[f"{key}_triangles"]]
    waiting = np.arange(len(corners))
    for named in bench.all_scenes(data)[name]:
        mesh = named.mesh
        offset_q16 = np.array(named.offset_q16 or (0, 0, 0), dtype=np.int64)
        assert not np.any(offset_q16 % 128)
        stored = mesh.positions.astype(np.int64)[mesh.triangles] + offset_q16 // 128
        at = {row.tobytes(): i for i, row in zip(waiting, corners[waiting], strict=True)}
        which = np.array([at[row.tobytes()] for row in stored])
        assert np.all(np.diff(which) > 0)
        assert np.array_equal(stored, corners[which])
        if mesh.triangle_colours is not None:
            assert np.array_equal(mesh.triangle_colours, data[f"{key}_triangle_rgb"][which])
        if mesh.colours is not None:
            assert np.array_equal(mesh.colours, data[f"{key}_vertex_rgb"])
        if mesh.uvs is not None:
            assert np.array_equal(mesh.uvs[mesh.triangles], data[f"{key}_corner_uv_texels"] * 16)
            assert named.texture is not None
            assert np.array_equal(named.texture.texels, data["texture_rgb565"])
        waiting = np.setdiff1d(waiting, which)
    assert len(waiting) == 0


def test_s4_is_in_as_few_meshes_as_can_be() -> None:
    """Three; two cannot do, as the triangles that no mesh can hold together form a cycle of odd length."""
    data = scenes()
    assert len(bench.all_scenes(data)["s4"]) == 3
    corners = data["S4_vertices"].astype(np.int64)[data["S4_triangles"]]
    low, high = corners.min(axis=1), corners.max(axis=1)
    side = np.full(len(corners), -1)
    odd = False
    for start in range(len(corners)):
        stack = [start] if side[start] < 0 else []
        side[start] = max(side[start], 0)
        while stack:
            i = stack.pop()
            apart = np.any(np.maximum(high, high[i]) - np.minimum(low, low[i]) > bench.REACH, axis=1)
            odd |= bool(np.any(apart & (side == side[i])))
            stack += np.flatnonzero(apart & (side < 0)).tolist()
            side[apart & (side < 0)] = 1 - side[i]
    assert odd
