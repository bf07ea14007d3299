"""Charts of how cost grows: pictures with a panel for each core. Points are measured frames, lines the laws that were
found for them."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .growth import LAWS, SPHERE_TRIANGLES, SPHERES_SEEN, Row, fit, predicted, rows_of
from .machines import CORES, MAIN_CORES, BenchError

PANEL_INCHES = (4.6, 3.1)
DOTS_PER_INCH = 100
# Distinct in grey and for the colour-blind (Okabe and Ito); curves that coincide show through each other.
CURVES = (("#0072b2", "o", "-"), ("#d55e00", "s", "--"), ("#009e73", "^", ":"))


@dataclass(frozen=True)
class Chart:
    """A picture: whose frames it shows, what lies along x, and by what its curves differ."""

    series: str
    title: str
    x_title: str
    x: Callable[[Row], float]
    curve: Callable[[Row], str] = lambda row: row.variant.replace("-", " ")
    variants: str = ""  # how their names begin
    ticks: tuple[int, ...] = ()  # x is logarithmic and has these
    y_from_0: bool = True  # else logarithmic
    marks: Callable[[Row], str] | None = None  # labels above the panel; "" for none
    passes: bool = False  # stand beside frames that took more than one


def _layers(shading: str) -> Chart:
    return Chart(
        "layers", f"Layers over the whole screen, {shading}", "layers", lambda row: row.x, variants=f"{shading}-"
    )


# By the name of the picture, growth_NAME.png.
CHARTS = {
    "triangles": Chart(
        "triangles",
        "A sphere of 200 px, flat",
        "triangles",
        lambda row: row.triangles / row.passes,
        lambda row: f"arena {row.arena_bytes // 1024} KB",
        ticks=(100, 300, 1000, 3000, 10000, 50000),
        y_from_0=False,
        passes=True,
    ),
    "pixels": Chart("pixels", "A board of 24 triangles comes nearer", "pixels on the screen", lambda row: row.pixels),
    "layers_flat": _layers("flat"),
    "layers_textured": _layers("textured"),
    "outside": Chart(
        "outside",
        f"{SPHERES_SEEN} spheres of {SPHERE_TRIANGLES} triangles in the view, others outside",
        "triangles outside",
        lambda row: (row.x - SPHERES_SEEN) * SPHERE_TRIANGLES,
        marks=lambda row: f"{1 - SPHERES_SEEN / row.x:.0%}" if row.x in (5, 100, 300, 500) else "",
    ),
    "bands": Chart(
        "bands",
        "Bands of 1 to 240 lines",
        "lines of a band",
        lambda row: row.band_lines,
        ticks=(1, 2, 4, 8, 16, 32, 80, 240),
    ),
    "arenas": Chart(
        "arenas",
        "Arenas of all sizes",
        "arena, KB",
        lambda row: row.arena_bytes / 1024,
        ticks=(16, 20, 32, 64, 128, 256, 512),
        y_from_0=False,
    ),
}


def draw(rows: Sequence[Row], folder: Path) -> list[Path]:
    """Writes all pictures; the same figures give the same files. Raises BenchError without matplotlib."""
    try:
        figures = importlib.import_module("matplotlib.figure")
        ticker = importlib.import_module("matplotlib.ticker")
    except ImportError as error:
        raise BenchError(f"charts need matplotlib ({error}); tests/prepare tests installs it") from None
    written = []
    for name, chart in CHARTS.items():
        width, height = PANEL_INCHES
        figure = figures.Figure(figsize=(width * len(MAIN_CORES), height), layout="constrained")
        for panel, core in zip(figure.subplots(1, len(MAIN_CORES)), MAIN_CORES, strict=True):
            _draw_curves(panel, chart, rows, core)
            _draw_axes(panel, chart, ticker)
            if chart.marks is not None:
                marks = {chart.x(row): chart.marks(row) for row in rows if row.series == chart.series}
                shown = {x: mark for x, mark in marks.items() if mark}
                panel.secondary_xaxis("top").set_xticks(list(shown), list(shown.values()), fontsize=8)
            panel.set_title(CORES[core].title, fontsize=10)
        figure.suptitle(chart.title, fontsize=11)
        path = folder / f"growth_{name}.png"
        figure.savefig(path, dpi=DOTS_PER_INCH, metadata={"Software": None})
        written.append(path)
    return written


def _draw_curves(panel: Any, chart: Chart, rows: Sequence[Row], core: str) -> None:
    """Points as measured, lines by the laws."""
    curves: dict[str, list[tuple[float, float, float]]] = {}
    beside = {"textcoords": "offset points", "xytext": (-5, 3), "ha": "right", "fontsize": 6.5, "color": "0.3"}
    for law in LAWS:
        if law.series == chart.series and law.variant.startswith(chart.variants):
            mine = rows_of(law, rows)
            for row, cost in zip(mine, predicted(law, mine, fit(law, mine, core)), strict=True):
                at = chart.x(row), row.instructions[core]
                curves.setdefault(chart.curve(row), []).append((*at, cost))
                if chart.passes and row.passes > 1:
                    panel.annotate(f"{row.passes} passes", (at[0], at[1] / 1e6), **beside)
    for (name, points), (colour, marker, dashes) in zip(curves.items(), CURVES, strict=False):
        xs, measured, expected = zip(*sorted(points), strict=True)
        panel.plot(xs, [cost / 1e6 for cost in expected], dashes, color=colour, linewidth=1.2, zorder=2)
        panel.plot(
            *(xs, [cost / 1e6 for cost in measured], marker),
            **{"color": colour, "markersize": 4.5, "markerfacecolor": "none", "label": name, "zorder": 3},
        )


def _draw_axes(panel: Any, chart: Chart, ticker: Any) -> None:
    figures = ticker.FuncFormatter(lambda value, _: f"{value:,g}")
    if chart.ticks:
        panel.set_xscale("log")
        panel.set_xticks(chart.ticks)
        panel.xaxis.set_minor_locator(ticker.NullLocator())
    else:
        panel.set_xlim(left=0)
    if chart.y_from_0:
        # With room for the legend, which curves that hardly fall would run into.
        panel.set_ylim(0, panel.get_ylim()[1] * (1.3 if chart.ticks else 1))
    else:
        panel.set_yscale("log")
        panel.yaxis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)))
        panel.yaxis.set_minor_locator(ticker.NullLocator())
    panel.xaxis.set_major_formatter(figures)
    panel.yaxis.set_major_formatter(figures)
    panel.set_xlabel(chart.x_title, fontsize=9)
    panel.set_ylabel("million instructions", fontsize=9)
    panel.tick_params(labelsize=8)
    panel.grid(True, which="major", linewidth=0.3)
    panel.spines[["top", "right"]].set_visible(False)
    panel.legend(fontsize=8, frameon=False)
