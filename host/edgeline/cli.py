"""The command `edgeline`: the command line, and what an error or an interruption comes to."""

from __future__ import annotations

import argparse
import os
import signal
import sys
import threading
from collections.abc import Callable, Sequence
from typing import NoReturn

from edgeline.budget_command import add_parser as add_budget_parser
from edgeline.commands import bench, ports, record, replay, verify, view
from edgeline.commands.options import EXIT_CODES
from edgeline.commands.report import complain
from edgeline.convert.command import add_parser as add_convert_parser
from edgeline.convert.font_command import add_parser as add_font_parser
from edgeline.convert.image_command import add_parser as add_image_parser
from edgeline.convert.preview import add_parser as add_preview_parser
from edgeline.errors import EdgelineError

PIPE_CLOSED = 141
"""What shells report of a program that writes to a pipe without a reader."""


class _Parser(argparse.ArgumentParser):
    """An argparse parser whose errors are one line."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {message} (see {self.prog} --help)\n")


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs one command; returns the exit code."""
    options = _options(arguments)
    # A recording that is told to end keeps its frames, whoever tells it.
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        run: Callable[[argparse.Namespace], int] = options.func
        code = run(options)
        sys.stdout.flush()
        return code
    except EdgelineError as error:
        complain(str(error))
        return error.exit_code
    except BrokenPipeError:
        # Who read the output has seen enough (`| head`); what is left in the buffer must not be tried again at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return PIPE_CLOSED
    except KeyboardInterrupt:
        return 130


def _options(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser: argparse.ArgumentParser = _Parser(
        prog="edgeline", description="Watch, record and prove what a microcontroller draws.", epilog=EXIT_CODES
    )
    commands = parser.add_subparsers(metavar="COMMAND", dest="command", required=True)
    for module in (ports, view, record, replay, verify):
        module.add_parsers(commands)
    add_convert_parser(commands)
    add_preview_parser(commands)
    add_font_parser(commands)
    add_image_parser(commands)
    add_budget_parser(commands)
    bench.add_parsers(commands)
    options, unknown = parser.parse_known_args(arguments)
    if unknown:
        # argparse would have the command line as a whole complain, whose help does not have the command's options.
        positional = hasattr(options, "port") and not unknown[0].startswith("-")
        hint = "; -p names a port or a recording" if positional else ""
        commands.choices[options.command].error(f"unrecognized arguments: {' '.join(unknown)}{hint}")
    return options
