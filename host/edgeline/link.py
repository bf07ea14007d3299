"""A session on a transport: the one place where time passes and bytes move.

Everything above it (the command line, the viewer, `edgeline.open`) calls `Link.step` or what is built on it.
"""

from __future__ import annotations

import contextlib
import time
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import replace
from types import TracebackType

from edgeline.errors import DeviceError, EdgelineError, StreamEndError, StreamError
from edgeline.events import Event, Frame, Log, RateChanged, Refused, SetRate
from edgeline.protocol import Control, Hello
from edgeline.quality import LinkQuality, Statistics
from edgeline.session import Session
from edgeline.transport import Transport

HELLO_TIMEOUT_S = 5.0
"""A board that the opened port has reset needs about two seconds to say HELLO, one whose host went away at a higher
rate three."""

FRAME_TIMEOUT_S = 30.0
"""One raw 320x240 frame takes 13.4 s at 115200 baud."""

RATE_TIMEOUT_S = 15.0
"""Of two attempts to change the rate."""


class Link:
    """Owns `transport` and closes it. An iterator over verified frames, without an end.

    `on_log` gets the device's text, fault reports included, while frames or a HELLO are waited for. `timeout_s` is how
    long a frame is waited for.
    """

    def __init__(
        self,
        transport: Transport,
        session: Session | None = None,
        on_log: Callable[[str], None] | None = None,
        timeout_s: float = FRAME_TIMEOUT_S,
    ) -> None:
        self.transport = transport
        self.session = session or Session()
        self.session.one_way = transport.one_way
        self.session.baud = transport.baud
        self.on_log = on_log
        self.timeout_s = timeout_s
        self.rate_words = ""
        """what came of the last attempt to change the link's rate"""
        self._frames: deque[Frame] = deque()

    def __enter__(self) -> Link:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def __iter__(self) -> Iterator[Frame]:
        """Verified frames; ends with a finite stream (a capture, a pipe) that held one at least.

        In mode roll, those whose `mixed` is set are no single moment's pictures.
        """
        seen = False
        while True:
            try:
                frame = self.next_frame()
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

    @property
    def quality(self) -> LinkQuality:
        """How good the link was in the last five seconds."""
        return self.session.quality(time.monotonic())

    @property
    def statistics(self) -> Statistics:
        """What it carried in the last five seconds, and what that cost."""
        return self.session.statistics(time.monotonic())

    def step(self) -> list[Event]:
        """Sends what is due, waits a moment for bytes, and returns what they meant. Raises StreamError."""
        events = self._carry_out(self.session.tick(time.monotonic()))
        events += self._carry_out(self.session.receive(self.transport.read(), time.monotonic()))
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

    def next_frame(self, timeout_s: float | None = None, settled: bool = False) -> Frame:
        """The next verified frame; if `settled`, the first that shows all that was asked for and is not mixed.

        Raises StreamError when there is none within `timeout_s` (None: the link's own) or the link ends.
        """
        wait_s = self.timeout_s if timeout_s is None else timeout_s
        deadline = time.monotonic() + wait_s
        self.wait_hello(min(wait_s, HELLO_TIMEOUT_S))
        while True:
            while self._frames:
                frame = self._frames.popleft()
                if not settled or (frame.shows_inputs and not frame.mixed):
                    return frame
            if time.monotonic() >= deadline:
                raise StreamError(self._no_frame(wait_s))
            self._collect()

    def control(self, control: str | int, value: int) -> None:
        """Sets one of the device's controls: by its name (scene, frame, pause, step, yaw, pitch, zoom, pan_x, pan_y,
        shading, texture_error, antialiasing, view; protocol.Control says what they do), or by its number.

        Called before the first frame is asked for, that one shows it; later, the first one with `shows_inputs` does,
        which `next_frame(settled=True)` waits for. Raises EdgelineError on an unknown name or a number that does not
        fit, DeviceError if the device does not take it.
        """
        if isinstance(control, str):
            if control.upper() not in Control.__members__:
                names = ", ".join(member.name.lower() for member in Control)
                raise EdgelineError(f"no control '{control}': there are {names}; others have numbers")
            control = Control[control.upper()]
        self.session.input(control, value)
        self._frames = deque(replace(frame, shows_inputs=False) for frame in self._frames)
        self._flush()

    def request_baud(self, rate: int = 0) -> int:
        """Changes the link's rate to `rate`, 0 for the device's highest, and returns the one that it has then.

        A rate that does not work is given up for the one of the beginning; `rate_words` says what happened. Raises
        DeviceError if the device cannot change its link's rate, StreamError if the link ends.
        """
        self.wait_hello()
        self.session.request_baud(rate)
        deadline = time.monotonic() + RATE_TIMEOUT_S
        while self.session.retuning and time.monotonic() < deadline:
            self._collect()
        return self.session.rate

    def close(self) -> None:
        """Tells the device to stop, as far as the link still holds, and closes the port."""
        self.session.close()
        with contextlib.suppress(EdgelineError):
            self._flush()
        self.transport.close()

    def _collect(self) -> None:
        for event in self.step():
            if isinstance(event, Refused):
                raise DeviceError(f"{self.transport.name}: {event.error}")
            if isinstance(event, Frame):
                self._frames.append(event)
            if isinstance(event, Log) and self.on_log is not None:
                self.on_log(event.text)

    def _carry_out(self, events: list[Event]) -> list[Event]:
        """Does what the events ask of the port, and sends what the session has to say."""
        told = list(events)
        for event in events:
            if isinstance(event, SetRate) and not self._set_rate(event):
                told += self.session.refuse_rate(time.monotonic())
        for event in told:
            if isinstance(event, RateChanged):
                self.rate_words = event.why
        self._flush()
        return told

    def _set_rate(self, event: SetRate) -> bool:
        return self.transport.set_baud(event.rate) or self.transport.set_baud(event.asked)

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

    def _no_frame(self, seconds: float) -> str:
        waiting = self.session.inputs_waiting
        wanted = "no verified frame that shows what was asked for" if waiting else "no verified frame"
        return (
            f"{self.transport.name}: {wanted} within {seconds:g} s "
            f"({self.session.counts.damaged} damaged pieces): check the cable and the baud rate (-b)"
        )
