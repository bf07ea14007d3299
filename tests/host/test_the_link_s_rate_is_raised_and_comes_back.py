"""SET_BAUD, on a clock that the test moves: the rate is raised, proven, and brought back whatever goes wrong."""

from __future__ import annotations

import time

import pytest

import edgeline as package
from edgeline import protocol
from edgeline.errors import DeviceError
from edgeline.protocol import Baud, Ping, SetBaud, Start, Stop
from edgeline.rate import Rate
from edgeline.session import Event, Frame, RateChanged, Session, SetRate, State
from fake_device import FakeDevice, Faults, PtyDevice
from talk import Talk

FIRST, HIGH = 115_200, 921_600


def met(fast: int | None = None, steps: int = 5, **device: object) -> Talk:
    """A host at 115,200 baud and a device that can do 921,600."""
    device = {"max_baud": HIGH, **device}
    talk = Talk(FakeDevice(**device), Session(baud=FIRST, fast=fast), rate=FIRST)  # type: ignore[arg-type]
    talk.run(steps)
    return talk


def rates(events: list[Event]) -> list[tuple[int, str]]:
    return [(event.rate, event.why) for event in events if isinstance(event, RateChanged)]


def kinds(talk: Talk, *ignored: type) -> list[str]:
    return [type(body).__name__ for body in talk.device.commands if not isinstance(body, ignored)]


def seconds_until(talk: Talk, condition: object, most: float = 20.0) -> float:
    began = talk.now
    while not condition():  # type: ignore[operator]
        assert talk.now - began < most, "it never came"
        talk.step(0.005)
    return talk.now - began


def test_the_rate_is_raised_before_the_stream_begins() -> None:
    talk = met(fast=0, steps=20)
    assert kinds(talk, protocol.Ack) == ["Ping", "SetBaud", "Ping", "Ping", "Start"]
    assert (talk.device.rate, talk.rate, talk.session.rate) == (HIGH, HIGH, HIGH)
    assert rates(talk.events) == [(HIGH, "921600 baud")]
    assert talk.frames
    assert talk.session.counts.damaged == 0


def test_ten_milliseconds_pass_between_baud_and_ping() -> None:
    session = Session(baud=FIRST, fast=HIGH)
    device = FakeDevice(max_baud=HIGH)
    session.tick(0.0)
    device.receive(session.bytes_to_send(), 0.0)
    session.receive(device.run(0.0), 0.0)
    device.receive(session.bytes_to_send(), 0.0)
    (event,) = (event for event in session.receive(device.run(0.0), 0.0) if isinstance(event, SetRate))
    assert (event.rate, event.asked) == (HIGH, HIGH)
    said = []
    for ms in range(1, 1000):
        session.tick(ms / 1000)
        said += [ms] if session.bytes_to_send() else []
    assert said == [10, 260, 510, 760]


def test_a_running_stream_is_stopped_for_it_and_goes_on() -> None:
    talk = met()
    frames = len(talk.frames)
    talk.session.request_baud(0)
    assert talk.session.retuning
    talk.device.commands.clear()
    talk.run(20)
    assert kinds(talk, protocol.Ack)[:2] == ["Stop", "SetBaud"]
    assert talk.device.commands[1] == SetBaud(HIGH)
    assert kinds(talk, protocol.Ack)[-1] == "Start"
    assert (talk.device.rate, talk.session.retuning) == (HIGH, False)
    assert len(talk.frames) > frames + 10
    talk.session.request_baud(460_800)
    talk.run(20)
    assert talk.device.rate == talk.rate == 460_800
    assert talk.session.counts.damaged == 0


@pytest.mark.parametrize("asked", [2_000_000, 0])
def test_a_rate_that_the_device_cannot_do_changes_nothing(asked: int) -> None:
    talk = met(fast=asked, steps=20, max_baud=HIGH if asked else FIRST)
    assert talk.device.rate == talk.rate == FIRST
    expected = [(FIRST, "115200 baud: the device cannot do 2000000")] if asked else []
    assert rates(talk.events) == expected
    assert len(talk.frames) > 5


def test_a_device_without_set_baud_is_said_and_streams() -> None:
    talk = met(fast=HIGH, max_baud=0)
    assert rates(talk.events) == [(FIRST, "fake board, edgeline 0.1.0: its link's rate cannot be changed")]
    assert talk.frames
    with pytest.raises(DeviceError, match="cannot be changed"):
        talk.session.request_baud(HIGH)


def test_the_rate_that_the_divider_gives_is_taken() -> None:
    talk = met()
    send = talk.device.send

    def divided(body: protocol.Body) -> None:
        send(Baud(923_076) if isinstance(body, Baud) else body)
        if isinstance(body, Baud):
            talk.device._switch(923_076, talk.now)

    talk.device.send = divided  # type: ignore[method-assign]
    switch = talk.device._switch
    talk.device._switch = lambda rate, now: None if rate == HIGH else switch(rate, now)  # type: ignore[method-assign]
    talk.session.request_baud(HIGH)
    talk.run(20)
    assert talk.rate == talk.device.rate == 923_076
    assert rates(talk.events) == [(923_076, "923076 baud")]
    assert talk.session.state is State.STREAMING
    assert not talk.session.retuning


@pytest.mark.parametrize("offered", [0, 1, 115_201, 898_000, 945_000, 2**32 - 1])
def test_an_answer_that_is_far_off_is_not_followed(offered: int) -> None:
    rate = Rate(FIRST, HIGH)
    rate.begin(HIGH, 0.0)
    (event,) = rate.answer(offered, 0.0)
    assert event == RateChanged(FIRST, f"{FIRST} baud: the device cannot do {HIGH}")


@pytest.mark.parametrize("lost", [1, 2])
def test_lost_packets_are_said_again(lost: int) -> None:
    """SET_BAUD, or its answer: after which the device is at the new rate, and back after 1 s."""
    talk = met()
    talk.device.faults = Faults(drop=1.0, last=lost)
    talk.session.request_baud(HIGH)
    talk.run(1)
    talk.device.faults = Faults()
    assert (
        seconds_until(talk, lambda: talk.device.rate == talk.rate == HIGH and talk.session.state is State.STREAMING) < 4
    )
    talk.run(20)
    assert isinstance(talk.events[-1], Frame)


def test_a_device_that_never_answers_is_left_at_its_rate() -> None:
    talk = met()
    obey = talk.device._obey
    talk.device._obey = lambda body, now: None if isinstance(body, SetBaud) else obey(body, now)  # type: ignore[method-assign]
    talk.session.request_baud(HIGH)
    assert seconds_until(talk, lambda: talk.session.state is State.STREAMING) < 3
    asked = [body for body in talk.device.commands if isinstance(body, SetBaud)]
    assert asked == [SetBaud(HIGH)] * 5
    assert rates(talk.events) == [(FIRST, "115200 baud: the device does not answer SET_BAUD")]
    assert not talk.session.retuning
    talk.run(10)
    assert isinstance(talk.events[-1], Frame)


def deafen(talk: Talk) -> None:
    """From now on the link garbles everything at any but the first rate."""
    receive, run = talk.device.receive, talk.device.run_at_rates

    def hear(data: bytes, now: float, rate: int | None = None) -> None:
        receive(data, now, 1 if talk.device.rate != FIRST else rate)

    talk.device.receive = hear  # type: ignore[method-assign]
    talk.device.run_at_rates = lambda now: [(rate if rate == FIRST else 1, data) for rate, data in run(now)]  # type: ignore[method-assign]


def test_a_rate_that_the_link_does_not_carry_is_given_up_on_both_sides() -> None:
    talk = met()
    deafen(talk)
    talk.session.request_baud(HIGH)
    began = talk.now
    seconds_until(talk, lambda: rates(talk.events))
    assert 1.5 <= talk.now - began < 1.6
    assert rates(talk.events) == [(FIRST, "back at 115200 baud: no HELLO at 921600 baud")]
    assert talk.session.counts.damaged == 0, "what is read at the wrong rate is no damage"
    seconds_until(talk, lambda: not talk.session.retuning and talk.session.state is State.STREAMING)
    assert talk.device.rate == talk.rate == FIRST
    frames = len(talk.frames)
    talk.run(600)
    assert len(talk.frames) > frames + 500
    assert len(rates(talk.events)) == 2, "it is tried twice and then left"


def test_a_link_that_goes_silent_at_a_raised_rate_comes_back_after_four_seconds() -> None:
    talk = met(fast=HIGH, steps=30)
    deafen(talk)
    began = talk.now
    seconds_until(talk, lambda: talk.rate == FIRST)
    assert 4.0 <= talk.now - began < 4.1
    assert rates(talk.events)[-1] == (FIRST, "back at 115200 baud: nothing for 4 s at 921600 baud")
    seconds_until(talk, lambda: talk.device.rate == FIRST and talk.session.state is State.STREAMING)
    talk.run(400)
    assert isinstance(talk.events[-1], Frame)


def test_a_device_that_was_started_anew_is_at_the_first_rate_and_raised_again() -> None:
    talk = met(fast=HIGH, steps=30)
    talk.device.reboot(77, talk.now)
    assert talk.device.rate == FIRST
    seconds_until(talk, lambda: talk.device.rate == talk.rate == HIGH and talk.session.state is State.STREAMING)
    talk.run(20)
    assert isinstance(talk.events[-1], Frame)
    assert talk.session.hello is not None
    assert talk.session.hello.boot_id == 77


def test_a_raised_rate_that_loses_more_than_a_quarter_of_the_frames_is_left_for_good() -> None:
    talk = met(fast=HIGH, steps=30)
    talk.device.faults = Faults(2, flip=0.12)
    began = talk.now
    seconds_until(talk, lambda: talk.device.rate == FIRST)
    assert 4.0 < talk.now - began < 10.0
    talk.device.faults = Faults()
    talk.run(300)
    (_, last) = rates(talk.events)[-1]
    assert last.startswith("back at 115200 baud: ")
    assert last.endswith(" % of the frames failed")
    assert int(last.split()[4]) > 25
    assert talk.device.rate == talk.rate == FIRST
    assert isinstance(talk.events[-1], Frame)


def test_a_raised_rate_that_loses_a_few_frames_is_kept() -> None:
    talk = met(fast=HIGH, steps=30)
    talk.device.faults = Faults(2, flip=0.02)
    talk.run(1500)
    assert talk.session.counts.failed > 10
    assert talk.device.rate == talk.rate == HIGH


def test_a_host_that_leaves_leaves_the_link_at_its_first_rate() -> None:
    talk = met(fast=HIGH, steps=30)
    talk.session.close()
    talk.device.commands.clear()
    talk.device.receive(talk.session.bytes_to_send(), talk.now, HIGH)
    assert talk.device.commands == [Stop(), SetBaud(FIRST)]
    assert talk.device.rate == FIRST


def test_a_host_that_vanished_is_followed_by_one_at_the_first_rate() -> None:
    talk = met(fast=HIGH, steps=30)
    late = Talk(talk.device, Session(baud=FIRST), talk.now, rate=FIRST)
    assert seconds_until(late, lambda: late.session.hello is not None) < 3.6
    assert isinstance(late.run(20)[-1], Frame)


def test_a_port_that_refuses_the_rate_is_given_a_common_one() -> None:
    talk = met(max_baud=2_000_000)
    talk.session.request_baud(0)
    while not any(isinstance(event, SetRate) for event in talk.step(0.005)):
        pass
    talk.rate = FIRST
    talk.events += talk.session.refuse_rate(talk.now)
    seconds_until(talk, lambda: talk.rate == talk.device.rate == HIGH and talk.session.state is State.STREAMING)
    assert rates(talk.events) == [
        (FIRST, "back at 115200 baud: this computer's port cannot do 2000000"),
        (HIGH, "921600 baud"),
    ]


def test_commands_at_raised_rates_are_still_taken_in_order() -> None:
    talk = met(fast=HIGH, steps=1)
    for value in range(10):
        talk.session.input(200, value)
    talk.run(60)
    assert talk.device.taken == [(200, value) for value in range(10)]
    starts = [i for i, body in enumerate(talk.device.commands) if isinstance(body, Start)]
    assert len(starts) == 1
    assert not [body for body in talk.device.commands[starts[0] + 1 :] if isinstance(body, Ping)]


def test_over_a_port() -> None:
    device = FakeDevice(max_baud=HIGH)
    with PtyDevice(device) as served:
        with package.open(served.port, FIRST) as link:
            assert link.next_frame(10).number == 0
            assert link.request_baud() == HIGH
            assert link.rate_words == "921600 baud"
            assert link.transport.baud == device.rate == HIGH
            link.next_frame(10)
        deadline = time.monotonic() + 5
        while device.rate != FIRST and time.monotonic() < deadline:
            time.sleep(0.01)
        assert device.rate == FIRST
        with package.open(served.port, FIRST, fast=0) as link:
            link.next_frame(10)
            assert link.session.rate == link.transport.baud == HIGH


def test_over_a_port_that_refuses(monkeypatch: pytest.MonkeyPatch) -> None:
    device = FakeDevice(max_baud=2_000_000)
    with PtyDevice(device) as served, package.open(served.port, FIRST) as link:
        set_baud = link.transport.set_baud
        monkeypatch.setattr(link.transport, "set_baud", lambda rate: rate < 1_000_000 and set_baud(rate))
        assert link.request_baud() == HIGH
        assert device.rate == link.transport.baud == HIGH
        assert link.rate_words == "921600 baud"
