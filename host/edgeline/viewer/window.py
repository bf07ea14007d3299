"""The window of `edgeline view`: puts its parts together, binds the keys, draws what the model has.

The window's thread never waits for the link and the link's thread never touches the window. So the window answers while
a cable is out, a slow screen does not hold up the device, and of a thousand frames a second it draws those that it can.
"""

from __future__ import annotations

import time
import tkinter as tk
from collections.abc import Callable

from edgeline.protocol import Control, DebugView
from edgeline.viewer import theme
from edgeline.viewer.capture import Capture
from edgeline.viewer.charts import Charts, Numbers
from edgeline.viewer.controls import ORBIT_PER_PIXEL, ORBIT_STEP, PAN_PER_PIXEL, PAN_STEP, Controls
from edgeline.viewer.keys import Action, bindings
from edgeline.viewer.legend import Legend
from edgeline.viewer.model import View, ViewModel
from edgeline.viewer.paint import Mask
from edgeline.viewer.panels import Facts, Help, LogPane, StatusLine
from edgeline.viewer.picture import Picture
from edgeline.viewer.sent import sent
from edgeline.viewer.state import Mood, Phase
from edgeline.viewer.viewport import largest_scale
from edgeline.viewer.widgets import Chip

PICTURE_MS = 15
PANEL_MS = 100
SIDE_WIDTH = 300
LEAST_WIDTH, LEAST_HEIGHT = 560, 400

_CHIP_GAP = 10


class Window:
    """The picture with the log below it, the facts, plots and numbers beside it, the status line at the foot."""

    def __init__(
        self,
        root: tk.Tk,
        model: ViewModel,
        controls: Controls,
        capture: Capture,
        *,
        frames: int | None = None,
        scale: int | None = None,
        full_screen: bool = False,
    ) -> None:
        self._root, self._model, self._controls, self._capture = root, model, controls, capture
        self._frames, self._scale = frames, scale
        self._serial = -1
        self._fitted = False
        self._not_sent = False
        self._full_screen = False
        self._before_full_screen = ""
        self._side_shown = self._log_shown = True
        self._timers = ["", ""]
        self.drawn = 0
        """pictures drawn since the window opened"""

        fonts = self._fonts = theme.fonts(root)
        root.title("Edgeline")
        root.configure(background=theme.GROUND)
        root.minsize(LEAST_WIDTH, LEAST_HEIGHT)
        root.columnconfigure(0, weight=1)
        root.rowconfigure(0, weight=1)
        self.picture = Picture(
            root,
            self._hovered,
            lambda dx, dy: controls.turn(-dx * ORBIT_PER_PIXEL, dy * ORBIT_PER_PIXEL),
            lambda dx, dy: controls.move(-dx * PAN_PER_PIXEL, dy * PAN_PER_PIXEL),
            controls.approach,
        )
        canvas = self.picture.canvas
        self._advice = canvas.create_text(0, 0, fill=theme.DIM, font=fonts.normal, justify="center", anchor="n")
        self._headline = canvas.create_text(0, 0, fill=theme.TEXT, font=fonts.large, justify="center", anchor="s")
        self._state_chip = Chip(canvas, fonts.normal, theme.TEXT, "nw")
        self._recording_chip = Chip(canvas, fonts.normal, theme.RECORDING, "ne")
        self._legend = Legend(canvas, fonts)
        self._side = tk.Frame(root, background=theme.PANEL, width=SIDE_WIDTH)
        self._build_side()
        self.log = LogPane(root, model, fonts)
        self.status = StatusLine(root, fonts)
        self.help = Help(root, fonts)
        self._arrange()
        canvas.bind("<Configure>", lambda _: self._draw_again())
        canvas.bind("<Destroy>", lambda _: self._stop())
        self._bind()
        if full_screen:
            self._set_full_screen(True)
        self._show_picture()
        self._show_panels()

    def _build_side(self) -> None:
        self._side.pack_propagate(False)
        self._facts = Facts(self._side, self._fonts)
        self._facts.frame.pack(fill="x")
        self.charts = Charts(self._side, self._model, self._fonts)
        self.numbers = Numbers(self._side, self._model, self.charts, self._fonts)
        heading = tk.Label(
            self._side,
            text="The last frame's numbers; a click plots one",
            background=theme.PANEL,
            foreground=theme.DIM,
            font=self._fonts.small,
            anchor="w",
        )
        self.numbers.canvas.pack(side="bottom", fill="x", pady=(0, 8))
        heading.pack(side="bottom", fill="x", padx=12, pady=(4, 2))
        self.charts.canvas.pack(fill="both", expand=True)

    def _arrange(self) -> None:
        """In full screen there is the picture alone, until the user asks for the rest."""
        parts: tuple[tuple[tk.Widget, bool, dict[str, object]], ...] = (
            (self.picture.canvas, True, {"row": 0, "column": 0, "sticky": "nsew"}),
            (self._side, self._side_shown, {"row": 0, "column": 1, "rowspan": 2, "sticky": "nsew"}),
            (self.log.frame, self._log_shown, {"row": 1, "column": 0, "sticky": "nsew"}),
            (self.status.frame, not self._full_screen, {"row": 2, "column": 0, "columnspan": 2, "sticky": "nsew"}),
        )
        for widget, shown, place in parts:
            if shown:
                widget.grid(**place)  # type: ignore[arg-type]
            else:
                widget.grid_remove()

    def _bind(self) -> None:
        actions: dict[Action, Callable[[tk.Event[tk.Misc]], None]] = {
            action: lambda _, do=do: do()  # type: ignore[misc]
            for action, do in self._actions().items()
        }
        actions[Action.SCENE] = lambda event: self._choose(int(event.keysym))
        for pattern, action, _ in bindings():

            def pressed(event: tk.Event[tk.Misc], action: Action = action) -> str:
                actions[action](event)
                return "break"

            self._root.bind(pattern, pressed)

    def _actions(self) -> dict[Action, Callable[[], None]]:
        controls = self._controls
        return {
            Action.FULL_SCREEN: lambda: self._set_full_screen(not self._full_screen),
            Action.LEAVE: self._leave,
            Action.LARGER: lambda: self._rescale(1),
            Action.SMALLER: lambda: self._rescale(-1),
            Action.FIT: self.picture.fit,
            Action.GRID: self._toggle_grid,
            Action.NOT_SENT: self._toggle_not_sent,
            Action.SIDE: self._toggle_side,
            Action.LOG: self._toggle_log,
            Action.HELP: self._toggle_help,
            Action.PAUSE: self._model.toggle_pause,
            Action.STEP: self._step,
            Action.SCREENSHOT: self._capture.screenshot,
            Action.RECORD: self._capture.toggle,
            Action.QUIT: self._root.destroy,
            Action.ORBIT_LEFT: lambda: controls.turn(-ORBIT_STEP, 0),
            Action.ORBIT_RIGHT: lambda: controls.turn(ORBIT_STEP, 0),
            Action.ORBIT_UP: lambda: controls.turn(0, ORBIT_STEP),
            Action.ORBIT_DOWN: lambda: controls.turn(0, -ORBIT_STEP),
            Action.NEARER: lambda: controls.approach(1),
            Action.FARTHER: lambda: controls.approach(-1),
            Action.PAN_LEFT: lambda: controls.move(-PAN_STEP, 0),
            Action.PAN_RIGHT: lambda: controls.move(PAN_STEP, 0),
            Action.PAN_UP: lambda: controls.move(0, PAN_STEP),
            Action.PAN_DOWN: lambda: controls.move(0, -PAN_STEP),
            Action.RESET_CAMERA: controls.reset_camera,
            Action.NEXT_SCENE: lambda: controls.next_scene(1),
            Action.PREVIOUS_SCENE: lambda: controls.next_scene(-1),
            Action.SHADING: controls.next_shading,
            Action.TEXTURE_ERROR: controls.next_texture_error,
            Action.ANTIALIASING: controls.next_antialiasing,
            Action.NEXT_VIEW: lambda: controls.next_view(1),
            Action.PREVIOUS_VIEW: lambda: controls.next_view(-1),
            Action.DEVICE_PAUSE: lambda: controls.pause(not controls.paused),
        }

    def _show_picture(self) -> None:
        """Draws the latest picture if there is one that has not been drawn, and comes back soon."""
        view = self._model.view(time.monotonic())
        if view.serial != self._serial:
            self._serial = view.serial
            self._draw(view)
        if self._frames is not None and self._model.frames >= self._frames:
            self._root.destroy()
            return
        self._timers[0] = self._root.after(PICTURE_MS, self._show_picture)

    def _show_panels(self) -> None:
        now = time.monotonic()
        view = self._model.view(now)
        recording = self._capture.poll()
        self.status.words(view)
        if self._side_shown:
            self._facts.draw(view, self._model.frames, self._controls.in_words())
            room = self._side.winfo_height() - self._facts.frame.winfo_height()
            self.numbers.canvas.configure(height=self.numbers.height_within(room * 45 // 100))
            self.charts.draw(now)
            self.numbers.draw()
        if self._log_shown:
            self.log.draw()
        self._over_picture(view, recording)
        self._timers[1] = self._root.after(PANEL_MS, self._show_panels)

    def _stop(self) -> None:
        """The window is closing: nothing is to come round any more."""
        for timer in self._timers:
            self._root.after_cancel(timer)

    def _over_picture(self, view: View, recording: str) -> None:
        """Words where the picture should be, or over it where the status line is hidden or something is wrong."""
        canvas, words = self.picture.canvas, view.words
        width, height = canvas.winfo_width(), canvas.winfo_height()
        nothing = view.picture is None
        canvas.itemconfigure(self._headline, text=words.line if nothing else "", width=width - 40)
        canvas.itemconfigure(self._advice, text=words.advice if nothing else "", width=width - 40)
        canvas.coords(self._headline, width // 2, height // 2 - 6)
        canvas.coords(self._advice, width // 2, height // 2 + 6)
        telling = not nothing and (words.mood is Mood.BAD or (self._full_screen and words.mood is not Mood.GOOD))
        notice = view.notice if self._full_screen else ""
        self._state_chip.show(notice or (words.line if telling else ""), theme.MOODS[words.mood])
        self._state_chip.place(_CHIP_GAP, _CHIP_GAP, width * 3 // 5)
        self._recording_chip.show(recording)
        self._recording_chip.place(width - _CHIP_GAP, _CHIP_GAP, width * 2 // 5)
        debug_view = self._controls.view if view.phase is Phase.STREAMING else DebugView.PICTURE
        self._legend.show(debug_view, self._not_sent and not nothing, _CHIP_GAP, height - _CHIP_GAP)
        target = view.hello.target if view.hello else view.port
        self._root.title(f"{target} \u2013 Edgeline" if target else "Edgeline")

    def _draw(self, view: View) -> None:
        if view.picture is None:
            return
        if not self._fitted:
            self._fitted = True
            self._fit(*reversed(view.picture.shape))
        self.picture.show(view.picture, self._mask(view))
        self.drawn += 1
        self._say_scale()

    def _mask(self, view: View) -> Mask | None:
        """What is not dimmed: the lines of a failed frame that are certain, or what this frame carried, if asked."""
        assert view.picture is not None
        if view.proven is not None:
            return view.proven[:, None].repeat(view.picture.shape[1], axis=1)
        return sent(view.frame) if self._not_sent and view.frame is not None else None

    def _draw_again(self) -> None:
        self._serial = -1
        self._draw(self._model.view(time.monotonic()))

    def _say_scale(self) -> None:
        viewport = self.picture.viewport
        if viewport is not None:
            self.status.scale(f"{viewport.scale}x" if viewport.fits else f"{viewport.scale}x, z: all of it")

    def _hovered(self, at: tuple[int, int] | None) -> None:
        self.status.pixel(at, self.picture.pixel(*at) if at else 0)
        self._say_scale()

    def _fit(self, width: int, height: int) -> None:
        """Opens the window at the scale that was asked for, or the largest one that leaves some of the screen free."""
        room_x = self._root.winfo_screenwidth() * 9 // 10 - SIDE_WIDTH
        room_y = self._root.winfo_screenheight() * 8 // 10
        if not self._full_screen:
            self._resize(width, height, self._scale or largest_scale(width, height, room_x, room_y))

    def _resize(self, width: int, height: int, scale: int) -> None:
        self._root.update_idletasks()  # of a window that is just opening, the parts do not know their heights before
        beside = SIDE_WIDTH if self._side_shown else 0
        below = self.log.frame.winfo_reqheight() if self._log_shown else 0
        below += self.status.frame.winfo_reqheight()
        self._root.geometry(f"{width * scale + beside}x{height * scale + below}")
        self._root.update_idletasks()

    def _rescale(self, step: int) -> None:
        """The window follows the picture's scale, unless the user has zoomed or the screen is full."""
        viewport, shown = self.picture.viewport, self._model.shown
        if viewport is None or shown is None:
            return
        if viewport.fits and not self._full_screen:
            height, width = shown.picture.shape
            self._resize(width, height, max(1, viewport.scale + step))
        else:
            self.picture.zoom(step)

    def _set_full_screen(self, on: bool) -> None:
        if on == self._full_screen:
            return
        self._full_screen = on
        self._side_shown = self._log_shown = not on
        if on:
            self._before_full_screen = self._root.geometry()
            # A window manager makes it so; where there is none, the size does.
            self._root.geometry(f"{self._root.winfo_screenwidth()}x{self._root.winfo_screenheight()}+0+0")
        self._root.attributes("-fullscreen", on)
        if not on:
            self._root.geometry(self._before_full_screen)
        self._arrange()

    def _leave(self) -> None:
        if self.help.visible:
            self.help.hide()
        else:
            self._set_full_screen(False)

    def _toggle_grid(self) -> None:
        self.picture.grid = not self.picture.grid
        self.picture.draw()

    def _toggle_not_sent(self) -> None:
        self._not_sent = not self._not_sent
        self._draw_again()

    def _toggle_side(self) -> None:
        self._side_shown = not self._side_shown
        self._arrange()

    def _toggle_log(self) -> None:
        self._log_shown = not self._log_shown
        self._arrange()

    def _toggle_help(self) -> None:
        if self.help.visible:
            self.help.hide()
        else:
            self.help.show(self._controls.known)

    def _step(self) -> None:
        """A device that can does the step, and the picture follows it; otherwise the picture alone stands still."""
        if {Control.PAUSE, Control.STEP} <= self._controls.known:
            self._model.resume()
            self._controls.pause(True)
            self._controls.step()
        else:
            self._model.step()

    def _choose(self, number: int) -> None:
        if not self._model.choose(number):
            self._controls.choose_scene(number - 1)
