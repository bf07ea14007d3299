"""What the packages' tests share: the library as its users compile it, and what a display shows of a wire trace."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from needs import need_simulator, need_tool

REPOSITORY = Path(__file__).resolve().parents[2]
FIRMWARE = REPOSITORY / "firmware"
HERE = Path(__file__).resolve().parent

TRIANGLE_VIEW = ("--eye", "0,0,3", "--look-at", "0,0,0", "--near", "1", "--far", "10", "--fov", "45")
"""How examples and consumers look at their triangle, in the simulator's words."""

Picture = npt.NDArray[np.uint16]
"""RGB565 of shape (height, width), as the viewer sees it."""

WARNINGS = ("-Wall", "-Wextra", "-Werror")
STRICT = (*WARNINGS, "-Wconversion", "-Wshadow")


@dataclass(frozen=True)
class Target:
    """A processor that code is compiled for: its compilers, with their flags, and the packages that bring them."""

    c: tuple[str, ...]
    cxx: tuple[str, ...]
    package: str


ARM = Target(
    ("arm-none-eabi-gcc", "-mcpu=cortex-m0plus", "-mthumb"),
    ("arm-none-eabi-g++", "-mcpu=cortex-m0plus", "-mthumb"),
    "gcc-arm-none-eabi libnewlib-arm-none-eabi libstdc++-arm-none-eabi-newlib",
)
RISCV = Target(
    ("riscv64-unknown-elf-gcc", "-march=rv32imc", "-mabi=ilp32", "--specs=picolibc.specs"),
    (),
    "gcc-riscv64-unknown-elf picolibc-riscv64-unknown-elf",
)
NATIVE = Target(("cc",), ("c++",), "gcc g++")


def tried(
    *command: str | Path, env: Mapping[str, str] | None = None, stdin: bytes = b"", cwd: Path | None = None
) -> subprocess.CompletedProcess[bytes]:
    """Runs a command to its end, whatever its status."""
    return subprocess.run(
        [str(word) for word in command],
        env={**os.environ, **(env or {})},
        input=stdin,
        cwd=cwd,
        capture_output=True,
        timeout=120,
        check=False,
    )


def run(
    *command: str | Path, env: Mapping[str, str] | None = None, stdin: bytes = b"", cwd: Path | None = None
) -> bytes:
    """The command's standard output; a failure with what it said where its status is not 0."""
    done = tried(*command, env=env, stdin=stdin, cwd=cwd)
    assert done.returncode == 0, (
        f"{' '.join(map(str, command))}: status {done.returncode}\n"
        f"{done.stdout.decode(errors='replace')[-2000:]}{done.stderr.decode(errors='replace')[-4000:]}"
    )
    return done.stdout


def compile_units(compiler: Sequence[str], sources: Sequence[Path], flags: Sequence[str], folder: Path) -> list[Path]:
    """Compiles each source into `folder`, by one make, which uses both processors; the objects."""
    folder.mkdir(parents=True, exist_ok=True)
    objects = [folder / f"{source.parent.name}-{source.name}.o" for source in sources]
    command = " ".join([*compiler, *flags])
    rules = [f"all: {' '.join(map(str, objects))}"]
    rules += [f"{unit}: {source}\n\t{command} -c $< -o $@" for unit, source in zip(objects, sources, strict=True)]
    (folder / "Makefile").write_text("\n".join(rules) + "\n", encoding="utf-8")
    run(need_tool("make", "make"), "-s", "-j2", "-f", folder / "Makefile")
    return objects


def library_sources() -> list[Path]:
    """What Arduino and PlatformIO compile of the library: everything below src/."""
    return sorted(path for path in (FIRMWARE / "src").rglob("*") if path.suffix in (".c", ".cpp", ".S"))


def convert(source: Path, result: Path, *options: str) -> Path:
    """The `result` (.elm or .h) that `edgeline convert` makes of a model."""
    run(sys.executable, "-m", "edgeline", "convert", source, "-o", result, *options, cwd=REPOSITORY / "host")
    return result


def triangle_mesh(folder: Path) -> Path:
    """The triangle that examples and consumers draw, as the simulator reads it."""
    obj = folder / "triangle.obj"
    obj.write_text("v -1 -1 0 1 0 0\nv 1 -1 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n", encoding="utf-8")
    return convert(obj, folder / "triangle.elm", "--no-normals")


def look(trace: Path, panel: str, rotation: int, size: tuple[int, int]) -> Picture:
    """What the display model shows of a wire trace, of (width, height); fails on what the chip would not take."""
    raw = trace.with_suffix(".rgb565")
    run(need_simulator(), "look", "--panel", panel, "--rotation", str(rotation), trace, "--raw", raw)
    return np.fromfile(raw, "<u2").reshape(size[1], size[0])


def render(folder: Path, size: tuple[int, int], *arguments: str | Path) -> Picture:
    """The first frame of the simulator's `render` with these arguments, of (width, height)."""
    raw = folder / "render.rgb565"
    run(need_simulator(), "render", *arguments, "--frames", "1", "--raw", raw)
    return np.fromfile(raw, "<u2").reshape(size[1], size[0])
