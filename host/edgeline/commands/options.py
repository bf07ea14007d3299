"""The options that commands share, and the link that they describe."""

from __future__ import annotations

import argparse
import math
import os
from typing import TypeAlias, TypeVar

from edgeline import discovery
from edgeline.commands.report import device_says
from edgeline.link import Link
from edgeline.playback import RecordingTransport
from edgeline.protocol import Control, Mode
from edgeline.recording import is_recording
from edgeline.session import Session
from edgeline.transport import Transport, connect

SubParsers: TypeAlias = "argparse._SubParsersAction[argparse.ArgumentParser]"
Options: TypeAlias = argparse._ActionsContainer
"""a parser, or a group of one"""

EXIT_CODES = """exit codes: 0 done; 1 verify found a difference; 2 bad command line or file; 3 no device: port absent,
busy or forbidden, or nothing there that speaks this wire; 4 the stream failed: link lost, no verified frame in time,
recording damaged; 130 interrupted; 141 nobody reads the output"""

AnySession = TypeVar("AnySession", bound=Session)

DEFAULT_BAUD = 115200
_BAUD_VARIABLE = "EDGELINE_BAUD="


def add_command(commands: SubParsers, name: str, help_text: str) -> argparse.ArgumentParser:
    sentence = f"{help_text[0].upper()}{help_text[1:]}.".replace("%", "%%")
    return commands.add_parser(name, help=help_text, description=sentence, epilog=EXIT_CODES)


def add_port(command: Options) -> None:
    command.add_argument(
        "-p",
        "--port",
        default=os.environ.get("EDGELINE_PORT") or None,
        help="serial port, pty, socket://HOST:PORT, a recording, a captured stream's file, or - for standard input; "
        "default: $EDGELINE_PORT, or else the one USB port on which an Edgeline answers",
    )


def add_baud(command: Options) -> None:
    variable = os.environ.get("EDGELINE_BAUD")
    command.add_argument(
        "-b",
        "--baud",
        type=_baud,
        default=_BAUD_VARIABLE + variable if variable else DEFAULT_BAUD,
        metavar="RATE",
        help=f"at which the port is opened; default: $EDGELINE_BAUD, or else {DEFAULT_BAUD}",
    )


def add_json(command: Options) -> None:
    command.add_argument("--json", action="store_true", help="print the result as JSON")


def add_timeout(command: Options, default_s: float | None, help_text: str) -> None:
    shown = "" if default_s is None else f"; default: {default_s:g}"
    command.add_argument("--timeout", type=seconds, default=default_s, metavar="S", help=help_text + shown)


def add_link(command: Options) -> None:
    """Which device, and how it is spoken to."""
    add_port(command)
    add_baud(command)
    command.add_argument(
        "--fast",
        nargs="?",
        type=positive,
        const=0,
        metavar="RATE",
        help="have the device go on at RATE baud, or at its highest",
    )
    command.add_argument(
        "--mode",
        choices=[mode.name.lower() for mode in Mode],
        default="block",
        help="block (the default): every frame whole, rendering waits for the link; roll: rendering never waits, "
        "frames carry what the link takes",
    )


def add_headless(command: Options) -> None:
    command.add_argument("--headless", action="store_true", help="without a window; this command never opens one")


def add_fps(command: Options) -> None:
    command.add_argument(
        "--fps", type=frame_rate, default=0, metavar="N", help="ask for N frames per second; default: all that it can"
    )


def add_controls(command: Options) -> None:
    command.add_argument("--scene", type=count, metavar="N", help="have the device show its scene number N, from 0")
    command.add_argument("--frame", type=count, metavar="N", help="have it begin at the scene's frame N")
    command.add_argument("--pause", action="store_true", help="have it stay at that frame")


def new_session(options: argparse.Namespace, kind: type[AnySession]) -> AnySession:
    """A session of this kind as the command line wants it, with what `add_fps` and `add_controls` ask for, if the
    command has them."""
    given = vars(options)
    session = kind(fps=given.get("fps", 0), mode=Mode[options.mode.upper()], fast=options.fast)
    if "pause" in given:
        # PAUSE first: a frame that is played before it arrives would move on from the one that is asked for.
        wishes = (
            (Control.PAUSE, options.pause or None),
            (Control.SCENE, options.scene),
            (Control.FRAME, options.frame),
        )
        for control, value in wishes:
            if value is not None:
                session.input(control, int(value))
    return session


def open_port(port: str, baud: int, speed: float | None = None) -> Transport:
    """The port, or the recording, which is played `speed` times as fast as it was made, None: at once."""
    return RecordingTransport(port, speed) if speed is not None and is_recording(port) else connect(port, baud)


def open_transport(options: argparse.Namespace) -> Transport:
    return open_port(options.port or discovery.find(options.baud), options.baud)


def open_link(options: argparse.Namespace, session: Session) -> Link:
    return Link(open_transport(options), session, device_says)


def positive(text: str) -> int:
    return _whole(text, 1, 0x7FFFFFFF, "above 0")


def count(text: str) -> int:
    return _whole(text, 0, 0x7FFFFFFF, "from 0 to 2147483647")


def frame_rate(text: str) -> int:
    return _whole(text, 0, 65535, "from 0 to 65535")


def seconds(text: str) -> float:
    return _number(text, 0.0, 1e6, "number of seconds above 0")


def instant(text: str) -> float:
    """A time within a recording."""
    return 0.0 if text.strip("0.") == "" and "0" in text else _number(text, 0.0, 1e9, "number of seconds, 0 or more")


def speed(text: str) -> float:
    return _number(text, 0.0, 1e6, "factor above 0")


def _baud(text: str) -> int:
    try:
        return positive(text.removeprefix(_BAUD_VARIABLE))
    except argparse.ArgumentTypeError:
        raise argparse.ArgumentTypeError(f"'{text}' is no whole number above 0") from None


def _whole(text: str, least: int, most: int, range_text: str) -> int:
    if not text.isascii() or not text.isdigit() or len(text) > 10 or not least <= int(text) <= most:
        raise argparse.ArgumentTypeError(f"'{text}' is no whole number {range_text}")
    return int(text)


def _number(text: str, above: float, below: float, what: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not above < value < below:
        raise argparse.ArgumentTypeError(f"'{text}' is no {what}")
    return value
