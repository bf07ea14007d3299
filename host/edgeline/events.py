"""What a session tells: a type per event. Frames are the ones that are proven; everything else is about the link."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from edgeline import protocol
from edgeline.codec import Pixels
from edgeline.colour import to_rgb
from edgeline.errors import DeviceError


@dataclass(frozen=True)
class Connected:
    """A device is there. `restarted`: it has been started anew since the last time."""

    hello: protocol.Hello
    restarted: bool


@dataclass(frozen=True)
class FrameStats:
    """What a frame cost. Times in microseconds of the device's clock."""

    render_us: int
    """rendering, encoding left out"""
    encode_us: int
    """encoding and writing, waiting for the link included"""
    wire_bytes: int
    """of its bands, framing included"""
    raw_bytes: int
    """of its pixels: 2 * width * height"""
    bands: int
    """BAND packets"""
    not_sent: int
    """frames that the device has rendered and not sent since the last one that it sent"""
    cycles: int | None
    """of the processor while it rendered; None: the board does not count them"""
    counters: dict[str, int]
    """the renderer's work counters by name (firmware/src/base/stats.h)"""

    @property
    def compression(self) -> float | None:
        """Raw bytes for each byte on the wire; None when nothing had to be sent."""
        return self.raw_bytes / self.wire_bytes if self.wire_bytes else None


@dataclass(frozen=True)
class Frame:
    """A verified frame. `picture` is RGB565, uint16 of shape (height, width), read-only and not touched again."""

    number: int
    """the device's count of frames modulo 65536"""
    picture: Pixels
    end: protocol.FrameEnd
    shows_inputs: bool = True
    """it shows all that was asked of the device until now"""
    bands: tuple[protocol.Band, ...] = ()
    """that it came in; lines that no band has were left out, being unchanged"""
    time_s: float = 0.0
    """when it began: seconds of the device's clock since the session's first frame; never goes back"""
    received_s: float = 0.0
    """when its end arrived, by the clock that the session is given"""

    @property
    def rgb565(self) -> Pixels:
        """uint16 of shape (height, width), read-only: red in the upper 5 bits, green in 6, blue in the lower 5."""
        return self.picture

    @cached_property
    def rgb888(self) -> npt.NDArray[np.uint8]:
        """uint8 of shape (height, width, 3): red, green, blue, each widened to 0..255."""
        return to_rgb(self.picture)

    @property
    def mixed(self) -> bool:
        """Some lines are of earlier frames (ROLL): a proven mirror of what was sent, but not one moment's picture."""
        return self.end.mixed

    @property
    def lines_sent(self) -> npt.NDArray[np.bool_]:
        """bool of shape (height,): the lines that came with this frame."""
        sent = np.zeros(len(self.picture), bool)
        for band in self.bands:
            sent[band.y0 : band.y0 + band.lines] = True
        return sent

    @property
    def counters(self) -> dict[str, int]:
        """The renderer's work counters by name (firmware/src/base/stats.h)."""
        return self.end.named_counters()

    @property
    def stats(self) -> FrameStats:
        """What the frame cost on the device and on the wire."""
        end = self.end
        return FrameStats(
            render_us=end.render_us,
            encode_us=end.encode_us,
            wire_bytes=end.wire_bytes,
            raw_bytes=self.picture.nbytes,
            bands=end.bands,
            not_sent=end.dropped,
            cycles=end.cycles or None,
            counters=self.counters,
        )


@dataclass(frozen=True)
class Partial:
    """A frame that failed, for a viewer of a bad link; never a frame to store.

    `proven`, bool of shape (height,), has the lines of `picture` that are what the device sent of them last: each came
    in packets with a right CRC and depends on none that was lost. The others hold anything.
    """

    number: int
    picture: Pixels
    proven: npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Damage:
    """Something arrived that was not what the device sent, or did not arrive. What is missing is asked for again."""

    reason: str


@dataclass(frozen=True)
class Log:
    """Text from the device: a LOG packet, or printable bytes between packets."""

    text: str


@dataclass(frozen=True)
class Stalled:
    """Nothing arrived for `seconds`; the session asks for a HELLO again."""

    seconds: float


@dataclass(frozen=True)
class Refused:
    """The device cannot be served; nothing more will be sent or said."""

    error: DeviceError


@dataclass(frozen=True)
class SetRate:
    """For the owner of the port: from now on its rate has to be `rate`, or `asked` where the port refuses that one.

    The two are at most 2.5 % apart: what the device's divider gives, and what it was asked for.
    """

    rate: int
    asked: int


@dataclass(frozen=True)
class RateChanged:
    """An attempt to change the link's rate has ended. `rate` is what it is now, `why` says so in a line."""

    rate: int
    why: str


Event = Connected | Frame | Partial | Damage | Log | Stalled | Refused | SetRate | RateChanged
