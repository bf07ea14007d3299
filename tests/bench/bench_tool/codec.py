"""The stream's codec 2: bytes beside what others need for the same frames, the encoder's instructions, the decoder's
time. What may not get worse is compared with tests/bench/results/codec.json."""

from __future__ import annotations

import io
import sys
import time
import zlib
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import Image

from .frames import Verdicts
from .machines import MAIN_CORES, ROOT, BenchError, Machines

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
"""Frames decoded in a second of one desktop core's time."""

BYTES = ("split", "lines", "segments")


@dataclass(frozen=True)
class Encoded:
    """What the encoder makes of one sequence: bytes per frame when all is sent, instructions per pixel by core; and the
    bytes of the first design, by BYTES' names."""

    sequence: str
    split: int
    first: dict[str, int]
    instructions: dict[str, float]


@dataclass(frozen=True)
class Found(Encoded):
    """And the rest. Bytes are means per frame: `lines` and `segments` of sessions that leave out unchanged lines and
    segments, on the wire; `runs` codec 1; `png` and `zlib` whole frames. Rates are frames in a second of process
    time."""

    lines: int
    segments: int
    runs: int
    png: int
    zlib: int
    decoder_rate: float
    zlib_rate: float


def encode(machines: Machines, verdicts: Verdicts) -> list[Encoded]:
    """Runs the encoder on all machines. Every core's packets must be the native ones."""
    lines = [line for line in machines.native("codec", keep=_folder(machines)) if line.words[0] != "empty"]
    native = [line for line in lines if "bytes" in line.values]
    first = {line.words[0]: {key: int(line.values[key]) for key in BYTES} for line in lines if line.words[1] == "first"}
    crcs = {line.words: line.crc for line in native}
    counts: dict[tuple[str, str], list[int]] = {}
    for core in MAIN_CORES:
        for counted in machines.target(core, "codec"):
            words = counted.line.words
            verdicts.check(counted.line.crc == crcs[words], f"{core}: {' '.join(words)} has other bytes")
            counts.setdefault((words[0], core), []).append(counted.instructions)
    found = []
    for name, first_bytes in first.items():
        bytes_per_frame = [int(line.values["bytes"]) for line in native if line.words[0] == name]
        instructions = {core: round(_mean(counts[name, core]) / PIXELS, 1) for core in MAIN_CORES}
        found.append(Encoded(name, round(_mean(bytes_per_frame)), first_bytes, instructions))
    for one in found:
        limit = MOST_INSTRUCTIONS.get(one.sequence)
        cost = one.instructions["cortex-m0plus"]
        verdicts.check(limit is None or cost <= limit, f"{one.sequence}: {cost} instructions per pixel, not {limit}")
    return found


def measure(machines: Machines, verdicts: Verdicts) -> list[Found]:
    """Everything. Each frame that a session sent must be whole, by its digest; none may take more bytes than the first
    design did."""
    found = [_measure_sequence(one, _folder(machines)) for one in encode(machines, verdicts)]
    for one in found:
        for key in BYTES:
            now, was = getattr(one, key), one.first[key]
            verdicts.check(now <= was, f"{one.sequence}, {key}: {now} bytes per frame, {was} in the first design")
        verdicts.check(one.decoder_rate >= LEAST_RATE, f"{one.sequence}: decoded at {one.decoder_rate:.0f} frames/s")
    return found


def compare_with_recorded(found: Iterable[Encoded], recorded: dict[str, Any], verdicts: Verdicts) -> None:
    """Bytes and instructions not worse than the recorded ones, each of which must have been measured again."""
    known = {row["sequence"]: row for row in recorded["sequences"]}
    for one in found:
        row = known.get(one.sequence)
        if row is None:
            verdicts.check(False, f"codec, {one.sequence} is not recorded; run tests/bench/run --record-codec")
            continue
        figures = {f"{core}, instructions per pixel": count for core, count in one.instructions.items()}
        was = {f"{core}, instructions per pixel": count for core, count in row["instructions"].items()}
        for key in BYTES:
            if hasattr(one, key):
                figures[f"{key}, bytes per frame"] = getattr(one, key)
                was[f"{key}, bytes per frame"] = row[key]
        for what, figure in figures.items():
            verdicts.compare(f"codec, {one.sequence} on {what}", figure, was[what], "tests/bench/run --record-codec")


def _folder(machines: Machines) -> Path:
    return machines.folder / "codec"


def _mean(values: list[int]) -> float:
    return sum(values) / len(values)


def _measure_sequence(one: Encoded, folder: Path) -> Found:
    name = one.sequence
    wires = {mode: (folder / f"{name}.{mode}").read_bytes() for mode in ("segments", "lines", "runs")}
    frames = {mode: _frames(name, mode, wire) for mode, wire in wires.items()}
    pictures = [frame.picture for frame in frames["lines"]]
    packed = [zlib.compress(picture.tobytes(), 6) for picture in pictures]
    decoder_s, zlib_s = _decode_s(wires["lines"], packed)
    return Found(
        **vars(one),
        lines=round(_mean([frame.end.wire_bytes for frame in frames["lines"]])),
        segments=round(_mean([frame.end.wire_bytes for frame in frames["segments"]])),
        runs=round(_mean([_runs_bytes(picture) for picture in pictures[::EVERY]])),
        png=round(_mean([_png_bytes(picture) for picture in pictures[::EVERY]])),
        zlib=round(_mean([len(one) for one in packed])),
        decoder_rate=round(len(pictures) / decoder_s, 1),
        zlib_rate=round(len(pictures) / zlib_s, 1),
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


def _decode_s(wire: bytes, packed: list[bytes]) -> tuple[float, float]:
    """Process time that the decoder takes for all frames, and zlib for the same ones packed; the best of five each."""
    frames: list[list[protocol.Band]] = [[]]
    for body in _bodies(wire):
        if isinstance(body, protocol.Band):
            frames[-1].append(body)
        elif isinstance(body, protocol.FrameEnd):
            frames.append([])
    best, best_zlib = float("inf"), float("inf")
    for _ in range(5):
        picture: Pixels = np.zeros((240, 320), np.uint16)
        begin = time.process_time()
        for bands in frames[:-1]:
            split.decode(bands, picture)
        middle = time.process_time()
        for one in packed:
            zlib.decompress(one)
        best, best_zlib = min(best, middle - begin), min(best_zlib, time.process_time() - middle)
    return best, best_zlib


def _runs_bytes(picture: Pixels) -> int:
    band = runs_codec.encode_runs(0, 0, picture)
    return len(band.tokens) + len(band.literals)


def _png_bytes(picture: Pixels) -> int:
    buffer = io.BytesIO()
    Image.fromarray(to_rgb(picture)).save(buffer, "PNG")
    return buffer.tell()


def table(found: list[Found]) -> str:
    """Bytes per frame, instructions per pixel, frames per second; in brackets the first design's bytes."""
    lines = [
        f"{'':12} {'split':>15} {'lines':>15} {'segments':>15} {'runs':>7} {'PNG':>6} {'zlib 6':>6}"
        f" {'M0+':>5} {'M4F':>5} {'decoder':>8} {'zlib':>6} {'ratio':>6}"
    ]
    for one in found:
        sizes = " ".join(f"{getattr(one, key):6} {'(' + str(one.first[key]) + ')':>8}" for key in BYTES)
        lines.append(
            f"{one.sequence:12} {sizes} {one.runs:7} {one.png:6} {one.zlib:6}"
            f" {one.instructions['cortex-m0plus']:5.1f} {one.instructions['cortex-m4f']:5.1f}"
            f" {one.decoder_rate:8.0f} {one.zlib_rate:6.0f} {one.decoder_rate / one.zlib_rate:6.1%}"
        )
    return "\n".join(lines)


def rows(found: list[Found]) -> list[dict[str, Any]]:
    return [asdict(one) for one in found]
