"""The file of a recording: every byte as RECORDING.md draws it, and read up to the damage, wherever that is."""

from __future__ import annotations

import io
import random
import re
import signal
import struct
import subprocess
import sys
import time
import tracemalloc
import zlib
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from conftest import HOST, environment
from edgeline.errors import EdgelineError
from edgeline.recording import (
    CHUNK_BYTES,
    CHUNK_US,
    LARGEST_CHUNK,
    LARGEST_PIECE,
    LATEST_US,
    MAGIC,
    DamagedRecordingError,
    Direction,
    Header,
    Piece,
    RecordingReader,
    RecordingWriter,
)
from fake_device import FakeDevice, PtyDevice
from recorded import HEADER, as_file, frames_of

FROM, TO = Direction.FROM_DEVICE, Direction.TO_DEVICE


def read(data: bytes) -> tuple[Header, list[Piece]]:
    reader = RecordingReader(io.BytesIO(data), "a.elrec")
    return reader.header, list(reader)


def read_up_to_damage(data: bytes) -> tuple[list[Piece], str]:
    """The pieces until then, and what is said of the damage, "" if there is none."""
    pieces = []
    try:
        for piece in RecordingReader(io.BytesIO(data), "a.elrec"):
            pieces.append(piece)
    except DamagedRecordingError as error:
        return pieces, str(error)
    return pieces, ""


def some_pieces(count: int, seed: int = 1) -> list[Piece]:
    random_ = random.Random(seed)
    pieces, now = [], 0
    for _ in range(count):
        now += random_.choice((0, 3, 70_000))
        pieces.append(Piece(now, random_.choice((FROM, TO)), random_.randbytes(random_.randrange(1, 300))))
    return pieces


def chunk(pieces: bytes, time_us: int = 0) -> bytes:
    content = struct.pack("<IQ", len(pieces), time_us) + pieces
    return content + struct.pack("<I", zlib.crc32(content))


def test_the_example_of_the_document() -> None:
    text = (HOST / "RECORDING.md").read_text(encoding="utf-8")
    lines = re.search(r"on the port `p`\.\n\n((?:    .*\n)+)", text)
    assert lines is not None
    drawn = bytes.fromhex("".join(re.match(r"(?:\s+[0-9A-F]{2}\b)+", line)[0] for line in lines[1].splitlines()))  # type: ignore[index]
    pieces = [Piece(5000, FROM, b"\1\2\0"), Piece(6000, TO, b"\3\0")]
    assert as_file(pieces, Header(0, "p")) == drawn
    assert read(drawn) == (Header(0, "p"), pieces)


@settings(max_examples=40)
@given(
    st.lists(st.tuples(st.integers(0, 1 << 34), st.sampled_from(Direction), st.binary(min_size=1, max_size=70_000))),
    st.integers(0, LATEST_US - 1),
    st.text(max_size=300),
)
def test_what_was_written_is_read(steps: list[tuple[int, Direction, bytes]], start_us: int, port: str) -> None:
    now, pieces = 0, []
    for pause, direction, data in steps:
        now += pause
        pieces.append(Piece(now, direction, data))
    header, got = read(as_file(pieces, Header(start_us, port)))
    assert header.start_us == start_us
    assert port.encode("utf-8", "replace").startswith(header.port.encode())
    merged = [(piece.time_us, piece.direction) for piece in pieces for _ in range(-(-len(piece.data) // LARGEST_PIECE))]
    assert [(piece.time_us, piece.direction) for piece in got] == merged
    assert b"".join(piece.data for piece in got) == b"".join(piece.data for piece in pieces)


def test_chunks_are_written_as_the_bytes_come(tmp_path: Path) -> None:
    """And are in the file then, where a kill does not reach them."""
    path = tmp_path / "a.elrec"
    with path.open("wb") as stream:
        writer = RecordingWriter(stream, HEADER)

        def written() -> int:
            return len(read(path.read_bytes())[1])

        writer.add(Piece(0, FROM, b"a"))
        writer.idle(CHUNK_US - 1)
        assert written() == 0
        writer.idle(CHUNK_US)
        assert written() == 1
        writer.add(Piece(CHUNK_US, FROM, bytes(CHUNK_BYTES)))
        assert written() == 2
        writer.add(Piece(2 * CHUNK_US, FROM, b"b"))
        writer.add(Piece(3 * CHUNK_US - 1, FROM, b"c"))
        assert written() == 2
        writer.add(Piece(3 * CHUNK_US, FROM, b"d"))
        assert written() == 4


def test_a_clock_that_goes_back_stands_still() -> None:
    pieces = [Piece(9, FROM, b"a"), Piece(4, FROM, b"b"), Piece(10, FROM, b"c")]
    assert [piece.time_us for piece in read(as_file(pieces))[1]] == [9, 9, 10]


def test_a_file_that_is_cut_off_is_read_up_to_there() -> None:
    pieces = some_pieces(60)
    data = as_file(pieces)
    ends = {len(as_file(pieces[:count])): count for count in range(len(pieces) + 1)}
    complete = 0
    for length in range(len(as_file([])), len(data) + 1, 7):
        got, said = read_up_to_damage(data[:length])
        assert got == pieces[: len(got)]
        assert len(got) >= complete
        complete = len(got)
        if said:
            assert "is cut off near byte" in said
        else:
            assert length in ends
    assert read_up_to_damage(data) == (pieces, "")


def test_a_damaged_file_is_read_up_to_there() -> None:
    pieces = some_pieces(60)
    data = as_file(pieces)
    random_ = random.Random(5)
    for _ in range(300):
        at = random_.randrange(len(as_file([])), len(data))
        damaged = bytearray(data)
        damaged[at] ^= 1 << random_.randrange(8)
        got, said = read_up_to_damage(bytes(damaged))
        assert said
        assert got == pieces[: len(got)]
        assert got == read_up_to_damage(data[:at])[0]


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (chunk(b""), "is damaged"),
        (struct.pack("<IQ", LARGEST_CHUNK + 1, 0) + bytes(LARGEST_CHUNK + 5), "is damaged"),
        (struct.pack("<IQ", 0xFFFFFFFF, 0), "is damaged"),
        (chunk(struct.pack("<BIH", 0, 0, 3) + b"ab"), "is damaged"),
        (chunk(struct.pack("<BIH", 0, 0, 0)[:-1]), "is damaged"),
        (chunk(struct.pack("<BIH", 0, 0, 0), LATEST_US), "is damaged"),
        (chunk(struct.pack("<BIH", 0, 0, 0), 5) + chunk(struct.pack("<BIH", 0, 0, 0), 4), "is damaged"),
    ],
)
def test_rules_that_a_right_crc_does_not_keep(content: bytes, said: str) -> None:
    assert said in read_up_to_damage(HEADER.encode() + content)[1]


def test_what_newer_minor_versions_append_is_passed_over() -> None:
    facts = HEADER.encode()[12:-4] + b"more"
    header = MAGIC + struct.pack("<BBH", 1, 9, len(facts)) + facts
    header += struct.pack("<I", zlib.crc32(header))
    pieces = struct.pack("<BIH", 77, 5, 2) + b"??" + struct.pack("<BIH", 1, 6, 2) + b"ab"
    assert read(header + chunk(pieces, 100)) == (HEADER, [Piece(111, TO, b"ab")])


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (b"", "is no recording"),
        (b"GIF89a" + bytes(40), "is no recording"),
        (MAGIC, "is no recording"),
        (MAGIC + struct.pack("<BBH", 2, 0, 9) + bytes(13), "version 2.0, this host reads 1.x: update the host"),
        (MAGIC + struct.pack("<BBH", 1, 0, 8) + bytes(12), "header is damaged"),
        (MAGIC + struct.pack("<BBH", 1, 0, 60_000) + bytes(60_004), "header is damaged"),
        (HEADER.encode()[:-1], "header is damaged"),
        (HEADER.encode()[:-1] + b"\0", "header is damaged"),
    ],
)
def test_what_is_no_recording(data: bytes, said: str) -> None:
    with pytest.raises(EdgelineError, match=re.escape(said)):
        read(data)


def test_sizes_are_checked_before_memory_is_taken() -> None:
    """A file may say what it likes: reading it takes as much memory as its largest chunk may have."""
    huge = chunk(b"".join(struct.pack("<BIH", 0, 0, 60_000) + bytes(60_000) for _ in range(2)))
    data = HEADER.encode() + 40 * huge + struct.pack("<IQ", 0x7FFFFFFF, 0) + bytes(1000)
    stream = io.BytesIO(data)
    tracemalloc.start()
    with pytest.raises(DamagedRecordingError):
        for _ in RecordingReader(stream, "a.elrec"):
            pass
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 6 * LARGEST_CHUNK


@pytest.mark.parametrize("existing", [False, True])
def test_a_killed_recording_loses_its_last_chunk_at_most(tmp_path: Path, existing: bool) -> None:
    path = tmp_path / "a.elrec"
    if existing:
        path.write_bytes(b"precious")
    with PtyDevice(FakeDevice(split=True), frame_s=0.01) as served:
        recording = subprocess.Popen(
            [sys.executable, "-m", "edgeline", "record", "-p", served.port, "-o", "a.elrec"],
            cwd=tmp_path,
            env=environment(),
            stdout=subprocess.DEVNULL,
        )
        while len(served.device.sent) < 60:
            time.sleep(0.01)
        recording.send_signal(signal.SIGKILL)
        recording.wait(10)
        sent = dict(served.device.sent)
    if existing:  # what stood there stays until the recording is complete
        assert path.read_bytes() == b"precious"
        (path,) = (left for left in tmp_path.iterdir() if left.name.endswith(".part"))
    frames = [frame for _, frame in frames_of(path)]
    assert len(frames) > 10
    assert all((frame.picture == sent[frame.number]).all() for frame in frames)
