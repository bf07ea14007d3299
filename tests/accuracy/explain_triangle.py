"""What is wrong about one triangle: the first wrong pixel, and a picture of what is around it.

    EDGELINE_SIM=build/sim/edgeline-sim python tests/accuracy/explain_triangle.py 320x240 X,Y X,Y X,Y

Coordinates in 1/16 px. The simulator's `coverage` says only how many pixels it drew and their CRC, so the place is
found by drawing the same triangle on ever wider and higher targets: the first that differs has the pixel in its corner.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path

import numpy as np

import reference_coverage
from sim_commands import Ints, Simulator


def differs(simulator: Simulator, triangle: Ints, width: int, height: int) -> bool:
    """Whether simulator and reference disagree on this target."""
    got = simulator.coverage(triangle[np.newaxis], width, height)
    expected = reference_coverage.coverage(triangle[np.newaxis], width, height)
    return bool(got[0][0] != expected[0][0] or got[1][0] != expected[1][0])


def first_wrong_pixel(simulator: Simulator, triangle: Ints, width: int, height: int) -> tuple[int, int] | None:
    """The first wrong pixel in reading order; None where smaller targets are drawn right."""
    for rows in range(1, height + 1):
        if differs(simulator, triangle, width, rows):
            for columns in range(1, width + 1):
                if differs(simulator, triangle, columns, rows):
                    return columns - 1, rows - 1
            return None
    return None


def picture(triangle: Ints, width: int, height: int, around: tuple[int, int]) -> str:
    """The reference's pixels around one of them, `#` covered and `.` not; X and x the same at the pixel itself."""
    mask = reference_coverage.mask(triangle, width, height)
    x, y = around
    left, top = max(x - 30, 0), max(y - 8, 0)
    lines = []
    for j in range(top, min(top + 17, height)):
        symbols = [".x#X"[2 * int(mask[j, i]) + int((i, j) == (x, y))] for i in range(left, min(left + 61, width))]
        lines.append(f"{j:5d} {''.join(symbols)}")
    return f"      from column {left}\n" + "\n".join(lines)


def explain(simulator: Simulator, triangle: Ints, width: int, height: int) -> str:
    """Several lines for a failed test, or that the triangle is drawn right."""
    corners = " ".join(f"{x},{y}" for x, y in triangle)
    got = simulator.coverage(triangle[np.newaxis], width, height)
    expected = reference_coverage.coverage(triangle[np.newaxis], width, height)
    lines = [
        f"triangle {corners} (1/16 px) on {width}x{height}",
        f"expected {expected[0][0]} pixels, CRC {expected[1][0]:08x}; got {got[0][0]} pixels, CRC {got[1][0]:08x}",
    ]
    if not differs(simulator, triangle, width, height):
        return "\n".join([*lines, "drawn right"])
    wrong = first_wrong_pixel(simulator, triangle, width, height)
    if wrong is None:
        lines.append("smaller targets are drawn right, so that the wrong pixel cannot be told")
    else:
        x, y = wrong
        before = reference_coverage.mask(triangle, x + 1, y + 1)
        drawn = int(simulator.coverage(triangle[np.newaxis], x + 1, y + 1)[0][0])
        hits = drawn - int(before.sum()) + int(before[y, x])
        lines.append(f"first wrong pixel ({x}, {y}): expected {int(before[y, x])} times, got {hits} times")
        lines.append(picture(triangle, width, height, wrong))
    lines.append(f"again: python tests/accuracy/explain_triangle.py {width}x{height} {corners}")
    return "\n".join(lines)


def main(arguments: list[str]) -> int:
    """Exit status 0 when drawn right, 1 when wrong, 2 when it cannot be told."""
    try:
        size, *corners = arguments
        width, height = (int(number) for number in size.split("x"))
        triangle = np.array([[int(number) for number in corner.split(",")] for corner in corners], np.int64)
        simulator = Simulator(Path(os.environ["EDGELINE_SIM"]).resolve())
        reference_coverage.check_domain(triangle[np.newaxis], width, height)
    except (ValueError, KeyError, AssertionError):
        print("usage: EDGELINE_SIM=path explain_triangle.py WIDTHxHEIGHT X,Y X,Y X,Y (1/16 px)", file=sys.stderr)
        return 2
    print(explain(simulator, triangle, width, height))
    return int(differs(simulator, triangle, width, height))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
