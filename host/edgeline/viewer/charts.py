"""The plots beside the picture, and the list of numbers in which the user chooses what is plotted."""

from __future__ import annotations

import tkinter as tk
from dataclasses import dataclass
from typing import Literal

from PIL import Image, ImageTk

from edgeline.viewer import theme
from edgeline.viewer.history import default_charts, in_words, label, nice_ceiling
from edgeline.viewer.model import ViewModel
from edgeline.viewer.paint import chart
from edgeline.viewer.widgets import ScrolledCanvas

_MARGIN = 14
_TEXT = 17
_LEAST, _MOST = 28, 90
"""How high a chart may be, without its one or two lines of text."""

_GAP = 5

_ROW = 16


@dataclass(frozen=True)
class _Chart:
    """The items of one chart on the canvas."""

    image: int
    name: int
    value: int
    top: int
    summary: int


class Charts:
    """The chosen series, one below the other, each with its latest value and its range over the last ten seconds."""

    def __init__(self, parent: tk.Misc, model: ViewModel, fonts: theme.Fonts) -> None:
        self._model, self._fonts = model, fonts
        self._scrolled = ScrolledCanvas(parent, theme.PANEL)
        self.canvas = self._scrolled.canvas
        self.chosen: list[str] = []
        self._charts: list[_Chart] = []
        self._photos: list[ImageTk.PhotoImage] = []
        self._known: tuple[str, ...] = ()

    def colour(self, name: str) -> str | None:
        """In what colour a series is drawn, None if it is not."""
        return theme.SERIES[self.chosen.index(name) % len(theme.SERIES)] if name in self.chosen else None

    def toggle(self, name: str) -> None:
        """Draws the series or leaves it out. There are as many charts as colours."""
        if name in self.chosen:
            self.chosen.remove(name)
        elif len(self.chosen) < len(theme.SERIES):
            self.chosen.append(name)

    def draw(self, now: float) -> None:
        names = self._model.series()
        if names != self._known:
            self.chosen = [name for name in self.chosen if name in names] or list(default_charts(names))
            self._known = names
        width, room = self.canvas.winfo_width() - 2 * _MARGIN, self.canvas.winfo_height()
        if width < 20 or not self.chosen:
            return
        share = room // len(self.chosen)
        foot = _TEXT if share >= _LEAST + 2 * _TEXT + _GAP else 0
        height = min(_MOST, max(_LEAST, share - _TEXT - foot - _GAP))
        step = _TEXT + height + foot + _GAP
        self._scrolled.resize(step * len(self.chosen), step)
        for i, name in enumerate(self.chosen):
            self._draw(i, name, now, (width, height), i * step)
            if not foot:
                self.canvas.itemconfigure(self._charts[i].summary, state="hidden")
        for unused in self._charts[len(self.chosen) :]:
            for item in vars(unused).values():
                self.canvas.itemconfigure(item, state="hidden")

    def _draw(self, index: int, name: str, now: float, size: tuple[int, int], y: int) -> None:
        if index == len(self._charts):
            self._charts.append(self._new_chart())
        items, canvas = self._charts[index], self.canvas
        track, failures = self._model.track(name, now)
        summary = track.summary
        top = nice_ceiling(summary[2] if summary else 0.0)
        colour = theme.SERIES[index % len(theme.SERIES)]
        grounds = theme.rgb(theme.WELL), theme.rgb(colour), theme.rgb(theme.RECORDING)
        image = Image.fromarray(chart(track, failures, size, top, grounds))
        if index == len(self._photos) or (self._photos[index].width(), self._photos[index].height()) != size:
            self._photos[index : index + 1] = [ImageTk.PhotoImage(image, master=canvas)]
            canvas.itemconfigure(items.image, image=self._photos[index])
        else:
            self._photos[index].paste(image)
        texts = {
            items.name: label(name).strip().capitalize(),
            items.value: in_words(name, track.latest),
            items.top: f"to {in_words(name, top)}",
            items.summary: ""
            if summary is None
            else "   ".join(
                f"{what} {in_words(name, value)}" for what, value in zip(("min", "mean", "max"), summary, strict=True)
            ),
        }
        right, foot = _MARGIN + size[0], y + _TEXT + size[1]
        places = {
            items.image: (_MARGIN, y + _TEXT),
            items.name: (_MARGIN, y),
            items.value: (right, y),
            items.top: (_MARGIN + self._fonts.small.measure(texts[items.name]) + 8, y),
            items.summary: (right, foot),
        }
        for item, text in texts.items():
            canvas.itemconfigure(item, text=text)
        canvas.itemconfigure(items.name, fill=colour)
        for item, (x, at) in places.items():
            canvas.coords(item, x, at)
            canvas.itemconfigure(item, state="normal")

    def _new_chart(self) -> _Chart:
        def text(anchor: Literal["nw", "ne"], colour: str) -> int:
            return self.canvas.create_text(0, 0, anchor=anchor, fill=colour, font=self._fonts.small)

        image = self.canvas.create_image(0, 0, anchor="nw")
        return _Chart(
            image, text("nw", theme.ACCENT), text("ne", theme.TEXT), text("nw", theme.DIM), text("ne", theme.DIM)
        )


class Numbers:
    """All numbers of the last frame. A click on one plots it, another click ends that."""

    def __init__(self, parent: tk.Misc, model: ViewModel, charts: Charts, fonts: theme.Fonts) -> None:
        self._model, self._charts, self._fonts = model, charts, fonts
        self._scrolled = ScrolledCanvas(parent, theme.PANEL)
        self.canvas = self._scrolled.canvas
        self._rows: list[tuple[str, int, int, int]] = []
        self.canvas.bind("<Button-1>", self._click)
        self.canvas.configure(cursor="hand2")

    def height_within(self, room: int) -> int:
        """What it needs to show all of them, or as many whole rows as fit into `room`."""
        return max(1, min(len(self._rows), room // _ROW)) * _ROW

    def draw(self) -> None:
        latest = self._model.latest()
        if [row[0] for row in self._rows] != list(latest):
            self._build(list(latest))
        right = self.canvas.winfo_width() - _MARGIN
        for name, mark, _, value in self._rows:
            colour = self._charts.colour(name)
            self.canvas.itemconfigure(mark, fill=colour or "", outline=colour or theme.EDGE)
            self.canvas.itemconfigure(value, text=in_words(name, latest[name]))
            self.canvas.coords(value, right, self.canvas.coords(value)[1])

    def _build(self, names: list[str]) -> None:
        self.canvas.delete("all")
        self._rows = []
        for i, name in enumerate(names):
            y, text = i * _ROW, label(name)
            indent = 10 if text.startswith(" ") else 0
            mark = self.canvas.create_rectangle(_MARGIN, y + 4, _MARGIN + 7, y + 11, width=1)
            words = self.canvas.create_text(
                _MARGIN + 14 + indent, y, anchor="nw", text=text.strip(), fill=theme.DIM, font=self._fonts.small
            )
            value = self.canvas.create_text(0, y, anchor="ne", fill=theme.TEXT, font=self._fonts.small)
            self._rows.append((name, mark, words, value))
        self._scrolled.resize(len(names) * _ROW, _ROW)

    def _click(self, event: tk.Event[tk.Misc]) -> None:
        row = int(self.canvas.canvasy(event.y)) // _ROW
        if 0 <= row < len(self._rows):
            self._charts.toggle(self._rows[row][0])
            self.draw()
