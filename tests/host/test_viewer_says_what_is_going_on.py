"""The viewer's state in words: what it waits for, how bad the link is, what it shows meanwhile, how it comes back."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

from conftest import Edgeline, environment
from edgeline import discovery
from edgeline.errors import DeviceError
from edgeline.events import Damage, Frame, Log, Partial, Refused, Stalled
from edgeline.protocol import Hello, Mode, PacketType
from edgeline.quality import LinkQuality
from edgeline.session import Session
from edgeline.viewer import theme
from edgeline.viewer.log import Source
from edgeline.viewer.model import Measures, ViewModel
from edgeline.viewer.state import Mood, Phase, Situation, in_words
from fake_device import FakeDevice, Faults, PtyDevice, TcpDevice
from talk import Talk
from viewer_at_work import at_work, wait_for


def after(steps: int, device: FakeDevice | None = None) -> tuple[ViewModel, Talk]:
    talk, model = Talk(device or FakeDevice()), ViewModel("/dev/ttyX")
    model.enter(Phase.SILENT, talk.now, "/dev/ttyX")
    for _ in range(steps):
        events = talk.step()
        model.take(events, talk.now)
    measure(model, talk)
    return model, talk


def measure(model: ViewModel, talk: Talk) -> None:
    session = talk.session
    model.measure(
        Measures(replace(session.counts), session.quality(talk.now), session.statistics(talk.now), 921600), talk.now
    )


def quality(frames: int, failed: int, bit_error_rate: float | None = None) -> LinkQuality:
    return LinkQuality(5.0, frames, failed, 0.0, 0, bit_error_rate)


AT_115200 = Situation(Phase.SILENT, 0, "COM3", rate=115200)
STREAMING = Situation(Phase.STREAMING, 0, frame_age=0.1, quality=quality(99, 0))
OLD = Situation(Phase.STALLED, 6.0, frame_age=6.0)
MISMATCH = "the device speaks version 2.0 of the wire"

SITUATIONS = (
    (Situation(Phase.SEARCHING, 0, detail="asking COM3, COM4"), Mood.BUSY, "asking COM3, COM4"),
    (Situation(Phase.CHOOSING, 0), Mood.BUSY, "more than one Edgeline answers: press a number"),
    (Situation(Phase.ABSENT, 0, "COM3", "COM3: in use"), Mood.BUSY, "waiting for COM3"),
    (replace(AT_115200, since=9.0), Mood.BUSY, "COM3 is open; waiting for the device's HELLO"),
    (AT_115200, Mood.BUSY, "COM3 is open, and nothing arrives at 115,200 baud"),
    (replace(AT_115200, rate=0), Mood.BUSY, "COM3 is open, and nothing arrives"),
    (
        replace(AT_115200, bytes_received=1234),
        Mood.BUSY,
        "COM3: 1,234 bytes at 115,200 baud, and no HELLO among them",
    ),
    (Situation(Phase.GREETED, 0), Mood.BUSY, "waiting for the first frame"),
    (Situation(Phase.GREETED, 0, bytes_received=45_600), Mood.BUSY, "waiting for the first frame, 46 kB so far"),
    (
        replace(STREAMING, phase=Phase.GREETED, quality=quality(0, 7)),
        Mood.BAD,
        "bad link: no frame could be proven yet, 7 failed",
    ),
    (STREAMING, Mood.GOOD, "streaming"),
    (replace(STREAMING, mixed=True), Mood.GOOD, "streaming, lines of several frames"),
    (replace(STREAMING, frame_age=3.21), Mood.BUSY, "streaming; the picture is 3.2 s old"),
    (replace(STREAMING, frame_age=9.0, held=1234), Mood.BUSY, "frame 1234 is held; streaming"),
    (
        replace(STREAMING, quality=quality(98, 2)),
        Mood.BUSY,
        "streaming; 2 % of the frames fail, their lines are asked for anew",
    ),
    (
        replace(STREAMING, frame_age=0.4, quality=quality(57, 43, 1.2e-4)),
        Mood.BAD,
        "bad link: 43 % of the frames fail, bit errors about 1e-04; the last proven one is 0.4 s old",
    ),
    (OLD, Mood.BUSY, "silent for 6 s: asking again; the picture is 6.0 s old"),
    (
        replace(OLD, phase=Phase.LOST, port="COM3", frame_age=130),
        Mood.BAD,
        "lost COM3: reconnecting; the picture is 2 min old",
    ),
    (Situation(Phase.REFUSED, 0, detail=MISMATCH), Mood.BAD, MISMATCH),
    (Situation(Phase.ENDED, 0), Mood.GOOD, "the stream has ended; this is its last frame"),
)


@pytest.mark.parametrize(("situation", "mood", "line"), SITUATIONS)
def test_every_situation_has_its_words(situation: Situation, mood: Mood, line: str) -> None:
    words = in_words(situation, 10.0)
    assert (words.mood, words.line) == (mood, line)
    assert "\n" not in words.line


def test_what_to_do_about_it_is_said_where_the_picture_will_be() -> None:
    for phase in (Phase.SEARCHING, Phase.ABSENT, Phase.SILENT, Phase.GREETED):
        assert in_words(Situation(phase, 0.0, "COM3"), 10.0).advice


def test_text_can_be_read_on_its_ground() -> None:
    """WCAG 2.1, 1.4.3: a contrast of 4.5 to 1."""

    def luminance(colour: str) -> float:
        channels = np.array(theme.rgb(colour)) / 255
        linear = np.where(channels <= 0.04045, channels / 12.92, ((channels + 0.055) / 1.055) ** 2.4)
        return float(linear @ (0.2126, 0.7152, 0.0722))

    for ground in (theme.GROUND, theme.PANEL, theme.WELL):
        for text in (theme.TEXT, theme.DIM, theme.ACCENT, theme.RECORDING, *theme.MOODS.values(), *theme.SERIES):
            assert (luminance(text) + 0.05) / (luminance(ground) + 0.05) >= 4.5, (text, ground)


def test_before_the_device_answers() -> None:
    view = ViewModel("/dev/ttyX").view(1.0)
    assert (view.picture, view.hello, view.phase) == (None, None, Phase.SEARCHING)


def test_while_frames_arrive() -> None:
    model, talk = after(60)
    view = model.view(talk.now)
    assert (view.words.mood, view.words.line) == (Mood.GOOD, "streaming")
    assert view.picture is talk.frames[-1].picture
    assert view.hello is not None
    assert view.hello.target == "fake board"
    assert model.frames == len(talk.frames)
    assert model.latest()["memory_peak"] == talk.frames[-1].counters["memory_peak"]


def test_frames_that_fail_are_counted_and_the_last_proven_one_stays() -> None:
    model, talk = after(10)
    shown = model.view(talk.now).picture
    model.take([Damage("a packet with a wrong CRC (9 bytes)"), Log("hot\nvery hot")], talk.now)
    talk.session.counts.failed += 3
    measure(model, talk)
    view = model.view(talk.now)
    assert view.picture is shown
    lines, _ = model.log_since(0)
    assert [line.text for line in lines[-3:]] == ["a packet with a wrong CRC (9 bytes)", "hot", "very hot"]
    assert lines[-1].source is Source.DEVICE
    assert model.track("render", talk.now)[1].sum() == 3


def test_of_a_frame_that_failed_only_proven_lines_are_shown_and_only_when_no_whole_one_came() -> None:
    model, talk = after(10)
    good = talk.frames[-1]
    proven = np.zeros(len(good.picture), bool)
    proven[3:7] = True
    torn = np.full_like(good.picture, 0x1234)
    model.take([Partial(9, torn, proven)], talk.now)
    assert model.view(talk.now + 0.1).picture is good.picture
    late = model.view(talk.now + 0.8)
    assert late.picture is torn
    assert late.proven is proven
    assert model.shown is good  # this is what a screenshot has
    model.take([good], talk.now + 0.9)
    assert model.view(talk.now + 5).picture is good.picture


def test_pause_holds_the_picture_and_not_the_link() -> None:
    model, talk = after(10)
    model.toggle_pause()
    held = model.view(talk.now)
    model.take(talk.run(10), talk.now)
    still = model.view(talk.now)
    assert still.picture is held.picture
    assert still.serial == held.serial
    assert still.words.line == f"frame {talk.frames[8].number} is held; streaming"
    assert model.frames == len(talk.frames)
    model.step()
    expected = talk.step()
    model.take(expected, talk.now)
    model.take(talk.run(5), talk.now)
    assert model.shown is next(event for event in expected if isinstance(event, Frame))
    model.toggle_pause()
    assert model.view(talk.now).picture is talk.frames[-1].picture


def test_another_version_stays_on_the_screen() -> None:
    model, talk = after(3, FakeDevice(major=2))
    view = model.view(talk.now)
    assert view.words.mood is Mood.BAD
    assert "update the host" in view.words.line
    error = DeviceError("the device speaks version 2.0")
    model.take([Refused(error)], talk.now)
    assert model.view(talk.now).words.line == str(error)


def test_a_picture_of_several_frames_is_called_so() -> None:
    device = FakeDevice(160, 120, rolls=True, room=3000)
    talk, model = Talk(device, Session(mode=Mode.ROLL)), ViewModel("x")
    lines = set()
    for _ in range(60):
        model.take(talk.step(), talk.now)
        lines.add((model.view(talk.now).words.line, bool(talk.frames) and talk.frames[-1].mixed))
    assert ("streaming, lines of several frames", True) in lines
    assert ("streaming", True) not in lines


def test_silence_is_said_with_its_length() -> None:
    model, talk = after(10)
    model.take([Stalled(2.2)], talk.now)
    assert model.view(talk.now + 3).words.line.startswith("silent for 5 s: asking again; the picture is")


class Ports:
    """Stands for the computer's serial ports: `there`, and `answering`, which device is behind which."""

    def __init__(self) -> None:
        self.there: list[discovery.PortInfo] = []
        self.answering: dict[str, Hello] = {}

    def plug(self, device: str, serial_number: str = "1", hello: Hello | None = None) -> None:
        self.there.append(discovery.PortInfo(device, "", (0x2E8A, 0xA, serial_number)))
        if hello is not None:
            self.answering[device] = hello


@pytest.fixture
def ports(monkeypatch: pytest.MonkeyPatch) -> Iterator[Ports]:
    ports = Ports()
    monkeypatch.setattr(discovery, "ports", lambda: list(ports.there))
    monkeypatch.setattr(discovery, "probe_all", lambda names, _: [ports.answering.get(name) for name in names])
    yield ports


def test_it_finds_the_board_when_it_is_plugged_in(display: str, ports: Ports) -> None:
    with PtyDevice(FakeDevice()) as served, at_work(display, None) as viewer:
        viewer.until(lambda: viewer.line == "no serial port: waiting for a board")
        ports.plug("/dev/nowhere")
        viewer.until(lambda: viewer.line == "no Edgeline answers on /dev/nowhere at 115,200 baud: waiting for a board")
        ports.plug(served.port, "2", HELLO)
        viewer.until(lambda: viewer.line == "streaming")
        viewer.until(lambda: viewer.root.title() == "fake board \u2013 Edgeline")


def test_ports_that_are_not_usb_are_asked_too(display: str, ports: Ports) -> None:
    with PtyDevice(FakeDevice()) as served, at_work(display, None) as viewer:
        ports.plug("/dev/nowhere")
        ports.there.append(discovery.PortInfo(served.port, "", None))
        ports.answering[served.port] = HELLO
        viewer.until(lambda: viewer.line == "streaming")


HELLO = Hello(48, 32, 0, 1, "fake board", "edgeline 0.1.0")


def test_where_several_answer_the_user_chooses_by_a_number(display: str, ports: Ports) -> None:
    ports.plug("/dev/other", "1", HELLO)
    with PtyDevice(FakeDevice()) as served:
        ports.plug(served.port, "2", HELLO)
        with at_work(display, None) as viewer:
            viewer.until(lambda: viewer.line == "more than one Edgeline answers: press a number")
            assert viewer.view.words.advice == f"1   /dev/other   fake board\n2   {served.port}   fake board"
            viewer.press("2")
            viewer.until(lambda: viewer.line == "streaming")


def test_a_port_that_is_not_there_yet_is_waited_for(display: str) -> None:
    with TcpDevice(FakeDevice()) as first:
        port = first.port
    with at_work(display, port) as viewer:
        viewer.until(lambda: viewer.line == f"waiting for {port}")
        with TcpDevice(FakeDevice(), listen=int(port.rsplit(":", 1)[1])):
            viewer.until(lambda: viewer.line == "streaming")


def test_a_device_that_goes_and_comes_back(display: str) -> None:
    with TcpDevice(FakeDevice()) as first, at_work(display, first.port) as viewer:
        port = first.port
        viewer.until(lambda: viewer.model.frames > 3)
        first.stop()
        viewer.until(lambda: viewer.line.startswith(f"lost {port}: reconnecting; the picture is"))
        assert viewer.view.picture is not None
        seen = viewer.model.frames
        with TcpDevice(FakeDevice(boot_id=7), listen=int(port.rsplit(":", 1)[1])):
            viewer.until(lambda: viewer.model.frames > seen + 3 and viewer.line == "streaming")


def test_a_board_that_comes_back_on_another_port_is_found_by_its_ids(display: str, ports: Ports) -> None:
    with TcpDevice(FakeDevice()) as first, at_work(display, None) as viewer:
        ports.plug(first.port, "77", HELLO)
        viewer.until(lambda: viewer.model.frames > 3)
        ports.there.clear()
        first.stop()
        viewer.until(lambda: viewer.line.startswith("lost"))
        with TcpDevice(FakeDevice(boot_id=9)) as second:
            ports.plug(second.port, "77")
            viewer.until(lambda: viewer.line == "streaming")
            assert viewer.view.port == second.port


def test_a_device_of_another_version_is_named_and_asked_again(display: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("edgeline.viewer.reader.ASK_AGAIN_S", 0.3)
    device = FakeDevice(major=2)
    with PtyDevice(device) as served, at_work(display, served.port) as viewer:
        viewer.until(lambda: "update the host" in viewer.line)
        seen, asked = set(), len(device.commands)
        viewer.until(lambda: seen.add(viewer.line) or len(device.commands) >= asked + 3)
        assert len(seen) == 1  # it does not flicker
        with served.lock:
            device.major = 1  # another firmware is flashed
        viewer.until(lambda: viewer.line == "streaming")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_view_ends_cleanly_on_a_signal(display: str, number: signal.Signals) -> None:
    with PtyDevice(FakeDevice()) as served:
        viewer = subprocess.Popen(
            [sys.executable, "-m", "edgeline", "view", "-p", served.port],
            env={**environment(), "DISPLAY": display},
            stderr=subprocess.PIPE,
        )
        wait_for(lambda: len(served.device.sent) >= 5 or viewer.poll() is not None)
        viewer.send_signal(number)
        _, errors = viewer.communicate(timeout=60)
        assert (viewer.returncode, errors) == (0, b"")
        wait_for(lambda: served.device.commands[-1].TYPE == PacketType.STOP)


def test_view_ends_after_its_frames(display: str, edgeline: Edgeline) -> None:
    with PtyDevice(FakeDevice(faults=Faults(3, flip=0.02))) as served:
        result = edgeline("view", "-p", served.port, "--frames", "20", env={"DISPLAY": display})
        assert (result.returncode, result.stderr) == (0, "")
        wait_for(lambda: any(body.TYPE == PacketType.STOP for body in list(served.device.commands)))
