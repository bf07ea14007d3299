"""What the viewer shows, without a window: events in, a View out. Safe between the link's thread and the window's."""

from __future__ import annotations

import threading
from collections import deque
from dataclasses import dataclass
from enum import Enum

from edgeline.codec import Pixels
from edgeline.protocol import Hello
from edgeline.session import Connected, Counts, Damage, Event, Frame, Log, Refused, Stalled

RATE_WINDOW_S = 2.0
LOG_LINES = 200
NOTICE_S = 3.0

Rows = list[tuple[str, str]]


class Mood(Enum):
    GOOD = "good"
    BUSY = "busy"
    BAD = "bad"


@dataclass(frozen=True)
class View:
    """One moment. `serial` grows with every picture that has to be drawn; `picture` is None until the first."""

    serial: int
    picture: Pixels | None
    mood: Mood
    state: str
    title: str
    subtitle: str
    status: str
    sections: dict[str, Rows]
    log: tuple[str, ...]


class ViewModel:
    """The latest verified frame, the rates of the last two seconds, the state in words."""

    def __init__(self, port: str) -> None:
        self.port = port
        self._lock = threading.Lock()
        self._hello: Hello | None = None
        self._frame: Frame | None = None
        self._serial = 0
        self._frozen: Frame | None = None
        self._mood, self._state = Mood.BUSY, "waiting for the device's HELLO"
        self._notice, self._notice_until = "", 0.0
        self._counts = Counts()
        self._frame_times: deque[float] = deque()
        self._byte_marks: deque[tuple[float, int]] = deque()
        self._log: deque[str] = deque(maxlen=LOG_LINES)
        self._frames = 0

    @property
    def frames(self) -> int:
        """Verified frames since the viewer began."""
        return self._frames

    @property
    def paused(self) -> bool:
        return self._frozen is not None

    @property
    def shown(self) -> Frame | None:
        """The frame that is on the screen."""
        return self._frozen or self._frame

    def take(self, events: list[Event], counts: Counts, now: float) -> None:
        """What the link has brought. `counts` is the session's, read here and not kept."""
        with self._lock:
            for event in events:
                self._take(event, now)
            self._counts = Counts(**vars(counts))
            self._byte_marks.append((now, counts.bytes_received))
            self._forget(now)

    def lost(self, reason: str) -> None:
        """The link is gone; someone is trying to open it again."""
        with self._lock:
            self._mood, self._state = Mood.BAD, "gone: waiting for it to come back"
            self._log.append(reason)
            self._byte_marks.clear()
            self._frame_times.clear()

    def reopened(self, port: str) -> None:
        with self._lock:
            self.port = port
            self._mood, self._state = Mood.BUSY, "waiting for the device's HELLO"

    def toggle_pause(self) -> None:
        """Freezes the picture or lets it run again. The link goes on meanwhile."""
        with self._lock:
            self._frozen = self._frame if self._frozen is None else None
            self._serial += 1

    def notify(self, text: str, now: float) -> None:
        """Shows `text` in the status line for a moment."""
        with self._lock:
            self._notice, self._notice_until = text, now + NOTICE_S
            self._log.append(text)

    def view(self, now: float) -> View:
        with self._lock:
            self._forget(now)
            shown = self._frozen or self._frame
            hello = self._hello
            rate = self._frame_rate()
            bytes_per_second = self._byte_rate()
            state = "paused" if self._frozen is not None else self._state
            facts = [state, f"{rate:.1f} frames/s", f"{bytes_per_second / 1000:.1f} kB/s"]
            if shown is not None:
                facts.append(f"render {_milliseconds(shown.end.render_us)}")
            status = self._notice if now < self._notice_until else "   ".join(facts)
            return View(
                serial=self._serial,
                picture=None if shown is None else shown.picture,
                mood=Mood.BUSY if self._frozen is not None else self._mood,
                state=state,
                title=hello.target if hello else self.port,
                subtitle=f"{hello.firmware}, {hello.width} x {hello.height}" if hello else "",
                status=status,
                sections=self._sections(shown, rate, bytes_per_second),
                log=tuple(self._log),
            )

    def _take(self, event: Event, now: float) -> None:
        if isinstance(event, Frame):
            self._frame = event
            self._frames += 1
            self._frame_times.append(now)
            self._mood, self._state = Mood.GOOD, "streaming"
            if self._frozen is None:
                self._serial += 1
        elif isinstance(event, Connected):
            self._hello = event.hello
            self._mood, self._state = Mood.BUSY, "waiting for the first frame"
            self._log.append(
                "the device has been restarted" if event.restarted else f"connected to {event.hello.target}"
            )
        elif isinstance(event, Damage):
            if self._hello is not None:  # before it, this is the tail of a packet that was under way
                self._mood, self._state = Mood.BUSY, "damaged: lines asked for anew"
                self._log.append(event.reason)
        elif isinstance(event, Stalled):
            self._mood, self._state = Mood.BUSY, f"silent for {event.seconds:.0f} s: asking again"
        elif isinstance(event, Log):
            self._log.extend(event.text.splitlines())
        elif isinstance(event, Refused):
            self._mood, self._state = Mood.BAD, str(event.error)

    def _forget(self, now: float) -> None:
        while self._frame_times and self._frame_times[0] < now - RATE_WINDOW_S:
            self._frame_times.popleft()
        while len(self._byte_marks) > 2 and self._byte_marks[0][0] < now - RATE_WINDOW_S:
            self._byte_marks.popleft()

    def _frame_rate(self) -> float:
        if len(self._frame_times) < 2:
            return 0.0
        span = self._frame_times[-1] - self._frame_times[0]
        return (len(self._frame_times) - 1) / span if span > 0 else 0.0

    def _byte_rate(self) -> float:
        if len(self._byte_marks) < 2:
            return 0.0
        (t0, b0), (t1, b1) = self._byte_marks[0], self._byte_marks[-1]
        return (b1 - b0) / (t1 - t0) if t1 > t0 else 0.0

    def _sections(self, shown: Frame | None, rate: float, bytes_per_second: float) -> dict[str, Rows]:
        counts = self._counts
        sections: dict[str, Rows] = {
            "Link": [
                ("frames/s", f"{rate:.1f}"),
                ("kB/s", f"{bytes_per_second / 1000:.1f}"),
                ("verified", f"{self._frames:,}"),
                ("damaged", f"{counts.damaged:,}"),
                ("asked anew", f"{counts.keys_sent:,}"),
            ]
        }
        if shown is not None:
            end = shown.end
            sections["Frame"] = [
                ("number", str(end.frame)),
                ("render", _milliseconds(end.render_us)),
                ("encode and send", _milliseconds(end.encode_us)),
                ("bytes", f"{end.wire_bytes:,}"),
                ("not sent before it", str(end.dropped)),
            ]
            sections["Work"] = [(name.replace("_", " "), f"{count:,}") for name, count in shown.counters.items()]
        return sections


def _milliseconds(us: int) -> str:
    return f"{us / 1000:.1f} ms"


def largest_scale(width: int, height: int, room_x: int, room_y: int) -> int:
    """The largest whole factor by which a picture fits into the room, 1 at least."""
    return max(1, min(room_x // width, room_y // height))
