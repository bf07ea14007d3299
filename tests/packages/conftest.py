"""Fixtures of the packages' tests: the library, compiled once as a user's build system compiles it."""

from __future__ import annotations

from pathlib import Path

import pytest

from needs import need_tool
from packages_tools import FIRMWARE, NATIVE, STRICT, compile_units, library_sources


@pytest.fixture(scope="session")
def native_library(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """The objects of all of src/, with src/ as the one include directory."""
    need_tool(NATIVE.c[0], NATIVE.package)
    flags = ["-std=c11", "-O1", *STRICT, f"-I{FIRMWARE / 'src'}"]
    return compile_units(NATIVE.c, library_sources(), flags, tmp_path_factory.mktemp("library"))
