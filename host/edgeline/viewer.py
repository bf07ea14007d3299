"""The window of `edgeline view`: tkinter around a ViewModel, and a thread around a Link.

The window's thread never waits for the link and the link's thread never touches the window; they share the model alone.
So the window answers while a cable is out, and a slow screen does not hold up the device.
"""

from __future__ import annotations

import signal
import threading
import time
import tkinter as tk
from collections.abc import Callable
from pathlib import Path
from tkinter import font as tkfont

from PIL import Image, ImageTk

from edgeline import discovery
from edgeline.colour import to_image
from edgeline.errors import EdgelineError, OutputError
from edgeline.link import Link
from edgeline.recorder import save_png
from edgeline.session import Session
from edgeline.transport import Transport, connect
from edgeline.viewmodel import Mood, Rows, View, ViewModel, largest_scale

PICTURE_MS = 15
PANEL_MS = 200
REOPEN_S = 0.5
PANEL_WIDTH = 250
KEYS = "space pause   s screenshot   + - scale   q quit"

_PANEL_REST = 150
"""Lines of the panel above and below the table, in pixels."""

_BACKGROUND = "#0e1014"
_PANEL = "#171a21"
_EDGE = "#262b36"
_TEXT = "#e6e9ef"
_DIM = "#8b93a5"
_ACCENT = "#7cb7ff"
_MOODS = {Mood.GOOD: "#5fd38d", Mood.BUSY: "#f2c14e", Mood.BAD: "#f2665e"}


class Reader(threading.Thread):
    """Runs the link until `stop`; opens it again when it is lost, on another port too if the device moved there."""

    def __init__(
        self, model: ViewModel, transport: Transport, baud: int, new_session: Callable[[], Session] = Session
    ) -> None:
        super().__init__(name="edgeline-link", daemon=True)
        self._model = model
        self._transport: Transport | None = transport
        self._port = next(
            (port for port in discovery.ports() if port.device == transport.name),
            discovery.PortInfo(transport.name, "", None),
        )
        self._baud = baud
        self._new_session = new_session
        self._stopping = threading.Event()

    def run(self) -> None:
        while not self._stopping.is_set():
            if self._transport is None:
                self._transport = self._reopen()
                continue
            with Link(self._transport, self._new_session()) as link:
                try:
                    while not self._stopping.is_set():
                        self._model.take(link.step(), link.session.counts, time.monotonic())
                except EdgelineError as error:
                    self._model.lost(str(error))
            self._transport = None

    def stop(self) -> None:
        self._stopping.set()
        self.join(timeout=1.0)

    def _reopen(self) -> Transport | None:
        self._stopping.wait(REOPEN_S)
        try:
            transport = connect(discovery.moved(self._port) or self._port.device, self._baud)
        except EdgelineError:
            return None
        self._model.reopened(transport.name)
        return transport


class Window:
    """The picture at a whole scale on the left, the panel on the right, the status line below."""

    def __init__(self, root: tk.Tk, model: ViewModel, frames: int | None = None) -> None:
        self._root = root
        self._model = model
        self._frames = frames
        self._drawn = -1
        self._photo: ImageTk.PhotoImage | None = None
        self._fitted = False
        self._rows: dict[str, tuple[tk.Label, ...]] = {}

        families = set(tkfont.families(root))
        sans = next((name for name in ("Inter", "Segoe UI", "SF Pro Text", "DejaVu Sans") if name in families), "")
        self._font = tkfont.Font(family=sans or tkfont.nametofont("TkDefaultFont").actual("family"), size=9)
        self._small = tkfont.Font(family=self._font.actual("family"), size=8)
        self._bold = tkfont.Font(family=self._font.actual("family"), size=11, weight="bold")

        root.title(f"Edgeline {model.port}")
        root.configure(background=_BACKGROUND)
        root.minsize(PANEL_WIDTH + 240, 480)
        self._build_status()
        self._build_panel()
        self._canvas = tk.Canvas(root, background=_BACKGROUND, highlightthickness=0, width=640, height=480)
        self._canvas.pack(side="left", fill="both", expand=True)
        self._image = self._canvas.create_image(0, 0)
        self._hint = self._canvas.create_text(0, 0, fill=_DIM, font=self._font, justify="center")
        self._canvas.bind("<Configure>", lambda _: self._redraw())
        self._bind()
        self._show_picture()
        self._show_panel()

    def _build_status(self) -> None:
        bar = tk.Frame(self._root, background=_PANEL, highlightbackground=_EDGE, highlightthickness=1)
        bar.pack(side="bottom", fill="x")
        self._dot = tk.Canvas(bar, width=10, height=10, background=_PANEL, highlightthickness=0)
        self._lamp = self._dot.create_oval(1, 1, 9, 9, outline="")
        self._dot.pack(side="left", padx=(10, 6), pady=7)
        self._status = tk.Label(bar, background=_PANEL, foreground=_TEXT, font=self._font, anchor="w")
        keys = tk.Label(bar, background=_PANEL, foreground=_DIM, font=self._small, text=KEYS)
        keys.pack(side="right", padx=10)
        self._status.pack(side="left", fill="x", expand=True)

    def _build_panel(self) -> None:
        panel = tk.Frame(self._root, background=_PANEL, width=PANEL_WIDTH)
        panel.pack(side="right", fill="y")
        panel.pack_propagate(False)
        self._title = tk.Label(panel, background=_PANEL, foreground=_TEXT, font=self._bold, anchor="w")
        self._title.pack(fill="x", padx=14, pady=(12, 0))
        self._subtitle = tk.Label(panel, background=_PANEL, foreground=_DIM, font=self._small, anchor="w")
        self._subtitle.pack(fill="x", padx=14)
        self._table = tk.Frame(panel, background=_PANEL)
        self._table.pack(fill="x", padx=14, pady=(6, 0))
        self._table.columnconfigure(0, weight=1)
        self._log = tk.Label(
            panel,
            background=_PANEL,
            foreground=_DIM,
            font=self._small,
            anchor="sw",
            justify="left",
            wraplength=PANEL_WIDTH - 28,
        )
        self._log.pack(side="bottom", fill="x", padx=14, pady=10)

    def _bind(self) -> None:
        actions = {
            "<space>": self._model.toggle_pause,
            "s": self._screenshot,
            "<plus>": lambda: self._rescale(1),
            "<equal>": lambda: self._rescale(1),
            "<KP_Add>": lambda: self._rescale(1),
            "<minus>": lambda: self._rescale(-1),
            "<KP_Subtract>": lambda: self._rescale(-1),
            "q": self._root.destroy,
            "<Control-bracketright>": self._root.destroy,
        }
        for key, action in actions.items():
            self._root.bind(key, lambda _, action=action: action())  # type: ignore[misc]

    def _show_picture(self) -> None:
        """Draws the latest picture if there is one that has not been drawn, and comes back soon."""
        view = self._model.view(time.monotonic())
        if view.serial != self._drawn:
            self._drawn = view.serial
            self._draw(view)
        if self._frames is not None and self._model.frames >= self._frames:
            self._root.destroy()
            return
        self._root.after(PICTURE_MS, self._show_picture)

    def _show_panel(self) -> None:
        view = self._model.view(time.monotonic())
        self._dot.itemconfigure(self._lamp, fill=_MOODS[view.mood])
        self._status.configure(text=view.status)
        self._title.configure(text=view.title)
        self._subtitle.configure(text=view.subtitle)
        self._fill_table(view.sections)
        self._log.configure(text="\n".join(view.log[-3:]))
        if view.picture is None:
            self._canvas.itemconfigure(self._hint, text=f"{self._model.port}\n{view.state}")
        self._root.after(PANEL_MS, self._show_panel)

    def _fill_table(self, sections: dict[str, Rows]) -> None:
        """One label pair per row, made when the row first appears; later only its value changes."""
        line = 0
        known = len(self._rows)
        for section, rows in sections.items():
            if section not in self._rows:
                heading = tk.Label(
                    self._table, text=section, background=_PANEL, foreground=_ACCENT, font=self._small, anchor="w"
                )
                heading.grid(row=line, column=0, columnspan=2, sticky="w", pady=(7, 0))
                self._rows[section] = (heading,)
            line += 1
            for name, value in rows:
                key = f"{section} {name}"
                if key not in self._rows:
                    label = tk.Label(
                        self._table, text=name, background=_PANEL, foreground=_DIM, font=self._small, pady=0
                    )
                    number = tk.Label(self._table, background=_PANEL, foreground=_TEXT, font=self._small, pady=0)
                    label.grid(row=line, column=0, sticky="w")
                    number.grid(row=line, column=1, sticky="e")
                    self._rows[key] = (label, number)
                self._rows[key][1].configure(text=value)
                line += 1
        if len(self._rows) > known:
            self._table.update_idletasks()
            height = self._table.winfo_reqheight() + _PANEL_REST
            self._root.minsize(PANEL_WIDTH + 240, min(height, self._root.winfo_screenheight() * 9 // 10))

    def _draw(self, view: View) -> None:
        if view.picture is None:
            return
        height, width = view.picture.shape
        if not self._fitted:
            self._fitted = True
            self._fit(width, height)
        room_x, room_y = self._canvas.winfo_width(), self._canvas.winfo_height()
        scale = largest_scale(width, height, room_x, room_y)
        image = to_image(view.picture).resize((width * scale, height * scale), Image.Resampling.NEAREST)
        if self._photo is None or (self._photo.width(), self._photo.height()) != image.size:
            self._photo = ImageTk.PhotoImage(image)
            self._canvas.itemconfigure(self._image, image=self._photo)
            self._canvas.itemconfigure(self._hint, text="")
        else:
            self._photo.paste(image)
        self._canvas.coords(self._image, room_x // 2, room_y // 2)

    def _fit(self, width: int, height: int) -> None:
        """Opens the window at the largest scale that leaves some of the screen free."""
        room_x = self._root.winfo_screenwidth() * 9 // 10 - PANEL_WIDTH
        room_y = self._root.winfo_screenheight() * 8 // 10
        self._resize(width, height, largest_scale(width, height, room_x, room_y))

    def _resize(self, width: int, height: int, scale: int) -> None:
        border_x = self._root.winfo_width() - self._canvas.winfo_width()
        border_y = self._root.winfo_height() - self._canvas.winfo_height()
        self._root.geometry(f"{width * scale + border_x}x{height * scale + border_y}")
        self._root.update_idletasks()

    def _rescale(self, step: int) -> None:
        shown = self._model.shown
        if shown is None:
            return
        height, width = shown.picture.shape
        scale = largest_scale(width, height, self._canvas.winfo_width(), self._canvas.winfo_height())
        self._resize(width, height, max(1, scale + step))

    def _redraw(self) -> None:
        self._canvas.coords(self._hint, self._canvas.winfo_width() // 2, self._canvas.winfo_height() // 2)
        self._draw(self._model.view(time.monotonic()))

    def _screenshot(self) -> None:
        shown = self._model.shown
        if shown is None:
            return
        number = 1
        while Path(f"edgeline-{number:04d}.png").exists():
            number += 1
        name = f"edgeline-{number:04d}.png"
        try:
            save_png(name, shown.picture)
            self._model.notify(f"saved {name}", time.monotonic())
        except OutputError as error:
            self._model.notify(str(error), time.monotonic())


def run(transport: Transport, baud: int, new_session: Callable[[], Session], frames: int | None) -> None:
    """Shows what comes over `transport` until the window is closed, or `frames` frames have been verified.

    `new_session` is asked for another one each time that the link was lost.

    Raises EdgelineError if there is no display.
    """
    try:
        root = tk.Tk(className="Edgeline")
    except tk.TclError:
        transport.close()
        raise EdgelineError("no display to open a window on: use `edgeline shot` or `edgeline record`") from None
    model = ViewModel(transport.name)
    reader = Reader(model, transport, baud, new_session)
    Window(root, model, frames)
    for number in (signal.SIGINT, signal.SIGTERM):
        # As an exception it would arrive in a callback, where tkinter prints it and goes on.
        signal.signal(number, lambda *_: root.quit())
    reader.start()
    try:
        root.mainloop()
    finally:
        reader.stop()
