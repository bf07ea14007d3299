"""Every key and mouse gesture, once: what the window binds and what its help shows are both made from this table."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum, auto

from edgeline.protocol import Control


class Action(Enum):
    """What a key can do; the window has a function for each."""

    FULL_SCREEN = auto()
    LEAVE = auto()
    LARGER = auto()
    SMALLER = auto()
    FIT = auto()
    GRID = auto()
    NOT_SENT = auto()
    SIDE = auto()
    LOG = auto()
    HELP = auto()
    PAUSE = auto()
    STEP = auto()
    SCREENSHOT = auto()
    RECORD = auto()
    QUIT = auto()
    ORBIT_LEFT = auto()
    ORBIT_RIGHT = auto()
    ORBIT_UP = auto()
    ORBIT_DOWN = auto()
    NEARER = auto()
    FARTHER = auto()
    PAN_LEFT = auto()
    PAN_RIGHT = auto()
    PAN_UP = auto()
    PAN_DOWN = auto()
    RESET_CAMERA = auto()
    SCENE = auto()
    NEXT_SCENE = auto()
    PREVIOUS_SCENE = auto()
    SHADING = auto()
    TEXTURE_ERROR = auto()
    ANTIALIASING = auto()
    NEXT_VIEW = auto()
    PREVIOUS_VIEW = auto()
    DEVICE_PAUSE = auto()


@dataclass(frozen=True)
class Key:
    """A line of the help: the keys as they are `shown`, what they do, and Tk's patterns of each with its action.

    `needs`: keys for the device, of use only if it knows one of these controls.
    """

    shown: str
    does: str
    binds: tuple[tuple[str, Action], ...] = ()
    needs: tuple[Control, ...] = ()

    def works(self, controls: frozenset[Control]) -> bool:
        """Whether these keys do something with a device that knows `controls`."""
        return not self.needs or not controls.isdisjoint(self.needs)


def _key(shown: str, does: str, action: Action, *patterns: str) -> Key:
    return Key(shown, does, tuple((pattern, action) for pattern in patterns))


_WINDOW = (
    _key("f  F11", "full screen", Action.FULL_SCREEN, "<Key-f>", "<F11>"),
    _key("Esc", "leave full screen, or this help", Action.LEAVE, "<Escape>"),
    Key(
        "+  \u2212",
        "larger, smaller",
        (
            *((pattern, Action.LARGER) for pattern in ("<plus>", "<equal>", "<KP_Add>")),
            *((pattern, Action.SMALLER) for pattern in ("<minus>", "<KP_Subtract>")),
        ),
    ),
    _key("z", "the whole picture again", Action.FIT, "<Key-z>"),
    _key("g", "pixel grid, from 6x on", Action.GRID, "<Key-g>"),
    _key("o", "dim what the frame did not carry", Action.NOT_SENT, "<Key-o>"),
    _key("Space", "hold the picture, let it go", Action.PAUSE, "<space>"),
    _key(".", "one frame further", Action.STEP, "<period>"),
    _key("s", "screenshot", Action.SCREENSHOT, "<Key-s>"),
    _key("r", "start or stop a recording", Action.RECORD, "<Key-r>"),
    _key("Tab", "the plots beside the picture", Action.SIDE, "<Tab>"),
    _key("l", "the log below it", Action.LOG, "<Key-l>"),
    _key("?  F1", "this help", Action.HELP, "<question>", "<F1>"),
    _key("q", "quit", Action.QUIT, "<Key-q>", "<Control-bracketright>"),
)

_ORBIT = (Control.YAW, Control.PITCH)
_PAN = (Control.PAN_X, Control.PAN_Y)

_DEVICE = (
    Key(
        "\u2190 \u2192 \u2191 \u2193",
        "orbit",
        (
            ("<Left>", Action.ORBIT_LEFT),
            ("<Right>", Action.ORBIT_RIGHT),
            ("<Up>", Action.ORBIT_UP),
            ("<Down>", Action.ORBIT_DOWN),
        ),
        _ORBIT,
    ),
    Key(
        "Shift \u2190 \u2192 \u2191 \u2193",
        "move the camera",
        (
            ("<Shift-Left>", Action.PAN_LEFT),
            ("<Shift-Right>", Action.PAN_RIGHT),
            ("<Shift-Up>", Action.PAN_UP),
            ("<Shift-Down>", Action.PAN_DOWN),
        ),
        _PAN,
    ),
    Key(
        "Page Up  Down",
        "nearer, farther",
        (("<Prior>", Action.NEARER), ("<Next>", Action.FARTHER)),
        (Control.ZOOM,),
    ),
    Key("0", "the camera as the scene has it", (("<Key-0>", Action.RESET_CAMERA),), (*_ORBIT, *_PAN, Control.ZOOM)),
    Key("1 \u2026 9", "scene", tuple((f"<Key-{n}>", Action.SCENE) for n in range(1, 10)), (Control.SCENE,)),
    Key(
        "n  p",
        "next, previous scene",
        (("<Key-n>", Action.NEXT_SCENE), ("<Key-p>", Action.PREVIOUS_SCENE)),
        (Control.SCENE,),
    ),
    Key("h", "shading", (("<Key-h>", Action.SHADING),), (Control.SHADING,)),
    Key("t", "texture error", (("<Key-t>", Action.TEXTURE_ERROR),), (Control.TEXTURE_ERROR,)),
    Key("a", "anti-aliasing", (("<Key-a>", Action.ANTIALIASING),), (Control.ANTIALIASING,)),
    Key(
        "v  Shift v",
        "next, previous debug view",
        (("<Key-v>", Action.NEXT_VIEW), ("<Key-V>", Action.PREVIOUS_VIEW)),
        (Control.VIEW,),
    ),
    Key("d", "the scene stands still, goes on", (("<Key-d>", Action.DEVICE_PAUSE),), (Control.PAUSE,)),
)

_MOUSE = (
    Key("Wheel", "zoom about the pointer"),
    Key("Drag", "move the zoomed picture"),
    Key("Right drag", "orbit", needs=_ORBIT),
    Key("Shift right drag", "move the camera", needs=_PAN),
    Key("Ctrl wheel", "nearer, farther", needs=(Control.ZOOM,)),
)

HELP = (("Window", _WINDOW), ("Device", _DEVICE), ("Mouse", _MOUSE))
"""The help's sections, each with its title."""


def bindings() -> Iterator[tuple[str, Action, Key]]:
    """Tk's pattern, what it does, and the line that it belongs to; letters also as Caps Lock makes them."""
    lines = [key for _, keys in HELP for key in keys]
    given = {pattern for key in lines for pattern, _ in key.binds}
    for key in lines:
        for pattern, action in key.binds:
            yield pattern, action, key
            capital = pattern.upper().replace("KEY", "Key")
            if len(pattern) == len("<Key-x>") and pattern.startswith("<Key-") and capital not in given:
                given.add(capital)
                yield capital, action, key
