"""What several cores gain over one: threads on this computer, in pairs of measurements."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from .machines import Machines


@dataclass(frozen=True)
class Gain:
    """Medians over the rounds of one run; gains are those of the rounds' ratios. workers.c says what the path is."""

    scene: str
    band_lines: int
    workers: int
    one_us: float
    many_us: float
    gain: float
    path_us: float
    path_gain: float


def measure(machines: Machines) -> list[Gain]:
    """The program compares the pictures itself. Raises BenchError where they differ."""
    return [
        Gain(
            scene=line.words[0],
            band_lines=int(line.words[1]),
            workers=int(line.words[2]),
            one_us=int(line.values["of-one"]) / 1000,
            many_us=int(line.values["ns"]) / 1000,
            gain=int(line.values["gain-q10"]) / 1024,
            path_us=int(line.values["path"]) / 1000,
            path_gain=int(line.values["path-gain-q10"]) / 1024,
        )
        for line in machines.native("workers")
    ]


def table(gains: Iterable[Gain]) -> str:
    """A Markdown table."""
    lines = [
        "| scene | band | one core | cores | all | times as fast | longest path | times as fast |",
        "|" + "---|" * 8,
    ]
    for one in gains:
        cells = [one.scene, f"{one.band_lines} lines", f"{one.one_us:.0f} us", str(one.workers)]
        cells += [f"{one.many_us:.0f} us", f"{one.gain:.2f}", f"{one.path_us:.0f} us", f"{one.path_gain:.2f}"]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)
