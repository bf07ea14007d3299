"""What several tests share: running the command as users do, the simulator, a display."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from hypothesis import settings

from needs import missing, need_simulator

# The same examples every time, and none kept in the tree.
settings.register_profile("edgeline", derandomize=True, database=None, deadline=None)
settings.load_profile("edgeline")

HOST = Path(__file__).parents[2] / "host"

Edgeline = Callable[..., "subprocess.CompletedProcess[str]"]


def environment() -> dict[str, str]:
    """The environment for `python -m edgeline`, which need not be installed."""
    kept = {name: value for name, value in os.environ.items() if name != "EDGELINE_PORT"}
    return {**kept, "PYTHONPATH": str(HOST)}


@pytest.fixture
def edgeline(tmp_path: Path) -> Edgeline:
    """Runs `edgeline ARGUMENTS` in the test's folder and gives its status and output."""

    def run(
        *arguments: str, timeout: float = 60, env: dict[str, str] | None = None
    ) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "-m", "edgeline", *arguments],
            cwd=tmp_path,
            env={**environment(), **(env or {})},
            capture_output=True,
            text=True,
            timeout=timeout,
            check=False,
        )

    return run


@pytest.fixture(scope="session")
def simulator() -> str:
    """The path of edgeline-sim, which EDGELINE_SIM may name."""
    return str(need_simulator())


@pytest.fixture(scope="session")
def display() -> Iterator[str]:
    """An X display of this process alone: a window that another one opens would cover this one's and take its keys.

    So it is an Xvfb even where there is a display, which does only without Xvfb and for tests that run one by one.
    """
    before = os.environ.get("DISPLAY")
    xvfb = shutil.which("Xvfb")
    if xvfb is None:
        if before is None or "PYTEST_XDIST_WORKER" in os.environ:
            missing("neither Xvfb nor a display that no other test uses")
        yield before
        return
    read, write = os.pipe()
    server = subprocess.Popen(
        [xvfb, "-displayfd", str(write), "-screen", "0", "1366x900x24", "-nolisten", "tcp"],
        pass_fds=[write],
        stderr=subprocess.DEVNULL,
    )
    os.close(write)
    with os.fdopen(read) as pipe:
        number = pipe.readline().strip()
    assert number, "Xvfb did not start"
    os.environ["DISPLAY"] = f":{number}"
    yield f":{number}"
    if before is None:
        del os.environ["DISPLAY"]
    else:
        os.environ["DISPLAY"] = before
    server.terminate()
    server.wait(10)
