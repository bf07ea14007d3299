"""`edgeline verify`: any board, simulator or recording as a conformance test."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from edgeline import golden
from edgeline.codec import Pixels
from edgeline.commands.options import (
    SubParsers,
    add_command,
    add_headless,
    add_json,
    add_link,
    add_timeout,
    count,
    new_session,
    open_port,
    open_transport,
    positive,
)
from edgeline.commands.report import complain, device_says, print_json, progress
from edgeline.errors import EdgelineError, StreamError
from edgeline.golden import Golden, Place
from edgeline.link import Link
from edgeline.outfile import cannot_write, check_writable
from edgeline.recorder import save_png
from edgeline.recording import SUFFIX, is_recording
from edgeline.session import Session
from edgeline.tap import Tap
from edgeline.verify import Device, RecordedDevice, Source, Verdict, golden_of, judge, side_by_side

DIFFERS = 1
TIMEOUT_S = 30.0
MOST_SHOWN = 10
"""Differences that are listed, and of which pictures are kept; the JSON lists them all."""

NEW_FRAMES = 8
"""of each scene, in a golden file that is made from nothing"""


def add_parsers(commands: SubParsers) -> None:
    command = add_command(commands, "verify", "a device's pictures against a golden file: exit code 0 if all are equal")
    command.add_argument("golden", metavar="GOLDEN.crc", help="lines of `scene frame width height digest`")
    add_link(command)
    command.add_argument("--update", action="store_true", help="write what the device shows; makes the file if need be")
    command.add_argument("--scene", type=count, metavar="N", help="this scene alone")
    command.add_argument(
        "--frames", type=positive, metavar="N", help=f"frames below N alone; of a new file {NEW_FRAMES} by default"
    )
    command.add_argument("--diff", metavar="DIR", help=f"write the first {MOST_SHOWN} pictures that differ, as PNG")
    command.add_argument(
        "-r", "--reference", metavar="PORT", help="beside what this device, simulator or recording shows (with --diff)"
    )
    command.add_argument("--record", metavar="FILE", help=f"keep what passes, *{SUFFIX}, to be verified again")
    add_timeout(command, TIMEOUT_S, "give up after S seconds without a verified frame")
    add_json(command)
    add_headless(command)
    command.set_defaults(func=_verify)


@dataclass
class _Findings:
    """Verdicts by place, the pictures of the first that differ, and what ended the search early."""

    verdicts: dict[Place, Verdict] = field(default_factory=dict)
    pictures: dict[Place, Pixels] = field(default_factory=dict)
    failure: StreamError | None = None


def _verify(options: argparse.Namespace) -> int:
    if options.reference and not options.diff:
        raise EdgelineError("verify: --reference goes with --diff")
    if options.record and options.port and is_recording(options.port):
        raise EdgelineError(f"{options.port}: is a recording already: --record is for a device")
    if options.record and not options.record.lower().endswith(SUFFIX):
        raise EdgelineError(f"{options.record}: what passes is a recording: name it *{SUFFIX}")
    if options.update:
        return _update(options)
    goldens = _chosen(golden.read(options.golden), options)
    if options.diff:
        _make_folder(options.diff)
    findings = _Findings()
    with _source(options) as source:
        try:
            _compare(goldens, source, findings)
        except StreamError as error:
            findings.failure = error
        finally:
            progress("")
    files = _write_pictures(options, goldens, findings) if options.diff else {}
    return _report(options, goldens, findings, files)


def _compare(goldens: list[Golden], source: Source, findings: _Findings) -> None:
    wanted = {entry.place: entry for entry in goldens}
    for place, frame in source.show(wanted):
        verdict = judge(wanted[place], frame)
        findings.verdicts[place] = verdict
        if not verdict.equal and len(findings.pictures) < MOST_SHOWN:
            findings.pictures[place] = frame.picture
        progress(f"{len(findings.verdicts)} of {len(wanted)} frames")


def _report(options: argparse.Namespace, goldens: list[Golden], findings: _Findings, files: dict[Place, str]) -> int:
    verdicts = [findings.verdicts.get(entry.place) or judge(entry, None) for entry in goldens]
    different = [verdict for verdict in verdicts if not verdict.equal]
    equal = len(verdicts) - len(different)
    if options.json:
        rows = [_row(verdict, files) for verdict in verdicts]
        print_json({"golden": options.golden, "equal": equal, "different": len(different), "frames": rows})
    else:
        _print_table(different, files)
        print(f"{options.golden}: {equal} of {len(verdicts)} pictures are equal")
    if findings.failure is not None:
        complain(str(findings.failure))
        return findings.failure.exit_code
    return DIFFERS if different else 0


def _row(verdict: Verdict, files: dict[Place, str]) -> dict[str, object]:
    entry = verdict.golden
    width, height = verdict.size or (None, None)
    return {
        "scene": entry.place.scene,
        "frame": entry.place.frame,
        "verdict": verdict.words,
        "golden": {"width": entry.width, "height": entry.height, "digest": f"{entry.digest:08x}"},
        "shown": {"width": width, "height": height, "digest": _hex(verdict.digest)},
        "picture": files.get(entry.place),
    }


def _print_table(different: list[Verdict], files: dict[Place, str]) -> None:
    if different:
        print("scene      frame  golden    device    ")
    for verdict in different[:MOST_SHOWN]:
        place = verdict.golden.place
        scene = "-" if place.scene is None else str(place.scene)
        shown = _hex(verdict.digest) or "-"
        words = [verdict.words, *([files[place]] if place in files else [])]
        print(f"{scene:>5} {place.frame:>10}  {verdict.golden.digest:08x}  {shown:8}  {', '.join(words)}")
    if len(different) > MOST_SHOWN:
        print(f"... and {len(different) - MOST_SHOWN} more")


def _hex(digest: int | None) -> str | None:
    return None if digest is None else f"{digest:08x}"


def _write_pictures(options: argparse.Namespace, goldens: list[Golden], findings: _Findings) -> dict[Place, str]:
    """The PNGs of what differs, beside the reference's picture where it shows the golden one. Gives their names."""
    expected: dict[Place, Pixels] = {}
    if options.reference and findings.pictures:
        wanted = {entry.place: entry for entry in goldens if entry.place in findings.pictures}
        with _reference(options) as source:
            for place, frame in source.show(wanted):
                if judge(wanted[place], frame).equal:
                    expected[place] = frame.picture
        if len(expected) < len(wanted):
            complain(f"{options.reference}: shows {len(expected)} of the {len(wanted)} golden pictures that differ")
    files: dict[Place, str] = {}
    for place, picture in findings.pictures.items():
        number = "" if place.scene is None else f"scene{place.scene}-"
        files[place] = str(Path(options.diff) / f"{number}frame{place.frame}.png")
        save_png(files[place], side_by_side(expected.get(place), picture))
    return files


def _update(options: argparse.Namespace) -> int:
    before = golden.read(options.golden) if Path(options.golden).exists() else []
    check_writable(options.golden)
    chosen = [entry.place for entry in _chosen(before, options)] if before else []
    found: dict[Place, Golden] = {}
    with _source(options) as source:
        seen = source.show(chosen) if before else source.first(options.frames or NEW_FRAMES, options.scene)
        for place, frame in seen:
            found[place] = golden_of(place, frame)
            progress(f"{len(found)} frames")
    progress("")
    missing = [place for place in chosen if place not in found]
    if missing or not found:
        what = f"scene and frame {missing[0]}" if missing else "a frame"
        raise StreamError(f"{options.golden}: not written: the device did not show {what}")
    known = {entry.place: entry for entry in before}
    changed = sum(known.get(place) != entry for place, entry in found.items())
    golden.write(options.golden, {**known, **found}.values())
    if options.json:
        print_json({"golden": options.golden, "written": len(found), "changed": changed})
    else:
        print(f"{options.golden}: {len(found)} pictures written, {changed} of them new or changed")
    return 0


def _chosen(goldens: list[Golden], options: argparse.Namespace) -> list[Golden]:
    """Those of --scene and --frames."""
    chosen = [
        entry
        for entry in goldens
        if options.scene in (None, entry.place.scene) and (options.frames is None or entry.place.frame < options.frames)
    ]
    if not chosen:
        raise EdgelineError(f"{options.golden}: holds nothing of --scene and --frames")
    return chosen


@contextmanager
def _source(options: argparse.Namespace) -> Iterator[Source]:
    if options.port and is_recording(options.port):
        yield RecordedDevice(options.port)
        return
    tap = Tap(open_transport(options), packetwise=True)
    try:
        if options.record:
            tap.start(options.record, at_next_frame=False)
        with Link(tap, new_session(options, Session), device_says) as link:
            with _asked(link, options) as device:
                yield device
            if tap.failure is not None:
                raise tap.failure
    finally:
        tap.close()
        tap.stop()


@contextmanager
def _reference(options: argparse.Namespace) -> Iterator[Source]:
    if is_recording(options.reference):
        yield RecordedDevice(options.reference)
        return
    with Link(open_port(options.reference, options.baud)) as link, _asked(link, options) as device:
        yield device


@contextmanager
def _asked(link: Link, options: argparse.Namespace) -> Iterator[Device]:
    device = Device(link, options.timeout)
    try:
        yield device
    finally:
        device.release()


def _make_folder(name: str) -> None:
    try:
        Path(name).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise cannot_write(name, error) from None
