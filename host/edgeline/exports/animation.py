"""What GIF, animated PNG and MP4 share: one file that plays frames at the device's times."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np

from edgeline.codec import Pixels
from edgeline.errors import OutputError
from edgeline.outfile import AtomicFile, cannot_write

LAST_FRAME_US = 100_000
"""How long the only frame of a recording is shown; the last of several is shown as long as the one before."""

LONGEST_FRAME_US = 60_000_000
"""A pause longer than this is a restarted clock, not a picture to look at. It fits GIF's and PNG's 16 bits."""


class Animation(ABC):
    """A frame is written when the next one tells how long it lasts. Every public method may raise OutputError."""

    def __init__(self, path: str) -> None:
        self._file = AtomicFile(path)
        self._path = path
        self._waiting: tuple[Pixels, int] | None = None
        self._duration_us = LAST_FRAME_US

    def add(self, picture: Pixels, time_us: int) -> None:
        """The next frame, (h, w) RGB565 of one size throughout, begun at `time_us` of the device's clock (mod 2^32)."""
        if self._waiting is not None:
            elapsed_us = time_us - self._waiting[1] & 0xFFFFFFFF
            if elapsed_us <= LONGEST_FRAME_US:
                self._duration_us = elapsed_us
            self._put(self._waiting[0])
        self._waiting = picture, time_us

    def finish(self) -> None:
        """Makes the file complete. Without a frame there will be none."""
        if self._waiting is None:
            self.discard()
            return
        self._put(self._waiting[0])
        self._waiting = None
        try:
            self._end()
            self._file.commit()
        except OSError as error:
            raise cannot_write(self._path, error) from None
        finally:
            self.discard()

    def discard(self) -> None:
        """Leaves everything as if this recording had not been."""
        self._file.discard()

    def _put(self, picture: Pixels) -> None:
        try:
            self._frame(picture, self._duration_us)
        except OSError as error:
            self.discard()
            raise cannot_write(self._path, error) from None
        except OutputError:
            self.discard()
            raise

    @abstractmethod
    def _frame(self, picture: Pixels, duration_us: int) -> None: ...

    @abstractmethod
    def _end(self) -> None: ...


class Ticks:
    """Durations in whole ticks of a file's clock, rounded so that the error never adds up."""

    def __init__(self, tick_us: int, least: int = 0) -> None:
        self._tick_us = tick_us
        self._least = least
        self._time_us = 0
        self._ticks = 0

    def of(self, duration_us: int) -> int:
        self._time_us += duration_us
        ticks = max(self._least, round(self._time_us / self._tick_us) - self._ticks)
        self._ticks += ticks
        # A frame that had to be lengthened is not made up for by later ones: that would make the speed uneven.
        self._time_us = max(self._time_us, (self._ticks - 1) * self._tick_us)
        return ticks


def changed(before: Pixels | None, after: Pixels) -> tuple[int, int, int, int]:
    """The rectangle (x0, y0, x1, y1), half-open, outside of which both are equal; one pixel if they are equal, all of
    `after` if there is nothing before."""
    if before is None:
        return 0, 0, after.shape[1], after.shape[0]
    different = before != after
    rows, columns = np.flatnonzero(different.any(axis=1)), np.flatnonzero(different.any(axis=0))
    if rows.size == 0:
        return 0, 0, 1, 1
    return int(columns[0]), int(rows[0]), int(columns[-1]) + 1, int(rows[-1]) + 1
