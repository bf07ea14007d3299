"""A Pico's frames beside what its display's wire carries: tests/target/pico_wire.py measures both, in the emulator."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from typing import Any

from .machines import BENCH, ROOT, BenchError, MissingToolError
from .tables import markdown, put_between

PROGRAM = ROOT / "tests" / "target" / "pico_wire.py"
RESULT = BENCH / "results" / "pico.json"
RECORD = "tests/bench/run --record-pico"
STATUS_MISSING = 77

HIDDEN = 1.01
"""Cycles of a frame over the wire's, up to which drawing counts as hidden: the commands take the rest."""


def measure() -> dict[str, Any]:
    """What pico_wire.py prints. Raises MissingToolError without Node or the emulator, BenchError when it fails."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "host")}
    done = subprocess.run(
        [sys.executable, str(PROGRAM)], env=environment, capture_output=True, text=True, encoding="utf-8", check=False
    )
    if done.returncode == STATUS_MISSING:
        raise MissingToolError(done.stderr.strip())
    if done.returncode != 0:
        raise BenchError(f"{PROGRAM.name} failed: {done.stderr.strip()}")
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def table(found: Mapping[str, Any]) -> str:
    """A Markdown table."""
    head = ["scene", "sent", "cycles", "core idle", "wire in use", "bands, late", "frames/s", "hidden"]
    rows = []
    for one in found["courses"]:
        hidden = one["cycles"] <= HIDDEN * one["wire_cycles"]
        rows.append(
            [
                *(one["scene"], one["course"]),
                *(_millions(one[name]) for name in ("cycles", "idle_cycles", "wire_cycles")),
                f"{one['bands']}, {one['late_bands']}",
                f"{found['clock_hz'] / one['cycles']:,.1f}",
                "" if one["course"] != "whole" else "yes" if hidden else "no",
            ]
        )
    return markdown(head, rows, 2)


def embed(text: str, found: Mapping[str, Any]) -> str:
    """A document with its table "<!-- pico: frames -->" as measured."""
    return put_between(text, "pico", {"frames": lambda: table(found)})


def _millions(cycles: int) -> str:
    return f"{cycles / 1e6:.2f} M" if cycles == 0 or cycles >= 100_000 else f"{cycles / 1e6:.3f} M"
