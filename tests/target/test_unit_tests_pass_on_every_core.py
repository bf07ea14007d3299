"""The unit tests of tests/unit, compiled for each core and run in QEMU, have the results that they have natively, test
by test.

Those natively run are beside the simulator that EDGELINE_SIM names, or in build/sim: tests/run builds them first.
"""

from __future__ import annotations

import re

import pytest

from emulators import CORES, STATUS_FAULT, Core, build, run, seeded_copy, unity_options
from needs import missing
from target_tools import REPOSITORY, Simulator

# What cannot run without an operating system, and why. tests/unit/CMakeLists.txt leaves the same out.
NATIVE_ONLY = {"test_stream_ports": "sockets and pseudo-terminals", "test_workers": "threads"}

Results = dict[str, str]
"""Test -> what Unity says of it: PASS, FAIL, IGNORE."""


def results(text: str) -> Results:
    """The outcome of each test in a Unity program's output."""
    return dict(re.findall(r"^[^\s:]+:\d+:(\w+):(PASS|FAIL|IGNORE)\b", text, re.MULTILINE))


def said(text: str, test: str) -> str:
    """Unity's line for that test."""
    return next((line for line in text.splitlines() if f":{test}:" in line), f"{test}: nothing")


@pytest.fixture(scope="session")
def native(simulator: Simulator) -> dict[str, Results]:
    """Program -> its results on this computer."""
    folder = simulator.path.parent / "tests" / "unit"
    sources = sorted((REPOSITORY / "tests" / "unit").glob("test_*.c"))
    names = [source.stem for source in sources if source.stem not in NATIVE_ONLY]
    absent = [name for name in names if not (folder / name).is_file()]
    if absent:
        missing(f"{folder} has no {absent[0]}: build the unit tests there with EDGELINE_TESTS=ON")
    return {name: results(run(folder / name).text) for name in names}


@pytest.mark.parametrize("core", CORES.values(), ids=CORES.keys())
def test_results_equal_the_native_ones(native: dict[str, Results], core: Core) -> None:
    folder = build("unit", core.name, *core.toolchain(), *unity_options()) / "unit"
    wrong = []
    for name, expected in native.items():
        assert expected, f"{name} has no results natively"
        ended = run(folder / name, core)
        found = results(ended.text)
        differ = [test for test in {**expected, **found} if found.get(test) != expected.get(test)]
        wrong += [f"{name}: {said(ended.text, test)}, natively {expected.get(test)}" for test in differ]
        if not differ and ended.status != ("FAIL" in expected.values()):
            wrong.append(f"{name} ended with status {ended.status}")
    assert not wrong, "\n".join(wrong)
    print(f"{core.name}: {len(native)} programs, {sum(map(len, native.values()))} tests, as natively")


@pytest.mark.parametrize("core", CORES.values(), ids=CORES.keys())
def test_a_fault_is_a_failure(core: Core) -> None:
    """An illegal instruction ends the program with its own status, and not as a success."""
    folder = build("unit", core.name, *core.toolchain(), *unity_options(), targets=("faulting",))
    assert run(folder / "faulting", core).status == STATUS_FAULT


def test_a_wrong_constant_on_one_core_is_found(native: dict[str, Results]) -> None:
    core = CORES["cortex-m3"]
    source = seeded_copy("unit-faulty", "firmware/src/base/crc32.c", "0x51DE003A", "0x51DE003B")
    options = (*core.toolchain(), *unity_options())
    folder = build("unit", "faulty", *options, source=source, targets=("test_crc32",)) / "unit"
    assert results(run(folder / "test_crc32", core).text) != native["test_crc32"]
