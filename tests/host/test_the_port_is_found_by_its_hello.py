"""Auto-detection: every USB port is asked, the HELLO decides; a device that was unplugged is found on its new port."""

from __future__ import annotations

import json
import threading
import time
from dataclasses import dataclass

import pytest

from edgeline import cli, discovery
from edgeline.errors import DeviceError
from edgeline.transport import Transport
from fake_device import FakeDevice, PtyDevice


@dataclass
class Listed:
    """What pyserial tells of a port."""

    device: str
    vid: int | None = 0x2E8A
    pid: int = 10
    serial_number: str = "E66"
    description: str = "n/a"


@pytest.fixture(autouse=True)
def short_probe(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(discovery, "PROBE_TIMEOUT_S", 1.0)


def computer_with(monkeypatch: pytest.MonkeyPatch, *ports: Listed) -> None:
    monkeypatch.setattr("serial.tools.list_ports.comports", lambda: list(ports))


def test_the_one_that_answers(monkeypatch: pytest.MonkeyPatch) -> None:
    with PtyDevice(FakeDevice()) as board, PtyDevice(FakeDevice(major=9)) as other:
        computer_with(monkeypatch, Listed("/dev/ttyABSENT"), Listed(other.port), Listed(board.port))
        assert discovery.find(115200) == board.port


def test_ports_that_are_not_usb_are_asked_where_no_usb_port_answers(monkeypatch: pytest.MonkeyPatch) -> None:
    with PtyDevice(FakeDevice()) as board, PtyDevice(FakeDevice()) as other:
        computer_with(monkeypatch, Listed(board.port), Listed(other.port, vid=None))
        assert discovery.find(115200) == board.port
        assert other.device.commands == []
        computer_with(monkeypatch, Listed("/dev/ttyABSENT"), Listed(other.port, vid=None))
        assert discovery.find(115200) == other.port


def test_a_port_that_never_opens_holds_up_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    connect = discovery.connect

    def slow(port: str, baud: int) -> Transport:
        if port == "/dev/ttySLOW":
            threading.Event().wait()
        return connect(port, baud)

    monkeypatch.setattr(discovery, "connect", slow)
    with PtyDevice(FakeDevice()) as board:
        began = time.monotonic()
        assert [hello and hello.target for hello in discovery.probe_all(["/dev/ttySLOW", board.port], 115200, 0.3)] == [
            None,
            "fake board",
        ]
    assert time.monotonic() - began < 5


def test_none_and_two_are_said(monkeypatch: pytest.MonkeyPatch) -> None:
    computer_with(monkeypatch)
    with pytest.raises(DeviceError, match="no serial port found: plug the board in"):
        discovery.find(115200)
    computer_with(monkeypatch, Listed("/dev/ttyABSENT"))
    with pytest.raises(DeviceError, match="no Edgeline answers on /dev/ttyABSENT at 9600 baud"):
        discovery.find(9600)
    with PtyDevice(FakeDevice()) as one, PtyDevice(FakeDevice()) as two:
        computer_with(monkeypatch, Listed(one.port), Listed(two.port))
        with pytest.raises(DeviceError, match=f"choose one with -p: {one.port}, {two.port}"):
            discovery.find(115200)


def test_list_with_and_without_asking(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    with PtyDevice(FakeDevice()) as board:
        computer_with(monkeypatch, Listed("/dev/ttyS0", vid=None), Listed(board.port, description="Pico"))
        assert cli.main(["list"]) == 0
        assert capsys.readouterr().out.split() == [board.port, "2e8a:000a", "Pico", "/dev/ttyS0"]
        assert board.device.commands == []
        assert cli.main(["list", "--probe", "--json"]) == 0
        first, second = json.loads(capsys.readouterr().out)
    assert first["hello"]["target"] == "fake board"
    assert second["hello"] is None


def test_a_device_that_moved(monkeypatch: pytest.MonkeyPatch) -> None:
    before = discovery.PortInfo("/dev/ttyACM0", "", (0x2E8A, 10, "E66"))
    computer_with(monkeypatch, Listed("/dev/ttyACM1", serial_number="E67"), Listed("/dev/ttyACM2"))
    assert discovery.moved(before) == "/dev/ttyACM2"
    computer_with(monkeypatch, Listed("/dev/ttyACM0"), Listed("/dev/ttyACM1"))
    assert discovery.moved(before) == "/dev/ttyACM0"
    computer_with(monkeypatch)
    assert discovery.moved(before) is None
