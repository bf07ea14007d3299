"""What all charts share. matplotlib is an optional extra and imported when a chart is drawn, so that all else works
without it."""

from __future__ import annotations

import importlib
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from edgeline.errors import EdgelineError, OutputError, PackageError

DOTS_PER_INCH = 80


def load(path: str) -> dict[str, Any]:
    """A result file of tests/bench. Raises EdgelineError when the file is none."""
    try:
        content = json.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise EdgelineError(f"{path}: {error.strerror}") from None
    except ValueError as error:
        raise EdgelineError(f"{path} is no JSON: {error}") from None
    return content if isinstance(content, dict) else {}


def draw_with_pyplot(draw: Callable[[Any], Any], output: str) -> None:
    """Writes the figure that `draw` makes with matplotlib's pyplot. Raises EdgelineError."""
    try:
        matplotlib = importlib.import_module("matplotlib")
    except ImportError:
        raise PackageError("charts need", "matplotlib") from None
    matplotlib.use("Agg")
    pyplot = importlib.import_module("matplotlib.pyplot")
    figure = draw(pyplot)
    try:
        # Without dates and versions: the same figures give the same file.
        figure.savefig(output, dpi=DOTS_PER_INCH, metadata={"Software": None})
    except (OSError, ValueError) as error:
        raise OutputError(f"cannot write {output}: {error}") from None
    finally:
        pyplot.close(figure)
