"""Fixtures of the boards' tests: the simulator whose pictures are the reference, and the boards' images."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from target_tools import REPOSITORY, Image, Simulator, build_board, find_simulator


@pytest.fixture(scope="session")
def simulator() -> Simulator:
    """The simulator that EDGELINE_SIM names, else build/sim/edgeline-sim."""
    return find_simulator()


@pytest.fixture(scope="session")
def board_image() -> Callable[..., Image]:
    """`board_image("rp2040", EDGELINE_PANEL="st7789")` gives the built image; each variant is built once."""
    built: dict[tuple[str, ...], Image] = {}

    def get(board: str, **variables: str) -> Image:
        key = (board, *(f"{name}={value}" for name, value in variables.items()))
        if key not in built:
            built[key] = build_board(board, REPOSITORY, "", **variables)
        return built[key]

    return get
