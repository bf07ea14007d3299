"""Packets that no device would send, through everything that a packet passes: framing, unpacking, session, picture.

The quick test runs some thousands (test_any_bytes_are_survived.py). At length, for the night, ten million:

    PYTHONPATH=host:tests/host python tests/host/packet_fuzz.py --packets 10000000 --seed 1

which ends with status 0 and a line of counts, or with the seed and number of the packet that broke a promise. With
`--atheris`, where that package is installed, libFuzzer chooses what the generator's dice show, guided by coverage; what
follows it are libFuzzer's own options (`--atheris -runs=10000000 -max_len=4096`).

The promises: nothing but typed events comes out, however broken the packet; none takes more than PACKET_S of CPU; what
is kept is bounded by the largest picture; a frame that is told as good has the digest of its own pixels.
"""

from __future__ import annotations

import argparse
import random
import struct
import sys
import time
from collections import Counter
from dataclasses import dataclass, field

from edgeline import framing, protocol, split
from edgeline.errors import EdgelineError
from edgeline.events import Event, Frame
from edgeline.picture import digest_of
from edgeline.protocol import Band, Baud, Capability, Codec, FrameEnd, Hello, Log
from edgeline.session import Session, State

PACKET_S = 0.050
MOST_OUTGOING = 1 << 16
"""Bytes that the session may have to say at once."""

SIZES = ((1, 1), (5, 3), (48, 32), (64, 64), (130, 40), (320, 240), (2040, 8), (8, 2040), (2040, 2040))
_ANY_CODEC = Capability.RAW | Capability.RUNS | Capability.SPLIT
_CAPABILITIES = (_ANY_CODEC, _ANY_CODEC | Capability.INPUT | Capability.ROLL | Capability.SET_BAUD, Capability.RUNS)


class BrokenPromiseError(Exception):
    """What the fuzzer is looking for."""


@dataclass
class Fuzzer:
    """A session, and a device that has lost its mind."""

    rng: random.Random
    packets: int = 0
    worst_s: float = 0.0
    worst: str = ""
    events: Counter[str] = field(default_factory=Counter)

    def __post_init__(self) -> None:
        self._now = 0.0
        self._seq = 0
        self._renew()

    def _renew(self) -> None:
        mode = self.rng.choice((protocol.Mode.BLOCK, protocol.Mode.BLOCK, protocol.Mode.ROLL))
        self.session = Session(mode=mode, baud=115200, fast=self.rng.choice((None, None, 0)))
        self._resize()
        self._frame = 0
        self._y = 0
        self._bands = 0
        self._boot = self.rng.getrandbits(32)

    def _resize(self) -> None:
        small = self.rng.random() < 0.7
        self._width, self._height = self.rng.choice(SIZES[:5] if small else SIZES)

    def run(self, packets: int) -> None:
        """Raises BrokenPromiseError."""
        for _ in range(packets):
            self.step()

    def step(self) -> None:
        """One packet, or what stands for one."""
        if self.session.state is State.REFUSED or self.rng.random() < 0.002:
            self._renew()
        wire = self._wire()
        self._now += self.rng.choice((0.0, 0.001, 0.02, 0.02, 0.3, 3.0) if self.rng.random() < 0.1 else (0.001,))
        began = time.thread_time()
        events = self.session.tick(self._now)
        cut = self.rng.randrange(len(wire) + 1) if wire and self.rng.random() < 0.2 else len(wire)
        events += self.session.receive(wire[:cut], self._now)
        events += self.session.receive(wire[cut:], self._now)
        seconds = time.thread_time() - began
        self.packets += 1
        if seconds > self.worst_s:
            self.worst_s = seconds
            self.worst = f"packet {self.packets}, {len(wire)} bytes, {self._width}x{self._height}"
        if self.rng.random() < 0.02:
            self._use()
        self._check(events)

    def _check(self, events: list[Event]) -> None:
        for event in events:
            self.events[type(event).__name__] += 1
            if isinstance(event, Frame) and digest_of(event.picture) != event.end.digest:
                raise BrokenPromiseError(f"packet {self.packets}: a frame without its digest")
        if len(self.session.bytes_to_send()) > MOST_OUTGOING:
            raise BrokenPromiseError(f"packet {self.packets}: too much to say")

    def _use(self) -> None:
        """What a user does meanwhile; he gets one clear line at most."""
        try:
            if self.rng.random() < 0.7:
                self.session.input(self.rng.randrange(256), self.rng.randrange(-(2**31), 2**31))
            else:
                self.session.request_baud(self.rng.choice((0, 921600, 57600)))
        except EdgelineError:
            self.events["refused to the user"] += 1

    # --- the packets --------------------------------------------------------------------------------------------------

    def _wire(self) -> bytes:
        dice = self.rng.random()
        if dice < 0.02:
            return self.rng.randbytes(self.rng.randrange(200)) + bytes(self.rng.randrange(2))
        if dice < 0.03:
            return b"printable \xc3\xa4" * self.rng.randrange(20) + b"\0"
        body, kind = self._body()
        if self.rng.random() < 0.1:
            body = self._mutated(body)
        if self.rng.random() < 0.02:
            kind = self.rng.randrange(256)
        if self.rng.random() < 0.02:
            self._seq = self.rng.randrange(256)
        self._seq = self._seq + 1 & 0xFF
        wire = framing.encode(framing.Packet(kind, self._seq, body))
        if self.rng.random() < 0.01:
            wire = self._mutated(wire)
        return wire * (2 if self.rng.random() < 0.005 else 1)

    def _mutated(self, data: bytes) -> bytes:
        at = self.rng.randrange(len(data) + 1)
        end = min(len(data), at + self.rng.randrange(5))
        return data[:at] + self.rng.choice((b"", b"\0", b"\xff", self.rng.randbytes(3))) + data[end:]

    def _body(self) -> tuple[bytes, int]:
        dice = self.rng.random()
        met = self.session.hello is not None and self.session.state is not State.WAITING
        if dice < (0.002 if met else 0.5):
            return self._hello().encode(), protocol.PacketType.HELLO
        if dice < 0.01:
            return Log("x" * self.rng.randrange(300)).encode(), protocol.PacketType.LOG
        if dice < 0.02:
            return Baud(self.rng.choice((0, 1, 57600, 115200, 923076, 2**32 - 1))).encode(), protocol.PacketType.BAUD
        if dice < 0.03:
            return self.rng.randbytes(self.rng.randrange(80)), self.rng.randrange(16)
        if self._y >= self._height or dice < 0.25:
            return self._end().encode(), protocol.PacketType.FRAME_END
        return self._band().encode(), protocol.PacketType.BAND

    def _hello(self) -> Hello:
        if self.rng.random() < 0.3:
            self._boot = self.rng.getrandbits(32)
            self._resize()
        return Hello(
            self._width,
            self._height,
            self.rng.choice(_CAPABILITIES),
            self._boot,
            "fuzz",
            "1",
            minor=self.rng.choice((0, 1, 2, 2, 3)),
            highest_baud=self.rng.choice((0, 921600, 2**32 - 1)),
            input=self.rng.randrange(256),
            controls=self.rng.getrandbits(32),
            baud=self.rng.choice((0, 115200)),
        )

    def _end(self) -> FrameEnd:
        """Often right, so that frames are verified: the digest is the one that the session's own picture has."""
        stream = self.session._stream
        digest = self.rng.getrandbits(32)
        if stream is not None and self.rng.random() < 0.8:
            try:
                if stream._assembly is not None:
                    stream._picture.finish(stream._assembly)
                digest = stream._picture.digest()
            except EdgelineError:
                self.events["a band that breaks a rule"] += 1
        end = FrameEnd(
            self._frame,
            self._bands if self.rng.random() < 0.9 else self.rng.randrange(65536),
            self.rng.getrandbits(32),
            self.rng.getrandbits(32),
            0,
            self.rng.choice((0, 5000)),
            self.rng.choice((0, 0, 1, 65535)),
            digest,
            tuple(self.rng.getrandbits(32) for _ in range(self.rng.choice((0, 18, 255)))),
            input=self.rng.randrange(256),
            mixed=self.rng.random() < 0.2,
            owing=self.rng.random() < 0.1,
        )
        self._frame = self._frame + self.rng.choice((1, 1, 1, 1, 2, 0, 40000)) & 0xFFFF
        self._y = self._bands = 0
        return end

    def _band(self) -> Band:
        lines = min(self.rng.choice((1, 2, 8, 8, 255)), self._height - self._y, 255)
        y0 = self._y if self.rng.random() < 0.97 else self.rng.randrange(65536)
        pixels = lines * self._width
        codec = self.rng.choice((Codec.RAW, Codec.RUNS, Codec.SPLIT, Codec.SPLIT, Codec.SPLIT))
        if 2 * pixels > framing.MAX_PACKET - 100:
            codec = Codec.SPLIT
        self._y += lines
        self._bands += 1
        if codec is Codec.RAW:
            return Band(self._frame, y0, lines, codec, b"", self.rng.randbytes(2 * pixels))
        if codec is Codec.RUNS:
            tokens, used = self._runs(lines)
            return Band(self._frame, y0, lines, codec, tokens, self.rng.randbytes(2 * used))
        tokens, used = self._split(lines)
        lags = self.rng.randbytes(-(-lines // 8)) if self.rng.random() < 0.3 else b""
        joined = self.rng.random() < 0.5
        return Band(self._frame, y0, lines, codec, tokens, self.rng.randbytes(2 * used), lags, joined)

    def _runs(self, lines: int) -> tuple[bytes, int]:
        line = b"\xff" * (self._width // 129)
        rest = self._width % 129
        used = len(line) + (rest > 0)
        return (line + (bytes((rest + 126,)) if rest >= 2 else b"\0" * rest)) * lines, used * lines

    def _split(self, lines: int) -> tuple[bytes, int]:
        """A line of a few kinds of tokens again and again: right where no copy stands in the first line."""
        kinds = [self.rng.randrange(256) for _ in range(self.rng.choice((1, 2, 6)))]
        line, x, used = bytearray(), 0, 0
        while x < self._width:
            token = self.rng.choice(kinds) if len(line) < 40 else split.SKIP_TO_END
            size = split.length(token) or self._width - x
            if x + size > self._width:
                token, size = 0, 1
            line.append(token)
            used += size if token >= split.LITERALS else 0
            x += size
        return bytes(line) * lines, min(used * lines, (framing.MAX_PACKET - 100 - len(line) * lines) // 2)


def at_length(packets: int, seed: int) -> int:
    """Runs in slices, each with a seed of its own, so that a finding is quickly seen again."""
    slice_size = 20_000
    done = 0
    worst = (0.0, "")
    events: Counter[str] = Counter()
    began = time.monotonic()
    while done < packets:
        fuzzer = Fuzzer(random.Random(seed))
        try:
            fuzzer.run(min(slice_size, packets - done))
        except Exception as error:
            print(f"seed {seed}, {fuzzer.packets + 1} packets: {type(error).__name__}: {error}")
            return 1
        if fuzzer.worst_s > PACKET_S:
            print(f"seed {seed}: {fuzzer.worst} took {1000 * fuzzer.worst_s:.1f} ms")
            return 1
        done += fuzzer.packets
        events += fuzzer.events
        worst = max(worst, (fuzzer.worst_s, f"seed {seed}, {fuzzer.worst}"))
        seed += 1
    seconds = time.monotonic() - began
    print(f"{done} packets in {seconds:.0f} s; slowest {1000 * worst[0]:.1f} ms ({worst[1]}); {dict(events)}")
    return 0


class _Chosen(random.Random):
    """Dice that show what libFuzzer wants: its bytes, one after the other, then zeros."""

    def __init__(self, data: bytes) -> None:
        super().__init__(0)
        self._data = data
        self._at = 0

    def getrandbits(self, k: int, /) -> int:
        size = -(-k // 8)
        taken = self._data[self._at : self._at + size]
        self._at += size
        return int.from_bytes(taken.ljust(size, b"\0"), "little") >> (8 * size - k)

    def random(self) -> float:
        return self.getrandbits(16) / 65536

    def randbytes(self, n: int) -> bytes:
        return struct.pack("<I", self.getrandbits(32)) * (n // 4) + bytes(n % 4)

    @property
    def exhausted(self) -> bool:
        return self._at >= len(self._data)


def _one_input(data: bytes) -> None:
    dice = _Chosen(data)
    fuzzer = Fuzzer(dice)
    while not dice.exhausted and fuzzer.packets < 1000:
        fuzzer.step()


def main() -> int:
    """The command of the module's docstring."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--packets", type=int, default=1_000_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--atheris", nargs=argparse.REMAINDER, help="libFuzzer's options")
    options = parser.parse_args()
    if options.atheris is None:
        return at_length(options.packets, options.seed)
    try:
        import atheris  # noqa: PLC0415 (a tool of the night, not of the tests)
    except ImportError:
        print("atheris is not installed: pip install atheris, or leave out --atheris", file=sys.stderr)
        return 2
    atheris.instrument_all()
    atheris.Setup([sys.argv[0], *options.atheris], _one_input)
    atheris.Fuzz()
    return 0


if __name__ == "__main__":
    sys.exit(main())
