"""Writing the headers that make_fonts.py and make_meshes.py make."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

from edgeline.convert.files import write_whole
from edgeline.errors import EdgelineError


def write_headers(program: str, folder: Path, make: Callable[[], dict[str, str]]) -> int:
    """Writes what `make` gives, by its name, and tells how much that is. Returns the program's exit status, after one
    line on stderr where it is not 0."""
    try:
        for name, text in make().items():
            write_whole(folder / f"{name}.h", text.encode())
            print(f"{folder.name}/{name}.h: {len(text):,} characters")
    except EdgelineError as error:
        print(f"{program}: {error}", file=sys.stderr)
        return error.exit_code
    return 0
