"""The firmware's C, as syntax trees: what the proofs execute is the source itself.

A unit is one source file with all that it includes, as the C preprocessor leaves it for a given EL_SUBPIXEL_BITS and
a core, or a size, that it may be written differently for. A seeded fault is a unit in which one piece of text, which
must occur exactly once, was replaced.
"""

from __future__ import annotations

import functools
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

from pycparser import c_ast, c_parser

SOURCES = Path(__file__).resolve().parents[2] / "firmware" / "src"

# The macro of cores without a 32 x 32 -> 64 bit product and without a divider: some arithmetic is written for them.
ARMV6M = "__ARM_ARCH_6M__"

# Where size counts, some of it is written in another way again.
SMALL_CODE = "EL_SMALL_CODE=1"

# The compiler's own headers use extensions that the parser does not know.
HEADERS = {
    "stdint.h": "\n".join(
        [
            *(
                f"typedef {sign}{kind} {prefix}int{bits}_t;"
                for bits, kind in ((8, "char"), (16, "short"), (32, "int"), (64, "long long"))
                for sign, prefix in (("signed ", ""), ("unsigned ", "u"))
            ),
            "typedef unsigned long long uintptr_t;",
            *(f"#define INT{bits}_MAX {2 ** (bits - 1) - 1}" for bits in (8, 16, 32)),
            *(f"#define UINT{bits}_MAX {2**bits - 1}U" for bits in (8, 16, 32)),
            "#define INT64_MAX 0x7FFFFFFFFFFFFFFFLL",
            "#define UINT64_MAX 0xFFFFFFFFFFFFFFFFULL",
            "#define INT32_MIN (-INT32_MAX - 1)",
            "#define INT64_MIN (-INT64_MAX - 1)",
        ]
    ),
    "stdbool.h": "#define bool _Bool\n#define true 1\n#define false 0\n",
    "stddef.h": "#define NULL ((void *)0)\ntypedef unsigned long long size_t;\n#define offsetof(type, member) 0\n",
    "string.h": "#include <stddef.h>\nvoid *memcpy(void *to, const void *from, size_t bytes);\n"
    "void *memset(void *to, int byte, size_t bytes);\n",
}


# Division, with its tables, of which a core with a divider has none.
DIVISION = ["base/divide.c", "base/reciprocals.c"]

# What a unit calls in others, so that its functions can be linked; what those call in turn need not be named.
MIXED = [
    "raster/fill_mixed.c",
    "raster/fill_mixed_line.c",
    "raster/texel_line.c",
    "raster/texel_smooth.c",
    "raster/texel_strip.c",
    "raster/sampler.c",
    "raster/texture.c",
    "base/image.c",
]
COMPANIONS: dict[str, list[str]] = {
    "base/divide.c": ["base/reciprocals.c"],
    "base/fixed.c": [],
    "base/image.h": [],
    "base/rgb565.h": [],
    "geometry/transform.c": [
        *("geometry/cull.c", "geometry/vertex.c", "geometry/pose.c", "geometry/vector.c"),
        *("base/fixed.c", "base/angle.c"),
        *DIVISION,
    ],
    "geometry/vector.c": ["base/fixed.c"],
    "geometry/quaternion.c": ["geometry/vector.c", "base/angle.c", "base/atan2.c", "base/fixed.c"],
    "geometry/animation.c": [
        "geometry/quaternion.c",
        "geometry/vector.c",
        "base/angle.c",
        "base/atan2.c",
        "base/fixed.c",
    ],
    "geometry/vertex.c": ["base/fixed.c", *DIVISION],
    "geometry/clip.c": ["base/fixed.c", *DIVISION],
    "geometry/cull.c": ["base/fixed.c"],
    "geometry/sides.c": ["geometry/vertex.c", "base/fixed.c", *DIVISION],
    "raster/plane.c": DIVISION,
    "raster/triangle.c": ["raster/plane.c", "base/fixed.c", *DIVISION],
    "raster/texture_walk.c": DIVISION,
    "raster/spans.c": [],
    "raster/stripes.c": ["base/fixed.c"],
    "raster/fog.h": ["base/fixed.c"],
    "raster/field.c": ["raster/triangle.c"],
    "raster/sampled.c": ["base/fixed.c"],
    "raster/samples.c": ["base/fixed.c"],
    "raster/wires.c": ["base/fixed.c"],
    "raster/tiny_triangle.c": ["raster/gather.c", "geometry/vertex.c", "base/fixed.c", *DIVISION],
    "raster/fill.c": [
        *("raster/spans.c", "raster/fill_texture.c", "raster/small_triangle.c", "raster/small_gouraud.c"),
        "raster/depth_row.c",
        *("raster/texture_walk.c", "base/reciprocals.c", "raster/gather.c", *MIXED),
        *DIVISION,
    ],
    "raster/fill_texture.c": ["raster/spans.c", "raster/depth_row.c", "raster/texture_walk.c", *MIXED, *DIVISION],
    "raster/gather.c": ["raster/texture.c", "geometry/vertex.c", "base/fixed.c", *DIVISION],
}


@dataclass(frozen=True)
class Fault:
    """In `file` (relative to firmware/src), `old` is replaced by `new`."""

    file: str
    old: str
    new: str


def faulty_tree(folder: Path, fault: Fault) -> Path:
    """A copy of firmware/src in `folder` with the fault in it."""
    for source in SOURCES.rglob("*.[ch]"):
        copy = folder / source.relative_to(SOURCES)
        copy.parent.mkdir(parents=True, exist_ok=True)
        text = source.read_text(encoding="utf-8")
        if source == SOURCES / fault.file:
            assert text.count(fault.old) == 1, (
                f"{fault.file}: {fault.old!r} occurs {text.count(fault.old)} times, not once"
            )
            text = text.replace(fault.old, fault.new)
        copy.write_text(text, encoding="utf-8")
    return folder


def core_options(core: str) -> list[str]:
    """What tells the preprocessor the core, or that size counts; "" for any."""
    return [f"-D{core}"] if core else []


def _preprocess(tree: Path, file: str, subpixel_bits: int, core: str) -> str:
    with tempfile.TemporaryDirectory() as stubs:
        for name, text in HEADERS.items():
            (Path(stubs) / name).write_text(text, encoding="utf-8")
        command = ["cc", "-E", "-std=c11", "-nostdinc", "-I", stubs, "-I", str(tree)]
        # Attributes ask for inlining and the like; the parser does not know them.
        command += [f"-DEL_SUBPIXEL_BITS={subpixel_bits}", "-D__attribute__(x)=", *core_options(core), str(tree / file)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"the preprocessor refuses {file}: {done.stderr}"
    return done.stdout


@dataclass(frozen=True)
class Unit:
    """A parsed translation unit."""

    functions: dict[str, c_ast.FuncDef]
    typedefs: dict[str, c_ast.Node]
    structs: dict[str, c_ast.Struct]
    constants: dict[str, c_ast.Node | int]  # enumerators: the expression, or the one before and 1
    variables: dict[str, c_ast.Decl]  # file scope, const


class _Collector(c_ast.NodeVisitor):
    def __init__(self) -> None:
        self.unit = Unit({}, {}, {}, {}, {})

    def visit_FuncDef(self, node: c_ast.FuncDef) -> None:
        self.unit.functions[node.decl.name] = node
        self.generic_visit(node)

    def visit_Typedef(self, node: c_ast.Typedef) -> None:
        self.unit.typedefs[node.name] = node.type
        self.generic_visit(node)

    def visit_Struct(self, node: c_ast.Struct) -> None:
        if node.decls is not None and node.name is not None:
            self.unit.structs[node.name] = node
        self.generic_visit(node)

    def visit_Enum(self, node: c_ast.Enum) -> None:
        previous: c_ast.Node | None = None
        for item in node.values.enumerators if node.values else []:
            if item.value is not None:
                value = item.value
            elif previous is None:
                value = c_ast.Constant("int", "0")
            else:
                value = c_ast.BinaryOp("+", previous, c_ast.Constant("int", "1"))
            self.unit.constants[item.name] = value
            previous = value


def companions_of(file: str) -> list[str]:
    """What it is linked with: the units that it calls, and those that they call."""
    found = list(COMPANIONS[file])
    for companion in found:
        found += [further for further in COMPANIONS.get(companion, []) if further not in found]
    return found


@functools.cache
def parse(file: str, subpixel_bits: int = 4, fault: Fault | None = None, core: str = "") -> Unit:
    """The unit of `file`, a path relative to firmware/src, linked with those that it calls."""
    unit = _parse(file, subpixel_bits, fault, core)
    for companion in companions_of(file):
        concerned = fault is not None and (fault.file == companion or fault.file.endswith(".h"))
        other = _parse(companion, subpixel_bits, fault if concerned else None, core)
        for name, function in other.functions.items():
            known = unit.functions.setdefault(name, function)
            same = (
                Path(known.coord.file).name == Path(function.coord.file).name
                and known.coord.line == function.coord.line
            )
            assert same, f"{file} and {companion} both have a function {name}"
        for of, names in (
            (unit.typedefs, other.typedefs),
            (unit.structs, other.structs),
            (unit.constants, other.constants),
        ):
            of.update({name: node for name, node in names.items() if name not in of})
    return unit


@functools.cache
def _parse(file: str, subpixel_bits: int, fault: Fault | None, core: str) -> Unit:
    if fault is None:
        text = _preprocess(SOURCES, file, subpixel_bits, core)
    else:
        with tempfile.TemporaryDirectory() as folder:
            text = _preprocess(faulty_tree(Path(folder), fault), file, subpixel_bits, core)
    collector = _Collector()
    tree = c_parser.CParser().parse(text, filename=file)
    collector.visit(tree)
    for node in tree.ext:
        if isinstance(node, c_ast.Decl) and node.name and node.init is not None:
            collector.unit.variables[node.name] = node
    return collector.unit
