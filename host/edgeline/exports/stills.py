"""PNG: one picture, and a numbered sequence."""

from __future__ import annotations

import re
from pathlib import Path

from edgeline.codec import Pixels
from edgeline.colour import to_image
from edgeline.errors import OutputError
from edgeline.outfile import AtomicFile, cannot_write, check_writable

_NUMBER = re.compile(r"%(0[1-9])?d")


def save_png(path: str, picture: Pixels) -> None:
    """Writes one picture, (h, w) RGB565. Raises OutputError."""
    file = AtomicFile(path)
    try:
        to_image(picture).save(file.stream, "PNG")
        file.commit()
    except OSError as error:
        raise cannot_write(path, error) from None
    finally:
        file.discard()


class PngSequence:
    """One PNG per frame, numbered from 0; each is complete as soon as it is there."""

    def __init__(self, pattern: str) -> None:
        path = Path(pattern)
        if path.suffix.lower() != ".png" or not _NUMBER.search(path.name) or path.name.count("%") != 1:
            raise OutputError(f"{pattern}: a sequence is named with one number and .png, as in frames/%04d.png")
        self._pattern = path
        self._count = 0
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise cannot_write(str(path.parent), error) from None
        check_writable(pattern)

    def add(self, picture: Pixels, time_us: int) -> None:
        save_png(str(self._pattern.with_name(self._pattern.name % self._count)), picture)
        self._count += 1

    def finish(self) -> None:
        """Every file is complete already."""

    def discard(self) -> None:
        """What is there is good."""
