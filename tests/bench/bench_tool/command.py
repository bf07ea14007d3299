"""The command line of tests/bench/run."""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from . import codec, compare, frames, size, workers
from .machines import (
    BENCH,
    CORES,
    ROOT,
    BenchError,
    Machines,
    MissingToolError,
    check_tools,
    compiler_version,
    qemu_version,
)

RESULTS = BENCH / "results"
CODEC = RESULTS / "codec.json"
STATUS_SKIPPED = 77


def main(arguments: Sequence[str] | None = None) -> int:
    """Status 0: all checks passed; 1: one failed; 2: could not measure; 77: a tool is not installed."""
    parser = argparse.ArgumentParser(prog="tests/bench/run", description="Run time against error.")
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument(
        "--quick",
        action="store_true",
        help="check pictures against the simulator and counts against the results",
    )
    what.add_argument("--scenes", action="store_true", help="print the frames' instruction counts")
    what.add_argument("--profile", metavar="SCENE", help="print which functions a scene's instructions go to")
    what.add_argument("--alternatives", action="store_true", help="print cost and error of the alternatives")
    what.add_argument("--size", action="store_true", help="print bytes of code, check them against budgets and results")
    what.add_argument("--record-size", action="store_true", help="measure bytes of code, write tests/bench/results")
    what.add_argument("--codec", action="store_true", help="print the stream codec's bytes, cost and speed, check them")
    what.add_argument("--record-codec", action="store_true", help="measure the codec, write tests/bench/results")
    what.add_argument("--workers", action="store_true", help="print what two cores gain over one, here as threads")
    what.add_argument("--all", action="store_true", help="measure everything, write tests/bench/results and the chart")
    parser.add_argument("--build", type=Path, default=ROOT / "build" / "bench", metavar="DIR", help="where to build")
    options = parser.parse_args(arguments)
    verdicts = frames.Verdicts()
    try:
        check_tools()
        _run(options, Machines(options.build.resolve()), verdicts)
    except MissingToolError as error:
        print(f"bench: skipped, {error}")
        return STATUS_SKIPPED
    except BenchError as error:
        print(f"bench: {error}", file=sys.stderr)
        return 2
    if options.profile is None:
        print(f"{verdicts.passed} passed, {verdicts.failed} failed, 0 skipped")
    return 1 if verdicts.failed else 0


def _run(options: argparse.Namespace, machines: Machines, verdicts: frames.Verdicts) -> None:
    if options.quick:
        found = frames.measure(machines, verdicts)
        recorded = read_recorded(RESULTS / "scenes.json")
        if recorded["compiler"] == compiler_version():
            frames.compare_with_recorded(found, recorded, verdicts)
            codec.compare_with_recorded(codec.encode(machines, verdicts), read_recorded(CODEC), verdicts)
        else:
            print(f"counts not compared: recorded with gcc {recorded['compiler']}, this is {compiler_version()}")
    if options.quick or options.size:
        sizes = size.measure()
        size.check(sizes, read_recorded(size.RESULT), verdicts)
        if options.size:
            print(size.table(sizes))
    if options.record_size or options.all:
        size.record(size.measure())
    if options.scenes or options.all:
        found = frames.measure(machines, verdicts)
        for bits in (6, 8):
            # How bits and the texture's bound act together is of no interest.
            found += [one for one in frames.measure(machines, verdicts, bits) if one.uv_error_log2 == 3]
        print(frames.table(found))
        if options.all:
            _write_json(RESULTS / "scenes.json", {"frames": frames.rows(found)})
    if options.workers:
        print(workers.table(workers.measure(machines)))
    if options.profile is not None:
        for core in CORES:
            _print_profile(core, machines.profile(core, options.profile))
    if options.codec or options.record_codec or options.all:
        streams = codec.measure(machines, verdicts)
        print(codec.table(streams))
        if options.codec:
            codec.compare_with_recorded(streams, read_recorded(CODEC), verdicts)
        else:
            _write_json(CODEC, {"sequences": codec.rows(streams)}, "tests/bench/run --record-codec")
    if options.alternatives or options.all:
        groups = compare.measure(machines, verdicts)
        print(compare.table(groups))
        if options.all:
            _write_json(RESULTS / "accuracy_cost.json", {"groups": groups})
            (RESULTS / "accuracy_cost.csv").write_text(compare.as_csv(groups), encoding="utf-8")
            _plot(RESULTS / "accuracy_cost.json", RESULTS / "accuracy_cost.png")


def read_recorded(path: Path) -> dict[str, Any]:
    """A result file. Raises BenchError when it is missing or broken."""
    try:
        recorded: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise BenchError(f"cannot read {path.relative_to(ROOT)} ({error}); run tests/bench/run --all") from None
    return recorded


def _print_profile(core: str, functions: dict[str, int]) -> None:
    total = sum(functions.values())
    print(f"{core}: {total / 1e6:.3f} M instructions")
    for name, count in functions.items():
        if count >= total / 200:
            print(f"  {count / 1e6:9.3f} M {count / total:6.1%}  {name}")


def _write_json(path: Path, content: dict[str, Any], command: str = "tests/bench/run --all") -> None:
    head = {"command": command, "compiler": compiler_version(), "qemu": qemu_version()}
    path.parent.mkdir(exist_ok=True)
    path.write_text(json.dumps({**head, **content}, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    print(f"wrote {path.relative_to(ROOT)}")


def _plot(results: Path, picture: Path) -> None:
    command = [sys.executable, "-m", "edgeline", "bench", "--plot", str(results), "-o", str(picture)]
    if subprocess.run(command, check=False).returncode != 0:
        raise BenchError(f"no chart: {' '.join(command[1:])} failed (above)")
