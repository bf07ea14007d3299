"""`edgeline list` and `info`: which ports there are, and what a device says of itself."""

from __future__ import annotations

import argparse
import sys
from dataclasses import asdict
from datetime import datetime, timedelta, timezone

from edgeline import discovery
from edgeline.commands.options import (
    SubParsers,
    add_baud,
    add_command,
    add_headless,
    add_json,
    add_link,
    add_timeout,
    new_session,
    open_link,
)
from edgeline.commands.report import complain, print_json, printable
from edgeline.errors import StreamError
from edgeline.follow import follow
from edgeline.link import HELLO_TIMEOUT_S
from edgeline.protocol import Capability, Control, DebugView, Hello
from edgeline.recording import DamagedRecordingError, Direction, is_recording, opened
from edgeline.session import Session

_CAPABILITIES = {
    Capability.RAW: "raw bands",
    Capability.RUNS: "run-length bands",
    Capability.SPLIT: "split-stream bands",
    Capability.SKIPS_LINES: "leaves out unchanged lines",
    Capability.INPUT: "takes input",
    Capability.ROLL: "mode roll",
    Capability.SET_BAUD: "changes its rate",
}


def add_parsers(commands: SubParsers) -> None:
    command = add_command(commands, "list", "serial ports")
    command.add_argument("--probe", action="store_true", help="ask each USB port whether an Edgeline is there")
    add_baud(command)
    add_timeout(command, discovery.PROBE_TIMEOUT_S, "wait at most S seconds for each answer")
    add_json(command)
    command.set_defaults(func=_list)

    command = add_command(commands, "info", "what a device says of itself, or what a recording holds")
    add_link(command)
    add_timeout(command, HELLO_TIMEOUT_S, "wait at most S seconds for its answer")
    add_json(command)
    add_headless(command)
    command.set_defaults(func=_info)


def hello_json(hello: Hello) -> dict[str, object]:
    """HELLO with words for its bits."""
    return {
        **asdict(hello),
        "capabilities": _capabilities(hello),
        "controls": _controls(hello),
        "views": _views(hello),
    }


def _list(options: argparse.Namespace) -> int:
    ports = discovery.ports()
    asked = [port.device for port in ports if port.usb is not None] if options.probe else []
    hellos = dict(zip(asked, discovery.probe_all(asked, options.baud, options.timeout), strict=True))
    if options.json:
        rows = []
        for port in ports:
            hello = hellos.get(port.device)
            row: dict[str, object] = {"port": port.device, "description": port.description, "usb": port.usb}
            rows.append({**row, "hello": hello_json(hello) if hello else None} if options.probe else row)
        print_json(rows)
        return 0
    for port in ports:
        hello = hellos.get(port.device)
        usb = f"{port.usb[0]:04x}:{port.usb[1]:04x}" if port.usb else ""
        found = f"{hello.target}, {hello.firmware}" if hello else ""
        print(
            printable("  ".join(part for part in (f"{port.device:20}", f"{usb:9}", port.description, found))).rstrip()
        )
    if not ports:
        print("no serial ports", file=sys.stderr)
    return 0


def _info(options: argparse.Namespace) -> int:
    if options.port and is_recording(options.port):
        return _recording_info(options)
    session = new_session(options, Session)
    session.autostart = False
    with open_link(options, session) as link:
        hello = link.wait_hello(options.timeout)
        name = link.transport.name
    if options.json:
        print_json(hello_json(hello))
    else:
        _table({"port": name, **_facts(hello)})
    return 0


def _recording_info(options: argparse.Namespace) -> int:
    sizes = dict.fromkeys(Direction, 0)
    hello: Hello | None = None
    damage: DamagedRecordingError | None = None
    frames, end_us = 0, 0
    with opened(options.port) as reader:
        try:
            for step in follow(reader):
                sizes[step.piece.direction] += len(step.piece.data)
                end_us, hello = step.piece.time_us, step.hello or hello
                frames += step.frame is not None
        except DamagedRecordingError as error:
            damage = error
    if hello is None:
        raise damage or StreamError(f"{options.port}: the recording holds no HELLO")
    start = datetime(1970, 1, 1, tzinfo=timezone.utc) + timedelta(microseconds=reader.header.start_us)
    held = {
        "recorded_from": reader.header.port,
        "start": start.isoformat(timespec="milliseconds"),
        "seconds": round(end_us / 1e6, 6),
        "frames": frames,
        "received": sizes[Direction.FROM_DEVICE],
        "sent": sizes[Direction.TO_DEVICE],
    }
    if options.json:
        print_json({**hello_json(hello), "recording": held})
    else:
        words = {
            "recording": options.port,
            "made of": f"{reader.header.port}, {held['start']}",
            "length": f"{held['seconds']} s, {frames} verified frames",
            "bytes": f"{held['received']} from the device, {held['sent']} to it",
        }
        _table({**words, **_facts(hello)})
    if damage is not None:
        complain(str(damage))
        return damage.exit_code
    return 0


def _facts(hello: Hello) -> dict[str, str]:
    facts = {
        "target": hello.target,
        "firmware": hello.firmware,
        "picture": f"{hello.width} x {hello.height} RGB565",
        "wire": f"1.{hello.minor}, packets of at most {hello.largest_packet} bytes",
        "can do": ", ".join(_capabilities(hello)),
        "controls": ", ".join(_controls(hello)) or "none",
        "highest baud": str(hello.highest_baud) if hello.highest_baud else "none: the link has no baud rate",
        "boot id": f"{hello.boot_id:08x}",
    }
    if hello.scenes:
        facts["scenes"] = str(hello.scenes)
    if hello.views:
        facts["views"] = ", ".join(_views(hello))
    return facts


def _table(facts: dict[str, str]) -> None:
    for name, value in facts.items():
        print(f"{name:13} {printable(value)}")


def _capabilities(hello: Hello) -> list[str]:
    return [name for bit, name in _CAPABILITIES.items() if bit in hello.capabilities]


def _controls(hello: Hello) -> list[str]:
    return [control.name.lower() for control in Control if hello.knows(control)]


def _views(hello: Hello) -> list[str]:
    return [view.name.lower() for view in DebugView if hello.has_view(view)]
