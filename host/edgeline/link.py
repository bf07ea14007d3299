"""A session on a transport: the one place where time passes and bytes move.

Everything above it (the command line, the viewer, `edgeline.open`) calls `Link.step` or what is built on it.
"""

from __future__ import annotations

import contextlib
import time
from collections import deque
from collections.abc import Callable, Iterator
from types import TracebackType

from edgeline.errors import DeviceError, EdgelineError, StreamEndError, StreamError
from edgeline.protocol import Control, Hello
from edgeline.session import Event, Frame, Log, Refused, Session
from edgeline.transport import Transport

HELLO_TIMEOUT_S = 5.0
"""A board that the opened port has reset needs about two seconds to say HELLO."""

FRAME_TIMEOUT_S = 30.0
"""One raw 320x240 frame takes 13.4 s at 115200 baud."""


class Link:
    """Owns `transport` and closes it. An iterator over verified frames, without an end.

    `on_log` gets the device's text, fault reports included, while frames or a HELLO are waited for.
    """

    def __init__(
        self, transport: Transport, session: Session | None = None, on_log: Callable[[str], None] | None = None
    ) -> None:
        self.transport = transport
        self.session = session or Session()
        self.on_log = on_log
        self.timeout_s = FRAME_TIMEOUT_S
        self._frames: deque[Frame] = deque()

    def __enter__(self) -> Link:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def __iter__(self) -> Iterator[Frame]:
        """Verified frames; ends with a finite stream (a capture, a pipe) that held one at least."""
        seen = False
        while True:
            try:
                frame = self.next_frame(self.timeout_s)
            except StreamEndError:
                if seen:
                    return
                raise
            seen = True
            yield frame

    @property
    def hello(self) -> Hello:
        """What the device is. Waits for it: raises DeviceError if nothing answers, StreamError if the link ends."""
        return self.session.hello or self.wait_hello()

    def step(self) -> list[Event]:
        """Sends what is due, waits a moment for bytes, and returns what they meant. Raises StreamError."""
        events = self.session.tick(time.monotonic())
        self._flush()
        events += self.session.receive(self.transport.read(), time.monotonic())
        self._flush()
        return events

    def wait_hello(self, timeout_s: float = HELLO_TIMEOUT_S) -> Hello:
        """The device's HELLO. Raises DeviceError when none comes within `timeout_s` or it cannot be served."""
        deadline = time.monotonic() + timeout_s
        while self.session.hello is None:
            if time.monotonic() >= deadline:
                raise DeviceError(self._silence(f"within {timeout_s:g} s"))
            try:
                self._collect()
            except StreamEndError:
                raise DeviceError(self._silence("before the stream's end")) from None
        return self.session.hello

    def next_frame(self, timeout_s: float = FRAME_TIMEOUT_S) -> Frame:
        """The next verified frame. Raises StreamError when there is none within `timeout_s` or the link ends."""
        deadline = time.monotonic() + timeout_s
        self.wait_hello(min(timeout_s, HELLO_TIMEOUT_S))
        while not self._frames:
            if time.monotonic() >= deadline:
                raise StreamError(
                    f"{self.transport.name}: no verified frame within {timeout_s:g} s "
                    f"({self.session.counts.damaged} damaged pieces): check the cable and the baud rate (-b)"
                )
            self._collect()
        return self._frames.popleft()

    def _collect(self) -> None:
        for event in self.step():
            if isinstance(event, Refused):
                raise DeviceError(f"{self.transport.name}: {event.error}")
            if isinstance(event, Frame):
                self._frames.append(event)
            if isinstance(event, Log) and self.on_log is not None:
                self.on_log(event.text)

    def control(self, control: str | int, value: int) -> None:
        """Sets "scene" (its index), "frame" (the scene's next one), "pause" (1 or 0), or one of the program's own
        controls, 128..255.

        Called before the first frame is asked for, that one shows it; later, one of the next three frames is the first.
        Raises EdgelineError on an unknown name, DeviceError if the device takes no INPUT.
        """
        if isinstance(control, str):
            if control.upper() not in Control.__members__:
                raise EdgelineError(f"no control '{control}': scene, frame and pause have names, others have numbers")
            control = Control[control.upper()]
        self.session.input(control, value)
        self._flush()

    def close(self) -> None:
        """Tells the device to stop, as far as the link still holds, and closes the port."""
        self.session.stop()
        with contextlib.suppress(EdgelineError):
            self._flush()
        self.transport.close()

    def _flush(self) -> None:
        data = self.session.bytes_to_send()
        if data:
            self.transport.write(data)

    def _silence(self, when: str) -> str:
        name, counts = self.transport.name, self.session.counts
        if counts.bytes_received == 0:
            return f"{name}: nothing answers {when}: is an Edgeline firmware running there?"
        return (
            f"{name}: {counts.bytes_received} bytes {when}, but no HELLO among them: "
            "check the baud rate (-b), and that an Edgeline firmware is running there"
        )
