"""The ESP-IDF component and its example: registered as ESP-IDF wants it, compiled without a warning for an ESP32-C3's
instruction set, and on a stand-in for ESP-IDF's drivers the display shows the simulator's picture, pixel for pixel.
"""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

from needs import need_tool
from packages_tools import (
    FIRMWARE,
    HERE,
    RISCV,
    TRIANGLE_VIEW,
    library_sources,
    look,
    render,
    run,
    triangle_mesh,
    tried,
)

EXAMPLE = FIRMWARE / "examples" / "esp_idf"
IDF = {"IDF_PATH": str(HERE / "esp_idf_stand_in")}
SIZE = (240, 240)


def build(folder: Path, source: Path = EXAMPLE, *definitions: str) -> Path:
    """Builds the example as `idf.py build` does; the folder of the build."""
    need_tool("cmake", "cmake")
    run("cmake", "-S", source, "-B", folder, *definitions, env=IDF)
    run("cmake", "--build", folder, "--parallel", "2")
    return folder


def test_it_compiles_for_an_esp32_c3(tmp_path: Path) -> None:
    compiler, *flags = RISCV.c
    need_tool(compiler, RISCV.package)
    definitions = [
        "-DCMAKE_SYSTEM_NAME=Generic",
        f"-DCMAKE_C_COMPILER={compiler}",
        f"-DCMAKE_C_FLAGS={' '.join(flags)}",
    ]
    folder = build(tmp_path, EXAMPLE, *definitions, "-DCMAKE_TRY_COMPILE_TARGET_TYPE=STATIC_LIBRARY")
    [component, main] = (folder / "components.txt").read_text(encoding="utf-8").splitlines()
    name, sources, include_dirs = component.split("|")
    assert (name, include_dirs) == ("firmware", "src")
    assert sorted(map(Path, sources.split(";"))) == [path for path in library_sources() if path.suffix == ".c"]
    assert main == "main|main.c;bus.c|."


def shown(folder: Path, frames: int) -> np.ndarray[tuple[int, ...], np.dtype[np.uint16]]:
    trace = folder / f"trace{frames}"
    run(folder / "edgeline_triangle", env={"STAND_IN_TRACE": str(trace), "STAND_IN_FRAMES": str(frames)})
    return look(trace, "st7789-240x240", 0, SIZE)


def test_the_display_shows_the_simulators_picture(tmp_path: Path) -> None:
    view = (*TRIANGLE_VIEW, "--panel", "st7789-240x240")
    expected = render(tmp_path, SIZE, "--mesh", triangle_mesh(tmp_path), *view)
    folder = build(tmp_path / "build")
    assert np.array_equal(shown(folder, 1), expected)
    assert not np.array_equal(shown(folder, 3), expected), "it stands still"


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("    open = true;\n", "    done(argument);\n"),
        ("    close_transfer();\n    spi_transaction_t first", "    spi_transaction_t first"),
        ("return (spi_transaction_t){.length = 8 * bytes", "return (spi_transaction_t){.length = bytes"),
    ],
    ids=["a band given back before it is sent", "a command amid a transfer", "lengths in bytes"],
)
def test_a_broken_bus_is_seen(right: str, wrong: str, tmp_path: Path) -> None:
    """The proof that the test above can fail."""
    source = tmp_path / "firmware" / "examples" / "esp_idf"
    shutil.copytree(EXAMPLE, source)
    bus = source / "main" / "bus.c"
    text = bus.read_text(encoding="utf-8")
    assert text.count(right) == 1, f"bus.c: not once: {right!r}"
    bus.write_text(text.replace(right, wrong), encoding="utf-8")
    project = (source / "CMakeLists.txt").read_text(encoding="utf-8")
    (source / "CMakeLists.txt").write_text(
        project.replace("${CMAKE_CURRENT_LIST_DIR}/../..", str(FIRMWARE)), encoding="utf-8"
    )
    folder = build(tmp_path / "build", source)
    trace = tmp_path / "trace"
    done = tried(folder / "edgeline_triangle", env={"STAND_IN_TRACE": str(trace), "STAND_IN_FRAMES": "2"})
    if done.returncode == 0:
        with pytest.raises(AssertionError):
            look(trace, "st7789-240x240", 0, SIZE)
