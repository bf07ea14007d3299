"""320x240 with 1,000 visible triangles takes at most 48 KB of RAM in all, by the simulator's own account."""

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


@pytest.mark.parametrize(("band", "total"), [(4, "in all"), (8, "in all, when no triangle is textured")])
def test_a_thousand_triangles_fit(simulator: Simulator, band: int, total: str) -> None:
    assert _account(simulator, "--band", str(band))[total] <= LIMIT


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
