"""What a test needs and may not find: a tool, the simulator, whatever else.

What is missing is skipped by name on a developer's machine and is a failure where the environment variable CI is set,
so that a gate cannot pass by not running.
"""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from typing import NoReturn

import pytest

_SIMULATOR = Path(__file__).resolve().parents[1] / "build" / "sim" / "edgeline-sim"


def missing(what: str) -> NoReturn:
    """Skips the test where `what` is not there; in CI it has to be."""
    if os.environ.get("CI"):
        pytest.fail(f"{what} (CI is set: nothing may be skipped)", pytrace=False)
    pytest.skip(what)


def need_tool(name: str, package: str) -> str:
    """The path of the program `name`; skips the test where it is not installed."""
    path = shutil.which(name)
    if path is None:
        missing(f"no {name}: install {package}")
    return path


def need_simulator(variable: str = "EDGELINE_SIM") -> Path:
    """The simulator that the environment variable names, else the one of the preset `sim`; skips the test without."""
    named = os.environ.get(variable)
    path = Path(named or _SIMULATOR).resolve()
    if not path.is_file():
        if named:
            pytest.fail(f"{variable} names {named}, where there is no file: build the simulator first", pytrace=False)
        missing(f"no simulator: set {variable} to the path of edgeline-sim")
    return path
