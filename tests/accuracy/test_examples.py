"""The programs of firmware/examples/programs show what the gallery shows, and the gallery is what its maker writes.

After a change that is meant to change them: `firmware/examples/make_gallery.py`, and look at the pictures before
committing them.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from conftest import REPOSITORY, missing
from golden import expect_golden
from sim_commands import Simulator

EXAMPLES = REPOSITORY / "firmware" / "examples"
PROGRAMS = EXAMPLES / "programs"
MOST_LINES = 99
NAMES = sorted(re.findall(r"\[(\w+)\.c\]\(programs/", (EXAMPLES / "GALLERY.md").read_text(encoding="utf-8")))


@pytest.fixture(scope="module")
def gallery(simulator: Simulator, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the gallery as it is made now."""
    folder = tmp_path_factory.mktemp("gallery")
    command = [sys.executable, str(EXAMPLES / "make_gallery.py"), "--programs", str(simulator.path.parent / "examples")]
    subprocess.run([*command, "--pictures", str(folder), "--page", str(folder / "GALLERY.md")], check=True, timeout=60)
    return folder


@pytest.mark.parametrize("name", NAMES)
def test_a_program_shows_the_picture_of_the_gallery(gallery: Path, reports: Path, name: str) -> None:
    expect_golden(Image.open(gallery / f"example-{name}.png").convert("RGB"), f"example-{name}", reports)


def test_the_gallery_is_up_to_date(gallery: Path) -> None:
    assert (gallery / "GALLERY.md").read_text(encoding="utf-8") == (EXAMPLES / "GALLERY.md").read_text(encoding="utf-8")


def test_every_program_is_built_and_shown() -> None:
    cmake = (PROGRAMS / "examples.cmake").read_text(encoding="utf-8")
    built = re.search(r"set\(EDGELINE_EXAMPLES ([\w\s]+)\)", cmake)
    assert built is not None
    assert sorted(built[1].split()) == NAMES
    assert {path.stem for path in PROGRAMS.glob("*.c")} - {"example", "board_main", "gui_stand_in"} == set(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_a_program_has_fewer_than_100_lines(name: str) -> None:
    assert len((PROGRAMS / f"{name}.c").read_text(encoding="utf-8").splitlines()) <= MOST_LINES


@pytest.mark.parametrize("name", NAMES)
def test_any_keys_do_no_harm(checked_simulator: Simulator, name: str) -> None:
    """With sanitizers, where they are built; the same keys give the same frames again."""
    program = checked_simulator.path.parent / "examples" / name
    command = [str(program), "--frames", "24", "--step", "500000", "--crc", "--keys", "wwqq ssee ddaaW?wwwww sqqd"]
    first, again = (subprocess.run(command, capture_output=True, text=True, timeout=60, check=False) for _ in range(2))
    assert (first.returncode, first.stderr) == (0, "")
    assert len(first.stdout.split()) == 24
    assert first.stdout == again.stdout


def test_what_a_program_does_not_know_is_one_line(simulator: Simulator) -> None:
    program = str(simulator.path.parent / "examples" / "menu")
    for arguments in (["--frames", "0"], ["--nothing"], ["word"], ["--png", "no-such-folder/x.png"]):
        done = subprocess.run([program, *arguments], capture_output=True, text=True, timeout=60, check=False)
        assert done.returncode == 2
        assert len(done.stderr.splitlines()) == 1


OWN_MODEL = """mtllib own.mtl
v -3 -1 0\nv -1 -1 0\nv -1 1 0\nv -3 1 0\nv 1 -1 0\nv 1 1 0\nv 3 -1 0\nv 3 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1
usemtl left one\nf 1 2 3 4\nusemtl middle\nf 2/1 5/2 6/3 3/4\nusemtl Right\nf 5 7 8 6
"""
OWN_MATERIALS = """newmtl left one\nKd 1 0 0\nnewmtl middle\nmap_Kd green.png\nnewmtl Right\nKd 0 0 1\nd 0.5
"""
"""Three squares side by side: red, with a green picture, blue and half transparent."""


def test_a_model_of_several_materials_turns_whole(tmp_path: Path) -> None:
    """By the guide's commands, on a build of its own; the names have capitals and spaces."""
    if shutil.which("cmake") is None:
        missing("cmake")
    (tmp_path / "own.obj").write_text(OWN_MODEL, encoding="utf-8")
    (tmp_path / "own.mtl").write_text(OWN_MATERIALS, encoding="utf-8")
    Image.new("RGB", (4, 4), (0, 255, 0)).save(tmp_path / "green.png")
    header, build, shown = tmp_path / "my own.h", tmp_path / "build", tmp_path / "shown.png"
    for command in (
        [sys.executable, "-m", "edgeline", "convert", tmp_path / "own.obj", "--name", "MyOwn", "-o", header],
        ["cmake", "--preset", "sim", "-B", build, f"-DEDGELINE_EXAMPLE_MODEL={header}"],
        ["cmake", "--build", build, "--parallel", "2", "--target", "example-spinning_model"],
        [build / "examples" / "spinning_model", "--frames", "1", "--png", shown],
    ):
        environment = {**os.environ, "PYTHONPATH": str(REPOSITORY / "host")}
        done = subprocess.run(
            [*map(str, command)],
            cwd=REPOSITORY,
            env=environment,
            capture_output=True,
            text=True,
            timeout=300,
            check=False,
        )
        assert done.returncode == 0, f"{command}: {done.stderr or done.stdout}"
    row = np.asarray(Image.open(shown).convert("RGB"))[120].astype(int)
    lit = row[row.max(axis=1) > 64]
    assert lit[[0, len(lit) // 2, -1]].argmax(axis=1).tolist() == [0, 1, 2]
