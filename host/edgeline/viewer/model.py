"""What the viewer shows, without a window: events in, a View out.

The only thing that the link's thread and the window's thread share, besides the box of controls; each call takes the
lock for a moment, and everything in it is bounded.
"""

from __future__ import annotations

import threading
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from edgeline.codec import Pixels
from edgeline.events import Connected, Damage, Event, Frame, Log, Partial, RateChanged, Refused, Stalled
from edgeline.protocol import Hello
from edgeline.quality import LinkQuality, Statistics
from edgeline.session import Counts
from edgeline.viewer.history import History, Track
from edgeline.viewer.log import LINES, Line, Source
from edgeline.viewer.log import Log as LogLines
from edgeline.viewer.state import Phase, Situation, Words, in_words

NOTICE_S = 4.0
PARTIAL_AFTER_S = 0.5
"""The lines of a frame that failed are shown, the doubtful ones dimmed, if no whole one came for so long."""


@dataclass(frozen=True)
class Measures:
    """The link's own figures, as they were a moment ago."""

    counts: Counts
    quality: LinkQuality
    statistics: Statistics
    rate: int
    """in baud, 0: the link has none"""


@dataclass(frozen=True)
class View:
    """One moment. `serial` grows with every picture that has to be drawn; `picture` is None until the first.

    `proven`: None, or a bool for each line, where the picture is one that failed.
    """

    serial: int
    picture: Pixels | None
    frame: Frame | None
    proven: npt.NDArray[np.bool_] | None
    words: Words
    notice: str
    hello: Hello | None
    port: str
    phase: Phase
    measures: Measures | None


class ViewModel:
    """The latest verified frame, the last ten seconds of its numbers, the state of the link, the log."""

    def __init__(self, port: str = "") -> None:
        self._lock = threading.Lock()
        self._situation = Situation(Phase.SEARCHING, 0.0, port)
        self._hello: Hello | None = None
        self._frame: Frame | None = None
        self._partial: Partial | None = None
        self._frozen: Frame | None = None
        self._stepping = False
        self._arrived = 0.0
        self._serial = 0
        self._frames = 0
        self._notice, self._notice_until = "", 0.0
        self._measures: Measures | None = None
        self._history = History()
        self._log = LogLines()
        self._choice: tuple[str, ...] = ()
        self._chosen: str | None = None

    @property
    def frames(self) -> int:
        """Verified frames since the viewer began."""
        return self._frames

    @property
    def paused(self) -> bool:
        return self._frozen is not None

    @property
    def shown(self) -> Frame | None:
        """The verified frame that is on the screen, or was when it was last whole."""
        return self._frozen or self._frame

    # From the link's thread.

    def enter(self, phase: Phase, now: float, port: str | None = None, detail: str = "") -> None:
        """The link is in another phase; entering the one that it is in changes its detail alone."""
        with self._lock:
            self._enter(phase, now, port, detail)

    def take(self, events: Sequence[Event], now: float) -> None:
        """What the link has brought."""
        for event in events:
            with self._lock:  # for each by itself: there may be thousands, and the window waits
                self._take(event, now)
        with self._lock:
            self._log.settle(now)

    def measure(self, measures: Measures, now: float) -> None:
        with self._lock:
            before = self._measures.counts.failed if self._measures else 0
            self._history.fail(max(0, measures.counts.failed - before), now)
            self._measures = measures

    def say(self, source: Source, text: str) -> None:
        """A line for the log."""
        with self._lock:
            self._log.add(source, text)

    def offer(self, ports: Sequence[tuple[str, Hello]], now: float) -> None:
        """Several devices answer: the user is asked for one of these."""
        lines = "\n".join(f"{i}   {port}   {hello.target}" for i, (port, hello) in enumerate(ports[:9], 1))
        with self._lock:
            self._choice = tuple(port for port, _ in ports[:9])
            self._enter(Phase.CHOOSING, now, None, lines)

    def chosen(self) -> str | None:
        """The port that the user has chosen since the last call, if any."""
        with self._lock:
            port, self._chosen = self._chosen, None
            return port

    # From the window's thread.

    def choose(self, number: int) -> bool:
        """The user's answer, from 1 on. Returns whether there was a question."""
        with self._lock:
            asked = self._situation.phase is Phase.CHOOSING
            if asked and 1 <= number <= len(self._choice):
                self._chosen = self._choice[number - 1]
            return asked

    def toggle_pause(self) -> None:
        """Holds the picture or lets it go. The link goes on meanwhile."""
        with self._lock:
            self._stepping = False
            self._frozen = self._frame if self._frozen is None else None
            self._serial += 1

    def resume(self) -> None:
        if self.paused:
            self.toggle_pause()

    def step(self) -> None:
        """Holds the picture; if it is held, lets the next frame through and holds that."""
        with self._lock:
            if self._frozen is None:
                self._frozen = self._frame
                self._serial += 1
            else:
                self._stepping = True

    def notify(self, text: str, now: float) -> None:
        """Shows `text` in the status line for a moment, and logs it."""
        with self._lock:
            self._notice, self._notice_until = text, now + NOTICE_S
            self._log.add(Source.VIEWER, text)

    def view(self, now: float) -> View:
        with self._lock:
            frame = self._frozen or self._frame
            partial = self._partial
            if self._frozen is not None or now - self._arrived < PARTIAL_AFTER_S:
                partial = None
            measures = self._measures
            situation = replace(
                self._situation,
                rate=measures.rate if measures else 0,
                bytes_received=measures.counts.bytes_received if measures else 0,
                quality=measures.quality if measures else None,
                frame_age=None if self._frame is None else max(0.0, now - self._arrived),
                mixed=frame is not None and frame.mixed,
                held=None if self._frozen is None else self._frozen.number,
            )
            picture = partial.picture if partial is not None else frame.picture if frame is not None else None
            return View(
                serial=self._serial,
                picture=picture,
                frame=frame,
                proven=None if partial is None else partial.proven,
                words=in_words(situation, now),
                notice=self._notice if now < self._notice_until else "",
                hello=self._hello,
                port=situation.port,
                phase=situation.phase,
                measures=measures,
            )

    def series(self) -> tuple[str, ...]:
        """The names of what can be drawn."""
        with self._lock:
            return self._history.names

    def latest(self) -> dict[str, float]:
        """The last verified frame's numbers, by the names of `series`."""
        with self._lock:
            return self._history.latest()

    def track(self, name: str, now: float) -> tuple[Track, npt.NDArray[np.int64]]:
        """One series' last ten seconds, and the frames that failed meanwhile."""
        with self._lock:
            return self._history.track(name, now), self._history.failures(now)

    def log_since(self, number: int, most: int = LINES) -> tuple[list[Line], int]:
        """New lines of the log, `most` at most, and the number to ask with the next time; 0 at first."""
        with self._lock:
            return self._log.since(number, most)

    def _enter(self, phase: Phase, now: float, port: str | None, detail: str) -> None:
        before = self._situation
        since = before.since if phase is before.phase and port in (None, before.port) else now
        self._situation = Situation(phase, since, before.port if port is None else port, detail)
        if phase in (Phase.SEARCHING, Phase.ABSENT, Phase.LOST):
            self._measures = None

    def _take(self, event: Event, now: float) -> None:
        if isinstance(event, Frame):
            self._take_frame(event, now)
        elif isinstance(event, Connected):
            self._connected(event, now)
        elif isinstance(event, Partial):
            self._partial = event
            self._serial += 1
        elif isinstance(event, Damage):
            if self._hello is not None:  # before it, this is the tail of a packet that was under way
                self._log.damage(event.reason, now)
        elif isinstance(event, Stalled):
            self._enter(Phase.STALLED, now, None, "")
            self._log.add(Source.LINK, f"nothing for {event.seconds:.0f} s: asking for a HELLO")
        elif isinstance(event, Log):
            self._log.add(Source.DEVICE, event.text)
        elif isinstance(event, RateChanged):
            self._log.add(Source.LINK, event.why)
        elif isinstance(event, Refused):
            self._enter(Phase.REFUSED, now, None, str(event.error))
            self._log.add(Source.LINK, str(event.error))

    def _take_frame(self, frame: Frame, now: float) -> None:
        self._frame = frame
        self._partial = None
        self._arrived = now
        self._frames += 1
        self._history.add(frame, now)
        if self._situation.phase is not Phase.STREAMING:
            self._enter(Phase.STREAMING, now, None, "")
        if self._stepping:
            self._frozen, self._stepping = frame, False
        if self._frozen is None or self._frozen is frame:
            self._serial += 1

    def _connected(self, event: Connected, now: float) -> None:
        known, self._hello = self._hello, event.hello
        self._history.restart()
        restarted = event.restarted or (known is not None and known.boot_id != event.hello.boot_id)
        what = "the device has been started anew" if restarted else f"connected to {event.hello.target}"
        self._log.add(Source.LINK, f"{what}: {event.hello.firmware}")
        self._enter(Phase.GREETED, now, None, "")
