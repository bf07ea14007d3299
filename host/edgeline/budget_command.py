"""`edgeline budget`: what a program needs, before the parts are bought.

    edgeline budget --panel ili9341 --spi 62.5M --cpu 125M --band 8 --triangles 1000

Exit status 0, also when the RAM that was named is too little: lines say so and what would fit.
"""

from __future__ import annotations

import argparse
import json
import re
from collections.abc import Callable
from fractions import Fraction
from typing import TYPE_CHECKING

from edgeline import budget_facts as facts
from edgeline.budget import MICROCONTROLLER_BITS, PANELS, Account, Wish, account, advice, copies

if TYPE_CHECKING:
    SubParsers = argparse._SubParsersAction[argparse.ArgumentParser]

CORES = tuple(facts.FRAMES["S1"][1])
SHADINGS = ("flat", "gouraud", "textured")
SLOW_BYTE_CLOCKS = Fraction(17, 2)
"""Clocks per byte that are reported of an RP2040 with DMA in SPI mode 3: there are gaps between words."""
SAMPLED = re.compile(r"-[48]x$")
"""The names of scenes with several samples per pixel."""
UART_BITS = 10
"""Of a byte on a UART, with its start and stop bit."""

ARENA_TITLES = {
    "colour_bands": "two colour bands",
    "depth_band": "depth band",
    "vertices": "vertices, beyond what fits the depth band",
    "bins": "bins of the display list",
    "triangles": "triangles of the display list",
    "draws": "its draws, and slack",
    "samples": "{samples} samples per pixel of a band",
}
OTHER_TITLES = {
    "renderer": "el_renderer",
    "panel_driver": "{driver}, the panel's driver",
    "panel_buffer": "the driver's memory",
    "stream": "el_stream and its memory",
    "stack": "stack below el_draw, as measured",
}


def wire_seconds(wire_bytes: int, spi_hz: int, byte_clocks: Fraction = Fraction(8)) -> Fraction:
    """The time that a frame takes on the wire."""
    return wire_bytes * byte_clocks / spi_hz


def stream_seconds(wish: Wish, baud: int) -> float:
    """The time that the pixels of a frame take on a UART when nothing makes them fewer."""
    return 2 * wish.width * wish.height * UART_BITS / baud


def code_bytes(wish: Wish) -> int | None:
    """Flash of renderer, panel driver, stream and libc, for that shading; None where it was not measured."""
    if not facts.CODE_OPTIONS:
        return None
    renderer = facts.CODE_OPTIONS.get(wish.shading, facts.CODE_OPTIONS["all"])
    return renderer + _panel_code(wish.panel) + (facts.CODE_STREAM if wish.stream else 0) + facts.CODE_LIBC


def _panel_code(panel: str) -> int:
    """Panels of one controller share its driver's figure."""
    return facts.CODE_PANELS.get(panel, facts.CODE_PANELS.get(panel.partition("-")[0], 0))


def report(options: argparse.Namespace, wish: Wish) -> dict[str, object]:
    """Everything, as --json prints it."""
    found = account(wish)
    wire: dict[str, object] = {"pixel_bytes": found.pixel_bytes, "command_bytes": found.command_bytes}
    if options.spi is not None:
        seconds = wire_seconds(found.wire_bytes, options.spi)
        slow = wire_seconds(found.wire_bytes, options.spi, SLOW_BYTE_CLOCKS)
        wire |= {"frame_ms": float(seconds * 1000), "frames_per_second": float(1 / seconds)}
        wire |= {"frame_ms_at_8.5_clocks": float(slow * 1000), "frames_per_second_at_8.5_clocks": float(1 / slow)}
        if options.cpu is not None:
            wire["cpu_cycles"] = int(seconds * options.cpu)
    result: dict[str, object] = {
        "panel": wish.panel,
        "width": wish.width,
        "height": wish.height,
        "band": wish.band,
        "samples": wish.samples,
        "pointer_bits": MICROCONTROLLER_BITS,
        "ram": found.ram,
        "arena": found.arena,
        "arrays": copies(wish),
        "total": found.total,
        "wire": wire,
        "instructions": {
            "source": facts.FRAMES_SOURCE,
            "core": options.core,
            "frames": {scene: counts[options.core] for scene, (_, counts) in facts.FRAMES.items()},
        },
        "code": {
            "source": facts.CODE_SOURCE,
            "options": facts.CODE_OPTIONS,
            "panel": _panel_code(wish.panel),
            "stream": facts.CODE_STREAM,
            "libc": facts.CODE_LIBC,
        },
    }
    if wish.stream:
        result["stream_seconds_of_raw_frame"] = stream_seconds(wish, options.baud)
    if options.ram is not None:
        result["fits_ram"] = found.total <= options.ram
        result["advice"] = [] if found.total <= options.ram else advice(wish, options.ram)
    if options.flash is not None:
        code = code_bytes(wish)
        result["fits_flash"] = None if code is None else code <= options.flash
    return result


def _row(title: str, count: int) -> str:
    return f"  {title:<44}{count:>12,}"


def _ram_lines(options: argparse.Namespace, wish: Wish, found: Account) -> list[str]:
    lines = ["RAM in bytes, of a 32-bit microcontroller"]
    lines += [
        _row(title.format(samples=wish.samples), found.ram[key])
        for key, title in ARENA_TITLES.items()
        if found.ram[key]
    ]
    lines.append(_row("arena", found.arena))
    driver = PANELS[wish.panel].driver
    lines += [
        _row(title.format(driver=driver), found.ram[key]) for key, title in OTHER_TITLES.items() if found.ram[key]
    ]
    lines.append(_row("in all", found.total))
    fixed = ("colour_bands", "depth_band", "bins", "samples")
    if found.arena - sum(found.ram[key] for key in fixed) > facts.EL_LIST_MAX_BYTES:
        lines.append(f"  a display list uses {facts.EL_LIST_MAX_BYTES:,} bytes at most; what is more stays unused")
    if options.ram is not None:
        spare = options.ram - found.total
        if spare >= 0:
            lines.append(f"  fits {options.ram:,} bytes, and leaves {spare:,} to the program")
        else:
            lines.append(f"  does not fit {options.ram:,} bytes: {-spare:,} too many")
            lines += [f"  {way}" for way in advice(wish, options.ram)]
    return lines


def _wire_lines(options: argparse.Namespace, wish: Wish, found: Account) -> list[str]:
    bits = PANELS[wish.panel].bits
    lines = [
        f"The display's wire, {bits} bit{'s' if bits > 1 else ''} per pixel",
        f"  a frame: {found.pixel_bytes:,} bytes of pixels, {found.command_bytes} of commands",
    ]
    if options.spi is None:
        return [*lines, "  give --spi for its time"]
    for clocks, remark in ((Fraction(8), ""), (SLOW_BYTE_CLOCKS, ", as with an RP2040's DMA in SPI mode 3")):
        seconds = wire_seconds(found.wire_bytes, options.spi, clocks)
        lines.append(
            f"  {float(seconds * 1000):.2f} ms, at most {float(1 / seconds):.1f} frames/s at {float(clocks):g} clocks "
            f"per byte{remark}"
        )
    if options.cpu is not None:
        cycles = int(wire_seconds(found.wire_bytes, options.spi) * options.cpu)
        lines.append(f"  meanwhile, with DMA, the CPU has {cycles:,} cycles to draw the next frame")
    return lines


def _stream_lines(options: argparse.Namespace, wish: Wish) -> list[str]:
    if not wish.stream:
        return []
    return [
        f"Stream, {options.baud:,} baud",
        f"  {stream_seconds(wish, options.baud):.2f} s for a frame of noise; runs and unchanged lines shorten it",
    ]


def _frame_lines(options: argparse.Namespace) -> list[str]:
    return [
        f"Instructions for a frame of 320x240 on {options.core}, as measured; each takes a cycle or more",
        *(
            f"  {counts[options.core]:>12,}  {scene}: {summary}"
            for scene, (summary, counts) in facts.FRAMES.items()
            if options.samples > 1 or not SAMPLED.search(scene)
        ),
        f"  ({facts.FRAMES_SOURCE})",
    ]


def _code_lines(options: argparse.Namespace, wish: Wish) -> list[str]:
    total = code_bytes(wish)
    if total is None:
        lines = ["Code: not measured yet"]
        return lines if options.flash is None else [*lines, f"  so whether it fits {options.flash:,} is not known"]
    lines = [f"Code in bytes ({facts.CODE_SOURCE})"]
    lines += [_row(f"renderer, {name}", count) for name, count in facts.CODE_OPTIONS.items()]
    lines.append(_row(f"driver of {wish.panel}", _panel_code(wish.panel)))
    lines.append(_row("stream", facts.CODE_STREAM))
    lines.append(_row("memcpy, memmove, memset", facts.CODE_LIBC))
    if options.flash is not None:
        spare = options.flash - total
        verdict = f"fits {options.flash:,}, and leaves" if spare >= 0 else f"does not fit {options.flash:,}:"
        lines.append(f"  {wish.shading}: {total:,} bytes; {verdict} {abs(spare):,}{'' if spare >= 0 else ' too many'}")
    return lines


def _print(options: argparse.Namespace, wish: Wish) -> None:
    found = account(wish)
    lines = "1 line" if wish.band == 1 else f"{wish.band} lines"
    print(
        f"{wish.panel}, picture of {wish.width}x{wish.height}, bands of {lines}; a pass of {wish.triangles:,} "
        f"{wish.shading} triangles, meshes of {wish.vertices:,} vertices at most, {wish.draws} draws"
        + (f"; {wish.samples} samples per pixel" if wish.samples > 1 else "")
    )
    sections = (
        _ram_lines(options, wish, found),
        _wire_lines(options, wish, found),
        _stream_lines(options, wish),
        _frame_lines(options),
        _code_lines(options, wish),
        ["To copy", *(f"  {line}" for line in copies(wish))],
    )
    for section in sections:
        if section:
            print("", *section, sep="\n")


# --- The command line -------------------------------------------------------------------------------------------------


def add_parser(subparsers: SubParsers) -> None:
    """Adds the command to the command line of `edgeline`; the parser's `func` takes the arguments, returns a status."""
    command = subparsers.add_parser(
        "budget",
        help="RAM, wire time and code of a program, before the parts are bought",
        description="Frequencies take k and M for 1,000 and 1,000,000; bytes take K and M for 1,024 and 1,048,576.",
    )
    command.add_argument("--panel", required=True, choices=PANELS, help="the display's controller")
    command.add_argument(
        "--size", type=_size, metavar="WxH", help="of the picture; default: the glass, its long side lying"
    )
    command.add_argument("--spi", type=hertz, metavar="HZ", help="clock of the display's wire, such as 62.5M")
    command.add_argument("--cpu", type=hertz, metavar="HZ", help="clock of the processor, such as 125M")
    command.add_argument("--core", choices=CORES, default=CORES[0], help=f"default: {CORES[0]}")
    command.add_argument(
        "--band", type=_number(1, facts.EL_MAX_HEIGHT), default=8, metavar="N", help="lines; default: 8"
    )
    command.add_argument("--shading", choices=SHADINGS, default="textured", help="default: textured, the most")
    for name, default, most, what in (
        ("triangles", 1000, 65535, "visible triangles that a pass takes"),
        ("vertices", 600, facts.EL_MESH_MAX_VERTICES, "vertices of the largest mesh"),
        ("draws", 4, 65535, "calls of el_draw per frame"),
    ):
        command.add_argument(
            f"--{name}", type=_number(0, most), default=default, metavar="N", help=f"{what}; default: {default}"
        )
    command.add_argument(
        "--samples", type=int, choices=(1, 4, 8), default=1, help="per pixel, for smooth edges; default: 1"
    )
    command.add_argument("--stream", action="store_true", help="count the serial stream too")
    command.add_argument(
        "-b", "--baud", type=_number(1, 10**9), default=115200, metavar="RATE", help="its rate; default: 115200"
    )
    command.add_argument("--ram", type=_bytes, metavar="BYTES", help="what there is, such as 264K")
    command.add_argument("--flash", type=_bytes, metavar="BYTES", help="what there is, such as 2M")
    command.add_argument("--json", action="store_true", help="print the result as JSON")
    command.set_defaults(func=_budget)


def _budget(options: argparse.Namespace) -> int:
    panel = PANELS[options.panel]
    width, height = options.size or (max(panel.columns, panel.rows), min(panel.columns, panel.rows))
    wish = Wish(
        panel=options.panel,
        width=width,
        height=height,
        band=options.band,
        vertices=options.vertices,
        triangles=options.triangles,
        draws=options.draws,
        shading=options.shading,
        samples=options.samples,
        stream=options.stream,
    )
    wish.check()
    if options.json:
        print(json.dumps(report(options, wish), indent=2))
    else:
        _print(options, wish)
    return 0


def _number(least: int, most: int) -> Callable[[str], int]:
    def parse(text: str) -> int:
        if not text.isascii() or not text.isdigit() or not least <= int(text) <= most:
            raise argparse.ArgumentTypeError(f"'{text}' is no whole number from {least} to {most}")
        return int(text)

    return parse


def _size(text: str) -> tuple[int, int]:
    width, _, height = text.partition("x")
    side = _number(1, facts.EL_MAX_WIDTH)
    try:
        return side(width), side(height)
    except argparse.ArgumentTypeError:
        raise argparse.ArgumentTypeError(
            f"'{text}' is not WIDTHxHEIGHT, each 1 to {facts.EL_MAX_WIDTH} pixels"
        ) from None


def _scaled(text: str, units: dict[str, int]) -> int | None:
    """A positive number with a unit, when it is whole then."""
    digits, unit = (text[:-1], text[-1]) if text[-1:] in units else (text, "")
    if not digits.isascii() or not digits.replace(".", "", 1).isdigit():
        return None
    value = Fraction(digits) * units.get(unit, 1)
    return int(value) if value.denominator == 1 and 0 < value < 1 << 40 else None


def hertz(text: str) -> int:
    value = _scaled(text, {"k": 1000, "K": 1000, "M": 1000**2, "G": 1000**3})
    if value is None:
        raise argparse.ArgumentTypeError(f"'{text}' is no frequency in Hz, such as 62500000 or 62.5M")
    return value


def _bytes(text: str) -> int:
    value = _scaled(text, {"k": 1024, "K": 1024, "M": 1024**2})
    if value is None:
        raise argparse.ArgumentTypeError(f"'{text}' is no number of bytes, such as 65536 or 64K")
    return value
