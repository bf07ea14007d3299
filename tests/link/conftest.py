"""What the tests share: the device's program."""

from __future__ import annotations

from pathlib import Path

import pytest

from needs import missing
from program import NAME, device_program


@pytest.fixture(scope="session")
def program() -> Path:
    """The lock-step device."""
    path = device_program()
    if path is None:
        missing(f"no {NAME} beside the simulator that EDGELINE_SIM names: build with -DEDGELINE_TESTS=ON")
    return path
