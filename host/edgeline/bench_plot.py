"""A chart of what tests/bench measures: for each choice of the renderer, executed instructions against error.

A panel per group and core; each numbered point is one way to do the same, the renderer's own is filled, and the stepped
line is the Pareto front, below and left of which nothing was found.
"""

from __future__ import annotations

from typing import Any

from edgeline.chart import draw_with_pyplot
from edgeline.errors import EdgelineError

CORE_TITLES = {"cortex-m0plus": "Cortex-M0+", "cortex-m4f": "Cortex-M4F"}
PANEL_INCHES = (4.4, 2.5)


def check(path: str, content: dict[str, Any]) -> list[dict[str, Any]]:
    """The groups of an accuracy_cost.json. Raises EdgelineError when it lacks something."""
    groups = content["groups"]
    if not isinstance(groups, list) or not groups:
        raise EdgelineError(f"{path} holds no groups; tests/bench/run --all writes a file that does")
    try:
        for group in groups:
            points(group, next(iter(CORE_TITLES)))
    except (KeyError, TypeError, ValueError) as error:
        raise EdgelineError(f"{path} lacks {error}; tests/bench/run --all writes a file that has it") from None
    return groups


def points(group: dict[str, Any], core: str) -> list[tuple[float, float, str, bool]]:
    """Instructions per unit, error, title and whether it is the renderer's, of each way in a group."""
    return [
        (
            float(choice["instructions"][core]),
            float(choice["errors"][group["error"]]),
            str(choice["title"]),
            bool(choice["chosen"]),
        )
        for choice in group["choices"]
    ]


def front(found: list[tuple[float, float, str, bool]]) -> list[tuple[float, float]]:
    """The points that no other one equals or beats in both, cheapest first: cost rises, error falls."""
    kept: list[tuple[float, float]] = []
    for cost, error, *_ in sorted(found):
        if not kept or error < kept[-1][1]:
            kept.append((cost, error))
    return kept


def draw(groups: list[dict[str, Any]], output: str) -> None:
    """Writes the chart as PNG (or whatever matplotlib makes of the name's ending). Raises EdgelineError."""
    draw_with_pyplot(lambda pyplot: _draw(pyplot, groups), output)


def _draw(pyplot: Any, groups: list[dict[str, Any]]) -> Any:
    width, height = PANEL_INCHES
    figure, panels = pyplot.subplots(
        len(groups),
        len(CORE_TITLES),
        squeeze=False,
        figsize=(width * len(CORE_TITLES), height * len(groups)),
        layout="constrained",
    )
    for row, group in zip(panels, groups, strict=True):
        for panel, (core, title) in zip(row, CORE_TITLES.items(), strict=True):
            _draw_panel(panel, group, core, f"{group['title']}; {title}")
        names = [title for *_, title, _ in points(group, next(iter(CORE_TITLES)))]
        legend = "\n".join(f"{number}  {name}" for number, name in enumerate(names, start=1))
        row[-1].annotate(
            legend,
            (1, 0.5),
            xytext=(8, 0),
            xycoords="axes fraction",
            textcoords="offset points",
            va="center",
            fontsize=9,
        )
    return figure


def _draw_panel(panel: Any, group: dict[str, Any], core: str, title: str) -> None:
    found = points(group, core)
    errors = [error for _, error, *_ in found if error > 0]
    # The axis is logarithmic; an error of zero lies on its lower end, which says so.
    lowest, highest = min(errors, default=1.0) / 8, max(errors, default=1.0) * 4
    edge = [(cost, max(error, lowest)) for cost, error in front(found)]
    panel.set_yscale("log")
    panel.set_ylim(lowest / 2, highest)
    panel.set_xlim(0, 1.08 * max(cost for cost, *_ in found))
    outline = [(edge[0][0], highest), *edge, (panel.get_xlim()[1], edge[-1][1])]
    panel.step(*zip(*outline, strict=True), where="post", color="0.75", linewidth=1.5, zorder=1)
    for number, (cost, error, _, chosen) in enumerate(found, start=1):
        face, ink = ("tab:red", "white") if chosen else ("white", "tab:red")
        at = (cost, max(error, lowest))
        panel.plot(*at, marker="o", markersize=12, markeredgecolor="tab:red", markerfacecolor=face, zorder=2 + number)
        panel.annotate(str(number), at, color=ink, ha="center", va="center", fontsize=8, zorder=2 + number)
    if any(error == 0 for _, error, *_ in found):
        panel.annotate("0", (0, lowest), xytext=(-8, 0), textcoords="offset points", ha="right", va="center")
    panel.set_title(title, fontsize=9)
    panel.set_xlabel(f"instructions per {group['unit']}", fontsize=8)
    panel.set_ylabel(group["error_title"].replace(" per ", "\nper ").replace(", ", ",\n"), fontsize=8)
    panel.tick_params(labelsize=8)
    panel.minorticks_off()
    panel.grid(True, which="major", linewidth=0.3)
