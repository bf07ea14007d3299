"""The simulator's stable commands, as files and processes: nothing here knows how it works inside.

The formats are those of the simulator's `coverage`, `attributes` and `render` commands; all numbers little-endian.
"""

from __future__ import annotations

import json
import os
import struct
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

Ints = npt.NDArray[np.int64]

SUBPIXELS = int(os.environ.get("EDGELINE_SUBPIXELS", "16"))
"""Screen coordinates are integers of 1/16 pixel, or of 1/64 or 1/256 where the simulator was built so."""

SIXTEENTH = SUBPIXELS // 16
"""1/16 pixel in that unit."""

VERTEX = np.dtype(
    [("x", "<i4"), ("y", "<i4"), ("z", "<u2"), ("w", "<u2"), ("uv", "<i2", (2,)), ("rgb", "u1", (3,)), ("pad", "u1")]
)
"""A vertex of `attributes`: x, y in 1/16 px, z in 16-bit units, w = 1/w in 0.16, uv in texels 12.4, rgb in 8 bits."""

SAMPLE = np.dtype([("triangle", "<i4"), ("x", "<i4"), ("y", "<i4")])
"""A sample of `attributes`: a triangle's index and a pixel that it covers."""


class SimulatorError(AssertionError):
    """The simulator ended with another status than 0, or wrote something else than its format says."""


@dataclass(frozen=True)
class Rendering:
    """What `render` gave: pictures and depths of shape (frames, height, width), CRC lines, statistics per frame."""

    colour: npt.NDArray[np.uint16]
    depth: npt.NDArray[np.uint16]
    crcs: list[str]
    stats: list[dict[str, Any]]


@dataclass(frozen=True)
class Simulator:
    """The binary at `path`."""

    path: Path

    def run(self, *arguments: str, timeout: float = 120.0) -> subprocess.CompletedProcess[str]:
        """Runs the binary whatever its exit status; raises subprocess.TimeoutExpired."""
        return subprocess.run(
            [str(self.path), *arguments], capture_output=True, text=True, timeout=timeout, check=False
        )

    def run_well(self, *arguments: str) -> str:
        """Runs the binary and returns its standard output; raises SimulatorError when its status is not 0."""
        done = self.run(*arguments)
        if done.returncode != 0:
            raise SimulatorError(f"edgeline-sim {' '.join(arguments)}: status {done.returncode}: {done.stderr.strip()}")
        return done.stdout

    def scenes(self) -> list[str]:
        """The names that `list` prints, the first word of each line."""
        return [line.split()[0] for line in self.run_well("list").splitlines() if line.strip()]

    def coverage(self, triangles: Ints, width: int, height: int) -> tuple[npt.NDArray[np.uint32], ...]:
        """Pixels and CRC-32 of each triangle of shape (n, 3, 2), in 1/16 px."""
        header = b"HOC1" + struct.pack("<4i", len(triangles), width, height, SUBPIXELS)
        answer = self._exchange("coverage", header + triangles.astype("<i4").tobytes())
        if len(answer) != 8 * len(triangles):
            raise SimulatorError(f"coverage of {len(triangles)} triangles: {len(answer)} bytes")
        table = np.frombuffer(answer, "<u4").reshape(-1, 2).astype(np.uint32)
        return table[:, 0], table[:, 1]

    def attributes(self, vertices: npt.NDArray[Any], samples: npt.NDArray[Any]) -> npt.NDArray[np.float64]:
        """z, r, g, b, u, v of each of the SAMPLEs in triangles of VERTEX, shape (n, 3); shape (m, 6)."""
        header = b"HOA1" + struct.pack("<2i", len(vertices), len(samples))
        answer = self._exchange(
            "attributes", header + vertices.astype(VERTEX).tobytes() + samples.astype(SAMPLE).tobytes()
        )
        if len(answer) != 24 * len(samples):
            raise SimulatorError(f"attributes at {len(samples)} samples: {len(answer)} bytes")
        return np.frombuffer(answer, "<f4").reshape(-1, 6).astype(np.float64)

    def render(self, *arguments: str, width: int = 320, height: int = 240, pictures: bool = True) -> Rendering:
        """`render` with these arguments; without `pictures` only CRCs and statistics."""
        with tempfile.TemporaryDirectory() as folder:
            raw, depth = Path(folder, "raw"), Path(folder, "depth")
            files = ["--raw", str(raw), "--depth", str(depth)] if pictures else []
            text = self.run_well("render", "--size", f"{width}x{height}", "--crc", "--stats", *arguments, *files)
            lines = [line for line in text.splitlines() if line.strip()]
            shape = (-1, height, width)
            empty = np.zeros(0, "<u2").reshape(0, height, width)
            return Rendering(
                np.fromfile(raw, "<u2").reshape(shape) if pictures else empty,
                np.fromfile(depth, "<u2").reshape(shape) if pictures else empty,
                [line for line in lines if not line.startswith("{")],
                [json.loads(line) for line in lines if line.startswith("{")],
            )

    def _exchange(self, command: str, question: bytes) -> bytes:
        with tempfile.TemporaryDirectory() as folder:
            asked, answered = Path(folder, "in"), Path(folder, "out")
            asked.write_bytes(question)
            self.run_well(command, str(asked), str(answered))
            return answered.read_bytes()
