"""Bytes of code: what a program links of the renderer with each set of options, of a panel's driver, of the stream.

Each part is linked as a program that calls what every program calls, with -ffunction-sections and --gc-sections, and
what the linker's map says is counted: .text and .rodata of firmware/src and of libgcc. The C library's memcpy, memmove
and memset, which most programs have anyway, are listed apart and not in the total. What two parts share counts in both.
"""

from __future__ import annotations

import hashlib
import json
import re
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .frames import Verdicts
from .machines import BENCH, ROOT, BenchError, compiler_version, output_of

SOURCES = ROOT / "firmware" / "src"
RESULT = BENCH / "results" / "code_size.json"
COMMAND = "tests/bench/run --record-size"
CPU = "cortex-m0plus"
FLAGS = "-Os"

# Bytes that a part may grow beyond what is recorded before somebody must look and record anew.
TOLERANCE = 0.03

RENDERER = ("base", "geometry", "raster", "frame")

# What programs of the benchmark link besides.
NOT_THE_RENDERER = ("base/crc32.c",)

# What must hold, in bytes.
BUDGETS = {"all": 16 * 1024}

_MODES = ("GOURAUD", "TEXTURE", "DITHER", "OVERDRAW", "LIGHT", "ORTHOGRAPHIC")
_FASTER = ("STATS", "CARRY")

# Sets of options, by what base/options.h leaves out.
OPTIONS: dict[str, tuple[str, ...]] = {
    "all": (),
    **{f"no-{name.lower()}": (name,) for name in (*_MODES, *_FASTER)},
    "gouraud": ("TEXTURE", "DITHER", "OVERDRAW", "ORTHOGRAPHIC"),
    "flat": _MODES,
    "flat-smallest": (*_MODES, *_FASTER),
}

PROGRAM = """#include "edgeline.h"
el_renderer renderer;
el_config config;
el_camera camera;
el_mesh mesh;
el_pose pose;
el_material material;
int start(void);
int start(void)
{
    int status = el_init(&renderer, &config) | el_frame_begin(&renderer, &camera);
    do {
        status |= el_draw(&renderer, &mesh, &pose, &material);
    } while (el_frame_next(&renderer) > 0);
    return status;
}
"""

_PANEL = """#include "panel/{header}.h"
{kind} panel;
{kind}_config config;
el_sink sink;
int start(void);
int start(void)
{{
{model}    sink = {kind}_sink(&panel);
    return {kind}_init(&panel, &config);
}}
"""

_STREAM = """#include "stream/session.h"
#include "stream/sink.h"
el_stream stream;
el_stream_config config;
el_sink sink;
int start(void);
int start(void)
{
    sink = el_stream_sink(&stream);
    const int status = el_stream_init(&stream, &config);
    el_stream_poll(&stream);
    return status;
}
"""


def _panel(header: str, kind: str = "el_tft", model: str = "") -> str:
    return _PANEL.format(header=header, kind=kind, model=f"    config.model = &{model};\n" if model else "")


PANELS = {
    "ili9341": _panel("ili9341", model="el_ili9341"),
    "st7789": _panel("st7789", model="el_st7789"),
    "st7789-240x240": _panel("st7789", model="el_st7789_240x240"),
    "st7735": _panel("st7735", model="el_st7735"),
    "ssd1306": _panel("ssd1306", "el_ssd1306"),
    "ssd0323": _panel("ssd0323", "el_ssd0323"),
}


@dataclass
class Size:
    """Bytes by module, firmware/src's files and libgcc, and of the C library."""

    modules: dict[str, int] = field(default_factory=dict)
    libc: dict[str, int] = field(default_factory=dict)

    @property
    def total(self) -> int:
        return sum(self.modules.values())


def read_map(text: str) -> Size:
    """What a linker's map says. Objects are named LAYER-FILE.o, or as CMake names those of the layers' libraries; other
    objects are the measured program itself."""
    at = text.find("Linker script and memory map")
    if at < 0:
        raise BenchError("the linker's map has no 'Linker script and memory map'; is this GNU ld's?")
    size = Size()
    # Long section names have their figures on the next line.
    rows = re.sub(r"\n (\.\S+)\n +", r"\n \1 ", text[at:])
    for length, place in re.findall(r"\n \.(?:text|rodata)\S* +0x[0-9a-f]+ +0x([0-9a-f]+) (\S+)", rows):
        name = place.rsplit("/", 1)[-1]
        if (own := re.fullmatch(r"(?:libedgeline_)?(\w+)(?:-|\.a\()(\w+)\.(?:c\.obj\)|o)", name)) is not None:
            part, into = f"{own[1]}/{own[2]}.c", size.modules
        elif name.startswith("libgcc.a("):
            part, into = "libgcc", size.modules
        elif name.startswith("libc"):
            part, into = name[name.index("(") + 1 : -1].removeprefix("lib_a-").removesuffix(".o"), size.libc
        else:
            continue
        if int(length, 16) > 0:
            into[part] = into.get(part, 0) + int(length, 16)
    return size


def linked(map_file: Path) -> dict[str, int]:
    """Bytes by module of the renderer in a program that a core's build has linked."""
    modules = read_map(map_file.read_text(encoding="utf-8")).modules
    modules = {name: size for name, size in modules.items() if name.split("/")[0] in (*RENDERER, "libgcc")}
    used = {name: size for name, size in modules.items() if name not in NOT_THE_RENDERER}
    if "raster/list.c" not in used:
        raise BenchError(f"{map_file.name} has no raster/list.c; build it anew")
    return dict(sorted(used.items()))


class Compiler:
    """Compiles and links into a folder of its own. Most options change few files; what they leave as it is after the
    preprocessor is compiled once. `flags`: of the core, and how far to optimise."""

    def __init__(self, folder: Path, flags: Sequence[str] = (f"-mcpu={CPU}", FLAGS)) -> None:
        self.folder = folder
        self.command = ["arm-none-eabi-gcc", "-mthumb", *flags]
        self.command += ["-std=c11", "-ffreestanding", "-ffunction-sections", "-fdata-sections"]
        self._known: dict[tuple[Path, tuple[str, ...]], Path] = {}

    def link(
        self,
        name: str,
        program: str,
        layers: Iterable[str],
        options: Mapping[str, int] | None = None,
        calls: Iterable[str] = (),
    ) -> Size:
        """What the program takes of the layers. `options`: EL_WITH_, by their names in base/options.h; `calls`:
        functions that it is to have besides."""
        folder = self.folder / name
        folder.mkdir()
        source = folder / "program.c"
        source.write_text(program, encoding="ascii")
        elf = folder / "program.elf"
        map_file = folder / "map"
        linker = ["--specs=nano.specs", "-Wl,--entry=start", f"-Wl,-Map={map_file}"]
        linker += [f"-Wl,--require-defined={function}" for function in calls]
        self.program(elf, self.objects(layers, options) | {"program.o": self.compile(source, options)}, linker)
        return read_map(map_file.read_text(encoding="utf-8"))

    def objects(self, layers: Iterable[str], options: Mapping[str, int] | None = None) -> dict[str, Path]:
        """The layers' files, compiled, by the names that read_map knows them by."""
        files = [(layer, file) for layer in layers for file in sorted((SOURCES / layer).glob("*.c"))]
        return {f"{layer}-{file.stem}.o": self.compile(file, options) for layer, file in files}

    def program(self, elf: Path, objects: Mapping[str, Path], linker: Sequence[str]) -> None:
        """Links objects, each by its name in the folder of `elf`."""
        for name, compiled in objects.items():
            (elf.parent / name).symlink_to(compiled)
        names = [elf.parent / name for name in objects]
        output_of([*self.command, "-nostartfiles", "-Wl,--gc-sections", *linker, "-o", elf, *names])

    def compile(self, file: Path, options: Mapping[str, int] | None = None, include: Sequence[Path] = ()) -> Path:
        """The file's object, which is not made again for what the preprocessor makes the same of."""
        flags = [f"-DEL_WITH_{name}={value}" for name, value in (options or {}).items()]
        flags += [f"-I{folder}" for folder in (SOURCES, *include)]
        if (known := self._known.get((file, tuple(flags)))) is not None:
            return known
        text = output_of([*self.command, *flags, "-E", file])
        digest = hashlib.sha256(text.encode()).hexdigest()
        compiled = self.folder / f"{digest}.o"
        if not compiled.is_file():
            with tempfile.TemporaryDirectory(dir=self.folder) as folder:
                preprocessed, made = Path(folder) / "file.i", Path(folder) / "file.o"
                preprocessed.write_text(text, encoding="utf-8")
                output_of([*self.command, "-c", preprocessed, "-o", made])
                # Another thread may have been as fast, with the same result.
                made.replace(compiled)
        self._known[file, tuple(flags)] = compiled
        return compiled


def measure() -> dict[str, Any]:
    """All parts, as code_size.json has them."""
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(2) as pool:
        compiler = Compiler(Path(folder))
        options = {
            name: pool.submit(compiler.link, name, PROGRAM, RENDERER, dict.fromkeys(left_out, 0))
            for name, left_out in OPTIONS.items()
        }
        panels = {
            name: pool.submit(compiler.link, f"panel-{name}", text, ("base", "panel")) for name, text in PANELS.items()
        }
        stream = pool.submit(compiler.link, "stream", _STREAM, ("base", "stream"))
        return {
            "command": COMMAND,
            "compiler": compiler_version(),
            "cpu": CPU,
            "flags": FLAGS,
            "options": {name: _entry(name, one.result()) for name, one in options.items()},
            "panels": {name: one.result().total for name, one in panels.items()},
            "stream": stream.result().total,
        }


def _entry(name: str, size: Size) -> dict[str, Any]:
    return {
        "total": size.total,
        "without": [f"EL_WITH_{option}" for option in OPTIONS[name]],
        "modules": dict(sorted(size.modules.items())),
        "libc": dict(sorted(size.libc.items())),
    }


def _totals(found: Mapping[str, Any]) -> dict[str, int]:
    return {
        **{f"options '{name}'": entry["total"] for name, entry in found["options"].items()},
        **{f"panel {name}": total for name, total in found["panels"].items()},
        "stream": found["stream"],
    }


def check(found: Mapping[str, Any], recorded: Mapping[str, Any], verdicts: Verdicts) -> None:
    """Budgets hold, and nothing has grown. Bytes are compared only with those of the same compiler."""
    for name, budget in BUDGETS.items():
        total = found["options"][name]["total"]
        verdicts.check(total <= budget, f"code size, options '{name}': {total} bytes, the budget is {budget}")
    if found["compiler"] != recorded["compiler"]:
        print(f"code sizes not compared: recorded with gcc {recorded['compiler']}, this is {found['compiler']}")
        return
    known = _totals(recorded)
    for name, total in _totals(found).items():
        if name not in known:
            verdicts.check(False, f"code size of {name} is not recorded; run {COMMAND}")
            continue
        verdicts.check(
            total <= known[name] * (1 + TOLERANCE),
            f"code size of {name}: {total} bytes, recorded are {known[name]} ({total / known[name] - 1:+.1%}, "
            f"{TOLERANCE:.0%} may be); if it is meant, run {COMMAND} and commit tests/bench/results",
        )


def record(found: Mapping[str, Any]) -> None:
    RESULT.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    print(f"wrote {RESULT.relative_to(ROOT)}")


def table(found: Mapping[str, Any]) -> str:
    """A Markdown table: bytes of each set of options, by layer."""
    layers = (*RENDERER, "libgcc")
    lines = [f"| options | total | {' | '.join(layers)} | libc, apart |", "|---" * (len(layers) + 3) + "|"]
    for name, entry in found["options"].items():
        parts = [sum(size for file, size in entry["modules"].items() if file.startswith(layer)) for layer in layers]
        cells = [entry["total"], *parts, sum(entry["libc"].values())]
        lines.append(f"| {name} | {' | '.join(map(str, cells))} |")
    lines += [f"| panel {name} | {total} |" for name, total in found["panels"].items()]
    return "\n".join([*lines, f"| stream | {found['stream']} |"])
