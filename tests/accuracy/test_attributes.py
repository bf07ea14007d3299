"""Depth, colour and texture coordinates stay within their promised bounds on every covered pixel that is asked for."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import reference_attributes
import reference_coverage
from hard_triangles import KINDS, rng_for, triangles_of
from sim_commands import SAMPLE, VERTEX, Ints, Simulator

SCREENS = {(320, 240): 100, (2040, 24): 40}
"""Screens, the second with the longest spans there are, and how many triangles of each kind and filling lie on them;
each triangle with three rotations and two windings."""

COVERING = [kind for kind in KINDS if kind not in ("zero_area", "outside")]
ORDERS = ([0, 1, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0], [1, 0, 2], [0, 2, 1])

DEPTH_BOUND = 1.0
COLOUR_BOUND = 1.0
TEXEL_BOUND = 1 / 8

Filling = Callable[[np.random.Generator, npt.NDArray[Any]], None]


def anything(rng: np.random.Generator, vertices: npt.NDArray[Any]) -> None:
    """Each attribute over its whole range: 1/w from 1 to 65535, u and v over +-2047 texels."""
    shape = vertices.shape
    vertices["z"] = rng.integers(0, 65536, shape)
    vertices["w"] = rng.integers(1, 65536, shape)
    vertices["uv"] = rng.integers(-2047 * 16, 2047 * 16 + 1, (*shape, 2))
    vertices["rgb"] = rng.integers(0, 256, (*shape, 3))


def extremes(rng: np.random.Generator, vertices: npt.NDArray[Any]) -> None:
    """Each attribute at one end of its range."""
    shape = vertices.shape
    vertices["z"] = rng.choice([0, 65535], shape)
    vertices["w"] = rng.choice([128, 65535], shape)
    vertices["uv"] = rng.choice([-2047 * 16, 2047 * 16], (*shape, 2))
    vertices["rgb"] = rng.choice([0, 255], (*shape, 3))


def steep_walls(rng: np.random.Generator, vertices: npt.NDArray[Any]) -> None:
    """1/w in ratios up to 512, 256 texels wide: a wall seen along itself."""
    anything(rng, vertices)
    vertices["w"] = np.maximum(65535 / 2 ** rng.uniform(0, 9, vertices.shape), 128)
    vertices["uv"] = rng.integers(0, 256 * 16 + 1, (*vertices.shape, 2))


def far_away(rng: np.random.Generator, vertices: npt.NDArray[Any]) -> None:
    """Tiny 1/w, from 1 to 40: a few bits of it are all there is."""
    anything(rng, vertices)
    vertices["w"] = rng.integers(1, 41, vertices.shape)
    vertices["uv"] = rng.integers(-256 * 16, 256 * 16 + 1, (*vertices.shape, 2))


def flat_on(rng: np.random.Generator, vertices: npt.NDArray[Any]) -> None:
    """The same 1/w everywhere: affine."""
    anything(rng, vertices)
    vertices["w"] = rng.integers(1, 65536, (len(vertices), 1))


def gentle(rng: np.random.Generator, vertices: npt.NDArray[Any]) -> None:
    """What a scene has: ratios below 2, a few dozen texels, a short range of depth and colour."""
    shape = vertices.shape
    vertices["z"] = rng.integers(0, 60000, (len(vertices), 1)) + rng.integers(0, 400, shape)
    vertices["w"] = rng.integers(4000, 8000, shape)
    vertices["uv"] = rng.integers(0, 64 * 16 + 1, (*shape, 2))
    vertices["rgb"] = rng.integers(0, 200, (len(vertices), 1, 3)) + rng.integers(0, 56, (*shape, 3))


FILLINGS: dict[str, Filling] = {
    filling.__name__: filling for filling in (anything, extremes, steep_walls, far_away, flat_on, gentle)
}


def covered_pixels(rng: np.random.Generator, triangle: Ints, width: int, height: int) -> list[tuple[int, int]]:
    """Both ends of up to six rows, the first, the last and the widest among them, and up to eight pixels by chance."""
    x0, y0, x1, y1 = reference_coverage.box(triangle, width, height)
    mask = reference_coverage.mask_in_box(triangle, x0, y0, x1, y1)
    rows = np.flatnonzero(mask.any(axis=1))
    if len(rows) == 0:
        return []
    chosen = {int(rows[0]), int(rows[-1]), int(mask.sum(axis=1).argmax()), *rng.choice(rows, 3).tolist()}
    pixels = set()
    for row in chosen:
        columns = np.flatnonzero(mask[row])
        pixels |= {(x0 + int(columns[0]), y0 + row), (x0 + int(columns[-1]), y0 + row)}
    ys, xs = np.nonzero(mask)
    for k in rng.integers(0, len(xs), min(8, len(xs))):
        pixels.add((x0 + int(xs[k]), y0 + int(ys[k])))
    return sorted(pixels)


def questions(kind: str, filling: str) -> tuple[npt.NDArray[Any], npt.NDArray[Any]]:
    """Triangles of VERTEX with all their attributes, every order of their vertices, and SAMPLEs on them."""
    rng = rng_for("attributes", kind, filling)
    parts, pixels = [], []
    for (width, height), count in SCREENS.items():
        part = triangles_of(kind, f"attributes {filling}", count, width, height)
        parts.append(part)
        pixels += [covered_pixels(rng, triangle, width, height) for triangle in part]
    corners = np.concatenate(parts)
    count = len(corners)
    vertices = np.zeros((count, 3), VERTEX)
    vertices["x"], vertices["y"] = corners[:, :, 0], corners[:, :, 1]
    FILLINGS[filling](rng, vertices)
    samples = [(order * count + k, x, y) for order in range(len(ORDERS)) for k in range(count) for x, y in pixels[k]]
    return np.concatenate([vertices[:, order] for order in ORDERS]), np.array(samples, SAMPLE)


def measure(simulator: Simulator, kind: str, filling: str) -> dict[str, Any]:
    """The greatest and the 99th percentile error of each attribute, and a description of the worst sample of each."""
    vertices, samples = questions(kind, filling)
    got = simulator.attributes(vertices, samples)
    own = vertices[samples["triangle"]]
    x, y = samples["x"].astype(np.int64), samples["y"].astype(np.int64)
    expected = reference_attributes.exact(own, x, y)
    error = np.abs(got - expected)
    error[~np.isfinite(got)] = np.inf
    depth = np.floor(got[:, 0] + 0.5)
    out_of_range = (depth < own["z"].min(axis=1)) | (depth > own["z"].max(axis=1))
    colour = np.floor(got[:, 1:4] + 0.5)
    strange = ((colour < own["rgb"].min(axis=1)) | (colour > own["rgb"].max(axis=1))).any(axis=1)
    # A float32 has 8 bits of fraction at 65535: next to a tie it cannot tell to which side the depth was rounded.
    tells = np.abs(expected[:, 0] % 1 - 0.5) > 2**-7
    rounded = depth == reference_attributes.rounded_depth(own, x, y)
    result: dict[str, Any] = {
        "samples": len(samples),
        "depth_correctly_rounded": float(rounded[tells].mean()),
        "depth_outside_its_vertices": int(out_of_range.sum()),
        "colour_outside_its_vertices": int(strange.sum()),
    }
    for name, columns in (("depth", [0]), ("colour", [1, 2, 3]), ("texel", [4, 5])):
        worst = error[:, columns].max(axis=1)
        result[name] = {
            "max": float(worst.max()),
            "p99": float(np.percentile(worst, 99)),
            "worst": describe(own[worst.argmax()], samples[worst.argmax()], got[worst.argmax()]),
        }
    for name, flags in (("depth_outside_its_vertices", out_of_range), ("colour_outside_its_vertices", strange)):
        if flags.any():
            result[f"{name}_first"] = describe(own[flags.argmax()], samples[flags.argmax()], got[flags.argmax()])
    return result


def describe(vertices: npt.NDArray[Any], sample: Any, got: npt.NDArray[np.float64]) -> str:
    """One sample in words: its triangle, and what was got instead of what."""
    corners = " ".join(
        f"({v['x']},{v['y']} z={v['z']} w={v['w']} uv={v['uv'].tolist()} rgb={v['rgb'].tolist()})" for v in vertices
    )
    pixel = np.array([[sample["x"]], [sample["y"]]], np.int64)
    expected = reference_attributes.exact(vertices[np.newaxis], pixel[0], pixel[1])[0]
    pairs = zip(("z", "r", "g", "b", "u", "v"), expected, got, strict=True)
    values = ", ".join(f"{name} {want:.5f} got {have:.5f}" for name, want, have in pairs)
    return f"pixel ({sample['x']}, {sample['y']}) of {corners}: {values}"


@pytest.fixture(scope="session")
def measured(simulator: Simulator, reports: Path) -> dict[str, dict[str, Any]]:
    """All measurements, by "kind filling"; also written to attributes.json among the reports."""
    table = {f"{kind} {filling}": measure(simulator, kind, filling) for kind in COVERING for filling in FILLINGS}
    beside = reports / "attributes.json.new"
    beside.write_text(json.dumps(table, indent=1) + "\n")
    beside.replace(reports / "attributes.json")
    return table


CASES = pytest.mark.parametrize("case", [f"{kind} {filling}" for kind in COVERING for filling in FILLINGS])


@CASES
def test_depth_is_within_one_unit(measured: dict[str, dict[str, Any]], case: str) -> None:
    depth = measured[case]["depth"]
    assert depth["max"] <= DEPTH_BOUND, depth["worst"]


@CASES
def test_depth_is_never_outside_its_vertices(measured: dict[str, dict[str, Any]], case: str) -> None:
    result = measured[case]
    assert result["depth_outside_its_vertices"] == 0, result.get("depth_outside_its_vertices_first")


@CASES
def test_colour_is_within_one_unit_of_8_bits(measured: dict[str, dict[str, Any]], case: str) -> None:
    colour = measured[case]["colour"]
    assert colour["max"] <= COLOUR_BOUND, colour["worst"]


@CASES
def test_colour_is_never_outside_its_vertices(measured: dict[str, dict[str, Any]], case: str) -> None:
    result = measured[case]
    assert result["colour_outside_its_vertices"] == 0, result.get("colour_outside_its_vertices_first")


@CASES
def test_texture_coordinates_are_within_an_eighth_of_a_texel(measured: dict[str, dict[str, Any]], case: str) -> None:
    texel = measured[case]["texel"]
    assert texel["max"] <= TEXEL_BOUND, texel["worst"]


@CASES
def test_depth_is_correctly_rounded(measured: dict[str, dict[str, Any]], case: str) -> None:
    assert measured[case]["depth_correctly_rounded"] == 1, measured[case]["depth"]["worst"]
