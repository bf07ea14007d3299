"""`edgeline budget` computes with the firmware's own macros, struct sizes and drivers: C gives the same figures.

Each comparison runs over random sizes, from the smallest to the largest, with a seed.
"""

from __future__ import annotations

import json
import random
import re
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import make_budget
from edgeline import budget_facts as facts
from edgeline.budget import PANELS, Wish, account, advice, array_size, copies
from needs import missing

SEED = 20261122
ROUNDS = 60
SHADINGS = ("flat", "gouraud", "textured")


@pytest.fixture(params=[32, 64])
def bits(request: pytest.FixtureRequest) -> int:
    """A pointer's bits, where there is a compiler for that."""
    target = make_budget.TARGETS[request.param]
    if shutil.which(target.compiler[0]) is None:
        missing(f"{target.compiler[0]} is not installed")
    return int(request.param)


def any_of(rng: random.Random, most: int) -> int:
    """From 0: small and large numbers are equally likely, and so are both ends."""
    return rng.choice((0, most, rng.randint(0, most), rng.randint(0, min(most, 20))))


def wishes(count: int) -> list[Wish]:
    """Of all panels, upright and on their side, whole and in part."""
    rng = random.Random(SEED)
    found = []
    for i in range(count):
        name, panel = list(PANELS.items())[i % len(PANELS)]
        sides = (panel.columns, panel.rows) if rng.random() < 0.5 else (panel.rows, panel.columns)
        width, height = (side if rng.random() < 0.4 else rng.randint(1, side) for side in sides)
        found.append(
            Wish(
                panel=name,
                width=width,
                height=height,
                band=1 + any_of(rng, height - 1),
                vertices=any_of(rng, 65535),
                triangles=any_of(rng, 65535),
                draws=any_of(rng, 65535),
                shading=rng.choice(SHADINGS),
                samples=(1, 4, 8)[i // len(PANELS) % 3],
                stream=rng.random() < 0.5,
            )
        )
    return found


def simulated(simulator: str, *arguments: str) -> dict[str, Any]:
    """What the simulator says of a budget."""
    done = subprocess.run([simulator, "budget", *arguments], capture_output=True, text=True, timeout=60, check=True)
    told: dict[str, Any] = json.loads(done.stdout)
    return told


def test_the_facts_are_those_of_the_headers(tmp_path: Path) -> None:
    for tool in (make_budget.TARGETS[32].compiler[0], "gcc", "ruff"):
        if shutil.which(tool) is None:
            missing(f"{tool} is not installed")
    made = make_budget.facts()
    assert made == make_budget.OUTPUT.read_text(encoding="utf-8"), "make it again: host/make_budget.py"


def test_each_macro_has_the_compiler_s_value(bits: int) -> None:
    rng = random.Random(SEED)
    # What each parameter may be; the products are far from what 32 bits hold.
    most = {"width": 2040, "height": 2040, "band_lines": 2040, "bytes": 10**8, "a": 10**8, "b": 10**8}
    most["samples"] = 8
    least = {"width": 1, "height": 1, "band_lines": 1}
    arrays, values = {}, {}
    for macro in re.findall(r'^    """(EL_\w+) of ', make_budget.OUTPUT.read_text(encoding="utf-8"), re.MULTILINE):
        function = getattr(facts, macro.lower())
        names = [name for name in function.__annotations__ if name != "return"]
        for i in range(ROUNDS):
            low = [least.get(name, 0) for name in names]
            arguments = [at + any_of(rng, most.get(name, 65535) - at) for at, name in zip(low, names, strict=True)]
            value = function(*arguments)
            if value > 0:  # an array of no bytes is none
                arrays[f"{macro}_{i}"] = f"{macro}({', '.join(map(str, arguments))})"
                values[f"{macro}_{i}"] = value
    assert len(values) > 10 * ROUNDS
    assert make_budget.array_sizes(bits, arrays) == values


def test_the_arrays_to_copy_have_the_size_that_is_told(bits: int) -> None:
    chosen = wishes(2 * ROUNDS)
    sizes = make_budget.array_sizes(bits, {f"memory_{i}": array_size(wish) for i, wish in enumerate(chosen)})
    assert list(sizes.values()) == [account(wish).arena for wish in chosen]
    assert {"_MIN_" in array_size(wish) for wish in chosen} == {True, False}


def test_the_other_arrays_to_copy_are_those_of_the_account() -> None:
    for wish in wishes(ROUNDS):
        ram = account(wish).ram
        text = " ".join(copies(wish))
        assert text.count("static") == 1 + (ram["panel_buffer"] > 0) + (ram["stream"] > 0)
        assert ("panel_memory" in text) == (ram["panel_buffer"] > 0)


def test_the_simulator_has_the_same_account(simulator: str) -> None:
    for wish in wishes(2 * ROUNDS):
        told = simulated(
            simulator,
            *("--panel", wish.panel, "--size", f"{wish.width}x{wish.height}", "--band", str(wish.band)),
            *("--vertices", str(wish.vertices), "--triangles", str(wish.triangles), "--draws", str(wish.draws)),
            *("--shading", wish.shading, "--samples", str(wish.samples), *(["--stream"] if wish.stream else [])),
        )
        mine = account(wish, told["pointer_bits"])
        assert told["ram"] == mine.ram, wish
        assert (told["arena"], told["total"]) == (mine.arena, mine.total), wish
        assert told["wire"] == {"pixel_bytes": mine.pixel_bytes, "command_bytes": mine.command_bytes}, wish
        assert sum(list(told["ram"].values())[:7]) == told["arena"], wish


def test_the_panels_are_the_simulator_s(simulator: str) -> None:
    usage = subprocess.run([simulator, "--help"], capture_output=True, text=True, check=True, timeout=60).stdout
    assert re.findall(r"^panels: (.*)$", usage, re.MULTILINE)[0].split() == list(PANELS)
    for name, panel in PANELS.items():
        told = simulated(simulator, "--panel", name)
        assert {told["width"], told["height"]} == {panel.columns, panel.rows}


def test_what_is_advised_fits_and_one_more_does_not() -> None:
    rng = random.Random(SEED)
    kinds = set()
    for wish in wishes(4 * ROUNDS):
        total = account(wish).total
        least = account(replace(wish, band=1, triangles=0, vertices=0, draws=0, samples=1)).total
        ram = rng.choice((total - 1, rng.randint(min(2000, total - 1), total - 1)))
        ways = advice(wish, ram)
        assert not (ways[0].startswith("--band") and any(way.startswith("--band") for way in ways[1:]))
        for way in ways:
            kinds.add(re.sub(r"\d[\d,]*", "N", way))
            bytes_told = int(re.findall(r"([\d,]+) bytes", way)[0].replace(",", ""))
            changed = replace(wish, **{name: int(value) for name, value in re.findall(r"--(\w+) (\d+)", way)})
            assert account(changed).total == bytes_told
            assert (bytes_told <= ram) == ("nothing does" not in way)
            if "nothing does" in way:
                assert bytes_told == least
            elif "less smooth" in way:
                assert all(account(replace(wish, samples=n)).total > ram for n in (4, 8) if changed.samples < n)
            elif "--triangles" not in way:
                assert account(replace(changed, band=changed.band + 1)).total > ram
            elif changed.triangles < wish.triangles and "many passes" not in way:
                assert account(replace(changed, triangles=changed.triangles + 1)).total > ram
    assert kinds == {
        "--band N fits: N bytes",
        "--triangles N fits: N bytes; more take more passes",
        "--band N --triangles N fits: N bytes; more take more passes",
        "--band N --vertices N --triangles N fits: N bytes; more take more passes",
        "--band N --triangles N --vertices N --draws N takes N bytes, and many passes",
        "--band N --triangles N --vertices N --draws N --samples N takes N bytes, and many passes",
        "nothing does: --band N --triangles N --vertices N --draws N takes N bytes",
        "nothing does: --band N --triangles N --vertices N --draws N --samples N takes N bytes",
        "--samples N fits: N bytes; edges are less smooth",
    }
