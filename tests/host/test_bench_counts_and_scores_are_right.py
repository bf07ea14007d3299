"""What stands between QEMU and the committed figures: the count log, the exact references, the front, the recorded."""

from __future__ import annotations

import csv
import io
import json
import sys
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest

BENCH = Path(__file__).parents[1] / "bench"
sys.path.insert(0, str(BENCH))

from bench_tool import compare, frames, machines, score  # noqa: E402
from bench_tool.choices import GROUPS  # noqa: E402

LOG = """next 100
start 103
stop 106
next 200
start 203
stop 1206
start 5000
stop 5013
next 6000
start 6003
stop 6010
"""


def lines(*names: str) -> list[machines.Line]:
    return [machines.Line((name,), {"crc": "00000000"}) for name in names]


def test_stretches_are_summed_and_lose_what_the_markers_cost() -> None:
    found = machines.pair(lines("empty", "two", "one"), LOG, "a core")
    assert [(one.line.words[0], one.instructions) for one in found] == [("two", 1003 + 13 - 6), ("one", 7 - 3)]


def test_a_line_too_few_is_no_measurement() -> None:
    with pytest.raises(machines.BenchError, match="a core: 2 lines printed, 3 measurements counted"):
        machines.pair(lines("empty", "two"), LOG, "a core")


def test_a_stop_without_start_is_no_measurement() -> None:
    with pytest.raises(machines.BenchError, match="'stop 9' before a start"):
        machines.count_stretches("next 1\nstop 9\n")


def test_output_is_words_and_values() -> None:
    (line,) = machines.parse_lines("S1 32768 3 0 crc b9f576c1 passes 1 ns 12\n")
    assert line.words == ("S1", "32768", "3", "0")
    assert line.values == {"crc": "b9f576c1", "passes": "1", "ns": "12"}
    with pytest.raises(machines.BenchError, match="hard fault"):
        machines.parse_lines("hard fault\n")


def covered(x: list[int], y: list[int], bits: int) -> set[tuple[int, int]]:
    """By rational barycentric weights; on an edge, by whether a step to the right, else a smaller one down, goes in."""
    area = Fraction((x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]))
    found = set()
    if area == 0:
        return found
    for row in range(min(y) >> bits, (max(y) >> bits) + 1):
        for column in range(min(x) >> bits, (max(x) >> bits) + 1):
            px, py = (Fraction((2 * v + 1) << bits, 2) for v in (column, row))
            inside = True
            for k in range(3):
                a, b = (k + 1) % 3, (k + 2) % 3
                weight = ((x[b] - x[a]) * (py - y[a]) - (y[b] - y[a]) * (px - x[a])) / area
                right, down = Fraction(-(y[b] - y[a])) / area, Fraction(x[b] - x[a]) / area
                inside &= weight > 0 or (weight == 0 and (right > 0 or (right == 0 and down > 0)))
            if inside:
                found.add((column, row))
    return found


@pytest.mark.parametrize("bits", [4, 6, 8, 12])
def test_the_reference_covers_what_rational_arithmetic_covers(bits: int) -> None:
    rng = np.random.default_rng(bits)
    for number in range(60):
        # Every other triangle has its corners on pixel centres, where the fill rule decides.
        places = rng.integers(0, 12, (2, 3)) * (1 << bits) + (1 << (bits - 1))
        if number % 2:
            places = rng.integers(0, 12 << bits, (2, 3))
        samples = score.cover(places[0], places[1], bits, number, 0)
        found = {(int(p) % score.WIDTH, int(p) // score.WIDTH) for p in samples.place}
        assert found == covered(places[0].tolist(), places[1].tolist(), bits)
        assert len(found) == len(samples.place)


def test_weights_belong_to_their_corners() -> None:
    for order in ([0, 1, 2], [0, 2, 1], [2, 1, 0]):
        x, y = np.array([0, 160, 0])[order], np.array([0, 0, 160])[order]
        samples = score.cover(x, y, 4, 0, 0)
        at_middle = samples.weights[samples.place == 2 * score.WIDTH + 5][0]
        # x = 5.5 px of 10, y = 2.5 of 10: what a plane through x has there.
        assert (at_middle * x).sum() / at_middle.sum() == 88
        assert (at_middle * y).sum() / at_middle.sum() == 40


def test_the_front_keeps_what_is_best_in_something() -> None:
    def row(cost: float, error: float) -> compare.Choice:
        return {"instructions": {"core": cost}, "errors": {"e": error}}

    rows = [row(1, 9), row(2, 9), row(3, 0), row(4, 0), row(3, 0)]
    assert [compare.on_front(one, rows, "core", "e") for one in rows] == [True, False, True, False, True]


def recorded() -> dict[str, Any]:
    loaded: dict[str, Any] = json.loads((BENCH / "results" / "scenes.json").read_text("utf-8"))
    return loaded


def compared(frame: frames.Frame, capsys: pytest.CaptureFixture[str]) -> tuple[frames.Verdicts, list[str]]:
    """What is said of one frame against what is recorded of it."""
    content = {"frames": [row for row in recorded()["frames"] if frames.Frame(**row).key == frame.key]}
    verdicts = frames.Verdicts()
    frames.compare_with_recorded([frame], content, verdicts)
    return verdicts, capsys.readouterr().out.splitlines()


def first_frame() -> frames.Frame:
    return frames.Frame(**recorded()["frames"][0])


@pytest.mark.parametrize(("factor", "word"), [(1.0, ""), (1.029, ""), (0.971, ""), (1.031, "FAIL"), (0.969, "better")])
def test_counts_may_be_three_percent_worse(factor: float, word: str, capsys: pytest.CaptureFixture[str]) -> None:
    frame = first_frame()
    was = frame.instructions["cortex-m4f"]
    now = round(was * factor)
    verdicts, said = compared(replace(frame, instructions={**frame.instructions, "cortex-m4f": now}), capsys)
    assert (verdicts.failed, verdicts.better) == (int(word == "FAIL"), int(word == "better"))
    assert len(said) == int(word != "")
    assert all(line.startswith(f"{word} {frame.title} on cortex-m4f") for line in said)
    assert all(f"{now:,}, recorded are {was:,}" in line for line in said)


def test_more_ram_more_passes_and_another_picture_fail(capsys: pytest.CaptureFixture[str]) -> None:
    frame = first_frame()
    for worse, words in (
        (replace(frame, ram={**frame.ram, "list": frame.ram["list"] + frame.memory_peak // 32}), "bytes of RAM"),
        (replace(frame, ram={**frame.ram, "states": frame.memory_peak}), "bytes of RAM"),
        (replace(frame, passes=frame.passes + 1), "passes: 2, recorded are 1"),
        (replace(frame, crc="00000000"), "is 00000000, recorded is"),
    ):
        verdicts, said = compared(worse, capsys)
        assert verdicts.failed == len(said) == 1 and words in said[0]


def test_a_stage_that_grew_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    frame = first_frame()
    count = frame.instructions["rv32imc"]
    slower = {**frame.stages["rv32imc"], "rows": frame.stages["rv32imc"]["rows"] + count}
    worse = replace(
        frame,
        instructions={**frame.instructions, "rv32imc": 2 * count},
        stages={**frame.stages, "rv32imc": slower},
    )
    _, said = compared(worse, capsys)
    assert len(said) == 1 and f"(rows +{count / 1e6:.3f} M)" in said[0]


def test_a_frame_that_nobody_recorded_fails() -> None:
    verdicts = frames.Verdicts()
    frames.compare_with_recorded([replace(first_frame(), scene="new")], {"frames": []}, verdicts)
    assert verdicts.failed == 1


def test_a_recorded_frame_that_is_not_measured_fails_but_for_models_that_are_not_there() -> None:
    verdicts = frames.Verdicts()
    measured = [frame for frame in (frames.Frame(**row) for row in recorded()["frames"]) if frame.subpixel_bits == 4]
    frames.compare_with_recorded([one for one in measured if "model" not in one.scene], recorded(), verdicts)
    assert verdicts.failed == 0
    frames.compare_with_recorded([one for one in measured if one.scene != "S3"], recorded(), verdicts)
    assert verdicts.failed == 2


# What they make for themselves is no stage of the renderer: a HUD, lamps' light, a fog's table, pictures.
BUSY_SCENES = ("S1-hud", "materials-again", "S1-fog", "S2-flat-fog", "S2-fog", "S2-palette", "S2-alpha")


def test_the_recorded_stages_make_up_the_whole() -> None:
    for frame in (frames.Frame(**row) for row in recorded()["frames"]):
        for core, count in frame.instructions.items():
            assert sum(frame.stages[core].values()) == count
            assert 0 <= frame.stages[core]["rest"] <= (1 if frame.scene in BUSY_SCENES else 0.01) * count


def test_the_committed_files_are_of_one_run() -> None:
    content = json.loads((BENCH / "results" / "accuracy_cost.json").read_text("utf-8"))
    assert [group["name"] for group in content["groups"]] == list(GROUPS)
    assert (BENCH / "results" / "accuracy_cost.csv").read_text("utf-8") == compare.as_csv(content["groups"])
    for group in content["groups"]:
        chosen = [choice["name"] for choice in group["choices"] if choice["chosen"]]
        assert chosen == [GROUPS[group["name"]].chosen]
    assert recorded()["compiler"] == content["compiler"]


def test_the_csv_has_a_row_per_error() -> None:
    choice = {"name": "a", "title": "A", "chosen": True, "native_ratio": 1.0, "pareto": ["cortex-m4f"]}
    choice |= {"instructions": {"cortex-m0plus": 2.5, "cortex-m4f": 1.5}, "errors": {"e": 0.5, "f": 2}}
    rows = list(
        csv.DictReader(io.StringIO(compare.as_csv([{"name": "g", "unit": "px", "error": "e", "choices": [choice]}])))
    )
    assert [(row["error"], row["value"], row["pareto_cortex-m0plus"], row["pareto_cortex-m4f"]) for row in rows] == [
        ("e", "0.5", "0", "1"),
        ("f", "2", "", ""),
    ]
