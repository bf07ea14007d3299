"""What was measured, as Markdown: results/scenes.md, and what --scenes prints."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence

from .frames import FIXED_PARTS, PEERS, TARGETS, Frame
from .machines import CORES, MAIN_CORES, ROOT, BenchError
from .size import RENDERER
from .stages import STAGES

# They carry tables between lines "<!-- bench: NAME -->" and "<!-- bench end -->", which embed() keeps as measured.
DOCUMENTS = (ROOT / "README.md", ROOT / "firmware" / "DESIGN.md")

USUAL_UV = 3
LARGE_ARENA = 130 * 1024


def markdown(head: Sequence[str], rows: Iterable[Sequence[str]], words: int = 1) -> str:
    """A table, whose first columns are `words`, the others figures."""
    aligned = "|".join(["---"] * words + ["---:"] * (len(head) - words))
    lines = [f"| {' | '.join(head)} |", f"|{aligned}|", *(f"| {' | '.join(row)} |" for row in rows)]
    return "\n".join(lines)


def _millions(count: float) -> str:
    return f"{count / 1e6:.2f}" if count >= 5000 else f"{count / 1e6:.3f}"


def _name(frame: Frame) -> str:
    return f"{frame.scene}, {frame.number}" if frame.number else frame.scene


def usual(frames: Iterable[Frame]) -> list[Frame]:
    """Those with the default texture error and 4 sub-pixel bits."""
    return [frame for frame in frames if frame.uv_error_log2 == USUAL_UV and frame.subpixel_bits == 4]


def instructions(frames: Sequence[Frame]) -> str:
    """Million instructions per frame on each core."""
    cores = [core for core in CORES if core in frames[0].instructions]
    head = ["scene, frame", "arena", "passes", "RAM used", *(CORES[core].title for core in cores), "this computer"]
    rows = [
        [
            *(_name(frame), f"{frame.arena_bytes // 1024} KB", str(frame.passes), f"{frame.memory_peak / 1024:.1f} KB"),
            *(_millions(frame.instructions[core]) for core in cores),
            f"{frame.native_us / 1000:.2f} ms",
        ]
        for frame in usual(frames)
    ]
    return markdown(head, rows)


def against_peers(frames: Sequence[Frame]) -> str:
    """The standard scenes: million instructions, the best peer's, the target."""
    rows = []
    for frame in usual(frames):
        for core, peers in PEERS.items():
            if frame.scene not in peers or core not in frame.instructions or frame.arena_bytes != LARGE_ARENA:
                continue
            count = frame.instructions[core] / 1e6
            peer, name = peers[frame.scene]
            target = TARGETS.get(core, {}).get(frame.scene)
            wanted = [f"{target:.2f}", f"x {count / target:.2f}"] if target else ["", ""]
            rows.append(
                [frame.scene, CORES[core].title, f"{count:.2f}", f"{peer:.2f} ({name})", f"x {count / peer:.2f}"]
            )
            rows[-1] += wanted
    return markdown(["scene", "core", "million", "best peer", "of it", "target", "of it"], rows)


def by_stage(frames: Sequence[Frame]) -> str:
    """Million instructions of each stage, first frames in the large arena, on the main cores."""
    rows = []
    for frame in usual(frames):
        if frame.number != 0 or frame.arena_bytes != LARGE_ARENA:
            continue
        for core in MAIN_CORES:
            if core in frame.stages:
                parts = frame.stages[core]
                rows.append([frame.scene, CORES[core].title, *(_millions(parts[stage]) for stage in STAGES)])
    return markdown(["scene", "core", *STAGES], rows)


def memory(frames: Sequence[Frame]) -> str:
    """Bytes of the arena by part."""
    parts = ("two colour bands", "depth band", "bins", "list", "vertices beside it", "then states beside it")
    rows = [
        [
            *(frame.scene, f"{frame.arena_bytes // 1024} KB"),
            *(f"{frame.ram[part]:,}" for part in FIXED_PARTS),
            f"{frame.ram['vertices']:,}",
            f"{frame.ram['states']:,}" if frame.ram["states"] else "no more",
            f"{frame.memory_peak:,}",
        ]
        for frame in usual(frames)
        if frame.number == 0
    ]
    return markdown(["scene", "arena", *parts, "in all"], rows)


def exactness(frames: Sequence[Frame]) -> str:
    """Million instructions with other texture errors and other sub-pixel bits."""
    chosen = [frame for frame in frames if frame not in usual(frames)]
    head = ["scene, frame", "arena", "texture error", "bits", *(CORES[core].title for core in MAIN_CORES)]
    rows = [
        [
            *(_name(frame), f"{frame.arena_bytes // 1024} KB", f"1/{1 << frame.uv_error_log2}"),
            str(frame.subpixel_bits),
            *(_millions(frame.instructions[core]) for core in MAIN_CORES),
        ]
        for frame in chosen
    ]
    return markdown(head, rows)


def code(sizes: Mapping[str, Mapping[str, int]]) -> str:
    """Bytes of code by layer."""
    layers = (*RENDERER, "libgcc")
    rows = [
        [
            CORES[core].title,
            *(f"{sum(size for file, size in found.items() if file.startswith(layer)):,}" for layer in layers),
            f"{sum(found.values()):,}",
        ]
        for core, found in sizes.items()
    ]
    return markdown(["core", *layers, "in all"], rows)


def document(frames: Sequence[Frame], sizes: Mapping[str, Mapping[str, int]], command: str) -> str:
    """All of them."""
    parts = [
        "# What frames cost",
        f"Made by `{command}`; do not edit. Scenes of 320x240 in bands of 8 lines; million executed instructions, "
        "exact, in QEMU, of code that is compiled with -O2 for each core (a Cortex-M0+'s runs on an emulated "
        "Cortex-M3). `-again` is the second of two equal frames; `-4x` and `-8x` have so many samples per pixel, "
        "`-hud` a HUD over them; `layers` and `sheets` are ten layers over the whole screen, flat and textured; models "
        "are those of shared/models.",
        instructions(frames),
        "## Standard scenes, the best peers, and what is to be reached",
        against_peers(frames),
        "## By stage",
        "Million instructions. What several stages call (divisions, memcpy) is divided among them by how often each "
        "calls it. `bin` is culling and the display list, `rows` edges and spans, `sink` clearing and handing over.",
        by_stage(frames),
        "## Memory",
        "Bytes of the arena in its largest use. Beside the list lie vertices while triangles are collected, as far as "
        "the depth band has no room for them, and states of triangles while they are drawn: the larger one counts.",
        memory(frames),
        "## Other texture errors and sub-pixel bits",
        exactness(frames),
        "## Bytes of code",
        "The renderer with all options, -O2, as the benchmark links it; `code_size.json` has smaller ones.",
        code(sizes),
    ]
    return "\n\n".join(parts) + "\n"


def embed(text: str, frames: Sequence[Frame], sizes: Mapping[str, Mapping[str, int]]) -> str:
    """A document with its tables as measured."""
    tables = {
        "instructions": lambda: instructions(frames),
        "peers": lambda: against_peers(frames),
        "stages": lambda: by_stage(frames),
        "memory": lambda: memory(frames),
        "exactness": lambda: exactness(frames),
        "code": lambda: code(sizes),
    }
    return put_between(text, "bench", tables)


def put_between(text: str, mark: str, tables: Mapping[str, Callable[[], str]]) -> str:
    """A document with the tables between its lines "<!-- MARK: NAME -->" and "<!-- MARK end -->"."""

    def table(found: re.Match[str]) -> str:
        if found[1] not in tables:
            raise BenchError(f"a document asks for the table '{found[1]}'; there are {', '.join(tables)}")
        return f"<!-- {mark}: {found[1]} -->\n{tables[found[1]]()}\n<!-- {mark} end -->"

    return re.sub(rf"<!-- {mark}: (\S+) -->\n.*?<!-- {mark} end -->", table, text, flags=re.DOTALL)
