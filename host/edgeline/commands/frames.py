"""Taking verified frames from a link until there are enough, the link ends, or the user does."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from types import FrameType, TracebackType

from edgeline.commands.report import complain, progress
from edgeline.errors import EdgelineError, StreamEndError, StreamError
from edgeline.link import HELLO_TIMEOUT_S, Link
from edgeline.session import Frame
from edgeline.summary import Summary


class Interrupts:
    """Ctrl+C and SIGTERM end the waiting, not the writing: no frame is lost half-way. A second one ends everything."""

    def __init__(self) -> None:
        self._asked = False
        self._waiting = False
        self._before: list[tuple[signal.Signals, object]] = []

    def __enter__(self) -> Interrupts:
        if threading.current_thread() is threading.main_thread():
            for number in (signal.SIGINT, signal.SIGTERM):
                if signal.getsignal(number) != signal.SIG_IGN:  # what a shell starts with & does not hear Ctrl+C
                    self._before.append((number, signal.signal(number, self._ask)))
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for number, handler in self._before:
            signal.signal(number, handler)  # type: ignore[arg-type]

    @contextmanager
    def waiting(self) -> Iterator[None]:
        """Around what may be interrupted, by KeyboardInterrupt."""
        self._waiting = True
        try:
            if self._asked:
                raise KeyboardInterrupt
            yield
        finally:
            self._waiting = False

    def _ask(self, _number: int, _frame: FrameType | None) -> None:
        again, self._asked = self._asked, True
        if self._waiting or again:
            raise KeyboardInterrupt


@dataclass
class Taken:
    """What came of it. `failure` is why it ended, None if there were enough or the user ended it."""

    summary: Summary | None = None
    failure: EdgelineError | None = None

    @property
    def frames(self) -> int:
        return 0 if self.summary is None else self.summary.frames

    def outcome(self, wanted: int | None, kept: str) -> int:
        """The exit code, after one line on standard error unless all went well. The end of a finite stream is as it
        should be where no number of frames was asked for. `kept` says where the frames until then are, or is ""."""
        if self.failure is None:
            return 0
        if isinstance(self.failure, StreamEndError) and wanted is None and self.frames > 0:
            return 0
        complain(f"{self.failure}{kept if self.frames else ''}")
        return self.failure.exit_code


def take_frames(
    link: Link, take: Callable[[Frame], None], *, wanted: int | None, timeout_s: float, whole: bool = True
) -> Taken:
    """Gives verified frames to `take`, `wanted` of them, None: until the link or the user ends it.

    `whole`: only frames that are of one moment and show what was asked for, all of one size: those that can be stored.
    """
    taken = Taken()
    size: tuple[int, ...] | None = None
    with Interrupts() as interrupts:
        try:
            with interrupts.waiting():
                taken.summary = Summary(link.wait_hello(min(timeout_s, HELLO_TIMEOUT_S)))
            while wanted is None or taken.frames < wanted:
                with interrupts.waiting():
                    frame = link.next_frame(timeout_s, settled=whole)
                if whole and size is not None and frame.picture.shape != size:
                    raise StreamError(f"{link.transport.name}: the picture's size has changed: record it anew")
                size = frame.picture.shape
                take(frame)
                taken.summary.add(frame)
                progress(f"{taken.frames} frames, {taken.summary.frames_per_second or 0:.1f} frames/s")
        except StreamError as error:
            taken.failure = error
        except KeyboardInterrupt:
            if taken.summary is None:
                raise
        finally:
            progress("")
    _tell_of_rate(link)
    return taken


def _tell_of_rate(link: Link) -> None:
    """One line where the link does not have the rate that was asked for."""
    session = link.session
    if session.fast is None or session.hello is None or session.rate == (session.fast or session.hello.highest_baud):
        return
    if link.rate_words:
        complain(f"{link.transport.name}: {link.rate_words}")
