"""Simplifying keeps the budget, the tolerance, seams, parts and colours; the error that is reported is true."""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from converting import convert, library, refused
from edgeline.convert import simplify
from edgeline.convert.mesh import Floats
from edgeline.convert.nearest import Surface, nearest_on_triangle
from edgeline.convert.progress import Steps
from edgeline.convert.source import Part, Source
from models import Gltf, checks, ply, ring, stl_binary

MODEL = ring(48, 24)
CORNERS = MODEL.positions[MODEL.triangles].astype(np.float64)


@pytest.fixture(autouse=True, scope="module")
def extra() -> None:
    library("fast_simplification")
    library("tqdm")


def source_of(positions: Floats) -> Source:
    none = np.zeros(len(positions), dtype=np.int64)
    return Source("m", positions, (Part(""),), none, lambda row: f"m: triangle {row}")


def nearest_of_all(points: Floats, triangles: Floats) -> Floats:
    """Squared distances, by trying every triangle."""
    columns = [nearest_on_triangle(points, np.repeat(t[None], len(points), axis=0))[0] for t in triangles]
    return np.asarray(np.min(columns, axis=0))


@pytest.mark.parametrize("seed", range(12))
def test_the_nearest_triangle_is_found(seed: int) -> None:
    numbers = np.random.default_rng(seed)
    dimensions = 3 + seed % 2
    count = int(numbers.choice([1, 7, 8, 9, 65, 300]))
    triangles = numbers.normal(size=(count, 1, dimensions)) + numbers.normal(size=(count, 3, dimensions)) * 0.2
    triangles[numbers.random(count) < 0.1, 1] = 0.0  # long ones
    triangles[numbers.random(count) < 0.1] *= [[1], [1], [0]]
    degenerate = numbers.random(count) < 0.2
    triangles[degenerate, 2] = triangles[degenerate, 1]
    points = numbers.normal(size=(200, dimensions)) * 1.5
    distances, rows, weights = Surface(triangles).nearest(points)
    np.testing.assert_allclose(distances**2, nearest_of_all(points, triangles), atol=1e-12)
    on = (triangles[rows] * weights[:, :, None]).sum(axis=1)
    np.testing.assert_allclose(np.linalg.norm(on - points, axis=1), distances, atol=1e-9)
    assert weights.min() >= 0 and np.allclose(weights.sum(axis=1), 1)


def test_nearest_points_of_a_triangle() -> None:
    triangle = np.array([(0, 0, 0), (4, 0, 0), (0, 4, 0)], dtype=np.float64)
    for point, squared in (((1, 1, 3), 9), ((-3, -4, 0), 25), ((2, -2, 0), 4), ((4, 4, 0), 8), ((9, 0, 0), 25)):
        found, _ = nearest_on_triangle(np.array([point], dtype=np.float64), triangle[None])
        assert found[0] == pytest.approx(squared)


def test_the_distance_is_measured_both_ways() -> None:
    square = np.array([[(0, 0, 0), (1, 0, 0), (1, 1, 0)], [(0, 0, 0), (1, 1, 0), (0, 1, 0)]], dtype=np.float64)
    flag = np.concatenate([square, [[(0, 0, 0), (0.01, 0, 0), (0, 0, 3)]]])
    assert simplify.distance(square, flag, Steps(False))[0] == 3.0
    assert simplify.distance(flag, square, Steps(False))[0] == 3.0
    moved = simplify.distance(square, square + np.array([0, 0, 0.25]), Steps(False))
    assert moved == pytest.approx((0.25, 0.25))
    assert simplify.distance(square, square, Steps(False)) == pytest.approx((0.0, 0.0), abs=1e-12)


@pytest.mark.parametrize("budget", [100, 400, 1200])
def test_budgets_are_kept_and_the_error_is_true(budget: int) -> None:
    found = simplify.simplified(source_of(CORNERS), budget, None, Steps(False))
    assert 0.9 * budget <= len(found.source.positions) <= budget
    assert found.triangles_before == len(CORNERS)
    # An independent measure, by points of its own: the torus' formula.
    points = found.source.positions.reshape(-1, 3)
    away = np.abs(np.hypot(np.hypot(points[:, 0], points[:, 2]) - 1, points[:, 1]) - 0.4).max()
    assert 0.5 * away <= found.largest_distance < 0.5
    assert found.mean_distance < found.largest_distance / 2
    assert found.size == pytest.approx(np.linalg.norm([2.8, 0.8, 2.8]), rel=1e-2)


def test_finer_budgets_have_smaller_errors() -> None:
    errors = [
        simplify.simplified(source_of(CORNERS), budget, None, Steps(False)).largest_distance
        for budget in (100, 400, 1600)
    ]
    assert errors == sorted(errors, reverse=True)


@pytest.mark.parametrize("tolerance", [0.1, 0.02, 0.004])
def test_tolerances_are_kept_and_used(tolerance: float) -> None:
    found = simplify.simplified(source_of(CORNERS), None, tolerance, Steps(False))
    assert 0.3 * tolerance < found.largest_distance <= tolerance
    assert len(found.source.positions) < 0.8 * len(CORNERS)


def test_what_cannot_be_met_is_refused(tmp_path: Path) -> None:
    (tmp_path / "m.stl").write_bytes(stl_binary(MODEL))
    told = refused("convert", tmp_path / "m.stl", "-o", tmp_path / "m.h", "--triangles", 50, "--tolerance", 0.001)
    assert "triangles it is off by" in told and "--tolerance 0.001; give more triangles" in told
    assert refused("convert", tmp_path / "m.stl", "-o", "m.h", "--triangles", 0).startswith("--triangles 0: it is")
    assert refused("convert", tmp_path / "m.stl", "-o", "m.h", "--tolerance", "nan").startswith("--tolerance nan: it")


def test_a_model_within_the_budget_stays_as_it_is() -> None:
    source = source_of(CORNERS)
    found = simplify.simplified(source, len(CORNERS), None, Steps(False))
    assert found.source is source
    assert found.largest_distance == 0.0


def test_colours_and_texture_coordinates_stay_in_their_places() -> None:
    source = replace(
        source_of(CORNERS),
        uvs=MODEL.uvs[MODEL.triangles].astype(np.float64),
        colours=MODEL.colours[MODEL.triangles],
    )
    fewer = simplify.simplified(source, 700, None, Steps(False)).source
    assert fewer.uvs is not None and fewer.colours is not None
    x, _, z = np.moveaxis(fewer.positions, -1, 0)
    expected = (fewer.positions / 1.4 + 1) / 2 * 255
    assert np.abs(fewer.colours - np.clip(expected, 0, 255)).max() < 15
    # Around the ring u goes from 0 to 4; no triangle reaches across the seam where it begins again.
    u = np.arctan2(x, z) / (2 * np.pi) * 4
    turns = (fewer.uvs[..., 0] - u) / 4
    assert np.abs(turns - np.rint(turns)).max() < 0.02
    assert np.ptp(fewer.uvs[..., 0], axis=1).max() < 1.0
    assert np.ptp(fewer.uvs[..., 1], axis=1).max() < 0.5


def test_parts_and_their_colours_stay_apart() -> None:
    half = (CORNERS.mean(axis=1)[:, 0] > 0).astype(np.int64)
    paint = np.array([(255, 0, 0), (0, 0, 255)], np.uint8)
    source = replace(source_of(CORNERS), parts=(Part("a"), Part("b")), part_of=half, triangle_colours=paint[half])
    fewer = simplify.simplified(source, 800, None, Steps(False)).source
    assert fewer.triangle_colours is not None
    np.testing.assert_array_equal(fewer.triangle_colours, paint[fewer.part_of])
    middle = fewer.positions.mean(axis=1)[:, 0]
    sure = np.abs(middle) > 0.1
    np.testing.assert_array_equal(fewer.part_of[sure], (middle > 0)[sure])


def test_a_closed_surface_stays_closed() -> None:
    fewer = simplify.simplified(source_of(CORNERS), 700, None, Steps(False)).source.positions
    _, vertex_of = np.unique(fewer.reshape(-1, 3), axis=0, return_inverse=True)
    corners = vertex_of.reshape(-1, 3)
    edges = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    there = {tuple(edge) for edge in edges.tolist()}
    assert all((b, a) in there for a, b in there)


@pytest.mark.parametrize("option", [("--triangles", 300), ("--tolerance", 0.02)])
def test_the_same_input_gives_the_same_bytes(tmp_path: Path, option: tuple[str, object]) -> None:
    (tmp_path / "m.ply").write_bytes(ply(MODEL, "<"))
    made = []
    for name in ("a.h", "b.h"):
        convert(tmp_path / "m.ply", "-o", tmp_path / name, "--name", "m", *option)
        made.append((tmp_path / name).read_bytes())
    assert made[0] == made[1]


def test_the_report_says_what_was_lost(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    gltf = Gltf()
    paint = gltf.material(image={"bufferView": gltf.view(checks()), "mimeType": "image/png"})
    gltf.node(gltf.primitive(MODEL, attributes="pt", material=paint))
    (tmp_path / "m.glb").write_bytes(gltf.glb())
    convert(tmp_path / "m.glb", "-o", tmp_path / "m.elm", "--triangles", 600, "--json")
    found = json.loads(capsys.readouterr().out)
    lost = found["simplified"]
    assert found["triangles"] <= 600 and lost["triangles_before"] == len(CORNERS)
    assert lost["largest_fraction"] == pytest.approx(
        lost["largest_distance"] / np.linalg.norm([2.8, 0.8, 2.8]), rel=0.01
    )
    convert(tmp_path / "m.glb", "-o", tmp_path / "m.elm", "--triangles", 600)
    assert f"simplified from {len(CORNERS):,} triangles; surfaces " in capsys.readouterr().out


def test_without_the_extra_one_line_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "fast_simplification", None)
    monkeypatch.setitem(sys.modules, "tqdm", None)
    (tmp_path / "m.stl").write_bytes(stl_binary(MODEL))
    told = refused("convert", tmp_path / "m.stl", "-o", tmp_path / "m.h", "--triangles", 50)
    assert told.endswith(f"install it with: {sys.executable} -m pip install fast-simplification")
    assert convert(tmp_path / "m.stl", "-o", tmp_path / "m.h") == 0


def test_progress_is_for_terminals_alone(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    for is_terminal in (False, True):
        monkeypatch.setattr("edgeline.convert.progress.DELAY_S", 0.0)
        monkeypatch.setattr(sys.stderr, "isatty", lambda is_terminal=is_terminal: is_terminal)
        with Steps().bar("measuring", 10) as tick:
            tick(5)
        told = capsys.readouterr()
        assert told.out == ""
        assert ("measuring" in told.err) == is_terminal
