"""Fixtures of the accuracy tests: the simulator under test, the test models, the folder for reports."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from features_program import Features
from needs import missing, need_simulator
from sim_commands import Simulator

REPOSITORY = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def simulator() -> Simulator:
    """The optimised simulator that EDGELINE_SIM names."""
    return Simulator(need_simulator())


@pytest.fixture(scope="session")
def checked_simulator() -> Simulator:
    """The simulator with sanitizers that EDGELINE_SIM_DEBUG names, else the one that EDGELINE_SIM names."""
    return Simulator(need_simulator("EDGELINE_SIM_DEBUG" if os.environ.get("EDGELINE_SIM_DEBUG") else "EDGELINE_SIM"))


def _features_beside(simulator: Simulator) -> Features:
    path = simulator.path.parent / "tests" / "features" / "features"
    if not path.is_file():
        missing(f"no {path}: build with EDGELINE_TESTS=ON")
    return Features(path)


@pytest.fixture(scope="session")
def features(simulator: Simulator) -> Features:
    """The optimised program `features` beside the simulator."""
    return _features_beside(simulator)


@pytest.fixture(scope="session")
def checked_features(checked_simulator: Simulator) -> Features:
    """The program `features` with sanitizers, where there is one."""
    return _features_beside(checked_simulator)


@pytest.fixture(scope="session")
def reports() -> Path:
    """The folder for reports; EDGELINE_REPORTS, or build/reports in the repository."""
    folder = Path(os.environ.get("EDGELINE_REPORTS") or REPOSITORY / "build" / "reports")
    folder.mkdir(parents=True, exist_ok=True)
    return folder


@pytest.fixture(scope="session")
def models() -> Path:
    """The folder with the test models, shared/models beside the repository."""
    folder = REPOSITORY.parent / "shared" / "models"
    if not folder.is_dir():
        missing("no test models: shared/models is not beside the repository")
    return folder


@pytest.fixture(scope="session")
def convert(models: Path, tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Path]:
    """`convert("spot_control_mesh.obj", "--texture", "spot_texture.png")` gives the path of an .elm file.

    Arguments that name a test model become its path. The converter runs as a user runs it, from host/.
    """
    folder = tmp_path_factory.mktemp("elm")
    made: dict[tuple[str, ...], Path] = {}

    def run(*arguments: str) -> Path:
        if arguments not in made:
            path = folder / f"{len(made)}.elm"
            paths = [str(models / argument) if (models / argument).is_file() else argument for argument in arguments]
            environment = dict(os.environ)
            environment["PYTHONPATH"] = os.pathsep.join(
                [str(REPOSITORY / "host"), *filter(None, [os.environ.get("PYTHONPATH")])]
            )
            done = subprocess.run(
                [sys.executable, "-m", "edgeline", "convert", *paths, "-o", str(path)],
                env=environment,
                capture_output=True,
                text=True,
                timeout=120,
                check=False,
            )
            assert done.returncode == 0, f"edgeline convert {' '.join(arguments)}: {done.stderr}"
            made[arguments] = path
        return made[arguments]

    return run
