"""`edgeline cut`: each frame of a part is the original's, and the part stands by itself."""

from __future__ import annotations

import io
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from edgeline import framing, protocol
from edgeline.cli import main
from edgeline.codec import PIXEL
from edgeline.cut import cut
from edgeline.errors import StreamError
from edgeline.events import Damage, Frame
from edgeline.framing import Splitter
from edgeline.picture import digest_of
from edgeline.protocol import Control, FrameEnd, Hello, unpack
from edgeline.recording import DamagedRecordingError, Direction, Piece, RecordingReader
from edgeline.session import Session
from edgeline.snapshot import packets, snapshot
from fake_device import FakeDevice
from faults import Faults
from recorded import HEADER, as_file, frames_of, pieces_of, same, write_recording
from talk import Talk

FRAMES = 40


def cut_bytes(data: bytes, begin_us: int, end_us: int | None) -> bytes:
    output = io.BytesIO()
    cut(RecordingReader(io.BytesIO(data), "a.elrec"), output, begin_us, end_us)
    return output.getvalue()


def test_every_cut_has_the_frames_of_its_time(tmp_path: Path) -> None:
    """Between each two times at which a frame is complete, and exactly at them."""
    original = tmp_path / "a.elrec"
    write_recording(original, FRAMES)
    frames = frames_of(original)
    data = original.read_bytes()
    part = tmp_path / "b.elrec"
    times = [round(time_s * 1e6) for time_s, _ in frames]
    for first in range(0, FRAMES - 1, 3):
        for begin_us, end_us, last in (
            (times[first], None, FRAMES),
            (times[first] - 1, times[-1], FRAMES - 1),
            (times[first - 1] + 1 if first else 0, times[first] + 1, first + 1),
        ):
            part.write_bytes(cut_bytes(data, begin_us, end_us))
            got = frames_of(part)
            expected = frames[first:last]
            assert len(got) == len(expected)
            assert all(same(a, b) for (_, a), (_, b) in zip(got, expected, strict=True))
            assert [round((time_s - expected[0][0]) * 1e6) for time_s, _ in expected] == [
                round(time_s * 1e6) for time_s, _ in got
            ]


def test_a_cut_is_whole_from_its_first_byte_on(tmp_path: Path) -> None:
    """No damage, no gap in the packets' numbers, and START is answered at once; its wall clock is the original's."""
    write_recording(tmp_path / "a.elrec", FRAMES)
    data = cut_bytes((tmp_path / "a.elrec").read_bytes(), 400_000, None)
    reader = RecordingReader(io.BytesIO(data), "b.elrec")
    session = Session()
    events = [
        event
        for piece in reader
        if piece.direction is Direction.FROM_DEVICE
        for event in session.receive(piece.data, 0)
    ]
    assert not [event for event in events if isinstance(event, Damage)]
    assert session.counts.lost_packets == 0
    first = next(time_s for time_s, _ in frames_of(tmp_path / "a.elrec") if time_s >= 0.4)
    assert reader.header == replace(HEADER, start_us=HEADER.start_us + round(first * 1e6))


def test_a_cut_of_a_cut_is_a_cut(tmp_path: Path) -> None:
    write_recording(tmp_path / "a.elrec", FRAMES)
    data = (tmp_path / "a.elrec").read_bytes()
    once = cut_bytes(data, 300_000, None)
    begin_us = round(frames_of(tmp_path / "a.elrec")[0][0] * 1e6)
    first_us = next(round(t * 1e6) for t, _ in frames_of(tmp_path / "a.elrec") if t >= 0.3)
    assert begin_us < 300_000
    assert cut_bytes(once, 500_000 - first_us, None) == cut_bytes(data, 500_000, None)


def test_the_host_s_bytes_and_the_device_s_words_are_kept() -> None:
    def say(talk: Talk) -> None:
        if len(talk.frames) == 20:
            talk.device.send(protocol.Log("half-way"))
            talk.session.input(Control.PAUSE, 1)

    pieces = pieces_of(Talk(FakeDevice(split=True)), 30, say)
    cut_pieces = list(RecordingReader(io.BytesIO(cut_bytes(as_file(pieces), 200_000, None)), "b"))
    begin_us = next(piece.time_us for piece in pieces if piece.time_us >= 200_000)
    for direction in Direction:
        before = b"".join(p.data for p in pieces if p.direction is direction and p.time_us > begin_us)
        after = b"".join(p.data for p in cut_pieces if p.direction is direction and p.time_us > 0)
        assert after == before


@pytest.mark.parametrize("seed", range(4))
def test_a_recording_of_a_bad_link_is_cut_like_any_other(seed: int, tmp_path: Path) -> None:
    faults = Faults(seed, flip=0.02, drop=0.02, cut=0.02, duplicate=0.02, noise=0.02)
    path = tmp_path / "a.elrec"
    write_recording(path, FRAMES, FakeDevice(split=True, faults=faults))
    original = {frame.end.time_us: frame for _, frame in frames_of(path)}
    (tmp_path / "b.elrec").write_bytes(cut_bytes(path.read_bytes(), 300_000, None))
    frames = [frame for _, frame in frames_of(tmp_path / "b.elrec")]
    assert frames
    assert all(same(frame, original[frame.end.time_us]) for frame in frames)
    assert [frame.end.time_us for frame in frames] == [
        frame.end.time_us for time_s, frame in frames_of(path) if time_s >= 0.3
    ]


def test_packets_that_were_read_in_pieces(tmp_path: Path) -> None:
    """A slow port gives a few bytes at a time."""
    pieces = pieces_of(Talk(FakeDevice(split=True)), 12)
    crumbs = [
        Piece(piece.time_us, piece.direction, piece.data[i : i + 5])
        for piece in pieces
        for i in range(0, len(piece.data), 5)
    ]
    for name, told in (("a", pieces), ("b", crumbs)):
        (tmp_path / name).write_bytes(cut_bytes(as_file(told), 200_000, 350_000))
    whole, crumbled = ([frame for _, frame in frames_of(tmp_path / name)] for name in "ab")
    assert len(whole) > 3
    assert all(same(a, b) for a, b in zip(whole, crumbled, strict=True))


def test_a_damaged_original_is_cut_up_to_there(tmp_path: Path) -> None:
    write_recording(tmp_path / "a.elrec", FRAMES)
    data = (tmp_path / "a.elrec").read_bytes()
    output = io.BytesIO()
    part = cut(RecordingReader(io.BytesIO(data[:-9]), "a.elrec"), output, 200_000, None)
    assert isinstance(part.damage, DamagedRecordingError)
    (tmp_path / "b.elrec").write_bytes(output.getvalue())
    assert len(frames_of(tmp_path / "b.elrec")) == part.frames > 10


def test_where_there_is_no_frame_there_is_no_cut(tmp_path: Path) -> None:
    write_recording(tmp_path / "a.elrec", 3)
    data = (tmp_path / "a.elrec").read_bytes()
    output = io.BytesIO()
    with pytest.raises(StreamError, match="no verified frame between 5 s and its end"):
        cut(RecordingReader(io.BytesIO(data), "a.elrec"), output, 5_000_000, None)
    assert output.getvalue() == b""


def test_the_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.chdir(tmp_path)
    write_recording(tmp_path / "a.elrec", FRAMES)
    assert main(["cut", "a.elrec", "--from", "0.2", "--to", "0.4", "-o", "b.elrec", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    frames = frames_of(tmp_path / "b.elrec")
    assert (told["output"], told["frames"]) == ("b.elrec", len(frames))
    assert told["last_s"] - told["first_s"] == pytest.approx(frames[-1][0])
    assert main(["cut", "a.elrec", "--from", "9", "-o", "b.elrec"]) == 4
    assert len(frames_of(tmp_path / "b.elrec")) == len(frames)  # what was there is still there
    assert main(["cut", "b.elrec", "--to", "0.1", "-o", "b.elrec"]) == 0
    assert 0 < len(frames_of(tmp_path / "b.elrec")) < len(frames)
    assert {path.name for path in tmp_path.iterdir()} == {"a.elrec", "b.elrec"}


def hello_of(width: int, height: int, largest: int) -> Hello:
    return Hello(width, height, protocol.DECODABLE, 7, "board", "firmware", minor=2, largest_packet=largest)


@pytest.mark.parametrize(("width", "height", "largest"), [(1, 1, 64), (48, 32, 300), (7, 600, 60_000), (2040, 3, 1024)])
def test_a_snapshot_is_one_verified_frame(width: int, height: int, largest: int) -> None:
    picture = np.random.default_rng(1).integers(0, 65536, (height, width), np.uint16).astype(PIXEL)
    end = FrameEnd(65535, 9, 4_000_000_000, 1, 2, 3, 4, digest_of(picture), (1, 2, 3), 250, True, 77)
    data = snapshot(hello_of(width, height, largest), picture, end, 3)
    bodies = [chunk for chunk in Splitter().feed(data) if isinstance(chunk, framing.Packet)]
    assert bodies[-1].seq == 2
    assert [(chunk.seq + 1) % 256 for chunk in bodies[:-1]] == [chunk.seq for chunk in bodies[1:]]
    hello = unpack(bodies[0])
    assert isinstance(hello, Hello)
    assert hello == hello_of(width, height, max(largest, 14 + 2 * width))
    assert max(len(chunk.body) + 6 for chunk in bodies[1:]) <= hello.largest_packet
    session = Session(one_way=True)
    (frame,) = [event for event in session.receive(data, 0) if isinstance(event, Frame)]
    assert np.array_equal(frame.picture, picture)
    assert replace(frame.end, bands=9, wire_bytes=3) == end
    bands = b"".join(framing.encode(chunk) for chunk in bodies[1:-1])
    assert frame.end.wire_bytes == len(bands)
    assert session.counts.damaged == 0


@pytest.mark.parametrize("data", [b"", b"\0", b"ab", b"ab\0", b"\0\0ab\0c"])
def test_packets_are_the_stream_in_pieces(data: bytes) -> None:
    assert b"".join(packets(data)) == data
    assert all(piece.count(b"\0") <= 1 and piece.find(b"\0") in (-1, len(piece) - 1) for piece in packets(data))
    assert all(packets(data))
