"""The command `edgeline`.

Results go to standard output, progress and errors to standard error, progress only if that is a terminal. Exit codes:
0 done, 2 a bad command line or file, 3 no device (port absent, busy or forbidden, or nothing there that speaks this
wire), 4 the stream failed (link lost, no verified frame in time), 130 interrupted.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import sys
import threading
from collections.abc import Callable, Sequence
from dataclasses import asdict
from typing import NoReturn

from edgeline import bench_plot, discovery
from edgeline.budget_command import add_parser as add_budget_parser
from edgeline.convert.command import add_parser as add_convert_parser
from edgeline.errors import EdgelineError, StreamEndError
from edgeline.link import FRAME_TIMEOUT_S, HELLO_TIMEOUT_S, Link
from edgeline.protocol import Capability, Control, Hello
from edgeline.recorder import check_writable, recorder, save_png
from edgeline.session import Session
from edgeline.summary import Summary
from edgeline.transport import connect

EXIT_CODES = """exit codes: 0 done; 2 bad command line or file; 3 no device: port absent, busy or forbidden, or nothing
there that speaks this wire; 4 the stream failed: link lost, no verified frame in time; 130 interrupted"""


class _Parser(argparse.ArgumentParser):
    """An argparse parser whose errors are one line."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {message} (see {self.prog} --help)\n")


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs one command; returns the exit code."""
    options = _parser().parse_args(arguments)
    # A recording that is told to end keeps its frames, whoever tells it.
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        run: Callable[[argparse.Namespace], int] = options.func
        return run(options)
    except EdgelineError as error:
        print(f"edgeline: {error}", file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt:
        return 130


def _parser() -> argparse.ArgumentParser:
    parser: argparse.ArgumentParser = _Parser(
        prog="edgeline", description="Watch, record and prove what a microcontroller draws.", epilog=EXIT_CODES
    )
    commands = parser.add_subparsers(metavar="COMMAND", required=True)

    command = commands.add_parser("list", help="serial ports", epilog=EXIT_CODES)
    command.add_argument("--probe", action="store_true", help="ask each USB port whether an Edgeline is there")
    _add_baud(command)
    _add_json(command)
    command.set_defaults(func=_list)

    command = commands.add_parser("info", help="what a device says of itself", epilog=EXIT_CODES)
    _add_link(command, HELLO_TIMEOUT_S, "wait at most S seconds for its answer")
    _add_json(command)
    command.set_defaults(func=_info)

    command = commands.add_parser("view", help="a window with the picture, the rates and the renderer's work")
    _add_link(command, None, "")
    _add_fps(command)
    _add_controls(command)
    command.add_argument("--frames", type=_positive, metavar="N", help="close after N verified frames")
    command.set_defaults(func=_view)

    command = commands.add_parser("shot", help="one verified frame as PNG", epilog=EXIT_CODES)
    _add_link(command, FRAME_TIMEOUT_S, "give up after S seconds without a verified frame")
    _add_controls(command)
    _add_json(command)
    command.add_argument("-o", "--output", default="shot.png", metavar="FILE", help="default: shot.png")
    command.set_defaults(func=_shot)

    command = commands.add_parser("record", help="verified frames as GIF, animated PNG or PNGs", epilog=EXIT_CODES)
    _add_link(command, FRAME_TIMEOUT_S, "give up after S seconds without a verified frame")
    _add_fps(command)
    _add_controls(command)
    _add_json(command)
    command.add_argument(
        "-o",
        "--output",
        required=True,
        metavar="FILE",
        help="*.gif, *.png (animated, lossless), or a sequence such as frames/%%04d.png",
    )
    command.add_argument("--frames", type=_positive, metavar="N", help="stop after N; without it, at Ctrl+C")
    command.set_defaults(func=_record)

    add_convert_parser(commands)
    add_budget_parser(commands)

    command = commands.add_parser("bench", help="a chart of run time against error", epilog=EXIT_CODES)
    command.add_argument(
        "--plot", required=True, metavar="IN.json", help="what tests/bench/run --all wrote: accuracy_cost.json"
    )
    command.add_argument("-o", "--output", default="bench.png", metavar="OUT.png", help="default: bench.png")
    command.set_defaults(func=_bench)
    return parser


def _add_baud(command: argparse.ArgumentParser) -> None:
    command.add_argument("-b", "--baud", type=_positive, default=115200, metavar="RATE", help="default: 115200")


def _add_json(command: argparse.ArgumentParser) -> None:
    command.add_argument("--json", action="store_true", help="print the result as JSON")


def _add_fps(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--fps", type=_frame_rate, default=0, metavar="N", help="ask for N frames per second; default: all that it can"
    )


def _add_controls(command: argparse.ArgumentParser) -> None:
    command.add_argument("--scene", type=_count, metavar="N", help="have the device show its scene number N, from 0")
    command.add_argument("--frame", type=_count, metavar="N", help="have it begin at the scene's frame N")
    command.add_argument("--pause", action="store_true", help="have it stay at that frame")


def _add_link(command: argparse.ArgumentParser, timeout_s: float | None, timeout_help: str) -> None:
    command.add_argument(
        "-p",
        "--port",
        default=os.environ.get("EDGELINE_PORT") or None,
        help="serial port, pty, socket://HOST:PORT, a captured stream's file, or - for standard input; "
        "default: $EDGELINE_PORT, or else the one USB port on which an Edgeline answers",
    )
    _add_baud(command)
    if timeout_s is not None:
        command.add_argument(
            "--timeout", type=_seconds, default=timeout_s, metavar="S", help=f"{timeout_help}; default: {timeout_s:g}"
        )


def _positive(text: str) -> int:
    if not text.isascii() or not text.isdigit() or int(text) == 0:
        raise argparse.ArgumentTypeError(f"'{text}' is no whole number above 0")
    return int(text)


def _count(text: str) -> int:
    if not text.isascii() or not text.isdigit() or int(text) > 0x7FFFFFFF:
        raise argparse.ArgumentTypeError(f"'{text}' is no whole number from 0 to 2147483647")
    return int(text)


def _frame_rate(text: str) -> int:
    if not text.isascii() or not text.isdigit() or int(text) > 65535:
        raise argparse.ArgumentTypeError(f"'{text}' is no whole number from 0 to 65535")
    return int(text)


def _seconds(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0 < value < 1e6:
        raise argparse.ArgumentTypeError(f"'{text}' is no number of seconds above 0")
    return value


def _session(options: argparse.Namespace, fps: int = 0) -> Session:
    """A session that sets the controls of the command line."""
    session = Session(fps=fps)
    # PAUSE first: a frame that is played before it arrives would move on from the one that is asked for.
    wishes = ((Control.PAUSE, options.pause or None), (Control.SCENE, options.scene), (Control.FRAME, options.frame))
    for control, value in wishes:
        if value is not None:
            session.input(control, int(value))
    return session


def _open(options: argparse.Namespace, session: Session) -> Link:
    return Link(connect(options.port or discovery.find(options.baud), options.baud), session, _device_says)


def _list(options: argparse.Namespace) -> int:
    ports = discovery.ports()
    asked = [port.device for port in ports if port.usb is not None] if options.probe else []
    hellos = dict(zip(asked, discovery.probe_all(asked, options.baud), strict=True))
    if options.json:
        rows = []
        for port in ports:
            hello = hellos.get(port.device)
            row: dict[str, object] = {"port": port.device, "description": port.description, "usb": port.usb}
            rows.append({**row, "hello": _hello_json(hello) if hello else None} if options.probe else row)
        print(json.dumps(rows, indent=2))
        return 0
    for port in ports:
        hello = hellos.get(port.device)
        usb = f"{port.usb[0]:04x}:{port.usb[1]:04x}" if port.usb else ""
        found = f"{hello.target}, {hello.firmware}" if hello else ""
        print("  ".join(part for part in (f"{port.device:20}", f"{usb:9}", port.description, found)).rstrip())
    if not ports:
        print("no serial ports", file=sys.stderr)
    return 0


def _info(options: argparse.Namespace) -> int:
    with _open(options, Session(autostart=False)) as link:
        hello = link.wait_hello(options.timeout)
    if options.json:
        print(json.dumps(_hello_json(hello), indent=2))
        return 0
    facts = {
        "port": link.transport.name,
        "target": hello.target,
        "firmware": hello.firmware,
        "picture": f"{hello.width} x {hello.height} RGB565",
        "wire": f"1.{hello.minor}, packets of at most {hello.largest_packet} bytes",
        "can do": ", ".join(_capability_names(hello)),
        "highest baud": str(hello.highest_baud) if hello.highest_baud else "none: the link has no baud rate",
        "boot id": f"{hello.boot_id:08x}",
    }
    for name, value in facts.items():
        print(f"{name:13} {value}")
    return 0


def _capability_names(hello: Hello) -> list[str]:
    names = {
        Capability.RAW: "raw bands",
        Capability.RUNS: "run-length bands",
        Capability.SPLIT: "split-stream bands",
        Capability.SKIPS_LINES: "leaves out unchanged lines",
        Capability.INPUT: "takes input",
    }
    return [name for bit, name in names.items() if bit in hello.capabilities]


def _hello_json(hello: Hello) -> dict[str, object]:
    return {**asdict(hello), "capabilities": _capability_names(hello)}


def _view(options: argparse.Namespace) -> int:
    try:
        from edgeline import viewer  # noqa: PLC0415 (every other command works without tkinter)
    except ImportError as error:
        raise EdgelineError(
            f"the viewer needs tkinter, which this Python lacks ({error}): install python3-tk"
        ) from None
    port = options.port or discovery.find(options.baud)
    viewer.run(connect(port, options.baud), options.baud, lambda: _session(options, options.fps), options.frames)
    return 0


def _shot(options: argparse.Namespace) -> int:
    check_writable(options.output)
    if not options.output.lower().endswith(".png"):
        raise EdgelineError(f"{options.output}: a shot is a PNG file; name it so")
    with _open(options, _session(options)) as link:
        frame = link.next_frame(options.timeout)
        save_png(options.output, frame.picture)
        summary = Summary(link.hello)
        summary.add(frame)
    if options.json:
        print(json.dumps({"output": options.output, **summary.to_json(link.session.counts)}, indent=2))
    else:
        print(f"{options.output}: frame {frame.number}, digest {frame.end.digest:08x} verified")
    return 0


def _record(options: argparse.Namespace) -> int:
    writer = recorder(options.output)
    failure: EdgelineError | None = None
    try:
        with _open(options, _session(options, options.fps)) as link:
            summary = Summary(link.wait_hello(min(options.timeout, HELLO_TIMEOUT_S)))
            while options.frames is None or summary.frames < options.frames:
                try:
                    frame = link.next_frame(options.timeout)
                except EdgelineError as error:
                    failure = error
                    break
                except KeyboardInterrupt:
                    break
                writer.add(frame.picture, frame.end.time_us)
                summary.add(frame)
                _progress(f"{summary.frames} frames, {summary.frames_per_second or 0:.1f} frames/s")
        writer.finish()
    finally:
        writer.discard()
        _progress("")
    if options.json:
        print(json.dumps({"output": options.output, **summary.to_json(link.session.counts)}, indent=2))
    elif summary.frames:
        print(f"{options.output}: {summary}")
    ended_as_it_should = isinstance(failure, StreamEndError) and options.frames is None and summary.frames > 0
    if failure is not None and not ended_as_it_should:
        kept = f"; the {summary.frames} frames until then are in {options.output}" if summary.frames else ""
        print(f"edgeline: {failure}{kept}", file=sys.stderr)
        return failure.exit_code
    return 0


def _bench(options: argparse.Namespace) -> int:
    bench_plot.draw(bench_plot.load(options.plot), options.output)
    print(options.output)
    return 0


def _device_says(text: str) -> None:
    _progress("")
    for line in text.splitlines():
        print(f"device: {''.join(c if c.isprintable() else ' ' for c in line)}", file=sys.stderr)


def _progress(text: str) -> None:
    if sys.stderr.isatty():
        print(f"\r\x1b[K{text}", end="", file=sys.stderr, flush=True)
