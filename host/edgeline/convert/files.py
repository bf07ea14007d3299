"""Writing results so that a failure leaves what was there before: beside it first, then renamed."""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Sequence
from pathlib import Path

from edgeline.errors import OutputError


def write_whole(path: Path, data: bytes) -> None:
    """Makes `path` hold `data`, or raises OutputError and leaves it as it was."""
    write_all([(path, data)])


def write_all(files: Sequence[tuple[Path, bytes]]) -> None:
    """Makes each path hold its data. Raises OutputError; what could be foreseen then left all of them as they were."""
    beside: list[Path] = []
    path = Path()
    try:
        mask = os.umask(0)  # reading it means setting it
        os.umask(mask)
        for path, data in files:
            if path.is_dir():
                raise OutputError(f"cannot write {path}: it is a folder; give another -o")
            descriptor, name = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
            beside.append(Path(name))
            with os.fdopen(descriptor, "wb") as file:
                file.write(data)
            beside[-1].chmod(0o666 & ~mask)  # as a file that was simply opened for writing would have it
        for temporary, (path, _) in zip(beside, files, strict=True):
            temporary.replace(path)
    except OSError as error:
        raise OutputError(f"cannot write {path}: {error.strerror or error}; give another -o") from error
    finally:
        for temporary in beside:
            with contextlib.suppress(OSError):
                temporary.unlink()
