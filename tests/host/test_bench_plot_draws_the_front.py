"""`edgeline bench --plot`: which points make the Pareto front, and one clear line for whatever is wrong."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

from edgeline import bench_plot
from edgeline.cli import main

RESULTS = Path(__file__).parents[1] / "bench" / "results" / "accuracy_cost.json"


def choice(name: str, cost: float, error: float, chosen: bool = False) -> dict[str, Any]:
    return {
        "title": name,
        "chosen": chosen,
        "instructions": {"cortex-m0plus": cost, "cortex-m4f": cost / 2},
        "errors": {"max": error},
    }


def group(*choices: dict[str, Any]) -> dict[str, Any]:
    return {"title": "a choice", "unit": "pixel", "error": "max", "error_title": "texels", "choices": list(choices)}


@pytest.mark.parametrize(
    ("points", "front"),
    [
        ([(1, 9), (2, 5), (3, 1)], [(1, 9), (2, 5), (3, 1)]),
        ([(1, 9), (2, 9), (3, 1)], [(1, 9), (3, 1)]),
        ([(3, 1), (1, 9), (2, 0)], [(1, 9), (2, 0)]),
        ([(2, 5), (2, 3), (2, 4)], [(2, 3)]),
        ([(1, 0), (2, 0)], [(1, 0)]),
    ],
)
def test_the_front_is_what_nothing_equals_or_beats(points: list[tuple[int, int]], front: list[tuple[int, int]]) -> None:
    assert bench_plot.front([(cost, error, "", False) for cost, error in points]) == front


def test_points_are_those_of_the_core() -> None:
    found = bench_plot.points(group(choice("a", 8, 0.5, True), choice("b", 2, 3)), "cortex-m4f")
    assert found == [(4.0, 0.5, "a", True), (1.0, 3.0, "b", False)]


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (None, "No such file"),
        ("{", "is no JSON"),
        ("[]", "holds no groups"),
        ('{"groups": []}', "holds no groups"),
        (json.dumps({"groups": [{"title": "t"}]}), "lacks 'choices'"),
        (json.dumps({"groups": [group({"title": "x"})]}), "lacks 'instructions'"),
        (json.dumps({"groups": [3]}), "lacks"),
    ],
)
def test_a_bad_file_gets_one_line(
    content: str | None, words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "in.json"
    if content is not None:
        path.write_text(content)
    assert main(["bench", "--plot", str(path), "-o", str(tmp_path / "out.png")]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.count("\n") == 1
    assert str(path) in said.err
    assert words in said.err
    assert not (tmp_path / "out.png").exists()


def test_without_matplotlib_the_line_says_how_to_get_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(__import__("sys").modules, "matplotlib", None)
    assert main(["bench", "--plot", str(RESULTS), "-o", str(tmp_path / "out.png")]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert said.endswith("-m pip install matplotlib\n")


def test_an_output_that_cannot_be_written_gets_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("matplotlib")
    output = tmp_path / "no" / "folder.png"
    assert main(["bench", "--plot", str(RESULTS), "-o", str(output)]) == 2
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert str(output) in said


def test_the_committed_results_make_a_chart_and_the_same_one_each_time(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    outputs = [tmp_path / "a.png", tmp_path / "b.png"]
    for output in outputs:
        assert main(["bench", "--plot", str(RESULTS), "-o", str(output)]) == 0
    assert outputs[0].read_bytes() == outputs[1].read_bytes()
    with Image.open(outputs[0]) as picture:
        assert len(picture.convert("RGB").getcolors(1 << 20) or []) > 10
