"""Transports: large reads, waits that end, rates that a port takes or refuses, unplugging, each in one line."""

from __future__ import annotations

import os
import socket
import time
import tty
from collections.abc import Iterator
from pathlib import Path

import pytest

from edgeline.errors import StreamEndError, StreamError
from edgeline.transport import READ_TIMEOUT_S, SerialTransport, StreamTransport, TcpTransport, connect


@pytest.fixture
def pty() -> Iterator[tuple[int, str]]:
    """The descriptor of the device's end, and the port."""
    master, slave = os.openpty()
    tty.setraw(slave)
    yield master, os.ttyname(slave)
    for descriptor in (master, slave):
        os.close(descriptor)


def test_what_has_arrived_is_read_in_one_piece(pty: tuple[int, str]) -> None:
    master, port = pty
    transport = connect(port, 115200)
    assert isinstance(transport, SerialTransport)
    os.write(master, bytes(3000))
    deadline = time.monotonic() + 10
    while transport._port.in_waiting < 3000 and time.monotonic() < deadline:
        time.sleep(0.01)
    assert len(transport.read()) == 3000
    began = time.monotonic()
    assert transport.read() == b""
    assert time.monotonic() - began < READ_TIMEOUT_S + 5
    transport.close()


def test_a_serial_port_s_rate_is_changed(pty: tuple[int, str]) -> None:
    transport = connect(pty[1], 115200)
    assert isinstance(transport, SerialTransport)
    assert (transport.baud, transport.one_way) == (115200, False)
    assert transport.set_baud(921600)
    assert transport.baud == 921600
    assert not transport.set_baud(2**40)
    assert transport.baud == 921600
    transport.close()
    transport.close()


@pytest.mark.parametrize("refusal", [ValueError("Failed to set custom baud rate"), OSError(22, "Invalid argument")])
def test_a_driver_that_refuses_a_rate_keeps_its_own(
    pty: tuple[int, str], refusal: Exception, monkeypatch: pytest.MonkeyPatch
) -> None:
    transport = SerialTransport(pty[1], 115200)
    kind = type(transport._port)
    plain = kind.baudrate

    def refusing(port: object, rate: int) -> None:
        if rate > 500_000:
            raise refusal
        plain.fset(port, rate)

    monkeypatch.setattr(kind, "baudrate", property(plain.fget, refusing))
    assert not transport.set_baud(921600)
    assert transport.baud == 115200
    assert transport.set_baud(230400)
    assert transport.baud == 230400
    transport.close()


def test_an_unplugged_port_is_one_line_whoever_notices(pty: tuple[int, str]) -> None:
    transport = SerialTransport(pty[1], 115200)

    class Gone:
        """As pyserial behaves: plain OSError from in_waiting, too."""

        baudrate = 115200

        def read(self, _: int) -> bytes:
            return b"x"

        @property
        def in_waiting(self) -> int:
            raise OSError(5, "Input/output error")

        def write(self, _: bytes) -> int:
            raise OSError(5, "Input/output error")

        def close(self) -> None:
            raise OSError(5, "Input/output error")

    transport._port.close()
    transport._port = Gone()
    for use in (transport.read, lambda: transport.write(b"x")):
        with pytest.raises(StreamError, match="the device is gone"):
            use()
    transport.close()


def test_tcp_has_no_rate_and_reads_large_pieces() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        transport = connect(f"socket://127.0.0.1:{server.getsockname()[1]}", 115200)
        assert isinstance(transport, TcpTransport)
        peer, _ = server.accept()
        with peer:
            peer.sendall(bytes(50_000))
            time.sleep(0.2)
            assert len(transport.read()) > 10_000
            assert (transport.baud, transport.one_way, transport.set_baud(921600)) == (0, False, True)
        transport.close()


def test_a_pipe_that_says_nothing_does_not_hold_the_host() -> None:
    read, write = os.pipe()
    transport = StreamTransport("a pipe", read)
    began = time.monotonic()
    assert transport.read() == b""
    assert time.monotonic() - began < READ_TIMEOUT_S + 5
    os.write(write, b"said")
    assert transport.read() == b"said"
    os.close(write)
    with pytest.raises(StreamEndError, match="a pipe: the stream has ended"):
        transport.read()
    assert (transport.baud, transport.one_way, transport.set_baud(9600)) == (0, True, True)
    transport.close()
    with pytest.raises(StreamError):
        transport.read()


def test_a_file_is_one_way(tmp_path: Path) -> None:
    (tmp_path / "capture").write_bytes(b"abc")
    transport = connect(str(tmp_path / "capture"), 115200)
    assert transport.one_way
    assert transport.read() == b"abc"
    transport.close()
