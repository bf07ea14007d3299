"""A Player behind a pty or a TCP port: the I/O of `edgeline replay`."""

from __future__ import annotations

import contextlib
import os
import select
import socket
import time
from types import TracebackType
from typing import Protocol

from edgeline.errors import DeviceError, EdgelineError, StreamError
from edgeline.player import Player

_RECEIVE_BYTES = 1 << 16
_ACCEPT_S = 0.1
_LAST_WORDS_S = 1.0
"""How long a host is waited for that has not confirmed the last frames."""


class Port(Protocol):
    """Where hosts come to, one after the other. Only `join` may raise: what is sent to a host that has gone is lost."""

    name: str
    """as `-p` takes it"""
    said: str
    """what tells the user, as the simulator says it"""

    def join(self) -> bool:
        """Whether a host can be spoken to; waits a moment for one."""

    def exchange(self, outgoing: bytearray, wait_s: float) -> bytes | None:
        """Waits at most `wait_s`, takes from `outgoing` what the host takes, and gives what it says; None: it has
        gone."""


class PtyPort:
    """A pseudo terminal. Whether a host has it open cannot be seen, so it is always spoken to."""

    def __init__(self) -> None:
        if not hasattr(os, "openpty"):
            raise EdgelineError("replay: this system has no pseudo terminals: use --tcp PORT")
        import tty  # noqa: PLC0415 (exists where ptys do)

        self._master, self._slave = os.openpty()
        tty.setraw(self._slave)
        os.set_blocking(self._master, False)
        self.name = self.said = os.ttyname(self._slave)

    def __enter__(self) -> PtyPort:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        os.close(self._master)
        os.close(self._slave)

    def join(self) -> bool:
        return True

    def exchange(self, outgoing: bytearray, wait_s: float) -> bytes | None:
        readable, writable, _ = select.select([self._master], [self._master] if outgoing else [], [], wait_s)
        if writable:
            del outgoing[: os.write(self._master, outgoing)]
        return os.read(self._master, _RECEIVE_BYTES) if readable else b""


class TcpPort:
    """A TCP port of this machine, `number` 0: a free one. Raises DeviceError if it is taken."""

    def __init__(self, number: int) -> None:
        try:
            self._listener = socket.create_server(("127.0.0.1", number))
        except OSError as error:
            raise DeviceError(f"replay: cannot listen on TCP port {number}: {error.strerror or error}") from None
        self._listener.settimeout(_ACCEPT_S)
        self._host: socket.socket | None = None
        address = f"127.0.0.1:{self._listener.getsockname()[1]}"
        self.name, self.said = f"socket://{address}", f"listening on {address}"

    def __enter__(self) -> TcpPort:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._leave()
        self._listener.close()

    def join(self) -> bool:
        if self._host is None:
            with contextlib.suppress(TimeoutError):
                self._host, _ = self._listener.accept()
                self._host.setblocking(False)
                self._host.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return self._host is not None

    def exchange(self, outgoing: bytearray, wait_s: float) -> bytes | None:
        assert self._host is not None
        try:
            readable, writable, _ = select.select([self._host], [self._host] if outgoing else [], [], wait_s)
            if writable:
                del outgoing[: self._host.send(outgoing)]
            data = self._host.recv(_RECEIVE_BYTES) if readable else None
        except OSError:
            data = b""
        if data == b"":
            self._leave()
            return None
        return data or b""

    def _leave(self) -> None:
        if self._host is not None:
            self._host.close()
        self._host = None


def serve(player: Player, port: Port, timeout_s: float | None) -> None:
    """Plays to one host after the other until one has had the recording to its end.

    Raises StreamError if none asks for it within `timeout_s` seconds, None: waits for ever.
    """
    outgoing = bytearray()
    asked = time.monotonic()
    ended: float | None = None
    while True:
        now = time.monotonic()
        asked = now if player.streaming else asked
        if timeout_s is not None and now - asked > timeout_s:
            raise StreamError(f"{port.name}: no host has asked for frames within {timeout_s:g} s")
        if not port.join():
            continue
        if not outgoing:
            outgoing += player.run(now)
        if player.ended and not outgoing:
            ended = now if ended is None else ended
            if player.confirmed or now - ended > _LAST_WORDS_S:
                return
        said = port.exchange(outgoing, player.wait_s)
        if said is None:
            outgoing.clear()
            player.leave()
        else:
            player.receive(said, time.monotonic())
