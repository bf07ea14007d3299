"""The stream's codec 2: bytes beside what others need for the same frames, the encoder's instructions, the decoder's
time."""

from __future__ import annotations

import io
import sys
import time
import zlib
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import Image

from .frames import Verdicts
from .machines import CORES, ROOT, BenchError, Machines

sys.path.insert(0, str(ROOT / "host"))

from edgeline import codec as runs_codec
from edgeline import framing, protocol, split
from edgeline.colour import to_rgb
from edgeline.session import Frame, Session

Pixels = npt.NDArray[np.uint16]

PIXELS = 320 * 240
EVERY = 6
"""Of the frames, one in so many is compressed by the slower methods."""

MOST_INSTRUCTIONS = {"flat": 13, "gouraud": 16, "room": 53}
"""Per pixel, on a Cortex-M0+."""

LEAST_RATE = 120
"""Frames decoded in a second, on a desktop's core."""


@dataclass(frozen=True)
class Found:
    """One sequence. Bytes are means per frame: `split`, `lines` and `segments` of codec 2, sending everything, changed
    lines, and changed segments; the last two on the wire. Rates are frames per second."""

    sequence: str
    split: int
    lines: int
    segments: int
    runs: int
    png: int
    zlib: int
    instructions: dict[str, float]
    decoder_rate: float
    zlib_rate: float


def measure(machines: Machines, verdicts: Verdicts) -> list[Found]:
    """Runs every sequence. Each frame that a session sent must be whole, by its digest, and every core's packets must
    be the native ones."""
    folder = machines.folder / "codec"
    native = [line for line in machines.native("codec", keep=folder) if line.words[0] != "empty"]
    crcs = {line.words: line.crc for line in native}
    counts: dict[tuple[str, str], list[int]] = {}
    for core in CORES:
        for counted in machines.target(core, "codec"):
            words = counted.line.words
            verdicts.check(counted.line.crc == crcs[words], f"{core}: {' '.join(words)} has other bytes")
            counts.setdefault((words[0], core), []).append(counted.instructions)
    found = []
    for name in dict.fromkeys(line.words[0] for line in native):
        bytes_per_frame = [int(line.values["bytes"]) for line in native if line.words[0] == name]
        instructions = {core: round(_mean(counts[name, core]) / PIXELS, 1) for core in CORES}
        found.append(_measure_sequence(name, folder, round(_mean(bytes_per_frame)), instructions))
    for one in found:
        limit = MOST_INSTRUCTIONS.get(one.sequence)
        cost = one.instructions["cortex-m0plus"]
        verdicts.check(limit is None or cost <= limit, f"{one.sequence}: {cost} instructions per pixel, not {limit}")
        verdicts.check(one.decoder_rate >= LEAST_RATE, f"{one.sequence}: decoded at {one.decoder_rate:.0f} frames/s")
    return found


def _mean(values: list[int]) -> float:
    return sum(values) / len(values)


def _measure_sequence(name: str, folder: Path, bytes_per_frame: int, instructions: dict[str, float]) -> Found:
    wires = {mode: (folder / f"{name}.{mode}").read_bytes() for mode in ("segments", "lines", "runs")}
    frames = {mode: _frames(name, mode, wire) for mode, wire in wires.items()}
    pictures = [frame.picture for frame in frames["lines"]]
    packed = [zlib.compress(picture.tobytes(), 6) for picture in pictures]
    begin = time.perf_counter()
    for one in packed:
        zlib.decompress(one)
    zlib_s = time.perf_counter() - begin
    return Found(
        name,
        bytes_per_frame,
        round(_mean([frame.end.wire_bytes for frame in frames["lines"]])),
        round(_mean([frame.end.wire_bytes for frame in frames["segments"]])),
        round(_mean([_runs_bytes(picture) for picture in pictures[::EVERY]])),
        round(_mean([_png_bytes(picture) for picture in pictures[::EVERY]])),
        round(_mean([len(one) for one in packed])),
        instructions,
        round(len(pictures) / _decode_s(wires["lines"]), 1),
        round(len(pictures) / zlib_s, 1),
    )


def _frames(name: str, mode: str, wire: bytes) -> list[Frame]:
    """What a host that has sent PING and START would have seen."""
    session = Session()
    session.tick(0)
    events = session.receive(wire, 0)
    frames = [event for event in events if isinstance(event, Frame)]
    ends = sum(isinstance(body, protocol.FrameEnd) for body in _bodies(wire))
    if len(frames) != ends or ends == 0:
        raise BenchError(f"{name}.{mode}: {len(frames)} frames of {ends} are whole")
    return frames


def _bodies(wire: bytes) -> list[protocol.Body | None]:
    return [protocol.unpack(chunk) for chunk in framing.Splitter().feed(wire) if isinstance(chunk, framing.Packet)]


def _decode_s(wire: bytes) -> float:
    """Seconds that the decoder takes for all frames; the best of three."""
    frames: list[list[protocol.Band]] = [[]]
    for body in _bodies(wire):
        if isinstance(body, protocol.Band):
            frames[-1].append(body)
        elif isinstance(body, protocol.FrameEnd):
            frames.append([])
    best = float("inf")
    for _ in range(3):
        picture: Pixels = np.zeros((240, 320), np.uint16)
        begin = time.perf_counter()
        for bands in frames[:-1]:
            split.decode(bands, picture)
        best = min(best, time.perf_counter() - begin)
    return best


def _runs_bytes(picture: Pixels) -> int:
    band = runs_codec.encode_runs(0, 0, picture)
    return len(band.tokens) + len(band.literals)


def _png_bytes(picture: Pixels) -> int:
    buffer = io.BytesIO()
    Image.fromarray(to_rgb(picture)).save(buffer, "PNG")
    return buffer.tell()


def table(found: list[Found]) -> str:
    """Bytes per frame, instructions per pixel, frames per second."""
    rows = [
        f"{'':12} {'split':>7} {'lines':>7} {'segments':>8} {'runs':>7} {'PNG':>7} {'zlib 6':>7}"
        f" {'M0+':>6} {'M4F':>6} {'decoder':>8} {'zlib':>6}"
    ]
    rows += [
        f"{one.sequence:12} {one.split:7} {one.lines:7} {one.segments:8} {one.runs:7} {one.png:7} {one.zlib:7}"
        f" {one.instructions['cortex-m0plus']:6.1f} {one.instructions['cortex-m4f']:6.1f}"
        f" {one.decoder_rate:8.0f} {one.zlib_rate:6.0f}"
        for one in found
    ]
    return "\n".join(rows)


def rows(found: list[Found]) -> list[dict[str, Any]]:
    return [asdict(one) for one in found]
