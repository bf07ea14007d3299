"""Which file takes frames: the name's ending decides."""

from __future__ import annotations

from pathlib import Path
from typing import Protocol

from edgeline.codec import Pixels
from edgeline.errors import OutputError
from edgeline.exports.apng import ApngRecorder
from edgeline.exports.gif import GifRecorder
from edgeline.exports.mp4 import Mp4Recorder
from edgeline.exports.stills import PngSequence, save_png
from edgeline.outfile import check_writable

__all__ = ["Recorder", "check_writable", "recorder", "save_png"]

KINDS = "*.gif, *.png or *.apng (animated, lossless), *.mp4, or a sequence such as frames/%04d.png"


class Recorder(Protocol):
    """Takes frames one by one. Every method may raise OutputError."""

    def add(self, picture: Pixels, time_us: int) -> None:
        """The next frame, (h, w) RGB565 of one size throughout, begun at `time_us` of the device's clock (mod 2^32)."""

    def finish(self) -> None:
        """Makes the files complete. Without a frame there will be no file."""

    def discard(self) -> None:
        """Leaves everything as if this recorder had not been, except the finished files of a sequence."""


def recorder(path: str) -> Recorder:
    """The recorder for a file name, one of KINDS. Raises OutputError on other names, and where it cannot be written."""
    if "%" in Path(path).name:
        return PngSequence(path)
    suffix = Path(path).suffix.lower()
    if suffix == ".gif":
        return GifRecorder(path)
    if suffix in (".png", ".apng"):
        return ApngRecorder(path)
    if suffix == ".mp4":
        return Mp4Recorder(path)
    raise OutputError(f"{path}: frames are recorded as {KINDS}")
