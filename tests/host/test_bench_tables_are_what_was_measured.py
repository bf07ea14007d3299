"""The tables of documents are made of the recorded figures, whole, and none is out of date."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import pytest

BENCH = Path(__file__).parents[1] / "bench"
sys.path.insert(0, str(BENCH))

from bench_tool import frames, machines, models, pico, tables  # noqa: E402


@pytest.fixture
def recorded() -> dict[str, Any]:
    content: dict[str, Any] = json.loads((BENCH / "results" / "scenes.json").read_text("utf-8"))
    return content


@pytest.fixture
def measured(recorded: dict[str, Any]) -> list[frames.Frame]:
    return [frames.Frame(**row) for row in recorded["frames"]]


def test_the_committed_tables_are_the_recorded_figures(recorded: dict[str, Any], measured: list[frames.Frame]) -> None:
    made = tables.document(measured, recorded["code"], recorded["command"])
    assert (BENCH / "results" / "scenes.md").read_text("utf-8") == made


@pytest.mark.parametrize("path", tables.DOCUMENTS, ids=lambda path: path.name)
def test_tables_in_documents_are_the_recorded_figures(
    path: Path, recorded: dict[str, Any], measured: list[frames.Frame]
) -> None:
    text = path.read_text("utf-8")
    assert tables.embed(text, measured, recorded["code"]) == text


@pytest.mark.parametrize("path", tables.DOCUMENTS, ids=lambda path: path.name)
def test_the_pico_s_table_is_the_recorded_one(path: Path) -> None:
    text = path.read_text("utf-8")
    assert pico.embed(text, json.loads(pico.RESULT.read_text("utf-8"))) == text


def test_a_frame_of_the_pico_is_hidden_when_it_takes_what_the_wire_takes() -> None:
    whole = {
        "scene": "solid",
        "course": "whole",
        "wire_cycles": 2457600,
        "idle_cycles": 0,
        "bands": 60,
        "late_bands": 5,
    }
    courses = [{**whole, "cycles": 2482000}, {**whole, "cycles": 2483000}]
    courses.append({**whole, "course": "still", "cycles": 25000, "wire_cycles": 0})
    lines = pico.table({"clock_hz": 125000000, "courses": courses}).splitlines()[2:]
    assert lines == [
        "| solid | whole | 2.48 M | 0.00 M | 2.46 M | 60, 5 | 50.4 | yes |",
        "| solid | whole | 2.48 M | 0.00 M | 2.46 M | 60, 5 | 50.3 | no |",
        "| solid | still | 0.025 M | 0.00 M | 0.00 M | 60, 5 | 5,000.0 |  |",
    ]


def test_what_stands_between_the_marks_is_replaced_and_nothing_else(
    recorded: dict[str, Any], measured: list[frames.Frame]
) -> None:
    text = "a\n<!-- bench: peers -->\nold\n\nold\n<!-- bench end -->\nb\n<!-- bench: code -->\n<!-- bench end -->\nc\n"
    found = tables.embed(text, measured, recorded["code"])
    assert found.startswith(f"a\n<!-- bench: peers -->\n{tables.against_peers(measured)}\n<!-- bench end -->\nb\n")
    assert found.endswith(f"{tables.code(recorded['code'])}\n<!-- bench end -->\nc\n") and "old" not in found
    assert tables.embed(found, measured, recorded["code"]) == found


def test_a_table_that_there_is_not_is_told(measured: list[frames.Frame]) -> None:
    with pytest.raises(machines.BenchError, match="asks for the table 'costs'; there are instructions, peers"):
        tables.embed("<!-- bench: costs -->\n<!-- bench end -->", measured, {})


def test_every_row_is_as_wide_as_its_head(recorded: dict[str, Any], measured: list[frames.Frame]) -> None:
    width = 0
    for line in tables.document(measured, recorded["code"], "x").splitlines():
        if line.startswith("|"):
            width = width or line.count("|")
            assert line.count("|") == width, line
        else:
            width = 0


def test_without_models_nothing_is_converted_and_a_build_server_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("EDGELINE_MODELS", str(tmp_path / "nowhere"))
    monkeypatch.delenv("CI", raising=False)
    assert models.convert(tmp_path / "models") is None and not (tmp_path / "models").exists()
    monkeypatch.setenv("CI", "true")
    with pytest.raises(machines.MissingToolError, match="shared/models is not beside the repository"):
        models.convert(tmp_path / "models")
