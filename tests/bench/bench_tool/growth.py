"""How cost grows: frames of which one thing grows, the law that their instructions are expected to follow, the law that
they do follow, and the checks that it stays so.

A law is a sum of terms, each a number of events times what one of them costs. What the events cost is found by least
squares of the relative error over all frames of the law, so that a frame of 100 triangles counts as much as one of
50,000. A law that is no good shows by how far it is off at worst; `why` says what it leaves out.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .frames import Verdicts
from .machines import CORES, MAIN_CORES, BenchError, Line, Machines

# What an event costs may be that much above what was recorded before somebody must look and record anew.
TOLERANCE = 0.03

SCREEN_PIXELS = 320 * 240
SPHERES_SEEN = 5
SPHERE_TRIANGLES = 100


@dataclass(frozen=True)
class Row:
    """One frame: of `series`, as the program calls it, `x` of what grows."""

    series: str
    variant: str
    x: int
    arena_bytes: int
    band_lines: int
    crc: str
    passes: int
    vertices: int  # transformed, in all passes; so are the next
    triangles: int
    setups: int
    rows: int
    pixels: int
    bands: int
    instructions: dict[str, int]

    @property
    def title(self) -> str:
        arena = f"arena {self.arena_bytes / 1024:.0f} KB"
        return f"{self.series} {self.variant} {self.x} ({arena}, bands of {self.band_lines})"


@dataclass(frozen=True)
class Term:
    """What is paid for, and how often in a frame; `from_least`: how much more often than in the law's frame that has
    the least of it."""

    title: str
    count: Callable[[Row], float]
    from_least: bool = False


@dataclass(frozen=True)
class Law:
    """The law of a series' variant. The second of its terms is its slope, which is held against `most` on each of
    MAIN_CORES, and against what was recorded."""

    series: str
    variant: str
    expected: str
    terms: tuple[Term, ...]
    worst: float  # relative; a frame that is farther off breaks the law
    most: tuple[float, float]  # instructions per event of the slope
    why: str  # where the measured law is another than the expected one

    @property
    def title(self) -> str:
        return f"{self.series} {self.variant}"


@dataclass(frozen=True)
class Fit:
    """The measured law on a core: instructions per event of each term, and how far frames are off, relatively."""

    costs: dict[str, float]
    rms: float
    worst: float


FRAME = Term("frame", lambda row: 1)
TRIANGLE = Term("triangle", lambda row: row.triangles / row.passes)
PIXEL = Term("pixel", lambda row: row.pixels)
LINE = Term("row of a triangle", lambda row: row.rows)
LAYER_PIXEL = Term("pixel and layer", lambda row: row.x * SCREEN_PIXELS)
LAYER_BEHIND = Term("layer behind", lambda row: row.x - 1)
MESH_OUTSIDE = Term("mesh outside", lambda row: row.x - SPHERES_SEEN)
TRIANGLE_OUTSIDE = Term("triangle outside", lambda row: (row.x - SPHERES_SEEN) * SPHERE_TRIANGLES)
# A mesh of that many spheres has more vertices than a quarter of the free list has room for.
CACHED_SPHERES = 100
CACHED_OUTSIDE = Term(
    "the same through the cache",
    lambda row: (row.x - SPHERES_SEEN) * SPHERE_TRIANGLES if row.x >= CACHED_SPHERES else 0,
)
BAND = Term("band", lambda row: row.bands)
# What a small arena does again: vertices, in a further pass or because another took their place.
TRIANGLE_AGAIN = Term("triangle in a further pass", lambda row: row.triangles * (1 - 1 / row.passes))
VERTEX_AGAIN = Term("vertex transformed again", lambda row: row.vertices, from_least=True)
SPHERE_VERTEX_AGAIN = Term("vertex transformed again", lambda row: row.vertices - row.triangles / row.passes / 2 - 2)
# In the least arena no two triangles' vertices have room together, so each is transformed by itself.
LEAST_ARENA_BYTES = 16136
LONE_VERTEX = Term("vertex by itself", lambda row: row.vertices if row.arena_bytes <= LEAST_ARENA_BYTES else 0)
# Where every triangle has its own vertices: what is not kept whole costs more to draw, beside its vertices.
SHORT_RECORD = Term(
    "triangle of a short record", lambda row: row.setups if row.vertices > 3 * row.triangles / row.passes else 0
)
# Edges of more than 32 rows take a longer way, whose set-up is another.
LONG_TRIANGLE = Term("tall triangle", lambda row: row.setups if row.rows > 32 * row.setups else 0)
SETUP_AGAIN = Term("set-up made again", lambda row: row.setups, from_least=True)

BEHIND = "flat, but for a test per triangle and band: what is behind a full band is not set up"
NEAREST = (
    "A triangle is held against a band by its nearest corner. The layers are turned, so the first few behind the "
    "foremost are nearer with a corner than that is in places, and are drawn there, pixel by pixel rejected."
)
VISIT = (
    "Each triangle costs something in every band that it reaches, before its rows: its spans are made for all of the "
    "band, and what is linear is loaded and stored, which pays from two or three rows on."
)
SHORT_WAY = "Triangles of at most 64 x 32 px have a shorter way than others."

LAWS = (
    Law(
        "triangles",
        "sphere",
        "linear in triangles; a small arena adds what it does again",
        (FRAME, TRIANGLE, TRIANGLE_AGAIN, SPHERE_VERTEX_AGAIN, LINE),
        worst=0.15,
        most=(1000, 500),
        why="The list holds whole triangles until it is full, then 8 bytes of each, whose set-up costs more: what lies "
        "between counts as whole here.",
    ),
    *(
        Law(
            "pixels", variant, "linear in pixels, and in rows, which go with their square root", terms, worst, most, why
        )
        for variant, terms, worst, most, why in (
            ("flat", (FRAME, PIXEL, LINE, LONG_TRIANGLE), 0.07, (16.0, 14.0), SHORT_WAY),
            ("Gouraud", (FRAME, PIXEL, LINE, LONG_TRIANGLE), 0.07, (35.0, 23.0), SHORT_WAY),
            (
                "textured",
                (FRAME, PIXEL, LINE),
                0.24,
                (110.0, 50.0),
                "Spans are cut into pieces as short as the bound of their error needs, so there are more of them, and "
                "dearer pixels, where the board is far and the texture small. Long spans of empty pixels are cheaper.",
            ),
        )
    ),
    *(
        Law("layers", variant, expected, terms, 0.03, most, NEAREST if expected is BEHIND else "")
        for variant, expected, terms, most in (
            ("flat-back-to-front", "linear: every layer is drawn", (FRAME, LAYER_PIXEL), (17.0, 14.0)),
            ("flat-front-to-back", BEHIND, (FRAME, LAYER_BEHIND, PIXEL), (150000.0, 90000.0)),
            ("textured-back-to-front", "linear: every layer is drawn", (FRAME, LAYER_PIXEL), (110.0, 50.0)),
            ("textured-front-to-back", BEHIND, (FRAME, LAYER_BEHIND, PIXEL), (180000.0, 115000.0)),
        )
    ),
    Law(
        "outside",
        "many-meshes",
        "flat: one test per mesh, however many triangles it has",
        (FRAME, MESH_OUTSIDE),
        0.03,
        (1100.0, 800.0),
        "",
    ),
    Law(
        "outside",
        "mesh-behind",
        "flat: one test for all of it",
        (FRAME, TRIANGLE_OUTSIDE),
        0.03,
        (0.2, 0.1),
        "",
    ),
    Law(
        "outside",
        "one-mesh",
        "linear with a small slope: each vertex is looked at",
        (FRAME, TRIANGLE_OUTSIDE, CACHED_OUTSIDE),
        0.03,
        (130.0, 65.0),
        "A knee: where a mesh's vertices do not fit a quarter of the free list, they go through a cache.",
    ),
    *(
        Law("bands", scene, "linear in the number of bands", (FRAME, BAND), 0.08, most, VISIT + why)
        for scene, most, why in (
            ("S1", (5500.0, 3500.0), ""),
            ("S2", (4000.0, 2000.0), ""),
            (
                "S3",
                (25000.0, 17000.0),
                " What begins in a band and what is carried into it is merged. The depth band of 240 lines has room "
                "for all vertices, which go through a cache otherwise.",
            ),
        )
    ),
    *(
        Law(
            "arenas",
            scene,
            "flat where all fits; below, what is done again",
            (FRAME, VERTEX_AGAIN, *more),
            0.15,
            (800.0, 300.0),
            why,
        )
        for scene, more, why in (
            ("S1", (TRIANGLE_AGAIN, SETUP_AGAIN), ""),
            (
                "S3",
                (SHORT_RECORD, SETUP_AGAIN, LONE_VERTEX),
                "From 48 to 112 KB all fits as 8 bytes per triangle, in one pass, but vertices are transformed twice.",
            ),
        )
    ),
)

# Frames that show the same, whatever their arena, their bands, the order of layers and what is outside.
SAME_PICTURE: dict[str, Callable[[Row], tuple[object, ...]]] = {
    "triangles": lambda row: (row.x,),
    "pixels": lambda row: (row.variant, row.x),
    "layers": lambda row: (row.variant.split("-")[0],),
    "outside": lambda row: (row.variant,),
    "bands": lambda row: (row.variant, "a scene"),
    "arenas": lambda row: (row.variant, "a scene"),
}


def measure(machines: Machines, verdicts: Verdicts) -> list[Row]:
    """All frames on the main cores. Each core's picture must be the native build's, and frames that show the same thing
    in another way must be the same picture."""
    native = [line for line in machines.native("growth") if line.words[0] != "empty"]
    counts: dict[str, list[int]] = {}
    for core in MAIN_CORES:
        found = machines.target(core, "growth")
        if [one.line.words for one in found] != [line.words for line in native]:
            raise BenchError(f"growth: {core} drew other frames than this computer")
        counts[core] = [one.instructions for one in found]
        for here, there in zip(native, found, strict=True):
            verdicts.check(
                there.line.crc == here.crc,
                f"growth: {core} draws {' '.join(here.words)} as {there.line.crc}, this computer as {here.crc}",
            )
        # Counters depend on what fits an arena, and so on the size of a pointer.
        native = [one.line for one in found]
    rows = [_row(line, {core: counts[core][index] for core in MAIN_CORES}) for index, line in enumerate(native)]
    compare_pictures(rows, verdicts)
    return rows


def _row(line: Line, instructions: dict[str, int]) -> Row:
    series, variant, x, arena_bytes, band_lines = line.words
    counters = {name: int(value) for name, value in line.values.items() if name != "crc"}
    return Row(
        series=series,
        variant=variant,
        x=int(x),
        arena_bytes=int(arena_bytes),
        band_lines=int(band_lines),
        crc=line.crc,
        instructions=instructions,
        **counters,
    )


def compare_pictures(rows: Iterable[Row], verdicts: Verdicts) -> None:
    first: dict[object, Row] = {}
    for row in rows:
        shown = first.setdefault(SAME_PICTURE[row.series](row), row)
        verdicts.check(row.crc == shown.crc, f"growth: {row.title} is {row.crc}, {shown.title} {shown.crc}")


def rows_of(law: Law, rows: Iterable[Row]) -> list[Row]:
    return [row for row in rows if (row.series, row.variant) == (law.series, law.variant)]


def _events(law: Law, rows: Sequence[Row]) -> NDArray[np.float64]:
    """A row per frame, a column per term."""
    events = np.array([[term.count(row) for term in law.terms] for row in rows], dtype=np.float64)
    for column, term in enumerate(law.terms):
        if term.from_least:
            events[:, column] -= events[:, column].min()
    return events


def fit(law: Law, rows: Sequence[Row], core: str) -> Fit:
    """Least squares of the relative error; `rows` are all of the law's own."""
    events = _events(law, rows)
    measured = np.array([row.instructions[core] for row in rows], dtype=np.float64)
    costs = np.linalg.lstsq(events / measured[:, None], np.ones(len(rows)), rcond=None)[0]
    off = events @ costs / measured - 1
    return Fit(
        costs={term.title: float(cost) for term, cost in zip(law.terms, costs, strict=True)},
        rms=float(np.sqrt(np.mean(off**2))),
        worst=float(np.max(np.abs(off))),
    )


def predicted(law: Law, rows: Sequence[Row], found: Fit) -> list[float]:
    """Instructions of all of the law's frames by the law."""
    return [float(cost) for cost in _events(law, rows) @ np.array(list(found.costs.values()))]


def check(rows: Sequence[Row], verdicts: Verdicts) -> None:
    """Each law holds: no frame is off by more than it allows, no slope is steeper."""
    for law in LAWS:
        slope = law.terms[1].title
        for core, most in zip(MAIN_CORES, law.most, strict=True):
            found = fit(law, rows_of(law, rows), core)
            where = f"growth: {law.title} on {core}"
            verdicts.check(
                found.worst <= law.worst,
                f"{where}: a frame is {found.worst:.1%} off the law ({law.worst:.0%} may be)",
            )
            verdicts.check(
                found.costs[slope] <= most,
                f"{where}: {found.costs[slope]:.1f} instructions per {slope}, more than {most:g}",
            )


def compare_with_recorded(rows: Sequence[Row], recorded: dict[str, Any], verdicts: Verdicts) -> None:
    """No frame and no slope costs more than TOLERANCE above what was recorded."""
    before = [Row(**row) for row in recorded["rows"]]
    known = {row.title: row for row in before}
    advice = "if it is meant, run tests/bench/run --record-growth and commit tests/bench/results"
    for row in rows:
        was = known.get(row.title)
        if was is None:
            verdicts.check(False, f"growth: {row.title} is not recorded; run tests/bench/run --record-growth")
            continue
        for core, count in row.instructions.items():
            change = count / was.instructions[core] - 1
            verdicts.check(
                change <= TOLERANCE,
                f"growth: {row.title} on {core}: {count / 1e6:.3f} M instructions, recorded are "
                f"{was.instructions[core] / 1e6:.3f} M ({change:+.1%}); {advice}",
            )
    for law in LAWS:
        slope = law.terms[1].title
        for core in MAIN_CORES:
            now = fit(law, rows_of(law, rows), core).costs[slope]
            then = fit(law, rows_of(law, before), core).costs[slope]
            verdicts.check(
                now <= then * (1 + TOLERANCE),
                f"growth: {law.title} on {core}: {now:.1f} instructions per {slope}, recorded are {then:.1f}; {advice}",
            )


def content(rows: Sequence[Row]) -> dict[str, Any]:
    """What the JSON has: the laws, and all frames."""
    laws = [
        {
            "series": law.series,
            "variant": law.variant,
            "expected": law.expected,
            "why": law.why,
            "measured": {core: _rounded(fit(law, rows_of(law, rows), core)) for core in MAIN_CORES},
        }
        for law in LAWS
    ]
    return {"laws": laws, "rows": [asdict(row) for row in rows]}


def _rounded(found: Fit) -> dict[str, Any]:
    costs = {title: round(cost, 2) for title, cost in found.costs.items()}
    return {"costs": costs, "rms": round(found.rms, 5), "worst": round(found.worst, 5)}


def table(rows: Sequence[Row]) -> str:
    """A Markdown table of the laws: instructions per event, and how far the farthest frame is off."""
    lines = [
        f"| | expected | {' | '.join(f'{CORES[core].title} | off by' for core in MAIN_CORES)} |",
        "|---|---|" + "---|---|" * len(MAIN_CORES),
    ]
    for law in LAWS:
        cells = [law.title, law.expected]
        for core in MAIN_CORES:
            found = fit(law, rows_of(law, rows), core)
            cells.append("; ".join(f"{_number(cost)} per {title}" for title, cost in found.costs.items()))
            cells.append(f"{found.rms:.1%}, {found.worst:.1%} at most")
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def _number(cost: float) -> str:
    return f"{cost:,.1f}" if abs(cost) < 100 else f"{cost:,.0f}"
