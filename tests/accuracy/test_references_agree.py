"""The references are right: each is compared with a second one that shares none of its arithmetic."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

import reference_coverage
from hard_triangles import KINDS, triangles_of
from reference_attributes import exact, rounded_depth
from reference_coverage import covers_by_definition
from sim_commands import SUBPIXELS
from test_attributes import FILLINGS, questions
from test_coverage_is_exact import _areas


@pytest.mark.parametrize("kind", KINDS)
def test_the_top_left_rule_is_an_infinitesimal_shift(kind: str) -> None:
    for width, height, count in ((7, 5, 60), (33, 20, 12)):
        for triangle in triangles_of(kind, "references", count, width, height):
            mask = reference_coverage.mask(triangle, width, height)
            expected = [[covers_by_definition(triangle, i, j) for i in range(width)] for j in range(height)]
            assert np.array_equal(mask, expected), triangle.tolist()


@pytest.mark.parametrize("kind", KINDS)
def test_kinds_are_what_they_say(kind: str) -> None:
    """A kind without pixels, or on one side only, would test nothing."""
    triangles = triangles_of(kind, "kinds", 400, 320, 240)
    reference_coverage.check_domain(triangles, 320, 240)
    areas = _areas(triangles)
    counts = reference_coverage.coverage(triangles, 320, 240)[0]
    if kind == "zero_area":
        assert not areas.any() and not counts.any()
    else:
        assert (areas > 0).sum() > 100 and (areas < 0).sum() > 100
        assert (counts > 0).sum() > (20 if kind == "outside" else 80)


def test_near_misses_are_near() -> None:
    """At least nine in ten have an edge value of -1, 0 or 1 at some pixel's centre."""
    hits = np.zeros(3, np.int64)
    triangles = triangles_of("near_misses", "near", 300, 320, 240)
    x = np.arange(320) * SUBPIXELS + SUBPIXELS // 2
    y = (np.arange(240) * SUBPIXELS + SUBPIXELS // 2)[:, np.newaxis]
    for (ax, ay), (bx, by), _ in triangles:
        edge = (bx - ax) * (y - ay) - (by - ay) * (x - ax)
        hits += [bool((edge == value).any()) for value in (-1, 0, 1)]
    assert hits.sum() >= 270 and hits.min() >= 60


def plane_at(points: list[tuple[Fraction, Fraction]], values: list[int]) -> Fraction:
    """The value at the fourth point of the plane a x + b y + c that has these values at the first three."""
    (x0, y0), (x1, y1), (x2, y2), (x, y) = points
    determinant = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
    one, two = values[1] - values[0], values[2] - values[0]
    slope_x = (one * (y2 - y0) - two * (y1 - y0)) / determinant
    slope_y = (two * (x1 - x0) - one * (x2 - x0)) / determinant
    return values[0] + slope_x * (x - x0) + slope_y * (y - y0)


@pytest.mark.parametrize("filling", FILLINGS)
def test_attributes_are_those_of_the_plane_through_the_vertices(filling: str) -> None:
    """Cramer's rule on a x + b y + c in fractions, for z, 1/w, u/w and v/w; no barycentric weight."""
    vertices, samples = questions("on_screen", filling)
    for sample in samples[:: len(samples) // 100]:
        triangle = vertices[sample["triangle"]]
        rows = [(Fraction(int(v["x"]), SUBPIXELS), Fraction(int(v["y"]), SUBPIXELS)) for v in triangle]
        rows.append((Fraction(2 * int(sample["x"]) + 1, 2), Fraction(2 * int(sample["y"]) + 1, 2)))
        w = [int(v["w"]) for v in triangle]
        expected = [plane_at(rows, [int(v["z"]) for v in triangle])]
        expected += [plane_at(rows, [int(v["rgb"][k]) for v in triangle]) for k in range(3)]
        expected += [
            plane_at(rows, [w[i] * int(triangle[i]["uv"][k]) for i in range(3)]) / plane_at(rows, w) / 16
            for k in range(2)
        ]
        pixel = np.array([[sample["x"]], [sample["y"]]], np.int64)
        got = exact(triangle[np.newaxis], pixel[0], pixel[1])[0]
        assert [float(value) for value in expected] == pytest.approx(got.tolist(), rel=1e-15, abs=1e-13)
        assert rounded_depth(triangle[np.newaxis], pixel[0], pixel[1])[0] == math.floor(expected[0] + Fraction(1, 2))
