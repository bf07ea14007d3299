"""Writing a result so that a failure leaves what was there before: beside it first, then renamed."""

from __future__ import annotations

import contextlib
import os
import tempfile
from pathlib import Path

from edgeline.errors import OutputError


def write_whole(path: Path, data: bytes) -> None:
    """Makes `path` hold `data`, or raises OutputError and leaves it as it was."""
    beside: Path | None = None
    try:
        if path.is_dir():
            raise OutputError(f"cannot write {path}: it is a folder; give another -o")
        descriptor, name = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
        beside = Path(name)
        with os.fdopen(descriptor, "wb") as file:
            file.write(data)
        mask = os.umask(0)  # reading it means setting it
        os.umask(mask)
        beside.chmod(0o666 & ~mask)  # as a file that was simply opened for writing would have it
        beside.replace(path)
    except OSError as error:
        if beside is not None:
            with contextlib.suppress(OSError):
                beside.unlink()
        raise OutputError(f"cannot write {path}: {error.strerror or error}; give another -o") from error
