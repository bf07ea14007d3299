"""`edgeline convert`: a model into a C header or an .elm file.

    edgeline convert spot.obj --texture spot.png -o spot.h

Exit status 0, or an EdgelineError (status 2), one line that says what, where and what to do; then nothing is written.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING

from edgeline.budget_command import hertz
from edgeline.convert import elm, estimate
from edgeline.convert.files import write_all
from edgeline.convert.header import c_header, check_name, name_from
from edgeline.convert.options import add_model_options, check_model_options, command_words
from edgeline.convert.pipeline import Result, convert_model
from edgeline.convert.progress import Steps
from edgeline.convert.report import print_report, report
from edgeline.errors import EdgelineError

if TYPE_CHECKING:
    SubParsers = argparse._SubParsersAction[argparse.ArgumentParser]


def add_parser(subparsers: SubParsers) -> None:
    """Adds the command to the command line of `edgeline`; the parser's `func` takes the arguments, returns a status."""
    parser = subparsers.add_parser(
        "convert",
        help="make a mesh for the firmware out of a model",
        description="Converts a model (OBJ, STL, PLY, glTF, or an .elm) to a C header or an .elm file. A model with "
        "several textures becomes several meshes: in one header, or in an .elm each, named after its material.",
    )
    add_model_options(parser)
    parser.add_argument(
        "-o", "--output", type=Path, required=True, metavar="FILE", help="the result: FILE.h or FILE.elm"
    )
    parser.add_argument("--name", help="C name of the mesh (default: from the output's name)")
    parser.add_argument(
        "--core",
        choices=estimate.CORES,
        default=estimate.CORES[0],
        help=f"whose time per frame is estimated (default: {estimate.CORES[0]})",
    )
    parser.add_argument(
        "--cpu", type=hertz, metavar="HZ", help="its clock, such as 48M (default: an RP2040's or STM32F405's)"
    )
    parser.add_argument("--json", action="store_true", help="report as one JSON object")
    parser.set_defaults(func=run)


def check_options(args: argparse.Namespace) -> None:
    """Raises EdgelineError for options that make no sense, alone or for this kind of file."""
    if args.output.suffix.lower() not in (".h", ".elm"):
        raise EdgelineError(f"-o {args.output}: the result is a C header (.h) or an .elm; name it so")
    check_model_options(args)
    if args.name is not None:
        check_name(args.name)


def files_of(args: argparse.Namespace, name: str, result: Result) -> list[tuple[Path, bytes]]:
    """What is to be written: a header, or an .elm per mesh."""
    output: Path = args.output
    if output.suffix.lower() == ".h":
        about = [f"{args.model.name} as a mesh for Edgeline.", f"Made by: {command_words(args)}"]
        return [(output, c_header(name, about, result.meshes).encode("utf-8", "backslashreplace"))]
    if len(result.meshes) == 1:
        named = result.meshes[0]
        return [(output, elm.encode(named.mesh, named.texture, named.material))]
    return [
        (
            output.with_name(f"{output.stem}-{one.name.removeprefix(name + '_')}.elm"),
            elm.encode(one.mesh, one.texture, one.material),
        )
        for one in result.meshes
    ]


def run(args: argparse.Namespace) -> int:
    """Converts as `args` say, prints the report. Raises EdgelineError; then the output is as it was before."""
    check_options(args)
    name = args.name or name_from(args.output.stem)
    result = convert_model(args, name, Steps())
    files = files_of(args, name, result)
    write_all(files)
    found = report(args, [str(path) for path, _ in files], result)
    if args.json:
        print(json.dumps(found))
    else:
        print_report(found, result)
    return 0
