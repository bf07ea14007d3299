"""`edgeline budget` says what a program needs, in words and as JSON, and one clear line for what it cannot do."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from conftest import Edgeline
from edgeline import budget_facts as facts
from edgeline.cli import main

README = Path(__file__).parents[2] / "README.md"
PICO = ["--panel", "ili9341", "--spi", "62.5M", "--cpu", "125M", "--band", "8", "--triangles", "1000", "--ram", "264K"]


def run(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """The command's output; in this process, so that facts can be replaced."""
    assert main(["budget", *arguments]) == 0
    told = capsys.readouterr()
    assert told.err == ""
    return told.out


def measured(monkeypatch: pytest.MonkeyPatch) -> None:
    """Code sizes as if they had been measured."""
    monkeypatch.setattr(facts, "CODE_SOURCE", "a compiler, a core, -Os")
    monkeypatch.setattr(facts, "CODE_OPTIONS", {"all": 16000, "flat": 8000})
    monkeypatch.setattr(facts, "CODE_PANELS", {"st7789": 900})
    monkeypatch.setattr(facts, "CODE_STREAM", 4000)
    monkeypatch.setattr(facts, "CODE_LIBC", 80)


def test_the_readme_shows_what_it_prints(capsys: pytest.CaptureFixture[str]) -> None:
    shown = run(capsys, *PICO)
    told = README.read_text(encoding="utf-8")
    assert f"edgeline budget {' '.join(PICO)}" in told
    wanted = [line for line in shown.splitlines() if line.startswith("  ")]
    section = told.partition("## Memory and speed before you buy")[2].partition("\n## ")[0]
    quoted = [line[4:] for line in section.splitlines() if line.startswith("      ")]
    assert len(quoted) >= 15 and [line for line in wanted if line in quoted] == quoted


def test_the_wire_s_time_is_exact(capsys: pytest.CaptureFixture[str]) -> None:
    told = json.loads(run(capsys, *PICO, "--json"))
    # 153,611 bytes of 8 bits at 62.5 MHz; two CPU clocks each.
    assert told["wire"]["frame_ms"] == 153611 * 8 / 62500
    assert told["wire"]["cpu_cycles"] == 153611 * 8 * 2
    assert told["wire"]["frames_per_second"] == pytest.approx(62.5e6 / (153611 * 8), rel=1e-15)
    assert told["wire"]["frame_ms_at_8.5_clocks"] == 153611 * 8.5 / 62500
    assert "wire" in told and "frame_ms" not in json.loads(run(capsys, "--panel", "ili9341", "--json"))["wire"]


def test_json_and_words_agree(capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["--panel", "ssd0323", "--stream", "--baud", "921600", "--spi", "10M", "--ram", "24K"]
    told = json.loads(run(capsys, *arguments, "--json"))
    words = run(capsys, *arguments)
    assert told["total"] == sum(told["ram"].values()) and f"{told['total']:,}" in words
    assert told["fits_ram"] is False and all(f"  {way}\n" in words for way in told["advice"])
    assert all(f"  {array}\n" in words for array in told["arrays"]) and len(told["arrays"]) == 3
    assert f"{told['stream_seconds_of_raw_frame']:.2f} s" in words
    frames = told["instructions"]["frames"]
    assert {"S1", "S1-4x", "S1-8x"} <= set(frames)
    # Those with several samples are for who asks for them.
    assert all((f"{count:,}  {scene}:" in words) != scene.endswith("x") for scene, count in frames.items())


def test_instructions_are_the_core_s(capsys: pytest.CaptureFixture[str]) -> None:
    for core in facts.FRAMES["S1"][1]:
        told = json.loads(run(capsys, "--panel", "st7735", "--core", core, "--json"))["instructions"]
        assert told["frames"]["S1"] == facts.FRAMES["S1"][1][core] and told["core"] == core


def test_a_budget_that_fits_exactly_fits(capsys: pytest.CaptureFixture[str]) -> None:
    total = json.loads(run(capsys, "--panel", "ssd1306", "--json"))["total"]
    assert "and leaves 0 to the program" in run(capsys, "--panel", "ssd1306", "--ram", str(total))
    assert f"does not fit {total - 1:,} bytes: 1 too many" in run(capsys, "--panel", "ssd1306", "--ram", str(total - 1))


def test_a_list_longer_than_can_be_used_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    # 524,280 bytes: the triangles, 368 of slack and a byte array's rounding; one draw takes 160.
    arguments = ["--panel", "st7735", "--vertices", "0", "--draws", "0", "--triangles"]
    assert "stays unused" not in run(capsys, *arguments, "16372")
    assert "a display list uses 524,280 bytes at most" in run(capsys, *arguments, "16373")


def test_code_is_added_up(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    measured(monkeypatch)
    arguments = ["--panel", "st7789-240x240", "--flash", "20K"]
    assert "textured: 16,980 bytes; fits 20,480, and leaves 3,500" in run(capsys, *arguments)
    assert "flat: 8,980 bytes; fits" in run(capsys, *arguments, "--shading", "flat")
    assert "20,980 bytes; does not fit 20,480: 500 too many" in run(capsys, *arguments, "--stream")
    assert json.loads(run(capsys, *arguments, "--stream", "--json"))["fits_flash"] is False


def test_code_that_was_not_measured_is_said_to_be_so(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(facts, "CODE_OPTIONS", {})
    told = run(capsys, "--panel", "st7735", "--flash", "1M")
    assert "Code: not measured yet\n" in told and "whether it fits 1,048,576 is not known" in told
    assert json.loads(run(capsys, "--panel", "st7735", "--flash", "1M", "--json"))["fits_flash"] is None


BAD = {
    "no panel": ("", "--panel"),
    "another panel": ("--panel hd44780", "hd44780"),
    "a picture that is too large": ("--panel st7735 --size 160x160", "160x160 pixels are more than st7735 has"),
    "no size": ("--panel st7735 --size 160", "WIDTHxHEIGHT"),
    "a band that is too high": ("--panel ssd1306 --band 65", "65 lines are more than the picture's 64"),
    "no lines": ("--panel ssd1306 --band 0", "--band"),
    "no clock": ("--panel ssd1306 --spi fast", "'fast' is no frequency"),
    "less than a hertz": ("--panel ssd1306 --cpu 0.5", "'0.5' is no frequency"),
    "part of a byte": ("--panel ssd1306 --ram 0.3K", "'0.3K' is no number of bytes"),
    "no memory": ("--panel ssd1306 --flash 0", "'0' is no number of bytes"),
    "too many triangles": ("--panel ssd1306 --triangles 65536", "0 to 65535"),
    "another shading": ("--panel ssd1306 --shading phong", "phong"),
    "another core": ("--panel ssd1306 --core avr", "avr"),
    "no rate": ("--panel ssd1306 --stream --baud 0", "--baud"),
}


@pytest.mark.parametrize("case", BAD)
def test_a_bad_wish_gets_one_clear_line(capsys: pytest.CaptureFixture[str], case: str) -> None:
    arguments, expected = BAD[case]
    try:
        status = main(["budget", *arguments.split()])
    except SystemExit as ended:  # the parser's way
        status = int(ended.code or 0)
    told = capsys.readouterr()
    assert status == 2 and told.out == ""
    assert len(told.err.splitlines()) == 1 and expected in told.err, told.err


def test_the_installed_command_has_it(edgeline: Edgeline) -> None:
    done = edgeline("budget", *PICO)
    assert done.returncode == 0 and done.stderr == "" and "in all " in done.stdout
