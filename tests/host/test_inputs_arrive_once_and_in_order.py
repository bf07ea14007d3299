"""INPUT over a link that loses packets, both ways: each arrives, once, in order; frames say which of them they show."""

from __future__ import annotations

import random

import pytest

from edgeline import framing, protocol
from edgeline.errors import EdgelineError
from edgeline.inputs import MOST_WAITING, WINDOW, Inputs
from edgeline.protocol import Capability, Control, Hello, Input, Start
from edgeline.session import Frame, Session
from fake_device import FakeDevice, Faults, bars
from talk import Talk


def hello(number: int = 0, minor: int = 2) -> Hello:
    return Hello(8, 8, Capability.RAW | Capability.INPUT, 1, "", "", minor=minor, input=number, controls=0xFFFFFFFF)


def greeted(number: int = 0, minor: int = 2) -> Inputs:
    inputs = Inputs()
    inputs.greet(hello(number, minor), anew=False)
    return inputs


def numbers(bodies: list[Input]) -> list[int | None]:
    return [body.number for body in bodies]


def test_four_are_on_their_way_at_most_and_each_confirmation_lets_more_go() -> None:
    inputs = greeted()
    for value in range(9):
        inputs.ask(200, value)
    assert numbers(inputs.due(0.0, 2)) == [1, 2, 3, 4]
    assert inputs.due(0.1, 2) == []
    inputs.frame_ended(1, 3)
    assert inputs.due(0.1, 2) == [Input(200, 4, 5), Input(200, 5, 6), Input(200, 6, 7)]
    assert inputs.waiting == 6
    inputs.frame_ended(2, 7)
    assert numbers(inputs.due(0.1, 2)) == [8, 9]
    inputs.frame_ended(2, 9)
    assert (inputs.waiting, inputs.due(99.0, 9)) == (0, [])
    assert inputs.resent == 0


@pytest.mark.parametrize("number", [0, 253, 254, 255])
def test_numbers_go_on_from_the_hello_s_and_wrap(number: int) -> None:
    inputs = greeted(number)
    for value in range(4):
        inputs.ask(200, value)
    assert numbers(inputs.due(0.0, 2)) == [number + 1 + i & 0xFF for i in range(4)]
    inputs.frame_ended(1, number + 3 & 0xFF)
    assert inputs.waiting == 1


def test_what_is_not_confirmed_is_sent_again_after_half_a_second_then_less_often() -> None:
    inputs = greeted()
    inputs.ask(200, 1)
    inputs.ask(200, 2)
    assert numbers(inputs.due(10.0, 2)) == [1, 2]
    again = [now / 100 for now in range(1000, 3000) if inputs.due(now / 100, 2)]
    assert again == [10.5, 11.5, 13.5, 17.5, 21.5, 25.5, 29.5]
    inputs.frame_ended(1, 1)
    assert inputs.due(30.0, 2) == []
    assert numbers(inputs.due(30.5, 2)) == [2]


def test_a_frame_that_began_after_an_input_and_lacks_it_has_it_sent_again_at_once() -> None:
    inputs = greeted()
    inputs.ask(200, 1)
    assert numbers(inputs.due(0.0, 2)) == [1]  # two credits given: frames 1 and 2 may have begun before
    assert not inputs.frame_ended(1, 0)
    assert inputs.due(0.0, 3) == []
    assert not inputs.frame_ended(2, 0)
    assert inputs.due(0.0, 4) == []
    assert not inputs.frame_ended(3, 0)
    assert numbers(inputs.due(0.0, 5)) == [1]
    assert not inputs.frame_ended(4, 0)
    assert inputs.due(0.0, 6) == []  # frame 6 is the first that began after the second time
    assert inputs.frame_ended(5, 1)


def test_a_hello_that_was_asked_for_after_an_input_and_lacks_it_has_it_sent_again() -> None:
    inputs = greeted()
    inputs.ask(200, 1)
    inputs.due(5.0, 2)
    inputs.greet(hello(0), anew=False, asked=4.9)
    assert inputs.due(5.1, 2) == []
    inputs.greet(hello(0), anew=False, asked=5.1)
    assert numbers(inputs.due(5.2, 2)) == [1]
    inputs.greet(hello(1), anew=False, asked=5.3)
    assert inputs.waiting == 0


def test_a_frame_that_began_before_a_hello_was_told_takes_nothing_back() -> None:
    inputs = greeted(250)
    for value in range(8):
        inputs.ask(200, value)
    inputs.due(0.0, 2)
    inputs.greet(hello(253), anew=False)
    assert numbers(inputs.due(0.0, 2)) == [255, 0, 1]
    assert not inputs.frame_ended(1, 251)
    assert not inputs.frame_ended(2, 250)
    assert inputs.due(0.0, 2) == []
    assert not inputs.frame_ended(2, 255)
    assert numbers(inputs.due(0.0, 2)) == [2]


def test_where_somebody_else_sent_inputs_the_numbers_go_on_from_his() -> None:
    inputs = greeted(10)
    inputs.ask(200, 1)
    inputs.ask(200, 2)
    assert numbers(inputs.due(0.0, 2)) == [11, 12]
    assert not inputs.frame_ended(1, 40)
    assert inputs.due(0.0, 2) == [Input(200, 1, 41), Input(200, 2, 42)]
    assert inputs.frame_ended(2, 42)


def test_of_the_values_that_wait_only_the_newest_of_a_camera_or_a_view_is_told() -> None:
    inputs = greeted()
    for value in range(WINDOW):
        inputs.ask(200, value)
    inputs.due(0.0, 2)
    for value in range(100):
        inputs.ask(Control.YAW, value)
        inputs.ask(Control.VIEW, value % 6)
    for value in range(3):
        inputs.ask(Control.STEP, value)
        inputs.ask(Control.SCENE, value)
        inputs.ask(200, value)
    told = []
    for number in range(1, 40):
        inputs.frame_ended(1, number)
        told += [(body.control, body.value) for body in inputs.due(0.0, 2)]
    rest = [(control, value) for value in range(3) for control in (4, 1, 200)]
    assert told == [(5, 99), (13, 3), *rest]


def test_too_many_are_refused() -> None:
    inputs = Inputs()
    for value in range(MOST_WAITING):
        inputs.ask(200, value)
    with pytest.raises(EdgelineError, match="slower, please"):
        inputs.ask(200, 0)


def test_a_device_of_1_1_gets_each_once_without_a_number() -> None:
    talk = Talk(FakeDevice(minor=1))
    talk.session.input(Control.PAUSE, 1)
    talk.run(5)
    talk.session.input(Control.SCENE, 2)
    shows = [event.shows_inputs for event in talk.run(4) if isinstance(event, Frame)]
    told = [body for body in talk.device.commands if isinstance(body, Input | Start)]
    assert told == [Input(3, 1), Start(2), Input(1, 2)]
    assert shows == [False, False, True, True]  # two credits had been given when it was sent
    with pytest.raises(EdgelineError, match="has no control VIEW"):
        talk.session.input(Control.VIEW, 1)


def test_the_first_frame_that_shows_an_input_says_so() -> None:
    talk = Talk()
    talk.run(10)
    session, device, now = talk.session, talk.device, talk.now
    early = device.run(now)  # a frame begins before the INPUT is given
    session.input(Control.SCENE, 3)
    (frame,) = (event for event in session.receive(early, now) if isinstance(event, Frame))
    assert not frame.shows_inputs
    device.receive(session.bytes_to_send(), now)
    (frame,) = (event for event in session.receive(device.run(now), now) if isinstance(event, Frame))
    assert frame.shows_inputs
    assert session.inputs_waiting == 0


def over_a_bad_link(seed: int, loss: float, session: Session | None = None) -> tuple[list[tuple[int, int]], Talk]:
    """Asks for 300 controls at random times while packets are lost both ways; what was asked for, and the talk."""
    rng = random.Random(seed)
    talk = Talk(FakeDevice(scene=bars(48, 8), height=8, faults=Faults(seed, drop=loss, flip=loss)))
    talk.session = session or talk.session
    upward = Faults(seed + 1, drop=loss, flip=loss, duplicate=loss, swap=loss)
    receive = talk.device.receive

    def lossy(data: bytes, now: float, rate: int | None) -> None:
        for chunk in data.split(b"\0")[:-1]:
            receive(upward.apply(chunk + b"\0"), now, rate)

    talk.device.receive = lossy  # type: ignore[method-assign]
    asked: list[tuple[int, int]] = []
    while len(asked) < 300:
        for _ in range(rng.choice((0, 0, 1, 2, 5))):
            asked.append((rng.choice((Control.FRAME, Control.STEP, 130)), 1 + len(asked)))
            talk.session.input(*asked[-1])
        for event in talk.step():
            if isinstance(event, Frame) and event.shows_inputs:
                assert talk.device.taken == asked[: len(talk.device.taken)]
                assert len(talk.device.taken) == len(asked)
    for _ in range(4000):
        talk.step()
        if not talk.session.inputs_waiting:
            break
    return asked, talk


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("loss", [0.02, 0.1])
def test_none_is_lost_doubled_or_out_of_order(seed: int, loss: float) -> None:
    asked, talk = over_a_bad_link(seed, loss)
    assert talk.device.taken == asked
    assert talk.session.counts.inputs_resent > 0


def test_a_host_that_does_not_repeat_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Inputs, "_again", lambda *_: [])
    asked, talk = over_a_bad_link(1, 0.1)
    assert talk.device.taken != asked


def test_a_host_that_does_not_number_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(protocol.Input, "encode", lambda body: body._LAYOUT.pack(body.control, body.value))
    asked, talk = over_a_bad_link(1, 0.1)
    assert talk.device.taken != asked


def test_nothing_is_sent_to_a_device_that_was_not_met() -> None:
    session = Session()
    session.input(Control.SCENE, 1)
    for step in range(100):
        session.tick(step / 10)
    chunks = framing.Splitter().feed(session.bytes_to_send())
    kinds = {chunk.type for chunk in chunks if isinstance(chunk, framing.Packet)}
    assert kinds == {protocol.PacketType.PING}
