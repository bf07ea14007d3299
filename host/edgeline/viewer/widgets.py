"""Small pieces that the window is made of: text on the picture, a canvas that scrolls."""

from __future__ import annotations

import tkinter as tk
from tkinter import font as tkfont

from edgeline.viewer import theme

_PAD_X, _PAD_Y = 9, 5


def cut(font: tkfont.Font, text: str, width: int) -> str:
    """`text`, shortened with an ellipsis to what fits into `width` pixels."""
    if font.measure(text) <= width:
        return text
    low, high = 0, len(text)
    while low < high:
        middle = (low + high + 1) // 2
        if font.measure(text[:middle].rstrip() + "\u2026") <= width:
            low = middle
        else:
            high = middle - 1
    return text[:low].rstrip() + "\u2026"


class Chip:
    """A line of text on a dark ground, on a canvas; `anchor` says which corner of it `place` puts where."""

    def __init__(self, canvas: tk.Canvas, font: tkfont.Font, colour: str, anchor: str) -> None:
        self._canvas, self._font, self._anchor = canvas, font, anchor
        self._at = (0, 0)
        self._text = ""
        self._box = canvas.create_rectangle(0, 0, 0, 0, fill=theme.PANEL, outline=theme.EDGE, state="hidden")
        self._label = canvas.create_text(0, 0, text="", font=font, fill=colour, anchor="nw", state="hidden")

    def place(self, x: int, y: int, room: int) -> None:
        """Puts it at (x, y), `room` pixels wide at most."""
        if self._text:
            shown = cut(self._font, self._text, max(20, room - 2 * _PAD_X))
            width = self._font.measure(shown) + 2 * _PAD_X
            height = self._font.metrics("linespace") + 2 * _PAD_Y
            left = x - width if "e" in self._anchor else x
            top = y - height if "s" in self._anchor else y
            self._canvas.coords(self._box, left, top, left + width, top + height)
            self._canvas.coords(self._label, left + _PAD_X, top + _PAD_Y)
            self._canvas.itemconfigure(self._label, text=shown)

    def show(self, text: str, colour: str | None = None) -> None:
        """Nothing is shown for an empty text. `place` has to follow."""
        self._text = text
        state = "normal" if text else "hidden"
        self._canvas.itemconfigure(self._box, state=state)
        self._canvas.itemconfigure(self._label, state=state)
        if colour is not None:
            self._canvas.itemconfigure(self._label, fill=colour)
        if text:
            self._canvas.tag_raise(self._box)
            self._canvas.tag_raise(self._label)


class ScrolledCanvas:
    """A canvas that the wheel scrolls, with a thin mark at its right border that says where it is."""

    def __init__(self, parent: tk.Misc, background: str) -> None:
        self.canvas = tk.Canvas(parent, background=background, highlightthickness=0, height=1, width=1)
        self._thumb = tk.Frame(self.canvas, background=theme.EDGE, width=3)
        self._content = 0
        self.canvas.configure(yscrollcommand=self._moved)
        for event, steps in (("<Button-4>", -1), ("<Button-5>", 1)):
            self.canvas.bind(event, lambda _, steps=steps: self._scroll(steps))  # type: ignore[misc]
        self.canvas.bind("<MouseWheel>", lambda event: self._scroll(-1 if event.delta > 0 else 1))

    def resize(self, height: int, step: int) -> None:
        """The content is so high, and the wheel moves it by `step` pixels."""
        if height != self._content:
            self._content = height
            self.canvas.configure(scrollregion=(0, 0, 1, height), yscrollincrement=step)

    def _scroll(self, steps: int) -> None:
        if self._content > self.canvas.winfo_height():
            self.canvas.yview_scroll(steps, "units")

    def _moved(self, first: float, last: float) -> None:
        share, end = float(first), float(last)  # Tk passes text
        if end - share >= 1.0:
            self._thumb.place_forget()
        else:
            self._thumb.place(relx=1.0, x=-3, rely=share, relheight=end - share)
