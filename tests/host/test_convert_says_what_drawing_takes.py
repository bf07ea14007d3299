"""What the converter's report says of RAM, vertices and time agrees with the firmware's macros and measurements."""

from __future__ import annotations

import json
import random
import subprocess
from pathlib import Path

import numpy as np
import pytest

from converting import convert
from edgeline import budget_facts as facts
from edgeline.convert import elm, estimate
from edgeline.convert.clusters import with_clusters
from edgeline.convert.locality import cache_slots, per_triangle, transforms
from edgeline.convert.mesh import Mesh
from models import ring, stl_binary

ROOT = Path(__file__).resolve().parents[2]
MODEL = ring(48, 24)
NEAR = ("--eye", "1.9,1.4,3.2", "--look-at", "0,0,0", "--near", "0.5", "--far", "20")


@pytest.fixture
def model(tmp_path: Path) -> Path:
    (tmp_path / "m.stl").write_bytes(stl_binary(MODEL))
    return tmp_path / "m.stl"


def told(capsys: pytest.CaptureFixture[str], *words: object) -> dict[str, object]:
    convert(*words, "--json")
    found: dict[str, object] = json.loads(capsys.readouterr().out)
    return found


def drawn(simulator: str, path: Path, *options: str) -> dict[str, int]:
    """The renderer's counters of a frame."""
    done = subprocess.run(
        [simulator, "render", "--mesh", str(path), "--stats", *options],
        capture_output=True,
        text=True,
        check=True,
        timeout=60,
    )
    found: dict[str, int] = json.loads(done.stdout)
    return found


def shuffled(mesh: Mesh, seed: int) -> Mesh:
    source = np.random.default_rng(seed)
    return Mesh(mesh.positions, mesh.triangles[source.permutation(len(mesh.triangles))], mesh.scale_log2)


@pytest.mark.parametrize("seed", range(4))
def test_transformed_vertices_are_those_of_the_firmware(simulator: str, tmp_path: Path, seed: int) -> None:
    """In an arena that keeps all triangles and not all vertices; all is in view and no triangle is skipped before."""
    (tmp_path / "m.stl").write_bytes(stl_binary(ring(80, 40)))
    convert(tmp_path / "m.stl", "-o", tmp_path / "m.elm", "--no-clusters", "--no-normals")
    mesh, _ = elm.decode((tmp_path / "m.elm").read_bytes())
    if seed:
        mesh = shuffled(mesh, seed)
        (tmp_path / "m.elm").write_bytes(elm.encode(mesh))
    stats = drawn(simulator, tmp_path / "m.elm", "--arena", "110000", "--shading", "flat", *NEAR)
    assert stats["passes"] == 1
    # How many places there are depends on what is left of the list; there are these at least.
    choices = {transforms(mesh, cache_slots() << more) for more in range(3)}
    assert len(choices) == (3 if seed else 1) and min(choices) > 3200
    assert stats["vertices"] in choices


def test_the_cache_is_simulated_as_it_is() -> None:
    slots = 8
    source = random.Random(3)
    positions = np.zeros((40, 3), np.int16)
    positions[:, 0] = np.arange(40)
    triangles = np.array([[source.randrange(40) for _ in range(3)] for _ in range(200)], np.uint16)
    mesh = Mesh(positions, triangles, 0)
    held: dict[int, int] = {}
    total, following = 0, -1
    for index in triangles.reshape(-1).tolist():
        if held.get(index % slots) == index:
            continue
        end = index + 1
        if index == following:
            end = min(len(positions), index + 16, index - index % slots + slots)
        for i in range(index, end):
            held[i % slots] = i
            total += 1
        following = end
    assert transforms(mesh, slots) == total


@pytest.mark.parametrize("seed", range(3))
def test_clusters_follow_each_other_as_costs_least(tmp_path: Path, seed: int) -> None:
    """Never more than along the curve alone, and much less than triangles in no order; the mesh stays the same."""
    (tmp_path / "m.stl").write_bytes(stl_binary(ring(40 + 8 * seed, 32)))
    convert(tmp_path / "m.stl", "-o", tmp_path / "m.elm", "--no-clusters", "--no-normals")
    mesh = shuffled(elm.decode((tmp_path / "m.elm").read_bytes())[0], seed)
    curve, best = with_clusters(mesh), with_clusters(mesh, per_triangle)
    assert per_triangle(best) <= per_triangle(curve) < 0.5 * per_triangle(mesh)
    assert with_clusters(mesh, lambda one: -float(one is not None)).triangles.tolist() == curve.triangles.tolist()
    for one in (curve, best):
        corners = [sorted(map(tuple, triangle)) for triangle in one.positions[one.triangles].tolist()]
        assert sorted(corners) == sorted(sorted(map(tuple, t)) for t in mesh.positions[mesh.triangles].tolist())


def test_the_chain_of_clusters_is_taken_where_it_is_better(tmp_path: Path) -> None:
    source = np.random.default_rng(7)
    gains = []
    for _ in range(12):
        around, across = source.integers(8, 40, 2)
        model = ring(int(around), int(across))
        (tmp_path / "m.stl").write_bytes(stl_binary(model))
        convert(tmp_path / "m.stl", "-o", tmp_path / "m.elm", "--no-clusters", "--no-normals")
        mesh, _ = elm.decode((tmp_path / "m.elm").read_bytes())
        gains.append(per_triangle(with_clusters(mesh)) - per_triangle(with_clusters(mesh, per_triangle)))
    assert min(gains) == 0.0 < max(gains)


def test_ram_is_the_firmware_s_macro(model: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = told(capsys, model, "-o", model.with_suffix(".elm"))
    assert found["shading"] == "gouraud"
    triangles, vertices = found["triangles"], found["vertices"]
    assert isinstance(triangles, int) and isinstance(vertices, int)
    macro = facts.el_memory_bytes(320, 240, 8, vertices, triangles, 1)
    less = triangles * (facts.EL_TEXTURED_TRIANGLE_BYTES - facts.EL_TRIANGLE_BYTES)
    assert found["ram_bytes"] == macro - less


def test_so_much_ram_takes_one_pass(simulator: str, model: Path, capsys: pytest.CaptureFixture[str]) -> None:
    found = told(capsys, model, "-o", model.with_suffix(".elm"))
    assert drawn(simulator, model.with_suffix(".elm"), "--arena", str(found["ram_bytes"]))["passes"] == 1


def test_the_estimate_s_view_is_the_simulator_s(simulator: str, model: Path) -> None:
    convert(model, "-o", model.with_suffix(".elm"), "--no-clusters")
    mesh, _ = elm.decode(model.with_suffix(".elm").read_bytes())
    view = estimate.look_at([mesh])
    stats = drawn(simulator, model.with_suffix(".elm"))
    assert view.triangles == stats["triangles"]
    assert view.facing == pytest.approx(stats["triangles"] - stats["triangles_backface"], rel=0.02)
    assert view.pixels == pytest.approx(stats["pixels"], rel=0.15)


@pytest.mark.parametrize("core", estimate.CORES)
def test_the_estimate_is_near_what_was_measured(core: str) -> None:
    """Of the benchmark's scenes, as their counters have them, between half and one and a half of their instructions."""
    rows = json.loads((ROOT / "tests/bench/results/growth.json").read_text())["rows"]
    shadings = {"S1": "gouraud", "S2": "textured", "S3": "gouraud"}
    found = {}
    for row in rows:
        if row["series"] == "bands" and row["variant"] in shadings and row["band_lines"] == 8:
            view = estimate.View(row["triangles"], 0, row["rows"], row["pixels"])
            count = estimate.instructions(view, shadings[row["variant"]], core)
            found[row["variant"]] = count / row["instructions"][core]
    assert set(found) == set(shadings)
    assert all(0.5 < ratio < 1.5 for ratio in found.values()), found


def test_cores_and_clocks(model: Path, capsys: pytest.CaptureFixture[str]) -> None:
    times = {}
    for words in (["--core", "cortex-m4f"], [], ["--cpu", "62.5M"]):
        frame = told(capsys, model, "-o", model.with_suffix(".elm"), *words)["frame"]
        assert isinstance(frame, dict) and frame["estimate"] is True
        assert frame["milliseconds"] == pytest.approx(1000 * frame["instructions"] / frame["clock_hz"])
        times[frame["core"], frame["clock_hz"]] = frame["milliseconds"]
    assert times["cortex-m4f", 168_000_000] < times["cortex-m0plus", 125_000_000]
    assert times["cortex-m0plus", 62_500_000] == 2 * times["cortex-m0plus", 125_000_000]


def test_the_text_calls_an_estimate_one(model: Path, capsys: pytest.CaptureFixture[str]) -> None:
    convert(model, "-o", model.with_suffix(".elm"))
    lines = capsys.readouterr().out.splitlines()
    assert any(line.startswith("  estimate: ") and "on cortex-m0plus at 125 MHz" in line for line in lines)
    assert any("bytes of RAM draw it in one pass: gouraud, 320x240, bands of 8" in line for line in lines)
    assert any("vertices transformed per triangle" in line for line in lines)
