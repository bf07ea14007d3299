"""Drawing in two dimensions: instructions of canvas/ per pixel, row, edge or character, and of whole pages."""

from __future__ import annotations

from dataclasses import dataclass

from .frames import Verdicts, measure_alike
from .machines import MAIN_CORES, Machines


@dataclass(frozen=True)
class Drawing:
    """A drawing of `count` units."""

    name: str
    unit: str
    count: int
    instructions: dict[str, int]


def measure(machines: Machines, verdicts: Verdicts) -> list[Drawing]:
    """All drawings, on the main cores; each core must draw what this computer does."""
    return [
        Drawing(line.words[0], line.words[1], int(line.values["count"]), counts)
        for line, counts in measure_alike(machines, "canvas", verdicts)
    ]


def table(drawings: list[Drawing]) -> str:
    """A Markdown table."""
    lines = ["| drawing | units | Cortex-M0+ | Cortex-M4F | M0+ per unit | M4F per unit |", "|---|---|---|---|---|---|"]
    for drawing in drawings:
        whole = " | ".join(f"{drawing.instructions[core]:,}" for core in MAIN_CORES)
        each = " | ".join(f"{drawing.instructions[core] / drawing.count:,.1f}" for core in MAIN_CORES)
        lines.append(f"| {drawing.name} | {drawing.count:,} {drawing.unit} | {whole} | {each} |")
    return "\n".join(lines)
