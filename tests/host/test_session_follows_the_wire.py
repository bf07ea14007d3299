"""What a session says and when, on a clock that the test moves."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from edgeline import framing, protocol
from edgeline.protocol import Ack, Key, Ping, Start, Stop
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


def test_a_gap_in_seq_asks_for_all_lines_once() -> None:
    talk = Talk()
    talk.run(5)
    talk.device.faults = Faults(drop=1.0, last=1)
    events = talk.run(10)
    assert len([event for event in events if isinstance(event, Damage)]) >= 1
    assert [body for body in talk.device.commands if isinstance(body, Key)] == [Key(0, 32)]
    assert np.array_equal(talk.frames[-1].picture, bars()(talk.frames[-1].number))
    assert len(talk.frames) >= 11


def test_a_lost_log_is_told_and_repaired_at_once() -> None:
    """No band is missing, but the host cannot know that: a gap alone is reason enough."""
    talk = Talk(FakeDevice(limit=0))
    talk.run(3)
    talk.device.faults = Faults(drop=1.0, last=1)
    talk.device.send(protocol.Log("lost"))
    talk.device.send(protocol.Log("found"))
    assert [type(event) for event in talk.step()] == [Damage, Log]
    assert talk.device.commands[-1] == Key(0, 32)


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
    talk.run(5)
    talk.device.limit = 0
    talk.run(2000)
    gaps = [round(event.seconds) for event in talk.events if isinstance(event, Stalled)]
    assert gaps[:2] == [2, 4]
    assert all(later >= earlier for earlier, later in pairwise(gaps))


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


def test_another_major_version_is_said_once_and_ends_it() -> None:
    talk = Talk(FakeDevice(major=2))
    events = talk.run(200)
    assert [type(event) for event in events] == [Refused]
    assert "version 2.3" in str(events[0].error)  # type: ignore[union-attr]
    assert talk.device.commands == [Ping()]


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
