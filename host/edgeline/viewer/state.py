"""What the viewer is waiting for, or what is wrong, in words: facts in, a sentence and what to do about it out."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto

from edgeline.quality import LinkQuality

SILENT_S = 2.0
"""An open port that says nothing for so long is worth some advice."""

BAD_SHARE = 0.1
"""From this share of failed frames on the link is called bad."""

OLD_S = 1.0
"""A picture older than this is no live picture; its age is told."""


_BAD_LINK_ADVICE = "Try a lower baud rate, a shorter cable, a common ground."


class Mood(Enum):
    GOOD = auto()
    BUSY = auto()
    BAD = auto()


class Phase(Enum):
    SEARCHING = auto()
    """looking for a port on which an Edgeline answers"""
    CHOOSING = auto()
    """there are several; the user has to say which"""
    ABSENT = auto()
    """the port that was named does not open"""
    SILENT = auto()
    """it is open; no HELLO yet"""
    GREETED = auto()
    """HELLO is here, the first frame is not"""
    STREAMING = auto()
    STALLED = auto()
    """frames came, and then nothing for a while"""
    LOST = auto()
    """the port is gone"""
    REFUSED = auto()
    """the device cannot be served: another version, say"""
    ENDED = auto()
    """a stream with an end, a recording or a pipe, has been shown"""


@dataclass(frozen=True)
class Situation:
    """`detail` is the phase's own text: why a port does not open, say. `since`: when the phase began."""

    phase: Phase
    since: float
    port: str = ""
    detail: str = ""
    rate: int = 0
    """of the link in baud, 0: it has none"""
    bytes_received: int = 0
    quality: LinkQuality | None = None
    frame_age: float | None = None
    """seconds since the last proven frame, None before the first"""
    mixed: bool = False
    """the picture is a proven mirror of what was sent, but of lines of several frames (ROLL)"""
    held: int | None = None
    """the number of the frame that the user holds on the screen"""


@dataclass(frozen=True)
class Words:
    """One line for the status bar; what to do about it, for the place where the picture should be."""

    mood: Mood
    line: str
    advice: str = ""


def in_words(now: Situation, time: float) -> Words:
    """The situation at `time`, in seconds of the clock that `since` is from."""
    if now.phase is Phase.STREAMING:
        return _streaming(now)
    waited = time - now.since
    shown = "" if now.frame_age is None else f"; the picture is {_age(now.frame_age)} old"
    port = now.port
    if now.phase is Phase.SEARCHING:
        return Words(Mood.BUSY, now.detail or "looking for a board", "Plug the board in, or name its port with -p.")
    if now.phase is Phase.CHOOSING:
        return Words(Mood.BUSY, "more than one Edgeline answers: press a number", now.detail)
    if now.phase is Phase.ABSENT:
        return Words(Mood.BUSY, f"waiting for {port}", f"{now.detail}\nThe viewer goes on as soon as it opens.")
    if now.phase is Phase.SILENT:
        return _silent(now, waited)
    if now.phase is Phase.GREETED and now.quality is not None and now.quality.failed:
        return Words(
            Mood.BAD,
            f"bad link: no frame could be proven yet, {now.quality.failed} failed",
            _BAD_LINK_ADVICE,
        )
    if now.phase is Phase.GREETED:
        size = f", {now.bytes_received / 1000:,.0f} kB so far" if now.bytes_received > 2000 else ""
        return Words(Mood.BUSY, f"waiting for the first frame{size}", "The device has answered and was told to start.")
    if now.phase is Phase.STALLED:
        return Words(
            Mood.BUSY,
            f"silent for {waited + SILENT_S:.0f} s: asking again{shown}",
            "The device has stopped sending. Is it still running?",
        )
    if now.phase is Phase.LOST:
        return Words(Mood.BAD, f"lost {port}: reconnecting{shown}", now.detail)
    if now.phase is Phase.REFUSED:
        return Words(Mood.BAD, now.detail, now.detail)
    return Words(Mood.GOOD, "the stream has ended; this is its last frame", now.detail)


def _streaming(now: Situation) -> Words:
    quality, age = now.quality, now.frame_age or 0.0
    paused = now.held is not None
    held = f"frame {now.held} is held; " if paused else ""
    streaming = "streaming, lines of several frames" if now.mixed else "streaming"
    if quality is None or quality.failed == 0:
        late = f"; the picture is {_age(age)} old" if age > OLD_S and not paused else ""
        return Words(Mood.BUSY if paused or late else Mood.GOOD, f"{held}{streaming}{late}")
    share = f"{max(1, round(100 * quality.failed_share))} % of the frames fail"
    if quality.failed_share < BAD_SHARE:
        return Words(Mood.BUSY, f"{held}{streaming}; {share}, their lines are asked for anew")
    errors = "" if quality.bit_error_rate is None else f", bit errors about {quality.bit_error_rate:.0e}"
    return Words(
        Mood.BAD,
        f"{held}bad link: {share}{errors}; the last proven one is {_age(age)} old",
        _BAD_LINK_ADVICE,
    )


def _silent(now: Situation, waited: float) -> Words:
    rate = f" at {now.rate:,} baud" if now.rate else ""
    if waited < SILENT_S:
        return Words(Mood.BUSY, f"{now.port} is open; waiting for the device's HELLO")
    if now.bytes_received == 0:
        return Words(
            Mood.BUSY,
            f"{now.port} is open, and nothing arrives{rate}",
            "Is an Edgeline firmware running there? Some boards send after a reset only, or on other pins.",
        )
    return Words(
        Mood.BUSY,
        f"{now.port}: {now.bytes_received:,} bytes{rate}, and no HELLO among them",
        "Is the baud rate right? -b sets it. Is it an Edgeline firmware?"
        if now.rate
        else "Is an Edgeline firmware running there?",
    )


def _age(seconds: float) -> str:
    return f"{seconds:.1f} s" if seconds < 60 else f"{seconds / 60:.0f} min"
