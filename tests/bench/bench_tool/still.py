"""Frames after one another: what it saves, on each core and on the display's bus, to leave out what has not changed."""

from __future__ import annotations

from dataclasses import dataclass

from .frames import Verdicts, measure_alike
from .machines import MAIN_CORES, Machines

WIRE_BYTES_PER_S = 62.5e6 / 8
"""Of the Pico's SPI."""


@dataclass(frozen=True)
class Still:
    """The second of two frames. `way`: what is left out."""

    scene: str
    way: str
    bus_bytes: int
    instructions: dict[str, int]


def measure(machines: Machines, verdicts: Verdicts) -> list[Still]:
    """All scenes, on the main cores; what goes over the bus must be the same on each, and on this computer."""
    return [
        Still(line.words[0], line.words[1].replace(",", ", "), int(line.values["bytes"]), counts)
        for line, counts in measure_alike(machines, "still", verdicts)
    ]


def table(frames: list[Still]) -> str:
    """A Markdown table."""
    lines = [
        "| scene | sent or left out | Cortex-M0+ | Cortex-M4F | bytes on the bus | ms at 62.5 MHz |",
        "|---|---|---|---|---|---|",
    ]
    for frame in frames:
        counts = " | ".join(f"{frame.instructions[core] / 1e6:.3f} M" for core in MAIN_CORES)
        ms = frame.bus_bytes / WIRE_BYTES_PER_S * 1e3
        lines.append(f"| {frame.scene} | {frame.way} | {counts} | {frame.bus_bytes:,} | {ms:.1f} |")
    return "\n".join(lines)
