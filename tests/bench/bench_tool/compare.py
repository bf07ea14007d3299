"""The alternatives: measured everywhere, scored, and marked where nothing else is both cheaper and more exact."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable
from typing import Any

from .choices import GROUPS, RENDERER
from .frames import Verdicts
from .machines import MAIN_CORES, BenchError, Line, Machines
from .score import Reference

Choice = dict[str, Any]


def measure(machines: Machines, verdicts: Verdicts) -> list[dict[str, Any]]:
    """All groups, as the JSON has them. What each way leaves must be the same on all machines."""
    keep = machines.folder / "native" / "alternatives.kept"
    native = [line for line in machines.native("alternatives", keep) if line.words[0] != "empty"]
    counts: dict[tuple[str, ...], dict[str, int]] = {line.words: {} for line in native}
    for core in MAIN_CORES:
        found = machines.target(core, "alternatives")
        if len(found) != len(native):
            raise BenchError(f"{core} measured {len(found)} alternatives, this computer {len(native)}")
        for here, there in zip(native, found, strict=True):
            counts[there.line.words][core] = there.instructions
            verdicts.check(
                there.line.crc == here.crc,
                f"{core} leaves {there.line.crc} after {' '.join(here.words)}, this computer {here.crc}",
            )
    reference = Reference(keep)
    return [_group(name, native, counts, reference, verdicts) for name in GROUPS]


def _group(
    name: str,
    native: list[Line],
    counts: dict[tuple[str, ...], dict[str, int]],
    reference: Reference,
    verdicts: Verdicts,
) -> dict[str, Any]:
    group = GROUPS[name]
    lines = {line.words[1]: line for line in native if line.words[0] == name}
    if set(lines) - {RENDERER} != set(group.choices):
        raise BenchError(f"choices.py knows other ways than the program for {name}: {', '.join(lines)}")
    unit, units = reference.units(name)
    chosen = lines[group.chosen]
    choices: list[Choice] = []
    for choice, title in group.choices.items():
        line = lines[choice]
        choices.append(
            {
                "name": choice,
                "title": title,
                "chosen": choice == group.chosen,
                "instructions": {core: round(count / units, 2) for core, count in counts[line.words].items()},
                "native_ns": round(int(line.values["ns"]) / units, 3),
                "native_ratio": round(int(line.values["ns"]) / int(chosen.values["ns"]), 3),
                "errors": {key: float(f"{value:.6g}") for key, value in reference.score(name, choice).items()},
            }
        )
    for row in choices:
        row["pareto"] = [core for core in MAIN_CORES if on_front(row, choices, core, group.error)]
    result: dict[str, Any] = {
        "name": name,
        "title": group.title,
        "unit": unit,
        "units": units,
        "error": group.error,
        "error_title": group.error_title,
        "choices": choices,
    }
    if RENDERER in lines:
        renderer = lines[RENDERER]
        verdicts.check(
            renderer.crc == chosen.crc, f"{name}: the renderer draws {renderer.crc}, the copy of its loop {chosen.crc}"
        )
        costs = counts[renderer.words]
        result["renderer_instructions"] = {core: round(costs[core] / units, 2) for core in MAIN_CORES}
    return result


def on_front(choice: Choice, choices: Iterable[Choice], core: str, error: str) -> bool:
    """Whether no other way is at least as cheap and as exact, and better in one of the two."""
    mine = (choice["instructions"][core], choice["errors"][error])
    others = [(other["instructions"][core], other["errors"][error]) for other in choices]
    return not any(cost <= mine[0] and wrong <= mine[1] and (cost, wrong) != mine for cost, wrong in others)


def as_csv(groups: Iterable[dict[str, Any]]) -> str:
    """One row per way and kind of error."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(
        [
            *("group", "choice", "title", "chosen", "unit", *(f"instructions_{core}" for core in MAIN_CORES)),
            *("native_ratio", "error", "value", *(f"pareto_{core}" for core in MAIN_CORES)),
        ]
    )
    for group in groups:
        for choice in group["choices"]:
            for error, value in choice["errors"].items():
                fronts = [int(core in choice["pareto"]) if error == group["error"] else "" for core in MAIN_CORES]
                costs = [choice["instructions"][core] for core in MAIN_CORES]
                writer.writerow(
                    [
                        *(group["name"], choice["name"], choice["title"], int(choice["chosen"]), group["unit"]),
                        *(*costs, choice["native_ratio"], error, value, *fronts),
                    ]
                )
    return text.getvalue()


def table(groups: Iterable[dict[str, Any]]) -> str:
    """A Markdown table; the renderer's choice in bold, a star where a way lies on a core's front."""
    lines = ["| | Cortex-M0+ | Cortex-M4F | native | error |", "|---|---|---|---|---|"]
    for group in groups:
        lines.append(f"| *{group['title']}*, instructions per {group['unit']} | | | | |")
        for choice in group["choices"]:
            title = f"**{choice['title']}**" if choice["chosen"] else choice["title"]
            costs = [
                f"{choice['instructions'][core]:.1f}{' *' if core in choice['pareto'] else ''}" for core in MAIN_CORES
            ]
            errors = ", ".join(f"{key.replace('_', ' ')} {value:.4g}" for key, value in choice["errors"].items())
            lines.append(f"| {title} | {' | '.join(costs)} | x {choice['native_ratio']:.2f} | {errors} |")
    return "\n".join(lines)
