"""What a program needs of RAM and of its display's wire, and what fits a given RAM.

RAM is computed with the firmware's own macros and the struct sizes of 32-bit microcontrollers (budget_facts.py, made
from the C headers), the wire from the bytes that each panel's driver sends. Tests compare both with the C code.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

from edgeline import budget_facts as facts
from edgeline.errors import EdgelineError

MICROCONTROLLER_BITS = 32


@dataclass(frozen=True)
class Panel:
    """Glass, upright, and how its controller keeps pixels: 16 bits each, or several in a byte."""

    columns: int
    rows: int
    bits: int
    driver: str
    window_bytes: int
    """Commands and their parameters that the driver sends with each frame."""
    packs_columns: bool = False
    """Pixels that share a byte are of one column, not of one row."""
    buffer_bytes: Callable[[int], int] = lambda band: 0
    """The driver's own memory, for bands of that many lines."""

    def is_upright(self, width: int, height: int) -> bool | None:
        """Whether a picture of that size is upright on the glass, or else on its side; None where it does not fit."""
        if width <= self.columns and height <= self.rows:
            return True
        return False if width <= self.rows and height <= self.columns else None

    def pixel_bytes(self, width: int, height: int) -> int:
        """Bytes of a picture that fits, on the wire. A byte at the picture's edge may be filled in part."""
        if self.bits == 16:
            return 2 * width * height
        packed = 8 // self.bits
        if self.packs_columns == self.is_upright(width, height):
            return width * -(-height // packed)
        return -(-width // packed) * height


def _tft(columns: int, rows: int) -> Panel:
    # Column address and row address, each a command and four bytes, and memory write.
    return Panel(columns, rows, 16, "el_tft", 11)


PANELS = {
    "ili9341": _tft(240, 320),
    "st7789": _tft(240, 320),
    "st7789-240x240": _tft(240, 240),
    "st7735": _tft(128, 160),
    # Column and row range, each a command and two bytes.
    "ssd1306": Panel(128, 64, 1, "el_oled", 6, packs_columns=True, buffer_bytes=facts.el_ssd1306_memory_bytes),
    "ssd0323": Panel(128, 64, 4, "el_oled", 6, buffer_bytes=facts.el_ssd0323_memory_bytes),
}


@dataclass(frozen=True)
class Wish:
    """What is to be drawn on what. `triangles` are those of one pass; a frame with more takes several."""

    panel: str
    width: int
    height: int
    band: int = 8
    vertices: int = 600
    triangles: int = 1000
    draws: int = 4
    shading: str = "textured"
    samples: int = 1
    stream: bool = False

    def check(self) -> None:
        """Raises EdgelineError when no renderer and panel can do that."""
        panel = PANELS[self.panel]
        if panel.is_upright(self.width, self.height) is None:
            raise EdgelineError(
                f"--size: {self.width}x{self.height} pixels are more than {self.panel} has: "
                f"{panel.columns}x{panel.rows}, or {panel.rows}x{panel.columns} on its side"
            )
        if self.band > self.height:
            raise EdgelineError(f"--band: {self.band} lines are more than the picture's {self.height}")


@dataclass(frozen=True)
class Account:
    """Bytes of RAM by part, those of the arena first, and what goes over the display's wire for a frame."""

    ram: dict[str, int]
    arena: int
    pixel_bytes: int
    command_bytes: int

    @property
    def total(self) -> int:
        return sum(self.ram.values())

    @property
    def wire_bytes(self) -> int:
        return self.pixel_bytes + self.command_bytes


def account(wish: Wish, pointer_bits: int = MICROCONTROLLER_BITS) -> Account:
    """RAM and wire of a wish that passes its check."""
    panel = PANELS[wish.panel]
    structs = facts.STRUCT_BYTES[pointer_bits]
    size = (wish.width, wish.height)
    textured = wish.shading == "textured"
    triangle_bytes = facts.EL_TEXTURED_TRIANGLE_BYTES if textured else facts.EL_TRIANGLE_BYTES
    # The macro counts textured triangles, and never gives less than el_init accepts.
    without_samples = max(
        facts.el_min_memory_bytes(*size, wish.band),
        facts.el_memory_bytes(*size, wish.band, wish.vertices, wish.triangles, wish.draws)
        - wish.triangles * (facts.EL_TEXTURED_TRIANGLE_BYTES - triangle_bytes),
    )
    depth = facts.el_depth_band_bytes(wish.width, wish.band)
    parts = {
        "colour_bands": 2 * facts.el_colour_band_bytes(wish.width, wish.band),
        "depth_band": depth,
        "vertices": max(0, facts.el_round_up_8(wish.vertices * facts.EL_VERTEX_BYTES) - depth),
        "bins": facts.el_bin_bytes(wish.height, wish.band),
        "triangles": wish.triangles * triangle_bytes,
    }
    parts["draws"] = without_samples - sum(parts.values())
    parts["samples"] = facts.el_samples_bytes(wish.width, wish.band, wish.samples)
    arena = without_samples + parts["samples"]
    parts["renderer"] = structs["el_renderer"]
    parts["panel_driver"] = structs[panel.driver]
    parts["panel_buffer"] = panel.buffer_bytes(wish.band)
    parts["stream"] = structs["el_stream"] + facts.el_stream_memory_bytes(*size) if wish.stream else 0
    parts["stack"] = facts.EL_BUDGET_STACK_BYTES
    return Account(parts, arena, panel.pixel_bytes(*size), panel.window_bytes)


def array_size(wish: Wish) -> str:
    """The arena's size as a program writes it."""
    size = f"{wish.width}, {wish.height}, {wish.band}"
    if wish.samples > 1:
        samples = f"EL_SAMPLES_BYTES({wish.width}, {wish.band}, {wish.samples})"
        return f"{array_size(replace(wish, samples=1))} + {samples}"
    if account(wish).arena == facts.el_min_memory_bytes(wish.width, wish.height, wish.band):
        return f"EL_MIN_MEMORY_BYTES({size})"
    macro = f"EL_MEMORY_BYTES({size}, {wish.vertices}, {wish.triangles}, {wish.draws})"
    if wish.shading == "textured" or wish.triangles == 0:
        return macro
    return f"{macro} - {wish.triangles} * (EL_TEXTURED_TRIANGLE_BYTES - EL_TRIANGLE_BYTES)"


def copies(wish: Wish) -> list[str]:
    """The arrays of a program that has this budget, in C."""
    lines = [f"static _Alignas(8) uint8_t memory[{array_size(wish)}];"]
    if PANELS[wish.panel].driver == "el_oled":
        lines.append(f"static uint8_t panel_memory[EL_{wish.panel.upper()}_MEMORY_BYTES({wish.band})];")
    if wish.stream:
        lines.append(f"static uint8_t stream_memory[EL_STREAM_MEMORY_BYTES({wish.width}, {wish.height})];")
    return lines


def advice(wish: Wish, ram: int) -> list[str]:
    """What to change of a wish that does not fit; each line is one way.

    All have the same pixels: a display list that is too short for a frame, or for a mesh's vertices, costs passes.
    """

    def first(wishes: Iterable[Wish]) -> Wish | None:
        return next((one for one in wishes if account(one).total <= ram), None)

    ways = []
    lower = first(replace(wish, band=band) for band in range(wish.band - 1, 0, -1))
    if lower is not None:
        ways.append(f"--band {lower.band} fits: {account(lower).total:,} bytes")
    fewer = first(replace(wish, samples=samples) for samples in (4, 1) if samples < wish.samples)
    if fewer is not None:
        ways.append(f"--samples {fewer.samples} fits: {account(fewer).total:,} bytes; edges are less smooth")
    changes: dict[str, Wish] = {"": wish}
    if lower is None:
        changes["--band 1 "] = replace(wish, band=1)
        changes["--band 1 --vertices 0 "] = replace(wish, band=1, vertices=0)
    for change, changed in changes.items():
        shorter = _most_triangles(changed, ram)
        if shorter is not None:
            total = account(shorter).total
            ways.append(f"{change}--triangles {shorter.triangles} fits: {total:,} bytes; more take more passes")
            break
    if not ways:
        least = account(replace(wish, band=1, triangles=0, vertices=0, draws=0, samples=1)).total
        alone = " --samples 1" if wish.samples > 1 else ""
        smallest = f"--band 1 --triangles 0 --vertices 0 --draws 0{alone} takes {least:,} bytes"
        ways.append(f"{smallest}, and many passes" if least <= ram else f"nothing does: {smallest}")
    return ways


def _most_triangles(wish: Wish, ram: int) -> Wish | None:
    """The wish with as many triangles as fit, 1 at least and no more than it has; None where not one fits."""
    fits, too_many = 0, wish.triangles + 1
    while too_many - fits > 1:
        middle = (fits + too_many) // 2
        if account(replace(wish, triangles=middle)).total <= ram:
            fits = middle
        else:
            too_many = middle
    return replace(wish, triangles=fits) if fits else None
