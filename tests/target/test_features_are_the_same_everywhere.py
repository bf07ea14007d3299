"""Every feature - materials, lights, fog, samples, layers of canvas/, instances, picking - has the same pixels on every
core, in fast code and in small code: the CRC-32s are those of tests/golden/features.crc, which are of this computer.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from emulators import CORES, Core, build, run, seeded_copy, unity_options
from target_tools import REPOSITORY

Crcs = dict[str, list[str]]
"""Feature -> its CRC with 1, 4 and 8 samples per pixel; small code has the first alone."""

CONFIGURATIONS = [*((core, "") for core in CORES), ("cortex-m0plus", "-small")]
"""The library that the unit tests of that core have, and small code."""

IN_ALL_CODE = {"shading", "lamps", "layers", "picking", "instances", "seams"}


def golden() -> Crcs:
    text = (REPOSITORY / "tests" / "golden" / "features.crc").read_text(encoding="ascii")
    return {words[0]: words[1:] for words in map(str.split, text.splitlines())}


def drawn(core: Core, name: str, *options: str, source: Path = REPOSITORY) -> Crcs:
    """What is drawn with the library in the folder unit-`name`."""
    folder = build("unit", name, *core.toolchain(), *unity_options(), *options, source=source, targets=("features",))
    ended = run(folder / "features" / "features", core)
    assert ended.status == 0, f"status {ended.status}: {ended.text[-200:]}"
    return {words[0]: words[1:] for words in map(str.split, ended.text.splitlines())}


@pytest.mark.parametrize(("name", "kind"), CONFIGURATIONS)
def test_crcs_are_the_golden_ones(name: str, kind: str) -> None:
    expected = golden()
    found = drawn(CORES[name], f"{name}{kind}", *(["-DCMAKE_BUILD_TYPE=MinSizeRel"] if kind else []))
    if kind:
        assert set(found) >= IN_ALL_CODE
        expected = {feature: expected[feature][:1] for feature in found}
    wrong = [feature for feature in expected if found.get(feature) != expected[feature]]
    print(f"{name}{kind}: {len(found)} features, {sum(map(len, found.values()))} pictures, wrong: {wrong}")
    assert not wrong, {feature: found.get(feature) for feature in wrong}


def test_a_wrong_constant_is_found() -> None:
    """Fog, and nothing but fog, that is rounded down instead of to nearest."""
    source = seeded_copy(
        "features-faulty",
        "firmware/src/raster/fog.h",
        "return (farther - (fall * in_step >> step_log2) + 64U) >> 7;",
        "return (farther - (fall * in_step >> step_log2)) >> 7;",
    )
    found = drawn(CORES["cortex-m3"], "features-faulty", source=source)
    expected = golden()
    assert [feature for feature in expected if found[feature] != expected[feature]] == ["fog"]
