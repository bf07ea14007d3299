"""What the tests share: the device's program."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from program import NAME, device_program


def missing(what: str) -> None:
    """Skips the test where `what` is not there; in CI it has to be."""
    if os.environ.get("CI"):
        pytest.fail(f"{what}: has to be there in CI")
    pytest.skip(what)


@pytest.fixture(scope="session")
def program() -> Path:
    """The lock-step device."""
    path = device_program()
    if path is None:
        missing(f"no {NAME} beside the simulator that EDGELINE_SIM names: build with -DEDGELINE_TESTS=ON")
    assert path is not None
    return path
