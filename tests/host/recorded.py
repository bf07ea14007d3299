"""Recordings made of a Talk: exact to the microsecond, and the same every time."""

from __future__ import annotations

import io
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from conftest import Edgeline
from edgeline.cli import main
from edgeline.codec import Pixels
from edgeline.events import Frame
from edgeline.follow import follow
from edgeline.protocol import Control
from edgeline.recording import Direction, Header, Piece, RecordingWriter, opened
from fake_device import FakeDevice, bars
from talk import Talk

HEADER = Header(start_us=1_790_000_000_123_456, port="/dev/ttyACM0")
SCENES = 4


def pieces_of(talk: Talk, frames: int, each: Callable[[Talk], None] = lambda talk: None) -> list[Piece]:
    """What passes until `frames` frames are verified, in both directions; `each` is called before each step."""
    pieces: list[Piece] = []
    begin = talk.now
    run, receive = talk.device.run_at_rates, talk.device.receive

    def note(direction: Direction, data: bytes, now: float) -> None:
        if data:
            pieces.append(Piece(round((now - begin) * 1e6), direction, data))

    def run_noted(now: float) -> list[tuple[int, bytes]]:
        sent = run(now)
        note(Direction.FROM_DEVICE, b"".join(data for _, data in sent), now)
        return sent

    def receive_noted(data: bytes, now: float, rate: int | None = None) -> None:
        note(Direction.TO_DEVICE, data, now)
        receive(data, now, rate)

    talk.device.run_at_rates = run_noted  # type: ignore[method-assign]
    talk.device.receive = receive_noted  # type: ignore[method-assign]
    while len(talk.frames) < frames:
        each(talk)
        talk.step()
    return pieces


def called(*arguments: str) -> int:
    """The status of `edgeline ARGUMENTS`, run in this process."""
    try:
        return main(arguments)
    except SystemExit as stopped:
        assert isinstance(stopped.code, int)
        return stopped.code


@pytest.fixture(name="edgeline")
def edgeline_here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Edgeline:
    """As conftest's, in this process: it takes a tenth of the time."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("EDGELINE_PORT", raising=False)

    def run(*arguments: str, env: dict[str, str] | None = None) -> subprocess.CompletedProcess[str]:
        capsys.readouterr()
        with monkeypatch.context() as here:
            for name, value in (env or {}).items():
                here.setenv(name, value)
            status = called(*arguments)
        said = capsys.readouterr()
        return subprocess.CompletedProcess(arguments, status, said.out, said.err)

    return run


def capture(frames: int) -> bytes:
    """What a device says when all its frames are asked for."""
    return b"".join(piece.data for piece in pieces_of(Talk(), frames) if piece.direction is Direction.FROM_DEVICE)


def as_file(pieces: list[Piece], header: Header = HEADER) -> bytes:
    """The recording that holds `pieces`."""
    stream = io.BytesIO()
    writer = RecordingWriter(stream, header)
    for piece in pieces:
        writer.add(piece)
    writer.flush()
    return stream.getvalue()


def write_recording(path: Path, frames: int, device: FakeDevice | None = None) -> list[Frame]:
    """A recording of `device`, of one that uses codec 2 by default. Gives its frames, as the talk verified them."""
    talk = Talk(device or FakeDevice(split=True))
    path.write_bytes(as_file(pieces_of(talk, frames)))
    return talk.frames[:frames]


def frames_of(path: Path) -> list[tuple[float, Frame]]:
    """A recording's verified frames, and when they were complete, in seconds."""
    with opened(str(path)) as reader:
        return [(step.piece.time_us / 1e6, step.frame) for step in follow(reader) if step.frame is not None]


def same(one: Frame, other: Frame) -> bool:
    """The same picture and the same account of it; how it was told may differ."""
    ends = [replace(frame.end, bands=0, wire_bytes=0) for frame in (one, other)]
    return ends[0] == ends[1] and np.array_equal(one.picture, other.picture)


class PlayingDevice(FakeDevice):
    """A FakeDevice that has scenes, which PAUSE, SCENE and FRAME choose among, as the firmware's demo does."""

    def __post_init__(self) -> None:
        super().__post_init__()
        self.place = [0, 0]
        self.paused = False
        self.scene = lambda _: picture_at(*self._next_place(), self.width, self.height)

    def _next_place(self) -> tuple[int, int]:
        scene, frame = self.place
        self.place[1] += not self.paused
        return scene, frame

    def _obey(self, body: object, now: float) -> None:
        before = len(self.taken)
        super()._obey(body, now)  # type: ignore[arg-type]
        for control, value in self.taken[before:]:
            if control == Control.PAUSE:
                self.paused = value == 1
            elif control == Control.SCENE and 0 <= value < SCENES:
                self.place = [value, 0]
            elif control == Control.FRAME:
                self.place[1] = value


def picture_at(scene: int, frame: int, width: int = 48, height: int = 32) -> Pixels:
    """What a PlayingDevice shows there: another picture at each place."""
    picture: Pixels = np.roll(bars(width, height)(frame), 5 * scene, axis=1) ^ np.uint16(scene)
    return picture
