"""What stands around the picture: the facts above the plots, the log, the status line, the help over all of it."""

from __future__ import annotations

import tkinter as tk
from tkinter import font as tkfont

from edgeline.protocol import Control
from edgeline.viewer import theme
from edgeline.viewer.keys import HELP, Key
from edgeline.viewer.log import LINES, Source
from edgeline.viewer.model import Measures, View, ViewModel
from edgeline.viewer.state import Mood, Phase
from edgeline.viewer.widgets import cut

_SOURCES = {
    Source.DEVICE: theme.TEXT,
    Source.LINK: theme.ACCENT,
    Source.VIEWER: theme.MOODS[Mood.GOOD],
    Source.DAMAGE: theme.MOODS[Mood.BUSY],
}


_LINES_AT_ONCE = 100
"""What the log takes each time that it is drawn; more, and the rest of the window would wait."""


class Facts:
    """Who is at the other end, and how the link does: two columns of names and values."""

    _NAMES = ("frames/s", "received", "packed", "baud", "proven", "failed", "asked anew", "damaged")

    def __init__(self, parent: tk.Misc, fonts: theme.Fonts) -> None:
        self.frame = tk.Frame(parent, background=theme.PANEL)
        self._fonts = fonts
        self._title = self._label(fonts.bold, theme.TEXT)
        self._subtitle = self._label(fonts.small, theme.DIM)
        self._controls = self._label(fonts.small, theme.ACCENT)
        self._controls.configure(justify="left")
        grid = tk.Frame(self.frame, background=theme.PANEL)
        grid.pack(fill="x", padx=14, pady=(6, 4))
        grid.columnconfigure((1, 3), weight=1)
        self._values: dict[str, tk.Label] = {}
        for i, name in enumerate(self._NAMES):
            row, column = divmod(i, 2)
            heading = tk.Label(grid, text=name, background=theme.PANEL, foreground=theme.DIM, font=fonts.small, pady=0)
            heading.grid(row=row, column=2 * column, sticky="w", padx=(0, 6))
            value = tk.Label(grid, background=theme.PANEL, foreground=theme.TEXT, font=fonts.small, pady=0)
            value.grid(row=row, column=2 * column + 1, sticky="e", padx=(0, 12 * (1 - column)))
            self._values[name] = value

    def draw(self, view: View, frames: int, controls: list[str]) -> None:
        hello, width = view.hello, self.frame.winfo_width() - 28
        title = hello.target if hello else view.port or "Edgeline"
        subtitle = f"{hello.firmware}, {hello.width} x {hello.height}, {view.port}" if hello else ""
        self._title.configure(text=cut(self._fonts.bold, title, width))
        self._subtitle.configure(text=cut(self._fonts.small, subtitle, width))
        self._controls.configure(text=" \u00b7 ".join(controls), wraplength=max(1, width))
        for name, text in _facts(view.measures, frames).items():
            self._values[name].configure(text=text)

    def _label(self, font: tkfont.Font, colour: str) -> tk.Label:
        label = tk.Label(self.frame, background=theme.PANEL, foreground=colour, font=font, anchor="w", pady=0)
        label.pack(fill="x", padx=12, pady=(10, 0) if font is self._fonts.bold else 0)
        return label


def _facts(measures: Measures | None, frames: int) -> dict[str, str]:
    if measures is None:
        return dict.fromkeys(Facts._NAMES, "-") | {"proven": f"{frames:,}"}
    statistics, counts = measures.statistics, measures.counts
    shrunk = "-" if statistics.compression is None else f"1 : {statistics.compression:,.1f}"
    return {
        "frames/s": f"{statistics.frames_per_s:.1f}",
        "received": _rate(statistics.bytes_per_s),
        "packed": shrunk,
        "baud": f"{measures.rate:,}" if measures.rate else "-",
        "proven": f"{frames:,}",
        "failed": f"{counts.failed:,}",
        "asked anew": f"{counts.keys_sent:,}",
        "damaged": f"{counts.damaged:,}",
    }


def _rate(bytes_per_s: float) -> str:
    return f"{bytes_per_s / 1e6:.2f} MB/s" if bytes_per_s >= 1e6 else f"{bytes_per_s / 1000:.1f} kB/s"


class LogPane:
    """The log, scrolled to its end until the user scrolls away from it."""

    def __init__(self, parent: tk.Misc, model: ViewModel, fonts: theme.Fonts) -> None:
        self._model = model
        self._next = 0
        self.frame = tk.Frame(parent, background=theme.WELL, highlightbackground=theme.EDGE, highlightthickness=1)
        self.text = tk.Text(
            self.frame,
            background=theme.WELL,
            foreground=theme.TEXT,
            font=fonts.mono,
            height=5,
            borderwidth=0,
            highlightthickness=0,
            padx=10,
            pady=4,
            wrap="word",
            state="disabled",
            cursor="arrow",
            takefocus=False,
        )
        bar = tk.Scrollbar(
            self.frame,
            command=self.text.yview,
            width=9,
            borderwidth=0,
            elementborderwidth=0,
            highlightthickness=0,
            background=theme.EDGE,
            activebackground=theme.DIM,
            troughcolor=theme.WELL,
            takefocus=False,
        )
        self.text.configure(yscrollcommand=bar.set)
        self.text.tag_configure("stamp", foreground=theme.DIM)
        for source, colour in _SOURCES.items():
            self.text.tag_configure(source.value, foreground=colour, lmargin2=fonts.mono.measure("00:00:00  "))
        bar.pack(side="right", fill="y")
        self.text.pack(side="left", fill="both", expand=True)

    def draw(self) -> None:
        lines, self._next = self._model.log_since(self._next, _LINES_AT_ONCE)
        if not lines:
            return
        at_end = self.text.yview()[1] >= 1.0
        self.text.configure(state="normal")
        for line in lines:
            self.text.insert("end", f"{line.stamp}  ", "stamp", f"{line.text}\n", line.source.value)
        beyond = int(self.text.index("end-1c").split(".")[0]) - 1 - LINES
        if beyond > 0:
            self.text.delete("1.0", f"{beyond + 1}.0")
        self.text.configure(state="disabled")
        if at_end:
            self.text.see("end")


class StatusLine:
    """A lamp and the state in words; at the right the pixel under the pointer, and the scale."""

    def __init__(self, parent: tk.Misc, fonts: theme.Fonts) -> None:
        self._fonts = fonts
        self.frame = tk.Frame(parent, background=theme.PANEL, highlightbackground=theme.EDGE, highlightthickness=1)
        self._dot = tk.Canvas(self.frame, width=10, height=10, background=theme.PANEL, highlightthickness=0)
        self._lamp = self._dot.create_oval(1, 1, 9, 9, outline="")
        self._dot.pack(side="left", padx=(10, 6), pady=6)
        hint = self._label(fonts.small, theme.DIM)
        hint.configure(text="? help")
        hint.pack(side="right", padx=10)
        self._scale = self._label(fonts.small, theme.DIM)
        self._scale.pack(side="right", padx=(8, 0))
        self._pixel = self._label(fonts.mono, theme.TEXT)
        self._pixel.configure(width=len("2039,2039  FFFF  r31 g63 b31"), anchor="e")
        self._pixel.pack(side="right")
        self._swatch = tk.Frame(self.frame, background=theme.PANEL, width=12, height=12)
        self._swatch.pack(side="right", padx=6)
        self._words = self._label(fonts.normal, theme.TEXT)
        self._words.configure(anchor="w", width=1)  # it takes what the others leave
        self._words.pack(side="left", fill="x", expand=True)

    def words(self, view: View) -> None:
        self._dot.itemconfigure(self._lamp, fill=theme.MOODS[view.words.mood])
        said = view.words.line
        if view.phase is Phase.STREAMING and view.measures is not None:
            statistics = view.measures.statistics
            said += f"   {statistics.frames_per_s:.1f} frames/s   {_rate(statistics.bytes_per_s)}"
        if view.notice and view.words.mood is not Mood.BAD:
            said = view.notice
        self._words.configure(text=cut(self._fonts.normal, said, self._words.winfo_width() - 6))

    def scale(self, text: str) -> None:
        self._scale.configure(text=text)

    @property
    def pixel_text(self) -> str:
        """What it says of the pixel under the pointer."""
        return str(self._pixel.cget("text"))

    def pixel(self, at: tuple[int, int] | None, value: int) -> None:
        """The place and the RGB565 value of the pixel under the pointer; None: it is not on the picture."""
        if at is None:
            self._pixel.configure(text="")
            self._swatch.configure(background=theme.PANEL)
            return
        red, green, blue = value >> 11, value >> 5 & 63, value & 31
        self._pixel.configure(text=f"{at[0]},{at[1]}  {value:04X}  r{red} g{green} b{blue}")
        self._swatch.configure(background=theme.of_rgb565(value))

    def _label(self, font: tkfont.Font, colour: str) -> tk.Label:
        return tk.Label(self.frame, background=theme.PANEL, foreground=colour, font=font, pady=0)


class Help:
    """All keys, over the window's middle; those that this device does not know are greyed."""

    def __init__(self, parent: tk.Misc, fonts: theme.Fonts) -> None:
        self._parent = parent
        self.frame = tk.Frame(parent, background=theme.PANEL, highlightbackground=theme.ACCENT, highlightthickness=1)
        self._lines: list[tuple[Key, tk.Label, tk.Label]] = []
        left, right = (tk.Frame(self.frame, background=theme.PANEL) for _ in range(2))
        left.pack(side="left", anchor="n", padx=(18, 12), pady=14)
        right.pack(side="left", anchor="n", padx=(12, 18), pady=14)
        for section, (title, keys) in enumerate(HELP):
            self._section(left if section == 0 else right, title, keys, fonts)

    @property
    def visible(self) -> bool:
        return bool(self.frame.winfo_manager())

    def show(self, controls: frozenset[Control]) -> None:
        for key, shown, does in self._lines:
            works = key.works(controls)
            shown.configure(foreground=theme.ACCENT if works else theme.GREYED)
            does.configure(foreground=theme.TEXT if works else theme.GREYED)
        self.frame.place(relx=0.5, rely=0.5, anchor="center")
        self.frame.lift()

    def hide(self) -> None:
        self.frame.place_forget()

    def greyed(self) -> set[str]:
        """What the greyed lines would do."""
        return {key.does for key, shown, _ in self._lines if str(shown.cget("foreground")) == theme.GREYED}

    def _section(self, column: tk.Frame, title: str, keys: tuple[Key, ...], fonts: theme.Fonts) -> None:
        row = column.grid_size()[1]
        heading = tk.Label(column, text=title, background=theme.PANEL, foreground=theme.TEXT, font=fonts.bold)
        heading.grid(row=row, column=0, columnspan=2, sticky="w", pady=(8 if row else 0, 3))
        for i, key in enumerate(keys, row + 1):
            shown = tk.Label(column, text=key.shown, background=theme.PANEL, font=fonts.small, pady=0)
            does = tk.Label(column, text=key.does, background=theme.PANEL, font=fonts.small, pady=0)
            shown.grid(row=i, column=0, sticky="w", padx=(0, 14))
            does.grid(row=i, column=1, sticky="w")
            self._lines.append((key, shown, does))
