"""`edgeline replay`: a recording keeps the device's rules, so every program that reads a device can read it."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

import edgeline as package
from conftest import Edgeline, environment
from edgeline import protocol
from edgeline.cli import main
from edgeline.errors import StreamError
from edgeline.events import Connected, Damage, Event, Frame
from edgeline.follow import follow
from edgeline.framing import Packet, Splitter, encode
from edgeline.player import Player
from edgeline.protocol import Capability, Control
from edgeline.recording import RecordingReader
from edgeline.session import Session
from fake_device import FakeDevice
from recorded import as_file, frames_of, pieces_of, same, write_recording
from talk import Talk

FRAMES = 30


def sent(body: protocol.Body) -> bytes:
    """What a host says."""
    return encode(protocol.pack(body, 0))


class Playing:
    """A Player and a host's session, on a clock that the test moves."""

    def __init__(self, path: Path, speed: float | None = 1.0, **options: object) -> None:
        self.player = Player(lambda: follow(self._pieces(path)), speed, **options)  # type: ignore[arg-type]
        self.session = Session()
        self.now = 50.0
        self.events: list[Event] = []
        self.times: list[float] = []

    @staticmethod
    def _pieces(path: Path) -> RecordingReader:
        return RecordingReader(path.open("rb"), str(path))

    def step(self, seconds: float = 0.01) -> None:
        self.now += seconds
        self._hear(self.session.tick(self.now))
        self.player.receive(self.session.bytes_to_send(), self.now)
        while data := self.player.run(self.now):
            self._hear(self.session.receive(data, self.now))
            self.player.receive(self.session.bytes_to_send(), self.now)

    def run(self, steps: int) -> Playing:
        for _ in range(steps):
            self.step()
        return self

    def restart(self) -> None:
        """Another host comes."""
        self.session = Session()
        self.events.clear()
        self.times.clear()

    def _hear(self, events: list[Event]) -> None:
        self.events += events
        self.times += [self.now for event in events if isinstance(event, Frame)]

    @property
    def frames(self) -> list[Frame]:
        return [event for event in self.events if isinstance(event, Frame)]

    @property
    def damage(self) -> list[Damage]:
        return [event for event in self.events if isinstance(event, Damage)]


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    write_recording(tmp_path / "a.elrec", FRAMES)
    return tmp_path / "a.elrec"


def truth(recording: Path) -> list[Frame]:
    return [frame for _, frame in frames_of(recording)]


@pytest.mark.parametrize("speed", [0.5, 1.0, 4.0])
def test_the_frames_come_at_their_times(recording: Path, speed: float) -> None:
    playing = Playing(recording, speed).run(200)
    assert len(playing.frames) == FRAMES
    assert all(same(a, b) for a, b in zip(playing.frames, truth(recording), strict=True))
    recorded = [time_s for time_s, _ in frames_of(recording)]
    for time_s, came in zip(recorded, playing.times, strict=True):
        assert came - playing.times[0] == pytest.approx((time_s - recorded[0]) / speed, abs=0.0101)
    assert playing.damage == []
    assert playing.player.ended
    assert playing.player.confirmed


def test_as_fast_as_the_host_takes_them(recording: Path) -> None:
    playing = Playing(recording, None).run(3)
    assert all(same(a, b) for a, b in zip(playing.frames, truth(recording), strict=True))


def test_it_offers_what_a_recording_can_do(recording: Path) -> None:
    hello = next(event.hello for event in Playing(recording).run(3).events if isinstance(event, Connected))
    assert hello.capabilities == protocol.DECODABLE | Capability.SKIPS_LINES
    assert (hello.scenes, hello.controls, hello.views, hello.highest_baud) == (0, 0, 0, 0)
    assert hello.target == "fake board"


def test_without_credits_its_time_stands_still(recording: Path) -> None:
    playing = Playing(recording).run(30)
    before = len(playing.frames)
    playing.session.bytes_to_send()
    heard = playing.player.receive
    playing.player.receive = lambda data, now: None  # type: ignore[method-assign]
    for _ in range(50):
        playing.step()
    stood = len(playing.frames)
    assert stood - before <= 2
    playing.player.receive = heard  # type: ignore[method-assign]
    playing.player.receive(sent(protocol.Ack(0, 2)), playing.now)
    playing.run(300)
    assert len(playing.frames) == FRAMES
    assert playing.times[stood] - playing.times[stood - 1] > 0.4
    recorded = [time_s for time_s, _ in frames_of(recording)]
    rest = playing.times[-1] - playing.times[stood + 1]
    assert rest == pytest.approx(recorded[-1] - recorded[stood + 1], abs=0.0201)
    assert playing.damage == []


def test_a_host_that_has_gone_rewinds_it(recording: Path) -> None:
    playing = Playing(recording).run(30)
    assert 3 < len(playing.frames) < FRAMES
    for _ in range(150):
        playing.now += 0.01
        playing.player.run(playing.now)
    assert not playing.player.streaming
    playing.restart()
    playing.run(200)
    assert all(same(a, b) for a, b in zip(playing.frames, truth(recording), strict=True))


def test_stop_rewinds_it(recording: Path) -> None:
    playing = Playing(recording).run(30)
    playing.session.stop()
    playing.step()
    assert not playing.player.streaming
    playing.restart()
    playing.run(200)
    assert all(same(a, b) for a, b in zip(playing.frames, truth(recording), strict=True))
    playing.session.stop()
    playing.step()
    assert playing.player.ended  # and stays so: it has been played


@pytest.mark.parametrize("late_step", [20, 33, 47])
def test_who_comes_late_gets_a_whole_frame_and_goes_on(recording: Path, late_step: int) -> None:
    """Another START in the middle, as of a host that was restarted: nothing is shown that is not the recording's."""
    playing = Playing(recording).run(late_step)
    playing.restart()
    playing.run(200)
    expected = truth(recording)
    assert 3 < len(playing.frames) < FRAMES
    assert all(same(a, b) for a, b in zip(playing.frames, expected[-len(playing.frames) :], strict=True))


def test_key_is_answered_by_a_whole_frame(recording: Path) -> None:
    playing = Playing(recording).run(30)
    run = playing.player.run
    playing.player.run = lambda now: _damaged(run(now))  # type: ignore[method-assign]
    playing.step(0.03)
    playing.player.run = run  # type: ignore[method-assign]
    playing.run(200)
    assert playing.damage
    assert same(playing.frames[-1], truth(recording)[-1])
    assert len(playing.frames) >= FRAMES - 5


def _damaged(data: bytes) -> bytes:
    return data[:-3] + b"\x55" + data[-2:] if len(data) > 9 else data


def test_again_and_again(recording: Path) -> None:
    playing = Playing(recording, None, loop=True, most=2 * FRAMES + 5).run(10)
    expected = truth(recording)
    assert len(playing.frames) == 2 * FRAMES + 5
    assert all(same(frame, expected[i % FRAMES]) for i, frame in enumerate(playing.frames))
    assert playing.damage == []


def test_a_device_that_was_started_anew_is_played_as_one(tmp_path: Path) -> None:
    talk = Talk(FakeDevice(split=True))

    def reboot(talk: Talk) -> None:
        if len(talk.frames) == 10 and talk.device.boot_id != 99:
            talk.device.reboot(99, talk.now)

    (tmp_path / "a.elrec").write_bytes(as_file(pieces_of(talk, 25, reboot)))
    playing = Playing(tmp_path / "a.elrec").run(300)
    connected = [event.hello.boot_id for event in playing.events if isinstance(event, Connected)]
    assert connected == [0x1234ABCD, 99]
    expected = [frame.end.time_us for frame in truth(tmp_path / "a.elrec")]
    got = [frame.end.time_us for frame in playing.frames]
    assert got[:10] == expected[:10]
    assert got[-10:] == expected[-10:]


def test_what_it_cannot_do_is_said(recording: Path) -> None:
    player = Playing(recording).player
    for start in (protocol.Start(2, mode=protocol.Mode.ROLL), protocol.Start(2, codecs=Capability.RAW)):
        player.receive(sent(start), 50.0)
        assert not player.streaming
    chunks = Splitter().feed(player.run(50.0))
    bodies = [protocol.unpack(chunk) for chunk in chunks if isinstance(chunk, Packet)]
    assert [body.text for body in bodies if isinstance(body, protocol.Log)] == [
        "START refused: a recording cannot be played in mode ROLL",
        "START refused: a recording cannot be played in a host that lacks one of its codecs",
    ]
    player.receive(sent(protocol.Ping(2, 0)) + sent(protocol.Start(2, codecs=protocol.DECODABLE)), 51.0)
    assert not player.streaming
    assert b"takes nothing from a host of version 2" in player.run(51.0)
    player.receive(sent(protocol.Ping()) + sent(protocol.Start(2, codecs=protocol.DECODABLE)), 52.0)
    assert player.streaming
    empty = recording.with_name("empty.elrec")
    empty.write_bytes(as_file([]))
    with pytest.raises(StreamError, match="no HELLO"):
        Playing(empty)


def test_what_is_no_packet_of_a_host_is_passed_over(recording: Path) -> None:
    playing = Playing(recording)
    broken = [Packet(protocol.PacketType.START, 0, b""), Packet(0x7F, 0, b"?"), Packet(protocol.PacketType.ACK, 0, b"")]
    for packet in broken:
        playing.player.receive(b"noise\0" + encode(packet), playing.now)
    assert not playing.player.streaming
    assert len(playing.run(200).frames) == FRAMES


@contextmanager
def replaying(folder: Path, *arguments: str) -> Iterator[tuple[str, subprocess.Popen[str]]]:
    """`edgeline replay a.elrec`, and the port that leads to it."""
    process = subprocess.Popen(
        [sys.executable, "-m", "edgeline", "replay", "a.elrec", "--json", *arguments],
        cwd=folder,
        env=environment(),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    try:
        yield json.loads(process.stdout.readline())["port"], process
    finally:
        process.kill()
        process.communicate(timeout=10)


@pytest.mark.parametrize("link", [["--pty"], ["--tcp", "0"]], ids=["pty", "tcp"])
def test_the_command(recording: Path, link: list[str]) -> None:
    """One host that leaves early, then one that stays."""
    expected = truth(recording)
    with replaying(recording.parent, *link, "--as-fast") as (port, process):
        with package.open(port) as stream:
            assert same(stream.next_frame(10), expected[0])
        with package.open(port) as stream:
            frames = [stream.next_frame(10) for _ in range(FRAMES)]
            with pytest.raises(package.DeviceError, match="INPUT"):
                stream.control(Control.SCENE, 1)
        assert all(same(a, b) for a, b in zip(frames, expected, strict=True))
        assert process.wait(10) == 0
        assert process.stdout is not None
        assert json.loads(process.stdout.read()) == {"frames": FRAMES}


def test_other_commands_read_it(recording: Path, edgeline: Edgeline) -> None:
    expected = [f"{frame.end.digest:08x}" for frame in truth(recording)]
    with replaying(recording.parent, "--tcp", "0", "--speed", "3") as (port, _):
        shot = edgeline("shot", "-p", port, "-o", "a.png", "--json")
        assert json.loads(shot.stdout)["digest"] == expected[0]
        recorded = edgeline("record", "-p", port, "--frames", str(FRAMES), "-o", "b.elrec")
        assert recorded.returncode == 0, recorded.stderr
    assert [f"{frame.end.digest:08x}" for frame in truth(recording.with_name("b.elrec"))] == expected


def test_on_standard_output(recording: Path) -> None:
    replay = subprocess.run(
        [sys.executable, "-m", "edgeline", "replay", str(recording), "--stdout", "--as-fast"],
        env=environment(),
        capture_output=True,
        check=True,
        timeout=30,
    )
    frames = [event for event in Session(one_way=True).receive(replay.stdout, 0) if isinstance(event, Frame)]
    assert all(same(a, b) for a, b in zip(frames, truth(recording), strict=True))


def test_nobody_comes(recording: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["replay", str(recording), "--tcp", "0", "--timeout", "0.2"]) == 4
    assert "no host has asked for frames within 0.2 s" in capsys.readouterr().err


def test_a_damaged_recording_is_played_up_to_there(recording: Path, capsys: pytest.CaptureFixture[str]) -> None:
    recording.write_bytes(recording.read_bytes()[:-20])
    with replaying(recording.parent, "--tcp", "0", "--as-fast") as (port, process):
        with package.open(port) as stream:
            played = 0
            with pytest.raises(StreamError):
                while True:
                    stream.next_frame(3)
                    played += 1
        assert process.wait(10) == 4
        assert process.stderr is not None
        assert "a.elrec: the recording is cut off near byte" in process.stderr.read()
    assert played > 3
