"""Native time relative to another revision: both are built and run in turns, so that whatever else this computer does,
and however fast it happens to be, falls on both.

Each run gives the best of many repeats of each frame; a ratio is taken between the two runs of a round, and the median
over all rounds is what counts. The quartiles show how sure it is.
"""

from __future__ import annotations

import shutil
import statistics
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from .frames import Verdicts
from .machines import ROOT, BenchError, Line, Machines, output_of

ROUNDS = 11


@dataclass(frozen=True)
class Compared:
    """A frame's times, medians of all rounds, and the ratio of this tree's to the other's."""

    title: str
    before_ns: int
    now_ns: int
    ratio: float
    quartiles: tuple[float, float]


def extract(revision: str, folder: Path) -> tuple[str, Path]:
    """The commit's name, and its files below `folder`. Raises BenchError for what git does not know."""
    try:
        commit = output_of(["git", "-C", ROOT, "rev-parse", "--verify", f"{revision}^{{commit}}"]).strip()
    except BenchError:
        raise BenchError(f"git knows no revision '{revision}'") from None
    tree = folder / commit[:12]
    if not tree.exists():
        folder.mkdir(parents=True, exist_ok=True)
        archive, part = tree.with_suffix(".tar"), tree.with_suffix(".part")
        output_of(["git", "-C", ROOT, "archive", f"--output={archive}", commit])
        shutil.rmtree(part, ignore_errors=True)
        shutil.unpack_archive(archive, part)
        part.rename(tree)
        archive.unlink()
    return commit, tree


def measure(machines: Machines, revision: str, verdicts: Verdicts) -> tuple[str, list[Compared]]:
    """The other revision's name, and all frames that both programs measure. They must be the same pictures."""
    folder = machines.folder / "against"
    commit, tree = extract(revision, folder)
    other = Machines(folder / f"{commit[:12]}.build", source=tree / "tests" / "bench")
    rounds = [(other.native("scenes"), machines.native("scenes")) for _ in range(ROUNDS)]
    for before, now in zip(*(_by_frame(lines).values() for lines in _common(*rounds[0])), strict=True):
        title = " ".join(now.words)
        verdicts.check(now.crc == before.crc, f"{title} is {now.crc}, with {commit[:12]} it was {before.crc}")
    return commit, compare(rounds)


def compare(rounds: Sequence[tuple[list[Line], list[Line]]]) -> list[Compared]:
    """Frames that both measure, from the lines of each round, the other revision's first."""
    times: dict[tuple[str, ...], list[tuple[int, int]]] = {}
    for both in rounds:
        before, now = (_by_frame(lines) for lines in _common(*both))
        for words, line in now.items():
            times.setdefault(words, []).append((int(before[words].values["ns"]), int(line.values["ns"])))
    if not times:
        raise BenchError("the two revisions measure no frame alike")
    return [_compared(" ".join(words), pairs) for words, pairs in times.items()]


def _compared(title: str, pairs: Sequence[tuple[int, int]]) -> Compared:
    ratios = [now / before for before, now in pairs]
    lower, middle, upper = statistics.quantiles(ratios, n=4, method="inclusive")
    return Compared(
        title=title,
        before_ns=round(statistics.median(before for before, _ in pairs)),
        now_ns=round(statistics.median(now for _, now in pairs)),
        ratio=middle,
        quartiles=(lower, upper),
    )


def _common(before: list[Line], now: list[Line]) -> tuple[list[Line], list[Line]]:
    """The lines of each whose frame the other has as well; the empty measurement is none."""
    known = {line.words for line in before} & {line.words for line in now}
    kept = {words for words in known if words[0] != "empty"}
    return [line for line in before if line.words in kept], [line for line in now if line.words in kept]


def _by_frame(lines: list[Line]) -> dict[tuple[str, ...], Line]:
    return dict(sorted((line.words, line) for line in lines))


def table(commit: str, frames: Sequence[Compared]) -> str:
    """A Markdown table; the last row is the geometric mean of the ratios."""
    lines = [
        f"| scene, arena, texture error, frame | {commit[:12]}, µs | now, µs | ratio | quartiles |",
        "|---|---|---|---|---|",
    ]
    for one in frames:
        lower, upper = one.quartiles
        lines.append(
            f"| {one.title} | {one.before_ns / 1000:,.1f} | {one.now_ns / 1000:,.1f} | {one.ratio:.3f} | "
            f"{lower:.3f} to {upper:.3f} |"
        )
    mean = statistics.geometric_mean(one.ratio for one in frames)
    return "\n".join([*lines, f"| geometric mean | | | **{mean:.3f}** | |"])
