"""The part of the window that shows the picture: drawing it, and what the mouse does to it.

Only what can be seen is magnified, so a redraw costs about the same at any zoom.
"""

from __future__ import annotations

import tkinter as tk
from collections.abc import Callable

from PIL import ImageTk

from edgeline.codec import Pixels
from edgeline.viewer import theme
from edgeline.viewer.paint import Mask, magnify
from edgeline.viewer.viewport import Viewport


class Picture:
    """A canvas with the picture in a Viewport. `canvas` is its widget; `hovered` is called with the pixel under the
    pointer, or None, `orbit` and `move` with pixels that the right button was dragged, `approach` with wheel steps."""

    def __init__(
        self,
        parent: tk.Misc,
        hovered: Callable[[tuple[int, int] | None], None],
        orbit: Callable[[int, int], None],
        move: Callable[[int, int], None],
        approach: Callable[[int], None],
    ) -> None:
        self.canvas = tk.Canvas(parent, background=theme.GROUND, highlightthickness=0, width=640, height=480)
        self.grid = False
        self.viewport: Viewport | None = None
        self._hovered = hovered
        self._pixels: Pixels | None = None
        self._mask: Mask | None = None
        self._photo: ImageTk.PhotoImage | None = None
        self._image = self.canvas.create_image(0, 0, anchor="nw")
        self._frame = self.canvas.create_rectangle(-2, -2, -2, -2, outline=theme.EDGE)
        self._pointer: tuple[int, int] | None = None
        self._dragged = (0, 0)
        self._bind(orbit, move, approach)

    def show(self, pixels: Pixels, mask: Mask | None) -> None:
        """Draws `pixels`, (h, w) RGB565; what is False in `mask`, (h, w), is dimmed."""
        height, width = pixels.shape
        self._pixels, self._mask = pixels, mask
        if self.viewport is None:
            self.viewport = Viewport(width, height, self.canvas.winfo_width(), self.canvas.winfo_height())
        self.viewport.replace(width, height)
        self.draw()

    def draw(self) -> None:
        """Draws what is shown again: the room, the zoom or the grid has changed."""
        if self._pixels is None or self.viewport is None:
            return
        self.viewport.resize(self.canvas.winfo_width(), self.canvas.winfo_height())
        patch = self.viewport.patch()
        image = magnify(self._pixels, patch, self.grid, self._mask)
        if self._photo is None or (self._photo.width(), self._photo.height()) != image.size:
            self._photo = ImageTk.PhotoImage(image, master=self.canvas)
            self.canvas.itemconfigure(self._image, image=self._photo)
        else:
            self._photo.paste(image)
        right, bottom = patch.left + patch.width, patch.top + patch.height
        self.canvas.coords(self._image, patch.left, patch.top)
        self.canvas.coords(self._frame, patch.left - 1, patch.top - 1, right, bottom)
        self._hover()

    def zoom(self, steps: int) -> None:
        """About the middle of the room."""
        self._zoom(steps, self.canvas.winfo_width() // 2, self.canvas.winfo_height() // 2)

    def fit(self) -> None:
        if self.viewport is not None:
            self.viewport.fit()
            self.draw()

    def _bind(
        self, orbit: Callable[[int, int], None], move: Callable[[int, int], None], approach: Callable[[int], None]
    ) -> None:
        canvas = self.canvas

        def dragged(event: tk.Event[tk.Misc]) -> tuple[int, int]:
            before, self._dragged = self._dragged, (event.x, event.y)
            return event.x - before[0], event.y - before[1]

        def wheel(event: tk.Event[tk.Misc], steps: int) -> None:
            if _held(event, "Control"):
                approach(steps)
            else:
                self._zoom(steps, event.x, event.y)

        def right(event: tk.Event[tk.Misc]) -> None:
            (move if _held(event, "Shift") else orbit)(*dragged(event))

        # Some systems call the right button 2, some 3; the wheel is two buttons on X11 and an event elsewhere.
        for button in ("1", "2", "3"):
            canvas.bind(f"<ButtonPress-{button}>", dragged)
        canvas.bind("<B1-Motion>", lambda event: self._pan(*dragged(event)))
        canvas.bind("<B2-Motion>", right)
        canvas.bind("<B3-Motion>", right)
        canvas.bind("<Button-4>", lambda event: wheel(event, 1))
        canvas.bind("<Button-5>", lambda event: wheel(event, -1))
        canvas.bind("<MouseWheel>", lambda event: wheel(event, 1 if event.delta > 0 else -1))
        canvas.bind("<Motion>", lambda event: self._point((event.x, event.y)))
        canvas.bind("<Leave>", lambda _: self._point(None))

    def _zoom(self, steps: int, x: int, y: int) -> None:
        if self.viewport is not None:
            self.viewport.zoom(steps, x, y)
            self.draw()

    def _pan(self, dx: int, dy: int) -> None:
        if self.viewport is not None:
            self.viewport.pan(dx, dy)
            self._pointer = self._dragged
            self.draw()

    def _point(self, at: tuple[int, int] | None) -> None:
        self._pointer = at
        self._hover()

    def _hover(self) -> None:
        if self.viewport is None or self._pointer is None:
            self._hovered(None)
        else:
            self._hovered(self.viewport.pixel_at(*self._pointer))

    def pixel(self, x: int, y: int) -> int:
        """The RGB565 value at a pixel of what is shown."""
        assert self._pixels is not None
        return int(self._pixels[y, x])


_MODIFIERS = {"Shift": 0x1, "Control": 0x4}


def _held(event: tk.Event[tk.Misc], modifier: str) -> bool:
    return isinstance(event.state, int) and bool(event.state & _MODIFIERS[modifier])
