"""What a recording means, packet by packet: for those who take it apart or play it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from edgeline.framing import Chunk, Splitter
from edgeline.protocol import Hello
from edgeline.recording import Direction, Piece
from edgeline.session import Frame, Session
from edgeline.snapshot import packets


@dataclass(frozen=True)
class Step:
    """A packet of a recording, or a part of one, for the reads that were recorded end anywhere.

    `chunk` is what `piece` completes, `frame` the frame that is verified by it, `hello` what the device has said that
    it is.
    """

    piece: Piece
    chunk: Chunk | None
    frame: Frame | None
    hello: Hello | None


def follow(pieces: Iterable[Piece]) -> Iterator[Step]:
    """The steps of `pieces`, whose errors it passes on. Holds one frame, whatever the recording's length."""
    session = Session(one_way=True)
    splitters = {direction: Splitter() for direction in Direction}
    for piece in pieces:
        for packet in packets(piece.data):
            chunks = splitters[piece.direction].feed(packet)
            frame: Frame | None = None
            if piece.direction is Direction.FROM_DEVICE:
                events = session.receive(packet, piece.time_us / 1e6)
                session.bytes_to_send()  # nobody is there
                frame = next((event for event in events if isinstance(event, Frame)), None)
            step = Piece(piece.time_us, piece.direction, packet)
            yield Step(step, chunks[0] if chunks else None, frame, session.hello)
