"""What can be asked of a model: the options that `convert` and `preview` share, and whether they make sense."""

from __future__ import annotations

import argparse
import math
import shlex
from pathlib import Path

from edgeline.convert.palette import DITHERS
from edgeline.convert.texels import MAX_TEXTURE_LOG2, Format
from edgeline.errors import EdgelineError

DEFAULT_CREASE = 60.0
DEFAULT_TEXTURE_SIZE = 128
READ = (".obj", ".stl", ".ply", ".gltf", ".glb")
TEXTURE_OPTIONS = ("texture_size", "texture_format", "dither", "mipmaps", "atlas", "alpha", "wrap", "filter")
"""What can be asked of textures alone."""
MODEL_OPTIONS = (
    *("crease", "no_normals", "texture", "no_texture", *TEXTURE_OPTIONS),
    *("up", "scale", "centre", "triangles", "tolerance", "vertex_colours", "no_clusters"),
)
"""What can be asked of a model; an .elm is passed on as it is."""


def add_model_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("model", type=Path, help=f"a file {', '.join(READ)} or .elm")
    parser.add_argument(
        "--crease", type=float, metavar="DEGREES", help="edges sharper than this stay sharp (default: 60; 0 is flat)"
    )
    parser.add_argument("--no-normals", action="store_true", help="leave normals out")
    image = parser.add_mutually_exclusive_group()
    image.add_argument(
        "--texture", type=Path, metavar="IMAGE", help="the texture (default: those that the model names)"
    )
    image.add_argument("--no-texture", action="store_true", help="no texture; colours of the materials instead")
    parser.add_argument(
        "--texture-size", type=int, metavar="TEXELS", help="longest side of a texture, a power of two (default: 128)"
    )
    _add_texture_options(parser)
    parser.add_argument(
        "--vertex-colours", action="store_true", help="colours of materials at the vertices, for smooth shading"
    )
    parser.add_argument("--up", choices=("y", "z"), help="the model's axis that points up (default: y)")
    parser.add_argument("--scale", type=float, metavar="FACTOR", help="multiply all coordinates (default: 1)")
    parser.add_argument("--centre", action="store_true", help="move the middle of the bounding box to the origin")
    parser.add_argument(
        "--triangles", type=int, metavar="N", help="simplify to N triangles at most; needs fast-simplification"
    )
    parser.add_argument(
        "--tolerance",
        type=float,
        metavar="DISTANCE",
        help="simplify as far as the surface stays within DISTANCE, in the model's units after --scale; "
        "with --triangles: refuse what is farther off",
    )
    parser.add_argument(
        "--no-clusters",
        action="store_true",
        help="keep the model's order of triangles, without the clusters by which hidden parts are skipped",
    )


def _add_texture_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--texture-format",
        choices=[one.option for one in Format],
        help="what texels are: RGB565, 256 or 16 colours, or a bit each in one colour (default: rgb565)",
    )
    parser.add_argument("--dither", choices=DITHERS, help="how colours that there are not are mixed (default: none)")
    parser.add_argument(
        "--mipmaps", action="store_true", help="smaller textures for what is far away; a third more flash"
    )
    parser.add_argument(
        "--atlas", action="store_true", help="one texture for parts that differ only in their images, so one mesh"
    )
    parser.add_argument(
        "--alpha",
        choices=("file", "none", "test", "blend"),
        help="what alpha is for: nothing, texels that are drawn or not, or mixing (default: as the model says)",
    )
    parser.add_argument(
        "--wrap", choices=("file", "repeat", "clamp", "mirror"), help="beyond an image (default: as the model says)"
    )
    parser.add_argument(
        "--filter",
        choices=("file", "nearest", "bilinear"),
        help="between texels (default: nearest, which is drawn several times as fast as bilinear)",
    )


def is_given(value: object) -> bool:
    """Whether that is an option's value; a number of 0 is one."""
    return value is not None and value is not False


def given_options(args: argparse.Namespace, names: tuple[str, ...]) -> list[str]:
    """Those that the command line has, as it has them."""
    return [f"--{name.replace('_', '-')}" for name in names if is_given(getattr(args, name))]


def check_model_options(args: argparse.Namespace) -> None:
    """Raises EdgelineError for options that make no sense, alone or for this kind of file."""
    suffix = args.model.suffix.lower()
    if suffix not in (*READ, ".elm"):
        raise EdgelineError(f"{args.model}: models are read from {', '.join(READ)} or .elm; export it as one of these")
    given = given_options(args, MODEL_OPTIONS)
    if suffix == ".elm" and given:
        raise EdgelineError(f"{given[0]} is for models in other formats; an .elm is passed on as it is")
    if args.crease is not None and not 0 <= args.crease <= 180:
        raise EdgelineError(f"--crease {args.crease:g}: it is an angle of 0 to 180 degrees")
    if args.scale is not None and (not math.isfinite(args.scale) or args.scale <= 0):
        raise EdgelineError(f"--scale {args.scale:g}: it is a factor above 0")
    if args.triangles is not None and args.triangles < 1:
        raise EdgelineError(f"--triangles {args.triangles}: it is a number above 0")
    if args.tolerance is not None and (not math.isfinite(args.tolerance) or args.tolerance <= 0):
        raise EdgelineError(f"--tolerance {args.tolerance:g}: it is a distance above 0")
    if args.texture_size is not None and args.texture_size not in [1 << i for i in range(MAX_TEXTURE_LOG2 + 1)]:
        raise EdgelineError(f"--texture-size {args.texture_size}: it is a power of two, 1024 at most")


def _word(value: object) -> str:
    """A value as the command line has it, paths without their folders."""
    if isinstance(value, Path):
        return value.name
    return f"{value:g}" if isinstance(value, float) and float(f"{value:g}") == value else str(value)


def command_words(args: argparse.Namespace) -> str:
    """The command line with base names only: what another machine would be told to repeat."""
    words = ["edgeline", "convert", args.model.name]
    for name in MODEL_OPTIONS:
        value = getattr(args, name)
        option = f"--{name.replace('_', '-')}"
        if value is True:
            words.append(option)
        elif is_given(value):
            words += [option, _word(value)]
    return shlex.join(words)
