"""Meshes appear where a camera in float64 sees them: outlines, depths and texels, from many sides and through clipping.

What may differ follows from the rounding of vertices to 1/16 px alone (reference_renderer.py); everything else must
be equal. A failure leaves pictures in silhouettes/ among the reports: red is missing, green too much, blue excused.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import reference_renderer
from elm_file import ElmMesh, read_elm
from hard_triangles import rng_for
from reference_renderer import Camera, Floats, Mask, Picture
from sim_commands import Rendering, Simulator

WIDTH, HEIGHT = 320, 240
NOTHING = 65535
TEXEL_BOUND = 1 / 8
TEXEL_SLACK = 1 / 32
"""Texels, for the moves' second order and the 16 bits of 1/w."""
ENOUGH = 1000
"""Pixels that a view must put to the test; fewer would prove nothing."""

MODELS = {
    "spot": ("spot_control_mesh.obj", "--texture", "spot_texture.png"),
    "suzanne": ("suzanne.obj",),
    "beetle": ("beetle.obj",),
    "teapot": ("teapot.obj",),
}
VIEWS = ["0", "1", "2", "3", "inside 0", "inside 1"]
CASES = pytest.mark.parametrize(("model", "view"), [(model, view) for model in MODELS for view in VIEWS])

Convert = Callable[..., Path]


def camera_for(mesh: ElmMesh, model: str, view: str) -> Camera:
    """A camera around the model; for "inside" views the near plane cuts through it. Coordinates in whole 1/1024."""
    rng = rng_for("look", model, view)
    unit = 2.0**mesh.scale_log2
    radius = mesh.radius * unit
    direction = rng.normal(size=3) * [1, 0.5, 1]
    direction /= np.linalg.norm(direction)
    cuts = view.startswith("inside")
    distance = radius * (rng.uniform(0.5, 0.9) if cuts else rng.uniform(1.5, 2.2))
    target = mesh.centre * unit + rng.uniform(-0.2, 0.2, 3) * radius
    eye = target + direction * distance
    near = radius / 8 if cuts else distance - 1.4 * radius if distance > 1.5 * radius else radius / 16

    def exact(value: float) -> float:
        return round(value * 1024) / 1024

    def point(values: Floats) -> tuple[float, float, float]:
        x, y, z = (exact(float(value)) for value in values)
        return x, y, z

    fov = float(rng.integers(35, 60))
    return Camera(point(eye), point(target), fov, exact(near), exact(distance + 3 * radius))


@cache
def _reference(path: Path, model: str, view: str) -> tuple[ElmMesh, Camera, Picture]:
    mesh = read_elm(path)
    camera = camera_for(mesh, model, view)
    return mesh, camera, reference_renderer.render(mesh, camera, WIDTH, HEIGHT)


def _render(simulator: Simulator, path: Path, camera: Camera, shading: str) -> Rendering:
    return simulator.render("--mesh", str(path), "--shading", shading, *camera.arguments())


def _save(reports: Path, name: str, picture: Picture, drawn: Mask) -> Path:
    """A picture of the difference: grey is covered in both."""
    shown = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
    shown[picture.covered & drawn] = 128
    shown[picture.covered & ~drawn] = (255, 0, 0)
    shown[~picture.covered & drawn] = (0, 255, 0)
    shown[(picture.covered != drawn) & picture.outline & ~picture.solid] = (64, 64, 255)
    folder = reports / "silhouettes"
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name.replace(' ', '-')}.png"
    Image.fromarray(shown).resize((WIDTH * 3, HEIGHT * 3), Image.Resampling.NEAREST).save(path)
    return path


@CASES
def test_outlines_are_right(simulator: Simulator, convert: Convert, reports: Path, model: str, view: str) -> None:
    path = convert(*MODELS[model])
    _, camera, picture = _reference(path, model, view)
    assert picture.covered.sum() > ENOUGH, "the camera sees too little of the model"
    drawn = _render(simulator, path, camera, "flat").depth[0] != NOTHING
    must = picture.solid | (picture.covered & ~picture.outline)
    may = picture.covered | picture.outline
    wrong = (must & ~drawn) | (drawn & ~may)
    if wrong.any():
        saved = _save(reports, f"{model}-{view}", picture, drawn)
        y, x = (int(where[0]) for where in np.nonzero(wrong))
        pytest.fail(
            f"{model}, view {view}: {wrong.sum()} of {may.sum()} pixels wrong ({(must & ~drawn).sum()} missing); first "
            f"({x}, {y}): drawn {bool(drawn[y, x])}; {' '.join(camera.arguments())}; see {saved.name}",
            pytrace=False,
        )


@CASES
def test_depths_are_right(simulator: Simulator, convert: Convert, model: str, view: str) -> None:
    path = convert(*MODELS[model])
    _, camera, picture = _reference(path, model, view)
    depth = _render(simulator, path, camera, "flat").depth[0].astype(np.float64)
    drawn = depth != NOTHING
    wrong = drawn & ((depth < picture.least) | (depth > picture.most))
    assert (drawn & picture.solid).sum() > ENOUGH
    if wrong.any():
        y, x = (int(where[0]) for where in np.nonzero(wrong))
        excess = np.maximum(picture.least - depth, depth - picture.most)[wrong].max()
        pytest.fail(
            f"{model}, view {view}: {wrong.sum()} of {drawn.sum()} depths wrong, up to {excess:.2f} beyond; first "
            f"({x}, {y}): {depth[y, x]:.0f}, not within {picture.least[y, x]:.2f}..{picture.most[y, x]:.2f}; "
            f"{' '.join(camera.arguments())}",
            pytrace=False,
        )


@pytest.mark.parametrize("view", VIEWS)
def test_texels_are_right(simulator: Simulator, convert: Convert, view: str) -> None:
    """Where u and v are surely inside of one texel, the pixel has just its colour."""
    path = convert(*MODELS["spot"])
    mesh, camera, picture = _reference(path, "spot", view)
    assert mesh.texels is not None
    colour = _render(simulator, path, camera, "textured").colour[0]
    with np.errstate(invalid="ignore"):
        fraction = picture.uv - np.floor(picture.uv)
        room = np.minimum(fraction, 1 - fraction)
        robust: Mask = np.all(room > TEXEL_BOUND + TEXEL_SLACK + picture.uv_error, axis=2)
    texel = np.where(robust[..., np.newaxis], np.floor(picture.uv), 0).astype(np.int64)
    rows, columns = mesh.texels.shape
    expected = mesh.texels[texel[..., 1] % rows, texel[..., 0] % columns]
    assert robust.sum() > ENOUGH
    wrong: Mask = np.logical_and(robust, colour != expected)
    if wrong.any():
        y, x = (int(where[0]) for where in np.nonzero(wrong))
        pytest.fail(
            f"spot, view {view}: {wrong.sum()} of {robust.sum()} texels wrong; first ({x}, {y}): {colour[y, x]:04x}, "
            f"not {expected[y, x]:04x} at u, v = {picture.uv[y, x]}; {' '.join(camera.arguments())}",
            pytrace=False,
        )
