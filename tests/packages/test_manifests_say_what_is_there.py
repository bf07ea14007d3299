"""library.properties, library.json and idf_component.yml: the fields that Arduino's library specification, PlatformIO's
library.json reference and ESP-IDF's manifest reference ask for,
and nothing that is not there.
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from packages_tools import FIRMWARE, REPOSITORY

CATEGORIES = {
    "Display",
    "Communication",
    "Signal Input/Output",
    "Sensors",
    "Device Control",
    "Timing",
    "Data Storage",
    "Data Processing",
    "Other",
}
"""Of Arduino's library specification."""


def properties() -> dict[str, str]:
    text = (FIRMWARE / "library.properties").read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if line and not line.startswith("#")]
    return dict(line.split("=", 1) for line in lines)


def library_json() -> dict[str, Any]:
    loaded: dict[str, Any] = json.loads((FIRMWARE / "library.json").read_text(encoding="utf-8"))
    return loaded


def version_in(path: Path, pattern: str) -> str:
    found = re.search(pattern, path.read_text(encoding="utf-8"), re.MULTILINE)
    assert found is not None, f"{path.relative_to(REPOSITORY)} states no version"
    return found[1]


def test_all_state_the_same_version() -> None:
    versions = {
        properties()["version"],
        library_json()["version"],
        version_in(FIRMWARE / "idf_component.yml", r'^version: "(.*)"$'),
        version_in(REPOSITORY / "CMakeLists.txt", r"project\(edgeline VERSION (\S+)"),
        version_in(REPOSITORY / "host" / "pyproject.toml", r'^version = "(.*)"$'),
    }
    assert len(versions) == 1, versions
    assert re.fullmatch(r"\d+\.\d+\.\d+", versions.pop())


@pytest.mark.parametrize(
    "field",
    ["name", "version", "author", "maintainer", "sentence", "paragraph", "category", "architectures", "includes"],
)
def test_the_arduino_manifest_has_its_fields(field: str) -> None:
    assert properties()[field].strip()


def test_the_arduino_manifest_keeps_the_rules() -> None:
    fields = properties()
    assert re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9 _.\-]{0,62}", fields["name"])
    assert not fields["name"].lower().startswith("arduino")
    assert fields["category"] in CATEGORIES
    assert not fields["paragraph"].startswith(fields["sentence"])
    assert "avr" not in fields["architectures"].split(",")
    for header in fields["includes"].split(","):
        assert (FIRMWARE / "src" / header).is_file(), header


def test_arduino_sees_a_recursive_library() -> None:
    """With src/ beside library.properties all of src/ is compiled; utility/ is for libraries without it."""
    assert (FIRMWARE / "src").is_dir()
    assert not (FIRMWARE / "utility").exists()
    for sketch in (FIRMWARE / "examples").rglob("*.ino"):
        assert sketch.stem == sketch.parent.name, "a sketch has its folder's name"


def test_the_platformio_manifest_keeps_the_rules() -> None:
    manifest = library_json()
    known = {"name", "version", "description", "keywords", "authors", "license", "frameworks", "platforms", "headers"}
    assert set(manifest) <= known | {"examples", "export", "build"}
    assert re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9\-]{0,49}", manifest["name"])
    assert len(manifest["description"]) <= 255
    assert all(re.fullmatch(r"[a-z0-9\- ]{1,50}", keyword) for keyword in manifest["keywords"])
    assert manifest["name"] == properties()["name"]
    assert set(manifest["build"]) == {"srcDir", "includeDir", "libLDFMode"}
    for folder in (manifest["build"]["srcDir"], manifest["build"]["includeDir"]):
        assert (FIRMWARE / folder).is_dir()
    assert manifest["headers"] == properties()["includes"].split(",")
    assert all((FIRMWARE / name).exists() for name in manifest["export"]["include"])


def test_the_platformio_manifest_lists_every_sketch() -> None:
    examples = library_json()["examples"]
    assert {example["name"] for example in examples} == {path.stem for path in (FIRMWARE / "examples").rglob("*.ino")}
    for example in examples:
        files = {path.name for path in (FIRMWARE / example["base"]).iterdir() if path.suffix in (".ino", ".h")}
        assert set(example["files"]) == files


def test_the_esp_idf_manifest_names_what_is_there() -> None:
    text = (FIRMWARE / "idf_component.yml").read_text(encoding="utf-8")
    assert re.search(r'^dependencies:\n  idf: ">=\d+\.\d+"$', text, re.MULTILINE)
    [path] = re.findall(r"^  - path: (.*)$", text, re.MULTILINE)
    assert (FIRMWARE / path / "main" / "CMakeLists.txt").is_file()
    for folder in re.findall(r'^    - "(\w+)/\*\*/\*"$', text, re.MULTILINE):
        assert (FIRMWARE / folder).is_dir()
