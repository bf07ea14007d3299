"""Drawing in two dimensions: instructions of canvas/ per pixel, row, edge or character, and of whole pages."""

from __future__ import annotations

from dataclasses import dataclass

from .frames import Verdicts
from .machines import MAIN_CORES, BenchError, Machines


@dataclass(frozen=True)
class Drawing:
    """A drawing of `count` units."""

    name: str
    unit: str
    count: int
    instructions: dict[str, int]


def measure(machines: Machines, verdicts: Verdicts) -> list[Drawing]:
    """All drawings, on the main cores; each core must draw what this computer does."""
    native = [line for line in machines.native("canvas") if line.words[0] != "empty"]
    counts: dict[str, list[int]] = {}
    for core in MAIN_CORES:
        found = machines.target(core, "canvas")
        if len(found) != len(native):
            raise BenchError(f"{core} drew {len(found)} pictures, this computer {len(native)}")
        counts[core] = [one.instructions for one in found]
        for here, there in zip(native, found, strict=True):
            verdicts.check(there.line == here, f"{core} draws {there.line}, this computer {here}")
    return [
        Drawing(line.words[0], line.words[1], int(line.values["count"]), {core: counts[core][i] for core in MAIN_CORES})
        for i, line in enumerate(native)
    ]


def table(drawings: list[Drawing]) -> str:
    """A Markdown table."""
    lines = ["| drawing | units | Cortex-M0+ | Cortex-M4F | M0+ per unit | M4F per unit |", "|---|---|---|---|---|---|"]
    for drawing in drawings:
        whole = " | ".join(f"{drawing.instructions[core]:,}" for core in MAIN_CORES)
        each = " | ".join(f"{drawing.instructions[core] / drawing.count:,.1f}" for core in MAIN_CORES)
        lines.append(f"| {drawing.name} | {drawing.count:,} {drawing.unit} | {whole} | {each} |")
    return "\n".join(lines)
