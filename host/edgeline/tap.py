"""Recording what passes over a link, while something else uses it.

A Tap is a transport around another one. A recording begins with the link, or, in its middle, with the next verified
frame, which is told anew so that the recording depends on nothing before (`snapshot`).
"""

from __future__ import annotations

import contextlib
import threading
import time
from collections import deque
from dataclasses import dataclass

from edgeline.errors import OutputError
from edgeline.framing import Packet, Splitter
from edgeline.outfile import GrowingFile, cannot_write
from edgeline.protocol import Hello
from edgeline.recording import Direction, Header, Piece, RecordingWriter
from edgeline.session import Frame
from edgeline.snapshot import packets, snapshot
from edgeline.transport import Transport


@dataclass(frozen=True)
class Recorded:
    """How far a recording is: its file, its length, what it holds of the device's bytes and of the host's."""

    path: str
    seconds: float
    received: int
    sent: int


class RecordingFile:
    """A recording that is being written to `path`. Every method may raise OutputError; what was written stays."""

    def __init__(self, path: str, port: str) -> None:
        self._path = path
        self._port = port
        self._file = GrowingFile(path)
        self._writer: RecordingWriter | None = None
        self._start_us = 0
        self._counts = {Direction.FROM_DEVICE: 0, Direction.TO_DEVICE: 0}

    def begin(self) -> None:
        """The recording's time begins."""
        self._start_us = time.monotonic_ns() // 1000
        try:
            self._writer = RecordingWriter(self._file.stream, Header(time.time_ns() // 1000, self._port))
        except OSError as error:
            raise cannot_write(self._path, error) from None

    @property
    def begun(self) -> bool:
        return self._writer is not None

    @property
    def state(self) -> Recorded:
        seconds = (time.monotonic_ns() // 1000 - self._start_us) / 1e6 if self.begun else 0.0
        counts = self._counts
        return Recorded(self._path, seconds, counts[Direction.FROM_DEVICE], counts[Direction.TO_DEVICE])

    def add(self, direction: Direction, data: bytes) -> None:
        """Takes bytes that have just passed; none are a chance to write what waits."""
        assert self._writer is not None
        now_us = time.monotonic_ns() // 1000 - self._start_us
        try:
            if data:
                self._counts[direction] += len(data)
                self._writer.add(Piece(now_us, direction, data))
            else:
                self._writer.idle(now_us)
        except OSError as error:
            raise cannot_write(self._path, error) from None

    def finish(self) -> None:
        """Completes the file; without a byte from the device there will be none."""
        try:
            if self._writer is not None:
                self._writer.flush()
        except OSError as error:
            raise cannot_write(self._path, error) from None
        finally:
            self.keep()

    def keep(self) -> None:
        """Ends with what has been written. Never raises."""
        with contextlib.suppress(OSError):
            if self._counts[Direction.FROM_DEVICE]:
                self._file.commit()
        self._file.discard()


class Tap:
    """A transport that passes on what `transport` reads and writes, and records it from `start` to `stop`.

    `packetwise`: `read` gives one packet at a time, so that a recording that is stopped at a frame ends with it.
    Reading and writing belong to the link's thread; `start`, `stop` and `state` may be called from another.
    """

    def __init__(self, transport: Transport, packetwise: bool = False) -> None:
        self.transport = transport
        self._packetwise = packetwise
        self.failure: OutputError | None = None
        """why the last recording ended by itself: the disk is full, say"""
        self._lock = threading.Lock()
        self._file: RecordingFile | None = None
        self._waiting: deque[bytes] = deque()
        self._splitter = Splitter()
        self._seq: int | None = None

    @property
    def name(self) -> str:
        return self.transport.name

    @property
    def one_way(self) -> bool:
        return self.transport.one_way

    @property
    def baud(self) -> int:
        return self.transport.baud

    @property
    def state(self) -> Recorded | None:
        """How far the recording is, None if there is none."""
        with self._lock:
            return None if self._file is None else self._file.state

    def start(self, path: str, at_next_frame: bool) -> None:
        """Begins a recording, at once, which is right before the link's first byte, or with the next verified frame.

        Ends one that is under way. Raises OutputError if the file cannot be written.
        """
        self.stop()
        file = RecordingFile(path, self.name)
        if not at_next_frame:
            file.begin()
        with self._lock:
            self.failure = None
            self._file = file
            self._splitter = Splitter()
            self._seq = None

    def stop(self) -> Recorded | None:
        """Completes the recording. None if there was none, or it has not begun: then there is no file. Raises
        OutputError."""
        with self._lock:
            file, self._file = self._file, None
            if file is None:
                return None
            state = file.state
            file.finish()
            return state if state.received else None

    def frame(self, hello: Hello, frame: Frame) -> None:
        """To be told of every verified frame, before the next `read`: a recording may begin with it."""
        with self._lock:
            if self._file is None or self._file.begun:
                return
            if self._seq is None:  # the first half of its last packet came before `start`: the next frame will do
                return
            opening = snapshot(hello, frame.picture, frame.end, self._seq + 1 & 0xFF)
            try:
                self._file.begin()
                self._file.add(Direction.FROM_DEVICE, opening)
            except OutputError as error:
                self._fail(error)

    def attach(self, transport: Transport) -> None:
        """Goes on with another transport: the link was lost, and opened again."""
        self._waiting.clear()
        self.transport = transport

    def read(self) -> bytes:
        """As the transport's. While a recording waits for its first frame, one packet at a time, so that it is known
        which bytes come after that frame."""
        if not self._waiting:
            self._waiting.extend(packets(self.transport.read()))
        with self._lock:
            file = self._file
            if file is not None and not file.begun:
                packet = self._waiting.popleft() if self._waiting else b""
                for chunk in self._splitter.feed(packet):
                    self._seq = chunk.seq if isinstance(chunk, Packet) else None
                return packet
            count = min(1, len(self._waiting)) if self._packetwise else len(self._waiting)
            data = b"".join(self._waiting.popleft() for _ in range(count))
            self._record(Direction.FROM_DEVICE, data)
            return data

    def write(self, data: bytes) -> None:
        self.transport.write(data)
        with self._lock:
            if self._file is not None and self._file.begun:
                self._record(Direction.TO_DEVICE, data)

    def set_baud(self, rate: int) -> bool:
        return self.transport.set_baud(rate)

    def close(self) -> None:
        """Closes the transport; a recording stays to be stopped."""
        self.transport.close()

    def _record(self, direction: Direction, data: bytes) -> None:
        if self._file is None:
            return
        try:
            self._file.add(direction, data)
        except OutputError as error:
            self._fail(error)

    def _fail(self, error: OutputError) -> None:
        """The link goes on without its recording; `failure` says why."""
        self.failure = error
        if self._file is not None:
            self._file.keep()
        self._file = None
