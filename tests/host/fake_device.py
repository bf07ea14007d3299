"""A device in Python: the device's side of WIRE.md, with faults on request, in memory, on a pty and over TCP.

`FakeDevice` is without I/O, as the host's session is: bytes and a time in, bytes out. It stands for the simulator where
a test has to say exactly what goes wrong, and when.
"""

from __future__ import annotations

import contextlib
import os
import random
import select
import socket
import threading
import time
import tty
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np

from edgeline import codec, framing, protocol
from edgeline.codec import PIXEL, Pixels

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


@dataclass
class Faults:
    """What happens to packets on their way, each with a probability per packet, from number `first` up to `last`."""

    seed: int = 0
    flip: float = 0.0
    drop: float = 0.0
    cut: float = 0.0
    duplicate: float = 0.0
    noise: float = 0.0
    first: int = 0
    last: int = 1 << 30
    hits: int = 0

    def __post_init__(self) -> None:
        self._random = random.Random(self.seed)
        self._packet = 0

    def apply(self, chunk: bytes) -> bytes:
        """`chunk` is one encoded packet with its closing zero."""
        number, self._packet = self._packet, self._packet + 1
        if not self.first <= number < self.last:
            return chunk
        before = chunk
        if self._random.random() < self.flip:
            at = self._random.randrange(len(chunk))
            chunk = chunk[:at] + bytes((chunk[at] ^ 1 << self._random.randrange(8),)) + chunk[at + 1 :]
        if self._random.random() < self.cut:
            start = self._random.randrange(len(chunk))
            chunk = chunk[:start] + chunk[self._random.randrange(start, len(chunk)) + 1 :]
        if self._random.random() < self.drop:
            chunk = b""
        if self._random.random() < self.duplicate:
            chunk += chunk
        if self._random.random() < self.noise:
            chunk += self._random.randbytes(self._random.randrange(1, 40))
        self.hits += chunk != before
        return chunk


@dataclass
class FakeDevice:
    """Renders `scene` in bands, leaves unchanged lines out, and counts on credits, as WIRE.md says."""

    width: int = 48
    height: int = 32
    scene: Scene | None = None
    band_lines: int = 8
    boot_id: int = 0x1234ABCD
    runs: bool = True
    skips: bool = True
    takes_input: bool = True
    major: int = protocol.MAJOR
    frame_us: int = 40_000
    faults: Faults = field(default_factory=Faults)
    counters: int = len(protocol.COUNTERS)
    limit: int | None = None
    """Frames after which nothing more is sent."""

    def __post_init__(self) -> None:
        self.scene = self.scene or bars(self.width, self.height)
        self.sent: dict[int, Pixels] = {}
        self.commands: list[protocol.Body] = []
        self._splitter = framing.Splitter()
        self._outgoing: list[bytes] = []
        self._seq = 0
        self._credits = 0
        self._streaming = False
        self._next_hello = 0.0
        self._last_heard = 0.0
        self._frame = 0
        self._known_crcs: list[int | None] = [None] * self.height

    def reboot(self, boot_id: int, now: float) -> None:
        """As if the power had gone: everything begins anew, but the faults go on."""
        self.boot_id = boot_id
        sent, commands = self.sent, self.commands
        self.__post_init__()
        self.sent, self.commands = sent, commands
        self._next_hello = now

    def receive(self, data: bytes, now: float) -> None:
        for chunk in self._splitter.feed(data):
            if not isinstance(chunk, framing.Packet):
                continue
            body = protocol.unpack(chunk)
            if body is None:
                continue
            self._last_heard = now
            self.commands.append(body)
            if isinstance(body, protocol.Ping):
                self._hello()
            elif isinstance(body, protocol.Start):
                self._streaming = True
                self._credits = body.credits
                self._known_crcs = [None] * self.height
            elif isinstance(body, protocol.Ack):
                self._credits = min(255, self._credits + body.credits)
            elif isinstance(body, protocol.Key):
                for y in range(body.y0, min(body.y0 + body.lines, self.height)):
                    self._known_crcs[y] = None
            elif isinstance(body, protocol.Stop):
                self._streaming = False

    def run(self, now: float) -> bytes:
        """Lets the device do what it can: at most one frame. Returns what it puts on the wire."""
        if self._streaming and self._credits == 0 and now - self._last_heard > 1.0:
            self._streaming = False
        if not self._streaming and now >= self._next_hello:
            self._next_hello = now + 1.0
            self._hello()
        if self._streaming and self._credits > 0 and (self.limit is None or self._frame < self.limit):
            self._render()
        data = b"".join(self._outgoing)
        self._outgoing.clear()
        return data

    def text(self, text: bytes) -> None:
        """Bytes that are no packet, as a boot loader writes them."""
        self._outgoing.append(text)

    def send(self, body: protocol.Body) -> None:
        packet = protocol.pack(body, self._seq)
        if isinstance(body, protocol.Hello) and self.major != protocol.MAJOR:
            packet = framing.Packet(packet.type, packet.seq, b"EDGL" + bytes((self.major, 3)) + b"all else differs")
        self._seq = self._seq + 1 & 0xFF
        self._outgoing.append(self.faults.apply(framing.encode(packet)))

    def _hello(self) -> None:
        capabilities = protocol.Capability.RAW | protocol.Capability.RUNS
        if self.skips:
            capabilities |= protocol.Capability.SKIPS_LINES
        if self.takes_input:
            capabilities |= protocol.Capability.INPUT
        self.send(
            protocol.Hello(
                self.width, self.height, capabilities, self.boot_id, "fake board", "edgeline 0.1.0", highest_baud=921600
            )
        )

    def _render(self) -> None:
        assert self.scene is not None
        frame = self._frame & 0xFFFF
        picture = self.scene(self._frame)
        self.sent[self._frame] = picture
        crcs = [zlib.crc32(line.tobytes()) for line in picture]
        bands = 0
        for first in range(0, self.height, self.band_lines):
            due = [
                y
                for y in range(first, min(first + self.band_lines, self.height))
                if not self.skips or crcs[y] != self._known_crcs[y]
            ]
            for y0, y1 in _stretches(due):
                encode = codec.encode_runs if self.runs else codec.encode_raw
                self.send(encode(frame, y0, picture[y0:y1]))
                bands += 1
        self._known_crcs = list(crcs)
        digest = zlib.crc32(np.array(crcs, "<u4").tobytes())
        time_us = self._frame * self.frame_us & 0xFFFFFFFF
        self.send(
            protocol.FrameEnd(
                frame, bands, time_us, 4321, 1234, 5678, 0, digest, tuple(range(100, 100 + self.counters))
            )
        )
        self._frame += 1
        self._credits -= 1


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
