"""What all tests of boards share: images of boards, faulty variants of them, the simulator.

Two variables name places: EDGELINE_SIM is the simulator's binary (build/sim/edgeline-sim where it is not set),
EDGELINE_BUILD the folder that boards are built into (build).
"""

from __future__ import annotations

import fcntl
import os
import shutil
import subprocess
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

from needs import need_simulator, need_tool

REPOSITORY = Path(__file__).resolve().parents[2]

BUILD = Path(os.environ.get("EDGELINE_BUILD") or REPOSITORY / "build").resolve()

Picture = npt.NDArray[np.uint16]
"""RGB565 of shape (height, width), as the viewer sees it."""

Replacements = Mapping[str, Sequence[tuple[str, str]]]
"""Path below the repository -> what to replace by what; each text must be there exactly once."""


@contextmanager
def only_one(name: str) -> Iterator[None]:
    """Lets one process at a time pass, of all that test with the same EDGELINE_BUILD."""
    BUILD.mkdir(parents=True, exist_ok=True)
    with (BUILD / f"{name}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


@dataclass(frozen=True)
class Image:
    """A board's program as it is flashed."""

    folder: Path
    name: str = "edgeline-demo"

    @property
    def elf(self) -> Path:
        return self.folder / f"{self.name}.elf"

    @property
    def uf2(self) -> Path:
        return self.folder / f"{self.name}.uf2"


def build_board(board: str, source: Path = REPOSITORY, folder: str = "", **variables: str) -> Image:
    """Builds `board` by its preset, as users do, into build/<board>, or with CMake variables (EDGELINE_PANEL="st7789")
    into a folder of its own. What has not changed is not built again, so it may be called for each test."""
    need_tool("cmake", "cmake")
    if not board.startswith("riscv"):
        need_tool("arm-none-eabi-gcc", "gcc-arm-none-eabi")
    target = BUILD / (folder or "-".join([board, *variables.values()]))
    definitions = [f"-D{name}={value}" for name, value in variables.items()]
    with only_one(target.name):
        # A copy of the sources is configured once: what is faulty there is never CMake.
        if source == REPOSITORY or not (target / "CMakeCache.txt").is_file():
            _run(["cmake", "--preset", board, "-B", str(target), *definitions], source)
        _run(["cmake", "--build", str(target), "--parallel", "2"], source)
    return Image(target)


def build_faulty(board: str, faults: Replacements, kept: Path, **variables: str) -> Image:
    """Builds `board` from a copy of the sources in which texts have been replaced, and keeps the program in the folder
    `kept`. Fails when a text is not there exactly once: then the source has changed, and the fault with it.

    All faults of a board share one copy, so that each costs the compilation of one file."""
    copy = BUILD / f"{board}-faulty-source"
    with only_one(copy.name):
        copy.mkdir(exist_ok=True)
        for name in ("CMakeLists.txt", "CMakePresets.json", "firmware"):
            _mirror(REPOSITORY / name, copy / name)
        for name, replacements in faults.items():
            path = copy / name
            text = path.read_text(encoding="utf-8")
            for old, new in replacements:
                assert text.count(old) == 1, f"{name}: {text.count(old)} times, not once: {old!r}"
                text = text.replace(old, new)
            path.write_text(text, encoding="utf-8")
        image = build_board(board, copy, "-".join([board, *variables.values(), "faulty"]), **variables)
        kept.mkdir(parents=True, exist_ok=True)
        for path in image.folder.glob(f"{image.name}.*"):
            shutil.copy(path, kept)
    return Image(kept)


def _mirror(source: Path, target: Path) -> None:
    """Makes `target` equal to `source`; leaves files alone that are, so that make finds nothing to do for them."""
    if source.is_dir():
        target.mkdir(parents=True, exist_ok=True)
        names = {path.name for path in source.iterdir()}
        for path in target.iterdir():
            if path.name not in names:
                shutil.rmtree(path) if path.is_dir() else path.unlink()
        for name in names:
            _mirror(source / name, target / name)
    elif not target.is_file() or target.read_bytes() != source.read_bytes():
        shutil.copyfile(source, target)
        shutil.copymode(source, target)


def _run(command: list[str], folder: Path) -> None:
    done = subprocess.run(
        command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=600, check=False
    )
    tail = "\n".join(done.stdout.splitlines()[-15:])
    assert done.returncode == 0, f"{' '.join(command)}: status {done.returncode}\n{tail}"


class LookError(AssertionError):
    """What was on the display's wire is not what the display takes; the text is the simulator's."""


@dataclass(frozen=True)
class Simulator:
    """The binary at `path`."""

    path: Path

    def run(self, *arguments: str, timeout: float = 120.0) -> subprocess.CompletedProcess[str]:
        """Runs the binary whatever its exit status."""
        return subprocess.run(
            [str(self.path), *arguments], capture_output=True, text=True, timeout=timeout, check=False
        )

    def scenes(self) -> list[str]:
        """The names that `list` prints; a scene's place in it is its number in INPUT."""
        done = self.run("list")
        assert done.returncode == 0, done.stderr
        return [line.split()[0] for line in done.stdout.splitlines() if line.strip()]

    def render(
        self, scene: str, size: tuple[int, int], folder: Path, panel: str = "", *, rotation: int = 0, frames: int = 1
    ) -> npt.NDArray[np.uint16]:
        """The first `frames` pictures of `scene` at `size` (width, height), shape (frames, height, width): with a panel
        what its glass shows to the viewer."""
        width, height = size
        raw = folder / f"{scene}-{width}x{height}-{panel or 'plain'}-{rotation}.rgb565"
        glass = ["--panel", panel, "--rotation", str(rotation)] if panel else []
        kept = ["--size", f"{width}x{height}", "--frames", str(frames), "--raw", str(raw)]
        done = self.run("render", "--scene", scene, *kept, *glass)
        assert done.returncode == 0, f"render {scene}: {done.stderr.strip()}"
        pictures = np.fromfile(raw, "<u2").reshape(frames, height, width)
        raw.unlink()
        return pictures

    def look(self, trace: Path, panel: str, size: tuple[int, int], rotation: int = 0) -> Picture:
        """What `panel`, held at `rotation`, shows at the end of the wire trace; `size` is (width, height) as the viewer
        sees it. Raises LookError in the model's words."""
        width, height = size
        raw = trace.with_suffix(".rgb565")
        done = self.run("look", "--panel", panel, "--rotation", str(rotation), str(trace), "--raw", str(raw))
        if done.returncode != 0:
            raise LookError(done.stderr.strip() or f"look: status {done.returncode}")
        picture = np.fromfile(raw, "<u2").reshape(height, width)
        raw.unlink()
        return picture


def find_simulator() -> Simulator:
    """The simulator that EDGELINE_SIM names, else the one of the preset `sim`."""
    return Simulator(need_simulator())


def assert_same_picture(shown: Picture, expected: Picture, what: str) -> None:
    """Fails with the number of pixels that differ and the first of them."""
    assert shown.shape == expected.shape, f"{what}: {shown.shape} instead of {expected.shape}"
    places = np.argwhere(shown != expected)
    if len(places):
        y, x = places[0]
        pytest.fail(
            f"{what}: {len(places)} of {shown.size} pixels differ, the first at x {x}, y {y}: "
            f"{shown[y, x]:#06x} instead of {expected[y, x]:#06x}"
        )
