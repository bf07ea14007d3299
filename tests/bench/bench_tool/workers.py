"""What several cores gain over one: threads on this computer, in pairs of measurements."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from .machines import Machines


@dataclass(frozen=True)
class Gain:
    """Medians over the rounds of one run; gains are those of the rounds' ratios. workers.c says what the path is."""

    scene: str
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
            workers=int(line.words[1]),
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
    lines = ["| scene | one core | cores | all | times as fast | longest path | times as fast |", "|" + "---|" * 7]
    lines += [
        f"| {gain.scene} | {gain.one_us:.0f} us | {gain.workers} | {gain.many_us:.0f} us | {gain.gain:.2f} | "
        f"{gain.path_us:.0f} us | {gain.path_gain:.2f} |"
        for gain in gains
    ]
    return "\n".join(lines)
