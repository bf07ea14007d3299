"""What tests/fuzz/fuzz_all.c promises: a fault in what features share does not live. Its corpus, without libFuzzer,
finds nothing in the library as it is, and each fault that is put in here."""

from __future__ import annotations

import os
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from conftest import REPOSITORY
from needs import missing

SOURCES = REPOSITORY / "firmware" / "src"
FUZZ = REPOSITORY / "tests" / "fuzz"
SIM = REPOSITORY / "sim"
FLAGS = ("-std=gnu11", "-O1", f"-I{SOURCES}", f"-I{SIM}", f"-I{FUZZ}")

FAULTS = {
    "an alpha that is not looked at for the next frame": (
        "frame/quiet.c",
        "    hash = el_hash_word(hash, material->alpha);\n",
        "",
    ),
    "a layer that changes and is not asked": (
        "frame/quiet.c",
        "    return true;\n}\n\nbool el_quiet_is_unchanged(",
        "    return true;\n}\n#define layers_repeat(config, y, lines) true\nbool el_quiet_is_unchanged(",
    ),
    "a band that is empty and was not": ("frame/quiet.c", "(quiet->was_drawn & group) != 0 ||", ""),
    "another level picked than drawn": (
        "scene/instances.c",
        "el_pick_draw(pick, mesh_of(instance),",
        "el_pick_draw(pick, instance->levels[0].mesh,",
    ),
    "a pick that sees no back faces": ("frame/pick.c", "(EL_MATERIAL_TWO_SIDED |", "("),
    "a pick of the line above": ("frame/pick.c", "pass_begin = y;", "pass_begin = y > 0 ? y - 1U : 0;"),
    "an edge that begins in its own row and not in the band's": (
        "canvas/polygon_rows.c",
        "(int64_t)down * dx",
        "(int64_t)0 * dx * down",
    ),
    "a group's last band carried on": ("frame/workers.c", "band + 1 < end);", "true);"),
}


def _compiler() -> str:
    compiler = shutil.which("cc")
    if compiler is None:
        missing("cc")
    return compiler


def _compile(source: Path, object_file: Path) -> None:
    subprocess.run([_compiler(), *FLAGS, "-c", str(source), "-o", str(object_file)], check=True)


@pytest.fixture(scope="module")
def objects(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The target and the whole library, compiled: a source's name -> its object."""
    folder = tmp_path_factory.mktemp("objects")
    sources = {str(path.relative_to(SOURCES)): path for path in SOURCES.glob("*/*.c")}
    sources |= {path.name: path for path in (FUZZ / "fuzz_all.c", FUZZ / "standalone.c", SIM / "threads.c")}
    sources["report.c"] = SIM / "report.c"
    made = {name: folder / f"{name.replace('/', '-')}.o" for name in sources}
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(lambda name: _compile(sources[name], made[name]), sources))
    return made


def check(objects: dict[str, Path], folder: Path) -> subprocess.CompletedProcess[str]:
    """Links these and runs the corpus."""
    program = folder / "fuzz_all"
    subprocess.run([_compiler(), *map(str, objects.values()), "-lpthread", "-o", str(program)], check=True)
    corpus = sorted(map(str, (FUZZ / "corpus" / "fuzz_all").iterdir()))
    return subprocess.run([str(program), "0", *corpus], capture_output=True, text=True, timeout=60, check=False)


def test_nothing_is_found_in_the_library(objects: dict[str, Path], tmp_path: Path) -> None:
    ended = check(objects, tmp_path)
    assert ended.returncode == 0, ended.stderr


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_found(fault: str, objects: dict[str, Path], tmp_path: Path) -> None:
    name, old, new = FAULTS[fault]
    text = (SOURCES / name).read_text(encoding="utf-8")
    assert text.count(old) == 1, f"'{old}' is not what {name} has"
    source, changed = tmp_path / "faulty.c", tmp_path / "faulty.o"
    source.write_text(text.replace(old, new), encoding="utf-8")
    _compile(source, changed)
    ended = check(objects | {name: changed}, tmp_path)
    assert ended.returncode != 0 and "does not hold" in ended.stderr, ended.stderr
