"""Edgeline's host side: pictures from a microcontroller, each proven by its digest.

import edgeline

with edgeline.open("/dev/ttyACM0") as link:
    for frame in link:
        print(frame.number, frame.picture.shape, frame.end.render_us, frame.counters["pixels"])
"""

from collections.abc import Callable

from edgeline.colour import to_image, to_rgb
from edgeline.discovery import find
from edgeline.errors import DeviceError, EdgelineError, OutputError, StreamEndError, StreamError, WireError
from edgeline.link import Link
from edgeline.protocol import FrameEnd, Hello
from edgeline.session import Frame, Session
from edgeline.transport import connect

__version__ = "0.1.0"

__all__ = [
    "DeviceError",
    "EdgelineError",
    "Frame",
    "FrameEnd",
    "Hello",
    "Link",
    "OutputError",
    "StreamEndError",
    "StreamError",
    "WireError",
    "open",
    "to_image",
    "to_rgb",
]


def open(
    port: str | None = None, baud: int = 115200, fps: int = 0, on_log: Callable[[str], None] | None = None
) -> Link:
    """Opens `port` (a serial port or pty, `socket://HOST:PORT`, a capture file; None: the one board that answers).

    Iterating the link gives verified frames: `frame.picture` is RGB565, uint16 of shape (height, width). `fps` asks the
    device for that many frames per second, 0 for all that it can; `on_log` gets what it has to say. `link.control`
    chooses what it shows. Raises DeviceError here, StreamError while iterating.
    """
    return Link(connect(port or find(baud), baud), Session(fps=fps), on_log)
