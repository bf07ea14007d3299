"""`edgeline bench`: what a link carries; and, with --plot, the charts of what the renderer's steps cost."""

from __future__ import annotations

import argparse

from edgeline import bench_plot, chart, stage_plot
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
    open_transport,
    positive,
)
from edgeline.commands.report import device_says, print_json, printable
from edgeline.errors import EdgelineError
from edgeline.link import FRAME_TIMEOUT_S, Link
from edgeline.measure import TimedSession, can_measure_latency, latencies, measure

FRAMES = 100
TRIALS = 10


def add_parsers(commands: SubParsers) -> None:
    command = add_command(commands, "bench", "a link's frames and bytes per second, latency, the host's time to decode")
    add_link(command)
    add_fps(command)
    add_controls(command)
    command.add_argument(
        "--frames", type=positive, default=FRAMES, metavar="N", help=f"measure N frames; default: {FRAMES}"
    )
    add_timeout(command, FRAME_TIMEOUT_S, "give up after S seconds without a verified frame")
    add_json(command)
    add_headless(command)
    plot = command.add_argument_group("a chart of run time instead, against error or by stage")
    plot.add_argument(
        "--plot", metavar="IN.json", help="what tests/bench/run --all wrote: accuracy_cost or scenes.json"
    )
    plot.add_argument("-o", "--output", metavar="OUT.png", help="default: bench.png")
    command.set_defaults(func=_bench)


def _bench(options: argparse.Namespace) -> int:
    if options.plot is not None:
        output = options.output or "bench.png"
        content = chart.load(options.plot)
        if "frames" in content:
            stage_plot.draw(stage_plot.check(options.plot, content), output)
        elif "groups" in content:
            bench_plot.draw(bench_plot.check(options.plot, content), output)
        else:
            raise EdgelineError(f"{options.plot} holds no groups; tests/bench/run --all writes a file that does")
        print(output)
        return 0
    if options.output is not None:
        raise EdgelineError("bench: --output goes with --plot")
    session = new_session(options, TimedSession)
    with Link(open_transport(options), session, device_says) as link:
        measured = measure(link, session, options.frames, options.timeout)
        if can_measure_latency(link):
            measured.latencies_s = latencies(link, TRIALS, options.pause, options.timeout)
        has_rate = link.hello.highest_baud and not link.transport.one_way
        figures = measured.to_json(session.rate if has_rate else 0)
    facts = {"port": link.transport.name, "target": link.hello.target, "firmware": link.hello.firmware}
    if options.json:
        print_json({**facts, **figures})
        return 0
    for name, value in {**facts, **figures}.items():
        print(f"{name.replace('_', ' '):30} {_words(value)}")
    return 0


def _words(value: object) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{name} {number}" for name, number in value.items())
    return "-" if value is None else printable(str(value))
