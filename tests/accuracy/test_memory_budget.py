"""320x240 with 1,000 visible triangles takes at most 48 KB of RAM in all, by the simulator's own account, which adds up
and is enough."""

from __future__ import annotations

import json

import pytest

from sim_commands import Simulator

LIMIT = 48 * 1024


def _account(simulator: Simulator, *arguments: str) -> dict[str, int]:
    """Bytes by part."""
    done = simulator.run("memory", "--vertices", "600", "--triangles", "1000", *arguments)
    assert done.returncode == 0, done.stderr
    rows = [line.rsplit(maxsplit=1) for line in done.stdout.splitlines()[1:]]
    return {name: int(count) for name, count in rows}


@pytest.mark.parametrize(("band", "shading"), [(4, "textured"), (8, "gouraud"), (8, "flat")])
def test_a_thousand_triangles_fit(simulator: Simulator, band: int, shading: str) -> None:
    assert _account(simulator, "--band", str(band), "--shading", shading)["in all"] <= LIMIT


def test_the_table_adds_up(simulator: Simulator) -> None:
    account = _account(simulator, "--panel", "ssd1306", "--stream")
    parts = list(account.values())
    arena = account["arena (EL_MEMORY_BYTES)"]
    assert sum(parts[:7]) == parts[7] == arena and sum(parts[8:-1]) + arena == account["in all"]


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("--panel", "st7735", "--size", "200x100"), "200 x 100 pixels are more than st7735 has: 128 x 160"),
        (("--panel", "hd44780"), "there is no panel 'hd44780'"),
        (("--shading", "phong"), "--shading takes flat, gouraud or textured, not 'phong'"),
        (("--triangles", "65536"), "--triangles takes a whole number from 0 to 65535"),
        (("--band", "241"), "--band takes a whole number from 1 to 240"),
    ],
)
@pytest.mark.parametrize("command", ["memory", "budget"])
def test_a_bad_option_gets_one_clear_line(
    simulator: Simulator, command: str, arguments: tuple[str, ...], told: str
) -> None:
    done = simulator.run(command, *arguments)
    assert done.returncode == 2 and done.stdout == ""
    assert len(done.stderr.splitlines()) == 1 and told in done.stderr, done.stderr


@pytest.mark.parametrize("band", [1, 5, 8])
def test_the_arena_of_a_budget_is_enough_for_its_triangles(simulator: Simulator, band: int) -> None:
    """A budget for what each scene lists takes one pass; 8 bytes less than the least is refused."""
    sizes = ("--size", "160x120", "--band", str(band))
    for scene, shading, vertices in (("teapot", "gouraud", 873), ("field", "flat", 1369), ("S2", "textured", 16)):
        frame = json.loads(simulator.run_well("render", "--scene", scene, *sizes, "--arena", "1000000", "--stats"))
        # Those that are cut may take several times the memory of a whole one.
        triangles = frame["triangles_listed"] + 21 * frame["triangles_clipped"]
        wish = ("--vertices", str(vertices), "--triangles", str(triangles), "--shading", shading)
        arena = json.loads(simulator.run_well("budget", *sizes, *wish))["arena"]
        again = json.loads(simulator.run_well("render", "--scene", scene, *sizes, "--arena", str(arena), "--stats"))
        assert again["passes"] == 1, (scene, arena)
    least = json.loads(simulator.run_well("budget", *sizes, "--vertices", "0", "--triangles", "0", "--draws", "0"))[
        "arena"
    ]
    assert simulator.run("render", "--scene", "S2", *sizes, "--arena", str(least)).returncode == 0
    assert simulator.run("render", "--scene", "S2", *sizes, "--arena", str(least - 8)).returncode == 2


def test_the_arena_is_enough_for_one_pass(simulator: Simulator) -> None:
    # The island: one mesh of 1,369 vertices, flat.
    def stats(*arguments: str) -> dict[str, int]:
        done = simulator.run("render", "--scene", "field", "--stats", *arguments)
        assert done.returncode == 0, done.stderr
        parsed: dict[str, int] = json.loads(done.stdout)
        return parsed

    listed = stats("--arena", "1000000")["triangles_listed"]
    account = _account(simulator, "--vertices", "1369", "--triangles", str(listed), "--draws", "1")
    arena = account["arena (EL_MEMORY_BYTES)"] - listed * 8
    assert stats("--arena", str(arena))["passes"] == 1
