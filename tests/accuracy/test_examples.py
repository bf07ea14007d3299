"""The programs of firmware/examples/programs show what the gallery shows, and the gallery is what its maker writes.

After a change that is meant to change them: `firmware/examples/make_gallery.py`, and look at the pictures before
committing them.
"""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
from PIL import Image

from conftest import REPOSITORY
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
