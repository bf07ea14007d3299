#!/usr/bin/env python3
"""Makes edgeline/budget_facts.py: what `edgeline budget` knows of the firmware, told by compilers and measurements.

    host/make_budget.py              the file in the tree
    host/make_budget.py -o FILE      another one, for comparison

Macros that size arrays become functions of the same name: the preprocessor finds them, a C parser reads them. Sizes of
structs and values of enumerations are those of arrays that a compiler made that large, for Cortex-M0+ and for this
computer; nothing is run. Figures come from tests/bench/results. The file is committed; a test makes it again and
compares byte for byte.
"""

from __future__ import annotations

import argparse
import json
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from pycparser import c_ast, c_parser

from edgeline.convert.files import write_whole
from edgeline.errors import EdgelineError

ROOT = Path(__file__).resolve().parents[1]
OUTPUT = ROOT / "host" / "edgeline" / "budget_facts.py"
RESULTS = ROOT / "tests" / "bench" / "results"
FOLDERS = ("firmware/src", "sim")
HEADERS = ("edgeline.h", "panel/tft.h", "panel/ssd1306.h", "panel/ssd0323.h", "stream/session.h", "budget.h")
STRUCTS = ("el_renderer", "el_tft", "el_oled", "el_stream")
MACROS = (
    *("EL_MEMORY_BYTES", "EL_SAMPLES_BYTES"),
    *("EL_SSD1306_MEMORY_BYTES", "EL_SSD0323_MEMORY_BYTES", "EL_STREAM_MEMORY_BYTES"),
)
VALUES = (
    *("EL_TRIANGLE_BYTES", "EL_LIST_MAX_BYTES", "EL_MAX_WIDTH", "EL_MAX_HEIGHT", "EL_MESH_MAX_VERTICES"),
    *("EL_SUBPIXEL_BITS", "EL_STREAM_WIRE_BYTES", "EL_BUDGET_STACK_BYTES", "EL_BUDGET_WORKERS_STACK_BYTES"),
)


@dataclass(frozen=True)
class Target:
    """A compiler and what it is told, and the tool that lists its objects' symbols."""

    compiler: tuple[str, ...]
    nm: str


# The pointers' bits, and whose they are. All Cortex-M, and RISC-V with 32 bits, lay structs out alike.
TARGETS = {
    32: Target(("arm-none-eabi-gcc", "-mcpu=cortex-m0plus", "-mthumb"), "arm-none-eabi-nm"),
    64: Target(("gcc",), "nm"),
}


def run(command: list[str], text: str) -> str:
    """The output of a command that gets `text`. Raises EdgelineError."""
    if shutil.which(command[0]) is None:
        raise EdgelineError(f"{command[0]} is not installed; tests/prepare tests brings it")
    done = subprocess.run(command, input=text, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise EdgelineError(f"{command[0]} failed: {(done.stderr.splitlines() or ['it said nothing'])[0]}")
    return done.stdout


# --- What the compiler tells ------------------------------------------------------------------------------------------


def compile_command(target: Target) -> list[str]:
    """Reads C from standard input."""
    folders = [f"-I{ROOT / folder}" for folder in FOLDERS]
    return [*target.compiler, "-std=c11", "-ffreestanding", "-fdata-sections", *folders, "-x", "c", "-"]


def includes() -> str:
    return "".join(f'#include "{header}"\n' for header in HEADERS)


def array_sizes(bits: int, arrays: dict[str, str]) -> dict[str, int]:
    """The value of each C expression above zero, by the size of an array of that many bytes."""
    target = TARGETS[bits]
    text = includes() + "".join(f"char {name}[{expression}];\n" for name, expression in arrays.items())
    with tempfile.TemporaryDirectory() as folder:
        made = str(Path(folder) / "sizes.o")
        run([*compile_command(target), "-c", "-o", made], text)
        rows = [row.split() for row in run([target.nm, "-S", made], "").splitlines()]
    found = {row[3]: int(row[1], 16) for row in rows if len(row) == 4}
    return {name: found[name] for name in arrays}


# --- Macros -----------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Macro:
    """A macro with parameters; `where` is its header as an #include names it."""

    parameters: list[str]
    body: str
    where: str


def all_macros() -> dict[str, Macro]:
    """Every macro of the firmware that has parameters."""
    found = {}
    where = ""
    for line in run([*compile_command(TARGETS[32]), "-E", "-dD"], includes()).splitlines():
        if marker := re.match(r'# \d+ "([^"]*)"', line):
            where = marker[1]
        elif define := re.match(r"#define (EL_\w+)\(([^)]*)\) (.*)", line):
            header = Path(where)
            found[define[1]] = Macro(define[2].split(","), define[3], f"{header.parent.name}/{header.name}")
    return found


PRECEDENCE = {"==": 2, "<": 2, ">": 2, "+": 3, "-": 3, "*": 4, "/": 4, "%": 4}
"""Of the operators that the macros use; 1 is Python's conditional expression, 5 a name, a number or a call."""


class Translation:
    """A C expression of whole numbers, none below zero, as Python. Notes what it calls and which constants it names."""

    def __init__(self, macro: Macro) -> None:
        self.parameters = {name.strip() for name in macro.parameters}
        self.calls: list[str] = []
        self.constants: list[str] = []
        text = f"typedef unsigned size_t; unsigned f(void) {{ return {macro.body}; }}"
        function = c_parser.CParser().parse(text).ext[1]
        self.text, _ = self._expression(function.body.block_items[0].expr)

    def _expression(self, node: c_ast.Node) -> tuple[str, int]:
        """The text, and how tightly it binds."""
        if isinstance(node, c_ast.Cast):
            return self._expression(node.expr)
        if isinstance(node, c_ast.Constant):
            return node.value.rstrip("uUlL"), 5
        if isinstance(node, c_ast.ID):
            if node.name not in self.parameters:
                self.constants.append(node.name)
            return node.name, 5
        if isinstance(node, c_ast.FuncCall):
            self.calls.append(node.name.name)
            arguments = ", ".join(self._expression(one)[0] for one in node.args.exprs)
            return f"{node.name.name.lower()}({arguments})", 5
        if isinstance(node, c_ast.TernaryOp):
            condition, yes = self._bound(node.cond, 2), self._bound(node.iftrue, 2)
            return f"{yes} if {condition} else {self._bound(node.iffalse, 1)}", 1
        if isinstance(node, c_ast.BinaryOp) and node.op in PRECEDENCE:
            binds = PRECEDENCE[node.op]
            left, right = self._bound(node.left, binds), self._bound(node.right, binds + 1)
            return f"{left} {'//' if node.op == '/' else node.op} {right}", binds
        raise EdgelineError(f"host/make_budget.py knows no {type(node).__name__} in a macro; teach it")

    def _bound(self, node: c_ast.Node, least: int) -> str:
        text, binds = self._expression(node)
        return text if binds >= least else f"({text})"


def functions() -> tuple[str, list[str]]:
    """Python functions for MACROS and all that they use, and the constants in these."""
    macros = all_macros()
    found: dict[str, str] = {}
    constants: list[str] = []
    waiting = list(MACROS)
    while waiting:
        name = waiting.pop()
        if name in found:
            continue
        if name not in macros:
            raise EdgelineError(f"the headers have no macro {name}; host/make_budget.py names it")
        macro = macros[name]
        translation = Translation(macro)
        parameters = ", ".join(f"{one.strip()}: int" for one in macro.parameters)
        found[name] = (
            f'def {name.lower()}({parameters}) -> int:\n    """{name} of {macro.where}."""\n'
            f"    return {translation.text}\n"
        )
        waiting += translation.calls
        constants += translation.constants
    return "\n\n".join(found[name] for name in sorted(found)), constants


# --- Measurements -----------------------------------------------------------------------------------------------------


def scene_summaries() -> dict[str, str]:
    """What the tables of the scenes say of each; the benchmark has some with several samples per pixel, too."""
    text = "".join(path.read_text(encoding="utf-8") for path in sorted(ROOT.glob("firmware/apps/*/*_scenes.c")))
    found = dict(re.findall(r'\{\s*"([\w-]+)",\s*"([^"]+)"', text))
    sampled = {f"{name}-{n}x": f"{name} with {n} samples per pixel" for name in found for n in (4, 8)}
    return found | sampled


def frames() -> str:
    """Instructions of the first frame of each scene, by core."""
    content = json.loads((RESULTS / "scenes.json").read_text(encoding="utf-8"))
    summaries = scene_summaries()
    rows = {}
    for frame in content["frames"]:
        usual = frame["subpixel_bits"] == 4 and frame["uv_error_log2"] == 3 and frame["number"] == 0
        if usual and frame["passes"] == 1 and frame["scene"] in summaries and frame["scene"] not in rows:
            rows[frame["scene"]] = (summaries[frame["scene"]], frame["instructions"])
    source = f"{content['command']}, arm-none-eabi-gcc {content['compiler']}, QEMU {content['qemu']}"
    return (
        f"FRAMES_SOURCE = {source!r}\n\nFRAMES: dict[str, tuple[str, dict[str, int]]] = {rows!r}\n"
        '"""Of scenes at 320 x 240: what they are, and instructions of their first frame by core."""\n'
    )


# By shading: the law of its pixels, whose terms are frame, pixel and row of a triangle.
SHADING_LAWS = {"flat": "flat", "gouraud": "Gouraud", "textured": "textured"}


def laws() -> str:
    """Instructions per frame, pixel, row of a triangle, and triangle, by shading and core."""
    content = json.loads((RESULTS / "growth.json").read_text(encoding="utf-8"))
    measured = {(law["series"], law["variant"]): law["measured"] for law in content["laws"]}
    triangles = measured["triangles", "sphere"]
    table = {
        shading: {
            core: (
                *(fit["costs"][term] for term in ("frame", "pixel", "row of a triangle")),
                triangles[core]["costs"]["triangle"],
            )
            for core, fit in measured["pixels", law].items()
        }
        for shading, law in SHADING_LAWS.items()
    }
    source = f"{content['command']}, arm-none-eabi-gcc {content['compiler']}, QEMU {content['qemu']}"
    return (
        f"LAWS_SOURCE = {source!r}\n\n"
        f"LAWS: dict[str, dict[str, tuple[float, float, float, float]]] = {table!r}\n"
        '"""Instructions by shading and core: of a frame, and for each pixel, row of a triangle, and triangle."""\n'
    )


def code() -> str:
    """Code sizes, or nothing where they are not measured."""
    path = RESULTS / "code_size.json"
    content = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
    source = "arm-none-eabi-gcc {compiler}, {cpu}, {flags}".format(**content) if content else ""
    options = content.get("options", {})
    totals = {name: option["total"] for name, option in options.items()}
    libc = sum(options.get("all", {}).get("libc", {}).values())
    return (
        f"CODE_SOURCE = {source!r}\n"
        f"CODE_OPTIONS: dict[str, int] = {totals!r}\n"
        '"""Bytes of the renderer by its options; empty where they are not measured."""\n'
        f"CODE_PANELS: dict[str, int] = {content.get('panels', {})!r}\n"
        f"CODE_STREAM = {content.get('stream', 0)!r}\n"
        f"CODE_LIBC = {libc!r}\n"
    )


def facts() -> str:
    """The text of the module."""
    text, used = functions()
    names = sorted({*used, *VALUES})
    values = array_sizes(32, {f"value_{name}": name for name in names})
    structs = {
        bits: {name.removeprefix("size_"): size for name, size in found.items()}
        for bits, found in (
            (bits, array_sizes(bits, {f"size_{name}": f"sizeof({name})" for name in STRUCTS})) for bits in TARGETS
        )
    }
    module = [
        '"""What `edgeline budget` knows of the firmware. Made by host/make_budget.py; do not edit."""\n\n',
        "# ruff: noqa: PLR0917 (parameters are those of the macros)\n\n",
        "".join(f"{name} = {values[f'value_{name}']}\n" for name in names),
        f"\nSTRUCT_BYTES: dict[int, dict[str, int]] = {structs!r}\n",
        '"""By the bits of a pointer: 32 on microcontrollers, 64 in the simulator."""\n\n',
        frames(),
        "\n",
        laws(),
        "\n",
        code(),
        "\n\n",
        text,
    ]
    style = ["ruff", "format", "--no-cache", "--config", str(ROOT / "host" / "pyproject.toml"), "-"]
    return run(style, "".join(module))


def main() -> int:
    parser = argparse.ArgumentParser(description="Makes what `edgeline budget` knows of the firmware.")
    parser.add_argument(
        "-o", "--output", type=Path, default=OUTPUT, metavar="FILE", help="default: the one in the tree"
    )
    output: Path = parser.parse_args().output
    try:
        write_whole(output, facts().encode())
    except EdgelineError as error:
        print(f"make_budget: {error}", file=sys.stderr)
        return error.exit_code
    print(output.name)
    return 0


if __name__ == "__main__":
    sys.exit(main())
