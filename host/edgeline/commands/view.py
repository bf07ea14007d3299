"""`edgeline view`: the window, and what it would prove without one."""

from __future__ import annotations

import argparse
from pathlib import Path

from edgeline.commands.frames import take_frames
from edgeline.commands.options import (
    SubParsers,
    add_command,
    add_controls,
    add_fps,
    add_json,
    add_link,
    add_timeout,
    new_session,
    open_link,
    open_port,
    positive,
    speed,
)
from edgeline.commands.report import print_json
from edgeline.errors import EdgelineError
from edgeline.link import FRAME_TIMEOUT_S
from edgeline.recording import SUFFIX
from edgeline.session import Frame, Session

LARGEST_SCALE = 16


def add_parsers(commands: SubParsers) -> None:
    command = add_command(commands, "view", "a window with the picture, the rates and the renderer's work")
    add_link(command)
    add_fps(command)
    add_controls(command)
    command.add_argument("--frames", type=positive, metavar="N", help="close after N verified frames")
    window = command.add_argument_group("the window")
    window.add_argument("--scale", type=_scale, metavar="N", help="screen pixels per pixel; default: what fits")
    window.add_argument("--full-screen", action="store_true", help="begin so; Escape leaves it")
    window.add_argument(
        "--folder", default=".", metavar="DIR", help="where screenshots and recordings go; default: here"
    )
    window.add_argument("--record", metavar="FILE", help=f"record from the first frame on, *{SUFFIX}")
    window.add_argument(
        "--speed", type=speed, default=1.0, metavar="N", help="play a recording N times as fast as it was made"
    )
    headless = command.add_argument_group("without a window")
    headless.add_argument("--headless", action="store_true", help="verify frames and print statistics instead")
    headless.add_argument("--digests", action="store_true", help="print each frame's number and digest, too")
    add_timeout(headless, FRAME_TIMEOUT_S, "give up after S seconds without a verified frame")
    add_json(headless)
    command.set_defaults(func=_view)


def _view(options: argparse.Namespace) -> int:
    if options.headless:
        return _verify_frames(options)
    for name in ("digests", "json"):
        if getattr(options, name):
            raise EdgelineError(f"view: --{name} goes with --headless")
    try:
        from edgeline import viewer  # noqa: PLC0415 (every other command works without tkinter)
    except ImportError as error:
        raise EdgelineError(
            f"the viewer needs tkinter, which this Python lacks ({error}): install python3-tk, or use --headless"
        ) from None
    viewer.run(
        viewer.Options(
            port=options.port,
            connect=lambda port: open_port(port, options.baud, options.speed),
            new_session=lambda: new_session(options, Session),
            baud=options.baud,
            frames=options.frames,
            scale=options.scale,
            full_screen=options.full_screen,
            folder=Path(options.folder),
            record=options.record,
            scene=options.scene,
            paused=options.pause,
        )
    )
    return 0


def _verify_frames(options: argparse.Namespace) -> int:
    digests: list[str] = []

    def take(frame: Frame) -> None:
        if not options.digests:
            return
        if options.json:
            digests.append(f"{frame.end.digest:08x}")
        else:
            print(f"{frame.number} {frame.end.digest:08x}", flush=True)

    with open_link(options, new_session(options, Session)) as link:
        taken = take_frames(link, take, wanted=options.frames, timeout_s=options.timeout, whole=False)
        counts, quality = link.session.counts, link.quality.words
    if taken.summary is not None and options.json:
        more = {"digests": digests} if options.digests else {}
        print_json({"port": link.transport.name, "quality": quality, **taken.summary.to_json(counts), **more})
    elif taken.frames:
        print(f"{link.transport.name}: {taken.summary}; the link: {quality}")
    return taken.outcome(options.frames, f"; {taken.frames} frames were verified until then")


def _scale(text: str) -> int:
    number = positive(text)
    if number > LARGEST_SCALE:
        raise argparse.ArgumentTypeError(f"'{text}' is no whole number from 1 to {LARGEST_SCALE}")
    return number
