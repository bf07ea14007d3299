"""`edgeline view`: a window with the picture, the link's state in words, live plots, the log, and keys for the device.

`reader` is the link's thread, `window` the window's; `model` and `controls` are all that they share. What can be
computed without a window is in modules of its own: `viewport` (where the picture stands), `paint` (pixels), `history`
(plots), `state` (words), `keys` (what each key does), `log`, `sent`.
"""

from __future__ import annotations

import signal
import tkinter as tk
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from edgeline.errors import EdgelineError
from edgeline.outfile import check_writable
from edgeline.recording import SUFFIX
from edgeline.session import Session
from edgeline.transport import Transport
from edgeline.viewer.capture import Capture
from edgeline.viewer.controls import Controls
from edgeline.viewer.model import ViewModel
from edgeline.viewer.reader import Reader
from edgeline.viewer.window import Window


@dataclass(frozen=True)
class Options:
    """`port` None: looks for a device on all ports. `connect` opens a port by its name, again after each loss, and
    `new_session` is asked for a session for it."""

    port: str | None
    connect: Callable[[str], Transport]
    new_session: Callable[[], Session] = Session
    baud: int = 115200
    """at which the ports are searched"""
    frames: int | None = None
    """closes the window after so many verified frames"""
    scale: int | None = None
    full_screen: bool = False
    folder: Path = field(default_factory=Path)
    """of screenshots and recordings"""
    record: str | None = None
    """a recording from the first frame on"""
    scene: int | None = None
    paused: bool = False
    """what the sessions ask for at their beginning"""


def run(options: Options) -> None:
    """Shows what the device sends until the window is closed, or as many frames as were asked for have been verified.

    Raises EdgelineError if there is no display, or nothing can be written where the options say.
    """
    if options.record is not None:
        if not options.record.endswith(SUFFIX):
            raise EdgelineError(
                f"{options.record}: the viewer records *{SUFFIX}; `edgeline record` makes other files of it"
            )
        check_writable(options.record)
    if not options.folder.is_dir():
        raise EdgelineError(f"{options.folder}: no such folder")
    try:
        root = tk.Tk(className="Edgeline")
    except tk.TclError:
        raise EdgelineError("no display to open a window on: use `edgeline shot` or `edgeline record`") from None
    model = ViewModel(options.port or "")
    controls = Controls(options.scene, options.paused)
    reader = Reader(
        model,
        controls,
        port=options.port,
        connect=options.connect,
        new_session=options.new_session,
        baud=options.baud,
    )
    capture = Capture(model, lambda: reader.tap, options.folder, options.record)
    Window(
        root,
        model,
        controls,
        capture,
        frames=options.frames,
        scale=options.scale,
        full_screen=options.full_screen,
    )
    for number in (signal.SIGINT, signal.SIGTERM):
        # As an exception it would arrive in a callback, where tkinter prints it and goes on.
        signal.signal(number, lambda *_: root.quit())
    reader.start()
    try:
        root.mainloop()
    finally:
        capture.finish()
        reader.stop()
