"""The command line of tests/bench/run."""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from . import (
    against,
    canvas,
    codec,
    compare,
    feature_tables,
    features,
    frames,
    growth,
    growth_plot,
    helpers,
    models,
    pico,
    size,
    stages,
    still,
    tables,
    workers,
)
from .machines import (
    BENCH,
    CORES,
    MAIN_CORES,
    ROOT,
    BenchError,
    Machines,
    MissingToolError,
    check_tools,
    compiler_version,
    qemu_version,
)

RESULTS = BENCH / "results"
SCENES = RESULTS / "scenes.json"
CODEC = RESULTS / "codec.json"
QUICK_CORES = (*MAIN_CORES, "rv32imc")
GROWTH = RESULTS / "growth.json"
ALTERNATIVES = RESULTS / "accuracy_cost.json"
FEATURES = RESULTS / "features.json"
RECORD_FEATURES = "tests/bench/run --record-features"
STATUS_SKIPPED = 77


def main(arguments: Sequence[str] | None = None) -> int:
    """Status 0: all checks passed; 1: one failed; 2: could not measure; 77: a tool is not installed."""
    parser = argparse.ArgumentParser(prog="tests/bench/run", description="Run time against error.")
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument(
        "--quick",
        action="store_true",
        help="check pictures against the simulator, and figures against the results",
    )
    what.add_argument("--scenes", action="store_true", help="print the frames' instruction counts on all cores")
    what.add_argument("--record-scenes", action="store_true", help="measure the frames, write tests/bench/results")
    what.add_argument(
        "--profile", metavar="SCENE", help="print which stages and functions a scene's instructions go to"
    )
    what.add_argument("--still", action="store_true", help="print what it saves to leave out what has not changed")
    what.add_argument("--helpers", action="store_true", help="print what quaternions, animations, picking ... cost")
    what.add_argument("--canvas", action="store_true", help="print what drawing in two dimensions costs")
    what.add_argument("--features", action="store_true", help="print what each feature costs, used and not used")
    what.add_argument("--record-features", action="store_true", help="measure that, write tests/bench/results")
    what.add_argument("--alternatives", action="store_true", help="print cost and error of the alternatives")
    what.add_argument("--record-alternatives", action="store_true", help="measure those, write tests/bench/results")
    what.add_argument("--size", action="store_true", help="print bytes of code, check them against budgets and results")
    what.add_argument("--record-size", action="store_true", help="measure bytes of code, write tests/bench/results")
    what.add_argument("--codec", action="store_true", help="print the stream codec's bytes, cost and speed, check them")
    what.add_argument("--record-codec", action="store_true", help="measure the codec, write tests/bench/results")
    what.add_argument("--growth", action="store_true", help="print how cost grows, check the laws that it follows")
    what.add_argument("--record-growth", action="store_true", help="measure that, write tests/bench/results and charts")
    what.add_argument("--pico", action="store_true", help="print a Pico's frames beside its display's wire")
    what.add_argument("--record-pico", action="store_true", help="measure those, write tests/bench/results")
    what.add_argument("--against", metavar="REVISION", help="print native time relative to another git revision")
    what.add_argument("--workers", action="store_true", help="print what two cores gain over one, here as threads")
    what.add_argument("--all", action="store_true", help="measure everything, write tests/bench/results and the chart")
    parser.add_argument("--build", type=Path, default=ROOT / "build" / "bench", metavar="DIR", help="where to build")
    options = parser.parse_args(arguments)
    verdicts = frames.Verdicts()
    try:
        check_tools()
        _run(options, options.build.resolve(), verdicts)
    except MissingToolError as error:
        print(f"bench: skipped, {error}")
        return STATUS_SKIPPED
    except BenchError as error:
        print(f"bench: {error}", file=sys.stderr)
        return 2
    if verdicts.better:
        print(f"{verdicts.better} figures are better than the recorded ones; record them: {frames.RECORD}")
    if options.profile is None:
        print(f"{verdicts.passed} passed, {verdicts.failed} failed, 0 skipped")
    return 1 if verdicts.failed else 0


def _run(options: argparse.Namespace, folder: Path, verdicts: frames.Verdicts) -> None:
    machines = Machines(folder, models.convert(folder / "models"))
    if options.quick:
        _check(machines, verdicts)
    if options.quick or options.size:
        sizes = size.measure()
        size.check(sizes, read_recorded(size.RESULT), verdicts)
        if options.size:
            print(size.table(sizes))
    if options.record_size or options.all:
        size.record(size.measure())
    if options.scenes:
        print(tables.instructions(frames.measure(machines, verdicts)))
    if options.record_scenes or options.all:
        _record_scenes(machines, verdicts)
    if options.against is not None:
        print(against.table(*against.measure(machines, options.against, verdicts)))
    if options.canvas:
        print(canvas.table(canvas.measure(machines, verdicts)))
    if options.still:
        print(still.table(still.measure(machines, verdicts)))
    if options.helpers:
        print(helpers.table(helpers.measure(machines, verdicts)))
    if options.features or options.record_features or options.all:
        _measure_features(machines, verdicts, record=not options.features)
    if options.workers:
        print(workers.table(workers.measure(machines)))
    if options.profile is not None:
        for core in MAIN_CORES:
            _print_profile(machines, core, options.profile)
    if options.codec or options.record_codec or options.all:
        streams = codec.measure(machines, verdicts)
        print(codec.table(streams))
        if options.codec:
            codec.compare_with_recorded(streams, read_recorded(CODEC), verdicts)
        else:
            _write_json(CODEC, {"sequences": codec.rows(streams)}, "tests/bench/run --record-codec")
    if options.quick or options.growth or options.record_growth or options.all:
        _grow(options, machines, verdicts)
    if options.pico or options.record_pico or options.all:
        _measure_pico(record=not options.pico)
    if options.alternatives or options.record_alternatives or options.all:
        _measure_alternatives(machines, verdicts, record=not options.alternatives)


def _check(machines: Machines, verdicts: frames.Verdicts) -> None:
    """Pictures, counts, memory and code sizes against the recorded ones, on QUICK_CORES."""
    found = frames.measure(machines, verdicts, QUICK_CORES)
    recorded = read_recorded(SCENES)
    if recorded["compilers"] != {core: compiler_version(core) for core in recorded["compilers"]}:
        print(f"counts not compared: recorded with gcc {recorded['compilers']}")
        return
    frames.compare_with_recorded(found, recorded, verdicts)
    for core in QUICK_CORES:
        total, was = (sum(sizes.values()) for sizes in (_code_of(machines, core), recorded["code"][core]))
        verdicts.compare(f"{CORES[core].title}: bytes of code with -O2", total, was, frames.RECORD)
    codec.compare_with_recorded(codec.encode(machines, verdicts), read_recorded(CODEC), verdicts)
    features.check_quickly(machines, verdicts)


def _record_scenes(machines: Machines, verdicts: frames.Verdicts) -> None:
    if machines.models is None:
        raise BenchError("models are recorded too: have shared/models beside the repository, or set EDGELINE_MODELS")
    found = frames.measure(machines, verdicts)
    for bits in (6, 8):
        # How bits and the texture's bound act together is of no interest.
        finer = frames.measure(machines, verdicts, MAIN_CORES, bits)
        found += [frame for frame in finer if frame.uv_error_log2 == tables.USUAL_UV]
    code = {core: _code_of(machines, core) for core in CORES}
    print(tables.instructions(found))
    compilers = {core: compiler_version(core) for core in CORES}
    facts = {"compilers": compilers, "peers": frames.PEERS, "targets": frames.TARGETS, "code": code}
    _write_json(SCENES, {**facts, "frames": frames.rows(found)}, frames.RECORD)
    SCENES.with_suffix(".md").write_text(tables.document(found, code, frames.RECORD), encoding="utf-8")
    _plot(SCENES, SCENES.with_suffix(".png"))
    for path in tables.DOCUMENTS:
        path.write_text(tables.embed(path.read_text(encoding="utf-8"), found, code), encoding="utf-8")


def _measure_alternatives(machines: Machines, verdicts: frames.Verdicts, record: bool) -> None:
    groups = compare.measure(machines, verdicts)
    print(compare.table(groups))
    if record:
        _write_json(ALTERNATIVES, {"groups": groups}, "tests/bench/run --record-alternatives")
        ALTERNATIVES.with_suffix(".csv").write_text(compare.as_csv(groups), encoding="utf-8")
        _plot(ALTERNATIVES, ALTERNATIVES.with_suffix(".png"))


def _measure_features(machines: Machines, verdicts: frames.Verdicts, record: bool) -> None:
    found = features.measure(machines, verdicts)
    text = feature_tables.document(found, RECORD_FEATURES)
    print(text)
    if record:
        _write_json(FEATURES, found, RECORD_FEATURES)
        FEATURES.with_suffix(".md").write_text(text, encoding="utf-8")
        for path in tables.DOCUMENTS:
            path.write_text(feature_tables.embed(path.read_text(encoding="utf-8"), found), encoding="utf-8")


def _measure_pico(record: bool) -> None:
    found = pico.measure()
    print(f"{found['figures']}\n\n{pico.table(found)}")
    if record:
        _write_json(pico.RESULT, found, pico.RECORD)
        for path in tables.DOCUMENTS:
            path.write_text(pico.embed(path.read_text(encoding="utf-8"), found), encoding="utf-8")


def _code_of(machines: Machines, core: str) -> dict[str, int]:
    return size.linked(machines.build(core, "scenes").with_name("scenes.map"))


def _grow(options: argparse.Namespace, machines: Machines, verdicts: frames.Verdicts) -> None:
    rows = growth.measure(machines, verdicts)
    growth.check(rows, verdicts)
    if not options.quick:
        print(growth.table(rows))
    if options.record_growth or options.all:
        _write_json(GROWTH, growth.content(rows), "tests/bench/run --record-growth")
        for picture in growth_plot.draw(rows, RESULTS):
            print(f"wrote {picture.relative_to(ROOT)}")
        return
    recorded = read_recorded(GROWTH)
    if recorded["compiler"] == compiler_version():
        growth.compare_with_recorded(rows, recorded, verdicts)


def read_recorded(path: Path) -> dict[str, Any]:
    """A result file. Raises BenchError when it is missing or broken."""
    try:
        recorded: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise BenchError(f"cannot read {path.relative_to(ROOT)} ({error}); run tests/bench/run --all") from None
    return recorded


def _print_profile(machines: Machines, core: str, scene: str) -> None:
    """Of the scene's first frame: instructions by stage, and by function."""
    measured, profiles = stages.profile(machines, core, "scenes")
    names = [one.line.words[0] for one in measured]
    if scene not in names:
        raise BenchError(f"no scene '{scene}' is measured; there are {', '.join(dict.fromkeys(names))}")
    counts = profiles[names.index(scene)]
    program = stages.Program(CORES[core], machines.build(core, "scenes"))
    total = measured[names.index(scene)].instructions
    print(f"{core}: {total / 1e6:.3f} M instructions")
    print("  " + ", ".join(f"{name} {count / 1e6:.3f} M" for name, count in program.split(counts).items()))
    for name, count in program.by_function(counts).items():
        if count >= total / 200:
            print(f"  {count / 1e6:9.3f} M {count / total:6.1%}  {name}")


def _write_json(path: Path, content: dict[str, Any], command: str) -> None:
    head = {"command": command, "compiler": compiler_version(), "qemu": qemu_version()}
    path.parent.mkdir(exist_ok=True)
    path.write_text(json.dumps({**head, **content}, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    print(f"wrote {path.relative_to(ROOT)}")


def _plot(results: Path, picture: Path) -> None:
    command = [sys.executable, "-m", "edgeline", "bench", "--plot", str(results), "-o", str(picture)]
    if subprocess.run(command, check=False).returncode != 0:
        raise BenchError(f"no chart: {' '.join(command[1:])} failed (above)")
