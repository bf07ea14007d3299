"""The viewer's real window with a device behind it, used as a person uses it: keys, mouse, a look at the screen."""

from __future__ import annotations

import contextlib
import gc
import time
import tkinter as tk
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import ImageGrab

from edgeline.session import Session
from edgeline.transport import Transport, connect
from edgeline.viewer.capture import Capture
from edgeline.viewer.controls import Controls
from edgeline.viewer.model import View, ViewModel
from edgeline.viewer.reader import Reader
from edgeline.viewer.window import PANEL_MS, Window

Rgb = npt.NDArray[np.uint8]


def open_at_115200(port: str) -> Transport:
    return connect(port, 115200)


def wait_for(true: Callable[[], object], seconds: float = 60) -> None:
    """Until what another thread or process does has arrived, while no window lives."""
    deadline = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < deadline, "this did not happen in time"
        time.sleep(0.01)


class AtWork:
    """A viewer on `port`; None: it has to find one. Screenshots and recordings go to `folder`."""

    def __init__(
        self,
        display: str,
        port: str | None,
        folder: Path = Path(),
        new_session: Callable[[], Session] = Session,
        scale: int | None = None,
    ) -> None:
        self._display = display
        self.root = tk.Tk()
        self.model = ViewModel(port or "")
        self.controls = Controls()
        self.reader = Reader(
            self.model, self.controls, port=port, connect=open_at_115200, new_session=new_session, baud=115200
        )
        self.capture = Capture(self.model, lambda: self.reader.tap, folder)
        self.window = Window(self.root, self.model, self.controls, self.capture, scale=scale)
        self.root.geometry("+0+0")
        self.reader.start()

    @property
    def view(self) -> View:
        return self.model.view(time.monotonic())

    @property
    def line(self) -> str:
        """The state in words."""
        return self.view.words.line

    @property
    def canvas(self) -> tk.Canvas:
        return self.window.picture.canvas

    def until(self, true: Callable[[], object], seconds: float = 60) -> None:
        """Lets the window live until something is true."""
        deadline = time.monotonic() + seconds
        while not true():
            assert time.monotonic() < deadline, f"this did not happen in time; the viewer says: {self.line}"
            self.root.update()
            time.sleep(0.002)

    def settle(self) -> None:
        """Until all of the window has come round and shows what the model has had since the call, however slow that is.

        Tk's timers go off in the order in which they fall due, so one as long as the panels' goes off after each of the
        window's own has. Twice: the first round may give the window another size, and the second draws in it.
        """
        for _ in range(2):
            rounds: list[None] = []
            self.root.after(PANEL_MS, rounds.append, None)
            self.until(lambda rounds=rounds: rounds)  # type: ignore[misc]
        self.root.update()

    def live(self, seconds: float) -> None:
        """Lets time pass, where a test's subject is what happens, or does not, in the meantime."""
        end = time.monotonic() + seconds
        self.until(lambda: time.monotonic() > end)

    def press(self, *keys: str) -> None:
        for key in keys:
            self.root.focus_force()
            self.until(lambda: self.root.focus_displayof() is not None)  # keys go nowhere before that
            self.root.event_generate(key)
            self.root.update()

    def screen(self) -> Rgb:
        """The picture's part of the window, as it stands on the screen."""
        self.root.update()
        x, y = self.canvas.winfo_rootx(), self.canvas.winfo_rooty()
        box = x, y, x + self.canvas.winfo_width(), y + self.canvas.winfo_height()
        return np.asarray(ImageGrab.grab(box, xdisplay=self._display).convert("RGB"))

    def close(self) -> None:
        self.capture.finish()
        self.reader.stop()
        with contextlib.suppress(tk.TclError):
            self.root.destroy()
        # Tk's interpreter has to go in the thread that made it: later, the collector may run in another one.
        vars(self).clear()
        gc.collect()


@contextlib.contextmanager
def at_work(
    display: str,
    port: str | None,
    folder: Path = Path(),
    new_session: Callable[[], Session] = Session,
    scale: int | None = None,
) -> Iterator[AtWork]:
    viewer = AtWork(display, port, folder, new_session, scale)
    try:
        yield viewer
    finally:
        viewer.close()
