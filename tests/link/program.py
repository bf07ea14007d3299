"""Where the lock-step device's program is."""

from __future__ import annotations

import os
from pathlib import Path

NAME = "edgeline-link-device"


def device_program(given: Path | None = None) -> Path | None:
    """`given`, or the one beside the simulator that EDGELINE_SIM names, or build/sim's; None if it is not there."""
    simulator = os.environ.get("EDGELINE_SIM")
    folder = Path(simulator).parent if simulator else Path(__file__).parents[2] / "build" / "sim"
    program = given or folder / NAME
    return program.resolve() if program.is_file() else None
