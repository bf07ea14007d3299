"""Meshes and cameras by chance, up to the ends of what is allowed: drawn, drawn right, and drawn alike in every band.

Triangles here cross each other, the camera and all planes; meshes are as small as a few 2^-16 units and as large as the
world. What lies within the stated ranges may not be refused.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

import reference_renderer
from elm_file import ElmMesh, write_elm
from hard_triangles import rng_for
from reference_renderer import Camera
from sim_commands import Simulator

WORLD = 16384
"""World units: positions, distances and far planes end here."""

NOTHING = 65535
CASES_PER_BATCH = 40
SCREENS = [(320, 240), (160, 128), (33, 200), (7, 5), (1, 1), (2040, 3)]


@dataclass(frozen=True)
class Case:
    """A mesh, a camera and a screen, with what the command line says of them."""

    mesh: ElmMesh
    camera: Camera
    width: int
    height: int
    shading: str

    def arguments(self, path: Path) -> list[str]:
        """The simulator's `render` command."""
        size = ["--size", f"{self.width}x{self.height}", "--shading", self.shading]
        return ["render", "--mesh", str(path), *size, *self.camera.arguments(), "--crc"]


def _mesh(rng: np.random.Generator, largest_log2: int) -> ElmMesh:
    """Up to 40 vertices and 60 triangles that share them at random, about the origin."""
    amplitude = int(rng.choice([3, 200, 8000, 32767]))
    positions = rng.integers(-amplitude, amplitude + 1, (int(rng.integers(3, 40)), 3))
    if rng.random() < 0.2:
        positions = np.where(positions < 0, -amplitude, amplitude)
    radius = math.ceil(math.sqrt(int((positions**2).sum(axis=1).max())))
    reach = int(rng.choice([64, 1024, 2047 * 16]))
    size_log2 = largest_log2 if rng.random() < 0.3 else int(rng.integers(-15, largest_log2))
    return ElmMesh(
        positions=positions,
        triangles=rng.integers(0, len(positions), (int(rng.integers(1, 60)), 3)),
        scale_log2=min(8, size_log2 - amplitude.bit_length()),
        centre=np.zeros(3, np.int64),
        radius=radius,
        uvs=rng.integers(-reach, reach + 1, (len(positions), 2)),
        texels=rng.integers(0, 65536, (1 << int(rng.integers(0, 8)), 1 << int(rng.integers(0, 8)))).astype(np.uint16),
    )


def _point(rng: np.random.Generator, reach: float) -> tuple[float, float, float]:
    """A point in whole 2^-16 units, within the world."""
    x, y, z = (round(min(max(value, -WORLD), WORLD) * 65536) / 65536 for value in rng.normal(size=3) * reach)
    return x, y, z


def make(*seed: object) -> Case:
    """One case; telephoto views of far things, wide ones of near things and all between."""
    rng = rng_for("any", *seed)
    mesh = _mesh(rng, 13)
    reach = mesh.radius * 2.0**mesh.scale_log2
    near = round(min(max(reach * float(rng.choice([1e-4, 0.01, 0.1, 0.5, 1.5])), 2**-11), 12000) * 65536) / 65536
    far = min(near * float(rng.choice([1.25, 2, 100, 1e5])), WORLD)
    camera = Camera(
        eye=_point(rng, reach * float(rng.choice([0.2, 0.7, 1.5, 3, 30]))),
        target=_point(rng, reach * 0.3),
        fov=float(rng.choice([1, 5, 30, 60, 90, 150, 179])),
        near=near,
        far=math.ceil(far * 65536) / 65536,
    )
    width, height = SCREENS[int(rng.integers(0, len(SCREENS)))]
    return Case(mesh, camera, width, height, str(rng.choice(["flat", "gouraud", "textured"])))


def is_upright(camera: Camera) -> bool:
    """Whether the view is far enough from straight up or down, and long enough, to say where up is."""
    dx, dy, dz = (a - b for a, b in zip(camera.target, camera.eye, strict=True))
    return math.hypot(dx, dz) > max(abs(dy) / 64, 2**-8)


@pytest.mark.parametrize("batch", range(10))
def test_everything_allowed_is_drawn_right(checked_simulator: Simulator, tmp_path: Path, batch: int) -> None:
    """No sanitizer speaks, nothing is refused; outlines and depths are the reference's where it can tell."""
    told = 0
    for number in range(CASES_PER_BATCH):
        case = make(batch, number)
        if not is_upright(case.camera):
            continue
        mesh_path, depth_path = tmp_path / f"{number}.elm", tmp_path / "depth"
        write_elm(mesh_path, case.mesh)
        arguments = case.arguments(mesh_path)
        done = checked_simulator.run(*arguments, "--band", str(min(8, case.height)), "--depth", str(depth_path))
        assert done.returncode == 0, f"{' '.join(arguments)}: status {done.returncode}: {done.stderr[:600]}"
        if not reference_renderer.is_before_far(case.mesh, case.camera):
            continue
        told += 1
        picture = reference_renderer.render(case.mesh, case.camera, case.width, case.height)
        depth = np.fromfile(depth_path, "<u2").reshape(case.height, case.width).astype(np.float64)
        drawn = depth != NOTHING
        must = picture.solid | (picture.covered & ~picture.outline)
        wrong = (must & ~drawn) | (drawn & ~(picture.covered | picture.outline))
        assert not wrong.any(), f"{' '.join(arguments)}: {wrong.sum()} pixels wrong, {(must & ~drawn).sum()} missing"
        off = drawn & ((depth < picture.least) | (depth > picture.most))
        assert not off.any(), f"{' '.join(arguments)}: {off.sum()} of {drawn.sum()} depths wrong"
    assert told >= CASES_PER_BATCH // 8, "too few cases in which the reference can tell"


@pytest.mark.parametrize("batch", range(10))
def test_every_band_and_arena_draws_the_same(simulator: Simulator, tmp_path: Path, batch: int) -> None:
    for number in range(CASES_PER_BATCH):
        case = make("bands", batch, number)
        if not is_upright(case.camera):
            continue
        mesh_path = tmp_path / f"{number}.elm"
        write_elm(mesh_path, case.mesh)
        arguments = case.arguments(mesh_path)
        expected = simulator.run_well(*arguments, "--band", "1")
        for band in {min(7, case.height), case.height}:
            assert simulator.run_well(*arguments, "--band", str(band)) == expected, f"{' '.join(arguments)} {band}"
        for arena in (4000, 12000, 30000):
            limited = [*arguments, "--band", "1", "--arena", str(arena)]
            done = simulator.run(*limited)
            if done.returncode == 0:
                assert done.stdout == expected, " ".join(limited)
            else:
                assert "arena" in done.stderr, f"{' '.join(limited)}: {done.stderr}"
