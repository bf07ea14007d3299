"""The example sketches: they compile for a Cortex-M0+ and for this machine as an Arduino core compiles them, without a
warning; and what a display shows of what they send is the simulator's picture of the same thing, pixel for pixel.

The core is a stand-in with the signatures of ArduinoCore-API (arduino_stand_in); AVR gets one clear line.
"""

from __future__ import annotations

import shutil
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from edgeline import framing, protocol
from needs import missing, need_tool
from packages_tools import (
    ARM,
    FIRMWARE,
    HERE,
    NATIVE,
    REPOSITORY,
    TRIANGLE_VIEW,
    WARNINGS,
    Target,
    compile_units,
    convert,
    library_sources,
    look,
    render,
    run,
    triangle_mesh,
    tried,
)

EXAMPLES = FIRMWARE / "examples"
STAND_IN = HERE / "arduino_stand_in"
FRAMES = 3
AVR_CORE = Path("/usr/share/arduino/hardware/arduino/avr")

# g++ counts what a designated initialiser leaves out as missing, gcc does not; converted meshes leave out what is NULL.
CXX_WARNINGS = (*WARNINGS, "-Wno-missing-field-initializers")


@dataclass(frozen=True)
class Example:
    """A sketch, its display, and how the simulator is asked for its first frame."""

    panel: str
    rotation: int
    size: tuple[int, int]
    view: tuple[str, ...]


TETRAHEDRON = (
    "v 1 1 1 1 1 1\nv -1 -1 1 1 0.251 0\nv -1 1 -1 0 0.6275 0.251\nv 1 -1 -1 0.1255 0.1255 1\n"
    "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
)
CENTRE = ("--look-at", "0,0,0", "--near", "1", "--fov", "45")
EXAMPLES_SHOW = {
    "HelloTriangle": Example("ili9341", 90, (320, 240), TRIANGLE_VIEW),
    "SpinningModel": Example("st7789-240x240", 0, (240, 240), ("--eye", "0,1,3", "--far", "8", *CENTRE)),
    "StreamToHost": Example("ssd1306", 0, (128, 64), ("--eye", "2,1,4", "--far", "10", *CENTRE)),
}


def sketch_flags(name: str, standard: str) -> list[str]:
    """As a core compiles a sketch: Arduino.h in front, the library's src/ in the include path."""
    flags = [f"-std={standard}", "-O1", *CXX_WARNINGS, f"-I{FIRMWARE / 'src'}", f"-I{STAND_IN}"]
    return [*flags, f"-I{EXAMPLES / name}", "-include Arduino.h", "-x c++"]


def compile_sketch(target: Target, name: str, standard: str, folder: Path, sketch: Path | None = None) -> Path:
    need_tool(target.cxx[0], target.package)
    path = sketch or EXAMPLES / name / f"{name}.ino"
    return compile_units(target.cxx, [path], sketch_flags(name, standard), folder)[0]


Build = Callable[..., Path]


@pytest.fixture
def build(native_library: list[Path], tmp_path: Path) -> Build:
    """`build("HelloTriangle")` gives the sketch as a program of this machine."""

    def link(name: str, sketch: Path | None = None) -> Path:
        objects = [compile_sketch(NATIVE, name, "gnu++11", tmp_path, sketch)]
        objects += compile_units(NATIVE.cxx, [STAND_IN / "stand_in.cpp"], ["-std=c++11", *WARNINGS], tmp_path / "core")
        program = tmp_path / name
        run(*NATIVE.cxx, *objects, *native_library, "-o", program)
        return program

    return link


def play(program: Path, loops: int, stdin: bytes = b"") -> tuple[Path, bytes]:
    """Runs a sketch for some loops: the trace of its display's wire, and what it sent over Serial."""
    trace = program.with_suffix(f".trace{loops}")
    output = run(program, env={"STAND_IN_TRACE": str(trace), "STAND_IN_LOOPS": str(loops)}, stdin=stdin)
    return trace, output


def mesh_of(name: str, folder: Path) -> Path:
    """The sketch's mesh as the simulator reads it."""
    if name == "HelloTriangle":
        return triangle_mesh(folder)
    if name == "SpinningModel":
        return convert(EXAMPLES / name / "gem.obj", folder / "mesh.elm", "--crease", "0")
    obj = folder / "mesh.obj"
    obj.write_text(TETRAHEDRON, encoding="utf-8")
    return convert(obj, folder / "mesh.elm", "--no-normals")


@pytest.mark.parametrize("name", EXAMPLES_SHOW)
def test_sketches_are_whole_and_short(name: str) -> None:
    sketches = sorted(path.parent.name for path in EXAMPLES.glob("*/*.ino"))
    assert sketches == sorted(EXAMPLES_SHOW)
    text = (EXAMPLES / name / f"{name}.ino").read_text(encoding="utf-8")
    assert len(text.splitlines()) < 100
    assert max(map(len, text.splitlines())) <= 120


@pytest.mark.parametrize("standard", ["gnu++11", "gnu++17", "gnu++20"])
@pytest.mark.parametrize("name", EXAMPLES_SHOW)
def test_they_compile_for_a_cortex_m0plus(name: str, standard: str, tmp_path: Path) -> None:
    compile_sketch(ARM, name, standard, tmp_path)


@pytest.mark.parametrize("name", EXAMPLES_SHOW)
def test_the_display_shows_the_simulators_picture(name: str, build: Build, tmp_path: Path) -> None:
    example = EXAMPLES_SHOW[name]
    program = build(name)
    panel = ("--panel", example.panel, "--rotation", str(example.rotation))
    expected = render(tmp_path, example.size, "--mesh", mesh_of(name, tmp_path), *example.view, *panel)
    shown = look(play(program, 1)[0], example.panel, example.rotation, example.size)
    assert np.array_equal(shown, expected)
    assert len(np.unique(shown)) > 1
    later = look(play(program, FRAMES)[0], example.panel, example.rotation, example.size)
    assert not np.array_equal(later, shown), "it stands still"


def test_a_wrong_pixel_would_be_seen(build: Build, tmp_path: Path) -> None:
    """The proof that the test above can fail: the same triangle, a colour of it one step off."""
    text = (EXAMPLES / "HelloTriangle" / "HelloTriangle.ino").read_text(encoding="utf-8")
    assert text.count("{255, 0, 0}") == 1
    sketch = tmp_path / "HelloTriangle.ino"
    sketch.write_text(text.replace("{255, 0, 0}", "{247, 0, 0}"), encoding="utf-8")
    trace, _ = play(build("HelloTriangle", sketch), 1)
    example = EXAMPLES_SHOW["HelloTriangle"]
    mesh = mesh_of("HelloTriangle", tmp_path)
    expected = render(tmp_path, example.size, "--mesh", mesh, *example.view)
    assert not np.array_equal(look(trace, example.panel, example.rotation, example.size), expected)


def test_the_stream_carries_the_same_frames(build: Build, tmp_path: Path) -> None:
    program = build("StreamToHost")
    start = framing.encode(protocol.pack(protocol.Start(credits=200), 0))
    _, output = play(program, FRAMES, stdin=start)
    capture = tmp_path / "capture"
    capture.write_bytes(output)
    run(
        *(sys.executable, "-m", "edgeline", "record", "-p", capture, "-o", tmp_path / "%04d.png", "--frames", "2"),
        cwd=REPOSITORY / "host",
    )
    first = np.asarray(Image.open(tmp_path / "0000.png"))
    assert not np.array_equal(first, np.asarray(Image.open(tmp_path / "0001.png")))
    example = EXAMPLES_SHOW["StreamToHost"]
    png = tmp_path / "expected.png"
    size = "x".join(map(str, example.size))
    mesh = mesh_of("StreamToHost", tmp_path)
    render(tmp_path, example.size, "--mesh", mesh, *example.view, "--size", size, "--png", png)
    assert np.array_equal(first, np.asarray(Image.open(png)))


def test_the_models_header_is_what_the_converter_makes(tmp_path: Path) -> None:
    folder = EXAMPLES / "SpinningModel"
    made = convert(folder / "gem.obj", tmp_path / "gem.h", "--crease", "0")
    assert made.read_text(encoding="utf-8") == (folder / "gem.h").read_text(encoding="utf-8")


def avr_errors(*arguments: str | Path) -> list[str]:
    compiler = need_tool("avr-gcc", "gcc-avr avr-libc")
    done = tried(compiler, "-mmcu=atmega328p", "-Os", f"-I{FIRMWARE / 'src'}", *arguments, "-o", "/dev/null")
    assert done.returncode != 0
    return [line.split("error: ")[1] for line in done.stderr.decode().splitlines() if "error: " in line]


@pytest.mark.parametrize("name", EXAMPLES_SHOW)
def test_avr_is_refused_by_one_clear_line(name: str) -> None:
    if not AVR_CORE.is_dir() or shutil.which("avr-gcc") is None:
        missing("no Arduino core for AVR: install arduino-core-avr gcc-avr avr-libc")
    folders = [AVR_CORE / "cores/arduino", AVR_CORE / "variants/standard", AVR_CORE / "libraries/SPI/src"]
    core = ["-std=gnu++11", "-DF_CPU=16000000L", "-DARDUINO=10819", *(f"-I{folder}" for folder in folders)]
    sketch = EXAMPLES / name / f"{name}.ino"
    errors = avr_errors(*core, f"-I{sketch.parent}", "-include", "Arduino.h", "-x", "c++", "-c", sketch)
    assert errors[0].startswith("#error "), errors
    assert "needs a 32-bit int" in errors[0]
    assert sum(line.startswith("#error ") for line in errors) == 1


def test_the_library_needs_no_include_path_but_src(native_library: list[Path]) -> None:
    """Arduino and PlatformIO compile each file below src/ with src/ alone; the fixture has done so."""
    assert len(native_library) == len(library_sources()) > 20
