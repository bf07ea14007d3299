"""After a loss the host asks for the lines that it may lack, as soon as it knows which, and knows what is proven."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from edgeline import protocol
from edgeline.codec import PIXEL, Pixels
from edgeline.errors import WireError
from edgeline.picture import Assembly, Picture, digest_of
from edgeline.protocol import Ack, Band, FrameEnd, Key
from edgeline.session import Damage, Event, Frame, Partial
from edgeline.stream import Stream
from fake_codec import encode_split
from fake_device import FakeDevice, Faults, Scene
from talk import Talk

HEIGHT, BAND = 32, 8


def rows(frame: int) -> Pixels:
    """Every line differs from those of all other frames."""
    return (np.arange(HEIGHT)[:, np.newaxis] * 1000 + frame + np.zeros(80, int)).astype(PIXEL)


def stripes(frame: int) -> Pixels:
    """Columns of many colours, so that a line is told by the one above; some change with every third frame, some with
    every fifth."""
    picture = np.zeros((HEIGHT, 80), PIXEL)
    for first, period in ((0, 3), (12, 5), (20, 3)):
        picture[first:] = np.random.default_rng(frame // period + first).integers(0, 65536, 80, np.uint16)
    return picture


def streaming(scene: Scene = rows, split: bool = False) -> Talk:
    """A talk that has frames already; each of `rows` has 4 bands of 8 lines and a FRAME_END."""
    talk = Talk(FakeDevice(80, HEIGHT, scene, BAND, split=split))
    talk.run(5)
    talk.device.commands.clear()
    talk.events.clear()
    return talk


def lose(talk: Talk, first: int, last: int) -> None:
    """Of the packets that follow, those from `first` to before `last`."""
    talk.device.faults = Faults(drop=1.0, first=first, last=last)


def keys_and_acks(talk: Talk) -> list[Key | Ack]:
    return [body for body in talk.device.commands if isinstance(body, Key | Ack)]


@pytest.mark.parametrize("band", range(3))
def test_a_lost_band_is_asked_for_before_its_frame_ends(band: int) -> None:
    talk = streaming()
    lose(talk, band, band + 1)
    number = talk.device._frame
    talk.run(3)
    assert keys_and_acks(talk) == [Key(band * BAND, BAND), Ack(number, 1), Ack(number + 1, 1), Ack(number + 2, 1)]
    assert [frame.number for frame in talk.frames] == [number + 1, number + 2]


def test_the_last_band_is_asked_for_at_the_frame_s_end_ahead_of_its_ack() -> None:
    talk = streaming()
    lose(talk, 3, 4)
    number = talk.device._frame
    talk.step()
    assert keys_and_acks(talk) == [Key(24, 8), Ack(number, 1)]


def test_a_lost_frame_end_asks_for_nothing_but_what_may_have_been_in_between() -> None:
    """Between the last line of one frame and the first of the next there is nothing."""
    talk = streaming()
    lose(talk, 4, 5)
    number = talk.device._frame
    talk.run(2)
    assert keys_and_acks(talk) == [Ack(number, 1), Ack(number + 1, 1)]
    assert [frame.number for frame in talk.frames] == [number + 1]


def test_what_was_lost_around_a_frame_s_end_is_asked_for_in_two_pieces() -> None:
    talk = streaming()
    lose(talk, 3, 6)
    number = talk.device._frame
    talk.run(2)
    assert keys_and_acks(talk) == [Ack(number, 1), Key(0, 8), Key(24, 8), Ack(number + 1, 1)]


def test_a_frame_that_vanished_as_a_whole_is_acknowledged_all_the_same() -> None:
    talk = streaming()
    lose(talk, 0, 5)
    number = talk.device._frame
    talk.run(40)
    assert keys_and_acks(talk)[:4] == [Key(0, HEIGHT), Ack(number, 1), Ack(number + 1, 1), Ack(number + 2, 1)]
    assert [frame.number for frame in talk.frames][:2] == [number + 1, number + 2]
    assert talk.session.counts.failed == 1


def test_frames_that_were_not_sent_are_not_missed() -> None:
    talk = streaming()
    number = talk.device._frame
    talk.device._frame += 3
    talk.device._dropped = 3
    talk.run(2)
    assert keys_and_acks(talk) == [Ack(number + 3, 1), Ack(number + 4, 1)]


def test_a_lost_log_asks_for_nothing() -> None:
    talk = streaming()
    lose(talk, 0, 1)
    talk.device.send(protocol.Log("lost"))
    talk.run(3)
    assert [type(event) for event in talk.events] == [Damage, Frame, Frame, Frame]
    assert not [body for body in talk.device.commands if isinstance(body, Key)]


def test_garbage_between_packets_asks_for_nothing() -> None:
    talk = streaming()
    talk.device.text(b"\xff\xfe\xfd\0")
    talk.run(3)
    assert [type(event) for event in talk.events] == [Damage, Frame, Frame, Frame]
    assert not [body for body in talk.device.commands if isinstance(body, Key)]


def test_a_packet_that_came_twice_is_taken_once() -> None:
    talk = streaming()
    talk.device.faults = Faults(duplicate=1.0, first=2, last=3)
    talk.run(2)
    assert [type(event) for event in talk.events] == [Damage, Frame, Frame]
    assert not [body for body in talk.device.commands if isinstance(body, Key)]


def test_a_key_that_was_lost_is_sent_again_after_the_frames_that_were_on_their_way() -> None:
    talk = streaming()
    lose(talk, 1, 2)
    still = rows(talk.device._frame)
    talk.device.scene = lambda _: still
    number = talk.device._frame
    obey = talk.device._obey
    lost: list[Key] = []

    def deaf(body: protocol.Body, now: float) -> None:
        if isinstance(body, Key) and not lost:
            lost.append(body)
        else:
            obey(body, now)

    talk.device._obey = deaf  # type: ignore[method-assign]
    talk.run(6)
    assert keys_and_acks(talk)[:5] == [
        Key(8, 8),
        Ack(number, 1),
        Ack(number + 1, 1),
        Key(8, 8),
        Ack(number + 2, 1),
    ]
    assert talk.frames[0].number == number + 3


def test_what_nothing_explains_asks_for_all_lines() -> None:
    talk = streaming()
    send = talk.device.send

    def lie(body: protocol.Body) -> None:
        send(body if not isinstance(body, FrameEnd) else protocol.FrameEnd.decode(_other_digest(body).encode()))

    talk.device.send = lie  # type: ignore[method-assign]
    talk.step()
    assert keys_and_acks(talk)[0] == Key(0, HEIGHT)


def _other_digest(end: FrameEnd) -> FrameEnd:
    return FrameEnd(**{**end.__dict__, "digest": end.digest ^ 1})


def band(y0: int, lines: int, *, joined: bool = False, skips: bool = False) -> Band:
    kept = np.full((lines, 80), skips)
    return encode_split(0, y0, rows(1)[y0 : y0 + lines], kept, rows(1)[y0 - 1].tolist() if joined else None)


@pytest.mark.parametrize(
    ("bands", "in_doubt"),
    [
        ([band(4, 4)], [(0, 0)]),
        ([band(4, 2)], [(6, 8)]),
        ([band(0, 4), band(4, 4)], [(0, 0)]),
        ([band(8, 4, joined=True)], [(4, 12)]),
        ([band(8, 4, joined=True), band(12, 4, joined=True)], [(4, 16)]),
        ([band(8, 4, joined=True), band(12, 4)], [(4, 12)]),
        ([band(4, 4, skips=True)], [(4, 8)]),
        ([band(8, 4, skips=True)], [(4, 8)]),
        ([band(16, 4, joined=True)], [(4, 8)]),
        ([band(0, 32, skips=True)], [(4, 32)]),
        ([band(0, 6, skips=True), band(6, 4)], [(4, 6)]),
        ([band(0, 6), band(6, 4, skips=True)], [(6, 10)]),
    ],
)
def test_doubt_spreads_as_the_codec_does(bands: list[Band], in_doubt: list[tuple[int, int]]) -> None:
    picture = Picture(80, HEIGHT)
    picture.prove()
    picture.lose(4, 8)
    assembly = Assembly(0)
    for each in bands:
        picture.take(each, assembly)
    picture.finish(assembly)
    expected = np.zeros(HEIGHT, bool)
    for y0, y1 in in_doubt:
        expected[y0:y1] = True
    assert picture.in_doubt.tolist() == expected.tolist()


@pytest.mark.parametrize("rows_apart", [1, 2, 5])
@pytest.mark.parametrize("error", [1, 0x1234, 0x8000, 0xFFFF])
def test_the_digest_sees_an_edge_that_has_moved(rows_apart: int, error: int) -> None:
    """The same error in two lines, at any distance: CRCs of CRCs are blind where it is two pixels for each line."""
    picture = np.random.default_rng(5).integers(0, 65536, (HEIGHT, 40), np.uint16).astype(PIXEL)
    picture[10:20] = picture[10]
    right = digest_of(picture)
    for x in range(40):
        wrong = picture.copy()
        wrong[11, 20] ^= error
        wrong[11 + rows_apart, x] ^= error
        assert digest_of(wrong) != right


def test_stretches_are_few() -> None:
    picture = Picture(80, HEIGHT)
    picture.prove()
    for y in (0, 1, 5, 9, 31):
        picture.lose(y, y + 1)
    assert picture.ask(2) == [(0, 2), (5, 1), (9, 1), (31, 1)]
    assert picture.ask(2) == []
    picture.prove()
    for y in range(0, 10, 2):
        picture.lose(y, y + 1)
    assert picture.ask(2) == [(0, 9)]


def test_a_broken_band_puts_its_lines_in_doubt_and_the_frame_is_no_frame() -> None:
    picture = Picture(80, HEIGHT)
    picture.prove()
    assembly = Assembly(0)
    picture.take(band(0, 4), assembly)
    broken = band(4, 4)
    picture.take(Band(**{**broken.__dict__, "tokens": broken.tokens[:-1]}), assembly)
    with pytest.raises(WireError, match="add up"):
        picture.finish(assembly)
    assert assembly.broken
    assert picture.in_doubt.tolist() == [y < 8 for y in range(HEIGHT)]


@pytest.mark.parametrize("split", [False, True])
@pytest.mark.parametrize("rate", [0.05, 0.3])
@pytest.mark.parametrize("seed", range(3))
def test_what_is_called_proven_is_what_the_device_sent(seed: int, rate: float, split: bool) -> None:
    talk = streaming(stripes, split)
    talk.device.faults = Faults(seed, drop=rate, flip=rate / 4)
    seen = 0
    for _ in range(150):
        for event in talk.step():
            if isinstance(event, Partial):
                truth = talk.device.sent[event.number]
                assert event.proven.any()
                assert np.array_equal(event.picture[event.proven], truth[event.proven])
                seen += 1
    assert seen > 3


def test_partial_pictures_come_ten_times_a_second_at_most() -> None:
    talk = streaming()
    lose(talk, 1, 1 << 30)
    talk.device.faults.drop = 0.3
    times = []
    for _ in range(200):
        times += [talk.now for event in talk.step() if isinstance(event, Partial)]
    assert len(times) > 5
    assert min(later - earlier for earlier, later in pairwise(times)) >= 0.1 - 1e-9


@pytest.mark.parametrize("fault", ["_first_doubtful", "lose"])
def test_a_picture_that_does_not_doubt_enough_is_found(fault: str, monkeypatch: pytest.MonkeyPatch) -> None:
    wrong = {"_first_doubtful": lambda _, band: band.y0 + band.lines, "lose": lambda *_: None}
    monkeypatch.setattr(Picture, fault, wrong[fault])
    with pytest.raises(AssertionError):
        for seed in range(6):
            test_what_is_called_proven_is_what_the_device_sent(seed, 0.3, split=True)


@pytest.mark.parametrize("believes_all", [False, True])
def test_only_the_digest_makes_a_frame_good(believes_all: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Bands can all have arrived and the picture be wrong, because one of an earlier frame had not."""
    talk = streaming(stripes, split=True)
    talk.device.faults = Faults(1, drop=0.1)
    if believes_all:
        end = Stream.end

        def believing(self: Stream, body: FrameEnd, now: float) -> list[Event]:
            monkeypatch.setattr(Picture, "digest", lambda _: body.digest)
            return end(self, body, now)

        monkeypatch.setattr(Stream, "end", believing)
    talk.run(100)
    wrong = [frame for frame in talk.frames if not np.array_equal(frame.picture, talk.device.sent[frame.number])]
    assert bool(wrong) == believes_all
