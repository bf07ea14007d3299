"""A chart of what frames cost: a bar per scene and core, its instructions by stage; for the standard scenes the best
peer's and what is to be reached beside it."""

from __future__ import annotations

from typing import Any

from edgeline.chart import draw_with_pyplot
from edgeline.errors import EdgelineError

CORE_TITLES = {"cortex-m0plus": "Cortex-M0+", "cortex-m4f": "Cortex-M4F"}
STAGE_COLOURS = {
    "vertex": "tab:blue",
    "clip": "tab:cyan",
    "set-up": "tab:orange",
    "bin": "tab:olive",
    "rows": "tab:green",
    "pixels": "tab:red",
    "sink": "tab:purple",
}
WIDTH_INCHES = 5.0
BAR_INCHES = 0.27
ROOM_INCHES = 0.75

Frames = dict[str, dict[str, Any]]


def check(path: str, content: dict[str, Any]) -> dict[str, Any]:
    """A scenes.json. Raises EdgelineError when it lacks something."""
    try:
        for row in panels_of(content):
            for frame in row.values():
                for core in CORE_TITLES:
                    shares(frame, core)
        if not panels_of(content):
            raise EdgelineError(f"{path} holds no frames; tests/bench/run --all writes a file that does")
        _ = content["peers"], content["targets"]
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        raise EdgelineError(f"{path} lacks {error}; tests/bench/run --all writes a file that has it") from None
    return content


def panels_of(content: dict[str, Any]) -> list[Frames]:
    """First frames as a user's program has them, by scene: the standard ones, layers, and all others."""
    found: Frames = {}
    for frame in content["frames"]:
        if frame["number"] == 0 and frame["subpixel_bits"] == 4 and frame["uv_error_log2"] == 3:
            found.setdefault(frame["scene"], frame)
    rows: list[Frames] = [{}, {}, {}]
    for scene, frame in found.items():
        rows[0 if scene in content["targets"]["cortex-m4f"] else 2 if "front" in scene else 1][scene] = frame
    return [row for row in rows if row]


def shares(frame: dict[str, Any], core: str) -> list[tuple[str, float]]:
    """Million instructions of each stage."""
    return [(stage, frame["stages"][core][stage] / 1e6) for stage in STAGE_COLOURS]


def draw(content: dict[str, Any], output: str) -> None:
    """Writes the chart as PNG (or whatever matplotlib makes of the name's ending). Raises EdgelineError."""
    draw_with_pyplot(lambda pyplot: _draw(pyplot, content), output)


def _draw(pyplot: Any, content: dict[str, Any]) -> Any:
    rows = panels_of(content)
    heights = [ROOM_INCHES + BAR_INCHES * len(row) for row in rows]
    figure, panels = pyplot.subplots(
        len(rows),
        len(CORE_TITLES),
        squeeze=False,
        figsize=(WIDTH_INCHES * len(CORE_TITLES), sum(heights) + 0.4),
        height_ratios=heights,
        layout="constrained",
    )
    for row, of_row in zip(panels, rows, strict=True):
        for panel, (core, title) in zip(row, CORE_TITLES.items(), strict=True):
            _draw_panel(panel, of_row, core, content)
            panel.set_title(title, fontsize=9)
        row[-1].set_yticklabels([])
    handles, titles = panels[0][0].get_legend_handles_labels()
    figure.legend(handles, titles, loc="outside upper center", ncols=len(titles), fontsize=8, frameon=False)
    return figure


def _draw_panel(panel: Any, frames: Frames, core: str, content: dict[str, Any]) -> None:
    for place, (scene, frame) in enumerate(frames.items()):
        left = 0.0
        for stage, millions in shares(frame, core):
            label = stage if place == 0 else None
            panel.barh(place, millions, left=left, height=0.7, color=STAGE_COLOURS[stage], label=label)
            left += millions
        end = left
        if scene in content["peers"].get(core, {}):
            peer = content["peers"][core][scene][0]
            end = max(left, peer)
            panel.plot(peer, place, "kD", markersize=4, linestyle="", label="best peer" if place == 0 else None)
        if scene in content["targets"].get(core, {}):
            wanted = content["targets"][core][scene]
            label = "to be reached" if place == 0 else None
            panel.plot(wanted, place, "k|", markersize=14, markeredgewidth=2, linestyle="", label=label)
        panel.annotate(f"  {left:.2f}", (end, place), va="center", fontsize=7)
    panel.set_yticks(range(len(frames)), list(frames), fontsize=8)
    panel.invert_yaxis()
    panel.margins(x=0.1)
    panel.set_xlim(left=0)
    panel.set_xlabel("million instructions per frame", fontsize=8)
    panel.tick_params(labelsize=8)
    panel.grid(True, axis="x", linewidth=0.3)
    panel.set_axisbelow(True)
