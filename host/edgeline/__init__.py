"""Edgeline's host side: pictures from a microcontroller, each proven by its digest.

import edgeline

with edgeline.open("/dev/ttyACM0") as link:
    for frame in link:
        print(frame.number, frame.time_s, frame.rgb565.shape, frame.stats.render_us, frame.counters["pixels"])
"""

import os
from collections.abc import Callable

from edgeline.colour import to_image, to_rgb
from edgeline.discovery import find
from edgeline.errors import DeviceError, EdgelineError, OutputError, StreamEndError, StreamError, WireError
from edgeline.events import Frame, FrameStats
from edgeline.link import FRAME_TIMEOUT_S, Link
from edgeline.protocol import Control, DebugView, FrameEnd, Hello, Mode, Shading
from edgeline.quality import LinkQuality, Statistics
from edgeline.session import Session
from edgeline.transport import connect

__version__ = "0.1.0"

__all__ = [
    "Control",
    "DebugView",
    "DeviceError",
    "EdgelineError",
    "Frame",
    "FrameEnd",
    "FrameStats",
    "Hello",
    "Link",
    "LinkQuality",
    "Mode",
    "OutputError",
    "Shading",
    "Statistics",
    "StreamEndError",
    "StreamError",
    "WireError",
    "open",
    "to_image",
    "to_rgb",
]


def open(
    port: str | None = None,
    baud: int = 115200,
    *,
    mode: str = "block",
    fps: int = 0,
    timeout: float = FRAME_TIMEOUT_S,
    fast: int | None = None,
    on_log: Callable[[str], None] | None = None,
) -> Link:
    """Opens a device and gives a context manager that iterates over its verified frames.

    >>> with edgeline.open("/dev/ttyACM0") as link:
    ...     for frame in itertools.islice(link, 3):
    ...         print(frame.number, frame.time_s, frame.rgb565.shape, frame.rgb888.shape, frame.stats.render_us)
    0 0.0 (240, 320) (240, 320, 3) 4321
    1 0.04 (240, 320) (240, 320, 3) 4321
    2 0.08 (240, 320) (240, 320, 3) 4321

    Of each frame:

    * ``frame.rgb565``: numpy uint16 of shape (height, width), read-only: red in the upper 5 bits, green in 6, blue in
      the lower 5; row 0 is the top, column 0 the left.
    * ``frame.rgb888``: numpy uint8 of shape (height, width, 3): red, green, blue.
    * ``frame.number``: the device's count of frames modulo 65536; ``frame.time_s``: seconds of the device's clock since
      the first frame, which never go back.
    * ``frame.stats``: what it cost, times in microseconds, sizes in bytes; ``frame.counters``: the renderer's work.
    * ``frame.mixed`` (mode roll): lines of several frames, as the device's display may show them, too.

    ``port``: a serial port or pty, ``socket://HOST:PORT``, a file with a captured stream, or ``-``; None is the
    environment's EDGELINE_PORT or else the one port on which an Edgeline answers. ``baud``: the rate to begin with, in
    bits per second; ``fast`` the one to go on with, 0 for the device's highest. ``mode``: "block" (every frame whole,
    the device waits for the link) or "roll" (the device never waits). ``fps``: frames per second at most, 0 for all
    that the device can. ``timeout``: seconds without a verified frame after which iterating raises StreamError.
    ``on_log`` gets what the device has to say, a fault report for instance.

    ``link.control("scene", 2)`` and the like choose what is shown; ``link.hello``, ``link.quality`` and
    ``link.statistics`` tell what the device is and how the link does.

    Raises EdgelineError for arguments out of range, DeviceError if the port does not open or no device is found there;
    iterating raises DeviceError if nothing answers or it speaks another version, StreamError if the link ends.
    """
    if mode.upper() not in Mode.__members__:
        raise EdgelineError(f"no mode '{mode}': there are block and roll")
    session = Session(fps=fps, mode=Mode[mode.upper()], fast=fast)
    port = port or os.environ.get("EDGELINE_PORT") or find(baud)
    return Link(connect(port, baud), session, on_log, timeout)
