"""What colours mean: a debug view's name and scale, and what is dimmed, over the picture's lower left corner."""

from __future__ import annotations

import tkinter as tk
from dataclasses import dataclass

from edgeline.protocol import DebugView
from edgeline.viewer import theme

HEATS = (0x0000, 0x018C, 0x2957, 0x9015, 0xC012, 0xE810, 0xFA8D, 0xFC0D, 0xFD2E, 0xFE30, 0xFF34, 0xFFFF)
"""RGB565: el_debug_heat of firmware/src/frame/debug_view.h, from 0 up."""

GREYS = tuple(255 - (255 - 32) * i // 11 for i in range(12))
"""8-bit: DEPTH, from the near plane to the far one."""

_SWATCH_X, _SWATCH_Y = 22, 11
_PAD = 9


@dataclass(frozen=True)
class _Scale:
    """Colours from left to right as Tk has them, and a label below each, "" for none."""

    title: str
    colours: tuple[str, ...] = ()
    labels: tuple[str, ...] = ()


_HEAT = tuple(map(theme.of_rgb565, HEATS))
_COUNTS = (*map(str, range(11)), "11+")
_BARS = ("0", "", "1", "", "2", "", "3", "", "4", "", "", "5.5+")
_GREYS = tuple(f"#{grey:02x}{grey:02x}{grey:02x}" for grey in GREYS)
_NEAR_TO_FAR = ("near", *[""] * (len(GREYS) - 2), "far")

SCALES = {
    DebugView.OVERDRAW: _Scale("Overdraw: how often each pixel was drawn", _HEAT, _COUNTS),
    DebugView.REJECTED: _Scale("Rejected: how often each pixel was tested and found hidden", _HEAT, _COUNTS),
    DebugView.DEPTH: _Scale(
        "Depth, by the logarithm of the distance; black: nothing",
        _GREYS,
        _NEAR_TO_FAR,
    ),
    DebugView.TRIANGLES: _Scale("Triangles: each in a colour of its own"),
    DebugView.BANDS: _Scale("Bands: their work per pixel, 1 being a flat one", _HEAT, _BARS),
}
_NOT_SENT = "Dimmed: this frame did not carry it"


class Legend:
    """On `canvas`; nothing while there is nothing to explain."""

    def __init__(self, canvas: tk.Canvas, fonts: theme.Fonts) -> None:
        self._canvas, self._fonts = canvas, fonts
        self._shown: tuple[object, ...] = ()

    def show(self, view: DebugView, not_sent: bool, x: int, y: int) -> None:
        """Puts its lower left corner at (x, y). `not_sent`: the overlay is on that dims what a frame did not carry."""
        scale = SCALES.get(view)
        if self._shown == (scale, not_sent, x, y):
            return
        self._shown = scale, not_sent, x, y
        self._canvas.delete("legend")
        lines = ([scale.title] if scale else []) + ([_NOT_SENT] if not_sent else [])
        if not lines:
            return
        line = self._fonts.normal.metrics("linespace")
        small = self._fonts.small.metrics("linespace")
        bar = _SWATCH_Y + small + 6 if scale and scale.colours else 0
        width = max(
            *(self._fonts.normal.measure(text) for text in lines), _SWATCH_X * len(scale.colours) if scale else 0
        )
        top = y - 2 * _PAD - line * len(lines) - bar
        self._canvas.create_rectangle(
            x, top, x + width + 2 * _PAD, y, fill=theme.PANEL, outline=theme.EDGE, tags="legend"
        )
        at = top + _PAD
        for text in lines:
            self._canvas.create_text(
                x + _PAD, at, text=text, fill=theme.TEXT, font=self._fonts.normal, anchor="nw", tags="legend"
            )
            at += line
            if scale and text == scale.title:
                self._draw_scale(scale, x + _PAD, at + 4)
                at += bar

    def _draw_scale(self, scale: _Scale, x: int, y: int) -> None:
        for i, (colour, label) in enumerate(zip(scale.colours, scale.labels, strict=True)):
            left = x + i * _SWATCH_X
            self._canvas.create_rectangle(
                left, y, left + _SWATCH_X, y + _SWATCH_Y, fill=colour, outline=theme.EDGE, tags="legend"
            )
            self._canvas.create_text(
                left + _SWATCH_X // 2,
                y + _SWATCH_Y + 2,
                text=label,
                fill=theme.DIM,
                font=self._fonts.small,
                anchor="n",
                tags="legend",
            )
