"""Where the picture stands in the window: whole scales, zoom about a point, panning. Arithmetic, without a window.

All places are whole pixels: of the room, which is the part of the window that the picture has, and of the picture. x to
the right, y down, rectangles half-open. Scales are whole, so every pixel of the panel is a square of the same size and
the panel's aspect is kept.
"""

from __future__ import annotations

from dataclasses import dataclass

SCALES = (1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 20, 24, 32, 40, 48, 64)
"""What the wheel goes through."""


def largest_scale(width: int, height: int, room_x: int, room_y: int) -> int:
    """The largest whole factor by which a picture fits into the room, 1 at least."""
    return max(1, min(room_x // width, room_y // height))


@dataclass(frozen=True)
class Patch:
    """Pixels x0..x1, y0..y1 of the picture, to be drawn from (left, top) of the room on, `scale` times as large."""

    x0: int
    y0: int
    x1: int
    y1: int
    left: int
    top: int
    scale: int

    @property
    def width(self) -> int:
        """In pixels of the room."""
        return (self.x1 - self.x0) * self.scale

    @property
    def height(self) -> int:
        """In pixels of the room."""
        return (self.y1 - self.y0) * self.scale


class Viewport:
    """A picture in a room. It fits, at the largest whole scale, until someone zooms; then it stays where it is put."""

    def __init__(self, width: int, height: int, room_x: int = 1, room_y: int = 1) -> None:
        self._width, self._height = width, height
        self._room_x, self._room_y = room_x, room_y
        self._zoom: int | None = None
        self._left = self._top = 0
        self._settle()

    @property
    def scale(self) -> int:
        if self._zoom is not None:
            return self._zoom
        return largest_scale(self._width, self._height, self._room_x, self._room_y)

    @property
    def fits(self) -> bool:
        """Whether the scale follows the room."""
        return self._zoom is None

    def resize(self, room_x: int, room_y: int) -> None:
        """The room has another size; what is in its middle stays there."""
        self._left += (room_x - self._room_x) // 2
        self._top += (room_y - self._room_y) // 2
        self._room_x, self._room_y = room_x, room_y
        self._settle()

    def replace(self, width: int, height: int) -> None:
        """Another picture. One of another size begins anew."""
        if (width, height) != (self._width, self._height):
            self._width, self._height = width, height
            self.fit()

    def fit(self) -> None:
        self._zoom = None
        self._settle()

    def zoom(self, steps: int, x: int, y: int) -> None:
        """Goes `steps` scales up or down; the picture's point at (x, y) of the room stays there, where it can."""
        before = after = self.scale
        for _ in range(abs(steps)):
            if steps > 0:
                after = next((scale for scale in SCALES if scale > after), SCALES[-1])
            else:
                after = next((scale for scale in reversed(SCALES) if scale < after), 1)
        self._zoom = after
        self._left = x - (x - self._left) * after // before
        self._top = y - (y - self._top) * after // before
        self._settle()

    def pan(self, dx: int, dy: int) -> None:
        self._left += dx
        self._top += dy
        self._settle()

    def pixel_at(self, x: int, y: int) -> tuple[int, int] | None:
        """The picture's pixel at (x, y) of the room; None beside the picture."""
        column, row = (x - self._left) // self.scale, (y - self._top) // self.scale
        return (column, row) if 0 <= column < self._width and 0 <= row < self._height else None

    def patch(self) -> Patch:
        """The part of the picture that can be seen, as whole pixels; those at the room's border may stick out."""
        scale = self.scale
        x0, y0 = max(0, -self._left // scale), max(0, -self._top // scale)
        x1 = min(self._width, -((self._left - self._room_x) // scale))
        y1 = min(self._height, -((self._top - self._room_y) // scale))
        return Patch(x0, y0, max(x0, x1), max(y0, y1), self._left + x0 * scale, self._top + y0 * scale, scale)

    def _settle(self) -> None:
        """A side that fits is centred; one that does not leaves no gap at the room's border."""
        self._left = _place(self._left, self._width * self.scale, self._room_x)
        self._top = _place(self._top, self._height * self.scale, self._room_y)


def _place(at: int, size: int, room: int) -> int:
    return (room - size) // 2 if size <= room else min(0, max(room - size, at))
