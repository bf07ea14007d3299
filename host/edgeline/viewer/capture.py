"""Screenshots and recordings: which file, and what became of it."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

from edgeline.errors import OutputError
from edgeline.recorder import save_png
from edgeline.recording import SUFFIX
from edgeline.tap import Tap
from edgeline.viewer.model import ViewModel


class Capture:
    """Writes into `folder`, under the first number that is free. `tap` gives the link's Tap, None before there is one.

    What happens is told to the user by the model's notices; nothing is raised.
    """

    def __init__(
        self, model: ViewModel, tap: Callable[[], Tap | None], folder: Path, record: str | None = None
    ) -> None:
        self._model, self._tap, self._folder = model, tap, folder
        self._wanted = record
        self._path: str | None = None

    def screenshot(self) -> None:
        """The verified frame that is on the screen, pixel for pixel, as PNG."""
        shown = self._model.shown
        if shown is None:
            return
        path = self._free(".png")
        try:
            save_png(path, shown.picture)
            self._tell(f"saved {path}" + (", lines of several frames" if shown.mixed else ""))
        except OutputError as error:
            self._tell(str(error))

    def toggle(self) -> None:
        """Starts a recording with the next verified frame, or completes the one that runs."""
        if self._path is not None:
            self._stop()
        elif self._wanted is None:
            self._wanted = self._free(SUFFIX)
            self.poll()

    def poll(self) -> str:
        """To be called a few times per second. Returns what the window says of the recording, "" if there is none."""
        tap = self._tap()
        if tap is None:
            return "" if self._wanted is None else f"\u25cf {Path(self._wanted).name} waits for the link"
        if self._wanted is not None:
            self._start(tap)
        if self._path is None:
            return ""
        if tap.failure is not None:
            self._path = None
            self._tell(f"the recording has ended: {tap.failure}")
            return ""
        state = tap.state
        seconds = 0 if state is None else int(state.seconds)
        return f"\u25cf {Path(self._path).name}  {seconds // 60}:{seconds % 60:02}"

    def finish(self) -> None:
        """Completes the recording, if there is one."""
        if self._path is not None:
            self._stop()

    def _start(self, tap: Tap) -> None:
        path, self._wanted = self._wanted, None
        assert path is not None
        try:
            tap.start(path, at_next_frame=True)
            self._path = path
            self._tell(f"recording {path}")
        except OutputError as error:
            self._tell(str(error))

    def _stop(self) -> None:
        path, self._path = self._path, None
        tap = self._tap()
        assert tap is not None
        try:
            done = tap.stop()
        except OutputError as error:
            self._tell(str(error))
            return
        if done is None:
            self._tell("nothing was recorded: no frame came")
        else:
            self._tell(f"recorded {path}: {done.seconds:.1f} s, {done.received / 1000:,.0f} kB")

    def _free(self, suffix: str) -> str:
        number = 1
        while (path := self._folder / f"edgeline-{number:04d}{suffix}").exists():
            number += 1
        return str(path)

    def _tell(self, text: str) -> None:
        self._model.notify(text, time.monotonic())
