"""What a session says and when, on a clock that the test moves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from edgeline import framing, protocol
from edgeline.errors import DeviceError, EdgelineError
from edgeline.protocol import Ack, Ping, Start, Stop
from edgeline.session import Connected, Damage, Frame, Log, Refused, Session, Stalled, State
from fake_device import FakeDevice, Faults, bars
from talk import Talk


def said(session: Session) -> list[protocol.Body | None]:
    chunks = framing.Splitter().feed(session.bytes_to_send())
    return [protocol.unpack(chunk) for chunk in chunks if isinstance(chunk, framing.Packet)]


def test_frames_arrive_in_order_pixel_for_pixel() -> None:
    talk = Talk()
    talk.run(50)
    assert [frame.number for frame in talk.frames] == list(range(len(talk.frames)))
    assert len(talk.frames) > 40
    for frame in talk.frames:
        assert np.array_equal(frame.picture, bars()(frame.number))
        assert frame.counters["passes"] == 100
        assert not frame.picture.flags.writeable
    assert talk.session.counts.damaged == 0
    assert talk.session.counts.keys_sent == 0


@pytest.mark.parametrize("runs", [False, True])
@pytest.mark.parametrize("skips", [False, True])
@pytest.mark.parametrize(("width", "height", "band_lines"), [(1, 4, 1), (48, 32, 5), (320, 240, 100), (131, 300, 200)])
def test_every_kind_of_band(width: int, height: int, band_lines: int, runs: bool, skips: bool) -> None:
    scene = bars(width, height)
    talk = Talk(FakeDevice(width, height, scene, band_lines, runs=runs, skips=skips))
    talk.run(6)
    assert len(talk.frames) >= 4
    assert all(np.array_equal(frame.picture, scene(frame.number)) for frame in talk.frames)


def test_ping_until_hello_then_start_then_an_ack_per_frame() -> None:
    session = Session(fps=25)
    pings = 0
    for step in range(100):
        session.tick(step / 10)
        pings += said(session).count(Ping())
    assert pings == 20
    talk = Talk(session=session, now=10.0)
    talk.run(20)
    starts = [body for body in talk.device.commands if isinstance(body, Start)]
    assert starts == [Start(2, 25)]  # what this device offers: raw and runs
    assert [body for body in talk.device.commands if isinstance(body, Ack)] == [Ack(f.number, 1) for f in talk.frames]


def test_without_autostart_nothing_is_started() -> None:
    talk = Talk(session=Session(autostart=False))
    talk.run(100)
    assert [type(event) for event in talk.events] == [Connected]
    assert all(isinstance(body, Ping) for body in talk.device.commands)
    assert talk.session.state is State.READY


def test_stop_is_said_once() -> None:
    talk = Talk()
    talk.run(5)
    talk.session.stop()
    talk.session.stop()
    assert said(talk.session) == [Stop()]


@pytest.mark.parametrize("size", [1, 3, 4096])
def test_the_pieces_do_not_matter(size: int) -> None:
    talk = Talk()
    device, session = talk.device, Session()
    frames = 0
    for step in range(30):
        now = 100 + step / 50
        session.tick(now)
        device.receive(session.bytes_to_send(), now)
        data = device.run(now)
        for i in range(0, len(data), size):
            events = session.receive(data[i : i + size], now)
            frames += sum(isinstance(event, Frame) for event in events)
            assert not [event for event in events if isinstance(event, Damage)]
    assert frames > 20


def test_a_stream_that_starts_in_the_middle() -> None:
    talk = Talk()
    talk.run(10)
    late = Talk(talk.device, now=talk.now)
    left_over = talk.device.run(talk.now)
    late.session.receive(left_over[len(left_over) // 3 :], late.now)
    late.run(20)
    assert len(late.frames) > 10
    assert all(np.array_equal(frame.picture, bars()(frame.number)) for frame in late.frames)


def test_a_gap_in_seq_is_told_and_repaired() -> None:
    talk = Talk()
    talk.run(5)
    talk.device.faults = Faults(drop=1.0, last=1)
    events = talk.run(10)
    assert len([event for event in events if isinstance(event, Damage)]) >= 1
    assert np.array_equal(talk.frames[-1].picture, bars()(talk.frames[-1].number))
    assert len(talk.frames) >= 11


def test_a_wrong_digest_is_no_frame() -> None:
    talk = Talk()
    talk.run(5)
    seen = len(talk.frames)
    send = talk.device.send

    def lie(body: protocol.Body) -> None:
        send(replace(body, digest=body.digest ^ 1) if isinstance(body, protocol.FrameEnd) else body)

    talk.device.send = lie  # type: ignore[method-assign]
    events = talk.run(10)
    assert len(talk.frames) == seen
    assert any(isinstance(event, Damage) and "digest" in event.reason for event in events)
    talk.device.send = send  # type: ignore[method-assign]
    talk.run(10)
    assert len(talk.frames) > seen


def test_a_frame_without_all_its_bands_is_no_frame_even_if_the_picture_is_right() -> None:
    still = bars()(0)
    device = FakeDevice(scene=lambda _: still, skips=False)
    talk = Talk(device)
    talk.run(5)
    device.faults = Faults(drop=1.0, first=1, last=2)
    lost = device._frame
    talk.run(10)
    assert lost not in [frame.number for frame in talk.frames]
    assert lost + 1 in [frame.number for frame in talk.frames]


def test_lost_frame_ends_do_not_use_up_the_credits() -> None:
    talk = Talk()
    send = talk.device.send

    def forget(body: protocol.Body) -> None:
        lost = isinstance(body, protocol.FrameEnd) and body.frame % 4 == 3
        talk.device.faults = Faults(drop=float(lost))
        send(body)

    talk.device.send = forget  # type: ignore[method-assign]
    talk.run(60)
    assert not [event for event in talk.events if isinstance(event, Stalled)]
    assert len(talk.frames) > 15


def test_all_credits_lost_begins_anew_after_silence() -> None:
    talk = Talk()
    talk.run(5)
    talk.device.faults = Faults(drop=1.0)
    talk.run(200)
    assert any(isinstance(event, Stalled) for event in talk.events)
    talk.device.faults = Faults()
    talk.run(100)
    assert isinstance(talk.events[-1], Frame)


def test_silence_is_waited_for_longer_each_time() -> None:
    talk = Talk()
    talk.run(60)
    talk.device.limit = 0
    talk.run(4000)
    gaps = [round(event.seconds, 1) for event in talk.events if isinstance(event, Stalled)]
    assert gaps[:6] == [0.5, 1.0, 2.0, 4.0, 8.0, 16.0]
    assert set(gaps[6:]) == {16.0}
    talk.device.limit = None
    while not any(isinstance(event, Frame) for event in talk.step()):
        pass
    talk.run(60)
    talk.device.limit = 0
    stalls = [event.seconds for event in talk.run(100) if isinstance(event, Stalled)]
    assert stalls[0] < 1, "what was in vain is forgotten when frames come"


def test_a_device_that_was_not_met_long_enough_to_know_its_pauses_has_two_seconds() -> None:
    talk = Talk(FakeDevice(limit=1))
    talk.run(1000)
    first = next(event for event in talk.events if isinstance(event, Stalled))
    assert first.seconds == pytest.approx(2.02)


def test_a_device_that_sends_now_and_then_is_given_its_time() -> None:
    talk = Talk()
    run = talk.device.run_at_rates
    talk.device.run_at_rates = lambda now: run(now) if int(now * 50) % 20 == 0 else []  # type: ignore[method-assign]
    talk.run(2000)  # a frame every 0.4 s
    assert not [event for event in talk.events if isinstance(event, Stalled)]
    assert len(talk.frames) > 90


def test_a_restarted_device_is_met_again() -> None:
    talk = Talk()
    talk.run(5)
    talk.device.reboot(99, talk.now)
    talk.device.text(b"Boot loader 1.0\r\n\0")
    events = talk.run(30)
    assert Log("Boot loader 1.0") in events
    restarts = [event for event in events if isinstance(event, Connected)]
    assert [event.restarted for event in restarts] == [True]
    assert restarts[0].hello.boot_id == 99
    assert len([event for event in events if isinstance(event, Frame)]) > 20
    assert not [event for event in events if isinstance(event, Damage)]


def test_a_device_that_restarts_with_another_size() -> None:
    talk = Talk()
    talk.run(5)
    talk.device.width, talk.device.height, talk.device.scene = 20, 10, bars(20, 10)
    talk.device.reboot(5, talk.now)
    talk.run(20)
    assert talk.frames[-1].picture.shape == (10, 20)


def test_a_same_device_with_another_size_is_met_anew() -> None:
    talk = Talk(FakeDevice(limit=3))
    talk.run(5)
    talk.device.width, talk.device.height = 10, 8
    talk.device._hello()
    talk.run(1)
    assert talk.device.commands[-1] == Start(2)
    assert talk.session.hello is not None
    assert talk.session.hello.width == 10


def test_another_major_version_is_said_once_and_ends_it() -> None:
    talk = Talk(FakeDevice(major=2))
    events = talk.run(200)
    assert [type(event) for event in events] == [Refused]
    assert str(events[0].error) == (  # type: ignore[union-attr]
        "the device speaks version 2.3 of the wire, this host 1.2: update the host"
    )
    assert talk.device.commands == [Ping(1, 2)]


def test_a_host_that_did_not_listen_does_not_call_it_silence() -> None:
    """A debugger, a slow disk: what came meanwhile is read first, and the device answers at once."""
    talk = Talk()
    talk.run(5)
    for pause in (1.5, 5.0, 60.0):
        frames = len(talk.frames)
        talk.step(pause)
        talk.run(10)
        assert len(talk.frames) > frames + 5
    assert not [event for event in talk.events if isinstance(event, Stalled | Damage)]


def test_a_frame_from_before_start_is_neither_damage_nor_an_answer() -> None:
    """The device was streaming to the host before this one, and was not through with it when START was sent."""
    talk = Talk()
    talk.run(5)
    late = Talk(talk.device, now=talk.now)
    late.session.tick(late.now)
    late.device.receive(late.session.bytes_to_send(), late.now)
    late.device.credits = 2
    wire = late.device.run(late.now)  # HELLO, and a frame with what has changed
    late.device.commands.clear()
    late.session.receive(wire, late.now)
    late.run(10)
    assert not [event for event in late.events if isinstance(event, Damage)]
    assert late.device.commands[0] == Start(2)
    assert not [body for body in late.device.commands if isinstance(body, protocol.Key)]
    acks = [body.frame for body in late.device.commands if isinstance(body, Ack)]
    assert acks == [frame.number for frame in late.frames]


def test_one_way_nothing_is_said_and_silence_means_nothing() -> None:
    talk = Talk(session=Session(one_way=True))
    talk.device.streaming, talk.device.credits = True, 200
    talk.device._hello()
    talk.run(20)
    talk.device.limit = 0
    talk.run(500)
    talk.device._hello()
    talk.device.limit = None
    talk.device.streaming, talk.device.credits = True, 200
    talk.run(20)
    assert talk.device.commands == []
    assert talk.session.counts.bytes_sent == 0
    assert len(talk.frames) == 40
    assert [type(event) for event in talk.events] == [Connected] + [Frame] * 40
    with pytest.raises(DeviceError, match="one-way"):
        talk.session.input(1, 1)


@pytest.mark.parametrize(("fps", "fast"), [(-1, None), (65536, None), (0, -1), (0, 2**32)])
def test_numbers_that_do_not_fit_the_wire_are_refused(fps: int, fast: int | None) -> None:
    with pytest.raises(EdgelineError, match=r"frames per second|no rate"):
        Session(fps=fps, fast=fast)


def test_logs_and_unknown_types_pass_and_count() -> None:
    talk = Talk()
    talk.run(3)
    talk.device.send(protocol.Log("temperature 41"))
    events = talk.run(1)
    assert Log("temperature 41") in events
    packet = framing.Packet(0x70, talk.device._seq, b"later")
    talk.device._seq = talk.device._seq + 1 & 0xFF
    talk.device.text(framing.encode(packet))
    assert not [event for event in talk.run(5) if isinstance(event, Damage)]


def test_what_a_device_says_is_cut_where_it_is_endless() -> None:
    talk = Talk()
    talk.run(3)
    talk.device.send(protocol.Log("ab" * 20_000))
    talk.device.text(b"cd" * 20_000 + b"\0")
    assert [event.text for event in talk.run(1) if isinstance(event, Log)] == ["ab" * 2048, "cd" * 2048]


@pytest.mark.parametrize("order", [[(8, 8), (0, 8)], [(0, 8), (7, 8)], [(30, 3)], [(2040, 255)]])
def test_bands_out_of_order_or_out_of_the_picture_are_damage(order: list[tuple[int, int]]) -> None:
    talk = Talk(FakeDevice(limit=0))
    talk.run(3)
    truth = bars()(0)
    for y0, lines in order:
        pixels = np.resize(truth, (lines, 48))
        talk.device.send(protocol.Band(0, y0, lines, protocol.Codec.RAW, b"", pixels.tobytes()))
    events = talk.run(1)
    assert [type(event) for event in events] == [Damage]
    assert "out of place" in events[0].reason  # type: ignore[union-attr]
