"""Packets that no device would send: typed events, bounded time and memory; packet_fuzz.py has more."""

from __future__ import annotations

import random
import tracemalloc

import pytest

from edgeline import split
from edgeline.events import Frame
from edgeline.picture import Picture
from edgeline.session import Session
from packet_fuzz import PACKET_S, SIZES, BrokenPromiseError, Fuzzer

PACKETS = 20_000


def fuzzed(seed: int, packets: int) -> Fuzzer:
    fuzzer = Fuzzer(random.Random(seed))
    fuzzer.run(packets)
    return fuzzer


def test_twenty_thousand_packets_are_survived_each_in_its_time() -> None:
    # Others use this machine as well; a packet that is slow by itself is slow each time.
    fuzzer = fuzzed(1, PACKETS)
    for _ in range(3):
        if fuzzer.worst_s <= PACKET_S:
            break
        fuzzer = fuzzed(1, PACKETS)
    assert fuzzer.worst_s <= PACKET_S, fuzzer.worst
    for kind in ("Frame", "Partial", "Damage", "Connected", "Log", "RateChanged", "SetRate", "Refused"):
        assert fuzzer.events[kind] > 0, f"the fuzzer brings about no {kind}"


def test_memory_is_bounded_by_the_largest_picture() -> None:
    """The picture and two copies of it at most, and what decoding takes: 64 bytes for each pixel of one packet."""
    width, height = SIZES[-1]
    bound = 3 * 2 * width * height + 255 * width * 64 + (8 << 20)
    tracemalloc.start()
    try:
        fuzzer = fuzzed(2, 2_000)
        kept, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert fuzzer.events["Frame"] > 0
    assert peak < bound
    assert kept < bound / 2


def test_a_picture_other_than_the_proven_one_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    copy = Picture.copy
    monkeypatch.setattr(Picture, "copy", lambda self: copy(self) ^ 1)
    with pytest.raises(BrokenPromiseError, match="without its digest"):
        fuzzed(1, 2_000)


def test_an_exception_of_another_kind_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(split, "check_size", lambda *_: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        fuzzed(1, 2_000)


@pytest.mark.parametrize("seed", range(5))
def test_noise_alone_is_no_frame_and_no_memory(seed: int) -> None:
    session = Session()
    rng = random.Random(seed)
    for step in range(300):
        events = session.receive(rng.randbytes(rng.randrange(1, 3000)), step / 50)
        assert not [event for event in events if isinstance(event, Frame)]
    assert session.hello is None
