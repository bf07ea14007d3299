"""The window's colours and fonts, in one place, so that everything goes together.

Dark, because a panel's picture is what should shine. Each text colour has a contrast of 4.5:1 at least on the grounds
that it is used on (WCAG 2.1, success criterion 1.4.3); a test computes it.
"""

from __future__ import annotations

import tkinter as tk
from dataclasses import dataclass
from tkinter import font as tkfont

import numpy as np

from edgeline.colour import to_rgb
from edgeline.viewer.state import Mood

GROUND = "#0e1014"
PANEL = "#171a21"
WELL = "#11141a"
"""Under charts and the log."""

EDGE = "#2a303c"
TEXT = "#e6e9ef"
DIM = "#949db0"
ACCENT = "#7cb7ff"
RECORDING = "#ff5c5c"
GREYED = "#6f7789"
"""A key that the device does not know. It may be faint: it says that there is nothing to press."""

MOODS = {Mood.GOOD: "#5fd38d", Mood.BUSY: "#f2c14e", Mood.BAD: "#f2766e"}

SERIES = ("#7cb7ff", "#f2c14e", "#5fd38d", "#d69cff", "#ff9e64", "#5ad1d1", "#f7768e", "#c3d96b")
"""Charts take these in turn."""

_SANS = ("Inter", "Segoe UI", "SF Pro Text", "DejaVu Sans")
_MONO = ("JetBrains Mono", "Cascadia Mono", "Consolas", "Menlo", "DejaVu Sans Mono")


def rgb(colour: str) -> tuple[int, int, int]:
    """`#rrggbb` as three numbers."""
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)


def of_rgb565(value: int) -> str:
    """A pixel's value as `#rrggbb`."""
    red, green, blue = to_rgb(np.array([[value]], np.uint16))[0, 0]
    return f"#{red:02x}{green:02x}{blue:02x}"


@dataclass(frozen=True)
class Fonts:
    normal: tkfont.Font
    small: tkfont.Font
    bold: tkfont.Font
    large: tkfont.Font
    mono: tkfont.Font


def fonts(root: tk.Misc) -> Fonts:
    """The best families that this computer has."""
    families = set(tkfont.families(root))
    sans = next((name for name in _SANS if name in families), tkfont.nametofont("TkDefaultFont").actual("family"))
    mono = next((name for name in _MONO if name in families), tkfont.nametofont("TkFixedFont").actual("family"))
    return Fonts(
        normal=tkfont.Font(root, family=sans, size=9),
        small=tkfont.Font(root, family=sans, size=8),
        bold=tkfont.Font(root, family=sans, size=11, weight="bold"),
        large=tkfont.Font(root, family=sans, size=13),
        mono=tkfont.Font(root, family=mono, size=8),
    )
