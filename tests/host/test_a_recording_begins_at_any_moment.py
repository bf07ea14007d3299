"""A Tap records what passes over a link from any moment on, and never stands in the link's way."""

from __future__ import annotations

from pathlib import Path

import pytest

from edgeline.errors import OutputError
from edgeline.events import Damage, Frame
from edgeline.recording import Direction, opened
from edgeline.session import Session
from edgeline.tap import Tap
from fake_device import FakeDevice, bars
from recorded import frames_of, same
from talk import Talk


class Wire:
    """A transport over a Talk's device, which gives what it likes at a time."""

    name, one_way, baud = "a port", False, 0

    def __init__(self, talk: Talk, read_bytes: int) -> None:
        self.talk, self._read_bytes, self._ready = talk, read_bytes, b""

    def read(self) -> bytes:
        self.talk.now += 0.02
        while len(self._ready) < self._read_bytes and (data := self.talk.device.run(self.talk.now)):
            self._ready += data  # so that a read may end one frame and begin the next
        data, self._ready = self._ready[: self._read_bytes], self._ready[self._read_bytes :]
        return data

    def write(self, data: bytes) -> None:
        self.talk.device.receive(data, self.talk.now)

    def set_baud(self, rate: int) -> bool:
        return True

    def close(self) -> None:
        """Nothing is open."""


class Viewing:
    """What a viewer does with a Tap: reads, tells it of frames, starts and stops a recording."""

    def __init__(self, read_bytes: int) -> None:
        self.talk = Talk(FakeDevice(split=True))
        self.tap = Tap(Wire(self.talk, read_bytes))
        self.session = Session()
        self.frames: list[Frame] = []

    def until(self, count: int) -> list[Frame]:
        """Goes on until there are `count` frames more at least; gives them."""
        before = len(self.frames)
        while len(self.frames) < before + count:
            self.session.tick(self.talk.now)
            self.send()
            for event in self.session.receive(self.tap.read(), self.talk.now):
                if isinstance(event, Frame):
                    assert self.session.hello is not None
                    self.frames.append(event)
                    self.tap.frame(self.session.hello, event)
            self.send()
        return self.frames[before:]

    def send(self) -> None:
        data = self.session.bytes_to_send()
        if data:
            self.tap.write(data)


@pytest.mark.parametrize("read_bytes", [7, 100, 1 << 16])
def test_a_recording_begins_in_the_middle_of_a_stream(read_bytes: int, tmp_path: Path) -> None:
    viewing = Viewing(read_bytes)
    viewing.until(10)
    viewing.tap.start(str(tmp_path / "a.elrec"), at_next_frame=True)
    shown = viewing.until(10)
    recorded = viewing.tap.stop()
    assert recorded is not None
    viewing.until(5)
    frames = [frame for _, frame in frames_of(tmp_path / "a.elrec")]
    assert len(shown) - len(frames) in (0, 1)  # the first may have begun before the recording was asked for
    assert all(same(a, b) for a, b in zip(frames, shown[-len(frames) :], strict=True))
    with opened(str(tmp_path / "a.elrec")) as reader:
        pieces = list(reader)
    assert sum(len(piece.data) for piece in pieces if piece.direction is Direction.FROM_DEVICE) == recorded.received
    assert sum(len(piece.data) for piece in pieces if piece.direction is Direction.TO_DEVICE) == recorded.sent > 0
    session = Session(one_way=True)
    events = [e for p in pieces if p.direction is Direction.FROM_DEVICE for e in session.receive(p.data, 0)]
    assert not [event for event in events if isinstance(event, Damage)]


def test_a_recording_that_got_no_frame_is_no_file(tmp_path: Path) -> None:
    (tmp_path / "b.elrec").write_bytes(b"precious")
    viewing = Viewing(1 << 16)
    for name in ("a.elrec", "b.elrec"):
        viewing.tap.start(str(tmp_path / name), at_next_frame=True)
        assert viewing.tap.state is not None
        assert viewing.tap.state.seconds == 0.0
        assert viewing.tap.stop() is None
        assert viewing.tap.state is None
    assert [(path.name, path.read_bytes()) for path in tmp_path.iterdir()] == [("b.elrec", b"precious")]
    with pytest.raises(OutputError, match="no/such/folder"):
        viewing.tap.start(str(tmp_path / "no/such/folder/a.elrec"), at_next_frame=True)


def test_a_recording_goes_on_over_another_link(tmp_path: Path) -> None:
    viewing = Viewing(1 << 16)
    viewing.tap.start(str(tmp_path / "a.elrec"), at_next_frame=False)
    first = viewing.until(5)
    viewing.talk = Talk(FakeDevice(split=True, boot_id=99, scene=bars(48, 32)))
    viewing.session = Session()
    viewing.tap.attach(Wire(viewing.talk, 1 << 16))
    second = viewing.until(5)
    viewing.tap.stop()
    frames = [frame for _, frame in frames_of(tmp_path / "a.elrec")]
    assert len(frames) >= 10
    assert all(same(a, b) for a, b in zip(frames, first + second, strict=True))


def test_a_full_disk_ends_the_recording_and_not_the_link(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    viewing = Viewing(1 << 16)
    viewing.tap.start(str(tmp_path / "a.elrec"), at_next_frame=True)
    viewing.until(5)

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("edgeline.recording.RecordingWriter.add", full)
    viewing.until(5)
    assert "a.elrec: cannot be written: No space left on device" in str(viewing.tap.failure)
    assert viewing.tap.state is None
    monkeypatch.undo()
    viewing.tap.start(str(tmp_path / "b.elrec"), at_next_frame=True)
    shown = viewing.until(3)
    assert viewing.tap.failure is None
    viewing.tap.stop()
    assert len(frames_of(tmp_path / "b.elrec")) == len(shown)
