"""A mesh with clusters looks like the same mesh without: inside, outside, near and far; and clusters are skipped."""

from __future__ import annotations

import json
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from edgeline.convert import elm
from edgeline.convert.clusters import MOST_TRIANGLES, in_order, with_clusters
from edgeline.convert.mesh import Mesh, Soup, quantise

EYES = ("0,0,3.5", "2,1,1.5", "0.2,0.1,1.05", "0,0,0", "-9,4,3", "40,-30,20", "1.3,0,0")
LOOK_AT = ("0,0,0", "2,0.5,-1", "0.7,0.7,0")


def sphere(rings: int) -> Mesh:
    """A closed sphere of radius 1, `rings` rings of twice as many segments."""
    north = np.linspace(0, np.pi, rings + 1)
    east = np.linspace(0, 2 * np.pi, 2 * rings + 1)
    north, east = np.meshgrid(north, east, indexing="ij")
    places = np.stack([np.sin(north) * np.cos(east), np.cos(north), -np.sin(north) * np.sin(east)], axis=-1)
    a, b, c, d = places[:-1, :-1], places[1:, :-1], places[1:, 1:], places[:-1, 1:]
    triangles = np.concatenate([np.stack([a, b, c], axis=2), np.stack([a, c, d], axis=2)], axis=2)
    corners = triangles.reshape(-1, 3, 3)
    colours = (np.abs(corners.mean(axis=1)) * 255).astype(np.uint8)
    return quantise(Soup(corners, triangle_colours=colours)).mesh


def scattered(count: int) -> Mesh:
    """Loose triangles that face anywhere."""
    numbers = np.random.default_rng(6)
    middles = numbers.uniform(-2, 2, (count, 1, 3))
    corners = middles + numbers.uniform(-0.1, 0.1, (count, 3, 3))
    return quantise(Soup(corners, triangle_colours=numbers.integers(0, 256, (count, 3)).astype(np.uint8))).mesh


def drawn(simulator: str, path: Path, eye: str, look_at: str) -> tuple[str, dict[str, int]]:
    """CRC and counters of a frame."""
    command = [simulator, "render", "--mesh", str(path), "--shading", "flat", "--crc", "--stats"]
    command += ["--eye", eye, "--look-at", look_at, "--near", "0.1", "--far", "100", "--fov", "60"]
    crc, stats = subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()
    return crc, json.loads(stats)


@pytest.mark.parametrize(
    "mesh", [sphere(24), in_order(sphere(16), 8), scattered(600)], ids=["sphere", "given", "loose"]
)
def test_clusters_change_no_pixel(simulator: str, tmp_path: Path, mesh: Mesh) -> None:
    clustered = mesh if mesh.clusters is not None else with_clusters(mesh)
    assert clustered.clusters is not None
    whole, plain = tmp_path / "whole.elm", tmp_path / "plain.elm"
    whole.write_bytes(elm.encode(clustered))
    plain.write_bytes(elm.encode(replace(clustered, clusters=None)))
    # Triangles that share no vertex are looked at by the view's sides, a stretch at a time, which a cluster may end.
    is_loose = len(mesh.positions) == 3 * len(mesh.triangles)
    slack = 3 * len(clustered.clusters) if is_loose else 0
    outside = turned = 0
    for eye in EYES:
        for look_at in LOOK_AT:
            if eye == look_at:
                continue
            crc, stats = drawn(simulator, whole, eye, look_at)
            expected, all_of_it = drawn(simulator, plain, eye, look_at)
            assert crc == expected, (eye, look_at)
            assert stats["triangles"] + stats["triangles_skipped"] == all_of_it["triangles"]
            assert stats["triangles_listed"] == all_of_it["triangles_listed"]
            assert stats["vertices"] <= all_of_it["vertices"] + slack
            outside += stats["clusters_outside"]
            turned += stats["clusters_turned"]
    assert outside > len(clustered.clusters) / 2
    assert turned > len(clustered.clusters) / 2 or is_loose


def test_a_closed_model_loses_a_fifth_of_its_triangles_unseen(simulator: str, tmp_path: Path) -> None:
    path = tmp_path / "sphere.elm"
    path.write_bytes(elm.encode(with_clusters(sphere(32))))
    _, stats = drawn(simulator, path, "0,0,3.5", "0,0,0")
    assert stats["triangles_skipped"] > (stats["triangles"] + stats["triangles_skipped"]) / 5


def test_clusters_hold_every_triangle_once_and_the_same_bytes_each_time() -> None:
    mesh = sphere(20)
    first, second = with_clusters(mesh), with_clusters(mesh)
    assert elm.encode(first) == elm.encode(second)
    assert first.clusters is not None
    assert int(first.clusters["triangle_count"].max()) <= MOST_TRIANGLES + 8
    before = mesh.positions[mesh.triangles.astype(int)].reshape(-1, 9)
    after = first.positions[first.triangles.astype(int)].reshape(-1, 9)
    assert sorted(map(tuple, before.tolist())) == sorted(map(tuple, after.tolist()))
