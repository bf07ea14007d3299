"""`edgeline-sim methods`: what is exact in theory is exact here, what is not is wrong as often as is written down.

Times are whatever the machine makes of them; everything else is the same in every run of a seed.
"""

from __future__ import annotations

import csv
import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from sim_commands import Simulator

REPOSITORY = Path(__file__).resolve().parents[2]
COUNT = 30

TRIANGLE_KINDS = ["small", "medium", "large", "sliver", "fan", "centred", "axis"]
POLYGON_KINDS = ["convex", "star", "concave", "hole", "crossing"]

WRONG_TRIANGLES = {
    "angle-sum": {},
    "barycentric-solve": {"sliver": (0, 7), "fan": (1, 0)},
    "split": {"fan": (36, 33), "centred": (8, 2), "axis": (0, 1)},
}
WRONG_POLYGONS = {
    "ray-naive": {
        "convex": (2392, 865),
        "star": (1563, 1475),
        "concave": (1703, 151),
        "hole": (7371, 3053),
        "crossing": (1610, 2235),
    },
    "angle-even-odd": {
        "convex": (72, 46),
        "star": (71, 169),
        "concave": (1308, 581),
        "hole": (139, 138),
        "crossing": (81, 189),
    },
    "angle-non-zero": {
        "convex": (72, 46),
        "star": (68, 169),
        "concave": (1308, 581),
        "hole": (122, 103),
        "crossing": (72, 184),
    },
}
"""Missing and extra pixels of each method that is not exact, by kind, for seed 1; kinds without any are left out."""

RULES_ON_FANS = [("all", False, True), ("none", True, False), ("left-top", False, False)]
"""What a rule does to shared edges: whether there are cracks, whether there are double hits."""

Tables = dict[str, Any]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("methods")


@pytest.fixture(scope="module")
def text(simulator: Simulator, folder: Path) -> str:
    """Standard output of one run of seed 1 that writes all its files to `folder`."""
    files = [f"--json={folder / 'm.json'}", f"--csv={folder / 'm.csv'}", f"--png={folder / 'm.png'}"]
    return simulator.run_well("methods", "--seed", "1", "--count", str(COUNT), *files)


@pytest.fixture(scope="module")
def tables(text: str, folder: Path) -> Tables:
    loaded: Tables = json.loads((folder / "m.json").read_text())
    return loaded


def wrong(method: dict[str, Any]) -> dict[str, tuple[int, int]]:
    """Missing and extra pixels of the kinds that have any."""
    counts = {kind: (score["missing"], score["extra"]) for kind, score in method["kinds"].items()}
    return {kind: both for kind, both in counts.items() if both != (0, 0)}


def untimed(value: Any) -> Any:
    """The same without the times."""
    if isinstance(value, dict):
        return {key: untimed(part) for key, part in value.items() if not key.startswith("ns_")}
    return [untimed(part) for part in value] if isinstance(value, list) else value


@pytest.mark.parametrize(("family", "kinds"), [("triangles", TRIANGLE_KINDS), ("polygons", POLYGON_KINDS)])
def test_every_method_met_every_kind(tables: Tables, family: str, kinds: list[str]) -> None:
    assert len(tables[family]) >= 13
    for method in tables[family]:
        assert list(method["kinds"]) == kinds
        for kind, score in method["kinds"].items():
            assert score["shapes"] == COUNT or (kind == "fan" and score["shapes"] >= 5 * COUNT)
            assert score["ns_per_shape"] > 0 and score["work"] > 0
            assert 0 < score["edge_pixels"] <= score["covered"]


@pytest.mark.parametrize("family", ["triangles", "polygons"])
def test_exact_methods_have_no_wrong_pixel(tables: Tables, family: str) -> None:
    exact = [method for method in tables[family] if method["exact"]]
    assert len(exact) >= 10
    assert {method["method"]: wrong(method) for method in exact if wrong(method)} == {}


def test_the_others_are_wrong_as_written_down(tables: Tables) -> None:
    assert {m["method"]: wrong(m) for m in tables["triangles"] if not m["exact"]} == WRONG_TRIANGLES
    assert {m["method"]: wrong(m) for m in tables["polygons"] if not m["exact"]} == WRONG_POLYGONS


def test_only_the_rule_of_left_and_top_keeps_fans_whole(tables: Tables) -> None:
    for method in tables["triangles"]:
        fans = method["fans"]
        assert fans["fans"] == COUNT and fans["inner"] > 0
        outcome = (method["rule"], fans["cracks"] > 0, fans["double_hits"] > 0)
        if method["exact"]:
            assert outcome in [("all", False, True), ("none", True, False), ("left-top", False, False)], method[
                "method"
            ]


def test_methods_of_one_rule_cover_the_same(tables: Tables) -> None:
    """The reference is the rule's, so its pixels are the same for all methods that share it."""
    for family in ("triangles", "polygons"):
        covered: dict[str, Any] = {}
        for method in tables[family]:
            pixels = {kind: (score["covered"], score["edge_pixels"]) for kind, score in method["kinds"].items()}
            assert covered.setdefault(method["rule"], pixels) == pixels, method["method"]


def test_edgelines_depth_is_within_one_and_in_range(tables: Tables) -> None:
    scores = [value for value in tables["values"] if value["method"] == "edgeline"]
    assert {value["use"] for value in scores} == {"depth", "colour"}
    for value in scores:
        for kind, score in value["kinds"].items():
            assert score["max_error"] <= 1 and score["outside"] == 0, (value["use"], kind, score)


def test_float_depth_is_off_where_edgelines_is_not(tables: Tables) -> None:
    """The measurement tells an exact plane from one in float, else Edgeline's figures would say nothing."""
    off = {
        value["method"]: sum(score["off"] for score in value["kinds"].values())
        for value in tables["values"]
        if value["use"] == "depth"
    }
    assert all(off[method] > 4 * off["edgeline"] for method in ("normal", "interpolated", "gradient")), off


def test_gradient_is_the_only_colour_without_an_error_to_see(tables: Tables) -> None:
    worst = {
        value["method"]: max(score["max_error"] for score in value["kinds"].values())
        for value in tables["values"]
        if value["use"] == "colour"
    }
    assert worst["of-first"] > worst["mean"] > 64
    assert all(worst[method] <= 1 for method in ("gradient", "interpolated", "edgeline"))


def test_a_seed_is_the_same_every_time_and_another_is_not(simulator: Simulator, tables: Tables, tmp_path: Path) -> None:
    for seed, same in ((1, True), (2, False)):
        path = tmp_path / f"{seed}.json"
        simulator.run_well("methods", "--seed", str(seed), "--count", str(COUNT), "--json", str(path))
        again = json.loads(path.read_text())
        assert (untimed(again["triangles"]) == untimed(tables["triangles"])) is same
        assert (untimed(again["polygons"]) == untimed(tables["polygons"])) is same
        assert (untimed(again["values"]) == untimed(tables["values"])) is same


def test_the_table_names_every_method(text: str, tables: Tables) -> None:
    for family in ("triangles", "polygons", "values"):
        for method in tables[family]:
            assert any(
                line.lstrip().startswith(method["title"]) or method["title"] in line for line in text.splitlines()
            )


def test_csv_says_what_json_says(tables: Tables, folder: Path) -> None:
    with (folder / "m.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    lines = {(row["family"], row["method"], row["kind"]): row for row in rows}
    assert len(lines) == len(rows)
    for family, name in (("triangles", "triangle"), ("polygons", "polygon"), ("values", "")):
        for method in tables[family]:
            for kind, score in method["kinds"].items():
                row = lines.pop((name or method["use"], method["method"], kind))
                shared = {key: value for key, value in score.items() if key in row}
                assert {key: float(row[key]) for key in shared} == shared
                if kind == "fan":
                    assert (int(row["cracks"]), int(row["double_hits"])) == (
                        method["fans"]["cracks"],
                        method["fans"]["double_hits"],
                    )
    assert lines == {}


def test_the_picture_shows_right_missing_and_extra(text: str, folder: Path) -> None:
    picture = np.asarray(Image.open(folder / "m.png").convert("RGB")).astype(int)
    assert picture.shape[:2] == (1092, 1000)
    red, green, blue = np.moveaxis(picture, 2, 0)
    assert ((red > 200) & (green < 60) & (blue < 60)).sum() > 500
    assert ((red > 240) & (green > 140) & (blue < 60)).sum() > 2000
    assert ((red < 130) & (green > 150) & (blue > 180)).sum() > 100000


@pytest.mark.parametrize(
    "arguments",
    [
        ["--seed", "-1"],
        ["--seed", "one"],
        ["--seed"],
        ["--count", "0"],
        ["--count", "10001"],
        ["--no-such-option"],
        ["extra"],
        ["--json", "no/such/folder/m.json"],
        ["--csv", "no/such/folder/m.csv"],
        ["--png", "no/such/folder/m.png"],
    ],
)
def test_bad_arguments_get_one_line(checked_simulator: Simulator, tmp_path: Path, arguments: list[str]) -> None:
    left = tmp_path / "left.json"
    done = checked_simulator.run("methods", "--count", "1", "--json", str(left), *arguments)
    assert (done.returncode, done.stdout) == (2, ""), done.stderr
    assert len(done.stderr.splitlines()) == 1 and done.stderr.startswith("edgeline-sim: ")
    assert not any(tmp_path.iterdir())


# --- The chart --------------------------------------------------------------------------------------------------------


def plot(*arguments: str, python_path: Path | None = None) -> subprocess.CompletedProcess[str]:
    paths = [str(path) for path in (python_path, REPOSITORY / "host") if path]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(paths)}
    return subprocess.run(
        [sys.executable, "-m", "edgeline.methods_plot", *arguments],
        env=environment,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


def test_the_chart_is_a_picture(text: str, folder: Path, tmp_path: Path) -> None:
    if importlib.util.find_spec("matplotlib") is None:
        (pytest.fail if os.environ.get("CI") else pytest.skip)("no matplotlib")
    done = plot(str(folder / "m.json"), str(tmp_path / "chart.png"))
    assert (done.returncode, done.stderr) == (0, "")
    with Image.open(tmp_path / "chart.png") as chart:
        assert chart.width > 800 and chart.height > 400


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (None, "cannot read"),
        ("no json", "not what"),
        ("{}", "not what"),
        ('{"triangles": [{"method": 1}]}', "not what"),
    ],
)
def test_the_chart_refuses_other_files_in_one_line(tmp_path: Path, content: str | None, words: str) -> None:
    source = tmp_path / "in.json"
    if content is not None:
        source.write_text(content)
    done = plot(str(source), str(tmp_path / "out.png"))
    assert done.returncode == 2 and words in done.stderr and len(done.stderr.splitlines()) == 1, done.stderr
    assert not (tmp_path / "out.png").exists()


def test_without_matplotlib_one_line_says_what_to_install(text: str, folder: Path, tmp_path: Path) -> None:
    hidden = tmp_path / "hidden"
    hidden.mkdir()
    (hidden / "matplotlib.py").write_text("raise ModuleNotFoundError(name='matplotlib')\n")
    done = plot(str(folder / "m.json"), str(tmp_path / "out.png"), python_path=hidden)
    assert done.returncode == 2 and "pip install matplotlib" in done.stderr and len(done.stderr.splitlines()) == 1, (
        done.stderr
    )
