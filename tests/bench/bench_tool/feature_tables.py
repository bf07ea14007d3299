"""What features cost, as Markdown: results/features.md, and what --features prints."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from .features import FAST, OPTIONS, PARTS, SCENES, SMALL
from .machines import CORES, MAIN_CORES
from .tables import markdown, put_between


def _more(count: int) -> str:
    return f"{count:+,}" if count else "0"


def options(found: Mapping[str, Any]) -> str:
    """Bytes that an option adds, of code and of RAM."""
    rows = []
    for option in OPTIONS:
        cells = []
        for build in (SMALL, FAST):
            pair = found["options"][option.name][build]
            cells += [_more(pair["with"][kind] - pair["without"][kind]) for kind in ("code", "renderer", "arena")]
            cells[-3] += "" if pair["on"] else ", off"
        rows.append([f"`{option.name}`", option.title, *cells])
    defaults = [found["defaults"][build][kind] for build in (SMALL, FAST) for kind in ("code", "renderer", "arena")]
    rows.append(["in all", "what is on", *(f"{size:,}" for size in defaults)])
    head = ["option", "what", "code, M0+ -Os", "renderer", "arena", "code, M4F -O2", "renderer", "arena"]
    return markdown(head, rows, words=2)


def unused(found: Mapping[str, Any], core: str) -> str:
    """Instructions that scenes take more with an option that they do not use."""
    rows = []
    for option in OPTIONS:
        cells = []
        for scene in SCENES:
            more = found["unused"][option.name][core].get(scene)
            used = scene in option.used_by or more is None
            cells.append("used" if used else " / ".join(_more(more[part]) for part in PARTS))
        rows.append([f"`{option.name}`", *cells])
    return markdown(["option", *SCENES], rows)


def gains(found: Mapping[str, Any]) -> str:
    """What the options bring that all scenes use."""
    rows = [
        [
            f"`{option.name}`",
            CORES[core].title,
            *(_more(sum(found["unused"][option.name][core][scene].values())) for scene in SCENES),
        ]
        for option in OPTIONS
        if option.used_by == SCENES
        for core in MAIN_CORES
    ]
    return markdown(["option", "core", *SCENES], rows, words=2)


def small_code(found: Mapping[str, Any]) -> str:
    """What -Os takes, against -O2."""
    rows = [
        [
            CORES[core].title,
            *(f"{small / 1e6:.2f} (x {small / fast:.2f})" for fast, small in found["small"][core].values()),
        ]
        for core in MAIN_CORES
    ]
    return markdown(["core", *SCENES], rows)


def modules(found: Mapping[str, Any]) -> str:
    """Bytes of what is linked where it is called, and of the memory that features are given."""
    rows = [[name, *(f"{sizes[build]:,}" for build in (SMALL, FAST))] for name, sizes in found["modules"].items()]
    return markdown(["module", "M0+ -Os", "M4F -O2"], rows)


def memory(found: Mapping[str, Any]) -> str:
    return markdown(["feature", "bytes"], [[name, f"{size:,}"] for name, size in found["memory"].items()])


def uses(found: Mapping[str, Any]) -> str:
    """What a scene takes with one thing more."""
    plain = {use["name"]: use["instructions"] for use in found["uses"] if use["name"] == use["plain"]}
    rows = []
    for use in found["uses"]:
        cells = []
        for core in MAIN_CORES:
            count, before = use["instructions"][core], plain[use["plain"]][core]
            cells.append(f"{count / 1e6:.2f}")
            if use["name"] == use["plain"]:
                cells += ["", ""]
            else:
                cells += [f"x {count / before:.2f}", f"{(count - before) / use['count']:,.1f}"]
        rows.append([use["name"], f"{use['count']:,} {use['unit']}", *cells])
    titles = [CORES[core].title for core in MAIN_CORES]
    return markdown(
        ["use", "of", *(f"{title}{part}" for title in titles for part in (", M", "", ", each"))], rows, words=2
    )


def document(found: Mapping[str, Any], command: str) -> str:
    """All of them."""
    parts = [
        "# What features cost, used and not used",
        f"Made by `{command}`; do not edit.",
        "## Options of base/options.h",
        "Bytes that each adds to the renderer: of code, of `el_renderer`, and of an arena for 320x240 in bands of 8 "
        "lines, 1,000 vertices, 1,000 triangles and 10 draw calls. `off`: not there unless it is asked for.",
        options(found),
        "## Not used",
        "Instructions per frame that a scene takes more with an option compiled in that it does not use, exact: in "
        f"{', '.join(PARTS)} (vertices among the triangles). One in the loop over another's pixels would be "
        f"{found['drawn']['S1']['pixels']:,} in S1 and {found['drawn']['S2']['pixels']:,} in S2.",
        *(f"{CORES[core].title}:\n\n{unused(found, core)}" for core in MAIN_CORES),
        "## Used by all scenes",
        "Instructions per frame with and without: what is below 0 is gained.",
        gains(found),
        "## Small code",
        "Million instructions of what -Os makes, and how many times those of -O2 that is.",
        small_code(found),
        "## Linked where it is called",
        "Bytes of code; there are none in programs that do not call them.",
        modules(found),
        "## Memory of their users",
        "Bytes, at 320x240 in bands of 8 lines.",
        memory(found),
        "## Used",
        "Million instructions of a scene with one thing more, how many times the scene without that is, and how many "
        "instructions more each unit takes.",
        uses(found),
    ]
    return "\n\n".join(parts) + "\n"


def embed(text: str, found: Mapping[str, Any]) -> str:
    """A document with its tables "<!-- features: NAME -->" as measured."""
    tables: dict[str, Callable[[], str]] = {
        "bytes": lambda: options(found),
        "gains": lambda: gains(found),
        "small": lambda: small_code(found),
        "modules": lambda: modules(found),
        "memory": lambda: memory(found),
        "uses": lambda: uses(found),
        **{f"unused-{core}": partial(unused, found, core) for core in MAIN_CORES},
    }
    return put_between(text, "features", tables)
