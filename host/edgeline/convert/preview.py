"""`edgeline preview`: a model as a panel shows it. The simulator renders it, its model of the panel shows it.

edgeline preview model.glb --panel st7789 -o model.png
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from edgeline.budget import PANELS
from edgeline.convert import elm
from edgeline.convert.files import write_whole
from edgeline.convert.header import name_from
from edgeline.convert.options import add_model_options, check_model_options
from edgeline.convert.pipeline import convert_model, read_bytes
from edgeline.convert.progress import Steps
from edgeline.errors import EdgelineError

if TYPE_CHECKING:
    SubParsers = argparse._SubParsersAction[argparse.ArgumentParser]

SIMULATOR = "edgeline-sim"
TREE = Path(__file__).resolve().parents[3]
"""The project's folder, where the package is used from it."""
TIMEOUT_S = 120
PASSED_ON = ("panel", "rotation", "size", "shading", "eye", "look_at", "fov")


def add_parser(subparsers: SubParsers) -> None:
    parser = subparsers.add_parser(
        "preview",
        help="a model as a panel shows it, by the simulator",
        description="Converts a model and has the simulator draw it: as a panel of --panel shows it, or as rendered.",
    )
    add_model_options(parser)
    parser.add_argument("-o", "--output", type=Path, default=Path("preview.png"), metavar="OUT.png")
    parser.add_argument("--panel", choices=PANELS, help="the display's controller (default: none, 320x240)")
    parser.add_argument("--rotation", choices=("0", "90", "180", "270"), help="how the panel is mounted")
    parser.add_argument("--size", metavar="WxH", help="of the picture")
    parser.add_argument(
        "--shading",
        choices=("flat", "gouraud", "textured", "lit"),
        help="default: textured with textures, times vertex colours if there are any, smooth with normals, flat with "
        "colours of triangles; lit: the same, with textures in a light, too",
    )
    parser.add_argument("--eye", metavar="X,Y,Z", help="where the camera stands (default: where all is seen)")
    parser.add_argument("--look-at", metavar="X,Y,Z", help="where it looks (default: the middle)")
    parser.add_argument("--fov", metavar="DEGREES", help="its vertical angle of view (default: 45)")
    parser.set_defaults(func=run)


def find_simulator() -> str:
    """The simulator's path: of $EDGELINE_SIM, in $PATH, or as built in the tree. Raises EdgelineError."""
    named = os.environ.get("EDGELINE_SIM")
    if named:
        if not Path(named).is_file():
            raise EdgelineError(f"EDGELINE_SIM={named}: there is no such file; build the simulator, or unset it")
        return named
    built = [TREE / "build" / "sim" / SIMULATOR, Path("build") / "sim" / SIMULATOR]
    found = shutil.which(SIMULATOR) or next((str(path.resolve()) for path in built if path.is_file()), None)
    if found is None:
        raise EdgelineError(
            "preview needs the simulator; build it in Edgeline's folder: cmake --preset sim && "
            "cmake --build --preset sim, or name it in EDGELINE_SIM"
        )
    return found


def run(args: argparse.Namespace) -> int:
    """Writes the picture. Raises EdgelineError; then the output is as it was before."""
    if args.output.suffix.lower() != ".png":
        raise EdgelineError(f"-o {args.output}: the picture is a PNG; name it so")
    check_model_options(args)
    simulator = find_simulator()
    result = convert_model(args, name_from(args.model.stem), Steps())
    words = [simulator, "render"]
    with tempfile.TemporaryDirectory(prefix="edgeline-preview-") as folder:
        picture = Path(folder) / "preview.png"
        names = {}
        for i, one in enumerate(result.meshes):
            path = Path(folder) / f"{i}.elm"
            path.write_bytes(elm.encode(one.mesh, one.texture, one.material))
            words += ["--mesh", str(path)]
            names[str(path)] = one.name
        for option in PASSED_ON:
            value = getattr(args, option)
            if value is not None:
                words += [f"--{option.replace('_', '-')}", value]
        _render([*words, "--png", str(picture)], names)
        write_whole(args.output, read_bytes(picture))
    for note in result.notes:
        print(f"note: {note}")
    print(args.output)
    return 0


def _render(words: list[str], names: dict[str, str]) -> None:
    """Raises EdgelineError; `names` are those of the meshes in files that only this command knows."""
    try:
        done = subprocess.run(words, capture_output=True, text=True, timeout=TIMEOUT_S, check=False)
    except (OSError, subprocess.SubprocessError) as error:
        raise EdgelineError(f"{words[0]}: the simulator does not run ({error}); build it anew") from error
    if done.returncode != 0:
        lines = done.stderr.splitlines() or [f"it ended with status {done.returncode}"]
        line = lines[0]
        for path, name in names.items():
            line = line.replace(path, name)
        raise EdgelineError(f"the simulator: {line}")
