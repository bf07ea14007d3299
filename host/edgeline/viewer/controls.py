"""What the user asked the device for: the values of its controls, and the box in which they wait for the link.

The window's thread sets, the link's thread takes. The box keeps the newest value of each control, so a key that
repeats thirty times a second, or a mouse that is faster than the wire, is one INPUT each time that the link has room.
"""

from __future__ import annotations

import threading

from edgeline.protocol import Control, DebugView, Hello, Shading

ORBIT_STEP = 1024
"""A key's press turns the camera by 1/64 of a turn."""

ZOOM_STEP = 32
"""... brings it nearer by a factor of 2^(1/8),"""

PAN_STEP = 16
"""... or moves it by 1/16 of its distance to what it looks at."""

ORBIT_PER_PIXEL = 128
"""A drag across 512 pixels of the screen is a whole turn."""

PAN_PER_PIXEL = 1

_CAMERA = (Control.YAW, Control.PITCH, Control.ZOOM, Control.PAN_X, Control.PAN_Y)
_LIMITS = {Control.PITCH: 16384, Control.ZOOM: 1024, Control.PAN_X: 4096, Control.PAN_Y: 4096}
_SAMPLES = (1, 4, 8)
_SHADINGS = {Shading.FLAT: "flat shading", Shading.COLOURS: "vertex colours alone", Shading.TEXTURES: "textures alone"}


def _order(control: Control) -> int:
    return -1 if control is Control.PAUSE else int(control)


class Controls:
    """Values as WIRE.md, "INPUT", has them; what the device was not asked for is 0 there, except for the scene, which
    it chooses itself. `scene` and `paused`: what its session asks for at its beginning."""

    def __init__(self, scene: int | None = None, paused: bool = False) -> None:
        self._lock = threading.Lock()
        self._values: dict[Control, int] = {Control.PAUSE: int(paused)}
        if scene is not None:
            self._values[Control.SCENE] = scene
        self._waiting: dict[Control, int] = {}
        self._known: frozenset[Control] = frozenset()
        self._views: tuple[DebugView, ...] = (DebugView.PICTURE,)
        self._scenes = 0

    def connect(self, hello: Hello, one_way: bool, again: bool = False) -> None:
        """Another device may know other controls; one at the other end of a `one_way` stream hears of none. `again`:
        the link was lost and is another one, so the device is told all that was set; it may have started anew."""
        with self._lock:
            self._known = frozenset(control for control in Control if hello.knows(control) and not one_way)
            self._views = tuple(view for view in DebugView if hello.has_view(view)) or (DebugView.PICTURE,)
            self._scenes = hello.scenes
            if again:
                # PAUSE comes first, as WIRE.md has it, then the scene, which begins anew.
                told = {control: self._values[control] for control in sorted(self._values, key=_order)}
                self._waiting = {**told, **self._waiting}
            self._waiting = {control: value for control, value in self._waiting.items() if control in self._known}
            if self._values.get(Control.VIEW, 0) not in self._views:
                del self._values[Control.VIEW]

    @property
    def known(self) -> frozenset[Control]:
        """What the device knows; nothing before its HELLO."""
        return self._known

    @property
    def scenes(self) -> int:
        """How many the device has; 0: it does not say."""
        return self._scenes

    def value(self, control: Control) -> int:
        return self._values.get(control, 0)

    @property
    def view(self) -> DebugView:
        return DebugView(self.value(Control.VIEW))

    def turn(self, yaw: int, pitch: int) -> None:
        """Orbits: to the right and upwards, in 1/65536 of a turn."""
        self._set(Control.YAW, self.value(Control.YAW) + yaw & 0xFFFF)
        self._add(Control.PITCH, pitch)

    def approach(self, steps: int) -> None:
        self._add(Control.ZOOM, steps * ZOOM_STEP)

    def move(self, x: int, y: int) -> None:
        """Pans: to the right and upwards, in 1/256 of the distance."""
        self._add(Control.PAN_X, x)
        self._add(Control.PAN_Y, y)

    def reset_camera(self) -> None:
        for control in _CAMERA:
            self._set(control, 0)

    def choose_scene(self, index: int) -> None:
        """One that the device does not have is not asked for."""
        if index >= 0 and (self._scenes == 0 or index < self._scenes):
            self._set(Control.SCENE, index, again=True)

    def next_scene(self, step: int) -> None:
        """The one that the device chose by itself is not known: next to it is the first, before it the last."""
        index = self._values.get(Control.SCENE, -1 if step > 0 else 0) + step
        self.choose_scene(index % self._scenes if self._scenes else max(0, index))

    def next_shading(self) -> None:
        self._set(Control.SHADING, (self.value(Control.SHADING) + 1) % len(Shading))

    def next_texture_error(self) -> None:
        self._set(Control.TEXTURE_ERROR, (self.value(Control.TEXTURE_ERROR) + 1) % 6)

    def next_antialiasing(self) -> None:
        now = max(1, self.value(Control.ANTIALIASING))
        self._set(Control.ANTIALIASING, _SAMPLES[(_SAMPLES.index(now) + 1) % len(_SAMPLES)])

    def next_view(self, step: int) -> None:
        self._set(Control.VIEW, self._views[(self._views.index(self.view) + step) % len(self._views)])

    def pause(self, still: bool) -> None:
        self._set(Control.PAUSE, int(still))

    @property
    def paused(self) -> bool:
        """Whether the device was asked to stand still."""
        return self.value(Control.PAUSE) == 1

    def step(self) -> None:
        """One frame further on a device that stands still. Steps that wait add up."""
        if Control.STEP in self._known:
            with self._lock:
                self._waiting[Control.STEP] = self._waiting.get(Control.STEP, 0) + 1

    def take(self) -> tuple[Control, int] | None:
        """What has waited longest, to be sent now; None: nothing."""
        with self._lock:
            if not self._waiting:
                return None
            control = next(iter(self._waiting))
            return control, self._waiting.pop(control)

    def in_words(self) -> list[str]:
        """What is not as the device had it at its start, a phrase each."""
        words = []
        if Control.SCENE in self._values:
            count = f" of {self._scenes}" if self._scenes else ""
            words.append(f"scene {self.value(Control.SCENE) + 1}{count}")
        if self.value(Control.SHADING):
            words.append(_SHADINGS[Shading(self.value(Control.SHADING))])
        if self.value(Control.TEXTURE_ERROR):
            words.append(f"texture error 1/{1 << self.value(Control.TEXTURE_ERROR)} texel")
        if self.value(Control.ANTIALIASING) > 1:
            words.append(f"{self.value(Control.ANTIALIASING)} samples per pixel")
        if any(self.value(control) for control in _CAMERA):
            words.append("camera moved")
        return words

    def _add(self, control: Control, difference: int) -> None:
        limit = _LIMITS[control]
        self._set(control, max(-limit, min(limit, self.value(control) + difference)))

    def _set(self, control: Control, value: int, again: bool = False) -> None:
        """`again`: to be sent even if it is what it was, because it begins something anew."""
        if control not in self._known or (value == self.value(control) and not again):
            return
        with self._lock:
            self._values[control] = value
            self._waiting[control] = value
