"""The scene's helpers: instructions per call on each core, and that all cores make the same of them."""

from __future__ import annotations

from .frames import Verdicts
from .machines import MAIN_CORES, BenchError, Machines


def measure(machines: Machines, verdicts: Verdicts) -> dict[str, dict[str, int]]:
    """Of each helper, by core."""
    native = [line for line in machines.native("helpers") if line.words[0] != "empty"]
    counts: dict[str, dict[str, int]] = {line.words[0]: {} for line in native}
    for core in MAIN_CORES:
        found = machines.target(core, "helpers")
        if len(found) != len(native):
            raise BenchError(f"{core} measured {len(found)} helpers, this computer {len(native)}")
        for here, there in zip(native, found, strict=True):
            verdicts.check(there.line == here, f"{core} makes {there.line}, this computer {here}")
            counts[here.words[0]][core] = there.instructions
    return counts


def table(counts: dict[str, dict[str, int]]) -> str:
    """A Markdown table."""
    lines = ["| once | Cortex-M0+ | Cortex-M4F |", "|---|---|---|"]
    for name, cores in counts.items():
        title = name.replace(",", ", ").replace("_KB", " KB").replace("_nodes", " nodes")
        lines.append(f"| `{title}` | {' | '.join(f'{cores[core]:,}' for core in MAIN_CORES)} |")
    return "\n".join(lines)
