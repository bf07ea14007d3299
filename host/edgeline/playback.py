"""A recording as a port: every command that takes `-p` reads one as it would read the device."""

from __future__ import annotations

import time
from contextlib import ExitStack

from edgeline.errors import StreamEndError
from edgeline.recording import Direction, Header, Piece, opened

READ_TIMEOUT_S = 0.05
"""How long a read waits at most for bytes that are not due; as the other transports do."""


class RecordingTransport:
    """What the device of the recording `path` said; what the host says now goes nowhere.

    `speed` 1 keeps the recorded times, 2 halves them, None waits for nothing. Raises EdgelineError if the file cannot
    be read, or is no recording.
    """

    one_way = True
    baud = 0

    def __init__(self, path: str, speed: float | None = None) -> None:
        self.name = path
        self._speed = speed
        self._file = ExitStack()
        reader = self._file.enter_context(opened(path))
        self.header: Header = reader.header
        self.time_us = 0
        """when, in the recording, the bytes passed that were read last"""
        self._pieces = (piece for piece in reader if piece.direction is Direction.FROM_DEVICE)
        self._next: Piece | None = None
        self._began: float | None = None

    def read(self) -> bytes:
        """The next bytes, b"" while they are not due. Raises StreamEndError at the end, StreamError at damage."""
        if self._next is None:
            self._next = next(self._pieces, None)
        if self._next is None:
            raise StreamEndError(f"{self.name}: the recording has ended")
        if self._speed is not None and not self._is_due(self._next.time_us / 1e6 / self._speed):
            return b""
        piece, self._next = self._next, None
        self.time_us = piece.time_us
        return piece.data

    def write(self, data: bytes) -> None:
        """There is nobody to tell."""

    def set_baud(self, rate: int) -> bool:
        """A file has no rate, so any will do."""
        return True

    def close(self) -> None:
        self._file.close()

    def _is_due(self, after_s: float) -> bool:
        now = time.monotonic()
        if self._began is None:
            self._began = now
        wait_s = self._began + after_s - now
        time.sleep(min(max(wait_s, 0.0), READ_TIMEOUT_S))
        return wait_s <= READ_TIMEOUT_S
