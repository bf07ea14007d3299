"""`edgeline bench --plot` of a scenes.json: which frames are shown, and one clear line for what is missing."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

from edgeline import stage_plot
from edgeline.cli import main

RESULTS = Path(__file__).parents[1] / "bench" / "results" / "scenes.json"


def frame(scene: str, **others: int) -> dict[str, Any]:
    stages = {core: dict.fromkeys(stage_plot.STAGE_COLOURS, 1_000_000) for core in stage_plot.CORE_TITLES}
    return {"scene": scene, "number": 0, "subpixel_bits": 4, "uv_error_log2": 3, "stages": stages, **others}


def content(*frames: dict[str, Any]) -> dict[str, Any]:
    return {"frames": list(frames), "peers": {}, "targets": {"cortex-m4f": {"S1": 0.45}}}


def test_first_frames_as_users_have_them_are_shown_once() -> None:
    first, small = frame("S1"), frame("S1", arena_bytes=1)
    rows = stage_plot.panels_of(content(first, small, frame("S1", uv_error_log2=1), frame("room", number=5)))
    assert rows == [{"S1": first}]


def test_standard_scenes_others_and_layers_have_rows_of_their_own() -> None:
    rows = stage_plot.panels_of(content(frame("layers-front-to-back"), frame("room"), frame("S1")))
    assert [list(row) for row in rows] == [["S1"], ["room"], ["layers-front-to-back"]]


def test_shares_are_millions_in_the_order_of_the_stages() -> None:
    assert stage_plot.shares(frame("S1"), "cortex-m4f") == [(stage, 1.0) for stage in stage_plot.STAGE_COLOURS]


@pytest.mark.parametrize(
    ("broken", "words"),
    [
        (content(), "holds no frames"),
        ({"frames": [frame("S1")], "peers": {}}, "lacks 'targets'"),
        ({"frames": [frame("S1")], "targets": {"cortex-m4f": {}}}, "lacks 'peers'"),
        (content({"scene": "S1"}), "lacks 'number'"),
        (content({**frame("S1"), "stages": {}}), "lacks 'cortex-m0plus'"),
        (content(3), "lacks"),  # type: ignore[arg-type]
    ],
)
def test_a_bad_file_gets_one_line(
    broken: dict[str, Any], words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "in.json"
    path.write_text(json.dumps(broken))
    assert main(["bench", "--plot", str(path), "-o", str(tmp_path / "out.png")]) == 2
    said = capsys.readouterr()
    assert said.err.count("\n") == 1 and words in said.err and str(path) in said.err
    assert not (tmp_path / "out.png").exists()


def test_the_committed_results_make_a_chart_and_the_same_one_each_time(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    outputs = [tmp_path / "a.png", tmp_path / "b.png"]
    for output in outputs:
        assert main(["bench", "--plot", str(RESULTS), "-o", str(output)]) == 0
    assert outputs[0].read_bytes() == outputs[1].read_bytes()
    with Image.open(outputs[0]) as picture:
        assert len(picture.convert("RGB").getcolors(1 << 20) or []) > 10
