"""Every scene has the same pixels whatever compiles and runs it: gcc and clang on this computer, for 64 and 32 bits,
and each core's compiler with the program in QEMU, at all levels of optimisation. The CRC-32 of each frame is the one in
tests/golden/scenes.crc. A table of what was compared is printed at the end of each test (pytest -rP shows it).
"""

from __future__ import annotations

import subprocess
from dataclasses import dataclass
from pathlib import Path

import pytest

from emulators import CORES, Core, build, run, seeded_copy
from needs import missing, need_tool
from target_tools import BUILD, REPOSITORY

ALL_FRAMES = 10
"""Every tenth of the first 120 frames is in the golden file."""

FIRST_FRAMES = 120
HALFWAY = 60

NOT_IN_SMALL_CODE = {"materials", "lamps", "wires"}
"""Scenes whose features are left out where -Os asks for small code."""

Crcs = dict[str, list[str]]
"""Scene -> a CRC-32 per frame."""


@dataclass(frozen=True)
class Configuration:
    """A compiler, its levels of optimisation, and every how many frames are drawn: fewer where that takes long."""

    name: str
    levels: tuple[str, ...]
    step: int
    core: Core | None = None
    options: tuple[str, ...] = ()

    def build(self, source: Path = REPOSITORY, prefix: str = "") -> Path:
        options = self.options if self.core is None else self.core.toolchain()
        levels = ";".join(self.levels)
        return build(
            "frames",
            f"{prefix}{self.name}",
            *(*options, f"-DEDGELINE_LEVELS={levels}", f"-DEDGELINE_FRAME_STEP={self.step}"),
            source=source,
        )


def _native(name: str, compiler: str, levels: tuple[str, ...], flags: str = "") -> Configuration:
    options = (f"-DCMAKE_C_COMPILER={compiler}", f"-DCMAKE_C_FLAGS={flags}")
    return Configuration(name, levels, ALL_FRAMES, None, options)


def _target(core: str, levels: tuple[str, ...], step: int) -> Configuration:
    return Configuration(core, levels, step, CORES[core])


CONFIGURATIONS = (
    _native("gcc-64", "gcc", ("O0", "O1", "O2", "O3", "Os")),
    _native("clang-64", "clang", ("O0", "O1", "O2", "O3", "Os")),
    _native("gcc-32", "gcc", ("O0", "O2", "O3"), "-m32"),
    _native("clang-32", "clang", ("O0", "O2", "O3"), "-m32"),
    _target("cortex-m0plus", ("O2", "Os"), FIRST_FRAMES),
    _target("cortex-m3", ("O0", "O2", "Os"), FIRST_FRAMES),
    _target("cortex-m4f", ("O2", "Os"), HALFWAY),
    _target("cortex-m7", ("O2", "O3", "Os"), FIRST_FRAMES),
    _target("cortex-m33", ("O2", "Os"), FIRST_FRAMES),
    _target("rv32imc", ("O0", "O2", "O3", "Os"), FIRST_FRAMES),
)


def golden(step: int) -> Crcs:
    """What the frames `step` apart must have."""
    text = (REPOSITORY / "tests" / "golden" / "scenes.crc").read_text(encoding="ascii")
    return {words[0]: words[1 :: step // ALL_FRAMES] for words in map(str.split, text.splitlines())}


def drawn(program: Path, core: Core | None) -> Crcs:
    """What the program draws."""
    ended = run(program, core)
    assert ended.status == 0, f"{program.name} ended with status {ended.status}: {ended.text[-200:]}"
    return {words[0]: words[1:] for words in map(str.split, ended.text.splitlines())}


def need_compiler(configuration: Configuration) -> None:
    """Skips the test where this computer cannot compile for the configuration."""
    if configuration.core is not None:
        return
    compiler, flags = (option.split("=", 1)[1] for option in configuration.options)
    need_tool(compiler, compiler)
    probe = BUILD / f"probe-{configuration.name}"
    probe.parent.mkdir(parents=True, exist_ok=True)
    command = [compiler, *flags.split(), "-x", "c", "-", "-o", str(probe)]
    source = '#include <stdio.h>\nint main(void) { return puts("") < 0; }\n'
    if subprocess.run(command, input=source, capture_output=True, text=True, check=False).returncode != 0:
        missing(f"{compiler} {flags} cannot make programs: install gcc-multilib")
    probe.unlink()


@pytest.mark.parametrize("configuration", CONFIGURATIONS, ids=lambda configuration: configuration.name)
def test_crcs_are_the_golden_ones(configuration: Configuration) -> None:
    need_compiler(configuration)
    folder = configuration.build()
    wrong = []
    for level in configuration.levels:
        left_out = NOT_IN_SMALL_CODE if level == "Os" else set()
        expected = {scene: crcs for scene, crcs in golden(configuration.step).items() if scene not in left_out}
        found = drawn(folder / f"frames-{level}", configuration.core)
        differ = [scene for scene in {**expected, **found} if found.get(scene) != expected.get(scene)]
        frames = sum(map(len, expected.values()))
        verdict = f"differs: {', '.join(differ)}" if differ else "equal"
        print(f"{configuration.name:14} -{level} {len(expected):3} scenes {frames:4} frames  {verdict}")
        wrong += [f"-{level}: {scene} is {found.get(scene)}, golden {expected.get(scene)}" for scene in differ]
    assert not wrong, "\n".join(wrong)


def test_a_wrong_constant_is_found() -> None:
    """Colours that are rounded by 1/256 of a level less, on one core."""
    configuration = _target("cortex-m3", ("O2",), FIRST_FRAMES)
    source = seeded_copy(
        "frames-faulty", "firmware/src/raster/plane.h", "EL_CHANNEL_HALF (1U << 23)", "EL_CHANNEL_HALF (0x7FU << 16)"
    )
    folder = configuration.build(source, "faulty-")
    assert drawn(folder / "frames-O2", configuration.core) != golden(configuration.step)
