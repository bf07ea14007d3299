"""The stack that budgets count with is enough for the deepest chain of calls, as the compiler's call graph has it.

gcc writes the frame of each function and who calls whom (-fcallgraph-info). The code has no recursion and no arrays of
variable length, so the deepest chain is a figure. Calls through pointers end in a sink of a panel driver or of the
stream, below that in the queue of the stream, and below that in a board's functions, which are not counted; those of
el_workers are a board's wherever they are called.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import pytest

import make_budget
from edgeline.budget_facts import EL_BUDGET_STACK_BYTES, EL_BUDGET_WORKERS_STACK_BYTES
from needs import missing

LAYERS = ("base", "geometry", "raster", "frame", "panel", "stream")
CORES = {
    "cortex-m0plus": ("-mcpu=cortex-m0plus",),
    "cortex-m4f": ("-mcpu=cortex-m4", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard"),
}
ENTRIES = ("el_init", "el_frame_begin", "el_draw", "el_frame_next", "el_stream_poll", "el_tft_init", "el_ssd1306_init")
JOBS = ("draw_parts.c:draw_part", "vertices.c:transform_part", "workers.c:draw_groups")
"""What el_workers has other cores call."""
EDGE = re.compile(r'edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)"(?: label: "(.+):(\d+):)?')
"""A call; those into gcc's library have no place."""
INDIRECT = "__indirect_call"
POINTED_AT = (r"/(panel|stream)/\w+\.c:(begin|rows|end|wait)$", r"^el_stream_drain$")
"""By level: what a call through a pointer may reach."""
BOARD_S_OWN = re.compile(r"\bworkers->(start|take|wait|pause)\(")
"""What a line has that calls a function of el_workers."""
LIBRARY_BYTES = 96
"""Of any function of gcc's library. The deepest that is called divides signed 64 bits, on Cortex-M0+: __aeabi_ldivmod
pushes 16, __gnu_ldivmod_helper 32, __divdi3 40, __clzdi2 8."""


def _line(path: str, number: int) -> str:
    return Path(path).read_text(encoding="utf-8").splitlines()[number - 1]


@dataclass
class Graph:
    """Frames in bytes and calls, by the compiler's names: those of static functions have their file in front."""

    frames: dict[str, int] = field(default_factory=dict)
    calls: dict[str, set[str]] = field(default_factory=dict)

    def read(self, text: str) -> None:
        """Adds what one .ci file says."""
        for line in text.splitlines():
            if node := re.match(r'node: \{ title: "([^"]+)" label: "[^"]*\\n(\d+) bytes \(([^)]*)\)', line):
                assert node[3] == "static", f"{node[1]} has a frame that is not known before it runs"
                self.frames[node[1]] = int(node[2])
            elif edge := EDGE.match(line):
                caller, called, path, number = edge.groups()
                if called != INDIRECT or not BOARD_S_OWN.search(_line(path, int(number))):
                    self.calls.setdefault(caller, set()).add(called)

    def named(self, entry: str) -> list[str]:
        """The whole names of a function, which the compiler may have cloned."""
        found = [name for name in self.frames if re.search(rf"(^|/){re.escape(entry)}(\.|$)", name)]
        assert found, f"no function {entry}"
        return found

    def deepest(self, entry: str) -> tuple[int, list[str]]:
        """Bytes of the deepest chain that begins with `entry`, and its functions."""
        return self._below(entry, 0, ())

    def _below(self, name: str, level: int, above: tuple[str, ...]) -> tuple[int, list[str]]:
        assert name not in above, f"{name} calls itself: {above}"
        if name == INDIRECT:
            if level == len(POINTED_AT):
                return 0, []
            reached = [one for one in self.frames if re.search(POINTED_AT[level], one)]
            assert reached, POINTED_AT[level]
            # What is pointed at may well be above: another sink of the same name.
            return max(self._below(one, level + 1, ()) for one in reached)
        if name not in self.frames:
            return LIBRARY_BYTES, [name]
        rest = [self._below(one, level, (*above, name)) for one in self.calls.get(name, ())]
        bytes_below, chain = max(rest, default=(0, []))
        return self.frames[name] + bytes_below, [name.rpartition("/")[2], *chain]


def graph_of(sources: list[Path], core: str, flags: tuple[str, ...], folder: Path) -> Graph:
    compiler = make_budget.TARGETS[32].compiler[0]
    if shutil.which(compiler) is None:
        missing(f"{compiler} is not installed")
    subprocess.run(
        [
            *(compiler, *CORES[core], "-mthumb", *flags, "-std=c11", "-ffreestanding", "-fcallgraph-info=su"),
            *(f"-I{make_budget.ROOT / 'firmware/src'}", "-c", *map(str, sources)),
        ],
        cwd=folder,
        check=True,
        timeout=300,
    )
    graph = Graph()
    for path in sorted(folder.glob("*.ci")):
        graph.read(path.read_text(encoding="utf-8"))
    return graph


def check_depth(core: str, flags: tuple[str, ...], entries: Sequence[str], limit: int, folder: Path) -> None:
    sources = [one for layer in LAYERS for one in sorted((make_budget.ROOT / "firmware/src" / layer).glob("*.c"))]
    graph = graph_of(sources, core, flags, folder)
    depth, chain = max(graph.deepest(one) for entry in entries for one in graph.named(entry))
    assert depth <= limit, f"{depth} bytes: {' > '.join(chain)}"


@pytest.mark.parametrize("optimisation", ["-O2", "-Os"])
@pytest.mark.parametrize("core", CORES)
def test_the_deepest_chain_fits(core: str, optimisation: str, tmp_path: Path) -> None:
    check_depth(core, (optimisation, "-DEL_WITH_WORKERS=0"), ENTRIES, EL_BUDGET_STACK_BYTES, tmp_path)


@pytest.mark.parametrize("core", CORES)
def test_with_other_cores_the_deepest_chain_fits(core: str, tmp_path: Path) -> None:
    limit = EL_BUDGET_STACK_BYTES + EL_BUDGET_WORKERS_STACK_BYTES
    check_depth(core, ("-O2", "-DEL_WITH_WORKERS=1"), ENTRIES, limit, tmp_path)


@pytest.mark.parametrize("core", CORES)
def test_another_core_s_deepest_chain_fits(core: str, tmp_path: Path) -> None:
    check_depth(core, ("-O2", "-DEL_WITH_WORKERS=1"), JOBS, EL_BUDGET_STACK_BYTES, tmp_path)


def test_a_chain_that_is_too_deep_is_seen(tmp_path: Path) -> None:
    source = tmp_path / "deep.c"
    source.write_text(
        "void sink(char *);\n"
        "static __attribute__((noinline)) void below(void) { char room[1500]; sink(room); sink(room); }\n"
        "void el_draw(void) { char room[500]; sink(room); below(); sink(room); }\n",
        encoding="utf-8",
    )
    depth, chain = graph_of([source], "cortex-m0plus", ("-O2",), tmp_path).deepest("el_draw")
    assert EL_BUDGET_STACK_BYTES < depth < EL_BUDGET_STACK_BYTES + 200
    assert chain == ["el_draw", "deep.c:below", "sink"]


def test_recursion_is_seen(tmp_path: Path) -> None:
    source = tmp_path / "endless.c"
    source.write_text("void g(void);\nvoid el_draw(void) { g(); el_draw(); g(); }\n", encoding="utf-8")
    graph = graph_of([source], "cortex-m0plus", ("-O1",), tmp_path)
    with pytest.raises(AssertionError, match="calls itself"):
        graph.deepest("el_draw")
