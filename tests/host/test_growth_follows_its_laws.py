"""What tests/bench/run --growth recorded follows its laws; a frame or a slope that gets dearer is told in one line."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

BENCH = Path(__file__).parents[1] / "bench"
sys.path.insert(0, str(BENCH))

from bench_tool import frames, growth  # noqa: E402

M0, M4 = growth.MAIN_CORES


@pytest.fixture
def recorded() -> dict[str, Any]:
    content: dict[str, Any] = json.loads((BENCH / "results" / "growth.json").read_text(encoding="utf-8"))
    return content


@pytest.fixture
def rows(recorded: dict[str, Any]) -> list[growth.Row]:
    return [growth.Row(**row) for row in recorded["rows"]]


def law_of(series: str, variant: str) -> growth.Law:
    return next(law for law in growth.LAWS if (law.series, law.variant) == (series, variant))


def dearer(row: growth.Row, extra: Callable[[growth.Row], float], core: str = M0) -> growth.Row:
    return replace(row, instructions={**row.instructions, core: row.instructions[core] + round(extra(row))})


def failures(
    rows: list[growth.Row], recorded: dict[str, Any], capsys: pytest.CaptureFixture[str]
) -> tuple[int, list[str]]:
    """Checks made, and the lines of those that failed."""
    verdicts = frames.Verdicts()
    growth.compare_pictures(rows, verdicts)
    growth.check(rows, verdicts)
    growth.compare_with_recorded(rows, recorded, verdicts)
    return verdicts.passed + verdicts.failed, capsys.readouterr().out.splitlines()


def test_what_is_recorded_holds(
    rows: list[growth.Row], recorded: dict[str, Any], capsys: pytest.CaptureFixture[str]
) -> None:
    assert failures(rows, recorded, capsys) == (len(rows) * 3 + len(growth.LAWS) * 2 * 3, [])
    now = growth.content(rows)
    assert now["rows"] == recorded["rows"]
    for law, was in zip(now["laws"], recorded["laws"], strict=True):
        for core in growth.MAIN_CORES:
            # Solvers of linear equations differ in the last bits.
            costs, worst = (law["measured"][core].pop(key) for key in ("costs", "worst"))
            rms = law["measured"][core].pop("rms")
            before = was["measured"].pop(core)
            assert costs == pytest.approx(before["costs"], rel=1e-3, abs=0.02)
            assert (rms, worst) == pytest.approx((before["rms"], before["worst"]), abs=2e-5)
            assert law["measured"].pop(core) == {}
        assert law == was


def test_each_frame_has_a_law(rows: list[growth.Row]) -> None:
    assert sum(len(growth.rows_of(law, rows)) for law in growth.LAWS) == len(rows)
    assert all(len(growth.rows_of(law, rows)) > 2 * len(law.terms) for law in growth.LAWS)


def test_the_ranges_are_those_that_were_asked_for(rows: list[growth.Row]) -> None:
    def ends(series: str, of: Callable[[growth.Row], float]) -> tuple[float, float]:
        values = [of(row) for row in rows if row.series == series]
        return min(values), max(values)

    assert ends("triangles", lambda row: row.triangles / row.passes) == (100, 50_000)
    assert ends("pixels", lambda row: row.pixels) == (91, 320 * 240)
    assert ends("layers", lambda row: row.pixels / (320 * 240)) == (1, 16)
    assert ends("outside", lambda row: 1 - growth.SPHERES_SEEN / row.x) == (0, 0.99)
    assert ends("bands", lambda row: row.band_lines) == (1, 240)
    assert ends("triangles", lambda row: row.passes)[1] > 1


def test_a_known_law_is_found_again(rows: list[growth.Row]) -> None:
    law = law_of("outside", "one-mesh")
    made = [
        replace(row, instructions={M0: 1_000_000 + 37 * 100 * (row.x - growth.SPHERES_SEEN), M4: 1})
        for row in growth.rows_of(law, rows)
    ]
    found = growth.fit(law, made, M0)
    costs = {"frame": 1_000_000, "triangle outside": 37, "the same through the cache": 0}
    assert found.costs == pytest.approx(costs, abs=1e-6)
    assert found.worst < 1e-9
    assert growth.predicted(law, made, found) == pytest.approx([row.instructions[M0] for row in made])


def test_what_is_outside_may_not_get_dearer(
    rows: list[growth.Row], recorded: dict[str, Any], capsys: pytest.CaptureFixture[str]
) -> None:
    """As if each triangle outside cost 4 % more: frames that are nearly all outside tell it, and so does the slope."""
    law = law_of("outside", "one-mesh")
    costs = growth.fit(law, growth.rows_of(law, rows), M0).costs
    slope = 0.04 * (costs["triangle outside"] + costs["the same through the cache"])
    worse = [
        dearer(row, lambda one: slope * 100 * (one.x - growth.SPHERES_SEEN)) if row.variant == "one-mesh" else row
        for row in rows
    ]
    _, lines = failures(worse, recorded, capsys)
    assert any(
        line.startswith(f"FAIL growth: outside one-mesh 500 (arena 130 KB, bands of 8) on {M0}:") for line in lines
    )
    assert any("instructions per triangle outside, recorded are" in line for line in lines)
    assert all("one-mesh" in line for line in lines)


def test_hidden_layers_may_not_be_drawn(
    rows: list[growth.Row], recorded: dict[str, Any], capsys: pytest.CaptureFixture[str]
) -> None:
    """As if the layers behind were drawn before the one in front of them."""
    drawn = {row.x: row.instructions for row in rows if row.variant == "textured-back-to-front"}
    worse = [
        replace(row, instructions=drawn[row.x]) if row.variant == "textured-front-to-back" else row for row in rows
    ]
    _, lines = failures(worse, recorded, capsys)
    for core in growth.MAIN_CORES:
        assert any(f"on {core}" in line and "instructions per layer behind, recorded are" in line for line in lines)


def test_a_slope_beyond_its_bound_is_told(rows: list[growth.Row], capsys: pytest.CaptureFixture[str]) -> None:
    """Whatever is recorded: here the frustum test is made for each triangle of a mesh."""
    worse = [dearer(row, lambda one: 100_000 * one.x) if row.variant == "many-meshes" else row for row in rows]
    _, lines = failures(worse, growth.content(worse), capsys)
    assert len(lines) == 1 and "instructions per mesh outside, more than" in lines[0], lines


def test_a_frame_off_its_law_is_told(rows: list[growth.Row], capsys: pytest.CaptureFixture[str]) -> None:
    worse = [
        dearer(row, lambda one: 0.5 * one.instructions[M0]) if (row.series, row.x) == ("bands", 16) else row
        for row in rows
    ]
    _, lines = failures(worse, growth.content(worse), capsys)
    assert [line for line in lines if "off the law" in line] == [line for line in lines if "bands" in line] != []


@pytest.mark.parametrize("series", ["triangles", "layers", "outside", "bands", "arenas"])
def test_another_picture_is_told(
    series: str, rows: list[growth.Row], recorded: dict[str, Any], capsys: pytest.CaptureFixture[str]
) -> None:
    last = max(index for index, row in enumerate(rows) if row.series == series)
    rows[last] = replace(rows[last], crc="00000000")
    _, lines = failures(rows, recorded, capsys)
    assert len(lines) == 1 and lines[0].startswith(f"FAIL growth: {series}") and "00000000" in lines[0], lines


def test_a_frame_that_is_not_recorded_is_told(
    rows: list[growth.Row], recorded: dict[str, Any], capsys: pytest.CaptureFixture[str]
) -> None:
    recorded["rows"] = recorded["rows"][:-1]
    _, lines = failures(rows, recorded, capsys)
    assert any("is not recorded" in line for line in lines)
