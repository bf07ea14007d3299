"""Which ports there are, and on which of them an Edgeline answers.

Names and USB ids say little (many boards share a USB bridge), so the HELLO decides.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Sequence
from dataclasses import dataclass

from serial.tools import list_ports

from edgeline.errors import DeviceError, EdgelineError
from edgeline.link import Link
from edgeline.protocol import Hello
from edgeline.session import Session
from edgeline.transport import connect

PROBE_TIMEOUT_S = 3.5
"""Opening the port resets many boards: one second in the boot loader, then up to one until HELLO. A device that a host
left behind at a higher rate says HELLO at its first one after 3 s."""

OPEN_TIMEOUT_S = 1.0
"""More, for a port that is slow to open; some never do (a modem's, a Bluetooth link's)."""


@dataclass(frozen=True)
class PortInfo:
    """A serial port of this computer. `usb` is its vendor id, product id and serial number, None on others."""

    device: str
    description: str
    usb: tuple[int, int, str | None] | None


def ports() -> list[PortInfo]:
    """All serial ports that the system names, USB ports first."""
    found = [
        PortInfo(
            port.device,
            port.description if port.description != "n/a" else "",
            None if port.vid is None else (port.vid, port.pid, port.serial_number),
        )
        for port in list_ports.comports()
    ]
    return sorted(found, key=lambda port: (port.usb is None, port.device))


def probe(device: str, baud: int, timeout_s: float = PROBE_TIMEOUT_S) -> Hello | None:
    """The HELLO of the device on a port, or None if nothing there answers (or the port does not open)."""
    try:
        with Link(connect(device, baud), Session(autostart=False)) as link:
            return link.wait_hello(timeout_s)
    except EdgelineError:
        return None


def probe_all(devices: Sequence[str], baud: int, timeout_s: float | None = None) -> list[Hello | None]:
    """As `probe` for all of them at once; a port that does not even open in that time is left alone."""
    found: dict[str, Hello | None] = {}
    wait_s = PROBE_TIMEOUT_S if timeout_s is None else timeout_s

    def ask(device: str) -> None:
        found[device] = probe(device, baud, wait_s)

    threads = [threading.Thread(target=ask, args=(device,), daemon=True) for device in devices]
    for thread in threads:
        thread.start()
    deadline = time.monotonic() + wait_s + OPEN_TIMEOUT_S
    for thread in threads:
        thread.join(max(0.0, deadline - time.monotonic()))
    return [found.get(device) for device in devices]


def find(baud: int) -> str:
    """The one port on which an Edgeline answers. Raises DeviceError if there is none, or more than one.

    USB ports are asked first, the others only where none of those answers: they are rarely connected to a board.
    """
    found = ports()
    for candidates in ([p.device for p in found if p.usb is not None], [p.device for p in found if p.usb is None]):
        hellos = probe_all(candidates, baud)
        answering = [device for device, hello in zip(candidates, hellos, strict=True) if hello is not None]
        if len(answering) > 1:
            raise DeviceError(f"more than one Edgeline answers: choose one with -p: {', '.join(answering)}")
        if answering:
            return answering[0]
    if not found:
        raise DeviceError("no serial port found: plug the board in, or name a port with -p (a pty, socket://HOST:PORT)")
    names = ", ".join(port.device for port in found)
    raise DeviceError(f"no Edgeline answers on {names} at {baud} baud: set -b, or name a port with -p")


def moved(before: PortInfo) -> str | None:
    """Where a USB device that was unplugged is now: the same port, or another one with the same ids; None: nowhere."""
    now = ports()
    if any(port.device == before.device for port in now):
        return before.device
    return next((port.device for port in now if before.usb is not None and port.usb == before.usb), None)
