"""The models of others that are measured: shared/models beside the repository, or where EDGELINE_MODELS says, converted
as a user converts them."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from .machines import ROOT, MissingToolError, output_of

# By the name in C: the file, and what the converter is told.
MODELS = {
    "spot": ("spot_control_mesh.obj", ("--texture", "spot_texture.png")),
    "suzanne": ("suzanne.obj", ()),
    "beetle": ("beetle.obj", ()),
    "newell": ("teapot.obj", ()),
}
SCENES = ("model-spot", "model-suzanne", "model-beetle", "model-teapot", "model-teapot-whole", "S4-clusters")
MAKE_MESHES = ROOT / "firmware" / "apps" / "make_meshes.py"
CLUSTERED = "clustered"
"""Below the models' headers: those of the standard scenes in the order of clusters."""


def convert(folder: Path) -> Path | None:
    """Writes the models' headers into `folder`, as far as they are not there or older than the converter, and returns
    it; None where there are no models. With CI=true that is an error."""
    source = Path(os.environ.get("EDGELINE_MODELS") or ROOT.parent / "shared" / "models")
    if not source.is_dir():
        if os.environ.get("CI") == "true":
            raise MissingToolError("no models: shared/models is not beside the repository")
        return None
    folder.mkdir(parents=True, exist_ok=True)
    converter = sorted((ROOT / "host" / "edgeline" / "convert").glob("*.py"))
    for name, (model, extra) in MODELS.items():
        header = folder / f"{name}.h"
        words = [source / word if (source / word).is_file() else word for word in (model, *extra)]
        needed = [*converter, *(word for word in words if isinstance(word, Path))]
        if not header.is_file() or header.stat().st_mtime < max(file.stat().st_mtime for file in needed):
            command = [sys.executable, "-m", "edgeline", "convert", *words, "--name", name, "-o", header]
            output_of(command, {"PYTHONPATH": str(ROOT / "host")})
    _cluster_scenes(folder / CLUSTERED, source.parent / "bench" / "scenes.npz", converter)
    return folder


def _cluster_scenes(folder: Path, scenes: Path, converter: list[Path]) -> None:
    """The standard scenes with clusters, made anew where the converter is newer. With the models come the scenes."""
    made = folder / "s4.h"
    if not scenes.is_file():
        raise MissingToolError(f"{scenes.name} is not in {scenes.parent.name} beside the models")
    folder.mkdir(exist_ok=True)
    if not made.is_file() or made.stat().st_mtime < max(file.stat().st_mtime for file in converter):
        command = [sys.executable, MAKE_MESHES, "--bench", scenes, "--clusters", "-o", folder]
        output_of(command, {"PYTHONPATH": str(ROOT / "host")})
