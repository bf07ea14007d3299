"""What tests/fuzz/fuzz_split.c promises: a fault in the split-stream encoder does not live. Its corpus and a few seeded
inputs, without libFuzzer, find nothing in the encoder as it is, and each fault that is put in here."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from needs import missing

ROOT = Path(__file__).parents[2]
FUZZ = ROOT / "tests" / "fuzz"
ENCODER = ROOT / "firmware" / "src" / "stream" / "split.c"
SEEDED_INPUTS = "300"

FAULTS = {
    "a copy from beyond the line's end": ("end < l->last ? end : l->last, a + 1", "end, a + 1"),
    "a copy from before the line's begin": ("(inside || p > l->pixels)", "(inside || p >= l->pixels)"),
    "a stretch that goes on to the line's end and does not": ("best->stop > l->last", "best->stop >= l->last"),
    "a stretch across what the host keeps": ("l.end = pixels + end;", "l.end = pixels + width;"),
    "a literal of the packet before": (
        "ago < MOST_RECENT && ago < count && split->literals[ago] == value",
        "ago < MOST_RECENT && split->literals[ago] == value",
    ),
    "a pair the wrong way round": ("PAIR_CLASSES * first->class + second", "PAIR_CLASSES * second->class + first"),
    "a literal too many for a token": ("LITERALS + MOST_LITERALS - 1", "LITERALS + MOST_LITERALS"),
    "a dithered line that is not told": ("1U << split->lines % 8", "1U << (split->lines + 1) % 8"),
    "a delta of the wrong neighbour": ("find_delta(p[lag + 1], p[1])", "find_delta(p[lag + 1], p[0])"),
}


def check(folder: Path, source: Path) -> subprocess.CompletedProcess[str]:
    """Builds the target with the encoder `source` and runs it."""
    compiler = shutil.which("cc")
    if compiler is None:
        missing("cc")
    program = folder / "fuzz_split"
    parts = [FUZZ / "fuzz_split.c", FUZZ / "standalone.c", source]
    includes = [f"-I{ROOT / 'firmware' / 'src'}", f"-I{ROOT / 'tests' / 'unit'}"]
    subprocess.run([str(compiler), "-std=c11", "-O1", *includes, *map(str, parts), "-o", str(program)], check=True)
    corpus = sorted(map(str, (FUZZ / "corpus" / "fuzz_split").iterdir()))
    return subprocess.run(
        [str(program), SEEDED_INPUTS, *corpus], capture_output=True, text=True, timeout=60, check=False
    )


def test_nothing_is_found_in_the_encoder(tmp_path: Path) -> None:
    ended = check(tmp_path, ENCODER)
    assert ended.returncode == 0, ended.stderr


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_found(fault: str, tmp_path: Path) -> None:
    old, new = FAULTS[fault]
    text = ENCODER.read_text(encoding="utf-8")
    assert text.count(old) == 1, f"'{old}' is not what the encoder has"
    source = tmp_path / "split.c"
    source.write_text(text.replace(old, new), encoding="utf-8")
    ended = check(tmp_path, source)
    assert ended.returncode != 0 and "does not hold" in ended.stderr, ended.stderr
