"""The guide tells the truth: its C stands in programs and tests that are compiled, its pictures are what the commands
below them make, its commands run, and its links lead somewhere.
"""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from PIL import Image, ImageChops

from conftest import REPOSITORY
from sim_commands import Simulator

FIRMWARE = REPOSITORY / "firmware"
PAGES = [FIRMWARE / "GUIDE.md", *sorted((FIRMWARE / "guide").glob("*.md"))]
COMPILED = [*(REPOSITORY / "tests" / "unit").glob("test_*_guide.c"), *(FIRMWARE / "examples" / "programs").glob("*.c")]
SHOWN = re.compile(r"!\[[^\]]*\]\(([^)]+)\)\n\(`(build/(?:sim|venv/bin)/[^`]+)`\)\n")


def words(text: str) -> str:
    """C without what clang-format decides."""
    return re.sub(r"\s+", " ", text).strip()


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_its_c_is_compiled(page: Path) -> None:
    sources = [words(path.read_text(encoding="utf-8")) for path in COMPILED]
    for block in re.findall(r"^```c\n(.*?)^```$", page.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE):
        for part in block.split("\n\n") if block.count("\n\n") > 1 else [block]:
            assert any(words(part) in source for source in sources), f"{page.name}: in no compiled file:\n{part}"


@pytest.mark.parametrize("page", PAGES[1:], ids=lambda page: page.stem)
def test_its_picture_is_what_the_command_makes(page: Path, simulator: Simulator, tmp_path: Path) -> None:
    shown = SHOWN.findall(page.read_text(encoding="utf-8"))
    assert shown, f"{page.name} has no picture with the command that makes it"
    copy_the_model(tmp_path)
    for picture, command in shown:
        run(command, simulator, tmp_path)
        made = next(tmp_path.glob("*.png"))
        with Image.open(made) as is_now, Image.open(page.parent / picture) as was:
            assert ImageChops.difference(is_now.convert("RGB"), was.convert("RGB")).getbbox() is None
        made.unlink()


def test_its_commands_run(simulator: Simulator, tmp_path: Path) -> None:
    """One after another in one folder, as somebody types them; the builds are those of this test's own run."""
    copy_the_model(tmp_path)
    typed = re.findall(r"^    (build/(?:venv|sim)/.+)$", PAGES[0].read_text(encoding="utf-8"), re.MULTILINE)
    assert len(typed) >= 6
    for command in typed:
        run(command, simulator, tmp_path)
    made = {path.name for path in tmp_path.glob("*.*")}
    assert {"hello.png", "preview.png", "my_model.h", "my_model.png", "teapot-0.png", "teapot-4.png"} <= made


@pytest.mark.parametrize("page", [*PAGES, FIRMWARE / "examples" / "GALLERY.md"], ids=lambda page: page.stem)
def test_its_links_lead_somewhere(page: Path) -> None:
    for link in re.findall(r"\]\(([^)#]+)\)", page.read_text(encoding="utf-8")):
        assert (page.parent / link).exists(), f"{page.name}: {link}"


def test_every_page_is_in_the_table() -> None:
    table = set(re.findall(r"\]\(guide/(\w+\.md)\)", PAGES[0].read_text(encoding="utf-8")))
    assert table == {page.name for page in PAGES[1:]}


@pytest.mark.parametrize(
    ("name", "row"),
    [
        ("EL_MAX_WIDTH", "| screen | 1x1 to {0}x{0} pixels |"),
        ("EL_GUARD_PX", "| corners on the screen | +-{0} px of its origin;"),
        ("EL_GUARD_PX", "| polygons | points within +-{0} px,"),
        ("EL_MESH_MAX_TRIANGLES", "| mesh | {0:,} triangles,"),
        ("EL_MESH_MAX_VERTICES", "triangles, {0:,} vertices |"),
        ("EL_IMAGE_MAX", "| images | {0:,} px a side;"),
        ("EL_MAX_SINKS", "| sinks | {0} |"),
    ],
)
def test_the_limits_are_those_of_the_headers(name: str, row: str) -> None:
    headers = [path.read_text(encoding="utf-8") for path in (FIRMWARE / "src").rglob("*.h")]
    [value] = [int(found) for text in headers for found in re.findall(rf"\b{name} = (\d+)\b", text)]
    assert row.format(value) in (FIRMWARE / "guide" / "limits.md").read_text(encoding="utf-8")


def copy_the_model(folder: Path) -> None:
    """Where commands that are typed in the repository's folder look for it."""
    shutil.copytree(FIRMWARE / "examples" / "SpinningModel", folder / "firmware" / "examples" / "SpinningModel")


def run(command: str, simulator: Simulator, folder: Path) -> None:
    """As typed, except that programs are where this run has them."""
    first, *arguments = shlex.split(command)
    if first == "build/venv/bin/edgeline":
        program = [sys.executable, "-m", "edgeline"]
    else:
        program = [str(simulator.path.parent / Path(first).relative_to("build/sim"))]
    environment = {**os.environ, "PYTHONPATH": str(REPOSITORY / "host"), "EDGELINE_SIM": str(simulator.path)}
    done = subprocess.run(
        [*program, *arguments], cwd=folder, env=environment, capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, f"{command}: {done.stderr or done.stdout}"
