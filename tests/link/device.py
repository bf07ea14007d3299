"""The lock-step device of device.c as an object: each request is answered before the next one."""

from __future__ import annotations

import os
import struct
import subprocess
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType

import numpy as np
import numpy.typing as npt

Picture = npt.NDArray[np.uint16]

SEGMENTS, PICTURES, ONE_WAY = 1, 2, 4


@dataclass(frozen=True)
class Boot:
    """A start of the device; device.c says what each member means."""

    scene: str = "solid"
    width: int = 64
    height: int = 48
    band_lines: int = 8
    ring: int = 1024
    rate: int = 115200
    max_rate: int = 115200
    render_us: int = 10000
    clock_us: int = 0
    boot_id: int = 1
    frame: int = 0
    seq: int = 0
    segments: bool = True
    pictures: bool = True
    one_way: bool = False

    def pack(self) -> bytes:
        flags = SEGMENTS * self.segments | PICTURES * self.pictures | ONE_WAY * self.one_way
        sizes = (self.width, self.height, self.band_lines, self.ring)
        numbers = (self.rate, self.max_rate, self.render_us, self.clock_us, self.boot_id)
        head = struct.pack("<4H5IHBB", *sizes, *numbers, self.frame, self.seq, flags)
        return head + self.scene.encode()


@dataclass(frozen=True)
class Truth:
    """A frame as it was drawn: its number, its digest, how many frames were sent since the start and before it, and its
    pixels (height, width) if Boot.pictures asked for them."""

    number: int
    digest: int
    sent: int
    picture: Picture | None


@dataclass
class Answer:
    """What a request brought about. `state`: 0 waiting, 1 running, 2 gone."""

    wire: list[tuple[int, bytes]] = field(default_factory=list)
    truths: list[Truth] = field(default_factory=list)
    inputs: list[tuple[int, int]] = field(default_factory=list)
    clock_us: int = 0
    rate: int = 0
    frames: int = 0
    stalls: int = 0
    damaged: int = 0
    missed: int = 0
    state: int = 0
    credits: int = 0

    @property
    def bytes(self) -> bytes:
        """All that left the device, whatever the rate."""
        return b"".join(piece for _, piece in self.wire)


class Device:
    """A running device.c. To be used in a `with`; `boot` comes first, and whenever the device is to start anew."""

    def __init__(self, program: str | os.PathLike[str]) -> None:
        self._process = subprocess.Popen([Path(program)], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self._shape = (0, 0)

    def __enter__(self) -> Device:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    @property
    def pid(self) -> int:
        """Of its process."""
        return self._process.pid

    def close(self) -> None:
        assert self._process.stdin is not None and self._process.stdout is not None
        self._process.stdin.close()
        self._process.stdout.close()
        self._process.wait(10)

    def boot(self, boot: Boot) -> Answer:
        """Starts the device, in the middle of a frame too; what its port held is lost."""
        self._shape = (boot.height, boot.width)
        return self._ask(b"B", boot.pack())

    def advance(self, us: int, received: bytes = b"") -> Answer:
        """Lets it run for `us`; `received` arrives at the beginning."""
        return self._ask(b"A", struct.pack("<I", us) + received)

    def _ask(self, kind: bytes, body: bytes) -> Answer:
        assert self._process.stdin is not None
        self._process.stdin.write(kind + struct.pack("<I", len(body)) + body)
        self._process.stdin.flush()
        answer = Answer()
        while not self._take(answer):
            pass
        return answer

    def _take(self, answer: Answer) -> bool:
        """One record; true for the last one."""
        head = self._read(5)
        kind, size = head[:1], int.from_bytes(head[1:], "little")
        body = self._read(size)
        if kind == b"W":
            answer.wire.append((int.from_bytes(body[:4], "little"), body[4:]))
        elif kind == b"T":
            number, digest, sent = struct.unpack_from("<HII", body)
            pixels = np.frombuffer(body, "<u2", offset=10)
            answer.truths.append(Truth(number, digest, sent, pixels.reshape(self._shape) if pixels.size else None))
        elif kind == b"I":
            answer.inputs.append(struct.unpack("<Bi", body))
        else:
            assert kind == b"D", f"the device answers with a record of kind {kind!r}"
            (answer.clock_us, answer.rate, answer.frames, answer.stalls, answer.damaged, answer.missed) = (
                struct.unpack_from("<6I", body)
            )
            answer.state, answer.credits = body[24], body[25]
        return kind == b"D"

    def _read(self, size: int) -> bytes:
        assert self._process.stdout is not None
        body = self._process.stdout.read(size)
        if len(body) < size:
            raise RuntimeError(f"the device ended with status {self._process.wait(10)}; its last words are on stderr")
        return body
