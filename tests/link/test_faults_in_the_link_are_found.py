"""The judge can fail: a fault is put into a copy of either side, and a conversation must end with the words that belong
to it."""

from __future__ import annotations

import json
import shlex
import subprocess
from dataclasses import dataclass, replace
from pathlib import Path

import pytest

from cases import CASES
from channel import Faults
from conversation import Case, Conversation, WrongError
from edgeline.picture import Picture
from edgeline.stream import Stream
from needs import missing

STREAM = Path(__file__).parents[2] / "firmware" / "src" / "stream"


def case(name: str) -> Case:
    return next(case for case in CASES if case.name == name)


UNDER_ERRORS = case("bit errors 1e-5, vertex colours, 160x120")
"""Much of it stands still, so that what is lost comes again only if it is asked for."""


def test_a_host_that_skips_the_digest(program: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class Any(int):
        def __eq__(self, other: object) -> bool:
            return True

        __hash__ = int.__hash__

    monkeypatch.setattr(Picture, "digest", lambda picture: Any())
    with pytest.raises(WrongError, match=r"is called good, and \d+ of its pixels are wrong"):
        Conversation(program, case("bit errors 1e-4, vertex colours"), 1).run(300)


def test_a_host_that_forgets_key(program: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Stream, "_ask", lambda stream: None)
    with pytest.raises(WrongError, match="frames failed in the mean"):
        Conversation(program, UNDER_ERRORS, 1).run(60)


def test_a_host_that_calls_all_lines_proven(program: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Picture, "lose", lambda picture, y0, y1: None)
    with pytest.raises(WrongError, match="is called good and was never drawn"):
        Conversation(program, case("bit errors 1e-4, vertex colours"), 1).run(300)


@dataclass(frozen=True)
class Fault:
    """One in the firmware: in `path`, `right` is replaced by `wrong`; then `case` ends with `words`."""

    name: str
    path: str
    right: str
    wrong: str
    case: Case
    words: str
    frames: int = 60


FAULTS = (
    Fault(
        "a changed segment is left out",
        "changes.c",
        "(fresh[i] != crcs[i] ? 1U : 0U) << i",
        "(fresh[i] != crcs[i] && i == 0 ? 1U : 0U) << i",
        replace(case("no faults"), boot=replace(case("no faults").boot, width=160)),
        "frames failed in the mean|frames within",
    ),
    Fault(
        "INPUT's numbers are ignored",
        "session.c",
        "(numbered && body[INPUT_BYTES] != number)",
        "(numbered && body[INPUT_BYTES] == number && false)",
        replace(case("no faults"), inputs=0.5, up=Faults(dropped=10)),
        "asked for",
        frames=300,
    ),
    Fault(
        "lines that KEY asks for are not sent",
        "session.c",
        "el_stream_make_due(stream, y0, y1 < height ? y1 : height);",
        "(void)y0, (void)y1, (void)height;",
        UNDER_ERRORS,
        "frames failed in the mean",
    ),
)


def run(command: list[str], folder: Path) -> None:
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr


def build(program: Path, fault: Fault, folder: Path) -> Path:
    """The device with the fault: the patched file is compiled as the build did it, and goes before the libraries, which
    then have nothing to add for it."""
    tree, source = program.parent, STREAM / fault.path
    commands = tree / "compile_commands.json"
    if not commands.is_file():
        missing(f"no {commands.name} beside {program.name}: build with CMake")
    text = source.read_text(encoding="utf-8")
    assert text.count(fault.right) == 1, f"{fault.path} has changed: mend the fault's text"
    patched, compiled, faulty = folder / fault.path, folder / "patched.o", folder / "device"
    patched.write_text(text.replace(fault.right, fault.wrong), encoding="utf-8")
    entries = json.loads(commands.read_text(encoding="utf-8"))
    entry = next(entry for entry in entries if Path(entry["file"]) == source)
    line = shlex.split(entry["command"])
    before = line[: line.index("-o")]
    run([*before, "-o", str(compiled), "-c", str(patched)], Path(entry["directory"]))
    device = next(tree.glob("tests/link/**/device.c.o"))
    libraries = [str(library) for library in sorted((tree / "firmware").glob("libedgeline*.a"))]
    group = ["-Wl,--start-group", *libraries, "-Wl,--end-group"]
    run([line[0], str(device), str(compiled), *group, "-o", str(faulty)], folder)
    return faulty


@pytest.mark.parametrize("fault", FAULTS, ids=[fault.name for fault in FAULTS])
def test_a_device_where(program: Path, tmp_path: Path, fault: Fault) -> None:
    with pytest.raises(WrongError, match=fault.words):
        Conversation(build(program, fault, tmp_path), fault.case, 1).run(fault.frames)
