"""Programs on bare cores: built with each core's compiler, run in QEMU with text and exit status by semihosting."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

from needs import need_tool
from target_tools import BUILD, REPOSITORY, only_one

TARGET = Path(__file__).resolve().parent
STATUS_FAULT = 99
"""What a program ends with whose core has taken a fault."""

RUN_TIMEOUT_S = 120
BUILD_TIMEOUT_S = 600


@dataclass(frozen=True)
class Core:
    """A core, as the toolchain files' EDGELINE_CPU calls it, and QEMU's machine that has it."""

    name: str
    machine: tuple[str, ...]

    @property
    def is_arm(self) -> bool:
        return self.name.startswith("cortex")

    @property
    def qemu(self) -> str:
        if self.is_arm:
            return need_tool("qemu-system-arm", "qemu-system-arm")
        return need_tool("qemu-system-riscv32", "qemu-system-misc")

    def toolchain(self) -> tuple[str, ...]:
        """CMake's options for the core; skips the test where the compiler or its library is not installed."""
        if self.is_arm:
            need_tool("arm-none-eabi-gcc", "gcc-arm-none-eabi and libnewlib-arm-none-eabi")
            file = "cortex_m/arm-none-eabi.cmake"
        else:
            need_tool("riscv64-unknown-elf-gcc", "gcc-riscv64-unknown-elf and picolibc-riscv64-unknown-elf")
            file = "riscv/riscv32-none-elf.cmake"
        path = REPOSITORY / "firmware" / "boards" / file
        return f"-DCMAKE_TOOLCHAIN_FILE={path}", f"-DEDGELINE_CPU={self.name}"


# A Cortex-M3 runs what is compiled for a Cortex-M0+. It forgives unaligned accesses, which the smaller core would not.
CORES = {
    core.name: core
    for core in (
        Core("cortex-m0plus", ("mps2-an385",)),
        Core("cortex-m3", ("mps2-an385",)),
        Core("cortex-m4f", ("mps2-an386",)),
        Core("cortex-m7", ("mps2-an500",)),
        Core("cortex-m33", ("mps2-an505",)),
        Core("rv32imc", ("virt", "-bios", "none")),
    )
}


@dataclass(frozen=True)
class Ended:
    """How a program ended, and what it had printed."""

    status: int
    text: str


def build(project: str, name: str, *options: str, source: Path = REPOSITORY, targets: tuple[str, ...] = ()) -> Path:
    """Builds tests/target/<project> of `source` into the folder <project>-<name> and returns that. What has not changed
    is not built again."""
    need_tool("cmake", "cmake")
    folder = BUILD / f"{project}-{name}"
    chosen = [word for target in targets for word in ("--target", target)]
    with only_one(folder.name):
        _run(["cmake", "-S", str(source / "tests" / "target" / project), "-B", str(folder), *options])
        _run(["cmake", "--build", str(folder), "--parallel", "2", *chosen])
    return folder


def run(program: Path, core: Core | None = None) -> Ended:
    """Runs a program on this computer, or on a core in QEMU."""
    if core is None:
        done = _ended([str(program)])
        return Ended(done.returncode, done.stdout)
    with tempfile.TemporaryDirectory(prefix="edgeline-") as folder:
        text = Path(folder) / "text"
        done = _ended(
            [
                *(core.qemu, "-M", *core.machine, "-kernel", str(program)),
                *("-display", "none", "-monitor", "none", "-serial", "none", "-chardev", f"file,id=text,path={text}"),
                *("-semihosting-config", "enable=on,target=native,chardev=text"),
            ]
        )
        printed = text.read_text(encoding="utf-8", errors="replace") if text.is_file() else ""
    return Ended(done.returncode, printed + done.stdout)


def seeded_copy(name: str, path: str, old: str, new: str) -> Path:
    """A copy of the sources with one text of one file replaced; it must be there exactly once. Returns its root."""
    copy = BUILD / f"{name}-source"
    shutil.rmtree(copy, ignore_errors=True)
    shutil.copytree(REPOSITORY / "tests" / "golden", copy / "tests" / "golden")
    for part in ("firmware", "sim", "tests/features", "tests/target", "tests/unit"):
        shutil.copytree(REPOSITORY / part, copy / part, ignore=shutil.ignore_patterns("node_modules", "__pycache__"))
    shutil.copy(REPOSITORY / "CMakeLists.txt", copy)
    text = (copy / path).read_text(encoding="utf-8")
    assert text.count(old) == 1, f"{path}: {text.count(old)} times, not once: {old!r}"
    (copy / path).write_text(text.replace(old, new), encoding="utf-8")
    return copy


def unity_options() -> tuple[str, ...]:
    """Where the project's own preparation has put Unity; without it, CMake looks and fetches."""
    folder = Path(os.environ.get("EDGELINE_UNITY_DIR") or REPOSITORY / "build" / "unity" / "src").resolve()
    return (f"-DEDGELINE_UNITY_DIR={folder}",) if (folder / "unity.c").is_file() else ()


def _ended(command: list[str]) -> subprocess.CompletedProcess[str]:
    try:
        return subprocess.run(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            timeout=RUN_TIMEOUT_S,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise AssertionError(f"{' '.join(command)} did not end within {RUN_TIMEOUT_S} s") from None


def _run(command: list[str]) -> None:
    done = subprocess.run(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
        timeout=BUILD_TIMEOUT_S,
        check=False,
    )
    lines = done.stdout.splitlines()
    errors = [line for line in lines if "error" in line or "undefined" in line][:10] or lines[-15:]
    assert done.returncode == 0, "\n".join([f"{' '.join(command)}: status {done.returncode}", *errors])
