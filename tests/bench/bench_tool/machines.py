"""Building and running the measuring programs: on bare cores in QEMU, where executed instructions are counted, and on
this computer, where time is taken."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

BENCH = Path(__file__).resolve().parents[1]
ROOT = BENCH.parents[1]
BOARDS = ROOT / "firmware" / "boards"


@dataclass(frozen=True)
class Core:
    """A core as its toolchain file's EDGELINE_CPU calls it, QEMU's machine that runs it, and where its code begins
    there. Each is compiled for with -O2."""

    name: str
    title: str
    machine: tuple[str, ...]
    code: int = 0

    @property
    def is_arm(self) -> bool:
        return self.name.startswith("cortex")

    @property
    def qemu(self) -> str:
        return "qemu-system-arm" if self.is_arm else "qemu-system-riscv32"

    @property
    def toolchain(self) -> Path:
        return BOARDS / ("cortex_m/arm-none-eabi.cmake" if self.is_arm else "riscv/riscv32-none-elf.cmake")

    def tool(self, name: str) -> str:
        """A program of its compiler's: gcc, nm ..."""
        return f"{'arm-none-eabi' if self.is_arm else 'riscv64-unknown-elf'}-{name}"


# A Cortex-M3 runs what is compiled for a Cortex-M0+.
CORES = {
    core.name: core
    for core in (
        Core("cortex-m0plus", "Cortex-M0+", ("mps2-an385",)),
        Core("cortex-m3", "Cortex-M3", ("mps2-an385",)),
        Core("cortex-m4f", "Cortex-M4F", ("mps2-an386",)),
        Core("cortex-m7", "Cortex-M7", ("mps2-an500",)),
        Core("cortex-m33", "Cortex-M33", ("mps2-an505",), 0x10000000),
        Core("rv32imc", "RV32IMC", ("virt", "-bios", "none"), 0x80000000),
    )
}

# The two between which the others lie: what is measured with much besides is measured on these alone.
MAIN_CORES = ("cortex-m0plus", "cortex-m4f")

PACKAGES = {
    "arm-none-eabi-gcc": "gcc-arm-none-eabi libnewlib-arm-none-eabi",
    "qemu-system-arm": "qemu-system-arm",
    "riscv64-unknown-elf-gcc": "gcc-riscv64-unknown-elf picolibc-riscv64-unknown-elf",
    "qemu-system-riscv32": "qemu-system-misc",
    "cmake": "cmake",
    "cc": "gcc libc6-dev",
}
RUN_TIMEOUT_S = 300


class BenchError(Exception):
    """What stops a measurement: one line that says what, where and what to do."""


class MissingToolError(BenchError):
    """A program that is not installed; the measurement is skipped then."""


@dataclass(frozen=True)
class Line:
    """One measurement as its program printed it: the words before `crc`, and the named values after it."""

    words: tuple[str, ...]
    values: dict[str, str]

    @property
    def crc(self) -> str:
        return self.values["crc"]


@dataclass(frozen=True)
class Measured:
    line: Line
    instructions: int


def check_tools() -> None:
    """Raises MissingToolError when a tool is not there."""
    missing = [tool for tool in PACKAGES if shutil.which(tool) is None]
    if missing:
        packages = " ".join(PACKAGES[tool] for tool in missing)
        raise MissingToolError(f"{', '.join(missing)} not found; on Debian: apt-get install {packages}")


def output_of(command: Sequence[str | Path], environment: dict[str, str] | None = None) -> str:
    """Standard output of a command that must succeed. Raises BenchError with the last line that it complained with."""
    try:
        done = subprocess.run(
            [str(word) for word in command],
            capture_output=True,
            text=True,
            timeout=RUN_TIMEOUT_S,
            check=False,
            env={**os.environ, **(environment or {})},
        )
    except subprocess.TimeoutExpired:
        raise BenchError(f"{Path(command[0]).name} did not end within {RUN_TIMEOUT_S} s: {command[-1]}") from None
    if done.returncode != 0:
        said = [line for line in (done.stdout + done.stderr).splitlines() if line.strip()]
        errors = [line for line in said if re.search(r"\b(error|Error)\b", line)] or said[-1:]
        line = errors[0].strip() if errors else "it said nothing"
        raise BenchError(f"{' '.join(map(str, command[:3]))} ended with status {done.returncode}: {line}")
    return done.stdout


def compiler_version(core: str = "cortex-m0plus") -> str:
    return output_of([CORES[core].tool("gcc"), "-dumpfullversion"]).strip()


def qemu_version() -> str:
    found = re.search(r"version ([\d.]+)", output_of(["qemu-system-arm", "--version"]))
    return found.group(1) if found else "unknown"


class Machines:
    """Build trees below `folder`, one per core and number of sub-pixel bits; each is made when it is first needed.
    `source` is this folder's parent, or that of another revision."""

    def __init__(self, folder: Path, models: Path | None = None, source: Path = BENCH) -> None:
        """`models` is the folder of the models' headers; without, they are not measured."""
        self.folder = folder
        self.models = models
        self.source = source
        self._configured: dict[str, Path] = {}

    def native(self, program: str, keep: Path | None = None, bits: int = 4) -> list[Line]:
        """The program's measurements on this computer; `keep` gets the files that it leaves."""
        path = self.build("native", program, bits)
        arguments: list[str | Path] = [path]
        if keep is not None:
            keep.mkdir(parents=True, exist_ok=True)
            arguments.append(keep)
        return parse_lines(output_of(arguments))

    def simulator(self) -> Path:
        """The simulator, built from the same sources."""
        return self.build("native", "edgeline-sim")

    def target(self, core: str, program: str, bits: int = 4, profile: Path | None = None) -> list[Measured]:
        """The program's measurements on a core, the cost of the markers taken off; `profile` gets the plugin's."""
        return self.run(core, self.build(core, program, bits), profile)

    def run(self, core: str, elf: Path, profile: Path | None = None) -> list[Measured]:
        """The same of a program that is built already."""
        machine = CORES[core]
        self.build("native", "count")
        plugin = self._tree("native", 4) / "libcount.so"
        log, text = elf.with_suffix(".count"), elf.with_suffix(".text")
        markers = ",".join(f"{name}=0x{address:x}" for name, address in marker_addresses(machine, elf).items())
        arguments = f"{markers},out={log}"
        if profile is not None:
            arguments += f",code=0x{machine.code:x},profile={profile}"
        command = [machine.qemu, "-M", *machine.machine, "-kernel", str(elf)]
        command += ["-display", "none", "-monitor", "none", "-serial", "none", "-chardev", f"file,id=text,path={text}"]
        command += ["-semihosting-config", "enable=on,target=native,chardev=text", "-plugin", f"{plugin},{arguments}"]
        output_of(command)
        return pair(parse_lines(text.read_text(encoding="ascii")), log.read_text(encoding="ascii"), core)

    def _tree(self, core: str, bits: int) -> Path:
        return self.folder / (core if bits == 4 else f"{core}-{bits}")

    def build(self, core: str, program: str, bits: int = 4) -> Path:
        """The program, built for a core or "native"."""
        tree = self._tree(core, bits)
        if str(tree) not in self._configured:
            command: list[str | Path] = ["cmake", "-S", self.source, "-B", tree, "-DCMAKE_BUILD_TYPE=Release"]
            command += ["-DCMAKE_C_FLAGS_RELEASE=-O2 -g", f"-DEDGELINE_SUBPIXEL_BITS={bits}"]
            command += [f"-DEDGELINE_BENCH_MODELS={self.models or ''}"]
            if core != "native":
                command += [f"-DCMAKE_TOOLCHAIN_FILE={CORES[core].toolchain}", f"-DEDGELINE_CPU={core}"]
            output_of(command)
            self._configured[str(tree)] = tree
        output_of(["cmake", "--build", tree, "--parallel", str(os.cpu_count() or 1), "--target", program])
        return tree / (program if core == "native" else f"{program}.elf")


def parse_lines(text: str) -> list[Line]:
    """The measurements in a program's output: `WORD ... crc CRC NAME VALUE ...`."""
    lines = []
    for row in text.splitlines():
        words = row.split()
        if "crc" not in words:
            raise BenchError(f"the measuring program says '{row}'")
        at = words.index("crc")
        lines.append(Line(tuple(words[:at]), dict(zip(words[at::2], words[at + 1 :: 2], strict=True))))
    return lines


def marker_addresses(core: Core, elf: Path) -> dict[str, int]:
    """The addresses of bench_next, bench_start and bench_stop."""
    found = {}
    for row in output_of([core.tool("nm"), elf]).splitlines():
        *_, name = row.split()
        if name in ("bench_next", "bench_start", "bench_stop"):
            found[name.removeprefix("bench_")] = int(row.split()[0], 16) & ~1
    if len(found) != 3:
        raise BenchError(f"{elf.name} has no markers; build it anew")
    return found


def count_stretches(log: str) -> list[tuple[int, int]]:
    """For each measurement in a plugin's log: instructions from start to stop, summed, and how many such stretches."""
    sums: list[tuple[int, int]] = []
    started: int | None = None
    for row in log.splitlines():
        name, count = row.split()
        if name == "next":
            sums.append((0, 0))
        elif name == "start":
            started = int(count)
        elif started is None or not sums:
            raise BenchError(f"the count log has '{row}' before a start")
        else:
            total, stretches = sums[-1]
            sums[-1] = (total + int(count) - started, stretches + 1)
            started = None
    return sums


def pair(lines: list[Line], log: str, core: str) -> list[Measured]:
    """Lines and counts of one run. The first measurement is empty: what it counts is in each stretch of the others."""
    sums = count_stretches(log)
    if len(lines) != len(sums) or not lines or lines[0].words[0] != "empty":
        raise BenchError(f"{core}: {len(lines)} lines printed, {len(sums)} measurements counted")
    overhead, _ = sums[0]
    return [
        Measured(line, total - overhead * stretches)
        for line, (total, stretches) in zip(lines[1:], sums[1:], strict=True)
    ]
