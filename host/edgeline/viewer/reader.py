"""The link's thread: finds the device, runs the session, brings it back when it is lost.

It never touches the window. It writes into the model, takes what the user asked for out of the box of controls, and
tells the recording, if there is one, of each frame.
"""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable
from dataclasses import replace

from edgeline import discovery
from edgeline.errors import EdgelineError, StreamEndError
from edgeline.events import Connected, Frame, Refused
from edgeline.link import Link
from edgeline.protocol import Hello
from edgeline.session import Session
from edgeline.tap import Tap
from edgeline.transport import Transport
from edgeline.viewer.controls import Controls
from edgeline.viewer.log import Source
from edgeline.viewer.model import Measures, ViewModel
from edgeline.viewer.state import Phase

REOPEN_S = 0.5
MEASURE_S = 0.2
ASK_AGAIN_S = 3.0
"""A device that was refused may have been given another firmware behind the same USB bridge: it is asked again."""

SWITCH_S = 0.001
"""The window's thread waits at most so long for Python's lock, several times per drawing. With the usual 5 ms a flood
of text makes it 4 drawings a second, with this more than 50, and the link is hardly slower."""

OTHERS_EVERY_S = 10.0
"""How often ports that are not USB are asked: for seconds, in which a board that is plugged in would have to wait."""

MOST_WAITING = 2
"""INPUTs that the session may have under way before the box of controls gives it another one."""

Connect = Callable[[str], Transport]


class Reader(threading.Thread):
    """Runs until `stop`. `port` None: looks for a device on all ports.

    `connect` opens a port by its name and raises EdgelineError; `new_session` is asked for another session each time.
    """

    def __init__(
        self,
        model: ViewModel,
        controls: Controls,
        *,
        port: str | None,
        connect: Connect,
        new_session: Callable[[], Session] = Session,
        baud: int = 115200,
    ) -> None:
        super().__init__(name="edgeline-link", daemon=True)
        self._model = model
        self._controls = controls
        self._named = port
        self._connect = connect
        self._new_session = new_session
        self._baud = baud
        self._stopping = threading.Event()
        self._last: discovery.PortInfo | None = None
        self._refused = False
        self._had_link = False
        self._others_due = 0.0
        self.tap: Tap | None = None
        """what recordings are made with; None before the first port was open"""

    def run(self) -> None:
        interval = sys.getswitchinterval()
        sys.setswitchinterval(SWITCH_S)
        try:
            self._run()
        finally:
            sys.setswitchinterval(interval)

    def _run(self) -> None:
        while not self._stopping.is_set():
            transport = self._open()
            if transport is None:
                self._stopping.wait(REOPEN_S)
                continue
            if self.tap is None:
                self.tap = Tap(transport)
            else:
                self.tap.attach(transport)
            if not self._talk(self.tap):
                return

    def stop(self) -> None:
        """Ends the stream politely, as far as the port still lets it."""
        self._stopping.set()
        self.join(timeout=1.0)

    def _talk(self, tap: Tap) -> bool:
        """One life of the link. Returns whether there may be another one."""
        if not self._refused:
            self._model.enter(Phase.SILENT, time.monotonic(), tap.name)
        with Link(tap, self._new_session()) as link:
            try:
                measured = refused_at = None
                again = self._had_link
                while not self._stopping.is_set():
                    self._ask(link.session)
                    events = link.step()
                    now = time.monotonic()
                    for event in events:
                        if isinstance(event, Connected):
                            self._refused = False
                            self._controls.connect(event.hello, tap.one_way, again)
                            again, self._had_link = False, True  # within a session it is the session that tells
                        elif isinstance(event, Frame) and link.session.hello is not None:
                            tap.frame(link.session.hello, event)
                        elif isinstance(event, Refused):
                            self._refused, refused_at = True, now
                    self._model.take(events, now)
                    if measured is None or now - measured >= MEASURE_S:
                        measured = now
                        self._measure(link, now)
                    if refused_at is not None and now - refused_at > ASK_AGAIN_S:
                        return True
            except StreamEndError as error:
                self._model.enter(Phase.ENDED, time.monotonic(), None, str(error))
                self._model.say(Source.LINK, str(error))
                return False
            except EdgelineError as error:
                self._refused = False
                self._model.enter(Phase.LOST, time.monotonic(), None, str(error))
                self._model.say(Source.LINK, str(error))
        return True

    def _ask(self, session: Session) -> None:
        """Hands on what the user asked for, as much as the device has room for."""
        while session.hello is not None and session.inputs_waiting < MOST_WAITING:
            wish = self._controls.take()
            if wish is None:
                return
            session.input(*wish)

    def _measure(self, link: Link, now: float) -> None:
        session = link.session
        counts = replace(session.counts)
        self._model.measure(Measures(counts, session.quality(now), session.statistics(now), session.rate), now)

    def _open(self) -> Transport | None:
        """The port, open, or None and the reason in the model."""
        port = self._port()
        if port is None:
            return None
        try:
            transport = self._connect(port)
        except EdgelineError as error:
            phase = Phase.ABSENT if self._last is None else Phase.LOST
            self._model.enter(phase, time.monotonic(), port, str(error))
            return None
        known = (found for found in discovery.ports() if found.device == port)
        self._last = next(known, discovery.PortInfo(port, "", None))
        return transport

    def _port(self) -> str | None:
        """What is to be opened: where the device is now, the port that was named, or the one on which one answers."""
        if self._last is not None:
            port = discovery.moved(self._last)
            if port is not None or self._named is not None:
                return port or self._last.device
        return self._named or self._search()

    def _search(self) -> str | None:
        """The one port on which a device answers, or the one that the user has chosen of several: USB ports, and now
        and then the others, of which few computers have one with a board."""
        found = discovery.ports()
        answering = self._ask_for_hello([port.device for port in found if port.usb is not None])
        others = [port.device for port in found if port.usb is None]
        if not answering and others and time.monotonic() >= self._others_due:
            answering = self._ask_for_hello(others)
            self._others_due = time.monotonic() + OTHERS_EVERY_S
        if len(answering) == 1:
            return answering[0][0]
        if answering:
            self._model.offer(answering, time.monotonic())
            return self._answer()
        names = ", ".join(port.device for port in found)
        silence = f"no Edgeline answers on {names} at {self._baud:,} baud" if names else "no serial port"
        self._tell(f"{silence}: waiting for a board")
        return None

    def _ask_for_hello(self, ports: list[str]) -> list[tuple[str, Hello]]:
        if ports:
            self._tell(f"asking {', '.join(ports)}")
        hellos = zip(ports, discovery.probe_all(ports, self._baud), strict=True)
        return [(port, hello) for port, hello in hellos if hello is not None]

    def _tell(self, text: str) -> None:
        """Says what the search does, unless the user is told already that the device was lost."""
        if self._last is None:
            self._model.enter(Phase.SEARCHING, time.monotonic(), None, text)

    def _answer(self) -> str | None:
        """Waits until the user has chosen."""
        while not self._stopping.wait(0.05):
            port = self._model.chosen()
            if port is not None:
                return port
        return None
