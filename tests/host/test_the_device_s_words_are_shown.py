"""What a device says, its fault report among it, is shown by the commands and given to programs, a line each."""

from __future__ import annotations

import time

import edgeline as package
from conftest import Edgeline
from edgeline.codec import Pixels
from edgeline.protocol import Log
from fake_device import FakeDevice, PtyDevice

FAULT = "HardFault: divide by zero, at 00000102, called from 00000251; fake board 0.1.0"


def speaking(texts: list[str]) -> FakeDevice:
    """A device that says this at its first frames."""
    device = FakeDevice()
    render = device.scene
    assert render is not None

    def scene(frame: int) -> Pixels:
        if frame < len(texts):
            device.send(Log(texts[frame]))
        return render(frame)

    device.scene = scene
    return device


def test_the_commands_show_them(edgeline: Edgeline) -> None:
    with PtyDevice(speaking([FAULT, "two\nlines\x1b[2J"])) as served:
        done = edgeline("record", "-p", served.port, "--frames", "4", "-o", "a.png")
    assert done.returncode == 0
    assert done.stderr.splitlines() == [f"device: {FAULT}", "device: two", "device: lines [2J"]


def test_programs_get_them() -> None:
    said: list[str] = []
    with PtyDevice(speaking([FAULT])) as served, package.open(served.port, on_log=said.append) as link:
        deadline = time.monotonic() + 10
        while not said and time.monotonic() < deadline:
            link.next_frame()
    assert said == [FAULT]
