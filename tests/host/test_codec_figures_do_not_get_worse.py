"""The codec's bytes and instructions are held against what is recorded, and a change is told in one line."""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

BENCH = Path(__file__).parents[1] / "bench"
sys.path.insert(0, str(BENCH))

from bench_tool import codec, frames  # noqa: E402


@pytest.fixture
def recorded() -> dict[str, Any]:
    content: dict[str, Any] = json.loads((BENCH / "results" / "codec.json").read_text(encoding="utf-8"))
    return content


@pytest.fixture
def found(recorded: dict[str, Any]) -> list[codec.Found]:
    return [codec.Found(**row) for row in recorded["sequences"]]


def failures(
    found: list[codec.Found], recorded: dict[str, Any], capsys: pytest.CaptureFixture[str]
) -> tuple[int, list[str]]:
    """Checks made, and the lines of those that failed."""
    verdicts = frames.Verdicts()
    codec.compare_with_recorded(found, recorded, verdicts)
    return verdicts.passed + verdicts.failed, capsys.readouterr().out.splitlines()


def test_what_is_recorded_holds(
    found: list[codec.Found], recorded: dict[str, Any], capsys: pytest.CaptureFixture[str]
) -> None:
    assert failures(found, recorded, capsys) == (7 * 5, [])


def test_the_recorded_limits_hold(found: list[codec.Found]) -> None:
    for one in found:
        assert one.instructions["cortex-m0plus"] <= codec.MOST_INSTRUCTIONS.get(one.sequence, 100)
        assert all(getattr(one, key) <= one.first[key] for key in codec.BYTES)
        assert one.decoder_rate >= codec.LEAST_RATE


@pytest.mark.parametrize("key", codec.BYTES)
def test_more_bytes_are_told(
    key: str, found: list[codec.Found], recorded: dict[str, Any], capsys: pytest.CaptureFixture[str]
) -> None:
    one = found[4]
    found[4] = replace(one, **{key: round(getattr(one, key) * 1.031)})
    _, lines = failures(found, recorded, capsys)
    assert len(lines) == 1 and lines[0].startswith(f"FAIL codec, room on {key}, bytes per frame:"), lines


def test_more_instructions_are_told(
    found: list[codec.Found], recorded: dict[str, Any], capsys: pytest.CaptureFixture[str]
) -> None:
    one = found[2]
    cost = one.instructions["cortex-m0plus"]
    found[2] = replace(one, instructions={**one.instructions, "cortex-m0plus": cost * 1.031})
    _, lines = failures(found, recorded, capsys)
    assert len(lines) == 1 and "gouraud on cortex-m0plus, instructions per pixel" in lines[0], lines


def test_a_sequence_that_is_not_recorded_is_told(
    found: list[codec.Found], recorded: dict[str, Any], capsys: pytest.CaptureFixture[str]
) -> None:
    found[0] = replace(found[0], sequence="another")
    _, lines = failures(found, recorded, capsys)
    assert lines == ["FAIL codec, another is not recorded; run tests/bench/run --record-codec"]
