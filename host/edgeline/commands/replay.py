"""`edgeline replay` and `cut`: a recording as a device that any program can connect to, and a part of a recording."""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Iterator

from edgeline.commands.options import (
    SubParsers,
    add_command,
    add_headless,
    add_json,
    add_timeout,
    count,
    instant,
    positive,
    speed,
)
from edgeline.commands.report import complain, print_json
from edgeline.cut import cut
from edgeline.errors import EdgelineError, StreamEndError
from edgeline.follow import Step, follow
from edgeline.outfile import AtomicFile, cannot_write
from edgeline.playback import RecordingTransport
from edgeline.player import Player
from edgeline.recording import SUFFIX, opened
from edgeline.serve import PtyPort, TcpPort, serve


def add_parsers(commands: SubParsers) -> None:
    command = add_command(commands, "replay", "a recording as a device, on a pty or a TCP port")
    command.add_argument("recording", metavar="FILE", help=f"a recording, *{SUFFIX}")
    link = command.add_mutually_exclusive_group()
    link.add_argument("--pty", action="store_true", help="on a pseudo terminal, whose name is printed; the default")
    link.add_argument("--tcp", type=_tcp_port, metavar="PORT", help="on a TCP port of this machine; 0: a free one")
    link.add_argument("--stdout", action="store_true", help="the device's bytes alone, one way")
    pace = command.add_mutually_exclusive_group()
    pace.add_argument("--speed", type=speed, default=1.0, metavar="N", help="N times as fast as it was recorded")
    pace.add_argument("--as-fast", action="store_true", help="as fast as the host takes it")
    command.add_argument("--loop", action="store_true", help="again and again, until Ctrl+C")
    command.add_argument("--frames", type=positive, metavar="N", help="end after N frames")
    add_timeout(command, None, "wait at most S seconds for a host; default: for ever")
    add_json(command)
    add_headless(command)
    command.set_defaults(func=_replay)

    command = add_command(commands, "cut", "a part of a recording, which stands by itself")
    command.add_argument("recording", metavar="FILE", help=f"a recording, *{SUFFIX}")
    command.add_argument("--from", dest="begin", type=instant, default=0.0, metavar="S", help="default: the beginning")
    command.add_argument("--to", dest="end", type=instant, metavar="S", help="default: the end")
    command.add_argument("-o", "--output", required=True, metavar="FILE", help=f"*{SUFFIX}")
    add_json(command)
    command.set_defaults(func=_cut)


def _replay(options: argparse.Namespace) -> int:
    pace = None if options.as_fast else options.speed
    if options.stdout:
        return _pour(options, pace)
    player = Player(lambda: _steps(options.recording), pace, loop=options.loop, most=options.frames)
    with TcpPort(options.tcp) if options.tcp is not None else PtyPort() as port:
        _say(options, {"port": port.name}, port.said)
        serve(player, port, options.timeout)
    _say(options, {"frames": player.frames}, f"{options.recording}: {player.frames} frames played")
    if player.damage is not None:
        complain(str(player.damage))
        return player.damage.exit_code
    return 0


def _say(options: argparse.Namespace, facts: dict[str, object], words: str) -> None:
    print(json.dumps(facts) if options.json else words, flush=True)


def _steps(path: str) -> Iterator[Step]:
    with opened(path) as reader:
        yield from follow(reader)


def _pour(options: argparse.Namespace, pace: float | None) -> int:
    """The device's bytes to standard output, until its reader has enough."""
    if options.frames is not None or options.loop or options.json:
        raise EdgelineError("replay: --stdout takes neither --frames, --loop nor --json")
    transport = RecordingTransport(options.recording, pace)
    try:
        while True:
            sys.stdout.buffer.write(transport.read())
            sys.stdout.buffer.flush()
    except StreamEndError:
        return 0
    except BrokenPipeError:
        # Nothing is left to be flushed at the program's end.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    finally:
        transport.close()


def _cut(options: argparse.Namespace) -> int:
    begin_us = round(options.begin * 1e6)
    end_us = None if options.end is None else round(options.end * 1e6)
    if end_us is not None and end_us <= begin_us:
        raise EdgelineError(f"cut: --to {options.end:g} is not after --from {options.begin:g}")
    if not options.output.lower().endswith(SUFFIX):
        raise EdgelineError(
            f"{options.output}: a cut is a recording: name it *{SUFFIX}; `edgeline export` makes others"
        )
    file = AtomicFile(options.output)
    try:
        with opened(options.recording) as reader:
            part = cut(reader, file.stream, begin_us, end_us)
        file.commit()
    except OSError as error:
        raise cannot_write(options.output, error) from None
    finally:
        file.discard()
    if options.json:
        facts = {"frames": part.frames, "first_s": part.first_s, "last_s": part.last_s}
        print_json({"output": options.output, **facts})
    else:
        print(f"{options.output}: {part.frames} frames, from {part.first_s:.3f} s to {part.last_s:.3f} s")
    if part.damage is not None:
        complain(str(part.damage))
        return part.damage.exit_code
    return 0


def _tcp_port(text: str) -> int:
    number = count(text)
    if number > 65535:
        raise argparse.ArgumentTypeError(f"'{text}' is no TCP port, 0 to 65535")
    return number
