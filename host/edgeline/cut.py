"""A part of a recording, which stands by itself.

Frames depend on earlier ones, so the part opens with its first verified frame told anew (`snapshot`); from there on it
has the original's bytes, both ways, moved to the time 0. Its frames are those of the original that were verified in the
time that was asked for, to the pixel.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import IO

from edgeline.errors import StreamError
from edgeline.follow import Step, follow
from edgeline.framing import Packet
from edgeline.recording import DamagedRecordingError, Direction, Piece, RecordingReader, RecordingWriter
from edgeline.snapshot import snapshot


@dataclass
class Part:
    """What was cut out: its frames, and when in the original the first and the last of them came, in seconds.

    `damage`: the original is damaged, and the part ends there.
    """

    frames: int = 0
    first_s: float = 0.0
    last_s: float = 0.0
    damage: DamagedRecordingError | None = None


def cut(reader: RecordingReader, output: IO[bytes], from_us: int, to_us: int | None) -> Part:
    """Writes the part of a recording with the frames that were verified at `from_us` or later and before `to_us`, in
    microseconds of the recording; None: to its end.

    Raises StreamError if there is none: then nothing has been written. OSError if writing fails.
    """
    part = Part()
    writer: RecordingWriter | None = None
    begin_us = 0
    try:
        for step in follow(reader):
            time_us = step.piece.time_us
            if to_us is not None and time_us >= to_us:
                break
            if step.frame is not None and time_us >= from_us:
                part.frames += 1
                part.last_s = time_us / 1e6
                if writer is None:
                    part.first_s, begin_us = time_us / 1e6, time_us
                    writer = RecordingWriter(output, replace(reader.header, start_us=reader.header.start_us + time_us))
                    writer.add(Piece(0, Direction.FROM_DEVICE, _opening(step)))
                    continue
            if writer is not None:
                writer.add(replace(step.piece, time_us=time_us - begin_us))
    except DamagedRecordingError as error:
        part.damage = error
    if writer is None:
        end = "its end" if to_us is None else f"{to_us / 1e6:g} s"
        none = StreamError(
            f"{reader.name}: no verified frame between {from_us / 1e6:g} s and {end}: nothing to cut out"
        )
        raise part.damage or none
    writer.flush()
    return part


def _opening(step: Step) -> bytes:
    assert step.frame is not None and step.hello is not None and isinstance(step.chunk, Packet)
    return snapshot(step.hello, step.frame.picture, step.frame.end, step.chunk.seq + 1 & 0xFF)
