"""The program `features` (tests/features), built beside the simulator: pictures of each feature, in any way."""

from __future__ import annotations

import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

WIDTH, HEIGHT = 240, 160


class Drawn(NamedTuple):
    """A feature, by the CRC-32 of its pixels and of its depth, and the passes that it took."""

    crc: str
    depth: str
    passes: int


@dataclass(frozen=True)
class Features:
    """The program at `path`."""

    path: Path

    def draw(self, *arguments: str) -> dict[str, Drawn]:
        """All features, in their order."""
        done = subprocess.run([str(self.path), *arguments], capture_output=True, text=True, timeout=60, check=False)
        assert done.returncode == 0, f"features {' '.join(arguments)}: status {done.returncode}: {done.stderr.strip()}"
        rows = [line.split() for line in done.stdout.splitlines()]
        return {name: Drawn(crc, depth, int(passes)) for name, crc, depth, passes in rows}

    def pictures(self, folder: Path, *arguments: str) -> dict[str, npt.NDArray[np.uint16]]:
        """All features as RGB565, of shape (HEIGHT, WIDTH); `folder` gets files."""
        names = self.draw("--raw", str(folder), *arguments)
        return {name: np.fromfile(folder / f"{name}.raw", "<u2").reshape(HEIGHT, WIDTH) for name in names}
