"""Every option of the firmware has its cost recorded, used and not used; none costs another's loops anything; and
documents quote what was recorded."""

from __future__ import annotations

import copy
import json
import re
import sys
from pathlib import Path
from typing import Any

import pytest

BENCH = Path(__file__).parents[1] / "bench"
sys.path.insert(0, str(BENCH))

from bench_tool import feature_tables, features, frames, machines, size, tables  # noqa: E402


@pytest.fixture
def recorded() -> dict[str, Any]:
    content: dict[str, Any] = json.loads((BENCH / "results" / "features.json").read_text("utf-8"))
    return content


def failures(found: dict[str, Any]) -> int:
    verdicts = frames.Verdicts()
    features.check(found["unused"], found["drawn"], verdicts)
    return verdicts.failed


def test_every_option_of_the_firmware_is_measured() -> None:
    text = (size.SOURCES / "base" / "options.h").read_text("utf-8")
    assert {option.name for option in features.OPTIONS} == set(
        re.findall(r"^#ifndef EL_WITH_(\w+)", text, re.MULTILINE)
    )


def test_the_record_is_complete(recorded: dict[str, Any]) -> None:
    names = [option.name for option in features.OPTIONS]
    assert list(recorded["options"]) == names and list(recorded["unused"]) == names
    assert list(recorded["modules"]) == list(features.MODULES)
    assert list(recorded["memory"]) == list(features.USED_MEMORY)
    for option in features.OPTIONS:
        for core in machines.MAIN_CORES:
            # A scene whose shading is left out cannot be drawn, and is used by that option.
            missing = set(features.SCENES) - set(recorded["unused"][option.name][core])
            assert missing <= set(option.used_by)
    uses = re.findall(r'^ +(?:\w+\()?\{?"([\w-]+)", ', (BENCH / "uses.c").read_text("utf-8"), re.MULTILINE)
    assert [use["name"] for use in recorded["uses"]] == uses and len(uses) > 20


def test_the_committed_table_is_the_recorded_figures(recorded: dict[str, Any]) -> None:
    made = feature_tables.document(recorded, recorded["command"])
    assert (BENCH / "results" / "features.md").read_text("utf-8") == made


@pytest.mark.parametrize("path", tables.DOCUMENTS, ids=lambda path: path.name)
def test_tables_in_documents_are_the_recorded_figures(path: Path, recorded: dict[str, Any]) -> None:
    text = path.read_text("utf-8")
    assert feature_tables.embed(text, recorded) == text


def test_what_a_document_asks_for_is_put_there(recorded: dict[str, Any]) -> None:
    text = "a\n<!-- features: memory -->\nold\n<!-- features end -->\n<!-- bench: code -->\nkept\n<!-- bench end -->\n"
    found = feature_tables.embed(text, recorded)
    assert feature_tables.memory(recorded) in found and "old" not in found and "kept" in found
    with pytest.raises(machines.BenchError, match="asks for the table 'costs'; there are bytes, gains"):
        feature_tables.embed("<!-- features: costs -->\n<!-- features end -->", recorded)


def test_no_option_costs_an_instruction_in_another_s_loops(recorded: dict[str, Any]) -> None:
    assert failures(recorded) == 0


@pytest.mark.parametrize("part", ["pixels", "rows"])
def test_an_instruction_in_another_s_loop_is_told(recorded: dict[str, Any], part: str) -> None:
    seeded = copy.deepcopy(recorded)
    seeded["unused"]["SAMPLES"]["cortex-m4f"]["S2"][part] += recorded["drawn"]["S2"][part]
    assert failures(seeded) == 1
    # What uses the option may pay for it.
    seeded = copy.deepcopy(recorded)
    seeded["unused"]["STATS"]["cortex-m4f"]["S2"][part] += recorded["drawn"]["S2"][part]
    assert failures(seeded) == 0
