#!/usr/bin/env python3
"""Run the programs of firmware/examples/programs in the simulator, and write their pictures and the gallery that shows
them:

    firmware/examples/make_gallery.py [--programs build/sim/examples] [--pictures FOLDER] [--page FILE]

What a program is comes from the comment that it begins with; with which keys and when it is looked at stands here.
Without options the page is firmware/examples/GALLERY.md and the pictures are those in tests/golden, which a test
compares.
"""

from __future__ import annotations

import argparse
import re
import shlex
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
PICTURES = REPOSITORY / "tests" / "golden"
PAGE = HERE / "GALLERY.md"

HEAD = """# Gallery

Complete programs of fewer than 100 lines, in `firmware/examples/programs`. Each is one C source that runs in the
simulator and on a Raspberry Pi Pico, with the same pixels. The pictures below are what the commands beside them made,
and the tests compare them pixel by pixel; `firmware/examples/make_gallery.py` makes this page.

    cmake --preset sim && cmake --build --preset sim             # all of them: build/sim/examples/NAME
    cmake --preset rp2040                                        # once; then one of them, or the target examples:
    cmake --build --preset rp2040 --target example-menu          # build/rp2040/example-menu.uf2: drop it onto the Pico

On the Pico the display is wired as `firmware/boards/rp2040/WIRING.md` says (`one_bit`: an SSD1306 on the same pins),
and keys are letters that a terminal sends to its serial line at 115,200 baud. In the simulator they are `--keys`, one
for each frame; `--png frame-%03d.png` keeps every frame, and `--pty` prints a port for `edgeline view -p PORT`, which
shows it moving, with keys typed where it was started. A program is two functions, `example_setup` and `example_frame`
(`programs/example.h`), so it moves to a board of your own with `programs/board_main.c`, or into your own loop.

Arduino sketches are in `HelloTriangle`, `SpinningModel` and `StreamToHost`, a project for ESP-IDF in `esp_idf`.
"""


@dataclass(frozen=True)
class Shot:
    """A program, the heading above it, and the arguments with which its picture is taken."""

    name: str
    title: str
    arguments: tuple[str, ...]

    @property
    def picture(self) -> str:
        return f"example-{self.name}.png"


SHOTS = (
    Shot("hello_triangle", "Hello, triangle", ("--frames", "24")),
    Shot("spinning_model", "A model of your own", ("--frames", "30")),
    Shot("textured_room", "A textured room to walk through", ("--frames", "12", "--keys", "wwwwwwwwwwda")),
    Shot("attitude_indicator", "An attitude indicator", ("--frames", "60")),
    Shot("oscilloscope", "An oscilloscope", ("--frames", "40")),
    Shot("product_viewer", "A product viewer", ("--frames", "5", "--keys", "dw  q")),
    Shot("menu", "A menu over 3D", ("--frames", "30", "--keys", "s w.s")),
    Shot("flush_callback", "Beside another GUI", ("--frames", "40")),
    Shot("one_bit", "One bit per pixel", ("--frames", "30")),
)


def comment_of(name: str) -> str:
    """The comment that the program begins with, as one text; its paragraphs stay apart."""
    text = (HERE / "programs" / f"{name}.c").read_text(encoding="utf-8")
    found = re.match(r"/\* (.*?) \*/", text, re.DOTALL)
    if found is None:
        raise SystemExit(f"make_gallery: {name}.c does not begin with a comment")
    paragraphs = re.sub(r"\n \*", "\n", found[1]).split("\n\n")
    return "\n\n".join(" ".join(paragraph.split()) for paragraph in paragraphs)


def page() -> str:
    """The gallery as Markdown."""
    parts = [HEAD]
    for shot in SHOTS:
        command = shlex.join((f"build/sim/examples/{shot.name}", *shot.arguments, "--png", f"{shot.name}.png"))
        parts.append(
            f"## {shot.title}\n\n![{shot.title}](../../tests/golden/{shot.picture})\n\n{comment_of(shot.name)}\n\n"
            f"    {command}\n    cmake --build --preset rp2040 --target example-{shot.name}\n\n"
            f"[{shot.name}.c](programs/{shot.name}.c)\n"
        )
    return "\n".join(parts)


def take(shot: Shot, programs: Path, folder: Path) -> None:
    """Runs the program, and leaves its picture in `folder`."""
    program = programs / shot.name
    if not program.is_file():
        raise SystemExit(f"make_gallery: {program} is not there: cmake --preset sim && cmake --build --preset sim")
    subprocess.run([program, *shot.arguments, "--png", folder / shot.picture], check=True)


def main() -> int:
    parser = argparse.ArgumentParser(description="Make the gallery of examples.")
    parser.add_argument("--programs", type=Path, default=REPOSITORY / "build" / "sim" / "examples")
    parser.add_argument("--pictures", type=Path, default=PICTURES)
    parser.add_argument("--page", type=Path, default=PAGE)
    options = parser.parse_args()
    for shot in SHOTS:
        take(shot, options.programs, options.pictures)
    options.page.write_text(page(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
