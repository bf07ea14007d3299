"""Progress bars for what takes more than a second: on standard error, and only where that is a terminal."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from edgeline.convert.extra import tqdm

DELAY_S = 1.0


class Steps:
    """What shows how far a conversion is. `shown` False keeps it quiet whatever standard error is."""

    def __init__(self, shown: bool = True) -> None:
        self._tqdm = tqdm() if shown and sys.stderr.isatty() else None

    @contextmanager
    def bar(self, title: str, total: int) -> Iterator[Callable[[int], None]]:
        """Gives the function that is told of things done, `total` of them in the end."""
        if self._tqdm is None:
            yield lambda count: None
            return
        with self._tqdm.tqdm(desc=title, total=total, delay=DELAY_S, leave=False, file=sys.stderr) as shown:
            yield lambda count: shown.update(count) and None
