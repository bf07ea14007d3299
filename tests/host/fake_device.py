"""A device in Python: the device's side of WIRE.md, with faults on request, in memory, on a pty and over TCP.

`FakeDevice` is without I/O, as the host's session is: bytes and a time in, bytes out. It stands for the simulator where
a test has to say exactly what goes wrong, and when.
"""

from __future__ import annotations

import contextlib
import os
import select
import socket
import threading
import time
import tty
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from edgeline import codec, framing, protocol
from edgeline.codec import PIXEL, Pixels
from fake_codec import encode_split
from faults import Faults, garbled

__all__ = ["FakeDevice", "Faults", "PtyDevice", "Scene", "TcpDevice", "bars"]

Scene = Callable[[int], Pixels]


def bars(width: int = 48, height: int = 32) -> Scene:
    """A scene with long runs, noise and lines that never change; another picture for every frame number."""

    def picture(frame: int) -> Pixels:
        pixels = np.zeros((height, width), PIXEL)
        pixels[:, :] = 0x1082
        left = frame * 3 % width
        pixels[height // 4 : height // 2, left : left + width // 4] = 0xF800
        noise = np.random.default_rng(frame).integers(0, 65536, (height // 4, width // 2), np.uint16)
        pixels[height // 2 : height // 2 + height // 4, : width // 2] = noise
        return pixels

    return picture


ALL_CONTROLS = sum(1 << control for control in protocol.Control)
ALL_VIEWS = sum(1 << view for view in protocol.DebugView)


@dataclass
class FakeDevice:
    """Renders `scene` in bands, leaves unchanged lines out, and counts on credits, as WIRE.md says."""

    width: int = 48
    height: int = 32
    scene: Scene | None = None
    band_lines: int = 8
    boot_id: int = 0x1234ABCD
    runs: bool = True
    split: bool = False
    """offers codec 2, and leaves out unchanged segments of lines"""
    skips: bool = True
    takes_input: bool = True
    controls: int = ALL_CONTROLS
    major: int = protocol.MAJOR
    minor: int = protocol.MINOR
    rolls: bool = False
    room: int = 400
    """bytes on the wire that a ROLL frame may take"""
    baud: int = 115200
    max_baud: int = 0
    """0: it does not take SET_BAUD"""
    frame_us: int = 40_000
    faults: Faults = field(default_factory=Faults)
    counters: int = len(protocol.COUNTERS)
    limit: int | None = None
    """Frames after which nothing more is sent."""
    frame: int = 0
    """the first frame's number"""
    seq: int = 0
    time_us: int = 0

    def __post_init__(self) -> None:
        self.scene = self.scene or bars(self.width, self.height)
        self.sent: dict[int, Pixels] = {}
        """pictures by the frame's number; of ROLL, what was sent of them"""
        self.commands: list[protocol.Body] = []
        self.taken: list[tuple[int, int]] = []
        """the controls that were set, in order"""
        self.rate = self.baud
        self.streaming = False
        self.credits = 0
        self.late_credits = 0
        """of those brought since START, what was for frames that had been sent before it"""
        self._began = self.frame
        self._splitter = framing.Splitter()
        self._outgoing: list[tuple[int, bytes]] = []
        self._seq = self.seq
        self._input = 0
        self._mode = protocol.Mode.BLOCK
        self._codecs = protocol.Capability.RAW
        self._next_hello = 0.0
        self._last_heard = 0.0
        self._switched: float | None = None
        self._frame = self.frame
        self._dropped = 0
        self._cursor = 0
        self._alone = True
        self._known: Pixels = np.zeros((self.height, self.width), PIXEL)
        self._due = np.ones(self.height, bool)
        self._never = np.ones(self.height, bool)

    def reboot(self, boot_id: int, now: float) -> None:
        """As if the power had gone: everything begins anew, but the faults go on."""
        self.boot_id = boot_id
        self.frame = self.seq = 0
        sent, commands, taken = self.sent, self.commands, self.taken
        self.__post_init__()
        self.sent, self.commands, self.taken = sent, commands, taken
        self._next_hello = now

    def receive(self, data: bytes, now: float, rate: int | None = None) -> None:
        """Bytes from a host whose port has `rate`; None: the same."""
        for chunk in self._splitter.feed(garbled(data, rate or self.rate, self.rate)):
            if not isinstance(chunk, framing.Packet):
                continue
            body = protocol.unpack(chunk)
            if body is None:
                continue
            self._last_heard = now
            self._switched = None
            self.commands.append(body)
            self._obey(body, now)

    def _obey(self, body: protocol.Body, now: float) -> None:
        if isinstance(body, protocol.Ping):
            self._hello()
        elif isinstance(body, protocol.Start):
            self.streaming = True
            self.credits = body.credits
            self.late_credits = 0
            self._began = self._frame
            self._mode = protocol.Mode(body.mode)
            self._codecs = body.codecs
            self._dropped = 0
            self._due[:] = self._alone = True
        elif isinstance(body, protocol.Ack):
            self.credits = min(255, self.credits + body.credits)
            self.late_credits += (body.frame - self._began & 0x8000) >> 15
        elif isinstance(body, protocol.Key):
            self._due[body.y0 : body.y0 + body.lines] = self._alone = True
        elif isinstance(body, protocol.Stop):
            self.streaming = False
        elif isinstance(body, protocol.Input) and body.number in (None, self._input + 1 & 0xFF):
            self._input = self._input if body.number is None else body.number
            self.taken.append((body.control, body.value))
        elif isinstance(body, protocol.SetBaud):
            rate = body.rate if body.rate <= self.max_baud else self.rate
            self.send(protocol.Baud(rate))
            self._switch(rate, now)

    def _switch(self, rate: int, now: float) -> None:
        if rate != self.rate:
            self.rate = rate
            self._switched = now

    def run(self, now: float) -> bytes:
        """Lets the device do what it can: at most one frame. Returns what it puts on the wire."""
        return b"".join(data for _, data in self.run_at_rates(now))

    def run_at_rates(self, now: float) -> list[tuple[int, bytes]]:
        """As `run`, each piece with the rate that it was sent at."""
        if self.streaming and self.credits == 0 and now - self._last_heard > 1.0:
            self.streaming = False
        unproven = self._switched is not None and now - self._switched > 1.0
        if self.rate != self.baud and (unproven or (not self.streaming and now - self._last_heard > 3.0)):
            self.rate = self.baud
            self._switched = None
            self.streaming = False
            self._next_hello = now
        if not self.streaming and now >= self._next_hello:
            self._next_hello = now + 1.0
            self._hello()
        if self.streaming and self.credits > 0 and (self.limit is None or self._frame < self.limit):
            self._render()
        pieces, self._outgoing = self._outgoing, []
        return pieces

    def text(self, text: bytes) -> None:
        """Bytes that are no packet, as a boot loader writes them."""
        self._outgoing.append((self.rate, text))

    def send(self, body: protocol.Body) -> None:
        packet = protocol.pack(body, self._seq)
        if isinstance(body, protocol.Hello) and self.major != protocol.MAJOR:
            packet = framing.Packet(packet.type, packet.seq, b"EDGL" + bytes((self.major, 3)) + b"all else differs")
        self._seq = self._seq + 1 & 0xFF
        self._outgoing.append((self.rate, self.faults.apply(framing.encode(packet))))

    def _hello(self) -> None:
        offers = {
            protocol.Capability.RAW: True,
            protocol.Capability.RUNS: True,
            protocol.Capability.SPLIT: self.split,
            protocol.Capability.SKIPS_LINES: self.skips,
            protocol.Capability.INPUT: self.takes_input,
            protocol.Capability.ROLL: self.rolls,
            protocol.Capability.SET_BAUD: self.max_baud > 0,
        }
        self.send(
            protocol.Hello(
                self.width,
                self.height,
                protocol.Capability(sum(bit for bit, offered in offers.items() if offered)),
                self.boot_id,
                "fake board",
                "edgeline 0.1.0",
                minor=self.minor,
                highest_baud=self.max_baud or 921600,
                input=self._input,
                scenes=4,
                controls=self.controls if self.takes_input else 0,
                views=ALL_VIEWS,
                baud=self.rate,
            )
        )

    def _render(self) -> None:
        assert self.scene is not None
        picture = self.scene(self._frame)
        rolling = self._mode is protocol.Mode.ROLL
        shown = self._input
        bands = self._roll(picture) if rolling else self._block(picture)
        if rolling and not bands and self._waits(picture).any():
            self._dropped += 1
        else:
            self._finish(bands, shown, not np.array_equal(self._known, picture))
        self._frame += 1

    def _waits(self, picture: Pixels) -> npt.NDArray[np.bool_]:
        """The lines that the host lacks."""
        changed = np.array([row.tobytes() != known.tobytes() for row, known in zip(picture, self._known, strict=True)])
        return self._due | changed | (not self.skips)

    def _block(self, picture: Pixels) -> int:
        wanted = self._waits(picture)
        alone, self._alone = self._alone, False
        bands = 0
        for first in range(0, self.height, self.band_lines):
            lines = range(first, min(first + self.band_lines, self.height))
            for y0, y1 in _stretches([y for y in lines if wanted[y]]):
                self._band(picture, y0, y1, alone)
                bands += 1
        return bands

    def _roll(self, picture: Pixels) -> int:
        wanted = self._waits(picture)
        alone, self._alone = self._alone, False
        room, bands = self.room, 0
        for y in range(self._cursor, self.height):
            if not wanted[y]:
                continue
            before = len(self._outgoing)
            room -= 2 * self.width + 30
            if room < 0:
                self._cursor = y
                return bands
            self._band(picture, y, y + 1, alone)
            assert len(self._outgoing) == before + 1
            bands += 1
        self._cursor = 0
        return bands

    def _band(self, picture: Pixels, y0: int, y1: int, alone: bool) -> None:
        frame, pixels = self._frame & 0xFFFF, picture[y0:y1]
        if protocol.Capability.SPLIT in self._codecs and self.split:
            above = None if alone or y0 == 0 else self._known[y0 - 1].tolist()
            self.send(encode_split(frame, y0, pixels, self._kept(pixels, y0, y1), above))
        else:
            encode = codec.encode_runs if self.runs else codec.encode_raw
            self.send(encode(frame, y0, pixels))
        self._known[y0:y1] = pixels
        self._due[y0:y1] = self._never[y0:y1] = False

    def _kept(self, pixels: Pixels, y0: int, y1: int) -> npt.NDArray[np.bool_]:
        """The segments that the host has."""
        kept = np.zeros(pixels.shape, bool)
        for x in range(0, self.width, 64):
            same = (pixels[:, x : x + 64] == self._known[y0:y1, x : x + 64]).all(axis=1)
            kept[:, x : x + 64] = (same & ~self._due[y0:y1])[:, np.newaxis]
        return kept

    def _finish(self, bands: int, shown: int, mixed: bool) -> None:
        picture = self._known.copy()
        self.sent[self._frame] = picture
        crcs = [0 if never else zlib.crc32(line.tobytes()) for never, line in zip(self._never, picture, strict=True)]
        digest = zlib.crc32(b"".join((crc * 0x9E3779B1 & 0xFFFFFFFF).to_bytes(4, "little") for crc in crcs))
        since_1_2 = self.minor >= 2
        self.send(
            protocol.FrameEnd(
                self._frame & 0xFFFF,
                bands,
                self.time_us + (self._frame - self.frame) * self.frame_us & 0xFFFFFFFF,
                4321,
                1234,
                5678,
                self._dropped,
                digest,
                tuple(range(100, 100 + self.counters)),
                input=shown if since_1_2 else 0,
                mixed=mixed,
                cycles=654321 if since_1_2 else 0,
                owing=bool(self._due.any()),
            )
        )
        self._dropped = 0
        self.credits -= 1


def _stretches(lines: list[int]) -> Iterator[tuple[int, int]]:
    """The half-open stretches of neighbouring numbers in an ascending list."""
    start = 0
    for i in range(1, len(lines) + 1):
        if i == len(lines) or lines[i] != lines[i - 1] + 1:
            yield lines[start], lines[i - 1] + 1
            start = i


class _Served:
    """A FakeDevice with a thread that moves its bytes."""

    def __init__(self, device: FakeDevice, frame_s: float = 0.005) -> None:
        self.device = device
        self.lock = threading.Lock()
        self._frame_s = frame_s
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._serve, daemon=True)

    def __enter__(self) -> _Served:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def stop(self) -> None:
        """The device disappears, as an unplugged board does."""
        self._stopping.set()
        self._thread.join(5)

    @property
    def port(self) -> str:
        raise NotImplementedError

    def _serve(self) -> None:
        raise NotImplementedError

    def _pump(self, descriptor: int) -> None:
        """Until the other end or the test ends it."""
        os.set_blocking(descriptor, False)
        outgoing = b""
        next_frame = 0.0
        while not self._stopping.is_set():
            readable, writable, _ = select.select([descriptor], [descriptor] if outgoing else [], [], 0.001)
            with self.lock:
                if readable:
                    data = os.read(descriptor, 65536)
                    if not data:
                        return
                    self.device.receive(data, time.monotonic())
                if writable:
                    outgoing = outgoing[os.write(descriptor, outgoing[:4096]) :]
                if not outgoing and time.monotonic() >= next_frame:
                    next_frame = time.monotonic() + self._frame_s
                    outgoing = self.device.run(time.monotonic())


class PtyDevice(_Served):
    """On a pty; `port` is its path."""

    def __init__(self, device: FakeDevice, frame_s: float = 0.005) -> None:
        super().__init__(device, frame_s)
        self._master, self._slave = os.openpty()
        tty.setraw(self._slave)
        self._port = os.ttyname(self._slave)

    @property
    def port(self) -> str:
        return self._port

    def stop(self) -> None:
        super().stop()
        for descriptor in (self._master, self._slave):
            with contextlib.suppress(OSError):
                os.close(descriptor)

    def _serve(self) -> None:
        with contextlib.suppress(OSError):
            self._pump(self._master)


class TcpDevice(_Served):
    """On a TCP port of this machine, for one connection after the other."""

    def __init__(self, device: FakeDevice, frame_s: float = 0.005, listen: int = 0) -> None:
        super().__init__(device, frame_s)
        self._listener = socket.create_server(("127.0.0.1", listen))
        self._listener.settimeout(0.05)

    @property
    def port(self) -> str:
        return f"socket://127.0.0.1:{self._listener.getsockname()[1]}"

    def _serve(self) -> None:
        with self._listener:
            while not self._stopping.is_set():
                with contextlib.suppress(OSError):
                    connection, _ = self._listener.accept()
                    with connection:
                        self._pump(connection.fileno())
