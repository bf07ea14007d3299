"""What the extra `convert` brings: libraries that are imported when needed, or missed in one line."""

from __future__ import annotations

import importlib
from types import ModuleType

from edgeline.errors import PackageError


def fast_simplification() -> ModuleType:
    """The library that collapses edges. Raises PackageError where it is not installed."""
    try:
        return importlib.import_module("fast_simplification")
    except ImportError:
        raise PackageError("--triangles and --tolerance need", "fast-simplification") from None


def tqdm() -> ModuleType | None:
    """The progress bar, if it is installed: its absence takes nothing else away."""
    try:
        return importlib.import_module("tqdm")
    except ImportError:
        return None
