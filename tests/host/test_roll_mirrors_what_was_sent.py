"""Mode ROLL: the picture is built up of what fits, and each proven one is what the device sent last of every line."""

from __future__ import annotations

import numpy as np
import pytest

import edgeline as package
from edgeline import protocol
from edgeline.codec import Pixels
from edgeline.errors import EdgelineError
from edgeline.protocol import Ack, Key, Mode, Start
from edgeline.session import Damage, Frame, Partial, Refused, Session
from fake_device import FakeDevice, Faults, PtyDevice, bars
from talk import Talk


def slowly(frame: int) -> Pixels:
    """Stands still for a while, so that it can be caught up with."""
    return bars(80, 32)(frame // 15)


def rolling(faults: Faults | None = None, room: int = 700, split: bool = False) -> Talk:
    device = FakeDevice(80, 32, slowly, rolls=True, room=room, split=split, faults=faults or Faults())
    return Talk(device, Session(mode=Mode.ROLL))


def check(talk: Talk) -> None:
    for frame in talk.frames:
        assert np.array_equal(frame.picture, talk.device.sent[frame.number]), f"frame {frame.number}"
        assert frame.mixed == (not np.array_equal(frame.picture, slowly(frame.number)))


@pytest.mark.parametrize("split", [False, True])
def test_frames_are_mirrors_and_say_when_they_are_mixed(split: bool) -> None:
    talk = rolling(split=split)
    talk.run(100)
    check(talk)
    assert any(frame.mixed for frame in talk.frames)
    assert not all(frame.mixed for frame in talk.frames)
    assert len(talk.frames) > 80
    start = next(body for body in talk.device.commands if isinstance(body, Start))
    assert (start.mode, start.credits) == (1, 2)
    assert not [event for event in talk.events if isinstance(event, Damage)]
    assert not [body for body in talk.device.commands if isinstance(body, Key)]


def test_the_picture_is_built_up_without_a_word_of_damage() -> None:
    talk = rolling(room=250)
    events = talk.run(40)
    first = next(i for i, event in enumerate(events) if isinstance(event, Frame))
    partial = [event for event in events[:first] if isinstance(event, Partial)]
    assert partial
    assert [int(event.proven.sum()) for event in partial] == sorted(int(event.proven.sum()) for event in partial)
    for event in partial:
        sent = talk.device.sent[event.number]
        assert np.array_equal(event.picture[event.proven], sent[event.proven])
    assert talk.session.counts.damaged == talk.session.counts.failed == 0
    acks = [body.frame for body in talk.device.commands if isinstance(body, Ack)]
    assert acks == sorted(talk.device.sent)[: len(acks)]


def test_frames_without_an_end_take_no_credit() -> None:
    talk = rolling(room=100)  # no line fits
    talk.run(50)
    assert talk.device.credits == 2
    talk.device.room = 700
    talk.run(30)
    check(talk)
    assert talk.device.credits == 2
    acks = [body.frame for body in talk.device.commands if isinstance(body, Ack)]
    assert acks == sorted(talk.device.sent)
    assert acks[0] > 40


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("split", [False, True])
def test_damage_is_never_shown_and_does_not_live_on(seed: int, split: bool) -> None:
    talk = rolling(Faults(seed, flip=0.02, drop=0.02, swap=0.01, duplicate=0.01, noise=0.01), split=split)
    talk.run(300)
    check(talk)
    assert talk.session.counts.failed > 0
    talk.device.faults = Faults()
    seen = len(talk.frames)
    talk.run(150)
    check(talk)
    assert len(talk.frames) > seen + 100
    assert talk.device.credits <= 2 + talk.device.late_credits


def test_a_device_that_does_not_know_roll_is_named() -> None:
    talk = Talk(session=Session(mode=Mode.ROLL))
    refusals = [event for event in talk.run(10) if isinstance(event, Refused)]
    assert str(refusals[0].error) == "fake board, edgeline 0.1.0: does not know the mode roll: use block"
    assert not [body for body in talk.device.commands if isinstance(body, protocol.Start)]


def test_settled_frames_are_whole_ones() -> None:
    device = FakeDevice(80, 32, slowly, rolls=True, room=700)
    with PtyDevice(device) as served, package.open(served.port, mode="roll") as link:
        link.control("scene", 2)
        for _ in range(3):
            frame = link.next_frame(20, settled=True)
            assert frame.shows_inputs
            assert not frame.mixed
            assert np.array_equal(frame.picture, slowly(frame.number))
    with pytest.raises(EdgelineError, match="no mode 'rock': there are block and roll"):
        package.open(served.port, mode="rock")
