"""A chart of time against error from the JSON of `edgeline-sim methods`.

`python -m edgeline.methods_plot IN.json OUT.png`. Needs matplotlib, the optional extra `plot`.
"""

from __future__ import annotations

import importlib
import io
import json
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from edgeline.convert.files import write_whole
from edgeline.errors import EdgelineError, PackageError

FAMILIES = ("triangles", "polygons")
FAULTS = ("cracks", "double_hits")


@dataclass(frozen=True)
class Point:
    """A method in the chart: its time, and its error when measured by its own rule and on closed fans."""

    title: str
    rule: str
    microseconds: float  # per shape, mean of all kinds
    wrong: float  # pixels per 1000 edge pixels
    fan_faults: float | None  # cracks and double hits per 1000 pixels of the fans; None for polygons


def points_of(tables: dict[str, Any], family: str) -> list[Point]:
    """The points of one of FAMILIES. Raises KeyError, TypeError or AttributeError when the tables are not such."""
    return [_point_of(method) for method in tables[family]]


def _point_of(method: dict[str, Any]) -> Point:
    scores: list[dict[str, float]] = list(method["kinds"].values())
    shapes = sum(score["shapes"] for score in scores)
    edges = sum(score["edge_pixels"] for score in scores)
    errors = sum(score["missing"] + score["extra"] for score in scores)
    nanoseconds = sum(score["ns_per_shape"] * score["shapes"] for score in scores)
    fans = method.get("fans")
    return Point(
        title=str(method["title"]),
        rule=str(method["rule"]),
        microseconds=nanoseconds / shapes / 1000,
        wrong=1000 * errors / edges,
        fan_faults=None if fans is None else 1000 * sum(fans[fault] for fault in FAULTS) / fans["inner"],
    )


def read_points(path: Path) -> dict[str, list[Point]]:
    """The points of both families. Raises EdgelineError for a file that cannot be read or holds something else."""
    try:
        tables = json.loads(path.read_text(encoding="utf-8"))
        return {family: points_of(tables, family) for family in FAMILIES}
    except OSError as error:
        raise EdgelineError(f"cannot read {path}: {error.strerror or error}") from error
    except (ValueError, KeyError, TypeError, AttributeError, ZeroDivisionError) as error:
        raise EdgelineError(f"{path} is not what `edgeline-sim methods --json` writes; make it anew") from error


def draw(points: dict[str, list[Point]]) -> bytes:
    """The chart as PNG. Raises PackageError without matplotlib."""
    try:
        figure_module = importlib.import_module("matplotlib.figure")
    except ModuleNotFoundError:
        raise PackageError("the chart needs", "matplotlib") from None
    figure = figure_module.Figure(figsize=(12, 9), layout="constrained")
    panels = figure.subplots(2, 2, width_ratios=(1, 1))
    for row, family in zip(panels, FAMILIES, strict=True):
        ordered = sorted(points[family], key=lambda point: -point.microseconds)
        labels = [f"{point.title} ({point.rule})" for point in ordered]
        times, errors = row
        times.barh(labels, [point.microseconds for point in ordered], color="#4c84b8")
        times.set_xscale("log")
        times.set_xlabel(f"µs per {family[:-1]}, mean of all kinds")
        errors.barh(labels, [point.wrong for point in ordered], color="#c8403c", label="wrong, per 1000 edge pixels")
        if family == "triangles":
            faults = [point.fan_faults or 0.0 for point in ordered]
            errors.barh(
                labels, faults, height=0.35, color="#e8a020", label="cracks and double hits in fans, per 1000 pixels"
            )
        errors.set_xscale("symlog", linthresh=0.1)
        errors.set_xlim(left=0)
        errors.tick_params(labelleft=False)
        errors.set_xlabel("error (nothing: exact)")
        errors.legend(loc="lower right", bbox_to_anchor=(1, 1), fontsize="small", frameon=False)
    figure.suptitle("Methods of the textbooks: time and error (edgeline-sim methods)")
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=100)
    return buffer.getvalue()


def main(arguments: Sequence[str] | None = None) -> int:
    """Returns the exit code: 0, or 2 after one line on standard error."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    if len(words) != 2 or words[0].startswith("-"):
        print("usage: python -m edgeline.methods_plot IN.json OUT.png", file=sys.stderr)
        return 2
    try:
        write_whole(Path(words[1]), draw(read_points(Path(words[0]))))
    except EdgelineError as error:
        print(f"edgeline: {error}", file=sys.stderr)
        return error.exit_code
    return 0


if __name__ == "__main__":
    sys.exit(main())
