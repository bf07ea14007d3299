"""The scene's helpers: instructions per call on each core, and that all cores make the same of them."""

from __future__ import annotations

from .frames import Verdicts, measure_alike
from .machines import MAIN_CORES, Machines


def measure(machines: Machines, verdicts: Verdicts) -> dict[str, dict[str, int]]:
    """Of each helper, by core."""
    return {line.words[0]: counts for line, counts in measure_alike(machines, "helpers", verdicts)}


def table(counts: dict[str, dict[str, int]]) -> str:
    """A Markdown table."""
    lines = ["| once | Cortex-M0+ | Cortex-M4F |", "|---|---|---|"]
    for name, cores in counts.items():
        title = name.replace(",", ", ").replace("_KB", " KB").replace("_nodes", " nodes")
        lines.append(f"| `{title}` | {' | '.join(f'{cores[core]:,}' for core in MAIN_CORES)} |")
    return "\n".join(lines)
