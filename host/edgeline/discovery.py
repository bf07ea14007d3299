"""Which ports there are, and on which of them an Edgeline answers.

Names and USB ids say little (many boards share a USB bridge), so the HELLO decides.
"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

from serial.tools import list_ports

from edgeline.errors import DeviceError, EdgelineError
from edgeline.link import Link
from edgeline.protocol import Hello
from edgeline.session import Session
from edgeline.transport import connect

PROBE_TIMEOUT_S = 3.0
"""Opening the port resets many boards: one second in the boot loader, then up to one until HELLO."""


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


def probe_all(devices: Sequence[str], baud: int) -> list[Hello | None]:
    """As `probe` for all of them at once."""
    if not devices:
        return []
    with ThreadPoolExecutor(len(devices)) as pool:
        return list(pool.map(lambda device: probe(device, baud), devices))


def find(baud: int) -> str:
    """The one port on which an Edgeline answers. Raises DeviceError if there is none, or more than one.

    Only USB ports are asked: the others are rarely connected, and a modem or console there should not be written to.
    """
    candidates = [port.device for port in ports() if port.usb is not None]
    if not candidates:
        raise DeviceError(
            "no USB serial port found: plug the board in, or name a port with -p (a pty, socket://HOST:PORT)"
        )
    hellos = probe_all(candidates, baud)
    answering = [device for device, hello in zip(candidates, hellos, strict=True) if hello is not None]
    if not answering:
        raise DeviceError(
            f"no Edgeline answers on {', '.join(candidates)} at {baud} baud: set -b, or name a port with -p"
        )
    if len(answering) > 1:
        raise DeviceError(f"more than one Edgeline answers: choose one with -p: {', '.join(answering)}")
    return answering[0]


def moved(before: PortInfo) -> str | None:
    """Where a USB device that was unplugged is now: the same port, or another one with the same ids; None: nowhere."""
    now = ports()
    if any(port.device == before.device for port in now):
        return before.device
    return next((port.device for port in now if before.usb is not None and port.usb == before.usb), None)
