"""tests/bench/run --against: medians of ratios taken within a round, so a computer that slows down changes nothing."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

BENCH = Path(__file__).parents[1] / "bench"
sys.path.insert(0, str(BENCH))

from bench_tool import against, machines  # noqa: E402


def line(scene: str, ns: int, crc: str = "00000000") -> machines.Line:
    return machines.Line((scene, "1024", "3", "0"), {"crc": crc, "ns": str(ns)})


def test_a_computer_that_slows_down_changes_no_ratio() -> None:
    rounds = [([line("S1", 100 * speed)], [line("S1", 80 * speed)]) for speed in (1, 2, 3, 5, 9)]
    (found,) = against.compare(rounds)
    assert (found.ratio, found.quartiles) == (pytest.approx(0.8), pytest.approx((0.8, 0.8)))
    assert (found.before_ns, found.now_ns) == (300, 240)


def test_one_disturbed_round_changes_no_median() -> None:
    rounds = [([line("S1", 100)], [line("S1", ns)]) for ns in (90, 90, 900, 90, 90)]
    assert against.compare(rounds)[0].ratio == pytest.approx(0.9)


def test_only_frames_of_both_are_compared() -> None:
    before = [line("empty", 0), line("S1", 100), line("gone", 1)]
    now = [line("empty", 0), line("new", 1), line("S1", 50)]
    found = against.compare([(before, now)] * 3)
    assert [one.title for one in found] == ["S1 1024 3 0"]
    assert "| S1 1024 3 0 | 0.1 | 0.1 | 0.500 |" in against.table("0123456789abcdef", found)
    with pytest.raises(machines.BenchError, match="no frame alike"):
        against.compare([([line("gone", 1)], [line("new", 1)])] * 3)


def test_another_revision_is_taken_out_whole(tmp_path: Path) -> None:
    if subprocess.run(["git", "-C", str(machines.ROOT), "rev-parse"], capture_output=True, check=False).returncode != 0:
        pytest.skip("this tree is no git repository")
    commit, tree = against.extract("HEAD", tmp_path)
    assert (tree / "tests" / "bench" / "CMakeLists.txt").is_file() and tree.name == commit[:12]
    assert [path.name for path in tmp_path.iterdir()] == [tree.name]
    assert against.extract("HEAD", tmp_path) == (commit, tree)


def test_what_git_does_not_know_is_named(tmp_path: Path) -> None:
    with pytest.raises(machines.BenchError, match="git knows no revision 'nonsense'"):
        against.extract("nonsense", tmp_path)
