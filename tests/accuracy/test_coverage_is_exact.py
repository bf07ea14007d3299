"""The rasterizer covers exactly the pixels of the top-left rule: every triangle here, every pixel, no tolerance."""

from __future__ import annotations

import numpy as np
import pytest

import reference_coverage
from explain_triangle import explain
from hard_triangles import KINDS, fan, jittered_grid, rng_for, triangles_of
from sim_commands import SUBPIXELS, Ints, Simulator

SIZES = {(320, 240): 4400, (240, 320): 1600, (33, 200): 1600, (7, 5): 1600, (1, 1): 1000, (2040, 9): 300}
"""Targets, and how many triangles of each kind are drawn on them: 115,500 in all."""


def check(simulator: Simulator, triangles: Ints, width: int, height: int) -> None:
    """Fails with an explanation of the first triangle whose pixels are not the reference's."""
    got_counts, got_crcs = simulator.coverage(triangles, width, height)
    counts, crcs = reference_coverage.coverage(triangles, width, height)
    wrong = np.flatnonzero((got_counts != counts) | (got_crcs != crcs))
    if len(wrong):
        detail = explain(simulator, triangles[wrong[0]], width, height)
        pytest.fail(
            f"{len(wrong)} of {len(triangles)} triangles are wrong; number {wrong[0]}:\n{detail}", pytrace=False
        )


def test_there_are_a_hundred_thousand_triangles() -> None:
    assert len(KINDS) * sum(SIZES.values()) >= 100_000


@pytest.mark.parametrize(("width", "height"), SIZES)
@pytest.mark.parametrize("kind", KINDS)
def test_each_pixel_is_decided_exactly(simulator: Simulator, kind: str, width: int, height: int) -> None:
    triangles = triangles_of(kind, "coverage", SIZES[width, height], width, height)
    check(simulator, triangles, width, height)


@pytest.mark.parametrize("kind", ["on_screen", "near_misses", "guard_band", "slivers"])
def test_windings_and_rotations_cover_the_same_pixels(simulator: Simulator, kind: str) -> None:
    width, height = 320, 240
    triangles = triangles_of(kind, "rotations", 300, width, height)
    for order in ([0, 1, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0], [1, 0, 2], [0, 2, 1]):
        check(simulator, triangles[:, order], width, height)


def test_zero_area_draws_nothing(simulator: Simulator) -> None:
    triangles = triangles_of("zero_area", "nothing", 2000, 320, 240)
    counts, crcs = simulator.coverage(triangles, 320, 240)
    assert not counts.any() and not crcs.any()


@pytest.mark.parametrize("radius", [24, 200, 2000, 12000])
def test_fans_cover_each_inner_pixel_once(simulator: Simulator, radius: int) -> None:
    """Shared edges: no pixel twice, none between two triangles left out."""
    width, height = 320, 240
    rng = rng_for("fans", radius)
    fans = [fan(rng, width, height, int(rng.integers(3, 40)), radius) for _ in range(40)]
    check(simulator, np.concatenate(fans), width, height)
    for triangles in fans:
        hits = np.sum([reference_coverage.mask(triangle, width, height) for triangle in triangles], axis=0)
        turns = np.sign(_areas(triangles))
        if (turns > 0).all():  # the rim is star-shaped around the hub after rounding, so nothing may overlap
            assert hits.max() <= 1
            assert simulator.coverage(triangles, width, height)[0].sum() == hits.sum()


def _areas(triangles: Ints) -> Ints:
    (ax, ay), (bx, by), (cx, cy) = (triangles[:, k].T for k in range(3))
    return np.asarray((bx - ax) * (cy - ay) - (by - ay) * (cx - ax))


@pytest.mark.parametrize("corners", [3, 4, 5, 17, 64])
def test_fans_larger_than_the_screen_cover_all_of_it_once(simulator: Simulator, corners: int) -> None:
    """No reference: the rim lies outside, so the pixels of all triangles together are width * height."""
    width, height = 320, 240
    for case in range(10):
        rng = rng_for("large fan", corners, case)
        angles = (np.arange(corners) + rng.uniform(0, 0.2)) * (2 * np.pi / corners)
        rim = np.rint(1500 * SUBPIXELS * np.stack([np.cos(angles), np.sin(angles)], axis=1)).astype(np.int64)
        rim += np.array([width, height]) * (SUBPIXELS // 2)
        hub = rng.integers(0, [width * SUBPIXELS, height * SUBPIXELS])
        triangles = np.stack([np.broadcast_to(hub, rim.shape), rim, np.roll(rim, -1, axis=0)], axis=1)
        assert simulator.coverage(triangles, width, height)[0].sum() == width * height


@pytest.mark.parametrize("cells", [2, 13, 60, 190])
def test_a_mesh_over_the_screen_covers_all_of_it_once(simulator: Simulator, cells: int) -> None:
    width, height = 320, 240
    triangles = jittered_grid(rng_for("grid", cells), width, height, cells)
    assert simulator.coverage(triangles, width, height)[0].sum() == width * height
