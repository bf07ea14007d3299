"""The byte links: serial ports and ptys, TCP, and one-way streams (a capture in a file, a pipe).

A transport reads in large pieces, waits at most READ_TIMEOUT_S, and turns every failure into one line that says what
to do. What was measured: pyserial's `read(1)` followed by `read(in_waiting)` moves 28 MB/s through a pty, `read(1)`
alone 0.01; pyserial's `socket://` knows no `in_waiting` beyond 1 and waits for a whole buffer, so TCP is done here.
"""

from __future__ import annotations

import contextlib
import errno
import os
import select
import socket
import sys
from pathlib import Path
from typing import Protocol
from urllib.parse import urlsplit

import serial

from edgeline.errors import DeviceError, StreamEndError, StreamError
from edgeline.playback import RecordingTransport
from edgeline.recording import is_recording

READ_TIMEOUT_S = 0.05
WRITE_TIMEOUT_S = 2.0
CONNECT_TIMEOUT_S = 5.0
RECEIVE_BYTES = 1 << 16


class Transport(Protocol):
    """A link to a device. Every method may raise StreamError once the link is gone."""

    @property
    def name(self) -> str:
        """As the user calls it."""

    @property
    def one_way(self) -> bool:
        """Nobody reads what is written: a recording, a pipe."""

    @property
    def baud(self) -> int:
        """Bits per second, 0 for a link without a rate."""

    def read(self) -> bytes:
        """What has arrived, b"" if nothing did within READ_TIMEOUT_S."""

    def write(self, data: bytes) -> None:
        """Sends all of `data`."""

    def set_baud(self, rate: int) -> bool:
        """Changes the rate, and says whether that is possible; as before if not. No-op, and True, without a rate."""

    def close(self) -> None:
        """Never raises; may be called twice."""


def connect(port: str, baud: int) -> Transport:
    """Opens `port`: a serial port or pty, `socket://HOST:PORT`, another URL of pyserial's, `-` (standard input), a
    recording, or a file with a captured stream. Raises DeviceError, EdgelineError for a recording that is damaged."""
    if port.startswith("socket://"):
        return TcpTransport(port)
    if port == "-":
        return StreamTransport("standard input", sys.stdin.fileno())
    if is_recording(port):
        return RecordingTransport(port)
    if Path(port).is_file():
        try:
            return StreamTransport(port, os.open(port, os.O_RDONLY | getattr(os, "O_BINARY", 0)))
        except OSError as error:
            raise DeviceError(_explain(port, error)) from None
    return SerialTransport(port, baud)


class SerialTransport:
    """A port of pyserial's."""

    one_way = False

    def __init__(self, port: str, baud: int) -> None:
        self.name = port
        is_path = "://" not in port
        try:
            # An exclusive port cannot be shared with a second viewer by mistake: both would get half of the bytes.
            self._port = serial.serial_for_url(
                port,
                baudrate=baud,
                timeout=READ_TIMEOUT_S,
                write_timeout=WRITE_TIMEOUT_S,
                **({"exclusive": True} if is_path and os.name == "posix" else {}),
            )
        except ValueError as error:
            raise DeviceError(f"{port}: {error} (-b sets the baud rate)") from None
        except OSError as error:
            raise DeviceError(_explain(port, error)) from None
        if hasattr(self._port, "set_buffer_size"):  # Windows, whose default of 4 KB overruns between two reads
            self._port.set_buffer_size(1 << 20)

    def read(self) -> bytes:
        try:
            data: bytes = self._port.read(1)
            waiting: int = self._port.in_waiting if data else 0
            return data + self._port.read(waiting) if waiting else data
        except (OSError, TypeError):  # TypeError: pyserial's, when another thread has just closed the port
            raise StreamError(f"{self.name}: the device is gone (unplugged, or its simulator has ended)") from None

    def write(self, data: bytes) -> None:
        try:
            self._port.write(data)
        except serial.SerialTimeoutException:
            raise StreamError(f"{self.name}: the device takes no bytes") from None
        except (OSError, TypeError):
            raise StreamError(f"{self.name}: the device is gone (unplugged, or its simulator has ended)") from None

    @property
    def baud(self) -> int:
        return int(self._port.baudrate)

    def set_baud(self, rate: int) -> bool:
        before = self.baud
        try:
            self._port.baudrate = rate
        except (OSError, ValueError, OverflowError):  # drivers differ in which rates they refuse, and how
            with contextlib.suppress(OSError, ValueError):
                self._port.baudrate = before
            return False
        return True

    def close(self) -> None:
        with contextlib.suppress(OSError):
            self._port.close()


class TcpTransport:
    """`socket://HOST:PORT`: a simulator, or a serial server."""

    one_way = False
    baud = 0

    def __init__(self, url: str) -> None:
        self.name = url
        try:
            parts = urlsplit(url)
            host, number = parts.hostname, parts.port
        except ValueError:
            host, number = None, None
        if not host or not number:
            raise DeviceError(f"{url}: a TCP link is written socket://HOST:PORT")
        try:
            self._socket = socket.create_connection((host, number), CONNECT_TIMEOUT_S)
        except OSError as error:
            raise DeviceError(_explain(url, error)) from None
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def read(self) -> bytes:
        try:
            self._socket.settimeout(READ_TIMEOUT_S)
            data = self._socket.recv(RECEIVE_BYTES)
        except TimeoutError:
            return b""
        except OSError:
            data = b""
        if not data:
            raise StreamError(f"{self.name}: the other end has closed the connection")
        return data

    def write(self, data: bytes) -> None:
        try:
            self._socket.settimeout(WRITE_TIMEOUT_S)
            self._socket.sendall(data)
        except OSError:
            raise StreamError(f"{self.name}: the other end takes no bytes") from None

    def set_baud(self, _rate: int) -> bool:
        return True

    def close(self) -> None:
        with contextlib.suppress(OSError):
            self._socket.close()


class StreamTransport:
    """Bytes that were recorded or are piped in; what the host says goes nowhere."""

    one_way = True
    baud = 0

    def __init__(self, name: str, descriptor: int) -> None:
        self.name = name
        self._descriptor = descriptor

    def read(self) -> bytes:
        try:
            # A file is always ready; on Windows, where select knows sockets alone, a pipe is waited for.
            if os.name == "posix" and not select.select([self._descriptor], [], [], READ_TIMEOUT_S)[0]:
                return b""
            data = os.read(self._descriptor, RECEIVE_BYTES)
        except (OSError, ValueError) as error:  # ValueError: it has been closed
            raise StreamError(f"{self.name}: {getattr(error, 'strerror', None) or error}") from None
        if not data:
            raise StreamEndError(f"{self.name}: the stream has ended")
        return data

    def write(self, data: bytes) -> None:
        """There is nobody to tell."""

    def set_baud(self, _rate: int) -> bool:
        return True

    def close(self) -> None:
        if self._descriptor > 2:
            with contextlib.suppress(OSError):
                os.close(self._descriptor)
            self._descriptor = -1


def _explain(port: str, error: OSError) -> str:
    """One line for a port that does not open. pyserial wraps the cause: its errno on POSIX, its text on Windows."""
    text = str(error)
    if error.errno in (errno.EBUSY, errno.EAGAIN) or "PermissionError(13" in text:
        return f"{port}: in use by another program: close that one first"
    if error.errno == errno.ENOENT or "FileNotFoundError" in text:
        return f"{port}: there is no such port: is it plugged in? `edgeline list` shows those that are there"
    if error.errno in (errno.EACCES, errno.EPERM):
        return f"{port}: permission denied: on Linux, join the group that owns the port (dialout, uucp)"
    if error.errno == errno.ENOTTY or f"({errno.ENOTTY}, " in text:
        return f"{port}: is no serial port: `edgeline list` shows those that are there"
    if isinstance(error, socket.gaierror):
        return f"{port}: the host's name cannot be resolved"
    if isinstance(error, (TimeoutError, ConnectionRefusedError)):
        return f"{port}: nothing listens there"
    return f"{port}: cannot be opened: {error.strerror or text}"
