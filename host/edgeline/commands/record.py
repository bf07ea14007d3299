"""`edgeline record`, `export`, `shot`: verified frames to files, or the wire itself."""

from __future__ import annotations

import argparse
from collections.abc import Callable

from edgeline.commands.frames import Taken, take_frames
from edgeline.commands.options import (
    SubParsers,
    add_command,
    add_controls,
    add_fps,
    add_headless,
    add_json,
    add_link,
    add_timeout,
    new_session,
    open_link,
    open_transport,
    positive,
)
from edgeline.commands.report import device_says, print_json
from edgeline.errors import EdgelineError
from edgeline.link import FRAME_TIMEOUT_S, Link
from edgeline.outfile import check_writable
from edgeline.playback import RecordingTransport
from edgeline.recorder import KINDS, recorder, save_png
from edgeline.recording import SUFFIX, is_recording
from edgeline.session import Counts, Frame, Session
from edgeline.tap import Tap

_GIVE_UP = "give up after S seconds without a verified frame"


def add_parsers(commands: SubParsers) -> None:
    command = add_command(commands, "record", "the wire's bytes, or verified frames as GIF, APNG, PNGs or MP4")
    add_link(command)
    add_fps(command)
    add_controls(command)
    _add_output(command, f"*{SUFFIX} (the wire, with times: for replay, cut, export), {KINDS}")
    command.set_defaults(func=_record)

    command = add_command(commands, "export", "a recording's verified frames as GIF, APNG, PNGs or MP4")
    command.add_argument("recording", metavar="FILE", help=f"a recording, *{SUFFIX}")
    _add_output(command, KINDS)
    command.set_defaults(func=_export)

    command = add_command(commands, "shot", "one verified frame as PNG")
    add_link(command)
    add_controls(command)
    add_timeout(command, FRAME_TIMEOUT_S, _GIVE_UP)
    command.add_argument("-o", "--output", default="shot.png", metavar="FILE", help="default: shot.png")
    command.add_argument("--frames", type=positive, default=1, metavar="N", help="the N-th frame; default: 1")
    add_json(command)
    add_headless(command)
    command.set_defaults(func=_shot)


def _add_output(command: argparse.ArgumentParser, kinds: str) -> None:
    command.add_argument("-o", "--output", required=True, metavar="FILE", help=kinds.replace("%", "%%"))
    command.add_argument("--frames", type=positive, metavar="N", help="stop after N; without it, at the end or Ctrl+C")
    add_timeout(command, FRAME_TIMEOUT_S, _GIVE_UP)
    add_json(command)
    add_headless(command)


def _record(options: argparse.Namespace) -> int:
    if options.output.lower().endswith(SUFFIX):
        return _record_wire(options)
    return _record_frames(options, lambda: open_link(options, new_session(options, Session)))


def _export(options: argparse.Namespace) -> int:
    if options.output.lower().endswith(SUFFIX):
        raise EdgelineError(f"{options.output}: `edgeline cut` makes a recording of a recording; export makes {KINDS}")
    return _record_frames(options, lambda: Link(RecordingTransport(options.recording), Session(), device_says))


def _record_frames(options: argparse.Namespace, open_frames: Callable[[], Link]) -> int:
    writer = recorder(options.output)
    try:
        with open_frames() as link:
            taken = take_frames(
                link,
                lambda frame: writer.add(frame.picture, frame.end.time_us),
                wanted=options.frames,
                timeout_s=options.timeout,
            )
            counts = link.session.counts
        writer.finish()
    finally:
        writer.discard()
    return _tell(options, taken, counts, {})


def _record_wire(options: argparse.Namespace) -> int:
    if options.port and is_recording(options.port):
        raise EdgelineError(f"{options.port}: is a recording already: `edgeline cut` makes another one of it")
    check_writable(options.output)
    tap = Tap(open_transport(options), packetwise=True)

    def check(_: Frame) -> None:
        if tap.failure is not None:
            raise tap.failure

    try:
        tap.start(options.output, at_next_frame=False)
        with Link(tap, new_session(options, Session), device_says) as link:
            taken = take_frames(link, check, wanted=options.frames, timeout_s=options.timeout, whole=False)
            counts = link.session.counts
    finally:
        tap.close()
        recorded = tap.stop()
    return _tell(
        options, taken, counts, {} if recorded is None else {"received": recorded.received, "sent": recorded.sent}
    )


def _shot(options: argparse.Namespace) -> int:
    check_writable(options.output)
    if not options.output.lower().endswith(".png"):
        raise EdgelineError(f"{options.output}: a shot is a PNG file; name it so")
    last: list[Frame] = []
    with open_link(options, new_session(options, Session)) as link:

        def keep(frame: Frame) -> None:
            last[:] = [frame]

        taken = take_frames(link, keep, wanted=options.frames, timeout_s=options.timeout)
        counts = link.session.counts
    if taken.frames < options.frames:
        return taken.outcome(options.frames, "")
    (frame,) = last
    save_png(options.output, frame.picture)
    if options.json:
        return _tell(options, taken, counts, {"number": frame.number, "digest": f"{frame.end.digest:08x}"})
    print(f"{options.output}: frame {frame.number}, digest {frame.end.digest:08x} verified")
    return 0


def _tell(options: argparse.Namespace, taken: Taken, counts: Counts, more: dict[str, object]) -> int:
    """The result on standard output, the failure on standard error; returns the exit code."""
    if taken.summary is not None and options.json:
        print_json({"output": options.output, **more, **taken.summary.to_json(counts)})
    elif taken.frames:
        print(f"{options.output}: {taken.summary}")
    return taken.outcome(options.frames, f"; the {taken.frames} frames until then are in {options.output}")
